//! Units of measured columns, and the factors between them.

use crate::problem::Fault;
use rotor_base::significant;

/// What a unit measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dimension {
    /// Time.
    Time,
    /// Electric potential.
    Voltage,
    /// Electric current.
    Current,
    /// Length.
    Length,
    /// Speed.
    Velocity,
    /// Force.
    Force,
    /// Magnetic field `H`; a flux density stands for `B / mu0`.
    MagneticField,
    /// Magnetic moment.
    MagneticMoment,
    /// Plane angle.
    Angle,
    /// Temperature, its zero left as it is.
    Temperature,
    /// A pure number.
    Number,
}

/// A unit a column may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// The form the program writes, such as `um` or `A_per_m`.
    pub symbol: &'static str,
    /// What it measures.
    pub dimension: Dimension,
    /// Factor into the SI unit of its dimension (s, V, A, m, m/s, N, A/m, A m^2, rad, degree, 1).
    pub to_si: f64,
    /// Other spellings.
    spellings: &'static [&'static str],
}

/// `mu0 = 4 pi 1e-7` V s/(A m), the value by which oersted and gauss are defined.
const MU0: f64 = 4e-7 * std::f64::consts::PI;
/// Pound-force, N: 0.45359237 kg times standard gravity, exact.
const POUND_FORCE_NEWTON: f64 = 4.448_221_615_260_5;
/// Inch, m, exact.
const INCH_METRE: f64 = 0.0254;

const fn unit(
    symbol: &'static str,
    dimension: Dimension,
    to_si: f64,
    spellings: &'static [&'static str],
) -> Unit {
    Unit { symbol, dimension, to_si, spellings }
}

/// Every unit known.
pub const UNITS: [Unit; 46] = {
    use Dimension::{
        Angle, Current, Force, Length, MagneticField, MagneticMoment, Number, Temperature, Time,
        Velocity, Voltage,
    };
    [
        unit("s", Time, 1.0, &["sec", "second", "seconds", "sekunde", "sekunden", "secondes"]),
        unit("ms", Time, 1e-3, &["msec", "millisecond", "milliseconds"]),
        unit("us", Time, 1e-6, &["µs", "μs", "usec", "microseconds"]),
        unit("ns", Time, 1e-9, &["nanoseconds"]),
        unit("min", Time, 60.0, &[]),
        unit("h", Time, 3600.0, &[]),
        unit("V", Voltage, 1.0, &["volt", "volts", "vdc", "V DC"]),
        unit("mV", Voltage, 1e-3, &["millivolt", "millivolts"]),
        unit("uV", Voltage, 1e-6, &["µV", "μV"]),
        unit("kV", Voltage, 1e3, &[]),
        unit("A", Current, 1.0, &[]),
        unit("mA", Current, 1e-3, &[]),
        unit("uA", Current, 1e-6, &["µA", "μA"]),
        unit("m", Length, 1.0, &["meter", "meters", "metre"]),
        unit("cm", Length, 1e-2, &[]),
        unit("mm", Length, 1e-3, &["millimeter", "millimeters"]),
        unit(
            "um",
            Length,
            1e-6,
            &["µm", "μm", "micron", "microns", "micrometer", "micrometers", "mikrometer"],
        ),
        unit("nm", Length, 1e-9, &["nanometer", "nanometers"]),
        unit("in", Length, INCH_METRE, &["inch", "inches"]),
        unit("ft", Length, 12.0 * INCH_METRE, &[]),
        unit("m_per_s", Velocity, 1.0, &["m/s"]),
        unit("mm_per_s", Velocity, 1e-3, &["mm/s"]),
        unit("in_per_s", Velocity, INCH_METRE, &["in/s"]),
        unit("N", Force, 1.0, &["newton"]),
        unit("mN", Force, 1e-3, &[]),
        unit("kN", Force, 1e3, &[]),
        unit("lb", Force, POUND_FORCE_NEWTON, &["lbf"]),
        unit("kip", Force, 1e3 * POUND_FORCE_NEWTON, &["kips"]),
        unit("kgf", Force, 9.806_65, &[]),
        unit("A_per_m", MagneticField, 1.0, &["A/m"]),
        unit("kA_per_m", MagneticField, 1e3, &["kA/m"]),
        unit("Oe", MagneticField, 1e-4 / MU0, &["oersted"]),
        unit("G", MagneticField, 1e-4 / MU0, &["gauss"]),
        unit("T", MagneticField, 1.0 / MU0, &["tesla"]),
        unit("mT", MagneticField, 1e-3 / MU0, &[]),
        unit("A_m2", MagneticMoment, 1.0, &["Am2", "A m^2", "A*m^2", "Am^2", "A m2"]),
        unit("emu", MagneticMoment, 1e-3, &[]),
        unit("memu", MagneticMoment, 1e-6, &[]),
        unit("uemu", MagneticMoment, 1e-9, &["µemu"]),
        unit("rad", Angle, 1.0, &[]),
        unit("deg", Angle, std::f64::consts::PI / 180.0, &["°", "degree", "degrees"]),
        unit("mrad", Angle, 1e-3, &[]),
        unit("C", Temperature, 1.0, &["degC", "°C"]),
        unit("K", Temperature, 1.0, &[]),
        unit("ratio", Number, 1.0, &["1", "-"]),
        unit("percent", Number, 1e-2, &["%"]),
    ]
};

impl Unit {
    /// The unit of that name, in any known spelling; case matters (`mN` is no `MN`) except in words (`Volts`).
    pub fn find(text: &str) -> Option<Self> {
        let exact = UNITS.into_iter().find(|u| u.symbol == text || u.spellings.contains(&text));
        let is_word = text.len() > 2 && text.chars().all(char::is_alphabetic);
        let word = || text.to_lowercase();
        exact.or_else(|| UNITS.into_iter().find(|u| is_word && u.spellings.contains(&&*word())))
    }

    /// The number by which a value in this unit is multiplied to be in another one; none if they
    /// measure different things, or if a shift is needed too (temperatures).
    pub fn factor_to(self, other: Self) -> Option<f64> {
        if self.dimension != other.dimension {
            return None;
        }
        if self.symbol == other.symbol {
            return Some(1.0);
        }
        // 1e-3/1e-6 is not quite 1000: the short decimal within rounding is the one meant
        let exact = self.to_si / other.to_si;
        let short = significant(exact, 14);
        let factor = if (short / exact - 1.0).abs() <= 4.0 * f64::EPSILON { short } else { exact };
        (self.dimension != Dimension::Temperature).then_some(factor)
    }
}

/// The fault of a column that has no unit, or one that is not known.
pub(crate) fn unknown_unit(column: &str) -> Fault {
    Fault::Other(format!(
        "the column `{column}` has no known unit; name it `NAME_UNIT` with a unit of: {}",
        UNITS.map(|unit| unit.symbol).join(", ")
    ))
}

/// Whether the letter of a unit, over another unit, is the symbol of a quantity: `s / mm` is a path, `T / K` a temperature.
fn is_symbol(letter: Unit, over: Unit) -> bool {
    use Dimension::{Length, MagneticField, Temperature, Time};
    matches!((letter.dimension, over.dimension), (Time, Length) | (MagneticField, Temperature))
}

/// The text inside brackets.
pub(super) fn strip_brackets(text: &str) -> &str {
    text.trim_matches(['(', ')', '[', ']']).trim()
}

/// A measured quantity with its unit: a column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Channel {
    /// Name without unit, such as `displacement`.
    pub name: String,
    /// Unit.
    pub unit: Unit,
}

impl Channel {
    /// Name with unit, the header the program writes: `displacement_um`.
    pub fn label(&self) -> String {
        format!("{}_{}", self.name, self.unit.symbol)
    }

    /// Reads `name_unit`, `name [unit]`, `name (unit)`, `name / unit`, `name in unit` or `name, unit`.
    ///
    /// None if there is no unit or an unknown one.
    pub fn parse(text: &str) -> Option<Self> {
        let text = text.trim();
        let behind = |at: usize, length: usize| {
            Some((text[..at].trim(), Unit::find(text[at + length..].trim())?))
        };
        // the quotient of the standards: `t / s`, `v / m/s`, `s / mm`; `speed m/s` is none
        let quotient = || {
            let at = text.find(" / ").map(|at| at + 1).or_else(|| text.rfind('/'))?;
            let last = text[..at].split_whitespace().last()?;
            behind(at, 1)
                .filter(|(_, unit)| Unit::find(last).is_none_or(|own| is_symbol(own, *unit)))
        };
        let (name, unit) = match text.rfind(['[', '(']) {
            Some(open) => (text[..open].trim(), Unit::find(strip_brackets(&text[open..]))?),
            // the longest ending that is a unit: field_A_per_m
            None => text
                .match_indices('_')
                .find_map(|(at, _)| Some((&text[..at], Unit::find(&text[at + 1..])?)))
                .or_else(|| behind(text.rfind(" in ")?, 4))
                .or_else(|| behind(text.rfind(',')?, 1))
                .or_else(quotient)?,
        };
        let name = Self::plain_name(name);
        (!name.is_empty()).then_some(Self { name, unit })
    }

    /// A name that can stand in a header: lower case, blanks as `_`, nothing else than letters,
    /// digits and `_`.
    pub fn plain_name(text: &str) -> String {
        let plain: String = text
            .trim()
            .to_lowercase()
            .chars()
            .map(|c| if c.is_alphanumeric() { c } else { '_' })
            .collect();
        plain.trim_matches('_').to_owned()
    }

    /// Whether this is the time.
    pub fn is_time(&self) -> bool {
        self.unit.dimension == Dimension::Time && matches!(self.name.as_str(), "time" | "t")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factor(from: &str, to: &str) -> f64 {
        Unit::find(from).unwrap().factor_to(Unit::find(to).unwrap()).unwrap()
    }

    #[test]
    fn factors_of_the_definitions() {
        for (from, to, expected) in [
            ("mV", "V", 1e-3),
            ("mm", "um", 1e3),
            ("in", "mm", 25.4),
            ("kip", "lb", 1000.0),
            ("lbf", "N", 4.448_221_615_260_5),
            ("Oe", "A_per_m", 79.577_471_545_947_67),
            ("G", "Oe", 1.0),
            ("T", "Oe", 1e4),
            ("emu", "A_m2", 1e-3),
            ("ms", "s", 1e-3),
            ("percent", "ratio", 0.01),
        ] {
            let found = factor(from, to);
            assert!((found / expected - 1.0).abs() < 1e-14, "{from} to {to}: {found}");
        }
        assert_eq!(factor("mV", "V").to_bits(), 1e-3_f64.to_bits(), "exact decimals stay exact");
        assert_eq!(Unit::find("in").unwrap().factor_to(Unit::find("kip").unwrap()), None);
        assert_eq!(Unit::find("K").unwrap().factor_to(Unit::find("C").unwrap()), None);
        assert_eq!(Unit::find("furlong"), None);
    }

    #[test]
    fn names_of_columns() {
        let label = |text: &str| Channel::parse(text).map(|c| c.label());
        for (text, expected) in [
            ("time_s", Some("time_s")),
            ("friction_force_kip", Some("friction_force_kip")),
            ("field_A_per_m", Some("field_A_per_m")),
            ("Displacement [µm]", Some("displacement_um")),
            ("actuator force 1 (lb)", Some("actuator_force_1_lb")),
            ("t / s", Some("t_s")),
            ("s / mm", Some("s_mm")),
            ("s/mm", Some("s_mm")),
            ("T / °C", Some("t_C")),
            ("m / s", None),
            ("N / mm", None),
            ("v / m/s", Some("v_m_per_s")),
            ("Weg in mm", Some("weg_mm")),
            ("Time, s", Some("time_s")),
            ("amplifier (ch 1) [Volts]", Some("amplifier__ch_1_V")),
            ("speed m/s", None),
            ("displacement", None),
            ("displacement_furlong", None),
            ("_s", None),
            ("", None),
        ] {
            assert_eq!(label(text).as_deref(), expected, "{text}");
        }
        assert!(Channel::parse("t_ms").unwrap().is_time());
    }

    #[test]
    fn every_symbol_is_its_own() {
        for (i, unit) in UNITS.iter().enumerate() {
            assert_eq!(UNITS.iter().position(|u| u.symbol == unit.symbol), Some(i));
            assert_eq!(Unit::find(unit.symbol).unwrap(), *unit);
            assert!(unit.spellings.iter().all(|s| Unit::find(s) == Some(*unit)), "{}", unit.symbol);
        }
    }
}

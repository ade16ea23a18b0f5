//! What a sweep measured.

use crate::error::RotorGapError;
use crate::rotor::columns::{Column, Load, PartOf, Reading, Setting};
use measured_data::{PointColumn, PointData, Scatter};
use model_gap::points::{Channel, channels_of};
use rotor_base::Harmonic;
use rotor_case::{Case, TrimValues};

/// Points of test of a rotor.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// The points.
    pub points: Vec<SweepPoint>,
    /// The channels read.
    pub channels: Vec<SweepChannel>,
    /// Names of the columns that set conditions, but for drives, and their values by point.
    pub conditions: Vec<(String, Vec<f64>)>,
}

/// A channel with its readings, by point.
#[derive(Debug, Clone, PartialEq)]
pub struct SweepChannel {
    /// Name of its column.
    pub name: String,
    /// What it reads.
    pub reading: Reading,
    /// The readings.
    pub values: Vec<Option<f64>>,
    /// How sure they are.
    pub scatter: Scatter,
}

/// The channels for the engine, and the names of their instruments. Airloads of a section are integrals of the same pressures,
/// motions of the tip are read by the same targets: all their harmonics have one gain.
pub(super) fn instrumented(channels: &[SweepChannel]) -> (Vec<Channel>, Vec<String>) {
    let names: Vec<&str> = channels.iter().map(|own| own.name.as_str()).collect();
    let (mut named, of_harmonics) = channels_of(&names);
    let mut instruments: Vec<String> = Vec::new();
    for (own, channel) in named.iter_mut().zip(channels) {
        let what = channel.name.rsplit_once("_n").map_or("", |own| own.0);
        let name = match channel.reading {
            Reading::Harmonic { of: Load::Airload { .. }, .. } => {
                format!("airloads{}", what.trim_start_matches("cn_m2").trim_start_matches("cm_m2"))
            }
            Reading::Harmonic { of: Load::TipTwistDeg | Load::TipFlap, .. } => what.to_owned(),
            _ => of_harmonics[own.instrument].clone(),
        };
        let known = instruments.iter().position(|own| *own == name);
        own.instrument = known.unwrap_or_else(|| {
            instruments.push(name);
            instruments.len() - 1
        });
    }
    (named, instruments)
}

/// One point of test.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SweepPoint {
    /// Name.
    pub id: String,
    /// Number of its sweep.
    pub group: usize,
    /// Whether what is looked for does not act there.
    pub is_reference: bool,
    /// Advance ratio.
    pub advance_ratio: f64,
    /// Thrust over solidity, with stated density and rotor speed.
    pub ct_sigma: Option<f64>,
    /// Thrust, N.
    pub thrust_newton: Option<f64>,
    /// Shaft tilt, deg.
    pub shaft_tilt_deg: Option<f64>,
    /// Rotor speed, rpm.
    pub omega_rpm: Option<f64>,
    /// Air density, kg/m^3.
    pub air_density: Option<f64>,
    /// Pitch controls that were set, deg; of a trim that finds them none.
    pub controls_deg: Option<[f64; 3]>,
    /// Harmonics of pitch at the root, deg.
    pub root_pitch_deg: Vec<(usize, Harmonic)>,
    /// Harmonics of voltage of every flap, V.
    pub flaps_volt: Vec<Vec<(usize, Harmonic)>>,
}

/// A point that cannot be flown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Aside {
    /// The point.
    pub point: String,
    /// Why.
    pub reason: String,
}

/// What is said of points set aside.
pub(crate) const ASIDE: &str = "set aside, no trim was found";

impl SweepPoint {
    /// Whether a flap is driven.
    pub fn is_driven(&self) -> bool {
        self.flaps_volt.iter().flatten().any(|(_, own)| own.cosine != 0.0 || own.sine != 0.0)
    }

    /// Whether another point has the same condition, its drives aside.
    pub(crate) fn is_trimmed_as(&self, other: &Self) -> bool {
        let condition = |own: &Self| Self {
            id: String::new(),
            group: 0,
            is_reference: false,
            flaps_volt: Vec::new(),
            ..own.clone()
        };
        condition(self) == condition(other)
    }
}

impl Sweep {
    /// What the columns of a table say of the rotor of a case.
    ///
    /// # Errors
    /// [`RotorGapError::Column`]: a name that is not known, a flap that the case does not have, a condition that its trim
    /// finds, a blank condition, no advance ratio, no thrust where the trim asks for one, no reading.
    pub fn of(data: &PointData, case: &Case) -> Result<Self, RotorGapError> {
        let refused = |name: &str, reason: String| {
            Err(RotorGapError::Column { name: name.to_owned(), reason })
        };
        let mut points: Vec<SweepPoint> = data
            .ids
            .iter()
            .zip(data.groups.iter().zip(&data.references))
            .map(|(id, (group, is_reference))| SweepPoint {
                id: id.clone(),
                group: *group,
                is_reference: *is_reference,
                flaps_volt: vec![Vec::new(); case.flaps.len()],
                ..SweepPoint::default()
            })
            .collect();
        let is_prescribed = matches!(case.trim, TrimValues::Prescribed(_));
        let (mut channels, mut conditions) = (Vec::new(), Vec::new());
        for own in &data.columns {
            let name = &own.name;
            let column = Column::parse(name)
                .map_err(|reason| RotorGapError::Column { name: name.clone(), reason })?;
            match column {
                Column::Reads(Reading::ControlDeg(control)) if is_prescribed => {
                    for (point, value) in points.iter_mut().zip(full(own)?) {
                        point.controls_deg.get_or_insert_with(|| prescribed(case))[control] = value;
                    }
                }
                Column::Reads(reading) => {
                    let (name, values) = (name.clone(), own.values.clone());
                    channels.push(SweepChannel {
                        name,
                        reading,
                        values,
                        scatter: own.scatter.clone(),
                    });
                }
                Column::Sets(setting) => {
                    if setting == Setting::ShaftTiltDeg
                        && matches!(case.trim, TrimValues::Propulsive(_))
                    {
                        let reason = "the case is trimmed `Propulsive`, which finds it; trim it `WindTunnel`";
                        return refused(name, reason.to_owned());
                    }
                    let flap = if let Setting::FlapVolt { flap, .. } = setting { flap } else { 0 };
                    if flap > 0 && flap >= case.flaps.len() {
                        return refused(name, format!("the case has {} flaps", case.flaps.len()));
                    }
                    let values = full(own)?;
                    for (point, value) in points.iter_mut().zip(&values) {
                        point.set(setting, *value);
                    }
                    if !matches!(setting, Setting::FlapVolt { .. } | Setting::RootPitchDeg { .. }) {
                        conditions.push((name.clone(), values));
                    }
                }
            }
        }
        let has = |name: &str| data.columns.iter().any(|own| own.name == name);
        if !has("advance_ratio") {
            return refused("advance_ratio", "it is missing: every point has one".to_owned());
        }
        if channels.is_empty() {
            let reason = "no column was read: give hub loads, controls or power".to_owned();
            return refused("fz_n4_cos_N", reason);
        }
        Ok(Self { points, channels, conditions })
    }
}

/// The controls of a case that prescribes them, deg.
fn prescribed(case: &Case) -> [f64; 3] {
    match &case.trim {
        TrimValues::Prescribed(own) => [own.theta0_deg, own.theta1c_deg, own.theta1s_deg],
        _ => [0.0; 3],
    }
}

/// The values of a column without blank cells.
fn full(own: &PointColumn) -> Result<Vec<f64>, RotorGapError> {
    let value = |(row, value): (usize, &Option<f64>)| {
        value.ok_or_else(|| RotorGapError::Column {
            name: own.name.clone(),
            reason: format!("row {} is blank: a condition has a value at every point", row + 1),
        })
    };
    own.values.iter().enumerate().map(value).collect()
}

/// Sets a part of one of a list of harmonics.
fn set_part(list: &mut Vec<(usize, Harmonic)>, harmonic: usize, part: PartOf, value: f64) {
    let place = list.iter().position(|own| own.0 == harmonic).unwrap_or_else(|| {
        list.push((harmonic, Harmonic { cosine: 0.0, sine: 0.0 }));
        list.len() - 1
    });
    match part {
        PartOf::Sine => list[place].1.sine = value,
        PartOf::Cosine | PartOf::Mean => list[place].1.cosine = value,
    }
}

impl SweepPoint {
    fn set(&mut self, setting: Setting, value: f64) {
        match setting {
            Setting::AdvanceRatio => self.advance_ratio = value,
            Setting::CtSigma => self.ct_sigma = Some(value),
            Setting::ThrustNewton => self.thrust_newton = Some(value),
            Setting::ShaftTiltDeg => self.shaft_tilt_deg = Some(value),
            Setting::OmegaRpm => self.omega_rpm = Some(value),
            Setting::AirDensity => self.air_density = Some(value),
            Setting::FlapVolt { flap, harmonic, part } => {
                set_part(&mut self.flaps_volt[flap], harmonic, part, value);
            }
            Setting::RootPitchDeg { harmonic, part } => {
                set_part(&mut self.root_pitch_deg, harmonic, part, value);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn airloads_of_a_section_have_one_gain_and_hub_loads_one_for_each_harmonic() {
        let of = |name: &&str| {
            let Ok(Column::Reads(reading)) = Column::parse(name) else { panic!("{name}") };
            let (values, scatter) = (vec![], Scatter::Unknown);
            SweepChannel { name: (*name).to_owned(), reading, values, scatter }
        };
        let names = [
            "cn_m2_r0p87_n0",
            "cn_m2_r0p87_n1_cos",
            "cn_m2_r0p87_n1_sin",
            "cm_m2_r0p87_n2_cos",
            "cn_m2_r0p6_n1_cos",
            "tip_twist_n0_deg",
            "tip_twist_n2_sin_deg",
            "fz_n4_cos_N",
            "fz_n4_sin_N",
            "fz_n3_sin_N",
        ];
        let channels: Vec<SweepChannel> = names.iter().map(of).collect();
        let (named, instruments) = instrumented(&channels);
        let read_by: Vec<usize> = named.iter().map(|own| own.instrument).collect();
        assert_eq!(read_by, [0, 0, 0, 0, 1, 2, 2, 3, 3, 4]);
        let expected = ["airloads_r0p87", "airloads_r0p6", "tip_twist", "fz_n4_N", "fz_n3_sin_N"];
        assert_eq!(instruments, expected);
    }
}

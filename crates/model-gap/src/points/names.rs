//! What the name of a channel says: unit, instrument, part of a harmonic.

use super::table::{Channel, Part};

/// Units that a name may end in, with how they are shown.
const UNITS: [(&str, &str); 20] = [
    ("N", "N"),
    ("Nm", "N m"),
    ("W", "W"),
    ("V", "V"),
    ("A", "A"),
    ("C", "C"),
    ("deg", "deg"),
    ("rad", "rad"),
    ("Hz", "Hz"),
    ("hz", "Hz"),
    ("rpm", "rpm"),
    ("m", "m"),
    ("mm", "mm"),
    ("um", "um"),
    ("s", "s"),
    ("ms", "ms"),
    ("Pa", "Pa"),
    ("g", "g"),
    ("r", "R"),
    ("percent", "%"),
];
/// What the two of a harmonic are called: cosine and sine, or real and imaginary part.
const PAIRS: [[&str; 2]; 2] = [["_cos", "_sin"], ["_re", "_im"]];

/// A text as one that lives as long as the program: what names of suspects must.
pub fn lasting(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}

/// Channels of column names, and the names of their instruments.
///
/// `fz_n4_cos_N` and `fz_n4_sin_N` are cosine and sine of one harmonic in N, read by one instrument, `fz_n4_N`. A name
/// without such a partner is a value by itself with an instrument of its own; one that ends in no known unit is a number.
pub fn channels_of(names: &[&str]) -> (Vec<Channel>, Vec<String>) {
    let mut instruments: Vec<String> = Vec::new();
    let mut instrument = |name: String| {
        instruments.iter().position(|own| *own == name).unwrap_or_else(|| {
            instruments.push(name);
            instruments.len() - 1
        })
    };
    let place = |wanted: &str| names.iter().position(|name| *name == wanted);
    let channel = |name: &&str| {
        let last = name.rsplit('_').next().unwrap_or_default();
        let unit = UNITS.iter().find(|(own, _)| *own == last).map_or("1", |(_, shown)| *shown);
        let in_pair = PAIRS.iter().find_map(|[first, second]| {
            if name.contains(first) {
                let sine = place(&name.replacen(first, second, 1))?;
                return Some((Part::CosineOf(sine), name.replacen(first, "", 1)));
            }
            let cosine =
                place(&name.replacen(second, first, 1)).filter(|_| name.contains(second))?;
            Some((Part::SineOf(cosine), name.replacen(second, "", 1)))
        });
        let (part, of) = in_pair.unwrap_or_else(|| (Part::Scalar, (*name).to_owned()));
        Channel {
            name: (*name).to_owned(),
            unit: unit.to_owned(),
            instrument: instrument(of),
            part,
        }
    };
    let channels = names.iter().map(channel).collect();
    (channels, instruments)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_units_and_the_two_of_a_harmonic() {
        let (channels, instruments) =
            channels_of(&["fz_n4_cos_N", "theta0_deg", "fz_n4_sin_N", "mx_n3_cos_Nm", "ratio"]);
        assert_eq!(instruments, ["fz_n4_N", "theta0_deg", "mx_n3_cos_Nm", "ratio"]);
        assert_eq!(channels_of(&["cn_re", "cm_re", "cn_im"]).1, ["cn", "cm_re"]);
        let of = |c: usize| (channels[c].unit.as_str(), channels[c].instrument, channels[c].part);
        assert_eq!(of(0), ("N", 0, Part::CosineOf(2)));
        assert_eq!(of(2), ("N", 0, Part::SineOf(0)));
        assert_eq!(of(1), ("deg", 1, Part::Scalar));
        // without its sine it is a value by itself
        assert_eq!(of(3), ("N m", 2, Part::Scalar));
        assert_eq!(of(4), ("1", 3, Part::Scalar));
    }
}

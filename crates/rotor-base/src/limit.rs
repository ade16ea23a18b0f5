//! Limits that were looked for, as tables and files write them: the number, or a word where there is none.
//!
//! The functions beside [`Limit`] write and read fields of other types: a phase, deg, of which 180 is none, a gain, of which
//! infinity is none.

use serde::de::{Error as _, Unexpected};
use serde::ser::SerializeSeq;
use serde::{Deserialize, Deserializer, Serializer};

/// What stands in the place of a limit that there is not.
pub const UNBOUNDED: &str = "unbounded";

/// A limit that was looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// Where it is.
    At(f64),
    /// Nowhere up to the end of the search.
    Unbounded,
}

impl Limit {
    /// Of a phase, deg: 180 is the end of the search.
    pub fn of_phase(deg: f64) -> Self {
        if deg < 180.0 { Self::At(deg) } else { Self::Unbounded }
    }

    /// Of a gain or a condition: infinity for none.
    pub fn of_gain(gain: f64) -> Self {
        if gain.is_finite() { Self::At(gain) } else { Self::Unbounded }
    }

    /// Of an advance ratio up to which a T holds.
    pub fn of_reach(advance_ratio: Option<f64>) -> Self {
        advance_ratio.map_or(Self::Unbounded, Self::At)
    }

    /// Its place on an axis; no number where there is none.
    pub fn place(self) -> f64 {
        self.or(f64::NAN)
    }

    fn or(self, none: f64) -> f64 {
        match self {
            Self::At(value) => value,
            Self::Unbounded => none,
        }
    }

    /// With so many digits behind the point, for people.
    pub fn rounded(self, digits: usize) -> String {
        match self {
            Self::At(value) => format!("{value:.digits$}"),
            Self::Unbounded => UNBOUNDED.to_owned(),
        }
    }

    /// With every digit, for programs.
    pub fn exact(self) -> String {
        match self {
            Self::At(value) => value.to_string(),
            Self::Unbounded => UNBOUNDED.to_owned(),
        }
    }
}

impl serde::Serialize for Limit {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::At(value) => serializer.serialize_f64(*value),
            Self::Unbounded => serializer.serialize_str(UNBOUNDED),
        }
    }
}

fn list<S: Serializer>(
    limits: impl ExactSizeIterator<Item = Limit>,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    let mut list = serializer.serialize_seq(Some(limits.len()))?;
    for limit in limits {
        list.serialize_element(&limit)?;
    }
    list.end()
}

impl<'de> Deserialize<'de> for Limit {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged)]
        enum Written {
            Number(f64),
            Word(String),
        }
        match Written::deserialize(deserializer)? {
            Written::Number(value) => Ok(Self::At(value)),
            Written::Word(word) if word == UNBOUNDED => Ok(Self::Unbounded),
            Written::Word(word) => {
                let expected = "a number, or `unbounded`";
                Err(D::Error::invalid_value(Unexpected::Str(&word), &expected))
            }
        }
    }
}

/// Reads a phase, deg, that [`phase`] wrote: 180 for none.
///
/// # Errors
/// A word that is not [`UNBOUNDED`].
pub fn read_phase<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Limit::deserialize(deserializer).map(|limit| limit.or(180.0))
}

/// Reads the phases that [`phases`] wrote.
///
/// # Errors
/// As [`read_phase`].
pub fn read_phases<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let limits = Vec::<Limit>::deserialize(deserializer)?;
    Ok(limits.into_iter().map(|limit| limit.or(180.0)).collect())
}

/// Reads a gain that [`gain`] wrote: infinity for none, which was 0 once.
///
/// # Errors
/// As [`read_phase`].
pub fn read_gain<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    let found = Limit::deserialize(deserializer)?.or(f64::INFINITY);
    Ok(if found > 0.0 { found } else { f64::INFINITY })
}

/// Writes a phase, deg.
///
/// # Errors
/// Those of the serializer.
pub fn phase<S: Serializer>(deg: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&Limit::of_phase(*deg), serializer)
}

/// Writes a gain.
///
/// # Errors
/// Those of the serializer.
pub fn gain<S: Serializer>(gain: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&Limit::of_gain(*gain), serializer)
}

/// Writes phases, deg.
///
/// # Errors
/// Those of the serializer.
pub fn phases<S: Serializer>(deg: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    list(deg.iter().map(|deg| Limit::of_phase(*deg)), serializer)
}

/// Writes gains.
///
/// # Errors
/// Those of the serializer.
pub fn gains<S: Serializer>(gains: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    list(gains.iter().map(|gain| Limit::of_gain(*gain)), serializer)
}

/// Writes the ends of a range.
///
/// # Errors
/// Those of the serializer.
pub fn reach<S: Serializer>(ends: &[Option<f64>; 2], serializer: S) -> Result<S::Ok, S::Error> {
    list(ends.iter().map(|end| Limit::of_reach(*end)), serializer)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Debug, PartialEq, serde::Serialize, Deserialize)]
    struct Margins {
        #[serde(serialize_with = "phase", deserialize_with = "read_phase")]
        phase_deg: f64,
        #[serde(serialize_with = "phases", deserialize_with = "read_phases")]
        phases_deg: Vec<f64>,
        #[serde(serialize_with = "gain", deserialize_with = "read_gain")]
        gain: f64,
    }

    /// What has no limit is a word, and read as none again; what was written before words is read too.
    #[test]
    fn a_limit_that_there_is_not_is_a_word_and_read_as_none() {
        let none = Margins { phase_deg: 180.0, phases_deg: vec![20.0, 180.0], gain: f64::INFINITY };
        let text = serde_json::to_string(&none).unwrap();
        let word =
            r#"{"phase_deg":"unbounded","phases_deg":[20.0,"unbounded"],"gain":"unbounded"}"#;
        assert_eq!(text, word);
        assert_eq!(serde_json::from_str::<Margins>(&text).unwrap(), none);
        let before = r#"{"phase_deg":180,"phases_deg":[20,180],"gain":0}"#;
        assert_eq!(serde_json::from_str::<Margins>(before).unwrap(), none);
        let found = Margins { phase_deg: 75.5, phases_deg: vec![0.0], gain: 4.0 };
        let text = serde_json::to_string(&found).unwrap();
        assert_eq!(serde_json::from_str::<Margins>(&text).unwrap(), found);
        let wrong = serde_json::from_str::<Margins>(&text.replace("75.5", "\"none\""));
        assert!(wrong.unwrap_err().to_string().contains("`unbounded`"));
    }
}

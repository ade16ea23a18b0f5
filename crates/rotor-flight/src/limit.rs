//! Limits that were looked for, as tables and files write them: the number, or a word where there is none.

use rotor_study::UNBOUNDED;
use serde::Serializer;
use serde::ser::SerializeSeq;

/// A limit that was looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Limit {
    /// Where it is.
    At(f64),
    /// Nowhere up to the end of the search.
    Unbounded,
}

impl Limit {
    /// Of a phase, deg: 180 is the end of the search.
    pub(crate) fn of_phase(deg: f64) -> Self {
        if deg < 180.0 { Self::At(deg) } else { Self::Unbounded }
    }

    /// Of a gain or a condition: infinity for none.
    pub(crate) fn of_gain(gain: f64) -> Self {
        if gain.is_finite() { Self::At(gain) } else { Self::Unbounded }
    }

    /// Of an advance ratio up to which a T holds.
    pub(crate) fn of_reach(advance_ratio: Option<f64>) -> Self {
        advance_ratio.map_or(Self::Unbounded, Self::At)
    }

    /// Its place on an axis; no number where there is none.
    pub(crate) fn place(self) -> f64 {
        match self {
            Self::At(value) => value,
            Self::Unbounded => f64::NAN,
        }
    }

    /// With so many digits behind the point, for people.
    pub(crate) fn rounded(self, digits: usize) -> String {
        match self {
            Self::At(value) => format!("{value:.digits$}"),
            Self::Unbounded => UNBOUNDED.to_owned(),
        }
    }

    /// With every digit, for programs.
    pub(crate) fn exact(self) -> String {
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

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature is that of serde")]
pub(crate) fn phase<S: Serializer>(deg: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&Limit::of_phase(*deg), serializer)
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the signature is that of serde")]
pub(crate) fn gain<S: Serializer>(gain: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    serde::Serialize::serialize(&Limit::of_gain(*gain), serializer)
}

pub(crate) fn phases<S: Serializer>(deg: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    list(deg.iter().map(|deg| Limit::of_phase(*deg)), serializer)
}

pub(crate) fn gains<S: Serializer>(gains: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
    list(gains.iter().map(|gain| Limit::of_gain(*gain)), serializer)
}

pub(crate) fn reach<S: Serializer>(
    ends: &[Option<f64>; 2],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    list(ends.iter().map(|end| Limit::of_reach(*end)), serializer)
}

//! What a sweep case is reduced to: named channels with unit and tolerance, kept as RON.

use serde::{Deserialize, Serialize};

/// Share of its own magnitude by which every channel must be able to move unseen at most: a change of
/// 1 % of any channel is always a difference.
pub const GUARDED_CHANGE: f64 = 0.01;

/// How much a channel may move.
///
/// ```text
/// |new - old| <= absolute + relative |old|        (scaled)
/// new = old                                       (exact)
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Tolerance {
    /// A computed quantity.
    Scaled {
        /// Share of the golden value.
        relative: f64,
        /// Floor for values near zero, in the unit of the channel.
        absolute: f64,
    },
    /// A count: a solver that suddenly needs other steps is a regression.
    Exact,
}

impl Tolerance {
    /// Largest change that passes for a golden value, in its unit.
    pub fn allowed(&self, golden: f64) -> f64 {
        match self {
            Self::Scaled { relative, absolute } => absolute + relative * golden.abs(),
            Self::Exact => 0.0,
        }
    }

    /// Whether a change of [`GUARDED_CHANGE`] of this value would go unseen. Zero has no share of
    /// itself to lose.
    pub fn is_blind_to(&self, golden: f64) -> bool {
        golden != 0.0 && self.allowed(golden) >= 0.99 * GUARDED_CHANGE * golden.abs()
    }
}

/// Channels of one kind.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// What the channels are.
    pub name: String,
    /// Their unit.
    pub unit: String,
    /// How much each may move.
    pub tolerance: Tolerance,
    /// Names, unique within the group, and values.
    pub channels: Vec<(String, f64)>,
}

/// All channels of one case.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Snapshot {
    /// Advance ratio of the case.
    pub advance_ratio: f64,
    /// Harmonic of the control, per rev.
    pub harmonic_per_rev: u32,
    /// The channels.
    pub groups: Vec<Group>,
}

impl Snapshot {
    /// Every channel with its group.
    pub fn channels(&self) -> impl Iterator<Item = (&Group, &str, f64)> {
        self.groups.iter().flat_map(|group| {
            group.channels.iter().map(move |(name, value)| (group, name.as_str(), *value))
        })
    }

    /// The snapshot as the text of a golden file.
    ///
    /// # Errors
    /// What RON cannot write.
    pub fn to_ron(&self) -> Result<String, ron::Error> {
        let pretty = ron::ser::PrettyConfig::new().compact_arrays(false).depth_limit(4);
        let text = ron::ser::to_string_pretty(self, pretty)?;
        Ok(format!("{HEADER}{text}\n"))
    }

    /// The snapshot a golden file holds.
    ///
    /// # Errors
    /// The place (line and column) where the text is no snapshot.
    pub fn from_ron(text: &str) -> Result<Self, ron::error::SpannedError> {
        ron::from_str(text)
    }
}

const HEADER: &str = "\
// Golden values, written by `cargo xtask regress --bless`; explain every change of them under
// \"Numbers changed\" in CHANGELOG.md. Compared as |new - old| <= absolute + relative |old|.
";

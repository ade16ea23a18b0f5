//! Comparison of a golden with what was computed now.

use std::collections::BTreeMap;
use std::fmt;

use super::snapshot::{Group, Snapshot, Tolerance};

/// Something that is not as the golden has it.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Difference {
    /// A channel moved by more than it may.
    Moved {
        /// `group: channel`.
        channel: String,
        /// Unit of the values.
        unit: String,
        /// Golden value.
        golden: f64,
        /// Value now.
        now: f64,
        /// Largest change that would pass.
        allowed: f64,
    },
    /// A value is no finite number.
    NotFinite {
        /// `group: channel`.
        channel: String,
        /// Golden value.
        golden: f64,
        /// Value now.
        now: f64,
    },
    /// The golden has a channel that is not computed any more.
    Gone {
        /// `group: channel`.
        channel: String,
    },
    /// A channel is computed that the golden does not have.
    New {
        /// `group: channel`.
        channel: String,
    },
    /// A channel stands twice in the golden, so that one of its values is compared with nothing.
    Twice {
        /// `group: channel`.
        channel: String,
    },
    /// Tolerance, unit or case in the golden are not the program's.
    Label {
        /// What it is.
        what: String,
        /// As the golden has it.
        golden: String,
        /// As the program has it.
        now: String,
    },
    /// The floor of the tolerance hides a change of 1 % of this channel: no golden may hold it.
    Blind {
        /// `group: channel`.
        channel: String,
        /// The value.
        value: f64,
        /// Largest change that would pass.
        allowed: f64,
    },
    /// There is no golden.
    NoGolden,
    /// The golden cannot be read.
    Unreadable {
        /// What is wrong, and where.
        message: String,
    },
    /// A golden that belongs to no case of the sweep.
    Orphan,
}

/// Key of a channel: its group's name and its own.
type Key<'a> = (&'a str, &'a str);

/// All differences between a golden and what was computed now, in the golden's order.
///
/// The tolerance is the program's; a golden that states another one differs.
pub fn compare(golden: &Snapshot, now: &Snapshot) -> Vec<Difference> {
    let mut differences = labels(golden, now);
    let current: BTreeMap<Key, (&Group, f64)> = now
        .channels()
        .map(|(group, name, value)| ((group.name.as_str(), name), (group, value)))
        .collect();
    let mut seen: BTreeMap<Key, usize> = BTreeMap::new();
    for (group, name, old) in golden.channels() {
        let channel = format!("{}: {name}", group.name);
        let count = seen.entry((group.name.as_str(), name)).or_default();
        *count += 1;
        if *count == 2 {
            differences.push(Difference::Twice { channel: channel.clone() });
        }
        match current.get(&(group.name.as_str(), name)) {
            None => differences.push(Difference::Gone { channel }),
            Some((group, new)) => differences.extend(moved(channel, group, old, *new)),
        }
    }
    for (group, name, _) in now.channels() {
        if !seen.contains_key(&(group.name.as_str(), name)) {
            differences.push(Difference::New { channel: format!("{}: {name}", group.name) });
        }
    }
    differences
}

/// What keeps a snapshot from becoming a golden: values that are no numbers, and values so small that
/// the floor of their tolerance would hide a change of 1 %.
pub fn unfit_for_a_golden(now: &Snapshot) -> Vec<Difference> {
    now.channels()
        .filter_map(|(group, name, value)| {
            let channel = format!("{}: {name}", group.name);
            if !value.is_finite() {
                return Some(Difference::NotFinite { channel, golden: value, now: value });
            }
            let allowed = group.tolerance.allowed(value);
            let blind = group.tolerance.is_blind_to(value);
            blind.then_some(Difference::Blind { channel, value, allowed })
        })
        .collect()
}

fn moved(channel: String, group: &Group, golden: f64, now: f64) -> Option<Difference> {
    if !golden.is_finite() || !now.is_finite() {
        return Some(Difference::NotFinite { channel, golden, now });
    }
    let allowed = group.tolerance.allowed(golden);
    let unit = group.unit.clone();
    ((now - golden).abs() > allowed).then_some(Difference::Moved {
        channel,
        unit,
        golden,
        now,
        allowed,
    })
}

/// Differences of what surrounds the values.
fn labels(golden: &Snapshot, now: &Snapshot) -> Vec<Difference> {
    let label = |what: String, golden: String, now: String| {
        (golden != now).then_some(Difference::Label { what, golden, now })
    };
    let case = |s: &Snapshot| format!("mu={},n={}", s.advance_ratio, s.harmonic_per_rev);
    let mut differences: Vec<Difference> =
        label("case".to_owned(), case(golden), case(now)).into_iter().collect();
    for group in &golden.groups {
        let Some(current) = now.groups.iter().find(|g| g.name == group.name) else {
            continue;
        };
        let what = |label: &str| format!("{label} of {}", group.name);
        differences.extend(label(what("unit"), group.unit.clone(), current.unit.clone()));
        let (old, new) = (show_tolerance(group.tolerance), show_tolerance(current.tolerance));
        differences.extend(label(what("tolerance"), old, new));
    }
    differences
}

fn show_tolerance(tolerance: Tolerance) -> String {
    match tolerance {
        Tolerance::Exact => "exact".to_owned(),
        Tolerance::Scaled { relative, absolute } => format!("{relative} of value + {absolute:e}"),
    }
}

impl Difference {
    /// The line of the difference table: what, golden, now, change, allowed.
    pub fn cells(&self) -> [String; 5] {
        let number = |value: f64| format!("{value:.8e}");
        let none = String::new;
        match self {
            Self::Moved { channel, unit, golden, now, allowed } => {
                let change = if *golden == 0.0 {
                    format!("{:+.2e}", now - golden)
                } else {
                    format!("{:+.3} %", 100.0 * (now - golden) / golden.abs())
                };
                let allowed = if *golden == 0.0 || *allowed == 0.0 {
                    format!("{allowed:.1e}")
                } else {
                    format!("{:.3} %", 100.0 * allowed / golden.abs())
                };
                [format!("{channel} [{unit}]"), number(*golden), number(*now), change, allowed]
            }
            Self::NotFinite { channel, golden, now } => [
                channel.clone(),
                number(*golden),
                number(*now),
                "not a finite number".to_owned(),
                none(),
            ],
            Self::Gone { channel } => {
                [channel.clone(), none(), none(), "not computed any more".to_owned(), none()]
            }
            Self::New { channel } => {
                [channel.clone(), none(), none(), "not in the golden".to_owned(), none()]
            }
            Self::Twice { channel } => {
                [channel.clone(), none(), none(), "twice in the golden".to_owned(), none()]
            }
            Self::Label { what, golden, now } => {
                [what.clone(), golden.clone(), now.clone(), "changed".to_owned(), none()]
            }
            Self::Blind { channel, value, allowed } => [
                channel.clone(),
                none(),
                number(*value),
                "too small: a change of 1 % would pass".to_owned(),
                format!("{allowed:.1e}"),
            ],
            Self::NoGolden => [
                "golden file".to_owned(),
                none(),
                none(),
                "missing: check the result, then --bless".to_owned(),
                none(),
            ],
            Self::Unreadable { message } => {
                ["golden file".to_owned(), none(), none(), message.clone(), none()]
            }
            Self::Orphan => [
                "golden file".to_owned(),
                none(),
                none(),
                "belongs to no case of the sweep: delete it".to_owned(),
                none(),
            ],
        }
    }
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [what, golden, now, change, allowed] = self.cells();
        write!(f, "{what}: {change} (golden {golden}, now {now}, allowed {allowed})")
    }
}

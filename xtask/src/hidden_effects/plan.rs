//! Which sets the suite has.

use std::collections::BTreeMap;

use truth::hidden::{Assignment, BLOCK, Hidden};

/// A choice of sets.
#[derive(Debug, Clone, PartialEq)]
pub struct Selection {
    /// Sets of each cause at each noise level; ten of no effect, four pairs and four of unknown effects come with it.
    pub seeds: u64,
    /// Block of seeds that it begins with: blocks that bounds were set with are no test of them.
    pub first_block: u64,
    /// Noise levels, dB.
    pub snr_db: Vec<f64>,
    /// Only some: `null`, `pairs`, `outside`, or the id of what is hidden; all if empty.
    pub only: String,
}

/// Sets with one reference folder.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// The base.
    pub base: u64,
    /// Noise level, dB.
    pub snr_db: f64,
    /// Seeds, ascending.
    pub seeds: Vec<u64>,
}

impl Selection {
    fn admits(&self, hidden: Hidden) -> bool {
        match self.only.as_str() {
            "" => true,
            "pairs" => matches!(hidden, Hidden::Two(..)),
            "outside" => matches!(hidden, Hidden::Other(_)),
            only => hidden.id() == only,
        }
    }

    /// Whether a set with this hidden, at this noise level, belongs to it, whatever its block.
    pub fn admits_case(&self, hidden: &str, snr_db: f64) -> bool {
        let known = Hidden::parse(hidden).is_ok_and(|hidden| self.admits(hidden));
        known && self.snr_db.iter().any(|level| (level - snr_db).abs() < 1e-9)
    }
}

/// The groups of a selection, by noise level in the order given and by base.
pub fn groups(selection: &Selection) -> Vec<Group> {
    let mut by_base: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
    let first = selection.first_block * BLOCK;
    for seed in first..first + selection.seeds * BLOCK {
        let assignment = Assignment::of_seed(seed);
        if selection.admits(assignment.hidden) {
            by_base.entry(assignment.base).or_default().push(seed);
        }
    }
    let mut groups = Vec::new();
    for snr_db in &selection.snr_db {
        for (base, seeds) in &by_base {
            groups.push(Group { base: *base, snr_db: *snr_db, seeds: seeds.clone() });
        }
    }
    groups
}

#[cfg(test)]
mod tests {
    use super::*;

    fn selection(only: &str) -> Selection {
        let snr_db = vec![40.0, 30.0, 20.0];
        Selection { seeds: 10, first_block: 0, snr_db, only: only.to_owned() }
    }

    fn sets(only: &str) -> usize {
        groups(&selection(only)).iter().map(|group| group.seeds.len()).sum()
    }

    #[test]
    fn ten_seeds_make_the_suite_that_is_asked_for() {
        assert_eq!(sets("") as u64, 30 * BLOCK);
        assert_eq!(sets("null"), 300);
        assert_eq!(sets("creep"), 30);
        assert_eq!((sets("pairs"), sets("outside")), (120, 120));
        assert_eq!(sets("no such thing"), 0);
    }

    #[test]
    fn a_stored_set_is_admitted_by_kind_and_noise_and_not_by_block() {
        let pairs = selection("pairs");
        assert!(pairs.admits_case("creep+transport-delay", 30.0));
        assert!(!pairs.admits_case("creep+transport-delay", 25.0));
        assert!(!pairs.admits_case("creep", 30.0) && !pairs.admits_case("no such thing", 30.0));
        assert!(selection("").admits_case("null", 20.0));
    }

    #[test]
    fn another_block_has_other_seeds_and_as_many() {
        let later = Selection { seeds: 2, first_block: 3, ..selection("") };
        let seeds: Vec<u64> = groups(&later).into_iter().flat_map(|g| g.seeds).collect();
        assert_eq!(seeds.len() as u64, 2 * BLOCK * 3);
        assert!(seeds.iter().all(|seed| (3 * BLOCK..5 * BLOCK).contains(seed)), "{seeds:?}");
    }

    #[test]
    fn a_group_has_one_base() {
        for group in groups(&selection("")) {
            assert!(group.seeds.iter().all(|seed| Assignment::of_seed(*seed).base == group.base));
        }
    }
}

//! What several specimens of one kind have in common.

/// Explanations that several specimens share, each with something missing that any of them could be.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct InCommon<'a> {
    /// What all of those specimens leave open; the best first.
    pub explanations: Vec<&'a str>,
    /// The specimens, and which of their findings it is; both counted from 0.
    pub findings: Vec<(usize, usize)>,
}

/// What the specimens have in common, what most of them share first.
///
/// `open` holds, for each specimen and each thing found missing there, the explanations that its data leave open, the
/// best first. If one cause is at work in several specimens, it is open in all of them: what one of them excludes is
/// excluded for all. No evidence is added up, because the error of the base model is common to like specimens.
pub fn in_common<'a>(open: &[Vec<Vec<&'a str>>]) -> Vec<InCommon<'a>> {
    let mut left: Vec<(usize, usize)> =
        (0..open.len()).flat_map(|s| (0..open[s].len()).map(move |f| (s, f))).collect();
    left.retain(|&(s, f)| !open[s][f].is_empty());
    let mut all = Vec::new();
    while let Some(found) = most_shared(open, &left) {
        left.retain(|place| !found.findings.contains(place));
        all.push(found);
    }
    all
}

/// The explanation that most specimens share, among equals the one that stands first most often, with what is open
/// beside it in all of them.
fn most_shared<'a>(open: &[Vec<Vec<&'a str>>], left: &[(usize, usize)]) -> Option<InCommon<'a>> {
    let rank = |id: &str, (s, f): (usize, usize)| open[s][f].iter().position(|own| *own == id);
    // the finding of each specimen that the explanation could be best
    let places = |id: &str| {
        let mut places: Vec<(usize, usize)> =
            left.iter().copied().filter(|place| rank(id, *place).is_some()).collect();
        places.sort_by_key(|&place| (place.0, rank(id, place)));
        places.dedup_by_key(|place| place.0);
        places
    };
    let ranks = |id: &str, places: &[(usize, usize)]| -> usize {
        places.iter().filter_map(|place| rank(id, *place)).sum()
    };
    let ids = left.iter().flat_map(|&(s, f)| open[s][f].iter().copied());
    let first = ids.min_by_key(|id| {
        let places = places(id);
        (usize::MAX - places.len(), ranks(id, &places))
    })?;
    let findings = places(first);
    let shared = |id: &&str| findings.iter().all(|place| rank(id, *place).is_some());
    let (s, f) = findings[0];
    let mut explanations: Vec<&str> = open[s][f].iter().copied().filter(shared).collect();
    explanations.sort_by_key(|id| ranks(id, &findings));
    Some(InCommon { explanations, findings })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_one_specimen_excludes_is_excluded_for_all() {
        let open = vec![
            vec![vec!["backlash", "friction", "creep"]],
            vec![vec!["friction", "backlash"]],
            vec![vec!["backlash", "creep"]],
        ];
        let found = in_common(&open);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].explanations, ["backlash"]);
        assert_eq!(found[0].findings, [(0, 0), (1, 0), (2, 0)]);
        // two of them leave more open, best first over both
        assert_eq!(in_common(&open[..2])[0].explanations, ["backlash", "friction"]);
    }

    #[test]
    fn what_one_specimen_has_alone_is_told_apart() {
        let open = vec![
            vec![vec!["creep"], vec!["delay", "lag"]],
            vec![],
            vec![vec!["lag"]],
            vec![vec!["lag", "delay"]],
        ];
        let found = in_common(&open);
        assert_eq!(found.len(), 2);
        assert_eq!((&found[0].explanations[..], found[0].findings.len()), (&["lag"][..], 3));
        assert_eq!(found[0].findings[0], (0, 1));
        assert_eq!(
            (&found[1].explanations[..], &found[1].findings[..]),
            (&["creep"][..], &[(0, 0)][..])
        );
        assert!(in_common(&[vec![], vec![vec![]]]).is_empty());
    }
}

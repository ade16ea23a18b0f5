//! Ids of validation checks: unique, on the page, and nowhere without a check behind them.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::{Finding, Tree};

/// The page that `cargo xtask validate` writes.
const PAGE: &str = "docs/src/validation.md";

/// The member that lists the ids.
const LIST: &str = "tests/validation";

/// Rules for ids of validation checks, `V-AREA-NN`:
///
/// - no two rows share one;
/// - exactly one test states the row of an id;
/// - the page has a row for each id, and no row without;
/// - an id mentioned anywhere in a source or page is one of a row.
///
/// `known` are the ids of all rows.
pub fn validation_ids(tree: &Tree, known: &[&str]) -> Vec<Finding> {
    let mut findings = Vec::new();
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for id in known {
        *count.entry(id).or_default() += 1;
        if ids_in(id) != [*id] {
            findings.push(Finding::of_file(LIST, format!("id `{id}` is not V-AREA-NN")));
        }
    }
    for (id, _) in count.iter().filter(|(_, n)| **n > 1) {
        findings.push(Finding::of_file(LIST, format!("two rows share the id {id}")));
    }
    for file in &tree.texts {
        for (index, line) in file.text.lines().enumerate() {
            for id in ids_in(line).into_iter().filter(|id| !count.contains_key(*id)) {
                let fault = format!("{id} is the id of no validation row");
                findings.push(Finding::at_line(&file.path, index + 1, fault));
            }
        }
    }
    for id in count.keys() {
        let quoted = format!("\"{id}\"");
        let tests = tree.texts.iter().filter(|file| {
            Path::new(&file.path).extension().is_some_and(|kind| kind == "rs")
                && !file.path.starts_with(LIST)
                && file.text.contains(&quoted)
        });
        let tests: Vec<&str> = tests.map(|file| file.path.as_str()).collect();
        if tests.len() != 1 {
            let fault =
                format!("the row {id} is stated by {} tests: {}", tests.len(), tests.join(", "));
            findings.push(Finding::of_file(LIST, fault));
        }
    }
    if let Some(page) = tree.text(PAGE) {
        let rows: BTreeSet<&str> = page.lines().filter_map(row_id).collect();
        for id in count.keys().filter(|id| !rows.contains(**id)) {
            let fault = format!("has no row for {id}: run `cargo xtask validate`");
            findings.push(Finding::of_file(PAGE, fault));
        }
    }
    findings
}

/// The id in the first cell of a table row.
fn row_id(line: &str) -> Option<&str> {
    let cell = line.strip_prefix('|')?.split('|').next()?;
    ids_in(cell).first().copied()
}

/// All ids `V-AREA-NN` in a text, in order.
pub fn ids_in(text: &str) -> Vec<&str> {
    text.match_indices("V-").filter_map(|(at, _)| id_at(text, at)).collect()
}

fn id_at(text: &str, at: usize) -> Option<&str> {
    let word = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
    if text[..at].ends_with(word) {
        return None;
    }
    let rest = &text[at..];
    let id = &rest[..rest.find(|c| !word(c)).unwrap_or(rest.len())];
    let (area, number) = id.strip_prefix("V-")?.split_once('-')?;
    let sound = !area.is_empty()
        && area.chars().all(|c| c.is_ascii_uppercase())
        && number.len() == 2
        && number.chars().all(|c| c.is_ascii_digit());
    sound.then_some(id)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_found_as_whole_words() {
        // put together here, so that this file mentions no id itself
        let id = format!("V-{}-{}", "QQ", "07");
        assert_eq!(ids_in(&format!("Test: {id}.")), [id.as_str()]);
        assert_eq!(ids_in(&format!("| {id} | {id} |")).len(), 2);
        for no_id in ["V-AREA-NN", "V-q-01", "A V-", "EV-QQ-01-x"] {
            assert!(ids_in(no_id).is_empty(), "{no_id}");
        }
        assert!(ids_in(&format!("X{id}")).is_empty() && ids_in(&format!("{id}1")).is_empty());
    }
}

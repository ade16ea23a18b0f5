//! Rules for Rust sources.

use super::{Finding, TextFile, Tree};

/// Lines a source may have; past about 600 it usually holds two ideas.
pub const LINE_LIMIT: usize = 700;

/// Lines that an example stays below: one task of its user.
pub const EXAMPLE_LIMIT: usize = 80;

/// Sources that may be longer than [`LINE_LIMIT`], each with the reason.
pub const LONG_FILES: &[(&str, &str)] = &[];

/// Words that mark work left undone, with what is expected instead. Split so that this file does not
/// break its own rule.
const FORBIDDEN: [(&str, &str); 5] = [
    (concat!("to", "do!("), "finish it or leave it out"),
    (concat!("unimple", "mented!("), "finish it or leave it out"),
    (concat!("FIX", "ME"), "repair it, or state the limitation in the documentation"),
    (concat!("TO", "DO"), "do it, or state the limitation in the documentation"),
    (concat!("HA", "CK"), "say what the code does and why it must"),
];

/// Parts of the standard library that pure functions of values have no use for.
const OUTSIDE_WORLD: [&str; 5] = ["std::fs", "std::env", "std::net", "std::process", "std::time"];

/// The crates of the product that know files.
const KNOW_FILES: [&str; 3] = ["measured-data", "case-sweep", "sim-driver"];

/// Folders that exist on one machine only.
const MACHINE_FOLDERS: [&str; 4] =
    [concat!("/ho", "me/"), concat!("/t", "mp/"), concat!("/ro", "ot/"), concat!("/wo", "rk/")];

/// Rules for every Rust source:
///
/// - it starts with a `//!` line that says what it holds;
/// - it has at most [`LINE_LIMIT`] lines, or a line with a reason in [`LONG_FILES`];
/// - an example of a crate, in Python too, has less than [`EXAMPLE_LIMIT`] lines;
/// - tests do not expect panics without naming the message, nor are they ignored without reason;
/// - no word marks work left undone, no path belongs to one machine;
/// - no crate but `KNOW_FILES` knows files, environment, clock, processes or network.
pub fn rust(tree: &Tree) -> Vec<Finding> {
    let mut findings: Vec<Finding> = tree.ending_in(".rs").flat_map(source).collect();
    findings.extend(stale_exceptions(tree, LONG_FILES));
    findings.extend(tree.texts.iter().filter_map(long_example));
    findings.extend(tree.texts.iter().flat_map(machine_paths));
    findings
}

/// An example of a crate that is no single task any more.
fn long_example(file: &TextFile) -> Option<Finding> {
    let (_, inside) = file.path.strip_prefix("crates/")?.split_once('/')?;
    let name = inside.strip_prefix("examples/")?;
    let lines = file.text.lines().count();
    let is_program = [".rs", ".py"].iter().any(|ending| name.ends_with(ending));
    (is_program && lines >= EXAMPLE_LIMIT).then(|| {
        let fault = format!(
            "has {lines} lines, an example less than {EXAMPLE_LIMIT}: cut it down to one task of its user"
        );
        Finding::of_file(&file.path, fault)
    })
}

fn source(file: &TextFile) -> Vec<Finding> {
    let path = file.path.as_str();
    let mut findings = Vec::new();
    if !file.text.starts_with("//!") {
        findings
            .push(Finding::of_file(path, "starts without `//!`: say first what the file holds"));
    }
    let lines = file.text.lines().count();
    if lines > LINE_LIMIT && !LONG_FILES.iter().any(|(long, _)| *long == path) {
        findings.push(Finding::of_file(
            path,
            format!("has {lines} lines, at most {LINE_LIMIT} expected: split it by idea"),
        ));
    }
    let pure = file.shipped_by().is_some_and(|name| !KNOW_FILES.contains(&name));
    for (index, line) in file.text.lines().enumerate() {
        let mut fault = |fault: String| findings.push(Finding::at_line(path, index + 1, fault));
        let code = line.trim_start();
        if code.starts_with("#[should_panic") {
            fault("`should_panic` passes on any panic: match the error instead".to_owned());
        }
        if code.starts_with("#[ignore") && !code.starts_with("#[ignore = \"") {
            fault("an ignored test without reason: write #[ignore = \"why\"]".to_owned());
        }
        for (word, instead) in FORBIDDEN {
            if line.contains(word) {
                fault(format!("`{word}` marks work left undone: {instead}"));
            }
        }
        let commented = code.starts_with("//");
        for module in
            OUTSIDE_WORLD.iter().filter(|module| pure && !commented && line.contains(**module))
        {
            fault(format!("`{module}` in a crate without files: hand the function values instead"));
        }
    }
    findings
}

/// Paths that exist on one machine only.
fn machine_paths(file: &TextFile) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (index, line) in file.text.lines().enumerate() {
        for folder in MACHINE_FOLDERS {
            // a folder of that name inside a relative path is none of a machine
            let absolute = line.match_indices(folder).any(|(at, _)| {
                !line[..at].ends_with(|c: char| c.is_alphanumeric() || "._-/:}".contains(c))
            });
            if absolute {
                let fault =
                    format!("`{folder}` belongs to one machine: use a path inside the tree");
                findings.push(Finding::at_line(&file.path, index + 1, fault));
            }
        }
    }
    findings
}

/// Exceptions that have lost their file, or their reason to be.
fn stale_exceptions(tree: &Tree, exceptions: &[(&str, &str)]) -> Vec<Finding> {
    let stale = |path: &&str| tree.text(path).is_none_or(|text| text.lines().count() <= LINE_LIMIT);
    exceptions
        .iter()
        .map(|(path, _)| *path)
        .filter(stale)
        .map(|path| Finding::of_file(path, "needs no entry among the long files any more"))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_exception_must_be_needed() {
        let tree = Tree::of(&[("a.rs", "//! Short.\n")]);
        assert_eq!(stale_exceptions(&tree, &[("a.rs", "why"), ("gone.rs", "why")]).len(), 2);
        let long = "//! Long.\n".repeat(LINE_LIMIT + 1);
        let tree = Tree::of(&[("a.rs", &long)]);
        assert!(stale_exceptions(&tree, &[("a.rs", "why")]).is_empty());
    }
}

//! Rules for the manifests of the members.

use super::{Finding, Tree};

/// Rules for every member's `Cargo.toml`:
///
/// - versions are written once, in the root: a dependency says `workspace = true`;
/// - the workspace's lints apply;
/// - a member below `crates/` has a `README.md` beside it.
pub fn manifests(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for file in tree.ending_in("/Cargo.toml") {
        let path = file.path.as_str();
        let mut section = "";
        let mut linted = false;
        for (index, line) in file.text.lines().enumerate() {
            let line = line.trim();
            if line.starts_with('[') {
                section = line.trim_matches(['[', ']']);
            }
            linted |= section == "lints" && is_inherited(line);
            let entry = !line.is_empty() && !line.starts_with(['#', '[']);
            if section.ends_with("dependencies") && entry && !is_inherited(line) {
                let fault = format!(
                    "`{line}`: versions are written once, in the root Cargo.toml; write \
                     `name.workspace = true`"
                );
                findings.push(Finding::at_line(path, index + 1, fault));
            }
        }
        if !linted {
            let fault = "the lints of the workspace do not apply: add [lints] workspace = true";
            findings.push(Finding::of_file(path, fault));
        }
        let folder = path.trim_end_matches("/Cargo.toml");
        let readme = format!("{folder}/README.md");
        if folder.starts_with("crates/") && !tree.paths.contains(&readme) {
            let fault = "is missing: say what the crate models, what not, and show it in ten lines";
            findings.push(Finding::of_file(&readme, fault));
        }
    }
    findings
}

/// Whether a line takes its value from the workspace.
fn is_inherited(line: &str) -> bool {
    let squeezed: String = line.chars().filter(|c| !c.is_whitespace()).collect();
    squeezed.contains("workspace=true")
}

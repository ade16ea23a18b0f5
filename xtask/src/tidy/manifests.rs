//! Rules for the manifests of the members.

use super::{Finding, Tree};

/// Rules for every member's `Cargo.toml`:
///
/// - versions are written once, in the root: a dependency says `workspace = true`. A member of the tests that another member
///   needs when it runs stands with path and version: the root has none, so that packages leave it out of their tests;
/// - the workspace's lints apply;
/// - a library or program that is not built for unit tests, `test = false`, has none;
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
            if is_without_tests(line) {
                findings.extend(unit_tests(tree, path, section));
            }
            let with_path = section == "dependencies" && is_of_tests(path, line);
            if section.ends_with("dependencies") && entry && !is_inherited(line) && !with_path {
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

/// What panics on a mistake in a test, by its key in a profile.
const CHECKS: [&str; 2] = ["debug-assertions", "overflow-checks"];

/// Our own code is tested with debug assertions and overflow checks: the profiles of tests in the root `Cargo.toml` take
/// them from dependencies alone, which are `"*"` there.
pub fn profiles(tree: &Tree) -> Vec<Finding> {
    let path = "Cargo.toml";
    let mut findings = Vec::new();
    let mut section = "";
    for (index, line) in tree.text(path).unwrap_or_default().lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if line.starts_with('[') {
            section = line.trim_matches(['[', ']']);
        }
        let place = format!("{section}.{line}");
        let is_of_tests =
            ["profile.dev", "profile.test"].iter().any(|own| section.starts_with(own));
        let is_of_dependencies = place.contains(".package.\"*\"");
        let squeezed: String = line.chars().filter(|c| !c.is_whitespace()).collect();
        for check in CHECKS {
            let is_off = squeezed.contains(&format!("{check}=false"));
            if is_off && is_of_tests && !is_of_dependencies {
                let fault = format!("{check} of our own code are off in tests; leave them on");
                findings.push(Finding::at_line(path, index + 1, fault));
            }
        }
    }
    findings
}

fn is_without_tests(line: &str) -> bool {
    line.split('#').next().unwrap_or_default().split_whitespace().eq(["test", "=", "false"])
}

/// Unit tests that nobody runs: of the program, `[[bin]]`, those of its `main.rs`, of the library all others.
fn unit_tests(tree: &Tree, manifest: &str, section: &str) -> Vec<Finding> {
    let sources = manifest.replace("Cargo.toml", "src/");
    let own = tree.ending_in(".rs").filter(|file| file.path.starts_with(&sources));
    let own = own.filter(|file| file.path.ends_with("/main.rs") == (section == "bin"));
    let tested = own.filter(|file| file.text.lines().any(|line| line.trim() == "#[test]"));
    let fault = format!("has a test that is never run: {manifest} says `test = false`");
    tested.map(|file| Finding::of_file(&file.path, fault.clone())).collect()
}

/// Whether a line of a member that is no product names one of the tests by its folder, with a version.
fn is_of_tests(manifest: &str, line: &str) -> bool {
    let folder = if manifest.starts_with("tests/") { "path = \"../" } else { "path = \"../tests/" };
    !manifest.starts_with("crates/") && line.contains(folder) && line.contains("version = \"=")
}

/// Whether a line takes its value from the workspace.
fn is_inherited(line: &str) -> bool {
    let squeezed: String = line.chars().filter(|c| !c.is_whitespace()).collect();
    squeezed.contains("workspace=true")
}

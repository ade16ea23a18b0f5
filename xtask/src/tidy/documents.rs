//! Rules for the documents.

use std::collections::{BTreeMap, BTreeSet};

use super::{Finding, Tree};
use crate::layers::Member;

/// Files a stranger looks for.
pub const REQUIRED_FILES: [&str; 16] = [
    ".ci/run",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "Cargo.lock",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "docs/book.toml",
    "docs/src/SUMMARY.md",
    "docs/src/decisions.md",
    "docs/src/introduction.md",
    "docs/src/known-differences.md",
    "docs/src/validation.md",
    "rust-toolchain.toml",
];

/// All of [`REQUIRED_FILES`] are there, and every folder of reference data says where it is from.
pub fn required(tree: &Tree) -> Vec<Finding> {
    let missing = |path: &str| !tree.paths.contains(path);
    let mut findings: Vec<Finding> = REQUIRED_FILES
        .into_iter()
        .filter(|path| missing(path))
        .map(|path| Finding::of_file(path, "is missing"))
        .collect();
    for path in &tree.paths {
        let data = path.strip_prefix("fixtures/reference/").and_then(|rest| rest.split_once('/'));
        if let Some((folder, _)) = data {
            let source = format!("fixtures/reference/{folder}/SOURCE.md");
            if missing(&source) {
                findings
                    .push(Finding::of_file(&source, "is missing: say where the numbers are from"));
            }
        }
    }
    findings
}

/// Every version in CHANGELOG.md has its heading "Numbers changed".
pub fn changelog(tree: &Tree) -> Vec<Finding> {
    let path = "CHANGELOG.md";
    let Some(text) = tree.text(path) else {
        return Vec::new();
    };
    let mut findings = Vec::new();
    let mut versions = 0;
    for section in text.split("\n## ").skip(1) {
        versions += 1;
        if !section.lines().any(|line| line.trim() == "### Numbers changed") {
            let version = section.lines().next().unwrap_or_default();
            let fault = format!("version `{version}` has no heading `### Numbers changed`");
            findings.push(Finding::of_file(path, fault));
        }
    }
    if versions == 0 {
        findings.push(Finding::of_file(path, "has no version: expected a `## ` heading"));
    }
    findings
}

/// Every relative link in a Markdown file leads to a file or folder of the tree, and its `#` part to a heading of a page.
pub fn links(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let pages: BTreeMap<&str, BTreeSet<String>> =
        tree.ending_in(".md").map(|file| (file.path.as_str(), anchors(&file.text))).collect();
    for file in tree.ending_in(".md") {
        for (index, line) in prose(&file.text) {
            for (target, anchor) in links_in(line) {
                let resolved = match target {
                    "" => file.path.clone(),
                    _ => resolve(&file.path, target),
                };
                let mut fault = |fault: String| {
                    findings.push(Finding::at_line(&file.path, index + 1, fault));
                };
                if !resolved.is_empty() && !tree.paths.contains(&resolved) {
                    fault(format!("link to `{target}` leads nowhere"));
                }
                let there = pages.get(resolved.as_str());
                if let (Some(anchor), Some(there)) = (anchor, there)
                    && !there.contains(anchor)
                {
                    fault(format!("`#{anchor}` is no heading of {resolved}"));
                }
            }
        }
    }
    findings
}

/// The lines of a Markdown text outside of code blocks, with their numbers from 0.
fn prose(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut code = false;
    text.lines().enumerate().filter(move |(_, line)| {
        let is_fence = line.trim_start().starts_with("```");
        code ^= is_fence;
        !code && !is_fence
    })
}

/// What the headings of a page are linked to by, as mdBook names them.
fn anchors(text: &str) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    for (_, line) in prose(text) {
        let heading = line.trim_start_matches('#');
        let Some(heading) = heading.strip_prefix(' ').filter(|_| line.starts_with('#')) else {
            continue;
        };
        // of a link its text
        let shown: String = heading
            .split("](")
            .enumerate()
            .map(|(k, part)| if k == 0 { part } else { part.split_once(')').map_or("", |p| p.1) })
            .collect();
        let kept = shown.trim().chars().filter_map(|c| match c {
            _ if c.is_whitespace() => Some('-'),
            _ if c.is_alphanumeric() || c == '_' || c == '-' => Some(c),
            _ => None,
        });
        let name: String = kept.collect::<String>().to_lowercase();
        // the second of a name has a number behind it
        let numbered = (1..=found.len()).map(|k| format!("{name}-{k}"));
        let mut names = std::iter::once(name.clone()).chain(numbered);
        let free = names.find(|name| !found.contains(name));
        found.extend(free);
    }
    found
}

/// Every path in back ticks that begins at a folder of the root leads to a file or folder of the tree.
pub fn named_paths(tree: &Tree) -> Vec<Finding> {
    let roots = ["crates/", "docs/", "fixtures/", "xtask/"];
    let mut findings = Vec::new();
    for file in tree.ending_in(".md").filter(|file| !file.path.starts_with("CHANGELOG")) {
        for (index, line) in file.text.lines().enumerate() {
            for span in line.split('`').skip(1).step_by(2) {
                let path = span.split([' ', ',', ':']).next().unwrap_or_default();
                let is_pattern = path.contains(['*', '<']) || path.contains("NAME");
                let path = path.trim_end_matches('/');
                if roots.iter().any(|root| path.starts_with(root))
                    && !is_pattern
                    && !tree.paths.contains(path)
                {
                    let fault = format!("`{path}` is not in the tree");
                    findings.push(Finding::at_line(&file.path, index + 1, fault));
                }
            }
        }
    }
    findings
}

/// Longest row of a table, characters.
const ROW: usize = 300;
/// The page of generated rows, whose texts belong to the tests, and the descriptions of reference data.
const LONGER: [&str; 2] = ["docs/src/validation.md", "fixtures/"];

/// No row of a table is a paragraph.
pub fn long_rows(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let longer = |path: &str| LONGER.iter().any(|start| path.starts_with(start));
    for file in tree.ending_in(".md").filter(|file| !longer(&file.path)) {
        for (index, line) in file.text.lines().enumerate() {
            let length = line.chars().count();
            if line.starts_with('|') && length > ROW {
                let fault =
                    format!("a row of {length} characters: {ROW} at most, say the rest below");
                findings.push(Finding::at_line(&file.path, index + 1, fault));
            }
        }
    }
    findings
}

/// The relative links `[text](target#anchor)` in a line; the target is empty for a place of the page itself.
fn links_in(line: &str) -> impl Iterator<Item = (&str, Option<&str>)> {
    line.split("](").skip(1).filter_map(|rest| {
        let target = rest.split([')', ' ']).next()?;
        let outside = target.contains("://") || target.starts_with("mailto:");
        let (target, anchor) = match target.split_once('#') {
            Some((target, anchor)) => (target, Some(anchor)),
            None => (target, None),
        };
        let is_link = !(target.is_empty() && anchor.is_none());
        (is_link && !outside).then_some((target, anchor))
    })
}

/// A link target as a path from the root; empty for the root itself.
fn resolve(from: &str, target: &str) -> String {
    let mut parts: Vec<&str> = from.split('/').collect();
    parts.pop();
    for part in target.split('/') {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop();
            }
            name => parts.push(name),
        }
    }
    parts.join("/")
}

/// Every page of the book stands in its table of contents. (That every entry has a page is a matter
/// of [`links`].)
pub fn summary(tree: &Tree) -> Vec<Finding> {
    let path = "docs/src/SUMMARY.md";
    let Some(text) = tree.text(path) else {
        return Vec::new();
    };
    let listed: Vec<String> =
        text.lines().flat_map(links_in).map(|(target, _)| resolve(path, target)).collect();
    tree.ending_in(".md")
        .map(|file| file.path.as_str())
        .filter(|page| page.starts_with("docs/src/") && *page != path)
        .filter(|page| !listed.iter().any(|l| l == page))
        .map(|page| Finding::of_file(page, format!("is not in {path}: nobody will find it")))
        .collect()
}

/// The code map of ARCHITECTURE.md names every member with the floor its manifest states.
///
/// A row of the map starts with the member and its floor.
pub fn floors_of_the_code_map(tree: &Tree, members: &[Member]) -> Vec<Finding> {
    let path = "ARCHITECTURE.md";
    let Some(text) = tree.text(path) else {
        return Vec::new();
    };
    let stated: BTreeMap<&str, u32> = text.lines().filter_map(code_map_row).collect();
    let mut findings = Vec::new();
    for member in members {
        let fault = match (stated.get(member.name.as_str()), member.floor) {
            (None, _) => format!("the code map does not name `{}`", member.name),
            (Some(on_page), Some(floor)) if *on_page != floor => format!(
                "`{}` stands on floor {floor} by its manifest, on {on_page} by the code map",
                member.name
            ),
            _ => continue,
        };
        findings.push(Finding::of_file(path, fault));
    }
    for name in stated.keys() {
        if !members.iter().any(|member| member.name == *name) {
            let fault = format!("the code map names `{name}`, which is no member");
            findings.push(Finding::of_file(path, fault));
        }
    }
    findings
}

/// Member and floor of a table row `| [`name`](path) | floor | ... |`.
fn code_map_row(line: &str) -> Option<(&str, u32)> {
    let mut cells = line.strip_prefix('|')?.split('|');
    let name = cells.next()?.split('`').nth(1)?;
    let floor = cells.next()?.trim().parse().ok()?;
    Some((name, floor))
}

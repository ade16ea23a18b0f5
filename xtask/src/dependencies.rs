//! Dependencies: each one used where its manifest lists it, and each under a licence the project can ship with.
//!
//! [`unused`] is a function of plain texts. [`licences`] asks `cargo metadata` for all packages of the lock file.

use std::collections::BTreeMap;
use std::fmt;
use std::path::Path;

use serde::Deserialize;

use crate::XtaskError;
use crate::layers::{DependencyKind, Member};
use crate::tidy::Tree;
use crate::workspace::cargo;

/// Licences under which a dependency may come, by SPDX identifier. All of them let a program under MIT or
/// Apache 2.0 be linked with the dependency.
pub const ALLOWED_LICENCES: [&str; 12] = [
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
];

/// A dependency that a manifest lists and no code of that kind uses.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unused {
    /// Manifest, relative to the root.
    pub manifest: String,
    /// The package it lists.
    pub dependency: String,
    /// The table it stands in.
    pub kind: DependencyKind,
    /// Whether tests, examples, benches or documentation use it all the same.
    pub in_tests: bool,
}

impl fmt::Display for Unused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { manifest, dependency, kind, .. } = self;
        let remedy = match (self.in_tests, kind) {
            (true, DependencyKind::Normal) => "only tests use it: move it to [dev-dependencies]",
            _ => "nothing uses it: remove the line",
        };
        write!(f, "{manifest}: {dependency} in [{kind}]: {remedy}")
    }
}

/// A package whose licence is missing or not among [`ALLOWED_LICENCES`].
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unlicensed {
    /// Name and version.
    pub package: String,
    /// What its manifest says.
    pub licence: Option<String>,
}

impl fmt::Display for Unlicensed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let said = self.licence.as_deref().unwrap_or("no licence");
        write!(
            f,
            "{}: {said}; allowed: {}. Replace the package, or add the licence to the list with care",
            self.package,
            ALLOWED_LICENCES.join(", ")
        )
    }
}

/// The listed dependencies that nothing uses, in the order of the members.
///
/// A normal dependency must be named in `src`, tests apart; a dev-dependency anywhere in the package, its README
/// and documentation examples included; a build dependency in `build.rs`.
pub fn unused(members: &[Member], tree: &Tree) -> Vec<Unused> {
    let manifests = manifests(tree);
    let mut found = Vec::new();
    for member in members {
        let Some(manifest) = manifests.get(member.name.as_str()) else { continue };
        let folder = manifest.trim_end_matches("Cargo.toml");
        let code = Code::of(folder, tree);
        for dependency in &member.dependencies {
            let name = dependency.name.replace('-', "_");
            let in_tests = names(&code.tests, &name);
            let used = match dependency.kind {
                DependencyKind::Normal => names(&code.shipped, &name),
                DependencyKind::Development => in_tests,
                DependencyKind::Build => names(&code.build, &name),
            };
            if !used {
                found.push(Unused {
                    manifest: (*manifest).to_owned(),
                    dependency: dependency.name.clone(),
                    kind: dependency.kind,
                    in_tests,
                });
            }
        }
    }
    found
}

/// Package name to manifest path of every manifest in the tree.
fn manifests(tree: &Tree) -> BTreeMap<&str, &str> {
    tree.texts
        .iter()
        .filter(|file| file.path.ends_with("Cargo.toml"))
        .filter_map(|file| {
            let line = file.text.lines().find(|line| line.starts_with("name = "))?;
            Some((line.trim_start_matches("name = ").trim_matches('"'), file.path.as_str()))
        })
        .collect()
}

/// The code of one package by what it is for.
#[derive(Default)]
struct Code {
    shipped: String,
    tests: String,
    build: String,
}

impl Code {
    fn of(folder: &str, tree: &Tree) -> Self {
        let mut code = Self::default();
        for file in &tree.texts {
            let Some(path) = file.path.strip_prefix(folder) else { continue };
            let is_rust = Path::new(path).extension().is_some_and(|ending| ending == "rs");
            if path == "build.rs" {
                code.build.push_str(&without_comments(&file.text));
            } else if is_rust && path.starts_with("src/") && !is_test_module(path) {
                let (shipped, tests) =
                    file.text.split_once("\n#[cfg(test)]\n").unwrap_or((&file.text, ""));
                code.shipped.push_str(&without_comments(shipped));
                code.tests.push_str(tests);
                code.tests.extend(shipped.lines().filter(|line| is_comment(line)));
            } else if is_rust || path.ends_with("README.md") {
                code.tests.push_str(&file.text);
            }
        }
        code
    }
}

/// Whether a file below `src` holds tests alone, by its name.
fn is_test_module(path: &str) -> bool {
    path.ends_with("tests.rs") || path.contains("/tests/")
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with("//")
}

fn without_comments(text: &str) -> String {
    text.lines().filter(|line| !is_comment(line)).flat_map(|line| [line, "\n"]).collect()
}

/// Whether `name` stands in `code` as a word of its own.
fn names(code: &str, name: &str) -> bool {
    let is_part = |c: Option<char>| c.is_some_and(|c| c.is_alphanumeric() || c == '_');
    code.match_indices(name).any(|(at, _)| {
        !is_part(code[..at].chars().next_back()) && !is_part(code[at + name.len()..].chars().next())
    })
}

/// The packages of the lock file whose licence is not allowed, and how many there are in all.
///
/// # Errors
/// [`XtaskError`] if cargo cannot be run or answers in another shape.
pub fn licences(root: &Path) -> Result<(usize, Vec<Unlicensed>), XtaskError> {
    unlicensed(&cargo(root, &["metadata", "--locked", "--format-version", "1"])?)
}

/// The packages in an answer of `cargo metadata` whose licence is not allowed, and how many there are in all.
///
/// # Errors
/// [`XtaskError::MetadataShape`] if the answer is not the JSON that format version 1 describes.
pub fn unlicensed(metadata_json: &[u8]) -> Result<(usize, Vec<Unlicensed>), XtaskError> {
    let metadata: Metadata = serde_json::from_slice(metadata_json)
        .map_err(|source| XtaskError::MetadataShape { source })?;
    let count = metadata.packages.len();
    let refused = metadata
        .packages
        .into_iter()
        .filter(|package| !package.license.as_deref().is_some_and(is_allowed));
    let refused = refused.map(|package| Unlicensed {
        package: format!("{} {}", package.name, package.version),
        licence: package.license,
    });
    Ok((count, refused.collect()))
}

/// Whether a licence expression can be met by [`ALLOWED_LICENCES`] alone. The old form `MIT/Apache-2.0` is a choice.
fn is_allowed(expression: &str) -> bool {
    let parsed = spdx::Expression::parse_mode(expression, spdx::ParseMode::LAX);
    parsed.is_ok_and(|parsed| {
        parsed.evaluate(|required| ALLOWED_LICENCES.contains(&required.to_string().as_str()))
    })
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    version: String,
    license: Option<String>,
}

//! Rules of the house that a text can break, checked over the whole tree.
//!
//! Every rule is a function of a [`Tree`], a plain list of texts, so that a test can plant a breach.

mod documents;
mod manifests;
mod rust;
mod tree;
mod validation_ids;

use std::fmt;

pub use documents::{
    REQUIRED_FILES, changelog, floors_of_the_code_map, links, long_rows, named_paths, required,
    summary,
};
pub use manifests::{manifests, profiles};
pub use rust::{EXAMPLE_LIMIT, LINE_LIMIT, LONG_FILES, rust};
pub use tree::{TextFile, Tree};
pub use validation_ids::{ids_in, validation_ids};

use crate::layers::Member;

/// A breach of a rule.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Finding {
    /// File, relative to the root, with `/` between folders.
    pub path: String,
    /// Line, from 1, where there is one.
    pub line: Option<usize>,
    /// What is wrong and what was expected.
    pub fault: String,
}

impl Finding {
    fn of_file(path: &str, fault: impl Into<String>) -> Self {
        Self { path: path.to_owned(), line: None, fault: fault.into() }
    }

    fn at_line(path: &str, line: usize, fault: impl Into<String>) -> Self {
        Self { path: path.to_owned(), line: Some(line), fault: fault.into() }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "{}:{line}: {}", self.path, self.fault),
            None => write!(f, "{}: {}", self.path, self.fault),
        }
    }
}

/// All breaches in a tree, ordered by file and line.
///
/// | argument | meaning |
/// |---|---|
/// | `tree` | the texts |
/// | `members` | the workspace, for the floors that ARCHITECTURE.md states |
pub fn check(tree: &Tree, members: &[Member]) -> Vec<Finding> {
    let mut findings = rust(tree);
    findings.extend(manifests(tree));
    findings.extend(profiles(tree));
    findings.extend(required(tree));
    findings.extend(changelog(tree));
    findings.extend(links(tree));
    findings.extend(named_paths(tree));
    findings.extend(long_rows(tree));
    findings.extend(summary(tree));
    findings.extend(floors_of_the_code_map(tree, members));
    findings.extend(validation_ids(tree, &validation::ids().collect::<Vec<_>>()));
    findings.sort();
    findings.dedup();
    findings
}

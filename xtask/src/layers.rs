//! The layer rule: a crate stands only on crates of a strictly lower floor.
//!
//! [`check`] is a function of plain values; [`crate::workspace`] fills them from `cargo metadata`.

use std::collections::BTreeMap;
use std::fmt;

/// The floors there are: 0 to 8 are the product, 9 holds the tools that look at all of it.
pub const FLOORS: [u32; 10] = [0, 1, 2, 3, 4, 5, 6, 7, 8, TOOLS_FLOOR];

/// The floor of `xtask` and of the end-to-end tests.
pub const TOOLS_FLOOR: u32 = 9;

/// The member that makes synthetic measurements and shares no code with the product.
pub const TRUTH: &str = "truth";

/// The member that makes points of test of a rotor of its own, and shares no code with any other.
pub const ROTOR_TRUTH: &str = "rotor-truth";

/// The member that makes synthetic measurements with everyday errors, and shares no code with product or [`TRUTH`].
pub const EVERYDAY: &str = "everyday-bench";

/// The member that compares findings with the answers of both, and shares no code with the product either.
pub const SCORE: &str = "score";

/// External crates that know files, the terminal or reports.
pub const RESERVED_CRATES: [&str; 10] = [
    "blake3",
    "clap",
    "comfy-table",
    "csv",
    "indicatif",
    "maud",
    "plotly",
    "ron",
    "serde_json",
    "tempfile",
];

/// The members that may use [`RESERVED_CRATES`] in what they ship; tests may use them anywhere.
pub const RESERVED_FOR: [&str; 12] = [
    "measured-data",
    "case-sweep",
    "report-page",
    "diagnosis-page",
    "sim-driver",
    "xtask",
    TRUTH,
    ROTOR_TRUTH,
    EVERYDAY,
    SCORE,
    "validation",
    "e2e",
];

/// The member whose studies take values and give values.
pub const STUDY: &str = "rotor-study";

/// External crates that no crate below [`STUDY`] may bring into it either, tests included.
pub const FREE_OF: [&str; 7] = ["clap", "plotly", "csv", "ron", "comfy-table", "indicatif", "maud"];

/// Those of [`FREE_OF`] among the crates that [`STUDY`] is built with.
pub fn brought_in(crates: &[String]) -> Vec<&str> {
    crates.iter().map(String::as_str).filter(|name| FREE_OF.contains(name)).collect()
}

/// What a dependency is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum DependencyKind {
    /// Part of the crate.
    Normal,
    /// Used by its build script.
    Build,
    /// Used by its tests, examples and benches.
    Development,
}

impl fmt::Display for DependencyKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Normal => "dependencies",
            Self::Build => "build-dependencies",
            Self::Development => "dev-dependencies",
        })
    }
}

/// A line in a manifest's dependency table.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dependency {
    /// Name of the package depended on.
    pub name: String,
    /// Which table it stands in.
    pub kind: DependencyKind,
}

/// A member of the workspace.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Member {
    /// Package name.
    pub name: String,
    /// `layer` of `[package.metadata.house]`, if there is one.
    pub floor: Option<u32>,
    /// All its dependencies, of the workspace and external.
    pub dependencies: Vec<Dependency>,
}

/// A breach of the layer rule.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LayerFault {
    /// A member does not say on which floor it stands.
    #[error(
        "{member} has no floor: add `layer = N` under [package.metadata.house] in its Cargo.toml"
    )]
    NoFloor {
        /// The member.
        member: String,
    },
    /// A member stands on a floor the house does not have.
    #[error("{member} stands on floor {floor}: the house has floors 0 to 7 and 9 (tools)")]
    UnknownFloor {
        /// The member.
        member: String,
        /// The floor it claims.
        floor: u32,
    },
    /// A dependency does not lead downward.
    #[error(
        "{member} (floor {floor}) has {dependency} (floor {dependency_floor}) among its {kind}: a \
         crate may use strictly lower floors only; move what is shared down, or the user of it up"
    )]
    NotDownward {
        /// The member.
        member: String,
        /// Its floor.
        floor: u32,
        /// What it depends on.
        dependency: String,
        /// The floor of that.
        dependency_floor: u32,
        /// In which table.
        kind: DependencyKind,
    },
    /// The generators of synthetic measurements use the product, or the product uses them.
    #[error(
        "{member} has {dependency} among its {kind}: the generators of synthetic measurements and \
         the product share no code, or the product would be tested against itself"
    )]
    TruthNotApart {
        /// The member.
        member: String,
        /// What it depends on.
        dependency: String,
        /// In which table.
        kind: DependencyKind,
    },
    /// A crate below the driver knows files, the terminal or reports.
    #[error(
        "{member} has {dependency} among its {kind}: files, terminal and reports are known to {} \
         alone; hand the crate values instead", RESERVED_FOR.join(", ")
    )]
    Reserved {
        /// The member.
        member: String,
        /// The external crate.
        dependency: String,
        /// In which table.
        kind: DependencyKind,
    },
}

/// All breaches of the layer rule among the members of a workspace, in the order of the members.
///
/// - every member names one of [`FLOORS`];
/// - dependencies of every kind, tests included, lead to strictly lower floors;
/// - [`TRUTH`], [`ROTOR_TRUTH`] and [`EVERYDAY`] use no other member, [`SCORE`] none but them, and no member below the tools
///   uses them;
/// - [`RESERVED_CRATES`] are used by [`RESERVED_FOR`] alone, or in tests.
pub fn check(members: &[Member]) -> Vec<LayerFault> {
    let floors: BTreeMap<&str, Option<u32>> =
        members.iter().map(|member| (member.name.as_str(), member.floor)).collect();
    let mut faults = Vec::new();
    for member in members {
        match member.floor {
            None => faults.push(LayerFault::NoFloor { member: member.name.clone() }),
            Some(floor) if !FLOORS.contains(&floor) => {
                faults.push(LayerFault::UnknownFloor { member: member.name.clone(), floor });
            }
            Some(_) => {}
        }
        for dependency in &member.dependencies {
            faults.extend(match floors.get(dependency.name.as_str()) {
                Some(below) => check_member_edge(member, dependency, *below),
                None => check_external_edge(member, dependency),
            });
        }
    }
    faults
}

/// A dependency on a crate of no member.
fn check_external_edge(member: &Member, dependency: &Dependency) -> Option<LayerFault> {
    let reserved = RESERVED_CRATES.contains(&dependency.name.as_str())
        && dependency.kind != DependencyKind::Development
        && !RESERVED_FOR.contains(&member.name.as_str());
    reserved.then(|| LayerFault::Reserved {
        member: member.name.clone(),
        dependency: dependency.name.clone(),
        kind: dependency.kind,
    })
}

/// A dependency on a member that stands on floor `below`; a missing floor is a fault of its own member.
fn check_member_edge(
    member: &Member,
    dependency: &Dependency,
    below: Option<u32>,
) -> Option<LayerFault> {
    let (name, kind) = (dependency.name.clone(), dependency.kind);
    let apart = |member: &str| [TRUTH, ROTOR_TRUTH, EVERYDAY, SCORE].contains(&member);
    let scorer = member.name == SCORE && [TRUTH, ROTOR_TRUTH, EVERYDAY].contains(&name.as_str());
    let user = apart(&name) && member.floor != Some(TOOLS_FLOOR);
    if (apart(&member.name) || user) && !scorer {
        return Some(LayerFault::TruthNotApart {
            member: member.name.clone(),
            dependency: name,
            kind,
        });
    }
    let (floor, dependency_floor) = (member.floor?, below?);
    (dependency_floor >= floor).then(|| LayerFault::NotDownward {
        member: member.name.clone(),
        floor,
        dependency: name,
        dependency_floor,
        kind,
    })
}

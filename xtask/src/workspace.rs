//! The workspace as cargo sees it.

use std::path::{Path, PathBuf};
use std::process::Command;

use serde::Deserialize;

use crate::XtaskError;
use crate::layers::{Dependency, DependencyKind, Member};

/// Root folder of the workspace.
pub fn root() -> PathBuf {
    let xtask = Path::new(env!("CARGO_MANIFEST_DIR"));
    xtask.parent().unwrap_or(xtask).to_path_buf()
}

/// The members of the workspace at `root`, in the order of `cargo metadata --no-deps`.
///
/// # Errors
/// [`XtaskError`] if cargo cannot be run, refuses a manifest, or answers in another shape.
pub fn members(root: &Path) -> Result<Vec<Member>, XtaskError> {
    members_of(&cargo(root, &["metadata", "--no-deps", "--format-version", "1", "--offline"])?)
}

/// What cargo says on standard output, asked at `root`.
pub(crate) fn cargo(root: &Path, arguments: &[&str]) -> Result<Vec<u8>, XtaskError> {
    let program = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output =
        Command::new(&program).args(arguments).current_dir(root).output().map_err(|source| {
            XtaskError::Start { program: program.to_string_lossy().into_owned(), source }
        })?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr).trim().to_owned();
        return Err(XtaskError::Metadata { said });
    }
    Ok(output.stdout)
}

/// Names of all crates that a member is built and tested with, itself included, as `cargo tree` lists them.
///
/// # Errors
/// [`XtaskError`] if cargo cannot be run or refuses.
pub fn tree(root: &Path, member: &str) -> Result<Vec<String>, XtaskError> {
    let asked = ["tree", "--package", member, "--edges", "all", "--prefix", "none", "--offline"];
    let lines = String::from_utf8_lossy(&cargo(root, &asked)?).into_owned();
    let mut names: Vec<String> =
        lines.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect();
    names.sort();
    names.dedup();
    Ok(names)
}

/// The members in an answer of `cargo metadata`.
///
/// # Errors
/// [`XtaskError::MetadataShape`] if the answer is not the JSON that format version 1 describes.
pub fn members_of(metadata_json: &[u8]) -> Result<Vec<Member>, XtaskError> {
    let metadata: Metadata = serde_json::from_slice(metadata_json)
        .map_err(|source| XtaskError::MetadataShape { source })?;
    Ok(metadata.packages.into_iter().map(Package::into_member).collect())
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Package>,
}

#[derive(Deserialize)]
struct Package {
    name: String,
    dependencies: Vec<PackageDependency>,
    metadata: Option<PackageMetadata>,
}

#[derive(Deserialize)]
struct PackageDependency {
    name: String,
    kind: Option<String>,
}

#[derive(Deserialize)]
struct PackageMetadata {
    house: Option<House>,
}

#[derive(Deserialize)]
struct House {
    layer: Option<u32>,
}

impl Package {
    fn into_member(self) -> Member {
        let dependencies = self.dependencies.into_iter().map(|dependency| Dependency {
            kind: match dependency.kind.as_deref() {
                Some("dev") => DependencyKind::Development,
                Some("build") => DependencyKind::Build,
                _ => DependencyKind::Normal,
            },
            name: dependency.name,
        });
        Member {
            name: self.name,
            floor: self.metadata.and_then(|m| m.house).and_then(|house| house.layer),
            dependencies: dependencies.collect(),
        }
    }
}

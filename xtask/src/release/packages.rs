//! Packages: complete manifests, and files that are inside.
//!
//! `cargo package` makes them, all at once, because one needs the other. What it does not see is looked for in the
//! unpacked packages: a source that includes a file from outside of its package does not compile anywhere else, and the
//! text of the licence goes with every package.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use serde::Deserialize;

use crate::workspace::cargo;
use crate::{XtaskError, files};

/// Folders of the members that are of use in this repository alone. The generators and oracles among the tests are not: others
/// can try their own tools with them, and cargo packages no member that needs one it may not publish.
const OF_REPOSITORY: [&str; 2] = ["xtask/", "tests/e2e/"];

/// A member as `cargo metadata` describes it.
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize)]
pub struct Manifest {
    /// Package name.
    pub name: String,
    /// Version.
    pub version: String,
    /// Path of `Cargo.toml`.
    pub manifest_path: String,
    /// Registries that it may go to: none is no registry, left out is any.
    pub publish: Option<Vec<String>>,
    /// One sentence.
    pub description: Option<String>,
    /// SPDX expression.
    pub license: Option<String>,
    /// Its page in the registry.
    pub readme: Option<String>,
    /// Least compiler.
    pub rust_version: Option<String>,
    /// Words that it is found by.
    pub keywords: Vec<String>,
    /// Categories of the registry.
    pub categories: Vec<String>,
    /// What it depends on.
    pub dependencies: Vec<Needed>,
}

/// A dependency of a [`Manifest`].
#[derive(Debug, Clone, PartialEq, Eq, Default, Deserialize)]
pub struct Needed {
    /// Package name.
    pub name: String,
    /// Versions that do; `*` where none is stated.
    pub req: String,
    /// `dev`, `build`, or nothing.
    pub kind: Option<String>,
    /// Folder, of a member.
    pub path: Option<String>,
}

#[derive(Deserialize)]
struct Metadata {
    packages: Vec<Manifest>,
}

/// The members of the workspace at `root`.
///
/// # Errors
/// [`XtaskError`] if cargo cannot be run or answers in another shape.
pub fn manifests(root: &Path) -> Result<Vec<Manifest>, XtaskError> {
    let said = cargo(root, &["metadata", "--no-deps", "--format-version", "1", "--offline"])?;
    let metadata: Metadata =
        serde_json::from_slice(&said).map_err(|source| XtaskError::MetadataShape { source })?;
    Ok(metadata.packages)
}

impl Manifest {
    /// Whether it may be published.
    pub fn is_published(&self) -> bool {
        self.publish.as_ref().is_none_or(|registries| !registries.is_empty())
    }

    /// What is missing or wrong for a registry. `folder` is that of the member from the root, with `/` at its end.
    pub fn faults(&self, folder: &str) -> Vec<String> {
        let name = &self.name;
        let is_meant = !OF_REPOSITORY.contains(&folder);
        if self.is_published() != is_meant {
            let remedy =
                if is_meant { "remove `publish = false`" } else { "add `publish = false`" };
            return vec![format!("{folder}Cargo.toml: {name}: {remedy}")];
        }
        if !is_meant {
            return vec![];
        }
        let mut missing = Vec::new();
        for (key, is_there) in [
            ("description", self.description.is_some()),
            ("license", self.license.is_some()),
            ("readme", self.readme.is_some()),
            ("rust-version", self.rust_version.is_some()),
            ("keywords", (1..=5).contains(&self.keywords.len())),
            ("categories", !self.categories.is_empty()),
        ] {
            missing.extend((!is_there).then(|| format!("{folder}Cargo.toml: {name} has no {key}")));
        }
        for needed in &self.dependencies {
            let is_dev = needed.kind.as_deref() == Some("dev");
            if needed.path.is_some() && needed.req == "*" && !is_dev {
                missing.push(format!(
                    "{folder}Cargo.toml: {name} needs {} without a version: state it in the root Cargo.toml",
                    needed.name
                ));
            }
        }
        missing
    }
}

/// A file that a source includes and that is not in its package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Outside {
    /// The source, from the folder of the package.
    pub source: String,
    /// Its line, from 1.
    pub line: usize,
    /// What it includes, as it is written.
    pub included: String,
}

/// The files that a source text includes: line and path as it is written. Paths put together by a macro are left to the
/// compiler.
pub fn included(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    for call in ["include_str!", "include_bytes!", "include!"] {
        for (at, _) in text.match_indices(call) {
            let line = text[..at].matches('\n').count() + 1;
            let inside = text[at + call.len()..].strip_prefix('(').map(str::trim_start);
            let quoted = inside.and_then(|inside| inside.strip_prefix('"'));
            let literal = quoted.and_then(|quoted| quoted.split_once('"'));
            found.extend(literal.map(|(path, _)| (line, path.to_owned())));
        }
    }
    found.sort();
    found
}

/// What the sources below `package` include from outside of it, or what is not there.
///
/// # Errors
/// [`XtaskError::Read`].
pub fn outside(package: &Path) -> Result<Vec<Outside>, XtaskError> {
    let mut found = Vec::new();
    let mut folders = vec![package.to_path_buf()];
    let inside = package.canonicalize().unwrap_or_else(|_| package.to_path_buf());
    while let Some(folder) = folders.pop() {
        for path in files::in_folder(&folder)? {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                for (line, name) in included(&files::read(&path)?) {
                    let target = folder.join(&name).canonicalize();
                    if !target.is_ok_and(|target| target.starts_with(&inside)) {
                        let source = path.strip_prefix(package).unwrap_or(&path);
                        let source = source.display().to_string();
                        found.push(Outside { source, line, included: name });
                    }
                }
            }
        }
    }
    found.sort_by(|a, b| (&a.source, a.line).cmp(&(&b.source, b.line)));
    Ok(found)
}

/// Texts of the licence, of the repository and of every package.
const LICENCES: [&str; 2] = ["LICENSE-MIT", "LICENSE-APACHE"];

/// The texts of the licence that a package lacks, or has otherwise than the repository.
///
/// # Errors
/// [`XtaskError::Read`] if the repository has none.
pub fn licences(root: &Path, package: &Path) -> Result<Vec<String>, XtaskError> {
    let mut faults = Vec::new();
    for name in LICENCES {
        let text = files::read(&root.join(name))?;
        let own = files::read(&package.join(name)).ok();
        if own.as_ref() != Some(&text) {
            let what = if own.is_none() { "is not there" } else { "is not that of the repository" };
            faults.push(format!("{name} {what}: `ln -s ../../{name}` in the folder of the crate"));
        }
    }
    Ok(faults)
}

/// What became of the packages.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Packed {
    /// Names of the packages.
    pub names: Vec<String>,
    /// Bytes of all packages.
    pub bytes: u64,
    /// What is wrong.
    pub faults: Vec<String>,
    /// What was done, and how long it took.
    pub steps: Vec<String>,
}

/// Checks the manifests, packages all that is published, and looks for files outside. With `install`, builds and installs
/// `hhc` from the packages alone and runs it in another folder.
///
/// # Errors
/// [`XtaskError`] if cargo or tar cannot be run, or a package cannot be made.
pub fn check(root: &Path, target: &Path, install: bool) -> Result<Packed, XtaskError> {
    let begun = Instant::now();
    let mut packed = Packed::default();
    let root_text = format!("{}/", root.display());
    let mut arguments = ["package", "--workspace", "--no-verify", "--allow-dirty", "--offline"]
        .map(String::from)
        .to_vec();
    let members = manifests(root)?;
    let of_registry: Vec<&Manifest> = members.iter().filter(|own| own.is_published()).collect();
    for member in &members {
        let path = member.manifest_path.strip_prefix(&root_text).unwrap_or(&member.manifest_path);
        packed.faults.extend(member.faults(path.trim_end_matches("Cargo.toml")));
    }
    for member in &of_registry {
        packed.names.push(member.name.clone());
    }
    arguments.extend(["--target-dir".to_owned(), target.display().to_string()]);
    said(Command::new("cargo").args(&arguments).current_dir(root))?;
    packed.steps.push(format!("packed in {:.1} s", begun.elapsed().as_secs_f64()));
    let unpacked = target.join("package/unpacked");
    files::remove_folder(&unpacked)?;
    let failed = |source| XtaskError::Write { path: unpacked.clone(), source };
    std::fs::create_dir_all(&unpacked).map_err(failed)?;
    // cargo builds all of them, the unpublished ones too
    for member in &members {
        let name = format!("{}-{}", member.name, member.version);
        let package = target.join("package").join(format!("{name}.crate"));
        packed.bytes += std::fs::metadata(&package).map_or(0, |found| found.len());
        said(Command::new("tar").arg("-xzf").arg(&package).arg("-C").arg(&unpacked))?;
        if member.is_published() {
            let own = licences(root, &unpacked.join(&name))?;
            packed.faults.extend(own.iter().map(|fault| format!("{name}: {fault}")));
        }
        for Outside { source, line, included } in outside(&unpacked.join(&name))? {
            packed.faults.push(format!(
                "{name}: {source}:{line} includes {included}, which is not in the package: move it into the crate"
            ));
        }
    }
    packed.steps.push(format!("unpacked and read after {:.1} s", begun.elapsed().as_secs_f64()));
    if install && packed.faults.is_empty() {
        let program = installed(root, target, &unpacked, &of_registry)?;
        packed.steps.push(format!("installed after {:.1} s", begun.elapsed().as_secs_f64()));
        packed.steps.push(run_elsewhere(root, &program)?);
    }
    Ok(packed)
}

/// A workspace of the unpacked packages and nothing else: the program installed from it.
fn installed(
    root: &Path,
    target: &Path,
    unpacked: &Path,
    members: &[&Manifest],
) -> Result<PathBuf, XtaskError> {
    let manifest = files::read(&root.join("Cargo.toml"))?;
    // the same profiles: what is built already need not be built again
    let profiles = manifest.find("[profile.dev]").map_or("", |at| &manifest[at..]);
    let names: Vec<String> =
        members.iter().map(|own| format!("{}-{}", own.name, own.version)).collect();
    let patches = members.iter().zip(&names);
    let patches: Vec<String> =
        patches.map(|(own, name)| format!("{} = {{ path = \"{name}\" }}\n", own.name)).collect();
    let text = format!(
        "[workspace]\nresolver = \"3\"\nmembers = {names:?}\n\n[patch.crates-io]\n{}\n{profiles}",
        patches.concat()
    );
    files::write_atomically(&unpacked.join("Cargo.toml"), &text)?;
    files::write_atomically(&unpacked.join("Cargo.lock"), &files::read(&root.join("Cargo.lock"))?)?;
    let place = unpacked.join("installed");
    let driver = names.iter().find(|name| name.starts_with("sim-driver-")).cloned();
    let mut install = Command::new("cargo");
    install.args(["install", "--debug", "--offline", "--no-track", "--path"]);
    install.arg(unpacked.join(driver.unwrap_or_default()));
    install.arg("--root").arg(&place).arg("--target-dir").arg(target);
    said(install.current_dir(unpacked))?;
    Ok(place.join("bin").join(format!("hhc{}", std::env::consts::EXE_SUFFIX)))
}

/// Runs a program in a folder of its own: the case to start from, its check, modes, the paper's study. Where the system allows
/// it, the repository at `root` is out of sight meanwhile.
fn run_elsewhere(root: &Path, program: &Path) -> Result<String, XtaskError> {
    let failed = |source| XtaskError::Write { path: "a temporary folder".into(), source };
    let place = tempfile::tempdir().map_err(failed)?;
    // it was installed below the folder of what is built, which may be inside the repository
    let copy = place.path().join("hhc");
    std::fs::copy(program, &copy).map_err(failed)?;
    let run = |is_hidden: bool, arguments: &[&str]| {
        let mut command = Command::new(if is_hidden { Path::new("unshare") } else { &copy });
        if is_hidden {
            let hide = "mount -t tmpfs none \"$1\" && shift && exec \"$@\"";
            command.args(["-rm", "sh", "-c", hide, "sh"]).arg(root).arg(&copy);
        }
        said(command.args(arguments).current_dir(place.path()).env_clear())
    };
    let is_hidden = run(true, &["--version"]).is_ok();
    let mut ran = Vec::new();
    for arguments in [
        &["--version"][..],
        &["init", "case.ron"],
        &["check", "case.ron"],
        &["modes"],
        &["--inflow", "uniform", "--out", "out"],
    ] {
        run(is_hidden, arguments)?;
        ran.push(format!("hhc {}", arguments.join(" ")));
    }
    let sight = if is_hidden { "out of sight" } else { "in sight" };
    Ok(format!("ran in another folder, the repository {sight}: {}", ran.join("; ")))
}

/// Runs a program to its end.
fn said(command: &mut Command) -> Result<(), XtaskError> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command
        .output()
        .map_err(|source| XtaskError::Start { program: program.clone(), source })?;
    if output.status.success() {
        return Ok(());
    }
    let said = String::from_utf8_lossy(&output.stderr);
    let lines: Vec<&str> = said.lines().filter(|line| !line.trim().is_empty()).collect();
    // the cause stands at the end
    let said = lines[lines.len().saturating_sub(6)..].join("\n");
    Err(XtaskError::Refused { program, said })
}

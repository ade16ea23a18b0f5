//! Which programs make a result.

use std::path::Path;
use std::process::Command;

use crate::{XtaskError, files};

/// The programs of a run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Programs {
    /// Hash of the program that diagnoses and of this one, 16 digits.
    pub(super) key: String,
    /// Version and commit of the first, and both hashes.
    pub(super) text: String,
}

impl Programs {
    /// The program that diagnoses and this one, which generates and scores.
    pub(super) fn of(root: &Path, program: &Path) -> Result<Self, XtaskError> {
        let own = std::env::current_exe()
            .map_err(|source| XtaskError::Start { program: "xtask".to_owned(), source })?;
        let hash = |path: &Path| -> Result<String, XtaskError> {
            let hash = blake3::hash(&files::read_bytes(path)?).to_hex();
            Ok(hash.as_str()[..8].to_owned())
        };
        let (diagnosing, generating) = (hash(program)?, hash(&own)?);
        let version = said(Command::new(program).arg("--version"));
        let text = format!(
            "{} at commit {}, program {diagnosing}, generator {generating}",
            version.unwrap_or("hhc".to_owned()),
            commit(root),
        );
        Ok(Self { key: format!("{diagnosing}{generating}"), text })
    }
}

/// The commit of the tree, and whether there are changes since.
pub(crate) fn commit(root: &Path) -> String {
    let git = |arguments: &[&str]| said(Command::new("git").args(arguments).current_dir(root));
    let commit = git(&["rev-parse", "--short", "HEAD"]).unwrap_or("unknown".to_owned());
    let changed = git(&["status", "--porcelain"]).is_some_and(|text| !text.is_empty());
    format!("{commit}{}", if changed { " with changes" } else { "" })
}

/// What a program says, if it can be started and ends well.
pub(crate) fn said(command: &mut Command) -> Option<String> {
    let output = command.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

//! A folder of its own in which the program runs, and what stands in it.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

use crate::{XtaskError, files};

/// A case that is quick to run: that of the tests of the command.
pub(super) const CASE: &str = include_str!("../../shared/quick.ron");

/// How files that are being written are named, so that none is taken for a result.
const UNFINISHED: &str = ".hhc-";

/// Content by path from a folder.
pub(super) type Files = BTreeMap<String, Vec<u8>>;

/// A temporary folder with the program.
pub(super) struct Place {
    folder: tempfile::TempDir,
    program: PathBuf,
}

impl Place {
    /// A folder with the case `case.ron` in it.
    pub(super) fn new(program: &Path) -> Result<Self, XtaskError> {
        let program = program
            .canonicalize()
            .map_err(|source| XtaskError::Read { path: program.to_path_buf(), source })?;
        let made = tempfile::tempdir();
        let folder =
            made.map_err(|source| XtaskError::Write { path: "a temporary folder".into(), source })?;
        let place = Self { folder, program };
        place.write("case.ron", CASE)?;
        Ok(place)
    }

    pub(super) fn path(&self) -> &Path {
        self.folder.path()
    }

    pub(super) fn program(&self) -> &Path {
        &self.program
    }

    pub(super) fn write(&self, name: &str, text: &str) -> Result<(), XtaskError> {
        files::write_atomically(&self.path().join(name), text)
    }

    /// The program here, on one thread.
    pub(super) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.args(arguments).current_dir(self.path()).env("RAYON_NUM_THREADS", "1");
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command
    }

    pub(super) fn spawn(&self, arguments: &[&str]) -> Result<Child, XtaskError> {
        self.command(arguments).spawn().map_err(|source| self.not_started(source))
    }

    /// What the program says, which must end well.
    pub(super) fn said(&self, arguments: &[&str]) -> Result<String, XtaskError> {
        let mut command = self.command(arguments);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let Output { status, stdout, stderr } =
            command.output().map_err(|source| self.not_started(source))?;
        if !status.success() {
            let said = String::from_utf8_lossy(&stderr).trim().to_owned();
            return Err(XtaskError::Refused {
                program: format!("hhc {}", arguments.join(" ")),
                said,
            });
        }
        Ok(String::from_utf8_lossy(&stdout).into_owned())
    }

    fn not_started(&self, source: std::io::Error) -> XtaskError {
        XtaskError::Start { program: self.program.display().to_string(), source }
    }

    /// The files below a folder, those that are being written apart.
    pub(super) fn files(&self, folder: &str) -> Files {
        let mut found = Files::new();
        collect(&self.path().join(folder), "", &mut |name, path, is_whole| {
            // a file may be put in place while it is looked at
            if let Some(bytes) = files::read_bytes(path).ok().filter(|_| is_whole) {
                found.insert(name, bytes);
            }
        });
        found
    }

    /// How many files below a folder were being written.
    pub(super) fn unfinished(&self, folder: &str) -> usize {
        let mut count = 0;
        collect(&self.path().join(folder), "", &mut |_, _, is_whole| {
            count += usize::from(!is_whole);
        });
        count
    }
}

fn collect(folder: &Path, prefix: &str, found: &mut dyn FnMut(String, &Path, bool)) {
    for path in files::in_folder(folder).unwrap_or_default() {
        let own = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let name = format!("{prefix}{own}");
        if path.is_dir() && !own.starts_with(UNFINISHED) {
            collect(&path, &format!("{name}/"), found);
        } else {
            found(name, &path, !own.starts_with(UNFINISHED));
        }
    }
}

/// Files of `found` that `whole` does not have, or has with other content.
pub(super) fn strange(found: &Files, whole: &Files) -> Vec<String> {
    found
        .iter()
        .filter(|(name, bytes)| whole.get(*name) != Some(bytes))
        .map(|(name, _)| name.clone())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A file that is cut off, one that no undisturbed run has, and one that is being written.
    #[test]
    fn half_files_are_told_from_whole_ones() {
        let place = Place::new(&std::env::current_exe().unwrap()).unwrap();
        let whole = Files::from([("a".to_owned(), b"12".to_vec()), ("d/b".to_owned(), vec![])]);
        for (name, text) in [("out/a", "12"), ("out/d/b", ""), ("out/d/.hhc-x", "1")] {
            place.write(name, text).unwrap();
        }
        assert_eq!((place.files("out"), place.unfinished("out")), (whole.clone(), 1));
        place.write("out/a", "1").unwrap();
        place.write("out/c", "").unwrap();
        assert_eq!(strange(&place.files("out"), &whole), ["a", "c"]);
        assert_eq!(strange(&whole, &place.files("out")), ["a"]);
    }
}

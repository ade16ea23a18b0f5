//! Disks without space and folders that take no file: an error that says so, and no file that is half there.
//!
//! A small file system in memory stands for the disk, in a name space of its own, which needs no right of the user. Where the
//! system allows none, a limit of file size stands for it.

use std::path::Path;
use std::process::Command;

use super::place::{Place, strange};
use crate::{XtaskError, files};

/// What was tried on a disk.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tried {
    /// What the disk is.
    pub disk: String,
    /// What was run.
    pub what: String,
    /// Exit code.
    pub code: Option<i32>,
    /// The first line of the error.
    pub said: String,
    /// Files on the disk afterwards.
    pub files: usize,
    /// What must not be.
    pub faults: Vec<String>,
}

impl std::fmt::Display for Tried {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { disk, what, code, said, files, .. } = self;
        let code = code.map_or("none".to_owned(), |code| code.to_string());
        write!(f, "{disk}: {what}: exit {code}, {files} files whole on it: {said}")
    }
}

/// What is run: its name and its arguments.
type Run<'a> = (&'a str, &'a [&'a str]);

/// Runs commands that write to `out` on full disks and in a folder that takes no file.
///
/// # Errors
/// [`XtaskError`] if an undisturbed run fails, or no shell can be started.
pub fn fill(program: &Path) -> Result<Vec<Tried>, XtaskError> {
    let mut tried = Vec::new();
    for (what, arguments) in [
        ("study", &["run", "case.ron", "--out", "out"][..]),
        ("sweep", &["sweep", "run", "sweep.ron", "--out", "out"][..]),
    ] {
        let place = Place::new(program)?;
        place.write(
            "sweep.ron",
            "(base: \"case.ron\", axes: [(field: \"rotor.gj\", from: 0.005, to: 0.007, count: 60)])",
        )?;
        place.said(arguments)?;
        let whole = place.files("out");
        files::remove_folder(&place.path().join("out"))?;
        let probe = "mkdir -p out && unshare -rm mount -t tmpfs none out";
        let may_mount = shell(&place, probe, &[]).is_ok_and(|(code, _)| code == Some(0));
        let mounted = |options: &str| {
            format!(
                "mkdir -p out kept; exec unshare -rm sh -c 'mount -t tmpfs -o {options} none out && \
                 \"$0\" \"$@\"; code=$?; cp -r out/. kept; exit $code' \"$0\" \"$@\""
            )
        };
        let limited = "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"".to_owned();
        let disks = if may_mount {
            vec![
                ("a disk of 4 KB", mounted("size=4k")),
                ("a disk of 64 KB", mounted("size=64k")),
                ("a disk that is read only", mounted("ro,size=64k")),
                ("a limit of 4 KB a file", limited),
            ]
        } else {
            vec![("a limit of 4 KB a file", limited)]
        };
        for (disk, script) in disks {
            tried.push(on_disk(&place, disk, &script, (what, arguments), &whole)?);
        }
    }
    Ok(tried)
}

fn on_disk(
    place: &Place,
    disk: &str,
    script: &str,
    (what, arguments): Run<'_>,
    whole: &super::place::Files,
) -> Result<Tried, XtaskError> {
    for folder in ["out", "kept"] {
        files::remove_folder(&place.path().join(folder))?;
    }
    let (code, said) = shell(place, script, arguments)?;
    let kept = if place.path().join("kept").is_dir() { "kept" } else { "out" };
    let found = place.files(kept);
    let mut faults: Vec<String> = strange(&found, whole)
        .into_iter()
        .map(|name| format!("{disk}: {what}: {name} is not that of an undisturbed run"))
        .collect();
    if place.unfinished(kept) > 0 {
        faults.push(format!("{disk}: {what}: a file under a temporary name is left"));
    }
    if code != Some(2) || !said.contains("cannot be written") {
        faults.push(format!(
            "{disk}: {what}: expected exit 2 and `cannot be written`, found {code:?}: {said}"
        ));
    }
    let said = said.lines().next().unwrap_or_default().to_owned();
    Ok(Tried {
        disk: disk.to_owned(),
        what: what.to_owned(),
        code,
        said,
        files: found.len(),
        faults,
    })
}

/// Exit code and errors of a script, whose `$0` is the program and whose arguments are those of it.
fn shell(
    place: &Place,
    script: &str,
    arguments: &[&str],
) -> Result<(Option<i32>, String), XtaskError> {
    let mut command = Command::new("sh");
    command.args(["-c", script]).arg(place.program()).args(arguments).current_dir(place.path());
    let output = command
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .map_err(|source| XtaskError::Start { program: "sh".to_owned(), source })?;
    Ok((output.status.code(), String::from_utf8_lossy(&output.stderr).trim().to_owned()))
}

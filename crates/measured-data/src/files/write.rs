//! Atomic writing: a file appears whole or not at all.

use super::{RonIndex, Source};
use crate::error::DataError;
use std::io::{Error, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// Links followed before they are taken for a ring.
const MOST_LINKS: usize = 40;

/// Writes a file through a temporary one in the same folder, which is created if needed.
///
/// A symbolic link stays: the file it leads to is the one written. What is no regular file (a pipe, a
/// device, standard output) is written to as it is, never replaced.
///
/// # Errors
/// [`DataError::NotWritten`]; a file that was at `path` before is then still there.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), DataError> {
    let write = || match Target::of(path)? {
        Target::Descriptor(1) => through(std::io::stdout().lock(), bytes),
        Target::Descriptor(2) => through(std::io::stderr().lock(), bytes),
        Target::Descriptor(_) | Target::Special => {
            through(std::fs::OpenOptions::new().write(true).open(path)?, bytes)
        }
        Target::File(file) => {
            prepare(&file, bytes)?.persist(&file).map(|_| ()).map_err(|e| e.error)
        }
    };
    write().map_err(|e| not_written(path, &e))
}

fn through(mut place: impl Write, bytes: &[u8]) -> std::io::Result<()> {
    place.write_all(bytes)?;
    place.flush()
}

/// What a path leads to.
#[derive(Debug, PartialEq)]
enum Target {
    /// A regular file, or none yet: its path with all links followed.
    File(PathBuf),
    /// A file this process holds open, by its number: `/dev/stdout` is 1.
    Descriptor(u32),
    /// Something else: a pipe, a device, a folder.
    Special,
}

impl Target {
    fn of(path: &Path) -> std::io::Result<Self> {
        let mut at = path.to_path_buf();
        for _ in 0..MOST_LINKS {
            if let Some(number) = own_descriptor(&at) {
                return Ok(Self::Descriptor(number));
            }
            match std::fs::read_link(&at) {
                Ok(link) => at = parent_of(&at).join(link),
                Err(_) if at.exists() && !at.is_file() => return Ok(Self::Special),
                Err(_) => return Ok(Self::File(at)),
            }
        }
        Err(Error::new(ErrorKind::InvalidInput, "a ring of symbolic links"))
    }
}

/// The number of an open file of this process, from a path such as `/proc/self/fd/1`.
fn own_descriptor(path: &Path) -> Option<u32> {
    let number = path.file_name()?.to_str()?.parse().ok()?;
    let open = Path::new("/proc/self/fd").canonicalize().ok()?;
    (parent_of(path).canonicalize().ok()? == open).then_some(number)
}

/// Refuses to replace a file that a command reads with what it writes.
///
/// # Errors
/// [`DataError::WouldOverwriteInput`] if both paths lead to the same regular file.
pub fn refuse_input(input: &Path, output: &Path) -> Result<(), DataError> {
    if is_same(input, output) && output.is_file() {
        return Err(DataError::WouldOverwriteInput { path: output.to_path_buf() });
    }
    Ok(())
}

/// Refuses to replace a file that is not of a kind, the value of its field `kind`. Empty files and what is no regular
/// file are let pass.
///
/// # Errors
/// [`DataError::WouldOverwriteOther`].
pub fn refuse_other_kind(path: &Path, kind: &'static str) -> Result<(), DataError> {
    let is_empty = path.metadata().is_ok_and(|found| found.len() == 0);
    if !path.is_file() || is_empty {
        return Ok(());
    }
    // what cannot be read as text is of no kind
    let source = Source::read(path).ok();
    let found = source.map(|source| RonIndex::new(&source.name, &source.text));
    let is_kind = found.and_then(|index| Some(index.value_text("kind")?.trim() == kind));
    match is_kind {
        Some(true) => Ok(()),
        _ => Err(DataError::WouldOverwriteOther { path: path.to_path_buf(), kind }),
    }
}

/// Refuses to replace a file that does not hold a text which all files of a kind hold. Empty files and what is no regular
/// file are let pass.
///
/// # Errors
/// [`DataError::WouldOverwriteOther`].
pub fn refuse_other_text(path: &Path, held: &str, kind: &'static str) -> Result<(), DataError> {
    let is_empty = path.metadata().is_ok_and(|found| found.len() == 0);
    let is_own = || Source::read(path).is_ok_and(|source| source.text.contains(held));
    if !path.is_file() || is_empty || is_own() {
        return Ok(());
    }
    Err(DataError::WouldOverwriteOther { path: path.to_path_buf(), kind })
}

/// Refuses to replace files of a folder, each given by its name and a text that all files of `hhc` with that name hold.
///
/// # Errors
/// [`DataError::WouldOverwriteOther`] of the first that does not hold its text.
pub fn refuse_foreign<'a>(
    folder: &Path,
    mut files: impl Iterator<Item = (&'a str, &'a str)>,
) -> Result<(), DataError> {
    files.try_for_each(|(name, held)| refuse_other_text(&folder.join(name), held, "result of hhc"))
}

/// The file for what is made of a data folder if the user names none: the folder's name with the ending `.ron`, in the working
/// folder.
pub fn default_model_file(data: &Path) -> PathBuf {
    // `.` and `..` have no name of their own
    let whole = data.canonicalize().unwrap_or_else(|_| data.to_owned());
    let name = whole.file_name().map_or_else(|| "model".into(), |name| name.display().to_string());
    PathBuf::from(format!("{name}.ron"))
}

/// Whether two paths lead to the same file or folder.
fn is_same(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Refuses a folder that no file can be written to, before what is to be written is computed. Leaves nothing behind: of a
/// folder that is not there yet, the nearest one above is tried.
///
/// # Errors
/// [`DataError::NotWritten`].
pub fn refuse_unwritable(folder: &Path) -> Result<(), DataError> {
    let there = folder.ancestors().find(|above| above.exists());
    let tried = match there {
        Some(above) if !above.as_os_str().is_empty() => above,
        _ => Path::new("."),
    };
    temporary(0o666).tempfile_in(tried).map(|_| ()).map_err(|e| not_written(folder, &e))
}

/// Like [`write_atomic`], but refuses to replace a file.
///
/// # Errors
/// [`DataError::WouldOverwrite`] or [`DataError::NotWritten`].
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<(), DataError> {
    let taken = || DataError::WouldOverwrite { path: path.to_path_buf() };
    if path.exists() {
        return Err(taken());
    }
    let file = prepare(path, bytes).map_err(|e| not_written(path, &e))?;
    file.persist_noclobber(path).map(|_| ()).map_err(|e| {
        if e.error.kind() == std::io::ErrorKind::AlreadyExists {
            taken()
        } else {
            not_written(path, &e.error)
        }
    })
}

/// Removes a regular file whose text is known as written by this program; whether it was there. Anything else stays: other
/// text, what is no text, links, what is not there.
///
/// # Errors
/// [`DataError::NotWritten`] of a file that is known and cannot be removed.
pub fn remove_own(path: &Path, is_own: impl Fn(&str) -> bool) -> Result<bool, DataError> {
    let is_regular = path.symlink_metadata().is_ok_and(|found| found.is_file());
    if !is_regular || !Source::read(path).is_ok_and(|source| is_own(&source.text)) {
        return Ok(false);
    }
    std::fs::remove_file(path).map(|()| true).map_err(|e| not_written(path, &e))
}

/// Refuses to replace a file of a data folder with a result.
///
/// # Errors
/// [`DataError::WouldOverwriteData`] if `path` is a file that lies directly in `data`.
pub fn refuse_inside(data: &Path, path: &Path) -> Result<(), DataError> {
    if path.exists() && is_same(data, parent_of(path)) {
        return Err(DataError::WouldOverwriteData { path: path.to_path_buf() });
    }
    Ok(())
}

/// Writes a new folder with its files: it appears whole or not at all.
///
/// # Errors
/// [`DataError::WouldOverwrite`] if something is at `path` already, [`DataError::NotWritten`].
pub fn write_folder(path: &Path, files: &[(String, Vec<u8>)]) -> Result<(), DataError> {
    if path.exists() {
        return Err(DataError::WouldOverwrite { path: path.to_path_buf() });
    }
    let parent = parent_of(path);
    let whole = || -> std::io::Result<()> {
        std::fs::create_dir_all(parent)?;
        let folder = temporary(0o777).tempdir_in(parent)?;
        for (name, bytes) in files {
            prepare(&folder.path().join(name), bytes)?
                .persist_noclobber(folder.path().join(name))
                .map_err(|e| e.error)?;
        }
        // renamed last; an error leaves the temporary folder to be removed
        std::fs::rename(folder.path(), path)?;
        let _moved_away = folder.keep();
        Ok(())
    };
    whole().map_err(|e| not_written(path, &e))
}

fn parent_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// What makes temporary files and folders: the user's umask applies to `mode` as to any new one.
#[cfg_attr(not(unix), expect(unused_variables, reason = "there are no modes"))]
fn temporary(mode: u32) -> tempfile::Builder<'static, 'static> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hhc-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(mode));
    }
    builder
}

fn prepare(path: &Path, bytes: &[u8]) -> std::io::Result<tempfile::NamedTempFile> {
    let folder = parent_of(path);
    std::fs::create_dir_all(folder)?;
    let mut file = temporary(0o666).tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

fn not_written(path: &Path, error: &std::io::Error) -> DataError {
    DataError::NotWritten { path: path.to_path_buf(), reason: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[expect(clippy::disallowed_methods, reason = "reads back what was written")]
    fn files_are_replaced_whole_and_new_ones_never_replace() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("deep/er/file.txt");
        write_atomic(&path, b"one").unwrap();
        write_atomic(&path, b"two").unwrap();
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "two");
        let error = write_new(&path, b"three").unwrap_err();
        assert!(matches!(error, DataError::WouldOverwrite { .. }));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "two");
        let left: Vec<_> = std::fs::read_dir(path.parent().unwrap()).unwrap().collect();
        assert_eq!(left.len(), 1, "no temporary file stays behind");
    }

    #[test]
    fn only_a_file_of_the_kind_is_replaced_unasked() {
        let place = tempfile::tempdir().unwrap();
        let refused = |name: &str, bytes: &[u8]| {
            let path = place.path().join(name);
            write_atomic(&path, bytes).unwrap();
            refuse_other_kind(&path, "Actuator").is_err()
        };
        assert!(!refused(
            "own.ron",
            b"(\n    // a comment\n    kind: Actuator,\n    title: \"t\",\n)"
        ));
        assert!(!refused("empty", b""));
        assert!(refused("case.ron", b"(title: \"kind: Actuator\", advance_ratio: 0.3)"));
        assert!(refused("dataset.ron", b"(kind: ActuatorBench, title: \"t\", runs: [])"));
        assert!(refused("data.csv", b"time_s,command_V\n0,1\n"));
        assert!(refused("bytes", &[0xff, 0x00, 0x80]));
        refuse_other_kind(&place.path().join("none"), "Actuator").unwrap();
        let of_text = |name: &str, held: &str| {
            refuse_other_text(&place.path().join(name), held, "page").is_ok()
        };
        assert!(of_text("own.ron", "a comment") && of_text("empty", "a") && of_text("none", "a"));
        assert!(!of_text("data.csv", "a comment") && !of_text("bytes", "a comment"));
        let known = [("own.ron", "a comment"), ("none", "a"), ("data.csv", "time_s,")];
        refuse_foreign(place.path(), known.into_iter()).unwrap();
        let error = refuse_foreign(place.path(), [known[0], ("data.csv", "psi,")].into_iter());
        let text = error.unwrap_err().to_string();
        assert!(text.contains("data.csv exists already and is no file of kind result"), "{text}");
    }

    #[cfg(unix)]
    #[test]
    #[expect(clippy::disallowed_methods, reason = "reads back what was written")]
    fn links_stay_and_lead_to_the_file() {
        let place = tempfile::tempdir().unwrap();
        let at = |name: &str| place.path().join(name);
        write_atomic(&at("deep/file"), b"old").unwrap();
        std::os::unix::fs::symlink("deep/file", at("link")).unwrap();
        std::os::unix::fs::symlink("link", at("second")).unwrap();
        std::os::unix::fs::symlink("deep/new", at("dangling")).unwrap();
        for (name, file) in
            [("link", "deep/file"), ("second", "deep/file"), ("dangling", "deep/new")]
        {
            write_atomic(&at(name), name.as_bytes()).unwrap();
            assert!(at(name).symlink_metadata().unwrap().is_symlink(), "{name}");
            assert_eq!(std::fs::read_to_string(at(file)).unwrap(), name);
        }
        std::os::unix::fs::symlink("ring", at("ring")).unwrap();
        let error = write_atomic(&at("ring"), b"x").unwrap_err();
        assert!(matches!(error, DataError::NotWritten { .. }), "{error}");
        let error = refuse_input(&at("second"), &at("deep/file")).unwrap_err();
        assert!(matches!(error, DataError::WouldOverwriteInput { .. }));
        refuse_input(&at("second"), &at("deep/new")).unwrap();
        refuse_input(&at("gone"), &at("gone")).unwrap();
    }

    #[cfg(unix)]
    #[test]
    #[expect(clippy::disallowed_methods, reason = "reads back what was written")]
    fn a_pipe_gets_the_text_and_stays_a_pipe() {
        use std::os::unix::fs::FileTypeExt;
        let place = tempfile::tempdir().unwrap();
        let pipe = place.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || std::fs::read_to_string(pipe).unwrap()
        });
        write_atomic(&pipe, b"S,cn\n").unwrap();
        assert!(pipe.metadata().unwrap().file_type().is_fifo());
        assert_eq!(reader.join().unwrap(), "S,cn\n");
    }

    /// On a copy of the device that is always full, where the system lets one be made.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_an_error_and_stays_a_device() {
        use std::os::unix::fs::FileTypeExt;
        let place = tempfile::tempdir().unwrap();
        let device = place.path().join("full");
        let made = std::process::Command::new("mknod").arg(&device).args(["c", "1", "7"]).output();
        if !made.is_ok_and(|made| made.status.success()) {
            return;
        }
        match write_atomic(&device, b"x") {
            Err(DataError::NotWritten { .. }) => {}
            other => panic!("{other:?}"),
        }
        assert!(device.metadata().unwrap().file_type().is_char_device());
        assert_eq!(Target::of(&device).unwrap(), Target::Special);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn standard_output_is_written_to_and_never_replaced() {
        assert_eq!(Target::of(Path::new("/dev/stdout")).unwrap(), Target::Descriptor(1));
        assert_eq!(Target::of(Path::new("/dev/fd/2")).unwrap(), Target::Descriptor(2));
    }

    #[test]
    fn a_folder_appears_whole_or_not_at_all() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a/data");
        let files = [("x.csv".to_owned(), b"1".to_vec()), ("y.csv".to_owned(), b"2".to_vec())];
        write_folder(&path, &files).unwrap();
        assert!(path.join("x.csv").is_file() && path.join("y.csv").is_file());
        let error = write_folder(&path, &files).unwrap_err();
        assert!(matches!(error, DataError::WouldOverwrite { .. }));
        // the second file cannot be written: nothing stays
        let bad = [files[0].clone(), ("x.csv/below".to_owned(), vec![])];
        let error = write_folder(&place.path().join("b"), &bad).unwrap_err();
        assert!(matches!(error, DataError::NotWritten { .. }));
        let left: Vec<_> = std::fs::read_dir(place.path()).unwrap().collect();
        assert_eq!(left.len(), 1, "{left:?}");
    }

    #[test]
    fn only_what_is_known_is_removed() {
        let place = tempfile::tempdir().unwrap();
        let is_own = |text: &str| text.starts_with("own,");
        let left = |name: &str, bytes: &[u8]| {
            let path = place.path().join(name);
            write_atomic(&path, bytes).unwrap();
            let is_removed = remove_own(&path, is_own).unwrap();
            assert_eq!(is_removed, !path.exists());
            path.exists()
        };
        assert!(!left("own.csv", b"own,table\n1,2\n"));
        assert!(left("other.csv", b"my,table\n1,2\n") && left("bytes", &[0xff, 0x00]));
        assert!(!remove_own(&place.path().join("none.csv"), is_own).unwrap());
        assert!(!remove_own(place.path(), is_own).unwrap());
        #[cfg(unix)]
        {
            let (to, link) = (place.path().join("to.csv"), place.path().join("link.csv"));
            write_atomic(&to, b"own,table\n").unwrap();
            std::os::unix::fs::symlink(&to, &link).unwrap();
            assert!(!remove_own(&link, is_own).unwrap() && to.is_file());
        }
    }

    #[test]
    fn an_impossible_place_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        write_atomic(&folder.path().join("file"), b"x").unwrap();
        let error = write_atomic(&folder.path().join("file/below"), b"x").unwrap_err();
        assert!(matches!(error, DataError::NotWritten { .. }));
        for place in ["file", "file/below", "file/far/below"] {
            let error = refuse_unwritable(&folder.path().join(place)).unwrap_err();
            assert!(matches!(error, DataError::NotWritten { .. }), "{place}");
        }
        refuse_unwritable(&folder.path().join("new/folder")).unwrap();
        let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().collect();
        assert_eq!(left.len(), 1, "nothing is left behind: {left:?}");
    }
}

//! Atomic writing: a file appears whole or not at all.

use crate::SimError;
use std::io::Write;
use std::path::Path;

/// Writes a file through a temporary one in the same folder, which is created if needed.
///
/// # Errors
/// [`SimError::NotWritten`]; whatever was at `path` before is then still there.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), SimError> {
    prepare(path, bytes)
        .and_then(|file| file.persist(path).map(|_| ()).map_err(|e| e.error))
        .map_err(|e| not_written(path, &e))
}

/// Like [`write_atomic`], but refuses to replace a file.
///
/// # Errors
/// [`SimError::WouldOverwrite`] or [`SimError::NotWritten`].
pub fn write_new(path: &Path, bytes: &[u8]) -> Result<(), SimError> {
    let taken = || SimError::WouldOverwrite { path: path.to_path_buf() };
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

/// Refuses to replace a file of a data folder with a result.
///
/// # Errors
/// [`SimError::WouldOverwrite`] if `path` is a file that lies directly in `data`.
pub fn refuse_inside(data: &Path, path: &Path) -> Result<(), SimError> {
    let same = |a: &Path, b: &Path| match (a.canonicalize(), b.canonicalize()) {
        (Ok(a), Ok(b)) => a == b,
        _ => false,
    };
    if path.exists() && same(data, parent_of(path)) {
        return Err(SimError::WouldOverwrite { path: path.to_path_buf() });
    }
    Ok(())
}

/// Writes a new folder with its files: it appears whole or not at all.
///
/// # Errors
/// [`SimError::WouldOverwrite`] if something is at `path` already, [`SimError::NotWritten`].
pub fn write_folder(path: &Path, files: &[(String, Vec<u8>)]) -> Result<(), SimError> {
    if path.exists() {
        return Err(SimError::WouldOverwrite { path: path.to_path_buf() });
    }
    let parent = parent_of(path);
    let whole = || -> std::io::Result<()> {
        std::fs::create_dir_all(parent)?;
        let mut builder = tempfile::Builder::new();
        builder.prefix(".hhc-");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            builder.permissions(std::fs::Permissions::from_mode(0o777));
        }
        let folder = builder.tempdir_in(parent)?;
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

fn prepare(path: &Path, bytes: &[u8]) -> std::io::Result<tempfile::NamedTempFile> {
    let folder = parent_of(path);
    std::fs::create_dir_all(folder)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".hhc-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        // the user's umask applies to this as to any new file
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder)?;
    file.write_all(bytes)?;
    file.as_file().sync_all()?;
    Ok(file)
}

fn not_written(path: &Path, error: &std::io::Error) -> SimError {
    SimError::NotWritten { path: path.to_path_buf(), reason: error.to_string() }
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
        assert!(matches!(error, SimError::WouldOverwrite { .. }));
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "two");
        let left: Vec<_> = std::fs::read_dir(path.parent().unwrap()).unwrap().collect();
        assert_eq!(left.len(), 1, "no temporary file stays behind");
    }

    #[test]
    fn a_folder_appears_whole_or_not_at_all() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("a/data");
        let files = [("x.csv".to_owned(), b"1".to_vec()), ("y.csv".to_owned(), b"2".to_vec())];
        write_folder(&path, &files).unwrap();
        assert!(path.join("x.csv").is_file() && path.join("y.csv").is_file());
        let error = write_folder(&path, &files).unwrap_err();
        assert!(matches!(error, SimError::WouldOverwrite { .. }));
        // the second file cannot be written: nothing stays
        let bad = [files[0].clone(), ("x.csv/below".to_owned(), vec![])];
        let error = write_folder(&place.path().join("b"), &bad).unwrap_err();
        assert!(matches!(error, SimError::NotWritten { .. }));
        let left: Vec<_> = std::fs::read_dir(place.path()).unwrap().collect();
        assert_eq!(left.len(), 1, "{left:?}");
    }

    #[test]
    fn an_impossible_place_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        write_atomic(&folder.path().join("file"), b"x").unwrap();
        let error = write_atomic(&folder.path().join("file/below"), b"x").unwrap_err();
        assert!(matches!(error, SimError::NotWritten { .. }));
    }
}

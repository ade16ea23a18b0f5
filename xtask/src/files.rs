//! Reading and atomic writing of text files.

use std::io::Write;
use std::path::{Path, PathBuf};

use crate::XtaskError;

/// The text of a file.
///
/// # Errors
/// [`XtaskError::Read`] if there is no such file or it is not UTF-8.
pub fn read(path: &Path) -> Result<String, XtaskError> {
    std::fs::read_to_string(path)
        .map_err(|source| XtaskError::Read { path: path.to_path_buf(), source })
}

/// The bytes of a file.
///
/// # Errors
/// [`XtaskError::Read`] if there is no such file.
pub fn read_bytes(path: &Path) -> Result<Vec<u8>, XtaskError> {
    std::fs::read(path).map_err(|source| XtaskError::Read { path: path.to_path_buf(), source })
}

/// The files and folders of a folder, by name; none where there is no such folder.
///
/// # Errors
/// [`XtaskError::Read`] if it cannot be read.
pub fn in_folder(folder: &Path) -> Result<Vec<PathBuf>, XtaskError> {
    let failed = |source| XtaskError::Read { path: folder.to_path_buf(), source };
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let mut paths = std::fs::read_dir(folder)
        .map_err(failed)?
        .map(|entry| entry.map(|entry| entry.path()).map_err(failed))
        .collect::<Result<Vec<_>, _>>()?;
    paths.sort();
    Ok(paths)
}

/// Removes a folder with all it holds; one that is not there is removed already.
///
/// # Errors
/// [`XtaskError::Write`] if it cannot be removed.
pub fn remove_folder(path: &Path) -> Result<(), XtaskError> {
    match std::fs::remove_dir_all(path) {
        Err(source) if source.kind() != std::io::ErrorKind::NotFound => {
            Err(XtaskError::Write { path: path.to_path_buf(), source })
        }
        _ => Ok(()),
    }
}

/// Writes a file so that a reader sees the old text or the new one, never a part.
///
/// # Errors
/// [`XtaskError::Write`] if the folder cannot be made or the file cannot be put in place.
pub fn write_atomically(path: &Path, text: &str) -> Result<(), XtaskError> {
    let failed = |source| XtaskError::Write { path: path.to_path_buf(), source };
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    std::fs::create_dir_all(folder).map_err(failed)?;
    let mut file = tempfile::Builder::new().prefix(".new-").tempfile_in(folder).map_err(failed)?;
    file.write_all(text.as_bytes()).map_err(failed)?;
    readable_by_all(file.as_file()).map_err(failed)?;
    file.persist(path).map_err(|error| failed(error.error))?;
    Ok(())
}

/// Temporary files are private to their owner; a file of the tree is not.
#[cfg(unix)]
fn readable_by_all(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}

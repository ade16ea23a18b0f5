//! Where files come from: a folder on disk, or the files shipped inside the program.

use crate::problem::{Fault, Place, Problem};
use std::fmt;
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

/// A text file that was read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Source {
    /// Name for messages: the path as the user gave it.
    pub name: String,
    /// The text.
    pub text: String,
}

/// A folder that files are read from; relative paths in a file are relative to its folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Folder {
    /// A folder on disk.
    Disk(PathBuf),
    /// A folder of the files shipped inside the program.
    Embedded(Embedded),
}

/// A folder among files that are part of the program, or held in its memory.
#[derive(Clone, PartialEq, Eq)]
pub struct Embedded {
    /// Path of the folder, with `/` between its parts.
    path: String,
    files: Files,
}

/// Path and content of every file, in one folder or another.
#[derive(Clone, PartialEq, Eq)]
enum Files {
    /// Part of the program.
    Shipped(&'static [(&'static str, &'static [u8])]),
    /// Made while it runs.
    Held(Arc<[(String, Vec<u8>)]>),
}

impl Files {
    fn all(&self) -> impl Iterator<Item = (&str, &[u8])> {
        let (shipped, held): (&[_], &[_]) = match self {
            Self::Shipped(files) => (files, &[]),
            Self::Held(files) => (&[], files),
        };
        let held = held.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice()));
        shipped.iter().copied().chain(held)
    }
}

impl Embedded {
    /// The folder `path` among `files`, each with its path and its content.
    pub fn new(path: &str, files: &'static [(&'static str, &'static [u8])]) -> Self {
        Self { path: normalised(path), files: Files::Shipped(files) }
    }

    /// A folder `path` with the given texts, each with its name: data that are in memory are read and checked as those of a
    /// folder on disk.
    pub fn of_texts(path: &str, texts: Vec<(String, String)>) -> Self {
        let path = normalised(path);
        let held =
            texts.into_iter().map(|(name, text)| (format!("{path}/{name}"), text.into_bytes()));
        let files = Files::Held(held.collect());
        Self { path, files }
    }

    /// The path of a file of this folder.
    fn file(&self, file: &str) -> String {
        normalised(&format!("{}/{file}", self.path))
    }

    /// The content of a file of this folder.
    fn content(&self, file: &str) -> Option<&[u8]> {
        let path = self.file(file);
        self.files.all().find(|(name, _)| *name == path).map(|(_, bytes)| bytes)
    }
}

impl fmt::Debug for Embedded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Embedded").field(&self.path).finish()
    }
}

impl Folder {
    /// The folder that holds a file on disk.
    pub fn of_file(path: &Path) -> Self {
        Self::Disk(path.parent().map(Path::to_path_buf).unwrap_or_default())
    }

    /// The name of a file in this folder, as messages and results show it.
    pub fn display(&self, file: &str) -> String {
        match self {
            Self::Disk(folder) => folder.join(file).display().to_string(),
            Self::Embedded(folder) => folder.file(file),
        }
    }

    /// A folder relative to this one; an absolute path on disk stands for itself.
    #[must_use]
    pub fn join(&self, relative: &str) -> Self {
        match self {
            Self::Disk(folder) => Self::Disk(folder.join(relative)),
            Self::Embedded(folder) => {
                Self::Embedded(Embedded { path: folder.file(relative), ..folder.clone() })
            }
        }
    }

    /// Reads a text file of this folder.
    ///
    /// # Errors
    /// [`Fault::Unreadable`], [`Fault::NotText`] or [`Fault::NotShipped`].
    pub fn read(&self, file: &str) -> Result<Source, Problem> {
        let name = self.display(file);
        let refused = |fault| Problem::new(Place::file(&name), fault);
        let not_shipped = || refused(Fault::NotShipped { path: name.clone() });
        let bytes = match self {
            Self::Disk(folder) => read_bytes(&folder.join(file), &name)?,
            Self::Embedded(folder) => folder.content(file).ok_or_else(not_shipped)?.to_vec(),
        };
        as_text(name, bytes)
    }

    /// Size of a file of this folder, bytes; 0 if it cannot be told.
    pub fn size_bytes(&self, file: &str) -> u64 {
        match self {
            Self::Disk(folder) => std::fs::metadata(folder.join(file)).map_or(0, |m| m.len()),
            Self::Embedded(folder) => folder.content(file).map_or(0, |b| b.len() as u64),
        }
    }

    /// Names of the files of this folder, in alphabetical order; none of a folder that cannot be read.
    pub fn files(&self) -> Vec<String> {
        let mut names: Vec<String> = match self {
            Self::Disk(folder) => {
                let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
                let files = entries.filter(|entry| entry.path().is_file());
                files.filter_map(|entry| entry.file_name().into_string().ok()).collect()
            }
            Self::Embedded(folder) => {
                let own = folder.file("");
                let inside = |(path, _): &(&str, &[u8])| {
                    path.strip_prefix(&own)
                        .is_some_and(|rest| !rest.trim_matches('/').contains('/'))
                };
                let name =
                    |(path, _): (&str, &[u8])| path[own.len()..].trim_matches('/').to_owned();
                folder.files.all().filter(inside).map(name).collect()
            }
        };
        names.sort();
        names
    }

    /// Why a name that stands in a file of this folder may not be read: it leads out of the folder, by itself or by a link.
    /// None where it stays inside, or is not there.
    pub(crate) fn leads_out(&self, file: &str) -> Option<Fault> {
        let mut parts = Path::new(file).components();
        if file.is_empty() || !parts.all(|part| matches!(part, Component::Normal(_))) {
            return Some(Fault::Other(format!(
                "{file} is not a plain file name inside the data folder; give the name of a file in it"
            )));
        }
        let Self::Disk(folder) = self else { return None };
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let inside = folder.canonicalize().ok()?;
        let target = folder.join(file).canonicalize().ok()?;
        (!target.starts_with(&inside)).then(|| {
            Fault::Other(format!(
                "{file} is a link that leads out of the data folder; copy the file into it"
            ))
        })
    }

    /// Whether a file exists in this folder.
    pub fn contains(&self, file: &str) -> bool {
        match self {
            Self::Disk(folder) => folder.join(file).is_file(),
            Self::Embedded(folder) => folder.content(file).is_some(),
        }
    }
}

impl Source {
    /// Reads a text file on disk.
    ///
    /// # Errors
    /// [`Fault::Unreadable`] or [`Fault::NotText`].
    pub fn read(path: &Path) -> Result<Self, Problem> {
        let folder = Folder::of_file(path);
        if let Some(file) = path.file_name().and_then(|n| n.to_str()) {
            return folder.read(file);
        }
        let reason = "not a file name".to_owned();
        let place = Place::file(path.display().to_string());
        Err(Problem::new(place, Fault::Unreadable { reason }))
    }
}

/// Bytes as a source of a name.
fn as_text(name: String, bytes: Vec<u8>) -> Result<Source, Problem> {
    let text = String::from_utf8(bytes).map_err(|e| {
        let offset = e.utf8_error().valid_up_to();
        Problem::new(Place::file(&name), Fault::NotText { offset })
    })?;
    // a byte-order mark belongs to no format read here
    let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
    Ok(Source { name, text })
}

/// The path that stands for standard input.
pub(crate) const STANDARD_INPUT: &str = "-";

/// Opens a file to be read piece by piece.
///
/// # Errors
/// [`Fault::Unreadable`].
#[expect(clippy::disallowed_methods, reason = "beside `read_bytes` the one place that reads files")]
pub fn open_reader(path: &Path) -> Result<std::io::BufReader<std::fs::File>, Problem> {
    let unreadable = |fault| Problem::new(Place::file(path.display().to_string()), fault);
    let file = std::fs::File::open(path).map_err(|e| unreadable(e.into()))?;
    // a folder opens but cannot be read
    if file.metadata().is_ok_and(|m| m.is_dir()) {
        return Err(unreadable(Fault::Unreadable { reason: "it is a folder".into() }));
    }
    Ok(std::io::BufReader::with_capacity(1 << 16, file))
}

#[expect(clippy::disallowed_methods, reason = "the one place of the program that reads files")]
fn read_bytes(path: &Path, name: &str) -> Result<Vec<u8>, Problem> {
    std::fs::read(path).map_err(|e| Problem::new(Place::file(name), e.into()))
}

/// A path with `.` and `..` resolved and `/` between its parts.
fn normalised(path: &str) -> String {
    let mut parts: Vec<String> = Vec::new();
    for component in Path::new(path).components() {
        match component {
            Component::ParentDir => {
                parts.pop();
            }
            Component::Normal(part) => parts.push(part.to_string_lossy().into_owned()),
            _ => {}
        }
    }
    parts.join("/")
}

/// Names of folders, such as those of like specimens: as much of the end of each path as tells them apart.
///
/// # Errors
/// A folder that is given twice.
pub fn distinct_names(data: &[PathBuf]) -> Result<Vec<String>, Problem> {
    // a folder that is not there is told of where it is read
    let paths: Vec<PathBuf> =
        data.iter().map(|path| path.canonicalize().unwrap_or_else(|_| path.clone())).collect();
    let ends = |depth: usize| -> Vec<String> {
        let end = |path: &PathBuf| {
            let parts: Vec<_> = path.iter().map(|part| part.to_string_lossy()).collect();
            parts[parts.len().saturating_sub(depth)..].join("_").replace(['/', '\\'], "")
        };
        paths.iter().map(end).collect()
    };
    let deepest = paths.iter().map(|path| path.iter().count()).max().unwrap_or(0);
    let is_told_apart =
        |names: &Vec<String>| (1..names.len()).all(|i| !names[..i].contains(&names[i]));
    (1..=deepest).map(ends).find(is_told_apart).ok_or_else(|| {
        let message =
            "one folder was given twice: give the folder of each specimen once".to_owned();
        Problem::new(Place::file("--data"), Fault::Refused { message })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_paths_resolve_dots() {
        const FILES: &[(&str, &[u8])] = &[("data/bench/dataset.ron", b"()")];
        let cases = Folder::Embedded(Embedded::new("data/cases", FILES));
        let bench = cases.join("../bench");
        assert_eq!(bench, Folder::Embedded(Embedded::new("data/./bench", FILES)));
        assert_eq!(bench.read("dataset.ron").unwrap().text, "()");
        assert!(!bench.contains("none.csv"));
        assert!(matches!(bench.read("none.csv").unwrap_err().fault, Fault::NotShipped { .. }));
    }

    #[test]
    fn texts_in_memory_are_files_of_a_folder() {
        let texts = ["dataset.ron", "a.csv"].map(|name| (name.to_owned(), format!("({name})")));
        let folder = Folder::Embedded(Embedded::of_texts("arrays", texts.to_vec()));
        assert_eq!(folder.files(), ["a.csv", "dataset.ron"]);
        let read = folder.read("a.csv").unwrap();
        assert_eq!((read.name.as_str(), read.text.as_str()), ("arrays/a.csv", "(a.csv)"));
        assert!(!folder.contains("b.csv") && folder.size_bytes("a.csv") == 7);
    }

    /// Names with `..`, absolute ones and links out of the folder are refused; links inside it are not.
    #[test]
    fn no_name_leads_out_of_its_folder() {
        let place = tempfile::tempdir().unwrap();
        let (data, secret) = (place.path().join("data"), place.path().join("secret.csv"));
        crate::write_atomic(&secret, b"1").unwrap();
        crate::write_atomic(&data.join("sub/own.csv"), b"1").unwrap();
        let folder = Folder::Disk(data.clone());
        for name in ["../secret.csv", "sub/../../secret.csv", "./sub/own.csv", "", "/", "sub/.."] {
            let fault = folder.leads_out(name);
            assert!(
                matches!(&fault, Some(Fault::Other(m)) if m.contains("plain file name")),
                "{name}: {fault:?}"
            );
        }
        assert!(folder.leads_out(&secret.display().to_string()).is_some());
        assert_eq!(folder.leads_out("sub/own.csv"), None);
        assert_eq!(folder.leads_out("missing.csv"), None);
        #[cfg(unix)]
        {
            let link = |to: &str, name: &str| {
                std::os::unix::fs::symlink(to, data.join(name)).unwrap();
            };
            link("../secret.csv", "file.csv");
            link("..", "up");
            link("file.csv", "twice.csv");
            link("sub/own.csv", "inside.csv");
            for name in ["file.csv", "up/secret.csv", "twice.csv"] {
                let fault = folder.leads_out(name);
                assert!(
                    matches!(&fault, Some(Fault::Other(m)) if m.contains("copy the file")),
                    "{name}: {fault:?}"
                );
            }
            assert_eq!(folder.leads_out("inside.csv"), None);
        }
    }

    #[test]
    fn a_missing_file_is_named() {
        let problem = Source::read(Path::new("no/such/case.ron")).unwrap_err();
        assert!(problem.to_string().starts_with("no/such/case.ron: cannot be read"), "{problem}");
    }
}

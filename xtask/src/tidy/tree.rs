//! The texts of the workspace.

use std::collections::BTreeSet;
use std::path::Path;

use crate::XtaskError;

/// Folders that hold nothing a person wrote.
const SKIPPED_FOLDERS: [&str; 4] = [".git", "target", "out", "book"];

/// Endings of the files whose text is read; of all others only the name is known.
const TEXT_ENDINGS: [&str; 8] = ["rs", "py", "toml", "md", "cff", "ron", "yml", "sh"];

/// A text with its place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TextFile {
    /// Path relative to the root, with `/` between folders.
    pub path: String,
    /// What it says.
    pub text: String,
}

impl TextFile {
    /// The crate's folder name if this file is part of what a crate below `crates/` ships.
    pub(super) fn shipped_by(&self) -> Option<&str> {
        let (name, rest) = self.path.strip_prefix("crates/")?.split_once('/')?;
        rest.starts_with("src/").then_some(name)
    }
}

/// All files of a workspace, sorted by path.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Tree {
    /// Every file and folder, relative to the root.
    pub paths: BTreeSet<String>,
    /// The files that hold text.
    pub texts: Vec<TextFile>,
}

impl Tree {
    /// A tree of the given `(path, text)` pairs.
    pub fn of(files: &[(&str, &str)]) -> Self {
        let mut tree = Self::default();
        for (path, text) in files {
            tree.add_path(path);
            tree.texts.push(TextFile { path: (*path).to_owned(), text: (*text).to_owned() });
        }
        tree
    }

    /// Reads the tree below `root`, leaving out what was built.
    ///
    /// # Errors
    /// [`XtaskError::Read`] for a folder or text that cannot be read.
    pub fn load(root: &Path) -> Result<Self, XtaskError> {
        let mut tree = Self::default();
        tree.load_folder(root, "")?;
        Ok(tree)
    }

    fn load_folder(&mut self, folder: &Path, prefix: &str) -> Result<(), XtaskError> {
        let failed = |source| XtaskError::Read { path: folder.to_path_buf(), source };
        let mut entries = std::fs::read_dir(folder)
            .map_err(failed)?
            .collect::<Result<Vec<_>, _>>()
            .map_err(failed)?;
        entries.sort_by_key(std::fs::DirEntry::file_name);
        for entry in entries {
            let name = entry.file_name().to_string_lossy().into_owned();
            let path = if prefix.is_empty() { name.clone() } else { format!("{prefix}/{name}") };
            let is_folder = entry.file_type().map_err(failed)?.is_dir();
            if is_folder && !SKIPPED_FOLDERS.contains(&name.as_str()) {
                self.paths.insert(path.clone());
                self.load_folder(&entry.path(), &path)?;
            } else if !is_folder {
                self.paths.insert(path.clone());
                let ending = name.rsplit_once('.').map_or("", |(_, ending)| ending);
                if TEXT_ENDINGS.contains(&ending) || path.starts_with(".ci/") {
                    let text = crate::files::read(&entry.path())?;
                    self.texts.push(TextFile { path, text });
                }
            }
        }
        Ok(())
    }

    /// Adds a path with all folders above it.
    fn add_path(&mut self, path: &str) {
        let ends = path.match_indices('/').map(|(end, _)| end).chain([path.len()]);
        self.paths.extend(ends.map(|end| path[..end].to_owned()));
    }

    /// The text at a path.
    pub fn text(&self, path: &str) -> Option<&str> {
        self.texts.iter().find(|file| file.path == path).map(|file| file.text.as_str())
    }

    /// The texts whose path ends in `ending`.
    pub(super) fn ending_in<'a>(&'a self, ending: &'a str) -> impl Iterator<Item = &'a TextFile> {
        self.texts.iter().filter(move |file| file.path.ends_with(ending))
    }
}

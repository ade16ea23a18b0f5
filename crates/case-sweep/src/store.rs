//! Results on disk: `results/<first two of the key>/<key>`, each whole, with its own hash.

use crate::SweepError;
use measured_data::{DataError, Source, write_atomic};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Folder of the results below that of the sweep.
pub(crate) const RESULTS: &str = "results";

/// A value of a column.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Cell {
    /// A finite number.
    Number(f64),
    /// A word.
    Text(String),
    /// No value.
    Nothing(()),
}

impl From<f64> for Cell {
    /// A number; what is not finite is no value.
    fn from(value: f64) -> Self {
        if value.is_finite() { Self::Number(value) } else { Self::Nothing(()) }
    }
}

impl From<Option<f64>> for Cell {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::Nothing(()), Self::from)
    }
}

/// What a case ended with.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Numbers.
    Found {
        /// Name with unit, and value.
        columns: Vec<(String, Cell)>,
        /// What a reader should know before using them.
        warnings: Vec<String>,
    },
    /// No numbers.
    Failed {
        /// Why.
        reason: String,
    },
}

/// A stored result: everything needed to reproduce it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredCase {
    /// Version of the model.
    pub version: String,
    /// blake3 of every file that the case names.
    pub inputs: Vec<String>,
    /// The case, canonical; of a case whose values do not go together as it was given.
    pub case: String,
    /// What it ended with.
    pub outcome: Outcome,
}

/// The key of a case: blake3 of version, canonical case and hashes of inputs, each with its length before it.
pub fn case_key(version: &str, canonical: &str, inputs: &[String]) -> String {
    let mut hash = blake3::Hasher::new();
    let inputs = inputs.iter().map(String::as_str);
    for part in [version, canonical].into_iter().chain(inputs) {
        hash.update(&(part.len() as u64).to_le_bytes());
        hash.update(part.as_bytes());
    }
    hash.finalize().to_hex().to_string()
}

impl StoredCase {
    /// The key that its parts give.
    pub fn key(&self) -> String {
        case_key(&self.version, &self.case, &self.inputs)
    }

    /// The text of the file: JSON whose first member is the hash of the rest.
    fn text(&self) -> Result<String, serde_json::Error> {
        let rest = serde_json::to_string(self)?;
        let hash = blake3::hash(rest.as_bytes()).to_hex();
        Ok(format!("{{\"hash\":\"{hash}\",{}\n", &rest[1..]))
    }

    /// The result in a text; none if the text is not whole, was altered, or is of another key.
    pub fn of(text: &str, key: &str) -> Option<Self> {
        let (hash, rest) = text.strip_prefix("{\"hash\":\"")?.split_once("\",")?;
        let rest = format!("{{{}", rest.strip_suffix('\n')?);
        if blake3::hash(rest.as_bytes()).to_hex().as_str() != hash {
            return None;
        }
        let stored: Self = serde_json::from_str(&rest).ok()?;
        (stored.key() == key).then_some(stored)
    }
}

/// The folder of a sweep.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Store {
    pub(crate) folder: PathBuf,
}

/// How a result is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum State {
    /// Whole: numbers.
    Found,
    /// Whole: a reason why there are none.
    Failed,
    /// Cut off or altered: it is computed again.
    Damaged,
    /// Not there.
    Missing,
}

impl Store {
    /// The store in a folder, which need not be there yet.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.to_path_buf() }
    }

    /// The file of a key.
    pub(crate) fn path(&self, key: &str) -> PathBuf {
        let start: String = key.chars().take(2).collect();
        self.folder.join(RESULTS).join(start).join(key)
    }

    /// The result of a key and its state.
    pub fn get(&self, key: &str) -> (State, Option<StoredCase>) {
        let path = self.path(key);
        // a link may lead anywhere: its file is no result of this folder
        let read = path.is_file().then(|| Source::read(&path).ok().filter(|_| !path.is_symlink()));
        let Some(source) = read else { return (State::Missing, None) };
        let stored = source.and_then(|source| StoredCase::of(&source.text, key));
        let state = match stored.as_ref().map(|stored| &stored.outcome) {
            Some(Outcome::Found { .. }) => State::Found,
            Some(Outcome::Failed { .. }) => State::Failed,
            None => State::Damaged,
        };
        (state, stored)
    }

    /// Forgets the result of a key: it is computed again.
    ///
    /// # Errors
    /// That it cannot be removed.
    pub fn forget(&self, key: &str) -> Result<(), SweepError> {
        let path = self.path(key);
        let failed = |error: std::io::Error| DataError::NotWritten {
            path: path.clone(),
            reason: error.to_string(),
        };
        if path.is_symlink() || path.exists() {
            std::fs::remove_file(&path).map_err(failed)?;
        }
        Ok(())
    }

    /// Writes a result, whole or not at all.
    ///
    /// # Errors
    /// That it cannot be written: a folder without permission, a full disk.
    pub fn put(&self, stored: &StoredCase) -> Result<(), SweepError> {
        let path = self.path(&stored.key());
        let failed = |reason: String| DataError::NotWritten { path: path.clone(), reason };
        let text = stored.text().map_err(|error| failed(error.to_string()))?;
        if path.is_symlink() {
            // else the file that it leads to would be written
            self.forget(&stored.key())?;
        }
        Ok(write_atomic(&path, text.as_bytes())?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stored() -> StoredCase {
        let columns = [("a_deg", Cell::from(0.1 + 0.2)), ("b", Cell::from(f64::NAN))];
        let columns = columns.map(|(name, cell)| (name.to_owned(), cell)).to_vec();
        let outcome = Outcome::Found { columns, warnings: vec!["a \"w\"\n".into()] };
        StoredCase { version: "1".into(), inputs: vec!["i".into()], case: "(x: 1)".into(), outcome }
    }

    #[test]
    fn the_key_follows_version_case_and_inputs() {
        let key = |version: &str, case: &str, inputs: &[&str]| {
            let inputs: Vec<String> = inputs.iter().map(|i| (*i).to_owned()).collect();
            case_key(version, case, &inputs)
        };
        let base = key("1", "(x: 1)", &["a", "b"]);
        assert_eq!(base.len(), 64);
        for other in [
            key("2", "(x: 1)", &["a", "b"]),
            key("1", "(x: 2)", &["a", "b"]),
            key("1", "(x: 1)", &["ab"]),
            key("1", "(x: 1)", &["b", "a"]),
        ] {
            assert_ne!(base, other);
        }
    }

    /// Any byte cut off or changed makes a result that is computed again; a result under another name too.
    #[test]
    fn a_result_is_told_by_its_hash_and_its_name() {
        let place = tempfile::tempdir().unwrap();
        let store = Store::new(place.path());
        let stored = stored();
        let key = stored.key();
        assert_eq!(store.get(&key), (State::Missing, None));
        store.put(&stored).unwrap();
        let path = store.path(&key);
        assert!(path.ends_with(format!("results/{}/{key}", &key[..2])));
        assert_eq!(store.get(&key), (State::Found, Some(stored.clone())));
        let text = stored.text().unwrap();
        for end in 0..text.len() {
            assert_eq!(StoredCase::of(&text[..end], &key), None, "{end}");
        }
        for at in 0..text.len() {
            let mut bytes = text.clone().into_bytes();
            bytes[at] ^= 1;
            let changed = String::from_utf8(bytes).unwrap();
            assert_eq!(StoredCase::of(&changed, &key), None, "{at}");
        }
        write_atomic(&path, &text.as_bytes()[..100]).unwrap();
        assert_eq!(store.get(&key).0, State::Damaged);
        write_atomic(&path, &[0xff, 0xfe]).unwrap();
        assert_eq!(store.get(&key).0, State::Damaged);
        let other = format!("00{}", &key[2..]);
        write_atomic(&store.path(&other), text.as_bytes()).unwrap();
        assert_eq!(store.get(&other).0, State::Damaged);
    }

    /// A link in the place of a result leads out of the folder: nothing is read from there nor written.
    #[cfg(unix)]
    #[test]
    fn a_result_is_no_link() {
        let (place, other) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        let (store, stored) = (Store::new(place.path()), stored());
        let (path, outside) = (store.path(&stored.key()), other.path().join("file"));
        let text = stored.text().unwrap();
        write_atomic(&outside, text.as_bytes()).unwrap();
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::os::unix::fs::symlink(&outside, &path).unwrap();
        assert_eq!(store.get(&stored.key()).0, State::Damaged);
        write_atomic(&outside, b"mine").unwrap();
        store.put(&stored).unwrap();
        assert_eq!(Source::read(&outside).unwrap().text, "mine");
        assert_eq!(store.get(&stored.key()).0, State::Found);
    }

    #[test]
    fn a_place_that_takes_no_file_is_an_error() {
        let place = tempfile::tempdir().unwrap();
        write_atomic(&place.path().join(RESULTS), b"a file").unwrap();
        let error = Store::new(place.path()).put(&stored()).unwrap_err().to_string();
        assert!(error.contains("cannot be written") && error.contains("space left"), "{error}");
    }
}

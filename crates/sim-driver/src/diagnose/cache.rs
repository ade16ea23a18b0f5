//! Surrogate structures kept by the content they depend on: on disk between runs, or while the program runs.

use crate::files::write_atomic;
use actuator_gap::StructureStore;
use model_gap::discovery::Signal;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Signals of every surrogate on every run.
type Structures = Vec<Signal>;

/// A folder that keeps the structures of surrogates.
pub struct FolderStore<'a>(pub &'a Path);

impl StructureStore for FolderStore<'_> {
    fn get(&self, parts: &[&[f64]], lengths: &[usize]) -> Option<Structures> {
        read(self.0, &key(parts), lengths)
    }

    fn keep(&self, parts: &[&[f64]], structures: &[Signal]) {
        write(self.0, &key(parts), structures);
    }
}

/// A place that keeps the structures of surrogates: a folder, or memory until the program ends.
pub enum KeptStructures<'a> {
    /// A folder.
    Folder(FolderStore<'a>),
    /// Memory, by the hash of what they depend on.
    Memory(Mutex<BTreeMap<String, Structures>>),
}

impl<'a> KeptStructures<'a> {
    /// A folder, where one is given.
    pub fn at(folder: Option<&'a Path>) -> Self {
        folder.map_or_else(|| Self::Memory(Mutex::default()), |own| Self::Folder(FolderStore(own)))
    }
}

impl StructureStore for KeptStructures<'_> {
    fn get(&self, parts: &[&[f64]], lengths: &[usize]) -> Option<Structures> {
        match self {
            Self::Folder(store) => store.get(parts, lengths),
            Self::Memory(kept) => {
                kept.lock().unwrap_or_else(PoisonError::into_inner).get(&key(parts)).cloned()
            }
        }
    }

    fn keep(&self, parts: &[&[f64]], structures: &[Signal]) {
        match self {
            Self::Folder(store) => store.keep(parts, structures),
            Self::Memory(kept) => {
                let mut kept = kept.lock().unwrap_or_else(PoisonError::into_inner);
                kept.insert(key(parts), structures.to_vec());
            }
        }
    }
}

/// Name of a file of structures: everything they depend on goes into the hash.
fn key(parts: &[&[f64]]) -> String {
    let mut hash = blake3::Hasher::new();
    hash.update(rotor_study::MODEL_VERSION.as_bytes());
    for part in parts {
        hash.update(&(size_of_val(*part) as u64).to_le_bytes());
        for value in *part {
            hash.update(&value.to_le_bytes());
        }
    }
    hash.finalize().to_hex().to_string()
}

fn file(folder: &Path, key: &str) -> PathBuf {
    folder.join(format!("null-{key}.bin"))
}

/// Reads structures of the expected lengths; none if there are no such, or they do not fit.
#[expect(clippy::disallowed_methods, reason = "the one place that reads its own cache")]
fn read(folder: &Path, key: &str, lengths: &[usize]) -> Option<Structures> {
    let raw = std::fs::read(file(folder, key)).ok()?;
    let per_surrogate: usize = lengths.iter().sum::<usize>() * 4;
    if per_surrogate == 0 || raw.len() % per_surrogate != 0 {
        return None;
    }
    let mut values =
        raw.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes([b[0], b[1], b[2], b[3]])));
    let count = raw.len() / per_surrogate;
    Some(
        (0..count)
            .map(|_| lengths.iter().map(|&n| values.by_ref().take(n).collect()).collect())
            .collect(),
    )
}

/// Keeps structures; a folder that cannot be written is no error, the next run computes them again.
#[expect(clippy::cast_possible_truncation, reason = "single precision is enough for a floor")]
fn write(folder: &Path, key: &str, structures: &[Signal]) {
    let raw: Vec<u8> =
        structures.iter().flatten().flatten().flat_map(|&v| (v as f32).to_le_bytes()).collect();
    // a cache that cannot be written costs time, not results
    let _ = write_atomic(&file(folder, key), &raw);
}

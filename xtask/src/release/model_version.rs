//! The version of the model, which is part of the key of stored results, against the golden values.
//!
//! `fixtures/golden/versions.tsv` has a row for each version: its count, the hash of the goldens that belong to it and
//! what moved. Goldens that changed without a new row, and a row without its count in the code, are faults.

use std::path::Path;

use crate::{XtaskError, files};

/// The list of versions, from the root.
pub const VERSIONS: &str = "fixtures/golden/versions.tsv";

/// blake3 of names and contents of all goldens, in the order of their names.
///
/// # Errors
/// [`XtaskError::Read`] for a folder or file that cannot be read.
pub fn hash_of_goldens(folder: &Path) -> Result<String, XtaskError> {
    let mut hash = blake3::Hasher::new();
    for path in files::in_folder(folder)? {
        if path.extension().is_none_or(|ending| ending != "ron") {
            continue;
        }
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let bytes = files::read_bytes(&path)?;
        for part in [name.as_bytes(), &bytes] {
            hash.update(&(part.len() as u64).to_le_bytes());
            hash.update(part);
        }
    }
    Ok(hash.finalize().to_hex().to_string())
}

/// What is wrong with a list of versions: nothing where its last row has the count of `model_version` and `goldens`.
///
/// `versions` is the text of [`VERSIONS`], `model_version` such as `0.1.0+model.1`.
pub fn faults(versions: &str, goldens: &str, model_version: &str) -> Vec<String> {
    let rows: Vec<Vec<&str>> = versions
        .lines()
        .skip(1)
        .filter(|line| !line.is_empty())
        .map(|line| line.split('\t').collect())
        .collect();
    let mut faults = Vec::new();
    for (number, row) in rows.iter().enumerate() {
        let [count, hash, why] = row[..] else {
            faults.push(format!("{VERSIONS}:{}: expected count, hash, what moved", number + 2));
            continue;
        };
        if count != (number + 1).to_string() {
            faults.push(format!(
                "{VERSIONS}:{}: count {count}, expected {}",
                number + 2,
                number + 1
            ));
        }
        if why.trim().is_empty() {
            faults.push(format!("{VERSIONS}:{}: say what moved", number + 2));
        }
        let earlier = rows[..number].iter().position(|row| row.get(1) == Some(&hash));
        // goldens that are as they were do not forbid a new version: no golden may see what moved
        if let Some(earlier) = earlier.filter(|earlier| earlier + 1 != number) {
            let line = number + 2;
            faults.push(format!("{VERSIONS}:{line}: goldens of version {}", earlier + 1));
        }
    }
    let last = rows.last().and_then(|row| row.get(1)).copied().unwrap_or("none");
    if last != goldens {
        faults.push(format!(
            "the goldens have changed, so stored results need other keys: raise the count of `MODEL_VERSION` in \
             crates/rotor-study/src/lib.rs to {0} and add the row to {VERSIONS}\n{0}\t{goldens}\twhat moved",
            rows.len() + 1
        ));
    }
    let stated = model_version.rsplit_once("+model.").map_or("none", |(_, count)| count);
    if stated != rows.len().to_string() {
        faults.push(format!(
            "`MODEL_VERSION` has count {stated}, the last row of {VERSIONS} {}: they must be one",
            rows.len()
        ));
    }
    faults
}

/// The faults of the workspace at `root`.
///
/// # Errors
/// [`XtaskError::Read`].
pub fn check(root: &Path) -> Result<Vec<String>, XtaskError> {
    let goldens = hash_of_goldens(&root.join("fixtures/golden"))?;
    Ok(faults(&files::read(&root.join(VERSIONS))?, &goldens, rotor_study::MODEL_VERSION))
}

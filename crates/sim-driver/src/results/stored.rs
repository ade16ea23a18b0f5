//! The file of a result: raw numbers, the case and one hash of all of it.

use super::RunResult;
use super::bench::BenchPart;
use crate::SimError;
use crate::case::Case;
use crate::files::{Source, ron_text, write_atomic};
use crate::output::json;
use crate::problem::{Fault, Place, Problem};
use case_sweep::case_key;
use rotor_base::RotorScales;
use rotor_study::Setting;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// Name of the stored result of a run.
pub const RESULT_FILE: &str = "result.json";

/// Where programs before this form kept what the report shows of the bench.
const OLD_STUDY_FILE: &str = "study.json";

/// A stored result: everything needed to show and to reproduce it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StoredResult {
    /// Program and version.
    pub program: String,
    /// blake3 of model version, canonical case and input data: equal keys mean equal results.
    pub key: String,
    /// blake3 of each input beside the case: actuator or bench data, measured files, aerofoil tables.
    pub inputs: Vec<String>,
    /// The whole case, defaults filled in.
    pub case: Case,
    /// Bench data and fits of the actuator; none without a bench.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bench: Option<BenchPart>,
    /// The result.
    pub result: RunResult,
}

impl StoredResult {
    /// Puts a result beside its case and key. `inputs` are blake3 hashes of bench or actuator data.
    ///
    /// # Errors
    /// [`SimError::Data`] for a case RON cannot express.
    pub fn new(
        case: &Case,
        inputs: Vec<String>,
        bench: Option<BenchPart>,
        result: RunResult,
    ) -> Result<Self, SimError> {
        Ok(Self {
            program: format!("hhc {}", crate::VERSION),
            key: result_key(case, &inputs)?,
            inputs,
            case: case.clone(),
            bench,
            result,
        })
    }

    /// Writes the result atomically as JSON, its hash first.
    ///
    /// # Errors
    /// [`SimError::Data`].
    pub fn write(&self, path: &Path) -> Result<(), SimError> {
        Ok(write_atomic(path, hashed(json(self)?.trim_end()).as_bytes())?)
    }

    /// Reads the result in a folder, in this form or that of earlier programs, and checks its hash.
    ///
    /// # Errors
    /// A file that cannot be read; [`SimError::NotReproduced`] for one that was changed after it was written.
    pub fn read(folder: &Path) -> Result<Self, SimError> {
        let source = Source::read(&folder.join(RESULT_FILE))?;
        check_hash(&source)?;
        let mut stored: Self = from_json(&source)?;
        let old = folder.join(OLD_STUDY_FILE);
        if stored.bench.is_none() && old.is_file() {
            let bench: BenchPart = from_json(&Source::read(&old)?)?;
            stored.bench = Some(bench).filter(|bench| !bench.data_title.is_empty());
        }
        Ok(stored)
    }

    /// Whether it is what this program finds of a case with these inputs, in any order.
    pub fn is_of(&self, case: &Case, inputs: &[String]) -> bool {
        let sorted = |hashes: &[String]| {
            let mut hashes = hashes.to_vec();
            hashes.sort();
            hashes
        };
        let is_key = || result_key(case, &self.inputs).is_ok_and(|key| key == self.key);
        sorted(&self.inputs) == sorted(inputs) && is_key()
    }

    /// What the figures share.
    ///
    /// # Errors
    /// [`SimError::NotReproduced`] for a case whose rotor units are not positive.
    pub fn setting(&self) -> Result<Setting, SimError> {
        let scales = self.case.scales();
        RotorScales::new(scales.omega_rad_s(), scales.radius_m(), scales.mass_kg_m()).map_err(
            |error| SimError::NotReproduced {
                file: RESULT_FILE.to_owned(),
                field: "case.rotor".to_owned(),
                stored: error.to_string(),
                recomputed: String::new(),
            },
        )?;
        Ok(Setting::of_case(&self.case, &self.result.baseline.hub_nb_per_rev))
    }
}

/// A value of a JSON text.
///
/// # Errors
/// What is wrong in it, with line and column.
pub(crate) fn from_json<T: DeserializeOwned>(source: &Source) -> Result<T, SimError> {
    serde_json::from_str(&source.text).map_err(|e| {
        let place = Place::at(&source.name, e.line(), e.column());
        Problem::new(place, Fault::Syntax { message: e.to_string() }).into()
    })
}

fn hash_of(compact_json: &str) -> String {
    blake3::hash(compact_json.as_bytes()).to_hex().to_string()
}

/// JSON text of an object with the hash of the rest as its first member.
fn hashed(text: &str) -> String {
    let hash = hash_of(&compact(text));
    let members = text.trim_start().strip_prefix('{').unwrap_or_default();
    format!("{{\n  \"hash\": \"{hash}\",{members}\n")
}

/// JSON text without the white space between its parts: the layout is not part of a hash.
fn compact(text: &str) -> String {
    let (mut in_string, mut escaped) = (false, false);
    let kept = |c: &char| {
        let keep = in_string || !c.is_whitespace();
        in_string ^= *c == '"' && !escaped;
        escaped = in_string && *c == '\\' && !escaped;
        keep
    };
    text.chars().filter(kept).collect()
}

/// The hashes a file may hold.
#[derive(Deserialize)]
struct Hashes {
    /// Of all the rest of the file.
    hash: Option<String>,
    /// Of the result alone, as earlier programs wrote it.
    result_key: Option<String>,
}

/// Compares the hash in a file with that of its text.
fn check_hash(source: &Source) -> Result<(), SimError> {
    let text = compact(&source.text);
    let (field, stored, found) = match from_json(source)? {
        Hashes { hash: Some(hash), .. } => {
            let rest = text.strip_prefix(&format!("{{\"hash\":\"{hash}\","));
            ("hash", hash, rest.map(|rest| hash_of(&format!("{{{rest}"))))
        }
        Hashes { result_key: Some(key), .. } => {
            // the result is the last member and begins with its trim; quotes in strings are escaped
            let result = text.split_once("\"result\":{\"trim\":").and_then(|(_, rest)| {
                rest.strip_suffix('}').map(|rest| format!("{{\"trim\":{rest}"))
            });
            ("result_key", key, result.map(|result| hash_of(&result)))
        }
        _ => ("hash", "missing".to_owned(), None),
    };
    if found.as_ref() == Some(&stored) {
        return Ok(());
    }
    Err(SimError::NotReproduced {
        file: source.name.clone(),
        field: field.to_owned(),
        stored,
        recomputed: found.unwrap_or_else(|| hash_of(&text)),
    })
}

/// blake3 of model version, canonical case and input hashes.
///
/// The canonical case is the case file with its defaults filled in, so comments, order and layout of
/// the user's file do not matter.
///
/// # Errors
/// [`SimError::Data`] for a case RON cannot express.
fn result_key(case: &Case, inputs: &[String]) -> Result<String, SimError> {
    let canonical = ron_text(case).map_err(|e| SimError::not_written("case", &e))?;
    Ok(case_key(rotor_study::MODEL_VERSION, &canonical, inputs))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{PAPER_CASE, shipped_case};

    #[test]
    fn the_key_follows_case_and_inputs_but_not_layout() {
        let file = shipped_case(PAPER_CASE).unwrap().case;
        let key = |file: &Case, inputs: &[&str]| {
            let inputs: Vec<String> = inputs.iter().map(|s| (*s).to_owned()).collect();
            result_key(file, &inputs).unwrap()
        };
        let base = key(&file, &["a", "b"]);
        assert_eq!(base.len(), 64);
        assert_eq!(base, key(&file.clone(), &["a", "b"]));
        assert_ne!(base, key(&file, &["ab"]), "inputs are kept apart");
        // that of the model, which is more than that of the program
        let of_version = |version: &str| {
            case_key(version, &ron_text(&file).unwrap(), &["a".to_owned(), "b".to_owned()])
        };
        assert_eq!(base, of_version(rotor_study::MODEL_VERSION));
        assert_ne!(base, of_version(crate::VERSION));
        let moved = Case { advance_ratio: file.advance_ratio + 1e-12, ..file };
        assert_ne!(base, key(&moved, &["a", "b"]));
    }

    fn source(text: &str) -> Source {
        Source { name: "result.json".into(), text: text.into() }
    }

    #[test]
    fn a_changed_file_is_told_by_its_hash() {
        let text = hashed("{\n  \"title\": \"a \\\" b\",\n  \"x\": [1.5, 2]\n}");
        check_hash(&source(&text)).unwrap();
        // the layout may change, a space in a string may not
        check_hash(&source(&text.replace("\n ", "\n\t"))).unwrap();
        for (from, to) in [
            ("1.5", "1.6"),
            ("a \\", "a  \\"),
            ("\"x\"", "\"y\""),
            ("\"hash\": \"", "\"hash\": \"0"),
        ] {
            assert!(text.contains(from), "{text}");
            let error = check_hash(&source(&text.replacen(from, to, 1))).unwrap_err();
            assert_eq!(error.exit_code(), 3, "{from}: {error}");
        }
        assert_eq!(check_hash(&source("{\"x\": 1}")).unwrap_err().exit_code(), 3);
    }

    #[test]
    fn a_result_of_earlier_programs_is_told_by_the_key_of_its_result() {
        let result = "{\"trim\":{\"theta0_deg\":8.1},\"control\":[]}";
        let key = hash_of(result);
        let file = format!("{{\"result_key\": \"{key}\", \"case\": {{}}, \"result\": {result}}}");
        check_hash(&source(&file)).unwrap();
        assert!(check_hash(&source(&file.replace("8.1", "8.2"))).is_err());
    }
}

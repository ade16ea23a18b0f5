//! Source and licence of every folder of data, and the page of the book that lists them.
//!
//! A folder says both in its `SOURCE.md`, or the `SOURCE.md` of the folder above it names the folder and says so for it:
//!
//! ```text
//! - Origin: who measured or computed it, and where it was read
//! - Licence: MIT, text in `LICENSE`
//! ```

use std::path::Path;

use crate::{XtaskError, files};

/// The page, from the root.
pub const PAGE: &str = "docs/src/data-licences.md";

/// Folders of data, and folders of such folders.
const SINGLE: [&str; 7] =
    ["airfoils", "cases", "golden", "instrument_habits", "instruments", "mat", "sweeps"];
const GROUPS: [&str; 4] = ["bench", "measured", "points", "reference"];

/// Licences of others whose text must be beside the data.
const WITH_TEXT: [&str; 3] = ["MIT", "CC ", "Apache"];

/// What a folder says of itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Stated {
    /// The folder, from `fixtures`.
    pub folder: String,
    /// The file that says it, from `fixtures`.
    pub said_in: String,
    /// Where the data are from.
    pub origin: String,
    /// Under which licence they are passed on.
    pub licence: String,
}

/// The line of a text that begins with a key, without it and its full stop.
fn value<'a>(text: &'a str, key: &str) -> Option<&'a str> {
    let line = text.lines().find_map(|line| line.strip_prefix("- ")?.strip_prefix(key))?;
    let value = line.strip_prefix(':')?.trim().trim_end_matches('.');
    (!value.is_empty()).then_some(value)
}

/// What the folder of data at `fixtures/folder` says, or what is missing.
fn stated(fixtures: &Path, folder: &str) -> Result<Stated, String> {
    let own = format!("{folder}/SOURCE.md");
    let above = folder.rsplit_once('/').map_or("", |(above, _)| above);
    let of_group = format!("{above}/SOURCE.md").trim_start_matches('/').to_owned();
    let name = folder.rsplit('/').next().unwrap_or(folder);
    let read =
        |file: &String| files::read(&fixtures.join(file)).ok().map(|text| (file.clone(), text));
    let named = || read(&of_group).filter(|(_, text)| text.contains(&format!("`{name}`")));
    let remedy = "write the lines `- Origin: ...` and `- Licence: ...`";
    let has = |found: &(String, String)| value(&found.1, "Licence").is_some();
    let Some((said_in, text)) = read(&own).filter(has).or_else(named) else {
        return Err(format!(
            "fixtures/{own} does not say whence the data are and under which licence: {remedy}"
        ));
    };
    let part =
        |key| value(&text, key).ok_or(format!("fixtures/{said_in} has no `- {key}:`: {remedy}"));
    let (origin, licence) = (part("Origin")?.to_owned(), part("Licence")?.to_owned());
    if WITH_TEXT.iter().any(|known| licence.contains(known)) {
        let file = licence.split_once("text in `").and_then(|(_, rest)| rest.split('`').next());
        let is_there = |file: &str| fixtures.join(folder).join(file).is_file();
        if !file.is_some_and(is_there) {
            return Err(format!(
                "fixtures/{said_in}: the licence `{licence}` asks for its text: put it beside the data and write ``text in `FILE` ``"
            ));
        }
    }
    Ok(Stated { folder: folder.to_owned(), said_in, origin, licence })
}

/// Every folder of data in `fixtures` with what it says, and what is missing.
///
/// # Errors
/// [`XtaskError::Read`] for a folder that cannot be read.
pub fn collect(fixtures: &Path) -> Result<(Vec<Stated>, Vec<String>), XtaskError> {
    let mut folders: Vec<String> = Vec::new();
    let mut known: Vec<&str> = SINGLE.into_iter().chain(GROUPS).collect();
    known.sort_unstable();
    let mut faults = Vec::new();
    for path in files::in_folder(fixtures)?.iter().filter(|path| path.is_dir()) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if SINGLE.contains(&name.as_str()) {
            folders.push(name);
        } else if GROUPS.contains(&name.as_str()) {
            let inside = files::in_folder(path)?;
            let inside = inside.iter().filter(|path| path.is_dir());
            folders.extend(inside.map(|own| {
                format!("{name}/{}", own.file_name().unwrap_or_default().to_string_lossy())
            }));
        } else {
            faults
                .push(format!("fixtures/{name} is no known folder of data: {}", known.join(", ")));
        }
    }
    let mut found = Vec::new();
    for folder in folders {
        match stated(fixtures, &folder) {
            Ok(own) => found.push(own),
            Err(fault) => faults.push(fault),
        }
    }
    Ok((found, faults))
}

/// The page.
pub fn page(stated: &[Stated]) -> String {
    let rows: Vec<String> = stated
        .iter()
        .map(|own| {
            let Stated { folder, said_in, origin, licence } = own;
            format!("| [`{folder}`](../../fixtures/{said_in}) | {origin} | {licence} |\n")
        })
        .collect();
    format!(
        "# Licences of the data\n\n<!-- Written by `cargo xtask data-licences`; do not edit. -->\n\n\
         Every folder of `fixtures` with the origin of its data and the licence under which they are passed on. Code, synthetic \
         data and\nwhat was computed for this project are under MIT or Apache 2.0, at your choice. The packages and the command \
         hold `airfoils`, `cases` and\n`bench/apa500l_synthetic` alone; all else lies in the repository for tests.\n\n\
         The cases of HART II and HeliNOVI hold flight states, hub moments and a few means that were measured.\n\n\
         Where no licence was seen, facts are kept, not files as they stood: harmonics, and short tables, some of them whole. Ask the \
         owners\nbefore you pass them on.\n\n| folder | origin | licence |\n|---|---|---|\n{}",
        rows.concat()
    )
}

/// The fresh page of the workspace at `root`, and what is missing.
///
/// # Errors
/// [`XtaskError::Read`].
pub fn fresh(root: &Path) -> Result<(String, Vec<String>), XtaskError> {
    let (stated, faults) = collect(&root.join("fixtures"))?;
    Ok((page(&stated), faults))
}

//! The case studies of the book: diagnoses of measured points, the figures and the numbers that their pages quote.
//!
//! A study is a few diagnoses of folders under `fixtures/points`. Its page holds a marked block of numbers and shows one figure.
//! Both are written here, from the library behind `hhc diagnose`.

mod figure;
mod flap;
mod flights;
mod rotors;
mod stall;
mod strip;

use crate::{XtaskError, files};
use sim_driver::SimError;
use sim_driver::case::{Case, LoadedCase, load_case};
use sim_driver::diagnose::{CasePoints, Findings, PointDiagnosis};
use sim_driver::files::{Folder, dataset_kind, read_sweep};
use std::fmt::Write as _;
use std::path::Path;

/// Where the block of numbers begins and ends.
const BEGIN: &str = "<!-- Numbers written by `cargo xtask case-studies`; do not edit. -->\n";
const END: &str = "<!-- End of the numbers. -->\n";
/// Folder of the pages and of the figures.
const PAGES: &str = "docs/src/case-studies";
const FIGURES: &str = "docs/src/figures";
/// Folder of the points.
const POINTS: &str = "fixtures/points";

/// One diagnosis of a study.
struct Run {
    /// What it is called in the numbers.
    label: &'static str,
    /// Case file, from the root.
    case: &'static str,
    /// Folder below [`POINTS`].
    data: &'static str,
}

/// A study.
struct Study {
    /// Name of page and figure.
    name: &'static str,
    /// Whether it takes seconds.
    is_quick: bool,
    runs: &'static [Run],
    /// Numbers and figure.
    told: Teller,
}

/// What makes numbers and figure of the diagnoses.
enum Teller {
    /// From them alone.
    Plain(fn(&[Done]) -> Told),
    /// It simulates something besides.
    Simulating(fn(&[Done]) -> Result<Told, XtaskError>),
}

const STUDIES: [Study; 7] = [
    flap::STUDY,
    strip::STUDY,
    stall::STUDY,
    rotors::INFLOW,
    rotors::HYSTERESIS,
    rotors::LEVEL_FLIGHT,
    flights::STUDY,
];

/// A diagnosis that was done.
struct Done {
    label: &'static str,
    case: Case,
    diagnosis: PointDiagnosis,
    findings: Findings,
    /// The case with what was found.
    extended: Option<Case>,
}

/// What a study says.
struct Told {
    /// The block of numbers.
    numbers: String,
    /// The figure.
    figure: String,
}

/// Which studies, and whether pages are written or compared.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Options {
    /// One study; none: all of them.
    pub name: Option<String>,
    /// Only those of seconds.
    pub quick: bool,
    /// Write nothing.
    pub check: bool,
}

/// Runs the studies and writes figures and numbers; with [`Options::check`] names the files that are not as written.
///
/// # Errors
/// [`XtaskError::Study`] of a name that is no study and of a page without its block; the diagnosis; files.
pub fn run(
    root: &Path,
    options: &Options,
    mut progress: impl FnMut(&str),
) -> Result<Vec<String>, XtaskError> {
    let is_wanted = |own: &&Study| match &options.name {
        Some(name) => own.name == name,
        None => own.is_quick || !options.quick,
    };
    let wanted: Vec<&Study> = STUDIES.iter().filter(is_wanted).collect();
    if wanted.is_empty() {
        let names: Vec<&str> = STUDIES.iter().map(|own| own.name).collect();
        return Err(XtaskError::Study(format!("no such study: one of {}", names.join(", "))));
    }
    let mut stale = Vec::new();
    for study in wanted {
        let begin = std::time::Instant::now();
        let done = study.runs.iter().map(|own| own.done(root)).collect::<Result<Vec<_>, _>>()?;
        let told = match study.told {
            Teller::Plain(told) => told(&done),
            Teller::Simulating(told) => told(&done)?,
        };
        progress(&format!("{}: {:.1} s\n", study.name, begin.elapsed().as_secs_f64()));
        let page = format!("{PAGES}/{}.md", study.name);
        let text = files::read(&root.join(&page))?;
        let fresh = with_numbers(&text, &told.numbers).ok_or_else(|| {
            XtaskError::Study(format!("{page}: the marks of the numbers are missing"))
        })?;
        for (path, fresh) in [(page, fresh), (format!("{FIGURES}/{}.svg", study.name), told.figure)]
        {
            let full = root.join(&path);
            let is_same = full.exists() && files::read(&full)? == fresh;
            if !is_same && options.check {
                stale.push(path);
            } else if !is_same {
                files::write_atomically(&full, &fresh)?;
                progress(&format!("written: {path}\n"));
            }
        }
    }
    Ok(stale)
}

/// A page with other numbers; none of a page without marks.
fn with_numbers(page: &str, numbers: &str) -> Option<String> {
    let (before, rest) = page.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}\n{numbers}\n{END}{after}"))
}

impl Run {
    fn done(&self, root: &Path) -> Result<Done, XtaskError> {
        let case = load_case(&root.join(self.case)).map_err(SimError::from)?;
        diagnosed(self.label, &case, &root.join(POINTS).join(self.data))
    }
}

/// Diagnoses points of a folder.
fn diagnosed(label: &'static str, case: &LoadedCase, data: &Path) -> Result<Done, XtaskError> {
    let folder = Folder::Disk(data.to_path_buf());
    let kind = dataset_kind(&folder)
        .ok_or_else(|| XtaskError::Study(format!("{}: no points of test", data.display())))?;
    let data = read_sweep(&folder, kind).map_err(SimError::from)?;
    let found = CasePoints::of(case, &data, &[], &|_, _| {})?;
    let texts = found.files()?;
    let extended = texts.iter().find(|(name, _)| name.starts_with("extended"));
    let extended = match extended {
        Some((name, text)) => {
            let place = tempfile::tempdir()
                .map_err(|source| XtaskError::Write { path: name.into(), source })?;
            let path = place.path().join(name);
            files::write_atomically(&path, text)?;
            Some(load_case(&path).map_err(SimError::from)?.case)
        }
        None => None,
    };
    let findings = found.diagnosis.findings();
    Ok(Done { label, case: case.case.clone(), diagnosis: found.diagnosis, findings, extended })
}

/// A table of Markdown.
fn table(titles: &[&str], rows: &[Vec<String>]) -> String {
    let mut text = format!("| {} |\n|{}\n", titles.join(" | "), "---|".repeat(titles.len()));
    for row in rows {
        let _ = writeln!(text, "| {} |", row.join(" | "));
    }
    text
}

/// The answers of diagnoses, a row each: what is missing, its parameters with 95 % intervals, the nearest causes rejected.
fn answers(done: &[Done]) -> String {
    let row = |own: &Done| {
        let found = &own.diagnosis.found;
        vec![
            own.label.to_owned(),
            own.verdict(),
            own.causes(),
            own.rejected(),
            format!("{}, {}", own.diagnosis.table.values(), found.measured.len()),
        ]
    };
    let rows: Vec<Vec<String>> = done.iter().map(row).collect();
    table(
        &[
            "",
            "verdict",
            "cause and 95 % interval",
            "in its place, chi-square higher by",
            "readings, points",
        ],
        &rows,
    )
}

impl Done {
    /// The verdict as the findings have it.
    fn verdict(&self) -> String {
        let word = |value: serde_json::Result<serde_json::Value>| {
            value.ok().and_then(|own| own.as_str().map(str::to_owned)).unwrap_or_default()
        };
        let (verdict, sure) = (
            word(serde_json::to_value(self.findings.verdict)),
            word(serde_json::to_value(self.findings.confidence)),
        );
        format!("`{verdict}`, {sure}")
    }

    fn causes(&self) -> String {
        let one = |name: &String| {
            let values = self.findings.parameters.get(name);
            let values = values.into_iter().flatten().map(|(name, own)| {
                let [low, high] = own.ci95.map(figured);
                let unit = if own.unit == "1" { String::new() } else { format!(" {}", own.unit) };
                format!("{name} {} ({low} to {high}){unit}", figured(own.value))
            });
            format!("`{name}`: {}", values.collect::<Vec<_>>().join(", "))
        };
        let all: Vec<String> = self.findings.causes.iter().map(one).collect();
        if all.is_empty() { self.candidate() } else { all.join("; ") }
    }

    /// What was fitted and refused where no name is given.
    fn candidate(&self) -> String {
        let found = &self.diagnosis.found;
        let Some(first) = found.finding.causes.first() else { return "none".to_owned() };
        let values = first.parameters.iter().map(|own| {
            let [low, high] = own.ci95.map(figured);
            format!("{} {} ({low} to {high})", own.name, figured(own.value))
        });
        let values: Vec<String> = values.collect();
        let id = found.candidates[first.candidate].id;
        format!("none; fitted and refused: `{id}`: {}", values.join(", "))
    }

    /// The causes that were fitted in the place of those named, or are nearly as likely.
    fn rejected(&self) -> String {
        if self.findings.compared.is_empty() {
            return "-".to_owned();
        }
        let mut all: Vec<(&str, f64, f64)> = Vec::new();
        for own in &self.findings.compared {
            all.push((&own.cause, own.delta_chi2, own.discrimination_threshold));
        }
        all.sort_by(|a, b| a.1.total_cmp(&b.1));
        let one = |(name, delta, threshold): &(&str, f64, f64)| {
            // what differs by rounding alone differs by nothing
            let delta_text = if delta.abs() < 0.5 { "0".to_owned() } else { figured(*delta) };
            let open = if delta < threshold { " (as likely)" } else { "" };
            format!("`{name}` {delta_text}{open}")
        };
        let all: Vec<String> = all.iter().take(4).map(one).collect();
        all.join(", ")
    }
}

/// A number with three digits.
fn figured(value: f64) -> String {
    crate::validate::figure(value)
}

//! What an import says of the records that it wrote.

use crate::beside::{compared, glances};
use crate::glance::Glance;
use measured_data::import::{ImportResult, ImportedRun};
use measured_data::{Folder, read_dataset, significant};
use preisach_dyn::identify::{Finding, Severity};
use report_page::{Sheet, counted, table};
use serde::Serialize;
use std::ops::Deref;

/// Columns in a list; those without a name are counted.
fn names(columns: &[String]) -> String {
    let (named, unnamed): (Vec<&str>, Vec<&str>) =
        columns.iter().map(String::as_str).partition(|name| !name.trim().is_empty());
    let count = (!unnamed.is_empty()).then(|| format!("{} without a name", unnamed.len()));
    let all: Vec<String> = named.into_iter().map(str::to_owned).chain(count).collect();
    all.join(", ")
}

/// An import with its runs as they are read back.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ImportReport {
    /// What was written.
    #[serde(flatten)]
    pub import: ImportResult,
    /// Each record at a glance; empty of what is no record in time.
    pub glances: Vec<Glance>,
    #[serde(skip)]
    lines: Vec<String>,
}

impl Deref for ImportReport {
    type Target = ImportResult;

    fn deref(&self) -> &ImportResult {
        &self.import
    }
}

impl From<ImportResult> for ImportReport {
    /// Looks at the records written: what identification would suspect of each, and of each beside the others, becomes a
    /// warning.
    fn from(mut import: ImportResult) -> Self {
        let data = read_dataset(&Folder::Disk((&import.folder).into())).ok();
        let Some((glances, subject)) = data.as_ref().map(glances) else {
            return Self { import, glances: Vec::new(), lines: Vec::new() };
        };
        let suspect = glances.iter().flat_map(|glance| &glance.findings);
        let is_told = |finding: &&Finding| {
            finding.severity() == Severity::Suspect || matches!(finding, Finding::Spikes { .. })
        };
        let suspect = suspect.filter(is_told);
        let said = |finding| format!("{}; {}", subject.finding(finding), subject.remedy(finding));
        import.warnings.extend(suspect.map(said));
        import.warnings.extend(compared(&glances, subject));
        let lines = glances.iter().map(|glance| glance.line(subject)).collect();
        Self { import, glances, lines }
    }
}

impl ImportReport {
    /// It as tables for people.
    pub fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "{}: data set of kind {:?}, \"{}\"",
            self.folder, self.kind, self.title
        ));
        for (number, run) in self.runs.iter().enumerate() {
            sheet.line(format_args!("\n{}: {}", run.source, run.recognised));
            sheet.line(format_args!("run {}: {}", run.id, amount(run)));
            if let Some(line) = self.lines.get(number) {
                sheet.line(format_args!("  {line}"));
            }
            let rows = run
                .columns
                .iter()
                .map(|c| vec![c.column.clone(), number_text(c.least), number_text(c.largest)]);
            sheet.block(&table(&["column", "smallest", "largest"], rows));
            for said in &run.renamed {
                sheet.line(format_args!(" {said}"));
            }
            if !run.left_out.is_empty() {
                sheet.line(format_args!(" left out: {}", names(&run.left_out)));
            }
        }
        if let Some((low, high)) = self.range {
            let (low, high) = (number_text(low), number_text(high));
            sheet.line(format_args!("\nRange of the input {low} to {high}: {}", self.range_rule));
        }
        sheet.line(format_args!(
            "Written to {0}; check the roles and uses of its runs, then `hhc check {0}`",
            self.folder
        ));
        sheet.finish()
    }
}

/// How much a run holds: curves, samples with their step, or points without one.
fn amount(run: &ImportedRun) -> String {
    let ImportedRun { samples_read, samples_written, block, .. } = run;
    match (run.curves, run.step_s) {
        (Some(curves), _) => format!("{}, {samples_written} points", counted(curves, "curve")),
        (None, Some(step)) if *block > 1 => format!(
            "{samples_read} samples read, {samples_written} written: means of {block} samples, step {step} s"
        ),
        (None, Some(step)) => format!("{samples_written} samples, step {step} s"),
        (None, None) => format!("{samples_written} points"),
    }
}

fn number_text(value: f64) -> String {
    significant(value, 6).to_string()
}

#[cfg(test)]
mod tests {
    use super::names;

    #[test]
    fn columns_without_a_name_are_counted() {
        let list = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        assert_eq!(names(&list(&["load", "", " ", "gain"])), "load, gain, 2 without a name");
        assert_eq!(names(&list(&["", ""])), "2 without a name");
        assert_eq!(names(&list(&["load"])), "load");
    }
}

//! What `hhc import` prints.

use crate::files::{Channel, DataSet, Folder, read_dataset};
use crate::output::{Printable, Sheet, table};
use bench_study::Glance;
use bench_study::identification::records;
pub use measured_data::import::*;
use measured_data::significant;
use preisach_dyn::identify::{Severity, Subject};
use serde::Serialize;
use std::ops::Deref;

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
    /// Looks at the records written: what identification would suspect becomes a warning.
    fn from(mut import: ImportResult) -> Self {
        let data = read_dataset(&Folder::Disk((&import.folder).into())).ok();
        let (runs, subject) = match &data {
            Some(DataSet::Bench(data)) => (&data.runs[..], Subject::Displacement),
            Some(DataSet::Loops(data)) => {
                let [input_unit, output_unit] =
                    data.channels.both().map(|c: &Channel| c.unit.symbol);
                (&data.runs[..], Subject::Loop { input_unit, output_unit })
            }
            _ => (&[][..], Subject::Actuator),
        };
        let glances: Vec<Glance> = records(runs, 1.0).iter().map(Glance::of).collect();
        let suspect = glances.iter().flat_map(|glance| &glance.findings);
        let suspect = suspect.filter(|finding| finding.severity() == Severity::Suspect);
        let said = |finding| format!("{}; {}", subject.finding(finding), subject.remedy(finding));
        import.warnings.extend(suspect.map(said));
        let lines = glances.iter().map(|glance| glance.line(subject)).collect();
        Self { import, glances, lines }
    }
}

impl Printable for ImportReport {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "{}: data set of kind {:?}, \"{}\"",
            self.folder, self.kind, self.title
        ));
        for (number, run) in self.runs.iter().enumerate() {
            sheet.line(format_args!("\n{}: {}", run.source, run.recognised));
            let samples = match (run.curves, run.step_s) {
                (Some(curves), _) => format!("{curves} curves, {} points", run.samples_written),
                (None, Some(step)) if run.block > 1 => format!(
                    "{} samples read, {} written: means of {} samples, step {step} s",
                    run.samples_read, run.samples_written, run.block
                ),
                (None, step) => {
                    format!("{} samples, step {} s", run.samples_written, step.unwrap_or(f64::NAN))
                }
            };
            sheet.line(format_args!("run {}: {samples}", run.id));
            if let Some(line) = self.lines.get(number) {
                sheet.line(format_args!("  {line}"));
            }
            let rows = run
                .columns
                .iter()
                .map(|c| vec![c.column.clone(), number_text(c.least), number_text(c.largest)]);
            sheet.block(&table(&["column", "smallest", "largest"], rows));
            if !run.left_out.is_empty() {
                sheet.line(format_args!(" left out: {}", run.left_out.join(", ")));
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

fn number_text(value: f64) -> String {
    significant(value, 6).to_string()
}

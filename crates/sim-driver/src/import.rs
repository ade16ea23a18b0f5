//! What `hhc import` prints.

use crate::output::{Printable, Sheet, table};
pub use measured_data::import::*;
use measured_data::significant;

impl Printable for ImportResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "{}: data set of kind {:?}, \"{}\"",
            self.folder, self.kind, self.title
        ));
        for run in &self.runs {
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

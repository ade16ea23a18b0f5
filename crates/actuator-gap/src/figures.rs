//! Data of the figures: residuals before and after, and what they look like.

use crate::diagnosis::Diagnosis;
use crate::displays::{Shown, displays};
use crate::simulator::RunShown;
use std::fmt::Write;

impl Diagnosis {
    /// Names and texts of the tables: the residual of every measured run before and after, their
    /// harmonics, and maps over input, rate, time since a reversal and dose of drive.
    pub fn figures(&self) -> Vec<(String, String)> {
        let mut tables = Vec::new();
        let mut shown = Vec::new();
        for own in &self.shown {
            let RunShown { id, start_s, step_s, input, residual: [before, after], .. } = own;
            let unit = &self.output_unit;
            let mut text = format!("time_s,residual_before_{unit},residual_after_{unit}\n");
            for (i, (a, b)) in before.iter().zip(after).enumerate() {
                // writing into a string does not fail
                let time_s = start_s + i as f64 * step_s;
                let _ = writeln!(text, "{time_s:.6},{a:.6e},{b:.6e}");
            }
            tables.push((format!("residual_{id}.csv"), text));
            shown.push(Shown { id, step_s: *step_s, input, before, after });
        }
        tables.extend(displays(&shown, &self.output_unit));
        tables
    }
}

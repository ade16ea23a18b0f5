//! Data of the figures: residuals before and after, and what they look like.

use crate::diagnosis::Diagnosis;
use crate::displays::{Shown, displays};
use std::fmt::Write;

impl Diagnosis {
    /// Names and texts of the tables: the residual of every measured run before and after, their
    /// harmonics, and maps over input, rate, time since a reversal and dose of drive.
    pub fn figures(&self) -> Vec<(String, String)> {
        let mut tables = Vec::new();
        let mut shown = Vec::new();
        for (t, &(run, channel, step_s)) in self.traces.iter().enumerate() {
            if channel != "output" {
                continue;
            }
            let unit = &self.output_unit;
            let mut text = format!("time_s,residual_before_{unit},residual_after_{unit}\n");
            let before = &self.finding.residual_before[t];
            let after = &self.finding.residual_after[t];
            for (i, (a, b)) in before.iter().zip(after).enumerate() {
                // writing into a string does not fail
                let time_s = self.run_starts_s[run] + i as f64 * step_s;
                let _ = writeln!(text, "{time_s:.6},{a:.6e},{b:.6e}");
            }
            tables.push((format!("residual_{}.csv", self.run_ids[run]), text));
            let (id, input) = (self.run_ids[run].as_str(), self.run_inputs[run].as_slice());
            shown.push(Shown { id, step_s, input, before, after });
        }
        tables.extend(displays(&shown, &self.output_unit));
        tables
    }
}

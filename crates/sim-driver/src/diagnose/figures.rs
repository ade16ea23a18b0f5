//! Data of the figures: residuals before and after.

use super::Diagnosis;
use std::fmt::Write;

impl Diagnosis {
    /// Names and texts of the tables: the residual of every measured run before and after.
    pub fn figures(&self) -> Vec<(String, String)> {
        let mut tables = Vec::new();
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
                let _ = writeln!(text, "{:.6},{a:.6e},{b:.6e}", i as f64 * step_s);
            }
            tables.push((format!("residual_{}.csv", self.run_ids[run]), text));
        }
        tables
    }
}

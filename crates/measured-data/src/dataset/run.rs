//! One experiment: what was done, how, and the table of its record.

use super::file::{Fitting, RunFile, Sensor};
use crate::tables::MeasuredTable;
use std::ops::Range;

/// One experiment with its table.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// What `dataset.ron` says of it.
    pub entry: RunFile,
    /// The numbers.
    pub table: MeasuredTable,
}

impl Run {
    /// A run with the sensor and the fitting that its id may stand for.
    pub(super) fn new(entry: RunFile, table: MeasuredTable) -> Self {
        let (sensor, fitting) = meant_by_id(&entry.id);
        let (sensor, fitting) = (entry.sensor.or(sensor), entry.fitting.or(fitting));
        Self { entry: RunFile { sensor, fitting, ..entry }, table }
    }

    /// The samples that train or are judged.
    pub fn window(&self) -> Range<usize> {
        samples_within(&self.table.time_s, self.entry.window_s)
    }

    /// Sensor that read the output, and how the system was fitted.
    pub fn setup(&self) -> (Sensor, Fitting) {
        (self.entry.sensor.unwrap_or_default(), self.entry.fitting.unwrap_or_default())
    }
}

/// Sensor and fitting that the id of a run stood for before they had keys of their own.
pub(super) fn meant_by_id(id: &str) -> (Option<Sensor>, Option<Fitting>) {
    (
        id.starts_with("laser_").then_some(Sensor::Ideal),
        id.starts_with("preload_").then_some(Fitting::Preloaded),
    )
}

/// The samples of a window, ends included; all without one.
pub(super) fn samples_within(time_s: &[f64], window_s: Option<(f64, f64)>) -> Range<usize> {
    let Some((from_s, to_s)) = window_s else {
        return 0..time_s.len();
    };
    let first = time_s.partition_point(|t| *t < from_s);
    let end = time_s.partition_point(|t| *t <= to_s);
    first..end.max(first)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::{Folder, write_atomic};
    use crate::read_bench;
    use std::fmt::Write;

    /// The runs `entries` of one record, and the warnings.
    fn read(entries: &str) -> Result<(Vec<Run>, String), String> {
        let mut table = "time_s,command_V,displacement_um\n".to_owned();
        for i in 0..200 {
            let volt = 65.0 + 60.0 * (0.1 * f64::from(i)).sin();
            let _ = writeln!(table, "{},{volt},{}", 0.01 * f64::from(i), 2.0 * volt);
        }
        let folder = tempfile::tempdir().unwrap();
        let text = format!("(kind: ActuatorBench, title: \"t\", runs: [{entries}])");
        write_atomic(&folder.path().join("dataset.ron"), text.as_bytes()).unwrap();
        write_atomic(&folder.path().join("a.csv"), table.as_bytes()).unwrap();
        let data =
            read_bench(&Folder::Disk(folder.path().to_path_buf())).map_err(|e| e.to_string())?;
        let warnings: Vec<String> = data.warnings.iter().map(ToString::to_string).collect();
        Ok((data.runs, warnings.join("\n")))
    }

    #[test]
    fn sensor_and_fitting_have_keys_and_are_still_read_from_the_id_with_a_warning() {
        let (runs, warnings) = read("(id: \"laser_a\", file: \"a.csv\", role: Measured)").unwrap();
        assert_eq!(runs[0].setup(), (Sensor::Ideal, Fitting::Plain));
        assert!(
            warnings.contains("runs[0].id: ") && warnings.contains("`sensor: Ideal`"),
            "{warnings}"
        );
        let (runs, warnings) =
            read("(id: \"preload_a\", file: \"a.csv\", role: Measured)").unwrap();
        assert_eq!(runs[0].setup(), (Sensor::Bench, Fitting::Preloaded));
        assert!(warnings.contains("`fitting: Preloaded`"), "{warnings}");
        let (runs, warnings) = read(
            "(id: \"laser_a\", file: \"a.csv\", role: Measured, sensor: Bench, fitting: Preloaded)",
        )
        .unwrap();
        assert_eq!(runs[0].setup(), (Sensor::Bench, Fitting::Preloaded));
        assert_eq!(warnings, "");
    }

    #[test]
    fn conditions_have_units_and_finite_values() {
        let with = |conditions: &str| {
            read(&format!(
                "(id: \"a\", file: \"a.csv\", role: Measured, conditions: {{{conditions}}})"
            ))
        };
        let (runs, _) = with("\"temperature_C\": 40, \"load_N\": 12.5").unwrap();
        assert_eq!(runs[0].entry.conditions["load_N"].to_bits(), 12.5_f64.to_bits());
        let text = with("\"temperature\": 40").unwrap_err();
        assert!(text.contains("runs[0].conditions.temperature: "), "{text}");
        let text = with("\"load_N\": inf").unwrap_err();
        assert!(text.contains("runs[0].conditions.load_N: the value is inf"), "{text}");
    }
}

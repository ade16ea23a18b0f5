//! `hhc identify`: bench data in, actuator model out.

use crate::SimError;
use crate::files::{BenchData, RunUse};
use crate::output::{Printable, Sheet, table};
use crate::problem::Place;
use crate::stored_actuator::{FitUse, StoredActuator, StoredFit, StoredKind};
use preisach_dyn::identify::{
    BenchRecord, Identification, RecordReport, RecordUse, Refinement, Settings, identify,
};
use preisach_dyn::{PreisachError, VoltageRange};
use serde::Serialize;

/// Half peak to peak of the slowest full-scale loop where the data set gives no gain, deg.
///
/// Source: the paper scales the displacement so that the quasi-static response is +-10 deg.
pub const QUASI_STATIC_AMPLITUDE_DEG: f64 = 10.0;

/// An identification with the data it came from.
#[derive(Debug, Clone)]
pub struct BenchIdentification {
    /// The models and how they fit.
    pub identification: Identification,
    /// The settings used, range and gain included.
    pub settings: Settings,
    /// The records as the identification saw them.
    pub records: Vec<BenchRecord>,
}

/// Identifies an actuator from a bench.
///
/// `base` gives what the data set does not: levels, form, split rule. Range and gain are the data
/// set's; without a gain the displacement is scaled so that the slowest full-scale loop is
/// [`QUASI_STATIC_AMPLITUDE_DEG`].
///
/// # Errors
/// [`SimError::Actuator`] at the place of the data set.
pub fn identify_bench(data: &BenchData, base: &Settings) -> Result<BenchIdentification, SimError> {
    let fail = |source: PreisachError| SimError::Actuator {
        place: Place::file(format!("{}/dataset.ron", data.folder)),
        source,
    };
    let (low, high) = data.command_range_volt;
    let range_volt = VoltageRange::new(low, high).map_err(fail)?;
    let deg_per_um = match data.flap_deg_per_um {
        Some(gain) => gain,
        None => quasi_static_gain(data, base),
    };
    let settings = Settings {
        range_volt,
        deg_per_um,
        ..base.clone()
    };
    let records: Vec<BenchRecord> = data
        .runs
        .iter()
        .map(|run| BenchRecord {
            id: run.id.clone(),
            time_step_s: run.table.time_step_s,
            voltage_volt: run.table.command_volt.clone(),
            output_deg: run
                .table
                .displacement_um
                .iter()
                .map(|x| deg_per_um * x)
                .collect(),
            record_use: run.use_as.map(|given| match given {
                RunUse::Train => RecordUse::Train,
                RunUse::HeldOut => RecordUse::HeldOut,
            }),
            base_frequency_hz: None,
        })
        .collect();
    let identification = identify(&records, &settings).map_err(fail)?;
    Ok(BenchIdentification {
        identification,
        settings,
        records,
    })
}

/// Gain that makes the widest of the quasi-static records +- [`QUASI_STATIC_AMPLITUDE_DEG`], deg/um.
fn quasi_static_gain(data: &BenchData, base: &Settings) -> f64 {
    let half_stroke = |displacement_um: &[f64]| {
        let (low, high) = displacement_um
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| {
                (l.min(x), h.max(x))
            });
        0.5 * (high - low)
    };
    let widest_um = data
        .runs
        .iter()
        .filter(|run| {
            let record = BenchRecord {
                id: String::new(),
                time_step_s: run.table.time_step_s,
                voltage_volt: run.table.command_volt.clone(),
                output_deg: run.table.displacement_um.clone(),
                record_use: None,
                base_frequency_hz: None,
            };
            let drive = record.drive();
            drive.is_periodic() && base.split.is_quasi_static(&drive)
        })
        .map(|run| half_stroke(&run.table.displacement_um))
        .fold(0.0, f64::max);
    // no slow loop at all: identification says so in its own words
    if widest_um > 0.0 {
        QUASI_STATIC_AMPLITUDE_DEG / widest_um
    } else {
        1.0
    }
}

impl BenchIdentification {
    /// The actuator file of this identification.
    pub fn stored(&self, data: &BenchData) -> StoredActuator {
        StoredActuator {
            kind: StoredKind::Actuator,
            title: data.title.clone(),
            dataset: data.folder.clone(),
            data_hash: data.content_hash.clone(),
            program_version: crate::VERSION.to_owned(),
            settings: self.settings.clone(),
            runs: self.identification.records.iter().map(stored_fit).collect(),
            model: self.identification.dynamic.clone(),
        }
    }

    /// What `hhc identify` prints.
    pub fn summary(&self, data: &BenchData, written_to: Option<String>) -> IdentifyResult {
        let base = Settings::default().split;
        let by_rule = data.runs.iter().any(|run| run.use_as.is_none());
        let rule = &self.settings.split;
        IdentifyResult {
            title: data.title.clone(),
            dataset: data.folder.clone(),
            split: if by_rule {
                format!(
                    "trained: quasi-static records (up to {} Hz) and, at {} Hz, the largest and the smallest amplitude; held out: all others{}",
                    rule.quasi_static_hz,
                    rule.trained_hz
                        .iter()
                        .map(f64::to_string)
                        .collect::<Vec<_>>()
                        .join(" and "),
                    if *rule == base {
                        ""
                    } else {
                        " (rule of the start file)"
                    },
                )
            } else {
                "as dataset.ron says for every run".to_owned()
            },
            deg_per_um: self.settings.deg_per_um,
            zero_deg: self.identification.zero_deg,
            refinement: self.identification.refinement,
            runs: self.identification.records.iter().map(stored_fit).collect(),
            written_to,
        }
    }
}

fn stored_fit(report: &RecordReport) -> StoredFit {
    StoredFit {
        id: report.id.clone(),
        use_as: match report.record_use {
            RecordUse::Train => FitUse::Trained,
            RecordUse::HeldOut => FitUse::HeldOut,
        },
        frequency_hz: report.drive.strongest_hz(),
        amplitude_volt: report.drive.amplitude_volt,
        nrmse_percent: report.dynamic.nrmse_percent(),
        static_nrmse_percent: report.static_only.nrmse_percent(),
        amplitude_error_percent: report.dynamic.amplitude_error_percent,
        phase_error_deg: report.dynamic.phase_error_deg,
    }
}

/// What `hhc identify` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IdentifyResult {
    /// Title of the data.
    pub title: String,
    /// Folder of the data.
    pub dataset: String,
    /// How the runs were split.
    pub split: String,
    /// Gain from displacement to flap angle, deg/um.
    pub deg_per_um: f64,
    /// Output of the records that is zero flap angle of the model, deg.
    pub zero_deg: f64,
    /// What the output-error refinement did.
    pub refinement: Refinement,
    /// Fit of every run.
    pub runs: Vec<StoredFit>,
    /// File the model was written to.
    pub written_to: Option<String>,
}

impl Printable for IdentifyResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!("{}", self.title));
        sheet.line(format_args!(
            "Data   {}\nSplit  {}",
            self.dataset, self.split
        ));
        sheet.line(format_args!(
            "Gain   {:.6} deg/um; {:.3} deg of the records is zero flap angle",
            self.deg_per_um, self.zero_deg
        ));
        sheet.line(format_args!(
            "Output-error refinement {:?}: rms NRMSE of the trained runs {:.2} % before, {:.2} % after",
            self.refinement.outcome,
            100.0 * self.refinement.nrmse_before,
            100.0 * self.refinement.nrmse_after
        ));
        for (title, use_as) in [
            ("Trained runs", FitUse::Trained),
            ("Held-out runs", FitUse::HeldOut),
        ] {
            sheet.line(format_args!("\n{title}"));
            sheet.block(&fit_table(self.runs.iter().filter(|r| r.use_as == use_as)));
        }
        sheet.line(format_args!(
            "\nNRMSE: rms error / standard deviation of the measured output. Amplitude and phase error at\nthe strongest harmonic of the command, steady cycles; positive phase: the model lags too much."
        ));
        if let Some(path) = &self.written_to {
            sheet.line(format_args!("Actuator written to {path}"));
        }
        sheet.finish()
    }
}

fn fit_table<'a>(runs: impl Iterator<Item = &'a StoredFit>) -> String {
    let optional = |v: Option<f64>| v.map_or_else(|| "-".into(), |v| format!("{v:+.2}"));
    table(
        &[
            "run",
            "Hz",
            "V",
            "NRMSE %",
            "static only %",
            "amplitude %",
            "phase deg",
        ],
        runs.map(|r| {
            vec![
                r.id.clone(),
                format!("{:.1}", r.frequency_hz),
                format!("{:.0}", r.amplitude_volt),
                format!("{:.2}", r.nrmse_percent),
                format!("{:.1}", r.static_nrmse_percent),
                optional(r.amplitude_error_percent),
                optional(r.phase_error_deg),
            ]
        }),
    )
}

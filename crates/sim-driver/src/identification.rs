//! `hhc identify`: bench data in, actuator model out.

use crate::SimError;
use crate::files::{BenchData, LoopData, RunRole, RunUse, significant};
use crate::output::{Printable, Sheet, table};
use crate::problem::Place;
use crate::stored_actuator::{FitUse, StoredActuator, StoredChannels, StoredFit, StoredKind};
use model_gap::{EnergySplit, FirstHarmonicError, GapError, Misfit, NoiseEstimate, RunError, Use};
use preisach_dyn::identify::{
    BenchRecord, Candidates, Finding, FlapZero, Identification, ModelComparison, RecordUse,
    RecordWindows, Refinement, Settings, Severity, Subject, compare_models, identify,
};
use preisach_dyn::{ActuatorModel, PreisachError, VoltageRange};
use rayon::prelude::*;
use serde::Serialize;
use std::ops::Range;

/// Half peak to peak of the slowest full-scale loop where the data set gives no gain, deg.
///
/// Source: the paper scales the displacement so that the quasi-static response is +-10 deg.
pub const QUASI_STATIC_AMPLITUDE_DEG: f64 = 10.0;

/// What the reports say about the data of an identification.
#[derive(Debug, Clone, PartialEq)]
pub struct DataHeading {
    /// Title of the data.
    pub title: String,
    /// Folder of the data.
    pub folder: String,
    /// blake3 of the data.
    pub content_hash: String,
    /// Whether a run leaves its side of the split to the rule.
    pub split_by_rule: bool,
    /// Whether `dataset.ron` gives a run its side of the split, by its use or by its role.
    pub split_by_data: bool,
    /// Input and output of a generic loop; none for an actuator: V and deg.
    pub channels: Option<StoredChannels>,
    /// Where the range of the inputs comes from.
    pub range_rule: &'static str,
}

impl DataHeading {
    /// The words and units of messages about the data.
    pub fn subject(&self) -> Subject<'static> {
        self.channels.as_ref().map_or(Subject::Actuator, |channels| {
            let unit =
                |label: &str| crate::files::Channel::parse(label).map_or("", |c| c.unit.symbol);
            Subject::Loop { input_unit: unit(&channels.input), output_unit: unit(&channels.output) }
        })
    }

    /// An error of the model or its identification, at the place of the data set.
    pub(crate) fn failed(&self, source: PreisachError) -> SimError {
        let place = Place::file(format!("{}/dataset.ron", self.folder));
        match self.subject() {
            Subject::Actuator => SimError::Actuator { place, source },
            subject @ Subject::Loop { .. } => {
                SimError::Loop { place, message: subject.error(&source), source }
            }
        }
    }
}

/// An identification with the data it came from.
#[derive(Debug, Clone)]
pub struct BenchIdentification {
    /// What the data are.
    pub heading: DataHeading,
    /// The models and how they fit.
    pub identification: Identification,
    /// The settings used, range and gain included.
    pub settings: Settings,
    /// The records as the identification saw them.
    pub records: Vec<BenchRecord>,
    /// How the models fit each record.
    pub fits: Vec<RunFit>,
    /// The table of all models, once it was asked for.
    pub comparison: Option<ModelComparison>,
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
    let settings = Settings { range_volt, deg_per_um, ..base.clone() };
    let records: Vec<BenchRecord> = data
        .runs
        .iter()
        .map(|run| BenchRecord {
            id: run.id.clone(),
            time_step_s: run.table.time_step_s,
            voltage_volt: run.table.command_volt.clone(),
            output_deg: run.table.displacement_um.iter().map(|x| deg_per_um * x).collect(),
            record_use: record_use(run.use_as, run.role),
            windows: windows(run.window_s, run.window()),
            ..BenchRecord::default()
        })
        .collect();
    let heading = DataHeading {
        title: data.title.clone(),
        folder: data.folder.clone(),
        content_hash: data.content_hash.clone(),
        split_by_rule: data.runs.iter().any(|run| record_use(run.use_as, run.role).is_none()),
        split_by_data: data.runs.iter().any(|run| record_use(run.use_as, run.role).is_some()),
        channels: None,
        range_rule: "command_range_V",
    };
    identified(heading, records, settings)
}

/// Identifies a model of a generic loop, in the units of its data.
///
/// The models see the input where an actuator has its voltage, and the output where it has its flap
/// angle, with a gain of 1: their unit names stand for those of the channels. The range is the data
/// set's; zero output stays where it was recorded.
///
/// # Errors
/// [`SimError::Loop`] at the place of the data set.
pub fn identify_loops(data: &LoopData, base: &Settings) -> Result<BenchIdentification, SimError> {
    let [input, output] = data.channels.both().map(crate::files::Channel::label);
    let heading = DataHeading {
        title: data.title.clone(),
        folder: data.folder.clone(),
        content_hash: data.content_hash.clone(),
        split_by_rule: data.runs.iter().any(|run| record_use(run.use_as, run.role).is_none()),
        split_by_data: data.runs.iter().any(|run| record_use(run.use_as, run.role).is_some()),
        channels: Some(StoredChannels { input, output }),
        range_rule: data.input_range.rule(),
    };
    let (low, high) = data.input_range.limits();
    let range_volt = VoltageRange::new(low, high).map_err(|source| heading.failed(source))?;
    let zero = FlapZero::AsRecorded;
    let settings = Settings { range_volt, deg_per_um: 1.0, zero, ..base.clone() };
    let records = data
        .runs
        .iter()
        .map(|run| BenchRecord {
            id: run.id.clone(),
            time_step_s: run.table.time_step_s,
            voltage_volt: run.table.input.clone(),
            output_deg: run.table.output.clone(),
            record_use: record_use(run.use_as, run.role),
            windows: windows(run.window_s, run.window()),
            ..BenchRecord::default()
        })
        .collect();
    identified(heading, records, settings)
}

/// Side of the split that the data set fixes: what it says of the run, and otherwise that measured
/// runs, which are there to be explained, never train.
fn record_use(given: Option<RunUse>, role: RunRole) -> Option<RecordUse> {
    match (given, role) {
        (Some(RunUse::Train), _) => Some(RecordUse::Train),
        (Some(RunUse::HeldOut), _) | (None, RunRole::Measured) => Some(RecordUse::HeldOut),
        (None, RunRole::Reference) => None,
    }
}

/// A window of a run trains and judges alike; without one all of the run does.
fn windows(window_s: Option<(f64, f64)>, samples: Range<usize>) -> RecordWindows {
    let window = window_s.map(|_| samples);
    RecordWindows { train: window.clone(), judge: window }
}

/// Identifies from records and judges the models by them.
fn identified(
    heading: DataHeading,
    records: Vec<BenchRecord>,
    settings: Settings,
) -> Result<BenchIdentification, SimError> {
    let identification = identify(&records, &settings).map_err(|e| heading.failed(e))?;
    // of a generic loop the table of models may still be of use; a rotor needs an actuator
    let not_described = identification.summary.findings.iter().find_map(|finding| match finding {
        Finding::NotDescribed { nrmse_percent } => Some(*nrmse_percent),
        _ => None,
    });
    if let (Some(nrmse_percent), None) = (not_described, &heading.channels) {
        return Err(heading.failed(PreisachError::NotDescribed { nrmse_percent }));
    }
    let fits = judged(&heading, &records, &identification)?;
    Ok(BenchIdentification { heading, identification, settings, records, fits, comparison: None })
}

fn judged(
    heading: &DataHeading,
    records: &[BenchRecord],
    identification: &Identification,
) -> Result<Vec<RunFit>, SimError> {
    judge(records, identification).map_err(|e| match e {
        Judged::Model(source) => heading.failed(source),
        Judged::Misfit { id, source } => {
            let place = Place::file(format!("{}/dataset.ron", heading.folder)).field(&id);
            SimError::Misfit { place, source }
        }
    })
}

/// Why a record cannot be judged.
enum Judged {
    Model(PreisachError),
    Misfit { id: String, source: GapError },
}

/// The identified models against every record, judged by `model-gap` from their simulated outputs: the
/// identification does not mark its own work.
fn judge(records: &[BenchRecord], identification: &Identification) -> Result<Vec<RunFit>, Judged> {
    records
        .par_iter()
        .zip(&identification.records)
        .map(|(record, report)| {
            let failed = |source| Judged::Misfit { id: record.id.clone(), source };
            let simulate = |model: &ActuatorModel| {
                let run = model.simulate(&record.voltage_volt, record.time_step_s);
                run.map(|simulation| simulation.output_deg).map_err(Judged::Model)
            };
            let measured: Vec<f64> =
                record.output_deg.iter().map(|y| y - identification.zero_deg).collect();
            let simulated = simulate(&identification.dynamic)?;
            let quasi_static = simulate(&identification.static_only)?;
            let drive = &report.drive;
            let steady = drive.steady.clone();
            let first_harmonic = if drive.is_periodic() {
                let (dt, hz) = (record.time_step_s, drive.strongest_hz());
                let (y, model) = (&measured[steady.clone()], &simulated[steady.clone()]);
                Some(FirstHarmonicError::of(y, model, dt, hz).map_err(failed)?)
            } else {
                None
            };
            // the noise of the steady cycles; a record without repeats tells none
            let noise = drive.is_periodic().then(|| {
                NoiseEstimate::from_cycles(&measured[steady], record.time_step_s, drive.base_hz)
            });
            // simulated from the first sample, judged inside the window
            let window = record.judged_samples();
            let judged = &measured[window.clone()];
            let structured = match noise {
                Some(Ok(noise)) => {
                    let split = EnergySplit::of(judged, &simulated[window.clone()], noise.variance);
                    Some(split.map_err(failed)?.structured)
                }
                _ => None,
            };
            Ok(RunFit {
                error: RunError {
                    id: record.id.clone(),
                    used: match report.record_use {
                        RecordUse::Train => Use::Train,
                        RecordUse::HeldOut => Use::HeldOut,
                    },
                    misfit: Misfit::of(judged, &simulated[window.clone()]).map_err(failed)?,
                    first_harmonic,
                },
                static_nrmse: Misfit::of(judged, &quasi_static[window]).map_err(failed)?.nrmse,
                structured,
                frequency_hz: drive.strongest_hz(),
                amplitude_volt: drive.amplitude_volt,
            })
        })
        .collect()
}

/// How the identified models fit one record.
#[derive(Debug, Clone, PartialEq)]
pub struct RunFit {
    /// Misfit of the dynamic model.
    pub error: RunError,
    /// NRMSE of the static model.
    pub static_nrmse: f64,
    /// Share of the output's energy that is neither explained nor noise; none without repeated cycles.
    pub structured: Option<f64>,
    /// Frequency of the strongest harmonic of the command, Hz.
    pub frequency_hz: f64,
    /// Half peak to peak of the command, V.
    pub amplitude_volt: f64,
}

/// Gain that makes the widest of the quasi-static records +- [`QUASI_STATIC_AMPLITUDE_DEG`], deg/um.
fn quasi_static_gain(data: &BenchData, base: &Settings) -> f64 {
    let half_stroke = |displacement_um: &[f64]| {
        let (low, high) = displacement_um
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), &x| (l.min(x), h.max(x)));
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
                ..BenchRecord::default()
            };
            let drive = record.drive();
            drive.is_periodic() && base.split.is_quasi_static(&drive)
        })
        .map(|run| half_stroke(&run.table.displacement_um))
        .fold(0.0, f64::max);
    // no slow loop at all: identification says so in its own words
    if widest_um > 0.0 { QUASI_STATIC_AMPLITUDE_DEG / widest_um } else { 1.0 }
}

impl BenchIdentification {
    /// Fits all families of models to the same records and keeps the table.
    ///
    /// # Errors
    /// [`SimError::Actuator`] or [`SimError::Loop`] at the place of the data set.
    pub fn compare(&mut self) -> Result<(), SimError> {
        let table = compare_models(&self.records, &self.settings, &Candidates::default());
        self.comparison = Some(table.map_err(|source| self.heading.failed(source))?);
        Ok(())
    }

    /// Puts the model that cross-validation chose in the place of the dynamic Preisach model. Nothing
    /// happens before [`Self::compare`].
    ///
    /// # Errors
    /// As [`identify_bench`].
    pub fn adopt_best(&mut self) -> Result<(), SimError> {
        if let Some(model) = self.comparison.as_ref().and_then(ModelComparison::model) {
            self.identification.dynamic = model.clone();
            self.fits = judged(&self.heading, &self.records, &self.identification)?;
        }
        Ok(())
    }

    /// The actuator file of this identification.
    pub fn stored(&self) -> StoredActuator {
        StoredActuator {
            kind: StoredKind::Actuator,
            title: self.heading.title.clone(),
            dataset: self.heading.folder.clone(),
            data_hash: self.heading.content_hash.clone(),
            program_version: crate::VERSION.to_owned(),
            channels: self.heading.channels.clone(),
            settings: self.settings.clone(),
            runs: self.fits.iter().map(stored_fit).collect(),
            model: self.identification.dynamic.clone(),
        }
    }

    /// What `hhc identify` prints.
    pub fn summary(&self, written_to: Option<String>) -> IdentifyResult {
        let base = Settings::default().split;
        let range = self.settings.range_volt;
        let rule = &self.settings.split;
        IdentifyResult {
            title: self.heading.title.clone(),
            dataset: self.heading.folder.clone(),
            channels: self.heading.channels.clone(),
            input_range: (range.lowest_volt(), range.highest_volt()),
            range_rule: self.heading.range_rule.to_owned(),
            split: if self.heading.split_by_rule {
                format!(
                    "{}trained: quasi-static records (up to {} Hz) and, at {} Hz, the largest and the smallest amplitude; held out: all others{}",
                    if self.heading.split_by_data {
                        "runs with a use, and measured ones, as dataset.ron says; of the others "
                    } else {
                        ""
                    },
                    rule.quasi_static_hz,
                    rule.trained_hz.iter().map(f64::to_string).collect::<Vec<_>>().join(" and "),
                    if *rule == base { "" } else { " (rule of the start file)" },
                )
            } else {
                "as dataset.ron says for every run".to_owned()
            },
            deg_per_um: self.settings.deg_per_um,
            zero_deg: self.identification.zero_deg,
            refinement: self.identification.refinement,
            runs: self.fits.iter().map(stored_fit).collect(),
            models: self
                .comparison
                .as_ref()
                .map_or_else(Vec::new, |table| model_lines(table, self.heading.subject())),
            findings: self
                .identification
                .summary
                .findings
                .iter()
                .map(|finding| FindingLine::of(finding, self.heading.subject()))
                .collect(),
            density_determined: self.identification.summary.density_determined,
            written_to,
        }
    }
}

/// One family of models in the table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModelLine {
    /// Its name.
    pub model: String,
    /// Levels of its memory.
    pub levels: usize,
    /// Whether cross-validation chose it.
    pub chosen: bool,
    /// RMS of the NRMSE of training runs left out of the fit, percent; none if none could be left out.
    pub cross_validation_percent: Option<f64>,
    /// RMS of the NRMSE of the training runs, percent.
    pub trained_percent: Option<f64>,
    /// RMS of the NRMSE of the held-out runs, percent.
    pub held_out_percent: Option<f64>,
    /// Largest NRMSE of a held-out run, percent.
    pub worst_held_out_percent: Option<f64>,
    /// Why there is no fit.
    pub failure: Option<String>,
}

fn model_lines(table: &ModelComparison, subject: Subject<'_>) -> Vec<ModelLine> {
    let percent = |v: f64| 100.0 * v;
    let line = |(index, row): (usize, &preisach_dyn::identify::ModelRow)| {
        let held_out = table.error_over(row, RecordUse::HeldOut);
        ModelLine {
            model: row.family.name().to_owned(),
            levels: row.order.levels,
            chosen: index == table.chosen,
            cross_validation_percent: row.cross_validation.filter(|v| v.is_finite()).map(percent),
            trained_percent: table.error_over(row, RecordUse::Train).map(|e| percent(e.0)),
            held_out_percent: held_out.map(|e| percent(e.0)),
            worst_held_out_percent: held_out.map(|e| percent(e.1)),
            failure: row.fitted.as_ref().err().map(|error| subject.error(error)),
        }
    };
    table.rows.iter().enumerate().map(line).collect()
}

/// One thing the data cannot tell, or that is wrong with them.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FindingLine {
    /// What it means for the model.
    pub severity: Severity,
    /// What was found, with its numbers.
    pub finding: Finding,
    /// The same as a sentence.
    pub message: String,
    /// What to do.
    pub remedy: &'static str,
}

impl FindingLine {
    fn of(finding: &Finding, subject: Subject<'_>) -> Self {
        Self {
            severity: finding.severity(),
            finding: finding.clone(),
            message: subject.finding(finding),
            remedy: subject.remedy(finding),
        }
    }
}

fn stored_fit(fit: &RunFit) -> StoredFit {
    let first = fit.error.first_harmonic.as_ref();
    StoredFit {
        id: fit.error.id.clone(),
        use_as: match fit.error.used {
            Use::Train => FitUse::Trained,
            Use::HeldOut => FitUse::HeldOut,
        },
        frequency_hz: fit.frequency_hz,
        amplitude_volt: fit.amplitude_volt,
        nrmse_percent: 100.0 * fit.error.misfit.nrmse,
        static_nrmse_percent: 100.0 * fit.static_nrmse,
        amplitude_error_percent: first.map(|f| 100.0 * (f.amplitude_ratio - 1.0)),
        phase_error_deg: first.map(|f| f.phase_error_deg),
        structured_percent: fit.structured.map(|s| 100.0 * s),
    }
}

/// What `hhc identify` prints.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct IdentifyResult {
    /// Title of the data.
    pub title: String,
    /// Folder of the data.
    pub dataset: String,
    /// Input and output of a generic loop; none for an actuator, V and deg.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub channels: Option<StoredChannels>,
    /// Range of the inputs, V or the unit of the input.
    pub input_range: (f64, f64),
    /// Where the range comes from.
    pub range_rule: String,
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
    /// All families of models on the same split; empty if they were not compared.
    pub models: Vec<ModelLine>,
    /// What the data cannot tell.
    pub findings: Vec<FindingLine>,
    /// Numbers of the static density that the training runs determine, of how many.
    pub density_determined: [usize; 2],
    /// File the model was written to.
    pub written_to: Option<String>,
}

impl Printable for IdentifyResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!("{}", self.title));
        sheet.line(format_args!("Data   {}\nSplit  {}", self.dataset, self.split));
        let (low, high) = self.input_range;
        match &self.channels {
            Some(channels) => sheet.line(format_args!(
                "Model  {} to {}, {} {low} to {high} ({})",
                channels.input, channels.output, channels.input, self.range_rule
            )),
            None => sheet.line(format_args!(
                "Gain   {:.6} deg/um; {:.3} deg of the records is zero flap angle",
                self.deg_per_um, self.zero_deg
            )),
        }
        sheet.line(format_args!(
            "Output-error refinement {:?}: rms NRMSE of the trained runs {:.2} % before, {:.2} % after",
            self.refinement.outcome,
            100.0 * self.refinement.nrmse_before,
            100.0 * self.refinement.nrmse_after
        ));
        for (title, use_as) in
            [("Trained runs", FitUse::Trained), ("Held-out runs", FitUse::HeldOut)]
        {
            sheet.line(format_args!("\n{title}"));
            let unit = self.channels.as_ref().map_or("V", |c| c.input.as_str());
            sheet.block(&fit_table(self.runs.iter().filter(|r| r.use_as == use_as), unit));
        }
        sheet.line(format_args!(
            "\nNRMSE: rms error / standard deviation of the measured output. Amplitude and phase error at\nthe strongest harmonic of the command, steady cycles; positive phase: the model lags too much.\nStructured: share of the output's energy that is neither explained nor noise of repeated cycles."
        ));
        if !self.models.is_empty() {
            sheet.line(format_args!("\nModels on the same split, NRMSE in %"));
            sheet.block(&model_table(&self.models));
            sheet.line(format_args!(
                "Left out: training runs of one frequency or one amplitude at a time; by this column the model\nmarked * is chosen. Held-out runs are never looked at for choosing."
            ));
            for failure in failures(&self.models) {
                sheet.line(format_args!("{failure}"));
            }
        }
        let [determined, unknowns] = self.density_determined;
        sheet.line(format_args!(
            "\nThe training runs determine {determined} of {unknowns} numbers of the static density."
        ));
        for line in &self.findings {
            sheet.line(format_args!("{:?}: {}\n  {}", line.severity, line.message, line.remedy));
        }
        if let Some(path) = &self.written_to {
            let what = if self.channels.is_some() { "Model" } else { "Actuator" };
            sheet.line(format_args!("{what} written to {path}"));
        }
        sheet.finish()
    }
}

fn model_table(models: &[ModelLine]) -> String {
    let optional = |v: Option<f64>| v.map_or_else(|| "-".into(), |v| format!("{v:.2}"));
    table(
        &["model", "levels", "left out", "trained", "held out", "worst held out"],
        models.iter().map(|m| {
            vec![
                format!("{}{}", if m.chosen { "* " } else { "" }, m.model),
                m.levels.to_string(),
                optional(m.cross_validation_percent),
                optional(m.trained_percent),
                optional(m.held_out_percent),
                optional(m.worst_held_out_percent),
            ]
        }),
    )
}

/// Why models have no fit, each reason once with the models it concerns.
fn failures(models: &[ModelLine]) -> Vec<String> {
    let mut reasons: Vec<(&str, Vec<&str>)> = Vec::new();
    for line in models {
        let Some(failure) = &line.failure else { continue };
        match reasons.iter_mut().find(|(reason, _)| reason == failure) {
            Some((_, concerned)) => concerned.push(&line.model),
            None => reasons.push((failure, vec![&line.model])),
        }
    }
    reasons
        .into_iter()
        .map(|(reason, concerned)| format!("Not fitted: {}\n  {reason}", concerned.join("; ")))
        .collect()
}

/// How the model fits the runs given.
///
/// `input` heads the column of the input's amplitude.
pub(crate) fn fit_table<'a>(runs: impl Iterator<Item = &'a StoredFit>, input: &str) -> String {
    let optional = |v: Option<f64>| v.map_or_else(|| "-".into(), |v| format!("{v:+.2}"));
    table(
        &[
            "run",
            "Hz",
            input,
            "NRMSE %",
            "static only %",
            "amplitude %",
            "phase deg",
            "structured %",
        ],
        runs.map(|r| {
            vec![
                r.id.clone(),
                format!("{}", significant(r.frequency_hz, 3)),
                format!("{}", significant(r.amplitude_volt, 3)),
                format!("{:.2}", r.nrmse_percent),
                format!("{:.1}", r.static_nrmse_percent),
                optional(r.amplitude_error_percent),
                optional(r.phase_error_deg),
                r.structured_percent.map_or_else(|| "-".into(), |v| format!("{v:.3}")),
            ]
        }),
    )
}

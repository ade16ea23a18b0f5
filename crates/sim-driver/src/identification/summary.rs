//! What `hhc identify` prints.

use super::{BenchIdentification, PickReason, RunFit};
use crate::files::significant;
use crate::output::{Printable, Screen, Sheet, table};
use crate::stored_actuator::{FitUse, GainRule, StoredChannels, StoredFit};
use model_gap::Use;
use preisach_dyn::identify::{
    Estimate, Family, Finding, MOST_UNEXPLAINED, ModelComparison, RecordUse, Refinement, Settings,
    Severity, Subject,
};
use serde::Serialize;

impl BenchIdentification {
    /// What `hhc identify` prints.
    pub fn summary(&self, written_to: Option<String>) -> IdentifyResult {
        let range = self.settings.range_volt;
        let subject = self.heading.subject();
        let found = &self.identification.summary;
        // the refinement that is known is the one of the first fit
        let refined = self.pick.family == Family::DynamicPreisach
            && self.model == self.identification.dynamic;
        IdentifyResult {
            title: self.heading.title.clone(),
            dataset: self.heading.folder.clone(),
            channels: self.heading.channels.clone(),
            input_range: (range.lowest_volt(), range.highest_volt()),
            range_rule: self.heading.range_rule.to_owned(),
            split: self.split(),
            deg_per_um: self.settings.deg_per_um,
            gain_rule: self.heading.gain_rule.map_or("", GainRule::text).to_owned(),
            zero_deg: self.identification.zero_deg,
            model: self.pick.family.name().to_owned(),
            levels: self.pick.order.levels,
            picked_by: self.pick.reason,
            refinement: refined.then_some(self.identification.refinement),
            parameters: self.pick.parameters.iter().map(ParameterLine::of).collect(),
            runs: self.fits.iter().map(RunFit::stored).collect(),
            models: self
                .comparison
                .as_ref()
                .map_or_else(Vec::new, |table| model_lines(table, subject)),
            findings: self.findings().iter().map(|f| FindingLine::of(f, subject)).collect(),
            density_determined: found.density_determined,
            written_to,
        }
    }

    /// What the data cannot tell; whether the model describes them is said of the model picked.
    fn findings(&self) -> Vec<Finding> {
        let mut findings = self.identification.summary.findings.clone();
        findings.retain(|finding| !matches!(finding, Finding::NotDescribed { .. }));
        let trained = self.fits.iter().filter(|fit| fit.error.used == Use::Train);
        let squares: Vec<f64> = trained.map(|fit| fit.error.misfit.nrmse.powi(2)).collect();
        let unexplained = (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt();
        if unexplained > MOST_UNEXPLAINED {
            findings.push(Finding::NotDescribed { nrmse_percent: 100.0 * unexplained });
        }
        findings
    }

    /// How the runs were split, in words.
    fn split(&self) -> String {
        if !self.heading.split_by_rule {
            return "as dataset.ron says for every run".to_owned();
        }
        let rule = &self.settings.split;
        format!(
            "{}trained: quasi-static records (up to {} Hz) and, at {} Hz, the largest and the smallest amplitude; held out: all others{}",
            if self.heading.split_by_data {
                "runs with a use, and measured ones, as dataset.ron says; of the others "
            } else {
                ""
            },
            rule.quasi_static_hz,
            rule.trained_hz.iter().map(f64::to_string).collect::<Vec<_>>().join(" and "),
            if *rule == Settings::default().split { "" } else { " (rule of the start file)" },
        )
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

/// One parameter of the model found by output error.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterLine {
    /// Its name, with its unit.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Its standard deviation; none if the records do not determine it.
    pub std_deviation: Option<f64>,
}

impl ParameterLine {
    fn of(estimate: &Estimate) -> Self {
        Self {
            name: estimate.name.clone(),
            value: estimate.value,
            std_deviation: Some(estimate.std_deviation).filter(|s| s.is_finite()),
        }
    }
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
    /// Where the gain comes from.
    pub gain_rule: String,
    /// Output of the records that is zero flap angle of the model, deg.
    pub zero_deg: f64,
    /// The model judged and written.
    pub model: String,
    /// Levels of its memory, where it has one.
    pub levels: usize,
    /// Why this model.
    pub picked_by: PickReason,
    /// What the output-error refinement of all its maps did; none for a model whose parameters alone
    /// were refined.
    pub refinement: Option<Refinement>,
    /// Parameters found by output error, as the fit holds them.
    pub parameters: Vec<ParameterLine>,
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

/// Rows of held-out runs on one screen.
const MOST_RUNS: usize = 6;
/// Findings on one screen.
const MOST_FINDINGS: usize = 4;

impl Printable for IdentifyResult {
    fn text(&self) -> String {
        let mut screen = Screen::default();
        screen.line(&self.title);
        screen.labelled("Model", &format!("{}, {}", self.model, self.picked()));
        if self.channels.is_none() {
            let gain = format!("{:.6} deg/um, {}", self.deg_per_um, self.gain_rule);
            screen.labelled("Gain", &gain);
        }
        let of = |use_as: FitUse| -> Vec<&StoredFit> {
            self.runs.iter().filter(|run| run.use_as == use_as).collect()
        };
        let mut held_out = of(FitUse::HeldOut);
        held_out.sort_by(|a, b| b.nrmse_percent.total_cmp(&a.nrmse_percent));
        for (label, runs) in [("Held out", &held_out), ("Trained", &of(FitUse::Trained))] {
            let squares: f64 = runs.iter().map(|run| run.nrmse_percent.powi(2)).sum();
            let rms = (squares / runs.len().max(1) as f64).sqrt();
            let worst = runs.iter().max_by(|a, b| a.nrmse_percent.total_cmp(&b.nrmse_percent));
            screen.labelled(
                label,
                &worst.map_or_else(
                    || "no run".to_owned(),
                    |worst| {
                        format!(
                            "{} runs, NRMSE {rms:.2} % rms, at most {:.2} % ({})",
                            runs.len(),
                            worst.nrmse_percent,
                            worst.id
                        )
                    },
                ),
            );
        }
        if !self.models.is_empty() {
            screen.line("\nModels on the same split, NRMSE in %; * chosen by the training runs left out of its fit");
            screen.block(&short_model_table(&self.models));
        }
        if !held_out.is_empty() {
            screen.line("\nHeld-out runs, the worst first");
            screen.block(&short_fit_table(&held_out));
        }
        screen.line("");
        for line in self.findings.iter().take(MOST_FINDINGS) {
            screen.labelled(&format!("{:?}", line.severity), &line.message);
        }
        screen.labelled("NRMSE", "rms error over the standard deviation of the measured output");
        if let Some(path) = &self.written_to {
            let what = if self.channels.is_some() { "Model" } else { "Actuator" };
            screen.line(&format!("{what} written to {path}"));
            screen.line("Every run and parameter: --details");
        }
        screen.finish()
    }

    fn details(&self) -> String {
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
                "Gain   {:.6} deg/um, {}; {:.3} deg of the records is zero flap angle",
                self.deg_per_um, self.gain_rule, self.zero_deg
            )),
        }
        sheet.line(format_args!("Fitted {}, {}", self.model, self.picked()));
        if let Some(refinement) = &self.refinement {
            sheet.line(format_args!(
                "       output-error refinement {:?}: rms NRMSE of the trained runs {:.2} % before, {:.2} % after",
                refinement.outcome,
                100.0 * refinement.nrmse_before,
                100.0 * refinement.nrmse_after
            ));
        }
        if !self.parameters.is_empty() {
            sheet.line(format_args!("\nParameters found by output error"));
            sheet.block(&parameter_table(&self.parameters));
        }
        for (title, use_as) in
            [("Trained runs", FitUse::Trained), ("Held-out runs", FitUse::HeldOut)]
        {
            let runs: Vec<&StoredFit> = self.runs.iter().filter(|r| r.use_as == use_as).collect();
            if runs.is_empty() {
                sheet.line(format_args!("\n{title}: none"));
                continue;
            }
            sheet.line(format_args!("\n{title}"));
            let unit = self.channels.as_ref().map_or("V", |c| c.input.as_str());
            sheet.block(&fit_table(runs.into_iter(), unit));
        }
        sheet.line(format_args!(
            "\nNRMSE: rms error / standard deviation of the measured output. Of range: rms error with its mean\nremoved / range of the measured output; offset: that mean, measured less simulated, in the output's\nunit. Amplitude and phase error at the strongest harmonic of the command, steady cycles; positive phase:\nthe model lags too much. Structured: share of the output's energy that is neither explained nor noise of\nrepeated cycles. A run with a window is judged inside it."
        ));
        for run in &self.runs {
            if let (Some(rms), Some(most)) = (run.start_up_rms_percent, run.start_up_percent) {
                sheet.line(format_args!(
                    "Before its window {} is missed by rms {rms:.2} %, at most {most:.2} % of range.",
                    run.id
                ));
            }
        }
        if !self.models.is_empty() {
            sheet.line(format_args!("\nModels on the same split, NRMSE in %"));
            sheet.block(&model_table(&self.models));
            sheet.line(format_args!(
                "{} Held-out runs take no part in the choice.",
                if self.models.iter().any(|m| m.cross_validation_percent.is_some()) {
                    "Left out: training runs of one frequency or one amplitude at a time; by this column the model\nmarked * is chosen, a simpler one if it is within 3 %."
                } else {
                    "Left out: too few training runs to leave one out. The model marked * is the usual one for such\nruns; nothing in the data chooses it."
                }
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

impl IdentifyResult {
    /// Why the model is the one judged, in words.
    fn picked(&self) -> &'static str {
        match self.picked_by {
            PickReason::OnlyFit => "the only one fitted",
            PickReason::CrossValidation => "chosen by cross-validation",
            PickReason::NothingToChooseBy => {
                "the usual one: too few training runs to choose a model by"
            }
            PickReason::AskedFor => "as asked for",
        }
    }
}

fn parameter_table(parameters: &[ParameterLine]) -> String {
    table(
        &["parameter", "value", "std deviation"],
        parameters.iter().map(|p| {
            let deviation = p
                .std_deviation
                .map_or_else(|| "not determined".to_owned(), |s| significant(s, 2).to_string());
            vec![p.name.clone(), significant(p.value, 4).to_string(), deviation]
        }),
    )
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

/// The table of models that fits a screen.
fn short_model_table(models: &[ModelLine]) -> String {
    let optional = |v: Option<f64>| v.map_or_else(|| "-".into(), |v| format!("{v:.2}"));
    table(
        &["model", "left out", "trained", "held out", "worst"],
        models.iter().map(|m| {
            vec![
                format!("{}{}", if m.chosen { "* " } else { "" }, m.model),
                optional(m.cross_validation_percent),
                optional(m.trained_percent),
                optional(m.held_out_percent),
                optional(m.worst_held_out_percent),
            ]
        }),
    )
}

/// The worst runs.
fn short_fit_table(runs: &[&StoredFit]) -> String {
    let optional = |v: Option<f64>| v.map_or_else(|| "-".into(), |v| format!("{v:+.2}"));
    table(
        &["run", "Hz", "amplitude", "NRMSE %", "amplitude error %", "phase error deg"],
        runs.iter().take(MOST_RUNS).map(|r| {
            vec![
                r.id.clone(),
                format!("{}", significant(r.frequency_hz, 3)),
                format!("{}", significant(r.amplitude_volt, 3)),
                format!("{:.2}", r.nrmse_percent),
                optional(r.amplitude_error_percent),
                optional(r.phase_error_deg),
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
    let plain = |v: Option<f64>| v.map_or_else(|| "-".into(), |v| format!("{v:.3}"));
    table(
        &[
            "run",
            "Hz",
            input,
            "NRMSE %",
            "of range %",
            "offset",
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
                plain(r.range_percent),
                r.offset.map_or_else(|| "-".into(), |v| significant(v, 2).to_string()),
                format!("{:.1}", r.static_nrmse_percent),
                optional(r.amplitude_error_percent),
                optional(r.phase_error_deg),
                plain(r.structured_percent),
            ]
        }),
    )
}

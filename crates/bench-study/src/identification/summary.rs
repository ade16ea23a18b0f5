//! What `hhc identify` prints.

use super::physical::{PhysicalParameter, physical};
use super::{BenchIdentification, PickReason, subject};
use crate::stored::{GainRule, StoredChannels, StoredFit};
use measured_data::significant;
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::{
    Channel, DensitySpread, Estimate, Family, Finding, LeftOut, MOST_UNEXPLAINED, ModelComparison,
    ModelRow, NoiseSource, RecordUse, Refinement, Settings, Severity, Subject,
};
use report_page::{Section, Sheet, counted, table};
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
            parameters: self.pick.parameters.clone(),
            physical: physical(
                &self.pick.parameters,
                &self.known_quantities(),
                &self.model,
                subject.units(),
            ),
            actuator: self.model.clone(),
            runs: self.fits.clone(),
            models: self
                .comparison
                .as_ref()
                .map_or_else(Vec::new, |table| model_lines(table, self.pick.row.as_ref(), subject)),
            left_out: self.comparison.as_ref().map_or(LeftOut::Nothing, |t| t.left_out),
            findings: self.findings(),
            density_determined: found.density_determined,
            density_spread: self.identification.density_spread.as_ref().map(DensityLine::of),
            written_to,
            page_written_to: None,
        }
    }

    /// What the data cannot tell; whether the model describes them is said of the model picked.
    fn findings(&self) -> Vec<FindingLine> {
        let subject = self.heading.subject();
        let nrmse_percent = rms_percent(&of_use(&self.fits, RecordUse::Train));
        let not_described = (nrmse_percent > 100.0 * MOST_UNEXPLAINED)
            .then_some(Finding::NotDescribed { nrmse_percent });
        let of_data = self.identification.summary.findings.iter().cloned();
        // what is said of the model stands first: a screen shows a few
        not_described
            .into_iter()
            .chain(self.better_held_out())
            .chain(self.levels_differ().unwrap_or_default())
            .chain(of_data.filter(|finding| !matches!(finding, Finding::NotDescribed { .. })))
            .map(|finding| FindingLine {
                severity: finding.severity(),
                message: said(subject, &finding, self.settings.deg_per_um),
                remedy: subject.remedy(&finding),
                finding,
            })
            .collect()
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

/// A finding as a sentence in the units of the data: of an actuator um, though models know flap angles.
fn said(subject: Subject<'_>, finding: &Finding, deg_per_um: f64) -> String {
    let Subject::Actuator = subject else { return subject.finding(finding) };
    let mut own = finding.clone();
    match &mut own {
        Finding::ConstantCommand { noise, .. } => {
            for value in [&mut noise.std_deg, &mut noise.drift_deg_per_min, &mut noise.hum_deg] {
                *value /= deg_per_um;
            }
        }
        Finding::OutputFalls { slope: value, .. }
        | Finding::Clipped { channel: Channel::Output, level: value, .. }
        | Finding::Spikes { channel: Channel::Output, value, .. } => *value /= deg_per_um,
        _ => {}
    }
    Subject::Displacement.finding(&own)
}

/// The runs of one side of the split.
fn of_use(runs: &[StoredFit], use_as: RecordUse) -> Vec<&StoredFit> {
    runs.iter().filter(|run| run.use_as == use_as).collect()
}

/// RMS of the NRMSE of runs, percent; 0 of none.
fn rms_percent(runs: &[&StoredFit]) -> f64 {
    let squares: f64 = runs.iter().map(|run| run.nrmse_percent.powi(2)).sum();
    (squares / runs.len().max(1) as f64).sqrt()
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
    /// RMS of the NRMSE of training runs, or of blocks of the only one, left out of the fit, percent; none if nothing could be
    /// left out.
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

/// The families of a comparison; that of the model picked in the order that was picked.
fn model_lines(
    table: &ModelComparison,
    picked: Option<&ModelRow>,
    subject: Subject<'_>,
) -> Vec<ModelLine> {
    let percent = |v: f64| 100.0 * v;
    let line = |(index, row): (usize, &ModelRow)| {
        let row = picked.filter(|own| own.family == row.family).unwrap_or(row);
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
    /// Parameters found by output error, as the fit holds them; a deviation is null in JSON if the
    /// records do not determine the parameter.
    pub parameters: Vec<Estimate>,
    /// What the model says in physical terms, with 95 % intervals where they are confirmed for its family.
    pub physical: Vec<PhysicalParameter>,
    /// The model itself, as the actuator file holds it.
    pub actuator: ActuatorModel,
    /// Fit of every run.
    pub runs: Vec<StoredFit>,
    /// All families of models on the same split; empty if they were not compared.
    pub models: Vec<ModelLine>,
    /// What was left out of the fits in turn to choose among them.
    pub left_out: LeftOut,
    /// What the data cannot tell.
    pub findings: Vec<FindingLine>,
    /// Numbers of the static density that the training runs determine, of how many.
    pub density_determined: [usize; 2],
    /// What noise does to the static density; none if that cannot be computed.
    pub density_spread: Option<DensityLine>,
    /// File the model was written to.
    pub written_to: Option<String>,
    /// Page of pictures beside it.
    pub page_written_to: Option<String>,
}

/// What noise does to the static density, in numbers for all cells.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct DensityLine {
    /// Cells of the Preisach triangle.
    pub cells: usize,
    /// Those at their bound, zero.
    pub at_bound: usize,
    /// Those of which the records say less than a twentieth: the rest is that of their neighbours.
    pub from_neighbours: usize,
    /// Standard deviation of the noise of the slow records, in the unit of the output.
    pub noise: f64,
    /// Where it comes from.
    pub noise_source: NoiseSource,
}

/// Share of a rise from the records below which it counts as that of its neighbours. A density that is smooth over some
/// cells has that many parts.
pub(crate) const LEAST_SHARE: f64 = 0.05;

impl DensityLine {
    fn of(spread: &DensitySpread) -> Self {
        let shares = || spread.record_share.iter().flatten();
        let count = |is_so: fn(&Option<f64>) -> bool| shares().filter(|own| is_so(own)).count();
        Self {
            cells: shares().count(),
            at_bound: count(Option::is_none),
            from_neighbours: count(|own| own.is_some_and(|share| share < LEAST_SHARE)),
            noise: spread.noise_deg,
            noise_source: spread.noise_source,
        }
    }

    /// It in words; `unit`: that of the output.
    pub fn text(&self, unit: &str) -> String {
        let source = match self.noise_source {
            NoiseSource::Cycles => "from repeated cycles",
            NoiseSource::Residual => "what the static model leaves, no cycle being repeated",
        };
        format!(
            "Of {} cells {} are at their bound, zero, and {} have less than a twentieth from the runs; noise {} {unit}, {source}.",
            self.cells,
            self.at_bound,
            self.from_neighbours,
            significant(self.noise, 2)
        )
    }
}

/// Rows of held-out runs on one screen.
const MOST_RUNS: usize = 6;
/// Findings on one screen.
const MOST_FINDINGS: usize = 4;

impl IdentifyResult {
    /// What a person wants to see first.
    pub fn text(&self) -> String {
        let mut screen = Sheet::default();
        screen.line(&self.title);
        screen.labelled("Model", &format!("{}, {}", self.model, self.picked()));
        if self.channels.is_none() {
            let gain = format!("{:.6} deg/um, {}", self.deg_per_um, self.gain_rule);
            screen.labelled("Gain", &gain);
        }
        let mut held_out = of_use(&self.runs, RecordUse::HeldOut);
        held_out.sort_by(|a, b| b.nrmse_percent.total_cmp(&a.nrmse_percent));
        for (label, text) in self.sides() {
            screen.labelled(label, &text);
        }
        if !self.models.is_empty() {
            let why = match self.left_out {
                LeftOut::Nothing => "the usual one: too few training runs to choose by",
                _ => "chosen by the training runs left out of its fit",
            };
            screen.line(format_args!("\nModels on the same split, NRMSE in %; * {why}"));
            screen.block(&as_text(&self.models_compared(false)));
        }
        if !held_out.is_empty() {
            screen.line("\nHeld-out runs, the worst first");
            screen.block(&short_fit_table(&held_out));
        }
        screen.line("");
        for line in self.findings.iter().take(MOST_FINDINGS) {
            screen.labelled(&format!("{:?}", line.severity), &line.message);
        }
        screen.labelled(
            "NRMSE",
            "rms error over the standard deviation of the measured output; the fit of MATLAB is 100 % less that",
        );
        if let Some(written) = self.written() {
            screen.line(&written);
            if let Some(page) = &self.page_written_to {
                screen.line(format_args!("Page written to {page}"));
            }
            screen.line("Every run and parameter: --details");
        }
        screen.screen()
    }

    /// Every table.
    pub fn details(&self) -> String {
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
        if !self.physical.is_empty() {
            sheet.line(format_args!("\nPhysical parameters"));
            sheet.block(&as_text(&self.parameters_found()));
        }
        for (title, use_as) in
            [("Trained runs", RecordUse::Train), ("Held-out runs", RecordUse::HeldOut)]
        {
            let runs = of_use(&self.runs, use_as);
            if runs.is_empty() {
                sheet.line(format_args!("\n{title}: none"));
                continue;
            }
            sheet.line(format_args!("\n{title}"));
            let unit = self.channels.as_ref().map_or("V", |c| c.input.as_str());
            sheet.block(&fit_table(runs.into_iter(), unit));
        }
        sheet.line(format_args!(
            "\nNRMSE: rms error / standard deviation of the measured output; MATLAB's fit is 100 % less that. Of range: rms error with its mean\nremoved / range of the measured output; offset: that mean, measured less simulated, in the output's\nunit. Amplitude and phase error at the strongest harmonic of the command, steady cycles; positive phase:\nthe model lags too much. Structured: share of the output's energy that is neither explained nor noise of\nrepeated cycles. A run with a window is judged inside it."
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
            sheet.block(&as_text(&self.models_compared(true)));
            sheet.line(self.how_chosen());
            for failure in self.not_fitted() {
                sheet.line(format_args!("{failure}"));
            }
        }
        let [determined, unknowns] = self.density_determined;
        sheet.line(format_args!(
            "\nThe training runs determine {determined} of {unknowns} numbers of the static density."
        ));
        if let Some(spread) = &self.density_spread {
            sheet.line(spread.text(self.units()[1]));
        }
        for line in &self.findings {
            sheet.line(format_args!("{:?}: {}\n  {}", line.severity, line.message, line.remedy));
        }
        if let Some(written) = self.written() {
            sheet.line(format_args!("{written}"));
        }
        if let Some(page) = &self.page_written_to {
            sheet.line(format_args!("Page written to {page}"));
        }
        sheet.finish()
    }
}

impl IdentifyResult {
    /// Where the model was written to, in words.
    fn written(&self) -> Option<String> {
        let what = if self.channels.is_some() { "Model" } else { "Actuator" };
        self.written_to.as_ref().map(|path| format!("{what} written to {path}"))
    }

    /// Held-out and trained runs, each side in a line.
    pub(crate) fn sides(&self) -> [(&'static str, String); 2] {
        [("Held out", RecordUse::HeldOut), ("Trained", RecordUse::Train)].map(|(label, use_as)| {
            let runs = of_use(&self.runs, use_as);
            let worst = runs.iter().max_by(|a, b| a.nrmse_percent.total_cmp(&b.nrmse_percent));
            let text = match worst {
                Some(worst) => format!(
                    "{}, NRMSE {:.2} % rms, at most {:.2} % ({})",
                    counted(runs.len(), "run"),
                    rms_percent(&runs),
                    worst.nrmse_percent,
                    worst.id
                ),
                None => "no run".to_owned(),
            };
            (label, text)
        })
    }

    /// Symbols of the units of input and output.
    pub(crate) fn units(&self) -> [&str; 2] {
        subject(self.channels.as_ref()).units()
    }

    /// The models compared; that of a screen is without the levels of their memories.
    pub(crate) fn models_compared(&self, has_levels: bool) -> Section {
        model_table(&self.models, has_levels)
    }

    /// How the choice among the models was made.
    pub(crate) fn how_chosen(&self) -> String {
        let way = match self.left_out {
            LeftOut::Records => {
                "Left out: training runs of one frequency or one amplitude at a time; by this column the model\nmarked * is chosen, a simpler one if it is within 3 %, the noise taken off."
            }
            LeftOut::RecordsAndBlocks => {
                "Left out: slow training runs one at a time, and blocks in time of the only fast one; by this column the\nmodel marked * is chosen, a simpler one if it is within 3 %, the noise taken off."
            }
            LeftOut::Blocks if self.trains_one() => {
                "Left out: blocks in time of the one training run, each run through and scored on the block; by this\ncolumn the model marked * is chosen, a simpler one if it is within 3 %, the noise taken off."
            }
            LeftOut::Blocks => {
                "Left out: blocks in time of the largest training run, as the commands of each run go beyond those of the others; by\nthis column the model marked * is chosen, a simpler one if it is within 3 %, the noise taken off."
            }
            LeftOut::Nothing => {
                "Left out: too few training runs to leave one out. The model marked * is the usual one for such\nruns; nothing in the data chooses it."
            }
        };
        format!("{way} Held-out runs take no part in the choice.")
    }

    /// Why families have no fit, each reason once.
    pub(crate) fn not_fitted(&self) -> Vec<String> {
        failures(&self.models)
    }

    /// The physical parameters.
    pub(crate) fn parameters_found(&self) -> Section {
        parameter_table(&self.physical)
    }

    /// Whether one run alone trains.
    fn trains_one(&self) -> bool {
        of_use(&self.runs, RecordUse::Train).len() == 1
    }

    /// Why the model is the one judged, in words.
    pub(crate) fn picked(&self) -> &'static str {
        match self.picked_by {
            PickReason::OnlyFit => "the only one fitted",
            PickReason::CrossValidation => "chosen by cross-validation",
            PickReason::BlocksInTime if self.trains_one() => {
                "chosen by blocks in time of the one training run"
            }
            PickReason::BlocksInTime => "chosen by blocks in time of the largest training run",
            PickReason::NothingToChooseBy => {
                "the usual one: too few training runs to choose a model by"
            }
            PickReason::AskedFor => "as asked for",
        }
    }
}

/// A table without title.
pub(crate) fn section(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> Section {
    let header = header.iter().map(|&head| head.to_owned()).collect();
    Section { header, rows: rows.into_iter().collect(), ..Section::default() }
}

/// A table for the terminal.
fn as_text(own: &Section) -> String {
    let header: Vec<&str> = own.header.iter().map(String::as_str).collect();
    table(&header, own.rows.iter().cloned())
}

fn parameter_table(parameters: &[PhysicalParameter]) -> Section {
    section(
        &["parameter", "value", "95 % interval", ""],
        parameters.iter().map(|own| {
            let value = format!("{} {}", significant(own.value, 4), own.unit);
            let none = if own.remark.is_some() { "-" } else { "not determined" };
            let interval = own.interval.map_or(none.to_owned(), |[low, high]| {
                format!("{} to {}", significant(low, 4), significant(high, 4))
            });
            let remark = own.remark.unwrap_or_default().to_owned();
            vec![own.name.clone(), value.trim_end().to_owned(), interval, remark]
        }),
    )
}

/// The table of models; that of a screen is without the levels of their memories.
fn model_table(models: &[ModelLine], has_levels: bool) -> Section {
    let levels = usize::from(has_levels);
    let header = ["levels", "left out", "trained", "held out", "worst"];
    section(
        &[&["model"], &header[1 - levels..]].concat(),
        models.iter().map(|m| {
            let model = format!("{}{}", if m.chosen { "* " } else { "" }, m.model);
            let percents = [
                m.cross_validation_percent,
                m.trained_percent,
                m.held_out_percent,
                m.worst_held_out_percent,
            ];
            let levels = std::iter::repeat_n(m.levels.to_string(), levels);
            let percents = percents.map(|v| optional(v, |v| format!("{v:.2}")));
            std::iter::once(model).chain(levels).chain(percents).collect()
        }),
    )
}

fn optional<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or_else(|| "-".into(), text)
}

/// The worst runs.
fn short_fit_table(runs: &[&StoredFit]) -> String {
    table(
        &["run", "Hz", "amplitude", "NRMSE %", "amplitude error %", "phase error deg"],
        runs.iter().take(MOST_RUNS).map(|run| {
            let (head, [.., amplitude, phase, _]) = fit_cells(run);
            head.into_iter().chain([amplitude, phase]).collect()
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
pub fn fit_table<'a>(runs: impl Iterator<Item = &'a StoredFit>, input: &str) -> String {
    as_text(&fits(runs, input))
}

/// The same without its form, sorted by frequency and amplitude.
pub(crate) fn fits<'a>(runs: impl Iterator<Item = &'a StoredFit>, input: &str) -> Section {
    let mut runs: Vec<&StoredFit> = runs.collect();
    runs.sort_by(|a, b| {
        let of_hz = a.frequency_hz.total_cmp(&b.frequency_hz);
        of_hz.then(a.amplitude_volt.total_cmp(&b.amplitude_volt))
    });
    section(
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
        runs.into_iter().map(|run| {
            let (head, rest) = fit_cells(run);
            head.into_iter().chain(rest).collect()
        }),
    )
}

/// The cells of [`fit_table`]: first what is shown of every run, then the rest.
fn fit_cells(run: &StoredFit) -> ([String; 4], [String; 6]) {
    let signed = |v: f64| format!("{v:+.2}");
    let plain = |v: f64| format!("{v:.3}");
    (
        [
            run.id.clone(),
            // what does not repeat has none
            optional(run.response.as_ref(), |_| significant(run.frequency_hz, 3).to_string()),
            significant(run.amplitude_volt, 3).to_string(),
            format!("{:.2}", run.nrmse_percent),
        ],
        [
            optional(run.range_percent, plain),
            optional(run.offset, |v| significant(v, 2).to_string()),
            format!("{:.1}", run.static_nrmse_percent),
            optional(run.amplitude_error_percent, signed),
            optional(run.phase_error_deg, signed),
            optional(run.structured_percent, plain),
        ],
    )
}

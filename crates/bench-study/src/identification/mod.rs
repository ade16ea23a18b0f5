//! `hhc identify`: bench data in, actuator model out.

mod choice;
mod intervals;
mod levels;
mod physical;
mod summary;

pub use choice::{ModelChoice, Pick, PickReason};
pub use intervals::{KnownQuantity, known_quantities};
pub use physical::PhysicalParameter;
pub use summary::fit_table;
pub use summary::{DensityLine, FindingLine, IdentifyResult, ModelLine};
pub(crate) use summary::{LEAST_SHARE, fits, section};

use crate::BenchError;
use crate::glance::{OF_BUTTERFLY, is_butterfly};
use crate::stored::{GainRule, StoredActuator, StoredChannels, StoredFit, StoredKind};
use actuator_gap::{DiagnosisError, NotJudged, judged};
use measured_data::problem::{Fault, Place, Problem};
use measured_data::{BenchData, Channel, DATASET, LoopData, Run, RunRole, limits};
use preisach_dyn::identify::{
    BenchRecord, Candidates, Family, Finding, FlapZero, Identification, MOST_UNEXPLAINED,
    ModelComparison, RecordUse, RecordWindows, RestNoise, Settings, Subject, compare_models,
    identify,
};
use preisach_dyn::{ActuatorModel, PreisachError, VoltageRange};
use rayon::prelude::*;
use rotor_base::mean_square;

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
    /// Where the gain comes from; none of a generic loop.
    pub gain_rule: Option<GainRule>,
}

/// The place of the description of a data folder.
pub fn dataset_place(folder: &str) -> Place {
    Place::file(format!("{folder}/{DATASET}"))
}

impl DataHeading {
    /// Data of that title, folder and hash: voltages of an actuator, without the rule of its gain.
    fn new([title, folder, content_hash]: [&String; 3], runs: &[Run]) -> Self {
        Self {
            title: title.clone(),
            folder: folder.clone(),
            content_hash: content_hash.clone(),
            split_by_rule: runs.iter().any(|run| record_use(run).is_none()),
            split_by_data: runs.iter().any(|run| record_use(run).is_some()),
            channels: None,
            range_rule: "command_range_V",
            gain_rule: None,
        }
    }

    /// The words and units of messages about the data.
    pub fn subject(&self) -> Subject<'static> {
        subject(self.channels.as_ref())
    }

    /// A record that cannot be judged, at the place of the data set.
    fn misjudged(&self, NotJudged { id, source }: NotJudged) -> BenchError {
        match source {
            DiagnosisError::Actuator(source) => self.failed(source),
            source => {
                BenchError::Diagnosis { place: dataset_place(&self.folder).field(id), source }
            }
        }
    }

    /// What is missing of data in which nothing moves.
    fn only_rests(&self, rests: &[BenchRecord]) -> Problem {
        let ids: Vec<&str> = rests.iter().map(|record| record.id.as_str()).collect();
        let message = format!(
            "the input rests in every record ({}): noise, hum and drift can be read from rests, a model cannot. Record a slow sine or triangle over the range, and a faster one for what depends on rate, and import them together with the rests",
            ids.join(", ")
        );
        Problem::new(dataset_place(&self.folder).field("runs"), Fault::Refused { message })
    }

    /// An error of the model or its identification, at the place of the data set.
    pub fn failed(&self, source: PreisachError) -> BenchError {
        let place = dataset_place(&self.folder);
        match self.subject() {
            subject @ Subject::Loop { .. } => {
                BenchError::Loop { place, message: subject.error(&source), source }
            }
            _ => BenchError::Actuator { place, source },
        }
    }
}

/// The words and units of messages about data of some channels; without any, of an actuator.
fn subject(channels: Option<&StoredChannels>) -> Subject<'static> {
    channels.map_or(Subject::Actuator, |channels| {
        let unit = |label: &str| Channel::parse(label).map_or("", |c| c.unit.symbol);
        Subject::Loop { input_unit: unit(&channels.input), output_unit: unit(&channels.output) }
    })
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
    /// The model to use: the dynamic Preisach model until another one is picked.
    pub model: ActuatorModel,
    /// Which model that is, and why.
    pub pick: Pick,
    /// How the model fits each record.
    pub fits: Vec<StoredFit>,
    /// The table of all models, once it was asked for.
    pub comparison: Option<ModelComparison>,
}

/// Models that a comparison fits at most: the families, and the orders of the one chosen.
pub const MODELS_COMPARED: usize = 20;

/// Whether all families of models are fitted to the same records, side by side with the identification, and their table
/// kept.
pub type Compared<'a> = Option<Comparing<'a>>;

/// A comparison: of which families, the simplest first, and what is called after each of at most [`MODELS_COMPARED`] fits.
#[derive(Clone, Copy)]
pub struct Comparing<'a> {
    /// The families.
    pub families: &'a [Family],
    /// What is called.
    pub done: &'a (dyn Fn() + Sync),
}

impl<'a> Comparing<'a> {
    /// All families.
    pub fn all(done: &'a (dyn Fn() + Sync)) -> Self {
        Self { families: &Family::ALL, done }
    }
}

/// Identifies an actuator from a bench.
///
/// `base` gives what the data set does not: levels, form, split rule. Range and gain are the data
/// set's; without a gain the displacement is scaled so that the slowest full-scale loop is
/// [`QUASI_STATIC_AMPLITUDE_DEG`].
///
/// # Errors
/// [`BenchError::Actuator`] at the place of the data set.
pub fn identify_bench(
    data: &BenchData,
    base: &Settings,
    compared: Compared<'_>,
) -> Result<BenchIdentification, BenchError> {
    let (deg_per_um, gain_rule) = gain(data, base);
    let of = [&data.title, &data.folder, &data.content_hash];
    let heading = DataHeading { gain_rule: Some(gain_rule), ..DataHeading::new(of, &data.runs) };
    let (low, high) = data.command_range_volt;
    let range_volt = VoltageRange::new(low, high).map_err(|source| heading.failed(source))?;
    let settings = Settings { range_volt, deg_per_um, ..base.clone() };
    identified(heading, records(&data.runs, deg_per_um), settings, compared)
}

/// Identifies a model of a generic loop, in the units of its data.
///
/// The models see the input where an actuator has its voltage, and the output where it has its flap
/// angle, with a gain of 1: their unit names stand for those of the channels. The range is the data
/// set's; zero output stays where it was recorded.
///
/// # Errors
/// [`BenchError::Loop`] at the place of the data set.
pub fn identify_loops(
    data: &LoopData,
    base: &Settings,
    compared: Compared<'_>,
) -> Result<BenchIdentification, BenchError> {
    let [input, output] = data.channels.both().map(Channel::label);
    let heading = DataHeading {
        channels: Some(StoredChannels { input, output }),
        range_rule: data.range_rule,
        ..DataHeading::new([&data.title, &data.folder, &data.content_hash], &data.runs)
    };
    let (low, high) = data.input_range;
    let range_volt = VoltageRange::new(low, high).map_err(|source| heading.failed(source))?;
    let zero = FlapZero::AsRecorded;
    let settings = Settings { range_volt, deg_per_um: 1.0, zero, ..base.clone() };
    identified(heading, records(&data.runs, 1.0), settings, compared)
}

/// The runs as an identification sees them, with a gain from their outputs.
pub fn records(runs: &[Run], gain: f64) -> Vec<BenchRecord> {
    // a folder of measured runs alone has no others to train by
    let is_bare =
        runs.iter().all(|run| run.entry.role == RunRole::Measured && run.entry.use_as.is_none());
    let record = |run: &Run| {
        // a window trains and judges alike; without one all of the run does
        let window = run.entry.window_s.map(|_| run.window());
        BenchRecord {
            id: run.entry.id.clone(),
            time_step_s: run.table.time_step_s,
            voltage_volt: run.table.input.clone(),
            output_deg: run.table.output.iter().map(|output| gain * output).collect(),
            record_use: if is_bare { None } else { record_use(run) },
            windows: RecordWindows { train: window.clone(), judge: window },
            ..BenchRecord::default()
        }
    };
    runs.iter().map(record).collect()
}

/// Side of the split that the data set fixes: what it says of the run, and otherwise that measured
/// runs, which are there to be explained, never train.
fn record_use(run: &Run) -> Option<RecordUse> {
    let measured = run.entry.role == RunRole::Measured;
    run.entry.use_as.or(measured.then_some(RecordUse::HeldOut))
}

/// Identifies from records and judges the models by them.
fn identified(
    heading: DataHeading,
    records: Vec<BenchRecord>,
    settings: Settings,
    compared: Compared<'_>,
) -> Result<BenchIdentification, BenchError> {
    let (rests, mut records): (Vec<_>, Vec<_>) =
        records.into_iter().partition(BenchRecord::is_at_rest);
    if records.is_empty() && !rests.is_empty() {
        return Err(heading.only_rests(&rests).into());
    }
    let mut spikes = Vec::new();
    for record in &mut records {
        if let Some((mended, found)) = record.without_spikes() {
            spikes.extend(found);
            *record = mended;
        }
    }
    let mut switched_on = Vec::new();
    // 0 V is where an amplifier is switched on; of other channels nothing is known
    for record in records.iter_mut().filter(|_| heading.channels.is_none()) {
        if let Some(from_zero) = record.from_switch_on(settings.range_volt) {
            switched_on.push(Finding::SwitchedOn { id: record.id.clone() });
            *record = from_zero;
        }
    }
    let noises: Vec<f64> = rests.iter().map(|r| RestNoise::of_record(r).rms_deg()).collect();
    let rest_noise_deg = (!noises.is_empty()).then(|| mean_square(&noises).sqrt());
    let table = || {
        let compare = |Comparing { families, done }: Comparing<'_>| {
            let candidates =
                Candidates { families: families.to_vec(), rest_noise_deg, ..Candidates::default() };
            compare_models(&records, &settings, &candidates, done)
        };
        compared.map(compare).transpose()
    };
    let (identification, comparison) = rayon::join(|| identify(&records, &settings), table);
    let mut identification = identification.map_err(|e| heading.failed(e))?;
    let findings = &mut identification.summary.findings;
    findings.extend(rests.iter().map(Finding::of_rest).chain(spikes).chain(switched_on));
    let comparison = comparison.map_err(|source| heading.failed(source))?;
    let explained = |table: &ModelComparison| {
        let error = table.best().and_then(|row| table.error_over(row, RecordUse::Train));
        error.is_some_and(|(nrmse, _)| nrmse <= MOST_UNEXPLAINED)
    };
    // another model of the table describes the device
    if comparison.as_ref().is_some_and(explained) {
        let findings = &mut identification.summary.findings;
        findings.retain(|finding| !matches!(finding, Finding::NotDescribed { .. }));
    }
    // of a generic loop the table of models may still be of use; a rotor needs an actuator
    let not_described = identification.summary.findings.iter().find_map(|finding| match finding {
        Finding::NotDescribed { nrmse_percent } => Some(*nrmse_percent),
        _ => None,
    });
    if let (Some(nrmse_percent), None) = (not_described, &heading.channels) {
        if let Some(record) = records.iter().find(|own| is_butterfly(own, &own.drive())) {
            let message =
                format!("{OF_BUTTERFLY}, and set command_range_V of dataset.ron to that range");
            let place = dataset_place(&heading.folder).field(format!("record {}", record.id));
            return Err(Problem::new(place, Fault::Refused { message }).into());
        }
        return Err(heading.failed(PreisachError::NotDescribed { nrmse_percent }));
    }
    let model = identification.dynamic.clone();
    let fits = judged(&records, &identification, &model).map_err(|e| heading.misjudged(e))?;
    let pick = Pick::first_fit(&settings);
    Ok(BenchIdentification {
        heading,
        identification,
        settings,
        records,
        model,
        pick,
        fits,
        comparison,
    })
}

/// Flap angle per displacement of a bench, deg/um, and where it comes from: the data set, else what makes
/// the widest of the quasi-static records +- [`QUASI_STATIC_AMPLITUDE_DEG`]; 1 if there is no slow loop.
pub fn gain(data: &BenchData, base: &Settings) -> (f64, GainRule) {
    if let Some(gain) = data.flap_deg_per_um {
        return (gain, GainRule::DataSet);
    }
    let half_stroke_um = |(run, record): (&Run, BenchRecord)| {
        let drive = record.drive();
        let (low, high) = limits(&run.table.output[run.window()]);
        (drive.is_periodic() && base.split.is_quasi_static(&drive)).then_some(0.5 * (high - low))
    };
    let runs = data.runs.iter().zip(records(&data.runs, 1.0));
    let widest_um = runs.filter_map(half_stroke_um).fold(0.0, f64::max);
    if widest_um > 0.0 {
        (QUASI_STATIC_AMPLITUDE_DEG / widest_um, GainRule::WidestSlowLoop)
    } else {
        (1.0, GainRule::Assumed)
    }
}

impl BenchIdentification {
    /// Output of the model on every record, from its first sample on.
    ///
    /// # Errors
    /// [`BenchError::Actuator`] or [`BenchError::Loop`] if the model cannot be simulated on one of them.
    pub fn simulated(&self) -> Result<Vec<Vec<f64>>, BenchError> {
        let simulate = |record: &BenchRecord| {
            let run = self.model.simulate(&record.voltage_volt, record.time_step_s);
            run.map(|simulation| simulation.output_deg)
        };
        let all: Result<_, PreisachError> = self.records.par_iter().map(simulate).collect();
        all.map_err(|source| self.heading.failed(source))
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
            gain: self.heading.gain_rule,
            settings: self.settings.clone(),
            runs: self.fits.clone(),
            model: self.model.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use measured_data::{Accuracy, MeasuredTable, RunFile};
    use preisach_dyn::{
        ActuatorLaw, Calibration, HystereticOscillator, LinearGain, OscillatorParameters,
    };
    use std::f64::consts::TAU;

    /// A slow loop and sines up to 75 Hz, as a law answers them, 1 deg/um.
    fn bench(law: ActuatorLaw) -> BenchData {
        let range = VoltageRange::amplified_stack();
        let model = ActuatorModel::new(law, range, Calibration { deg_per_um: 1.0, zero_um: 0.0 });
        let run = |(hz, volt): (f64, f64)| {
            let time_step_s = if hz < 1.0 { 4e-3 } else { 1e-3 };
            let at = |i: u32| time_step_s * f64::from(i);
            let input: Vec<f64> =
                (0..2000).map(|i| 65.0 + volt * (TAU * hz * at(i)).sin()).collect();
            let output = model.simulate(&input, time_step_s).unwrap().output_deg;
            let time_s = (0..2000).map(at).collect();
            let id = format!("{hz} Hz, {volt} V");
            let use_as = Some(RecordUse::Train);
            let table = MeasuredTable { time_s, time_step_s, input, output, ..Default::default() };
            Run { entry: RunFile { id, use_as, ..RunFile::default() }, table }
        };
        let runs = [(0.5, 80.0), (20.0, 60.0), (45.0, 20.0), (58.0, 12.0), (75.0, 20.0)];
        BenchData {
            title: String::new(),
            folder: "bench".into(),
            runs: runs.map(run).to_vec(),
            flap_deg_per_um: Some(1.0),
            command_range_volt: (range.lowest_volt(), range.highest_volt()),
            accuracy: Accuracy::default(),
            warnings: vec![],
            content_hash: String::new(),
        }
    }

    /// The paper's model does not describe it, another one of the table does.
    #[test]
    fn an_oscillator_is_not_outside_of_the_class() {
        let law = HystereticOscillator::new(OscillatorParameters {
            range_volt: VoltageRange::amplified_stack(),
            gain_deg_per_volt: 0.1,
            frequency_hz: 62.0,
            damping_ratio: 0.04,
            hysteretic_share: 0.4,
            loading_per_deg: 0.1,
            unloading_per_deg: 0.1,
            offset_deg: 0.0,
        });
        let data = bench(ActuatorLaw::HystereticOscillator(law.unwrap()));
        let alone = identify_bench(&data, &Settings::default(), None).unwrap_err();
        assert!(
            matches!(
                alone,
                BenchError::Actuator { source: PreisachError::NotDescribed { .. }, .. }
            ),
            "{alone}"
        );
        let compared = Some(Comparing::all(&|| ()));
        let mut found = identify_bench(&data, &Settings::default(), compared).unwrap();
        found.pick(None).unwrap();
        assert_eq!(found.pick.family, Family::HystereticOscillator);
        let findings = &found.identification.summary.findings;
        assert!(!findings.iter().any(|f| matches!(f, Finding::NotDescribed { .. })));
    }

    /// A model that was left out is not replaced by another one in silence.
    #[test]
    fn a_mode_that_no_run_shows_is_refused_with_the_remedy() {
        let line = LinearGain { gain_deg_per_volt: 0.1, bias_volt: 65.0 };
        let data = bench(ActuatorLaw::Linear(line));
        let compared = Some(Comparing::all(&|| ()));
        let mut found = identify_bench(&data, &Settings::default(), compared).unwrap();
        let message = found.pick(Some(Family::BoucWenMode)).unwrap_err().to_string();
        assert!(message.contains("Bouc-Wen + mode was left out"), "{message}");
        assert!(message.contains("--only"), "{message}");
    }

    /// What a run is said to be missed by is that of the run without the numbers that stand for none.
    #[test]
    fn spikes_are_no_part_of_the_error() {
        let line = LinearGain { gain_deg_per_volt: 0.1, bias_volt: 65.0 };
        let mut data = bench(ActuatorLaw::Linear(line));
        for index in [300, 900, 1400] {
            data.runs[1].table.output[index] = -9999.0;
        }
        let only = Some(Comparing { families: &[Family::Linear], done: &|| () });
        let found = identify_bench(&data, &Settings::default(), only).unwrap();
        let summary = found.summary(None);
        for run in &summary.runs {
            assert!(run.nrmse_percent < 1.0, "{}: {} %", run.id, run.nrmse_percent);
        }
        let is_told = |f: &&Finding| matches!(f, Finding::Spikes { samples: 3, .. });
        assert_eq!(found.identification.summary.findings.iter().filter(is_told).count(), 1);
    }

    /// A run at rest tells the noise that models are compared after.
    #[test]
    fn a_rest_is_taken_into_the_comparison() {
        let line = LinearGain { gain_deg_per_volt: 0.1, bias_volt: 65.0 };
        let mut data = bench(ActuatorLaw::Linear(line));
        let sawtooth = |i: usize| if i.is_multiple_of(2) { 0.05 } else { -0.05 };
        for run in &mut data.runs {
            run.table.output.iter_mut().enumerate().for_each(|(i, y)| *y += sawtooth(i));
        }
        let mut rest = data.runs[0].clone();
        rest.table.input.fill(65.0);
        let count = rest.table.output.len();
        rest.table.output = (0..count).map(sawtooth).collect();
        data.runs.truncate(1);
        // one cycle alone does not repeat
        data.runs[0].table.input.truncate(520);
        data.runs[0].table.output.truncate(520);
        data.runs[0].table.time_s.truncate(520);
        data.runs.push(rest);
        let only = Some(Comparing { families: &[Family::Linear], done: &|| () });
        let found = identify_bench(&data, &Settings::default(), only).unwrap();
        let row = &found.comparison.as_ref().unwrap().rows[0];
        let spread = rotor_base::variance(&data.runs[0].table.output).sqrt();
        assert!((row.noise * spread / 0.05 - 1.0).abs() < 1e-3, "{}", row.noise * spread);
    }
}

//! The records of a diagnosis, in the units of the bench.

use measured_data::{Accuracy, BenchData, Fitting, LoopData, Run, RunRole, Sensor};
use model_gap::Thinning;
use rayon::prelude::*;
use rotor_base::{RecordUse, mean_square, variance};
use std::ops::Range;

/// One record: input, output and what else was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Record {
    /// Name of the run.
    pub id: String,
    /// Whether it shows the system with nothing missing.
    pub is_reference: bool,
    /// Time between samples, s.
    pub step_s: f64,
    /// Input: V on a bench.
    pub input: Vec<f64>,
    /// Output: um on a bench.
    pub output: Vec<f64>,
    /// Terminal voltage, V.
    pub amplifier: Option<Vec<f64>>,
    /// Temperature, degrees Celsius.
    pub temperature: Option<Vec<f64>>,
    /// Load on the actuator, N.
    pub load: Option<Vec<f64>>,
    /// Samples that are fitted and judged. Simulations begin at the first sample all the same.
    pub window: Range<usize>,
    /// Sensor that read the output.
    pub sensor: Sensor,
    /// How the actuator was fitted to the bench.
    pub fitting: Fitting,
    /// Seconds since switch-on at which the record begins, where the data say it.
    pub start_s: Option<f64>,
}

impl Record {
    /// A measured record of input and output alone, all of which is judged.
    pub fn new(id: impl Into<String>, step_s: f64, input: Vec<f64>, output: Vec<f64>) -> Self {
        Self {
            id: id.into(),
            is_reference: false,
            step_s,
            window: 0..output.len(),
            input,
            output,
            amplifier: None,
            temperature: None,
            load: None,
            sensor: Sensor::Bench,
            fitting: Fitting::Plain,
            start_s: None,
        }
    }

    /// Whether the run was read by a second, ideal sensor.
    pub fn has_ideal_sensor(&self) -> bool {
        self.sensor == Sensor::Ideal
    }

    /// Whether the lever was preloaded, so that no joint has play.
    pub fn is_preloaded(&self) -> bool {
        self.fitting == Fitting::Preloaded
    }

    /// The part of a signal of this run that is judged.
    pub(crate) fn judged<'a>(&self, signal: &'a [f64]) -> &'a [f64] {
        signal.get(self.window.clone()).unwrap_or(signal)
    }

    /// Output that is judged.
    pub(crate) fn judged_output(&self) -> &[f64] {
        self.judged(&self.output)
    }

    /// Input meanwhile.
    pub(crate) fn judged_input(&self) -> &[f64] {
        self.judged(&self.input)
    }

    /// Whether the input never changes where it is judged.
    pub(crate) fn is_at_rest(&self) -> bool {
        self.judged_input().windows(2).all(|pair| (pair[1] - pair[0]).abs() <= 0.0)
    }

    /// Takes a zero off the output.
    pub(crate) fn lower(&mut self, zero: f64) {
        self.output.iter_mut().for_each(|y| *y -= zero);
    }

    /// The record without the samples in between.
    fn thinned(&self, thin: Thinning) -> Self {
        let of = |signal: &Vec<f64>| thin.of_signal(signal);
        let place = |sample: usize| sample.saturating_sub(thin.first).div_ceil(thin.every);
        Self {
            step_s: self.step_s * thin.every as f64,
            input: of(&self.input),
            output: of(&self.output),
            amplifier: self.amplifier.as_ref().map(of),
            temperature: self.temperature.as_ref().map(of),
            load: self.load.as_ref().map(of),
            window: place(self.window.start)..place(self.window.end),
            start_s: self.start_s.map(|start_s| start_s + self.step_s * thin.first as f64),
            ..self.clone()
        }
    }

    /// Length of what is judged, s.
    pub fn duration_s(&self) -> f64 {
        self.step_s * self.judged_input().len() as f64
    }

    /// Frequency of a sine that moves as fast as the input, Hz: see `frequency_hz`.
    pub fn frequency_hz(&self) -> f64 {
        frequency_hz(self.judged_input(), self.step_s)
    }
}

/// Records without samples that were interpolated between those of their outputs: they tell nothing, and make noise look
/// small. A run that does not show it is taken to be sampled as most runs of its step are.
pub(crate) fn as_measured(runs: &[Record]) -> Vec<Record> {
    let of = |run: &Record| Thinning::of(&run.output);
    let own: Vec<Option<Thinning>> = runs.par_iter().map(of).collect();
    let usual = |step_s: f64| {
        let alike = runs.iter().zip(&own).filter(|(run, _)| is_near(run.step_s, step_s));
        let mut found: Vec<Option<Thinning>> = alike.map(|(_, thin)| *thin).collect();
        found.sort_by_key(|thin| thin.map(|thin| thin.every));
        found[(found.len() - 1) / 2]
    };
    let thinned = |(run, own): (&Record, &Option<Thinning>)| {
        own.or_else(|| usual(run.step_s)).map_or_else(|| run.clone(), |thin| run.thinned(thin))
    };
    runs.iter().zip(&own).map(thinned).collect()
}

/// Whether two times between samples are one, but for how they were written.
pub(crate) fn is_near(step_s: f64, other_s: f64) -> bool {
    (step_s / other_s - 1.0).abs() < 1e-6
}

/// Time between samples up to which a bench is as fast as those of piezo actuators, s.
const USUAL_STEP_S: f64 = 0.01;

/// Times slower than a usual bench runs are, by the finest sampling among them; 1 of any faster. Relaxations and lags
/// are looked for where the sampling can show them.
pub(crate) fn slower(runs: &[&Record]) -> f64 {
    let finest_s = runs.iter().map(|r| r.step_s).fold(f64::INFINITY, f64::min);
    if finest_s.is_finite() { (finest_s / USUAL_STEP_S).max(1.0) } else { 1.0 }
}

/// Frequency of a sine that moves as fast as an input, for its size, Hz: RMS of the rate over the spread.
pub(crate) fn frequency_hz(input: &[f64], step_s: f64) -> f64 {
    let rates: Vec<f64> = input.windows(2).map(|w| (w[1] - w[0]) / step_s).collect();
    let spread = variance(input).sqrt();
    if spread > 0.0 { mean_square(&rates).sqrt() / spread / std::f64::consts::TAU } else { 0.0 }
}

/// Records with their range and units.
#[derive(Debug, Clone, PartialEq)]
pub struct Records {
    /// Title of the data.
    pub title: String,
    /// Folder of the data.
    pub folder: String,
    /// The records.
    pub runs: Vec<Record>,
    /// Range of the input.
    pub range: (f64, f64),
    /// Unit of the input.
    pub input_unit: String,
    /// Unit of the output.
    pub output_unit: String,
    /// Name and unit of the input, such as `command_V`.
    pub input_label: String,
    /// Name and unit of the output.
    pub output_label: String,
    /// Flap angle per output, deg/um, if it is an actuator and the data say it.
    pub deg_per_um: Option<f64>,
    /// How well the channels keep their calibration from one session to the next.
    pub accuracy: Accuracy,
    /// Whether this is an actuator bench.
    pub is_bench: bool,
    /// blake3 of the data.
    pub content_hash: String,
}

/// The records of runs.
///
/// A run may be a reference by its role. In a set without any measured run, where the sides of the
/// split are stated, those to be held out are what has to be explained.
fn records(runs: &[Run]) -> Vec<Record> {
    let all_reference = runs.iter().all(|r| r.entry.role == RunRole::Reference);
    let is_explained = |run: &Run| match run.entry.role {
        RunRole::Measured => true,
        RunRole::Reference => all_reference && run.entry.use_as == Some(RecordUse::HeldOut),
    };
    runs.iter()
        .map(|run| Record {
            id: run.entry.id.clone(),
            is_reference: !is_explained(run),
            step_s: run.table.time_step_s,
            input: run.table.input.clone(),
            output: run.table.output.clone(),
            amplifier: run.table.amplifier_volt.clone(),
            temperature: run.table.temperature_celsius.clone(),
            load: run.table.load_newton.clone(),
            window: run.window(),
            sensor: run.setup().0,
            fitting: run.setup().1,
            start_s: run.entry.start_s,
        })
        .collect()
}

impl From<&BenchData> for Records {
    fn from(data: &BenchData) -> Self {
        Self {
            title: data.title.clone(),
            folder: data.folder.clone(),
            runs: records(&data.runs),
            range: data.command_range_volt,
            input_unit: "V".into(),
            output_unit: "um".into(),
            input_label: "command_V".into(),
            output_label: "displacement_um".into(),
            deg_per_um: data.flap_deg_per_um,
            accuracy: data.accuracy,
            is_bench: true,
            content_hash: data.content_hash.clone(),
        }
    }
}

impl From<&LoopData> for Records {
    fn from(data: &LoopData) -> Self {
        Self {
            title: data.title.clone(),
            folder: data.folder.clone(),
            runs: records(&data.runs),
            range: data.input_range,
            input_unit: data.channels.input.unit.symbol.to_owned(),
            output_unit: data.channels.output.unit.symbol.to_owned(),
            input_label: data.channels.input.label(),
            output_label: data.channels.output.label(),
            deg_per_um: None,
            accuracy: Accuracy::EXACT,
            is_bench: false,
            content_hash: data.content_hash.clone(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use measured_data::{MeasuredTable, RunFile};

    #[test]
    fn window_sensor_and_fitting_of_a_run_reach_its_record() {
        let time_s: Vec<f64> = (0..100).map(|i| 0.01 * f64::from(i)).collect();
        let run = |id: &str, role, window_s, sensor, fitting| Run {
            entry: RunFile {
                id: id.into(),
                role,
                window_s,
                sensor: Some(sensor),
                fitting: Some(fitting),
                ..RunFile::default()
            },
            table: MeasuredTable {
                time_step_s: 0.01,
                input: time_s.clone(),
                output: time_s.clone(),
                time_s: time_s.clone(),
                ..MeasuredTable::default()
            },
        };
        let data = BenchData {
            title: String::new(),
            folder: String::new(),
            runs: vec![
                run("a", RunRole::Reference, None, Sensor::Bench, Fitting::Preloaded),
                run("b", RunRole::Measured, Some((0.195, 0.495)), Sensor::Ideal, Fitting::Plain),
            ],
            flap_deg_per_um: None,
            command_range_volt: (-20.0, 150.0),
            accuracy: Accuracy::default(),
            warnings: vec![],
            content_hash: String::new(),
        };
        let [first, second] = &Records::from(&data).runs[..] else { panic!("two runs") };
        assert!(first.is_reference && first.is_preloaded() && !first.has_ideal_sensor());
        assert_eq!(first.window, 0..100);
        assert!(!second.is_reference && second.has_ideal_sensor() && !second.is_preloaded());
        assert_eq!(second.window, 20..50);
        assert!((second.duration_s() - 0.3).abs() < 1e-12);
    }

    #[test]
    fn samples_in_between_go_with_their_channels_and_windows() {
        let mut draw = model_gap::SplitMix(3);
        let measured: Vec<f64> =
            (0..400).map(|i| (0.05 * f64::from(i)).sin() + 0.01 * draw.normal()).collect();
        let own = |id: &str| Record::new(id, 1e-3, measured.clone(), measured.clone());
        let fine = |id: &str| {
            let halves = measured.windows(2).flat_map(|w| [w[0], w[0].midpoint(w[1])]);
            let fine: Vec<f64> = halves.chain(measured.last().copied()).collect();
            let load = Some(fine.clone());
            let record = Record::new(id, 5e-4, fine.clone(), fine);
            Record { load, window: 100..701, ..record }
        };
        let back = |id: &str| Record { load: Some(measured.clone()), window: 50..351, ..own(id) };
        // one that is at rest shows nothing: it goes with most runs of its step, and not with half of them
        let rest = Record::new("rest", 5e-4, vec![1.0; 799], vec![1.0; 799]);
        let thin = Record::new("rest", 1e-3, vec![1.0; 400], vec![1.0; 400]);
        let read = as_measured(&[fine("a"), rest.clone(), own("c"), fine("b")]);
        assert!(read == [back("a"), thin, own("c"), back("b")]);
        assert!(as_measured(&[fine("a"), rest.clone()]) == [back("a"), rest]);
    }
}

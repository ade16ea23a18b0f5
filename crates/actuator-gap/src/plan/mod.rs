//! What planned runs would show: each cause put into the simulation, the runs simulated and diagnosed.

mod sized;
mod usual;

pub use usual::usual_runs;

use crate::causes::LIBRARY;
use crate::diagnosis::{Diagnosis, diagnose};
use crate::error::DiagnosisError;
use crate::numbers::less;
use crate::question::{Question, StructureStore};
use crate::record::{Record, Records};
use crate::sessions::simulated_um;
use crate::simulator::{BenchSimulator, Setting};
use measured_data::Accuracy;
use model_gap::discovery::{Confidence, Verdict};
use model_gap::{Class, Effect, Findings, SplitMix, places};
use preisach_dyn::ActuatorModel;
use rayon::prelude::*;
use serde::Serialize;
use sized::{sized, spread};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Noise of a planned reading, over the spread of the motion in all runs (40 dB).
const NOISE: f64 = 0.01;

/// Noise of a planned terminal voltage, V, and of a planned temperature, K.
const TERMINAL_NOISE_VOLT: f64 = 0.02;
const TEMPERATURE_NOISE_K: f64 = 0.02;

/// Sizes of a planned effect, its spread over that of the motion.
pub const SIZES: [f64; 2] = [0.03, 0.06];

/// What planned runs would show.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Plan {
    /// The runs, measured once with nothing missing and once with the cause.
    pub runs: Vec<String>,
    /// Noise of the reading, um.
    pub noise_um: f64,
    /// Noise of the terminal voltage where it is read, V.
    pub terminal_noise_volt: f64,
    /// Noise of the temperature where it is read, K.
    pub temperature_noise_k: f64,
    /// Every cause that may be named.
    pub causes: Vec<PlannedCause>,
}

/// What the runs would show of a cause.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PlannedCause {
    /// The cause.
    pub cause: &'static str,
    /// Its class.
    pub class: Class,
    /// Size from which it would be seen with 90 % probability, over the spread of the motion; none where it cannot.
    pub seen_from: Option<f64>,
    /// Why the runs cannot show it.
    pub blocked: Option<String>,
    /// What would be said of it, size by size, of either sign where it has two; empty where it cannot be made so large.
    pub rehearsed: Vec<Rehearsal>,
}

/// What a diagnosis says of a simulated cause.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rehearsal {
    /// Size, over the spread of the motion.
    pub size: f64,
    /// Value of the parameter that makes the size, in its unit.
    pub value: f64,
    /// The verdict.
    pub verdict: Verdict,
    /// How sure it is.
    pub confidence: Confidence,
    /// The causes it leaves open.
    pub causes: Vec<String>,
    /// The class of the leading one.
    pub class: Option<Class>,
    /// How sure the class is.
    pub class_confidence: Option<Confidence>,
    /// What it would ask for next.
    pub next_experiment: String,
}

/// What runs would show of every cause. Each is put into the simulation, the runs are simulated with noise and diagnosed
/// beside the same runs with nothing missing. The engine knows the form of the causes exactly here, so a bench will show
/// rather less.
///
/// `runs` say what is commanded, what is judged and which channels are read; what they hold as outputs is not read, and load
/// cells are left out: how stiff a load is the simulation does not know. `store` saves time. `told` hears how many causes of
/// how many are done.
///
/// # Errors
/// As [`diagnose`]; a cause of `only` that is not in the library.
pub fn plan(
    model: &ActuatorModel,
    planned: &Planned<'_>,
    store: Option<&dyn StructureStore>,
    told: &(dyn Fn(usize, usize) + Sync),
) -> Result<Plan, DiagnosisError> {
    let bench = Rehearsed::new(model, planned, store)?;
    let ids: Vec<&str> = bench.null.candidates[..LIBRARY.len()].iter().map(|own| own.id).collect();
    let mut named = places(&ids, planned.only)?;
    if named.is_empty() {
        named = (0..LIBRARY.len()).collect();
    }
    let done = AtomicUsize::new(0);
    let causes = named.par_iter().with_max_len(1).map(|&c| {
        let found = bench.cause(c);
        told(done.fetch_add(1, Ordering::Relaxed) + 1, named.len());
        found
    });
    Ok(Plan {
        runs: planned.runs.iter().map(|run| run.id.clone()).collect(),
        noise_um: bench.noise_um,
        terminal_noise_volt: TERMINAL_NOISE_VOLT,
        temperature_noise_k: TEMPERATURE_NOISE_K,
        causes: causes.collect::<Result<_, _>>()?,
    })
}

/// What is planned.
#[derive(Debug, Clone, Copy)]
pub struct Planned<'a> {
    /// The runs.
    pub runs: &'a [Record],
    /// How well the channels will keep their calibration.
    pub accuracy: Accuracy,
    /// The causes asked about; all if empty.
    pub only: &'a [String],
}

/// A simulated bench.
struct Rehearsed<'a> {
    /// The runs with nothing missing and without noise.
    plain: Vec<Record>,
    reference: Vec<Record>,
    bench: Bench,
    noise_um: f64,
    /// The diagnosis of runs with nothing missing.
    null: Diagnosis,
    store: Option<&'a dyn StructureStore>,
}

impl<'a> Rehearsed<'a> {
    fn new(
        model: &ActuatorModel,
        planned: &Planned<'_>,
        store: Option<&'a dyn StructureStore>,
    ) -> Result<Self, DiagnosisError> {
        let one = |run: &Record| -> Result<Record, DiagnosisError> {
            let output = simulated_um(model, run)?;
            Ok(Record {
                // what is planned without outputs is judged from beginning to end
                window: if run.window.is_empty() { 0..output.len() } else { run.window.clone() },
                amplifier: run.amplifier.as_ref().map(|_| run.input.clone()),
                temperature: run.temperature.as_ref().map(|_| vec![0.0; output.len()]),
                load: None,
                is_reference: false,
                output,
                ..run.clone()
            })
        };
        let plain: Vec<Record> = planned.runs.iter().map(one).collect::<Result<_, _>>()?;
        let noise_um = NOISE * spread(&plain);
        let bench = Bench {
            range_volt: (model.range_volt.lowest_volt(), model.range_volt.highest_volt()),
            deg_per_um: model.calibration.deg_per_um,
            accuracy: planned.accuracy,
        };
        let reference = noisy(&plain, noise_um, 1);
        let measured = bench.records(noisy(&plain, noise_um, 2));
        let question =
            Question { reference: reference.clone(), cache: store, ..Question::default() };
        let null = diagnose(&measured, &question)?;
        Ok(Self { plain, reference, bench, noise_um, null, store })
    }

    /// What the runs show of a cause.
    fn cause(&self, c: usize) -> Result<PlannedCause, DiagnosisError> {
        let candidate = &self.null.candidates[c];
        let runs: Vec<&Record> = self.plain.iter().collect();
        let setting = Setting {
            base: &self.null.base,
            references: self.reference.iter().collect(),
            causes: &self.null.library,
            range: self.bench.range_volt,
            accuracy: self.bench.accuracy,
        };
        let simulator = BenchSimulator::new(setting, runs)?;
        let mut rehearsed = Vec::new();
        if candidate.blocked.is_none() {
            for size in SIZES {
                for (value, effect) in sized(&simulator, (c, candidate), size)? {
                    rehearsed.push(self.rehearse(&simulator, &effect, [size, value])?);
                }
            }
        }
        Ok(PlannedCause {
            cause: candidate.id,
            class: candidate.class,
            seen_from: self.null.finding.limits[c],
            blocked: candidate.blocked.clone(),
            rehearsed,
        })
    }

    /// The diagnosis of the runs with an effect.
    fn rehearse(
        &self,
        simulator: &BenchSimulator<'_>,
        effect: &Effect,
        [size, value]: [f64; 2],
    ) -> Result<Rehearsal, DiagnosisError> {
        let with = simulator.rehearsed(std::slice::from_ref(effect))?;
        let without = simulator.rehearsed(&[])?;
        let mut runs = self.plain.clone();
        for ((run, with), without) in runs.iter_mut().zip(with).zip(without) {
            // the simulation's own form, with what the cause changes of the base model's
            let change = less(&with.output, &without.output);
            run.output.iter_mut().zip(change).for_each(|(y, change)| *y += change);
            (run.amplifier, run.temperature) = (with.amplifier, with.temperature);
        }
        let measured = self.bench.records(noisy(&runs, self.noise_um, 3));
        let reference = self.reference.clone();
        let question = Question { reference, cache: self.store, ..Question::default() };
        let found = Findings::from(&diagnose(&measured, &question)?);
        Ok(Rehearsal {
            size,
            value,
            verdict: found.verdict,
            confidence: found.confidence,
            causes: found.causes,
            class: found.class,
            class_confidence: found.class_confidence,
            next_experiment: found.next_experiment,
        })
    }
}

/// Runs read once, with another draw of the noise.
fn noisy(runs: &[Record], noise_um: f64, draw: u64) -> Vec<Record> {
    let mut noise = SplitMix(draw);
    let mut read = |signal: &mut [f64], size: f64| {
        for value in signal {
            *value += size * noise.normal();
        }
    };
    let mut runs = runs.to_vec();
    for run in &mut runs {
        read(&mut run.output, noise_um);
        let noise = [TERMINAL_NOISE_VOLT, TEMPERATURE_NOISE_K];
        for (signal, size) in [&mut run.amplifier, &mut run.temperature].into_iter().zip(noise) {
            read(signal.as_deref_mut().unwrap_or_default(), size);
        }
    }
    runs
}

/// What the simulated runs have in common.
struct Bench {
    range_volt: (f64, f64),
    deg_per_um: f64,
    accuracy: Accuracy,
}

impl Bench {
    fn records(&self, runs: Vec<Record>) -> Records {
        Records {
            title: "planned runs".into(),
            folder: "planned runs".into(),
            runs,
            range: self.range_volt,
            input_unit: "V".into(),
            output_unit: "um".into(),
            input_label: "command_V".into(),
            output_label: "displacement_um".into(),
            deg_per_um: Some(self.deg_per_um),
            accuracy: self.accuracy,
            is_bench: true,
            content_hash: String::new(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::{ActuatorLaw, Calibration, LinearGain, VoltageRange};

    fn straight() -> ActuatorModel {
        let law = ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: 0.1, bias_volt: 0.0 });
        let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
        ActuatorModel::new(law, VoltageRange::new(-20.0, 150.0).unwrap(), calibration)
    }

    fn asked(model: &ActuatorModel, runs: &[Record], only: &[String]) -> Plan {
        let planned = Planned { runs, accuracy: Accuracy::default(), only };
        plan(model, &planned, None, &|_, _| ()).unwrap()
    }

    /// Without the terminal voltage a lag may be on either side of it.
    #[test]
    fn a_plan_says_which_channel_parts_what() {
        let mut runs = usual_runs((-20.0, 150.0));
        runs.retain(|run| matches!(&*run.id, "triangles" | "multisine_small" | "wide_band"));
        let only = ["electrical-lag".to_owned()];
        let lag = |runs: &[Record]| asked(&straight(), runs, &only).causes[0].rehearsed[0].clone();
        let bare = lag(&runs);
        assert!(bare.causes.len() > 1 && bare.confidence == Confidence::Tentative, "{bare:?}");
        assert_eq!(bare.next_experiment, "amplifier-monitor");
        let monitored: Vec<Record> = runs
            .into_iter()
            .map(|run| Record { amplifier: Some(run.input.clone()), ..run })
            .collect();
        let told = lag(&monitored);
        let class = (told.class, told.class_confidence);
        assert_eq!(told.causes, only);
        assert_eq!(class, (Some(Class::LagBeforeTerminals), Some(Confidence::Confident)));
    }

    /// A gain may be too high or too low: both are rehearsed, and both are about as large as asked.
    #[test]
    fn a_plan_rehearses_both_signs() {
        let runs = usual_runs((-20.0, 150.0));
        let runs: Vec<Record> = runs.into_iter().filter(|run| run.id == "triangles").collect();
        let told = asked(&straight(), &runs, &["sensor-gain".to_owned()]);
        let values: Vec<f64> = told.causes[0].rehearsed.iter().map(|said| said.value).collect();
        let expected = [0.03, -0.03, 0.06, -0.06];
        assert_eq!(values.len(), expected.len(), "{values:?}");
        for (value, expected) in values.iter().zip(expected) {
            assert!((value / expected - 1.0).abs() < 0.03, "{values:?}");
        }
        let creep = asked(&straight(), &runs, &["backlash".to_owned()]);
        assert_eq!(creep.causes[0].rehearsed.len(), 2, "a gap has one sign: {creep:?}");
    }

    #[test]
    fn a_plan_of_one_frequency_shows_no_lag() {
        let only = ["electrical-lag".to_owned()];
        let wave = |i: u32| 65.0 + 60.0 * (0.0628 * f64::from(i)).sin();
        let runs = [Record::new("sine", 1e-3, (0..2000).map(wave).collect(), Vec::new())];
        let lag = &asked(&straight(), &runs, &only).causes[0];
        assert!(lag.seen_from.is_none() && lag.blocked.is_some() && lag.rehearsed.is_empty());
        for id in ["lag", "reading-range"] {
            let only = [id.to_owned()];
            let planned = Planned { runs: &runs, accuracy: Accuracy::default(), only: &only };
            assert!(plan(&straight(), &planned, None, &|_, _| ()).is_err(), "{id}");
        }
    }

    /// Where the sensor has its zero says nothing about noise and size.
    #[test]
    fn a_plan_does_not_depend_on_the_zero() {
        let wave = |i: u32| 65.0 + 60.0 * (0.0628 * f64::from(i)).sin();
        let runs = [Record::new("sine", 1e-3, (0..2000).map(wave).collect(), Vec::new())];
        let mut model = straight();
        let noise_um = |model: &ActuatorModel| asked(model, &runs, &["creep".to_owned()]).noise_um;
        let (here, by_hand) = (noise_um(&model), 0.01 * 2.5 * 60.0 / 2.0_f64.sqrt());
        assert!((here / by_hand - 1.0).abs() < 0.01, "{here} um, {by_hand} by hand");
        model.calibration.zero_um = 500.0;
        assert!((noise_um(&model) / here - 1.0).abs() < 1e-9);
    }
}

//! A diagnosis: what the base model of a bench gets wrong, why, and what it is worth to know.

use crate::base::{BaseModel, white_noise};
use crate::causes::{self, BenchCause, Design};
use crate::error::DiagnosisError;
use crate::next::{self, Proposal};
use crate::question::{Question, Stage, StructureStore};
use crate::record::{Record, Records, as_measured, slower};
use crate::sessions::{
    GivenModel, Sessions, beginning, continued, doubt, range_of, scale_of, simulated_runs,
};
use crate::simulator::{BenchSimulator, CALIBRATIONS, RunShown, Setting, inputs_of};
use crate::surrogate;
use measured_data::Accuracy;
use model_gap::discovery::{
    Discovery, Finding, Fingerprint, Rival, Settings, Signal, Trace, Verdict, fingerprints,
};
use model_gap::{Candidate, EnergySplit, GapError, places};
use preisach_dyn::ActuatorModel;
use rotor_base::variance;

/// A diagnosis with everything it rests on.
pub struct Diagnosis {
    /// What was found.
    pub finding: Finding,
    /// The candidates, in the order of the library.
    pub candidates: Vec<Candidate>,
    pub(crate) library: Vec<BenchCause>,
    pub(crate) base: BaseModel,
    /// Inputs that the base model was fitted to.
    pub(crate) law_inputs: Vec<Vec<f64>>,
    /// Names of the measured runs.
    pub run_ids: Vec<String>,
    /// Names of those with samples interpolated between the measured ones, which are left out.
    pub interpolated: Vec<String>,
    /// The outputs of the measured runs, of each what is simulated of it.
    pub shown: Vec<RunShown>,
    /// The causes found, then their nearest rivals, as they act on the traces.
    pub fingerprints: Vec<Fingerprint>,
    /// Energy of every measured run.
    pub energy: Vec<RunEnergy>,
    /// Title of the data.
    pub title: String,
    /// Folder of the data.
    pub folder: String,
    /// The data without their runs, the range widened to every input.
    pub(crate) data: Records,
    /// Whether reference runs fix the base model.
    pub has_reference: bool,
    /// The simulation given beside the data; none if none was.
    pub given: Option<GivenModel>,
    /// Motion of the measured outputs over that of the base model, by least squares: far from 1 where the
    /// unit of a column is not what its name says.
    pub scale: f64,
    /// Unit of the output.
    pub output_unit: String,
    /// What to measure next.
    pub next: Proposal,
    /// Error of the base model on reference runs left out of its fit, over the spread of the output.
    pub floor: f64,
    /// Noise of the reading on the reference runs, in the output's unit.
    pub noise: f64,
}

/// Where the energy of a measured run goes under the base model, fractions that sum to 1; of a run at rest, fractions
/// of the energy of the reference runs.
#[derive(Debug, Clone, PartialEq)]
pub struct RunEnergy {
    /// The run.
    pub id: String,
    /// Explained.
    pub explained: f64,
    /// Noise.
    pub noise: f64,
    /// Left over and not noise.
    pub structured: f64,
}

/// Motion over that expected, beyond which a unit is more likely wrong than a gain.
const LIKELY_SCALE: [f64; 2] = [0.4, 2.5];

impl Diagnosis {
    /// Reference runs that the base model was fitted to; the measured ones where there are none.
    pub fn fitted_runs(&self) -> usize {
        self.law_inputs.len()
    }

    /// How well the channels are taken to keep their calibration from one session to the next.
    pub fn accuracy(&self) -> Accuracy {
        self.data.accuracy
    }

    /// Unit of the input.
    pub fn input_unit(&self) -> &str {
        &self.data.input_unit
    }

    /// Whether the measured outputs move so much more or less than expected that a unit is more likely wrong than a gain.
    pub fn unit_looks_wrong(&self) -> bool {
        !(LIKELY_SCALE[0]..=LIKELY_SCALE[1]).contains(&self.scale)
    }

    /// Each thing that was found missing, as every cause that the data do not exclude, the best first; empty where nothing
    /// has a name.
    pub fn open(&self) -> Vec<Vec<&'static str>> {
        if self.finding.verdict == Verdict::Unknown {
            return Vec::new();
        }
        let id = |rival: &Rival| self.candidates[rival.candidate].id;
        self.finding.causes.iter().map(|found| found.rivals.iter().map(id).collect()).collect()
    }
}

/// Diagnoses measured runs against the base model of the reference runs. A simulation that is given beside reference runs
/// alone is asked about these.
///
/// # Errors
/// [`DiagnosisError::NothingMeasured`]; [`DiagnosisError::Misfit`] where the numerics fail, or where a cause of
/// [`Question::only`] is not in the library.
pub fn diagnose(measured: &Records, question: &Question<'_>) -> Result<Diagnosis, DiagnosisError> {
    let too_few = |what: &str| GapError::TooShort { what: what.to_owned(), samples: 0, needed: 1 };
    let library = [causes::LIBRARY.as_slice(), &causes::DECOYS].concat();
    let read = |runs: &[Record]| continued(&as_measured(runs));
    let (mut own, mut beside) = (read(&measured.runs), read(&question.reference));
    let is_finer = |(given, read): &(&Record, &Record)| given.step_s < read.step_s;
    let pairs = measured.runs.iter().zip(&own).filter(is_finer);
    let interpolated = pairs.map(|(run, _)| run.id.clone()).collect();
    if question.given.is_some() && beside.is_empty() && own.iter().all(|run| run.is_reference) {
        for run in &mut own {
            run.is_reference = false;
        }
    }
    // where the sensor has its zero says nothing
    let is_ordinary = |run: &&Record| run.is_reference;
    let zero = match (beside.is_empty(), own.iter().any(|run| run.is_reference)) {
        (false, _) => beginning(beside.iter()),
        (true, true) => beginning(own.iter().filter(is_ordinary)),
        (true, false) => beginning(own.iter()),
    };
    own.iter_mut().chain(&mut beside).for_each(|run| run.lower(zero));
    let runs: Vec<&Record> = own.iter().filter(|r| !r.is_reference).collect();
    if runs.is_empty() {
        return Err(DiagnosisError::NothingMeasured { runs: measured.runs.len() });
    }
    let mut references: Vec<&Record> = beside.iter().collect();
    references.extend(own.iter().filter(|r| r.is_reference));
    let has_reference = !references.is_empty();
    let given_model =
        question.given.map(|model| GivenModel::beside(model, &references, &runs)).transpose()?;
    let ours = question.given.zip(given_model).filter(|(_, own)| !own.is_foreign());
    let simulated = match ours {
        Some((model, _)) if !has_reference => simulated_from_zero(model, &runs)?,
        _ => Vec::new(),
    };
    references.extend(&simulated);
    let fitted = if references.is_empty() { &runs } else { &references };
    let range = range_of(measured.range, fitted, &runs);
    let begin = |stage| question.begun.iter().for_each(|begun| begun(stage));
    begin(Stage::BaseModel);
    let base =
        BaseModel::fit(fitted, range, None).ok_or_else(|| too_few("runs of the base model"))?;
    let design = Design::of(&runs, &references, &measured.accuracy, measured.is_bench);
    let mut candidates = causes::candidates(&library, &design);
    let given = restrict(&mut candidates[..causes::LIBRARY.len()], &question.only)?;
    let setting = Setting {
        base: &base,
        references: references.clone(),
        causes: &library,
        range,
        accuracy: measured.accuracy,
    };
    let simulator = BenchSimulator::new(setting.clone(), runs.clone())?;
    begin(Stage::Surrogates);
    let structures: Vec<Signal> = kept_structures(&base, fitted, &runs, range, question.cache)
        .iter()
        .map(|s| simulator.structure(|run| &s[run]))
        .collect();
    let trends =
        simulator.directions(|_, plain, step_s| surrogate::trends(plain, base.spread, step_s));
    let floors = Floors { trends, structures, groups: inputs_of(&runs, range) };
    begin(Stage::Search);
    let settings = Settings { has_reference, ..Settings::default() };
    let traces = simulator.traces();
    let of = (&simulator, &traces[..]);
    let mut finding = search(of, &candidates, &floors, settings, given.as_deref())?;
    let fingerprints = fingerprints(&simulator, &traces, &candidates, &finding)?;
    let shown = RunShown::of(&simulator, &traces, &finding, &fingerprints);
    let fingerprints = fingerprints.causes;
    let sessions = Sessions {
        runs: &runs,
        references: &references,
        base: &base,
        given: given_model,
        takes_for_true: given.is_some(),
    };
    doubt(&mut finding, &sessions);
    begin(Stage::NextExperiment);
    let bench = next::Bench { setting, candidates: &candidates, runs: &runs, design: &design };
    let next = next::proposal(&bench, &finding)?;
    Ok(Diagnosis {
        finding,
        law_inputs: fitted.iter().map(|r| r.input.clone()).collect(),
        run_ids: runs.iter().map(|r| r.id.clone()).collect(),
        interpolated,
        shown,
        fingerprints,
        energy: runs.iter().map(|run| RunEnergy::of(run, &base)).collect(),
        title: measured.title.clone(),
        folder: measured.folder.clone(),
        data: Records { runs: Vec::new(), range, ..measured.clone() },
        has_reference,
        given: given_model,
        scale: scale_of(&runs, &base),
        output_unit: measured.output_unit.clone(),
        next,
        floor: base.floor,
        noise: base.noise,
        candidates,
        library,
        base: base.raised(zero),
    })
}

/// The runs as a model simulates them, its zero taken off.
fn simulated_from_zero(
    model: &ActuatorModel,
    runs: &[&Record],
) -> Result<Vec<Record>, DiagnosisError> {
    let mut simulated = simulated_runs(model, runs)?;
    let zero = beginning(simulated.iter());
    for run in &mut simulated {
        run.lower(zero);
    }
    Ok(simulated)
}

/// What the runs leave with nothing missing, and which of them repeat one input.
#[derive(Debug, Default)]
pub(crate) struct Floors {
    trends: Vec<Signal>,
    structures: Vec<Signal>,
    groups: Vec<usize>,
}

/// What a search finds in the runs of a simulator with their traces; the candidates given are fitted together and not refused.
pub(crate) fn search(
    (simulator, traces): (&BenchSimulator<'_>, &[Trace]),
    candidates: &[Candidate],
    Floors { trends, structures, groups }: &Floors,
    settings: Settings,
    given: Option<&[usize]>,
) -> Result<Finding, GapError> {
    let spread = simulator.base.spread;
    let slower = slower(&simulator.runs);
    let generic = simulator.directions(|input, plain, step_s| {
        surrogate::generic(input, plain, (spread, slower), step_s)
    });
    let generic = generic.as_slice();
    let discovery = Discovery {
        traces,
        simulator,
        candidates,
        generic,
        trends,
        structures,
        groups,
        calibrations: CALIBRATIONS,
        settings,
    };
    match given {
        Some(given) => discovery.refit(given),
        None => discovery.find(),
    }
}

/// Blocks every candidate that is not asked for; the places of those that are.
fn restrict(candidates: &mut [Candidate], only: &[String]) -> Result<Option<Vec<usize>>, GapError> {
    if only.is_empty() {
        return Ok(None);
    }
    let ids: Vec<&str> = candidates.iter().map(|own| own.id).collect();
    let places = places(&ids, only)?;
    for (c, candidate) in candidates.iter_mut().enumerate() {
        if !places.contains(&c) {
            candidate.blocked = Some("not asked for".into());
        }
    }
    Ok(Some(places))
}

/// The structures of the surrogates, from the store where they are there.
fn kept_structures(
    base: &BaseModel,
    fitted: &[&Record],
    runs: &[&Record],
    range: (f64, f64),
    store: Option<&dyn StructureStore>,
) -> Vec<Signal> {
    let found = || surrogate::structures(base, fitted, runs, range);
    let Some(store) = store else { return found() };
    let lengths: Vec<usize> = runs.iter().map(|r| r.input.len()).collect();
    let range = [range.0, range.1];
    let mut parts: Vec<&[f64]> = vec![&range];
    for run in fitted {
        parts.extend([std::slice::from_ref(&run.step_s), &run.input, run.judged_output()]);
    }
    for run in runs {
        parts.extend([std::slice::from_ref(&run.step_s), run.input.as_slice()]);
    }
    store.get(&parts, &lengths).unwrap_or_else(|| {
        let found = found();
        store.keep(&parts, &found);
        found
    })
}

impl RunEnergy {
    fn of(run: &Record, base: &BaseModel) -> Self {
        let residual = base.residual(run);
        // a run at rest has no motion of its own
        let spread = variance(run.judged_output());
        let total = if run.is_at_rest() { base.spread.powi(2) } else { spread }.max(1e-300);
        let EnergySplit { explained, noise, structured } =
            EnergySplit::of_residual(&residual, total, white_noise(&residual).powi(2));
        Self { id: run.id.clone(), explained, noise, structured }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use measured_data::{DisplacementAccuracy, VoltageAccuracy};
    use model_gap::Class;
    use model_gap::Findings;
    use model_gap::discovery::{Confidence, Reason};
    use preisach_dyn::{ActuatorLaw, Calibration, LinearGain, VoltageRange};

    /// A line of gain 2.5 on a slow triangle and a sine, times a factor.
    fn runs(is_reference: bool, factor: f64) -> Vec<Record> {
        let wave = |i: u32| (0.011 * f64::from(i)).sin() * (0.0017 * f64::from(i)).cos();
        [0.9, 0.5]
            .map(|amplitude| {
                let input: Vec<f64> =
                    (0..3000).map(|i| 65.0 + 85.0 * amplitude * wave(i)).collect();
                let jitter = |i: usize| 0.05 * ((i * 7919 % 101) as f64 / 50.0 - 1.0);
                let output =
                    (0..).zip(&input).map(|(i, u)| factor * (2.5 * u + jitter(i))).collect();
                Record { is_reference, ..Record::new(amplitude.to_string(), 2e-3, input, output) }
            })
            .into()
    }

    fn records(runs: Vec<Record>) -> Records {
        Records {
            title: "line".into(),
            folder: "line".into(),
            runs,
            range: (-20.0, 150.0),
            input_unit: "V".into(),
            output_unit: "um".into(),
            input_label: "command_V".into(),
            output_label: "displacement_um".into(),
            deg_per_um: None,
            accuracy: Accuracy {
                displacement: DisplacementAccuracy { gain_percent: 0.1, zero_um: 1.0 },
                amplifier: VoltageAccuracy { gain_percent: 0.1, zero_volt: 0.1 },
                ..Accuracy::default()
            },
            is_bench: true,
            content_hash: String::new(),
        }
    }

    #[test]
    fn an_output_in_another_unit_is_noticed() {
        for (factor, warned) in [(1.0, false), (1e-3, true)] {
            let question = Question { reference: runs(true, 1.0), ..Question::default() };
            let found = diagnose(&records(runs(false, factor)), &question).unwrap();
            assert!((found.scale / factor - 1.0).abs() < 0.01, "{}", found.scale);
            assert_eq!(found.unit_looks_wrong(), warned, "{}", found.scale);
        }
    }

    /// Nothing tells the gain of a sensor from that of an amplifier, and a characteristic can bend its way to either.
    #[test]
    fn a_gain_alone_is_one_honest_set() {
        for (factor, members) in [
            (1.04, ["sensor-gain", "amplifier-gain"].as_slice()),
            (0.96, &["load-stiffness", "sensor-gain", "amplifier-gain"]),
        ] {
            // a curved law: a fit would tell the gain before it from that behind it
            let bent = |is_reference, factor: f64| {
                let mut runs = runs(is_reference, 1.0);
                for run in &mut runs {
                    for (y, u) in run.output.iter_mut().zip(&run.input) {
                        *y = factor * (*y + 0.01 * (u - 65.0).powi(2));
                    }
                }
                runs
            };
            let question = Question { reference: bent(true, 1.0), ..Question::default() };
            let found = diagnose(&records(bent(false, factor)), &question).unwrap();
            let findings = Findings::from(&found);
            assert_eq!(findings.verdict, Verdict::Ambiguous, "{:?}", found.finding.reasons);
            for id in members {
                assert!(findings.causes.iter().any(|own| own == id), "{:?}", findings.causes);
            }
            assert_eq!(findings.class, Some(Class::StaticGain));
            assert_eq!(findings.class_confidence, Some(Confidence::Confident));
        }
    }

    /// What is found of measured runs that were changed.
    fn found(change: impl Fn(&mut Record)) -> Diagnosis {
        let question = Question { reference: runs(true, 1.0), ..Question::default() };
        let mut measured = runs(false, 1.0);
        measured.iter_mut().for_each(change);
        diagnose(&records(measured), &question).unwrap()
    }

    #[test]
    fn where_the_reference_runs_have_not_been_nothing_is_sure() {
        for (part, confidence) in [(1.0, Confidence::Confident), (0.6, Confidence::Tentative)] {
            let mut reference = runs(true, 1.0);
            for run in &mut reference {
                run.input.iter_mut().for_each(|u| *u = 65.0 + part * (*u - 65.0));
                run.output.iter_mut().for_each(|y| *y = 162.5 + part * (*y - 162.5));
            }
            let question = Question { reference, ..Question::default() };
            let found = diagnose(&records(runs(false, 1.0)), &question).unwrap();
            assert_eq!(found.finding.verdict, Verdict::NothingMissing);
            assert_eq!(found.finding.confidence, confidence, "{:?}", found.finding.reasons);
            let is_said = |r: &Reason| matches!(r, Reason::BeyondReference { .. });
            assert_eq!(found.finding.reasons.iter().any(is_said), part < 1.0);
        }
    }

    /// On a straight line nothing tells an offset of the amplifier from one of the sensor.
    #[test]
    fn an_offset_alone_is_no_sure_zero_of_the_sensor() {
        let found = found(|run| run.output.iter_mut().for_each(|y| *y += 12.0));
        let findings = Findings::from(&found);
        assert_ne!(findings.verdict, Verdict::NothingMissing, "{:?}", found.finding.reasons);
        assert_eq!(findings.confidence, Confidence::Tentative, "{:?}", findings.causes);
        for id in ["sensor-zero", "amplifier-gain"] {
            assert!(findings.causes.iter().any(|own| own == id), "{:?}", findings.causes);
        }
    }

    /// A straight simulation of some gain.
    fn simulation(gain_um_per_volt: f64) -> ActuatorModel {
        let law = LinearGain { gain_deg_per_volt: gain_um_per_volt, bias_volt: 0.0 };
        let range = VoltageRange::new(-20.0, 150.0).unwrap();
        let calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
        ActuatorModel::new(ActuatorLaw::Linear(law), range, calibration)
    }

    /// With or without reference runs, whatever the runs have in common.
    #[test]
    fn of_a_simulation_of_another_bench_nothing_is_said() {
        for (gain, is_ours) in [(2.5, true), (10.0, false), (0.2, false)] {
            for reference in [runs(true, 1.0), Vec::new()] {
                let given = simulation(gain);
                let question = Question { reference, given: Some(&given), ..Question::default() };
                let found = diagnose(&records(runs(false, 1.0)), &question).unwrap();
                let findings = Findings::from(&found);
                let own = findings.given_model.unwrap();
                assert_eq!(own.is_of_this_bench, is_ours, "{own:?}");
                assert!((found.given.unwrap().scale - 2.5 / gain).abs() < 0.01);
                let is_said = matches!(found.finding.reasons[..], [Reason::OtherBench { .. }, ..]);
                assert_eq!(is_said, !is_ours, "{:?}", found.finding.reasons);
                let expected = if is_ours { Verdict::NothingMissing } else { Verdict::Unknown };
                assert_eq!(findings.verdict, expected, "{gain}: {:?}", found.finding.reasons);
            }
        }
    }

    /// Where nothing but the simulation says what is ordinary, what it lacks is what the runs have beyond it.
    #[test]
    fn without_reference_runs_the_simulation_is_what_the_runs_are_compared_with() {
        let bent = |mut runs: Vec<Record>| {
            for run in &mut runs {
                run.output.iter_mut().for_each(|y| *y += 1e-6 * (*y - 162.5).powi(3));
            }
            runs
        };
        let given = simulation(2.5);
        let names = |given, are_reference| {
            let question = Question { given, ..Question::default() };
            let found = diagnose(&records(bent(runs(are_reference, 1.0))), &question).unwrap();
            assert_eq!(found.finding.confidence, Confidence::Tentative);
            Findings::from(&found).causes
        };
        for are_reference in [false, true] {
            let names = names(Some(&given), are_reference);
            assert!(names.iter().any(|id| id == "sensor-nonlinearity"), "{names:?}");
        }
        assert!(
            names(None, false).is_empty(),
            "what all runs share is ordinary without anything beside them"
        );
    }

    /// What the reference runs did on the same input is known, whatever the base model makes of it: here a bend by the
    /// rate, which no play has.
    #[test]
    fn the_error_of_the_base_model_cancels_where_the_input_is_that_of_a_reference_run() {
        let bent = |mut runs: Vec<Record>| {
            for run in &mut runs {
                for i in 1..run.output.len() {
                    let rate = (run.input[i] - run.input[i - 1]) / run.step_s;
                    run.output[i] += 1e-4 * rate * rate;
                }
            }
            runs
        };
        let left = |measured: Vec<Record>| {
            let question = Question { reference: bent(runs(true, 1.0)), ..Question::default() };
            let found = diagnose(&records(measured), &question).unwrap();
            let own = &found.finding.residual_before[0];
            (own.iter().map(|x| x * x).sum::<f64>() / own.len() as f64).sqrt()
        };
        let same = left(bent(runs(false, 1.0)));
        let mut other = bent(runs(false, 1.0));
        for run in &mut other {
            // the same but for one sample: nothing to compare with
            run.input[1500] += 1.0;
        }
        let other = left(other);
        assert!(same < 0.2 * other, "{same} um, {other} um without the comparison");
    }

    fn looks_like(found: &Diagnosis) -> Option<&'static str> {
        found.finding.looks_like.map(|candidate| found.candidates[candidate].id)
    }

    #[test]
    fn flat_tops_of_the_reading_are_no_voltage_limit_where_the_terminals_follow() {
        let cut = |run: &mut Record| run.output.iter_mut().for_each(|y| *y = y.min(240.0));
        let watched = found(|run| {
            cut(run);
            run.amplifier = Some(run.input.clone());
        });
        assert_eq!(watched.finding.verdict, Verdict::Unknown, "{:?}", watched.finding.reasons);
        assert_eq!(looks_like(&watched), Some("reading-range"));
        // a line behind a limit of the voltage is cut about alike
        let alone = found(cut);
        assert_eq!(alone.finding.confidence, Confidence::Tentative, "{:?}", alone.finding.reasons);
        assert!(alone.finding.reasons.iter().any(|r| r.to_string().contains("reading-range")));
    }

    /// A sensor that reads low shows more load per displacement on a spring that was always there.
    #[test]
    fn a_sensor_that_reads_low_beside_an_old_spring_is_no_new_load() {
        let sprung = |mut runs: Vec<Record>, factor: f64| {
            for run in &mut runs {
                run.load = Some(run.output.iter().map(|y| 0.02 * y).collect());
                run.output.iter_mut().for_each(|y| *y *= factor);
            }
            runs
        };
        let question = Question { reference: sprung(runs(true, 1.0), 1.0), ..Question::default() };
        let found = diagnose(&records(sprung(runs(false, 1.0), 0.94)), &question).unwrap();
        let findings = Findings::from(&found);
        assert_eq!(findings.verdict, Verdict::Ambiguous, "{:?}", found.finding.reasons);
        assert!(findings.causes.iter().any(|id| id == "sensor-gain"), "{:?}", findings.causes);
    }

    #[test]
    fn an_amplifier_of_another_gain_is_seen_at_the_terminals() {
        let found = found(|run| {
            let terminals: Vec<f64> = run.input.iter().map(|u| 1.04 * u - 2.6).collect();
            run.output.iter_mut().zip(&run.input).for_each(|(y, u)| *y += 2.5 * (0.04 * u - 2.6));
            run.amplifier = Some(terminals);
        });
        let findings = Findings::from(&found);
        assert_eq!(findings.verdict, Verdict::Named, "{:?}", found.finding.reasons);
        assert_eq!(findings.causes, ["amplifier-gain"]);
        let rise = &findings.parameters["amplifier-gain"]["gain_error"];
        assert!((rise.value - 0.04).abs() < 0.004, "{rise:?}");
    }

    #[test]
    fn a_noisier_reading_is_no_confident_nothing() {
        // without a period: a line would be one of the mains
        let jitter = |i: usize| {
            let hash = (i as u64 + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
            ((hash ^ (hash >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 40) as f64
                / f64::from(1 << 23)
                - 1.0
        };
        for (size, confidence) in [(0.0, Confidence::Confident), (0.2, Confidence::Tentative)] {
            let found = found(|run| {
                run.output.iter_mut().enumerate().for_each(|(i, y)| *y += size * jitter(i));
            });
            let finding = &found.finding;
            assert_eq!(
                (finding.verdict, finding.confidence),
                (Verdict::NothingMissing, confidence)
            );
            let is_said = finding.reasons.iter().any(|r| matches!(r, Reason::Noisier { .. }));
            assert_eq!(is_said, confidence == Confidence::Tentative, "{:?}", finding.reasons);
        }
    }

    #[test]
    fn samples_outside_the_window_are_neither_fitted_nor_judged() {
        let started = |run: &mut Record| {
            run.output[..800]
                .iter_mut()
                .enumerate()
                .for_each(|(i, y)| *y += 40.0 - 0.05 * i as f64);
        };
        let whole = found(started);
        assert_ne!(whole.finding.verdict, Verdict::NothingMissing, "{:?}", whole.finding.reasons);
        let windowed = found(|run| {
            started(run);
            run.window = 800..run.output.len();
        });
        let finding = &windowed.finding;
        assert_eq!(
            (finding.verdict, finding.confidence),
            (Verdict::NothingMissing, Confidence::Confident),
            "{:?}",
            finding.reasons
        );
        assert!(finding.residual_before[0].len() <= 2200 && windowed.energy[0].explained > 0.999);
        // a reference run is fitted inside its window alone
        let mut reference = runs(true, 1.0);
        for run in &mut reference {
            started(run);
            run.window = 800..run.output.len();
        }
        let question = Question { reference, ..Question::default() };
        let found = diagnose(&records(runs(false, 1.0)), &question).unwrap();
        assert_eq!(found.finding.verdict, Verdict::NothingMissing, "{:?}", found.finding.reasons);
    }

    #[test]
    fn a_reading_that_returns_to_zero_is_not_nothing() {
        let found = found(|run| {
            let (first, mut sum) = (run.output[0], 0.0);
            for y in &mut run.output {
                sum += run.step_s * (*y - first) / 40.0;
                *y -= sum;
            }
        });
        assert_eq!(found.finding.verdict, Verdict::Unknown, "{:?}", found.finding.reasons);
        assert!(found.finding.is_slow, "{:?}", found.finding.reasons);
        assert_eq!(found.next.id, "hold-steps-100s");
    }

    #[test]
    fn data_without_measured_runs_are_refused_in_words() {
        let message = match diagnose(&records(runs(true, 1.0)), &Question::default()) {
            Ok(_) => String::new(),
            Err(error) => error.to_string(),
        };
        assert!(message.contains("role: Measured") && message.contains("all 2"), "{message}");
    }
}

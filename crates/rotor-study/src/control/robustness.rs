//! How the controllers stand noise, a wrong T and an actuator that drifts.

use crate::case::{Case, ControlActuator, ControllerChoice, EffortChoice};
use crate::control::drives::Drives;
use crate::control::set::{ControlSet, close_loop, stop_name};
use crate::error::StudyError;
use crate::flaps::PlantError;
use crate::loads::{HubLoads, Setting, loads_cost};
use crate::plant::{Answered, Answers, HUB_OUTPUTS, RotorPlant, hub_outputs};
use crate::rotor::TrimmedRotor;
use crate::series::scaled;
use hhc_control::{
    AdaptiveSettings, ControlError, ControlRun, Controller, EstimatorSettings, Measurement, Plant,
    RunError, TMatrix, identify_t,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What is disturbed in one run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Disturbance {
    /// Standard deviation of the noise of a load, percent of the root mean square baseline load.
    pub noise_percent: f64,
    /// T0 handed to the controller over the identified one.
    pub t_gain: f64,
    /// Phase error of that T0, deg of harmonic phase; the T that a local controller asks for is as wrong.
    pub t_phase_deg: f64,
    /// Loss of actuator gain with every measurement, percent.
    pub drift_percent: f64,
}

/// One cell of the map.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RobustnessCell {
    /// Harmonic under control, per rev.
    pub harmonic: usize,
    /// `global`, `local` or `adaptive`.
    pub controller: String,
    /// How the control was weighted: `limits`, `meet-stroke` or `given`.
    #[serde(default)]
    pub effort: String,
    /// What was disturbed.
    pub disturbance: Disturbance,
    /// How the loop ended: `converged`, `stalled`, `out-of-range`, `step-limit`; `diverged`: no first step
    /// lowers the cost; `failed`: the stroke was not met or a cone program not solved.
    #[serde(alias = "outcome")]
    pub status: String,
    /// Control steps.
    pub steps: usize,
    /// Backtracks.
    #[serde(alias = "halvings")]
    pub backtracks: u32,
    /// Measurements.
    pub measurements: usize,
    /// Hub loads at the end, without noise.
    pub end: HubLoads,
    /// The best of the way, without noise.
    pub best: HubLoads,
}

/// A cell with its reductions.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct RobustnessLine {
    /// What was found.
    #[serde(flatten)]
    pub cell: RobustnessCell,
    /// Fall of `J_Z` at the end, percent: of the loads without noise, with the actuator as it is by then.
    pub reduction_percent: f64,
    /// The best any recorded control reached on the way.
    pub best_percent: f64,
}

impl RobustnessCell {
    /// The cell with its reductions computed from its loads.
    pub fn figures(&self, setting: &Setting) -> RobustnessLine {
        let weights = setting.load_weights();
        let before = loads_cost(&weights, &setting.baseline);
        let fall = |loads: &HubLoads| {
            setting.reduction_percent(before, loads_cost(&weights, &loads.parts()))
        };
        RobustnessLine {
            reduction_percent: fall(&self.end),
            best_percent: fall(&self.best),
            cell: self.clone(),
        }
    }
}

const NOISE_PERCENT: [f64; 4] = [0.0, 1.0, 3.0, 10.0];
const T_GAINS: [f64; 3] = [0.8, 1.0, 1.2];
const T_PHASES_DEG: [f64; 3] = [-30.0, 0.0, 30.0];
const DRIFT_PERCENT: [f64; 2] = [0.5, 2.0];
/// First seed of the noise.
const SEED: u64 = 20_260_101;

/// The rotor of the study with its real actuators, disturbed.
///
/// Differs from a plant at rest on purpose: noise and drift make its answers depend on the calls made
/// before.
struct Disturbed {
    /// Standard deviation of a load.
    noise: f64,
    /// Loss of actuator gain per answer, as a part.
    drift: f64,
    t_gain: f64,
    t_phase_rad: f64,
    random: ChaCha8Rng,
    /// Controls that were measured, one per answer, and their loads without noise.
    truth: Vec<(Vec<f64>, [f64; 12])>,
}

impl Disturbed {
    fn new(disturbance: Disturbance, rms: f64, seed: u64) -> Self {
        Self {
            noise: 0.01 * disturbance.noise_percent * rms,
            drift: 0.01 * disturbance.drift_percent,
            t_gain: disturbance.t_gain,
            t_phase_rad: disturbance.t_phase_deg.to_radians(),
            random: ChaCha8Rng::seed_from_u64(seed),
            truth: Vec::new(),
        }
    }

    /// Loads without noise and flap motions, the gain of the actuators as it is now.
    fn answer(&self, plant: &RotorPlant, control_volt: &[f64]) -> Result<Measurement, PlantError> {
        let left = (1.0 - self.drift).powf(self.truth.len() as f64);
        let mut state = plant.state(control_volt)?;
        if self.drift > 0.0 && !self.truth.is_empty() {
            for flap in &mut state.flaps {
                flap.flap_deg = scaled(&flap.flap_deg, left);
            }
            state = plant.state_of(state.flaps)?;
        }
        Ok(plant.seen(control_volt, &state))
    }

    /// The loads that a control had when it was measured last, without noise.
    fn measured(&self, control_volt: &[f64]) -> Option<[f64; 12]> {
        let mut latest = self.truth.iter().rev();
        latest.find(|(u, _)| u == control_volt).map(|(_, loads)| *loads)
    }
}

impl Answers for Disturbed {
    fn measure(
        &mut self,
        plant: &RotorPlant,
        control_volt: &[f64],
    ) -> Result<Measurement, PlantError> {
        let mut measurement = self.answer(plant, control_volt)?;
        self.truth.push((control_volt.to_vec(), hub_outputs(&measurement.outputs)));
        // the power is worked out, not measured
        add_noise(&mut measurement.outputs[..HUB_OUTPUTS], self.noise, &mut self.random);
        Ok(measurement)
    }

    fn offered_t(
        &self,
        plant: &mut RotorPlant,
        control_volt: &[f64],
    ) -> Result<Option<TMatrix>, PlantError> {
        let offered = plant.linearised_t(control_volt)?;
        let wrong = |t: TMatrix| wrong_t(&t, self.t_gain, self.t_phase_rad);
        offered.map(wrong).transpose().map_err(PlantError::Bias)
    }
}

/// T with the loads of the hub multiplied by a gain and turned by a phase; the weight of the power is known.
fn wrong_t(t: &TMatrix, gain: f64, phase_rad: f64) -> Result<TMatrix, ControlError> {
    if gain.to_bits() == 1.0_f64.to_bits() && phase_rad == 0.0 {
        return Ok(t.clone());
    }
    let mut columns = t.turned(gain, phase_rad)?.columns();
    for (wrong, right) in columns.iter_mut().zip(t.columns()) {
        for (wrong, right) in wrong.iter_mut().zip(right).skip(HUB_OUTPUTS) {
            *wrong = right;
        }
    }
    TMatrix::from_columns(&columns)
}

/// Adds normal noise of a standard deviation to every load.
fn add_noise(loads: &mut [f64], deviation: f64, random: &mut ChaCha8Rng) {
    for load in loads {
        let draw: f64 = StandardNormal.sample(random);
        *load += deviation * draw;
    }
}

fn disturbances() -> Vec<Disturbance> {
    let none =
        Disturbance { noise_percent: 0.0, t_gain: 1.0, t_phase_deg: 0.0, drift_percent: 0.0 };
    let noise = NOISE_PERCENT.map(|noise_percent| Disturbance { noise_percent, ..none });
    let wrong = T_GAINS.into_iter().flat_map(|t_gain| {
        T_PHASES_DEG.map(|t_phase_deg| Disturbance { t_gain, t_phase_deg, ..none })
    });
    let drift = DRIFT_PERCENT.map(|drift_percent| Disturbance { drift_percent, ..none });
    let all =
        Disturbance { noise_percent: 3.0, t_gain: 0.8, t_phase_deg: 30.0, drift_percent: 0.5 };
    let wrong = wrong.filter(|d| *d != none);
    noise.into_iter().chain(wrong).chain(drift).chain([all]).collect()
}

/// What is run for one cell.
#[derive(Clone, Copy)]
struct Trial {
    disturbance: Disturbance,
    /// Of the noise.
    seed: u64,
    controller: ControllerChoice,
    /// How the control is weighted.
    effort: EffortChoice,
}

/// Every controller of a map under one disturbance, in their order. Each weights the control as the case does, but a
/// weight that is tuned to the stroke goes with a constant T; where T is learnt the limits take its place.
fn trials(effort: EffortChoice, disturbance: Disturbance) -> [Trial; 3] {
    let learnt = if effort == EffortChoice::MeetStroke { EffortChoice::Limits } else { effort };
    let of = |controller, effort| Trial { disturbance, seed: SEED, controller, effort };
    [
        of(ControllerChoice::Global, effort),
        of(ControllerChoice::Local, learnt),
        of(ControllerChoice::Adaptive, learnt),
    ]
}

fn effort_name(effort: EffortChoice) -> &'static str {
    match effort {
        EffortChoice::MeetStroke => "meet-stroke",
        EffortChoice::Limits => "limits",
        EffortChoice::Given { .. } => "given",
    }
}

/// Runs every controller of one harmonic under every disturbance: the loop of the study itself, with its plant,
/// limits, laws, renewals and settings.
///
/// Every run starts from zero control and a T0 identified without disturbance, wrong by what the disturbance says; so
/// is the T that the local controller asks the plant for. A filter is told the noise.
///
/// # Errors
/// [`StudyError`] of the plant; a run that diverges or whose stroke is not met is a cell of the map.
fn cells(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
    harmonic: usize,
    disturbances: Vec<Disturbance>,
) -> Result<Vec<RobustnessCell>, StudyError> {
    if drives.hysteretic.is_none() {
        return Ok(Vec::new());
    }
    let harmonics = [harmonic];
    let set = ControlSet::new(case, rotor, drives, &harmonics)?;
    let plant = set.plant(ControlActuator::Hysteretic)?;
    let step_volt = set.step_volts(&plant);
    let failed = |source| set.failed(ControlActuator::Hysteretic, source);
    let baseline = rotor.trim().rotor.hub.harmonic(case.rotor.blades);
    let flight = Flight {
        set: &set,
        t0: identify_t(&mut plant.clone(), &step_volt).map_err(failed)?,
        t_at_rest: set.t_at_rest(&plant).map_err(failed)?,
        step_volt,
        rms: (baseline.iter().map(|z| z * z).sum::<f64>() / baseline.len() as f64).sqrt(),
        weights: set.load_weights(),
        plant,
        baseline,
    };
    let each: Vec<Trial> = disturbances
        .into_iter()
        .flat_map(|disturbance| trials(case.control.effort, disturbance))
        .zip(SEED..)
        .map(|(trial, seed)| Trial { seed, ..trial })
        .collect();
    each.into_par_iter().map(|trial| flight.cell(trial).map_err(failed)).collect()
}

/// What the cells of a map share.
struct Flight<'a> {
    set: &'a ControlSet<'a>,
    plant: RotorPlant,
    /// By differences, and of the linearised rotor.
    t0: TMatrix,
    t_at_rest: TMatrix,
    step_volt: Vec<f64>,
    baseline: [f64; HUB_OUTPUTS],
    rms: f64,
    weights: [f64; 6],
}

impl Flight<'_> {
    fn cell(&self, trial: Trial) -> Result<RobustnessCell, RunError<PlantError>> {
        let Trial { disturbance, seed, controller: choice, effort } = trial;
        let answers = Disturbed::new(disturbance, self.rms, seed);
        let way = match self.set.t_policy(choice, self.step_volt.clone()) {
            Controller::Adaptive(settings) => {
                let share = (answers.noise > 0.0).then(|| answers.noise / self.rms);
                let noise_share = share.or(settings.estimator.noise_share);
                let estimator = EstimatorSettings { noise_share, ..settings.estimator };
                Controller::Adaptive(AdaptiveSettings { estimator, ..settings })
            }
            way => way,
        };
        let t0 = match choice {
            ControllerChoice::Local => &self.t_at_rest,
            ControllerChoice::Global | ControllerChoice::Adaptive => &self.t0,
        };
        let wrong = wrong_t(t0, answers.t_gain, answers.t_phase_rad)?;
        let controller = self.set.controller(&wrong, way, effort)?;
        let mut plant = Answered { plant: self.plant.clone(), answers };
        let (run, status) = match close_loop(&controller, &mut plant, effort) {
            Ok((run, _)) => {
                let status = stop_name(run.stop);
                (Some(run), status)
            }
            Err(RunError::Control(
                ControlError::Diverges { .. } | ControlError::NotAdmitted { .. },
            )) => (None, "diverged"),
            Err(RunError::Control(
                ControlError::StrokeNotMet { .. } | ControlError::ConeProgram { .. },
            )) => (None, "failed"),
            Err(error) => return Err(error),
        };
        let disturbed = &plant.answers;
        let (end, best) = match &run {
            Some(run) => (Self::end(run, &plant)?, self.best(run, disturbed)),
            // a run that diverges stays where it is
            None => (self.baseline, self.baseline),
        };
        Ok(RobustnessCell {
            harmonic: self.set.harmonics.first().copied().unwrap_or_default(),
            controller: choice_name(choice).to_owned(),
            effort: effort_name(effort).to_owned(),
            disturbance,
            status: status.to_owned(),
            steps: run.as_ref().map_or(0, |run| run.steps.len()),
            backtracks: run.as_ref().map_or(0, |run| run.backtracks),
            measurements: disturbed.truth.len(),
            end: HubLoads::from_parts(end),
            best: HubLoads::from_parts(best),
        })
    }

    /// The loads at the end, without noise and with the actuator as it is by then.
    fn end(
        run: &ControlRun,
        Answered { plant, answers }: &Answered<Disturbed>,
    ) -> Result<[f64; HUB_OUTPUTS], RunError<PlantError>> {
        let control = &run.last().control_volt;
        if let Some(loads) = answers.measured(control).filter(|_| answers.drift == 0.0) {
            return Ok(loads);
        }
        let answer = answers.answer(plant, control).map_err(|source| RunError::Plant {
            call: "measured",
            at_volt: control.clone(),
            history: run.history().cloned().collect(),
            source,
        })?;
        Ok(hub_outputs(&answer.outputs))
    }

    /// The least loads of the record, each as it was when it was measured.
    fn best(&self, run: &ControlRun, disturbed: &Disturbed) -> [f64; HUB_OUTPUTS] {
        let weights = &self.weights;
        let all = run.history().filter_map(|step| disturbed.measured(&step.control_volt));
        all.fold(self.baseline, |best, loads| {
            if loads_cost(weights, &loads) < loads_cost(weights, &best) { loads } else { best }
        })
    }
}

fn choice_name(choice: ControllerChoice) -> &'static str {
    match choice {
        ControllerChoice::Global => "global",
        ControllerChoice::Local => "local",
        ControllerChoice::Adaptive => "adaptive",
    }
}

/// The maps of every harmonic that a case controls alone on the hysteretic actuator.
///
/// # Errors
/// [`StudyError::Robustness`] of the plant.
pub fn robustness_maps(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
) -> Result<Vec<RobustnessCell>, StudyError> {
    if rotor.wake_diverged() || !case.control.actuators.contains(&ControlActuator::Hysteretic) {
        return Ok(Vec::new());
    }
    let mut maps = Vec::new();
    for &harmonic in case.control.harmonics.iter().filter(|set| set.len() == 1).flatten() {
        let map = cells(case, rotor, drives, harmonic, disturbances())
            .map_err(|source| StudyError::Robustness { harmonic, source: Box::new(source) })?;
        maps.extend(map);
    }
    Ok(maps)
}

#[cfg(test)]
#[path = "robustness_tests.rs"]
mod tests;

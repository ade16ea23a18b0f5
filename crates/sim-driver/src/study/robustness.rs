//! How the controllers stand noise, a wrong T and an actuator that drifts.

use super::lines::outcome_name;
use super::{Drives, PlantError, RotorPlant, StudyError, TrimmedRotor};
use crate::SimError;
use crate::case::{Case, ControlActuator, LoadedCase};
use crate::raw::{Setting, loads_cost};
use crate::results::HubLoads;
use crate::run::RunOutcome;
use hhc_control::{
    AdaptiveSettings, ControlError, ControlLayout, ControlLimits, Controller, FeedbackController,
    FeedbackSettings, LoadWeights, Measurement, Plant, RunError, TMatrix, identify_t,
    reduction_percent,
};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

/// What is disturbed in one run.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Disturbance {
    /// Standard deviation of the noise of a load, percent of the root mean square baseline load.
    pub noise_percent: f64,
    /// T0 handed to the controller over the identified one.
    pub t_gain: f64,
    /// Phase error of that T0, deg of harmonic phase.
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
    /// What was disturbed.
    pub disturbance: Disturbance,
    /// Fall of `J_Z` at the end, percent: of the loads without noise, with the actuator as it is by then.
    pub reduction_percent: f64,
    /// The best any recorded control reached on the way.
    pub best_percent: f64,
    /// How the loop ended: `converged`, `stalled`, `out-of-range`, `step-limit`; `diverged`: no first step
    /// lowers the cost.
    pub outcome: String,
    /// Control steps.
    pub steps: usize,
    /// Halvings.
    pub halvings: u32,
    /// Measurements.
    pub measurements: usize,
    /// Hub loads at the end, without noise.
    pub end: HubLoads,
    /// The best of the way, without noise.
    pub best: HubLoads,
}

impl RobustnessCell {
    /// The cell with its reductions computed from its loads.
    #[must_use]
    pub fn refigured(&self, setting: &Setting) -> Self {
        let weights = setting.load_weights();
        let before = loads_cost(&weights, &setting.baseline);
        let fall =
            |loads: &HubLoads| reduction_percent(before, loads_cost(&weights, &loads.parts()));
        Self { reduction_percent: fall(&self.end), best_percent: fall(&self.best), ..self.clone() }
    }
}

const NOISE_PERCENT: [f64; 4] = [0.0, 1.0, 3.0, 10.0];
const T_GAINS: [f64; 3] = [0.8, 1.0, 1.2];
const T_PHASES_DEG: [f64; 3] = [-30.0, 0.0, 30.0];
const DRIFT_PERCENT: [f64; 2] = [0.5, 2.0];
/// Steps of a run: noise keeps it from ending by itself.
const STEPS: usize = 15;
/// First seed of the noise.
const SEED: u64 = 20_260_101;

/// The linearised rotor with the real actuators, disturbed.
///
/// Differs from a plant at rest on purpose: noise and drift make its answers depend on the calls made
/// before.
struct Disturbed {
    plant: RotorPlant,
    baseline: [f64; 12],
    noise: f64,
    drift: f64,
    answers: u32,
    random: ChaCha8Rng,
}

impl Disturbed {
    /// Flap harmonics of the control, the gain of the actuators as it is now.
    fn flaps(&self, control_volt: &[f64]) -> Result<Vec<HarmonicSeries>, PlantError> {
        let left = (1.0 - self.drift).powf(f64::from(self.answers));
        let motions = self.plant.flap_motion(control_volt)?;
        Ok(motions.into_iter().map(|motion| scaled(&motion.flap_deg, left)).collect())
    }

    /// The loads without noise.
    fn loads(&self, flaps: &[HarmonicSeries]) -> Result<[f64; 12], PlantError> {
        let authority = self.plant.rotor().authority()?;
        let mut loads = self.baseline;
        for (flap, motion) in flaps.iter().enumerate() {
            for (load, change) in loads.iter_mut().zip(authority.loads(flap, motion)) {
                *load += change;
            }
        }
        Ok(loads)
    }
}

fn scaled(series: &HarmonicSeries, factor: f64) -> HarmonicSeries {
    let harmonics = series
        .harmonics
        .iter()
        .map(|h| Harmonic { cosine: factor * h.cosine, sine: factor * h.sine })
        .collect();
    HarmonicSeries { mean: factor * series.mean, harmonics }
}

impl Plant for Disturbed {
    type Error = PlantError;

    fn layout(&self) -> &ControlLayout {
        self.plant.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, PlantError> {
        let flaps = self.flaps(control_volt)?;
        let mut loads = self.loads(&flaps)?;
        self.answers += 1;
        add_noise(&mut loads, self.noise, &mut self.random);
        let pairs = (0..self.layout().pairs()).filter_map(|p| self.layout().flap_and_harmonic(p));
        Ok(Measurement {
            hub_loads: loads.to_vec(),
            flap_motion_deg: pairs.map(|(f, n)| flaps[f].harmonic(n as usize)).collect(),
            mean_flap_deg: flaps.iter().map(|f| f.mean).collect(),
        })
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, PlantError> {
        self.plant.strokes_deg(control_volt)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.plant.stroke_limits_deg()
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        self.plant.admits(control_volt)
    }

    fn limits(&mut self, control_volt: &[f64]) -> Result<ControlLimits, PlantError> {
        self.plant.limits(control_volt)
    }
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

/// The plant's own error of a control run.
fn plant_error(error: RunError<PlantError>) -> PlantError {
    match error {
        RunError::Plant { source, .. } => source,
        RunError::Control(error) => PlantError::Bias(error),
        _ => PlantError::BiasSearch,
    }
}

/// Runs every controller of one harmonic under every disturbance, within the limits of the actuators.
///
/// The rotor is linearised about its trim, the actuators are the identified ones. Every run starts from
/// zero control and a T0 identified without disturbance; the local controller measures its own T and
/// suffers the noise there too.
///
/// # Errors
/// [`PlantError`] of the actuators or of the linearised rotor; a run that diverges is a cell of the map.
pub fn robustness(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
    harmonic: usize,
) -> Result<Vec<RobustnessCell>, PlantError> {
    let (Some(drive), Some(limit)) = (&drives.hysteretic, drives.limit(harmonic)) else {
        return Ok(Vec::new());
    };
    let plant = RotorPlant::new(rotor.clone(), drive.clone(), &[harmonic], &[limit])
        .map_err(plant_error)?;
    let baseline = rotor.trim().rotor.hub.harmonic(case.blades);
    let rms = (baseline.iter().map(|z| z * z).sum::<f64>() / 12.0).sqrt();
    let undisturbed = |seed: u64| Disturbed {
        plant: plant.clone(),
        baseline,
        noise: 0.0,
        drift: 0.0,
        answers: 0,
        random: ChaCha8Rng::seed_from_u64(seed),
    };
    let control = &case.control;
    let step = control.t_step_deg * control.amplitude_volt / case.actuator.ideal_amplitude_deg;
    let step_volt = vec![step; plant.layout().len()];
    let t0 = match identify_t(&mut undisturbed(0), &step_volt) {
        Ok(t0) => t0,
        Err(error) => return Err(plant_error(error)),
    };
    let setting = Setting::of_case(case, &HubLoads::from_parts(baseline));
    let weights = setting.load_weights();
    let each: Vec<(Disturbance, Controller)> = disturbances()
        .into_iter()
        .flat_map(|disturbance| {
            let noise = 0.01 * disturbance.noise_percent * rms;
            let full_scale = AdaptiveSettings::of_full_scale(control.amplitude_volt);
            let ways = [
                Controller::Global,
                // wider than at rest: the noise of a difference falls with its step
                Controller::Local { step_volt: vec![2.0 * step; plant.layout().len()] },
                Controller::Adaptive(AdaptiveSettings { noise, ..full_scale }),
            ];
            ways.map(|way| (disturbance, way))
        })
        .collect();
    each.into_par_iter()
        .enumerate()
        .map(|(index, (disturbance, way))| {
            let mut disturbed = Disturbed {
                noise: 0.01 * disturbance.noise_percent * rms,
                drift: 0.01 * disturbance.drift_percent,
                ..undisturbed(SEED + index as u64)
            };
            let controller = way.name();
            let settings = FeedbackSettings {
                max_steps: STEPS,
                step_tolerance: control.step_tolerance,
                ..FeedbackSettings::default()
            };
            let diagonal = weights.into_iter().flat_map(|w| [w, w]).collect();
            let wrong = wrong_t(&t0, disturbance)?;
            let made = FeedbackController::new(&wrong, &LoadWeights::Diagonal(diagonal), settings)
                .and_then(|c| c.with_controller(way))
                .map_err(PlantError::Bias)?;
            let ended = made.run_constrained(&mut disturbed, 0.0);
            let truth = |u: &[f64]| disturbed.loads(&disturbed.flaps(u)?);
            // a run that diverges stays where it is
            let at_rest = HubLoads::from_parts(baseline);
            let cell = RobustnessCell {
                harmonic,
                controller: controller.to_owned(),
                disturbance,
                outcome: "diverged".to_owned(),
                measurements: disturbed.answers as usize,
                end: at_rest,
                best: at_rest,
                ..RobustnessCell::default()
            };
            let cell = match ended {
                Ok(run) => {
                    let mut best = baseline;
                    for step in run.history() {
                        let loads = truth(&step.control_volt)?;
                        if loads_cost(&weights, &loads) < loads_cost(&weights, &best) {
                            best = loads;
                        }
                    }
                    RobustnessCell {
                        end: HubLoads::from_parts(truth(&run.last().control_volt)?),
                        best: HubLoads::from_parts(best),
                        outcome: outcome_name(Some(run.outcome)).to_owned(),
                        steps: run.steps.len(),
                        halvings: run.halvings,
                        measurements: run.measurements,
                        ..cell
                    }
                }
                Err(RunError::Plant { source, .. }) => return Err(source),
                Err(RunError::Control(
                    ControlError::Diverges { .. } | ControlError::NotAdmitted { .. },
                )) => cell,
                Err(RunError::Control(error)) => return Err(PlantError::Bias(error)),
                Err(_) => return Err(PlantError::BiasSearch),
            };
            Ok(cell.refigured(&setting))
        })
        .collect()
}

/// The maps of every harmonic that a run controlled alone on the hysteretic actuator.
///
/// # Errors
/// As [`robustness`], at the control section of the case.
pub fn robustness_maps(
    loaded: &LoadedCase,
    outcome: &RunOutcome,
) -> Result<Vec<RobustnessCell>, SimError> {
    let case = &loaded.case;
    let alone = outcome.studies.iter().filter(|study| {
        study.actuator == ControlActuator::Hysteretic && study.harmonics.len() == 1
    });
    let maps = alone
        .map(|study| {
            let harmonic = study.harmonics[0];
            robustness(case, &outcome.trimmed, &outcome.drives, harmonic).map_err(|source| {
                let source = StudyError::Robustness { harmonic, source };
                SimError::Study { place: loaded.index.place("control"), source }
            })
        })
        .collect::<Result<Vec<_>, SimError>>()?;
    Ok(maps.into_iter().flatten().collect())
}

/// T0 multiplied by a gain and turned by a phase, pair by pair.
fn wrong_t(t0: &TMatrix, disturbance: Disturbance) -> Result<TMatrix, PlantError> {
    let (sin, cos) = disturbance.t_phase_deg.to_radians().sin_cos();
    let gain = disturbance.t_gain;
    let columns: Vec<Vec<f64>> = t0
        .columns()
        .chunks_exact(2)
        .flat_map(|pair| {
            let mix = |a: f64, b: f64| -> Vec<f64> {
                pair[0].iter().zip(&pair[1]).map(|(c, s)| gain * (a * c + b * s)).collect()
            };
            [mix(cos, sin), mix(-sin, cos)]
        })
        .collect();
    TMatrix::from_columns(&columns).map_err(PlantError::Bias)
}

/// The cells as CSV text.
pub fn robustness_csv(cells: &[RobustnessCell]) -> String {
    let mut text = String::from(
        "per_rev,controller,noise_percent,t_gain,t_phase_deg,drift_percent,reduction_percent,best_percent,outcome,steps,halvings,measurements\n",
    );
    for c in cells {
        let d = c.disturbance;
        // writing to a string cannot fail
        let _ = writeln!(
            text,
            "{},{},{},{},{},{},{:.3},{:.3},{},{},{},{}",
            c.harmonic,
            c.controller,
            d.noise_percent,
            d.t_gain,
            d.t_phase_deg,
            d.drift_percent,
            c.reduction_percent,
            c.best_percent,
            c.outcome,
            c.steps,
            c.halvings,
            c.measurements
        );
    }
    text
}

#[cfg(test)]
#[path = "robustness_tests.rs"]
mod tests;

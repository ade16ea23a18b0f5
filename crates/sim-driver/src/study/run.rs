//! One case from trim to controlled vibration.

use super::{FlapDrive, PlantError, PlantState, RotorPlant, StudyError, TrimmedRotor};
use crate::case::{Case, ControlActuator, EffortChoice, StrokeChoice};
use hhc_control::{
    ControlRun, FeedbackController, FeedbackSettings, LoadWeights, Outcome, Plant, RunError,
    identify_t, reduction_percent,
};
use preisach_dyn::{ActuatorModel, VoltageRange};
use rayon::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What the controller did with one set of harmonics and one actuator.
#[derive(Debug, Clone)]
pub struct ControlStudy {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// The actuator.
    pub actuator: ControlActuator,
    /// Voltages at the end, layout of the plant, V.
    pub control_volt: Vec<f64>,
    /// The recorded run; none where voltages were taken over from another actuator.
    pub run: Option<ControlRun>,
    /// Frobenius norm of the T matrix, load per V; of the run whose voltages are used.
    pub t_norm: f64,
    /// Control weight `W_u = rho I` of that run, 1/V^2.
    pub rho: f64,
    /// Stroke limit of each controlled harmonic, deg.
    pub stroke_limit_deg: Vec<f64>,
    /// `J_Z` without control.
    pub j_before: f64,
    /// `J_Z` with control.
    pub j_after: f64,
    /// Rotor and flaps at the end.
    pub state: PlantState,
    /// Force (moment) the moving flaps leave unbalanced at the trimmed controls, over the weight.
    pub trim_imbalance: f64,
}

impl ControlStudy {
    /// `100 (1 - J_Z / J_Z0)`.
    pub fn reduction_percent(&self) -> f64 {
        reduction_percent(self.j_before, self.j_after)
    }

    /// Control steps measured.
    pub fn steps(&self) -> usize {
        self.run.as_ref().map_or(0, |run| run.steps.len())
    }

    /// Steps that were halved because they raised the cost.
    pub fn halvings(&self) -> u32 {
        self.run.as_ref().map_or(0, ControlRun::halvings)
    }

    /// How the loop ended; converged where voltages were taken over.
    pub fn outcome(&self) -> Option<Outcome> {
        self.run.as_ref().map(|run| run.outcome)
    }
}

/// Full-scale voltage of an actuator at one harmonic and the stroke it gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FullScale {
    /// Voltage amplitude, V.
    pub amplitude_volt: f64,
    /// Flap amplitude, deg.
    pub stroke_deg: f64,
}

/// The drives of a case and the stroke limits they set.
#[derive(Debug, Clone)]
pub struct Drives {
    /// Ideal linear actuator.
    pub ideal: FlapDrive,
    /// The identified actuator, if the case has one.
    pub hysteretic: Option<FlapDrive>,
    /// Stroke limits by harmonic per rev.
    limits: BTreeMap<usize, FullScale>,
}

impl Drives {
    /// Drives of a case, with the stroke limit at every harmonic it controls; `model` is the actuator
    /// identified or read for it.
    ///
    /// # Errors
    /// [`StudyError::Stroke`].
    pub fn new(case: &Case, model: Option<Arc<ActuatorModel>>) -> Result<Self, StudyError> {
        let control = &case.control;
        let gain = case.actuator.ideal_amplitude_deg / control.amplitude_volt;
        let bias_volt = control.bias_volt;
        let (low, high) = case.actuator.range_volt;
        let range_volt = VoltageRange::new(low, high).map_err(StudyError::Range)?;
        let mut drives = Self {
            ideal: FlapDrive::Ideal { gain_deg_per_volt: gain, bias_volt, range_volt },
            hysteretic: model.map(|model| FlapDrive::Model {
                model,
                range_volt,
                rev_hz: case.actuator.bench_rev_hz,
                bias_volt,
            }),
            limits: BTreeMap::new(),
        };
        let harmonics: BTreeSet<usize> = control.harmonics.iter().flatten().copied().collect();
        let harmonics: Vec<usize> = harmonics.into_iter().collect();
        let limits = harmonics
            .par_iter()
            .map(|&n| Ok((n, drives.full_scale(case, n)?)))
            .collect::<Result<Vec<_>, StudyError>>()?;
        drives.limits = limits.into_iter().collect();
        Ok(drives)
    }

    /// Stroke limit at one harmonic and the voltage of the hysteretic actuator that belongs to it.
    fn full_scale(&self, case: &Case, harmonic: usize) -> Result<FullScale, StudyError> {
        let control = &case.control;
        let drive = self.hysteretic.as_ref().unwrap_or(&self.ideal);
        let full = drive.full_scale(harmonic, control.amplitude_volt).map_err(|source| {
            let frequency_hz = case.bench_frequency_hz(harmonic);
            StudyError::Stroke { harmonic, frequency_hz, source }
        })?;
        Ok(match control.stroke_limit {
            StrokeChoice::FromActuator => full,
            StrokeChoice::Given { amplitude_deg } => FullScale {
                amplitude_volt: full.amplitude_volt * (amplitude_deg / full.stroke_deg).min(1.0),
                stroke_deg: amplitude_deg,
            },
        })
    }

    /// The same drives with every stroke limit multiplied by a factor.
    #[must_use]
    pub fn with_strokes_scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        for limit in scaled.limits.values_mut() {
            limit.amplitude_volt *= factor;
            limit.stroke_deg *= factor;
        }
        scaled
    }

    /// Stroke limit at a harmonic of the case; none at others.
    pub fn limit(&self, harmonic: usize) -> Option<FullScale> {
        self.limits.get(&harmonic).copied()
    }
}

/// Controls one set of harmonics with every actuator the case asks for, in the order of the case.
///
/// # Errors
/// [`StudyError`].
pub fn control_set(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
    harmonics: &[usize],
    done: &(dyn Fn() + Sync),
) -> Result<Vec<ControlStudy>, StudyError> {
    let limits = harmonics
        .iter()
        .map(|&n| drives.limit(n).map_or_else(|| drives.full_scale(case, n), Ok))
        .collect::<Result<Vec<FullScale>, _>>()?;
    let set = ControlSet { case, rotor, drives, harmonics, limits };
    // the ideal actuator's run serves two actuators and is made only for them
    let mut ideal: Option<ControlStudy> = None;
    let mut studies = Vec::with_capacity(case.control.actuators.len());
    for &actuator in &case.control.actuators {
        if actuator != ControlActuator::Hysteretic && ideal.is_none() {
            ideal = Some(set.feedback(ControlActuator::Ideal)?);
        }
        studies.push(match (actuator, &ideal) {
            (ControlActuator::Ideal, Some(ideal)) => ideal.clone(),
            (ControlActuator::Ignored, Some(ideal)) => set.taken_over(ideal)?,
            _ => set.feedback(actuator)?,
        });
        done();
    }
    Ok(studies)
}

/// Controls every set of harmonics of the case; sets in parallel, results in the order of the case.
///
/// # Errors
/// [`StudyError`] of the first set that fails.
pub fn control_all(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
    done: &(dyn Fn() + Sync),
) -> Result<Vec<ControlStudy>, StudyError> {
    let sets = case
        .control
        .harmonics
        .par_iter()
        .map(|harmonics| control_set(case, rotor, drives, harmonics, done))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(sets.into_iter().flatten().collect())
}

struct ControlSet<'a> {
    case: &'a Case,
    rotor: &'a TrimmedRotor,
    drives: &'a Drives,
    harmonics: &'a [usize],
    /// Full-scale voltage and stroke limit of every harmonic.
    limits: Vec<FullScale>,
}

impl ControlSet<'_> {
    fn failed(&self, actuator: ControlActuator, source: RunError<PlantError>) -> StudyError {
        StudyError::Control {
            harmonics: self.harmonics.to_vec(),
            actuator: actuator.name(),
            source: Box::new(source),
        }
    }

    fn plant(&self, actuator: ControlActuator) -> Result<RotorPlant, StudyError> {
        let (drive, full_scale) = match actuator {
            ControlActuator::Ideal => {
                let amplitude = self.case.control.amplitude_volt;
                let per_deg = amplitude / self.case.actuator.ideal_amplitude_deg;
                let scale = self
                    .limits
                    .iter()
                    .map(|l| FullScale { amplitude_volt: l.stroke_deg * per_deg, ..*l })
                    .collect();
                (&self.drives.ideal, scale)
            }
            ControlActuator::Ignored | ControlActuator::Hysteretic => {
                let drive = self.drives.hysteretic.as_ref();
                let name = actuator.name();
                (drive.ok_or(StudyError::NoActuator { actuator: name })?, self.limits.clone())
            }
        };
        RotorPlant::new(self.rotor.clone(), drive.clone(), self.harmonics, &full_scale)
            .map_err(|e| self.failed(actuator, e))
    }

    fn weights(&self) -> LoadWeights {
        let w = &self.case.control.load_weights;
        let each = [w.fx, w.fy, w.fz, w.mx, w.my, w.mz];
        LoadWeights::Diagonal(each.into_iter().flat_map(|w| [w, w]).collect())
    }

    /// `J_Z` of a hub load vector.
    fn loads_cost(&self, loads: &[f64; 12]) -> f64 {
        let w = &self.case.control.load_weights;
        let each = [w.fx, w.fy, w.fz, w.mx, w.my, w.mz];
        loads.chunks_exact(2).zip(each).map(|(z, w)| w * (z[0] * z[0] + z[1] * z[1])).sum()
    }

    fn study(
        &self,
        actuator: ControlActuator,
        plant: &RotorPlant,
        control_volt: Vec<f64>,
        (run, t_norm, rho): (Option<ControlRun>, f64, f64),
    ) -> Result<ControlStudy, StudyError> {
        let state = plant.state(&control_volt).map_err(|source| {
            let call = hhc_control::PlantCall::Measure { control_volt: control_volt.clone() };
            self.failed(actuator, RunError::Plant { call, history: Vec::new(), source })
        })?;
        let blades = self.case.blades;
        let before = self.rotor.trim().rotor.hub.harmonic(blades);
        let target = self.case.trim_target();
        let trim_imbalance = self.rotor.imbalance(&target, &state.rotor)?;
        Ok(ControlStudy {
            harmonics: self.harmonics.to_vec(),
            actuator,
            trim_imbalance,
            control_volt,
            run,
            t_norm,
            rho,
            stroke_limit_deg: self.limits.iter().map(|l| l.stroke_deg).collect(),
            j_before: self.loads_cost(&before),
            j_after: self.loads_cost(&state.rotor.hub.harmonic(blades)),
            state,
        })
    }

    /// Feedback to convergence on the plant itself, from zero control.
    fn feedback(&self, actuator: ControlActuator) -> Result<ControlStudy, StudyError> {
        let mut plant = self.plant(actuator)?;
        let failed = |e| self.failed(actuator, e);
        let control = &self.case.control;
        let step_volt =
            control.t_step_deg * control.amplitude_volt / self.case.actuator.ideal_amplitude_deg;
        let steps = vec![step_volt; plant.layout().len()];
        let t = identify_t(&mut plant, &steps).map_err(failed)?;
        let settings = FeedbackSettings {
            max_steps: control.max_steps,
            step_tolerance: control.step_tolerance,
            ..FeedbackSettings::default()
        };
        let controller =
            FeedbackController::new(&t, &self.weights(), settings).map_err(|e| failed(e.into()))?;
        let (run, rho) = match control.effort {
            EffortChoice::MeetStroke => {
                let limited = controller.run_within_stroke(&mut plant).map_err(failed)?;
                (limited.run, limited.rho)
            }
            EffortChoice::Given { rho } => (controller.run(&mut plant, rho).map_err(failed)?, rho),
        };
        let volts = run.last().control_volt.clone();
        self.study(actuator, &plant, volts, (Some(run), t.frobenius_norm(), rho))
    }

    /// The ideal actuator's voltages applied to the hysteretic one: what ignoring hysteresis costs.
    fn taken_over(&self, ideal: &ControlStudy) -> Result<ControlStudy, StudyError> {
        let actuator = ControlActuator::Ignored;
        let plant = self.plant(actuator)?;
        let from = (None, ideal.t_norm, ideal.rho);
        self.study(actuator, &plant, ideal.control_volt.clone(), from)
    }
}

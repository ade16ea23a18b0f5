//! One case from trim to controlled vibration.

use super::inverted::within_reach;
use super::{FlapDrive, PlantError, PlantState, RotorPlant, StudyError, TrimmedRotor};
use crate::case::{Case, ControlActuator, ControllerChoice, EffortChoice, StrokeChoice};
use crate::raw::{Setting, loads_cost};
use crate::results::HubLoads;
use hhc_control::{
    AdaptiveSettings, ControlRun, Controller, FeedbackController, FeedbackSettings, LoadWeights,
    Outcome, Plant, PlantCall, RunError, TMatrix, identify_t, reduction_percent,
};
use preisach_dyn::{ActuatorModel, VoltageRange};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
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
    /// The T matrix, load per V; of the run whose voltages are used.
    pub t: Option<TMatrix>,
    /// Control weight `W_u = rho I` of that run, 1/V^2.
    pub rho: f64,
    /// T about the control at the end, load per V; of a loop with a constant T and a control weight.
    pub t_at_end: Option<TMatrix>,
    /// Tolerance of the step of the loop, relative.
    pub step_tolerance: f64,
    /// Tolerance of the cost of the loop, over that at the start; 0 for the test of the step alone.
    pub cost_tolerance: f64,
    /// Motion asked of the inverse, flap by flap, deg; empty but for the inverse.
    pub wanted_deg: Vec<HarmonicSeries>,
    /// Its size over that of the ideal motion: below 1 where the range of voltages ends first.
    pub motion_share: Option<f64>,
    /// Part of the motion that the identified actuator makes within its range of voltages; of the ideal one.
    pub reach_share: Option<f64>,
    /// Part of the voltages that were taken over: below 1 where they leave no room for the bias.
    pub voltage_share: Option<f64>,
    /// Stroke limit of each controlled harmonic, deg.
    pub stroke_limit_deg: Vec<f64>,
    /// Flap motion at each harmonic for a cosine of the voltage of its stroke limit, `[cosine, sine]`, deg.
    pub at_stroke_deg: Vec<[f64; 2]>,
    /// Weight of each load in `J_Z`, order `FX FY FZ MX MY MZ`.
    pub load_weights: [f64; 6],
    /// `J_Z` without control.
    pub j_before: f64,
    /// `J_Z` with control.
    pub j_after: f64,
    /// What turns the voltage of each pair into the square root of its weighted power, per V.
    pub power_gains_per_volt: Vec<f64>,
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
        self.run.as_ref().map_or(0, |run| run.halvings)
    }

    /// Frobenius norm of the T matrix, load per V; 0 without one.
    pub fn t_norm(&self) -> f64 {
        self.t.as_ref().map_or(0.0, TMatrix::frobenius_norm)
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
    /// Largest amplitude that the range of voltages leaves to this harmonic alone, V.
    pub reach_volt: f64,
    /// Flap motion for a cosine of the voltage amplitude, `[cosine, sine]`, deg.
    pub motion_deg: [f64; 2],
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
        let failed = |source| {
            let frequency_hz = case.bench_frequency_hz(harmonic);
            StudyError::Stroke { harmonic, frequency_hz, source }
        };
        Ok(match control.stroke_limit {
            StrokeChoice::FromActuator => full,
            StrokeChoice::Given { amplitude_deg } if amplitude_deg >= full.stroke_deg => {
                FullScale { stroke_deg: amplitude_deg, ..full }
            }
            StrokeChoice::Given { amplitude_deg } => {
                let (amplitude_volt, motion_deg) =
                    drive.voltage_of_stroke(harmonic, amplitude_deg, full).map_err(failed)?;
                FullScale { amplitude_volt, stroke_deg: amplitude_deg, motion_deg, ..full }
            }
        })
    }

    /// The same drives with every stroke limit multiplied by a factor.
    #[must_use]
    pub fn with_strokes_scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        for limit in scaled.limits.values_mut() {
            limit.amplitude_volt *= factor;
            limit.stroke_deg *= factor;
            limit.reach_volt *= factor;
            limit.motion_deg = limit.motion_deg.map(|deg| factor * deg);
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
    let set = ControlSet::new(case, rotor, drives, harmonics)?;
    let asked = &case.control.actuators;
    // the ideal actuator's run serves three actuators and is made only for them
    let ideal = if asked.iter().any(|&actuator| actuator != ControlActuator::Hysteretic) {
        Some(set.feedback(ControlActuator::Ideal)?)
    } else {
        None
    };
    let inverse =
        |a: &ControlActuator| matches!(a, ControlActuator::Ideal | ControlActuator::Inverse);
    let made = match &ideal {
        Some(ideal) if drives.hysteretic.is_some() && asked.iter().any(inverse) => {
            Some(set.made_whole(ideal)?)
        }
        _ => None,
    };
    let mut studies = Vec::with_capacity(asked.len());
    for &actuator in asked {
        studies.push(match (actuator, &ideal) {
            (ControlActuator::Ideal, Some(ideal)) => {
                let reach_share = made.as_ref().and_then(|made| match made {
                    Ok(_) => Some(1.0),
                    Err(error) => within_reach(error).map(|share| share.min(LARGEST_SHARE_BEYOND)),
                });
                ControlStudy { reach_share, ..ideal.clone() }
            }
            (ControlActuator::Ignored, Some(ideal)) => set.taken_over(ideal)?,
            (ControlActuator::Inverse, Some(ideal)) => set.inverted(ideal, made.clone())?,
            _ => set.feedback(actuator)?,
        });
        done();
    }
    Ok(studies)
}

/// One set of harmonics with the ideal actuator alone.
///
/// # Errors
/// [`StudyError`].
pub(super) fn ideal_control(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
    harmonics: &[usize],
) -> Result<ControlStudy, StudyError> {
    ControlSet::new(case, rotor, drives, harmonics)?.feedback(ControlActuator::Ideal)
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
    let control = &case.control;
    if control.controller == ControllerChoice::Local && !control.harmonics.is_empty() {
        // made once before the sets run side by side; a failure is that of the set that needs it
        let _ = rotor.authority();
    }
    let sets = control
        .harmonics
        .par_iter()
        .map(|harmonics| control_set(case, rotor, drives, harmonics, done))
        .collect::<Result<Vec<_>, _>>()?;
    Ok(sets.into_iter().flatten().collect())
}

pub(super) struct ControlSet<'a> {
    pub(super) case: &'a Case,
    pub(super) rotor: &'a TrimmedRotor,
    pub(super) drives: &'a Drives,
    pub(super) harmonics: &'a [usize],
    /// Full-scale voltage and stroke limit of every harmonic.
    pub(super) limits: Vec<FullScale>,
}

impl<'a> ControlSet<'a> {
    pub(super) fn new(
        case: &'a Case,
        rotor: &'a TrimmedRotor,
        drives: &'a Drives,
        harmonics: &'a [usize],
    ) -> Result<Self, StudyError> {
        let limits = harmonics
            .iter()
            .map(|&n| drives.limit(n).map_or_else(|| drives.full_scale(case, n), Ok))
            .collect::<Result<Vec<FullScale>, _>>()?;
        Ok(Self { case, rotor, drives, harmonics, limits })
    }
}

impl ControlSet<'_> {
    pub(super) fn failed(
        &self,
        actuator: ControlActuator,
        source: RunError<PlantError>,
    ) -> StudyError {
        StudyError::Control {
            harmonics: self.harmonics.to_vec(),
            actuator: actuator.name(),
            source: Box::new(source),
        }
    }

    pub(super) fn plant(&self, actuator: ControlActuator) -> Result<RotorPlant, StudyError> {
        let (drive, full_scale) = match actuator {
            ControlActuator::Ideal => {
                let amplitude = self.case.control.amplitude_volt;
                let per_deg = amplitude / self.case.actuator.ideal_amplitude_deg;
                let scale = self
                    .limits
                    .iter()
                    .map(|l| {
                        let amplitude_volt = l.stroke_deg * per_deg;
                        FullScale { amplitude_volt, reach_volt: amplitude_volt, ..*l }
                    })
                    .collect();
                (&self.drives.ideal, scale)
            }
            ControlActuator::Ignored | ControlActuator::Hysteretic | ControlActuator::Inverse => {
                let drive = self.drives.hysteretic.as_ref();
                let name = actuator.name();
                (drive.ok_or(StudyError::NoActuator { actuator: name })?, self.limits.clone())
            }
        };
        let plant = RotorPlant::new(self.rotor.clone(), drive.clone(), self.harmonics, &full_scale)
            .map_err(|e| self.failed(actuator, e))?;
        let control = &self.case.control;
        plant.with_power(control.power_limit_watt, control.power_weight_per_watt).map_err(
            |source| {
                let call = PlantCall::Linearise { control_volt: Vec::new() };
                self.failed(actuator, RunError::Plant { call, history: Vec::new(), source })
            },
        )
    }

    /// Weight of each load: those of the case, over the squared baseline amplitude if it asks for that.
    pub(super) fn load_weights(&self) -> [f64; 6] {
        load_weights(self.case, &self.rotor.trim().rotor.hub.harmonic(self.case.blades))
    }

    /// The step of the T matrix, V.
    pub(super) fn step_volt(&self) -> f64 {
        let control = &self.case.control;
        control.t_step_deg * control.amplitude_volt / self.case.actuator.ideal_amplitude_deg
    }

    /// The same for every control of a plant.
    pub(super) fn step_volts(&self, plant: &RotorPlant) -> Vec<f64> {
        vec![self.step_volt(); plant.layout().len()]
    }

    /// T0 of the local controller: its T is that of the linearised rotor at every control, and so at none.
    pub(super) fn t_at_rest(&self, plant: &RotorPlant) -> Result<TMatrix, RunError<PlantError>> {
        plant.t_at_rest(self.step_volt()).map_err(|source| {
            let call = PlantCall::Linearise { control_volt: plant.layout().zero() };
            RunError::Plant { call, history: Vec::new(), source }
        })
    }

    /// How a controller of the case knows T.
    pub(super) fn way(&self, choice: ControllerChoice, step_volt: Vec<f64>) -> Controller {
        match choice {
            ControllerChoice::Global => Controller::Renewed { step_volt, renewals: RENEWALS },
            ControllerChoice::Local => Controller::Local { step_volt },
            ControllerChoice::Adaptive => Controller::Adaptive(AdaptiveSettings::of_full_scale(
                self.case.control.amplitude_volt,
            )),
        }
    }

    /// T0 of a plant and the controller of the case, `way` of knowing T and of weighting the control included.
    pub(super) fn controller(
        &self,
        t: &TMatrix,
        way: Controller,
        effort: EffortChoice,
    ) -> Result<FeedbackController, RunError<PlantError>> {
        let control = &self.case.control;
        let settings = FeedbackSettings {
            max_steps: control.max_steps,
            step_tolerance: control.step_tolerance,
            cost_tolerance: cost_tolerance(&way, effort),
            ..FeedbackSettings::default()
        };
        // the weight of the power is in its loads already
        let further = t.loads().saturating_sub(2 * self.load_weights().len());
        let weights = self.load_weights().into_iter().flat_map(|w| [w, w]);
        let weights = weights.chain(std::iter::repeat_n(1.0, further)).collect();
        Ok(FeedbackController::new(t, &LoadWeights::Diagonal(weights), settings)?
            .with_controller(way)?)
    }

    pub(super) fn study(
        &self,
        actuator: ControlActuator,
        plant: &RotorPlant,
        control_volt: Vec<f64>,
        state: PlantState,
    ) -> Result<ControlStudy, StudyError> {
        let blades = self.case.blades;
        let before = self.rotor.trim().rotor.hub.harmonic(blades);
        let target = self.case.trim_target();
        let trim_imbalance = self.rotor.imbalance(&target, &state.rotor)?;
        let load_weights = self.load_weights();
        let after = state.rotor.hub.harmonic(blades);
        Ok(ControlStudy {
            power_gains_per_volt: plant.power_gains(),
            harmonics: self.harmonics.to_vec(),
            actuator,
            trim_imbalance,
            control_volt,
            run: None,
            t: None,
            rho: 0.0,
            t_at_end: None,
            step_tolerance: self.case.control.step_tolerance,
            cost_tolerance: 0.0,
            wanted_deg: Vec::new(),
            motion_share: None,
            reach_share: None,
            voltage_share: None,
            stroke_limit_deg: self.limits.iter().map(|l| l.stroke_deg).collect(),
            at_stroke_deg: self.limits.iter().map(|l| l.motion_deg).collect(),
            load_weights,
            j_before: loads_cost(&load_weights, &before),
            j_after: loads_cost(&load_weights, &after),
            state,
        })
    }

    /// The state at a control vector.
    pub(super) fn state(
        &self,
        actuator: ControlActuator,
        plant: &RotorPlant,
        control_volt: &[f64],
    ) -> Result<PlantState, StudyError> {
        plant.state(control_volt).map_err(|source| {
            let call = hhc_control::PlantCall::Measure { control_volt: control_volt.to_vec() };
            self.failed(actuator, RunError::Plant { call, history: Vec::new(), source })
        })
    }

    /// Feedback to convergence on the plant itself, from zero control.
    fn feedback(&self, actuator: ControlActuator) -> Result<ControlStudy, StudyError> {
        let mut plant = self.plant(actuator)?;
        let failed = |e| self.failed(actuator, e);
        let control = &self.case.control;
        let step_volt = self.step_volts(&plant);
        let way = match (actuator, control.controller) {
            // the ideal actuator has nearly one T everywhere: at limits that bind even the rotor's own bend shows
            (ControlActuator::Ideal, ControllerChoice::Global | ControllerChoice::Adaptive) => {
                Controller::Global
            }
            (_, choice) => self.way(choice, step_volt.clone()),
        };
        let t = match way {
            Controller::Local { .. } => self.t_at_rest(&plant).map_err(failed)?,
            _ => identify_t(&mut plant, &step_volt).map_err(failed)?,
        };
        let holds_t = matches!(way, Controller::Renewed { .. });
        let cost_tolerance = cost_tolerance(&way, control.effort);
        let controller = self.controller(&t, way, control.effort).map_err(failed)?;
        let (run, rho) = close_loop(&controller, &mut plant, control.effort).map_err(failed)?;
        let volts = run.last().control_volt.clone();
        let state = self.state(actuator, &plant, &volts)?;
        // whether whole steps settle there is a question of a constant T and a given weight
        let t_at_end = if holds_t && control.effort != EffortChoice::Limits {
            plant.linearised_t(&volts).ok().flatten()
        } else {
            None
        };
        Ok(ControlStudy {
            t: Some(run.t.clone()),
            run: Some(run),
            rho,
            t_at_end,
            cost_tolerance,
            ..self.study(actuator, &plant, volts, state)?
        })
    }

    /// The ideal actuator's voltages applied to the hysteretic one: what ignoring hysteresis costs. Where
    /// their swing leaves no room for the bias that centres the flap, the largest part of them that does.
    fn taken_over(&self, ideal: &ControlStudy) -> Result<ControlStudy, StudyError> {
        let actuator = ControlActuator::Ignored;
        let plant = self.plant(actuator)?;
        let part =
            |share: f64| -> Vec<f64> { ideal.control_volt.iter().map(|u| share * u).collect() };
        let mut share = 1.0;
        if !plant.admits(&part(share)) {
            let (mut low, mut high) = (0.0, 1.0);
            while high - low > TAKEN_OVER_TOLERANCE {
                let middle = f64::midpoint(low, high);
                let end = if plant.admits(&part(middle)) { &mut low } else { &mut high };
                *end = middle;
            }
            share = low;
        }
        let volts = part(share);
        let state = self.state(actuator, &plant, &volts)?;
        Ok(ControlStudy {
            t: ideal.t.clone(),
            rho: ideal.rho,
            voltage_share: Some(share),
            ..self.study(actuator, &plant, volts, state)?
        })
    }
}

/// Runs the loop from zero control as the case weights the control; with the weight found, 1/V^2.
pub(super) fn close_loop<P: Plant>(
    controller: &FeedbackController,
    plant: &mut P,
    effort: EffortChoice,
) -> Result<(ControlRun, f64), RunError<P::Error>> {
    Ok(match effort {
        EffortChoice::MeetStroke => {
            let limited = controller.run_within_stroke(plant)?;
            (limited.run, limited.rho)
        }
        EffortChoice::Limits => {
            let rho = least_effort(controller);
            (controller.run_constrained(plant, rho)?, rho)
        }
        EffortChoice::Given { rho } => (controller.run(plant, rho)?, rho),
    })
}

/// Times that a constant T which leads nowhere is identified again.
const RENEWALS: u32 = 4;

/// Accuracy of the part of a voltage that is taken over.
const TAKEN_OVER_TOLERANCE: f64 = 1e-4;

/// Fall of J that may be left to a loop that has converged, as a part of the uncontrolled J.
const COST_TOLERANCE: f64 = 1e-5;

/// Tolerance of the cost of a loop: a constant T promises what it cannot keep, its end is that of the paper's loop;
/// that of the ideal actuator is right wherever the loop ends, limits or not.
pub(crate) fn cost_tolerance(way: &Controller, effort: EffortChoice) -> f64 {
    match (way, effort) {
        (Controller::Global, EffortChoice::Limits) => COST_TOLERANCE,
        (Controller::Global | Controller::Renewed { .. }, _) => 0.0,
        _ => COST_TOLERANCE,
    }
}

/// Share of a motion that is out of reach, should rounding call it whole.
const LARGEST_SHARE_BEYOND: f64 = 1.0 - 1e-9;
/// Weight of the control, over the largest singular value of T squared, that picks the least voltage
/// where the optimum is not unique.
pub(super) const LEAST_EFFORT: f64 = 1e-8;

/// Control weight of a cone program, 1/V^2: with more controls than loads the optimum is one of many, and the least
/// voltage is taken.
pub(super) fn least_effort(controller: &FeedbackController) -> f64 {
    let law = controller.law();
    let scale = law.singular_values().first().map_or(0.0, |s| s * s);
    if law.has_surplus_controls() { LEAST_EFFORT * scale } else { 0.0 }
}

/// Weight of each load of a case, for the hub loads without control.
pub(super) fn load_weights(case: &Case, baseline: &[f64; 12]) -> [f64; 6] {
    Setting::of_case(case, &HubLoads::from_parts(*baseline)).load_weights()
}

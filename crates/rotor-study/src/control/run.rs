//! One case from trim to controlled vibration.

use crate::control::drives::Drives;
use crate::control::set::{ControlSet, acceptance, close_loop};
use crate::control::study::ControlStudy;
use crate::error::StudyError;
use crate::plant::RotorPlant;
use crate::rotor::TrimmedRotor;
use hhc_control::{Controller, Plant, TMatrix, identify_t};
use rayon::prelude::*;
use rotor_case::{Case, ControlActuator, ControllerChoice, EffortChoice};

/// Accuracy of the part of a voltage that is taken over.
const TAKEN_OVER_TOLERANCE: f64 = 1e-4;

/// Share of a motion that is out of reach, should rounding call it whole.
const LARGEST_SHARE_BEYOND: f64 = 1.0 - 1e-9;

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
        // the inverse sets the bias: one that is held leaves it nothing to set
        Some(ideal)
            if drives.hysteretic.as_ref().is_some_and(|drive| !drive.holds_bias())
                && asked.iter().any(inverse) =>
        {
            Some(set.through_the_inverse(ideal)?)
        }
        _ => None,
    };
    let mut studies = Vec::with_capacity(asked.len());
    for &actuator in asked {
        studies.push(match (actuator, &ideal) {
            (ControlActuator::Ideal, Some(ideal)) => {
                let reach_share = made.as_ref().and_then(|made| match made {
                    Ok(_) => Some(1.0),
                    Err(error) => error.within_reach().map(|share| share.min(LARGEST_SHARE_BEYOND)),
                });
                ControlStudy { reach_share, ..ideal.clone() }
            }
            (ControlActuator::Ignored, Some(ideal)) => set.with_ideal_voltages(ideal)?,
            (ControlActuator::Inverse, Some(ideal)) => set.inverted(ideal, made.clone())?,
            _ => set.feedback(actuator)?,
        });
        done();
    }
    Ok(studies)
}

/// One set of harmonics with the ideal actuator alone, its T that of the linearised rotor, by differences where that one
/// has no answer (a rotor that stalls).
///
/// # Errors
/// [`StudyError`].
pub(crate) fn ideal_control(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
    harmonics: &[usize],
) -> Result<ControlStudy, StudyError> {
    let set = ControlSet::new(case, rotor, drives, harmonics)?;
    let actuator = ControlActuator::Ideal;
    let mut plant = set.plant(actuator)?;
    let t = if let Ok(linear) = set.t_at_rest(&plant.settled()) {
        linear
    } else {
        let step_volt = set.step_volts(&plant);
        identify_t(&mut plant, &step_volt).map_err(|e| set.failed(actuator, e))?
    };
    set.controlled(actuator, plant, &t)
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
    let starts_linear = rotor.rotor().model().nonlinear.is_linear();
    if !control.harmonics.is_empty()
        && (starts_linear || control.controller == ControllerChoice::Local)
    {
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

impl ControlSet<'_> {
    /// Feedback to convergence on the plant itself, from zero control.
    fn feedback(&self, actuator: ControlActuator) -> Result<ControlStudy, StudyError> {
        let mut plant = self.plant(actuator)?;
        if let Some(t) = self.handed_t(actuator, &plant)? {
            return self.controlled(actuator, plant, &t);
        }
        let step_volt = self.step_volts(&plant);
        let t = match self.case.control.controller {
            ControllerChoice::Local => self.t_at_rest(&plant),
            ControllerChoice::Global | ControllerChoice::Adaptive => {
                identify_t(&mut plant, &step_volt)
            }
        };
        let t = t.map_err(|e| self.failed(actuator, e))?;
        self.controlled(actuator, plant, &t)
    }

    /// The same with a T about zero control.
    fn controlled(
        &self,
        actuator: ControlActuator,
        mut plant: RotorPlant,
        t: &TMatrix,
    ) -> Result<ControlStudy, StudyError> {
        let failed = |e| self.failed(actuator, e);
        let control = &self.case.control;
        let is_handed = self.handed_t(actuator, &plant)?.is_some();
        let way = match (actuator, control.controller) {
            // a T that is handed in is held, and never identified again
            (_, ControllerChoice::Global | ControllerChoice::Adaptive) if is_handed => {
                Controller::Global
            }
            // the ideal actuator has nearly one T everywhere: at limits that bind even the rotor's own bend shows
            (ControlActuator::Ideal, ControllerChoice::Global | ControllerChoice::Adaptive) => {
                Controller::Global
            }
            (_, choice) => self.t_policy(choice, self.step_volts(&plant)),
        };
        let holds_t = matches!(way, Controller::Renewed { .. });
        let cost_tolerance = acceptance(&way, control.effort).cost_tolerance();
        let controller = self.controller(t, way, control.effort).map_err(failed)?;
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
    fn with_ideal_voltages(&self, ideal: &ControlStudy) -> Result<ControlStudy, StudyError> {
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

//! The ideal actuator's flap motion made by the identified one, or the best motion within its range of voltages.

use crate::control::set::{ControlSet, least_effort};
use crate::control::study::ControlStudy;
use crate::error::StudyError;
use crate::flaps::{FlapDrive, FlapMotion, PlantError};
use crate::loads::loads_cost;
use crate::plant::{LinearisedPlant, PlantState, RotorPlant};
use hhc_control::{Controller, Plant, RunError};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_base::series::{scaled, times};
use rotor_case::{ControlActuator, EffortChoice};

/// A wanted motion of every flap, deg, and the rotor with what the inverse makes of it.
type Made = (Vec<HarmonicSeries>, PlantState);

impl ControlSet<'_> {
    /// The ideal actuator's flap motion through the inverse, whole; the inner error where it is not to be had.
    pub(crate) fn through_the_inverse(
        &self,
        ideal: &ControlStudy,
    ) -> Result<Result<Vec<FlapMotion>, PlantError>, StudyError> {
        let plant = self.plant(ControlActuator::Inverse)?;
        Ok(made(&plant, &self.wanted(&ideal.state.flaps, 1.0)))
    }

    /// The ideal actuator's flap motion, made by the hysteretic one: its inverse gives the voltage. Where the
    /// whole of it takes voltages beyond the range, the best motion within.
    pub(crate) fn inverted(
        &self,
        ideal: &ControlStudy,
        whole: Option<Result<Vec<FlapMotion>, PlantError>>,
    ) -> Result<ControlStudy, StudyError> {
        let actuator = ControlActuator::Inverse;
        let plant = self.plant(actuator)?;
        let failed = |source| {
            self.failed(actuator, RunError::plant("measured", &ideal.control_volt)(source))
        };
        let mut share = 1.0;
        let mut found =
            whole.unwrap_or_else(|| made(&plant, &self.wanted(&ideal.state.flaps, share)));
        for _ in 0..INVERSE_TRIALS {
            let Err(error) = &found else { break };
            let Some(within) = error.within_reach() else { break };
            share *= (INVERSE_MARGIN * within).max(0.5);
            found = made(&plant, &self.wanted(&ideal.state.flaps, share));
        }
        let state = plant.state_of(found.map_err(failed)?).map_err(failed)?;
        let mut best = (self.wanted(&ideal.state.flaps, share), state);
        if share < 1.0 {
            best = self.best_in_reach(&plant, best).map_err(failed)?;
        }
        let (wanted_deg, state) = best;
        let volts = self.control_volt(&state.flaps);
        Ok(ControlStudy {
            t: ideal.t.clone(),
            rho: ideal.rho,
            wanted_deg,
            motion_share: Some(share),
            ..self.study(actuator, &plant, volts, state)?
        })
    }

    /// The motion of least cost that the range of voltages holds, or a motion that it holds if that is better:
    /// the loop with T about the present control, run beforehand on the model of actuators and linearised rotor,
    /// from rest and from the voltages of that motion. Its flap motion is what the inverse is asked for.
    fn best_in_reach(&self, plant: &RotorPlant, mut best: Made) -> Result<Made, PlantError> {
        let blades = self.case.rotor.blades;
        let weights = self.load_weights();
        let cost = |state: &PlantState| loads_cost(&weights, &state.rotor.hub.harmonic(blades));
        let model = LinearisedPlant(plant.settled());
        let starts = [plant.layout().zero(), self.control_volt(&best.1.flaps)];
        let planned: Vec<Result<Vec<FlapMotion>, RunError<PlantError>>> =
            starts.into_par_iter().map(|start| self.planned(model.clone(), &start)).collect();
        for flaps in planned {
            // a plan that fails is no better than the motion at hand
            let Ok(flaps) = flaps else { continue };
            for part in PLAN_PARTS {
                let wanted_deg = self.wanted(&flaps, part);
                let Ok(flaps) = made(plant, &wanted_deg) else { continue };
                let tried = plant.state_of(flaps)?;
                if cost(&tried) < cost(&best.1) {
                    best = (wanted_deg, tried);
                }
                break;
            }
        }
        Ok(best)
    }

    /// Flap motions at the optimum of a model within its limits, from a control vector.
    fn planned(
        &self,
        mut model: LinearisedPlant,
        start_volt: &[f64],
    ) -> Result<Vec<FlapMotion>, RunError<PlantError>> {
        let failed = |source| RunError::plant("linearised", start_volt)(source);
        let t = model.linearised_t(start_volt).map_err(failed)?;
        let t = t.ok_or_else(|| failed(PlantError::BiasSearch))?;
        let step_volt = vec![self.step_volt(); model.layout().len()];
        let way = Controller::Local { step_volt };
        let controller = self.controller(&t, way, EffortChoice::Limits)?;
        let rho = least_effort(controller.law());
        let run = controller.run_constrained_from(&mut model, rho, start_volt)?;
        model.0.flap_motion(&run.last().control_volt).map_err(failed)
    }

    /// Motions up to the highest controlled harmonic, mean left to the bias, times a factor: lower harmonics
    /// that the actuators add on the way are part of them.
    fn wanted(&self, flaps: &[FlapMotion], factor: f64) -> Vec<HarmonicSeries> {
        let highest = self.harmonics.iter().copied().max().unwrap_or(1);
        let cut = |flap: &FlapMotion| HarmonicSeries {
            mean: 0.0,
            harmonics: (1..=highest).map(|n| times(flap.flap_deg.harmonic(n), factor)).collect(),
        };
        flaps.iter().map(cut).collect()
    }

    /// The controlled voltages of flaps as a control vector, V.
    fn control_volt(&self, flaps: &[FlapMotion]) -> Vec<f64> {
        let each = flaps
            .iter()
            .flat_map(|flap| self.harmonics.iter().map(|&n| flap.voltage_volt.harmonic(n)));
        each.flat_map(|h| [h.cosine, h.sine]).collect()
    }
}

/// Wanted motions made through the inverse under the hinge moments they bring.
fn made(plant: &RotorPlant, wanted_deg: &[HarmonicSeries]) -> Result<Vec<FlapMotion>, PlantError> {
    let drive: &FlapDrive = plant.drive();
    let loads = if drive.compliance_deg_per_newton_metre() == 0.0 {
        vec![HarmonicSeries::zero(0); wanted_deg.len()]
    } else {
        let angles_rad = wanted_deg.iter().map(|w| scaled(w, 1.0_f64.to_radians())).collect();
        let rotor = plant.rotor();
        rotor.hinge_moments_newton_metre(&rotor.with_flaps(angles_rad)?)
    };
    let each = wanted_deg.par_iter().zip(&loads);
    each.map(|(wanted, load)| drive.loaded_inverse(wanted, load)).collect()
}

/// Smaller motions to try where one is out of reach.
const INVERSE_TRIALS: usize = 6;
/// Part of the reachable motion that is asked for.
const INVERSE_MARGIN: f64 = 0.98;
/// Parts of a planned motion that are asked of the inverse, the first that it makes.
const PLAN_PARTS: [f64; 4] = [1.0, 0.998, 0.99, 0.97];

//! The ideal actuator's flap motion made by the identified one, or the best motion within its range of voltages.

use crate::case::{ControlActuator, EffortChoice};
use crate::control::set::{ControlSet, least_effort};
use crate::control::study::ControlStudy;
use crate::error::StudyError;
use crate::flaps::{FlapDrive, FlapMotion, PlantError};
use crate::loads::loads_cost;
use crate::plant::{ModelPlant, PlantState, RotorPlant};
use hhc_control::{Controller, Plant, RunError};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};

/// A wanted motion of every flap and what the inverse makes of it.
#[derive(Debug, Clone)]
struct Made {
    wanted_deg: Vec<HarmonicSeries>,
    flaps: Vec<FlapMotion>,
}

impl ControlSet<'_> {
    /// The ideal actuator's flap motion through the inverse, whole; the inner error where it is not to be had.
    pub(crate) fn through_the_inverse(
        &self,
        ideal: &ControlStudy,
    ) -> Result<Result<Vec<FlapMotion>, PlantError>, StudyError> {
        let plant = self.plant(ControlActuator::Inverse)?;
        Ok(made(&plant, &self.wanted(ideal, 1.0)))
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
        let mut found = whole.unwrap_or_else(|| made(&plant, &self.wanted(ideal, share)));
        for _ in 0..INVERSE_TRIALS {
            let Err(error) = &found else { break };
            let Some(within) = error.within_reach() else { break };
            share *= (INVERSE_MARGIN * within).max(0.5);
            found = made(&plant, &self.wanted(ideal, share));
        }
        let flaps = found.map_err(failed)?;
        let first = Made { wanted_deg: self.wanted(ideal, share), flaps };
        let state = plant.state_of(first.flaps.clone()).map_err(failed)?;
        let (best, state) = if share < 1.0 {
            self.best_in_reach(&plant, (first, state)).map_err(failed)?
        } else {
            (first, state)
        };
        let volts = self.control_volt(&best.flaps);
        Ok(ControlStudy {
            t: ideal.t.clone(),
            rho: ideal.rho,
            wanted_deg: best.wanted_deg,
            motion_share: Some(share),
            ..self.study(actuator, &plant, volts, state)?
        })
    }

    /// The motion of least cost that the range of voltages holds, or a motion that it holds if that is better:
    /// the loop with T about the present control, run beforehand on the model of actuators and linearised rotor,
    /// from rest and from the voltages of that motion. Its flap motion is what the inverse is asked for.
    fn best_in_reach(
        &self,
        plant: &RotorPlant,
        (mut best, mut state): (Made, PlantState),
    ) -> Result<(Made, PlantState), PlantError> {
        let blades = self.case.rotor.blades;
        let weights = self.load_weights();
        let cost = |state: &PlantState| loads_cost(&weights, &state.rotor.hub.harmonic(blades));
        let model = ModelPlant::new(plant.settled(), blades);
        let starts = [plant.layout().zero(), self.control_volt(&best.flaps)];
        let planned: Vec<Result<Vec<FlapMotion>, RunError<PlantError>>> =
            starts.into_par_iter().map(|start| self.planned(model.clone(), &start)).collect();
        for flaps in planned {
            // a plan that fails is no better than the motion at hand
            let Ok(flaps) = flaps else { continue };
            for part in PLAN_PARTS {
                let wanted_deg: Vec<HarmonicSeries> =
                    flaps.iter().map(|flap| self.up_to_the_highest(&flap.flap_deg, part)).collect();
                let Ok(flaps) = made(plant, &wanted_deg) else { continue };
                let tried = plant.state_of(flaps.clone())?;
                if cost(&tried) < cost(&state) {
                    (best, state) = (Made { wanted_deg, flaps }, tried);
                }
                break;
            }
        }
        Ok((best, state))
    }

    /// Flap motions at the optimum of a model within its limits, from a control vector.
    fn planned(
        &self,
        mut model: ModelPlant,
        start_volt: &[f64],
    ) -> Result<Vec<FlapMotion>, RunError<PlantError>> {
        let failed = |source| RunError::plant("linearised", start_volt)(source);
        let t = model.linearised_t(start_volt).map_err(failed)?;
        let t = t.ok_or_else(|| failed(PlantError::BiasSearch))?;
        let step_volt = vec![self.step_volt(); model.layout().len()];
        let way = Controller::Local { step_volt };
        let controller = self.controller(&t, way, EffortChoice::Limits)?;
        let rho = least_effort(&controller);
        let run = controller.run_constrained_from(&mut model, rho, start_volt)?;
        model.flap_motion(&run.last().control_volt).map_err(failed)
    }

    /// A motion up to the highest controlled harmonic, mean left to the bias, times a factor: lower harmonics
    /// that the actuators add on the way are part of it.
    fn up_to_the_highest(&self, motion: &HarmonicSeries, factor: f64) -> HarmonicSeries {
        let highest = self.harmonics.iter().copied().max().unwrap_or(1);
        let mut cut = HarmonicSeries::zero(highest);
        for n in 1..=highest {
            let Harmonic { cosine, sine } = motion.harmonic(n);
            cut.set_harmonic(n, Harmonic { cosine: factor * cosine, sine: factor * sine });
        }
        cut
    }

    /// A share of the controlled harmonics of the ideal actuator's flap motion.
    fn wanted(&self, ideal: &ControlStudy, share: f64) -> Vec<HarmonicSeries> {
        let highest = self.harmonics.iter().copied().max().unwrap_or(1);
        let rest = HarmonicSeries::zero(highest);
        let flaps = ideal.state.flaps.iter();
        flaps.map(|motion| self.between(&rest, &motion.flap_deg, share)).collect()
    }

    /// The controlled harmonics a part of the way from one motion to another.
    fn between(&self, from: &HarmonicSeries, to: &HarmonicSeries, part: f64) -> HarmonicSeries {
        let mut between = HarmonicSeries::zero(self.harmonics.iter().copied().max().unwrap_or(1));
        for &n in self.harmonics {
            let (a, b) = (from.harmonic(n), to.harmonic(n));
            let along = |a: f64, b: f64| a + part * (b - a);
            let (cosine, sine) = (along(a.cosine, b.cosine), along(a.sine, b.sine));
            between.set_harmonic(n, Harmonic { cosine, sine });
        }
        between
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
        let flaps = wanted_deg.iter().map(|flap_deg| FlapMotion {
            voltage_volt: HarmonicSeries::zero(0),
            flap_deg: flap_deg.clone(),
        });
        plant.hinge_moments_newton_metre(flaps.collect())?
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

//! The ideal actuator's flap motion made by the identified one, or the best motion within its range of voltages.

use super::run::{ControlSet, LEAST_EFFORT};
use super::{ControlStudy, FlapDrive, FlapMotion, PlantError, PlantState, RotorPlant, StudyError};
use crate::case::ControlActuator;
use crate::raw::loads_cost;
use hhc_control::{FeedbackLaw, LoadWeights, Plant, PlantCall, RunError, TMatrix};
use preisach_dyn::PreisachError;
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
    pub(super) fn made_whole(
        &self,
        ideal: &ControlStudy,
    ) -> Result<Result<Vec<FlapMotion>, PlantError>, StudyError> {
        let plant = self.plant(ControlActuator::Inverse)?;
        Ok(made(&plant, &self.wanted(ideal, 1.0)))
    }

    /// The ideal actuator's flap motion, made by the hysteretic one: its inverse gives the voltage. Where the
    /// whole of it takes voltages beyond the range, the best motion within.
    pub(super) fn inverted(
        &self,
        ideal: &ControlStudy,
        whole: Option<Result<Vec<FlapMotion>, PlantError>>,
    ) -> Result<ControlStudy, StudyError> {
        let actuator = ControlActuator::Inverse;
        let plant = self.plant(actuator)?;
        let failed = |source| {
            let call = PlantCall::Measure { control_volt: ideal.control_volt.clone() };
            self.failed(actuator, RunError::Plant { call, history: Vec::new(), source })
        };
        let mut share = 1.0;
        let mut found = whole.unwrap_or_else(|| made(&plant, &self.wanted(ideal, share)));
        for _ in 0..INVERSE_TRIALS {
            let Err(error) = &found else { break };
            let Some(within) = within_reach(error) else { break };
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

    /// The motion of least cost that the range of voltages holds, from one that it holds: again and again the
    /// cone program on the linearised rotor, with the range and the strokes as they are for the voltages that
    /// the inverse gives, until the cost falls no more.
    fn best_in_reach(
        &self,
        plant: &RotorPlant,
        (mut best, mut state): (Made, PlantState),
    ) -> Result<(Made, PlantState), PlantError> {
        let blades = self.case.blades;
        let weights = self.load_weights();
        let diagonal = LoadWeights::Diagonal(weights.into_iter().flat_map(|w| [w, w]).collect());
        let cost = |state: &PlantState| loads_cost(&weights, &state.rotor.hub.harmonic(blades));
        let start = loads_cost(&weights, &self.rotor.trim().rotor.hub.harmonic(blades));
        for _ in 0..REACH_ROUNDS {
            let control_volt = self.control_volt(&best.flaps);
            let Ok(limits) = plant.clone().limits(&control_volt) else { break };
            let gains = self.gains(&best.flaps);
            let t = self.t_by_gains(&gains)?;
            let law = FeedbackLaw::new(&t, &diagonal).map_err(PlantError::Bias)?;
            let surplus = t.controls() > t.loads();
            let scale = law.singular_values().first().map_or(0.0, |s| s * s);
            let rho = if surplus { LEAST_EFFORT * scale } else { 0.0 };
            let loads = state.rotor.hub.harmonic(blades);
            let aim = law
                .optimum_within(rho, &control_volt, &loads, &limits)
                .map_err(PlantError::Bias)?;
            let aimed = self.motion_of(&gains, &aim.control_volt);
            let before = cost(&state);
            for part in REACH_PARTS {
                let wanted_deg: Vec<HarmonicSeries> = best
                    .wanted_deg
                    .iter()
                    .zip(&aimed)
                    .map(|(from, to)| self.between(from, to, part))
                    .collect();
                let Ok(flaps) = made(plant, &wanted_deg) else { continue };
                let tried = plant.state_of(flaps.clone())?;
                if cost(&tried) < before {
                    (best, state) = (Made { wanted_deg, flaps }, tried);
                    break;
                }
            }
            if before - cost(&state) <= REACH_FALL * start {
                break;
            }
        }
        Ok((best, state))
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

    /// Motion over voltage of every pair as `[real, imaginary]`, deg/V, for `cosine + i sine`.
    fn gains(&self, flaps: &[FlapMotion]) -> Vec<[f64; 2]> {
        let each = flaps.iter().flat_map(|flap| self.harmonics.iter().map(move |&n| (flap, n)));
        each.map(|(flap, n)| {
            let (u, d) = (flap.voltage_volt.harmonic(n), flap.flap_deg.harmonic(n));
            let square = (u.cosine * u.cosine + u.sine * u.sine).max(f64::MIN_POSITIVE);
            [
                (d.cosine * u.cosine + d.sine * u.sine) / square,
                (d.sine * u.cosine - d.cosine * u.sine) / square,
            ]
        })
        .collect()
    }

    /// The flap motions that gains give to a control vector, deg.
    fn motion_of(&self, gains: &[[f64; 2]], control_volt: &[f64]) -> Vec<HarmonicSeries> {
        let size = self.harmonics.len();
        let pairs: Vec<Harmonic> = gains
            .iter()
            .zip(control_volt.chunks_exact(2))
            .map(|([re, im], u)| Harmonic {
                cosine: re * u[0] - im * u[1],
                sine: im * u[0] + re * u[1],
            })
            .collect();
        let flaps = pairs.chunks(size.max(1));
        flaps
            .map(|flap| {
                let highest = self.harmonics.iter().copied().max().unwrap_or(1);
                let mut motion = HarmonicSeries::zero(highest);
                for (&n, &h) in self.harmonics.iter().zip(flap) {
                    motion.set_harmonic(n, h);
                }
                motion
            })
            .collect()
    }

    /// T of the linearised rotor for gains of the pairs, load per V.
    fn t_by_gains(&self, gains: &[[f64; 2]]) -> Result<TMatrix, PlantError> {
        let authority = self.rotor.authority()?;
        let mut columns = Vec::with_capacity(2 * gains.len());
        for control in 0..2 * gains.len() {
            let mut unit = vec![0.0; 2 * gains.len()];
            unit[control] = 1.0;
            let flap = control / (2 * self.harmonics.len());
            let motions = self.motion_of(gains, &unit);
            columns.push(authority.loads(flap, &motions[flap]).to_vec());
        }
        TMatrix::from_columns(&columns).map_err(PlantError::Bias)
    }
}

/// Wanted motions made through the inverse under the hinge moments they bring.
fn made(plant: &RotorPlant, wanted_deg: &[HarmonicSeries]) -> Result<Vec<FlapMotion>, PlantError> {
    let drive: &FlapDrive = plant.drive();
    let loads = if drive.give_deg_per_newton_metre() == 0.0 {
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

/// Part of a wanted motion that the actuator reaches, if that is why its inverse failed.
pub(super) fn within_reach(error: &PlantError) -> Option<f64> {
    match error {
        PlantError::Actuator(PreisachError::MotionOutOfReach {
            wanted_deg, reachable_deg, ..
        }) => Some(reachable_deg / wanted_deg),
        PlantError::Actuator(PreisachError::InverseNotConverged { share, .. }) => Some(*share),
        _ => None,
    }
}

/// Smaller motions to try where one is out of reach.
const INVERSE_TRIALS: usize = 6;
/// Part of the reachable motion that is asked for.
const INVERSE_MARGIN: f64 = 0.98;
/// Cone programs on the way to the best motion in reach.
const REACH_ROUNDS: usize = 12;
/// Parts of the way to the aim of one that are tried.
const REACH_PARTS: [f64; 4] = [1.0, 0.5, 0.25, 0.1];
/// Fall of J, as a part of the uncontrolled J, below which the motion is the best in reach.
const REACH_FALL: f64 = 1e-3;

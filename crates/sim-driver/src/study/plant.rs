//! The trimmed rotor with its driven flaps as the plant of the controller.

use super::{FlapDrive, FlapMotion, FullScale, PlantError};
use crate::SimError;
use crate::case::{LoadedCase, TrimValues};
use crate::inflow::{SettledInflow, SettledTrim, settled_trim};
use hhc_control::{ControlError, ControlLayout, Measurement, Plant};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::{Condition, ResponseError, Rotor, RotorSolution, RotorSolver};
use std::sync::Arc;
use trim::{TrimError, TrimSolution, TrimTarget, WakeTrim, imbalance};

/// A rotor in trim, flaps at rest: where every control run starts.
#[derive(Debug, Clone)]
pub struct TrimmedRotor {
    solver: RotorSolver,
    inflow: SettledInflow,
    trim: TrimSolution,
    wake: Option<Arc<WakeTrim>>,
}

impl TrimmedRotor {
    /// Builds the rotor of a case and trims it with its flaps at rest, from a nearby trim if there
    /// is one.
    ///
    /// # Errors
    /// [`SimError::Blade`], [`SimError::Response`] and [`SimError::Trim`], at the line of the case
    /// that asked for it.
    pub fn new(loaded: &LoadedCase, start: Option<&TrimSolution>) -> Result<Self, SimError> {
        let case = &loaded.case;
        let at_rotor = |source| SimError::Response { place: loaded.index.place("rotor"), source };
        let blade = case.blade_properties()?;
        let rotor =
            Rotor::new(case.rotor_model(), &blade, case.discretisation()).map_err(at_rotor)?;
        let mu = case.advance_ratio;
        let tolerances = case.response_tolerances();
        let mut solver = RotorSolver::new(Arc::new(rotor), mu, tolerances).map_err(at_rotor)?;
        let settled = settled_trim(loaded, &mut solver, start).map_err(|source| {
            let field = match case.trim {
                TrimValues::Propulsive { .. } | TrimValues::WindTunnel { .. } => "trim.ct_sigma",
                TrimValues::Prescribed { .. } => "trim",
            };
            SimError::Trim { place: loaded.index.place(field), source }
        })?;
        let SettledTrim { trim, inflow, wake } = settled;
        Ok(Self { solver, inflow, trim, wake })
    }

    /// The trim.
    pub fn trim(&self) -> &TrimSolution {
        &self.trim
    }

    /// The free wake the trim settled with, if the case asks for one.
    pub fn wake(&self) -> Option<&WakeTrim> {
        self.wake.as_deref()
    }

    /// The rotor.
    pub fn rotor(&self) -> &Rotor {
        self.solver.rotor()
    }

    /// What another response leaves unbalanced at the controls and attitude of this trim, over the
    /// weight.
    ///
    /// # Errors
    /// As [`trim::imbalance`].
    pub fn imbalance(
        &self,
        target: &TrimTarget,
        response: &RotorSolution,
    ) -> Result<f64, TrimError> {
        imbalance(&self.solver, &self.inflow, target, &self.trim, response)
    }

    /// Response with moving flaps: pilot controls and attitude as trimmed, inflow settled anew.
    ///
    /// Starts from the trimmed orbit with the trim's factorisation, whatever was solved before.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn with_flaps(
        &self,
        flap_angles_rad: Vec<HarmonicSeries>,
    ) -> Result<RotorSolution, ResponseError> {
        let condition =
            Condition { flight: self.trim.flight, controls: self.trim.controls, flap_angles_rad };
        self.solver.clone().solve(&condition, &self.inflow, Some(&self.trim.rotor))
    }
}

/// Everything about one control vector.
#[derive(Debug, Clone)]
pub struct PlantState {
    /// Motion of each flap, root to tip.
    pub flaps: Vec<FlapMotion>,
    /// Response of the rotor.
    pub rotor: RotorSolution,
}

/// The plant: voltages in, hub loads out.
#[derive(Debug, Clone)]
pub struct RotorPlant {
    layout: ControlLayout,
    rotor: TrimmedRotor,
    drive: FlapDrive,
    /// One per pair of the layout.
    stroke_limits_deg: Vec<f64>,
    /// Amplitude at which each pair reaches its limit, V.
    full_scale_volt: Vec<f64>,
}

impl RotorPlant {
    /// A plant with the same drive at every flap.
    ///
    /// `full_scale` holds the limit at each controlled harmonic.
    ///
    /// # Errors
    /// [`ControlError`] for a layout without flaps or harmonics.
    pub fn new(
        rotor: TrimmedRotor,
        drive: FlapDrive,
        harmonics: &[usize],
        full_scale: &[FullScale],
    ) -> Result<Self, ControlError> {
        let flaps = rotor.rotor().model().flaps.len();
        let numbers = harmonics.iter().map(|&n| u32::try_from(n).unwrap_or(u32::MAX)).collect();
        let layout = ControlLayout::new(flaps, numbers)?;
        let per_pair = |pick: &dyn Fn(&FullScale) -> f64| -> Vec<f64> {
            (0..layout.pairs()).map(|p| pick(&full_scale[p % full_scale.len()])).collect()
        };
        Ok(Self {
            full_scale_volt: per_pair(&|f| f.amplitude_volt),
            stroke_limits_deg: per_pair(&|f| f.stroke_deg),
            layout,
            rotor,
            drive,
        })
    }

    /// The rotor in trim.
    pub fn rotor(&self) -> &TrimmedRotor {
        &self.rotor
    }

    /// Harmonics of the voltage of every flap.
    fn voltages(&self, control_volt: &[f64]) -> Result<Vec<Vec<(usize, Harmonic)>>, PlantError> {
        let pairs = self.layout.voltages_volt(control_volt).map_err(PlantError::Bias)?;
        let mut flaps = vec![Vec::new(); self.layout.flaps()];
        for (pair, voltage) in pairs.into_iter().enumerate() {
            if let Some((flap, harmonic)) = self.layout.flap_and_harmonic(pair) {
                flaps[flap].push((harmonic as usize, voltage));
            }
        }
        Ok(flaps)
    }

    /// Motion of every flap for a control vector.
    ///
    /// # Errors
    /// The actuator's errors.
    pub fn flap_motion(&self, control_volt: &[f64]) -> Result<Vec<FlapMotion>, PlantError> {
        self.voltages(control_volt)?
            .into_par_iter()
            .map(|voltages| self.drive.motion(&voltages))
            .collect()
    }

    /// Flap motion and rotor response for a control vector.
    ///
    /// # Errors
    /// The errors of actuator and rotor.
    pub fn state(&self, control_volt: &[f64]) -> Result<PlantState, PlantError> {
        let flaps = self.flap_motion(control_volt)?;
        let angles = flaps
            .iter()
            .map(|f| {
                let to_rad = std::f64::consts::PI / 180.0;
                let harmonics = f
                    .flap_deg
                    .harmonics
                    .iter()
                    .map(|h| Harmonic { cosine: to_rad * h.cosine, sine: to_rad * h.sine })
                    .collect();
                HarmonicSeries { mean: to_rad * f.flap_deg.mean, harmonics }
            })
            .collect();
        Ok(PlantState { rotor: self.rotor.with_flaps(angles)?, flaps })
    }

    /// Motion of each pair of the layout at its own harmonic, deg.
    fn pair_motion(&self, flaps: &[FlapMotion]) -> Vec<Harmonic> {
        (0..self.layout.pairs())
            .filter_map(|pair| self.layout.flap_and_harmonic(pair))
            .map(|(flap, n)| flaps[flap].flap_deg.harmonic(n as usize))
            .collect()
    }

    fn answer(&self, control_volt: &[f64]) -> Result<Measurement, PlantError> {
        let state = self.state(control_volt)?;
        let blades = self.rotor.rotor().model().blades;
        Ok(Measurement {
            hub_loads: state.rotor.hub.harmonic(blades).to_vec(),
            flap_motion_deg: self.pair_motion(&state.flaps),
            mean_flap_deg: state.flaps.iter().map(|f| f.flap_deg.mean).collect(),
        })
    }
}

impl Plant for RotorPlant {
    type Error = PlantError;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, PlantError> {
        self.answer(control_volt)
    }

    fn measure_many(&mut self, controls_volt: &[Vec<f64>]) -> Result<Vec<Measurement>, PlantError> {
        let plant = &*self;
        controls_volt.par_iter().map(|control| plant.answer(control)).collect()
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, PlantError> {
        let amplitudes = self.layout.amplitudes_volt(control_volt).map_err(PlantError::Bias)?;
        let scaled = || {
            amplitudes
                .iter()
                .zip(&self.full_scale_volt)
                .zip(&self.stroke_limits_deg)
                .map(|((volt, full), limit)| limit * volt / full)
                .collect::<Vec<f64>>()
        };
        // beyond full scale the actuator cannot be asked: the stroke grows with the voltage there
        if amplitudes.iter().zip(&self.full_scale_volt).any(|(volt, full)| volt > full) {
            return Ok(scaled());
        }
        // harmonics that share a flap share its range of voltages
        let ratios: Vec<f64> =
            self.voltages(control_volt)?.iter().map(|v| self.drive.range_ratio(v)).collect();
        let in_range = |strokes: Vec<f64>| {
            let pairs = strokes.into_iter().zip(&self.stroke_limits_deg).enumerate();
            pairs
                .map(|(pair, (stroke, limit))| {
                    let flap = self.layout.flap_and_harmonic(pair).map_or(0, |(flap, _)| flap);
                    stroke.max(limit * ratios[flap])
                })
                .collect()
        };
        match self.flap_motion(control_volt) {
            Ok(flaps) => {
                let motion = self.pair_motion(&flaps);
                Ok(in_range(motion.iter().map(Harmonic::amplitude).collect()))
            }
            Err(PlantError::VoltageSwing { .. }) => Ok(in_range(scaled())),
            // no bias centres the flap inside the range, though the swing alone fits
            Err(PlantError::Bias(_)) => {
                let excess = amplitudes.len() as f64;
                Ok(scaled().iter().map(|s| s * excess).collect())
            }
            Err(error) => Err(error),
        }
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.stroke_limits_deg.clone()
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        self.flap_motion(control_volt).is_ok()
    }
}

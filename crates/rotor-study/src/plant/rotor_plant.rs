//! The plant of the controller: voltages in, hub loads out.

use crate::flaps::{CouplingResidual, FlapDrive, FlapMotion, FullScale, HingeCoupling, PlantError};
use crate::plant::memo::{Memo, answer};
use crate::rotor::TrimmedRotor;
use hhc_control::{
    ControlLayout, ControlLimits, FlapCircle, Measurement, Plant, RunError, TMatrix,
};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::RotorSolution;
use std::sync::Arc;

/// Part of full scale from which the gain of an actuator is read off its motion.
const LEAST_GAIN_PART: f64 = 0.2;
/// Part of a given stroke limit that a cone program aims at: the gain moves with the control, and no end of a
/// loop is to lie above the limit.
const STROKE_AIMED_AT: f64 = 0.9985;

/// What the power of the actuators has to do with the control.
#[derive(Debug, Clone)]
pub(super) struct PlantPower {
    /// Power of each pair, W per `deg^2`.
    pub(super) watt_per_deg2: Vec<f64>,
    /// Largest mean power that the actuators of one blade give, W.
    pub(super) limit_watt: Option<f64>,
    /// Weight of the power in the cost, per W.
    pub(super) weight_per_watt: f64,
}

/// Everything about one control vector.
#[derive(Debug, Clone)]
pub struct PlantState {
    /// Motion of each flap, root to tip.
    pub flaps: Vec<FlapMotion>,
    /// Response of the rotor.
    pub rotor: RotorSolution,
    /// How well flap motion and hinge moment agree; none where no actuator gives way to it.
    pub coupling: Option<CouplingResidual>,
}

/// The plant: voltages in, hub loads out.
#[derive(Debug, Clone)]
pub struct RotorPlant {
    pub(super) layout: ControlLayout,
    pub(super) rotor: TrimmedRotor,
    pub(super) drive: FlapDrive,
    /// None where the actuator does not give way to the hinge moment.
    coupling: Option<HingeCoupling>,
    /// Limit of every pair of the layout, alone on its flap.
    pub(super) full_scale: Vec<FullScale>,
    pub(super) power: Option<PlantPower>,
    /// The control measured last and what was found there: T is mostly asked for about it.
    pub(super) measured: Option<(Vec<f64>, Arc<PlantState>)>,
    /// Motions of one flap without hinge moment, and of all flaps under it.
    free: Memo<FlapMotion>,
    /// Their changes with the controls of the flap.
    pub(super) tangents: Memo<Vec<FlapMotion>>,
    coupled: Memo<Vec<FlapMotion>>,
}

impl RotorPlant {
    /// A plant with the same drive at every flap.
    ///
    /// `full_scale` holds the limit at each controlled harmonic. A drive that gives way to a load is
    /// coupled with the hinge moment of its flap in every answer.
    ///
    /// # Errors
    /// [`RunError::Control`] for a layout without flaps or harmonics.
    pub fn new(
        rotor: TrimmedRotor,
        drive: FlapDrive,
        harmonics: &[usize],
        full_scale: &[FullScale],
    ) -> Result<Self, RunError<PlantError>> {
        let flaps = rotor.rotor().model().flaps.len();
        let numbers = harmonics.iter().map(|&n| u32::try_from(n).unwrap_or(u32::MAX)).collect();
        let layout = ControlLayout::new(flaps, numbers)?;
        let coupling = rotor
            .coupling(drive.compliance_deg_per_newton_metre(), drive.holds_bias())
            .map_err(|source| RunError::plant("measured", &layout.zero())(source.into()))?;
        let of_pair = |pair: usize| full_scale[pair % full_scale.len()];
        Ok(Self {
            full_scale: (0..layout.pairs()).map(of_pair).collect(),
            layout,
            rotor,
            drive,
            coupling,
            power: None,
            measured: None,
            free: Memo::default(),
            tangents: Memo::default(),
            coupled: Memo::default(),
        })
    }

    /// The rotor in trim.
    pub fn rotor(&self) -> &TrimmedRotor {
        &self.rotor
    }

    /// The same plant with the inflow settled in the T of its linearised rotor, as in its answers.
    pub(crate) fn settled(&self) -> Self {
        Self { rotor: self.rotor.with_settled_t(), ..self.clone() }
    }

    /// What drives its flaps.
    pub fn drive(&self) -> &FlapDrive {
        &self.drive
    }

    /// Harmonics of the voltage of every flap.
    pub(super) fn voltages(
        &self,
        control_volt: &[f64],
    ) -> Result<Vec<Vec<(usize, Harmonic)>>, PlantError> {
        let pairs = self.layout.voltages_volt(control_volt).map_err(PlantError::Bias)?;
        let mut flaps = vec![Vec::new(); self.layout.flaps()];
        for (pair, voltage) in pairs.into_iter().enumerate() {
            if let Some((flap, harmonic)) = self.layout.flap_and_harmonic(pair) {
                flaps[flap].push((harmonic as usize, voltage));
            }
        }
        Ok(flaps)
    }

    /// Motion of every flap for a control vector, without hinge moment.
    fn free_motion(&self, control_volt: &[f64]) -> Result<Vec<FlapMotion>, PlantError> {
        self.voltages(control_volt)?
            .into_par_iter()
            .map(|voltages| answer(&self.free, bits(&voltages), || self.drive.motion(&voltages)))
            .collect()
    }

    /// The free motions under hinge moments, N m.
    fn loaded(
        &self,
        free: &[FlapMotion],
        moments: &[HarmonicSeries],
    ) -> Result<Vec<FlapMotion>, PlantError> {
        free.par_iter()
            .zip(moments)
            .map(|(free, moment)| self.drive.loaded_motion(free, moment))
            .collect()
    }

    /// Motion of every flap for a control vector, without a response of the rotor: under a hinge moment
    /// it is that of the rotor's linear answer ([`HingeCoupling::predict`]).
    ///
    /// # Errors
    /// The actuator's errors; [`PlantError::Coupling`].
    pub fn flap_motion(&self, control_volt: &[f64]) -> Result<Vec<FlapMotion>, PlantError> {
        let free = self.free_motion(control_volt)?;
        match &self.coupling {
            None => Ok(free),
            Some(coupling) => {
                let bits = control_volt.iter().copied().enumerate();
                let predict = || coupling.predict(|moments| self.loaded(&free, moments));
                answer(&self.coupled, bits, predict)
            }
        }
    }

    /// Flap motion and rotor response for a control vector, settled on each other where the actuator
    /// gives way to the hinge moment. Depends on the control vector alone.
    ///
    /// # Errors
    /// The errors of actuator and rotor; [`PlantError::Coupling`].
    pub fn state(&self, control_volt: &[f64]) -> Result<PlantState, PlantError> {
        let free = self.free_motion(control_volt)?;
        let Some(coupling) = &self.coupling else {
            let rotor = self.rotor.with_flaps(angles_rad(&free))?;
            return Ok(PlantState { rotor, flaps: free, coupling: None });
        };
        let actuate = |moments: &[HarmonicSeries]| self.loaded(&free, moments);
        let respond = |flaps: &[FlapMotion], last: Option<&RotorSolution>| {
            let start = last.unwrap_or(&self.rotor.trim().rotor);
            let rotor = self.rotor.with_flaps_from(angles_rad(flaps), start)?;
            let moments = self.rotor.hinge_moments_newton_metre(&rotor);
            Ok((rotor, moments))
        };
        let (flaps, rotor, residual) = coupling.settle(actuate, respond)?;
        Ok(PlantState { rotor, flaps, coupling: Some(residual) })
    }

    /// The same, not solved again where it was measured last.
    pub(crate) fn state_measured(
        &self,
        control_volt: &[f64],
    ) -> Result<Arc<PlantState>, PlantError> {
        match &self.measured {
            Some((control, state)) if control == control_volt => Ok(Arc::clone(state)),
            _ => Ok(Arc::new(self.state(control_volt)?)),
        }
    }

    /// Rotor response for given flap motions, whatever the actuator makes of the hinge moment.
    ///
    /// # Errors
    /// The errors of the rotor.
    pub fn state_of(&self, flaps: Vec<FlapMotion>) -> Result<PlantState, PlantError> {
        let rotor = self.rotor.with_flaps(angles_rad(&flaps))?;
        Ok(PlantState { rotor, flaps, coupling: None })
    }

    /// Motion of each pair of the layout at its own harmonic, deg.
    pub(super) fn pair_motion(&self, flaps: &[FlapMotion]) -> Vec<Harmonic> {
        (0..self.layout.pairs())
            .filter_map(|pair| self.layout.flap_and_harmonic(pair))
            .map(|(flap, n)| flaps[flap].flap_deg.harmonic(n as usize))
            .collect()
    }

    /// What is measured of given hub loads and flap motions.
    pub(crate) fn measurement(
        &self,
        control_volt: &[f64],
        hub_loads: &[f64; 12],
        flaps: &[FlapMotion],
    ) -> Measurement {
        let mut outputs = hub_loads.to_vec();
        outputs.extend(self.power_outputs().at(control_volt));
        Measurement {
            outputs,
            flap_motion_deg: self.pair_motion(flaps),
            mean_flap_deg: flaps.iter().map(|f| f.flap_deg.mean).collect(),
        }
    }

    /// What is measured of a state.
    pub(crate) fn seen(&self, control_volt: &[f64], state: &PlantState) -> Measurement {
        let loads = state.rotor.hub.harmonic(self.rotor.rotor().model().blades);
        self.measurement(control_volt, &loads, &state.flaps)
    }
}

/// Voltages with their harmonics, as answers are remembered by.
pub(super) fn bits(voltages: &[(usize, Harmonic)]) -> impl Iterator<Item = (usize, f64)> + '_ {
    voltages.iter().flat_map(|&(n, h)| [(n, h.cosine), (n, h.sine)])
}

/// Flap angles as the rotor takes them, rad.
pub(crate) fn angles_rad(flaps: &[FlapMotion]) -> Vec<HarmonicSeries> {
    flaps.iter().map(FlapMotion::angle_rad).collect()
}

impl Plant for RotorPlant {
    type Error = PlantError;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, PlantError> {
        let state = self.state(control_volt)?;
        let measurement = self.seen(control_volt, &state);
        self.measured = Some((control_volt.to_vec(), Arc::new(state)));
        Ok(measurement)
    }

    fn measure_many(&mut self, controls_volt: &[Vec<f64>]) -> Result<Vec<Measurement>, PlantError> {
        let plant = &*self;
        let answer = |u: &Vec<f64>| plant.state(u).map(|state| plant.seen(u, &state));
        controls_volt.par_iter().map(answer).collect()
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, PlantError> {
        let amplitudes = self.layout.amplitudes_volt(control_volt).map_err(PlantError::Bias)?;
        let asked = amplitudes.iter().zip(&self.full_scale);
        let by_voltage: Vec<f64> = asked
            .clone()
            .map(|(volt, full)| full.stroke_deg * volt / full.amplitude_volt)
            .collect();
        // beyond the range the actuator cannot be asked: the stroke grows with the voltage there
        if asked.clone().any(|(volt, full)| *volt > full.reach_volt) {
            return Ok(by_voltage);
        }
        // harmonics that share a flap share its range of voltages
        let ratios: Vec<f64> =
            self.voltages(control_volt)?.iter().map(|v| self.drive.range_ratio(v)).collect();
        let in_range = |strokes: Vec<f64>| {
            let pairs = strokes.into_iter().zip(&self.full_scale).enumerate();
            pairs
                .map(|(pair, (stroke, full))| {
                    let flap = self.layout.flap_and_harmonic(pair).map_or(0, |(flap, _)| flap);
                    stroke.max(full.stroke_deg * ratios[flap])
                })
                .collect()
        };
        match self.flap_motion(control_volt) {
            Ok(flaps) => {
                let motion = self.pair_motion(&flaps);
                Ok(in_range(motion.iter().map(Harmonic::amplitude).collect()))
            }
            Err(PlantError::VoltageSwing { .. }) => Ok(in_range(by_voltage)),
            // no bias centres the flap inside the range, though the swing alone fits
            Err(PlantError::Bias(_)) => {
                let excess = amplitudes.len() as f64;
                Ok(by_voltage.iter().map(|s| s * excess).collect())
            }
            Err(error) => Err(error),
        }
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.full_scale.iter().map(|full| full.stroke_deg).collect()
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        self.flap_motion(control_volt).is_ok()
    }

    fn limits(&mut self, control_volt: &[f64]) -> Result<ControlLimits, PlantError> {
        let flaps = self.flap_motion(control_volt)?;
        let voltage = self.voltage_range(control_volt, &flaps)?;
        let voltages = self.layout.voltages_volt(control_volt).map_err(PlantError::Bias)?;
        // the gain of a small motion says nothing about a large one: its amplitude is bounded in volt
        let known = |voltage: &Harmonic, full: &FullScale| {
            voltage.amplitude() > LEAST_GAIN_PART * full.amplitude_volt
        };
        let largest_volt = voltages.iter().zip(&self.full_scale).map(|(voltage, full)| {
            if known(voltage, full) { full.reach_volt } else { full.amplitude_volt }
        });
        let mut limits = ControlLimits::none(&self.layout)
            .with_amplitudes_volt(largest_volt.collect())
            .and_then(|limits| limits.with_voltage_range(voltage))
            .map_err(PlantError::Bias)?;
        let pairs = voltages.iter().zip(self.pair_motion(&flaps)).zip(&self.full_scale);
        for (pair, ((voltage, motion), full)) in pairs.enumerate() {
            if known(voltage, full) {
                let gain = motion.amplitude() / voltage.amplitude();
                let (sin, cos) = (motion.phase_rad() - voltage.phase_rad()).sin_cos();
                // where the range of voltages is the limit, its circle holds the stroke
                let given = full.amplitude_volt < full.reach_volt;
                let aimed_at = if given { STROKE_AIMED_AT } else { 1.0 };
                let circle = FlapCircle {
                    gain_deg_per_volt: [[gain * cos, -gain * sin], [gain * sin, gain * cos]],
                    limit_deg: aimed_at * full.stroke_deg,
                };
                limits = limits.with_flap_circle(pair, circle).map_err(PlantError::Bias)?;
            }
        }
        if let Some(power) = self.power_limit(control_volt, &flaps)? {
            limits = limits.with_power(power).map_err(PlantError::Bias)?;
        }
        Ok(limits)
    }

    fn linearised_t(&mut self, control_volt: &[f64]) -> Result<Option<TMatrix>, PlantError> {
        self.t_about(control_volt).map(Some)
    }
}

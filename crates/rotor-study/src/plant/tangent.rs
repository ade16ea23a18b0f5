//! T of the plant: what its controls do to the hub.
//!
//! ```text
//! T(u) = G(u) A(u),   G = dZ/d(flap motion) of the rotor linearised about its controlled orbit,   A = d(flap motion)/du
//! ```

use crate::flaps::{FlapMotion, PlantError};
use crate::plant::memo::answer;
use crate::plant::rotor_plant::{RotorPlant, angles_rad, bits};
use hhc_control::{TMatrix, VoltageRange};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};

/// Azimuths at which the range of the voltage is held: a peak of the fifth harmonic between two of them may lie beyond by
/// 2e-4 of its amplitude.
const LIMIT_AZIMUTHS: usize = 720;
/// Voltage step of the tangent of an actuator as a part of its range, 1 V of 170 V: wide enough to see past the steps
/// of its memory.
const TANGENT_STEP: f64 = 1.0 / 170.0;
/// Part of the range of voltages that the tangent of the bias has to leave free at zero control.
const LEAST_ROOM_PART: f64 = 0.05;

impl RotorPlant {
    /// T about a control vector: rotor and actuators linearised about the state there.
    ///
    /// # Errors
    /// The errors of actuator and rotor.
    pub(crate) fn t_about(&self, control_volt: &[f64]) -> Result<TMatrix, PlantError> {
        let state = self.state_measured(control_volt)?;
        let tangents = self.tangents_at(control_volt)?;
        let angles = angles_rad(&state.flaps);
        self.t_of(&self.rotor.loads_along(angles, &state.rotor, each_motion(&tangents))?)
    }

    /// Change of the motion of every flap with its controls, per V.
    fn tangents_at(&self, control_volt: &[f64]) -> Result<Vec<Vec<FlapMotion>>, PlantError> {
        let each = self.voltages(control_volt)?;
        each.par_iter().map(|voltages| self.tangent(voltages)).collect()
    }

    /// Change of the motion of a flap with its controls, per V.
    fn tangent(&self, voltages: &[(usize, Harmonic)]) -> Result<Vec<FlapMotion>, PlantError> {
        let step_volt = TANGENT_STEP * self.drive.range_volt().span_volt();
        answer(&self.tangents, bits(voltages), || self.drive.tangent(voltages, step_volt))
    }

    /// The range of the voltage about a control vector and the motion it makes, with the bias as it moves with the
    /// control. Where its tangent leads out of the range, or there is none, the bias is that of the motion.
    pub(crate) fn voltage_range(
        &self,
        control_volt: &[f64],
        flaps: &[FlapMotion],
    ) -> Result<VoltageRange, PlantError> {
        let range = self.drive.range_volt();
        let mut bias_volt = Vec::with_capacity(flaps.len());
        let mut bias_slope = Vec::with_capacity(control_volt.len());
        let per_flap = 2 * self.layout.harmonics().len();
        let each = self.voltages(control_volt)?;
        for ((flap, voltages), own) in
            flaps.iter().zip(&each).zip(control_volt.chunks_exact(per_flap))
        {
            let bias = flap.voltage_volt.mean;
            let slope: Vec<f64> = self
                .tangent(voltages)
                .map(|tangent| tangent.iter().map(|along| along.voltage_volt.mean).collect())
                .unwrap_or_default();
            let at_zero = bias - slope.iter().zip(own).map(|(s, u)| s * u).sum::<f64>();
            let room = (range.highest_volt() - at_zero).min(at_zero - range.lowest_volt());
            if slope.len() == per_flap && room > LEAST_ROOM_PART * range.span_volt() {
                bias_volt.push(at_zero);
                bias_slope.extend(slope);
            } else {
                bias_volt.push(bias);
                bias_slope.extend(std::iter::repeat_n(0.0, per_flap));
            }
        }
        Ok(VoltageRange {
            range_volt: [range.lowest_volt(), range.highest_volt()],
            bias_volt,
            bias_slope,
            azimuths: LIMIT_AZIMUTHS,
        })
    }

    /// T from the load per V of every control, with the outputs of the power.
    fn t_of(&self, loads: &[[f64; 12]]) -> Result<TMatrix, PlantError> {
        let power = self.power_outputs();
        let column = |(control, loads): (usize, &[f64; 12])| {
            loads.iter().copied().chain(power.along(control)).collect()
        };
        let columns: Vec<Vec<f64>> = loads.iter().enumerate().map(column).collect();
        TMatrix::from_columns(&columns).map_err(PlantError::Bias)
    }

    /// T about a control vector of a rotor that is linear: its derivatives are those about the trim.
    pub(crate) fn t_about_trim(&self, control_volt: &[f64]) -> Result<TMatrix, PlantError> {
        self.t_of_linear_rotor(&self.tangents_at(control_volt)?)
    }

    /// T about zero control of the rotor linearised there, the actuators by central differences of the step that
    /// eq. (8) takes: at rest the tangent of a hysteretic actuator is not what it does at that step.
    ///
    /// # Errors
    /// As [`Self::t_about_trim`].
    pub(crate) fn t_at_rest(&self, step_volt: f64) -> Result<TMatrix, PlantError> {
        let at_rest = self.voltages(&self.layout.zero())?;
        let tangents: Vec<Vec<FlapMotion>> = at_rest
            .par_iter()
            .map(|voltages| self.drive.tangent(voltages, step_volt))
            .collect::<Result<_, _>>()?;
        self.t_of_linear_rotor(&tangents)
    }

    /// T of the rotor linearised about its trim.
    fn t_of_linear_rotor(&self, tangents: &[Vec<FlapMotion>]) -> Result<TMatrix, PlantError> {
        let authority = self.rotor.authority()?;
        let each = each_motion(tangents).map(|(flap, along)| authority.loads(flap, along));
        self.t_of(&each.collect::<Vec<_>>())
    }
}

/// The flap and its motion with every control, deg/V.
fn each_motion(tangents: &[Vec<FlapMotion>]) -> impl Iterator<Item = (usize, &HarmonicSeries)> {
    let flaps = tangents.iter().enumerate();
    flaps.flat_map(|(flap, tangent)| tangent.iter().map(move |along| (flap, &along.flap_deg)))
}

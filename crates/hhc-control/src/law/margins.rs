//! How wrong a constant T may be before the loop diverges.

use crate::{ControlError, ControlLayout, Cost, FeedbackLaw, OperatingPoint, RelaxedStep, TMatrix};
use std::ops::Range;

/// The least error of the true T, one at a time, at which the spectral radius of (C.14) reaches 1 or the loads overshoot; 0 deg
/// and a gain of 1 where they do without one.
#[derive(Debug, Clone, PartialEq)]
pub struct TMargins {
    /// Phase error common to all flaps, deg, the smaller of lag and lead; 180 where none diverges.
    pub common_phase_deg: f64,
    /// Gain of the rotor over that of T, common to all flaps; infinity where none up to 1000 diverges.
    pub common_gain: f64,
    /// Phase error of one flap alone, deg, flap by flap.
    pub flap_phase_deg: Vec<f64>,
    /// Gain of one flap alone over that of T, flap by flap.
    pub flap_gain: Vec<f64>,
    /// Common phase error from which the cost of the loads rises above the uncontrolled one on the way, deg; 180 where
    /// none does.
    pub common_overshoot_deg: f64,
    /// The same of one flap alone, flap by flap.
    pub flap_overshoot_deg: Vec<f64>,
}

/// The least error of one load in the true T, one at a time, at which the spectral radius of (C.14) reaches 1; 0 deg and a gain
/// of 1 where it does without one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoadMargin {
    /// Phase error, deg, the smaller of lag and lead; 180 where none diverges.
    pub phase_deg: f64,
    /// Gain of the load over that in T; infinity where none up to 1000 diverges.
    pub gain: f64,
}

/// Steps of the search for the first crossing; it is then bisected.
const PHASE_STEPS: u32 = 180;
const GAIN_STEPS: u32 = 120;
const LARGEST_GAIN: f64 = 1000.0;
const BISECTIONS: u32 = 30;
const OVERSHOOT_CYCLES: u32 = 40;
const ROUNDING: f64 = 1e-9;

impl FeedbackLaw {
    /// The margins of the T of a law that flies with fixed cycles where another one may be true.
    ///
    /// ```text
    /// | 1 - gain g exp(i phi) | = 1    for a common error with rho = 0:  cos phi = gain/2,  g = 2/gain
    /// ```
    /// | argument | meaning | unit | range |
    /// |---|---|---|---|
    /// | `layout` | of the controls of T | - | |
    /// | `there` | the true T, which the errors turn; [`Self::t`] where the law knows it | 1/V | of the shape of T |
    /// | `step` | weights of control and change, held, and part of the way | 1/V^2, - | as [`RelaxedStep`] |
    /// | `baseline` | loads `Z0` without control | nondimensional | one per row of T |
    ///
    /// With `rho = 0` an error of one flap alone has the same margin of convergence as one of all: `T0^+ T` is the error
    /// itself. What tells them apart is the overshoot, where T is ill-conditioned.
    ///
    /// # Errors
    /// A layout of other controls than T; as [`Self::relaxed_spectral_radius`].
    pub fn margins(
        &self,
        layout: &ControlLayout,
        there: &TMatrix,
        step: RelaxedStep,
        baseline: &[f64],
    ) -> Result<TMargins, ControlError> {
        let controls = layout.len();
        crate::error::check_length("controls of T", self.shape().1, controls)?;
        let turned = |part: Range<usize>, size: &dyn Fn(&TMatrix) -> Result<f64, ControlError>| {
            least_phase_deg(|phase_rad| size(&there.turned_within(part.clone(), 1.0, phase_rad)?))
        };
        let phase = |part| turned(part, &|turned| self.relaxed_spectral_radius(step, turned));
        let overshoot = |part| turned(part, &|turned| self.overshoot(step, turned, baseline));
        let largest = |part: Range<usize>| -> Result<f64, ControlError> {
            least_gain(|stronger| {
                let stronger = there.turned_within(part.clone(), stronger, 0.0)?;
                self.relaxed_spectral_radius(step, &stronger)
            })
        };
        let width = controls / layout.flaps();
        let flaps = || (0..layout.flaps()).map(|flap| flap * width..(flap + 1) * width);
        Ok(TMargins {
            common_phase_deg: phase(0..controls)?,
            common_gain: largest(0..controls)?,
            common_overshoot_deg: overshoot(0..controls)?,
            flap_overshoot_deg: flaps().map(overshoot).collect::<Result<_, _>>()?,
            flap_phase_deg: flaps().map(phase).collect::<Result<_, _>>()?,
            flap_gain: flaps().map(largest).collect::<Result<_, _>>()?,
        })
    }

    /// How wrong the true T may be in one load alone, whose cosine and sine are the rows `2 load` and `2 load + 1`. Arguments as
    /// [`Self::margins`].
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a load that T lacks; as [`Self::relaxed_spectral_radius`].
    pub fn load_margin(
        &self,
        there: &TMatrix,
        step: RelaxedStep,
        load: usize,
    ) -> Result<LoadMargin, ControlError> {
        let radius = |of_load: f64, phase_rad: f64| {
            let turned = there.with_load_turned(load, of_load, phase_rad)?;
            self.relaxed_spectral_radius(step, &turned)
        };
        Ok(LoadMargin {
            phase_deg: least_phase_deg(|phase_rad| radius(1.0, phase_rad))?,
            gain: least_gain(|stronger| radius(stronger, 0.0))?,
        })
    }

    /// Largest cost of the loads in the first cycles from zero control, over that without control; what is above by rounding
    /// is no overshoot.
    fn overshoot(
        &self,
        step: RelaxedStep,
        there: &TMatrix,
        baseline: &[f64],
    ) -> Result<f64, ControlError> {
        let before = Cost::of(baseline, self.load_weights(), &[], 0.0).loads;
        let mut control_volt = vec![0.0; there.controls()];
        let mut largest = 0.0_f64;
        for _ in 0..OVERSHOOT_CYCLES {
            let mut outputs = there.loads_for(&control_volt)?;
            outputs.iter_mut().zip(baseline).for_each(|(output, z0)| *output += z0);
            let at = OperatingPoint { control_volt: &control_volt, outputs: &outputs };
            let aim = self.aim_volt(step, at)?;
            let moves = control_volt.iter_mut().zip(aim);
            moves.for_each(|(here, to)| *here += step.gain * (to - *here));
            let cost = Cost::of(&outputs, self.load_weights(), &[], 0.0).loads;
            largest = largest.max(cost / before);
        }
        Ok(largest - ROUNDING)
    }
}

/// The least phase, deg, lag or lead, at which a radius reaches 1; 180 for none.
fn least_phase_deg(radius: impl Fn(f64) -> Result<f64, ControlError>) -> Result<f64, ControlError> {
    let sided =
        |side: f64| first_crossing(180.0, PHASE_STEPS, |deg| radius(side * deg.to_radians()));
    Ok(sided(1.0)?.min(sided(-1.0)?))
}

/// The least gain of 1 or above at which a radius reaches 1; infinity for none up to the largest.
fn least_gain(radius: impl Fn(f64) -> Result<f64, ControlError>) -> Result<f64, ControlError> {
    let found = first_crossing(LARGEST_GAIN.ln(), GAIN_STEPS, |log| radius(log.exp()))?;
    Ok(if found < LARGEST_GAIN.ln() { found.exp() } else { f64::INFINITY })
}

/// Where a radius first reaches 1 from 0 to `end`; `end` if nowhere.
fn first_crossing(
    end: f64,
    steps: u32,
    radius: impl Fn(f64) -> Result<f64, ControlError>,
) -> Result<f64, ControlError> {
    if radius(0.0)? >= 1.0 {
        return Ok(0.0);
    }
    let step = end / f64::from(steps);
    for k in 1..=steps {
        if radius(step * f64::from(k))? < 1.0 {
            continue;
        }
        let (mut low, mut high) = (step * f64::from(k - 1), step * f64::from(k));
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(low, high);
            *(if radius(middle)? < 1.0 { &mut low } else { &mut high }) = middle;
        }
        return Ok(high);
    }
    Ok(end)
}

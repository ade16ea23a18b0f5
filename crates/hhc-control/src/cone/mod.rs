//! The optimum within limits, as a second-order cone program.

mod polish;
mod program;

use crate::law::{OperatingPoint, Proximal, Quadratic};
use crate::limits::ControlLimits;
use crate::{ControlError, FeedbackLaw, error};
use nalgebra::DVector;
use program::{Cone, Program};

/// How far an optimum is from the conditions of Karush, Kuhn and Tucker, each relative to the size of
/// its terms.
///
/// ```text
/// min x'Px/2 + q'x  subject to  s = b - A x in K:      P x + q + A' z = 0,  s in K,  z in K*,  s'z = 0
/// ```
/// Computed anew from the control vector returned and the multipliers, with no part of the solver; limits without a
/// multiplier are left out.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct KktResidual {
    /// Largest element of `P x + q + A' z`, over the largest of `P` and `q`.
    pub stationarity: f64,
    /// How far `s` leaves its cones; the limits are scaled to 1.
    pub primal: f64,
    /// How far the multipliers leave theirs, scaled as the stationarity.
    pub dual: f64,
    /// `|s' z|`, scaled as the stationarity.
    pub complementarity: f64,
}

impl KktResidual {
    /// The largest of the four.
    pub fn largest(&self) -> f64 {
        self.stationarity.max(self.primal).max(self.dual).max(self.complementarity)
    }
}

/// The best control within limits.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstrainedOptimum {
    /// The control vector, V; it keeps every limit.
    pub control_volt: Vec<f64>,
    /// How exactly it is the optimum.
    pub kkt: KktResidual,
    /// Whether a limit binds; if none does, the optimum is that of eq. (10).
    pub binding: bool,
    /// Iterations of the interior-point method; 0 if no limit binds.
    pub iterations: u32,
}

/// Why the cone program has no answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConeStatus {
    /// The solver refused the problem or its settings.
    Refused,
    /// It stopped short of its accuracy, and the KKT residual is too large.
    Inaccurate,
    /// Voltages beyond the range kept appearing between the azimuths held.
    Azimuths,
}

/// Largest KKT residual accepted.
const LARGEST_KKT: f64 = 1e-6;
/// At first, every so many azimuth samples are held; the others follow where they are exceeded.
const COARSE_STRIDE: usize = 10;
/// Rounds in which exceeded azimuth samples are added.
const AZIMUTH_ROUNDS: usize = 20;
/// Excess of a row that is rounding, as a part of its room.
const ROW_ROUNDING: f64 = 1e-10;

impl FeedbackLaw {
    /// The control of least predicted cost among those that keep the limits.
    ///
    /// ```text
    /// min over u'   | W_Z^(1/2) (Z + T (u' - u)) |^2 + rho |u'|^2     subject to the limits
    /// ```
    /// Solved as a second-order cone program: amplitudes and flap angles are circles, the power is a
    /// rotated cone, the range of the voltage is two rows per azimuth sample. Where no limit binds it
    /// is the optimum of eq. (10) itself.
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `rho` | `rho` | 1/V^2 | >= 0; with more controls than loads above 0, or the optimum is not unique |
    /// | `control_volt` | `u` | V | as measured |
    /// | `hub_loads` | `Z` | nondimensional | measured at `u` |
    ///
    /// # Errors
    /// [`ControlError::ConeProgram`] if the program is not solved to a KKT residual of 1e-6; vectors of
    /// the wrong length.
    ///
    /// Source: S. Boyd, L. Vandenberghe, *Convex Optimization* (2004), section 4.4 and 5.5.3.
    pub fn optimum_within(
        &self,
        rho: f64,
        control_volt: &[f64],
        hub_loads: &[f64],
        limits: &ControlLimits,
    ) -> Result<ConstrainedOptimum, ControlError> {
        error::check_not_negative("control weight rho (1/V^2)", rho)?;
        let target = self.modal_target(OperatingPoint { control_volt, outputs: hub_loads })?;
        self.optimum_near_within(rho, &target, Proximal { weight: 0.0, control_volt }, limits)
    }

    /// The same for a modal target, with a proximal term.
    pub(crate) fn optimum_near_within(
        &self,
        rho: f64,
        target: &DVector<f64>,
        proximal: Proximal<'_>,
        limits: &ControlLimits,
    ) -> Result<ConstrainedOptimum, ControlError> {
        let controls = self.shape().1;
        error::check_length("controls of the limits", limits.layout().len(), controls)?;
        let free = self.optimum_near(rho, target, proximal);
        let volt = limits.typical_volt().unwrap_or_else(|| largest(&free).max(f64::MIN_POSITIVE));
        let Quadratic { hessian, linear } = self.quadratic(rho, target).with(proximal).scaled(volt);
        let mut program = Program { hessian, linear, cones: Vec::new() };
        if limits.usage(&free)? <= 1.0 {
            let point = DVector::from_column_slice(&free) / volt;
            let (kkt, binding, iterations) = (program.kkt(&point, &[]), false, 0);
            return Ok(ConstrainedOptimum { control_volt: free, kkt, binding, iterations });
        }
        program.add_circles(limits, volt);
        program.add_power(limits, volt);
        let rows = limits.voltage_rows();
        let per_flap = rows.len() / limits.layout().flaps();
        let mut held: Vec<bool> = (0..rows.len())
            .map(|k| ((k % per_flap.max(1)) / 2).is_multiple_of(COARSE_STRIDE))
            .collect();
        let mut iterations = 0;
        for _ in 0..AZIMUTH_ROUNDS {
            let mut round = program.clone();
            for (row, room) in rows.iter().zip(&held).filter(|(_, held)| **held).map(|(r, _)| r) {
                let scaled = row.iter().map(|&(column, v)| (column, v * volt / room)).collect();
                round.cones.push(Cone { rows: vec![(scaled, 1.0)] });
            }
            let (x, z, used) = round.solve_best()?;
            iterations += used;
            let control: Vec<f64> = x.iter().map(|v| v * volt).collect();
            let mut is_exceeded = false;
            for ((row, room), held) in rows.iter().zip(&mut held) {
                let value: f64 = row.iter().map(|&(column, v)| v * control[column]).sum();
                if !*held && value > room * (1.0 + ROW_ROUNDING) {
                    (*held, is_exceeded) = (true, true);
                }
            }
            if is_exceeded {
                continue;
            }
            // rounding of the solver, taken back toward zero control, which keeps every limit
            let usage = limits.usage(&control)?.max(1.0);
            let control_volt: Vec<f64> = control.iter().map(|u| u / usage).collect();
            let point = x / usage;
            let kkt = round.kkt(&point, &z).largest();
            if kkt > LARGEST_KKT {
                let status = ConeStatus::Inaccurate;
                return Err(ControlError::ConeProgram { status, iterations, kkt });
            }
            let (kkt, binding) = (round.kkt_of_binding(&point, &z), true);
            return Ok(ConstrainedOptimum { control_volt, kkt, binding, iterations });
        }
        let (status, kkt) = (ConeStatus::Azimuths, f64::NAN);
        Err(ControlError::ConeProgram { status, iterations, kkt })
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| v.abs().max(m))
}

//! The optimum within limits, as a second-order cone program.

mod polish;
mod program;

use crate::law::{Anchor, order_one};
use crate::limits::ControlLimits;
use crate::{ControlError, FeedbackLaw, error};
use nalgebra::{DMatrix, DVector};
use program::{Cone, Kind, Program};

/// How far an optimum is from the conditions of Karush, Kuhn and Tucker, each relative to the size of
/// its terms.
///
/// ```text
/// min x'Px/2 + q'x  subject to  s = b - A x in K:      P x + q + A' z = 0,  s in K,  z in K*,  s'z = 0
/// ```
/// Computed anew from the control vector returned and the multipliers, with no part of the solver.
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

/// What shows that a point is the optimum within limits, as numbers alone: the program, scaled to order 1,
/// with its multipliers. Limits without a multiplier are left out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct KktCertificate {
    /// `P`, row by row.
    pub hessian: Vec<Vec<f64>>,
    /// `q`.
    pub linear: Vec<f64>,
    /// `x`: the control over [`Self::volt`].
    pub point: Vec<f64>,
    /// Voltage that the point is scaled by, V.
    pub volt: f64,
    /// The limits that bind.
    pub cones: Vec<CertifiedCone>,
}

/// One limit of a [`KktCertificate`]: `s = bound - A x`, a single row with `s >= 0` or several with
/// `s_0 >= |(s_1, s_2, ...)|`.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct CertifiedCone {
    /// `A`, row by row.
    pub rows: Vec<Vec<f64>>,
    /// The bound of every row.
    pub bounds: Vec<f64>,
    /// The multiplier of every row.
    pub multipliers: Vec<f64>,
}

impl KktCertificate {
    /// The residuals of the point, formed from the numbers of the certificate alone; numbers that do not fit
    /// together give NaN.
    pub fn residual(&self) -> KktResidual {
        let n = self.point.len();
        let of_size = |rows: &[Vec<f64>]| rows.iter().all(|row| row.len() == n);
        let fits = |cone: &CertifiedCone| {
            let count = cone.rows.len();
            let sizes = cone.bounds.len() == count && cone.multipliers.len() == count;
            sizes && count > 0 && of_size(&cone.rows)
        };
        let square = self.hessian.len() == n && self.linear.len() == n && of_size(&self.hessian);
        if !square || !self.cones.iter().all(fits) {
            let nan = f64::NAN;
            return KktResidual { stationarity: nan, primal: nan, dual: nan, complementarity: nan };
        }
        let cone = |cone: &CertifiedCone| Cone {
            kind: if cone.rows.len() == 1 { Kind::Linear } else { Kind::SecondOrder },
            rows: cone
                .rows
                .iter()
                .zip(&cone.bounds)
                .map(|(row, bound)| (row.iter().copied().enumerate().collect(), *bound))
                .collect(),
        };
        let program = Program {
            hessian: DMatrix::from_fn(n, n, |i, j| self.hessian[i][j]),
            linear: DVector::from_column_slice(&self.linear),
            cones: self.cones.iter().map(cone).collect(),
        };
        let multipliers: Vec<f64> =
            self.cones.iter().flat_map(|cone| cone.multipliers.iter().copied()).collect();
        program.kkt(&DVector::from_column_slice(&self.point), &multipliers)
    }

    /// The control it is about, V.
    pub fn control_volt(&self) -> Vec<f64> {
        self.point.iter().map(|x| x * self.volt).collect()
    }
}

/// The best control within limits.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstrainedOptimum {
    /// The control vector, V; it keeps every limit.
    pub control_volt: Vec<f64>,
    /// How exactly it is the optimum.
    pub kkt: KktResidual,
    /// The numbers that show it.
    pub certificate: KktCertificate,
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
        let target = self.modal_target(control_volt, hub_loads)?;
        let anchor = Anchor { weight: 0.0, control_volt };
        self.optimum_of_target_within(rho, (&target, anchor), limits)
    }

    /// The same for a modal target, held near an anchor.
    pub(crate) fn optimum_of_target_within(
        &self,
        rho: f64,
        (target, anchor): (&DVector<f64>, Anchor<'_>),
        limits: &ControlLimits,
    ) -> Result<ConstrainedOptimum, ControlError> {
        let (found, expected) = (limits.layout().len(), self.shape().1);
        if found != expected {
            return Err(ControlError::Length { what: "controls of the limits", found, expected });
        }
        let free = self.optimum_near(rho, target, anchor);
        let volt = limits.typical_volt().unwrap_or_else(|| largest(&free).max(f64::MIN_POSITIVE));
        let (hessian, linear) = order_one(anchor.added(self.quadratic(rho, target)), volt);
        let mut program = Program { hessian, linear, cones: Vec::new() };
        if limits.usage(&free)? <= 1.0 {
            let point = DVector::from_column_slice(&free) / volt;
            let kkt = program.kkt(&point, &[]);
            return Ok(ConstrainedOptimum {
                control_volt: free,
                kkt,
                certificate: program.certificate(&point, &[], volt),
                binding: false,
                iterations: 0,
            });
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
                round.cones.push(Cone { kind: Kind::Linear, rows: vec![(scaled, 1.0)] });
            }
            let (x, z, used) = round.solve_best()?;
            iterations += used;
            let control: Vec<f64> = x.iter().map(|v| v * volt).collect();
            let exceeded: Vec<usize> = rows
                .iter()
                .enumerate()
                .filter(|(k, (row, room))| {
                    let value: f64 = row.iter().map(|&(column, v)| v * control[column]).sum();
                    !held[*k] && value > room * (1.0 + ROW_ROUNDING)
                })
                .map(|(k, _)| k)
                .collect();
            if !exceeded.is_empty() {
                for k in exceeded {
                    held[k] = true;
                }
                continue;
            }
            // rounding of the solver, taken back toward zero control, which keeps every limit
            let usage = limits.usage(&control)?.max(1.0);
            let control_volt: Vec<f64> = control.iter().map(|u| u / usage).collect();
            let point = x / usage;
            let kkt = round.kkt(&point, &z);
            let certificate = round.certificate(&point, &z, volt);
            if kkt.largest() > LARGEST_KKT {
                let (status, kkt) = (ConeStatus::Inaccurate, kkt.largest());
                return Err(ControlError::ConeProgram { status, iterations, kkt });
            }
            return Ok(ConstrainedOptimum {
                control_volt,
                kkt,
                certificate,
                binding: true,
                iterations,
            });
        }
        let (status, kkt) = (ConeStatus::Azimuths, f64::NAN);
        Err(ControlError::ConeProgram { status, iterations, kkt })
    }
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| v.abs().max(m))
}

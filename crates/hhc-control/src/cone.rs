//! The optimum within limits, as a second-order cone program.

use crate::law::{Anchor, order_one};
use crate::limits::ControlLimits;
use crate::{ControlError, FeedbackLaw, error};
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT,
    SolverStatus, SupportedConeT,
};
use nalgebra::{DMatrix, DVector};

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

/// Accuracy asked of the interior-point method.
const SOLVER_TOLERANCE: f64 = 1e-12;
/// KKT residual below which no other regularisation of the linear systems is tried.
const GOOD_KKT: f64 = 1e-9;
/// KKT residual with which the usual regularisations are enough, and how many these are.
const FAIR_KKT: f64 = 1e-7;
const USUAL: usize = 4;
/// Regularisations tried, the solver's own first, each with the scaling of rows and columns or without.
const REGULARISATIONS: [(f64, bool); 10] = [
    (1e-8, true),
    (1e-11, true),
    (1e-6, true),
    (1e-13, true),
    (1e-8, false),
    (1e-10, false),
    (1e-12, false),
    (1e-9, true),
    (1e-7, true),
    (1e-7, false),
];
/// Refinements of a linear solution.
const REFINEMENTS: u32 = 50;
/// Accuracy of a linear solution.
const REFINED_TO: f64 = 1e-14;
/// Largest KKT residual accepted.
const LARGEST_KKT: f64 = 1e-6;
/// At first, every so many azimuth samples are held; the others follow where they are exceeded.
const COARSE_STRIDE: usize = 10;
/// Rounds in which exceeded azimuth samples are added.
const AZIMUTH_ROUNDS: usize = 20;
/// Excess of a row that is rounding, as a part of its room.
const ROW_ROUNDING: f64 = 1e-10;
/// Largest multiplier of a limit that does not bind, scaled as the stationarity.
const NO_MULTIPLIER: f64 = 1e-13;

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

/// What a cone is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// `s >= 0`, one row.
    Linear,
    /// `s_0 >= |(s_1, s_2, ...)|`.
    SecondOrder,
}

/// One cone: `s = bound - row x` by row, each row sparse.
#[derive(Debug, Clone)]
struct Cone {
    kind: Kind,
    rows: Vec<(Vec<(usize, f64)>, f64)>,
}

impl Cone {
    /// The slack at a point.
    fn slack(&self, x: &DVector<f64>) -> Vec<f64> {
        let along =
            |row: &[(usize, f64)]| -> f64 { row.iter().map(|&(column, a)| a * x[column]).sum() };
        self.rows.iter().map(|(row, bound)| bound - along(row)).collect()
    }

    /// How far a vector lies outside the cone, which is its own dual.
    fn outside(&self, s: &[f64]) -> f64 {
        let rest = s[1..].iter().map(|v| v * v).sum::<f64>().sqrt();
        match self.kind {
            Kind::Linear => (-s[0]).max(0.0),
            Kind::SecondOrder => (rest - s[0]).max(0.0),
        }
    }
}

/// `min x' P x / 2 + q' x` subject to cones; `x` is the control over a typical voltage.
#[derive(Debug, Clone)]
struct Program {
    hessian: DMatrix<f64>,
    linear: DVector<f64>,
    cones: Vec<Cone>,
}

impl Program {
    fn add_circles(&mut self, limits: &ControlLimits, volt: f64) {
        for (pair, &amplitude) in limits.amplitudes_volt().iter().enumerate() {
            if amplitude.is_finite() {
                let share = volt / amplitude;
                self.add_circle(pair, [[share, 0.0], [0.0, share]]);
            }
        }
        for (pair, circle) in limits.flap_circles().iter().enumerate() {
            if let Some(circle) = circle {
                let share = volt / circle.limit_deg;
                self.add_circle(pair, circle.gain_deg_per_volt.map(|row| row.map(|g| g * share)));
            }
        }
    }

    /// `|gain [x_c, x_s]'| <= 1`.
    fn add_circle(&mut self, pair: usize, gain: [[f64; 2]; 2]) {
        let mut rows = vec![(Vec::new(), 1.0)];
        rows.extend(gain.map(|[c, s]| (vec![(2 * pair, -c), (2 * pair + 1, -s)], 0.0)));
        self.cones.push(Cone { kind: Kind::SecondOrder, rows });
    }

    /// `u' P u / room <= t = 1 - p' u / room` as `|(2 F u / sqrt(room), 1 - t)| <= 1 + t`.
    fn add_power(&mut self, limits: &ControlLimits, volt: f64) {
        let Some((power, root)) = limits.power() else { return };
        let room = power.limit - power.constant;
        let linear: Vec<(usize, f64)> =
            power.linear.iter().map(|p| p * volt / room).enumerate().collect();
        let opposite = linear.iter().map(|&(column, p)| (column, -p)).collect();
        let mut rows = vec![(linear, 2.0)];
        let factor = -2.0 * volt / room.sqrt();
        rows.extend(
            root.row_iter().map(|row| (row.iter().map(|f| factor * f).enumerate().collect(), 0.0)),
        );
        rows.push((opposite, 0.0));
        self.cones.push(Cone { kind: Kind::SecondOrder, rows });
    }

    /// [`Self::solve`] with one regularisation after the other, until the conditions hold as they should: the
    /// best of them.
    fn solve_best(&self) -> Result<(DVector<f64>, Vec<f64>, u32), ControlError> {
        let mut best: Option<(f64, DVector<f64>, Vec<f64>)> = None;
        let mut failure = None;
        let mut iterations = 0;
        for (tried, regularisation) in REGULARISATIONS.into_iter().enumerate() {
            let fair = best.as_ref().is_some_and(|(least, ..)| *least <= FAIR_KKT);
            if tried >= USUAL && fair {
                break;
            }
            match self.solve(regularisation) {
                Ok((x, z, used)) => {
                    iterations += used;
                    let kkt = self.kkt(&x, &z).largest();
                    if best.as_ref().is_none_or(|(least, ..)| kkt < *least) {
                        best = Some((kkt, x, z));
                    }
                    if kkt <= GOOD_KKT {
                        break;
                    }
                }
                Err(error) => failure = failure.or(Some(error)),
            }
        }
        match (best, failure) {
            (Some((_, x, z)), _) => Ok((x, z, iterations)),
            (None, Some(error)) => Err(error),
            (None, None) => {
                let (status, kkt) = (ConeStatus::Refused, f64::NAN);
                Err(ControlError::ConeProgram { status, iterations, kkt })
            }
        }
    }

    /// Minimum, multipliers by row, iterations.
    fn solve(
        &self,
        (regularisation, is_scaled): (f64, bool),
    ) -> Result<(DVector<f64>, Vec<f64>, u32), ControlError> {
        let n = self.linear.len();
        let refused = |status| ControlError::ConeProgram { status, iterations: 0, kkt: f64::NAN };
        let upper: Vec<(usize, usize, f64)> = (0..n)
            .flat_map(|column| (0..=column).map(move |row| (row, column)))
            .map(|(row, column)| (row, column, self.hessian[(row, column)]))
            .collect();
        let hessian = sparse(n, n, &upper);
        let rows: Vec<_> = self.cones.iter().flat_map(|cone| &cone.rows).collect();
        let entries: Vec<(usize, usize, f64)> = rows
            .iter()
            .enumerate()
            .flat_map(|(k, (row, _))| row.iter().map(move |&(column, a)| (k, column, a)))
            .collect();
        let matrix = sparse(rows.len(), n, &entries);
        let bounds: Vec<f64> = rows.iter().map(|(_, bound)| *bound).collect();
        let cones: Vec<SupportedConeT<f64>> = self
            .cones
            .iter()
            .map(|cone| match cone.kind {
                Kind::Linear => NonnegativeConeT(1),
                Kind::SecondOrder => SecondOrderConeT(cone.rows.len()),
            })
            .collect();
        let settings = DefaultSettingsBuilder::default()
            .verbose(false)
            .tol_gap_abs(SOLVER_TOLERANCE)
            .tol_gap_rel(SOLVER_TOLERANCE)
            .tol_feas(SOLVER_TOLERANCE)
            .tol_ktratio(SOLVER_TOLERANCE)
            .static_regularization_constant(regularisation)
            .equilibrate_enable(is_scaled)
            .iterative_refinement_max_iter(REFINEMENTS)
            .iterative_refinement_reltol(REFINED_TO)
            .iterative_refinement_abstol(REFINED_TO)
            .build()
            .map_err(|_| refused(ConeStatus::Refused))?;
        let linear: Vec<f64> = self.linear.iter().copied().collect();
        let mut solver = DefaultSolver::new(&hessian, &linear, &matrix, &bounds, &cones, settings)
            .map_err(|_| refused(ConeStatus::Refused))?;
        solver.solve();
        let found = solver.solution;
        match found.status {
            // an early stop is judged by the KKT residual
            SolverStatus::Solved
            | SolverStatus::AlmostSolved
            | SolverStatus::InsufficientProgress
            | SolverStatus::MaxIterations => {
                Ok((DVector::from_vec(found.x), found.z, found.iterations))
            }
            _ => Err(refused(ConeStatus::Inaccurate)),
        }
    }

    /// The numbers that show a point to be the optimum.
    fn certificate(&self, x: &DVector<f64>, z: &[f64], volt: f64) -> KktCertificate {
        let n = self.linear.len();
        let mut cones = Vec::new();
        let mut at = 0;
        for cone in &self.cones {
            let Some(multipliers) = z.get(at..at + cone.rows.len()) else { break };
            at += multipliers.len();
            if largest(multipliers) <= NO_MULTIPLIER {
                continue;
            }
            let dense = |row: &[(usize, f64)]| {
                let mut values = vec![0.0; n];
                for &(column, value) in row {
                    values[column] += value;
                }
                values
            };
            cones.push(CertifiedCone {
                rows: cone.rows.iter().map(|(row, _)| dense(row)).collect(),
                bounds: cone.rows.iter().map(|(_, bound)| *bound).collect(),
                multipliers: multipliers.to_vec(),
            });
        }
        KktCertificate {
            hessian: self.hessian.row_iter().map(|row| row.iter().copied().collect()).collect(),
            linear: self.linear.iter().copied().collect(),
            point: x.iter().copied().collect(),
            volt,
            cones,
        }
    }

    /// The KKT conditions at a point; without multipliers, those of no cone.
    fn kkt(&self, x: &DVector<f64>, z: &[f64]) -> KktResidual {
        let mut gradient = &self.hessian * x + &self.linear;
        let mut residual = KktResidual::default();
        let mut product = 0.0;
        let mut at = 0;
        for cone in &self.cones {
            let slack = cone.slack(x);
            residual.primal = residual.primal.max(cone.outside(&slack));
            let Some(z) = z.get(at..at + slack.len()) else { break };
            at += slack.len();
            residual.dual = residual.dual.max(cone.outside(z));
            product += slack.iter().zip(z).map(|(s, z)| s * z).sum::<f64>();
            for ((row, _), multiplier) in cone.rows.iter().zip(z) {
                for &(column, a) in row {
                    gradient[column] += a * multiplier;
                }
            }
        }
        residual.stationarity = gradient.amax();
        residual.complementarity = product.abs();
        residual
    }
}

/// A sparse matrix from `(row, column, value)` with rows ascending inside a column.
fn sparse(rows: usize, columns: usize, entries: &[(usize, usize, f64)]) -> CscMatrix<f64> {
    let mut starts = vec![0];
    let (mut row_numbers, mut values) = (Vec::new(), Vec::new());
    let mut by_column: Vec<Vec<(usize, f64)>> = vec![Vec::new(); columns];
    for &(row, column, value) in entries {
        by_column[column].push((row, value));
    }
    for column in by_column {
        for (row, value) in column {
            row_numbers.push(row);
            values.push(value);
        }
        starts.push(row_numbers.len());
    }
    CscMatrix::new(rows, columns, starts, row_numbers, values)
}

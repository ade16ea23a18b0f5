//! The second-order cone program and its interior-point solver.

use super::{ConeStatus, KktResidual, largest};
use crate::ControlError;
use crate::limits::ControlLimits;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SecondOrderConeT,
    SolverStatus, SupportedConeT,
};
use nalgebra::{DMatrix, DVector};

/// Accuracy asked of the interior-point method.
const SOLVER_TOLERANCE: f64 = 1e-12;
/// KKT residual below which no other regularisation of the linear systems is tried.
pub(super) const GOOD_KKT: f64 = 1e-9;
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
/// Largest multiplier of a limit that does not bind, scaled as the stationarity.
pub(super) const NO_MULTIPLIER: f64 = 1e-13;

pub(super) fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// One cone: `s_0 >= |(s_1, s_2, ...)|` with `s = bound - row x` by row, each row sparse; of one row, `s_0 >= 0`.
#[derive(Debug, Clone)]
pub(super) struct Cone {
    pub(super) rows: Vec<(Vec<(usize, f64)>, f64)>,
}

impl Cone {
    /// The slack at a point.
    pub(super) fn slack(&self, x: &DVector<f64>) -> Vec<f64> {
        let along =
            |row: &[(usize, f64)]| -> f64 { row.iter().map(|&(column, a)| a * x[column]).sum() };
        self.rows.iter().map(|(row, bound)| bound - along(row)).collect()
    }
}

/// How far a vector lies outside a cone, which is its own dual.
fn outside(s: &[f64]) -> f64 {
    (norm(&s[1..]) - s[0]).max(0.0)
}

/// `min x' P x / 2 + q' x` subject to cones; `x` is the control over a typical voltage.
#[derive(Debug, Clone)]
pub(super) struct Program {
    pub(super) hessian: DMatrix<f64>,
    pub(super) linear: DVector<f64>,
    pub(super) cones: Vec<Cone>,
}

impl Program {
    pub(super) fn add_circles(&mut self, limits: &ControlLimits, volt: f64) {
        for (pair, &amplitude) in limits.amplitude_volt.iter().enumerate() {
            if amplitude.is_finite() {
                let share = volt / amplitude;
                self.add_circle(pair, [[share, 0.0], [0.0, share]]);
            }
        }
        for (pair, circle) in limits.flaps.iter().enumerate() {
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
        self.cones.push(Cone { rows });
    }

    /// `u' P u / room <= t = 1 - p' u / room` as `|(2 F u / sqrt(room), 1 - t)| <= 1 + t`.
    pub(super) fn add_power(&mut self, limits: &ControlLimits, volt: f64) {
        let Some((power, root)) = &limits.power else { return };
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
        self.cones.push(Cone { rows });
    }

    /// [`Self::solve`] with one regularisation after the other, until the conditions hold as they should: the
    /// best of them.
    pub(super) fn solve_best(&self) -> Result<(DVector<f64>, Vec<f64>, u32), ControlError> {
        let mut best: Option<(f64, DVector<f64>, Vec<f64>)> = None;
        let mut failure = None;
        let mut iterations = 0;
        for (tried, (regularisation, is_scaled)) in REGULARISATIONS.into_iter().enumerate() {
            let fair = best.as_ref().is_some_and(|(least, ..)| *least <= FAIR_KKT);
            if tried >= USUAL && fair {
                break;
            }
            match self.solve(regularisation, is_scaled) {
                Ok((x, z, used)) => {
                    iterations += used;
                    let (x, z) = self.polished(x, z);
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
        let (status, kkt) = (ConeStatus::Refused, f64::NAN);
        let refused = ControlError::ConeProgram { status, iterations, kkt };
        best.map(|(_, x, z)| (x, z, iterations)).ok_or_else(|| failure.unwrap_or(refused))
    }

    /// Minimum, multipliers by row, iterations.
    fn solve(
        &self,
        regularisation: f64,
        is_scaled: bool,
    ) -> Result<(DVector<f64>, Vec<f64>, u32), ControlError> {
        let n = self.linear.len();
        let refused = |status| ControlError::ConeProgram { status, iterations: 0, kkt: f64::NAN };
        let upper = (0..n).flat_map(|column| (0..=column).map(move |row| (row, column)));
        let hessian = sparse(n, n, upper.map(|(i, j)| (i, j, self.hessian[(i, j)])));
        let rows: Vec<_> = self.cones.iter().flat_map(|cone| &cone.rows).collect();
        let entries = rows.iter().enumerate();
        let entries =
            entries.flat_map(|(k, (row, _))| row.iter().map(move |&(column, a)| (k, column, a)));
        let matrix = sparse(rows.len(), n, entries);
        let bounds: Vec<f64> = rows.iter().map(|(_, bound)| *bound).collect();
        let cones: Vec<SupportedConeT<f64>> = self
            .cones
            .iter()
            .map(|cone| match cone.rows.len() {
                1 => NonnegativeConeT(1),
                rows => SecondOrderConeT(rows),
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

    /// [`Self::kkt`] of the cones with a multiplier alone.
    pub(super) fn kkt_of_binding(&self, x: &DVector<f64>, z: &[f64]) -> KktResidual {
        let mut binding = Self { cones: Vec::new(), ..self.clone() };
        let mut multipliers = Vec::new();
        let mut at = 0;
        for cone in &self.cones {
            let own = &z[at..at + cone.rows.len()];
            at += own.len();
            if largest(own) > NO_MULTIPLIER {
                binding.cones.push(cone.clone());
                multipliers.extend(own);
            }
        }
        binding.kkt(x, &multipliers)
    }

    /// The KKT conditions at a point; without multipliers, those of no cone.
    pub(super) fn kkt(&self, x: &DVector<f64>, z: &[f64]) -> KktResidual {
        let mut gradient = &self.hessian * x + &self.linear;
        let mut residual = KktResidual::default();
        let mut product = 0.0;
        let mut at = 0;
        for cone in &self.cones {
            let slack = cone.slack(x);
            residual.primal = residual.primal.max(outside(&slack));
            let Some(z) = z.get(at..at + slack.len()) else { break };
            at += slack.len();
            residual.dual = residual.dual.max(outside(z));
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

/// A sparse matrix from `(row, column, value)`.
fn sparse(
    rows: usize,
    columns: usize,
    entries: impl Iterator<Item = (usize, usize, f64)>,
) -> CscMatrix<f64> {
    let (places, values): (Vec<_>, Vec<_>) = entries.map(|(i, j, v)| ((i, j), v)).unzip();
    let (i, j) = places.into_iter().unzip();
    CscMatrix::new_from_triplets(rows, columns, i, j, values)
}

//! Linearly constrained least squares by clarabel.

use crate::PreisachError;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};

/// How the quadratic programming solver ended, if not with a solution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum QpStatus {
    /// It refused the problem or its settings.
    Refused,
    /// The constraints contradict each other.
    Infeasible,
    /// The minimum is at minus infinity.
    Unbounded,
    /// It stopped at a reduced accuracy.
    ReducedAccuracy,
    /// It ran out of iterations or time.
    Limit,
    /// It broke down numerically or stopped making progress.
    Breakdown,
}

/// A sparse row: unknown and coefficient.
pub(super) type Row = Vec<(usize, f64)>;

/// `min sum_i w_i (a_i x - b_i)^2` subject to `c_k x >= d_k` and `e_k x = 0`.
#[derive(Debug, Clone)]
pub(super) struct LeastSquaresProgram {
    unknowns: usize,
    /// Upper triangle of `sum w a a'`, column by column.
    normal: Vec<f64>,
    right: Vec<f64>,
    lower_bounds: Vec<(Row, f64)>,
    equalities: Vec<Row>,
}

/// Place of `(row, column)`, `row <= column`, in a packed upper triangle.
fn packed(row: usize, column: usize) -> usize {
    column * (column + 1) / 2 + row
}

impl LeastSquaresProgram {
    pub(super) fn new(unknowns: usize) -> Self {
        Self {
            unknowns,
            normal: vec![0.0; unknowns * (unknowns + 1) / 2],
            right: vec![0.0; unknowns],
            lower_bounds: Vec::new(),
            equalities: Vec::new(),
        }
    }

    /// Adds `weight (row x - target)^2`. Columns of `row` ascend.
    pub(super) fn add(&mut self, row: &[(usize, f64)], target: f64, weight: f64) {
        for (i, &(column, b)) in row.iter().enumerate() {
            let scaled = weight * b;
            for &(r, a) in &row[..=i] {
                self.normal[packed(r, column)] += scaled * a;
            }
            self.right[column] += scaled * target;
        }
    }

    /// Demands `row x >= bound`.
    pub(super) fn at_least(&mut self, row: Row, bound: f64) {
        self.lower_bounds.push((row, bound));
    }

    /// Demands `row x = 0`.
    pub(super) fn equal_zero(&mut self, row: Row) {
        self.equalities.push(row);
    }

    /// The minimiser. Any end but a full solution is an error.
    ///
    /// Rows must have been weighted so that their weights sum to about one: unscaled normal
    /// equations made the solver stop far from the minimum.
    pub(super) fn solve(&self, stage: &'static str) -> Result<Vec<f64>, PreisachError> {
        let n = self.unknowns;
        let (mut column_starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in 0..n {
            for row in 0..=column {
                let value = self.normal[packed(row, column)];
                if value != 0.0 || row == column {
                    rows.push(row);
                    values.push(value);
                }
            }
            column_starts.push(rows.len());
        }
        let hessian = CscMatrix::new(n, n, column_starts, rows, values);
        let linear: Vec<f64> = self.right.iter().map(|v| -v).collect();

        let constraints = self.equalities.len() + self.lower_bounds.len();
        let mut by_column: Vec<Vec<(usize, f64)>> = vec![Vec::new(); n];
        let mut bounds = vec![0.0; self.equalities.len()];
        for (k, row) in self.equalities.iter().enumerate() {
            for &(column, a) in row {
                by_column[column].push((k, a));
            }
        }
        for (k, (row, bound)) in self.lower_bounds.iter().enumerate() {
            let k = k + self.equalities.len();
            for &(column, a) in row {
                by_column[column].push((k, -a));
            }
            bounds.push(-bound);
        }
        let (mut column_starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in by_column {
            for (row, value) in column {
                rows.push(row);
                values.push(value);
            }
            column_starts.push(rows.len());
        }
        let matrix = CscMatrix::new(constraints, n, column_starts, rows, values);
        let cones = [
            ZeroConeT(self.equalities.len()),
            NonnegativeConeT(self.lower_bounds.len()),
        ];

        let refused = PreisachError::QuadraticProgram {
            stage,
            status: QpStatus::Refused,
            iterations: 0,
            primal_residual: f64::NAN,
        };
        let Ok(settings) = DefaultSettingsBuilder::default().verbose(false).build() else {
            return Err(refused);
        };
        let Ok(mut solver) =
            DefaultSolver::new(&hessian, &linear, &matrix, &bounds, &cones, settings)
        else {
            return Err(refused);
        };
        solver.solve();
        let solution = solver.solution;
        let status = match solution.status {
            SolverStatus::Solved => return Ok(solution.x),
            SolverStatus::PrimalInfeasible | SolverStatus::AlmostPrimalInfeasible => {
                QpStatus::Infeasible
            }
            SolverStatus::DualInfeasible | SolverStatus::AlmostDualInfeasible => {
                QpStatus::Unbounded
            }
            SolverStatus::AlmostSolved => QpStatus::ReducedAccuracy,
            SolverStatus::MaxIterations | SolverStatus::MaxTime => QpStatus::Limit,
            _ => QpStatus::Breakdown,
        };
        Err(PreisachError::QuadraticProgram {
            stage,
            status,
            iterations: solution.iterations,
            primal_residual: solution.r_prim,
        })
    }
}

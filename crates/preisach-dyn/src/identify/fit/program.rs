//! Linearly constrained least squares by clarabel.

use crate::PreisachError;
use crate::check::largest_above;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{
    DefaultSettingsBuilder, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT,
};
use nalgebra::DMatrix;

/// Residuals and gap below which a program that stopped early is solved. The weights of the rows sum to one: such a gap is
/// 0.1 % of their rms.
const ALMOST_RESIDUAL: f64 = 1e-7;
const ALMOST_GAP: f64 = 1e-6;
/// Gap of a full solution.
const GAP: f64 = 1e-8;
/// The same where smoothness of little weight says much of the solution: what it weighs is to be far above the gap.
pub(crate) const FINE_GAP: f64 = 1e-10;

/// A sparse row: unknown and coefficient.
pub(crate) type Row = Vec<(usize, f64)>;

/// Ranges of the targets that their middle may be from zero before it counts as an offset.
const SMALL_OFFSET: f64 = 2.0;

/// The offset of targets between two extremes that is taken off before a fit and given back to its
/// constant: their middle, if it is far from zero.
///
/// The solver ends at a tolerance relative to what is squared: of a displacement read from a metre away it
/// would leave most of the motion unexplained. Targets near zero stay as they are.
pub(crate) fn offset([low, high]: [f64; 2]) -> f64 {
    let middle = 0.5 * (low + high);
    let is_far = middle.abs() > SMALL_OFFSET * (high - low);
    if is_far && middle.is_finite() { middle } else { 0.0 }
}

/// `min sum_i w_i (a_i x - b_i)^2` subject to `c_k x >= d_k` and `e_k x = 0`.
#[derive(Debug, Clone)]
pub(crate) struct LeastSquaresProgram {
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
    pub(crate) fn new(unknowns: usize) -> Self {
        Self {
            unknowns,
            normal: vec![0.0; unknowns * (unknowns + 1) / 2],
            right: vec![0.0; unknowns],
            lower_bounds: Vec::new(),
            equalities: Vec::new(),
        }
    }

    /// Adds `weight (row x - target)^2`. Columns of `row` ascend.
    pub(crate) fn add(&mut self, row: &[(usize, f64)], target: f64, weight: f64) {
        for (i, &(column, b)) in row.iter().enumerate() {
            let scaled = weight * b;
            for &(r, a) in &row[..=i] {
                self.normal[packed(r, column)] += scaled * a;
            }
            self.right[column] += scaled * target;
        }
    }

    /// Gives a row that was added with target zero its target.
    pub(crate) fn aim(&mut self, row: &[(usize, f64)], target: f64, weight: f64) {
        for &(column, a) in row {
            self.right[column] += weight * a * target;
        }
    }

    /// `sum w a a'` of the rows added so far.
    pub(crate) fn normal_matrix(&self) -> DMatrix<f64> {
        let at = |i: usize, j: usize| self.normal[packed(i.min(j), i.max(j))];
        DMatrix::from_fn(self.unknowns, self.unknowns, at)
    }

    /// `sum w a b` of the rows added so far.
    pub(crate) fn right(&self) -> &[f64] {
        &self.right
    }

    /// Numbers kept: the normal equations.
    pub(crate) fn kept_numbers(&self) -> usize {
        self.normal.len() + self.right.len()
    }

    /// Counts all targets added so far from their weighted mean in a unit, so that the solver's tolerances are shares of
    /// what they spread over. Gives the mean. Every row so far is to have unknown 0 with coefficient 1.
    pub(crate) fn count_targets_in(&mut self, unit: f64) -> f64 {
        let mean = self.right[0] / self.normal[packed(0, 0)];
        for (column, value) in self.right.iter_mut().enumerate() {
            *value = (*value - mean * self.normal[packed(0, column)]) / unit;
        }
        mean
    }

    /// Multiplies the weights of all rows added so far.
    pub(crate) fn scale(&mut self, factor: f64) {
        self.normal.iter_mut().chain(&mut self.right).for_each(|value| *value *= factor);
    }

    /// The number of directions of the unknowns that the rows added so far determine: the rank of
    /// their normal matrix by Cholesky's method with pivoting, down to `relative` of the largest
    /// pivot. Counted up to `most`.
    pub(crate) fn rank(&self, relative: f64, most: usize) -> usize {
        let n = self.unknowns;
        let at = |a: &[f64], r: usize, c: usize| a[packed(r.min(c), r.max(c))];
        let mut rest: Vec<f64> = (0..n).map(|i| self.normal[packed(i, i)]).collect();
        let largest = rest.iter().copied().fold(0.0, f64::max);
        let mut columns: Vec<Vec<f64>> = Vec::new();
        while columns.len() < n.min(most) {
            let (pivot, value) = largest_above(0.0, rest.iter().copied());
            if value <= relative * largest {
                break;
            }
            let root = value.sqrt();
            let mut column: Vec<f64> = (0..n).map(|i| at(&self.normal, i, pivot)).collect();
            for earlier in &columns {
                let factor = earlier[pivot];
                for (c, e) in column.iter_mut().zip(earlier) {
                    *c -= factor * e;
                }
            }
            for (left, c) in rest.iter_mut().zip(&mut column) {
                *c /= root;
                *left -= *c * *c;
            }
            rest[pivot] = 0.0;
            columns.push(column);
        }
        columns.len()
    }

    /// Demands `row x >= bound`.
    pub(crate) fn at_least(&mut self, row: Row, bound: f64) {
        self.lower_bounds.push((row, bound));
    }

    /// Demands `row x = 0`.
    pub(crate) fn equal_zero(&mut self, row: Row) {
        self.equalities.push(row);
    }

    /// The minimiser, to a gap of [`GAP`]. Any end but a full solution is an error, unless it is nearly there.
    ///
    /// Rows must have been weighted so that their weights sum to about one: unscaled normal
    /// equations made the solver stop far from the minimum.
    pub(crate) fn solve(&self, stage: &'static str) -> Result<Vec<f64>, PreisachError> {
        self.solve_to(GAP, stage)
    }

    /// As [`Self::solve`], to another gap.
    pub(crate) fn solve_to(
        &self,
        gap: f64,
        stage: &'static str,
    ) -> Result<Vec<f64>, PreisachError> {
        let n = self.unknowns;
        let column = |column: usize| -> Row {
            let entries = (0..=column).map(|row| (row, self.normal[packed(row, column)]));
            entries.filter(|&(row, value)| value != 0.0 || row == column).collect()
        };
        let hessian = from_columns(n, (0..n).map(column).collect());
        let linear: Vec<f64> = self.right.iter().map(|v| -v).collect();

        let equal = self.equalities.iter().map(|row| (row, 1.0, 0.0));
        let bounded = self.lower_bounds.iter().map(|(row, bound)| (row, -1.0, -bound));
        let mut columns: Vec<Row> = vec![Row::new(); n];
        let mut bounds = Vec::new();
        for (k, (row, sign, bound)) in equal.chain(bounded).enumerate() {
            for &(column, a) in row {
                columns[column].push((k, sign * a));
            }
            bounds.push(bound);
        }
        let matrix = from_columns(bounds.len(), columns);
        let cones = [ZeroConeT(self.equalities.len()), NonnegativeConeT(self.lower_bounds.len())];

        let failed = |status: String, iterations: u32, primal_residual: f64| {
            PreisachError::QuadraticProgram { stage, status, iterations, primal_residual }
        };
        let refused = failed("Refused".into(), 0, f64::NAN);
        let mut settings = DefaultSettingsBuilder::default();
        settings.verbose(false).tol_gap_abs(gap).tol_gap_rel(gap);
        let Ok(settings) = settings.build() else {
            return Err(refused);
        };
        let Ok(mut solver) =
            DefaultSolver::new(&hessian, &linear, &matrix, &bounds, &cones, settings)
        else {
            return Err(refused);
        };
        solver.solve();
        let solution = solver.solution;
        let gap = (solution.obj_val - solution.obj_val_dual).abs();
        let residual = solution.r_prim.max(solution.r_dual);
        let is_near = residual <= ALMOST_RESIDUAL && gap <= ALMOST_GAP;
        match solution.status {
            SolverStatus::Solved => Ok(solution.x),
            SolverStatus::AlmostSolved if is_near => Ok(solution.x),
            status => Err(failed(format!("{status:?}"), solution.iterations, solution.r_prim)),
        }
    }
}

/// A matrix from its columns, each with its rows ascending.
fn from_columns(rows: usize, columns: Vec<Row>) -> CscMatrix {
    let mut starts = vec![0];
    starts.extend(columns.iter().scan(0, |end, column| {
        *end += column.len();
        Some(*end)
    }));
    let count = columns.len();
    let (places, values) = columns.into_iter().flatten().unzip();
    CscMatrix::new(rows, count, starts, places, values)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn an_offset_is_the_middle_of_targets_far_from_zero() {
        for (low, high, expected) in [
            (-20.0, 480.0, 0.0),
            (0.0, 500.0, 0.0),
            (100_000.0, 100_500.0, 100_250.0),
            (-3.25, -3.0, -3.125),
            (f64::INFINITY, f64::NEG_INFINITY, 0.0),
        ] {
            assert_abs_diff_eq!(offset([low, high]), expected, epsilon = 1e-12);
        }
    }

    /// A line through three points, `x0 + x1 t`.
    fn line() -> LeastSquaresProgram {
        let mut program = LeastSquaresProgram::new(2);
        for (t, y) in [(0.0, 1.0), (1.0, 0.0), (2.0, -1.5)] {
            program.add(&[(0, 1.0), (1, t)], y, 1.0 / 3.0);
        }
        program
    }

    #[test]
    fn without_constraints_it_is_least_squares() {
        // normal equations by hand: slope -5/4, intercept 13/12
        let x = line().solve("test").unwrap();
        assert_abs_diff_eq!(x[0], 13.0 / 12.0, epsilon = 1e-7);
        assert_abs_diff_eq!(x[1], -1.25, epsilon = 1e-7);
    }

    #[test]
    fn the_rank_counts_what_the_rows_determine() {
        assert_eq!(line().rank(1e-9, 3), 2);
        let mut program = LeastSquaresProgram::new(4);
        for (a, b) in [(1.0, 2.0), (0.5, -1.0), (3.0, 0.1)] {
            // x0 and x1 only in the combination x0 + 2 x1; x3 never
            program.add(&[(0, a), (1, 2.0 * a), (2, b)], 0.0, 1.0);
        }
        assert_eq!(program.rank(1e-9, 3), 2);
        assert_eq!(LeastSquaresProgram::new(3).rank(1e-9, 3), 0);
    }

    #[test]
    fn bounds_and_equalities_hold() {
        let mut program = line();
        program.at_least(vec![(1, 1.0)], -1.0);
        let x = program.solve("test").unwrap();
        // slope at its bound, intercept = mean of y + t
        assert_abs_diff_eq!(x[1], -1.0, epsilon = 1e-7);
        assert_abs_diff_eq!(x[0], 2.5 / 3.0, epsilon = 1e-7);
        program.equal_zero(vec![(0, 1.0), (1, 1.0)]);
        let x = program.solve("test").unwrap();
        assert_abs_diff_eq!(x[0] + x[1], 0.0, epsilon = 1e-7);
    }

    #[test]
    fn contradicting_constraints_are_an_error() {
        let mut program = line();
        program.at_least(vec![(0, 1.0)], 1.0);
        program.at_least(vec![(0, -1.0)], 1.0);
        let error = program.solve("test").unwrap_err();
        assert!(
            matches!(&error, PreisachError::QuadraticProgram { status, .. }
                if status == "PrimalInfeasible"),
            "{error}"
        );
    }
}

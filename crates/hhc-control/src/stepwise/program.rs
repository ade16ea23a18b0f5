//! The least of a quadratic form over discs, in place.

use nalgebra::{DMatrix, DVector};

/// Iterations of one solution at most. The next cycle goes on from where this one ends.
const ITERATIONS: usize = 60;
/// Change of the scaled controls, relative, at which the iteration ends.
const TOLERANCE: f64 = 1e-10;

/// `min  x' N x / 2 + g' x` with every consecutive pair of `x` in a disc about zero.
///
/// Without a limit that binds, by Cholesky's factors. Else by the accelerated projected gradient with restarts, each pair
/// scaled by the mean of its diagonal.
///
/// Source: Y. Nesterov, *Introductory Lectures on Convex Optimization* (2004); B. O'Donoghue, E. Candes, Found. Comput.
/// Math. 15 (2015) 715 for the restarts.
#[derive(Debug, Clone)]
pub(super) struct DiscProgram {
    pub(super) normal: DMatrix<f64>,
    pub(super) linear: DVector<f64>,
    /// Largest size of every pair; infinity for none.
    pub(super) radius: Vec<f64>,
    factor: DMatrix<f64>,
    point: DVector<f64>,
    ahead: DVector<f64>,
    slope: DVector<f64>,
    scale: Vec<f64>,
}

impl DiscProgram {
    pub(super) fn new(radius: Vec<f64>) -> Self {
        let size = 2 * radius.len();
        let vector = || DVector::zeros(size);
        Self {
            normal: DMatrix::zeros(size, size),
            linear: vector(),
            scale: vec![1.0; radius.len()],
            radius,
            factor: DMatrix::zeros(size, size),
            point: vector(),
            ahead: vector(),
            slope: vector(),
        }
    }

    /// The optimum, from a start inside the discs; whether a limit binds.
    pub(super) fn solve(&mut self, x: &mut DVector<f64>) -> bool {
        if self.is_free() {
            x.copy_from(&self.point);
            return false;
        }
        self.project_onto_discs(x);
        true
    }

    /// Solves without the limits, into `point`; whether that keeps them.
    fn is_free(&mut self) -> bool {
        let size = self.normal.nrows();
        for j in 0..size {
            for i in j..size {
                let known: f64 = (0..j).map(|k| self.factor[(i, k)] * self.factor[(j, k)]).sum();
                let left = self.normal[(i, j)] - known;
                if i == j && left <= f64::EPSILON * self.normal[(j, j)] {
                    return false;
                }
                let diagonal = if i == j { 1.0 } else { self.factor[(j, j)] };
                self.factor[(i, j)] = if i == j { left.sqrt() } else { left / diagonal };
            }
        }
        self.point.copy_from(&self.linear);
        self.point.neg_mut();
        let Self { factor, point, radius, .. } = self;
        let is_solved =
            factor.solve_lower_triangular_mut(point) && factor.tr_solve_lower_triangular_mut(point);
        let fits = |(pair, radius): (&[f64], &f64)| pair[0].hypot(pair[1]) <= *radius;
        is_solved && point.as_slice().chunks_exact(2).zip(radius.iter()).all(fits)
    }

    fn project_onto_discs(&mut self, x: &mut DVector<f64>) {
        let size = x.len();
        // of a form scaled to a unit diagonal the largest eigenvalue is at most its largest row sum
        for (pair, scale) in self.scale.iter_mut().enumerate() {
            let mean = f64::midpoint(
                self.normal[(2 * pair, 2 * pair)],
                self.normal[(2 * pair + 1, 2 * pair + 1)],
            );
            *scale = if mean > 0.0 { 1.0 / mean.sqrt() } else { 1.0 };
        }
        let scale = |k: usize| self.scale[k / 2];
        let row = |i: usize| -> f64 {
            (0..size).map(|j| self.normal[(i, j)].abs() * scale(i) * scale(j)).sum()
        };
        let steepest = (0..size).map(row).fold(f64::MIN_POSITIVE, f64::max);
        self.ahead.copy_from(x);
        let mut momentum = 1.0_f64;
        for _ in 0..ITERATIONS {
            self.slope.copy_from(&self.linear);
            self.slope.gemv(1.0, &self.normal, &self.ahead, 1.0);
            self.point.copy_from(x);
            for (pair, radius) in self.radius.iter().enumerate() {
                let step = self.scale[pair] * self.scale[pair] / steepest;
                let k = 2 * pair;
                let to = [0, 1].map(|d| self.ahead[k + d] - step * self.slope[k + d]);
                let length = to[0].hypot(to[1]);
                let share = if length > *radius { radius / length } else { 1.0 };
                (x[k], x[k + 1]) = (share * to[0], share * to[1]);
            }
            let (mut changed, mut largest, mut uphill) = (0.0_f64, 0.0_f64, 0.0);
            for k in 0..size {
                let change = x[k] - self.point[k];
                uphill += self.slope[k] * change;
                changed = changed.max(change.abs() / self.scale[k / 2]);
                largest = largest.max(x[k].abs() / self.scale[k / 2]);
            }
            if changed <= TOLERANCE * largest {
                break;
            }
            let next =
                if uphill > 0.0 { 1.0 } else { momentum.mul_add(momentum, 0.25).sqrt() + 0.5 };
            let carry = if uphill > 0.0 { 0.0 } else { (momentum - 1.0) / next };
            momentum = next;
            for k in 0..size {
                self.ahead[k] = x[k] + carry * (x[k] - self.point[k]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two flaps that nearly cancel, under limits that bind: the point keeps the conditions of the optimum, and the one
    /// cut off at the discs does not.
    #[test]
    fn the_optimum_in_discs_keeps_its_conditions() {
        let t = DMatrix::from_fn(12, 4, |i, j| {
            (0.8 * i as f64 + 1.3 * (j % 2) as f64).sin() + 0.15 * (1.9 * i as f64 + j as f64).cos()
        });
        let wanted = DVector::from_vec(vec![-6.0, 4.0, 5.0, -3.0]);
        let z = DVector::from_fn(12, |i, _| 0.6 * (1.7 * i as f64).cos()) - &t * wanted;
        let mut program = DiscProgram::new(vec![1.0, 5.0]);
        program.normal = t.transpose() * &t;
        program.linear = t.transpose() * &z;
        let cost = |x: &DVector<f64>| (&z + &t * x).norm_squared();
        let mut x = DVector::zeros(4);
        for _ in 0..50 {
            assert!(program.solve(&mut x));
        }
        let slope = &program.normal * &x + &program.linear;
        for (pair, radius) in [1.0, 5.0].into_iter().enumerate() {
            let (a, b) = ([x[2 * pair], x[2 * pair + 1]], [slope[2 * pair], slope[2 * pair + 1]]);
            let (size, push) = (a[0].hypot(a[1]), b[0].hypot(b[1]));
            assert!(size <= radius * (1.0 + 1e-12));
            // at a limit the slope points inward, inside it vanishes
            let off =
                if size < radius - 1e-9 { push } else { a[0] * b[0] + a[1] * b[1] + size * push };
            assert!(off.abs() < 1e-6, "{pair}: {off}");
        }
        let free = program.normal.clone().lu().solve(&-&program.linear).unwrap();
        let clipped = DVector::from_fn(4, |k, _| {
            let pair = k / 2;
            let size = free[2 * pair].hypot(free[2 * pair + 1]);
            free[k] * (program.radius[pair] / size).min(1.0)
        });
        assert!(cost(&x) < 0.5 * cost(&clipped), "{} {}", cost(&x), cost(&clipped));
        program.radius = vec![1e3; 2];
        assert!(!program.solve(&mut x));
        assert!((&x - &free).norm() < 1e-9 * free.norm());
    }
}

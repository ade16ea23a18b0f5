//! Newton's method on the limits that bind, where the interior point stops short.

use super::program::{Cone, GOOD_KKT, NO_MULTIPLIER, Program, norm};
use nalgebra::{DMatrix, DVector};

/// Sets of binding cones that Newton's method is tried on, and its steps on each.
const POLISHING: usize = 12;
const NEWTON_STEPS: usize = 8;
/// Step with which it has come to rest, and one that leads away from the interior point; points are of order one.
const NEWTON_REST: f64 = 1e-14;
const FAR_STEP: f64 = 1e6;
/// Singular value below which two binding rows say the same.
const SAME_ROW: f64 = 1e-10;

impl Cone {
    /// How far the slack at a point lies outside the cone (negative within), by how much that grows with the point, and the
    /// second derivatives, if any.
    fn beyond(&self, x: &DVector<f64>) -> (f64, DVector<f64>, Option<DMatrix<f64>>) {
        let slack = self.slack(x);
        let dense = |row: &[(usize, f64)]| {
            let mut out = DVector::zeros(x.len());
            for &(column, a) in row {
                out[column] += a;
            }
            out
        };
        let first = dense(&self.rows[0].0);
        if self.rows.len() == 1 {
            return (-slack[0], first, None);
        }
        let size = norm(&slack[1..]).max(f64::MIN_POSITIVE);
        let rest: Vec<DVector<f64>> = self.rows[1..].iter().map(|(row, _)| dense(row)).collect();
        let mut along = DVector::zeros(x.len());
        let mut bend = DMatrix::zeros(x.len(), x.len());
        for (row, s) in rest.iter().zip(&slack[1..]) {
            along.axpy(s / size, row, 1.0);
            bend.ger(1.0 / size, row, row, 1.0);
        }
        bend.ger(-1.0 / size, &along, &along, 1.0);
        (size - slack[0], first - along, Some(bend))
    }
}

impl Program {
    /// The conditions of the optimum met by Newton's method on the cones that bind, those the interior point gives: it stops
    /// short where rows of neighbouring azimuths are nearly alike. The point given, if that is nearer.
    pub(super) fn polished(&self, x: DVector<f64>, z: Vec<f64>) -> (DVector<f64>, Vec<f64>) {
        let mut best = (self.kkt(&x, &z).largest(), x, z);
        if best.0 <= GOOD_KKT {
            return (best.1, best.2);
        }
        let mut binding = self.binding(&best.1, &best.2);
        let mut now = best.1.clone();
        for _ in 0..POLISHING {
            let Some((point, weights)) = self.newton_on(&binding, now) else { break };
            let multipliers = self.multipliers(&point, &binding, &weights);
            let kkt = self.kkt(&point, &multipliers).largest();
            if kkt < best.0 {
                best = (kkt, point.clone(), multipliers);
            }
            // a cone that pushes the wrong way does not bind
            let least = (0..weights.len()).min_by(|&a, &b| weights[a].total_cmp(&weights[b]));
            match least {
                _ if kkt <= GOOD_KKT => break,
                Some(k) if weights[k] < -NO_MULTIPLIER => drop(binding.remove(k)),
                _ => break,
            }
            now = point;
        }
        (best.1, best.2)
    }

    /// The cones whose multiplier is larger than their distance from the boundary, with that multiplier.
    fn binding(&self, x: &DVector<f64>, z: &[f64]) -> Vec<(usize, f64)> {
        let mut at = 0;
        let mut out = Vec::new();
        for (k, cone) in self.cones.iter().enumerate() {
            let weight = z[at];
            at += cone.rows.len();
            if weight > -cone.beyond(x).0 {
                out.push((k, weight));
            }
        }
        out
    }

    /// Newton's method for the point at which these cones just bind, and their multipliers.
    fn newton_on(
        &self,
        binding: &[(usize, f64)],
        mut x: DVector<f64>,
    ) -> Option<(DVector<f64>, Vec<f64>)> {
        let (n, m) = (x.len(), binding.len());
        let mut weights: Vec<f64> = binding.iter().map(|(_, weight)| *weight).collect();
        for _ in 0..NEWTON_STEPS {
            let mut matrix = DMatrix::zeros(n + m, n + m);
            let mut wanted = DVector::zeros(n + m);
            let mut curved = self.hessian.clone();
            let mut gradient = &self.hessian * &x + &self.linear;
            for (j, ((k, _), weight)) in binding.iter().zip(&weights).enumerate() {
                let (excess, slope, bend) = self.cones[*k].beyond(&x);
                wanted[n + j] = -excess;
                gradient.axpy(*weight, &slope, 1.0);
                matrix.view_mut((0, n + j), (n, 1)).copy_from(&slope);
                matrix.view_mut((n + j, 0), (1, n)).copy_from(&slope.transpose());
                if let Some(bend) = bend {
                    curved += bend * *weight;
                }
            }
            wanted.rows_mut(0, n).copy_from(&-gradient);
            matrix.view_mut((0, 0), (n, n)).copy_from(&curved);
            // rows that say the same leave their multipliers shared
            let step = matrix.svd(true, true).solve(&wanted, SAME_ROW).ok()?;
            x += step.rows(0, n);
            for (weight, change) in weights.iter_mut().zip(step.rows(n, m).iter()) {
                *weight += change;
            }
            if !step.amax().is_finite() || step.amax() > FAR_STEP {
                return None;
            }
            if step.amax() < NEWTON_REST {
                break;
            }
        }
        Some((x, weights))
    }

    /// The multipliers of all rows where these cones bind with these weights.
    fn multipliers(&self, x: &DVector<f64>, binding: &[(usize, f64)], weights: &[f64]) -> Vec<f64> {
        let mut out = Vec::new();
        for (k, cone) in self.cones.iter().enumerate() {
            let found = binding.iter().position(|(other, _)| *other == k);
            let weight = found.map_or(0.0, |j| weights[j].max(0.0));
            let slack = cone.slack(x);
            let size = norm(&slack[1..]).max(f64::MIN_POSITIVE);
            out.push(weight);
            out.extend(slack[1..].iter().map(|s| -weight * s / size));
        }
        out
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

    use super::*;

    /// Two pairs of controls whose optimum lies on a circle and on a row of the range of voltages, beside which a
    /// neighbour says nearly the same.
    fn program() -> Program {
        let circle =
            Cone { rows: vec![(vec![], 1.0), (vec![(0, -1.0)], 0.0), (vec![(1, -1.0)], 0.0)] };
        let row = |slope: f64| Cone { rows: vec![(vec![(2, 1.0), (3, slope)], 1.0)] };
        let mut hessian = DMatrix::identity(4, 4);
        (hessian[(0, 2)], hessian[(2, 0)]) = (0.3, 0.3);
        Program {
            hessian,
            linear: DVector::from_column_slice(&[-2.0, -1.0, -3.0, -1.0]),
            cones: vec![circle, row(0.2), row(0.2 + 1e-7)],
        }
    }

    #[test]
    fn a_point_beside_the_optimum_is_brought_onto_it() {
        let program = program();
        let (x, z, _) = program.solve_best().unwrap();
        assert!(program.kkt(&x, &z).largest() < 1e-9);
        // as an interior point that stopped short would give it
        let near = x.map(|v| v * (1.0 - 3e-5));
        let short: Vec<f64> = z.iter().map(|v| v * (1.0 + 2e-5) + 1e-8).collect();
        assert!(program.kkt(&near, &short).largest() > 1e-6);
        let (polished, multipliers) = program.polished(near, short);
        let kkt = program.kkt(&polished, &multipliers);
        assert!(kkt.largest() < 1e-12, "{kkt:?}");
        // what is left of complementarity bounds the square of the distance
        assert!((polished - x).amax() < 1e-4);
    }

    /// What is an optimum already, or has no binding cone, stays as it is.
    #[test]
    fn an_optimum_is_left_alone() {
        let program = program();
        let (x, z, _) = program.solve_best().unwrap();
        assert_eq!(program.polished(x.clone(), z.clone()), (x, z));
        let free = Program { cones: Vec::new(), ..program };
        let point = DVector::zeros(4);
        let (polished, _) = free.polished(point.clone(), Vec::new());
        assert!(free.kkt(&polished, &[]).largest() < 1e-12 || polished == point);
    }
}

//! Aerodynamic lag states made periodic, by Gauss collocation on the time elements.
//!
//! A lag state follows `x' = a(psi) (r(psi) - x)` with `a = pole |U|/b`. Inside one time element the
//! state is a polynomial through the Gauss points (the Gauss implicit Runge-Kutta method, order twice
//! the number of points), so that
//!
//! ```text
//! X = x0 alpha + B r,    x_end = x0 e + f . r
//! ```
//! with `alpha`, `B`, `e`, `f` from the linear solve `(I + h/2 A diag(a)) X = x0 1 + h/2 A diag(a) r`.
//! Chaining the elements over one revolution and asking the last end to be the first start gives the
//! periodic state without marching.
//!
//! Source: Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.5 (Gauss methods).

use crate::ResponseError;
use nalgebra::{DMatrix, DVector};
use rotor_base::{LagrangeBasis, gauss_legendre};
use rotor_fem::TimeElements;
use std::f64::consts::PI;

/// Integration matrix of the Gauss points of one element, and the elements it is for.
#[derive(Debug, Clone)]
pub(crate) struct Collocation {
    integration: DMatrix<f64>,
    end_weights: DVector<f64>,
    half_widths: Vec<f64>,
}

impl Collocation {
    pub(crate) fn new(time: &TimeElements) -> Self {
        let points = time.gauss_per_element();
        let rule = gauss_legendre(points);
        let rows = LagrangeBasis::new(rule.nodes).integration_matrix();
        Self {
            integration: DMatrix::from_fn(points, points, |i, j| rows[i][j]),
            end_weights: DVector::from_vec(rule.weights),
            half_widths: vec![PI / time.elements() as f64; time.elements()],
        }
    }

    /// The same for elements of other half lengths, rad, that fill the revolution.
    pub(crate) fn on(&self, half_widths: &[f64]) -> Self {
        Self { half_widths: half_widths.to_vec(), ..self.clone() }
    }

    pub(crate) fn points(&self) -> usize {
        self.end_weights.len()
    }
}

/// One lag channel over one revolution, its elements solved.
#[derive(Debug, Clone)]
pub(crate) struct PeriodicLag {
    points_per_element: usize,
    /// Element by element the columns `alpha` and `B`, then `e` and `f`.
    table: Vec<f64>,
    closing: f64,
}

/// One element of a lag: `X = x0 start + B r`, `x_end = x0 end_start + end_drive . r`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LagElement<'a> {
    pub(crate) start: &'a [f64],
    /// Column by column.
    pub(crate) drive: &'a [f64],
    pub(crate) end_start: f64,
    pub(crate) end_drive: &'a [f64],
}

impl PeriodicLag {
    /// Solves the elements for the rates `a` (per rad) at all points of the revolution.
    ///
    /// # Errors
    /// [`ResponseError::LagSingular`] if an element cannot be solved (rates not finite).
    pub(crate) fn new(collocation: &Collocation, rates: &[f64]) -> Result<Self, ResponseError> {
        let g = collocation.points();
        let mut table = Vec::with_capacity(collocation.half_widths.len() * (g + 1) * (g + 1));
        let mut passed = 1.0;
        for (chunk, &half) in rates.chunks_exact(g).zip(&collocation.half_widths) {
            let scaled =
                DMatrix::from_fn(g, g, |i, j| half * collocation.integration[(i, j)] * chunk[j]);
            let system = (DMatrix::identity(g, g) + &scaled).lu();
            let start = system.solve(&DVector::from_element(g, 1.0));
            let drive = system.solve(&scaled);
            let (Some(start), Some(drive)) = (start, drive) else {
                return Err(ResponseError::LagSingular { largest_rate: max_abs(chunk) });
            };
            table.extend(start.iter().chain(&drive));
            let weights = DVector::from_fn(g, |i, _| half * collocation.end_weights[i] * chunk[i]);
            let end_start = 1.0 - weights.dot(&start);
            table.push(end_start);
            table.extend((&weights - drive.transpose() * &weights).iter());
            passed *= end_start;
        }
        let closing = 1.0 - passed;
        if !closing.is_finite() || closing.abs() < 1e-12 {
            return Err(ResponseError::LagSingular { largest_rate: max_abs(rates) });
        }
        Ok(Self { points_per_element: g, table, closing })
    }

    /// What one element makes of its start and of the drive at its points.
    pub(crate) fn element(&self, element: usize) -> LagElement<'_> {
        let g = self.points_per_element;
        let table = &self.table[element * (g + 1) * (g + 1)..(element + 1) * (g + 1) * (g + 1)];
        let (inside, end) = table.split_at(g * (g + 1));
        let (start, drive) = inside.split_at(g);
        LagElement { start, drive, end_start: end[0], end_drive: &end[1..] }
    }

    /// One less the part of a state that is left after a revolution without drive.
    pub(crate) fn closing(&self) -> f64 {
        self.closing
    }

    /// The periodic state as a linear operator on the drive, `x_p = sum_p' P[p, p'] r_p'`.
    ///
    /// ```text
    /// P = B within an element  +  alpha_e (e_(e-1) ... e_(e'+1)) f_e' / (1 - e_1 ... e_n)  for every e'
    /// ```
    /// the last term the way round from the end of element `e'` to the start of `e`.
    pub(crate) fn operator(&self) -> DMatrix<f64> {
        let g = self.points_per_element;
        let elements = self.table.len() / ((g + 1) * (g + 1));
        let mut operator = DMatrix::zeros(g * elements, g * elements);
        for at in 0..elements {
            let LagElement { start, drive, .. } = self.element(at);
            for (j, column) in drive.chunks_exact(g).enumerate() {
                for (i, b) in column.iter().enumerate() {
                    operator[(at * g + i, at * g + j)] = *b;
                }
            }
            let mut passed = 1.0 / self.closing;
            for back in 1..=elements {
                let from = (at + elements - back) % elements;
                let LagElement { end_start, end_drive, .. } = self.element(from);
                for (j, f) in end_drive.iter().enumerate() {
                    for (i, alpha) in start.iter().enumerate() {
                        operator[(at * g + i, from * g + j)] += alpha * passed * f;
                    }
                }
                passed *= end_start;
            }
        }
        operator
    }
}

fn max_abs(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| if v.abs() <= m { m } else { v.abs() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// `x' = a (r - x)` with constant `a` and `r = cos n psi`: closed form.
    #[test]
    fn a_constant_lag_is_its_transfer_function() {
        for (elements, gauss) in [(8, 8), (12, 8)] {
            let time = TimeElements::new(elements, 5, gauss).unwrap();
            let collocation = Collocation::new(&time);
            for a in [0.5, 3.0, 25.0, 600.0] {
                let lag = PeriodicLag::new(&collocation, &vec![a; time.points().len()]).unwrap();
                for n in [1.0, 4.0] {
                    let drive: Vec<f64> = time.points().iter().map(|p| (n * p).cos()).collect();
                    let state = lag.operator() * DVector::from_vec(drive);
                    for (&psi, got) in time.points().iter().zip(&state) {
                        let exact =
                            a * (a * (n * psi).cos() + n * (n * psi).sin()) / (a * a + n * n);
                        assert_abs_diff_eq!(*got, exact, epsilon = 2e-6);
                    }
                }
            }
        }
    }

    /// A varying rate: `x = exp(-sin psi)` solves `x' = a (r - x)` for `a = 2 + cos psi`,
    /// `r = x (1 - cos psi / a)`; the error must fall with high order.
    #[test]
    fn a_varying_rate_converges_fast() {
        let error = |elements: usize| {
            let time = TimeElements::new(elements, 5, 6).unwrap();
            let rates: Vec<f64> = time.points().iter().map(|p| 2.0 + p.cos()).collect();
            let exact: Vec<f64> = time.points().iter().map(|p| (-p.sin()).exp()).collect();
            let drive: Vec<f64> = time
                .points()
                .iter()
                .zip(&exact)
                .map(|(p, x)| x * (1.0 - p.cos() / (2.0 + p.cos())))
                .collect();
            let lag = PeriodicLag::new(&Collocation::new(&time), &rates).unwrap();
            let state = lag.operator() * DVector::from_vec(drive);
            state.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
        };
        let (coarse, fine) = (error(4), error(8));
        assert!(fine < 5e-6, "{fine:e}");
        assert!(coarse / fine > 40.0, "order too low: {coarse:e} to {fine:e}");
    }

    #[test]
    fn rates_that_are_no_numbers_are_an_error() {
        let time = TimeElements::new(4, 5, 8).unwrap();
        let rates = vec![f64::NAN; time.points().len()];
        assert!(matches!(
            PeriodicLag::new(&Collocation::new(&time), &rates),
            Err(ResponseError::LagSingular { .. })
        ));
    }
}

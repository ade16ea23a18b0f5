//! Quadrature along the span of the modal blade, with running integrals.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use rotor_base::{LagrangeBasis, gauss_legendre};

use super::Scalar;

/// Gauss points of a blade cut into pieces, with running integrals.
#[derive(Debug, Clone)]
pub(super) struct Span {
    pub(super) stations: Vec<f64>,
    pub(super) weights: Vec<f64>,
    halves: Vec<f64>,
    integration: Vec<Vec<f64>>,
}

impl Span {
    pub(super) fn new(edges: &[f64], points: usize) -> Self {
        let rule = gauss_legendre(points);
        let mut span = Self {
            stations: Vec::new(),
            weights: Vec::new(),
            halves: Vec::new(),
            integration: LagrangeBasis::new(rule.nodes.clone()).integration_matrix(),
        };
        for pair in edges.windows(2) {
            let (half, mid) = (0.5 * (pair[1] - pair[0]), 0.5 * (pair[1] + pair[0]));
            span.halves.push(half);
            span.stations.extend(rule.nodes.iter().map(|node| mid + half * node));
            span.weights.extend(rule.weights.iter().map(|weight| half * weight));
        }
        span
    }

    /// Integral from the root to every station.
    ///
    /// For Gauss points it is the adjoint of [`Self::to_tip`] to the last bit of the arithmetic: virtual
    /// work is done by the very forces that are summed.
    #[inline(always)]
    pub(super) fn running<T: Scalar>(&self, f: &[T]) -> Vec<T> {
        let count = self.integration.len() - 1;
        let mut before = T::zero();
        let mut out = Vec::with_capacity(f.len());
        for (values, half) in f.chunks_exact(count).zip(&self.halves) {
            for row in &self.integration[..count] {
                out.push(before + partial(row, values, *half));
            }
            before += partial(&self.integration[count], values, *half);
        }
        out
    }

    /// Integral from every station to the tip.
    #[inline(always)]
    pub(super) fn to_tip<T: Scalar>(&self, f: &[T]) -> Vec<T> {
        let mut whole = T::zero();
        for (value, weight) in f.iter().zip(&self.weights) {
            whole += *value * T::from_real(*weight);
        }
        let mut out = self.running(f);
        for part in &mut out {
            *part = whole - *part;
        }
        out
    }
}

/// A row of the integration of one piece, half its length long.
#[inline(always)]
fn partial<T: Scalar>(row: &[f64], values: &[T], half: f64) -> T {
    let mut sum = T::zero();
    for (a, b) in row.iter().zip(values) {
        sum += *b * T::from_real(a * half);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Virtual work by either running integral is the same.
    #[test]
    fn the_two_running_integrals_are_adjoint() {
        let span = Span::new(&[0.1, 0.3, 0.35, 1.0], 5);
        let f: Vec<f64> = span.stations.iter().map(|x| (7.0 * x).sin()).collect();
        let g: Vec<f64> = span.stations.iter().map(|x| (3.0 - 5.0 * x).exp()).collect();
        let product = |a: &[f64], b: &[f64]| -> f64 {
            a.iter().zip(b).zip(&span.weights).map(|((a, b), w)| a * b * w).sum()
        };
        let gap = product(&f, &span.running(&g)) - product(&span.to_tip(&f), &g);
        assert!(gap.abs() < 1e-14, "{gap:e}");
        let line = span.running(&vec![2.0; span.stations.len()]);
        for (x, value) in span.stations.iter().zip(line) {
            assert!((value - 2.0 * (x - 0.1)).abs() < 1e-15);
        }
    }
}

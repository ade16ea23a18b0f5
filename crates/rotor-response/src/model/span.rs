//! Spanwise stations: Gauss points in pieces that respect every kink of the loading.

use crate::ResponseError;
use crate::error::check;
use rotor_base::{LagrangeBasis, gauss_legendre};

/// Gauss points along the blade, grouped in pieces, with running integrals of high order.
///
/// Pieces end at the structural elements, the aerodynamic cut-out and the edges of the trailing-edge
/// flaps, so that every integrand is smooth inside a piece.
#[derive(Debug, Clone)]
pub struct SpanGrid {
    x: Vec<f64>,
    weight: Vec<f64>,
    edges: Vec<f64>,
    halves: Vec<f64>,
    points_per_piece: usize,
    basis: LagrangeBasis,
    integration: Vec<Vec<f64>>,
}

impl SpanGrid {
    /// A grid from `root` to 1 (radius R) with pieces between all `breaks` and `points_per_piece`
    /// Gauss points in each; breaks outside and repeated breaks are dropped.
    ///
    /// # Errors
    /// [`ResponseError::Parameter`] unless `1 <= points_per_piece <= 16`.
    pub fn new(root: f64, breaks: &[f64], points_per_piece: usize) -> Result<Self, ResponseError> {
        let allowed = (1..=16).contains(&points_per_piece);
        check("span_points_per_piece", points_per_piece as f64, allowed, "1 to 16")?;
        let mut edges: Vec<f64> =
            breaks.iter().copied().filter(|b| *b > root && *b < 1.0).chain([root, 1.0]).collect();
        edges.sort_by(f64::total_cmp);
        edges.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
        let rule = gauss_legendre(points_per_piece);
        let basis = LagrangeBasis::new(rule.nodes.clone());
        let mut grid = Self {
            x: Vec::new(),
            weight: Vec::new(),
            edges: edges.clone(),
            halves: Vec::new(),
            points_per_piece,
            integration: basis.integration_matrix(),
            basis,
        };
        for pair in edges.windows(2) {
            let (half, mid) = (0.5 * (pair[1] - pair[0]), 0.5 * (pair[1] + pair[0]));
            grid.halves.push(half);
            grid.x.extend(rule.nodes.iter().map(|node| mid + half * node));
            grid.weight.extend(rule.weights.iter().map(|weight| half * weight));
        }
        Ok(grid)
    }

    /// The same with the pieces between two stations halved.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn halved(
        root: f64,
        breaks: &[f64],
        [from, to]: [f64; 2],
        points_per_piece: usize,
    ) -> Result<Self, ResponseError> {
        let whole = Self::new(root, breaks, points_per_piece)?;
        let middle = |pair: &[f64]| {
            let inside = pair[0] > from - 1e-9 && pair[1] < to + 1e-9;
            inside.then_some(0.5 * (pair[0] + pair[1]))
        };
        let middles = whole.edges.windows(2).filter_map(middle);
        let breaks: Vec<f64> = breaks.iter().copied().chain(middles).collect();
        Self::new(root, &breaks, points_per_piece)
    }

    /// Stations, radius R, ascending.
    pub fn x(&self) -> &[f64] {
        &self.x
    }

    /// Quadrature weights, radius R, summing to the blade's length.
    pub fn weight(&self) -> &[f64] {
        &self.weight
    }

    /// Ends of the pieces, radius R, from root to tip.
    pub fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// Gauss points in each piece.
    pub fn points_per_piece(&self) -> usize {
        self.points_per_piece
    }

    /// Number of stations.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// Whether the grid has no station (it never has).
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Integral of `f` from the root to every station.
    pub fn integral_from_root(&self, f: &[f64], out: &mut [f64]) {
        self.integrals_from_root(f, out, &mut [0.0]);
    }

    /// The same for several functions side by side, lane by lane; both of shape stations x lanes. `total` has a place for
    /// every lane and leaves with the integral over the blade.
    #[expect(clippy::inline_always, reason = "what is inlined is compiled for the vector unit")]
    #[inline(always)]
    pub fn integrals_from_root(&self, f: &[f64], out: &mut [f64], total: &mut [f64]) {
        let lanes = total.len();
        let piece = self.points_per_piece * lanes;
        total.fill(0.0);
        let values = f.chunks_exact(piece).zip(out.chunks_exact_mut(piece));
        for ((values, out), half) in values.zip(&self.halves) {
            let add = |row: &[f64], out: &mut [f64]| {
                for (weight, values) in row.iter().zip(values.chunks_exact(lanes)) {
                    for (sum, value) in out.iter_mut().zip(values) {
                        *sum += half * weight * value;
                    }
                }
            };
            for (out, row) in out.chunks_exact_mut(lanes).zip(&self.integration) {
                out.copy_from_slice(total);
                add(row, out);
            }
            add(&self.integration[self.points_per_piece], total);
        }
    }

    /// Integral of `f` from every station to the tip.
    pub fn integral_to_tip(&self, f: &[f64], out: &mut [f64]) {
        self.integral_from_root(f, out);
        let total = self.integral(f);
        for o in out.iter_mut() {
            *o = total - *o;
        }
    }

    /// Weights of the integral from a station to the tip, radius R: the polynomial through the points of the
    /// piece cut by the station, the whole of those outboard. At the root they are [`Self::weight`], at the tip
    /// nothing.
    pub fn weights_outboard(&self, station: f64) -> Vec<f64> {
        let n = self.points_per_piece;
        let mut out = self.weight.clone();
        for ((edges, half), weights) in
            self.edges.windows(2).zip(&self.halves).zip(out.chunks_exact_mut(n))
        {
            if station >= edges[1] {
                weights.fill(0.0);
            } else if station > edges[0] {
                let inboard = self.basis.integrals_to((station - edges[0]) / half - 1.0);
                for (weight, part) in weights.iter_mut().zip(inboard) {
                    *weight -= half * part;
                }
            }
        }
        out
    }

    /// The first point of the piece that holds a station, and the shares of the values at its points in the polynomial there;
    /// on an edge the piece inboard of it, but at the root.
    pub fn shares_at(&self, station: f64) -> (usize, Vec<f64>) {
        let pieces = self.halves.len();
        let piece = self.edges[1..pieces].partition_point(|edge| *edge < station);
        let local = (station - self.edges[piece]) / self.halves[piece] - 1.0;
        let shares = self.basis.evaluate(local).into_iter().map(|[share, ..]| share);
        (piece * self.points_per_piece, shares.collect())
    }

    /// Integral of `f` over the blade.
    pub fn integral(&self, f: &[f64]) -> f64 {
        self.weight.iter().zip(f).map(|(w, v)| w * v).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn running_integrals_are_exact_for_polynomials_and_respect_kinks() {
        let grid = SpanGrid::new(0.0, &[0.35, 0.7, 0.7, 0.5, 1.0], 4).unwrap();
        assert_eq!(grid.len(), 16);
        let f: Vec<f64> = grid.x().iter().map(|x| x.powi(3)).collect();
        let mut out = vec![0.0; grid.len()];
        grid.integral_from_root(&f, &mut out);
        for (got, x) in out.iter().zip(grid.x()) {
            assert_abs_diff_eq!(*got, x.powi(4) / 4.0, epsilon = 1e-15);
        }
        grid.integral_to_tip(&f, &mut out);
        for (got, x) in out.iter().zip(grid.x()) {
            assert_abs_diff_eq!(*got, (1.0 - x.powi(4)) / 4.0, epsilon = 1e-15);
        }
        for station in [0.0, 0.1, 0.35, 0.4321, 0.7, 0.999, 1.0] {
            let weights = grid.weights_outboard(station);
            let sum: f64 = weights.iter().zip(&f).map(|(w, f)| w * f).sum();
            assert_abs_diff_eq!(sum, (1.0 - f64::powi(station, 4)) / 4.0, epsilon = 1e-15);
        }
        for station in [0.0, 0.1, 0.35, 0.4321, 0.7, 0.999, 1.0] {
            let (from, shares) = grid.shares_at(station);
            let value: f64 = shares.iter().zip(&f[from..]).map(|(share, f)| share * f).sum();
            assert_abs_diff_eq!(value, f64::powi(station, 3), epsilon = 1e-14);
        }
        assert_eq!((grid.shares_at(0.35).0, grid.shares_at(0.3501).0), (0, 4));
        assert_eq!(grid.weights_outboard(0.0), grid.weight());
        assert!(grid.weights_outboard(1.0).iter().all(|w| *w == 0.0));
        let step: Vec<f64> = grid.x().iter().map(|&x| f64::from(x > 0.35)).collect();
        assert_abs_diff_eq!(grid.integral(&step), 0.65, epsilon = 1e-15);
        assert!(SpanGrid::new(0.0, &[], 0).is_err());
    }
}

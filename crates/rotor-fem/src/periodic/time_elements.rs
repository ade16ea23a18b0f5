//! Finite elements over one revolution: the mesh, periodic orbits and their samples.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use rotor_base::{HarmonicSeries, LagrangeBasis, gauss_legendre, gauss_lobatto_nodes};

use crate::FemError;
use crate::error::check_parameters;

/// Largest polynomial order of a time element; beyond it nothing is gained over more elements.
const MAX_ORDER: usize = 12;

/// A periodic mesh of equal time elements over one revolution, azimuth 0 to 2 pi.
///
/// ```text
/// q(psi) = sum_a N_a(psi) q_a,   q(0) = q(2 pi)
/// ```
/// `N_a` are continuous piecewise Lagrange polynomials on Gauss-Lobatto nodes; the last node of the
/// last element is the first node of the first.
///
/// Source: time elements of Viswamurthy and Ganguli (8 elements, fifth order); Gauss-Lobatto nodes in
/// place of equal spacing are our choice, for conditioning.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeElements {
    elements: usize,
    order: usize,
    gauss: usize,
    basis: LagrangeBasis,
    /// `[gauss point][local node]`: value, first and second derivative with respect to azimuth.
    table: Vec<Vec<[f64; 3]>>,
    points: Vec<f64>,
    weights: Vec<f64>,
    node_weights: Vec<f64>,
}

impl Default for TimeElements {
    /// Eight elements of fifth order with eight Gauss points each.
    fn default() -> Self {
        Self::build(8, 5, 8)
    }
}

impl TimeElements {
    /// A mesh of `elements` equal elements of polynomial `order` with `gauss_points` Gauss points
    /// in each.
    ///
    /// | argument | range | default |
    /// |---|---|---|
    /// | `elements` | 1.. | 8 |
    /// | `order` | 2 to 12 | 5 |
    /// | `gauss_points` | `order`.., at least 8 for aerodynamic loads | 8 |
    ///
    /// # Errors
    /// [`FemError::Parameter`] when an argument is out of range.
    pub fn new(elements: usize, order: usize, gauss_points: usize) -> Result<Self, FemError> {
        let parameters = [
            ("elements of the revolution", elements, elements >= 1, "1 or more"),
            ("order of the time elements", order, (2..=MAX_ORDER).contains(&order), "2 to 12"),
            (
                "gauss_points of a time element",
                gauss_points,
                (order..=64).contains(&gauss_points),
                "the order to 64",
            ),
        ];
        check_parameters(
            parameters.map(|(name, found, good, expected)| (name, found as f64, good, expected)),
        )?;
        Ok(Self::build(elements, order, gauss_points))
    }

    fn build(elements: usize, order: usize, gauss: usize) -> Self {
        let length = TAU / elements as f64;
        let basis = LagrangeBasis::new(gauss_lobatto_nodes(order + 1));
        let rule = gauss_legendre(gauss);
        let rate = 2.0 / length;
        let table: Vec<Vec<[f64; 3]>> = rule
            .nodes
            .iter()
            .map(|&s| {
                let scale = |[n, d, dd]: [f64; 3]| [n, d * rate, dd * rate * rate];
                basis.evaluate(s).into_iter().map(scale).collect()
            })
            .collect();
        let mut mesh = Self {
            elements,
            order,
            gauss,
            basis,
            table,
            points: Vec::new(),
            weights: Vec::new(),
            node_weights: vec![0.0; elements * order],
        };
        for e in 0..elements {
            for (g, (&s, &w)) in rule.nodes.iter().zip(&rule.weights).enumerate() {
                mesh.points.push(length * (e as f64 + 0.5 * (s + 1.0)));
                mesh.weights.push(0.5 * length * w);
                for (a, shape) in mesh.table[g].iter().enumerate() {
                    let node = (e * order + a) % (elements * order);
                    mesh.node_weights[node] += 0.5 * length * w * shape[0];
                }
            }
        }
        mesh
    }

    /// Number of elements over the revolution.
    pub fn elements(&self) -> usize {
        self.elements
    }

    /// Polynomial order of an element.
    pub fn order(&self) -> usize {
        self.order
    }

    /// Number of nodes over the revolution, `elements * order`: the unknowns of one degree of freedom.
    pub fn unknowns_per_dof(&self) -> usize {
        self.elements * self.order
    }

    /// Gauss points in each element.
    pub fn gauss_per_element(&self) -> usize {
        self.gauss
    }

    /// Azimuths of all Gauss points, rad, ascending in (0, 2 pi).
    pub fn points(&self) -> &[f64] {
        &self.points
    }

    /// Quadrature weights of [`points`](Self::points), rad, summing to 2 pi.
    pub fn weights(&self) -> &[f64] {
        &self.weights
    }

    /// Azimuths of the nodes, rad, ascending in [0, 2 pi).
    pub fn node_azimuths_rad(&self) -> Vec<f64> {
        let length = TAU / self.elements as f64;
        let local = &self.basis.nodes()[..self.order];
        (0..self.elements)
            .flat_map(|e| local.iter().map(move |s| length * (e as f64 + 0.5 * (s + 1.0))))
            .collect()
    }

    /// Integral of every node's basis function over the revolution, rad; these sum to 2 pi.
    pub(crate) fn node_weights(&self) -> &[f64] {
        &self.node_weights
    }

    /// Basis functions at local Gauss point `g`: `[local node]` of value and two azimuth derivatives.
    pub(crate) fn shapes(&self, g: usize) -> &[[f64; 3]] {
        &self.table[g]
    }

    /// Global node of local node `a` in element `e`.
    pub(crate) fn node(&self, e: usize, a: usize) -> usize {
        (e * self.order + a) % self.unknowns_per_dof()
    }
}

/// A periodic motion on a time mesh.
///
/// Nodal values are a matrix of shape `dof x nodes`: column `a` holds all degrees of freedom at node
/// `a` (node-major when flattened).
#[derive(Debug, Clone, PartialEq)]
pub struct Orbit {
    /// The nodal values.
    pub nodal: DMatrix<f64>,
}

impl Orbit {
    /// The orbit at rest at zero.
    pub fn zero(time: &TimeElements, dof: usize) -> Self {
        Self { nodal: DMatrix::zeros(dof, time.unknowns_per_dof()) }
    }

    /// The orbit that interpolates `motion` (azimuth in rad to all degrees of freedom) at the nodes.
    ///
    /// Components beyond `dof` are dropped, missing ones are zero.
    pub fn interpolate(
        time: &TimeElements,
        dof: usize,
        motion: impl Fn(f64) -> DVector<f64>,
    ) -> Self {
        let mut orbit = Self::zero(time, dof);
        for (mut column, psi) in orbit.nodal.column_iter_mut().zip(time.node_azimuths_rad()) {
            let value = motion(psi);
            for (target, source) in column.iter_mut().zip(value.iter()) {
                *target = *source;
            }
        }
        orbit
    }

    /// Number of degrees of freedom.
    pub fn dof(&self) -> usize {
        self.nodal.nrows()
    }

    /// Displacement, rate and acceleration at all Gauss points of the mesh the orbit belongs to.
    pub fn sample(&self, time: &TimeElements) -> OrbitSamples {
        let (dof, count) = (self.dof(), time.points.len());
        let mut samples = OrbitSamples {
            azimuth_rad: time.points.clone(),
            q: DMatrix::zeros(dof, count),
            qd: DMatrix::zeros(dof, count),
            qdd: DMatrix::zeros(dof, count),
        };
        for e in 0..time.elements {
            for g in 0..time.gauss {
                let point = e * time.gauss + g;
                for (a, [n, d, dd]) in time.table[g].iter().enumerate() {
                    let value = self.nodal.column(time.node(e, a));
                    samples.q.column_mut(point).axpy(*n, &value, 1.0);
                    samples.qd.column_mut(point).axpy(*d, &value, 1.0);
                    samples.qdd.column_mut(point).axpy(*dd, &value, 1.0);
                }
            }
        }
        samples
    }

    /// Fourier series of one degree of freedom with `count` harmonics; zero for an unknown `dof`.
    pub fn harmonics(&self, time: &TimeElements, dof: usize, count: usize) -> HarmonicSeries {
        if dof >= self.dof() {
            return HarmonicSeries::zero(count);
        }
        let samples = self.sample(time);
        let row: Vec<f64> = samples.q.row(dof).iter().copied().collect();
        let weights: Vec<f64> = time.weights.iter().map(|w| w / TAU).collect();
        HarmonicSeries::project(&time.points, &weights, &row, count)
    }
}

/// An orbit at all Gauss points of its mesh; each column is one point, in order of azimuth.
#[derive(Debug, Clone, PartialEq)]
pub struct OrbitSamples {
    /// Azimuths, rad, ascending.
    pub azimuth_rad: Vec<f64>,
    /// Displacements, shape `dof x points`.
    pub q: DMatrix<f64>,
    /// Rates with respect to azimuth (per rad), shape `dof x points`.
    pub qd: DMatrix<f64>,
    /// Second derivatives with respect to azimuth (per rad squared), shape `dof x points`.
    pub qdd: DMatrix<f64>,
}

impl OrbitSamples {
    /// Displacements, rates and second derivatives at a point.
    pub fn at(&self, point: usize) -> [&[f64]; 3] {
        let dof = self.q.nrows();
        [&self.q, &self.qd, &self.qdd].map(|m| &m.as_slice()[dof * point..dof * (point + 1)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn weights_and_nodes_cover_the_revolution() {
        let time = TimeElements::new(6, 4, 9).unwrap();
        assert_eq!(time.unknowns_per_dof(), 24);
        assert_eq!(time.points().len(), 54);
        assert!(time.points().windows(2).all(|p| p[0] < p[1]));
        assert_abs_diff_eq!(time.weights().iter().sum::<f64>(), TAU, epsilon = 1e-13);
        assert_abs_diff_eq!(time.node_weights().iter().sum::<f64>(), TAU, epsilon = 1e-13);
        assert!(time.node_weights().iter().all(|w| *w > 0.0));
    }

    #[test]
    fn an_interpolated_motion_and_its_rates_are_near_the_motion() {
        let time = TimeElements::default();
        let motion = |psi: f64| DVector::from_vec(vec![psi.cos(), (2.0 * psi).sin()]);
        let orbit = Orbit::interpolate(&time, 2, motion);
        let samples = orbit.sample(&time);
        for (p, psi) in samples.azimuth_rad.iter().enumerate() {
            assert_abs_diff_eq!(samples.q[(0, p)], psi.cos(), epsilon = 2e-6);
            assert_abs_diff_eq!(samples.qd[(1, p)], 2.0 * (2.0 * psi).cos(), epsilon = 1e-3);
            assert_abs_diff_eq!(samples.qdd[(0, p)], -psi.cos(), epsilon = 2e-3);
        }
        let series = orbit.harmonics(&time, 1, 3);
        assert_abs_diff_eq!(series.harmonic(2).sine, 1.0, epsilon = 1e-7);
    }

    #[test]
    fn bad_meshes_are_named() {
        for (elements, order, gauss, name) in
            [(0, 5, 8, "elements"), (8, 1, 8, "order"), (8, 5, 4, "gauss_points")]
        {
            let error = TimeElements::new(elements, order, gauss).unwrap_err();
            assert!(error.to_string().contains(name), "{error}");
        }
    }
}

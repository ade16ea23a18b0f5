//! What the load at one azimuth feels of the motion at all others, in the Newton matrix.

use nalgebra::DMatrix;

use crate::TimeElements;

/// Linearisation of `f` at every point with the motion at every point of the revolution, beyond what a
/// [`LocalTangent`](crate::LocalTangent) says of the motion at its own point: the memory of states that the
/// system makes periodic itself.
///
/// ```text
/// df(psi_p) = local tangent + sum_p' dq[p, p'] q(psi_p') + dqd[p, p'] q'(psi_p')
/// ```
/// Both matrices have the shape `dof points x dof points`, degree of freedom fastest; the quadrature over
/// the past is in them.
#[derive(Debug, Clone, PartialEq)]
pub struct OrbitMemory {
    /// Derivative with respect to the displacements.
    pub dq: DMatrix<f64>,
    /// Derivative with respect to the rates.
    pub dqd: DMatrix<f64>,
}

impl OrbitMemory {
    /// No memory yet, for `dof` degrees of freedom at `points` points.
    pub fn zero(dof: usize, points: usize) -> Self {
        let zero = DMatrix::zeros(dof * points, dof * points);
        Self { dq: zero.clone(), dqd: zero }
    }

    /// Its part of the weak tangent, unknowns node-major:
    ///
    /// ```text
    /// sum_p w_p N_a(p) sum_p' ( dq[p, p'] N_b(p') + dqd[p, p'] N_b'(p') )
    /// ```
    pub(crate) fn weak(&self, time: &TimeElements) -> DMatrix<f64> {
        let (points, nodes) = (time.points().len(), time.unknowns_per_dof());
        let dof = self.dq.nrows() / points;
        let gauss = time.gauss_per_element();
        let mut at_points = DMatrix::zeros(dof * points, dof * nodes);
        let mut weak = DMatrix::zeros(dof * nodes, dof * nodes);
        for p in 0..points {
            for (b, [n, d, _]) in time.shapes(p % gauss).iter().enumerate() {
                let node = time.node(p / gauss, b);
                for j in 0..dof {
                    let mut column = at_points.column_mut(node * dof + j);
                    column.axpy(*n, &self.dq.column(p * dof + j), 1.0);
                    column.axpy(*d, &self.dqd.column(p * dof + j), 1.0);
                }
            }
        }
        for (load, mut column) in at_points.column_iter().zip(weak.column_iter_mut()) {
            for p in 0..points {
                let weight = time.weights()[p];
                for (a, [test, ..]) in time.shapes(p % gauss).iter().enumerate() {
                    let node = time.node(p / gauss, a);
                    for i in 0..dof {
                        column[node * dof + i] += weight * test * load[p * dof + i];
                    }
                }
            }
        }
        weak
    }
}

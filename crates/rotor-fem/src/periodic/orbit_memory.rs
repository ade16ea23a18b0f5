//! What the load at one azimuth feels of the motion at all others, in the Newton matrix.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

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
        let at = |p: usize| {
            let shapes = time.shapes(p % gauss).iter().enumerate();
            shapes.map(move |(a, shape)| (time.node(p / gauss, a), shape))
        };
        let mut weak = DMatrix::zeros(dof * nodes, dof * nodes);
        let columns = weak.as_mut_slice().par_chunks_mut(dof * nodes).enumerate();
        columns.for_each_init(
            || DVector::zeros(dof * points),
            |load, (unknown, column)| {
                load.fill(0.0);
                for p in 0..points {
                    for (_, [n, d, _]) in at(p).filter(|(node, _)| *node == unknown / dof) {
                        load.axpy(*n, &self.dq.column(p * dof + unknown % dof), 1.0);
                        load.axpy(*d, &self.dqd.column(p * dof + unknown % dof), 1.0);
                    }
                }
                for p in 0..points {
                    let load = &load.as_slice()[p * dof..(p + 1) * dof];
                    for (node, [test, ..]) in at(p) {
                        let sums = &mut column[node * dof..(node + 1) * dof];
                        for (sum, load) in sums.iter_mut().zip(load) {
                            *sum += time.weights()[p] * test * load;
                        }
                    }
                }
            },
        );
        weak
    }
}

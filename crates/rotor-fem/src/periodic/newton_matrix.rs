//! The Newton matrix of a revolution: assembly, factorisation and the search for resonance.

use std::f64::consts::TAU;

use faer::Mat;
use faer::linalg::solvers::{PartialPivLu, Solve};
use nalgebra::{DMatrix, DVector, Dyn, LU};
use rotor_base::HarmonicSeries;

use crate::{LocalTangent, Orbit, OrbitMemory, PeriodicError, TimeElements};

/// Inverse iterations on the smallest singular value.
const INVERSE_ITERATIONS: usize = 6;
/// A dynamic stiffness below this multiple of the discretisation error counts as zero.
const RESOLUTION_MARGIN: f64 = 2.0;
/// A harmonic counts as resolved when its square is right within this fraction.
const RESOLVED: f64 = 1e-3;
/// A dynamic stiffness below this fraction of the squared harmonic counts as zero on any mesh.
const RELATIVE_FLOOR: f64 = 1e-9;

/// LU factors of the scaled Newton matrix.
///
/// Rows and columns are divided by the square root of the mass, rows also by the node's integral
/// weight: an undamped mode of frequency `w` then contributes entries of the size of `w^2 - n^2`.
#[derive(Clone)]
pub(crate) struct Factorisation {
    lu: PartialPivLu<f64>,
    root_mass: Vec<f64>,
    /// Factors of the mass with what the loads add to it, by point.
    inertia: Vec<LU<f64, Dyn, Dyn>>,
}

impl std::fmt::Debug for Factorisation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Factorisation").field("dof", &self.dof()).finish_non_exhaustive()
    }
}

impl Factorisation {
    /// Factors of the matrix belonging to the tangents at all points, and to the memory if there is one.
    ///
    /// # Errors
    /// [`PeriodicError::Resonance`].
    pub(crate) fn new<E: std::error::Error>(
        time: &TimeElements,
        mass: &DMatrix<f64>,
        tangents: &[LocalTangent],
        memory: Option<&OrbitMemory>,
    ) -> Result<Self, PeriodicError<E>> {
        let dof = mass.nrows();
        let root_mass: Vec<f64> = (0..dof).map(|i| mass[(i, i)].sqrt()).collect();
        let mut matrix = assemble(time, mass, tangents);
        let weak = memory.map(|memory| memory.weak(time));
        let weights = time.node_weights();
        for column in 0..matrix.ncols() {
            for row in 0..matrix.nrows() {
                if let Some(weak) = &weak {
                    matrix[(row, column)] += weak[(row, column)];
                }
                matrix[(row, column)] /=
                    weights[row / dof] * root_mass[row % dof] * root_mass[column % dof];
            }
        }
        let inertia = tangents.iter().map(|tangent| (mass + &tangent.dqdd).lu()).collect();
        let this = Self { lu: matrix.partial_piv_lu(), root_mass, inertia };
        this.refuse_resonance(time)?;
        Ok(this)
    }

    /// Number of degrees of freedom.
    pub(crate) fn dof(&self) -> usize {
        self.root_mass.len()
    }

    /// The Newton step for a residual already divided by the node weights; both `dof x nodes`.
    pub(crate) fn solve(&self, residual: &DMatrix<f64>) -> DMatrix<f64> {
        self.solve_all(std::slice::from_ref(residual)).pop().unwrap_or_else(|| residual.clone())
    }

    /// The same for several residuals at once: the factors are read once.
    pub(crate) fn solve_all(&self, residuals: &[DMatrix<f64>]) -> Vec<DMatrix<f64>> {
        let dof = self.dof();
        let Some(first) = residuals.first() else { return Vec::new() };
        let mut x = Mat::from_fn(first.len(), residuals.len(), |k, r| {
            -residuals[r][(k % dof, k / dof)] / self.root_mass[k % dof]
        });
        self.lu.solve_in_place(x.as_mut());
        let step = |r: usize| {
            let entry = |i: usize, a: usize| x[(a * dof + i, r)] / self.root_mass[i];
            DMatrix::from_fn(dof, first.ncols(), entry)
        };
        (0..residuals.len()).map(step).collect()
    }

    /// The accelerations that loads left over at a point call for, `-(M + df/dq'')^-1 r`, or none where
    /// that matrix is singular.
    pub(crate) fn acceleration(&self, point: usize, residual: &mut DVector<f64>) -> bool {
        self.inertia.get(point).is_some_and(|inertia| {
            *residual *= -1.0;
            inertia.solve_mut(residual)
        })
    }

    /// Finds the motion with the least dynamic stiffness and refuses a resonance without damping.
    ///
    /// The time elements themselves get the square of a harmonic wrong by `resolution`; a dynamic
    /// stiffness not well above that cannot be told from zero. Harmonics the mesh does not resolve (a
    /// high mode may sit near one) are refused only when the matrix is singular to round-off.
    fn refuse_resonance<E: std::error::Error>(
        &self,
        time: &TimeElements,
    ) -> Result<(), PeriodicError<E>> {
        let dof = self.dof();
        let size = dof * time.unknowns_per_dof();
        // any start does that is not orthogonal to the answer: the golden-ratio sequence
        let mut y =
            Mat::from_fn(size, 1, |k, _| (0.5 + k as f64 * 0.618_033_988_749_895).fract() - 0.5);
        let mut stiffness = f64::INFINITY;
        for _ in 0..INVERSE_ITERATIONS {
            let length = y.norm_l2();
            y /= faer::Scale(length);
            let before = y.clone();
            self.lu.solve_transpose_in_place(y.as_mut());
            self.lu.solve_in_place(y.as_mut());
            let growth = y.norm_l2();
            if !growth.is_finite() {
                y = before;
                stiffness = 0.0;
                break;
            }
            stiffness = growth.sqrt().recip();
        }
        let motion = Orbit { nodal: DMatrix::from_fn(dof, size / dof, |i, a| y[(a * dof + i, 0)]) };
        let energy = |i: usize| motion.nodal.row(i).norm_squared();
        let leader = (0..dof).max_by(|&i, &j| energy(i).total_cmp(&energy(j))).unwrap_or(0);
        let series = motion.harmonics(time, leader, time.unknowns_per_dof() / 2);
        let per_rev = dominant_harmonic(&series);
        let resolution = harmonic_error(time, per_rev);
        let square = (per_rev * per_rev).max(1) as f64;
        let margin =
            if resolution < RESOLVED * square { RESOLUTION_MARGIN * resolution } else { 0.0 };
        if stiffness < margin.max(RELATIVE_FLOOR * square) {
            return Err(PeriodicError::Resonance {
                dof: leader,
                per_rev,
                dynamic_stiffness: stiffness,
                resolution,
            });
        }
        Ok(())
    }
}

/// The weak tangent, unknowns node-major.
fn assemble(time: &TimeElements, mass: &DMatrix<f64>, tangents: &[LocalTangent]) -> Mat<f64> {
    let dof = mass.nrows();
    let size = dof * time.unknowns_per_dof();
    let mut matrix = Mat::<f64>::zeros(size, size);
    for e in 0..time.elements() {
        for g in 0..time.gauss_per_element() {
            let point = e * time.gauss_per_element() + g;
            let weight = time.weights()[point];
            let tangent = &tangents[point];
            for (b, [n, d, dd]) in time.shapes(g).iter().enumerate() {
                let column = time.node(e, b) * dof;
                let load = &tangent.dq * *n + &tangent.dqd * *d + &tangent.dqdd * *dd;
                for (a, [test, test_rate, _]) in time.shapes(g).iter().enumerate() {
                    let row = time.node(e, a) * dof;
                    let (inertia, rest) = (-weight * test_rate * d, weight * test);
                    for j in 0..dof {
                        for i in 0..dof {
                            matrix[(row + i, column + j)] +=
                                inertia * mass[(i, j)] + rest * load[(i, j)];
                        }
                    }
                }
            }
        }
    }
    matrix
}

/// The harmonic with the largest amplitude, 0 for the mean.
fn dominant_harmonic(series: &HarmonicSeries) -> usize {
    let mut leader = (0, series.mean.abs() * std::f64::consts::SQRT_2);
    for (k, harmonic) in series.harmonics.iter().enumerate() {
        if harmonic.amplitude() > leader.1 {
            leader = (k + 1, harmonic.amplitude());
        }
    }
    leader.0
}

/// How far the time elements miss `n^2`, the square of a harmonic: the error of the Rayleigh quotient
/// of its interpolant.
fn harmonic_error(time: &TimeElements, n: usize) -> f64 {
    if n == 0 {
        return 0.0;
    }
    let n = n as f64;
    // the phase is arbitrary; one that does not favour a node
    let wave = |psi: f64| nalgebra::DVector::from_element(1, (n * psi + 0.3 * TAU).cos());
    let samples = Orbit::interpolate(time, 1, wave).sample(time);
    let sum = |row: &DMatrix<f64>| -> f64 {
        row.iter().zip(time.weights()).map(|(v, w)| w * v * v).sum()
    };
    (sum(&samples.qd) / sum(&samples.q) - n * n).abs()
}

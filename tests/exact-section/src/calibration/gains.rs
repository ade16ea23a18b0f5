//! The gains: linear least squares with start and steady value imposed.

use super::pole_law::{POLES, PoleLaw};
use super::samples::{REDUCED_FREQUENCIES, Samples};
use super::{FLAP_RANGE, FLAP_TERMS, MACH_TERMS, mach_nodes, nodes_of};
use crate::ExactError;
use crate::chebyshev::transform;
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;

/// Weight of the gains themselves in the fit, which keeps nearly equal poles from cancelling.
const DAMPING: f64 = 1e-3;

/// Gains of all poles, `[load][downwash][pole]`.
pub type Gains = [[[f64; POLES]; 4]; 3];

/// The best gains for given poles, and the weighted misfit that is left.
///
/// The fastest pole is the first: its gain makes the sum `steady - start`.
pub fn fit_gains(samples: &Samples, poles: &[f64; POLES]) -> (Gains, Vec<f64>) {
    let rows = REDUCED_FREQUENCIES.len();
    let lag = |p: f64, k: f64| -Complex64::new(0.0, k) / Complex64::new(p, k);
    let mut gains = [[[0.0; POLES]; 4]; 3];
    let mut misfit = Vec::with_capacity(24 * rows);
    for (o, j) in (0..3).flat_map(|o| (0..4).map(move |j| (o, j))) {
        let total = samples.steady[o][j] - samples.start[o][j];
        let mut basis = DMatrix::zeros(2 * rows + POLES - 1, POLES - 1);
        let mut goal = DVector::zeros(2 * rows + POLES - 1);
        for (i, &k) in REDUCED_FREQUENCIES.iter().enumerate() {
            let weight = samples.weights[i][o][j];
            let first = lag(poles[0], k);
            for (q, pole) in poles.iter().skip(1).enumerate() {
                let value = (lag(*pole, k) - first) * weight;
                basis[(2 * i, q)] = value.re;
                basis[(2 * i + 1, q)] = value.im;
            }
            let value = (samples.loads[i][o][j] - samples.steady[o][j] - total * first) * weight;
            goal[2 * i] = value.re;
            goal[2 * i + 1] = value.im;
        }
        // what a gain is worth, by the size of the load at k = 0.5
        let scale = DAMPING * samples.weights[14][o][j];
        for q in 0..POLES - 1 {
            basis[(2 * rows + q, q)] = scale;
        }
        let normal = basis.tr_mul(&basis);
        let right = basis.tr_mul(&goal);
        let solution = normal.cholesky().map_or_else(
            || DVector::zeros(POLES - 1),
            |factors| {
                // one step of refinement: the normal equations lose digits
                let first = factors.solve(&right);
                let left = basis.tr_mul(&(&goal - &basis * &first));
                first + factors.solve(&left)
            },
        );
        let left = &goal - &basis * &solution;
        misfit.extend(left.iter().take(2 * rows));
        gains[o][j][0] = total - solution.sum();
        for (gain, value) in gains[o][j].iter_mut().skip(1).zip(solution.iter()) {
            *gain = *value;
        }
    }
    (gains, misfit)
}

/// Chebyshev coefficients of `M gain(M, E)`, `[load][downwash][pole][mach term][flap term]`, without
/// the fastest pole.
#[derive(Debug, Clone, PartialEq)]
pub struct GainTable {
    /// The coefficients; rows with one flap term do not depend on the flap chord.
    pub coefficients: Vec<Vec<Vec<Vec<Vec<f64>>>>>,
}

impl GainTable {
    /// Fits the gains at all nodes.
    ///
    /// # Errors
    /// [`ExactError`] if the exact theory fails at a node.
    pub fn fit(law: &PoleLaw) -> Result<Self, ExactError> {
        let flap_chords = nodes_of(FLAP_RANGE, FLAP_TERMS);
        // [mach][flap]
        let gains = mach_nodes()
            .into_iter()
            .map(|mach| {
                let poles = law.poles(mach);
                let samples = Samples::at(mach, &flap_chords)?;
                Ok(samples.iter().map(|s| scaled(&fit_gains(s, &poles).0, mach)).collect())
            })
            .collect::<Result<Vec<Vec<Gains>>, ExactError>>()?;
        let series = |o: usize, j: usize, q: usize| {
            let along_mach: Vec<Vec<f64>> = (0..FLAP_TERMS)
                .map(|f| real_transform(&gains.iter().map(|g| g[f][o][j][q]).collect::<Vec<_>>()))
                .collect();
            let terms = if o < 2 && j < 2 { 1 } else { FLAP_TERMS };
            (0..MACH_TERMS)
                .map(|m| {
                    let across: Vec<f64> = along_mach.iter().map(|row| row[m]).collect();
                    let mut row = real_transform(&across);
                    row.truncate(terms);
                    row.into_iter().map(nine_decimals).collect()
                })
                .collect()
        };
        let coefficients = (0..3)
            .map(|o| (0..4).map(|j| (1..POLES).map(|q| series(o, j, q)).collect()).collect())
            .collect();
        Ok(Self { coefficients })
    }
}

fn scaled(gains: &Gains, mach: f64) -> Gains {
    gains.map(|row| row.map(|gains| gains.map(|gain| gain * mach)))
}

fn real_transform(values: &[f64]) -> Vec<f64> {
    let complex: Vec<Complex64> = values.iter().map(|v| Complex64::from(*v)).collect();
    transform(&complex).into_iter().map(|c| c.re).collect()
}

/// Nine decimals: gains are of the order of 0.01 to 10.
fn nine_decimals(x: f64) -> f64 {
    (x * 1e9).round() / 1e9
}

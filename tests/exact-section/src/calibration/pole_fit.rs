//! The fit of the law of the poles to exact theory.

use super::gains::fit_gains;
use super::pole_law::PoleLaw;
use super::samples::Samples;
use crate::ExactError;
use nalgebra::{DMatrix, DVector};

/// Mach numbers the law is fitted at, with the weight of each.
const MACH_NUMBERS: [(f64, f64); 11] = [
    (0.05, 0.6),
    (0.1, 1.0),
    (0.2, 1.0),
    (0.3, 1.0),
    (0.4, 1.0),
    (0.5, 1.0),
    (0.6, 1.0),
    (0.7, 1.0),
    (0.75, 0.7),
    (0.8, 0.4),
    (0.88, 0.15),
];
/// Weight of the distance from where the fit began.
const PRIOR: f64 = 0.1;
/// Flap chords the law is fitted at.
const FLAP_CHORDS: [f64; 3] = [0.1, 0.2, 0.4];
/// Largest number of Gauss-Newton steps.
const STEPS: usize = 40;

/// Fits the parameters of the law.
///
/// # Errors
/// [`ExactError`] if the exact theory fails at a sample.
pub fn fit_pole_law(start: &PoleLaw) -> Result<PoleLaw, ExactError> {
    let mut samples = Vec::new();
    for (mach, weight) in MACH_NUMBERS {
        samples.push((weight, Samples::at(mach, &FLAP_CHORDS)?));
    }
    let origin = start.to_vector();
    let misfit = |x: &DVector<f64>| {
        let law = PoleLaw::from_vector(x);
        let mut all = Vec::new();
        for (weight, samples) in &samples {
            let poles = law.poles(samples[0].mach);
            for sample in samples {
                all.extend(fit_gains(sample, &poles).1.into_iter().map(|r| r * weight));
            }
        }
        // what the loads leave open stays where it began
        all.extend((x - &origin).iter().map(|d| PRIOR * d));
        DVector::from_vec(all)
    };
    let mut x = origin.clone();
    let mut residual = misfit(&x);
    let mut damping = 1e-3;
    for _ in 0..STEPS {
        let mut jacobian = DMatrix::zeros(residual.len(), x.len());
        for n in 0..x.len() {
            let h = 1e-4;
            let mut moved = x.clone();
            moved[n] += h;
            jacobian.set_column(n, &((misfit(&moved) - &residual) / h));
        }
        let normal = jacobian.tr_mul(&jacobian);
        let gradient = jacobian.tr_mul(&residual);
        let before = residual.norm_squared();
        let mut improved = false;
        for _ in 0..8 {
            let mut damped = normal.clone();
            for n in 0..x.len() {
                damped[(n, n)] += damping * (normal[(n, n)] + 1e-6);
            }
            let Some(factors) = damped.cholesky() else {
                damping *= 10.0;
                continue;
            };
            let step = factors.solve(&gradient);
            let largest = step.amax();
            let candidate = &x - step * (0.5 / largest.max(0.5));
            let left = misfit(&candidate);
            if left.norm_squared() < before {
                x = candidate;
                residual = left;
                damping = (damping * 0.3).max(1e-9);
                improved = true;
                break;
            }
            damping *= 5.0;
        }
        if !improved || residual.norm_squared() > before * (1.0 - 1e-6) {
            break;
        }
    }
    Ok(PoleLaw::from_vector(&x))
}

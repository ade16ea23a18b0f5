//! The poles as functions of the Mach number.

use super::gains::fit_gains;
use super::samples::Samples;
use crate::ExactError;
use nalgebra::{DMatrix, DVector};

/// Number of poles.
pub const POLES: usize = 6;
/// The first poles belong to the pressure waves and grow like `1/M`; the others to the wake, which
/// goes with `beta^2`.
pub(super) const FAST: usize = 3;
/// Smallest ratio of neighbouring poles.
pub(super) const SMALLEST_RATIO: f64 = 1.5;
/// Parameters per pole.
const PARAMETERS: usize = 3;

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

/// The slowest pole goes with `beta^2`, every other is a factor above the one before it:
///
/// ```text
/// ln p_N     = ln beta^2 + f_N(M)
/// ln p_i     = ln p_(i+1) + ln 1.5 + softplus(f_i(M)),      f_i(M) = a_i + b_i M + c_i M^2
/// ```
/// The first of the fast poles has `-ln(M beta^2)` added to its `f`. Poles never meet, so that the
/// gains stay moderate and smooth in the Mach number.
#[derive(Debug, Clone, PartialEq)]
pub struct PoleLaw {
    /// `[a, b, c]` per pole, fastest first.
    pub parameters: [[f64; PARAMETERS]; POLES],
}

/// `ln(1 + e^x)`.
fn softplus(x: f64) -> f64 {
    x.max(0.0) + (-x.abs()).exp().ln_1p()
}

impl PoleLaw {
    /// Where the fit starts: the lags of Wagner's function below, pressure waves crossing the chord
    /// and the flap above.
    pub fn start() -> Self {
        let level = |a: f64| [a, 0.0, 0.0];
        Self {
            parameters: [level(0.2), level(0.2), level(-0.7), level(0.7), level(1.2), level(-4.2)],
        }
    }

    /// The poles at a Mach number, per semichord, fastest first.
    pub fn poles(&self, mach: f64) -> [f64; POLES] {
        let beta2 = 1.0 - mach * mach;
        let mut poles = [0.0; POLES];
        let mut log = beta2.ln();
        for i in (0..POLES).rev() {
            let [a, b, c] = self.parameters[i];
            let f = a + mach * (b + mach * c);
            log += match i + 1 {
                POLES => f,
                FAST => SMALLEST_RATIO.ln() + softplus(f - (mach * beta2).ln()),
                _ => SMALLEST_RATIO.ln() + softplus(f),
            };
            poles[i] = log.exp();
        }
        poles
    }

    /// The same with parameters of four decimals.
    #[must_use]
    pub fn rounded(&self) -> Self {
        let four = |x: f64| (x * 1e4).round() / 1e4;
        Self { parameters: self.parameters.map(|row| row.map(four)) }
    }

    fn from_vector(x: &DVector<f64>) -> Self {
        Self { parameters: std::array::from_fn(|i| std::array::from_fn(|n| x[i * PARAMETERS + n])) }
    }

    fn to_vector(&self) -> DVector<f64> {
        DVector::from_iterator(POLES * PARAMETERS, self.parameters.iter().flatten().copied())
    }
}

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

/// Largest number of Gauss-Newton steps.
const STEPS: usize = 40;

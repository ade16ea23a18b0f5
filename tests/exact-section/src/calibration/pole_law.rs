//! The poles as functions of the Mach number.

use nalgebra::DVector;

/// Number of poles.
pub const POLES: usize = 6;
/// The first poles belong to the pressure waves and grow like `1/M`; the others to the wake, which
/// goes with `beta^2`.
pub(super) const FAST: usize = 3;
/// Smallest ratio of neighbouring poles.
pub(super) const SMALLEST_RATIO: f64 = 1.5;
/// Parameters per pole.
const PARAMETERS: usize = 3;

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

    pub(super) fn from_vector(x: &DVector<f64>) -> Self {
        Self { parameters: std::array::from_fn(|i| std::array::from_fn(|n| x[i * PARAMETERS + n])) }
    }

    pub(super) fn to_vector(&self) -> DVector<f64> {
        DVector::from_iterator(POLES * PARAMETERS, self.parameters.iter().flatten().copied())
    }
}

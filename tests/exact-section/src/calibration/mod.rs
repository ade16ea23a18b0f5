//! Poles and gains of a lag model, fitted to the exact theory over Mach number and flap chord.
//!
//! ```text
//! y_o / m_j = start + sum over poles of gain_i p_i / (p_i + ik),     sum gain_i = steady - start
//! ```
//! for each load `o` and downwash `j`. All loads and downwashes share the poles, which follow a law in
//! the Mach number alone; the gains are then a linear least-squares problem. Start and steady values
//! are imposed, not fitted: the gain of the fastest pole is what the others leave.
//!
//! 1. [`fit_pole_law`]: the parameters of the law, by Gauss-Newton steps on the misfit that is left
//!    when the gains are the best ones (variable projection);
//! 2. [`fit_gains`]: gains at the Chebyshev nodes of Mach number and flap chord;
//! 3. [`GainTable::fit`]: `M gain` as Chebyshev series in both.
//!
//! Everything is deterministic: the same numbers at every run.

mod gains;
mod pole_fit;
mod pole_law;
mod render;
mod samples;

pub use gains::{GainTable, Gains, fit_gains};
pub use pole_fit::fit_pole_law;
pub use pole_law::{POLES, PoleLaw};
pub use samples::{REDUCED_FREQUENCIES, Samples};

use crate::ExactError;

/// Mach numbers the calibration spans.
pub const MACH_RANGE: [f64; 2] = [0.05, 0.9];
/// Flap chord ratios the calibration spans.
pub const FLAP_RANGE: [f64; 2] = [0.1, 0.4];
/// Chebyshev terms of the gains in the Mach number.
pub const MACH_TERMS: usize = 20;
/// Chebyshev terms of the gains in the flap chord.
pub const FLAP_TERMS: usize = 4;

/// The variable the gains are smooth in: `ln(M/(1 - M))`.
pub fn mach_variable(mach: f64) -> f64 {
    (mach / (1.0 - mach)).ln()
}

/// Mach numbers at the Chebyshev nodes of [`mach_variable`].
pub fn mach_nodes() -> Vec<f64> {
    nodes_of(MACH_RANGE.map(mach_variable), MACH_TERMS)
        .into_iter()
        .map(|v| 1.0 / (1.0 + (-v).exp()))
        .collect()
}

/// Chebyshev nodes of a range.
pub fn nodes_of([low, high]: [f64; 2], count: usize) -> Vec<f64> {
    crate::chebyshev::nodes(count)
        .iter()
        .map(|t| 0.5 * (low + high) + 0.5 * (high - low) * t)
        .collect()
}

/// A whole calibration.
#[derive(Debug, Clone, PartialEq)]
pub struct Calibration {
    /// Law of the poles.
    pub law: PoleLaw,
    /// Chebyshev coefficients of the gains.
    pub table: GainTable,
}

/// Fits everything. The parameters of the law are rounded before the gains are fitted, so that the
/// last bits of its iteration do not show.
///
/// # Errors
/// [`ExactError`] if the exact theory fails at one of the samples.
pub fn calibrate() -> Result<Calibration, ExactError> {
    let law = fit_pole_law(&PoleLaw::start())?.rounded();
    let table = GainTable::fit(&law)?;
    Ok(Calibration { law, table })
}

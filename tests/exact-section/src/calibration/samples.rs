//! What the fit is made to: exact harmonic loads at one Mach number and flap chord.

use crate::{ExactError, Motion, Possio, start_loads, steady_loads};
use num_complex::Complex64;

/// Reduced frequencies of the fit.
pub const REDUCED_FREQUENCIES: [f64; 25] = [
    0.005, 0.01, 0.02, 0.03, 0.05, 0.075, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4, 0.45, 0.5, 0.6,
    0.7, 0.8, 0.9, 1.0, 1.1, 1.25, 1.5, 1.8, 2.2,
];

/// Errors of the three loads of a flap motion that weigh the same; their ratio is that of the bounds
/// the project sets itself for lift, moment and hinge moment.
const WEIGHT_OF_LOAD: [f64; 3] = [1.0, 1.0, 1.6];
/// The same for pitch and plunge.
const WEIGHT_OF_LOAD_RIGID: [f64; 3] = [1.0, 1.8, 0.9];

/// Exact loads and the weights of their errors.
#[derive(Debug, Clone, PartialEq)]
pub struct Samples {
    /// Mach number.
    pub mach: f64,
    /// Flap chord ratio.
    pub flap_chord: f64,
    /// Loads at the start of a step, `[load][downwash]`.
    pub start: [[f64; 4]; 3],
    /// Steady loads.
    pub steady: [[f64; 4]; 3],
    /// Harmonic loads at [`REDUCED_FREQUENCIES`].
    pub loads: Vec<[[Complex64; 4]; 3]>,
    /// Weight of an error of each, per frequency.
    pub weights: Vec<[[f64; 4]; 3]>,
}

impl Samples {
    /// Samples at one Mach number, for several flap chords.
    ///
    /// # Errors
    /// [`ExactError`] outside the exact theory.
    pub fn at(mach: f64, flap_chords: &[f64]) -> Result<Vec<Self>, ExactError> {
        let beta = (1.0 - mach * mach).sqrt();
        let solvers = REDUCED_FREQUENCIES
            .iter()
            .map(|k| Possio::with_terms(mach, *k, 64))
            .collect::<Result<Vec<_>, _>>()?;
        flap_chords
            .iter()
            .map(|&flap_chord| {
                let still = steady_loads(0.0, flap_chord);
                let loads = solvers
                    .iter()
                    .map(|solver| solver.loads_with(flap_chord, &still))
                    .collect::<Result<Vec<_>, _>>()?;
                let weights = loads
                    .iter()
                    .zip(REDUCED_FREQUENCIES)
                    .map(|(loads, k)| weights(loads, k))
                    .collect();
                Ok(Self {
                    mach,
                    flap_chord,
                    start: start_loads(mach, flap_chord),
                    steady: still.map(|row| row.map(|load| load / beta)),
                    loads,
                    weights,
                })
            })
            .collect()
    }
}

/// An error counts relative to the load of the motions it enters, more at low frequencies, little
/// above `k = 1`.
fn weights(loads: &[[Complex64; 4]; 3], k: f64) -> [[f64; 4]; 3] {
    let size = Motion::ALL.map(|motion| motion.of(loads, k).map(Complex64::norm));
    let here = match k {
        ..=0.31 => 1.6,
        ..=1.01 => 1.0,
        _ => 0.15,
    };
    std::array::from_fn(|o| {
        let [flap, pitch, plunge] = size.map(|loads| loads[o].max(1e-12));
        let (f, r) = (here * WEIGHT_OF_LOAD[o], here * WEIGHT_OF_LOAD_RIGID[o]);
        [r / pitch.min(plunge), r * 2.0 * k / pitch, f / flap, f * 2.0 * k / flap]
    })
}

//! What can go wrong in the search for a periodic orbit.

use crate::Orbit;

/// Why no periodic orbit was found; `E` is the system's own error.
///
/// Apart from [`FemError`](crate::FemError) because it carries the caller's error type.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PeriodicError<E: std::error::Error + 'static> {
    /// Start orbit, mass matrix or tangents do not fit the system.
    #[error("{what}: found {found}, expected {expected}")]
    Shape {
        /// What does not fit.
        what: &'static str,
        /// Size found.
        found: usize,
        /// Size expected.
        expected: usize,
    },
    /// The mass matrix is not symmetric with a positive diagonal.
    #[error(
        "mass matrix entry ({row}, {column}) is {value}: expected finite and symmetric, with a \
         positive diagonal"
    )]
    Mass {
        /// Row, from 0.
        row: usize,
        /// Column, from 0.
        column: usize,
        /// The value found.
        value: f64,
    },
    /// The system's physics refused an orbit.
    #[error("the system refused the orbit of iteration {iteration}: {source}")]
    System {
        /// Iteration, 0 for the start.
        iteration: usize,
        /// The system's error.
        source: E,
    },
    /// A residual or tangent is not a finite number.
    #[error(
        "the residual of degree of freedom {dof} is not a finite number at azimuth {azimuth_rad} rad \
         in iteration {iteration}: the system diverges or has bad data; start nearer to the solution"
    )]
    NotFinite {
        /// Iteration, 0 for the start.
        iteration: usize,
        /// Degree of freedom, from 0.
        dof: usize,
        /// Azimuth, rad.
        azimuth_rad: f64,
        /// Last orbit with a finite residual.
        best: Box<Orbit>,
    },
    /// A mode is in resonance without damping: the orbit is not determined.
    #[error(
        "degree of freedom {dof} resonates at {per_rev} per rev without damping: the smallest dynamic \
         stiffness of the revolution is {dynamic_stiffness:.2e} per unit mass (rotor speed squared), not \
         distinguishable from zero with a time discretisation error of {resolution:.1e}; give the mode \
         damping or move its frequency off the integer"
    )]
    Resonance {
        /// Degree of freedom that dominates the undetermined motion, from 0.
        dof: usize,
        /// Harmonic that dominates the undetermined motion, per rev.
        per_rev: usize,
        /// Smallest dynamic stiffness per unit mass, rotor speed squared.
        dynamic_stiffness: f64,
        /// Error of the time elements in the square of that harmonic.
        resolution: f64,
    },
    /// The residual did not fall below the tolerance.
    #[error(
        "no periodic orbit after {iterations} iterations: residual {residual:.1e}, tolerance \
         {tolerance:.1e} (best {:.1e}); start nearer, add damping, or allow more iterations; history: {}",
        .history.iter().copied().fold(f64::INFINITY, f64::min), show(.history)
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Residual norm of the last orbit.
        residual: f64,
        /// Tolerance asked for.
        tolerance: f64,
        /// Residual norm at the start and after every step.
        history: Vec<f64>,
        /// The orbit with the smallest residual.
        best: Box<Orbit>,
    },
}

/// Residuals shown of a history at most.
const SHOWN: usize = 30;

/// The whole history for a message; of a long one every so many residuals from the start, and the last.
fn show(history: &[f64]) -> String {
    let stride = history.len().div_ceil(SHOWN).max(1);
    let last = history.len().saturating_sub(1);
    let mut shown: Vec<String> = history
        .iter()
        .enumerate()
        .filter(|(k, _)| k % stride == 0 || *k == last)
        .map(|(_, residual)| format!("{residual:.1e}"))
        .collect();
    if stride > 1 {
        shown.push(format!("(each {stride} steps, and the last)"));
    }
    shown.join(" ")
}

#[cfg(test)]
mod tests {
    use super::show;

    #[test]
    fn a_history_is_shown_from_its_start_to_its_end() {
        assert_eq!(show(&[1.0, 0.1]), "1.0e0 1.0e-1");
        let long: Vec<f64> = (0..200).map(f64::from).collect();
        let text = show(&long);
        assert!(text.starts_with("0.0e0 7.0e0") && text.contains(" 2.0e2 (each 7"), "{text}");
        let numbers =
            text.split(' ').filter(|word| word.contains('e') && word.parse::<f64>().is_ok());
        assert_eq!(numbers.count(), 30);
    }
}

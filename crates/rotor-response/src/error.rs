//! The errors of this crate.

use rotor_fem::{FemError, ModeKind, PeriodicError};

/// What a frequency is near to, for a message.
fn harmonic(frequency_per_rev: f64) -> String {
    match frequency_per_rev.round() {
        0.0 => "nothing that brings it back,".to_owned(),
        n => format!("near the harmonic {n} of the loads,"),
    }
}

/// What helps against a resonance, for a message.
fn remedy(frequency_per_rev: f64) -> &'static str {
    if frequency_per_rev.round() == 0.0 {
        "a spring at the root, or a hinge farther from the centre"
    } else {
        "modal_damping above 0, or another stiffness"
    }
}

/// What can go wrong between a blade, its air and its loads.
///
/// Three families: rejected input (the first variants), numerical failure (with iteration, residual
/// and what was kept) and errors of the crates below.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ResponseError {
    /// Loads are asked for at a station where there is no blade.
    #[error("loads at {station} R: the blade reaches from {root} to 1 R")]
    LoadStation {
        /// The station asked for, R.
        station: f64,
        /// Station of the blade's root, R.
        root: f64,
    },
    /// A model parameter is out of its range.
    #[error("{field} is {value}, expected {expected}")]
    Parameter {
        /// Name of the parameter, unit included.
        field: &'static str,
        /// The value found.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A trailing-edge flap does not lie on the lifting part of the blade.
    #[error(
        "flap {index} spans {start}..{end} R, expected start < end within the lifting span {cutout}..1 R and no overlap with its neighbour"
    )]
    FlapSpan {
        /// Index of the flap, from 0 at the root side.
        index: usize,
        /// Inboard edge, radius R.
        start: f64,
        /// Outboard edge, radius R.
        end: f64,
        /// Aerodynamic root cut-out, radius R.
        cutout: f64,
    },
    /// The flap motions given do not match the flaps of the blade.
    #[error("{given} flap motions were given for {expected} flaps")]
    FlapMotions {
        /// Motions given.
        given: usize,
        /// Flaps of the blade.
        expected: usize,
    },
    /// The modal mass matrix is not positive definite.
    #[error(
        "mass matrix of {modes} modes is not positive definite: mode shapes are linearly dependent or a mass is not positive"
    )]
    MassMatrix {
        /// Number of modes.
        modes: usize,
    },
    /// A coupled mode without damping has the frequency of a harmonic.
    #[error(
        "{kind} {number} at {pitch_deg:.2} deg has {frequency_per_rev:.4} per rev, {} and no damping: nothing bounds its response. Remedy: {}",
        harmonic(*.frequency_per_rev),
        remedy(*.frequency_per_rev)
    )]
    Resonance {
        /// Family of the mode.
        kind: ModeKind,
        /// Number in its family, from 1.
        number: usize,
        /// Its frequency.
        frequency_per_rev: f64,
        /// Pitch at 0.75 R at which it is.
        pitch_deg: f64,
    },
    /// A lag channel of the section aerodynamics cannot be made periodic.
    #[error(
        "aerodynamic lag states cannot be made periodic (largest rate {largest_rate:.3e} per rad); expected finite positive lag poles and section speeds"
    )]
    LagSingular {
        /// Largest rate found, per rad.
        largest_rate: f64,
    },
    /// The stall of a section, marched round under one motion, does not come back to itself.
    #[error(
        "dynamic stall at {station} R does not repeat: it still changes by {change:.3e} (coefficients) after {revolutions} revolutions, wanted {tolerance:.0e}; the vortex may last longer than a revolution: raise root_cutout, or leave dynamic stall off"
    )]
    StallNotPeriodic {
        /// Station, radius R.
        station: f64,
        /// Revolutions marched.
        revolutions: usize,
        /// Last change of a coefficient from revolution to revolution.
        change: f64,
        /// Change wanted.
        tolerance: f64,
    },
    /// The periodic response was not found; the inner error carries iterations, residuals and the
    /// best orbit.
    #[error("periodic blade response: {0}")]
    Periodic(Box<PeriodicError<ResponseError>>),
    /// The same of a rotor whose sections may stall.
    #[error(
        "periodic response of sections that stall: {0}. Remedy: past stall a response need not repeat, so lower collective, thrust or the stroke of the flaps, or leave dynamic stall off"
    )]
    PeriodicStall(Box<PeriodicError<ResponseError>>),
    /// Inflow and thrust did not settle on each other.
    #[error(
        "inflow and thrust did not settle: change {change:.3e} of the tip speed after {iterations} iterations (wanted {tolerance:.1e}), last C_T {thrust_coefficient:.6}"
    )]
    InflowNotConverged {
        /// Iterations spent.
        iterations: usize,
        /// Last change of an inflow parameter.
        change: f64,
        /// Change wanted.
        tolerance: f64,
        /// Last thrust coefficient.
        thrust_coefficient: f64,
    },
    /// A step in time did not settle.
    #[error(
        "step in time at azimuth {azimuth_deg:.1} deg, revolution {revolution}: accelerations still move by {change:.3e} Omega^2 R after {iterations} iterations, wanted {tolerance:.1e}; the last instant before is kept. Remedy: more steps per revolution, or lower collective"
    )]
    StepNotConverged {
        /// Azimuth of the first blade, deg.
        azimuth_deg: f64,
        /// Revolutions since the start.
        revolution: usize,
        /// Last change of an acceleration, `Omega^2 R`.
        change: f64,
        /// Change wanted.
        tolerance: f64,
        /// Iterations spent.
        iterations: usize,
    },
    /// At the end of a step in time, circulation and inflow do not agree.
    #[error(
        "step in time: the inflow still changes by {change:.3e} of the tip speed after {iterations} iterations, wanted {tolerance:.1e}; the end of the step before is kept. Remedy: more azimuth steps of the wake, or lower collective"
    )]
    InflowInTime {
        /// Iterations spent.
        iterations: usize,
        /// Last mismatch of the inflow, tip speed.
        change: f64,
        /// Mismatch wanted.
        tolerance: f64,
    },
    /// The blade or the time elements refused their input or failed.
    #[error(transparent)]
    Fem(#[from] FemError),
    /// The section aerodynamics refused its input.
    #[error(transparent)]
    Aero(#[from] flap_aero::AeroError),
    /// The inflow model refused its input or has no solution.
    #[error(transparent)]
    Wake(#[from] rotor_wake::WakeError),
}

/// Refuses a parameter that is not good.
pub(crate) fn check(
    field: &'static str,
    value: f64,
    good: bool,
    expected: &'static str,
) -> Result<(), ResponseError> {
    if good { Ok(()) } else { Err(ResponseError::Parameter { field, value, expected }) }
}

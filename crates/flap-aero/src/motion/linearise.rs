//! Slopes of the loads and lag rates of a section in a varying stream, in closed form.

use crate::{AeroError, FreeStream, SectionCoefficients, SectionLoads, section_loads};

/// Slopes of [`section_loads`] at a state.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadSlopes {
    /// The loads.
    pub value: SectionLoads,
    /// Per velocity input, `[load][input]`.
    pub per_velocity: [[f64; 4]; 3],
    /// Per rate of a velocity input, `[load][input]`: apparent mass.
    pub per_velocity_rate: [[f64; 4]; 3],
    /// Per lag state, `[load][lag]`.
    pub per_lag: [Vec<f64>; 3],
    /// Per unit of the speed of the stream.
    pub per_speed: [f64; 3],
}

/// Slopes of the loads of [`section_loads`] at a state, in the order of [`Load`](crate::Load).
///
/// ```text
/// dL = (1/2) rho c { |U| (direct dw + sum output dx) + b rate d(dw/dt) + sgn(U) dU (direct w + sum output x) }
/// ```
/// The moments with another `c`. The coefficients, and so the Mach number, are held: a change of
/// speed acts through the dynamic pressure and the velocities. Exact: the loads are linear in
/// velocities, rates and lags, and in the speed on either side of 0 (at 0 the slope of its upper
/// side).
///
/// # Errors
/// [`AeroError::StateMismatch`] unless there is one entry in `lags` per lag of the section.
pub fn load_slopes(
    section: &SectionCoefficients,
    stream: &FreeStream,
    velocities: &[f64; 4],
    velocity_rates: &[f64; 4],
    lags: &[f64],
) -> Result<LoadSlopes, AeroError> {
    let value = section_loads(section, stream, velocities, velocity_rates, lags)?;
    let chord = 2.0 * stream.semichord;
    let force = 0.5 * stream.density * chord;
    let scales = [force, force * chord, force * chord];
    let speed = stream.speed.abs();
    let side = if stream.speed < 0.0 { -1.0 } else { 1.0 };
    let per_lag = std::array::from_fn(|o| {
        section.lags.iter().map(|lag| scales[o] * speed * lag.output[o]).collect()
    });
    let per_speed = std::array::from_fn(|o| {
        let direct: f64 = section.direct[o].iter().zip(velocities).map(|(d, w)| d * w).sum();
        let lagged: f64 = section.lags.iter().zip(lags).map(|(lag, x)| lag.output[o] * x).sum();
        scales[o] * side * (direct + lagged)
    });
    let scaled = |rows: &[[f64; 4]; 3], factor: f64| -> [[f64; 4]; 3] {
        std::array::from_fn(|o| rows[o].map(|entry| scales[o] * factor * entry))
    };
    Ok(LoadSlopes {
        value,
        per_velocity: scaled(&section.direct, speed),
        per_velocity_rate: scaled(&section.rate, stream.semichord),
        per_lag,
        per_speed,
    })
}

/// Slopes of the rate of one lag of [`lag_rates`](crate::lag_rates).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LagRateSlopes {
    /// Per velocity input.
    pub per_velocity: [f64; 4],
    /// Per unit of its own state.
    pub per_lag: f64,
    /// Per unit of the speed of the stream.
    pub per_speed: f64,
}

/// Slopes of the rates of all lags at a state.
///
/// ```text
/// d(dx/dt) = (|U|/b) pole (input . dw - dx) + (sgn(U) dU/b) pole (input . w - x)
/// ```
/// # Errors
/// [`AeroError::StateMismatch`] unless there is one entry in `lags` per lag of the section.
pub fn lag_rate_slopes(
    section: &SectionCoefficients,
    stream: &FreeStream,
    velocities: &[f64; 4],
    lags: &[f64],
) -> Result<Vec<LagRateSlopes>, AeroError> {
    section.check_lags(lags.len())?;
    let pace = stream.semichord_rate();
    let side = if stream.speed < 0.0 { -1.0 } else { 1.0 };
    Ok(section
        .lags
        .iter()
        .zip(lags)
        .map(|(lag, x)| {
            let drive: f64 = lag.input.iter().zip(velocities).map(|(a, w)| a * w).sum();
            LagRateSlopes {
                per_velocity: lag.input.map(|weight| pace * lag.pole * weight),
                per_lag: -pace * lag.pole,
                per_speed: side / stream.semichord * lag.pole * (drive - x),
            }
        })
        .collect())
}

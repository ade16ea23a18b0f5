//! Loads of a section whose free stream varies in time: velocities in, loads per length out.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::{AeroError, SectionCoefficients};
use rotor_base::Number;

/// The stream a section sees, in any consistent units (rotor units: length `R`, time `1/Omega`).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FreeStream<T = f64> {
    /// Air density.
    pub density: f64,
    /// Semichord `b = c/2`, positive.
    pub semichord: f64,
    /// Chordwise velocity `U` from leading to trailing edge; negative in reverse flow.
    pub speed: T,
}

impl FreeStream {
    /// The stream of a section that meets it yawed by `yaw_rad` from the direction of the chord.
    ///
    /// In attached flow the loads are those of the component normal to the span, `U cos(yaw)`, alone
    /// (independence principle): Mach number, reduced frequency and incidence are to be formed with
    /// it too.
    #[must_use]
    pub fn yawed(density: f64, semichord: f64, speed: f64, yaw_rad: f64) -> Self {
        Self { density, semichord, speed: speed * yaw_rad.cos() }
    }

    /// Semichords travelled per unit of time, `|U| / b`.
    pub fn semichord_rate(&self) -> f64 {
        self.speed.abs() / self.semichord
    }
}

/// Aerodynamic loads of a section per length of span, in the units of the [`FreeStream`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SectionLoads<T = f64> {
    /// Lift, up +.
    pub lift: T,
    /// Moment about the quarter chord, nose-up +.
    pub moment: T,
    /// Hinge moment, positive in the sense of the flap angle.
    pub hinge: T,
}

/// Loads per length of a section in a stream that may vary.
///
/// ```text
/// w = U m = [U alpha, theta_dot c, U delta, delta_dot c]        velocities, x the lags of w
/// L = (1/2) rho c   [ |U| (direct w + sum output x) + b rate dw/dt ]_Cn
/// M = (1/2) rho c^2 [ |U| (direct w + sum output x) + b rate dw/dt ]_Cm,     H with Ch
/// ```
/// | argument | symbol | unit |
/// |---|---|---|
/// | `section` | coefficients at the local Mach number | - |
/// | `stream` | `rho`, `b = c/2`, `U` | consistent |
/// | `velocities` | `w`, order of [`Mode`](crate::Mode) | velocity |
/// | `velocity_rates` | `dw/dt` | velocity / time |
/// | `lags` | `x`, velocities, order of the section's lags; see [`lag_rates`] | velocity |
///
/// For a constant `U` these are the coefficients times `rho U^2 c / 2` and `rho U^2 c^2 / 2`.
///
/// Assumes, for a varying `U`: the shape of the downwash is what the aerofoil sees now, so velocity
/// inputs, not angles, are what is lagged and differentiated (`d(U delta)/dt` holds `U_dot delta`);
/// the wake is convected at the local `|U|`, its own unevenness is left out. In reverse flow
/// the section is taken as it is with the flow from ahead: lift follows the normal velocity, an
/// angle's share `U delta` turns sign, and the aerodynamic centre stays at the quarter chord of the
/// geometric nose. Not modelled: the blunt-edge flow of real reverse flow.
///
/// # Errors
/// [`AeroError::StateMismatch`] unless there is one entry in `lags` per lag of the section.
pub fn section_loads(
    section: &SectionCoefficients,
    stream: &FreeStream,
    velocities: &[f64; 4],
    velocity_rates: &[f64; 4],
    lags: &[f64],
) -> Result<SectionLoads, AeroError> {
    section.check_lags(lags.len())?;
    let dot = |row: &[f64; 4], v: &[f64; 4]| -> f64 { row.iter().zip(v).map(|(a, b)| a * b).sum() };
    let mut circulating = section.direct.each_ref().map(|row| dot(row, velocities));
    for (lag, x) in section.lags.iter().zip(lags) {
        for (sum, weight) in circulating.iter_mut().zip(lag.output) {
            *sum += weight * x;
        }
    }
    let apparent = section.rate.each_ref().map(|row| dot(row, velocity_rates));
    Ok(loads_of_outputs(stream, circulating, apparent))
}

/// Loads per length from the two kinds of output of a section: those that come with the speed and those
/// of the apparent mass.
///
/// ```text
/// L = (1/2) rho c   [ |U| y + b y_rate ]_Cn
/// M = (1/2) rho c^2 [ |U| y + b y_rate ]_Cm,     H with Ch
/// y = direct w + sum output x,     y_rate = rate dw/dt
/// ```
/// For callers that keep the lags of their sections in a form of their own. `y` and `y_rate` are in
/// the order of [`Load`](crate::Load), a velocity and a velocity per time; of one section, or of several side by side.
#[inline(always)]
pub fn loads_of_outputs<T: Number>(
    stream: &FreeStream<T>,
    circulating: [T; 3],
    apparent: [T; 3],
) -> SectionLoads<T> {
    let speed = stream.speed.abs();
    let output = |o: usize| speed * circulating[o] + apparent[o] * stream.semichord;
    let [lift, moment, hinge] = [output(0), output(1), output(2)];
    let chord = 2.0 * stream.semichord;
    let force = 0.5 * stream.density * chord;
    SectionLoads {
        lift: lift * force,
        moment: moment * (force * chord),
        hinge: hinge * (force * chord),
    }
}

/// Rates of the lags of velocity inputs, written to `rates`.
///
/// ```text
/// dx/dt = (|U| / b) pole (input . w - x)
/// ```
/// `lags` and `rates` have one entry per lag of the section, in its order. At `U = 0` the lags
/// stand still.
///
/// # Errors
/// [`AeroError::StateMismatch`] if `lags` or `rates` has another length; nothing is written then.
pub fn lag_rates(
    section: &SectionCoefficients,
    stream: &FreeStream,
    velocities: &[f64; 4],
    lags: &[f64],
    rates: &mut [f64],
) -> Result<(), AeroError> {
    section.check_lags(lags.len())?;
    section.check_lags(rates.len())?;
    let pace = stream.semichord_rate();
    for ((lag, x), rate) in section.lags.iter().zip(lags).zip(rates) {
        let drive: f64 = lag.input.iter().zip(velocities).map(|(a, w)| a * w).sum();
        *rate = pace * lag.pole * (drive - x);
    }
    Ok(())
}

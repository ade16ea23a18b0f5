//! Glauert's momentum theory of a lifting rotor in axial, inclined and forward flight.

use crate::error::ensure_finite;
use crate::{FlightState, WakeError};

/// Smallest wake transport speed, over the hover induced velocity, that is accepted in descent.
///
/// ```text
/// sqrt(mu^2 + lambda^2) / sqrt(C_T / 2) >= 0.75     wherever mu tan(alpha_s) < 0
/// ```
/// Below it the wake is carried away more slowly than it is shed and rolls up into a ring around
/// the disk. In vertical descent the bound refuses descent rates between 0.58 and 2.0 times the
/// hover induced velocity, and above an advance ratio of 0.75 times that velocity it refuses
/// nothing. It is an engineering bound of this project, not a measured boundary.
pub const VORTEX_RING_TRANSPORT: f64 = 0.75;

/// Wake transport speed, [`descent_transport`], below which a descending wake breaks down.
pub const WAKE_BREAKDOWN_TRANSPORT: f64 = 0.74;

/// Share of the stream along the disk that carries the wake away.
const EDGEWISE_SHARE: f64 = 0.65;

/// Largest wake skew angle for which inflow with gradients is modelled, deg.
const LARGEST_SKEW_DEG: f64 = 135.0;

/// Relative residual at which the momentum equation counts as solved.
const TOLERANCE: f64 = 2e-15;

/// Bisection alone would need about 60 steps from the widest bracket.
const MAX_ITERATIONS: usize = 200;

/// Mean induced inflow of a rotor by momentum theory.
///
/// ```text
/// lambda_i = C_T / (2 sqrt(mu^2 + lambda^2)),      lambda = mu tan(alpha_s) + lambda_i
/// ```
/// Returns `lambda_i`, positive down for a positive thrust, from hover through climb and forward
/// flight to the windmill-brake state. Where the equation has several roots (steep descent) the one
/// of smallest magnitude is the flow that leaves upward through the disk, and is returned.
///
/// Assumes: uniform inflow, a wake as wide as the disk. Not modelled: tip loss, induced-power
/// factor, the vortex-ring state.
///
/// # Errors
/// [`WakeError::BadInput`] for numbers that are no flight or no thrust;
/// [`WakeError::VortexRingState`] in descent below [`VORTEX_RING_TRANSPORT`];
/// [`WakeError::NotConverged`] if the root was not found.
///
/// Source: Glauert, ARC R&M 1111 (1926).
pub fn momentum_inflow(flight: &FlightState, thrust_coefficient: f64) -> Result<f64, WakeError> {
    let flight = flight.validated()?;
    ensure_finite("thrust_coefficient", &[thrust_coefficient])?;
    if thrust_coefficient == 0.0 {
        return Ok(0.0);
    }
    // a rotor that thrusts downward is the same flow seen upside down
    let sign = thrust_coefficient.signum();
    let normal = sign * flight.normal_inflow();
    let hover = (0.5 * thrust_coefficient.abs()).sqrt();
    let induced = smallest_root(flight.advance_ratio, normal, hover)?;
    let transport_ratio = flight.advance_ratio.hypot(normal + induced) / hover;
    if normal < 0.0 && transport_ratio < VORTEX_RING_TRANSPORT {
        return Err(WakeError::VortexRingState {
            advance_ratio: flight.advance_ratio,
            normal_inflow: flight.normal_inflow(),
            thrust_coefficient,
            transport_ratio,
            limit: VORTEX_RING_TRANSPORT,
        });
    }
    Ok(sign * induced)
}

/// Speed with which a wake is carried away in descent, over the hover induced velocity; none in level flight and in
/// climb, without thrust, and where momentum theory has no inflow. Below [`WAKE_BREAKDOWN_TRANSPORT`] the wake breaks
/// down into the vortex-ring state.
///
/// ```text
/// sqrt((k mu)^2 + lambda^2) / sqrt(C_T / 2),      k = 0.65
/// ```
/// The stream along the disk carries the wake away less well than that through it. A warning: nothing is refused by it,
/// as below [`VORTEX_RING_TRANSPORT`].
///
/// Source: S. Newman, R. Brown, J. Perry, S. Lewis, M. Orchard, A. Modha, Journal of the American Helicopter Society
/// 48 (2003), boundary of wake breakdown in descending flight.
pub fn descent_transport(flight: &FlightState, thrust_coefficient: f64) -> Option<f64> {
    let sign = thrust_coefficient.signum();
    if sign * flight.normal_inflow() >= 0.0 || thrust_coefficient == 0.0 {
        return None;
    }
    let lambda = flight.normal_inflow() + momentum_inflow(flight, thrust_coefficient).ok()?;
    let along = EDGEWISE_SHARE * flight.advance_ratio;
    Some(along.hypot(lambda) / (0.5 * thrust_coefficient.abs()).sqrt())
}

/// A mean inflow over that of momentum theory; none in descent, where momentum theory is no measure of a wake, and where
/// it has no inflow.
pub fn inflow_over_momentum(
    flight: &FlightState,
    thrust_coefficient: f64,
    mean_inflow: f64,
) -> Option<f64> {
    if descent_transport(flight, thrust_coefficient).is_some() {
        return None;
    }
    Some(mean_inflow / momentum_inflow(flight, thrust_coefficient).ok()?)
}

/// Angle of the wake behind the disk normal, rad: 0 in hover, near `pi/2` in fast forward flight,
/// above `pi/2` where the flow passes the disk upward.
///
/// ```text
/// chi = atan2(mu, lambda),      lambda = mu tan(alpha_s) + lambda_i
/// ```
pub fn wake_skew_rad(flight: &FlightState, induced_inflow: f64) -> f64 {
    flight.advance_ratio.atan2(flight.normal_inflow() + induced_inflow)
}

/// [`wake_skew_rad`] for a model of inflow with gradients.
///
/// # Errors
/// [`WakeError::WakeAboveDisk`] beyond 135 deg.
pub(crate) fn modelled_skew_rad(
    model: &'static str,
    flight: &FlightState,
    induced_inflow: f64,
) -> Result<f64, WakeError> {
    let skew = wake_skew_rad(flight, induced_inflow);
    let (skew_deg, limit_deg) = (skew.to_degrees(), LARGEST_SKEW_DEG);
    if skew_deg > limit_deg {
        return Err(WakeError::WakeAboveDisk { model, skew_deg, limit_deg });
    }
    Ok(skew)
}

/// The interval `(low, high)` that holds the smallest positive root of
/// `x sqrt(mu^2 + (n + x)^2) = h^2` and no other.
///
/// The left side grows with `x`, except between `(3|n| -+ sqrt(n^2 - 8 mu^2)) / 4` if `n < 0`.
fn bracket(mu: f64, normal: f64, hover: f64) -> (f64, f64) {
    // there the speed past the disk is at least h, so the left side is at least h^2
    let high = hover + (-normal).max(0.0);
    let discriminant = normal * normal - 8.0 * mu * mu;
    if normal >= 0.0 || discriminant <= 0.0 {
        return (0.0, high);
    }
    let maximum = 0.25 * (-3.0 * normal - discriminant.sqrt());
    let minimum = 0.25 * (-3.0 * normal + discriminant.sqrt());
    if maximum * mu.hypot(normal + maximum) >= hover * hover {
        (0.0, maximum)
    } else {
        (minimum, high)
    }
}

/// Newton's method on the momentum equation, kept inside a shrinking bracket.
fn smallest_root(mu: f64, normal: f64, hover: f64) -> Result<f64, WakeError> {
    let (mut low, mut high) = bracket(mu, normal, hover);
    let mut x = high;
    let mut relative = f64::INFINITY;
    for _ in 0..MAX_ITERATIONS {
        let through = normal + x;
        let speed = mu.hypot(through);
        let excess = x * speed - hover * hover;
        relative = excess / (hover * hover);
        if relative.abs() <= TOLERANCE {
            return Ok(x);
        }
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - excess * speed / (speed * speed + x * through);
        let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        // neighbouring numbers: this is as near as the arithmetic comes
        if (next - x).abs() <= f64::EPSILON * x.abs() {
            return Ok(next);
        }
        x = next;
    }
    Err(WakeError::NotConverged { iterations: MAX_ITERATIONS, residual: relative, last_inflow: x })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    fn flight(advance_ratio: f64, tilt_deg: f64) -> FlightState {
        FlightState { advance_ratio, shaft_tilt_rad: tilt_deg.to_radians() }
    }

    #[test]
    fn the_stated_flight_point() {
        let flight = flight(0.30, 5.0);
        let induced = momentum_inflow(&flight, 0.0049).unwrap();
        assert_abs_diff_eq!(induced, 0.008_114, epsilon = 5e-7);
        assert_abs_diff_eq!(flight.normal_inflow() + induced, 0.034_360, epsilon = 5e-7);
        assert_abs_diff_eq!(wake_skew_rad(&flight, induced).to_degrees(), 83.47, epsilon = 5e-3);
    }

    #[test]
    fn hover_is_the_square_root() {
        let induced = momentum_inflow(&flight(0.0, 0.0), 0.0049).unwrap();
        assert_relative_eq!(induced, 0.00245_f64.sqrt(), max_relative = 1e-15);
        assert_abs_diff_eq!(induced, 0.049_497, epsilon = 5e-7);
    }

    #[test]
    fn vertical_climb_and_slow_descent_solve_the_quadratic() {
        // almost vertical: the in-plane component is 1e-9 of the normal one
        let tilt = std::f64::consts::FRAC_PI_2 - 1e-9;
        let hover = 0.05;
        for climb in [0.005, 0.02, 0.1, 0.5, -0.005, -0.02] {
            let flight = FlightState {
                advance_ratio: f64::abs(climb) * 1e-9,
                shaft_tilt_rad: tilt.copysign(climb),
            };
            let n = flight.normal_inflow();
            let exact = -0.5 * n + (0.25 * n * n + hover * hover).sqrt();
            let got = momentum_inflow(&flight, 2.0 * hover * hover).unwrap();
            assert_relative_eq!(got, exact, max_relative = 1e-12);
        }
    }

    #[test]
    fn windmill_brake_solves_the_other_quadratic() {
        let hover = 0.05;
        for descent in [2.0001, 2.5, 4.0] {
            let flight = FlightState {
                advance_ratio: 1e-10,
                shaft_tilt_rad: -(descent * hover / 1e-10_f64).atan(),
            };
            let n = -flight.normal_inflow();
            let exact = 0.5 * n - (0.25 * n * n - hover * hover).sqrt();
            let got = momentum_inflow(&flight, 2.0 * hover * hover).unwrap();
            assert_relative_eq!(got, exact, max_relative = 1e-7);
        }
    }

    /// Down a slope of 45 deg the wake is carried away least at the speed of the inflow, and well by both slower and
    /// faster flight.
    #[test]
    fn descending_wakes_are_carried_away_least_at_the_speed_of_the_inflow() {
        let ct = 2.0 * 0.05 * 0.05;
        let at = |mu: f64| descent_transport(&flight(mu * 0.05, -45.0), ct);
        assert!(at(0.2).unwrap() > 0.9, "{:?}", at(0.2));
        assert!(at(0.7).unwrap() < WAKE_BREAKDOWN_TRANSPORT, "{:?}", at(0.7));
        assert!(at(1.0).unwrap() < WAKE_BREAKDOWN_TRANSPORT, "{:?}", at(1.0));
        assert!(at(1.6).unwrap() > WAKE_BREAKDOWN_TRANSPORT, "{:?}", at(1.6));
        // lambda = 0 where the descent is the induced inflow: x mu = 1 with n = -x, x = mu
        assert_relative_eq!(at(1.0).unwrap(), EDGEWISE_SHARE, max_relative = 1e-9);
        assert_eq!(descent_transport(&flight(0.05, 0.0), ct), None);
        assert_eq!(descent_transport(&flight(0.05, 45.0), ct), None);
        assert_eq!(descent_transport(&flight(0.05, -45.0), 0.0), None);
    }

    #[test]
    fn vortex_ring_state_is_named_with_its_numbers() {
        for descent in [0.6, 1.0, 1.5, 1.99] {
            let flight = FlightState {
                advance_ratio: 1e-8,
                shaft_tilt_rad: -(descent * 0.05 / 1e-8_f64).atan(),
            };
            let error = momentum_inflow(&flight, 0.005).unwrap_err();
            let WakeError::VortexRingState { transport_ratio, .. } = error else {
                panic!("descent {descent}: {error}");
            };
            assert!(transport_ratio < VORTEX_RING_TRANSPORT);
            assert!(error.to_string().contains("vortex-ring state"), "{error}");
        }
        // the same descent rate at speed is an ordinary approach
        assert!(momentum_inflow(&flight(0.10, -26.6), 0.005).is_ok());
    }

    #[test]
    fn thrust_downward_is_the_flow_upside_down() {
        let up = momentum_inflow(&flight(0.2, 3.0), 0.006).unwrap();
        let down = momentum_inflow(&flight(0.2, -3.0), -0.006).unwrap();
        assert_eq!(up.to_bits(), (-down).to_bits());
        assert_eq!(momentum_inflow(&flight(0.0, 0.0), 0.0).unwrap().to_bits(), 0);
    }

    #[test]
    fn thrust_that_is_no_number_is_refused() {
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(matches!(
                momentum_inflow(&flight(0.3, 5.0), bad),
                Err(WakeError::BadInput { quantity: "thrust_coefficient", .. })
            ));
        }
    }
}

//! The flow round a body below the rotor: a prolate spheroid in a uniform stream.

use crate::WakeError;
use crate::error::{ensure, ensure_finite};
use crate::vector::{Vec3, add, dot, norm, scale, sub};

/// A body of revolution in the stream of the flight, fixed to the hub: a fuselage or the housing of a test stand. It
/// changes the velocity of the air at the blades and along the wake; the wake does not change the flow round it.
///
/// ```text
/// zeta = (R_1 + R_2) / 2 f,   R_1,2 = distances from the foci,   f^2 = a^2 - b^2,   zeta_0 = a / f
/// phi  = U A [R_1 - R_2 + 2 x acoth zeta] + W B z [zeta / (zeta^2 - 1) - acoth zeta]
/// ```
/// in body axes, with `A` and `B` from no flow through the surface `zeta = zeta_0`. Inside the body the velocity is that of the
/// surface in the same direction from its middle.
///
/// Source: H. Lamb, *Hydrodynamics*, sections 103 to 105.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Half its length `a`, unit `R`.
    pub half_length: f64,
    /// Its largest radius `b`, unit `R`, less than `a`.
    pub radius: f64,
    /// Its middle in hub axes (aft, starboard, up), unit `R`.
    pub middle: Vec3,
    /// Angle of its axis against the plane normal to the shaft, rad, nose up positive.
    pub nose_up_rad: f64,
}

/// Least length over thickness: the foci of a sphere coincide.
const LEAST_FINENESS: f64 = 1.01;

/// Part of the body about its middle that has no direction of its own.
const MIDDLE: f64 = 1e-6;

/// Inverse hyperbolic cotangent.
fn acoth(x: f64) -> f64 {
    0.5 * (2.0 / (x - 1.0)).ln_1p()
}

/// The factor of cross flow, and its slope.
fn cross_flow(zeta: f64) -> [f64; 2] {
    let square = zeta * zeta - 1.0;
    [zeta / square - acoth(zeta), -2.0 / (square * square)]
}

impl Body {
    /// Checks the numbers.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a radius that is not above 0 or a body that is not longer than thick.
    pub fn validate(&self) -> Result<(), WakeError> {
        ensure_finite("middle of the body", &self.middle)?;
        ensure_finite("nose_up_rad of the body", &[self.nose_up_rad])?;
        let Self { half_length, radius, .. } = *self;
        ensure(radius.is_finite() && radius > 0.0, "radius of the body", radius, "more than 0")?;
        let is_long = half_length.is_finite() && half_length >= LEAST_FINENESS * radius;
        ensure(is_long, "half_length of the body", half_length, "1.01 of its radius or more")
    }

    /// What the body adds to the velocity of a uniform stream, hub axes, unit of the stream.
    pub fn velocity(&self, point: Vec3, stream: Vec3) -> Vec3 {
        let (sin, cos) = self.nose_up_rad.sin_cos();
        let [aft, up] = [[cos, 0.0, -sin], [sin, 0.0, cos]];
        let to_body = |v: Vec3| [dot(v, aft), v[1], dot(v, up)];
        let (a, b) = (self.half_length, self.radius);
        let mut at = to_body(sub(point, self.middle));
        let depth = norm([at[0] / a, at[1] / b, at[2] / b]);
        if depth < MIDDLE {
            at = [0.0, 0.0, b];
        } else if depth < 1.0 {
            at = scale(at, 1.0 / depth);
        }
        let focus = (a * a - b * b).sqrt();
        let distances = [sub(at, [focus, 0.0, 0.0]), add(at, [focus, 0.0, 0.0])];
        let [r_1, r_2] = distances.map(norm);
        let [towards_1, towards_2] =
            [scale(distances[0], 1.0 / r_1), scale(distances[1], 1.0 / r_2)];
        let (zeta, surface) = ((r_1 + r_2) / (2.0 * focus), a / focus);
        let slope = scale(add(towards_1, towards_2), 1.0 / (2.0 * focus));
        let square = surface * surface - 1.0;
        let [u, v, w] = to_body(stream);
        let axial = u / (2.0 * (surface / square - acoth(surface)));
        let mut sum = sub(towards_1, towards_2);
        sum[0] += 2.0 * acoth(zeta);
        sum = add(sum, scale(slope, -2.0 * at[0] / (zeta * zeta - 1.0)));
        sum = scale(sum, axial);
        let [of_surface, _] = cross_flow(surface);
        let [factor, rate] = cross_flow(zeta);
        for (axis, speed) in [(1, v), (2, w)] {
            let strength = -speed * surface / (of_surface * surface - 2.0 / square);
            sum[axis] += strength * factor;
            sum = add(sum, scale(slope, strength * rate * at[axis]));
        }
        add(add(scale(aft, sum[0]), [0.0, sum[1], 0.0]), scale(up, sum[2]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    const BODY: Body =
        Body { half_length: 0.5, radius: 0.18, middle: [-0.1, 0.02, -0.4], nose_up_rad: 0.1 };
    const STREAM: Vec3 = [0.15, 0.02, 0.03];

    /// Points on the surface of a body a little larger, and the direction out of it, hub axes.
    fn on_surface(body: &Body, larger: f64) -> impl Iterator<Item = (Vec3, Vec3)> {
        let Body { half_length: a, radius: b, middle, nose_up_rad } = *body;
        let (sin, cos) = nose_up_rad.sin_cos();
        let from_body = move |v: Vec3| [v[0] * cos + v[2] * sin, v[1], v[2] * cos - v[0] * sin];
        (0..200).map(move |k| {
            let (x, turn) = (-0.99 + 1.98 * f64::from(k) / 199.0, 2.4 * f64::from(k));
            let (r, (s, c)) = ((1.0 - x * x).sqrt(), turn.sin_cos());
            let out = [x / a, r * s / b, r * c / b];
            let at = scale([x * a, r * s * b, r * c * b], larger);
            (add(middle, from_body(at)), scale(from_body(out), 1.0 / norm(out)))
        })
    }

    #[test]
    fn nothing_flows_through_the_surface() {
        for (point, out) in on_surface(&BODY, 1.0 + 1e-12) {
            let through = dot(out, add(STREAM, BODY.velocity(point, STREAM)));
            assert_abs_diff_eq!(through, 0.0, epsilon = 1e-9);
            // within the body the velocity of its surface goes on
            let middle = BODY.middle;
            let inside = add(middle, scale(sub(point, middle), 0.4));
            let change = sub(BODY.velocity(inside, STREAM), BODY.velocity(point, STREAM));
            assert_abs_diff_eq!(norm(change), 0.0, epsilon = 1e-9);
        }
        assert!(norm(BODY.velocity(BODY.middle, STREAM)).is_finite());
    }

    /// Neither divergence nor curl: it is the flow of a potential.
    #[test]
    fn the_flow_has_a_potential() {
        let h = 1e-5;
        for (point, _) in on_surface(&BODY, 1.4) {
            let gradient: [Vec3; 3] = std::array::from_fn(|k| {
                let [mut before, mut after] = [point; 2];
                (before[k], after[k]) = (point[k] - h, point[k] + h);
                let change = sub(BODY.velocity(after, STREAM), BODY.velocity(before, STREAM));
                scale(change, 0.5 / h)
            });
            let divergence = gradient[0][0] + gradient[1][1] + gradient[2][2];
            assert_abs_diff_eq!(divergence, 0.0, epsilon = 1e-7);
            for (j, k) in [(0, 1), (1, 2), (2, 0)] {
                assert_abs_diff_eq!(gradient[j][k], gradient[k][j], epsilon = 1e-7);
            }
        }
    }

    /// A sphere is a doublet: half the stream beside it, all of it ahead, and the cube of the distance farther off.
    #[test]
    fn a_body_nearly_round_is_a_sphere() {
        let body =
            Body { half_length: 0.1 * 1.0005, radius: 0.1, middle: [0.0; 3], nose_up_rad: 0.3 };
        for (ahead, beside) in
            [([1.0, 0.0, 0.0], [0.0, 0.0, 1.0]), ([0.0, 0.0, 1.0], [0.0, 1.0, 0.0])]
        {
            for distance in [1.02, 3.0] {
                let of_sphere = 0.5 / f64::powi(distance, 3);
                let at = |direction| body.velocity(scale(direction, 0.1 * distance), ahead);
                assert_abs_diff_eq!(dot(at(beside), ahead), of_sphere, epsilon = 1e-3);
                assert_abs_diff_eq!(dot(at(ahead), ahead), -2.0 * of_sphere, epsilon = 2e-3);
            }
        }
    }

    #[test]
    fn bodies_that_are_none_are_refused() {
        assert!(BODY.validate().is_ok());
        for bad in [
            Body { half_length: 0.18, ..BODY },
            Body { radius: 0.0, ..BODY },
            Body { nose_up_rad: f64::NAN, ..BODY },
        ] {
            assert!(matches!(bad.validate(), Err(WakeError::BadInput { .. })), "{bad:?}");
        }
    }
}

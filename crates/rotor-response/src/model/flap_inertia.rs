//! Inertia of a trailing-edge flap that moves with its blade section and turns about its hinge.
//!
//! A point of the flap at the distance `X` behind the hinge, which lies `d` behind the elastic axis, is
//! in coned blade axes (x outboard, y to the leading edge, z up) at
//!
//! ```text
//! r = ( x - v_x eta - w_x zeta,  v + eta,  w + zeta )
//! (eta, zeta) = -d (cos th, sin th) - X (cos(th + delta), sin(th + delta))
//! a = r'' + 2 O x r' + O x (O x r),    O = (sin bp, 0, cos bp)
//! Q_c = -m a . dr/dc,                  c = v, w, v_x, w_x, th, delta
//! ```
//! `Q_delta` is the inertial hinge moment: d'Alembert, centrifugal (the propeller moment of the flap,
//! and the pull of the radial force on a bent blade) and Coriolis parts together. The loads are those of
//! one Lagrangian, so that their power is what kinetic and centrifugal energy lose.
//!
//! A thin flap on the chord line has the mass, the static moment and the moments of inertia of two
//! equal point masses at `X_f +- k`, `k` its radius of gyration about its centre of gravity.
//!
//! Assumes: slopes to first order in `r`; foreshortening of the blade left out.
//! Source: d'Alembert's principle; the terms of Viswamurthy and Ganguli's flap (mass, centre of gravity
//! behind the hinge) are among them.

/// Motion of a blade section and its flap: value, first and second azimuth derivative of each.
///
/// Radius R and rad. `twist` is the whole pitch angle of the section, nose up.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct FlapSection {
    /// Station, R.
    pub(crate) x: f64,
    /// Precone, rad.
    pub(crate) precone: f64,
    /// Lag deflection and its slope.
    pub(crate) v: [f64; 3],
    pub(crate) v_x: [f64; 3],
    /// Flap deflection and its slope.
    pub(crate) w: [f64; 3],
    pub(crate) w_x: [f64; 3],
    /// Pitch angle `th`.
    pub(crate) twist: [f64; 3],
    /// Flap angle, trailing edge down.
    pub(crate) delta: [f64; 3],
}

/// Inertial loads per length of a flap, or of a part of it: what acts on blade and hinge.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct InertialLoads {
    /// Force `-m a` along x, y, z.
    pub(crate) force: [f64; 3],
    /// Moments that work on the slopes `v_x` and `w_x`.
    pub(crate) slope: [f64; 2],
    /// Nose-up moment about the elastic axis.
    pub(crate) twist: f64,
    /// Hinge moment, positive in the sense of the flap angle.
    pub(crate) hinge: f64,
}

impl InertialLoads {
    fn plus(mut self, other: &Self, factor: f64) -> Self {
        for (a, b) in self.force.iter_mut().zip(other.force) {
            *a += factor * b;
        }
        for (a, b) in self.slope.iter_mut().zip(other.slope) {
            *a += factor * b;
        }
        self.twist += factor * other.twist;
        self.hinge += factor * other.hinge;
        self
    }
}

/// Mass distribution of a flap per length, rotor units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FlapBody {
    /// Mass.
    pub(crate) mass: f64,
    /// Distance of the hinge behind the elastic axis.
    pub(crate) hinge: f64,
    /// Distance of the centre of gravity behind the hinge.
    pub(crate) cg: f64,
    /// Radius of gyration about the centre of gravity.
    pub(crate) gyration: f64,
}

impl FlapBody {
    /// Loads of the whole flap.
    pub(crate) fn loads(&self, section: &FlapSection) -> InertialLoads {
        [self.cg - self.gyration, self.cg + self.gyration]
            .into_iter()
            .map(|arm| point_loads(0.5 * self.mass, self.hinge, arm, section))
            .fold(InertialLoads::default(), |sum, part| sum.plus(&part, 1.0))
    }

    /// Loads of the whole flap less those of its mass on the elastic axis.
    pub(crate) fn loads_off_axis(&self, section: &FlapSection) -> InertialLoads {
        self.loads(section).plus(&point_loads(self.mass, 0.0, 0.0, section), -1.0)
    }

    /// Inertial hinge moment.
    pub(crate) fn hinge_moment(&self, section: &FlapSection) -> f64 {
        self.loads(section).hinge
    }
}

/// A vector along the chord from hinge axis to trailing edge that turns by an angle, with its
/// derivatives: `-length (cos a, sin a)`.
fn chordwise(length: f64, [angle, rate, acceleration]: [f64; 3]) -> [[f64; 2]; 3] {
    let (sin, cos) = angle.sin_cos();
    let along = [-length * cos, -length * sin];
    let across = [length * sin, -length * cos];
    [
        along,
        [rate * across[0], rate * across[1]],
        [
            acceleration * across[0] - rate * rate * along[0],
            acceleration * across[1] - rate * rate * along[1],
        ],
    ]
}

/// Acceleration in a frame that turns with `O = (sin bp, 0, cos bp)`.
fn absolute_acceleration(precone: f64, r: [f64; 3], rd: [f64; 3], rdd: [f64; 3]) -> [f64; 3] {
    let (s, c) = precone.sin_cos();
    let along = s * r[0] + c * r[2];
    [
        rdd[0] - 2.0 * c * rd[1] + s * along - r[0],
        rdd[1] + 2.0 * (c * rd[0] - s * rd[2]) - r[1],
        rdd[2] + 2.0 * s * rd[1] + c * along - r[2],
    ]
}

/// Loads of one point mass.
fn point_loads(mass: f64, hinge: f64, arm: f64, at: &FlapSection) -> InertialLoads {
    let turned = std::array::from_fn(|k| at.twist[k] + at.delta[k]);
    let (blade, flap) = (chordwise(hinge, at.twist), chordwise(arm, turned));
    let eta: [f64; 3] = std::array::from_fn(|k| blade[k][0] + flap[k][0]);
    let zeta: [f64; 3] = std::array::from_fn(|k| blade[k][1] + flap[k][1]);
    let product = |a: &[f64; 3], b: &[f64; 3]| {
        [a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2]]
    };
    let (tilt_v, tilt_w) = (product(&at.v_x, &eta), product(&at.w_x, &zeta));
    let position = |k: usize| {
        let x = if k == 0 { at.x } else { 0.0 };
        [x - tilt_v[k] - tilt_w[k], at.v[k] + eta[k], at.w[k] + zeta[k]]
    };
    let [ax, ay, az] = absolute_acceleration(at.precone, position(0), position(1), position(2));
    // turning about the elastic axis or the hinge moves the point across its arm
    let turning =
        |[y, z]: [f64; 2]| -mass * (ax * (at.v_x[0] * z - at.w_x[0] * y) - ay * z + az * y);
    InertialLoads {
        force: [-mass * ax, -mass * ay, -mass * az],
        slope: [mass * ax * eta[0], mass * ax * zeta[0]],
        twist: turning([eta[0], zeta[0]]),
        hinge: turning(flap[0]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::{assert_abs_diff_eq, assert_relative_eq};

    const BODY: FlapBody = FlapBody { mass: 0.1, hinge: 0.030, cg: 0.0031, gyration: 0.0042 };

    /// A motion of every coordinate, large on purpose.
    fn motion(t: f64) -> FlapSection {
        let wave = |amplitude: f64, n: f64, phase: f64| {
            let (s, c) = (n * t + phase).sin_cos();
            [amplitude * s, amplitude * n * c, -amplitude * n * n * s]
        };
        FlapSection {
            x: 0.8,
            precone: 0.05,
            v: wave(0.03, 1.0, 0.3),
            v_x: wave(0.05, 1.3, 1.0),
            w: wave(0.08, 2.0, 0.7),
            w_x: wave(0.1, 2.2, 0.1),
            twist: wave(0.3, 1.0, 2.0),
            delta: wave(0.2, 4.0, 0.5),
        }
    }

    /// Where the point of the flap at `arm` behind the hinge is, rotating blade axes.
    fn position(t: f64, arm: f64) -> [f64; 3] {
        let m = motion(t);
        let (s, c) = m.twist[0].sin_cos();
        let (sf, cf) = (m.twist[0] + m.delta[0]).sin_cos();
        let (eta, zeta) = (-BODY.hinge * c - arm * cf, -BODY.hinge * s - arm * sf);
        [m.x - m.v_x[0] * eta - m.w_x[0] * zeta, m.v[0] + eta, m.w[0] + zeta]
    }

    const ARMS: [f64; 2] = [BODY.cg - BODY.gyration, BODY.cg + BODY.gyration];

    /// Kinetic energy in the rotating frame less half the square of the frame's velocity.
    fn energy(t: f64) -> f64 {
        let h = 1e-3;
        ARMS.iter()
            .map(|&arm| {
                let at = |k: f64| position(t + k * h, arm);
                let (m2, m1, p1, p2) = (at(-2.0), at(-1.0), at(1.0), at(2.0));
                let speed2: f64 = (0..3)
                    .map(|i| ((m2[i] - p2[i] + 8.0 * (p1[i] - m1[i])) / (12.0 * h)).powi(2))
                    .sum();
                let [x, y, z] = position(t, arm);
                let (s, c) = motion(t).precone.sin_cos();
                let frame2 = y * y + (c * x - s * z).powi(2);
                0.25 * BODY.mass * (speed2 - frame2)
            })
            .sum()
    }

    /// The force is the mass times the acceleration in axes that do not turn: differences of the position
    /// turned by `t` about the shaft. Coriolis forces are in it, which no energy sees.
    #[test]
    fn the_force_is_that_of_axes_that_do_not_turn() {
        let (s, c) = motion(0.0).precone.sin_cos();
        let turned = |angle: f64, r: [f64; 3]| {
            // about the shaft (s, 0, c), counter-clockwise
            let (sin, cos) = angle.sin_cos();
            let along = (s * r[0] + c * r[2]) * (1.0 - cos);
            [
                r[0] * cos - c * r[1] * sin + s * along,
                r[1] * cos + (c * r[0] - s * r[2]) * sin,
                r[2] * cos + s * r[1] * sin + c * along,
            ]
        };
        let h = 2e-3;
        for t in [0.3, 1.7, 3.9] {
            let mut expected = [0.0; 3];
            for arm in ARMS {
                // in axes that stand where the blade's are at t
                let at = |k: f64| turned(k * h, position(t + k * h, arm));
                let (m2, m1, now, p1, p2) = (at(-2.0), at(-1.0), at(0.0), at(1.0), at(2.0));
                for (i, sum) in expected.iter_mut().enumerate() {
                    let second = 16.0 * (m1[i] + p1[i]) - m2[i] - p2[i] - 30.0 * now[i];
                    *sum -= 0.5 * BODY.mass * second / (12.0 * h * h);
                }
            }
            for (got, wanted) in BODY.loads(&motion(t)).force.iter().zip(expected) {
                assert_abs_diff_eq!(*got, wanted, epsilon = 1e-9);
            }
        }
    }

    /// The loads' power is what the energy of the rotating frame loses: Coriolis forces do no work.
    #[test]
    fn the_power_of_the_loads_is_the_loss_of_energy() {
        for t in [0.0, 0.4, 1.1, 2.9, 4.4] {
            let (m, loads) = (motion(t), BODY.loads(&motion(t)));
            let power = loads.force[1] * m.v[1]
                + loads.force[2] * m.w[1]
                + loads.slope[0] * m.v_x[1]
                + loads.slope[1] * m.w_x[1]
                + loads.twist * m.twist[1]
                + loads.hinge * m.delta[1];
            let h = 1e-3;
            let rate = (energy(t - 2.0 * h) - energy(t + 2.0 * h)
                + 8.0 * (energy(t + h) - energy(t - h)))
                / (12.0 * h);
            assert_abs_diff_eq!(power, -rate, epsilon = 1e-10);
            assert!(rate.abs() > 1e-5, "the test sees something: {rate:e}");
        }
    }

    /// Hinge moment of a flap on a blade that does not move, driven by itself: the moment of inertia
    /// about the hinge times the acceleration, and the centrifugal part of the flap angle.
    #[test]
    fn a_flap_on_a_rigid_blade() {
        let (delta, acceleration) = (1e-4, -1.6e-3);
        let section =
            FlapSection { x: 0.8, delta: [delta, 0.0, acceleration], ..FlapSection::default() };
        let inertia = BODY.mass * (BODY.gyration.powi(2) + BODY.cg.powi(2));
        // the frame pulls a point at y with m y away from the axis: back to delta = 0
        let centrifugal = BODY.mass * BODY.hinge * BODY.cg + inertia;
        assert_relative_eq!(
            BODY.hinge_moment(&section),
            -inertia * acceleration - centrifugal * delta,
            max_relative = 1e-7
        );
    }

    /// On a blade that slopes and accelerates up the flap stays behind, trailing edge down:
    /// `m X (w'' + x w_x)`.
    #[test]
    fn a_flap_on_a_flapping_blade() {
        let section = FlapSection {
            x: 0.8,
            w: [0.0, 0.0, 2e-3],
            w_x: [1e-3, 0.0, 0.0],
            ..FlapSection::default()
        };
        let first = BODY.mass * BODY.cg;
        assert_relative_eq!(
            BODY.hinge_moment(&section),
            first * (2e-3 + 0.8 * 1e-3),
            max_relative = 1e-3
        );
    }

    /// What the flap angle adds at zero pitch is the first-order form that the blade's equations carry,
    /// to second order in the angles; but for the centrifugal moment `I_cg delta` of the flap's own inertia,
    /// which that form leaves out (1 % of it at 4/rev).
    #[test]
    fn the_first_order_form_is_its_limit() {
        let gap = |scale: f64| {
            let section = FlapSection {
                x: 0.8,
                delta: [scale, 0.0, -16.0 * scale],
                twist: [scale, 0.0, 0.0],
                ..FlapSection::default()
            };
            let rest = FlapSection { delta: [0.0; 3], ..section };
            let [moving, still] = [section, rest].map(|s| BODY.loads(&s));
            let arm = BODY.mass * (BODY.hinge + BODY.cg) * BODY.cg;
            let own = BODY.mass * BODY.gyration.powi(2);
            let force = BODY.mass * BODY.cg * section.delta[2];
            let form = -(arm + own) * section.delta[2] - arm * section.delta[0];
            let twist = form - own * section.delta[0];
            assert!((twist / form - 1.0).abs() < 0.011);
            let parts = [
                (moving.force[2] - still.force[2] - force) / force,
                (moving.twist - still.twist - twist) / twist,
            ];
            parts.map(f64::abs)
        };
        let [coarse, fine] = [gap(0.02), gap(0.01)];
        println!("{coarse:?} {fine:?}");
        for (c, f) in coarse.iter().zip(fine) {
            assert!(*c < 0.02 && f < 0.3 * c, "{coarse:?} {fine:?}");
        }
    }
}

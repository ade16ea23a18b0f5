//! Equilibrium of the helicopter: pure functions of the mean hub loads.

use crate::TrimError;

/// The helicopter around the rotor. Lengths in radius R.
///
/// All values are assumptions: the paper does not give them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vehicle {
    /// Equivalent flat-plate area of the fuselage over the disk area, `f/A`.
    pub drag_area: f64,
    /// Distance of the centre of gravity below the hub, along the shaft.
    pub cg_below_hub: f64,
    /// Distance of the hub behind the centre of gravity, aft positive.
    pub hub_aft_of_cg: f64,
    /// Distance of the hub to starboard of the centre of gravity.
    pub hub_starboard_of_cg: f64,
    /// Distance of the tail rotor behind the centre of gravity.
    pub tail_rotor_arm: f64,
    /// Height of the tail rotor above the centre of gravity.
    pub tail_rotor_height: f64,
    /// Horizontal tail.
    pub horizontal_tail: HorizontalTail,
}

/// A horizontal tail in the undisturbed stream: no downwash of rotor or fuselage, no stall, no drag.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HorizontalTail {
    /// Area over the disk area, `S_t/A`; zero is no tail.
    pub area: f64,
    /// Distance behind the centre of gravity, radius R.
    pub arm: f64,
    /// Height above the centre of gravity, radius R.
    pub height: f64,
    /// Incidence against the plane normal to the shaft, rad, nose up positive.
    pub incidence_rad: f64,
    /// Lift slope, per rad.
    pub lift_slope: f64,
}

impl HorizontalTail {
    /// No tail: area zero, 1.2 R behind the centre of gravity, lift slope 4 per rad.
    pub const NONE: Self =
        Self { area: 0.0, arm: 1.2, height: 0.0, incidence_rad: 0.0, lift_slope: 4.0 };
}

impl Default for Vehicle {
    /// `f/A` .01, centre of gravity .2 R under the hub, tail rotor 1.2 R behind and .2 R above it, no
    /// horizontal tail.
    fn default() -> Self {
        Self {
            drag_area: 0.01,
            cg_below_hub: 0.2,
            hub_aft_of_cg: 0.0,
            hub_starboard_of_cg: 0.0,
            tail_rotor_arm: 1.2,
            tail_rotor_height: 0.2,
            horizontal_tail: HorizontalTail::NONE,
        }
    }
}

impl Vehicle {
    /// Checks every value.
    ///
    /// # Errors
    /// [`TrimError::Parameter`] for the first value out of range.
    pub fn validate(&self) -> Result<(), TrimError> {
        let tail = &self.horizontal_tail;
        for (field, value, [low, high], expected) in [
            ("drag_area", self.drag_area, [0.0, 1.0], "0 to 1 disk area"),
            ("cg_below_hub", self.cg_below_hub, [0.0, 2.0], "0 to 2 R"),
            ("hub_aft_of_cg", self.hub_aft_of_cg, [-1.0, 1.0], "-1 to 1 R"),
            ("hub_starboard_of_cg", self.hub_starboard_of_cg, [-1.0, 1.0], "-1 to 1 R"),
            ("tail_rotor_arm", self.tail_rotor_arm, [0.1, 5.0], "0.1 to 5 R"),
            ("tail_rotor_height", self.tail_rotor_height, [-2.0, 2.0], "-2 to 2 R"),
            ("horizontal_tail.area", tail.area, [0.0, 0.2], "0 to 0.2 disk areas"),
            ("horizontal_tail.arm", tail.arm, [-5.0, 5.0], "-5 to 5 R"),
            ("horizontal_tail.height", tail.height, [-2.0, 2.0], "-2 to 2 R"),
            ("horizontal_tail.incidence_rad", tail.incidence_rad, [-0.5, 0.5], "-0.5 to 0.5 rad"),
            ("horizontal_tail.lift_slope", tail.lift_slope, [0.0, 10.0], "0 to 10 per rad"),
        ] {
            if !(value >= low && value <= high) {
                return Err(TrimError::Parameter { field, value, expected });
            }
        }
        Ok(())
    }
}

/// Attitude and tail rotor of the helicopter.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Attitude {
    /// Forward tilt of the shaft, rad, forward positive.
    pub shaft_tilt_rad: f64,
    /// Bank to starboard, rad, right positive.
    pub roll_rad: f64,
    /// Tail rotor thrust to starboard, `m0 Omega^2 R^2`.
    pub tail_thrust: f64,
}

/// Sum of forces and moments on the helicopter in steady level flight.
///
/// ```text
/// forward   T sin a - D - H cos a
/// up        (T cos a + H sin a) cos f - Y sin f + L_t cos f - W
/// starboard (T cos a + H sin a) sin f + Y cos f + T_tr + L_t sin f
/// pitch     M_Y + H h - T x_h + L_t (h_t sin a - x_t cos a)   (nose up)
/// roll      M_X - Y h + T y_h - T_tr h_tr    (about X aft: starboard side up)
/// yaw       M_Z + Y x_h - H y_h + T_tr x_tr
/// ```
/// | argument | meaning | unit |
/// |---|---|---|
/// | `hub_mean` | mean hub loads `H, Y, T, M_X, M_Y, M_Z` in shaft axes (X aft, Y starboard, Z up) | `m0 Omega^2 R^2` (`R^3`) |
/// | `weight` | `W` | `m0 Omega^2 R^2` |
/// | `airframe` | `D` and the lift `L_t` of the horizontal tail | `m0 Omega^2 R^2` |
///
/// `a` shaft tilt forward, `f` bank right, `h` the distance of the centre of gravity below the hub,
/// `x_h`, `y_h` the hub's offset aft and to starboard, `x_t`, `h_t` the tail's aft and above the centre
/// of gravity.
/// Source: the six equations of coupled trim, Johnson, Helicopter Theory (1980), section 5-4, with the
/// roll moment written about the aft axis.
pub fn equilibrium(
    hub_mean: [f64; 6],
    attitude: &Attitude,
    vehicle: &Vehicle,
    weight: f64,
    airframe: AirframeLoads,
) -> [f64; 6] {
    let [h_force, y_force, thrust, mx, my, mz] = hub_mean;
    let (sin_a, cos_a) = attitude.shaft_tilt_rad.sin_cos();
    let (sin_f, cos_f) = attitude.roll_rad.sin_cos();
    let tail = attitude.tail_thrust;
    let AirframeLoads { drag, tail_lift } = airframe;
    let plane = &vehicle.horizontal_tail;
    let below = vehicle.cg_below_hub;
    // along the fuselage, normal to the flight path
    let lifted = thrust * cos_a + h_force * sin_a;
    [
        thrust * sin_a - drag - h_force * cos_a,
        lifted * cos_f - y_force * sin_f + tail_lift * cos_f - weight,
        lifted * sin_f + y_force * cos_f + tail + tail_lift * sin_f,
        my + h_force * below - thrust * vehicle.hub_aft_of_cg
            + tail_lift * (plane.height * sin_a - plane.arm * cos_a),
        mx - y_force * below + thrust * vehicle.hub_starboard_of_cg
            - tail * vehicle.tail_rotor_height,
        mz + y_force * vehicle.hub_aft_of_cg - h_force * vehicle.hub_starboard_of_cg
            + tail * vehicle.tail_rotor_arm,
    ]
}

/// Loads of the airframe in steady level flight, `m0 Omega^2 R^2`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct AirframeLoads {
    /// Drag of the fuselage, along the flight path.
    pub drag: f64,
    /// Lift of the horizontal tail, up and normal to the flight path.
    pub tail_lift: f64,
}

impl AirframeLoads {
    /// Drag and tail lift of a vehicle at an advance ratio and shaft tilt.
    ///
    /// ```text
    /// q A  = (1/2) (rho c R/m0) (R/c) pi (V / Omega R)^2,   V / Omega R = mu / cos a
    /// D    = q A (f/A),    L_t = q A (S_t/A) a_t (i_t - a)
    /// ```
    /// | argument | meaning | unit |
    /// |---|---|---|
    /// | `density_chord` | `rho c R/m0` | - |
    /// | `chord` | `c/R` | - |
    /// | `advance_ratio` | `mu`, the in-plane component of the flight speed | tip speed |
    /// | `shaft_tilt_rad` | `a`, forward positive | rad |
    ///
    /// Source: Johnson, Helicopter Theory (1980), section 5-4; the tail sees the flight speed alone.
    pub fn of(
        vehicle: &Vehicle,
        density_chord: f64,
        chord: f64,
        advance_ratio: f64,
        shaft_tilt_rad: f64,
    ) -> Self {
        let speed = advance_ratio / shaft_tilt_rad.cos();
        let pressure = 0.5 * density_chord / chord * std::f64::consts::PI * speed * speed;
        let tail = &vehicle.horizontal_tail;
        let angle = tail.incidence_rad - shaft_tilt_rad;
        Self {
            drag: pressure * vehicle.drag_area,
            tail_lift: pressure * tail.area * tail.lift_slope * angle,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// A thrust along the shaft through the centre of gravity, no drag and no torque: balance is the
    /// weight alone.
    #[test]
    fn a_hovering_thrust_carries_the_weight() {
        let e = equilibrium(
            [0.0, 0.0, 2.0, 0.0, 0.0, 0.0],
            &Attitude::default(),
            &Vehicle::default(),
            2.0,
            AirframeLoads::default(),
        );
        assert!(e.iter().all(|r| r.abs() < 1e-15), "{e:?}");
    }

    /// Moments of the forces about the centre of gravity, by the cross product.
    #[test]
    fn moments_are_those_of_the_cross_product() {
        let vehicle =
            Vehicle { hub_aft_of_cg: 0.07, hub_starboard_of_cg: -0.03, ..Vehicle::default() };
        let hub = [0.3, -0.2, 1.1, 0.05, 0.04, -0.06];
        let attitude = Attitude { tail_thrust: 0.09, ..Attitude::default() };
        let cross = |r: [f64; 3], f: [f64; 3]| {
            [r[1] * f[2] - r[2] * f[1], r[2] * f[0] - r[0] * f[2], r[0] * f[1] - r[1] * f[0]]
        };
        let at_hub = cross([0.07, -0.03, 0.2], [hub[0], hub[1], hub[2]]);
        let at_tail = cross([1.2, 0.0, 0.2], [0.0, 0.09, 0.0]);
        let e = equilibrium(hub, &attitude, &vehicle, 1.0, AirframeLoads::default());
        assert_abs_diff_eq!(e[4], hub[3] + at_hub[0] + at_tail[0], epsilon = 1e-15);
        assert_abs_diff_eq!(e[3], hub[4] + at_hub[1] + at_tail[1], epsilon = 1e-15);
        assert_abs_diff_eq!(e[5], hub[5] + at_hub[2] + at_tail[2], epsilon = 1e-15);
    }

    /// The three forces are one rotation of the hub's: what is seen of it keeps its length, and gravity pulls along the
    /// line that is called up.
    #[test]
    fn forces_are_a_rotation_of_those_of_the_hub() {
        for (tilt, roll) in [(0.0, 0.0), (0.12, -0.05), (-0.4, 0.9), (0.7, -0.6)] {
            let attitude = Attitude { shaft_tilt_rad: tilt, roll_rad: roll, tail_thrust: 0.0 };
            let seen = |hub: [f64; 3]| {
                let loads = [hub[0], hub[1], hub[2], 0.0, 0.0, 0.0];
                let none = AirframeLoads::default();
                let e = equilibrium(loads, &attitude, &Vehicle::default(), 0.0, none);
                nalgebra::Vector3::new(e[0], e[1], e[2])
            };
            let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(seen);
            for (i, a) in axes.iter().enumerate() {
                for (j, b) in axes.iter().enumerate() {
                    assert_abs_diff_eq!(a.dot(b), f64::from(u8::from(i == j)), epsilon = 1e-15);
                }
            }
            // as `RotorSolver` has gravity
            let up = [tilt.sin() * roll.cos(), -roll.sin(), tilt.cos() * roll.cos()];
            assert_abs_diff_eq!(seen(up)[1], 1.0, epsilon = 1e-15);
        }
    }

    #[test]
    fn drag_in_thrust_coefficient_is_half_mu_squared_area() {
        // C_D = D / (rho pi R^2 (Omega R)^2) = (f/A) (V/Omega R)^2 / 2
        let (rc, c) = (0.2759, 0.055);
        let to_coefficient = c / (std::f64::consts::PI * rc);
        let d = AirframeLoads::of(&Vehicle::default(), rc, c, 0.3, 0.0).drag;
        assert_abs_diff_eq!(d * to_coefficient, 0.5 * 0.3 * 0.3 * 0.01, epsilon = 1e-15);
    }

    /// The lift of the tail written as a vector in shaft axes, its moment by the cross product.
    #[test]
    fn tail_lift_is_normal_to_the_flight_path() {
        let tail = HorizontalTail {
            area: 0.01,
            arm: 1.1,
            height: 0.3,
            incidence_rad: -0.04,
            ..HorizontalTail::NONE
        };
        let vehicle = Vehicle { horizontal_tail: tail, drag_area: 0.0, ..Vehicle::default() };
        let attitude = Attitude { shaft_tilt_rad: 0.12, roll_rad: -0.05, tail_thrust: 0.0 };
        let air = AirframeLoads::of(&vehicle, 0.2759, 0.055, 0.3, 0.12);
        // q S a (i - alpha), q A = 16.6.. in these units, down because the nose is down
        let dynamic = 0.5 * 0.2759 / 0.055 * std::f64::consts::PI * (0.3 / 0.12_f64.cos()).powi(2);
        assert_abs_diff_eq!(air.tail_lift, -0.16 * 4.0 * 0.01 * dynamic, epsilon = 1e-15);
        let e = equilibrium([0.0; 6], &attitude, &vehicle, 0.0, air);
        let lift = air.tail_lift;
        // forward nothing, up and starboard the banked lift
        assert_abs_diff_eq!(e[0], 0.0, epsilon = 1e-15);
        assert_abs_diff_eq!(e[1].hypot(e[2]), lift.abs(), epsilon = 1e-15);
        // in shaft axes: X aft = L sin a, Z up = L cos a; the moment about Y is z F_x - x F_z
        let [x, z] = [lift * 0.12_f64.sin(), lift * 0.12_f64.cos()];
        assert_abs_diff_eq!(e[3], 0.3 * x - 1.1 * z, epsilon = 1e-15);
        assert!(e[3] > 0.0, "a tail pressed down lifts the nose");
        assert!(e[4].abs() + e[5].abs() < 1e-15);
    }
}

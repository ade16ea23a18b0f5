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
}

impl Default for Vehicle {
    /// `f/A` .01, centre of gravity .2 R under the hub, tail rotor 1.2 R behind and .2 R above it.
    fn default() -> Self {
        Self {
            drag_area: 0.01,
            cg_below_hub: 0.2,
            hub_aft_of_cg: 0.0,
            hub_starboard_of_cg: 0.0,
            tail_rotor_arm: 1.2,
            tail_rotor_height: 0.2,
        }
    }
}

impl Vehicle {
    /// Checks every value.
    ///
    /// # Errors
    /// [`TrimError::Parameter`] for the first value out of range.
    pub fn validate(&self) -> Result<(), TrimError> {
        let check = |field, value: f64, low: f64, high: f64, expected| {
            if value >= low && value <= high {
                Ok(())
            } else {
                Err(TrimError::Parameter { field, value, expected })
            }
        };
        check("drag_area", self.drag_area, 0.0, 1.0, "0 to 1 disk area")?;
        check("cg_below_hub", self.cg_below_hub, 0.0, 2.0, "0 to 2 R")?;
        check("hub_aft_of_cg", self.hub_aft_of_cg, -1.0, 1.0, "-1 to 1 R")?;
        check("hub_starboard_of_cg", self.hub_starboard_of_cg, -1.0, 1.0, "-1 to 1 R")?;
        check("tail_rotor_arm", self.tail_rotor_arm, 0.1, 5.0, "0.1 to 5 R")?;
        check("tail_rotor_height", self.tail_rotor_height, -2.0, 2.0, "-2 to 2 R")
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
/// up        T cos a cos f + H sin a - Y sin f - W
/// starboard Y cos f + T sin f cos a + T_tr
/// pitch     M_Y + H h - T x_h                (nose up)
/// roll      M_X - Y h + T y_h - T_tr h_tr    (about X aft: starboard side up)
/// yaw       M_Z + Y x_h - H y_h + T_tr x_tr
/// ```
/// | argument | meaning | unit |
/// |---|---|---|
/// | `hub_mean` | mean hub loads `H, Y, T, M_X, M_Y, M_Z` in shaft axes (X aft, Y starboard, Z up) | `m0 Omega^2 R^2` (`R^3`) |
/// | `weight`, `drag` | `W`, `D` | `m0 Omega^2 R^2` |
///
/// `a` shaft tilt forward, `f` bank right, `h` the distance of the centre of gravity below the hub,
/// `x_h`, `y_h` the hub's offset aft and to starboard.
/// Source: the six equations of coupled trim, Johnson, Helicopter Theory (1980), section 5-4, with the
/// roll moment written about the aft axis.
pub fn equilibrium(
    hub_mean: [f64; 6],
    attitude: &Attitude,
    vehicle: &Vehicle,
    weight: f64,
    drag: f64,
) -> [f64; 6] {
    let [h_force, y_force, thrust, mx, my, mz] = hub_mean;
    let (sin_a, cos_a) = attitude.shaft_tilt_rad.sin_cos();
    let (sin_f, cos_f) = attitude.roll_rad.sin_cos();
    let tail = attitude.tail_thrust;
    let below = vehicle.cg_below_hub;
    [
        thrust * sin_a - drag - h_force * cos_a,
        thrust * cos_a * cos_f + h_force * sin_a - y_force * sin_f - weight,
        y_force * cos_f + thrust * sin_f * cos_a + tail,
        my + h_force * below - thrust * vehicle.hub_aft_of_cg,
        mx - y_force * below + thrust * vehicle.hub_starboard_of_cg
            - tail * vehicle.tail_rotor_height,
        mz + y_force * vehicle.hub_aft_of_cg - h_force * vehicle.hub_starboard_of_cg
            + tail * vehicle.tail_rotor_arm,
    ]
}

/// Fuselage drag `D = rho V^2 f / 2` in `m0 Omega^2 R^2`.
///
/// ```text
/// D = (1/2) (rho c R/m0) (R/c) pi (f/A) (V / Omega R)^2,   V / Omega R = mu / cos a
/// ```
/// `mu` is the in-plane component of the flight speed, `a` the shaft tilt.
pub fn fuselage_drag(
    density_chord: f64,
    chord: f64,
    drag_area: f64,
    advance_ratio: f64,
    shaft_tilt_rad: f64,
) -> f64 {
    let speed = advance_ratio / shaft_tilt_rad.cos();
    0.5 * density_chord / chord * std::f64::consts::PI * drag_area * speed * speed
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
            0.0,
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
        let e = equilibrium(hub, &attitude, &vehicle, 1.0, 0.0);
        assert_abs_diff_eq!(e[4], hub[3] + at_hub[0] + at_tail[0], epsilon = 1e-15);
        assert_abs_diff_eq!(e[3], hub[4] + at_hub[1] + at_tail[1], epsilon = 1e-15);
        assert_abs_diff_eq!(e[5], hub[5] + at_hub[2] + at_tail[2], epsilon = 1e-15);
    }

    #[test]
    fn drag_in_thrust_coefficient_is_half_mu_squared_area() {
        // C_D = D / (rho pi R^2 (Omega R)^2) = (f/A) (V/Omega R)^2 / 2
        let (rc, c) = (0.2759, 0.055);
        let to_coefficient = c / (std::f64::consts::PI * rc);
        let d = fuselage_drag(rc, c, 0.01, 0.3, 0.0);
        assert_abs_diff_eq!(d * to_coefficient, 0.5 * 0.3 * 0.3 * 0.01, epsilon = 1e-15);
    }
}

//! Rotating and fixed frames.

/// A vector of the rotating blade frame (x outboard, y toward the leading edge, z up) in hub axes
/// (X aft, Y starboard, Z up) for a blade at `azimuth_rad`.
///
/// ```text
/// F_X = F_x cos psi - F_y sin psi,   F_Y = F_x sin psi + F_y cos psi,   F_Z = F_z
/// ```
/// The same holds for moments. Any unit; the unit is kept.
pub fn rotating_to_fixed(azimuth_rad: f64, rotating: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = azimuth_rad.sin_cos();
    let [x, y, z] = rotating;
    [x * cos - y * sin, x * sin + y * cos, z]
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_starboard_blade_points_to_starboard() {
        let f = rotating_to_fixed(FRAC_PI_2, [1.0, 0.0, 2.0]);
        assert_abs_diff_eq!(f[0], 0.0, epsilon = 1e-15);
        assert_abs_diff_eq!(f[1], 1.0, epsilon = 1e-15);
        assert_abs_diff_eq!(f[2], 2.0, epsilon = 0.0);
        // the leading edge of the starboard (advancing) blade faces forward, which is -X
        assert_abs_diff_eq!(rotating_to_fixed(FRAC_PI_2, [0.0, 1.0, 0.0])[0], -1.0);
    }
}

//! Nondimensional groups of a rotor.

use crate::BaseError;

/// Reference quantities that make blade and hub loads nondimensional.
///
/// ```text
/// forces  by m0 Omega^2 R^2      moments by m0 Omega^2 R^3      stiffness EI by m0 Omega^2 R^4
/// ```
/// Source: Viswamurthy and Ganguli, Table 1 and section 5.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorScales {
    omega_rad_s: f64,
    radius_m: f64,
    mass_kg_m: f64,
}

impl RotorScales {
    /// Scales from rotor speed (rad/s), radius (m) and reference mass per length (kg/m).
    ///
    /// # Errors
    /// [`BaseError::NotPositive`] if a value is not a positive finite number.
    pub fn new(omega_rad_s: f64, radius_m: f64, mass_kg_m: f64) -> Result<Self, BaseError> {
        for (quantity, value) in
            [("omega_rad_s", omega_rad_s), ("radius_m", radius_m), ("mass_kg_m", mass_kg_m)]
        {
            if !(value.is_finite() && value > 0.0) {
                return Err(BaseError::NotPositive { quantity, value });
            }
        }
        Ok(Self { omega_rad_s, radius_m, mass_kg_m })
    }

    /// The same of values that are positive and finite already, as those of a checked case; of others the units
    /// are of no use.
    pub fn of_checked(omega_rad_s: f64, radius_m: f64, mass_kg_m: f64) -> Self {
        Self { omega_rad_s, radius_m, mass_kg_m }
    }

    /// Rotor speed, rad/s.
    pub fn omega_rad_s(&self) -> f64 {
        self.omega_rad_s
    }

    /// Rotor radius, m.
    pub fn radius_m(&self) -> f64 {
        self.radius_m
    }

    /// Reference mass per length `m0`, kg/m.
    pub fn mass_kg_m(&self) -> f64 {
        self.mass_kg_m
    }

    /// Rotor speed in revolutions per second.
    pub fn rev_hz(&self) -> f64 {
        self.omega_rad_s / std::f64::consts::TAU
    }

    /// Tip speed `Omega R`, m/s.
    pub fn tip_speed_m_s(&self) -> f64 {
        self.omega_rad_s * self.radius_m
    }

    /// Force unit `m0 Omega^2 R^2`, N.
    pub fn force_newton(&self) -> f64 {
        self.mass_kg_m * self.tip_speed_m_s().powi(2)
    }

    /// Moment unit `m0 Omega^2 R^3`, N m.
    pub fn moment_newton_metre(&self) -> f64 {
        self.force_newton() * self.radius_m
    }

    /// Bending stiffness unit `m0 Omega^2 R^4`, N m^2.
    pub fn stiffness_newton_metre2(&self) -> f64 {
        self.moment_newton_metre() * self.radius_m
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn table_1_rotor_in_numbers() {
        let s = RotorScales::new(383.0 * std::f64::consts::TAU / 60.0, 4.94, 6.46).unwrap();
        assert_relative_eq!(s.omega_rad_s(), 40.108, max_relative = 1e-5);
        assert_relative_eq!(s.tip_speed_m_s(), 198.1, max_relative = 2e-4);
        assert_relative_eq!(s.force_newton(), 253.6e3, max_relative = 2e-4);
        assert_relative_eq!(s.moment_newton_metre(), 1.2528e6, max_relative = 1e-4);
        assert_relative_eq!(s.stiffness_newton_metre2(), 6.1886e6, max_relative = 1e-4);
        assert_relative_eq!(s.rev_hz(), 383.0 / 60.0, max_relative = 1e-14);
    }

    #[test]
    fn rejects_what_is_no_rotor() {
        assert!(RotorScales::new(0.0, 1.0, 1.0).is_err());
        assert!(RotorScales::new(1.0, -1.0, 1.0).is_err());
        assert!(RotorScales::new(1.0, 1.0, f64::NAN).is_err());
    }
}

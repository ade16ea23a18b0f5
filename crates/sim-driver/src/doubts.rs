//! What a case asks for that can be, but hardly is meant: warnings of `hhc check` and `hhc run`.

use crate::SimError;
use crate::case::{LoadedCase, TrimValues};
use crate::problem::{Fault, Problem};
use rotor_response::{CoupledBladeMode, Rotor, RotorSolution};
use trim::mean_lift_coefficient;

/// Bending and torsion stiffness below which a blade is a rope, over `m0 Omega^2 R^4`: a hundredth of the
/// softest articulated blades.
const LEAST_STIFFNESS: f64 = 2e-5;

/// Mean lift coefficient above which rotors stall: `C_T/sigma` of 0.15 in hover, and 0.17 at an advance ratio
/// of 0.3, which is beyond the limits of thrust measured in wind tunnels.
///
/// Source: F. J. `McHugh`, 34th Annual Forum of the American Helicopter Society (1978).
const STALLING_LIFT_COEFFICIENT: f64 = 0.9;

impl LoadedCase {
    /// Doubts about the case alone, each with its place: values, thrust, and modes at a harmonic at the
    /// collective of a prescribed trim, else at none.
    ///
    /// # Errors
    /// [`SimError::Blade`] and [`SimError::Response`] if the rotor cannot be built.
    pub fn doubts(&self) -> Result<Vec<String>, SimError> {
        let case = &self.case;
        let mut doubts = self.value_doubts();
        let pitch_rad = match case.trim {
            TrimValues::Propulsive { ct_sigma, .. } | TrimValues::WindTunnel { ct_sigma, .. } => {
                doubts.extend(self.lift_doubt(ct_sigma));
                0.0
            }
            TrimValues::Prescribed { theta0_rad, .. } => theta0_rad,
        };
        let blade = case.blade_properties()?;
        let rotor = Rotor::new(case.rotor_model(), &blade, case.discretisation());
        let rotor = rotor.map_err(|source| {
            let place = self.index.place("rotor");
            SimError::Response { place, source }
        })?;
        doubts.extend(self.resonance_doubt(&rotor, (pitch_rad, None))?);
        Ok(doubts)
    }

    /// Doubts about what the trim of the case has found.
    ///
    /// # Errors
    /// [`SimError::Response`] if the coupled modes cannot be found.
    pub(crate) fn doubts_in_flight(
        &self,
        rotor: &Rotor,
        (theta0_rad, found): (f64, &RotorSolution),
    ) -> Result<Vec<String>, SimError> {
        let mut doubts = self.value_doubts();
        doubts.extend(self.lift_doubt(found.thrust_coefficient / rotor.model().solidity()));
        doubts.extend(self.resonance_doubt(rotor, (theta0_rad, Some(found)))?);
        Ok(doubts)
    }

    fn doubt(&self, field: &str, message: String) -> String {
        Problem::new(self.index.place(field), Fault::Doubtful { message }).to_string()
    }

    /// Stiffness and radii of a section that no blade has.
    fn value_doubts(&self) -> Vec<String> {
        let file = &self.file.rotor;
        let mut doubts = Vec::new();
        let soft = |value: f64| {
            format!(
                "the stiffness {value:e} m0 Omega^2 R^4 is less than {LEAST_STIFFNESS:e}, a hundredth of the softest blade's: the blade is a rope that rotation alone holds, and its curvature at the root is not resolved. Is the value over m0 Omega^2 R^4? The paper's blade has 0.0108 in flap, 0.0268 in lag, 0.00615 in torsion"
            )
        };
        for (key, value, table) in [
            ("ei_flap", file.ei_flap, &file.tables.ei_flap),
            ("ei_lag", file.ei_lag, &file.tables.ei_lag),
            ("gj", file.gj, &file.tables.gj),
        ] {
            // a table takes the place of the uniform value
            if table.is_empty() && value < LEAST_STIFFNESS {
                doubts.push(self.doubt(&format!("rotor.{key}"), soft(value)));
            }
            let below = table.iter().position(|(_, value)| *value < LEAST_STIFFNESS);
            if let Some(i) = below {
                doubts.push(self.doubt(&format!("rotor.tables.{key}[{i}]"), soft(table[i].1)));
            }
        }
        let tables = !file.tables.km1_r.is_empty() || !file.tables.km2_r.is_empty();
        if !tables && file.km1_r > file.km2_r {
            let message = format!(
                "the mass radius about the chord line, {} R, is larger than that about its normal, km2_r {} R: the section would be thicker than it is deep, and its propeller moment would turn it out of flat pitch. Are the two exchanged?",
                file.km1_r, file.km2_r
            );
            doubts.push(self.doubt("rotor.km1_r", message));
        }
        doubts
    }

    /// A thrust at which real sections stall, carried by sections that cannot.
    fn lift_doubt(&self, ct_sigma: f64) -> Option<String> {
        if !self.case.rotor_model().nonlinear.is_linear() {
            return None;
        }
        let lift = mean_lift_coefficient(ct_sigma, self.case.advance_ratio);
        let field = match self.case.trim {
            TrimValues::Prescribed { .. } => "trim.theta0_deg",
            TrimValues::Propulsive { .. } | TrimValues::WindTunnel { .. } => "trim.ct_sigma",
        };
        (lift > STALLING_LIFT_COEFFICIENT).then(|| {
            self.doubt(
                field,
                format!(
                    "C_T/sigma {ct_sigma:.3} is a mean lift coefficient of {lift:.2}, beyond {STALLING_LIFT_COEFFICIENT}, where rotors stall; the attached sections of this case do not, and their loads mean nothing there. Lower the thrust, or give aerodynamics.airfoils and dynamic_stall"
                ),
            )
        })
    }

    /// A mode at a harmonic that next to nothing damps.
    fn resonance_doubt(
        &self,
        rotor: &Rotor,
        (theta0_rad, flight): (f64, Option<&RotorSolution>),
    ) -> Result<Option<String>, SimError> {
        let field = "rotor.modal_damping";
        let found = rotor.hardly_damped_at_a_harmonic(theta0_rad, flight);
        let found = found.map_err(|source| {
            let place = self.index.place(field);
            SimError::Response { place, source }
        })?;
        Ok(found.map(|CoupledBladeMode { kind, number, frequency_per_rev }| {
            self.doubt(
                field,
                format!(
                    "{kind} {number} at {:.2} deg has {frequency_per_rev:.4} per rev, near the harmonic {} of the loads, and {:e} of critical damping: its response and the loads at that harmonic are those of the damping alone. Give modal_damping of 0.005, or another stiffness",
                    theta0_rad.to_degrees(),
                    frequency_per_rev.round(),
                    rotor.model().modal_damping
                ),
            )
        }))
    }
}

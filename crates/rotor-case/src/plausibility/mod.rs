//! What a case asks for that can be, but hardly is meant: warnings of `hhc check` and `hhc run`.

mod blade;

use super::{
    Case, CirculationChoice, CouplingsChoice, InflowChoice, Joint, NearWakeMotion, PropulsiveTrim,
    RotorValues, TrimValues, WakeChoices,
};
use crate::ModelError;
use rotor_response::{CoupledBladeMode, Rotor, RotorSolution, SectionLift};
use trim::mean_lift_coefficient;

/// Mean lift coefficient above which rotors stall: `C_T/sigma` of 0.15 in hover, and 0.17 at an advance ratio
/// of 0.3, which is beyond the limits of thrust measured in wind tunnels.
///
/// Source: F. J. `McHugh`, 34th Annual Forum of the American Helicopter Society (1978).
const STALLING_LIFT_COEFFICIENT: f64 = 0.9;

/// Mean lift coefficient above which a rotor is near stall: `C_T/sigma` of 0.115 in hover, 0.13 at an advance
/// ratio of 0.3, where wind-tunnel rotors begin to stall on the retreating side.
const NEAR_STALL_LIFT_COEFFICIENT: f64 = 0.69;
/// Lift coefficient of a section above which aerofoils stall: held still they do at 1.2 to 1.4.
const SECTION_STALL: f64 = 1.4;
/// Longest near wake, deg, that may lie in the plane of its blade: that of a four-bladed rotor's next blade.
const LONGEST_IN_PLANE_DEG: f64 = 90.0;
/// Shortest near wake, deg, with which measured airloads are met: that of a four-bladed rotor's next blade.
const SHORTEST_IN_FLIGHT_DEG: f64 = 90.0;

/// Drag over weight above which no helicopter flies level.
const MOST_DRAG: f64 = 0.27;

/// Axial stiffness below which a blade stretches by more than half a percent, `m0 Omega^2 R^2`.
const LEAST_AXIAL_STIFFNESS: f64 = 100.0;

/// Hinge offset, and height of the hub over the centre of gravity, below which neither tilts the helicopter, R.
const LEAST_LEVER: f64 = 0.01;

/// A value that can be, but hardly is meant.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PlausibilityWarning {
    /// Path of the field.
    pub field: String,
    /// What was found, what is usual, what to do.
    pub message: String,
}

fn warning(field: &str, message: impl Into<String>) -> PlausibilityWarning {
    PlausibilityWarning { field: field.to_owned(), message: message.into() }
}

impl Case {
    /// Warnings of the case alone, each with its place: values, thrust, and modes at a harmonic at the
    /// collective of a prescribed trim, else at none.
    ///
    /// # Errors
    /// [`ModelError::Blade`] and [`ModelError::Response`] if the rotor cannot be built.
    pub fn plausibility_warnings(&self) -> Result<Vec<PlausibilityWarning>, ModelError> {
        let mut warnings = self.value_warnings();
        warnings.extend(self.trim.ct_sigma().and_then(|ct_sigma| self.lift_warning(ct_sigma)));
        let pitch_rad = self.trim.collective_rad();
        let blade = self.blade_properties()?;
        let rotor = self.rotor_of(&blade, "rotor")?;
        warnings.extend(self.resonance_warning(&rotor, pitch_rad, None)?);
        Ok(warnings)
    }

    /// Warnings of what the trim of the case has found.
    ///
    /// # Errors
    /// [`ModelError::Response`] if the coupled modes cannot be found.
    pub fn warnings_in_flight(
        &self,
        rotor: &Rotor,
        theta0_rad: f64,
        found: &RotorSolution,
        most: Option<SectionLift>,
    ) -> Result<Vec<PlausibilityWarning>, ModelError> {
        let mut warnings = self.value_warnings();
        let ct_sigma = found.thrust_coefficient / rotor.model().solidity();
        let lift = self.lift_warning(ct_sigma).map_or_else(|| self.section_warning(most), Some);
        warnings.extend(lift);
        warnings.extend(self.resonance_warning(rotor, theta0_rad, Some(found))?);
        warnings.extend(self.torque_warning());
        Ok(warnings)
    }

    /// A torque and a power whose second-order terms the equations lack.
    fn torque_warning(&self) -> Option<PlausibilityWarning> {
        let structure = &self.structure;
        let is_linear = structure.couplings == CouplingsChoice::Linear;
        (is_linear && structure.modes.lag > 0).then(|| {
            let message = "torque and power of Linear are the statics of a blade whose lag its air does not follow: in hover about 1 % off inflow times thrust and profile drag for a blade that is clamped, 14 % for one that lags by 0.1 rad or stands 0.05 R off the shaft, more beyond. For a power choose structure.couplings: Full";
            warning("structure.couplings", message.to_owned())
        })
    }

    /// Values of a case that hardly are meant, flight or no flight.
    pub fn value_warnings(&self) -> Vec<PlausibilityWarning> {
        let flight = [self.moment_trim_warning(), self.drag_warning(), self.axial_warning()];
        let wake = self.wake_warnings().into_iter().chain(self.first_harmonic_warning());
        self.blade_warnings().into_iter().chain(flight.into_iter().flatten()).chain(wake).collect()
    }

    /// Control at 1/rev, which is the pilot's.
    fn first_harmonic_warning(&self) -> Option<PlausibilityWarning> {
        let is_asked = self.control.harmonics.iter().flatten().any(|&n| n == 1);
        is_asked.then(|| {
            warning(
                "control.harmonics",
                "flaps at 1/rev tilt the rotor as cyclic pitch does, and the pilot's controls are held: the flight is no longer trimmed (residuals.trim of the line in result.json). Control 2/rev and above, or take the reduction with that imbalance",
            )
        })
    }

    /// A near wake that meets the other blades, and more azimuth steps than the response resolves.
    fn wake_warnings(&self) -> Vec<PlausibilityWarning> {
        let InflowChoice::FreeWake(wake) = self.inflow.model else { return vec![] };
        let mut warnings = Vec::new();
        let WakeChoices { near_wake, near_wake_deg, .. } = wake.choices();
        let in_plane = near_wake == NearWakeMotion::BladePlane;
        if in_plane && near_wake_deg > LONGEST_IN_PLANE_DEG {
            let message = format!(
                "a near wake of {near_wake_deg} deg held in the plane of its blade lies in that of the blades behind: they fly in its sheet, and the mean inflow is several times Glauert's. Give near_wake_deg of at most {LONGEST_IN_PLANE_DEG}, or near_wake: FollowsTip"
            );
            warnings.push(warning("inflow.model.near_wake", message));
        }
        let r = &self.response;
        let points = r.time_elements * r.time_gauss_points;
        let of_the_wake = wake.azimuths_for(self.rotor.blades);
        let (field, azimuths) = match wake.section_azimuths {
            Some(count) => ("inflow.model.section_azimuths", count),
            None => ("inflow.model.azimuths", of_the_wake),
        };
        let is_trimmed = wake.circulation == CirculationChoice::Trimmed;
        let flies = is_trimmed && !in_plane && self.advance_ratio > 0.0;
        if flies && near_wake_deg < SHORTEST_IN_FLIGHT_DEG {
            let message = format!(
                "a near wake of {near_wake_deg} deg is rolled up before the next blade passes: the measured airloads of HART II are met worst with such, at a correlation of 0.45 against 0.8 from {SHORTEST_IN_FLIGHT_DEG} to 180 deg. Give {SHORTEST_IN_FLIGHT_DEG} or more, or leave it out for 360"
            );
            warnings.push(warning("inflow.model.near_wake_deg", message));
        }
        if is_trimmed && 4 * azimuths > 3 * points {
            let message = format!(
                "{azimuths} steps per revolution are more than three quarters of the {points} points in time of the response (response.time_elements times time_gauss_points): inflow and circulation do not answer each other on every step. Give time_gauss_points of {} or more",
                (4 * azimuths).div_ceil(3 * r.time_elements)
            );
            warnings.push(warning(field, message));
        }
        warnings
    }

    /// A drag that asks for a tilt no helicopter flies at.
    fn drag_warning(&self) -> Option<PlausibilityWarning> {
        let TrimValues::Propulsive(PropulsiveTrim { ct_sigma, drag_area, .. }) = self.trim else {
            return None;
        };
        let weight = ct_sigma * self.rotor_model().solidity();
        let drag = 0.5 * drag_area * self.advance_ratio.powi(2);
        (drag > MOST_DRAG * weight).then(|| {
            let message = format!(
                "the drag at this advance ratio is {:.2} of the weight: the rotor would fly tilted by {:.0} deg, a helicopter at its fastest by 10 to 15. Lower drag_area (0.01 disk areas is usual; here {drag_area}) or the advance ratio",
                drag / weight,
                (drag / weight).atan().to_degrees()
            );
            warning("trim.drag_area", message)
        })
    }

    /// A moment trim of a hub that the flapping puts no moment on.
    fn moment_trim_warning(&self) -> Option<PlausibilityWarning> {
        let r = &self.rotor;
        let is_central = r.root.flap == Joint::Free && r.root_offset_r < LEAST_LEVER;
        let (field, message) = match &self.trim {
            TrimValues::WindTunnel(_) => (
                "trim",
                "a free flap hinge at the rotor centre puts no flap moment on the hub: zero hub moments set the cyclic by the pitching moments of the blades alone, and the disk tilts as it likes. Give rotor.root_offset_r, or the controls with trim: Prescribed",
            ),
            TrimValues::Propulsive(p) if p.cg_below_hub_r.abs() < LEAST_LEVER => (
                "trim.cg_below_hub_r",
                "a free flap hinge at the rotor centre puts no flap moment on the hub, and hub forces turn the helicopter by the height of the hub over its centre of gravity alone, which is next to none: pitch and roll balance at any tilt of the disk. Give cg_below_hub_r (0.2 is usual) or rotor.root_offset_r",
            ),
            TrimValues::Propulsive(_) | TrimValues::Prescribed(_) => return None,
        };
        is_central.then(|| warning(field, message.to_owned()))
    }

    /// An axial stiffness that the flight does not know, or a blade that stretches much.
    fn axial_warning(&self) -> Option<PlausibilityWarning> {
        let r = &self.rotor;
        let (key, value) = match r.tables.ea.iter().map(|(_, value)| *value).reduce(f64::min) {
            Some(least) => ("rotor.tables.ea", least),
            None => ("rotor.ea", r.ea),
        };
        if self.structure.couplings != CouplingsChoice::Moderate {
            let given = key != "rotor.ea" || (value - RotorValues::default().ea).abs() > 0.0;
            return given.then(|| {
                let message = "Linear and Full know no stretch, the blade keeps its length: the value serves hhc modes alone; for flight choose structure.couplings: Moderate";
                warning(key, message.to_owned())
            });
        }
        (value < LEAST_AXIAL_STIFFNESS).then(|| {
            let message = format!(
                "the axial stiffness {value} m0 Omega^2 R^2 is less than {LEAST_AXIAL_STIFFNESS}: rotation stretches the blade by {:.1} % at the root, and the stretch by the changing part of the tension, which Moderate leaves out, is no longer small. A blade has 500 to 5000",
                50.0 / value
            );
            warning(key, message)
        })
    }

    /// A thrust at which real sections stall, carried by sections that cannot.
    fn lift_warning(&self, ct_sigma: f64) -> Option<PlausibilityWarning> {
        if !self.rotor_model().nonlinear.is_linear() {
            return None;
        }
        let lift = mean_lift_coefficient(ct_sigma, self.advance_ratio);
        let field = self.trim.loading_field();
        let meaning = if lift > STALLING_LIFT_COEFFICIENT {
            format!(
                "beyond {STALLING_LIFT_COEFFICIENT}, where rotors stall; the attached sections of this case do not, and their loads mean nothing there"
            )
        } else if lift > NEAR_STALL_LIFT_COEFFICIENT {
            format!(
                "near stall (above {NEAR_STALL_LIFT_COEFFICIENT}); the attached sections of this case do not stall, those of a real rotor do on the retreating side"
            )
        } else {
            return None;
        };
        let message = format!(
            "C_T/sigma {ct_sigma:.3} is a mean lift coefficient of {lift:.2}, {meaning}. Lower the thrust, or give aerodynamics.airfoils and dynamic_stall"
        );
        Some(warning(field, message))
    }

    /// A section of the trimmed rotor that lifts more than aerofoils do, where sections cannot stall.
    fn section_warning(&self, most: Option<SectionLift>) -> Option<PlausibilityWarning> {
        let most = most.filter(|most| most.lift_coefficient > SECTION_STALL)?;
        if !self.rotor_model().nonlinear.is_linear() {
            return None;
        }
        let message = format!(
            "the section at {:.2} R has a lift coefficient of {:.2} at azimuth {:.0} deg, above {SECTION_STALL}, where aerofoils stall; the attached sections of this case do not. Lower the thrust or the advance ratio, or give aerodynamics.airfoils and dynamic_stall",
            most.station,
            most.lift_coefficient,
            most.azimuth_rad.to_degrees()
        );
        Some(warning("aerodynamics", message))
    }

    /// A mode at a harmonic that next to nothing damps.
    fn resonance_warning(
        &self,
        rotor: &Rotor,
        theta0_rad: f64,
        flight: Option<&RotorSolution>,
    ) -> Result<Option<PlausibilityWarning>, ModelError> {
        let field = "rotor.modal_damping";
        let found = rotor.lightly_damped_at_a_harmonic(theta0_rad, flight);
        let found =
            found.map_err(|source| ModelError::Response { field: field.to_owned(), source })?;
        Ok(found.map(|CoupledBladeMode { kind, number, frequency_per_rev }| {
            let where_found = match (flight, &self.trim) {
                (Some(_), _) => "about the mean deflection in flight, pitch",
                (None, TrimValues::Prescribed(_)) => "in still air, pitch",
                (None, _) => "in still air (the trim looks again at its own pitch), pitch",
            };
            warning(
                field,
                format!(
                    "{kind} {number} {where_found} {:.2} deg, has {frequency_per_rev:.4} per rev, near the harmonic {} of the loads, and {:e} of critical damping: its response and the loads at that harmonic are those of the damping alone. Give modal_damping of 0.005, or another stiffness",
                    theta0_rad.to_degrees(),
                    frequency_per_rev.round(),
                    rotor.model().modal_damping
                ),
            )
        }))
    }
}

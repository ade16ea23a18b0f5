//! Sections beyond attached linear theory: tables along the span, dynamic stall.
//!
//! The attached model stays what it is; a table takes the place of the static lift, drag and moment of
//! the rigid section, dynamic stall adds what separation and its vortex do:
//!
//! ```text
//! w_E     = U_T sin th - U_P cos th + [ y_rigid / a - (U_T th - U_P) ]       effective normal velocity
//! alpha_E = atan2( w_E, U_T cos th + U_P sin th ),   W^2 = U_T^2 + U_P^2
//! F_z = (1/2) rho c W ( Cl U_T - Cd U_P ),  F_y = -(1/2) rho c W ( Cl U_P + Cd U_T ),  M = (1/2) rho c^2 W^2 Cm
//! Gamma = (1/2) c W Cl       bound circulation, whose lift is that of the table: F_z = rho Gamma U_T, F_y = -rho Gamma U_P
//! ```
//! with `Cl`, `Cd`, `Cm` of the table at `alpha_E` and the Mach number of the rigid blade. `y_rigid` is
//! the output of the attached model in lift due to incidence and pitch rate, lags included, and `a` its
//! lift slope: `y_rigid / a` is the normal velocity a section at rest would need for the same lift, so the
//! bracket holds the pitch rate and what the lags lack, and vanishes in steady flow. The attached
//! static lift appears nowhere else: nothing is counted twice. Of the attached model remain: apparent
//! mass, the moment due to pitch rate and lags, the hinge moment, and all that the flap does, with its
//! effectiveness.
//!
//! Dynamic stall adds coefficients `d = [dCn, dCc, dCm]` along the section's axes, in flow from the
//! leading edge,
//!
//! ```text
//! F_z += (1/2) rho c W max(U_T, 0) ( dCn cos th + dCc sin th ),   F_y and M likewise
//! Gamma += (1/2) c max(U_T, 0) ( what of d stands across the flow )
//! d = loads of Leishman and Beddoes - what the section has without them:
//!     attached flow (linear sections), or their own loads without delay and vortex (tables)
//! ```
//! so that with a table a section held still has the table's loads, however it stalls.
//!
//! Assumes: the rigid blade's speed for Mach number and distance travelled, as the lags do. Not
//! modelled: the flap's loss of effect in separated flow, its effect on the table's drag.

use crate::model::air_scales::AirScales;
use crate::sections::air::{
    PromptCoefficients, SectionFlow, SectionLoads, SectionPast, section_loads,
};
use flap_aero::{AeroError, AirfoilSpan};
use std::sync::Arc;

/// The tables at one station.
#[derive(Debug, Clone)]
pub(crate) struct TabledStation {
    airfoils: Arc<AirfoilSpan>,
    station: f64,
    /// Mach number of the rigid blade, and the attached model's lift slope there, by point.
    points: Vec<(f64, f64)>,
}

impl TabledStation {
    pub(crate) fn new(
        airfoils: &Arc<AirfoilSpan>,
        station: f64,
        points: Vec<(f64, f64)>,
    ) -> Result<Self, AeroError> {
        if let Some((_, value)) =
            points.iter().copied().find(|(_, slope)| *slope <= 0.0 || slope.is_nan())
        {
            let quantity = "lift slope of the attached model";
            return Err(AeroError::BadInput { quantity, value, expected: "a number above 0" });
        }
        Ok(Self { airfoils: Arc::clone(airfoils), station, points })
    }

    /// Loads of the section: the table's, and what of the attached model it does not hold.
    pub(crate) fn loads(
        &self,
        point: usize,
        scales: AirScales,
        flow: &SectionFlow,
        coefficients: &PromptCoefficients,
        past: &SectionPast,
    ) -> SectionLoads {
        let (mach, slope) = self.points[point];
        let [normal_velocity, pitch_rate, ..] = flow.input;
        let [per_normal, per_rate, ..] = coefficients.direct[0];
        let rigid = per_normal * normal_velocity + per_rate * pitch_rate + past.rigid_lift;
        let [lift, moment, hinge] = past.lag;
        let frictionless = AirScales { drag: 0.0, ..scales };
        // what the table's lift holds is taken out of the lift, not of the pressure waves
        let left = SectionPast {
            lag: [lift - rigid, moment, hinge],
            circulatory_lift: past.circulatory_lift - rigid,
            ..*past
        };
        let mut loads = section_loads(frictionless, flow, coefficients, &left);
        let (sin, cos) = flow.pitch.sin_cos();
        let (u_t, u_p) = (flow.u_t, flow.u_p);
        let chordwise = u_t * cos + u_p * sin;
        let normal = u_t * sin - u_p * cos;
        let incidence = (normal - normal_velocity + rigid / slope).atan2(chordwise);
        let c = self.airfoils.at(self.station, incidence, mach).value;
        let speed = u_t.hypot(u_p);
        let half = 0.5 * scales.density_chord;
        loads.fz += half * speed * (c.lift * u_t - c.drag * u_p);
        loads.fy -= half * speed * (c.lift * u_p + c.drag * u_t);
        loads.moment += half * scales.chord * speed * speed * c.moment;
        loads.circulation += 0.5 * scales.chord * speed * c.lift;
        loads
    }
}

/// Adds what stall adds to the loads of a section.
pub(crate) fn add_stall(
    scales: AirScales,
    flow: &SectionFlow,
    [normal, chord, moment]: [f64; 3],
    loads: &mut SectionLoads,
) {
    let (sin, cos) = flow.pitch.sin_cos();
    let speed = flow.u_t.hypot(flow.u_p);
    let scale = 0.5 * scales.density_chord * speed * flow.u_t.max(0.0);
    let (up, forward) = (normal * cos + chord * sin, chord * cos - normal * sin);
    loads.fz += scale * up;
    loads.fy += scale * forward;
    loads.moment += scale * scales.chord * moment;
    // what stands across the flow is lift
    if speed > 0.0 {
        let lift = (up * flow.u_t - forward * flow.u_p) / speed;
        loads.circulation += 0.5 * scales.chord * flow.u_t.max(0.0) * lift;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    /// What stall adds stands in section axes, scales with the whole speed, and is nothing in reverse flow.
    #[test]
    fn stall_acts_along_the_axes_of_the_section() {
        let scales = AirScales {
            density_chord: 0.8,
            chord: 0.055,
            drag: 0.01,
            centre: 0.0,
            sweep: 0.0,
            zero_lift: 0.0,
            camber_moment: 0.0,
        };
        let [normal, chord, moment] = [-0.4, -0.3, -0.2];
        let added = |u_t: f64| {
            let flow = SectionFlow { u_t, u_p: 0.05, pitch: 0.21, ..SectionFlow::default() };
            let mut loads = SectionLoads::default();
            add_stall(scales, &flow, [normal, chord, moment], &mut loads);
            loads
        };
        let loads = added(0.6);
        let pressure = 0.5 * 0.8 * 0.6_f64.hypot(0.05) * 0.6;
        // turned back by the pitch: up is normal, toward the leading edge is chord
        let (sin, cos) = 0.21_f64.sin_cos();
        assert_abs_diff_eq!(loads.fz * cos - loads.fy * sin, pressure * normal, epsilon = 1e-15);
        assert_abs_diff_eq!(loads.fz * sin + loads.fy * cos, pressure * chord, epsilon = 1e-15);
        assert_abs_diff_eq!(loads.moment, pressure * 0.055 * moment, epsilon = 1e-15);
        // of the force, what stands across the flow is the lift of the circulation
        let across = (loads.fz * 0.6 - loads.fy * 0.05) / 0.6_f64.hypot(0.05);
        let of_circulation = 0.8 / 0.055 * loads.circulation * 0.6_f64.hypot(0.05);
        assert_abs_diff_eq!(of_circulation, across, epsilon = 1e-15);
        assert!(loads.circulation < 0.0);
        // suction that is lost pulls the blade back
        assert!(loads.fy < 0.0);
        assert_eq!(added(-0.6), SectionLoads::default());
    }
}

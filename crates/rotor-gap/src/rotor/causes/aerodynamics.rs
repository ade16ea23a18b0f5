//! What the aerodynamics may lack.

use super::{Occasion, RotorCause};
use model_gap::points::{CauseParameter, Shown};
use rotor_case::{CompressibilityChoice, DynamicStallChoice, FreeWakeValues, InflowChoice};

/// A cause that is there or not; between, a part of it.
fn share() -> CauseParameter {
    CauseParameter {
        name: "share",
        unit: "1",
        none: 0.0,
        range: (0.0, 2.0),
        amounts: vec![1.0],
        shown: Shown::Itself,
    }
}

pub(super) fn flap_effectiveness(o: &Occasion<'_>) -> RotorCause {
    let physics = "the flaps make less or more than thin-aerofoil theory says: lift and moment each times a ratio";
    let wide = (0.1, 1.8);
    let parameters = vec![
        CauseParameter { name: "lift", ..CauseParameter::ratio(&[0.95], wide) },
        CauseParameter { name: "moment", ..CauseParameter::ratio(&[0.95], wide) },
    ];
    RotorCause::new("flap-effectiveness", physics, parameters, |m, v| {
        for flap in &mut m.case.flaps {
            flap.effectiveness.lift *= v[0];
            flap.effectiveness.moment *= v[1];
        }
    })
    .beside(&["actuator-gain"], &["the motion of the flaps measured"])
    .blocked_if(!o.is_driven, "no flap is driven at any point")
}

/// Ahead of the elastic axis, as the case counts it.
pub(super) fn aerodynamic_centre(o: &Occasion<'_>) -> RotorCause {
    let physics = "the aerodynamic centre lies elsewhere: ahead of the elastic axis by an offset";
    let chord = o.model.case.rotor.chord_r;
    let parameters = vec![CauseParameter::both_ways("offset_r", "R", &[0.02 * chord], 0.2 * chord)];
    RotorCause::new("aerodynamic-centre", physics, parameters, |m, v| {
        m.case.rotor.aerodynamic_centre_r += v[0];
    })
    .beside(&["cg-offset", "stiffness-torsion"], &["points at other rotor speeds"])
}

pub(super) fn twist() -> RotorCause {
    let physics = "the blades are twisted more or less from root to tip";
    let parameters = vec![CauseParameter::both_ways("deg", "deg", &[0.5], 8.0)];
    RotorCause::new("twist", physics, parameters, |m, v| {
        m.case.rotor.twist_deg += v[0];
        // zero at 0.75 R, as the uniform twist
        for (station, own) in &mut m.case.rotor.tables.twist_deg {
            *own += v[0] * (*station - 0.75);
        }
    })
}

pub(super) fn lift_slope() -> RotorCause {
    let physics = "the sections lift more or less for their incidence: lift slope times a ratio";
    let parameters = vec![CauseParameter::ratio(&[0.97], (0.6, 1.5))];
    RotorCause::new("lift-slope", physics, parameters, |m, v| m.lift_slope *= v[0]).beside(
        &["air-density", "mass"],
        &["the density measured by itself", "the collective at zero thrust"],
    )
}

pub(super) fn drag(o: &Occasion<'_>) -> RotorCause {
    let physics = "the sections have more or less profile drag: its coefficient times a ratio";
    let parameters = vec![CauseParameter::ratio(&[1.1], (0.2, 4.0))];
    let has_tables = o.model.case.aerodynamics.tables.is_some();
    RotorCause::new("drag", physics, parameters, |m, v| {
        m.case.aerodynamics.drag_coefficient *= v[0];
    })
    .blocked_if(has_tables, "the drag is that of the aerofoil tables")
}

/// The whole way to the free wake of the vortices that roll up.
pub(super) fn inflow(o: &Occasion<'_>) -> RotorCause {
    let physics = "the inflow model lacks the wake: a part of what a free wake changes";
    let is_wake = matches!(o.model.case.inflow.model, InflowChoice::FreeWake(_));
    // to tell what it changes, not to settle it
    let azimuths = Some(4 * o.model.case.rotor.blades.clamp(2, 8));
    let coarse =
        FreeWakeValues { azimuths, turns: Some(3), tolerance: 2e-3, ..FreeWakeValues::default() };
    RotorCause::new("inflow", physics, vec![share()], move |m, v| {
        if v[0] != 0.0 {
            m.case.inflow.model = InflowChoice::FreeWake(coarse);
        }
    })
    .blocked_if(is_wake, "the case flies in a free wake already")
}

pub(super) fn dynamic_stall(o: &Occasion<'_>) -> RotorCause {
    let physics = "the retreating blade stalls: a part of what dynamic stall changes";
    let is_on = o.model.case.aerodynamics.dynamic_stall != DynamicStallChoice::Off;
    RotorCause::new("dynamic-stall", physics, vec![share()], |m, v| {
        if v[0] != 0.0 {
            m.case.aerodynamics.dynamic_stall = DynamicStallChoice::Naca0012;
        }
    })
    .blocked_if(is_on, "the case has it already")
}

pub(super) fn compressibility(o: &Occasion<'_>) -> RotorCause {
    let physics = "the Mach number of the sections is left out: a part of what it changes";
    let has_it = o.model.case.aerodynamics.compressibility == CompressibilityChoice::LocalMach;
    RotorCause::new("compressibility", physics, vec![share()], move |m, v| {
        if v[0] != 0.0 {
            m.case.aerodynamics.compressibility =
                if has_it { CompressibilityChoice::None } else { CompressibilityChoice::LocalMach };
        }
    })
}

//! What the blades may lack.

use super::{Occasion, RotorCause};
use crate::rotor::model::RotorModel;
use model_gap::points::{CauseParameter, Shown};
use rotor_fem::Joint;
use rotor_study::case::{CouplingsChoice, DissimilarBlade, RotorValues, times};

const STIFF: (f64, f64) = (0.4, 2.0);
/// A mode near a harmonic answers far from straight: several amounts on both sides.
const STEPS: [f64; 3] = [1.05, 0.85, 1.2];
const SWEEP_OF_SPEED: &[&str] = &["points at other rotor speeds", "blade frequencies at rest"];

/// A property of the blade, uniform and as a table.
type Property<'a> = (&'a mut f64, &'a mut Vec<(f64, f64)>);

/// A stiffness times a ratio; `of` gives it, uniform and as a table.
fn stiffness(
    id: &'static str,
    physics: &'static str,
    of: fn(&mut RotorValues) -> Property<'_>,
) -> RotorCause {
    let parameters = vec![CauseParameter::ratio(&STEPS, STIFF)];
    RotorCause::new(id, physics, parameters, move |m, v| {
        let (uniform, table) = of(&mut m.case.rotor);
        times(uniform, table, v[0]);
    })
}

pub(super) fn stiffness_flap() -> RotorCause {
    let physics = "the blade bends more or less easily out of the plane: EI_flap times a ratio";
    stiffness("stiffness-flap", physics, |r| (&mut r.ei_flap, &mut r.tables.ei_flap))
        .beside(&["mass"], SWEEP_OF_SPEED)
}

pub(super) fn stiffness_lag() -> RotorCause {
    let physics = "the blade bends more or less easily in the plane: EI_lag times a ratio";
    stiffness("stiffness-lag", physics, |r| (&mut r.ei_lag, &mut r.tables.ei_lag))
        .beside(&["mass"], SWEEP_OF_SPEED)
}

pub(super) fn stiffness_torsion() -> RotorCause {
    let physics = "the blade twists more or less easily: GJ times a ratio";
    stiffness("stiffness-torsion", physics, |r| (&mut r.gj, &mut r.tables.gj)).beside(
        &["pitch-link", "aerodynamic-centre"],
        &["a static load at the pitch horn", "twist along the span"],
    )
}

/// The compliance of the pitch bearing is what adds up; its reciprocal is reported.
pub(super) fn pitch_link(o: &Occasion<'_>) -> RotorCause {
    let physics = "pitch link and control system give way: a spring at the root in pitch";
    let unit_newton_metre = o.model.case.scales().moment_newton_metre();
    let none = match o.model.case.rotor.root.feather {
        Joint::Spring { stiffness } => 1.0 / (stiffness * unit_newton_metre),
        _ => 0.0,
    };
    // softer by a twentieth of what gj gives over the radius
    let give = 0.05 / (o.model.case.rotor.gj * unit_newton_metre);
    let parameter = CauseParameter {
        name: "stiffness",
        unit: "N m/rad",
        none,
        range: (0.0, none + 40.0 * give),
        amounts: vec![none + give],
        shown: Shown::Reciprocal,
    };
    RotorCause::new("pitch-link", physics, vec![parameter], move |m, v| {
        let is_same = v[0] - none == 0.0;
        if !is_same {
            let compliance = v[0] * unit_newton_metre;
            m.case.rotor.root.feather = if compliance > 0.0 {
                Joint::Spring { stiffness: 1.0 / compliance }
            } else {
                Joint::Locked
            };
        }
    })
    .beside(&["stiffness-torsion"], &["a static load at the pitch horn"])
}

/// The stiffnesses are over the mass, and so is the Lock number.
pub(super) fn mass() -> RotorCause {
    let physics = "the blades are heavier or lighter: mass per length times a ratio";
    let parameters = vec![CauseParameter::ratio(&[1.03, 0.95, 1.1], (0.7, 1.4))];
    RotorCause::new("mass", physics, parameters, |m, v| {
        let r = &mut m.case.rotor;
        let lighter = 1.0 / v[0];
        r.stiffen(lighter);
        r.lag_damper *= lighter;
        r.lock_number *= lighter;
        r.mass_kg_m *= v[0];
    })
    .beside(&["air-density", "lift-slope"], &["the weight of a blade"])
}

pub(super) fn cg_offset(o: &Occasion<'_>) -> RotorCause {
    let physics = "the mass centre lies elsewhere: ahead of the elastic axis by an offset";
    let parameters = vec![CauseParameter::both_ways("offset_r", "R", &[0.001], 0.01)];
    let is_moderate = o.model.case.structure.couplings == CouplingsChoice::Moderate;
    RotorCause::new("cg-offset", physics, parameters, |m, v| m.case.rotor.mass_centre_r += v[0])
        .beside(
            &["aerodynamic-centre"],
            &["points at other air densities", "points at other rotor speeds"],
        )
        .blocked_if(!is_moderate, "the mass centre takes part with `couplings: Moderate` only")
}

pub(super) fn structural_damping(o: &Occasion<'_>) -> RotorCause {
    let physics = "the blades damp more or less: a fraction of critical in every mode";
    let none = o.model.case.rotor.modal_damping;
    let amount = if none > 0.0 { 2.0 * none } else { 0.005 };
    let parameter = CauseParameter {
        name: "ratio",
        unit: "of critical",
        none,
        range: (0.0, none + 0.1),
        amounts: vec![amount],
        shown: Shown::Itself,
    };
    RotorCause::new("structural-damping", physics, vec![parameter], |m, v| {
        m.case.rotor.modal_damping = v[0];
    })
}

/// One cause for every blade, heavier or set to another pitch.
pub(super) fn blade_dissimilarity(o: &Occasion<'_>) -> Vec<RotorCause> {
    fn of(m: &mut RotorModel, blade: usize) -> &mut DissimilarBlade {
        let list = &mut m.case.rotor.dissimilar_blades;
        let place = list.iter().position(|own| own.blade == blade).unwrap_or_else(|| {
            list.push(DissimilarBlade { blade, ..DissimilarBlade::default() });
            list.len() - 1
        });
        &mut list[place]
    }
    let alike: &[&str] = &["azimuth-offset"];
    let told: &[&str] = &["gauges on every blade", "blades exchanged", "track"];
    let each = (1..=o.model.case.rotor.blades).flat_map(|blade| {
        let label = CauseParameter::label("blade", blade as f64);
        let mass =
            CauseParameter { name: "mass_ratio", ..CauseParameter::ratio(&[1.01], (0.8, 1.2)) };
        let pitch = CauseParameter::both_ways("pitch_deg", "deg", &[0.1], 1.5);
        let heavier = RotorCause::new(
            "blade-dissimilarity",
            "one blade is heavier or lighter than the others",
            vec![mass, label.clone()],
            move |m, v| {
                if v[0] - 1.0 != 0.0 {
                    of(m, blade).mass *= v[0];
                }
            },
        );
        let turned = RotorCause::new(
            "blade-dissimilarity",
            "one blade is set to another pitch than the others",
            vec![pitch, label],
            move |m, v| {
                if v[0] != 0.0 {
                    of(m, blade).pitch_deg += v[0];
                }
            },
        );
        [heavier.beside(alike, told), turned.beside(alike, told)]
    });
    each.collect()
}

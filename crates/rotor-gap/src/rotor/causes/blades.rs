//! What the blades may lack.

use super::{Occasion, RotorCause};
use crate::properties;
use crate::rotor::model::RotorModel;
use model_gap::points::{CauseParameter, Shown};
use rotor_case::{CouplingsChoice, DissimilarBlade};

const SWEEP_OF_SPEED: &[&str] = &["points at other rotor speeds", "blade frequencies at rest"];

pub(super) fn stiffness_flap() -> RotorCause {
    properties::stiffness_flap().beside(&["mass"], SWEEP_OF_SPEED)
}

pub(super) fn stiffness_lag() -> RotorCause {
    properties::stiffness_lag().beside(&["mass"], SWEEP_OF_SPEED)
}

pub(super) fn stiffness_torsion() -> RotorCause {
    properties::stiffness_torsion().beside(
        &["pitch-link", "aerodynamic-centre"],
        &["a static load at the pitch horn", "twist along the span"],
    )
}

pub(super) fn pitch_link(o: &Occasion<'_>) -> RotorCause {
    let physics = "pitch link and control system give way: a spring at the root in pitch";
    let case = &o.model.case;
    // softer by a twentieth of what gj gives over the radius
    let give = 0.05 / (case.rotor.gj * case.scales().moment_newton_metre());
    let named = ("pitch-link", physics);
    properties::root_spring(named, o.model, |r| &mut r.root.feather, (give, &[1.0]))
        .beside(&["stiffness-torsion"], &["a static load at the pitch horn"])
}

pub(super) fn mass() -> RotorCause {
    properties::mass().beside(&["air-density", "lift-slope"], &["the weight of a blade"])
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

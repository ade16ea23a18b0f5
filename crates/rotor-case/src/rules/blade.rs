//! Rules of the blade: root, offsets, tables along the span, blades that differ.

use super::checker::Checker;
use crate::{Case, CouplingsChoice, DynamicStallChoice, Joint, RootPitchBy, TwistAngle, Untwist};

/// Softest springs of flap and lag hinges and of the pitch link, over `m0 Omega^2 R^3`.
const LEAST_SPRING: f64 = 1e-6;
const LEAST_PITCH_SPRING: f64 = 1e-3;
/// Largest sweep of a part of the blade, deg.
const MOST_SWEEP_DEG: f64 = 45.0;

/// Checks what the blade has beyond the uniform one on a clamp.
pub(super) fn check_blade(check: &mut Checker, case: &Case) {
    let r = &case.rotor;
    check_root(check, case);
    check_mass_centre(check, case);
    let remedy =
        "quarter chord ahead of the elastic axis is positive; the axis lies inside the chord";
    let (quarter, ahead) = (0.25 * r.chord_r, r.aerodynamic_centre_r);
    check.within("rotor.aerodynamic_centre_r", ahead, (-3.0 * quarter, quarter), "R", remedy);
    check_couplings(check, case);
    check_sweep(check, case);
    check_root_pitch(check, case);
    for (i, blade) in r.dissimilar_blades.iter().enumerate() {
        let list = format!("rotor.dissimilar_blades[{i}]");
        let field = format!("{list}.blade");
        check.count(&field, blade.blade, (1, r.blades), "blades are counted from 1");
        if r.dissimilar_blades[..i].iter().any(|before| before.blade == blade.blade) {
            let number = blade.blade;
            let message =
                format!("`{number}` is used already at {list}; give every dissimilar blade once");
            check.broken(&field, message);
        }
    }
}

/// Harmonics of pitch at the root once each, and such as what makes them can.
fn check_root_pitch(check: &mut Checker, case: &Case) {
    let r = &case.rotor;
    for (i, one) in r.root_pitch.iter().enumerate() {
        let (harmonic, field) = (one.harmonic, format!("rotor.root_pitch[{i}].harmonic"));
        if r.root_pitch[..i].iter().any(|before| before.harmonic == harmonic) {
            check.broken(&field, format!("`{harmonic}` is given twice; give every harmonic once"));
        }
        if let Some(message) = case.beyond_swashplate(harmonic) {
            check.broken(&field, message);
        }
    }
}

impl Case {
    /// Why a harmonic of root pitch cannot be made, where a swashplate makes it: it gives the blade number per rev and
    /// its neighbours.
    pub fn beyond_swashplate(&self, harmonic: usize) -> Option<String> {
        let blades = self.rotor.blades;
        let beyond = harmonic.abs_diff(blades) > 1;
        (self.rotor.root_pitch_by == RootPitchBy::Swashplate && beyond).then(|| {
            format!(
                "a swashplate of {blades} blades gives {} to {} per rev: give one of these, or rotor.root_pitch_by: EachBlade",
                blades.saturating_sub(1),
                blades + 1
            )
        })
    }
}

/// Springs in their range, and a root that holds the blade.
fn check_root(check: &mut Checker, case: &Case) {
    let r = &case.rotor;
    let remedy = "moment per rad over m0 Omega^2 R^3; Locked is the stiffest, Free has none";
    // below a sixth of the paper's blade in torsion a pitch link holds no pitch any more
    let pitch_remedy =
        "moment per rad over m0 Omega^2 R^3; a pitch link is stiffer, Locked is stiffest";
    for (hinge, joint, least, remedy) in [
        ("flap", r.root.flap, LEAST_SPRING, remedy),
        ("lag", r.root.lag, LEAST_SPRING, remedy),
        ("pitch", r.root.feather, LEAST_PITCH_SPRING, pitch_remedy),
    ] {
        if let Joint::Spring { stiffness } = joint {
            let field = format!("rotor.root.{hinge}.stiffness");
            check.within(&field, stiffness, (least, 1e4), "", remedy);
        }
    }
    if r.root.lag == Joint::Free && r.root_offset_r == 0.0 {
        let message = "a lag hinge at the rotor centre has no stiffness, the blade turns about the shaft on its own: give rotor.root_offset_r, or Spring(stiffness: ...)";
        check.refuse("rotor.root.lag", message);
    }
    if r.lag_damper > 0.0 && r.root.lag == Joint::Locked {
        let message =
            "a damper needs a lag joint that turns: give rotor.root.lag: Free or Spring, or 0";
        check.refuse("rotor.lag_damper", message);
    }
    if r.root.feather == Joint::Free {
        let message =
            "a blade without pitch link holds no pitch: give Spring(stiffness: ...), or Locked";
        check.refuse("rotor.root.pitch", message);
    }
}

/// A mass centre farther from the elastic axis than the radius of gyration about that axis.
fn check_mass_centre(check: &mut Checker, case: &Case) {
    let r = &case.rotor;
    let listed = r.tables.km2_r.iter().map(|own| own.1).reduce(f64::min);
    let (key, least) = listed.map_or(("km2_r", r.km2_r), |least| ("tables.km2_r", least));
    let offset = r.mass_centre_r;
    if least > 0.0 && offset.abs() > least {
        let message = format!(
            "{offset} R is farther from the elastic axis than rotor.{key}, {least} R, the radius of gyration about that axis: give a radius of at least sqrt(k^2 + mass_centre_r^2), with k that about the mass centre"
        );
        check.refuse("rotor.mass_centre_r", message);
    }
}

/// Offsets and terms of torsion that the chosen couplings know.
fn check_couplings(check: &mut Checker, case: &Case) {
    let (r, s) = (&case.rotor, &case.structure);
    let moderate = s.couplings == CouplingsChoice::Moderate;
    let offset = "Linear and Full know no offsets: choose structure.couplings: Moderate, or give 0";
    let torque = "Moderate knows no torque offset: choose structure.couplings: Full, or give 0";
    let term =
        "Linear and Full have no such term: choose structure.couplings: Moderate, or leave it out";
    let swept = r.tables.set_back_r.iter().any(|(_, back)| *back != 0.0);
    let mass = "Linear and Full know no mass behind the axis: choose structure.couplings: Moderate, or leave it out";
    let air = &case.aerodynamics;
    let linear = air.dynamic_stall == DynamicStallChoice::Off && air.airfoils.is_empty();
    let sections = "airfoil tables and dynamic stall know no sweep: leave aerodynamics.airfoils and dynamic_stall out, or the sweep";
    for (field, is_given, is_known, message) in [
        ("rotor.tables.set_back_r", swept, moderate, mass),
        ("rotor.tables.set_back_r", swept, linear, sections),
        ("rotor.mass_centre_r", r.mass_centre_r != 0.0, moderate, offset),
        ("rotor.tension_centre_r", r.tension_centre_r != 0.0, moderate, offset),
        ("rotor.torque_offset_r", r.torque_offset_r != 0.0, !moderate, torque),
        ("structure.untwist", s.untwist != Untwist::default(), moderate, term),
        ("structure.twist_angle", s.twist_angle != TwistAngle::default(), moderate, term),
    ] {
        if is_given && !is_known {
            check.refuse(field, message);
        }
    }
}

/// The angle of a swept blade, its flaps, and its radius of gyration about the straight elastic axis.
fn check_sweep(check: &mut Checker, case: &Case) {
    let table = &case.rotor.tables.set_back_r;
    let at = |i: usize| format!("rotor.tables.set_back_r[{i}]");
    for (i, pair) in table.windows(2).enumerate() {
        let [(from, back), (to, next)] = [pair[0], pair[1]];
        let angle = ((next - back) / (to - from)).atan().to_degrees();
        if angle.abs() > MOST_SWEEP_DEG {
            let message = format!(
                "the blade sweeps by {angle:.0} deg from {from} R to {to} R; 45 deg is the most, a jump has no angle"
            );
            check.refuse(&at(i + 1), message);
        }
        let flap = case.flaps.iter().position(|f| f.start_r < to && f.end_r > from);
        if let (Some(flap), true) = (flap, angle != 0.0) {
            let message = format!(
                "the blade sweeps from {from} R to {to} R, where flaps[{flap}] is; a flap stands on an unswept part"
            );
            check.refuse(&at(i + 1), message);
        }
    }
    let Ok(blade) = case.blade_properties() else { return };
    for (i, &(station, back)) in table.iter().enumerate() {
        let (offset, about) =
            (case.rotor.mass_centre_r - back, blade.squared_mass_radii(station)[1]);
        if offset * offset > about {
            let message = format!(
                "the mass centre lies {offset} R from the elastic axis, farther than the radius of gyration about that axis, {} R: give rotor.tables.km2_r of at least sqrt(k^2 + offset^2), with k that about the mass centre",
                about.sqrt()
            );
            check.refuse(&at(i), message);
        }
    }
}

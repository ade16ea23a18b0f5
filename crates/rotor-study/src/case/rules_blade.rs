//! Rules of the blade: root, offsets, tables along the span, blades that differ.

use super::blade::{RIGID, RIGID_ALONG, TableKind};
use super::checker::{Checker, number};
use super::field::{Field, Range, Value as _};
use super::{Case, CaseFault, CouplingsChoice, DynamicStallChoice, Joint, TwistAngle, Untwist};

/// Softest springs of flap and lag hinges and of the pitch link, over `m0 Omega^2 R^3`.
const LEAST_SPRING: f64 = 1e-6;
const LEAST_PITCH_SPRING: f64 = 1e-3;
/// Largest sweep of a part of the blade, deg.
const MOST_SWEEP_DEG: f64 = 45.0;

/// Checks what the blade has beyond the uniform one on a clamp.
pub(super) fn check_blade(check: &mut Checker, case: &Case) {
    let r = &case.rotor;
    let remedy = "moment per rad over m0 Omega^2 R^3; Locked is the stiffest, Free has none";
    // below a sixth of the paper's blade in torsion a pitch link holds no pitch any more
    let pitch_remedy =
        "moment per rad over m0 Omega^2 R^3; a pitch link is stiffer, Locked is stiffest";
    for (field, joint, least, remedy) in [
        ("rotor.root.flap.stiffness", r.root.flap, LEAST_SPRING, remedy),
        ("rotor.root.lag.stiffness", r.root.lag, LEAST_SPRING, remedy),
        ("rotor.root.pitch.stiffness", r.root.feather, LEAST_PITCH_SPRING, pitch_remedy),
    ] {
        if let Joint::Spring { stiffness } = joint {
            check.within(number(field, stiffness, "", remedy), least, 1e4);
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
    for (field, value) in
        [("rotor.mass_centre_r", r.mass_centre_r), ("rotor.tension_centre_r", r.tension_centre_r)]
    {
        if value != 0.0 && case.structure.couplings != CouplingsChoice::Moderate {
            let message =
                "Linear and Full know no offsets: choose structure.couplings: Moderate, or give 0";
            check.refuse(field, message);
        }
    }
    check_mass_centre(check, case);
    check_sweep(check, case);
    let field = "rotor.aerodynamic_centre_r";
    let remedy =
        "quarter chord ahead of the elastic axis is positive; the axis lies inside the chord";
    let quarter = 0.25 * r.chord_r;
    check.within(number(field, r.aerodynamic_centre_r, "R", remedy), -3.0 * quarter, quarter);
    let field = "rotor.torque_offset_r";
    if r.torque_offset_r != 0.0 && case.structure.couplings == CouplingsChoice::Moderate {
        let message =
            "Moderate knows no torque offset: choose structure.couplings: Full, or give 0";
        check.refuse(field, message);
    }
    check_torsion_terms(check, case);
    check_tables(check, case);
    for (i, blade) in r.dissimilar_blades.iter().enumerate() {
        let at = |key: &str| format!("rotor.dissimilar_blades[{i}].{key}");
        check.count(&at("blade"), blade.blade, (1, r.blades), "blades are counted from 1");
        if r.dissimilar_blades[..i].iter().any(|before| before.blade == blade.blade) {
            let first = format!("rotor.dissimilar_blades[{i}]");
            let name = blade.blade.to_string();
            check.fault(&at("blade"), CaseFault::Repeated { name, of: "dissimilar blade", first });
        }
    }
}

/// A mass centre farther from the elastic axis than the radius of gyration about that axis.
fn check_mass_centre(check: &mut Checker, case: &Case) {
    let r = &case.rotor;
    let listed = r.tables.km2_r.iter().map(|own| own.1).reduce(f64::min);
    let (key, least) = listed.map_or(("km2_r", r.km2_r), |least| ("tables.km2_r", least));
    let backs = r.tables.set_back_r.iter().map(|(_, back)| r.mass_centre_r - back);
    let offset = backs.fold(r.mass_centre_r, |far, at| if at.abs() > far.abs() { at } else { far });
    if least > 0.0 && offset.abs() > least {
        let message = format!(
            "{offset} R is farther from the elastic axis than rotor.{key}, {least} R, the radius of gyration about that axis: give a radius of at least sqrt(k^2 + mass_centre_r^2), with k that about the mass centre"
        );
        check.refuse("rotor.mass_centre_r", message);
    }
}

/// A swept blade: what knows it, its angle, its flaps, its radius of gyration about the elastic axis.
fn check_sweep(check: &mut Checker, case: &Case) {
    let (field, table) = ("rotor.tables.set_back_r", &case.rotor.tables.set_back_r);
    if table.iter().all(|(_, back)| *back == 0.0) {
        return;
    }
    if case.structure.couplings != CouplingsChoice::Moderate {
        let message = "Linear and Full know no mass behind the axis: choose structure.couplings: Moderate, or leave it out";
        check.refuse(field, message);
    }
    let air = &case.aerodynamics;
    if air.dynamic_stall != DynamicStallChoice::Off || !air.airfoils.is_empty() {
        let message = "airfoil tables and dynamic stall know no sweep: leave aerodynamics.airfoils and dynamic_stall out, or the sweep";
        check.refuse(field, message);
    }
    for (i, pair) in table.windows(2).enumerate() {
        let [(from, back), (to, next)] = [pair[0], pair[1]];
        let angle = ((next - back) / (to - from)).atan().to_degrees();
        let at = format!("{field}[{}]", i + 1);
        if angle.abs() > MOST_SWEEP_DEG {
            let message = format!(
                "the blade sweeps by {angle:.0} deg from {from} R to {to} R; 45 deg is the most, a jump has no angle"
            );
            check.refuse(&at, message);
        }
        let flap = case.flaps.iter().position(|f| f.start_r < to && f.end_r > from);
        if let (Some(flap), true) = (flap, next != back) {
            let message = format!(
                "the blade sweeps from {from} R to {to} R, where flaps[{flap}] is; a flap stands on an unswept part"
            );
            check.refuse(&at, message);
        }
    }
}

/// Terms that the chosen couplings know.
fn check_torsion_terms(check: &mut Checker, case: &Case) {
    let chosen = &case.structure;
    if chosen.couplings == CouplingsChoice::Moderate {
        return;
    }
    for (field, is_default) in [
        ("structure.untwist", chosen.untwist == Untwist::default()),
        ("structure.twist_angle", chosen.twist_angle == TwistAngle::default()),
    ] {
        if !is_default {
            let message = "Linear and Full have no such term: choose structure.couplings: Moderate, or leave it out";
            check.refuse(field, message);
        }
    }
}

/// A value of a table.
const SECTION: Field = Field { key: "", meaning: &[], range: Range::Any, unit: "", remedy: "" };

/// Stations that grow, cover the blade and hold values that a blade can have.
fn check_tables(check: &mut Checker, case: &Case) {
    let root = case.rotor.root_offset_r;
    for (key, table, kind) in case.rotor.tables.named() {
        let at = |i: usize| format!("rotor.tables.{key}[{i}]");
        for (i, &(station, value)) in table.iter().enumerate() {
            let before = if i == 0 { 0.0 } else { table[i - 1].0 };
            let twice = table[..i].iter().position(|(s, _)| (s - station).abs() < 1e-12);
            if let Some(first) = twice {
                let message = format!(
                    "the station {station} R is given twice, as number {} and number {} of the list; give each once, a jump as two stations a little apart, such as {station} and {}",
                    first + 1,
                    i + 1,
                    station + 1e-3
                );
                check.refuse(&at(i), message);
            } else if !(station >= before && (i == 0 || station > before) && station <= 1.0) {
                let remedy = "list the stations from root to tip, each once";
                let (low, high) = (before, 1.0);
                let fault = CaseFault::OutOfRange { value: station, low, high, unit: "R", remedy };
                check.fault(&at(i), fault);
            }
            match kind {
                TableKind::Positive => {
                    let remedy = "a mass, a stiffness or a radius of a section is positive";
                    let most = if key == "ea" { RIGID_ALONG } else { RIGID };
                    let field = Field { range: Range::UpTo(most), unit: "", remedy, ..SECTION };
                    if let Some(fault) = value.fault(&field) {
                        check.fault(&at(i), fault);
                    }
                }
                TableKind::Radius => {
                    let remedy = "a radius is not negative; 0.029 R is usual";
                    check.within(number(&at(i), value, "R", remedy), 0.0, 1.0);
                }
                TableKind::Angle => {
                    let remedy = "a helicopter's blade turns by 8 to 16 deg from root to tip";
                    check.within(number(&at(i), value, "deg", remedy), -90.0, 90.0);
                }
                TableKind::SetBack => {
                    let remedy = "aft positive; a tip swept by 20 deg from 0.92 R ends at 0.029 R";
                    check.within(number(&at(i), value, "R", remedy), -0.2, 0.2);
                }
                TableKind::Chord => {
                    let remedy = "a blade's chord is 0.03 to 0.12 R";
                    check.within(number(&at(i), value, "R", remedy), 1e-3, 0.5);
                }
            }
        }
        let (Some(first), Some(last)) = (table.first(), table.last()) else { continue };
        if first.0 > root + 1e-9 || last.0 < 1.0 - 1e-9 || table.len() < 2 {
            let message = format!(
                "the table reaches from {} R to {} R, the blade from {root} R to 1 R; give a value at both ends",
                first.0, last.0
            );
            check.refuse(&format!("rotor.tables.{key}"), message);
        }
    }
}

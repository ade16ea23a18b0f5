//! What a blade may lack.

use super::BladeModel;
use crate::properties;
use model_gap::points::{CauseParameter, PointCause, Shown};
use rotor_case::{Case, times};
use rotor_fem::Joint;

/// A cause, ready for one blade.
pub type BladeCause = PointCause<BladeModel>;

/// Names of the causes of a blade.
pub const BLADE_LIBRARY: [&str; 8] = [
    "stiffness-flap",
    "stiffness-lag",
    "stiffness-torsion",
    "root-offset",
    "rotor-speed",
    "tip-mass",
    "root-compliance",
    "mass",
];

/// Part of the radius that a mass at the tip is spread over, all the more of it the further out.
const TIP: f64 = 0.02;
const AT_REST: &[&str] = &["frequencies at rest", "frequencies at other rotor speeds"];

/// The causes of a blade whose modes of these names were read.
pub(super) fn library(model: &BladeModel, modes: &[String]) -> Vec<BladeCause> {
    let stiffnesses = [
        properties::stiffness_flap(),
        properties::stiffness_lag(),
        properties::stiffness_torsion(),
    ];
    let mut all: Vec<BladeCause> =
        stiffnesses.map(|own| own.beside(&["mass", "root-compliance"], AT_REST)).to_vec();
    all.extend([root_offset(model), rotor_speed(), tip_mass(model)]);
    all.extend(root_compliance(model, modes));
    all.push(properties::mass().beside(&["stiffness-flap"], &["the weight of the blade"]));
    all
}

/// A blade of the same length whose root lies further out; all that a case holds is over the radius.
fn further_out(case: &mut Case, offset_r: f64) {
    let r = &mut case.rotor;
    let longer = 1.0 + offset_r;
    let (second, fourth) = (longer.powi(-2), longer.powi(-4));
    let t = &mut r.tables;
    for (uniform, table) in
        [(&mut r.ei_flap, &mut t.ei_flap), (&mut r.ei_lag, &mut t.ei_lag), (&mut r.gj, &mut t.gj)]
    {
        times(uniform, table, fourth);
    }
    times(&mut r.ea, &mut t.ea, second);
    for (uniform, table) in [
        (&mut r.km1_r, &mut t.km1_r),
        (&mut r.km2_r, &mut t.km2_r),
        (&mut r.ka_r, &mut t.ka_r),
        (&mut r.chord_r, &mut t.chord_r),
        (&mut r.mass_centre_r, &mut t.set_back_r),
    ] {
        times(uniform, table, 1.0 / longer);
    }
    for table in [
        &mut t.mass,
        &mut t.ei_flap,
        &mut t.ei_lag,
        &mut t.gj,
        &mut t.ea,
        &mut t.km1_r,
        &mut t.km2_r,
        &mut t.ka_r,
        &mut t.twist_deg,
        &mut t.set_back_r,
        &mut t.chord_r,
    ] {
        for (station, _) in table {
            *station = (*station + offset_r) / longer;
        }
    }
    for joint in [&mut r.root.flap, &mut r.root.lag, &mut r.root.feather] {
        if let Joint::Spring { stiffness } = joint {
            *stiffness *= longer.powi(-3);
        }
    }
    for length in [&mut r.tension_centre_r, &mut r.aerodynamic_centre_r, &mut r.torque_offset_r] {
        *length /= longer;
    }
    r.root_offset_r = (r.root_offset_r + offset_r) / longer;
    // over a longer radius the same twist per length is more
    r.twist_deg *= longer;
    r.radius_m *= longer;
    for flap in &mut case.flaps {
        for station in [&mut flap.start_r, &mut flap.end_r] {
            *station = (*station + offset_r) / longer;
        }
    }
}

fn root_offset(model: &BladeModel) -> BladeCause {
    let physics =
        "the root of the blade lies further out or in: a blade of the same length, shifted";
    // no root lies beyond the axis
    let inmost = -model.case.rotor.root_offset_r.clamp(0.0, 0.15);
    let mut amounts = vec![0.005, 0.03];
    if inmost < -0.01 {
        amounts.push(-0.005);
    }
    let (name, unit, shown) = ("offset_r", "R", Shown::Itself);
    let parameter = CauseParameter { name, unit, none: 0.0, range: (inmost, 0.15), amounts, shown };
    PointCause::new("root-offset", physics, vec![parameter], |m: &mut BladeModel, v| {
        if v[0] != 0.0 {
            further_out(&mut m.case, v[0]);
        }
    })
    .beside(
        &["rotor-speed"],
        &["where the root is, measured", "the rotor speed, measured another way"],
    )
}

fn rotor_speed() -> BladeCause {
    let physics = "the rotor turns faster or slower than stated: speed times a ratio";
    let parameters = vec![CauseParameter::ratio(&[1.01, 0.98, 1.05], (0.8, 1.25))];
    PointCause::new("rotor-speed", physics, parameters, |m: &mut BladeModel, v| m.speed *= v[0])
        .beside(&["root-offset"], &["the rotor speed, measured another way"])
}

fn tip_mass(model: &BladeModel) -> BladeCause {
    let physics = "the tip carries a mass, such as a balance weight or a sensor";
    let unit_kg = model.case.rotor.mass_kg_m * model.case.rotor.radius_m;
    let parameter = CauseParameter {
        name: "mass_kg",
        unit: "kg",
        none: 0.0,
        range: (0.0, 0.3 * unit_kg),
        amounts: vec![0.01 * unit_kg, 0.05 * unit_kg],
        shown: Shown::Itself,
    };
    PointCause::new("tip-mass", physics, vec![parameter], move |m: &mut BladeModel, v| {
        let table = &mut m.case.rotor.tables.mass;
        if v[0] == 0.0 {
            return;
        }
        if table.is_empty() {
            *table = vec![(0.0, 1.0), (1.0, 1.0)];
        }
        let inner = 1.0 - TIP;
        let at = |station: f64| {
            let after =
                table.iter().position(|own| own.0 >= station).unwrap_or(table.len() - 1).max(1);
            let (a, b) = (table[after - 1], table[after]);
            a.1 + (station - a.0) / (b.0 - a.0) * (b.1 - a.1)
        };
        let more = 2.0 * v[0] / unit_kg / TIP;
        let (own, end) = (at(inner), at(1.0));
        table.retain(|own| own.0 < inner);
        table.extend([(inner, own), (1.0, end + more)]);
    })
    .beside(&["stiffness-flap", "mass"], &["the weight of the blade and its centre"])
}

/// A root that gives way in flap, lag or twist.
fn root_compliance(model: &BladeModel, modes: &[String]) -> [BladeCause; 3] {
    let has = |kind: &str| modes.iter().any(|own| own.starts_with(kind));
    let case = &model.case;
    let unit = case.scales().moment_newton_metre();
    let told: &[&str] = &["a static load at the root", "frequencies of the third mode and above"];
    let named = |physics| ("root-compliance", physics);
    // what a fiftieth of the blade gives
    let give = |stiffness: f64| (0.02 / (stiffness * unit), &[1.0, 4.0][..]);
    let r = &case.rotor;
    let flap = named("the root gives way in flap bending: a spring in place of a clamp");
    let lag = named("the root gives way in lag bending: a spring in place of a clamp");
    let twist = named("the root gives way in pitch: a spring in place of a stiff pitch link");
    [
        properties::root_spring(flap, model, |r| &mut r.root.flap, give(r.ei_flap))
            .beside(&["stiffness-flap"], told),
        properties::root_spring(lag, model, |r| &mut r.root.lag, give(r.ei_lag))
            .beside(&["stiffness-lag"], told)
            .blocked_if(!has("lag"), "no lag mode was read"),
        properties::root_spring(twist, model, |r| &mut r.root.feather, give(r.gj))
            .beside(&["stiffness-torsion"], told)
            .blocked_if(!has("torsion"), "no torsion mode was read"),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_study::{AboutState, ModesQuestion, modes_at_speeds};

    /// A clamped blade of the same length sounds alike at rest wherever its root is, and higher when it turns further out.
    #[test]
    fn a_blade_further_out_is_the_same_blade() {
        let mut model =
            BladeModel { case: Case::default(), speed: 1.0, about: AboutState::Undeformed };
        model.case.rotor.tables.mass = vec![(0.0, 1.2), (0.6, 1.0), (1.0, 0.9)];
        let hz = |case: &Case| -> Vec<f64> {
            let question =
                ModesQuestion { about: AboutState::Undeformed, ..ModesQuestion::default() };
            let found = modes_at_speeds(case, &question, &[0.0, 1.0]).unwrap();
            found.iter().flat_map(|own| own.modes.iter().map(|mode| mode.hz)).collect()
        };
        let own = hz(&model.case);
        let out = root_offset(&model).applied(&model, &[0.06]);
        let out = hz(&out.case);
        let half = own.len() / 2;
        for (a, b) in own[..half].iter().zip(&out[..half]) {
            assert!((a / b - 1.0).abs() < 1e-6, "{a} {b}");
        }
        assert!(out[half] > 1.01 * own[half], "{} {}", out[half], own[half]);
    }

    /// A blade whose root is on the axis may have it further out, not further in.
    #[test]
    fn no_root_lies_beyond_the_axis() {
        let mut model =
            BladeModel { case: Case::default(), speed: 1.0, about: AboutState::Undeformed };
        for (offset_r, inmost, count) in [(0.0, 0.0, 2), (0.06, -0.06, 3)] {
            model.case.rotor.root_offset_r = offset_r;
            let parameter = root_offset(&model).parameters[0].clone();
            assert!((parameter.range.0 - inmost).abs() < 1e-12);
            assert_eq!(parameter.amounts.len(), count);
            assert!(parameter.amounts.iter().all(|amount| *amount > inmost));
        }
    }
}

//! What a blade may lack.

use super::BladeModel;
use model_gap::points::{CauseParameter, PointCause, Shown};
use rotor_fem::Joint;
use rotor_study::case::{Case, RotorValues, times};

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

const STEPS: [f64; 3] = [1.05, 0.9, 1.25];
const RANGE: (f64, f64) = (0.4, 2.5);
/// Part of the radius that a mass at the tip is spread over, all the more of it the further out.
const TIP: f64 = 0.02;
const AT_REST: &[&str] = &["frequencies at rest", "frequencies at other rotor speeds"];

/// A property of the blade, uniform and as a table.
type Property<'a> = (&'a mut f64, &'a mut Vec<(f64, f64)>);

fn stiffness(
    id: &'static str,
    physics: &'static str,
    of: fn(&mut RotorValues) -> Property<'_>,
) -> BladeCause {
    PointCause::new(
        id,
        physics,
        vec![CauseParameter::ratio(&STEPS, RANGE)],
        move |m: &mut BladeModel, v| {
            let (uniform, table) = of(&mut m.case.rotor);
            times(uniform, table, v[0]);
        },
    )
    .beside(&["mass", "root-compliance"], AT_REST)
}

/// The causes of a blade.
pub(super) fn library(model: &BladeModel) -> Vec<BladeCause> {
    vec![
        stiffness(
            "stiffness-flap",
            "the blade bends more or less easily out of the plane: EI_flap times a ratio",
            |r| (&mut r.ei_flap, &mut r.tables.ei_flap),
        ),
        stiffness(
            "stiffness-lag",
            "the blade bends more or less easily in the plane: EI_lag times a ratio",
            |r| (&mut r.ei_lag, &mut r.tables.ei_lag),
        ),
        stiffness(
            "stiffness-torsion",
            "the blade twists more or less easily: GJ times a ratio",
            |r| (&mut r.gj, &mut r.tables.gj),
        ),
        root_offset(),
        rotor_speed(),
        tip_mass(model),
        root_compliance(model),
        mass(),
    ]
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
    for (uniform, table) in
        [(&mut r.km1_r, &mut t.km1_r), (&mut r.km2_r, &mut t.km2_r), (&mut r.ka_r, &mut t.ka_r)]
    {
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
    r.chord_r /= longer;
    r.root_offset_r = (r.root_offset_r + offset_r) / longer;
    r.radius_m *= longer;
}

fn root_offset() -> BladeCause {
    let physics =
        "the root of the blade lies further out or in: a blade of the same length, shifted";
    let parameters = vec![CauseParameter::both_ways("offset_r", "R", &[0.005, -0.005, 0.03], 0.15)];
    PointCause::new("root-offset", physics, parameters, |m: &mut BladeModel, v| {
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

/// The compliance of the root in flap is what adds up; its reciprocal is reported.
fn root_compliance(model: &BladeModel) -> BladeCause {
    let physics = "the root gives way in flap bending: a spring in place of a clamp";
    let unit_newton_metre = model.case.scales().moment_newton_metre();
    let joint = model.case.rotor.root.flap;
    let none = match joint {
        Joint::Spring { stiffness } => 1.0 / (stiffness * unit_newton_metre),
        _ => 0.0,
    };
    // what a fiftieth of the blade gives in bending
    let give = 0.02 / (model.case.rotor.ei_flap * unit_newton_metre);
    let parameter = CauseParameter {
        name: "stiffness",
        unit: "N m/rad",
        none,
        range: (0.0, none + 50.0 * give),
        amounts: vec![none + give, none + 4.0 * give],
        shown: Shown::Reciprocal,
    };
    PointCause::new("root-compliance", physics, vec![parameter], move |m: &mut BladeModel, v| {
        let is_same = v[0] - none == 0.0;
        if !is_same {
            let compliance = v[0] * unit_newton_metre;
            m.case.rotor.root.flap = if compliance > 0.0 {
                Joint::Spring { stiffness: 1.0 / compliance }
            } else {
                Joint::Locked
            };
        }
    })
    .beside(
        &["stiffness-flap"],
        &["a static load at the root", "frequencies of the third mode and above"],
    )
    .blocked_if(joint == Joint::Free, "the blade hangs on a hinge")
}

/// The stiffnesses are over the mass.
fn mass() -> BladeCause {
    let physics = "the blade is heavier or lighter: mass per length times a ratio";
    PointCause::new(
        "mass",
        physics,
        vec![CauseParameter::ratio(&STEPS, RANGE)],
        |m: &mut BladeModel, v| {
            m.case.rotor.stiffen(1.0 / v[0]);
            m.case.rotor.mass_kg_m *= v[0];
        },
    )
    .beside(&["stiffness-flap"], &["the weight of the blade"])
}

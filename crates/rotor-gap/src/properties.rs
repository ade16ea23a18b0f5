//! What the blade in a case may lack, of a rotor and of a blade alone alike.

use model_gap::points::{CauseParameter, PointCause, Shown};
use rotor_case::{Case, RotorValues, times};
use rotor_fem::Joint;

/// A model that is a case with something beside.
pub(crate) trait OfCase: Clone + 'static {
    fn case(&self) -> &Case;
    fn case_mut(&mut self) -> &mut Case;
}

/// A property of the blade, uniform and as a table.
type Property<'a> = (&'a mut f64, &'a mut Vec<(f64, f64)>);

/// A mode near a harmonic answers far from straight: amounts on both sides.
const STEPS: [f64; 3] = [1.05, 0.85, 1.2];
const RANGE: (f64, f64) = (0.4, 2.0);

fn stiffness<M: OfCase>(
    id: &'static str,
    physics: &'static str,
    of: fn(&mut RotorValues) -> Property<'_>,
) -> PointCause<M> {
    let parameters = vec![CauseParameter::ratio(&STEPS, RANGE)];
    PointCause::new(id, physics, parameters, move |m: &mut M, v| {
        let (uniform, table) = of(&mut m.case_mut().rotor);
        times(uniform, table, v[0]);
    })
}

pub(crate) fn stiffness_flap<M: OfCase>() -> PointCause<M> {
    let physics = "the blade bends more or less easily out of the plane: EI_flap times a ratio";
    stiffness("stiffness-flap", physics, |r| (&mut r.ei_flap, &mut r.tables.ei_flap))
}

pub(crate) fn stiffness_lag<M: OfCase>() -> PointCause<M> {
    let physics = "the blade bends more or less easily in the plane: EI_lag times a ratio";
    stiffness("stiffness-lag", physics, |r| (&mut r.ei_lag, &mut r.tables.ei_lag))
}

pub(crate) fn stiffness_torsion<M: OfCase>() -> PointCause<M> {
    let physics = "the blade twists more or less easily: GJ times a ratio";
    stiffness("stiffness-torsion", physics, |r| (&mut r.gj, &mut r.tables.gj))
}

/// The stiffnesses are over the mass, and so is the Lock number.
pub(crate) fn mass<M: OfCase>() -> PointCause<M> {
    let physics = "the blades are heavier or lighter: mass per length times a ratio";
    let parameters = vec![CauseParameter::ratio(&[1.03, 0.95, 1.1], (0.5, 2.0))];
    PointCause::new("mass", physics, parameters, |m: &mut M, v| {
        let r = &mut m.case_mut().rotor;
        let lighter = 1.0 / v[0];
        r.stiffen(lighter);
        r.lag_damper *= lighter;
        r.lock_number *= lighter;
        r.mass_kg_m *= v[0];
    })
}

/// A joint at the root that gives way. Its compliance, rad/(N m), is what adds up; the reciprocal is reported. `give` is the
/// compliance that matters, of some amounts, over that of the joint as it is.
pub(crate) fn root_spring<M: OfCase>(
    (id, physics): (&'static str, &'static str),
    model: &M,
    joint: fn(&mut RotorValues) -> &mut Joint,
    (give, times): (f64, &[f64]),
) -> PointCause<M> {
    let unit_newton_metre = model.case().scales().moment_newton_metre();
    let own = *joint(&mut model.case().rotor.clone());
    let none = match own {
        Joint::Spring { stiffness } => 1.0 / (stiffness * unit_newton_metre),
        _ => 0.0,
    };
    let parameter = CauseParameter {
        name: "stiffness",
        unit: "N m/rad",
        none,
        range: (0.0, none + 50.0 * give),
        amounts: times.iter().map(|times| none + times * give).collect(),
        shown: Shown::Reciprocal,
    };
    PointCause::new(id, physics, vec![parameter], move |m: &mut M, v| {
        let is_same = v[0] - none == 0.0;
        if !is_same {
            let compliance = v[0] * unit_newton_metre;
            *joint(&mut m.case_mut().rotor) = if compliance > 0.0 {
                Joint::Spring { stiffness: 1.0 / compliance }
            } else {
                Joint::Locked
            };
        }
    })
    .blocked_if(own == Joint::Free, "the blade hangs on a hinge")
}

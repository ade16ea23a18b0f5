//! Rotor and wake marched in time where a periodic state exists.

use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{Discretisation, ResponseTolerances, Rotor, RotorModel, RotorSolver};
use std::sync::Arc;
use trim::{
    InTimeSettings, SteadySettings, TrimSettings, TrimTarget, Vehicle, WakeOutcome, WakeTrim,
    WakeTrimSettings, steady_in_time, trim_in_free_wake,
};
use validation::{Check, Failure, row, worst};

const PERIODIC: &str = "trim in the periodic free wake, settled by relaxation";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-TRIM-12",
        "rotor and free wake marched in time for 7 revolutions from their periodic trim, mu 0.15, 0.20, 0.30, modes \
         damped by 3 %, 36 steps of the wake and 288 of the blades: 4/rev hub loads off it, of the vector, largest",
        "%",
    )
    .against(PERIODIC)
    .at_most(1.0, || {
        let of = [0.15, 0.2, 0.3].map(|mu| Ok(100.0 * off(mu)?));
        worst("mu", 3, of)
    }),
    row(
        "V-TRIM-13",
        "trim on the means, mu 0.30, from a trim with 5 % less thrust, 32 revolutions: collective off that of the trim; it \
         began 0.14 deg off",
        "deg",
    )
    .against(PERIODIC)
    .at_most(0.02, collective_off).long(),
];

const CT_SIGMA: f64 = 0.07;

fn solver(mu: f64) -> Result<RotorSolver, Failure> {
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    let model = RotorModel { modal_damping: 0.03, ..RotorModel::paper_case() };
    let rotor = Arc::new(Rotor::new(model, &blade, Discretisation::default())?);
    Ok(RotorSolver::new(rotor, mu, ResponseTolerances::default())?)
}

fn target(weight_ct_sigma: f64) -> TrimTarget {
    TrimTarget::Propulsive { weight_ct_sigma, vehicle: Vehicle::default() }
}

fn periodic(solver: &mut RotorSolver, mu: f64, ct_sigma: f64) -> Result<WakeTrim, Failure> {
    let settings = WakeTrimSettings::default();
    let of_trim = TrimSettings::default();
    let found = trim_in_free_wake(solver, &settings, mu, &target(ct_sigma), &of_trim)?;
    assert_eq!(found.outcome, WakeOutcome::Settled);
    Ok(found)
}

fn still(_: usize, _: f64, _: f64) -> Vec<[f64; 3]> {
    vec![[0.0; 3]; 2]
}

fn off(mu: f64) -> Result<f64, Failure> {
    let mut solver = solver(mu)?;
    let found = periodic(&mut solver, mu, CT_SIGMA)?;
    let (controls, shaft_tilt_rad) = (found.trim.controls, found.trim.flight.shaft_tilt_rad);
    let held = TrimTarget::Prescribed { controls, shaft_tilt_rad };
    let settings = SteadySettings { settling: 6, revolutions: 1, ..SteadySettings::default() };
    let marched = steady_in_time(&solver, &found, &held, &settings, &still, &mut |_, _| {})?;
    let exact = found.trim.rotor.hub.harmonic(4);
    let norm = |of: &mut dyn Iterator<Item = f64>| of.map(|v| v * v).sum::<f64>().sqrt();
    let apart = norm(&mut marched.at_blade_number.iter().zip(exact).map(|(a, b)| a.mean - b));
    Ok(apart / norm(&mut exact.into_iter()))
}

fn collective_off() -> Result<f64, Failure> {
    let mu = 0.3;
    let mut solver = solver(mu)?;
    let wanted = periodic(&mut solver, mu, CT_SIGMA)?.trim.controls.theta0_rad;
    let begun = periodic(&mut solver, mu, 0.95 * CT_SIGMA)?;
    let began_off = (begun.trim.controls.theta0_rad - wanted).abs().to_degrees();
    assert!(began_off > 0.1, "{began_off}");
    let march = InTimeSettings { blade_steps_per_revolution: 144, ..InTimeSettings::default() };
    let settings =
        SteadySettings { march, settling: 28, revolutions: 4, ..SteadySettings::default() };
    let found =
        steady_in_time(&solver, &begun, &target(CT_SIGMA), &settings, &still, &mut |_, _| {})?;
    assert!(found.balanced, "{:?}", found.residuals);
    Ok((found.controls.theta0_rad - wanted).abs().to_degrees())
}

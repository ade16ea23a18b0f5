//! What a march in time refuses, and what it keeps.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use rotor_base::HarmonicSeries;
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Condition, Controls, Discretisation, DynamicStall, InstantDrive, ResponseError,
    ResponseTolerances, Rotor, RotorInTime, RotorModel, RotorSolver,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

fn rotor(change: impl FnOnce(&mut RotorModel)) -> Arc<Rotor> {
    let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
    let mut model = RotorModel::paper_case();
    change(&mut model);
    let few = Discretisation { modes: [2, 1, 1], ..Discretisation::default() };
    Arc::new(Rotor::new(model, &blade, few).unwrap())
}

fn condition(advance_ratio: f64) -> Condition {
    Condition {
        flight: FlightState { advance_ratio, shaft_tilt_rad: 0.08 },
        controls: Controls { theta0_rad: 0.12, theta1c_rad: 0.02, theta1s_rad: -0.05 },
        flap_angles_rad: vec![HarmonicSeries::zero(0); 2],
        bank_rad: 0.0,
    }
}

#[test]
fn steps_that_no_blade_spacing_fits_and_stalling_sections_are_refused() {
    let refused = |rotor: Arc<Rotor>, steps: usize| {
        let solver = RotorSolver::new(rotor, 0.2, ResponseTolerances::default()).unwrap();
        match RotorInTime::new(&solver, steps) {
            Err(ResponseError::Parameter { field, .. }) => field,
            other => panic!("{other:?}"),
        }
    };
    for steps in [0, 4, 37, 8000] {
        assert_eq!(refused(rotor(|_| {}), steps), "steps_per_revolution");
    }
    let stalling = rotor(|model| {
        model.nonlinear.dynamic_stall = Some(DynamicStall::Of(flap_aero::StallAirfoil::Naca0012));
    });
    assert_eq!(refused(stalling, 72), "dynamic_stall");
}

#[test]
fn another_advance_ratio_is_refused_by_start_and_step() {
    let rotor = rotor(|_| {});
    let tolerances = ResponseTolerances::default();
    let mut solver = RotorSolver::new(rotor, 0.2, tolerances).unwrap();
    let periodic = solver.solve(&condition(0.2), &LinearInflow::Drees, None).unwrap();
    let march = RotorInTime::new(&solver, 72).unwrap();
    let is_refused =
        |error| matches!(error, ResponseError::Parameter { field: "advance_ratio", .. });
    assert!(is_refused(march.start(&periodic, &condition(0.3)).unwrap_err()));
    let start = march.start(&periodic, &condition(0.2)).unwrap();
    let other = condition(0.3);
    let induced = |_: usize| vec![[0.0; 2]; march.lifting_stations().len()];
    let flap_rad = |_: usize| vec![[0.0; 3]; 2];
    let drive = InstantDrive { condition: &other, induced: &induced, flap_rad: &flap_rad };
    assert!(is_refused(march.step(&start, &drive, None).unwrap_err()));
    let at = condition(0.2);
    let one_flap = |_: usize| vec![[0.0; 3]];
    let short = InstantDrive { condition: &at, induced: &induced, flap_rad: &one_flap };
    let refused = march.step(&start, &short, None).unwrap_err();
    assert!(matches!(refused, ResponseError::FlapMotions { given: 1, expected: 2 }));
    let nowhere = |_: usize| Vec::new();
    let short = InstantDrive { condition: &at, induced: &nowhere, flap_rad: &flap_rad };
    let refused = march.step(&start, &short, None).unwrap_err();
    assert!(matches!(refused, ResponseError::Parameter { field: "induced", .. }));
}

/// One blade whose flap moves otherwise shakes at harmonics that like blades cancel, and only it moves otherwise.
#[test]
fn a_blade_may_do_what_the_others_do_not() {
    let rotor = rotor(|model| model.modal_damping = 0.05);
    let tolerances = ResponseTolerances::default();
    let mut solver = RotorSolver::new(rotor, 0.2, tolerances).unwrap();
    let at = condition(0.2);
    let periodic = solver.solve(&at, &LinearInflow::Drees, None).unwrap();
    let march = RotorInTime::new(&solver, 96).unwrap();
    let run = |other: f64| {
        let mut now = march.start(&periodic, &at).unwrap();
        let mut once_per_rev = [0.0; 2];
        let mut roots = Vec::new();
        for step in 1..=4 * 96 {
            let stations = march.lifting_stations();
            let azimuth = |blade| march.azimuth_rad(step, blade);
            let induced = |blade: usize| periodic.inflow.velocities(azimuth(blade), stations);
            let flap_rad = |blade: usize| vec![[if blade == 2 { other } else { 0.0 }, 0.0, 0.0]; 2];
            let drive = InstantDrive { condition: &at, induced: &induced, flap_rad: &flap_rad };
            now = march.step(&now, &drive, None).unwrap();
            roots.push(now.instant().roots.clone());
            if step > 3 * 96 {
                let (sin, cos) = azimuth(0).sin_cos();
                once_per_rev[0] += now.instant().hub[0] * cos;
                once_per_rev[1] += now.instant().hub[0] * sin;
            }
        }
        (once_per_rev[0].hypot(once_per_rev[1]), roots)
    };
    let (alike, of_alike) = run(0.0);
    let (unlike, of_unlike) = run(0.03);
    assert!(unlike > 100.0 * alike, "{unlike:e} {alike:e}");
    for (a, b) in of_alike.iter().zip(&of_unlike) {
        for blade in [0, 1, 3] {
            let apart = a[blade].iter().zip(b[blade]).map(|(a, b)| (a - b).abs());
            assert!(apart.fold(0.0, f64::max) < 1e-12);
        }
    }
    let apart = |step: usize| (of_alike[step][2][2] - of_unlike[step][2][2]).abs();
    assert!((0..of_alike.len()).map(apart).fold(0.0, f64::max) > 1e-4);
}

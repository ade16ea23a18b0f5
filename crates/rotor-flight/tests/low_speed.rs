//! Means at an advance ratio where relaxation finds no periodic wake.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use rotor_case::{AttachedFlowModel, Case, FreeWakeValues, InflowChoice, TrimValues};
use rotor_study::TrimmedRotor;
use trim::{InTimeSettings, Interval, SteadyInTime, SteadySettings, WakeOutcome, steady_in_time};

/// The paper's rotor at mu 0.05 on a coarse grid, the weight over that of the case.
fn case(weight: f64) -> Case {
    let wake = FreeWakeValues {
        azimuths: Some(12),
        turns: Some(3),
        panels: 8,
        ..FreeWakeValues::default()
    };
    let mut case = Case { advance_ratio: 0.05, ..Case::default() };
    case.inflow.model = InflowChoice::FreeWake(wake);
    case.rotor.modal_damping = 0.03;
    case.structure.elements = 4;
    case.structure.modes = [2, 1, 1].into();
    case.aerodynamics.model = AttachedFlowModel::QuasiSteady;
    if let TrimValues::Propulsive(trim) = &mut case.trim {
        trim.ct_sigma *= weight;
    }
    case
}

/// The collective of the trim of a weight, rad; whether its wake settled; and the case marched from there.
fn marched_from(weight: f64) -> (f64, bool, SteadyInTime) {
    let wanted = case(1.0);
    let begun = TrimmedRotor::new(&case(weight), None).unwrap();
    let march = InTimeSettings { blade_steps_per_revolution: 72, ..InTimeSettings::default() };
    let settings =
        SteadySettings { march, settling: 14, revolutions: 24, ..SteadySettings::default() };
    let still = |_: usize, _: f64, _: f64| vec![[0.0; 3]; 2];
    let (target, wake) = (wanted.trim_target(), begun.wake().unwrap());
    let found =
        steady_in_time(begun.solver(), wake, &target, &settings, &still, &mut |_, _| {}).unwrap();
    (wake.trim.controls.theta0_rad, wake.outcome == WakeOutcome::Settled, found)
}

/// Half of the interval of a difference of two means.
fn interval(a: &Interval, b: &Interval) -> f64 {
    a.half_width_95.hypot(b.half_width_95)
}

/// From another thrust, that is from another wake and another collective, the march comes to the same means, where relaxation
/// does not settle.
#[test]
fn the_means_at_low_speed_do_not_know_how_the_march_began() {
    let [(theta0_rad, settled, a), (other_rad, _, b)] = [1.0, 0.9].map(marched_from);
    assert!(!settled, "relaxation settles");
    assert!(a.balanced && b.balanced, "{:?} {:?}", a.residuals, b.residuals);
    let (inflows, collectives) =
        ([&a.mean_inflow, &b.mean_inflow], [&a.asked_for[0], &b.asked_for[0]]);
    // 18 comparisons of 95 % each, none of which is a free draw: the loads of a revolution move together
    let of_a = a.at_blade_number.iter().chain(&a.amplitudes);
    for (a, b) in of_a.zip(b.at_blade_number.iter().chain(&b.amplitudes)) {
        assert!((a.mean - b.mean).abs() < interval(a, b), "{a:?} {b:?}");
    }
    // the vertical force, which the wake shakes most, is known to a third
    let [a_z, b_z] = [&a.amplitudes[2], &b.amplitudes[2]];
    assert!(interval(a_z, b_z) < 0.35 * a_z.mean, "{a_z:?} {b_z:?}");
    for [a, b] in [inflows, collectives] {
        let (off, most) = ((a.mean - b.mean).abs(), interval(a, b));
        assert!(off < most && most < 0.05 * a.mean, "{a:?} {b:?}");
    }
    // they began farther apart than their intervals can hold
    let [a, b] = collectives;
    let began_off = (theta0_rad - other_rad).abs();
    assert!(began_off > 2.0 * interval(a, b), "{began_off} {a:?} {b:?}");
}

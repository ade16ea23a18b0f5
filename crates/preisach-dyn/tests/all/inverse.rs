//! Inverse, then forward: the flap must move as wanted.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use crate::common;

use common::Wavy;
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Backlash, Calibration, CoulombFriction,
    DynamicParameters, DynamicPreisach, InverseSettings, LinkageStage, LoadStiffness,
    PeriodicInverse, PeriodicSettings, PlayMap, PlayMemory, PreisachError, RateForm, Resonance,
    Saturation, StartState, StaticPreisach, TimeOrder, VoltageRange,
};
use proptest::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};

const REV_HZ: f64 = 5.0;

fn static_model(levels: usize) -> StaticPreisach {
    Wavy::GENTLE.law(levels)
}

fn actuator(law: ActuatorLaw) -> ActuatorModel {
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
    ActuatorModel::new(law, VoltageRange::amplified_stack(), calibration)
}

fn dynamic() -> ActuatorModel {
    let statics = static_model(24);
    let grid = *statics.grid();
    let mut g1_s = PlayMap::constant(&grid, -0.012);
    for row in &mut g1_s.nodes {
        for (k, value) in row.iter_mut().enumerate() {
            *value = -1e-5 * k as f64;
        }
    }
    let model = DynamicPreisach::new(DynamicParameters {
        grid,
        g0_deg: statics.map().clone(),
        g1_s,
        g2_s2_per_deg: PlayMap::constant(&grid, 2e-6),
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 500.0,
        time_order: TimeOrder::Second,
    });
    actuator(ActuatorLaw::DynamicPreisach(model.unwrap()))
}

/// 2, 3 and 4/rev, half peak to peak of about `size` degrees.
fn target(size: f64) -> HarmonicSeries {
    let mut wanted = HarmonicSeries::zero(4);
    for (n, amplitude, phase) in [(2, 0.5, 0.3), (3, 0.35, 1.9), (4, 0.25, -2.2)] {
        wanted.set_harmonic(n, Harmonic::from_amplitude_phase(size * amplitude, phase));
    }
    wanted
}

#[test]
fn inverse_then_forward_meets_a_mix_within_half_a_percent() {
    for (name, model, size) in [
        ("static", actuator(ActuatorLaw::StaticPreisach(static_model(24))), 5.0),
        ("dynamic", dynamic(), 2.5),
    ] {
        let settings = InverseSettings::default();
        let wanted = target(size);
        let found = model.periodic_inverse(&wanted, REV_HZ, &settings).unwrap();
        // forward again, on its own
        let volts = &found.response.voltage_volt;
        let again = model.periodic_response(volts, REV_HZ, &settings.periodic).unwrap();
        let steps = again.samples_deg.len() as f64;
        let worst = again.samples_deg.iter().enumerate().fold(0.0_f64, |m, (i, y)| {
            m.max((y - wanted.value(std::f64::consts::TAU * i as f64 / steps)).abs())
        });
        let percent = 100.0 * worst / found.amplitude_deg;
        println!("{name}: largest error {percent:.3} % of amplitude, {} steps", found.iterations);
        assert!(percent <= 0.5, "{name}: {percent}");
        assert!((worst - found.largest_error_deg).abs() < 1e-12);
        // the linear gain alone would not do
        let gain = 20.0 / 170.0;
        let mut naive = wanted.clone();
        for h in &mut naive.harmonics {
            (h.cosine, h.sine) = (h.cosine / gain, h.sine / gain);
        }
        naive.mean = 65.0;
        let off = model.periodic_response(&naive, REV_HZ, &settings.periodic).unwrap();
        let off = off.samples_deg.iter().enumerate().fold(0.0_f64, |m, (i, y)| {
            m.max((y - wanted.value(std::f64::consts::TAU * i as f64 / steps)).abs())
        });
        assert!(off > 0.05 * found.amplitude_deg, "{name}: {off}");
    }
}

/// A law that is no Preisach operator.
#[test]
fn a_smooth_law_of_another_kind_is_inverted_too() {
    let model = actuator(ActuatorLaw::BoucWen(common::bouc_wen(2.0, 0.8)));
    let settings = InverseSettings::default();
    let found = model.periodic_inverse(&target(2.0), REV_HZ, &settings).unwrap();
    let percent = 100.0 * found.largest_error_deg / found.amplitude_deg;
    println!("Bouc-Wen: largest error {percent:.4} % of amplitude");
    assert!(percent <= 0.5, "{percent}");
}

#[test]
fn a_motion_out_of_reach_says_what_is_in_reach() {
    let model = dynamic();
    let settings = InverseSettings { voltage_harmonics: 12, ..InverseSettings::default() };
    let error = model.periodic_inverse(&target(9.0), REV_HZ, &settings).unwrap_err();
    let PreisachError::MotionOutOfReach { wanted_deg, reachable_deg, harmonic, .. } = error else {
        panic!("{error}");
    };
    println!("{error}");
    assert!(reachable_deg > 0.3 * wanted_deg && reachable_deg < wanted_deg);
    assert!((2..=4).contains(&harmonic));
    // what it calls reachable is
    let share = 0.999 * reachable_deg / wanted_deg;
    assert!(model.periodic_inverse(&target(9.0 * share), REV_HZ, &settings).is_ok());
    let beyond = 1.05 * reachable_deg / wanted_deg;
    assert!(model.periodic_inverse(&target(9.0 * beyond), REV_HZ, &settings).is_err());
}

#[test]
fn a_linear_actuator_is_inverted_in_one_step() {
    let model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
    let found = model.periodic_inverse(&target(4.0), REV_HZ, &InverseSettings::default()).unwrap();
    assert!(found.largest_error_deg < 1e-9 && found.iterations == 1, "{found:?}");
}

#[test]
fn senseless_targets_are_refused() {
    let model = dynamic();
    let settings = InverseSettings::default();
    assert!(model.periodic_inverse(&target(f64::NAN), REV_HZ, &settings).is_err());
    assert!(model.periodic_inverse(&target(1.0), 0.0, &settings).is_err());
    let few = InverseSettings { voltage_harmonics: 2, ..settings };
    assert!(model.periodic_inverse(&target(1.0), REV_HZ, &few).is_err());
    let model = static_model(8);
    let mut memory = PlayMemory::new(model.grid(), 65.0, StartState::Rest);
    assert!(model.inverse(&mut memory, f64::NAN).is_err());
    let error = model.inverse(&mut memory, 1e3).unwrap_err();
    assert!(matches!(error, PreisachError::OutOfRange { .. }), "{error}");
    let mut other = PlayMemory::new(static_model(9).grid(), 65.0, StartState::Rest);
    assert!(matches!(model.inverse(&mut other, 0.0), Err(PreisachError::MemoryMismatch { .. })));
}

proptest! {
    #[test]
    fn the_static_inverse_is_exact(
        history in prop::collection::vec(-20.0..150.0_f64, 1..12),
        share in 0.0..=1.0_f64,
    ) {
        let model = static_model(13);
        let mut memory = PlayMemory::new(model.grid(), 65.0, StartState::Rest);
        for u in history {
            model.apply(&mut memory, u);
        }
        let (mut low, mut high) = (memory.clone(), memory.clone());
        let (low, high) = (model.apply(&mut low, -20.0), model.apply(&mut high, 150.0));
        let wanted = low + share * (high - low);
        let mut forward = memory.clone();
        let u = model.inverse(&mut memory, wanted).unwrap();
        let got = model.apply(&mut forward, u);
        prop_assert!((got - wanted).abs() < 1e-11, "{got} {wanted}");
    }

    #[test]
    fn the_static_inverse_gives_back_the_voltages(
        volts in prop::collection::vec(-20.0..150.0_f64, 1..30),
    ) {
        let model = static_model(11);
        let mut forward = PlayMemory::new(model.grid(), 65.0, StartState::Rest);
        let mut backward = forward.clone();
        for u in volts {
            let output = model.apply(&mut forward, u);
            let found = model.inverse(&mut backward, output).unwrap();
            prop_assert!((found - u).abs() < 1e-8, "{found} {u}");
        }
    }
}

/// The joints that stick.
fn sticking(width_um: f64) -> [(&'static str, LinkageStage); 2] {
    [
        ("backlash", LinkageStage::Backlash(Backlash { width_um })),
        ("Coulomb friction", LinkageStage::CoulombFriction(CoulombFriction { width_um })),
    ]
}

fn behind(model: &ActuatorModel, linkage: &[LinkageStage]) -> ActuatorModel {
    ActuatorModel { linkage: linkage.to_vec(), ..model.clone() }
}

/// Error of the mean and of 1 to 4/rev, deg.
fn low_error_deg(found: &PeriodicInverse, wanted: &HarmonicSeries) -> f64 {
    let flap = &found.response.flap_deg;
    (1..=4).fold((flap.mean - wanted.mean).abs(), |worst, n| {
        let (got, asked) = (flap.harmonic(n), wanted.harmonic(n));
        worst.max((got.cosine - asked.cosine).abs()).max((got.sine - asked.sine).abs())
    })
}

/// From rest no small voltage moves the flap behind such a joint: Newton's method alone has a singular
/// matrix there.
#[test]
fn joints_that_stick_are_undone() {
    let model = actuator(ActuatorLaw::StaticPreisach(static_model(24)));
    let wanted = target(5.0);
    let settings = InverseSettings { voltage_harmonics: 96, ..InverseSettings::default() };
    // 0.16 deg
    for (name, joint) in sticking(4.0) {
        let found = behind(&model, &[joint]).periodic_inverse(&wanted, REV_HZ, &settings).unwrap();
        let percent = 100.0 * found.largest_error_deg / found.amplitude_deg;
        println!("{name}: largest error {percent:.3} % of amplitude");
        assert!(percent <= 0.5, "{name}: {percent}");
        assert!(low_error_deg(&found, &wanted) <= settings.tolerance_deg, "{name}");
    }
}

/// At every reversal the flap rests for one period of the highest harmonic, in which the wanted motion
/// turns with the square of time. A gap narrower than the turn of that period leaves less.
#[test]
fn the_error_behind_a_gap_falls_with_the_square_of_the_harmonics() {
    let model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
    let model = behind(&model, &[LinkageStage::Backlash(Backlash { width_um: 25.0 })]);
    let periodic = PeriodicSettings { steps_per_rev: 2880, ..PeriodicSettings::default() };
    let mut wanted = HarmonicSeries::zero(3);
    wanted.set_harmonic(3, Harmonic::from_amplitude_phase(5.0, 1.9));
    let percent = [60, 120].map(|voltage_harmonics| {
        let settings =
            InverseSettings { voltage_harmonics, periodic, ..InverseSettings::default() };
        let found = model.periodic_inverse(&wanted, REV_HZ, &settings).unwrap();
        100.0 * found.largest_error_deg / found.amplitude_deg
    });
    let order = (percent[0] / percent[1]).log2();
    println!("largest error {percent:.3?} % of amplitude, order {order:.2}");
    assert!(order > 1.7, "{percent:?}");
}

#[test]
fn joints_and_modes_in_any_order_give_the_wanted_harmonics() {
    let width_um = 3.0;
    let gap = LinkageStage::Backlash(Backlash { width_um });
    let friction = LinkageStage::CoulombFriction(CoulombFriction { width_um });
    let mode = LinkageStage::Resonance(Resonance { frequency_hz: 180.0, damping_ratio: 0.02 });
    let load = LinkageStage::LoadStiffness(LoadStiffness {
        stiffness_ratio: 0.1,
        compliance_um_per_newton: 0.0,
    });
    let settings = InverseSettings { voltage_harmonics: 16, ..InverseSettings::default() };
    let wanted = target(2.0);
    for (name, linkage) in [
        ("a gap before a mode", vec![gap.clone(), mode.clone()]),
        ("friction under a load", vec![friction.clone(), load.clone()]),
        ("two joints", vec![load, gap, mode, friction]),
    ] {
        let model = behind(&dynamic(), &linkage);
        let found = model.periodic_inverse(&wanted, REV_HZ, &settings).unwrap();
        let error_deg = low_error_deg(&found, &wanted);
        println!("{name}: {error_deg:e} deg, {} steps", found.iterations);
        assert!(error_deg <= settings.tolerance_deg, "{name}: {error_deg}");
    }
}

#[test]
fn the_reach_behind_a_gap_is_the_flaps() {
    let settings = InverseSettings { voltage_harmonics: 12, ..InverseSettings::default() };
    let model = behind(&dynamic(), &[LinkageStage::Backlash(Backlash { width_um: 40.0 })]);
    let error = model.periodic_inverse(&target(9.0), REV_HZ, &settings).unwrap_err();
    let PreisachError::MotionOutOfReach { wanted_deg, reachable_deg, .. } = error else {
        panic!("{error}");
    };
    let free = dynamic().periodic_inverse(&target(9.0), REV_HZ, &settings).unwrap_err();
    let PreisachError::MotionOutOfReach { wanted_deg: same, reachable_deg: free_deg, .. } = free
    else {
        panic!("{free}");
    };
    println!("within reach: {reachable_deg} deg, without the gap {free_deg} deg");
    assert!((wanted_deg - same).abs() < 1e-12);
    // the gap takes half its width, 0.8 deg, from each side of the motion
    assert!((free_deg - reachable_deg - 0.8).abs() < 0.3, "{free_deg} {reachable_deg}");
    let share = |part: f64| target(9.0 * part * reachable_deg / wanted_deg);
    assert!(model.periodic_inverse(&share(0.999), REV_HZ, &settings).is_ok());
    assert!(model.periodic_inverse(&share(1.05), REV_HZ, &settings).is_err());
}

/// The linkage may turn the motion round; joints are as wide in either sense.
#[test]
fn joints_are_undone_under_a_gain_of_either_sign() {
    let settings = InverseSettings { voltage_harmonics: 48, ..InverseSettings::default() };
    for (name, joint) in sticking(4.0) {
        let errors = [0.04, -0.04].map(|deg_per_um| {
            let mut model = behind(&dynamic(), std::slice::from_ref(&joint));
            model.calibration.deg_per_um = deg_per_um;
            model.periodic_inverse(&target(2.5), REV_HZ, &settings).unwrap().largest_error_deg
        });
        assert!((errors[0] - errors[1]).abs() < 1e-9, "{name}: {errors:?}");
    }
}

/// Motions about as wide as the gap, with no more voltage harmonics than the motion has.
#[test]
fn small_motions_come_through_a_gap_with_few_harmonics() {
    let settings = InverseSettings { voltage_harmonics: 4, ..InverseSettings::default() };
    let model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
    for (name, joint) in sticking(4.0) {
        for size in [0.05, 0.1, 0.3] {
            let model = behind(&model, std::slice::from_ref(&joint));
            let found = model.periodic_inverse(&target(size), REV_HZ, &settings).unwrap();
            let error_deg = low_error_deg(&found, &target(size));
            assert!(error_deg <= settings.tolerance_deg, "{name} {size}: {error_deg}");
        }
    }
}

#[test]
fn an_amplifier_that_saturates_ends_the_reach() {
    let mut model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
    let limits = Saturation::sharp(0.0, 130.0);
    model.amplifier.push(AmplifierStage::Saturation(limits));
    let settings = InverseSettings { voltage_harmonics: 8, ..InverseSettings::default() };
    let error = model.periodic_inverse(&target(8.0), REV_HZ, &settings).unwrap_err();
    let PreisachError::MotionOutOfReach { range, reachable_deg, .. } = error else {
        panic!("{error}");
    };
    assert_eq!(range, VoltageRange::new(0.0, 130.0).unwrap());
    assert!(reachable_deg > 3.0, "{reachable_deg}");
}

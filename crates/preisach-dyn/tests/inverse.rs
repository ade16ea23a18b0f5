//! Inverse, then forward: the flap must move as wanted.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

mod common;

use common::Wavy;
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Calibration, DynamicParameters, DynamicPreisach, InverseSettings,
    PlayMap, PlayMemory, PreisachError, RateForm, StartState, StaticPreisach, TimeOrder,
    VoltageRange,
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
    assert!(matches!(error, PreisachError::OutputOutOfReach { .. }), "{error}");
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

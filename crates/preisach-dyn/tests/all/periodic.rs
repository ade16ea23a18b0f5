//! Closed orbits against exact responses; bias, stroke limit, refused commands.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use approx::assert_abs_diff_eq;
use preisach_dyn::{
    Accommodation, ActuatorLaw, ActuatorModel, AmplifierStage, Backlash, Calibration, CurrentLimit,
    Delay, DielectricHeating, Drive, DynamicParameters, DynamicPreisach, KelvinVoigt,
    KelvinVoigtElement, Lag, LinkageStage, LoadStiffness, LogCreep, MainsHum, PeriodicSettings,
    PlayMap, PreisachError, PreisachGrid, RateForm, Resonance, SensorStage, StartState,
    StaticPreisach, TimeOrder, VoltageRange,
};
use rotor_base::{Harmonic, HarmonicSeries};
use std::f64::consts::TAU;

const REV_HZ: f64 = 5.0;

fn command(mean: f64, harmonics: &[(usize, f64, f64)]) -> HarmonicSeries {
    let mut series = HarmonicSeries::zero(1);
    series.mean = mean;
    for &(n, cosine, sine) in harmonics {
        series.set_harmonic(n, Harmonic { cosine, sine });
    }
    series
}

fn grid() -> PreisachGrid {
    PreisachGrid::new(VoltageRange::amplified_stack(), 20).unwrap()
}

fn hysteretic_map(grid: &PreisachGrid) -> PlayMap {
    let rises: Vec<Vec<f64>> = (0..20_u32)
        .map(|j| {
            (0..20 - j)
                .map(|k| {
                    let reversible = if j == 0 { 0.45 } else { 0.0 };
                    reversible + 0.12 * (-0.15 * f64::from(j)).exp() * (1.0 + 0.02 * f64::from(k))
                })
                .collect()
        })
        .collect();
    PlayMap::from_rises(grid, 0.4, &rises).unwrap()
}

fn wrap(law: ActuatorLaw) -> ActuatorModel {
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 3.0 };
    ActuatorModel::new(law, VoltageRange::amplified_stack(), calibration)
}

fn dynamic(g0_deg: PlayMap, lag_s: f64) -> ActuatorModel {
    let grid = grid();
    wrap(ActuatorLaw::DynamicPreisach(
        DynamicPreisach::new(DynamicParameters {
            grid,
            g0_deg,
            g1_s: PlayMap::constant(&grid, -lag_s),
            g2_s2_per_deg: PlayMap::constant(&grid, 0.0),
            form: RateForm::WellPosed,
            unfolded_rate_deg_s: 1e3,
            time_order: TimeOrder::Second,
        })
        .unwrap(),
    ))
}

fn static_model() -> ActuatorModel {
    let grid = grid();
    wrap(ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, hysteretic_map(&grid)).unwrap()))
}

#[test]
fn the_linear_actuator_returns_the_command_scaled() {
    let model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
    let volts = command(65.0, &[(2, 30.0, -10.0), (3, 5.0, 20.0), (4, 0.0, 12.0)]);
    let response = model.periodic_response(&volts, REV_HZ, &PeriodicSettings::default()).unwrap();
    let gain = 10.0 / 85.0;
    assert_abs_diff_eq!(response.flap_deg.mean, 0.0, epsilon = 1e-12);
    for n in 1..=24 {
        let (flap, volt) = (response.flap_deg.harmonic(n), volts.harmonic(n));
        assert_abs_diff_eq!(flap.cosine, gain * volt.cosine, epsilon = 1e-12);
        assert_abs_diff_eq!(flap.sine, gain * volt.sine, epsilon = 1e-12);
    }
    assert_eq!(response.revolutions_used, 2);
}

#[test]
fn a_lag_gives_each_harmonic_its_exact_amplitude_and_phase() {
    let mut g0_deg = PlayMap::constant(&grid(), 0.0);
    g0_deg.nodes[0] = (0..21).map(|k| -10.0 + f64::from(k)).collect();
    let lag_s = 0.024;
    let model = dynamic(g0_deg, lag_s);
    let volts = command(65.0, &[(2, 30.0, 0.0), (3, 0.0, 30.0), (4, -10.0, 15.0)]);
    let worst = |steps_per_rev: usize| -> f64 {
        let settings = PeriodicSettings { steps_per_rev, ..PeriodicSettings::default() };
        let response = model.periodic_response(&volts, REV_HZ, &settings).unwrap();
        [2, 3, 4]
            .map(|n| {
                let volt = volts.harmonic(n);
                let p = TAU * REV_HZ * n as f64 * lag_s;
                let exact = Harmonic::from_amplitude_phase(
                    10.0 / 85.0 * volt.amplitude() / p.hypot(1.0),
                    volt.phase_rad() + p.atan(),
                );
                let got = response.flap_deg.harmonic(n);
                (got.cosine - exact.cosine).hypot(got.sine - exact.sine)
            })
            .into_iter()
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (worst(720), worst(2880));
    assert!(coarse < 2e-3, "{coarse:e}");
    let rate = (coarse / fine).log2() / 2.0;
    assert!((rate - 2.0).abs() < 0.1, "order {rate}");
}

#[test]
fn a_static_orbit_closes_at_once_and_does_not_know_the_speed() {
    let model = static_model();
    let volts = command(60.0, &[(2, 40.0, 0.0), (3, 0.0, 20.0)]);
    let settings = PeriodicSettings::default();
    let slow = model.periodic_response(&volts, 0.1, &settings).unwrap();
    let fast = model.periodic_response(&volts, 30.0, &settings).unwrap();
    assert_eq!(slow.samples_deg, fast.samples_deg);
    assert!(slow.revolutions_used <= 3 && slow.closure_deg == 0.0);
    // hysteresis lags: the flap's harmonic comes later than the voltage's
    let lag = slow.flap_deg.harmonic(2).phase_deg() - volts.harmonic(2).phase_deg();
    assert!((2.0..15.0).contains(&lag), "{lag}");
}

#[test]
fn an_orbit_that_cannot_close_in_time_is_an_error() {
    let model = dynamic(hysteretic_map(&grid()), 1.0);
    let volts = command(65.0, &[(2, 0.0, 50.0)]);
    let settings = PeriodicSettings { largest_revolutions: 5, ..PeriodicSettings::default() };
    let error = model.periodic_response(&volts, REV_HZ, &settings).unwrap_err();
    assert!(
        matches!(error, PreisachError::OrbitNotClosed { revolutions: 5, closure_deg, .. } if closure_deg > 1e-3),
        "{error}"
    );
}

#[test]
fn a_command_outside_the_range_is_an_error_with_its_azimuth() {
    let settings = PeriodicSettings::default();
    let model = static_model();
    let high = command(120.0, &[(1, 0.0, 40.0)]);
    let error = model.periodic_response(&high, REV_HZ, &settings).unwrap_err();
    assert!(
        matches!(error, PreisachError::CommandOutOfRange { azimuth_deg, voltage_volt, .. }
            if (azimuth_deg - 90.0).abs() < 1e-9 && (voltage_volt - 160.0).abs() < 1e-9),
        "{error}"
    );
    let not_a_number = command(65.0, &[(1, f64::NAN, 0.0)]);
    assert!(model.periodic_response(&not_a_number, REV_HZ, &settings).is_err());
}

/// First-harmonic stroke at full scale about the middle of the range.
fn stroke_deg(model: &ActuatorModel, harmonic: usize, settings: &PeriodicSettings) -> f64 {
    let volts = command(65.0, &[(harmonic, 85.0, 0.0)]);
    let orbit = model.periodic_response(&volts, REV_HZ, settings).unwrap();
    orbit.flap_deg.harmonic(harmonic).amplitude()
}

#[test]
fn the_stroke_falls_with_frequency_as_the_lag_says() {
    let settings = PeriodicSettings { steps_per_rev: 1440, ..PeriodicSettings::default() };
    let (model, rigid) = (dynamic(hysteretic_map(&grid()), 0.02), static_model());
    let full = stroke_deg(&rigid, 2, &settings);
    for n in [2, 3, 4] {
        let stroke = stroke_deg(&model, n, &settings);
        let p = TAU * REV_HZ * n as f64 * 0.02;
        // the lag acts on every harmonic of the static orbit alone: the first is exact
        assert_abs_diff_eq!(stroke, full / p.hypot(1.0), epsilon = 2e-3 * full);
    }
}

#[test]
fn shifting_the_angle_leaves_the_displacement() {
    for model in
        [static_model(), ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04)]
    {
        let moved = model.clone().shifted(-1.5);
        let volts = [65.0, 100.0, 30.0];
        let a = model.simulate(&volts, 1e-3).unwrap().output_deg;
        let b = moved.simulate(&volts, 1e-3).unwrap().output_deg;
        for (a, b) in a.iter().zip(&b) {
            assert_abs_diff_eq!(b - a, -1.5, epsilon = 1e-12);
            assert_abs_diff_eq!(
                model.calibration.displacement_um(*a),
                moved.calibration.displacement_um(*b),
                epsilon = 1e-9
            );
        }
    }
}

/// The orbit by plain marching over so many revolutions that everything has settled.
fn marched(
    model: &ActuatorModel,
    volts: &HarmonicSeries,
    rev_hz: f64,
    revolutions: u32,
) -> Vec<f64> {
    let steps = 720;
    let commands: Vec<f64> =
        rotor_base::uniform_azimuths_rad(steps).iter().map(|&psi| volts.value(psi)).collect();
    let mut memory = model.start(volts.mean, StartState::Rest).unwrap();
    let step_s = 1.0 / (rev_hz * steps as f64);
    let mut orbit = Vec::new();
    for _ in 0..revolutions {
        orbit = model.continue_drive(&mut memory, &Drive::new(&commands, step_s)).unwrap();
    }
    orbit
}

#[test]
fn orbits_close_with_stages_and_are_those_of_patient_marching() {
    let element = |time_constant_s| KelvinVoigtElement { compliance_ratio: 0.04, time_constant_s };
    let model = ActuatorModel {
        amplifier: vec![
            AmplifierStage::Lag(Lag { tau_s: 1e-3 }),
            AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: 3000.0 }),
            AmplifierStage::Delay(Delay { delay_s: 7e-4 }),
            AmplifierStage::DielectricHeating(DielectricHeating {
                rise_k_per_volt2_hz: 6e-4,
                ..DielectricHeating::new(1.5, 1e-3)
            }),
        ],
        linkage: vec![
            LinkageStage::KelvinVoigt(KelvinVoigt { elements: vec![element(0.3), element(2.0)] }),
            LinkageStage::Resonance(Resonance { frequency_hz: 90.0, damping_ratio: 0.02 }),
            LinkageStage::Backlash(Backlash { width_um: 1.0 }),
        ],
        sensor: vec![SensorStage::MainsHum(MainsHum {
            amplitude_um: 5.0,
            frequency_hz: 50.3,
            phase_rad: 0.0,
        })],
        ..static_model()
    };
    let volts = command(62.0, &[(2, 30.0, 0.0), (3, 0.0, 25.0)]);
    let settings = PeriodicSettings::default();
    let orbit = model.periodic_response(&volts, REV_HZ, &settings).unwrap();
    println!("{} revolutions", orbit.revolutions_used);
    assert!(orbit.revolutions_used <= 40 && orbit.closure_deg <= 1e-9);
    // 2 s is ten revolutions: 400 are twenty of the slowest time constant
    let patient = marched(&model, &volts, REV_HZ, 400);
    let off =
        orbit.samples_deg.iter().zip(&patient).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    // the two ways differ by what e^-20 leaves
    assert!(off < 1e-6, "{off:e}");
    // without the leap the slow states are still under way after as many revolutions
    let hasty = marched(&model, &volts, REV_HZ, 20);
    let off = hasty.iter().zip(&patient).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
    assert!(off > 1e-3, "{off:e}");
}

#[test]
fn creep_over_minutes_does_not_keep_an_orbit_from_closing() {
    let creep = LinkageStage::LogCreep(LogCreep::new(0.02));
    let model = ActuatorModel { linkage: vec![creep], ..static_model() };
    let volts = command(60.0, &[(3, 40.0, 0.0)]);
    let orbit = model.periodic_response(&volts, REV_HZ, &PeriodicSettings::default()).unwrap();
    assert!(orbit.revolutions_used <= 5, "{}", orbit.revolutions_used);
    // fast motion does not creep, the mean has crept by all there is: 4 decades of 2 %
    let still =
        static_model().periodic_response(&volts, REV_HZ, &PeriodicSettings::default()).unwrap();
    let (with, without) = (orbit.flap_deg.harmonic(3), still.flap_deg.harmonic(3));
    assert!((with.amplitude() / without.amplitude() - 1.0).abs() < 2e-3);
    let start = static_model().start(60.0, StartState::Rest).unwrap().output_deg();
    let crept = orbit.flap_deg.mean - still.flap_deg.mean;
    assert_abs_diff_eq!(crept, 0.08 * (still.flap_deg.mean - start), epsilon = 1e-9);
}

#[test]
fn a_resonance_gives_each_harmonic_its_exact_amplitude_and_phase() {
    let resonance = Resonance { frequency_hz: 60.0, damping_ratio: 0.05 };
    let model = ActuatorModel {
        linkage: vec![LinkageStage::Resonance(resonance)],
        ..ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04)
    };
    let volts = command(65.0, &[(2, 30.0, 0.0), (3, 0.0, 30.0), (4, -10.0, 15.0)]);
    let worst = |steps_per_rev: usize| -> f64 {
        let settings = PeriodicSettings { steps_per_rev, ..PeriodicSettings::default() };
        let orbit = model.periodic_response(&volts, REV_HZ, &settings).unwrap();
        [2, 3, 4]
            .map(|n| {
                let r = REV_HZ * n as f64 / 60.0;
                let (re, im) = (1.0 - r * r, 2.0 * 0.05 * r);
                let volt = volts.harmonic(n);
                let exact = Harmonic::from_amplitude_phase(
                    10.0 / 85.0 * volt.amplitude() / re.hypot(im),
                    volt.phase_rad() + im.atan2(re),
                );
                let got = orbit.flap_deg.harmonic(n);
                (got.cosine - exact.cosine).hypot(got.sine - exact.sine)
            })
            .into_iter()
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (worst(180), worst(720));
    let order = (coarse / fine).log2() / 2.0;
    assert!(fine < 2e-3 && (order - 2.0).abs() < 0.1, "{coarse:e} {fine:e} order {order}");
}

#[test]
fn a_hinge_moment_bends_the_orbit() {
    let stage = LoadStiffness { stiffness_ratio: 0.1, compliance_um_per_newton: 0.9 };
    let model =
        ActuatorModel { linkage: vec![LinkageStage::LoadStiffness(stage)], ..static_model() };
    let volts = command(60.0, &[(2, 40.0, 0.0)]);
    let settings = PeriodicSettings::default();
    let free = static_model().periodic_response(&volts, REV_HZ, &settings).unwrap();
    // 0.02 N m mean and 0.01 N m at 1/rev
    let newton = |moment: f64| model.calibration.load_newton(moment);
    let load = command(newton(0.02), &[(1, newton(0.01), 0.0)]);
    let bent = model.periodic_response_loaded(&volts, &load, REV_HZ, &settings).unwrap();
    let give_deg = |moment: f64| 0.04 * 0.9 * newton(moment);
    assert_abs_diff_eq!(
        bent.flap_deg.mean,
        (free.flap_deg.mean - give_deg(0.02)) / 1.1,
        epsilon = 1e-9
    );
    assert_abs_diff_eq!(
        bent.flap_deg.harmonic(1).cosine,
        (free.flap_deg.harmonic(1).cosine - give_deg(0.01)) / 1.1,
        epsilon = 1e-9
    );
    assert_abs_diff_eq!(
        bent.flap_deg.harmonic(2).amplitude(),
        free.flap_deg.harmonic(2).amplitude() / 1.1,
        epsilon = 1e-9
    );
    let error = static_model().periodic_response_loaded(&volts, &load, REV_HZ, &settings);
    assert!(matches!(error, Err(PreisachError::NoLoadStage)));
}

/// A share that settles with a way of many revolutions is taken to where it ends, before and behind a
/// stage that changes the way.
#[test]
fn a_slow_accommodation_closes_where_a_long_march_ends() {
    let accommodation =
        LinkageStage::Accommodation(Accommodation { share: 0.08, travel_um: 60_000.0 });
    let load = LinkageStage::LoadStiffness(LoadStiffness {
        stiffness_ratio: 0.2,
        compliance_um_per_newton: 0.0,
    });
    let volts = command(65.0, &[(2, 30.0, -10.0), (3, 5.0, 20.0)]);
    let settings = PeriodicSettings::default();
    for linkage in [
        vec![accommodation.clone()],
        vec![load.clone(), accommodation.clone()],
        vec![accommodation, load],
    ] {
        let model = ActuatorModel { linkage, ..static_model() };
        let orbit = model.periodic_response(&volts, REV_HZ, &settings).unwrap();
        assert!(orbit.revolutions_used < 12, "{}", orbit.revolutions_used);
        // marched without any haste
        let steps = settings.steps_per_rev;
        let azimuth = |i: usize| TAU * i as f64 / steps as f64;
        let revolution: Vec<f64> = (0..steps).map(|i| volts.value(azimuth(i))).collect();
        let mut memory = model.start(volts.mean, StartState::Rest).unwrap();
        let stepper = model.stepper(1.0 / (REV_HZ * steps as f64)).unwrap();
        let mut last = Vec::new();
        let mut way = 0.0;
        for _ in 0..2500 {
            last = revolution.iter().map(|&u| stepper.step(&mut memory, u, 0.0).unwrap()).collect();
        }
        for (a, b) in orbit.samples_deg.iter().zip(&last) {
            way = f64::max(way, (a - b).abs());
        }
        assert!(way < 1e-7, "{way}");
        // and it is slow indeed
        let mut memory = model.start(volts.mean, StartState::Rest).unwrap();
        for _ in 0..3 {
            last = revolution.iter().map(|&u| stepper.step(&mut memory, u, 0.0).unwrap()).collect();
        }
        let early =
            orbit.samples_deg.iter().zip(&last).fold(0.0_f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(early > 1e-3, "{early}");
    }
}

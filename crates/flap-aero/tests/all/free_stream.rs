//! Dimensional loads in a stream of constant, varying and reversed velocity.
#![expect(clippy::unwrap_used, reason = "a helper whose section is missing cannot go on")]

use approx::{assert_abs_diff_eq, assert_relative_eq};
use flap_aero::{
    AeroError, AttachedFlowModel, FlapChord, FreeStream, Mach, MarchingSection, SectionInputs,
    SectionLoads, SectionState, TheodorsenFunctions, lag_rates, section_loads,
};
use proptest::prelude::*;
use std::f64::consts::PI;

fn flap() -> FlapChord {
    FlapChord::new(0.2).unwrap()
}

proptest! {
    /// The quasi-steady section of a rotor blade written out term by term, forward and reverse:
    /// `q = U theta - U_P + b omega + (T10/pi) U delta + (T11 b/2 pi) delta_dot`,
    /// `L = 2 pi rho b |U| q`, `M = -pi rho b^3 |U| omega - rho b^2 (T15 |U| U delta + T16 b |U| delta_dot)`.
    #[test]
    fn quasi_steady_blade_section_term_by_term(
        speed in -1.2..1.3_f64,
        normal in -0.1..0.1_f64,
        omega in -0.2..0.2_f64,
        delta in -0.1..0.1_f64,
        delta_dot in -0.5..0.5_f64,
    ) {
        let (density, b) = (1.7, 0.0275);
        let section = AttachedFlowModel::QuasiSteady.coefficients(Mach::ZERO, flap()).unwrap();
        let stream = FreeStream { density, semichord: b, speed };
        let velocities = [normal, 2.0 * b * omega, speed * delta, 2.0 * b * delta_dot];
        let got = section_loads(&section, &stream, &velocities, &[9.0; 4], &[]).unwrap();
        // E = 0.2, quarter-chord axis
        let [t10, t11, t15, t16] = [1.727_295_218_002, 0.934_540_956_4, 1.28, 0.788_628_551_334_9];
        let q = normal + b * omega + t10 / PI * speed * delta + t11 * b / (2.0 * PI) * delta_dot;
        let lift = 2.0 * PI * density * b * speed.abs() * q;
        let moment = -PI * density * b.powi(3) * speed.abs() * omega
            - density * b * b * speed.abs() * (t15 * speed * delta + t16 * b * delta_dot);
        prop_assert!((got.lift - lift).abs() < 1e-12);
        prop_assert!((got.moment - moment).abs() < 1e-13);
    }
}

#[test]
fn a_constant_stream_gives_the_coefficients() {
    let section =
        AttachedFlowModel::HariharanLeishman.coefficients(Mach::new(0.5).unwrap(), flap()).unwrap();
    let stream = FreeStream { density: 1.2, semichord: 0.25, speed: 170.0 };
    let inputs = SectionInputs { modes: [0.05, 0.01, -0.03, 0.02], rates: [0.0; 4] };
    let march = MarchingSection::new(&section);
    let mut state = SectionState::at_rest(&march);
    let coefficients = state.step(&march, &inputs, 1.3).unwrap();

    let velocity = |m: [f64; 4]| m.map(|m| m * stream.speed);
    let lags: Vec<f64> = state.states().iter().map(|x| x * stream.speed).collect();
    let got = section_loads(&section, &stream, &velocity(inputs.modes), &[0.0; 4], &lags).unwrap();
    let pressure = 0.5 * stream.density * stream.speed.powi(2);
    let chord = 2.0 * stream.semichord;
    let [cn, cm, ch] = coefficients;
    assert_relative_eq!(got.lift, pressure * chord * cn, max_relative = 1e-13);
    assert_relative_eq!(got.moment, pressure * chord * chord * cm, max_relative = 1e-13);
    assert_relative_eq!(got.hinge, pressure * chord * chord * ch, max_relative = 1e-13);
}

#[test]
fn apparent_mass_of_a_plunging_plate_is_a_cylinder_of_air() {
    // L = pi rho b^2 dw/dt, its resultant at mid-chord, whatever the speed: also with none at all
    let section = AttachedFlowModel::Incompressible.coefficients(Mach::ZERO, flap()).unwrap();
    for speed in [0.0, -30.0, 50.0] {
        let (density, b) = (1.2, 0.25);
        let stream = FreeStream { density, semichord: b, speed };
        let still = [0.0; 4];
        let lags = [0.0; 2];
        let got = section_loads(&section, &stream, &still, &[3.0, 0.0, 0.0, 0.0], &lags).unwrap();
        let lift = PI * density * b * b * 3.0;
        assert_relative_eq!(got.lift, lift, max_relative = 1e-14);
        assert_relative_eq!(got.moment, -0.5 * b * lift, max_relative = 1e-14);
    }
}

#[test]
fn flap_in_a_stream_that_speeds_up() {
    // potential of a held flap grows with U: lift -T4 rho b^2 d(U delta)/dt beside the circulation
    let t = TheodorsenFunctions::new(flap().hinge());
    let section = AttachedFlowModel::Incompressible.coefficients(Mach::ZERO, flap()).unwrap();
    let (density, b, speed, acceleration, delta) = (1.2, 0.25, 40.0, 15.0, 0.1);
    let stream = FreeStream { density, semichord: b, speed };
    let w = [0.0, 0.0, speed * delta, 0.0];
    let at = |rate: f64| {
        section_loads(&section, &stream, &w, &[0.0, 0.0, rate, 0.0], &[0.0; 2]).unwrap().lift
    };
    let extra = at(acceleration * delta) - at(0.0);
    assert_relative_eq!(
        extra,
        -t.t::<4>() * density * b * b * acceleration * delta,
        max_relative = 1e-11
    );
}

#[test]
fn lags_follow_the_distance_travelled_not_the_time() {
    // an impulsive start at a speed that varies, and reverses for a while: against the distance
    // travelled it is the same indicial response
    let section = AttachedFlowModel::Incompressible.coefficients(Mach::ZERO, flap()).unwrap();
    let b = 0.25;
    let (mut lags, mut rates, mut travelled) = (vec![0.0; 2], vec![0.0; 2], 0.0);
    let w = [1.0, 0.0, 0.0, 0.0];
    let steps = 20_000;
    let dt = 0.2 / f64::from(steps);
    for n in 0..steps {
        // mid-point rule
        let time = f64::from(n) * dt;
        let speed = |t: f64| 20.0 + 15.0 * (30.0 * t).sin() - 60.0 * t;
        let stream = |t: f64| FreeStream { density: 1.0, semichord: b, speed: speed(t) };
        lag_rates(&section, &stream(time), &w, &lags, &mut rates).unwrap();
        let half: Vec<f64> = lags.iter().zip(&rates).map(|(x, r)| x + 0.5 * dt * r).collect();
        lag_rates(&section, &stream(time + 0.5 * dt), &w, &half, &mut rates).unwrap();
        for (x, r) in lags.iter_mut().zip(&rates) {
            *x += dt * r;
        }
        travelled += dt * speed(time + 0.5 * dt).abs() / b;
    }
    for (x, lag) in lags.iter().zip(&section.lags) {
        assert_abs_diff_eq!(*x, -(-lag.pole * travelled).exp_m1(), epsilon = 1e-7);
    }
}

#[test]
fn the_wrong_number_of_lags_is_refused() {
    let section = AttachedFlowModel::Incompressible.coefficients(Mach::ZERO, flap()).unwrap();
    let stream = FreeStream { density: 1.0, semichord: 0.1, speed: 10.0 };
    let zero = [0.0; 4];
    let mismatch = AeroError::StateMismatch { state: 1, coefficients: 2 };
    assert_eq!(section_loads(&section, &stream, &zero, &zero, &[0.0]), Err(mismatch.clone()));
    let mut rates = [7.0];
    assert_eq!(lag_rates(&section, &stream, &zero, &[0.0; 2], &mut rates), Err(mismatch));
    assert_eq!(
        section_loads(&section, &stream, &zero, &zero, &[0.0; 2]),
        Ok(SectionLoads::default())
    );
}

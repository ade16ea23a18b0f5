//! Time marching: exact on ramps, second order elsewhere, and honest about bad input.
#![expect(clippy::unwrap_used, reason = "a helper whose table or section is missing cannot go on")]

use crate::tables;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use flap_aero::{
    AeroError, AttachedFlowModel, FlapChord, LagChannel, Mach, MarchingSection, Mode, Motion,
    SectionCoefficients, SectionInputs, SectionState, StepFactors, harmonic_response,
    indicial_response,
};
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::TAU;
use tables::Table;

fn compressible(m: f64) -> SectionCoefficients {
    AttachedFlowModel::HariharanLeishman
        .coefficients(Mach::new(m).unwrap(), FlapChord::new(0.2).unwrap())
        .unwrap()
}

fn calibrated(m: f64) -> SectionCoefficients {
    AttachedFlowModel::Calibrated
        .coefficients(Mach::new(m).unwrap(), FlapChord::new(0.2).unwrap())
        .unwrap()
}

fn incompressible() -> SectionCoefficients {
    AttachedFlowModel::Incompressible
        .coefficients(Mach::ZERO, FlapChord::new(0.2).unwrap())
        .unwrap()
}

fn held(modes: [f64; 4]) -> SectionInputs {
    SectionInputs { modes, rates: [0.0; 4] }
}

#[test]
fn exact_on_a_ramp_whatever_the_step() {
    let slope = [0.3, -0.2, 1.0, 0.7];
    for section in
        [incompressible(), compressible(0.5), compressible(0.05), calibrated(0.5), calibrated(0.05)]
    {
        for (steps, distance) in [(1, 10.0), (7, 10.0), (100, 10.0), (1000, 1.0)] {
            let march = MarchingSection::new(&section);
            let mut state = SectionState::at_rest(&march);
            for n in 1..=steps {
                let s = distance * f64::from(n) / f64::from(steps);
                let inputs = SectionInputs { modes: slope.map(|r| r * s), rates: slope };
                state.step(&march, &inputs, distance / f64::from(steps)).unwrap();
            }
            for (x, lag) in state.states().iter().zip(&section.lags) {
                let rate: f64 = lag.input.iter().zip(slope).map(|(w, r)| w * r).sum();
                let exact = rate * (distance + (-lag.pole * distance).exp_m1() / lag.pole);
                assert_abs_diff_eq!(*x, exact, epsilon = 1e-12);
            }
        }
    }
}

#[test]
fn a_jump_gives_the_indicial_response() {
    for section in [incompressible(), compressible(0.5), calibrated(0.5)] {
        let march = MarchingSection::new(&section);
        for mode in Mode::ALL {
            let mut modes = [0.0; 4];
            modes[mode.index()] = 1.0;
            let mut state = SectionState::at_rest(&march);
            state.jump(&march, &modes).unwrap();
            let mut s = 0.0;
            for step in [0.0, 0.01, 0.3, 2.0, 25.0] {
                s += step;
                let loads = state.step(&march, &held(modes), step).unwrap();
                for (g, e) in loads.into_iter().zip(indicial_response(&section, mode, s)) {
                    assert_abs_diff_eq!(g, e, epsilon = 1e-12);
                }
                let again = state.loads(&march, &held(modes)).unwrap();
                assert_eq!(again.map(f64::to_bits), loads.map(f64::to_bits));
            }
        }
    }
}

#[test]
fn a_settled_section_stays() {
    let section = MarchingSection::new(&compressible(0.5));
    let modes = [0.1, 0.02, -0.05, 0.3];
    let mut state = SectionState::settled(&section, &modes);
    let before = state.loads(&section, &held(modes)).unwrap();
    let after = state.step(&section, &held(modes), 3.0).unwrap();
    for (a, b) in after.into_iter().zip(before) {
        assert_relative_eq!(a, b, max_relative = 1e-14);
    }
}

/// Largest error of the lift over two cycles of a marched flap motion, after it has settled.
fn marching_error(section: &SectionCoefficients, k: f64, steps_per_cycle: u32) -> f64 {
    let step = TAU / k / f64::from(steps_per_cycle);
    let amplitude = harmonic_response(section, k, Motion::Flap);
    let rate = Complex64::new(0.0, k);
    let march = MarchingSection::new(section);
    let mut state = SectionState::settled(&march, &Motion::Flap.inputs(k).map(|m| m.re));
    let mut worst = 0.0_f64;
    // e^(-0.0455 * 600) = 1e-12: the slowest lag of these sections has forgotten its start
    let settle = 600.0;
    let mut n = 0;
    while f64::from(n) * step < settle + 2.0 * TAU / k {
        n += 1;
        let phase = Complex64::from_polar(1.0, k * step * f64::from(n));
        let inputs = SectionInputs {
            modes: Motion::Flap.inputs(k).map(|m| (m * phase).re),
            rates: Motion::Flap.inputs(k).map(|m| (m * rate * phase).re),
        };
        let loads = state.step(&march, &inputs, step).unwrap();
        if f64::from(n) * step > settle {
            let exact = (amplitude[0] * phase).re;
            worst = worst.max((loads[0] - exact).abs() / amplitude[0].norm());
        }
    }
    worst
}

#[test]
fn second_order_on_a_harmonic_motion() {
    for (name, section) in [
        ("incompressible", incompressible()),
        ("M 0.5", compressible(0.5)),
        ("calibrated, M 0.5", calibrated(0.5)),
    ] {
        let errors: Vec<f64> =
            [72, 144, 288, 576, 1152].map(|n| marching_error(&section, 0.2, n)).to_vec();
        let orders: Vec<f64> = errors.windows(2).map(|e| (e[0] / e[1]).log2()).collect();
        println!("{name}: errors {errors:.6?} orders {orders:.3?}");
        // an order is a limit: the last two must have it
        assert!(errors[0] <= 6e-4, "{name}: {errors:?}");
        for order in &orders[2..] {
            assert!((order - 2.0).abs() < 0.05, "{name}: {orders:?}");
        }
    }
}

/// How a recurrence weighs the change of input within a step.
#[derive(Debug, Clone, Copy)]
enum Weighting {
    Rectangle,
    MidPoint,
    ExactRamp,
}

/// Beddoes's lags at Mach 0, pairs `(A, b)`.
const LAGS: [(f64, f64); 2] = [(0.3, 0.14), (0.7, 0.53)];

/// Largest error of the effective incidence, from rest, of an incidence `sin(k S)`.
///
/// The cheaper recurrences are those of the literature, `X <- X e^(-z) + A d(alpha) g`; the exact
/// ramp is the one the crate marches with.
fn recurrence_error(weighting: Weighting, k: f64, steps_per_cycle: u32) -> f64 {
    let step = TAU / k / f64::from(steps_per_cycle);
    let mut section = SectionCoefficients::default();
    section.lags.extend(LAGS.map(|(a, pole)| LagChannel {
        pole,
        input: [1.0, 0.0, 0.0, 0.0],
        output: [a, 0.0, 0.0],
        is_circulatory: true,
    }));
    let march = MarchingSection::new(&section);
    let mut state = SectionState::at_rest(&march);
    let mut deficiency = [0.0; 2];
    let mut worst = 0.0_f64;
    for n in 1..=10 * steps_per_cycle {
        let s = step * f64::from(n);
        let (alpha, before) = ((k * s).sin(), (k * (s - step)).sin());
        let weigh = |gain: fn(f64) -> f64, deficiency: &mut [f64; 2]| {
            for (x, (a, b)) in deficiency.iter_mut().zip(LAGS) {
                *x = *x * (-b * step).exp() + a * (alpha - before) * gain(b * step);
            }
            alpha - deficiency.iter().sum::<f64>()
        };
        let effective = match weighting {
            Weighting::Rectangle => weigh(|_| 1.0, &mut deficiency),
            Weighting::MidPoint => weigh(|z| (-0.5 * z).exp(), &mut deficiency),
            Weighting::ExactRamp => {
                state.step(&march, &held([alpha, 0.0, 0.0, 0.0]), step).unwrap()[0]
            }
        };
        let exact: f64 = LAGS
            .iter()
            .map(|&(a, b)| {
                // dx/dS = b (sin kS - x), x(0) = 0
                let forced = b / Complex64::new(b, k);
                a * ((forced * Complex64::from_polar(1.0, k * s)).im - forced.im * (-b * s).exp())
            })
            .sum();
        worst = worst.max((effective - exact).abs());
    }
    worst
}

#[test]
fn the_recurrence_beside_the_cheaper_ones() {
    for (weighting, order) in
        [(Weighting::Rectangle, 1.0), (Weighting::MidPoint, 2.0), (Weighting::ExactRamp, 2.0)]
    {
        let errors = [72, 144, 288].map(|n| recurrence_error(weighting, 0.2, n));
        println!("{weighting:?}, 72, 144, 288 steps per cycle: {errors:.7?}");
        for pair in errors.windows(2) {
            assert!(((pair[0] / pair[1]).log2() - order).abs() < 0.05, "{weighting:?} {errors:?}");
        }
    }
    assert!(recurrence_error(Weighting::ExactRamp, 0.2, 72) <= 6e-4);
    for row in Table::read("recurrence_accuracy.csv").rows() {
        let count: u32 = row.text("N").parse().unwrap();
        for (weighting, column) in [
            (Weighting::Rectangle, "err_D1"),
            (Weighting::MidPoint, "err_D2_mid"),
            (Weighting::ExactRamp, "err_exact_ramp"),
        ] {
            let got = recurrence_error(weighting, row.number("k"), count);
            assert_relative_eq!(got, row.number(column), max_relative = 1e-5);
        }
    }
}

#[test]
fn factors_made_beforehand_change_nothing() {
    let section = MarchingSection::new(&compressible(0.6));
    let factors = StepFactors::new(&section, 0.37).unwrap();
    let mut one = SectionState::at_rest(&section);
    let mut other = one.clone();
    for n in 0..50 {
        let inputs = held([0.1, 0.0, f64::from(n).sin(), f64::from(n).cos()]);
        let a = one.step(&section, &inputs, 0.37).unwrap();
        let b = other.step_with(&section, &inputs, &factors).unwrap();
        assert_eq!(a.map(f64::to_bits), b.map(f64::to_bits));
    }
}

#[test]
fn bad_input_is_refused_and_leaves_the_state() {
    let section = MarchingSection::new(&compressible(0.5));
    let mut state = SectionState::settled(&section, &[0.1; 4]);
    let before = state.clone();
    let good = held([0.1; 4]);
    for step in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(state.step(&section, &good, step), Err(AeroError::BadInput { .. })));
        assert!(matches!(StepFactors::new(&section, step), Err(AeroError::BadInput { .. })));
    }
    let nan = held([0.1, f64::NAN, 0.0, 0.0]);
    assert!(matches!(state.step(&section, &nan, 0.1), Err(AeroError::BadInput { .. })));
    let nan_rate = SectionInputs { modes: [0.0; 4], rates: [f64::INFINITY; 4] };
    assert!(matches!(state.step(&section, &nan_rate, 0.1), Err(AeroError::BadInput { .. })));
    assert_eq!(state, before);
    assert_eq!(
        state.step(&MarchingSection::new(&incompressible()), &good, 0.1),
        Err(AeroError::StateMismatch { state: 16, coefficients: 2 })
    );
}

proptest! {
    /// The state after a ramp does not know how the ramp was cut into steps.
    #[test]
    fn ramps_may_be_cut_anywhere(
        start in prop::array::uniform4(-1.0..1.0_f64),
        end in prop::array::uniform4(-1.0..1.0_f64),
        cut in 0.0..1.0_f64,
        distance in 1e-6..50.0_f64,
    ) {
        let section = MarchingSection::new(&compressible(0.5));
        let mut whole = SectionState::settled(&section, &start);
        let mut parts = whole.clone();
        whole.step(&section, &held(end), distance).unwrap();
        let middle = std::array::from_fn(|i| start[i] + cut * (end[i] - start[i]));
        parts.step(&section, &held(middle), cut * distance).unwrap();
        parts.step(&section, &held(end), (1.0 - cut) * distance).unwrap();
        for (a, b) in whole.states().iter().zip(parts.states()) {
            prop_assert!((a - b).abs() < 1e-13);
        }
    }

    /// A linear section: the response to a sum is the sum of the responses.
    #[test]
    fn responses_superpose(
        one in prop::collection::vec(prop::array::uniform4(-1.0..1.0_f64), 12),
        two in prop::collection::vec(prop::array::uniform4(-1.0..1.0_f64), 12),
    ) {
        let section = MarchingSection::new(&compressible(0.6));
        let mut states = [(); 3].map(|()| SectionState::at_rest(&section));
        for (a, b) in one.iter().zip(&two) {
            let sum = std::array::from_fn(|i| a[i] + b[i]);
            let [la, lb, ls] = {
                let [sa, sb, ss] = &mut states;
                [(sa, *a), (sb, *b), (ss, sum)]
                    .map(|(state, modes)| state.step(&section, &held(modes), 0.4).unwrap())
            };
            for i in 0..3 {
                prop_assert!((la[i] + lb[i] - ls[i]).abs() < 1e-12);
            }
        }
    }
}

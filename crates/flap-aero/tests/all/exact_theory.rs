//! Incompressible sections against exact thin-aerofoil theory.
#![expect(clippy::unwrap_used, reason = "a helper whose table or section is missing cannot go on")]

use crate::tables;

use approx::{assert_abs_diff_eq, assert_relative_eq};
use flap_aero::{
    AeroError, AttachedFlowModel, FlapChord, HingePosition, Mach, Mode, Motion,
    SectionCoefficients, TheodorsenFunctions, harmonic_response, indicial_response,
    steady_response,
};
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};
use tables::Table;

fn flap(ratio: f64) -> FlapChord {
    FlapChord::new(ratio).unwrap()
}

fn incompressible(ratio: f64) -> SectionCoefficients {
    AttachedFlowModel::Incompressible.coefficients(Mach::ZERO, flap(ratio)).unwrap()
}

#[test]
fn theodorsen_functions_against_the_table() {
    for row in Table::read("T_coeffs.csv").rows() {
        let functions = TheodorsenFunctions::new(HingePosition::new(row.number("e")).unwrap());
        for (i, value) in functions.all().iter().enumerate() {
            let expected = row.number(&format!("T{}", i + 1));
            assert_abs_diff_eq!(*value, expected, epsilon = 1e-10 * expected.abs().max(1e-2));
        }
    }
}

#[test]
fn a_flap_of_the_whole_chord_is_the_aerofoil() {
    // hinge at the leading edge: T10 = pi, T4 = -pi, T12 = pi, lift slope 2 pi
    let t = TheodorsenFunctions::new(HingePosition::new(-1.0).unwrap());
    assert_relative_eq!(t.circulatory_input()[2], 1.0, max_relative = 1e-15);
    assert_relative_eq!(t.apparent_mass()[0][2], PI, max_relative = 1e-15);
    assert_relative_eq!(t.t::<12>(), PI, max_relative = 1e-15);
    assert_abs_diff_eq!(t.t::<15>(), 0.0, epsilon = 1e-15);
    // moment of an aerofoil's lift about its leading edge: -(2 pi)/4
    let hinge = t.held_hinge()[2] + t.circulatory_hinge();
    assert_relative_eq!(hinge, -0.5 * PI, max_relative = 1e-14);
}

#[test]
fn a_flap_of_no_chord_does_nothing() {
    for model in AttachedFlowModel::ALL {
        let section = model.coefficients(Mach::ZERO, FlapChord::NONE).unwrap();
        for motion in [Motion::Flap, Motion::Pitch, Motion::Plunge] {
            let [cn, cm, ch] = harmonic_response(&section, 0.3, motion);
            assert!(ch.norm() < 1e-15, "{model:?} {motion:?}");
            if motion == Motion::Flap {
                assert!(cn.norm() < 1e-15 && cm.norm() < 1e-15, "{model:?}");
            }
        }
    }
}

/// Integral of `cos(n theta)` from the hinge to the trailing edge.
fn cosine_integral(n: i32, hinge_angle: f64) -> f64 {
    if n == 0 { PI - hinge_angle } else { -(f64::from(n) * hinge_angle).sin() / f64::from(n) }
}

/// `[Cn, Cm, Ch]` of a held downwash by Glauert's Fourier series, `x = -cos(theta)`.
///
/// `moment(n)` is the integral of `w cos(n theta)` over the chord.
fn glauert(moment: impl Fn(i32) -> f64, hinge: f64) -> [f64; 3] {
    let a0 = moment(0) / PI;
    let a = |n: i32| -2.0 / PI * moment(n);
    let angle = (-hinge).acos();
    // Ch = -(1/4) integral over the flap of dcp (x - e) dx, dcp = 4 [A0 (1+cos)/sin + sum An sin n]
    let against_sine = |n: i32| {
        let c = |m: i32| cosine_integral(m.abs(), angle);
        -0.25 * (c(n - 2) - c(n + 2)) - 0.5 * hinge * (c(n - 1) - c(n + 1))
    };
    // (1 + cos) (-cos - e) = -cos - 1/2 - cos(2)/2 - e - e cos
    let c = |m: i32| cosine_integral(m, angle);
    let against_a0 = -(1.0 + hinge) * c(1) - (0.5 + hinge) * c(0) - 0.5 * c(2);
    let series: f64 = (1..20_000).rev().map(|n| a(n) * against_sine(n)).sum();
    [TAU * (a0 + 0.5 * a(1)), -0.25 * PI * (a(1) - a(2)), -(a0 * against_a0 + series)]
}

#[test]
fn held_downwash_of_every_input_against_glauerts_series() {
    for ratio in [0.1, 0.2, 0.35, 0.6] {
        let section = incompressible(ratio);
        let hinge = flap(ratio).hinge().semichords();
        let angle = (-hinge).acos();
        // whole chord: integrals of 1 and of -cos(theta) against cos(n theta)
        let whole = |n: i32| if n == 0 { PI } else { 0.0 };
        let slope = |n: i32| if n == 1 { -0.5 * PI } else { 0.0 };
        let c = |n: i32| cosine_integral(n.abs(), angle);
        let flap_slope = |n: i32| -0.5 * (c(n - 1) + c(n + 1)) - hinge * c(n);
        let exact = [
            glauert(whole, hinge),
            glauert(|n| 0.5 * (slope(n) + 0.5 * whole(n)), hinge),
            glauert(c, hinge),
            glauert(|n| 0.5 * flap_slope(n), hinge),
        ];
        for (mode, expected) in Mode::ALL.into_iter().zip(exact) {
            let mut inputs = [0.0; 4];
            inputs[mode.index()] = 1.0;
            let got = steady_response(&section, &inputs);
            for (g, e) in got.into_iter().zip(expected) {
                assert_abs_diff_eq!(g, e, epsilon = 1e-9);
            }
        }
    }
}

/// Largest error over `k <= 1`, relative to the magnitude of each load.
fn worst(
    table: &Table,
    mut pair: impl FnMut(&tables::Row<'_>) -> Option<[[Complex64; 3]; 2]>,
) -> [f64; 3] {
    let mut worst = [0.0_f64; 3];
    let mut count = 0;
    for row in table.rows().filter(|row| row.number("k") <= 1.0) {
        let Some([got, exact]) = pair(&row) else {
            continue;
        };
        count += 1;
        for ((w, g), e) in worst.iter_mut().zip(got).zip(exact) {
            *w = w.max((g - e).norm() / e.norm());
        }
    }
    assert!(count >= 10, "only {count} rows compared");
    worst
}

#[test]
fn flap_motion_against_theodorsen() {
    let section = incompressible(0.2);
    let [cn, cm, ch] = worst(&Table::read("theodorsen_flap_E020.csv"), |row| {
        Some([harmonic_response(&section, row.number("k"), Motion::Flap), row.loads()])
    });
    println!("flap, k <= 1: Cn {cn:.4} Cm {cm:.1e} Ch {ch:.4} of magnitude");
    assert!(cn <= 0.025 && cm <= 1e-6 && ch <= 0.006, "{cn} {cm} {ch}");
    // Jones's two lags are not exact: a much smaller error would mean the table is not what it says
    assert!(cn > 0.015 && ch > 0.003, "{cn} {ch}");
}

#[test]
fn pitch_and_plunge_against_theodorsen() {
    let section = incompressible(0.2);
    let table = Table::read("theodorsen_pitch_plunge_E020.csv");
    for (name, motion, bounds) in [
        ("alpha", Motion::Pitch, [0.025, 1e-8, 0.016]),
        ("h", Motion::Plunge, [0.025, 1e-8, 0.025]),
    ] {
        let [cn, cm, ch] = worst(&table, |row| {
            let k = row.number("k");
            // plunge rows are per h/b: a unit of h_dot/U is h/b = 1/(ik)
            let scale = match motion {
                Motion::Plunge => Complex64::new(0.0, k).inv(),
                _ => Complex64::ONE,
            };
            (row.text("mode") == name).then(|| {
                [harmonic_response(&section, k, motion), row.loads().map(|load| load * scale)]
            })
        });
        println!("{motion:?}, k <= 1: Cn {cn:.4} Cm {cm:.1e} Ch {ch:.4} of magnitude");
        for (got, bound) in [cn, cm, ch].into_iter().zip(bounds) {
            assert!(got <= bound, "{motion:?}: {got} > {bound}");
        }
    }
}

/// Theodorsen's function as the section's lags have it.
fn lagged_function(section: &SectionCoefficients, k: f64) -> Complex64 {
    section
        .lags
        .iter()
        .map(|lag| {
            let weight = lag.output[0] / TAU;
            -Complex64::new(0.0, k) * weight / Complex64::new(lag.pole, k)
        })
        .sum::<Complex64>()
        + 1.0
}

#[test]
fn with_the_exact_function_in_place_of_the_lags_nothing_is_left() {
    let section = incompressible(0.2);
    let t = TheodorsenFunctions::new(flap(0.2).hinge());
    let flap_table = Table::read("theodorsen_flap_E020.csv");
    let rigid_table = Table::read("theodorsen_pitch_plunge_E020.csv");
    let exact_function =
        |k: f64| flap_table.rows().find(|row| row.is("k", k)).map(|row| row.complex("C")).unwrap();
    let corrected = |k: f64, motion: Motion| {
        let gap = exact_function(k) - lagged_function(&section, k);
        let weights = t.circulatory_input();
        let drive: Complex64 = motion.inputs(k).into_iter().zip(weights).map(|(m, w)| m * w).sum();
        let [cn, cm, ch] = harmonic_response(&section, k, motion);
        [cn + TAU * gap * drive, cm, ch + t.circulatory_hinge() * gap * drive]
    };
    let check = |row: tables::Row<'_>, motion: Motion, scale: Complex64| {
        for (got, exact) in corrected(row.number("k"), motion).into_iter().zip(row.loads()) {
            let error = (got - exact * scale).norm();
            assert!(
                error <= 2e-9 * (1.0 + scale.norm()),
                "{motion:?} {}: {error:e}",
                row.number("k")
            );
        }
    };
    for row in flap_table.rows() {
        check(row, Motion::Flap, Complex64::ONE);
    }
    for row in rigid_table.rows() {
        if row.text("mode") == "alpha" {
            check(row, Motion::Pitch, Complex64::ONE);
        } else {
            check(row, Motion::Plunge, Complex64::new(0.0, row.number("k")).inv());
        }
    }
}

#[test]
fn steady_values_in_numbers() {
    let section = incompressible(0.2);
    let [cn, cm, ch] = steady_response(&section, &[0.0, 0.0, 1.0, 0.0]);
    assert_abs_diff_eq!(cn, 3.45459, epsilon = 5e-6);
    assert_abs_diff_eq!(cm, -0.64, epsilon = 1e-12);
    assert_abs_diff_eq!(ch, -0.036_915, epsilon = 5e-7);
    let [.., ch_rate] = steady_response(&section, &[0.0, 0.0, 0.0, 1.0]);
    assert_abs_diff_eq!(ch_rate, -0.009_446_18, epsilon = 5e-9);
}

#[test]
fn wagner_step_starts_at_half_and_settles() {
    let section = incompressible(0.2);
    let lift = |s: f64| indicial_response(&section, Mode::Alpha, s)[0] / TAU;
    assert_relative_eq!(lift(0.0), 0.5, max_relative = 1e-14);
    // R. T. Jones's own formula
    for s in [0.5, 2.0, 10.0] {
        let jones = 1.0 - 0.165 * f64::exp(-0.0455 * s) - 0.335 * f64::exp(-0.3 * s);
        assert_relative_eq!(lift(s), jones, max_relative = 1e-14);
    }
    assert_relative_eq!(lift(1e4), 1.0, max_relative = 1e-12);
}

#[test]
fn quasi_steady_is_the_low_frequency_limit() {
    let ratio = 0.2;
    let section = incompressible(ratio);
    let quasi = AttachedFlowModel::QuasiSteady.coefficients(Mach::ZERO, flap(ratio)).unwrap();
    for motion in [Motion::Flap, Motion::Pitch, Motion::Plunge] {
        let k = 1e-6;
        let slow = harmonic_response(&section, k, motion);
        let limit = harmonic_response(&quasi, k, motion);
        for (s, l) in slow.iter().zip(limit) {
            assert!((s - l).norm() < 1e-4, "{motion:?}: {s} {l}");
        }
    }
    // the rate damping too, to first order in k; plunge has apparent mass alone in its moment
    for motion in [Motion::Flap, Motion::Pitch] {
        let k = 1e-4;
        let damping = |s: &SectionCoefficients| harmonic_response(s, k, motion)[1].im / k;
        assert_relative_eq!(damping(&section), damping(&quasi), max_relative = 1e-9);
    }
}

#[test]
fn quasi_steady_compressibility_factor() {
    let mach = Mach::new(0.6).unwrap();
    let at_rest = AttachedFlowModel::QuasiSteady.coefficients(Mach::ZERO, flap(0.2)).unwrap();
    let moving = AttachedFlowModel::QuasiSteady.coefficients(mach, flap(0.2)).unwrap();
    for o in 0..3 {
        for j in [0, 2, 3] {
            assert_relative_eq!(moving.direct[o][j], at_rest.direct[o][j] / 0.8, epsilon = 1e-15);
        }
    }
    // pitch-rate damping of apparent-mass kind is not scaled
    assert_relative_eq!(moving.direct[1][1], -0.25 * PI, max_relative = 1e-15);
}

#[test]
fn the_incompressible_model_refuses_a_mach_number() {
    let error = AttachedFlowModel::Incompressible
        .coefficients(Mach::new(0.3).unwrap(), flap(0.2))
        .unwrap_err();
    assert_eq!(error, AeroError::CompressibleFlow { mach: 0.3 });
    assert!(error.to_string().contains("Mach 0.3"), "{error}");
}

proptest! {
    /// Theodorsen's own relation between his functions, at any hinge, and smoothness toward the
    /// edges: `T4`, `T10` and `T11` are derivatives of one another along the hinge.
    #[test]
    fn functions_of_neighbouring_hinges_are_each_others_derivatives(e in -0.98..0.98_f64) {
        let h = 1e-5;
        let at = |x: f64| TheodorsenFunctions::new(HingePosition::new(x).unwrap());
        let d = |f: fn(&TheodorsenFunctions) -> f64| (f(&at(e + h)) - f(&at(e - h))) / (2.0 * h);
        // dT1/de = A - es = -T4;   dT11/de = -2 T10
        prop_assert!((d(TheodorsenFunctions::t::<1>) + at(e).t::<4>()).abs() < 1e-7);
        prop_assert!((d(TheodorsenFunctions::t::<11>) + 2.0 * at(e).t::<10>()).abs() < 1e-7);
        prop_assert!((at(e).t::<2>() - at(e).t::<6>()).abs() < 1e-15);
    }
}

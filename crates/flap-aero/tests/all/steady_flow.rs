//! Tabulated sections in any flow, their slopes, and the effectiveness of a flap.
#![expect(clippy::unwrap_used, reason = "a helper whose section is missing cannot go on")]

use approx::{assert_abs_diff_eq, assert_relative_eq};
use flap_aero::{
    AirfoilSpan, AttachedFlowModel, C81Airfoil, C81Table, CycleStep, FlapChord, FlapEffectiveness,
    FreeStream, LinearisedForces, Mach, MarchingSection, Motion, SectionFlow, SectionForces,
    SectionInputs, TabulatedSection, harmonic_response, lag_rate_slopes, lag_rates, load_slopes,
    periodic_state, section_loads,
};
use num_complex::Complex64;
use proptest::prelude::*;
use std::f64::consts::{PI, TAU};

/// A flat plate over the whole circle: `cl = sin(2a)`, `cd = 0.01 + 2 sin^2(a)`, and a moment.
fn plate() -> AirfoilSpan {
    let angles: Vec<f64> = (0..=360).map(|i| f64::from(i) - 180.0).collect();
    let machs = vec![0.0, 0.3, 0.8];
    let table = |f: fn(f64, f64) -> f64| {
        let values =
            angles.iter().flat_map(|a| machs.iter().map(move |m| f(a.to_radians(), *m))).collect();
        C81Table::new(machs.clone(), angles.clone(), values).unwrap()
    };
    let airfoil = C81Airfoil {
        name: "PLATE".into(),
        lift: table(|a, m| (2.0 * a).sin() * (1.0 + 0.2 * m)),
        drag: table(|a, m| 0.01 + 2.0 * a.sin().powi(2) + 0.01 * m),
        moment: table(|a, m| -0.25 * a.sin() * (1.0 + m)),
    };
    AirfoilSpan::new(vec![(0.0, airfoil)]).unwrap()
}

fn section() -> TabulatedSection {
    TabulatedSection::new(plate(), 0.5, 0.4, 0.006)
        .unwrap()
        .with_flap(FlapChord::new(0.2).unwrap(), &FlapEffectiveness::IDEAL)
}

fn flow(chordwise: f64, normal: f64, spanwise: f64, flap_rad: f64) -> SectionFlow {
    SectionFlow { density: 1.2, sound_speed: 340.0, chordwise, normal, spanwise, flap_rad }
}

fn forces(flow: &SectionFlow) -> LinearisedForces {
    section().forces(flow).unwrap()
}

fn parts(f: &SectionForces) -> [f64; 5] {
    [f.normal, f.chordwise, f.spanwise, f.moment, f.hinge]
}

#[test]
fn lift_and_drag_come_out_of_the_section_axes() {
    for (speed, degrees) in [(100.0, 5.0_f64), (60.0, 170.0), (40.0, -90.0), (90.0, -12.0)] {
        let a = degrees.to_radians();
        let got = forces(&flow(speed * a.cos(), speed * a.sin(), 0.0, 0.0)).value;
        let q = 0.5 * 1.2 * speed * speed * 0.4;
        let m = speed / 340.0;
        let lift = got.normal * a.cos() + got.chordwise * a.sin();
        let drag = got.normal * a.sin() - got.chordwise * a.cos();
        assert_relative_eq!(lift, q * (2.0 * a).sin() * (1.0 + 0.2 * m), epsilon = 1e-9 * q);
        assert_relative_eq!(
            drag,
            q * (0.01 + 2.0 * a.sin().powi(2) + 0.01 * m),
            epsilon = 1e-9 * q
        );
        assert_relative_eq!(got.moment, -0.25 * a.sin() * (1.0 + m) * q * 0.4, epsilon = 1e-9 * q);
    }
    // no flow: no force, and no direction to divide by
    assert_eq!(forces(&flow(0.0, 0.0, 20.0, 0.1)), LinearisedForces::default());
}

#[test]
fn a_yawed_section_feels_what_is_normal_to_its_span() {
    let straight = forces(&flow(80.0, 6.0, 0.0, 0.05)).value;
    let yawed = forces(&flow(80.0, 6.0, 45.0, 0.05)).value;
    assert_relative_eq!(yawed.moment, straight.moment, max_relative = 1e-12);
    // friction alone knows of the span: 0.5 rho c cf V s
    let whole = f64::hypot(f64::hypot(80.0, 6.0), 45.0);
    assert_relative_eq!(
        yawed.spanwise,
        0.5 * 1.2 * 0.4 * 0.006 * whole * 45.0,
        max_relative = 1e-12
    );
    assert!((yawed.normal / straight.normal - 1.0).abs() < 2e-3);
    assert!(yawed.chordwise < straight.chordwise);
    let stream = FreeStream::yawed(1.2, 0.2, 100.0, PI / 3.0);
    assert_relative_eq!(stream.speed, 50.0, max_relative = 1e-12);
}

#[test]
fn the_flap_acts_forward_and_not_in_reverse() {
    let flap = FlapChord::new(0.2).unwrap();
    let still =
        AttachedFlowModel::QuasiSteady.coefficients(Mach::new(0.25).unwrap(), flap).unwrap();
    let delta = 0.06;
    let (bare, moved) = (forces(&flow(85.0, 0.0, 0.0, 0.0)), forces(&flow(85.0, 0.0, 0.0, delta)));
    let q = 0.5 * 1.2 * 85.0 * 85.0 * 0.4;
    let direct = still.direct;
    let change = moved.value.normal - bare.value.normal;
    assert_relative_eq!(change, q * direct[0][2] * delta, max_relative = 1e-12);
    let change = moved.value.moment - bare.value.moment;
    assert_relative_eq!(change, q * 0.4 * direct[1][2] * delta, max_relative = 1e-12);
    assert_relative_eq!(moved.value.hinge, q * 0.4 * direct[2][2] * delta, max_relative = 1e-12);
    let reverse = [0.0, delta].map(|d| forces(&flow(-85.0, 3.0, 0.0, d)).value);
    assert_eq!(reverse[0], reverse[1]);
    let weak = FlapEffectiveness::new(0.78, 1.0, 0.9).unwrap();
    let real = TabulatedSection::new(plate(), 0.5, 0.4, 0.006).unwrap().with_flap(flap, &weak);
    let [a, b] = [0.0, delta].map(|d| real.forces(&flow(85.0, 0.0, 0.0, d)).unwrap().value);
    assert_relative_eq!(b.normal - a.normal, 0.78 * q * direct[0][2] * delta, max_relative = 1e-12);
    assert_relative_eq!(b.hinge, 0.9 * q * 0.4 * direct[2][2] * delta, max_relative = 1e-12);
}

proptest! {
    /// The slopes against differences, anywhere but on a node of the tables.
    #[test]
    fn slopes_are_the_derivatives(
        speed in 20.0..250.0_f64,
        angle in -179.6..179.6_f64,
        spanwise in -80.0..80.0_f64,
        delta in -0.1..0.1_f64,
    ) {
        let near = (angle - angle.round()).abs();
        let backward = angle.abs() - 90.0;
        prop_assume!(near > 0.01 && near < 0.49 && backward.abs() > 0.1);
        let mach = speed / 340.0;
        prop_assume!((mach - 0.3).abs() > 1e-3);
        let a = angle.to_radians();
        let base = flow(speed * a.cos(), speed * a.sin(), spanwise, delta);
        let got = forces(&base);
        let h = 1e-4;
        let difference = |change: &dyn Fn(&mut SectionFlow, f64), h: f64| {
            let [up, down] = [h, -h].map(|h| {
                let mut moved = base;
                change(&mut moved, h);
                parts(&forces(&moved).value)
            });
            std::array::from_fn::<f64, 5, _>(|i| (up[i] - down[i]) / (2.0 * h))
        };
        let checks = [
            (got.per_velocity[0], difference(&|f, h| f.chordwise += h, h)),
            (got.per_velocity[1], difference(&|f, h| f.normal += h, h)),
            (got.per_velocity[2], difference(&|f, h| f.spanwise += h, h)),
            (got.per_flap_rad, difference(&|f, h| f.flap_rad += h, 1e-6)),
        ];
        for (slope, exact) in checks {
            for (s, e) in parts(&slope).into_iter().zip(exact) {
                prop_assert!((s - e).abs() < 1e-5 * (1.0 + e.abs()) * speed, "{s} {e}");
            }
        }
    }
}

#[test]
fn slopes_of_the_attached_loads_are_exact() {
    let flap = FlapChord::new(0.25).unwrap();
    for model in [AttachedFlowModel::HariharanLeishman, AttachedFlowModel::Calibrated] {
        let section = model.coefficients(Mach::new(0.4).unwrap(), flap).unwrap();
        for speed in [120.0, -35.0] {
            let stream = FreeStream { density: 1.1, semichord: 0.2, speed };
            let (w, dw) = ([3.0, -1.0, 2.0, 0.5], [10.0, 4.0, -20.0, 7.0]);
            let x: Vec<f64> = (0..section.lags.len()).map(|i| (i as f64 * 0.7).sin()).collect();
            let slopes = load_slopes(&section, &stream, &w, &dw, &x).unwrap();
            let rates = lag_rate_slopes(&section, &stream, &w, &x).unwrap();
            let loads = |stream: &FreeStream, w: &[f64; 4], dw: &[f64; 4], x: &[f64]| {
                let l = section_loads(&section, stream, w, dw, x).unwrap();
                [l.lift, l.moment, l.hinge]
            };
            let lag_rate = |stream: &FreeStream, w: &[f64; 4], x: &[f64]| {
                let mut out = vec![0.0; x.len()];
                lag_rates(&section, stream, w, x, &mut out).unwrap();
                out
            };
            let base = loads(&stream, &w, &dw, &x);
            let base_rates = lag_rate(&stream, &w, &x);
            // linear functions: a difference over any length is the slope
            for j in 0..4 {
                let (mut up, mut dup) = (w, dw);
                up[j] += 1.0;
                dup[j] += 1.0;
                let (a, b) = (loads(&stream, &up, &dw, &x), loads(&stream, &w, &dup, &x));
                for o in 0..3 {
                    assert_abs_diff_eq!(a[o] - base[o], slopes.per_velocity[o][j], epsilon = 1e-8);
                    let apparent = slopes.per_velocity_rate[o][j];
                    assert_abs_diff_eq!(b[o] - base[o], apparent, epsilon = 1e-8);
                }
                for ((a, b), rate) in lag_rate(&stream, &up, &x).iter().zip(&base_rates).zip(&rates)
                {
                    let slope = rate.per_velocity[j];
                    assert_abs_diff_eq!(a - b, slope, epsilon = 1e-9 * (1.0 + b.abs()));
                }
            }
            for i in 0..x.len() {
                let mut up = x.clone();
                up[i] += 1.0;
                let a = loads(&stream, &w, &dw, &up);
                for o in 0..3 {
                    assert_abs_diff_eq!(a[o] - base[o], slopes.per_lag[o][i], epsilon = 1e-8);
                }
                let moved = lag_rate(&stream, &w, &up)[i] - base_rates[i];
                assert_abs_diff_eq!(moved, rates[i].per_lag, epsilon = 1e-9 * (1.0 + moved.abs()));
            }
            let faster = FreeStream { speed: speed + 1.0, ..stream };
            // apparent mass does not go with the speed, the rest is linear in it
            let a = loads(&faster, &w, &dw, &x);
            for o in 0..3 {
                assert_abs_diff_eq!(a[o] - base[o], slopes.per_speed[o], epsilon = 1e-8);
            }
            for ((a, b), rate) in lag_rate(&faster, &w, &x).iter().zip(&base_rates).zip(&rates) {
                assert_abs_diff_eq!(a - b, rate.per_speed, epsilon = 1e-9 * (1.0 + b.abs()));
            }
        }
    }
}

#[test]
fn effectiveness_weighs_the_flap_alone() {
    let flap = FlapChord::new(0.2).unwrap();
    let weak = FlapEffectiveness::new(0.78, 1.02, 0.9).unwrap();
    for (model, m) in [
        (AttachedFlowModel::QuasiSteady, 0.5),
        (AttachedFlowModel::Incompressible, 0.0),
        (AttachedFlowModel::HariharanLeishman, 0.5),
        (AttachedFlowModel::Calibrated, 0.5),
    ] {
        let ideal = model.coefficients(Mach::new(m).unwrap(), flap).unwrap();
        assert_eq!(ideal.clone().with_flap_effectiveness(&FlapEffectiveness::default()), ideal);
        let real = ideal.clone().with_flap_effectiveness(&weak);
        for k in [0.0, 0.1, 0.7] {
            let [a, b] = [&ideal, &real].map(|s| harmonic_response(s, k, Motion::Flap));
            for ((a, b), factor) in a.into_iter().zip(b).zip([0.78, 1.02, 0.9]) {
                assert!((b - a * factor).norm() < 1e-12, "{model:?} {k}");
            }
            for motion in [Motion::Pitch, Motion::Plunge] {
                let [a, b] = [&ideal, &real].map(|s| harmonic_response(s, k, motion));
                assert!(a.into_iter().zip(b).all(|(a, b)| (a - b).norm() < 1e-12));
            }
        }
    }
    assert!(FlapEffectiveness::new(-0.1, 1.0, 1.0).is_err());
    assert!(FlapEffectiveness::new(1.0, f64::NAN, 1.0).is_err());
}

/// The periodic state against marching until nothing changes, in a stream whose speed and Mach
/// number vary; and against the harmonic response where nothing varies.
#[test]
fn periodic_states_need_no_marching() {
    let flap = FlapChord::new(0.2).unwrap();
    for model in [AttachedFlowModel::HariharanLeishman, AttachedFlowModel::Calibrated] {
        let steps = 96;
        let sections: Vec<MarchingSection> = (1..=steps)
            .map(|n| {
                let psi = TAU * f64::from(n) / f64::from(steps);
                let mach = Mach::new(0.45 + 0.2 * psi.sin()).unwrap();
                MarchingSection::new(&model.coefficients(mach, flap).unwrap())
            })
            .collect();
        let cycle: Vec<CycleStep<'_>> = (1..=steps)
            .zip(&sections)
            .map(|(n, section)| {
                let psi = TAU * f64::from(n) / f64::from(steps);
                let modes = [0.05 * psi.cos(), 0.0, 0.03 * (3.0 * psi).sin(), 0.01 * psi.cos()];
                CycleStep {
                    section,
                    inputs: SectionInputs { modes, rates: [0.0; 4] },
                    semichords: 0.4 * (1.0 + 0.4 * psi.sin()),
                }
            })
            .collect();
        let start = periodic_state(&cycle).unwrap();
        let mut state = start.clone();
        for step in &cycle {
            state.step(step.section, &step.inputs, step.semichords).unwrap();
        }
        for (a, b) in state.states().iter().zip(start.states()) {
            assert_abs_diff_eq!(*a, b, epsilon = 1e-13);
        }
    }
    let section =
        AttachedFlowModel::Calibrated.coefficients(Mach::new(0.5).unwrap(), flap).unwrap();
    let march = MarchingSection::new(&section);
    let (k, steps) = (0.3, 1440);
    let cycle: Vec<CycleStep<'_>> = (1..=steps)
        .map(|n| {
            let turn = Complex64::cis(TAU * f64::from(n) / f64::from(steps));
            let modes = Motion::Flap.inputs(k).map(|m| (m * turn).re);
            CycleStep {
                section: &march,
                inputs: SectionInputs { modes, rates: [0.0; 4] },
                semichords: TAU / k / f64::from(steps),
            }
        })
        .collect();
    let state = periodic_state(&cycle).unwrap();
    let loads = state.loads(&march, &cycle[1439].inputs).unwrap();
    for (got, exact) in loads.into_iter().zip(harmonic_response(&section, k, Motion::Flap)) {
        assert_abs_diff_eq!(got, exact.re, epsilon = 1e-5 * exact.norm());
    }
    assert!(periodic_state(&[]).is_err());
    let nowhere = CycleStep { semichords: 0.0, ..cycle[0] };
    assert!(periodic_state(&[nowhere]).is_err());
}

//! Histories of a section, driven and round a cycle, against the exact answer to one frequency.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use flap_aero::{AttachedFlowModel, FlapEffectiveness, Motion, harmonic_response};
use num_complex::Complex64;
use section_study::{DrivenQuestion, LoopQuestion, SectionChoice, driven_history, loop_history};

const K: f64 = 0.2;
const AMPLITUDE_RAD: f64 = 0.03;

fn section(model: AttachedFlowModel) -> SectionChoice {
    // the incompressible model is of no other Mach number
    let mach = if model == AttachedFlowModel::Incompressible { 0.0 } else { 0.3 };
    SectionChoice { model, mach, flap_chord: 0.2, effectiveness: FlapEffectiveness::IDEAL }
}

/// Amplitude of a load; a load that is none is measured by a hundredth.
fn scale(exact: &Complex64) -> f64 {
    AMPLITUDE_RAD * exact.norm().max(0.01)
}

/// Largest difference of the last cycle from the harmonic response, over its amplitude, load by load.
fn error(model: AttachedFlowModel, motion: Motion, steps_per_cycle: usize) -> f64 {
    let ds = std::f64::consts::TAU / K / steps_per_cycle as f64;
    let samples = 30 * steps_per_cycle;
    let moved: Vec<f64> = (0..samples).map(|n| AMPLITUDE_RAD * (K * ds * n as f64).sin()).collect();
    let still = vec![0.0; samples];
    let (incidence, flap) =
        if motion == Motion::Flap { (&still, &moved) } else { (&moved, &still) };
    let question = DrivenQuestion {
        section: section(model),
        step_semichords: ds,
        incidence_rad: incidence,
        flap_rad: flap,
        pitches: motion == Motion::Pitch,
    };
    let loads = driven_history(&question).unwrap();
    let (coefficients, ..) = section(model).coefficients().unwrap();
    let exact = harmonic_response(&coefficients, K, motion);
    let mut worst: f64 = 0.0;
    // the very last samples have one-sided rates
    let last = loads.iter().enumerate().take(samples - 3).skip(samples - steps_per_cycle);
    for (n, loads) in last {
        let (sin, cos) = (K * ds * n as f64).sin_cos();
        for (load, exact) in loads.iter().zip(&exact) {
            let wanted = AMPLITUDE_RAD * (exact.re * sin + exact.im * cos);
            worst = worst.max((load - wanted).abs() / scale(exact));
        }
    }
    worst
}

#[test]
fn every_model_and_motion_gives_its_harmonic_response_to_second_order() {
    for model in AttachedFlowModel::ALL {
        for motion in [Motion::Flap, Motion::Pitch, Motion::Plunge] {
            let [coarse, fine] = [240, 480].map(|steps| error(model, motion, steps));
            assert!(fine < 1e-3, "{model:?} {motion:?}: {fine:e}");
            let order = (coarse / fine).log2();
            assert!(fine < 1e-9 || order > 1.8, "{model:?} {motion:?}: order {order}");
        }
    }
}

/// The first harmonic of a cycle is the exact answer; a march of 720 steps is near it.
#[test]
fn a_cycle_has_its_harmonic_response() {
    for model in AttachedFlowModel::ALL {
        for motion in [Motion::Flap, Motion::Pitch, Motion::Plunge] {
            let question = LoopQuestion {
                section: section(model),
                motion,
                mean_rad: 0.0,
                amplitude_rad: AMPLITUDE_RAD,
                reduced_frequency: K,
                points: 36,
                stall: None,
                stalls_later_rad: 0.0,
            };
            let rows = loop_history(&question).unwrap().rows;
            let (coefficients, ..) = section(model).coefficients().unwrap();
            let exact = harmonic_response(&coefficients, K, motion);
            for row in rows {
                let (sin, cos) = row[0].to_radians().sin_cos();
                for (load, exact) in row[3..].iter().zip(&exact) {
                    let wanted = AMPLITUDE_RAD * (exact.re * sin + exact.im * cos);
                    let error = (load - wanted).abs() / scale(exact);
                    assert!(error < 1e-3, "{model:?} {motion:?} at {} deg: {error:e}", row[0]);
                }
            }
        }
    }
}

#[test]
fn what_cannot_be_driven_is_refused() {
    let driven = |step_semichords: f64, incidence_rad: &[f64], flap_rad: &[f64]| {
        let section = section(AttachedFlowModel::Calibrated);
        let question =
            DrivenQuestion { section, step_semichords, incidence_rad, flap_rad, pitches: true };
        driven_history(&question).map_err(|error| error.to_string())
    };
    let held = [0.1; 4];
    let loads = driven(0.5, &held, &held).unwrap();
    let moved = loads[0].iter().zip(&loads[3]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(moved < 1e-14, "what is held stays: {moved:e}");
    for (found, word) in [
        (driven(0.0, &held, &held), "step"),
        (driven(0.5, &held[..2], &held[..2]), "incidence"),
        (driven(0.5, &held, &held[..3]), "flap angle"),
        (driven(0.5, &[0.0, f64::NAN, 0.0], &[0.0; 3]), "finite"),
    ] {
        let said = found.unwrap_err();
        assert!(said.contains(word), "{said}");
    }
}

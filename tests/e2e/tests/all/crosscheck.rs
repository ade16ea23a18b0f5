//! Cases S1 and S2, from their case files to hub loads, against an independent model of the same physics:
//! `fixtures/reference/rotor/crosscheck_S1_S2.json`.
#![expect(clippy::disallowed_methods, reason = "tests read reference tables")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use sim_driver::case::{CouplingsChoice, LoadedCase, TwistAngle, Untwist, shipped_case};
use sim_driver::progress::Progress;
use sim_driver::run::run_case;

fn reference(key: &str) -> Vec<f64> {
    of_case("S1_linear_fixed", key)
}

fn of_case(case: &str, key: &str) -> Vec<f64> {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../fixtures/reference/rotor/crosscheck_S1_S2.json"
    );
    let json: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap();
    serde_json::from_value(json[case][key].clone()).unwrap()
}

fn norm(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// All twelve 4/rev hub harmonics within 0.1 % of the norm of the 4/rev vector; mean force and moment
/// within 0.1 % of their own vectors.
#[test]
fn s1_from_its_case_file() {
    let loaded = shipped_case("crosscheck_s1.ron").unwrap();
    let outcome = run_case(&loaded, &Progress::hidden()).unwrap();
    let solution = &outcome.trimmed.trim().rotor;

    let (found, expected) = (solution.hub.harmonic(4), reference("hub_Z4"));
    let whole = norm(&expected);
    for (k, (f, e)) in found.iter().zip(&expected).enumerate() {
        let error = (f - e).abs() / whole;
        assert!(error <= 1e-3, "hub harmonic {k}: {f:e} instead of {e:e}, {error:.2e} of |Z4|");
    }
    let (found, expected) = (solution.hub.mean(), reference("hub_mean"));
    for part in [0..3, 3..6] {
        let difference: Vec<f64> =
            found[part.clone()].iter().zip(&expected[part.clone()]).map(|(f, e)| f - e).collect();
        let error = norm(&difference) / norm(&expected[part.clone()]);
        assert!(error <= 1e-3, "mean loads {part:?}: {error:.2e}");
    }

    // what is printed is what was computed, and nothing is controlled
    let hub = outcome.result.baseline.hub_nb_per_rev;
    assert_eq!(hub.fz[0].to_bits(), solution.hub.harmonic(4)[4].to_bits());
    assert!(outcome.result.control.is_empty());
    let r = &outcome.result.residuals;
    assert!(r.trim <= 1e-8 && r.periodicity <= 1e-8 && r.inflow <= 1e-8, "{r:?}");
}

/// The bounds fail when an effect is changed: nonlinear couplings in the vibratory loads, the profile
/// drag in the mean torque.
#[test]
fn the_bounds_see_a_missing_effect() {
    let mut full = shipped_case("crosscheck_s1.ron").unwrap();
    full.case.structure.couplings = CouplingsChoice::Full;
    let outcome = run_case(&full, &Progress::hidden()).unwrap();
    let (found, expected) = (outcome.trimmed.trim().rotor.hub.harmonic(4), reference("hub_Z4"));
    let worst = found.iter().zip(&expected).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
    assert!(worst > 0.1 * norm(&expected), "{worst:e}");

    let mut smooth = shipped_case("crosscheck_s1.ron").unwrap();
    smooth.case.aerodynamics.drag_coefficient = 0.0;
    let outcome = run_case(&smooth, &Progress::hidden()).unwrap();
    let (found, expected) = (outcome.trimmed.trim().rotor.hub.mean(), reference("hub_mean"));
    let error = (found[5] - expected[5]).abs() / norm(&expected[3..6]);
    assert!(error > 1e-2, "{error:e}");
}

/// Distance of the 4/rev hub loads from the reference's case S2, over their norm: all, and the vertical force
/// over its own.
fn s2_distance(loaded: &LoadedCase) -> [f64; 2] {
    let outcome = run_case(loaded, &Progress::hidden()).unwrap();
    let (found, expected) =
        (outcome.trimmed.trim().rotor.hub.harmonic(4), of_case("S2_full_fixed", "hub_Z4"));
    [0..12, 4..6].map(|part| {
        let apart: Vec<f64> =
            found[part.clone()].iter().zip(&expected[part.clone()]).map(|(f, e)| f - e).collect();
        norm(&apart) / norm(&expected[part])
    })
}

/// Moderate deflections with the terms that the reference has: within what its own account gives for those
/// of third order; and each of the two terms of torsion that it lacks leads away from it by its own size.
#[test]
fn s2_from_its_case_file() {
    let as_shipped = shipped_case("crosscheck_s2.ron").unwrap();
    let [all, vertical] = s2_distance(&as_shipped);
    assert!(all <= 0.05 && vertical <= 0.15, "{all} {vertical}");
    let mut turning = as_shipped.clone();
    turning.case.structure.twist_angle = TwistAngle::Rotation;
    let [with_turning, _] = s2_distance(&turning);
    turning.case.structure.untwist = Untwist::Included;
    let [whole, whole_vertical] = s2_distance(&turning);
    assert!((0.025..0.04).contains(&with_turning), "{with_turning}");
    assert!((0.09..0.12).contains(&whole) && whole_vertical > 0.2, "{whole} {whole_vertical}");
}

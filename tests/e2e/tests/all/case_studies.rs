//! The case studies of the book that take seconds: their verdicts and main numbers.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use model_gap::ParameterValue;
use model_gap::discovery::{Confidence, Verdict};
use sim_driver::case::load_case;
use sim_driver::diagnose::{CasePoints, Findings};
use sim_driver::files::{Folder, dataset_kind, read_sweep};
use std::path::Path;

/// What is found in a folder of `fixtures/points` with a case of it.
fn found(case: &str, data: &str) -> Findings {
    let points = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/points");
    let folder = Folder::Disk(points.join(data));
    let sweep = read_sweep(&folder, dataset_kind(&folder).unwrap()).unwrap();
    let case = load_case(&points.join(case)).unwrap();
    let own = CasePoints::of(&case, &sweep, &[], &|_, _| {}).unwrap();
    own.diagnosis.findings()
}

fn value<'a>(own: &'a Findings, cause: &str, name: &str) -> &'a ParameterValue {
    &own.parameters[cause][name]
}

fn near(own: &ParameterValue, value: f64, within: f64) {
    assert!((own.value - value).abs() < within, "{own:?}");
}

/// Whether a cause in the place of the one found is as likely.
fn is_open(own: &Findings, cause: &str) -> bool {
    let mut of = own.compared.iter().filter(|other| other.cause == cause);
    of.any(|other| other.delta_chi2 < other.discrimination_threshold)
}

#[test]
fn a_flap_has_less_lift_and_the_moment_of_theory() {
    let case = "flap_two_mach/case.ron";
    let own = found(case, "flap_m0500");
    assert_eq!((own.verdict, own.confidence), (Verdict::Named, Confidence::Tentative));
    let cause = "flap-effectiveness";
    assert_eq!(own.causes, [cause]);
    near(value(&own, cause, "lift"), 0.78, 0.01);
    let [low, high] = value(&own, cause, "moment").ci95;
    assert!(low < 1.0 && high > 1.0, "{low} to {high}");
    // the moment is that of theory: no gain and no time is it
    for other in ["sensor-gain", "timing", "unsteady-lag"] {
        assert!(own.compared.iter().any(|own| own.cause == other), "{other}");
        assert!(!is_open(&own, other), "{other}");
    }
    // one factor does not hold at Mach 0.748
    let both = found(case, "flap_two_mach");
    assert_eq!((both.verdict, &both.causes[..]), (Verdict::Unknown, &[][..]));
}

#[test]
fn a_strip_is_stiffer_and_further_out_or_faster() {
    let own = found("epps_chandra_sweep0/case.ron", "epps_chandra_sweep0");
    assert_eq!(own.verdict, Verdict::Ambiguous);
    let mut causes = own.causes.clone();
    causes.sort();
    assert_eq!(causes, ["mass", "root-offset", "rotor-speed", "stiffness-flap"]);
    near(value(&own, "stiffness-flap", "ratio"), 1.14, 0.02);
    near(value(&own, "rotor-speed", "ratio"), 1.05, 0.02);
    near(value(&own, "root-offset", "offset_r"), 0.086, 0.01);
}

/// Attached flow lacks stall, which begins at the incidence where the loops open; the stalled model's rest has no name.
#[test]
fn attached_flow_through_stall_is_told_by_its_onset() {
    let own = found("stall_naca0012/attached.ron", "stall_naca0012");
    let told = (own.verdict, own.confidence);
    assert_eq!(told, (Verdict::NamedStructureRemains, Confidence::Tentative));
    assert_eq!(own.causes, ["dynamic-stall"]);
    near(value(&own, "dynamic-stall", "onset_deg"), 13.0, 1.0);
    for other in ["sensor-gain", "unsteady-lag", "pitch-axis"] {
        assert!(!is_open(&own, other), "{other}");
    }
    let stalled = found("stall_naca0012/stalled.ron", "stall_naca0012");
    assert_eq!((stalled.verdict, &stalled.causes[..]), (Verdict::Unknown, &[][..]));
}

//! Points of test of an independent rotor: a fast part of `cargo xtask hidden-effects --kind rotor`.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use measured_data::{DatasetKind, Folder, PointData, Source};
use model_gap::discovery::{Confidence, Finding, Verdict};
use rotor_gap::{RotorDiagnosis, RotorQuestion, Sweep, diagnose};
use rotor_truth::asked::Asked;
use rotor_truth::physics::balance::Resolution;
use rotor_truth::set::made::make;
use sim_driver::case::read_case;

/// A set of few points, diagnosed as `hhc diagnose` does.
fn diagnosed(seed: u64, effect: &str, size: Option<f64>) -> RotorDiagnosis {
    let asked = Asked {
        seed,
        snr_db: 40.0,
        effect: Some(effect.to_owned()),
        size,
        points: Some(6),
        base_error: true,
    };
    let made = make(&asked, Resolution::default()).unwrap();
    let source = Source { name: "case.ron".into(), text: made.case_ron };
    let case = read_case(&source, &Folder::Disk(".".into())).unwrap();
    let source = Source { name: "sweep.csv".into(), text: made.sweep_csv };
    let data = PointData::read_with(&source, DatasetKind::RotorSweep.words()).unwrap();
    let sweep = Sweep::of(&data, &case.case).unwrap();
    let question = RotorQuestion {
        case: &case.case,
        actuator: None,
        hysteretic: None,
        uncertain: &case.case.uncertain,
        sweep: &sweep,
        only: &[],
        begun: &|_, _| {},
    };
    diagnose(&question).unwrap()
}

fn ids(own: &RotorDiagnosis) -> Vec<&'static str> {
    let Finding { causes, .. } = &own.found.finding;
    let mut all: Vec<&str> = Vec::new();
    for found in causes {
        all.push(own.causes[found.candidate].id);
        all.extend(found.alternatives.iter().map(|other| own.causes[other.candidate].id));
    }
    all
}

#[test]
fn a_rotor_of_another_program_is_told_by_what_it_hides() {
    let null = diagnosed(1, "null", None);
    assert!(ids(&null).is_empty(), "{:?}", ids(&null));
    let effect = "stiffness-torsion";
    let own = diagnosed(3, effect, Some(0.8));
    let finding = &own.found.finding;
    assert!(ids(&own).contains(&effect), "{effect}: {:?} {:?}", ids(&own), finding.reasons);
    let is_sure = finding.verdict == Verdict::Named && finding.confidence == Confidence::Confident;
    assert!(!is_sure || ids(&own) == [effect], "{effect}: {:?}", ids(&own));
}

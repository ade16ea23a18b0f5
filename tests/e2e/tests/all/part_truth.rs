//! Frequencies of a blade and loads of a section of another program: a fast part of
//! `cargo xtask hidden-effects --kind blade` and `--kind section`.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::page::check_page;
use measured_data::{DatasetKind, Folder, PointData, Source};
use model_gap::discovery::{Confidence, Verdict};
use rotor_gap::blade::{Frequencies, diagnose_blade};
use rotor_gap::section::{SectionLoads, diagnose_section};
use rotor_gap::{CaseDiagnosis, CaseQuestion};
use rotor_truth::asked::Asked;
use rotor_truth::kind::SetKind;
use sim_driver::case::read_case;
use sim_driver::diagnose::{PAGE_FILE, PointDiagnosis};

/// A set, diagnosed as `hhc diagnose` does.
fn diagnosed(kind: SetKind, seed: u64, effect: &str, size: Option<f64>) -> CaseDiagnosis {
    let made = kind.make(&Asked {
        seed,
        snr_db: if kind == SetKind::Blade { 56.0 } else { 40.0 },
        effect: Some(effect.to_owned()),
        size,
        points: (kind == SetKind::Blade).then_some(5),
        base_error: true,
    });
    let made = made.unwrap();
    let source = Source { name: "case.ron".into(), text: made.case_ron };
    let case = read_case(&source, &Folder::Disk(".".into())).unwrap().case;
    let source = Source { name: kind.table_name().into(), text: made.table_csv };
    let read = |kind: DatasetKind| PointData::read_with(&source, kind.words()).unwrap();
    let question =
        CaseQuestion { case: &case, uncertain: &case.uncertain, only: &[], begun: &|_, _| {} };
    if kind == SetKind::Blade {
        let measured = Frequencies::of(&read(DatasetKind::BladeFrequencies)).unwrap();
        diagnose_blade(&question, &measured).unwrap()
    } else {
        let measured = SectionLoads::of(&read(DatasetKind::SectionLoops)).unwrap();
        diagnose_section(&question, &measured).unwrap()
    }
}

/// The causes named, with what may be them instead.
fn ids(own: &CaseDiagnosis) -> Vec<&'static str> {
    let id = |candidate: usize| own.found.candidates[candidate].id;
    let mut all: Vec<&str> = Vec::new();
    for found in &own.found.finding.causes {
        all.push(id(found.candidate));
        all.extend(found.alternatives.iter().map(|other| id(other.candidate)));
    }
    all
}

fn is_sure(own: &CaseDiagnosis) -> bool {
    let finding = &own.found.finding;
    finding.verdict == Verdict::Named && finding.confidence == Confidence::Confident
}

/// The page that `hhc diagnose` writes.
fn page(own: CaseDiagnosis) -> String {
    let CaseDiagnosis { table, found, .. } = own;
    let own = PointDiagnosis {
        title: "a set".into(),
        data_kind: "made",
        table,
        found,
        besides: vec![],
        notes: vec![],
    };
    let files = own.files().unwrap();
    files.into_iter().find(|own| own.0 == PAGE_FILE).unwrap().1
}

/// An engine that is always silent misses the known effects, one that always says the same all but one and the null.
fn tells_apart(kind: SetKind, known: &[(&str, f64)], outside: (&str, Option<f64>)) {
    let null = diagnosed(kind, 1, "null", None);
    assert!(ids(&null).is_empty(), "null: {:?}", ids(&null));
    let mut sections =
        vec!["compared", "residuals", "fingerprints", "floors", "costs", "yardstick"];
    check_page(&page(null), &sections);
    sections.push("parameters");
    for (number, (effect, size)) in (2..).zip(known) {
        let own = diagnosed(kind, number, effect, Some(*size));
        assert!(ids(&own).contains(effect), "{effect}: {:?}", ids(&own));
        assert!(!is_sure(&own) || ids(&own) == [*effect], "{effect}: {:?}", ids(&own));
        assert_ne!(own.found.finding.verdict, Verdict::NothingMissing, "{effect}");
        check_page(&page(own), &sections);
    }
    let (effect, size) = outside;
    let own = diagnosed(kind, 9, effect, size);
    assert!(!is_sure(&own), "{effect}: {:?}", ids(&own));
    assert_ne!(own.found.finding.verdict, Verdict::NothingMissing, "{effect}");
}

#[test]
fn a_blade_of_another_program_is_told_by_what_it_hides() {
    let known = [("stiffness-torsion", 0.82), ("rotor-speed", 1.04)];
    tells_apart(SetKind::Blade, &known, ("graded-stiffness", Some(0.3)));
}

#[test]
fn a_section_of_another_program_is_told_by_what_it_hides() {
    let known = [
        ("flap-effectiveness", 0.75),
        ("sensor-gain", 0.8),
        ("timing", 0.002),
        ("unsteady-lag", 0.5),
        ("pivot-compliance", 0.4),
        ("pitch-axis", 0.3),
    ];
    tells_apart(SetKind::Section, &known, ("channel-leak", Some(0.05)));
}

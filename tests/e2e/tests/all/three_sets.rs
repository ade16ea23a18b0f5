//! The three small sets that the tutorial tells of: a name, a set of causes, nothing.
#![expect(clippy::disallowed_methods, reason = "a test reads the files that are shipped")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};

use crate::page::check_page;
use everyday_bench::family::Family;
use everyday_bench::hidden::Deal;
use everyday_bench::set::{Request, set};
use everyday_bench::text::File;
use model_gap::discovery::Confidence;
use sim_driver::diagnose::{Diagnosis, Findings, Question, Records, bench_page, diagnose};
use sim_driver::files::{Folder, read_bench};

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/bench/everyday_synthetic").join(name)
}

fn records(name: &str) -> Records {
    (&read_bench(&Folder::Disk(folder(name))).unwrap()).into()
}

fn diagnosed(name: &str, only: &[&str]) -> Diagnosis {
    let only = only.iter().map(|id| (*id).to_owned()).collect();
    let question = Question { reference: records("reference").runs, only, ..Question::default() };
    diagnose(&records(name), &question).unwrap()
}

fn found(name: &str, only: &[&str]) -> Findings {
    Findings::from(&diagnosed(name, only))
}

const HIDDEN: [(&str, &str); 3] = [("a", "creep"), ("b", "transport-delay"), ("c", "null")];

#[test]
fn they_are_as_the_generator_makes_them() {
    for (name, hidden) in HIDDEN {
        let hidden = hidden.parse().unwrap();
        let own = Request::new(Family::Relays, 15_001, Deal::All);
        let made = set(&Request { hidden, share: Some(0.05), ..own });
        let same = |folder_name: &str, files: &[File]| {
            // the list of runs was edited by hand, and the minute of drive left out
            let told = files.iter().filter(|(id, _)| id != "dataset.ron" && id != "warm_up.csv");
            told.for_each(|(id, text)| {
                let shipped = std::fs::read_to_string(folder(folder_name).join(id)).unwrap();
                assert!(shipped == *text, "{folder_name}/{id}");
            });
        };
        same("reference", &made.reference);
        same(name, &made.measured);
    }
}

#[test]
fn one_has_a_name_one_a_set_and_one_lacks_nothing() {
    let own = HIDDEN.map(|(name, _)| diagnosed(name, &[]));
    let [named, ambiguous, nothing] = own.each_ref().map(bench_page);
    for page in [&named, &ambiguous, &nothing] {
        check_page(
            page,
            &["compared", "residuals", "fingerprints", "floors", "costs", "yardstick"],
        );
    }
    assert!(named.contains("creep: rate_per_decade: 0.0"), "its parameter");
    assert!(
        named.contains("<strong>creep, ") && nothing.contains("Nothing is missing (confident)")
    );
    assert!(ambiguous.contains("transport-delay: delay, s: 0.000"));
    let [a, b, c] = own.map(|own| serde_json::to_value(Findings::from(&own)).unwrap());
    assert_eq!([&a["verdict"], &a["confidence"]], ["named", "confident"], "{a}");
    assert_eq!(a["causes"][0], "creep");
    let interval = &a["parameters"]["creep"]["rate_per_decade"]["ci95"];
    let [low, high] = [0, 1].map(|end| interval[end].as_f64().unwrap());
    assert!((low..high).contains(&0.0383), "{interval}");

    assert_eq!(
        [&b["verdict"], &b["class"], &b["class_confidence"]],
        ["ambiguous", "lag", "confident"]
    );
    assert_eq!(b["causes"].as_array().unwrap().len(), 4, "{b}");
    assert!(b["causes"].as_array().unwrap().contains(&"transport-delay".into()), "{b}");
    assert_eq!(b["next_experiment"], "amplifier-monitor");

    assert_eq!([&c["verdict"], &c["confidence"]], ["nothing-missing", "confident"], "{c}");
    let would = |cause: &str| c["would_have_shown"][cause].as_f64().unwrap();
    assert!(
        ["creep", "transport-delay", "backlash"].iter().all(|cause| would(cause) < 0.03),
        "{c}"
    );
}

#[test]
fn a_cause_that_is_asked_for_is_never_confident() {
    let own = found("b", &["sensor-filter"]);
    assert_eq!(own.causes, ["sensor-filter"]);
    assert_eq!(
        (own.confidence, own.class_confidence),
        (Confidence::Tentative, Some(Confidence::Tentative))
    );
}

//! The metrics of everyday errors on cases made by hand.
#![expect(clippy::unwrap_used, reason = "a helper that fails fails its test")]

use everyday_bench::answer::Answer;
use everyday_bench::family::Family;
use everyday_bench::hidden::Kind;
use score::binomial::Share;
use score::everyday::{EverydayCase, metrics, wrong_ones};
use score::findings::Findings;
use score::metrics::{Figure, Outcome};

/// What a set of `hidden` with these truths and classes was given as answer: the beginning of `findings.json`.
fn case(hidden: &str, kind: Kind, truths: &[&str], classes: &[&str], said: &str) -> EverydayCase {
    let owned = |list: &[&str]| list.iter().map(|id| (*id).to_owned()).collect::<Vec<_>>();
    let answer = Answer {
        family: Family::Relays,
        seed: 1,
        snr_db: 40.0,
        hidden: hidden.to_owned(),
        kind,
        truths: owned(truths),
        class: classes.first().map(|class| (*class).to_owned()),
        classes: owned(classes),
        effect_share: if kind == Kind::Null { 0.0 } else { 0.03 },
        noise_um: 1.0,
        monitored: false,
        parameters: serde_json::from_str(
            r#"{"transport-delay": {"delay": {"value": 1e-3, "unit": "s"}}}"#,
        )
        .unwrap(),
    };
    let text = format!(
        r#"{{{said}, "parameters": {{"transport-delay": {{"delay":
        {{"value": 1.1e-3, "unit": "s", "ci95": [0.9e-3, 1.3e-3]}}}}}},
        "gain": {{"heldout_rms_before": 1.0, "heldout_rms_after": 1.0, "ci95": [0.0, 0.0], "unit": "um"}},
        "next_experiment": "", "not_observable": []}}"#
    );
    let findings = Findings::parse(&text).unwrap();
    let made_by = String::new();
    EverydayCase { answer, findings, seconds: 3.0, identify_seconds: 1.0, made_by }
}

const NOTHING: &str = r#""verdict": "nothing-missing", "causes": [], "confidence": "confident""#;

fn named(name: &str, confidence: &str) -> String {
    format!(r#""verdict": "named", "causes": ["{name}"], "confidence": "{confidence}""#)
}

fn classed(class: &str, confidence: &str) -> String {
    format!(
        r#""verdict": "ambiguous", "causes": ["sensor-gain", "load-stiffness"], "confidence": "tentative",
        "class": "{class}", "class_members": ["sensor-gain"], "class_confidence": "{confidence}""#
    )
}

/// Hits and cases of the metric that begins so.
fn share_of(cases: &[EverydayCase], name: &str) -> (u64, u64) {
    let all = metrics(cases);
    let at = all.iter().find(|metric| metric.name.starts_with(name)).unwrap();
    match at.figure {
        Figure::Share(Share { hits, cases }) => (hits, cases),
        Figure::Number { .. } => panic!("{name} is no share"),
    }
}

#[test]
fn confident_wrong_names_classes_and_denials_of_everyday_errors_count() {
    let gain =
        |said: &str| case("sensor-gain", Kind::Everyday, &["sensor-gain"], &["static-gain"], said);
    let stop = |said: &str| case("end-stop", Kind::Everyday, &[], &[], said);
    let cases = [
        gain(&named("sensor-gain", "confident")),
        gain(&named("load-stiffness", "confident")),
        gain(&named("load-stiffness", "tentative")),
        gain(&classed("static-gain", "confident")),
        gain(&classed("slow-drift", "confident")),
        gain(&classed("slow-drift", "tentative")),
        gain(NOTHING),
        stop(&named("load-stiffness", "confident")),
        stop(&classed("static-gain", "confident")),
    ];
    assert_eq!(share_of(&cases, "everyday: confident wrong name"), (2, 9));
    assert_eq!(share_of(&cases, "everyday: confident wrong class"), (2, 9));
    assert_eq!(share_of(&cases, "everyday, effect >= 3 %"), (1, 9));
    assert_eq!(share_of(&cases, "everyday, a class is right"), (3, 7));
    let text = wrong_ones(&cases);
    assert_eq!(text.lines().count(), 5, "{text}");
    assert!(text.contains("wrong denial: relays seed 1, 3.0 %: sensor-gain -> nothing!"), "{text}");
    assert!(text.contains("(slow-drift!)"), "{text}");
}

#[test]
fn an_effect_below_three_percent_may_be_denied() {
    let mut small = case("sensor-zero", Kind::Everyday, &["sensor-zero"], &["zero"], NOTHING);
    small.answer.effect_share = 0.029;
    assert_eq!(share_of(&[small], "everyday, effect >= 3 %"), (0, 0));
}

#[test]
fn singles_count_their_classes_and_a_name_says_its_class() {
    let delay = |said: &str| {
        let (truths, classes) = (["transport-delay"], ["lag-behind-terminals"]);
        case("transport-delay", Kind::Single, &truths, &classes, said)
    };
    let cases = [
        delay(&named("transport-delay", "confident")),
        delay(&classed("lag-behind-terminals", "confident")),
        delay(&named("electrical-lag", "confident")),
        delay(&named("transport-delay", "tentative")),
    ];
    assert_eq!(share_of(&cases, "single: class confident"), (3, 4));
    assert_eq!(share_of(&cases, "single: exact name confident"), (2, 4));
    assert_eq!(share_of(&cases, "single: 95 % intervals"), (1, 1));
    let all = metrics(&cases);
    let at = all.iter().position(|metric| metric.name.starts_with("single: class")).unwrap();
    assert_eq!(all[at + 1].figure, Figure::Share(Share { hits: 2, cases: 3 }));
    assert_eq!(all[at + 1].outcome(), Outcome::Missed);
}

#[test]
fn a_pair_may_be_named_by_one_of_its_parts_and_a_null_by_none() {
    let pair = case(
        "sensor-gain+mains-hum",
        Kind::Pair,
        &["sensor-gain", "mains-hum"],
        &["static-gain", "line"],
        &named("mains-hum", "confident"),
    );
    let null = |said: &str| case("null", Kind::Null, &[], &[], said);
    let cases = [pair, null(NOTHING), null(&named("creep", "tentative"))];
    assert_eq!(share_of(&cases, "everyday: confident wrong name"), (0, 1));
    assert_eq!(share_of(&cases, "null: any name"), (1, 2));
    assert_eq!(share_of(&cases, "null: confident name"), (0, 2));
    assert_eq!(share_of(&cases, "null, full reference runs"), (1, 2));
    assert_eq!(wrong_ones(&cases), "");
}

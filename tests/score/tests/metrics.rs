//! Every metric on cases made by hand, and the tables.
#![expect(clippy::unwrap_used, reason = "a helper that fails fails its test")]

use std::collections::BTreeMap;

use score::binomial::Share;
use score::case::Case;
use score::findings::{Confidence, Estimate, Findings, Gain, Verdict};
use score::metrics::{Bar, Figure, Metric, Outcome, metrics};
use score::report::{confusion_table, metric_table};
use truth::hidden::{Answer, HiddenEffect, Quantity};

fn gain(before: f64, after: f64) -> Gain {
    let ci95 = [before - after - 0.1, before - after + 0.1];
    Gain { heldout_rms_before: before, heldout_rms_after: after, ci95, unit: "um".to_owned() }
}

/// A set of base 0 in which `hidden` (joined by `+`) is hidden, each effect of 5 um over 1 um of noise.
fn case(hidden: &str, verdict: Verdict, names: &[&str], confidence: Confidence) -> Case {
    let quantity = Quantity { value: 2e-3, unit: "s".to_owned() };
    let effects: Vec<HiddenEffect> = hidden
        .split('+')
        .filter(|id| *id != "null")
        .map(|id| HiddenEffect {
            id: id.to_owned(),
            parameters: BTreeMap::from([("tau".to_owned(), quantity.clone())]),
            effect_um: 5.0,
            effect_share: 0.05,
        })
        .collect();
    let answer = Answer {
        seed: 1,
        snr_db: 40.0,
        base: 0,
        design: "recommended".to_owned(),
        monitored: true,
        hidden: hidden.to_owned(),
        effects,
        noise_um: 1.0,
        effect_um: 5.0,
        effect_share: 0.05,
        runs: Vec::new(),
        experiment: None,
    };
    let findings = Findings {
        verdict,
        causes: names.iter().map(|name| (*name).to_owned()).collect(),
        confidence,
        parameters: BTreeMap::new(),
        gain: Some(gain(1.1, 1.1)),
        next_experiment: String::new(),
        not_observable: Vec::new(),
        class: None,
        class_members: Vec::new(),
        class_confidence: None,
    };
    let (oracle, follow_up, replicates) = (None, None, Vec::new());
    let (first_seconds, made_by) = (None, String::new());
    Case { answer, findings, seconds: 1.0, first_seconds, oracle, follow_up, replicates, made_by }
}

fn sure(hidden: &str, names: &[&str]) -> Case {
    case(hidden, Verdict::Named, names, Confidence::Confident)
}

fn silent(hidden: &str) -> Case {
    case(hidden, Verdict::NothingMissing, &[], Confidence::Tentative)
}

fn metric(cases: &[Case], name: &str) -> Metric {
    metrics(cases).into_iter().find(|metric| metric.name.trim() == name).unwrap()
}

fn share(cases: &[Case], name: &str) -> (u64, u64) {
    match metric(cases, name).figure {
        Figure::Share(Share { hits, cases }) => (hits, cases),
        Figure::Number { .. } => panic!("{name} is no share"),
    }
}

fn number(cases: &[Case], name: &str) -> (f64, u64) {
    match metric(cases, name).figure {
        Figure::Number { value, cases } => (value, cases),
        Figure::Share(_) => panic!("{name} is no number"),
    }
}

#[test]
fn false_alarms_are_names_on_nothing() {
    let ambiguous =
        case("null", Verdict::Ambiguous, &["creep", "mains-hum"], Confidence::Tentative);
    let unknown = case("null", Verdict::Unknown, &[], Confidence::Confident);
    let cases =
        [silent("null"), sure("null", &["creep"]), ambiguous, unknown, sure("creep", &["creep"])];
    assert_eq!(share(&cases, "null: confident name"), (1, 4));
    assert_eq!(share(&cases, "null: any name"), (2, 4));
    assert_eq!(share(&cases, "null: unknown cause claimed"), (1, 4));
}

#[test]
fn a_right_class_depends_on_what_was_measured() {
    let lag_as_filter = sure("electrical-lag", &["sensor-filter"]);
    let mut unmonitored = lag_as_filter.clone();
    unmonitored.answer.monitored = false;
    let mut noisy = sure("creep", &["mains-hum"]);
    noisy.answer.snr_db = 20.0;
    let friction = sure("backlash", &["coulomb-friction"]);
    let cases = [lag_as_filter, unmonitored, friction, noisy];
    assert_eq!(share(&cases, "confident: right class, 40 and 30 dB"), (2, 3));
    assert_eq!(share(&cases, "confident: right class, 20 dB"), (0, 1));
    assert_eq!(share(&cases, "confident: exact name"), (0, 4));
    assert_eq!(share(&cases, "named: truth in the set"), (0, 4));
}

#[test]
fn the_truth_in_an_ambiguous_set_counts_and_its_size_too() {
    let names = ["mains-hum", "creep", "backlash"];
    let cases = [
        case("creep", Verdict::Ambiguous, &names, Confidence::Tentative),
        sure("creep", &["creep"]),
        silent("creep"),
    ];
    assert_eq!(share(&cases, "named: truth in the set"), (2, 2));
    assert_eq!(number(&cases, "mean size of the set, recommended runs"), (2.0, 2));
    assert_eq!(metric(&cases, "mean size of the set, recommended runs").outcome(), Outcome::Missed);
}

#[test]
fn only_effects_above_the_floor_have_to_be_named() {
    let mut weak = silent("creep");
    weak.answer.effects[0].effect_um = 2.0;
    let cases = [weak, silent("creep"), sure("creep", &["creep"]), silent("backlash")];
    // Noise of 1 um: 2 um are too little, play has a metric of its own.
    assert_eq!(share(&cases, "effect >= 2.5 floors, 40 dB: named"), (1, 2));
    // Sets without effect that leave 3 um raise the floor to that.
    let mut rough = silent("null");
    rough.findings.gain = Some(gain(3.0, 3.0));
    let cases = [rough, silent("creep")];
    assert_eq!(share(&cases, "effect >= 2.5 floors, 40 dB: named"), (0, 0));
    assert_eq!(metric(&cases, "effect >= 2.5 floors, 40 dB: named").outcome(), Outcome::Open);
}

#[test]
fn outside_the_library_only_confidence_is_wrong() {
    let hidden = "outside-random-jumps";
    let tentative = case(hidden, Verdict::Named, &["creep"], Confidence::Tentative);
    let mut noisy = sure(hidden, &["creep"]);
    noisy.answer.snr_db = 20.0;
    let cases = [sure(hidden, &["creep"]), tentative, silent(hidden), noisy];
    assert_eq!(share(&cases, "outside the library: confident name, 40 and 30 dB"), (1, 3));
    assert_eq!(share(&cases, "outside the library: confident name, 20 dB"), (1, 1));
    // Such a set is no single cause of the library.
    assert_eq!(share(&cases, "named: truth in the set"), (0, 0));
}

#[test]
fn missed_play_has_to_be_listed() {
    let mut listed = silent("backlash");
    listed.findings.not_observable = vec!["backlash".to_owned()];
    let cases = [listed, silent("coulomb-friction"), sure("backlash", &["coulomb-friction"])];
    assert_eq!(share(&cases, "backlash or friction: named"), (1, 3));
    assert_eq!(share(&cases, "backlash or friction missed: listed as not observable"), (1, 2));
}

#[test]
fn parameters_count_when_confident() {
    let with = |value: f64, ci95: [f64; 2], confidence| {
        let mut found = case("sensor-filter", Verdict::Named, &["sensor-filter"], confidence);
        let estimate = Estimate { value, unit: "s".to_owned(), ci95 };
        let values = BTreeMap::from([("tau".to_owned(), estimate)]);
        found.findings.parameters = BTreeMap::from([("sensor-filter".to_owned(), values)]);
        found
    };
    let cases = [
        with(2.2e-3, [2.1e-3, 2.3e-3], Confidence::Confident),
        with(2.02e-3, [1.9e-3, 2.1e-3], Confidence::Confident),
        with(9.0e-3, [8e-3, 1e-2], Confidence::Tentative),
    ];
    let (error, count) = number(&cases, "confident: median error of parameters");
    assert!((error - 0.055).abs() < 1e-9 && count == 2, "{error} of {count}");
    assert_eq!(share(&cases, "confident: 95 % intervals of parameters cover"), (1, 2));
}

#[test]
fn gains_are_measured_against_the_refit_of_the_truth() {
    let with = |after: f64, best: f64| {
        let mut found = sure("creep", &["creep"]);
        found.findings.gain = Some(gain(2.0, after));
        found.oracle = Some(gain(2.0, best));
        found
    };
    // Reductions of 0.5 and 1 of 1 and 1 um; where the truth gains nothing, nothing is compared.
    let cases = [with(1.5, 1.0), with(1.0, 1.0), with(2.0, 1.99)];
    let (ratio, count) = number(&cases, "held-out reduction over that of the true cause");
    assert!((ratio - 0.75).abs() < 1e-12 && count == 2, "{ratio} of {count}");

    let mut repeated = with(1.0, 1.0);
    repeated.replicates = vec![gain(2.0, 1.05), gain(2.0, 0.95), gain(2.0, 1.6)];
    // Reductions 1, 0.95, 1.05, 0.4: mean 0.85, intervals of +-0.1.
    assert_eq!(share(&[repeated], "95 % intervals of the gain cover its mean"), (1, 4));
}

#[test]
fn a_follow_up_has_to_leave_the_truth_alone() {
    let with = |names: &[&str]| {
        let mut found =
            case("creep", Verdict::Ambiguous, &["creep", "mains-hum"], Confidence::Tentative);
        found.findings.next_experiment = "hold-steps-100s".to_owned();
        found.follow_up = Some(sure("creep", names).findings);
        found
    };
    let mut elsewhere = with(&["creep"]);
    elsewhere.findings.next_experiment = "measure again".to_owned();
    let cases = [with(&["creep"]), with(&["mains-hum"]), with(&["creep", "mains-hum"]), elsewhere];
    assert_eq!(share(&cases, "it leaves one, the right one"), (2, 4));
    let shrunk =
        |cases: &[Case]| share(cases, "proposed experiment leaves a smaller set with the truth");
    assert_eq!(shrunk(&cases), (2, 4));
    let mut three = with(&["creep", "mains-hum"]);
    three.findings.causes.push("dielectric-heating".to_owned());
    let mut without = three.clone();
    without.follow_up = Some(sure("mains-hum", &["mains-hum", "dielectric-heating"]).findings);
    assert_eq!(shrunk(&[three, without]), (1, 2));
    assert_eq!(share(&cases, "ambiguous: the proposal is in the catalogue"), (3, 4));
}

#[test]
fn pairs_need_both_and_no_third() {
    let pair = "creep+transport-delay";
    let mut weak = sure(pair, &["creep"]);
    weak.answer.effects[1].effect_um = 1.0;
    let cases = [
        sure(pair, &["creep", "transport-delay"]),
        sure(pair, &["creep", "transport-delay", "mains-hum"]),
        sure(pair, &["creep"]),
        weak,
    ];
    assert_eq!(share(&cases, "two causes >= 2.5 floors: both found"), (2, 3));
    assert_eq!(share(&cases, "two causes: a third falsely added"), (1, 4));
}

#[test]
fn times_are_those_of_later_sets() {
    let mut slow = silent("null");
    (slow.seconds, slow.first_seconds) = (4.0, Some(70.0));
    let cases = [slow, silent("null"), silent("null")];
    assert_eq!(number(&cases, "time of a small set, median, s"), (1.0, 3));
    assert_eq!(number(&cases, "time of a small set, longest, s"), (4.0, 3));
    let first = metric(&cases, "time of the first set of a base, longest, s");
    assert_eq!(first.outcome(), Outcome::Missed);
}

#[test]
fn a_bar_is_met_at_its_value() {
    let at = |value: f64, bar| {
        let figure = Figure::Number { value, cases: 1 };
        Metric { name: String::new(), figure, bar }.outcome()
    };
    assert_eq!(at(1.5, Bar::AtMost(1.5)), Outcome::Met);
    assert_eq!(at(1.51, Bar::AtMost(1.5)), Outcome::Missed);
    assert_eq!(at(0.79, Bar::AtLeast(0.8)), Outcome::Missed);
    assert_eq!(at(0.985, Bar::Within(0.9, 0.98)), Outcome::Missed);
    assert_eq!(at(f64::NAN, Bar::AtMost(1.5)), Outcome::Missed);
}

#[test]
fn the_tables_say_what_was_found() {
    let ambiguous =
        case("creep", Verdict::Ambiguous, &["mains-hum", "creep"], Confidence::Tentative);
    let cases = [sure("creep", &["creep"]), ambiguous, silent("null"), silent("null")];
    let confusion = confusion_table(&cases);
    let row = |name: &str| confusion.lines().find(|line| line.starts_with(name)).unwrap();
    assert!(row("creep").contains("creep! 1") && row("creep").contains("mains-hum+1? 1"));
    assert!(row("null").contains("nothing 2"), "{confusion}");
    let table = metric_table(&metrics(&cases));
    let line = table.lines().find(|line| line.starts_with("null: any name")).unwrap();
    assert!(
        line.contains("0.0 %") && line.contains("0.0..84.2 %") && line.ends_with("met"),
        "{line}"
    );
}

#[test]
fn findings_are_read_from_the_published_layout() {
    let text = r#"{"verdict": "named-structure-remains", "causes": ["creep"], "confidence": "confident",
        "parameters": {"creep": {"rate_per_decade": {"value": 0.02, "unit": "1", "ci95": [0.01, 0.03]}}},
        "gain": {"heldout_rms_before": 2.0, "heldout_rms_after": 1.0, "ci95": [0.8, 1.2], "unit": "um"},
        "next_experiment": "hold-steps-100s", "not_observable": ["backlash"],
        "screen": [{"cause": "creep", "score": 9.0, "absorbed": 0.1, "most_confused_with": "mains-hum", "cosine": 0.2}]}"#;
    let findings = Findings::parse(text).unwrap();
    assert!(findings.is_confident());
    assert_eq!(findings.names(), ["creep"]);
    assert!((findings.gain.unwrap().reduction() - 1.0).abs() < 1e-12);
    assert!(Findings::parse(&text.replace("named-structure-remains", "perhaps")).is_err());
    let ambiguous = Findings::parse(&text.replace("named-structure-remains", "ambiguous")).unwrap();
    assert!(!ambiguous.is_confident());
}

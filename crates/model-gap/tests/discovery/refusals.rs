//! What speaks against a name: channels beside the output, what is left, what has no name.

use crate::toy::{
    Metered, SAMPLES, added, candidate, find, find_by, found_beside_meters, traces,
    traces_beside_meters,
};
use model_gap::discovery::{Confidence, Finding, Reason, TraceRole, Verdict};
use std::f64::consts::TAU;

#[test]
fn what_shows_around_the_chain_alone_is_not_named() {
    // a thermometer that warms while the output does nothing
    let finding = found_beside_meters(0.3, 0.0, TraceRole::Covariate, 1.0);
    assert_eq!(finding.verdict, Verdict::NothingMissing, "{:?}", finding.reasons);
    // with the agent at work the meter makes its size sharp
    let finding = found_beside_meters(0.06, 0.06, TraceRole::Covariate, 1.0);
    assert_eq!((finding.verdict, finding.causes[0].candidate), (Verdict::Named, 1));
    // in a signal of the chain itself the ramp is fitted, and refused only because nothing is gained by it
    let worse = |r: &Reason| matches!(r, Reason::Negligible { drop, .. } if *drop < 0.0);
    let is_worse = |f: &Finding| f.reasons.iter().any(worse);
    let around = found_beside_meters(0.3, 0.0, TraceRole::Covariate, 1.0);
    let within = found_beside_meters(0.3, 0.0, TraceRole::IntermediateChannel, 1.0);
    assert!(!is_worse(&around) && is_worse(&within), "{:?} {:?}", around.reasons, within.reasons);
    assert!(within.causes.is_empty() && within.confidence == Confidence::Tentative);
}

#[test]
fn what_looks_like_a_refuted_cause_has_no_name() {
    let mut candidates = [candidate("cubic"), candidate("lag")];
    candidates[0].refuted = Some("its agent reads none".into());
    let finding = find(&traces(|e, i| added(0, 0.06, e, i), 4), &candidates);
    assert_eq!((finding.verdict, finding.causes.len()), (Verdict::Unknown, 0));
    assert!(
        finding.reasons.iter().any(|r| r.to_string().contains("its agent reads none")),
        "{:?}",
        finding.reasons
    );
    // another cause keeps its name
    let finding = find(&traces(|e, i| added(1, 0.06, e, i), 4), &candidates);
    assert_eq!((finding.verdict, finding.causes[0].candidate), (Verdict::Named, 1));
}

/// A lag on the outputs that a signal of the chain, read roughly, does not show: the outputs outweigh it, and it
/// refutes the lag all the same.
#[test]
fn a_channel_within_the_chain_that_follows_the_input_refutes_what_acts_before_it() {
    let unseen = found_beside_meters(0.0, 0.06, TraceRole::IntermediateChannel, 10.0);
    assert_eq!(
        (unseen.verdict, unseen.causes.len()),
        (Verdict::Unknown, 0),
        "{:?}",
        unseen.reasons
    );
    assert!(unseen.reasons.iter().any(|r| r.to_string().contains("intermediate channels show")));
    assert_eq!(unseen.looks_like, Some(1));
    // where it shows as much as the outputs say, the name stands; what surrounds the chain says nothing of it
    for (read, role) in [(0.06, TraceRole::IntermediateChannel), (0.0, TraceRole::Covariate)] {
        let seen = found_beside_meters(read, 0.06, role, 10.0);
        assert_eq!(seen.verdict, Verdict::Named, "{read}: {:?}", seen.reasons);
    }
}

/// What is found of a strong cubic and a weaker fifth power, easily taken for each other or not.
fn strong_and_weak(confused: &'static [&'static str]) -> Finding {
    let mut candidates =
        [candidate("cubic"), candidate("lag"), candidate("other lag"), candidate("fifth power")];
    candidates[2].blocked = Some("not asked for".into());
    candidates[3].confused_with = confused;
    let truth = |e: usize, i: usize| added(1, 0.3, e, i) + added(3, 0.07, e, i);
    find(&traces(truth, 5), &candidates)
}

#[test]
fn what_is_easily_taken_for_a_cause_before_must_add_more_than_an_error_of_form() {
    let count = |finding: &Finding| finding.causes.len();
    let (plain, confused) = (strong_and_weak(&[]), strong_and_weak(&["lag"]));
    assert_eq!(
        (count(&plain), count(&confused)),
        (2, 1),
        "{:?} {:?}",
        plain.reasons,
        confused.reasons
    );
    assert!(
        confused.reasons.iter().any(|r| r.to_string().contains("errors of form")),
        "{:?} {:?}",
        confused.causes,
        confused.reasons
    );
}

/// A lag in all runs, and a line of an amplitude in the last that nothing explains.
fn lag_and_line(lag: f64, amplitude: f64) -> Finding {
    let line = |i: usize| amplitude * (TAU * 31.0 * i as f64 / SAMPLES as f64).cos();
    let truth = |e: usize, i: usize| added(1, lag, e, i) + if e == 3 { line(i) } else { 0.0 };
    find(&traces(truth, 6), &[candidate("cubic"), candidate("lag")])
}

#[test]
fn a_run_that_is_missed_beside_the_name_makes_it_tentative() {
    let (alone, beside) = (lag_and_line(0.06, 0.0), lag_and_line(0.06, 0.05));
    assert_eq!((alone.verdict, alone.confidence), (Verdict::Named, Confidence::Confident));
    assert_eq!(
        (beside.verdict, beside.confidence),
        (Verdict::NamedStructureRemains, Confidence::Tentative),
        "{:?}",
        beside.reasons
    );
    assert!(beside.reasons.iter().any(|r| matches!(r, Reason::RunsStandOut { .. })));
    // where the lag is the smaller part of what stands out, it is no answer
    let most = lag_and_line(0.0055, 0.03);
    assert_eq!(most.verdict, Verdict::Unknown, "{:?}", most.reasons);
}

#[test]
fn what_explains_one_run_alone_is_not_nothing() {
    let truth = |e: usize, i: usize| if e == 3 { added(1, 0.009, e, i) } else { 0.0 };
    let finding = find(&traces(truth, 7), &[candidate("cubic"), candidate("lag")]);
    assert_eq!(
        (finding.verdict, finding.causes.len()),
        (Verdict::Unknown, 0),
        "{:?}",
        finding.reasons
    );
    let is_of_one = |r: &Reason| matches!(r, Reason::OneRunOnly { run, .. } if run.experiment == 3);
    assert!(finding.reasons.iter().any(is_of_one), "{:?}", finding.reasons);
}

#[test]
fn what_has_no_name_is_not_called_by_one_that_does_less_well() {
    let mut candidates =
        [candidate("cubic"), candidate("lag"), candidate("cubic again"), candidate("fifth power")];
    candidates[3].decoy = Some("a spring");
    let cubic = |e: usize, i: usize| added(0, 0.06, e, i);
    let fifth = |e: usize, i: usize| added(3, 0.06, e, i);
    let found = find(&traces(fifth, 4), &candidates);
    assert_eq!(
        (found.verdict, found.looks_like),
        (Verdict::Unknown, Some(3)),
        "{:?}",
        found.reasons
    );
    assert!(
        found.reasons.iter().any(|r| r.to_string().contains("it would be a spring")),
        "{:?}",
        found.reasons
    );
    // what it is not keeps its name; what explains the same but for a parameter has it, tentatively
    candidates[2].blocked = Some("not asked for".into());
    let found = find(&traces(cubic, 4), &candidates);
    assert_eq!(
        (found.verdict, found.causes[0].candidate),
        (Verdict::Named, 0),
        "{:?}",
        found.reasons
    );
    candidates[2].blocked = None;
    candidates[2].decoy = Some("a spring");
    let found = find(&traces(cubic, 4), &candidates);
    assert_eq!((found.confidence, found.causes[0].candidate), (Confidence::Tentative, 0));
    let names: Vec<usize> =
        found.causes[0].alternatives.iter().map(|other| other.candidate).collect();
    assert!(names.is_empty(), "what has no name is no alternative: {names:?}");
}

/// A fifth power that meters do not show, as what has no name would on them: it is not that, and the cubic that is
/// like it is asked.
#[test]
fn what_has_no_name_and_is_not_there_stands_in_nobodys_way() {
    let mut candidates =
        [candidate("cubic"), candidate("lag"), candidate("cubic again"), candidate("fifth power")];
    candidates[2].blocked = Some("not asked for".into());
    candidates[3].decoy = Some("a spring");
    let found = |ramp_read: f64| {
        let fifth = |e: usize, i: usize| added(3, 0.06, e, i);
        let traces = traces_beside_meters(fifth, ramp_read, TraceRole::IntermediateChannel, 10.0);
        find_by(&Metered, &traces, &candidates)
    };
    let (unseen, seen) = (found(0.0), found(0.06));
    let first = |finding: &Finding| finding.causes.first().map(|cause| cause.candidate);
    assert_eq!((first(&unseen), unseen.looks_like), (Some(0), None), "{:?}", unseen.reasons);
    assert_eq!((first(&seen), seen.looks_like), (None, Some(3)), "{:?}", seen.reasons);
}

//! What does not change the physics does not change the verdict: order, names, cutting, repeating, zero, unit, sampling and
//! sign of the records.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::everyday::bench;
use everyday_bench::family::Family;
use everyday_bench::hidden::Deal;
use everyday_bench::set::{Request, set};
use everyday_bench::text::{Column, File};
use rayon::prelude::*;
use sim_driver::diagnose::{Findings, Question, Record, Records, diagnose};

/// The records of a folder without the longest run by far, which neither set needs.
fn records(files: &[File]) -> Records {
    let mut records = Records::from(&bench(files));
    records.runs.retain(|run| run.id != "warm_up");
    records
}

/// A change of the runs of a folder.
type Change = fn(&mut Vec<Record>);

fn every_output(runs: &mut [Record], change: impl Fn(f64) -> f64) {
    runs.iter_mut().flat_map(|run| &mut run.output).for_each(|y| *y = change(*y));
}

/// The second half of a run, as a record of its own.
fn cut(run: &mut Record) -> Record {
    let half = run.output.len() / 2;
    let mut second = run.clone();
    second.id += "_second";
    let Record { input, output, amplifier, .. } = &mut *run;
    for own in [input, output].into_iter().chain(amplifier) {
        own.truncate(half);
    }
    let Record { input, output, amplifier, .. } = &mut second;
    for own in [input, output].into_iter().chain(amplifier) {
        own.drain(..half);
    }
    (run.window, second.window) = (0..run.output.len(), 0..second.output.len());
    second
}

/// Twice the samples, those in between on straight lines.
fn doubled(runs: &mut [Record]) {
    let fine = |own: &mut Vec<f64>| {
        let ends = own.windows(2).flat_map(|w| [w[0], w[0].midpoint(w[1])]);
        *own = ends.chain(own.last().copied()).collect();
    };
    for run in runs {
        fine(&mut run.input);
        fine(&mut run.output);
        run.amplifier.iter_mut().for_each(fine);
        (run.step_s, run.window) = (run.step_s / 2.0, 0..run.output.len());
    }
}

const CHANGES: [(&str, Change); 8] = [
    ("the order of the runs", |runs| runs.reverse()),
    ("their names", |runs| {
        for (number, run) in runs.iter_mut().enumerate() {
            run.id = format!("laser_preload_{number}");
        }
    }),
    ("a run given twice", |runs| {
        let again = Record { id: "again".into(), ..runs[1].clone() };
        runs.push(again);
    }),
    ("an offset", |runs| every_output(runs, |y| y + 1000.0)),
    ("a channel that says nothing", |runs| {
        for run in runs {
            run.temperature = Some(vec![21.0; run.output.len()]);
        }
    }),
    ("half the samples", |runs| {
        for run in runs {
            let half = |own: &Vec<f64>| own.iter().copied().step_by(2).collect();
            (run.input, run.output) = (half(&run.input), half(&run.output));
            run.amplifier = run.amplifier.as_ref().map(half);
            (run.step_s, run.window) = (2.0 * run.step_s, 0..run.output.len());
        }
    }),
    ("twice the samples, on straight lines", |runs| doubled(runs)),
    ("the sign of output and gain", |runs| every_output(runs, |y| -y)),
];

/// Verdict, confidence, class, causes in any order.
fn said(found: &Findings) -> String {
    let mut causes = found.causes.clone();
    causes.sort();
    let Findings { verdict, confidence, class, class_confidence, .. } = found;
    format!("{verdict:?} {confidence:?} {class:?} {class_confidence:?} {causes:?}")
}

/// Parameters that have moved by more than a tenth of their interval.
fn moved(plain: &Findings, changed: &Findings) -> Vec<String> {
    let mut all = Vec::new();
    for (cause, parameters) in &plain.parameters {
        for (name, own) in parameters {
            let now = changed.parameters[cause][name].value;
            if (now - own.value).abs() > 0.1 * (own.ci95[1] - own.ci95[0]) {
                all.push(format!("{cause}.{name}: {} was {}", now, own.value));
            }
        }
    }
    all
}

/// One set with nothing hidden and one with a limit of the voltage.
const SETS: [(Family, u64, Deal); 2] =
    [(Family::Relays, 12_206, Deal::Nulls), (Family::Duhem, 12_013, Deal::Singles)];

/// What is found of runs beside reference runs.
fn found(measured: &Records, reference: Vec<Record>) -> Findings {
    let question = Question { reference, ..Question::default() };
    Findings::from(&diagnose(measured, &question).unwrap())
}

#[test]
fn what_changes_no_physics_changes_no_verdict() {
    for (family, seed, deal) in SETS {
        let made = set(&Request::new(family, seed, deal));
        let (measured, reference) = (records(&made.measured), records(&made.reference).runs);
        let plain = found(&measured, reference.clone());
        CHANGES.par_iter().for_each(|(what, change)| {
            let (mut measured, mut reference) = (measured.clone(), reference.clone());
            change(&mut measured.runs);
            change(&mut reference);
            let changed = found(&measured, reference);
            let name = format!("{}: {what}", made.answer.hidden);
            assert_eq!(said(&changed), said(&plain), "{name}");
            assert!(moved(&plain, &changed).is_empty(), "{name}: {:?}", moved(&plain, &changed));
        });
    }
}

/// Output in mm or nm, input in mV, each with the accuracy in the same unit.
#[test]
fn the_unit_of_a_channel_changes_no_verdict() {
    for (family, seed, deal) in SETS {
        let made = set(&Request::new(family, seed, deal));
        let (measured, reference) = (records(&made.measured), records(&made.reference).runs);
        let plain = found(&measured, reference.clone());
        [(1e-3, 1.0), (1e3, 1.0), (1.0, 1e3)].par_iter().for_each(|&(output, input)| {
            let in_unit = |runs: &mut Vec<Record>| {
                every_output(runs, |y| output * y);
                for run in runs {
                    let volts = run.input.iter_mut().chain(run.amplifier.iter_mut().flatten());
                    volts.for_each(|u| *u *= input);
                }
            };
            let (mut measured, mut reference) = (measured.clone(), reference.clone());
            in_unit(&mut measured.runs);
            in_unit(&mut reference);
            measured.range = (input * measured.range.0, input * measured.range.1);
            measured.accuracy.displacement.zero_um *= output;
            measured.accuracy.amplifier.zero_volt *= input;
            measured.accuracy.monitor.zero_volt *= input;
            let mut changed = found(&measured, reference);
            for own in changed.parameters.values_mut().flat_map(|own| own.values_mut()) {
                let unit = match &*own.unit {
                    "um" => output,
                    "V" => input,
                    "1" => 1.0,
                    other => panic!("{other} is no unit of these sets"),
                };
                own.value /= unit;
            }
            let name = format!("{}: {output} um, {input} V", made.answer.hidden);
            assert_eq!(said(&changed), said(&plain), "{name}");
            assert!(moved(&plain, &changed).is_empty(), "{name}: {:?}", moved(&plain, &changed));
        });
    }
}

/// Halves of a record know what came before, though less is sure of them.
#[test]
fn measured_runs_that_were_cut_in_two_have_the_verdict_of_the_whole() {
    SETS.par_iter().for_each(|&(family, seed, deal)| {
        let made = set(&Request::new(family, seed, deal));
        let (mut measured, reference) = (records(&made.measured), records(&made.reference).runs);
        let plain = found(&measured, reference.clone());
        let second: Vec<Record> = measured.runs.iter_mut().map(cut).collect();
        measured.runs.extend(second);
        let halves = found(&measured, reference);
        assert_eq!((halves.verdict, &halves.causes), (plain.verdict, &plain.causes));
        assert!(moved(&plain, &halves).is_empty(), "{:?}", moved(&plain, &halves));
    });
}

/// A bench a thousand times slower shows the same lag, a thousand times longer.
#[test]
fn a_slow_bench_shows_the_lag_of_a_fast_one() {
    let request = Request::new(Family::Relays, 12_100, Deal::Singles);
    let made = set(&Request {
        hidden: "electrical-lag".parse().unwrap(),
        columns: vec![Column::Amplifier],
        ..request
    });
    let (measured, reference) = (records(&made.measured), records(&made.reference).runs);
    let fast = found(&measured, reference.clone());
    assert_eq!(fast.class_confidence.map(|sure| format!("{sure:?}")), Some("Confident".into()));
    let slowed = |mut runs: Vec<Record>| {
        for run in &mut runs {
            run.step_s *= 1000.0;
        }
        runs
    };
    let runs = slowed(measured.runs.clone());
    let slow = found(&Records { runs, ..measured }, slowed(reference));
    let leading = |found: &Findings| (found.class, found.causes.first().cloned());
    assert_eq!(leading(&slow), leading(&fast));
    let tau = |found: &Findings| found.parameters["electrical-lag"]["tau"].clone();
    let (slow, fast) = (tau(&slow), tau(&fast));
    let width = fast.ci95[1] - fast.ci95[0];
    assert!((slow.value / 1000.0 - fast.value).abs() < 0.1 * width, "{slow:?} {fast:?}");
}

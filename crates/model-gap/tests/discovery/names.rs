//! Which names are given, and how surely.

use crate::toy::{
    EXPERIMENTS, NOISE, SAMPLES, Toy, added, candidate, find, find_beside, find_by, input, traces,
};
use model_gap::discovery::{
    BandLeft, Confidence, Discovery, Finding, Reason, Settings, Signal, Simulator, Trace, Verdict,
    separations,
};
use model_gap::{Candidate, Class, Effect, GapError, Scale, Spectrum};
use nalgebra::DMatrix;
use std::f64::consts::TAU;

#[test]
fn nothing_missing_is_said_of_noise_alone() {
    let candidates = [candidate("cubic"), candidate("lag")];
    for seed in 1..40 {
        let finding = find(&traces(|_, _| 0.0, seed), &candidates);
        assert_eq!(finding.verdict, Verdict::NothingMissing, "seed {seed}: {:?}", finding.reasons);
        assert!(finding.causes.is_empty());
    }
}

#[test]
fn a_single_cause_is_named_with_its_parameter_and_gain() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let mut inside = 0;
    for seed in 1..41 {
        let finding = find(&traces(|e, i| added(1, 0.06, e, i), seed), &candidates);
        assert_eq!(finding.verdict, Verdict::Named, "seed {seed}: {:?}", finding.reasons);
        assert_eq!(finding.confidence, Confidence::Confident);
        let found = &finding.causes[0];
        assert_eq!((found.candidate, found.alternatives.len()), (1, 0));
        let size = found.parameters[0];
        assert!((size.value - 0.06).abs() < 0.012, "{size:?}");
        inside += i32::from((size.ci95[0]..=size.ci95[1]).contains(&0.06));
        // the noise is all that is left where the cause was fitted without the run
        assert!((finding.gain.unwrap().rms_after / NOISE - 1.0).abs() < 0.1, "{:?}", finding.gain);
        let gain = finding.gain.unwrap();
        assert!(gain.drop_ci95[0] < gain.rms_before - gain.rms_after);
    }
    assert!(inside >= 34, "{inside} of 40 intervals hold the truth");
}

#[test]
fn the_interval_of_the_gain_holds_what_other_noise_gives_and_hardly_more() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let gains: Vec<_> = (1..61)
        .filter_map(|seed| find(&traces(|e, i| added(1, 0.06, e, i), seed), &candidates).gain)
        .collect();
    let drop = |gain: &model_gap::discovery::Gain| gain.rms_before - gain.rms_after;
    let count = gains.len() as f64;
    let mean = gains.iter().map(drop).sum::<f64>() / count;
    let spread = (gains.iter().map(|g| (drop(g) - mean).powi(2)).sum::<f64>() / count).sqrt();
    let holds = |interval: [f64; 2]| (interval[0]..=interval[1]).contains(&mean);
    let covered = gains.iter().filter(|gain| holds(gain.drop_ci95)).count();
    assert!((52..=60).contains(&covered), "{covered} of 60");
    let half = gains.iter().map(|g| 0.5 * (g.drop_ci95[1] - g.drop_ci95[0])).sum::<f64>() / count;
    assert!((0.75..1.35).contains(&(half / (1.96 * spread))), "{half} for {spread}");
    // other experiments differ more than the noise does
    let wide = |g: &model_gap::discovery::Gain| g.drop_elsewhere_ci95[1] - g.drop_elsewhere_ci95[0];
    assert!(gains.iter().all(|g| wide(g) > 2.0 * half));
}

/// Samples weigh by the structure of the base model, ten times the noise, which is slower than the second line. What is
/// faster is judged by the noise alone.
#[test]
fn a_fast_effect_is_judged_by_the_errors_at_its_frequency() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let found = |spectrum: &Spectrum| {
        let mut all = traces(|e, i| added(1, 0.015, e, i), 5);
        for trace in &mut all {
            (trace.sigma, trace.spectrum) = (10.0 * NOISE, spectrum.clone());
        }
        find(&all, &candidates)
    };
    let slow = |k: usize| if k < 2 { 1.0 } else { 0.01 };
    let coloured = found(&Spectrum::new((0..SAMPLES).map(slow).collect()));
    assert_eq!((coloured.verdict, coloured.causes[0].candidate), (Verdict::Named, 1));
    let white = found(&Spectrum::default());
    assert!(white.causes.is_empty(), "{:?}", white.causes);
}

/// A line of 0.85 standard deviations of the noise is lost in the energy of a run, and stands out of its band.
#[test]
fn what_a_name_leaves_in_one_band_keeps_it_from_being_sure() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let mut told_before = 0;
    for seed in 1..21 {
        let found = |line: f64| {
            let wave = |i: usize| (TAU * 6.0 * i as f64 / SAMPLES as f64).cos();
            find(&traces(|e, i| added(1, 0.06, e, i) + line * NOISE * wave(i), seed), &candidates)
        };
        let plain = found(0.0);
        assert!(plain.bands_left.is_empty(), "seed {seed}: {:?}", plain.bands_left);
        assert_eq!(plain.confidence, Confidence::Confident);
        let lined = found(0.85);
        assert_eq!(lined.verdict, Verdict::NamedStructureRemains, "seed {seed}");
        assert_eq!(lined.causes[0].candidate, 1);
        // 6 cycles in 4 s
        let is_there = |b: &BandLeft| b.low_hz < 1.5 && 1.5 < b.high_hz && b.coherence < 0.5;
        assert!(lined.bands_left.iter().any(is_there), "seed {seed}: {:?}", lined.bands_left);
        assert!(lined.reasons.iter().any(|r| matches!(r, Reason::BandsLeft { .. })));
        let of_run =
            |r: &Reason| matches!(r, Reason::RunsStandOut { .. } | Reason::StructureLeft { .. });
        told_before += usize::from(lined.reasons.iter().any(of_run));
    }
    assert!(told_before < 10, "the whole run tells it in {told_before} of 20 draws already");
}

#[test]
fn two_names_for_one_effect_are_ambiguous() {
    let candidates = [candidate("cubic"), candidate("lag"), candidate("cubic-twin")];
    let finding = find(&traces(|e, i| added(0, 0.06, e, i), 5), &candidates);
    assert_eq!(finding.verdict, Verdict::Ambiguous);
    let mut set = vec![finding.causes[0].candidate];
    set.extend(finding.causes[0].alternatives.iter().map(|a| a.candidate));
    set.sort_unstable();
    assert_eq!(set, [0, 2]);
    assert!(finding.screen[0].most_confused.is_some_and(|(c, cosine)| c == 2 && cosine > 0.999));
}

#[test]
fn two_causes_are_both_found_and_no_third() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let truth = |e, i| added(0, 0.07, e, i) + added(1, -0.08, e, i);
    let finding = find(&traces(truth, 9), &candidates);
    let mut found: Vec<usize> = finding.causes.iter().map(|c| c.candidate).collect();
    found.sort_unstable();
    assert_eq!(found, [0, 1], "{:?}", finding.reasons);
}

#[test]
fn what_no_candidate_explains_gets_no_name() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let finding = find(&traces(|e, i| 0.05 * input(e, i).powi(4), 3), &candidates);
    assert_eq!(finding.verdict, Verdict::Unknown, "{:?}", finding.reasons);
    assert_eq!(finding.confidence, Confidence::Tentative);
}

#[test]
fn a_parameter_that_drifts_from_run_to_run_is_no_confident_name() {
    let candidates = [candidate("lag-free"), candidate("lag")];
    let truth = |e: usize, i| added(1, [0.02, 0.03, 0.06, 0.2][e], e, i);
    let finding = find(&traces(truth, 4), &candidates);
    assert_ne!(finding.confidence, Confidence::Confident, "{:?}", finding.reasons);
    assert!(
        finding
            .reasons
            .iter()
            .any(|r| matches!(r, Reason::Drifts { .. } | Reason::LostHeldOut { .. })),
        "{:?}",
        finding.reasons
    );
}

#[test]
fn what_surrogates_leave_is_no_cause() {
    // the same cubic in the data and in what surrogates with nothing missing leave
    let candidates = [candidate("cubic"), candidate("lag")];
    let traces = traces(|e, i| added(0, 0.06, e, i), 6);
    let structure: Signal =
        (0..EXPERIMENTS).map(|e| (0..SAMPLES).map(|i| added(0, 0.06, e, i)).collect()).collect();
    let finding = find_beside(&traces, &candidates, &[structure]);
    assert!(finding.causes.is_empty(), "{:?}", finding.causes);
}

#[test]
fn what_surrogates_could_do_to_a_difference_keeps_another_cause_open() {
    // distinguished if the base model is exact, not for sure if a surrogate leaves what lies between the two
    let mut candidates = ["cubic", "lag", "cubic-twin", "fifth"].map(candidate);
    candidates[2].blocked = Some("no".into());
    let traces = traces(|e, i| added(0, 0.06, e, i), 6);
    let named = |structures: &[Signal]| {
        let finding = find_beside(&traces, &candidates, structures);
        let first = finding.causes.first().map(|c| (c.candidate, c.alternatives.clone()));
        let open = finding.causes.first().map_or(0, |c| c.rivals.len() - 1);
        (finding.verdict, finding.confidence, open, first)
    };
    let structure = |share: f64| -> Vec<Signal> {
        let between = |e, i| share * (added(0, 0.06, e, i) - added(3, 0.04, e, i));
        vec![(0..EXPERIMENTS).map(|e| (0..SAMPLES).map(|i| between(e, i)).collect()).collect()]
    };
    let alone = || Some((0, vec![]));
    assert_eq!(named(&[]), (Verdict::Named, Confidence::Confident, 0, alone()));
    assert_eq!(named(&structure(0.2)), (Verdict::Named, Confidence::Tentative, 1, alone()));
}

/// Structure of the base model that leans from the true cause beyond the other: the better of both leaves as much
/// along their difference as they differ by, so that its lead says little.
#[test]
fn what_the_better_of_two_leaves_between_them_keeps_the_other_in_the_set() {
    let mut candidates = ["cubic", "lag", "cubic-twin", "fifth"].map(candidate);
    candidates[2].blocked = Some("no".into());
    // no second cause of the other sign may take the structure's place
    candidates[3].parameters[0].low = 0.0;
    candidates[3].starts = vec![vec![0.05]];
    let surrogate: Signal = vec![vec![0.0; SAMPLES]; EXPERIMENTS];
    let alternatives = |share: f64, structures: &[Signal]| -> Vec<usize> {
        let between = move |e, i| share * (added(0, 0.06, e, i) - added(3, 0.04, e, i));
        let traces = traces(move |e, i| added(0, 0.06, e, i) + between(e, i), 6);
        let finding = find_beside(&traces, &candidates, structures);
        let first = finding.causes.first();
        assert_eq!(first.map(|f| f.candidate), Some(0), "{share}: {:?}", finding.reasons);
        first.map_or_else(Vec::new, |f| f.alternatives.iter().map(|a| a.candidate).collect())
    };
    let granted = std::slice::from_ref(&surrogate);
    assert!(alternatives(0.0, granted).is_empty());
    assert_eq!(alternatives(0.45, granted), [3]);
    // a base model that is assumed exact leaves nothing
    assert!(alternatives(0.45, &[]).is_empty());
}

/// What a fit parts is one set where only a channel could: two gains without one that tells either.
#[test]
fn gains_and_lags_that_no_channel_tells_are_one_set() {
    let alternatives = |class, is_told| -> Vec<usize> {
        let mut candidates = ["cubic", "lag", "cubic-twin", "fifth"].map(candidate);
        candidates[2].blocked = Some("no".into());
        for own in &mut candidates {
            own.class = class;
        }
        candidates[3].is_told = is_told;
        let finding = find_beside(&traces(|e, i| added(0, 0.06, e, i), 6), &candidates, &[]);
        finding.causes[0].alternatives.iter().map(|a| a.candidate).collect()
    };
    assert_eq!(alternatives(Class::StaticGain, false), [3]);
    assert_eq!(alternatives(Class::Lag, false), [3]);
    assert!(alternatives(Class::LagBehindTerminals, false).is_empty());
    assert!(alternatives(Class::StaticGain, true).is_empty());
    assert!(alternatives(Class::Other, false).is_empty());
}

/// A lag whose range begins just below its value: from how far its interval reaches, it may be anything less.
#[test]
fn a_scale_that_is_open_to_one_end_of_its_range_makes_a_name_tentative() {
    let mut candidates = [candidate("lag-free"), candidate("lag")];
    let traces = traces(|e, i| added(1, 0.06, e, i), 4);
    let found = find(&traces, &candidates);
    let interval = found.causes[0].parameters[0].ci95;
    candidates[1].parameters[0].low = 0.999 * interval[0];
    let named = |scale, candidates: &mut [Candidate; 2]| {
        candidates[1].parameters[0].scale = scale;
        let found = find(&traces, candidates);
        (found.causes[0].candidate, found.confidence)
    };
    assert_eq!(named(Scale::Linear, &mut candidates), (1, Confidence::Confident));
    assert_eq!(named(Scale::Log, &mut candidates), (1, Confidence::Tentative));
}

#[test]
fn a_cause_none_of_whose_parameters_is_known_is_tentative() {
    // surrogates leave the effect itself, in half the size of what the data show: it is past the floor, but one
    // surrogate says so little of their spread that the size may be none
    let traces = traces(|e, i| added(0, 0.06, e, i), 5);
    let left: Signal =
        (0..EXPERIMENTS).map(|e| (0..SAMPLES).map(|i| added(0, 0.03, e, i)).collect()).collect();
    let candidates = [candidate("cubic")];
    let finding = find_beside(&traces, &candidates, std::slice::from_ref(&left));
    assert_eq!(finding.confidence, Confidence::Tentative, "{:?}", finding.reasons);
    let said =
        |finding: &Finding| finding.reasons.contains(&Reason::Undetermined { cause: "cubic" });
    assert!(said(&finding), "{:?}", finding.reasons);
    // a value that may be zero without the effect being none, as a threshold, is known
    let mut place = candidate("cubic");
    place.parameters[0].is_amount = false;
    assert!(!said(&find_beside(&traces, &[place], std::slice::from_ref(&left))));
}

#[test]
fn without_reference_runs_nothing_is_confident() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let traces = traces(|e, i| added(1, 0.06, e, i), 2);
    let settings = Settings { has_reference: false, ..Settings::default() };
    let discovery = Discovery { settings, ..Discovery::new(&traces, &Toy, &candidates) };
    assert_eq!(discovery.find().unwrap().confidence, Confidence::Tentative);
}

#[test]
fn a_blocked_candidate_is_never_named() {
    let mut candidates = [candidate("cubic"), candidate("lag")];
    candidates[1].blocked = Some("no".into());
    let finding = find(&traces(|e, i| added(1, 0.06, e, i), 2), &candidates);
    assert!(finding.causes.iter().all(|c| c.candidate != 1));
}

#[test]
fn a_weak_parameter_may_differ_from_run_to_run_where_that_costs_little() {
    // a strong cubic, steady, and a weak lag whose size differs by a third between runs: what values of
    // its own for every run would gain is a small part of what both explain
    let candidates = [candidate("cubic"), candidate("lag")];
    let weak = [0.10, 0.16, 0.10, 0.16];
    let truth = |e: usize, i| added(0, 1.5, e, i) + added(1, weak[e], e, i);
    let finding = find(&traces(truth, 8), &candidates);
    let mut found: Vec<usize> = finding.causes.iter().map(|c| c.candidate).collect();
    found.sort_unstable();
    assert_eq!(found, [0, 1], "{:?}", finding.reasons);
    // the same differences alone speak against the name
    let alone = find(&traces(|e: usize, i| added(1, 3.0 * (weak[e] - 0.09), e, i), 8), &candidates);
    assert!(
        alone
            .reasons
            .iter()
            .any(|r| matches!(r, Reason::Drifts { .. } | Reason::LostHeldOut { .. })),
        "{:?}",
        alone.reasons
    );
}

#[test]
fn one_run_far_out_is_not_lost_among_the_others() {
    // a line that no cause and no generic direction explains, in one run of four
    let line = |e: usize, i: usize| {
        if e == 2 { 0.05 * (TAU * 31.0 * i as f64 / SAMPLES as f64).cos() } else { 0.0 }
    };
    let finding = find(&traces(line, 6), &[candidate("cubic"), candidate("lag")]);
    let out: Vec<usize> = finding.standing_out.iter().map(|run| run.experiment).collect();
    assert_eq!((finding.verdict, out), (Verdict::Unknown, vec![2]), "{:?}", finding.reasons);
    assert!((finding.standing_out[0].times > 2.0), "{:?}", finding.standing_out);
}

/// Four traces of the toy whose base may move the level of each run and the gain of all by much.
fn loose_traces(truth: impl Fn(usize, usize) -> f64, seed: u64) -> Vec<Trace> {
    let mut all = traces(truth, seed);
    for (e, trace) in all.iter_mut().enumerate() {
        trace.nuisance = DMatrix::from_fn(SAMPLES, 2, |i, k| {
            if k == 0 { 0.1 * input(e, i) } else { 0.1 * input(e, i).powi(3) }
        });
    }
    all
}

#[test]
fn the_run_that_the_base_model_moved_to_meet_is_the_one_that_stands_out() {
    // the largest run alone has a gain of its own: the base model follows it and misses the three others
    let one = |e: usize, i: usize| if e == 2 { 0.3 * input(e, i) } else { 0.0 };
    let traces = loose_traces(one, 8);
    let finding = find(&traces, &[candidate("fifth power")]);
    let out: Vec<usize> = finding.standing_out.iter().map(|run| run.experiment).collect();
    assert_eq!(out, [2], "{:?}", finding.standing_out);
    // a gain that all share is no run's own
    let finding = find(&loose_traces(|e, i| 0.3 * input(e, i), 8), &[candidate("fifth power")]);
    assert!(finding.standing_out.is_empty(), "{:?}", finding.standing_out);
}

/// What is found where these trends are judged, beside many generic directions that surrogates fill.
fn found_with_trends(drift: f64, trends: &[Signal]) -> Finding {
    let slow = |i: usize| i as f64 / SAMPLES as f64 - 0.5;
    let traces = traces(|_, i| drift * slow(i), 11);
    let generic: Vec<Signal> = (2..6)
        .map(|power| {
            (0..EXPERIMENTS)
                .map(|e| (0..SAMPLES).map(|i| input(e, i).powi(power)).collect())
                .collect()
        })
        .chain(std::iter::once(vec![(0..SAMPLES).map(slow).collect(); EXPERIMENTS]))
        .collect();
    // a surrogate leaves a square, eight times the noise and more than any drift here
    let left: Signal = (0..EXPERIMENTS)
        .map(|e| (0..SAMPLES).map(|i| 8.0 * NOISE * input(e, i).powi(2)).collect())
        .collect();
    let candidates = [candidate("cubic"), candidate("lag")];
    let discovery = Discovery {
        generic: &generic,
        trends,
        structures: &[left],
        settings: Settings { resamplings: 200, ..Settings::default() },
        ..Discovery::new(&traces, &Toy, &candidates)
    };
    discovery.find().unwrap()
}

#[test]
fn a_zero_that_wanders_in_all_runs_alike_is_not_nothing() {
    let slow = |i: usize| i as f64 / SAMPLES as f64 - 0.5;
    let trends = [vec![(0..SAMPLES).map(slow).collect(); EXPERIMENTS]];
    let finding = found_with_trends(1.5 * NOISE, &trends);
    assert_eq!(finding.verdict, Verdict::Unknown, "{:?}", finding.reasons);
    assert!(
        finding.reasons.iter().any(|r| matches!(r, Reason::ChangesSlowly { .. })),
        "{:?}",
        finding.reasons
    );
    // among all generic directions it is lost
    assert_eq!(found_with_trends(1.5 * NOISE, &[]).verdict, Verdict::NothingMissing);
    // and where nothing wanders, nothing is missing
    assert_eq!(found_with_trends(0.0, &trends).verdict, Verdict::NothingMissing);
}

/// A line of one frequency whose phase is fitted in every experiment.
struct Humming {
    traces: Vec<Trace>,
    adapts: bool,
}

fn line(amplitude: f64, residual: &[f64]) -> Vec<f64> {
    let angle = |i: usize| TAU * 31.0 * i as f64 / SAMPLES as f64;
    let sum =
        |f: fn(f64) -> f64| residual.iter().enumerate().map(|(i, r)| r * f(angle(i))).sum::<f64>();
    let (c, s) = (sum(f64::cos), sum(f64::sin));
    let size = c.hypot(s).max(1e-300);
    (0..residual.len())
        .map(|i| amplitude * (c * angle(i).cos() + s * angle(i).sin()) / size)
        .collect()
}

impl Simulator for Humming {
    fn predict(&self, effects: &[Effect]) -> Result<Vec<Vec<f64>>, GapError> {
        let one = |(e, trace): (usize, &Trace)| {
            let base: Vec<f64> = (0..SAMPLES).map(|i| input(e, i)).collect();
            let left: Vec<f64> = trace.measured.iter().zip(&base).map(|(a, b)| a - b).collect();
            let amplitude: f64 = effects.iter().map(|x| x.values[0]).sum();
            base.iter().zip(line(amplitude, &left)).map(|(a, b)| a + b).collect()
        };
        Ok(self.traces.iter().enumerate().map(one).collect())
    }

    fn adapted(&self, effect: &Effect, residual: &Signal) -> Result<Option<Signal>, GapError> {
        let own = || residual.iter().map(|r| line(effect.values[0], r)).collect();
        Ok(self.adapts.then(own))
    }
}

#[test]
fn an_effect_that_adapts_may_adapt_to_surrogates_too() {
    // the surrogate holds the line with another phase than the data in every run
    let structure: Signal = (0..EXPERIMENTS)
        .map(|e| {
            let phase = |i: usize| TAU * 31.0 * i as f64 / SAMPLES as f64 + 1.6 * e as f64;
            (0..SAMPLES).map(|i| 0.05 * phase(i).sin()).collect()
        })
        .collect();
    let hum = |_: usize, i: usize| 0.05 * (TAU * 31.0 * i as f64 / SAMPLES as f64).cos();
    let threshold = |adapts: bool| {
        let traces = traces(hum, 7);
        let simulator = Humming { traces: traces.clone(), adapts };
        let candidates = [candidate("hum")];
        let structures = std::slice::from_ref(&structure);
        let discovery =
            Discovery { structures, ..Discovery::new(&traces, &simulator, &candidates) };
        let finding = discovery.find().unwrap();
        (finding.screen[0].threshold, finding.causes.len())
    };
    let (with, named) = threshold(true);
    let (without, named_without) = threshold(false);
    // a surrogate of the same size as the data forbids the name only if the line may turn to it
    assert!(with > 3.0 * without, "{with} {without}");
    assert_eq!((named, named_without), (0, 1));
}

#[test]
fn an_experiment_parts_what_differs_and_not_what_is_the_same() {
    let candidates = [candidate("cubic"), candidate("lag"), candidate("cubic-twin")];
    let truth = traces(|e, i| added(0, 0.06, e, i), 5);
    let finding = find(&truth, &candidates);
    let rivals = &finding.causes[0].rivals;
    assert_eq!(rivals.len(), 2);
    // the same runs once more part the twins by nothing
    let found = separations(&Toy, &truth, &candidates, rivals).unwrap();
    assert!(found.distance.iter().all(|d| *d < 1e-6), "{}", found.distance);
    assert!(found.energy.iter().all(|e| *e > 100.0), "{:?}", found.energy);
    // a lag in the place of the twin is parted from the cubic, both ways, by less than it adds
    let other = find(&traces(|e, i| added(1, 0.06, e, i), 5), &candidates);
    let apart = [rivals[0].clone(), other.causes[0].rivals[0].clone()];
    let found = separations(&Toy, &truth, &candidates, &apart).unwrap();
    for (a, b) in [(0, 1), (1, 0)] {
        let distance = found.distance[(a, b)];
        assert!(distance > 50.0, "{}", found.distance);
        assert!(
            distance
                < found.energy[0]
                    + found.energy[1]
                    + 2.0 * (found.energy[0] * found.energy[1]).sqrt()
        );
    }
}

/// A cubic whose size is a narrow peak over its parameter, as that of a mode is over its frequency.
struct Peaked;

fn peaked(value: f64, experiment: usize, i: usize) -> f64 {
    0.5 * (-((value - 1.0) / 0.1).powi(2)).exp() * input(experiment, i).powi(3)
}

impl Simulator for Peaked {
    fn predict(&self, effects: &[Effect]) -> Result<Vec<Vec<f64>>, GapError> {
        let sum =
            |e: usize, i: usize| effects.iter().map(|x| peaked(x.values[0], e, i)).sum::<f64>();
        let own = |e: usize| (0..SAMPLES).map(|i| input(e, i) + sum(e, i)).collect();
        Ok((0..EXPERIMENTS).map(own).collect())
    }
}

/// Two starts without any effect cost less than one that is right in form and eight times too large.
#[test]
fn a_start_that_promises_much_and_costs_more_than_none_is_tried() {
    let traces = traces(|e, i| peaked(1.146, e, i), 12);
    let mut own = candidate("peaked");
    own.starts = vec![vec![-1.0], vec![-0.5], vec![1.03]];
    own.parameters[0].is_amount = false;
    let finding = find_by(&Peaked, &traces, &[own]);
    let value = finding.causes.first().map(|cause| cause.parameters[0].value);
    assert!(value.is_some_and(|v| (v - 1.146).abs() < 0.01), "{value:?} {:?}", finding.reasons);
}

/// Four repeats of one input are one fold: nothing is held out, no gain is stated and no name is sure.
#[test]
fn without_a_held_out_experiment_no_gain_is_stated() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let traces = traces(|e, i| added(1, 0.06, e, i), 4);
    let found = |groups: &[usize]| {
        let settings = Settings { resamplings: 200, ..Settings::default() };
        let discovery =
            Discovery { groups, settings, ..Discovery::new(&traces, &Toy, &candidates) };
        discovery.find().unwrap()
    };
    let (apart, together) = (found(&[0, 1, 2, 3]), found(&[0; 4]));
    assert!(apart.gain.is_some() && apart.confidence == Confidence::Confident);
    assert!(together.gain.is_none(), "{:?}", together.gain);
    assert_eq!(together.causes.first().map(|found| found.candidate), Some(1));
    assert_eq!(together.confidence, Confidence::Tentative, "{:?}", together.reasons);
    assert!(together.reasons.iter().any(|r| matches!(r, Reason::NothingHeldOut)));
}

/// A rival whose fit stays below what its start promises may be as good as the name: here its range ends before the
/// size that the data ask for.
#[test]
fn an_unfinished_fit_of_a_rival_forbids_a_sure_name() {
    let found = |high: f64| {
        let mut candidates = [candidate("cubic"), candidate("lag"), candidate("cubic-twin")];
        candidates[2].parameters[0].high = high;
        candidates[2].starts = vec![vec![0.01]];
        candidates[2].blocked = (high == 0.0).then(|| "no".into());
        find(&traces(|e, i| added(0, 0.06, e, i), 4), &candidates)
    };
    let (alone, beside) = (found(0.0), found(0.012));
    assert_eq!(alone.confidence, Confidence::Confident, "{:?}", alone.reasons);
    assert_eq!(beside.causes[0].candidate, 0);
    assert_ne!(beside.confidence, Confidence::Confident, "{:?}", beside.reasons);
}

/// A gain that the calibration may move by hides nothing: beyond its accuracy a denial is not sure.
#[test]
fn a_calibration_that_is_off_makes_a_denial_tentative() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let found = |accuracies: f64| {
        let traces = traces(|e, i| 0.01 * accuracies * input(e, i), 4);
        let discovery = Discovery { calibrations: 1, ..Discovery::new(&traces, &Toy, &candidates) };
        discovery.find().unwrap()
    };
    for (accuracies, confidence) in [(1.0, Confidence::Confident), (3.0, Confidence::Tentative)] {
        let finding = found(accuracies);
        assert_eq!(finding.verdict, Verdict::NothingMissing, "{:?}", finding.reasons);
        assert_eq!(finding.confidence, confidence, "{accuracies}: {:?}", finding.reasons);
    }
}

/// A name that asks for a calibration far off besides is not the whole of it.
#[test]
fn a_calibration_that_is_far_off_makes_a_name_tentative() {
    let candidates = [candidate("cubic"), candidate("lag")];
    for (accuracies, confidence) in [(1.0, Confidence::Confident), (9.0, Confidence::Tentative)] {
        let traces = traces(|e, i| added(1, 0.06, e, i) + 0.01 * accuracies * input(e, i), 4);
        let discovery = Discovery { calibrations: 1, ..Discovery::new(&traces, &Toy, &candidates) };
        let finding = discovery.find().unwrap();
        assert_eq!(finding.causes[0].candidate, 1, "{:?}", finding.reasons);
        assert_eq!(finding.confidence, confidence, "{accuracies}: {:?}", finding.reasons);
        let is_said = finding.reasons.iter().any(|r| matches!(r, Reason::CalibrationOff { .. }));
        assert_eq!(is_said, confidence == Confidence::Tentative);
    }
}

/// The toy whose traces do not carry what its causes do.
struct Coarse;

impl Simulator for Coarse {
    fn predict(&self, effects: &[Effect]) -> Result<Signal, GapError> {
        Toy.predict(effects)
    }

    fn carries(&self, _effects: &[Effect], _trace: usize) -> bool {
        false
    }
}

#[test]
fn a_trace_that_does_not_carry_a_cause_does_not_speak_against_it() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let wave = |i: usize| (TAU * 6.0 * i as f64 / SAMPLES as f64).cos();
    let traces = traces(|e, i| added(1, 0.06, e, i) + 0.9 * NOISE * wave(i), 1);
    assert!(!find_by(&Toy, &traces, &candidates).bands_left.is_empty());
    assert!(find_by(&Coarse, &traces, &candidates).bands_left.is_empty());
}

/// What would have been seen is said of every cause; a common one that these data cannot show makes a denial tentative.
#[test]
fn a_denial_is_sure_only_where_common_causes_would_have_been_seen() {
    let found = |blocked: Option<String>| {
        let mut candidates = [candidate("cubic"), candidate("lag")];
        candidates[0].is_common = true;
        candidates[0].blocked = blocked;
        find_by(&Toy, &traces(|_, _| 0.0, 4), &candidates)
    };
    let (shown, hidden) = (found(None), found(Some("no".into())));
    for finding in [&shown, &hidden] {
        assert_eq!(finding.verdict, Verdict::NothingMissing, "{:?}", finding.reasons);
    }
    assert!(shown.limits[0].is_some_and(|share| share < 0.03), "{:?}", shown.limits);
    assert_eq!(shown.confidence, Confidence::Confident, "{:?}", shown.reasons);
    assert_eq!((hidden.limits[0], hidden.confidence), (None, Confidence::Tentative));
    let is_said =
        |r: &Reason| matches!(r, Reason::WouldBeMissed { causes, .. } if causes == &["cubic"]);
    assert!(hidden.reasons.iter().any(is_said), "{:?}", hidden.reasons);
}

/// An effect of a size that "would have been seen" is seen in nine of ten draws of the noise, and one of a third of it
/// is not.
#[test]
fn the_size_that_would_have_been_seen_is_seen() {
    let candidates = [candidate("cubic"), candidate("lag")];
    let limit = find_by(&Toy, &traces(|_, _| 0.0, 4), &candidates).limits[1].unwrap();
    let power = |f: &dyn Fn(usize, usize) -> f64| {
        let all = (0..EXPERIMENTS).flat_map(|e| (0..SAMPLES).map(move |i| (e, i)));
        all.map(|(e, i)| f(e, i).powi(2)).sum::<f64>()
    };
    let of_one = (power(&|e, i| added(1, 1.0, e, i)) / power(&input)).sqrt();
    let seen = |share: f64| {
        let size = share / of_one;
        (1..61)
            .filter(|&seed| {
                let traces = traces(|e, i| added(1, size, e, i), seed);
                !find_by(&Toy, &traces, &candidates).causes.is_empty()
            })
            .count()
    };
    let (at, below) = (seen(limit), seen(limit / 3.0));
    assert!(at >= 48 && below <= 6, "{at} and {below} of 60");
}

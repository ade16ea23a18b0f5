//! What to measure next: of the experiments a bench can do, the one that parts the explanations which
//! the data leave open.
//!
//! Every experiment is simulated with every explanation as fitted. It resolves a truth if every other
//! explanation, refitted within what the data at hand allow, would miss it by more than the search asks
//! of two causes to be told apart. The cheapest that rules out nearly as much as any experiment does is
//! proposed, among equals the one whose smallest distance is largest (T-optimality).

use super::catalogue::{Experiment, catalogue, is_wide};
use super::excitation::Span;
use crate::causes::{self, Design, chain_under};
use crate::record::Record;
use crate::simulator::{BenchSimulator, ChannelKind, Setting};
use measured_data::Sensor;
use model_gap::discovery::{
    Finding, Found, Rival, Separation, Verdict, needed_to_separate, separations,
};
use model_gap::{Candidate, Effect, GapError, SplitMix};
use preisach_dyn::AmplifierStage;
use rayon::prelude::*;

/// Margin on what the search asks of two causes to be discriminated: distances are straight in the parameters.
const MARGIN: f64 = 2.0;

/// A proposal.
#[derive(Debug, Clone, PartialEq)]
pub struct Proposal {
    /// Name of the experiment; of several to be done together, joined by `+`.
    pub id: String,
    /// What to do.
    pub what: String,
    /// Share of the open explanations that it would single out if true; none where nothing is open.
    pub resolves: Option<f64>,
}

/// What a proposal is worked out from.
pub(crate) struct Bench<'a> {
    pub(crate) setting: Setting<'a>,
    pub(crate) candidates: &'a [Candidate],
    pub(crate) runs: &'a [&'a Record],
    pub(crate) design: &'a Design,
}

/// The experiment that tells the remaining explanations apart best.
pub(crate) fn proposal(bench: &Bench<'_>, finding: &Finding) -> Result<Proposal, GapError> {
    let (low, high) = bench.design.input;
    let span = Span { middle: f64::midpoint(low, high), half: 0.5 * (high - low) };
    let references = &bench.setting.references;
    let catalogue = catalogue(span, bench.runs, references, bench.design.is_bench);
    let open = finding.causes.iter().max_by_key(|found| found.rivals.len());
    let Some(open) = open.filter(|found| found.rivals.len() > 1) else {
        let usual = usual(finding, bench, &catalogue);
        let (id, what) = usual.map_or(("", ""), |e| (e.id, e.what));
        return Ok(Proposal { id: id.to_owned(), what: what.to_owned(), resolves: None });
    };
    let parted: Vec<Parting> = catalogue
        .par_iter()
        .map(|experiment| parting(bench, experiment, open))
        .collect::<Result<_, _>>()?;
    let minutes: Vec<f64> = catalogue.iter().map(|own| own.minutes).collect();
    let first = choose(&parted, &minutes);
    let (id, what) = first.map_or(("", ""), |i| (catalogue[i].id, catalogue[i].what));
    Ok(Proposal {
        id: id.to_owned(),
        what: what.to_owned(),
        resolves: first.map(|i| parted[i].resolves()),
    })
}

/// Part of what the best experiment rules out that a cheaper one must.
const WORTH: f64 = 0.6;

/// The experiment to do first: the cheapest that rules out nearly as much as any does; what is still open then is asked
/// again. Among equals the one whose smallest distance is largest.
fn choose(parted: &[Parting], minutes: &[f64]) -> Option<usize> {
    let most = parted.iter().map(Parting::ruled_out).fold(0.0, f64::max);
    let is_worth = |own: &&usize| parted[**own].ruled_out() >= WORTH * most;
    let places: Vec<usize> = (0..parted.len()).collect();
    places
        .iter()
        .filter(is_worth)
        .min_by(|&&a, &&b| {
            let by_distance = || parted[b].least().total_cmp(&parted[a].least());
            minutes[a].total_cmp(&minutes[b]).then_with(by_distance)
        })
        .copied()
}

/// Distances over what is asked, `[truth][other]`; above 1 the other is ruled out.
#[derive(Debug, Clone, PartialEq)]
struct Parting(Vec<Vec<f64>>);

impl Parting {
    fn of(found: &Separation, drop: f64) -> Self {
        let count = found.energy.len();
        let ratio = |a: usize, b: usize| {
            let asked = MARGIN * needed_to_separate(drop + found.energy[a]);
            if a == b { f64::INFINITY } else { found.distance[(a, b)] / asked }
        };
        Self((0..count).map(|a| (0..count).map(|b| ratio(a, b)).collect()).collect())
    }

    /// Share of the pairs of a truth and another explanation that it tells apart.
    fn ruled_out(&self) -> f64 {
        let others = self.0.iter().enumerate().flat_map(|(a, row)| {
            row.iter().enumerate().filter(move |(b, _)| *b != a).map(|(_, ratio)| *ratio > 1.0)
        });
        let (told, all) =
            others.fold((0.0, 0.0), |(told, all), is_told| (told + f64::from(is_told), all + 1.0));
        told / f64::max(all, 1.0)
    }

    fn resolves(&self) -> f64 {
        let singled_out = self.0.iter().filter(|row| row.iter().all(|r| *r > 1.0)).count();
        singled_out as f64 / self.0.len().max(1) as f64
    }

    fn least(&self) -> f64 {
        self.0.iter().flatten().copied().fold(f64::INFINITY, f64::min)
    }
}

fn parting(bench: &Bench<'_>, experiment: &Experiment, open: &Found) -> Result<Parting, GapError> {
    let shows = |kind| experiment.shown.contains(&kind);
    let mut records: Vec<Record> = Vec::new();
    if experiment.runs.is_empty() {
        records.extend(bench.runs.iter().map(|&r| Record { load: None, ..r.clone() }));
    }
    for planned in &experiment.runs {
        records.push(undisturbed(bench, planned));
        if shows(ChannelKind::Comparison) {
            let (id, sensor) = (format!("laser_{}", planned.id), Sensor::Ideal);
            records.push(undisturbed(bench, &Record { id, sensor, ..planned.clone() }));
        }
    }
    for record in &mut records {
        if shows(ChannelKind::Amplifier) {
            record.amplifier = Some(record.input.clone());
        }
        if shows(ChannelKind::Temperature) {
            record.temperature = Some(warmth(bench, &open.rivals, record)?);
        }
    }
    let mut simulator = BenchSimulator::new(bench.setting.clone(), records.iter().collect())?;
    simulator.channels.retain(|channel| shows(channel.kind));
    let found = separations(&simulator, &simulator.traces(), bench.candidates, &open.rivals)?;
    let mut parting = Parting::of(&found, open.output_drop);
    // what no fit parts needs a channel that the experiment adds
    let design = Design::of(
        &records.iter().collect::<Vec<_>>(),
        &bench.setting.references,
        &bench.setting.accuracy,
        bench.design.is_bench,
    );
    let told = causes::candidates(bench.setting.causes, &design);
    for (a, one) in open.rivals.iter().enumerate() {
        for (b, other) in open.rivals.iter().enumerate() {
            if a != b && told[one.candidate].is_one_set_with(&told[other.candidate]) {
                parting.0[a][b] = 0.0;
            }
        }
    }
    Ok(parting)
}

/// A planned run of the base model, with its noise: that noise is what a distance is measured by.
fn undisturbed(bench: &Bench<'_>, planned: &Record) -> Record {
    // another draw for every run: two sensors on one motion do not share their noise
    let of_name =
        planned.id.bytes().fold(0, |sum: u64, b| sum.wrapping_mul(31).wrapping_add(b.into()));
    let mut noise = SplitMix(0x0F1E_2D3C ^ of_name);
    let mut output = bench.setting.base.predict(&planned.input, planned.step_s);
    for y in &mut output {
        *y += bench.setting.base.noise * noise.normal();
    }
    Record { window: 0..output.len(), output, ..planned.clone() }
}

/// The temperature that a rival expects: a thermometer shows the heat of the one that has any.
fn warmth(bench: &Bench<'_>, rivals: &[Rival], record: &Record) -> Result<Vec<f64>, GapError> {
    let is_heat = |effect: &&Effect| {
        let chain = chain_under(bench.setting.causes, std::slice::from_ref(effect));
        let stages = &chain.front.amplifier;
        stages.iter().any(|stage| matches!(stage, AmplifierStage::DielectricHeating(_)))
    };
    let Some(heat) = rivals.iter().flat_map(|r| &r.effects).find(is_heat) else {
        return Ok(vec![0.0; record.input.len()]);
    };
    let bare = Record { temperature: None, ..record.clone() };
    let simulator = BenchSimulator::new(bench.setting.clone(), vec![&bare])?;
    simulator.rise_k(heat)
}

/// What is usual where no explanations are to be told apart.
fn usual<'m>(
    finding: &Finding,
    bench: &Bench<'_>,
    catalogue: &'m [Experiment],
) -> Option<&'m Experiment> {
    let of = |id: &str| catalogue.iter().find(|experiment| experiment.id == id);
    let first = finding.causes.first().map(|found| found.candidate).or(finding.looks_like);
    let named = first.map(|candidate| &bench.candidates[candidate]);
    // what was measured already is no longer on the catalogue
    if finding.is_slow {
        return of("hold-steps-100s");
    }
    let separating = named.and_then(|cause| cause.separating.iter().find_map(|id| of(id)));
    separating.or_else(|| {
        of(if finding.verdict == Verdict::NothingMissing {
            "small-motion"
        } else if !bench.design.is_bench {
            // the catalogue's frequencies are those of a piezo bench; amplitudes are the system's own
            "amplitude-sweep"
        } else if bench.design.only_hz.is_some() {
            "frequency-sweep"
        } else if bench.runs.iter().any(|run| is_wide(run)) {
            // high frequencies were measured already: what is left to see is slow
            "hold-steps-100s"
        } else {
            "multisine-5-181Hz"
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use measured_data::Accuracy;

    const SELF: f64 = f64::INFINITY;

    #[test]
    fn every_experiment_that_a_cause_names_can_be_simulated() {
        let input: Vec<f64> = (0..400).map(|i| 80.0 * (0.1 * f64::from(i)).sin()).collect();
        let run = Record::new("a", 1e-3, input.clone(), input);
        let design = Design::of(&[&run], &[&run], &Accuracy::default(), true);
        let other = Record { input: run.input[..200].to_vec(), ..run.clone() };
        let catalogue = catalogue(Span { middle: 0.0, half: 80.0 }, &[&run], &[&other], true);
        for cause in crate::causes::candidates(&crate::causes::LIBRARY, &design) {
            assert!(!cause.separating.is_empty(), "{}", cause.id);
            for id in cause.separating {
                assert!(catalogue.iter().any(|e| e.id == *id), "{}: {id}", cause.id);
            }
        }
    }

    #[test]
    fn a_band_is_wide_and_a_fast_edge_is_not() {
        let span = Span { middle: 0.0, half: 80.0 };
        let run = |input: Vec<f64>| Record::new("a", 5e-4, input.clone(), input);
        // RMS of equal lines from 5 to 181 Hz: ((5^2 + 5 181 + 181^2) / 3)^(1/2) = 106 Hz
        let band = run(span.multisine((5.0, 181.0), 2.0, 0.35, 2.0, 5e-4));
        assert!((band.frequency_hz() - 106.0).abs() < 3.0, "{}", band.frequency_hz());
        assert!(is_wide(&band));
        assert!(!is_wide(&run(span.multisine((1.0, 35.0), 0.5, 0.7, 3.0, 5e-4))));
        assert!(!is_wide(&run(span.steps(&[0.5], 0.5, 5e-4))));
    }

    #[test]
    fn the_cheapest_experiment_that_rules_out_nearly_as_much_comes_first() {
        // three explanations; the first experiment parts one of them, the second all, the third nothing
        let one = Parting(vec![vec![SELF, 9.0, 9.0], vec![9.0, SELF, 0.1], vec![9.0, 0.1, SELF]]);
        let all = |least: f64| {
            Parting(vec![vec![SELF, least, 5.0], vec![least, SELF, 5.0], vec![5.0, 5.0, SELF]])
        };
        let nothing =
            Parting(vec![vec![SELF, 0.5, 0.5], vec![0.5, SELF, 0.5], vec![0.5, 0.5, SELF]]);
        assert!(
            (one.ruled_out() - 2.0 / 3.0).abs() < 1e-12
                && (one.resolves() - 1.0 / 3.0).abs() < 1e-12
        );
        let parted = [one, all(1.5), nothing];
        // two thirds of the pairs for a tenth of the time
        assert_eq!(choose(&parted, &[5.0, 60.0, 1.0]), Some(0));
        assert_eq!(choose(&parted, &[60.0, 5.0, 1.0]), Some(1));
        // of two of one price the one that leaves the largest distance
        assert_eq!(choose(&[all(1.5), all(3.0)], &[5.0, 5.0]), Some(1));
        assert_eq!(choose(&[], &[]), None);
    }

    #[test]
    fn what_was_measured_is_not_asked_for_again() {
        let span = Span { middle: 0.0, half: 80.0 };
        let run = |input: Vec<f64>| Record::new("a", 5e-4, input.clone(), input);
        let wide = run(span.multisine((5.0, 181.0), 2.0, 0.35, 2.0, 5e-4));
        let rest = run(vec![65.0; 4000]);
        let asked = |runs: &[&Record], id: &str| {
            catalogue(span, runs, &[&wide], true).iter().any(|own| own.id == id)
        };
        let slow = run(span.triangles(1.0, &[1.0], 5e-4));
        for (id, measured) in [
            ("multisine-5-181Hz", &wide),
            ("zero-input-record", &rest),
            ("repeat-reference", &wide),
        ] {
            assert!(asked(&[&slow], id) && !asked(&[&slow, measured], id), "{id}");
        }
    }
}

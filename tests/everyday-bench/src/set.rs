//! A whole set: reference folder, measured folder, answer.

use std::collections::BTreeMap;

use crate::actuator::Actuator;
use crate::answer::{Answer, Quantity};
use crate::catalogue::{Effect, Entry, Sizes};
use crate::draw::Draw;
use crate::effect::Physics;
use crate::family::Family;
use crate::hidden::{Deal, Hidden, Part};
use crate::physics::{Built, built};
use crate::runs::{self, Drive, Run};
use crate::simulate::{Prepared, Trace};
use crate::text::{self, Column, File};

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Family of the hysteresis.
    pub family: Family,
    /// Seed of actuator, hidden thing and noise.
    pub seed: u64,
    /// Rms of the reference output over that of the noise, dB.
    pub snr_db: f64,
    /// What is hidden.
    pub hidden: Hidden,
    /// Another share than the seed's own for causes whose size is a share.
    pub share: Option<f64>,
    /// Columns besides those of the seed.
    pub columns: Vec<Column>,
    /// How far the reference runs are driven.
    pub drive: Drive,
    /// Another draw of all noise for the same truth.
    pub draw: u64,
    /// Whether the measured runs are the reference runs done again.
    pub repeats: bool,
}

impl Request {
    /// The set of a seed at 40 dB.
    pub fn new(family: Family, seed: u64, deal: Deal) -> Self {
        let hidden = Hidden::of_seed(seed, deal);
        let (share, columns, drive) = (None, Vec::new(), Drive::Full);
        Self { family, seed, snr_db: 40.0, hidden, share, columns, drive, draw: 0, repeats: false }
    }

    /// The columns of both folders: a third of the seeds have the voltage, a quarter the load, a fifth the temperature;
    /// and those that what is hidden needs.
    pub fn columns(&self) -> Vec<Column> {
        let mut draw = Draw::new("columns", &[self.seed]);
        let mut dealt = |share: f64| draw.uniform(0.0, 1.0) < share;
        let own = [
            (Column::Amplifier, dealt(1.0 / 3.0)),
            (Column::Temperature, dealt(0.2)),
            (Column::Load, dealt(0.25)),
        ];
        let monitor = [Effect::MonitorGain, Effect::MonitorZero, Effect::MonitorBoth];
        let needed = |column: Column| match column {
            Column::Amplifier => monitor.iter().any(|effect| self.hidden.has(*effect)),
            Column::Load => self.hidden.has(Effect::SpringAlways),
            Column::Temperature => false,
        };
        let all = own
            .into_iter()
            .filter(|(column, dealt)| *dealt || self.columns.contains(column) || needed(*column));
        all.map(|(column, _)| column).collect()
    }

    fn drive(&self) -> Drive {
        if self.hidden.has(Effect::SmallReference) { Drive::Small } else { self.drive }
    }
}

/// Runs without noise, with and without what is hidden.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// Runs of the reference folder.
    pub reference: Vec<(Run, Trace)>,
    /// Runs of the measured folder.
    pub measured: Vec<(Run, Trace)>,
    /// What the measured runs would have been.
    pub without: Vec<Trace>,
    /// Standard deviation of the noise, um.
    pub noise_um: f64,
    /// Rms of what is hidden over rms of the output, over the driven runs.
    pub effect_share: f64,
    /// True parameters by name of the effect.
    pub parameters: BTreeMap<String, BTreeMap<String, Quantity>>,
}

/// A generated set.
#[derive(Debug, Clone, PartialEq)]
pub struct Set {
    /// Files of the reference folder.
    pub reference: Vec<File>,
    /// Files of the measured folder.
    pub measured: Vec<File>,
    /// What is hidden.
    pub answer: Answer,
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64
}

/// Rms of the outputs of some runs, runs of equal weight; um.
fn rms_um<'a>(traces: impl Iterator<Item = &'a Trace>) -> f64 {
    let squares: Vec<f64> = traces.map(|trace| mean_square(&trace.displacement_um)).collect();
    (squares.iter().sum::<f64>() / squares.len() as f64).sqrt()
}

/// Rms of the difference of two lists of runs over the rms of the second.
fn share_of(with: &[Trace], without: &[Trace]) -> f64 {
    let changes: Vec<f64> = with
        .iter()
        .zip(without)
        .map(|(a, b)| {
            let pairs = a.displacement_um.iter().zip(&b.displacement_um);
            mean_square(&pairs.map(|(a, b)| a - b).collect::<Vec<f64>>())
        })
        .collect();
    (changes.iter().sum::<f64>() / changes.len() as f64).sqrt() / rms_um(without.iter())
}

fn simulated(bench: (&Actuator, u64), runs: &[Run], finer: u32, hidden: &[Physics]) -> Vec<Trace> {
    let place = |number| (number, runs.len());
    let one = |(number, run)| Prepared::new(bench, run, place(number), finer).with(hidden);
    runs.iter().enumerate().map(one).collect()
}

/// The runs of a request, integrated `finer` times finer than usual.
pub fn truth(request: &Request, finer: u32) -> Truth {
    let seed = request.seed;
    let actuator = Actuator::new(request.family, seed);
    let bench = (&actuator, seed);
    let plans = if request.repeats {
        runs::reference(seed, request.drive())
    } else {
        runs::measured(seed, request.drive())
    };
    let prepare = |finer| -> Vec<(bool, Prepared<'_>)> {
        let one = |(i, run): (usize, &Run)| {
            (run.is_driven(), Prepared::new(bench, run, (i, plans.len()), finer))
        };
        plans.iter().enumerate().map(one).collect()
    };
    let usual = prepare(1);
    let parts: Vec<(Effect, Built)> = request
        .hidden
        .parts
        .iter()
        .map(|part| (part.effect, sized(part, request, bench, &usual)))
        .collect();
    // strengths belong to the usual step, whatever the step of the records
    let prepared = if finer == 1 { usual } else { prepare(finer) };
    let always: Vec<Physics> = parts.iter().flat_map(|(_, b)| b.always.clone()).collect();
    let changed = parts.iter().flat_map(|(_, b)| b.measured.clone());
    let hidden: Vec<Physics> = always.iter().copied().chain(changed).collect();
    let with: Vec<Trace> = prepared.iter().map(|(_, run)| run.with(&hidden)).collect();
    let mut without: Vec<Trace> = prepared.iter().map(|(_, run)| run.with(&always)).collect();

    let full = simulated(bench, &runs::reference(seed, Drive::Full), finer, &always);
    let noise_um = rms_um(full.iter()) * 10.0_f64.powf(-request.snr_db / 20.0);
    let reference_plans = runs::reference(seed, request.drive());
    let reference = if request.hidden.has(Effect::ForeignReference) {
        let other_seed = !seed;
        let other = Actuator::new(request.family, other_seed);
        without = simulated((&other, other_seed), &plans, finer, &[]);
        simulated((&other, other_seed), &reference_plans, finer, &[])
    } else if request.drive() == Drive::Full {
        full
    } else {
        simulated(bench, &reference_plans, finer, &always)
    };
    let driven = |traces: &[Trace]| -> Vec<Trace> {
        let kept = traces.iter().zip(&prepared).filter(|(_, (driven, _))| *driven);
        kept.map(|(trace, _)| trace.clone()).collect()
    };
    let effect_share = share_of(&driven(&with), &driven(&without));
    let mut parts = parts;
    if !request.columns().contains(&Column::Temperature) {
        // gain over temperature is defined where a temperature is
        for (_, built) in &mut parts {
            built.parameters.retain(|(name, ..)| *name != "coefficient");
        }
    }
    let parameters = parts.iter().filter(|(_, built)| !built.parameters.is_empty());
    Truth {
        reference: reference_plans.into_iter().zip(reference).collect(),
        measured: plans.into_iter().zip(with).collect(),
        without,
        noise_um,
        effect_share,
        parameters: parameters.map(|(effect, built)| named(*effect, built)).collect(),
    }
}

fn named(effect: Effect, built: &Built) -> (String, BTreeMap<String, Quantity>) {
    let quantity = |(name, value, unit): &(&str, f64, &str)| {
        ((*name).to_owned(), Quantity { value: *value, unit: (*unit).to_owned() })
    };
    let entry = effect.entry();
    let id = entry.truth.unwrap_or(entry.id).to_owned();
    (id, built.parameters.iter().map(quantity).collect())
}

/// An effect of the size asked for, or of the seed's own.
fn sized(
    part: &Part,
    request: &Request,
    bench: (&Actuator, u64),
    prepared: &[(bool, Prepared<'_>)],
) -> Built {
    let seed = request.seed;
    let mut draw = Draw::new("size", &[seed, part.effect as u64]);
    match part.effect.entry().sizes {
        Sizes::None => built(part.effect, 0.0, bench),
        Sizes::Own { choices, .. } => {
            let size = part.size.unwrap_or(choices[draw.below(choices.len())]);
            built(part.effect, size, bench)
        }
        Sizes::Share { strength } => {
            let own = [0.03, 0.06][draw.below(2)];
            let aim = part.size.or(request.share).unwrap_or(own);
            let driven: Vec<&Prepared<'_>> =
                prepared.iter().filter(|(driven, _)| *driven).map(|(_, run)| run).collect();
            let without: Vec<Trace> = driven.iter().map(|run| run.with(&[])).collect();
            let reach = |x: f64| {
                let hidden = built(part.effect, x, bench).measured;
                let with: Vec<Trace> = driven.iter().map(|run| run.with(&hidden)).collect();
                share_of(&with, &without)
            };
            built(part.effect, strength_for(strength, aim, reach), bench)
        }
    }
}

/// The strength in a range at which a share that grows with it comes within 2 % of an aim; the nearer end where
/// none does. Secants of the logarithms that keep the root between them (Illinois).
fn strength_for(range: (f64, f64), aim: f64, reach: impl Fn(f64) -> f64) -> f64 {
    let miss = |log_strength: f64| (reach(log_strength.exp()).max(1e-7) / aim).ln();
    let (mut low, mut high) = (range.0.ln(), range.1.ln());
    let (mut below, mut above) = (miss(low), miss(high));
    if below > 0.0 || above < 0.0 {
        return if below > 0.0 { range.0 } else { range.1 };
    }
    let mut last_was_above = None;
    let mut best = low;
    for _ in 0..30 {
        best = low + (high - low) * below / (below - above);
        let at = miss(best);
        if at.abs() < 0.02 {
            break;
        }
        // an end that stays twice counts half
        if at > 0.0 {
            (high, above) = (best, at);
            below *= if last_was_above == Some(true) { 0.5 } else { 1.0 };
        } else {
            (low, below) = (best, at);
            above *= if last_was_above == Some(false) { 0.5 } else { 1.0 };
        }
        last_was_above = Some(at > 0.0);
    }
    best.exp()
}

/// The files of a request and its answer.
pub fn set(request: &Request) -> Set {
    let truth = truth(request, 1);
    let columns = request.columns();
    let folder = |number: u64, runs: &[(Run, Trace)]| -> Vec<File> {
        let one = |(i, (run, trace)): (u64, &(Run, Trace))| {
            let key = [request.seed, request.family as u64, request.snr_db.to_bits()];
            let keys = [&key[..], &[request.draw, number, i]].concat();
            let text = text::csv(run.rate_hz, trace, &columns, truth.noise_um, &keys);
            (format!("{}.csv", run.id), text)
        };
        let mut files: Vec<File> = (0..).zip(runs).map(one).collect();
        let plans: Vec<Run> = runs.iter().map(|(run, _)| run.clone()).collect();
        let (role, what) =
            if number == 0 { ("Reference", "as it is") } else { ("Measured", "to be explained") };
        let seed = request.seed;
        let title = format!("Synthetic everyday bench {seed}, {what} (generated, not measured)");
        files.push(text::dataset(&title, role, &plans));
        files
    };
    let entries = || request.hidden.parts.iter().map(|part| part.effect.entry());
    let owned = |id: &str| id.to_owned();
    let classes = entries().flat_map(Entry::classes).map(owned).collect();
    let one = if let [part] = request.hidden.parts[..] { part.effect.entry().class } else { None };
    let answer = Answer {
        family: request.family,
        seed: request.seed,
        snr_db: request.snr_db,
        hidden: request.hidden.id(),
        kind: request.hidden.kind(),
        truths: entries().filter_map(|entry| entry.truth.map(owned)).collect(),
        class: one.map(owned),
        classes,
        effect_share: truth.effect_share,
        noise_um: truth.noise_um,
        monitored: columns.contains(&Column::Amplifier),
        parameters: truth.parameters.clone(),
    };
    Set { reference: folder(0, &truth.reference), measured: folder(1, &truth.measured), answer }
}

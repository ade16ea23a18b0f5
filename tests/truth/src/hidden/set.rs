//! A whole set: reference folder, measured folder, answer.

use super::answer::{Answer, HiddenEffect, Quantity, RunAnswer};
use super::assignment::Assignment;
use super::base::BaseActuator;
use super::catalogue::Hidden;
use super::design::{self, BASES, Design, Experiment, Monitor, Plan, RANGE_VOLT, Size};
use super::effect::{Character, Parameter, Physics};
use super::simulate::{Exact, Prepared};
use super::text::{self, Columns, File};
use crate::error::TruthError;

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// The seed: effect, strength, noise.
    pub seed: u64,
    /// Rms of the reference output over the noise, dB.
    pub snr_db: f64,
    /// Another effect than the seed's own.
    pub hidden: Option<Hidden>,
    /// Another base than the seed's own.
    pub base: Option<u64>,
    /// Another strength than the seed's own: rms of each effect over the rms of the output.
    pub share: Option<f64>,
    /// An experiment of the catalogue, in addition.
    pub experiment: Option<String>,
    /// How long the records are.
    pub size: Size,
    /// Another draw of the noise of the measured runs, for the same truth.
    pub replicate: u64,
}

impl Request {
    /// The small set of a seed.
    pub fn new(seed: u64, snr_db: f64) -> Self {
        let (hidden, base, share, experiment) = (None, None, None, None);
        Self { seed, snr_db, hidden, base, share, experiment, size: Size::Small, replicate: 0 }
    }

    /// What the request comes to.
    pub fn assignment(&self) -> Assignment {
        let own = Assignment::of_seed(self.seed);
        let mut found = match self.hidden {
            Some(hidden) => own.with_hidden(hidden, self.seed),
            None => own,
        };
        found.base = self.base.map_or(found.base, |base| base % BASES);
        if let Some(share) = self.share {
            found.shares.fill(share);
        }
        found
    }
}

/// A generated measured folder with its answer.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredSet {
    /// The files of the folder.
    pub files: Vec<File>,
    /// What is hidden.
    pub answer: Answer,
}

/// Runs without noise, with and without the hidden effects.
#[derive(Debug, Clone)]
pub struct Truth {
    /// The runs.
    pub plans: Vec<Plan>,
    /// What the actuator would have done without the effects.
    pub without: Vec<Exact>,
    /// What it does.
    pub with: Vec<Exact>,
    /// The effects.
    pub effects: Vec<HiddenEffect>,
    /// Their physics.
    pub physics: Vec<Physics>,
    /// Columns and range.
    pub experiment: Experiment,
    /// What was asked for.
    pub assignment: Assignment,
}

/// The files of the reference folder of a base at a noise level.
///
/// # Errors
/// [`TruthError::Parameter`] for parameters out of range.
pub fn reference_files(base: u64, snr_db: f64, size: Size) -> Result<Vec<File>, TruthError> {
    let actuator = BaseActuator::new(base);
    let plans = design::reference(base, size);
    let runs = undisturbed(&actuator, &plans, 1)?;
    let noise_um = noise_um(base, snr_db)?;
    let monitors = Design::of_base(base).1;
    let mut files = Vec::new();
    for (number, (plan, run)) in (0_u64..).zip(plans.iter().zip(&runs)) {
        let keys = [u64::MAX, base, snr_db.to_bits(), number];
        let columns = Columns { run, monitors, noise_um, keys: &keys };
        files.push((format!("{}.csv", plan.id), text::csv(plan.rate_hz, &columns)));
    }
    let title = format!("Synthetic bench {base}, as it is (generated, not measured)");
    files.push(text::dataset(&title, "Reference", &plans, RANGE_VOLT));
    Ok(files)
}

/// Standard deviation of the noise of a base, um: the rms output of its reference runs (all of equal weight)
/// over the ratio asked for.
///
/// # Errors
/// [`TruthError::Parameter`] for parameters out of range.
pub fn noise_um(base: u64, snr_db: f64) -> Result<f64, TruthError> {
    let actuator = BaseActuator::new(base);
    let runs = undisturbed(&actuator, &design::reference(base, Size::Small), 1)?;
    let square = runs.iter().map(|run| mean_square(&run.displacement_um)).sum::<f64>();
    Ok((square / runs.len() as f64).sqrt() * 10.0_f64.powf(-snr_db / 20.0))
}

fn undisturbed(
    actuator: &BaseActuator,
    plans: &[Plan],
    finer: u32,
) -> Result<Vec<Exact>, TruthError> {
    plans.iter().map(|plan| Prepared::new(actuator, plan, 0, finer)?.with(&[])).collect()
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64
}

fn mean_square_difference(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>() / a.len() as f64
}

/// The measured runs of a request without noise, integrated `finer` times finer than usual.
///
/// # Errors
/// [`TruthError::UnknownName`] for an experiment that is none, [`TruthError::Parameter`] for parameters out of range.
pub fn truth(request: &Request, finer: u32) -> Result<Truth, TruthError> {
    let assignment = request.assignment();
    let base = assignment.base;
    let actuator = BaseActuator::new(base);
    let monitors = Design::of_base(base).1;
    let experiment = match &request.experiment {
        Some(id) => design::experiment(id, base, monitors)?,
        None => Experiment { runs: Vec::new(), monitors, range_volt: RANGE_VOLT },
    };
    // Strength and answer belong to the runs of the design; a further experiment changes neither.
    let own = design::measured(base, request.size);
    let mut plans = own.clone();
    plans.extend(experiment.runs.iter().cloned());
    let key = |number: u64| request.seed.wrapping_mul(1000) + number;
    let mut prepared = Vec::new();
    for (number, plan) in (0_u64..).zip(&plans) {
        prepared.push(Prepared::new(&actuator, plan, key(number), finer)?);
    }
    let without = prepared.iter().map(|run| run.with(&[])).collect::<Result<Vec<_>, _>>()?;
    let driven: Vec<usize> =
        (0..own.len()).filter(|i| !own[*i].id.starts_with("zero_input")).collect();

    let characters = Character::of_seed(assignment.hidden, request.seed);
    let mut physics: Vec<Physics> = Vec::new();
    let mut effects = Vec::new();
    let ids: Vec<String> = assignment.hidden.id().split('+').map(str::to_owned).collect();
    for ((character, share), id) in characters.iter().zip(&assignment.shares).zip(ids) {
        let reach = |strength: f64| -> Result<f64, TruthError> {
            let (physics, _) = character.with_strength(strength);
            share_of(&prepared, &without, &driven, &physics)
        };
        let strength = strength_for(character.strength_range(), *share, reach)?;
        let (found, parameters) = character.with_strength(strength);
        let alone = share_of(&prepared, &without, &driven, &found)?;
        effects.push(hidden_effect(id, &parameters, alone, rms_output(&without, &driven)));
        physics.push(found);
    }
    let all: Vec<&Physics> = physics.iter().collect();
    let with = prepared.iter().map(|run| run.with(&all)).collect::<Result<Vec<_>, _>>()?;
    Ok(Truth { plans, without, with, effects, physics, experiment, assignment })
}

fn hidden_effect(id: String, parameters: &[Parameter], share: f64, output_um: f64) -> HiddenEffect {
    let quantity = |(name, value, unit): &Parameter| {
        ((*name).to_owned(), Quantity { value: *value, unit: (*unit).to_owned() })
    };
    HiddenEffect {
        id,
        parameters: parameters.iter().map(quantity).collect(),
        effect_um: share * output_um,
        effect_share: share,
    }
}

fn rms_output(runs: &[Exact], which: &[usize]) -> f64 {
    let sum: f64 = which.iter().map(|i| mean_square(&runs[*i].displacement_um)).sum();
    (sum / which.len() as f64).sqrt()
}

/// Rms of what an effect changes over the rms output, runs of equal weight.
fn share_of(
    prepared: &[Prepared<'_>],
    without: &[Exact],
    which: &[usize],
    physics: &Physics,
) -> Result<f64, TruthError> {
    let mut change = 0.0;
    for i in which {
        let with = prepared[*i].with(&[physics])?;
        change += mean_square_difference(&with.displacement_um, &without[*i].displacement_um);
    }
    Ok((change / which.len() as f64).sqrt() / rms_output(without, which))
}

/// Relative distance from the aim at which the search for the strength ends.
const SHARE_TOLERANCE: f64 = 0.03;

/// The strength at which an effect reaches a share: secant in the logarithms between brackets.
///
/// Where the range does not reach, its nearer end is taken.
fn strength_for(
    range: (f64, f64),
    aim: f64,
    reach: impl Fn(f64) -> Result<f64, TruthError>,
) -> Result<f64, TruthError> {
    let miss = |log_strength: f64| -> Result<f64, TruthError> {
        // An effect that is not there at all counts as a millionth.
        Ok((reach(log_strength.exp())?.max(1e-6) / aim).ln())
    };
    let (mut low, mut high) = (range.0.ln(), range.1.ln());
    let (mut below, mut above) = (miss(low)?, miss(high)?);
    if below > 0.0 || above < 0.0 {
        return Ok(if below > 0.0 { range.0 } else { range.1 });
    }
    let mut best = 0.5 * (low + high);
    for step in 0..12 {
        // Every third step halves, so that a bend of the curve cannot hold the secant up.
        let secant = low + (high - low) * (-below) / (above - below);
        best = if step % 3 == 2 { 0.5 * (low + high) } else { secant };
        let at = miss(best)?;
        if at.abs() < SHARE_TOLERANCE {
            break;
        }
        if at > 0.0 {
            (high, above) = (best, at);
        } else {
            (low, below) = (best, at);
        }
    }
    Ok(best.exp())
}

/// The measured folder of a request and its answer.
///
/// # Errors
/// As [`truth`].
pub fn measured_set(request: &Request) -> Result<MeasuredSet, TruthError> {
    let truth = truth(request, 1)?;
    let base = truth.assignment.base;
    let noise_um = noise_um(base, request.snr_db)?;
    let monitors = truth.experiment.monitors;
    let stage = request.experiment.as_ref().map_or(0, |id| {
        let place = |part: &str| design::EXPERIMENTS.iter().position(|known| *known == part);
        // A digit to the base of twenty for each of those joined.
        id.split('+').fold(0, |sum, part| 20 * sum + 1 + place(part).unwrap_or(0) as u64)
    });
    let mut files = Vec::new();
    for (number, (plan, run)) in (0_u64..).zip(truth.plans.iter().zip(&truth.with)) {
        let keys = [request.seed, request.snr_db.to_bits(), stage, number, request.replicate];
        let columns = Columns { run, monitors, noise_um, keys: &keys };
        files.push((format!("{}.csv", plan.id), text::csv(plan.rate_hz, &columns)));
    }
    let title = format!("Synthetic bench {base}, to be explained (generated, not measured)");
    files.push(text::dataset(&title, "Measured", &truth.plans, truth.experiment.range_volt));
    Ok(MeasuredSet { files, answer: answer(request, &truth, noise_um) })
}

fn answer(request: &Request, truth: &Truth, noise_um: f64) -> Answer {
    let own = design::measured(truth.assignment.base, request.size).len();
    let runs: Vec<RunAnswer> = truth
        .plans
        .iter()
        .zip(truth.with.iter().zip(&truth.without))
        .map(|(plan, (with, without))| RunAnswer {
            id: plan.id.clone(),
            effect_um: mean_square_difference(&with.displacement_um, &without.displacement_um)
                .sqrt(),
            output_um: mean_square(&without.displacement_um).sqrt(),
        })
        .collect();
    let driven = runs[..own].iter().filter(|run| !run.id.starts_with("zero_input"));
    let (change, output, count) = driven.fold((0.0, 0.0, 0.0), |(c, o, n), run| {
        (c + run.effect_um.powi(2), o + run.output_um.powi(2), n + 1.0)
    });
    let (design, monitors) = Design::of_base(truth.assignment.base);
    Answer {
        seed: request.seed,
        snr_db: request.snr_db,
        base: truth.assignment.base,
        design: design.id().to_owned(),
        monitored: monitors.amplifier == Monitor::Recorded,
        hidden: truth.assignment.hidden.id(),
        effects: truth.effects.clone(),
        noise_um,
        effect_um: f64::sqrt(change / count),
        effect_share: f64::sqrt(change / output),
        runs,
        experiment: request.experiment.clone(),
    }
}

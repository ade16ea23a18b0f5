//! What each candidate could explain, before any fit.

use super::evidence::{Evidence, columns, difference};
use super::thresholds::{FALSE_ALARM, OTHER_SIGN, STRUCTURE_MARGIN};
use super::{Discovery, Signal, Simulator, Yardstick};
use crate::quantile::normal_exceeded;
use crate::{Effect, GapError};
use rayon::prelude::*;

/// What the screening says of one candidate.
#[derive(Debug, Clone, PartialEq)]
pub struct Screened {
    /// Largest score over the starts: the drop of the misfit that the effect, scaled freely, would bring,
    /// in units of the noise variance.
    pub score: f64,
    /// Share of the effect that the base model would absorb, at the start of that score.
    pub absorbed: f64,
    /// What surrogates without any missing effect reach, with a margin for noise: below it there is
    /// nothing to name.
    pub threshold: f64,
    /// Drop of the misfit expected of a weak effect, a hundredth of the output or the first start, in units of the noise
    /// variance.
    pub weak_signal: f64,
    /// Mean square on the outputs that an effect of that size would take off their error, the channels calibrated as in
    /// the reference runs.
    pub weak_drop: f64,
    /// The candidate whose effect points the same way, with the cosine.
    pub most_confused: Option<(usize, f64)>,
}

/// Candidates, the largest score over its threshold first.
pub fn by_score(screened: &[Screened]) -> Vec<usize> {
    let ratio = |c: usize| screened[c].score / screened[c].threshold.max(1e-9);
    let mut order: Vec<usize> = (0..screened.len()).collect();
    order.sort_by(|&a, &b| ratio(b).total_cmp(&ratio(a)));
    order
}

/// Of so many starts of an effect that adapts to each experiment, one is tried on every surrogate.
const ADAPTED_STARTS: usize = 5;

/// Mean length of a vector of two standard normal numbers, root(pi / 2).
const RAYLEIGH_MEAN: f64 = 1.253_314_137_315_500_3;

/// The screening of every candidate, the effect of each at its best start compared with the others.
pub(crate) fn screen<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
    base: &Signal,
    misfit: &Signal,
) -> Result<Vec<Screened>, GapError> {
    let noise = noise_deviations(discovery);
    let results: Vec<(Screened, Option<Signal>)> = (0..discovery.candidates.len())
        .into_par_iter()
        .map(|candidate| one(discovery, evidence, base, misfit, (candidate, noise)))
        .collect::<Result<_, GapError>>()?;
    let (mut screened, effects): (Vec<Screened>, Vec<Option<Signal>>) = results.into_iter().unzip();
    let present: Vec<usize> = (0..effects.len()).filter(|&c| effects[c].is_some()).collect();
    let gram = evidence.gram(&effects.iter().flatten().collect::<Vec<_>>());
    for (i, &a) in present.iter().enumerate() {
        let cosine = |(j, &b): (usize, &usize)| {
            let size = (gram[(i, i)] * gram[(j, j)]).sqrt();
            (b, if size > 0.0 { gram[(i, j)] / size } else { 0.0 })
        };
        let others = present.iter().enumerate().filter(|(_, b)| **b != a);
        screened[a].most_confused =
            others.map(cosine).max_by(|x, y| x.1.abs().total_cmp(&y.1.abs()));
    }
    Ok(screened)
}

/// Standard deviations that the best of all starts exceeds in noise alone with a probability of [`FALSE_ALARM`], were
/// they independent; each has one sign.
fn noise_deviations<S>(discovery: &Discovery<'_, S>) -> f64 {
    let tried = discovery.candidates.iter().filter(|own| own.blocked.is_none());
    let starts: usize = tried.map(|own| own.starts.len()).sum();
    normal_exceeded(FALSE_ALARM / starts.max(1) as f64)
}

/// The screening of one candidate; beside its number the deviations that noise reaches.
fn one<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
    base: &Signal,
    misfit: &Signal,
    (candidate, noise): (usize, f64),
) -> Result<(Screened, Option<Signal>), GapError> {
    let nothing = Screened {
        score: 0.0,
        absorbed: 1.0,
        threshold: noise.powi(2),
        weak_signal: 0.0,
        weak_drop: 0.0,
        most_confused: None,
    };
    let given = &discovery.candidates[candidate];
    if given.blocked.is_some() {
        return Ok((nothing, None));
    }
    let effect_at = |start: usize| Effect { candidate, values: given.starts[start].clone() };
    let mut signals: Vec<Signal> = (0..given.starts.len())
        .map(|start| Ok(difference(&discovery.simulator.predict(&[effect_at(start)])?, base)))
        .collect::<Result<_, GapError>>()?;
    let known = evidence.seen(&columns(misfit, discovery.structures));
    let seen = evidence.seen(&signals.iter().collect::<Vec<_>>());
    let yardstick = discovery.settings.yardstick;
    let weak = yardstick.weak().powi(2) * evidence.output_energy();
    let spread = evidence.output_variance();
    let mut best = nothing;
    let mut found = None;
    let mut structural = 0.0_f64;
    let mut share = 1.0;
    // an effect that adapts to every experiment finds something to adapt to in noise too: the length of
    // a Rayleigh vector per experiment
    let adapts =
        !given.starts.is_empty() && discovery.simulator.adapted(&effect_at(0), misfit)?.is_some();
    let noise =
        noise + if adapts { RAYLEIGH_MEAN * (evidence.experiments as f64).sqrt() } else { 0.0 };
    for (start, signal) in seen.iter().enumerate() {
        let size = evidence.inner(signal, signal);
        let whole = evidence.dot(&signals[start], &signals[start]);
        if size <= 1e-9 * whole.max(1e-300) {
            continue;
        }
        let on_output = whole - evidence.energy_beside(&signals[start]);
        for structure in &known[1..] {
            let along = evidence.inner(signal, structure) / size.sqrt();
            structural = structural.max(along).max(-OTHER_SIGN * along);
        }
        if adapts && start % ADAPTED_STARTS == 0 {
            for (structure, own) in discovery.structures.iter().zip(&known[1..]) {
                if let Some(signal) = discovery.simulator.adapted(&effect_at(start), structure)? {
                    let signal = evidence.see(&signal);
                    let size = evidence.inner(&signal, &signal).max(1e-300).sqrt();
                    structural = structural.max(evidence.inner(&signal, own) / size);
                }
            }
        }
        if yardstick == Yardstick::FirstStart {
            if start == 0 {
                best.weak_signal = size;
            }
        } else if on_output > 1e-9 * whole {
            best.weak_signal = best.weak_signal.max(weak * size / on_output);
            // the same part of an effect that is a hundredth of the output
            let shown =
                evidence.output_square(&evidence.as_calibrated(signal, discovery.calibrations));
            let part = shown / evidence.output_square(&signals[start]).max(1e-300);
            best.weak_drop = best.weak_drop.max(yardstick.weak().powi(2) * spread * part);
        }
        let along = evidence.inner(signal, &known[0]);
        let score = if along > 0.0 { along * along / size } else { 0.0 };
        if score > best.score || found.is_none() {
            best.score = score;
            best.absorbed = 1.0 - size / whole;
            share = evidence.error_share(signal);
            found = Some(start);
        }
    }
    best.threshold = (STRUCTURE_MARGIN * structural).powi(2) + share * noise.powi(2);
    Ok((best, found.map(|start| signals.swap_remove(start))))
}

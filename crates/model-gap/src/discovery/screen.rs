//! What each candidate could explain, before any fit.

use super::evidence::{Evidence, difference};
use super::thresholds::OTHER_SIGN;
use super::{Discovery, Signal, Simulator};
use crate::{Effect, GapError};
use nalgebra::DMatrix;
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
    /// Drop of the misfit expected of a weak effect, [`super::Settings::weak_effect`] of the output, in
    /// units of the noise variance.
    pub weak_signal: f64,
    /// The candidate whose effect points the same way, with the cosine.
    pub most_confused: Option<(usize, f64)>,
    /// Start of the largest score.
    pub best_start: usize,
}

/// Of so many starts of an effect that adapts to each experiment, one is tried on every surrogate.
const ADAPTED_STARTS: usize = 5;

/// Mean length of a vector of two standard normal numbers, root(pi / 2).
const RAYLEIGH_MEAN: f64 = 1.253_314_137_315_500_3;

/// The screening of every candidate, the effect of each at its best start compared with the others.
pub(crate) fn screen<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
    base: &[Vec<f64>],
    misfit: &[Vec<f64>],
) -> Result<Vec<Screened>, GapError> {
    let results: Vec<Result<(Screened, Option<Signal>), GapError>> =
        (0..discovery.candidates.len())
            .into_par_iter()
            .map(|candidate| one(discovery, evidence, base, misfit, candidate))
            .collect();
    let mut screened = Vec::new();
    let mut effects = Vec::new();
    for result in results {
        let (own, effect) = result?;
        screened.push(own);
        effects.push(effect);
    }
    let present: Vec<usize> = (0..effects.len()).filter(|&c| effects[c].is_some()).collect();
    let columns: Vec<&[Vec<f64>]> = effects.iter().flatten().map(Vec::as_slice).collect();
    let seen = evidence.seen(&columns);
    let gram = evidence.inners(&seen.iter().collect::<Vec<_>>());
    let mut cosines = DMatrix::identity(effects.len(), effects.len());
    for (i, &a) in present.iter().enumerate() {
        for (j, &b) in present.iter().enumerate() {
            let size = (gram[(i, i)] * gram[(j, j)]).sqrt();
            cosines[(a, b)] = if size > 0.0 { gram[(i, j)] / size } else { 0.0 };
        }
    }
    for &a in &present {
        screened[a].most_confused = present
            .iter()
            .filter(|&&b| b != a)
            .map(|&b| (b, cosines[(a, b)]))
            .max_by(|x, y| x.1.abs().total_cmp(&y.1.abs()));
    }
    Ok(screened)
}

fn one<S: Simulator>(
    discovery: &Discovery<'_, S>,
    evidence: &Evidence<'_>,
    base: &[Vec<f64>],
    misfit: &[Vec<f64>],
    candidate: usize,
) -> Result<(Screened, Option<Signal>), GapError> {
    let settings = discovery.settings;
    let nothing = Screened {
        score: 0.0,
        absorbed: 1.0,
        threshold: settings.noise_deviations.powi(2),
        weak_signal: 0.0,
        most_confused: None,
        best_start: 0,
    };
    let given = &discovery.candidates[candidate];
    if given.blocked.is_some() {
        return Ok((nothing, None));
    }
    let mut signals: Vec<Signal> = Vec::with_capacity(given.starts.len());
    for values in &given.starts {
        let effect = Effect { candidate, values: values.clone() };
        signals.push(difference(&discovery.simulator.predict(&[effect])?, base));
    }
    let known: Vec<&[Vec<f64>]> =
        std::iter::once(misfit).chain(discovery.structures.iter().map(Vec::as_slice)).collect();
    let known = evidence.seen(&known);
    let columns: Vec<&[Vec<f64>]> = signals.iter().map(Vec::as_slice).collect();
    let seen = evidence.seen(&columns);
    let weak = settings.weak_effect.powi(2) * evidence.output_energy();
    let mut best = nothing;
    let mut found = None;
    let mut structural = 0.0_f64;
    // an effect that adapts to every experiment finds something to adapt to in noise too: the length of
    // a Rayleigh vector per experiment
    let adapts = match given.starts.first() {
        Some(values) => {
            let effect = Effect { candidate, values: values.clone() };
            discovery.simulator.adapted(&effect, misfit)?.is_some()
        }
        None => false,
    };
    let noise = settings.noise_deviations
        + if adapts { RAYLEIGH_MEAN * (evidence.experiments as f64).sqrt() } else { 0.0 };
    for (start, signal) in seen.iter().enumerate() {
        let size = evidence.inner(signal, signal);
        let whole = evidence.dot(&signals[start], &signals[start]);
        if size <= 1e-9 * whole.max(1e-300) {
            continue;
        }
        for structure in &known[1..] {
            let along = evidence.inner(signal, structure) / size.sqrt();
            structural = structural.max(along).max(-OTHER_SIGN * along);
        }
        if adapts && start % ADAPTED_STARTS == 0 {
            let effect = Effect { candidate, values: given.starts[start].clone() };
            for (structure, own) in discovery.structures.iter().zip(&known[1..]) {
                if let Some(signal) = discovery.simulator.adapted(&effect, structure)? {
                    let signal = evidence.see(&signal);
                    let size = evidence.inner(&signal, &signal).max(1e-300).sqrt();
                    structural = structural.max(evidence.inner(&signal, own) / size);
                }
            }
        }
        best.weak_signal = best.weak_signal.max(weak * size / whole);
        let along = evidence.inner(signal, &known[0]);
        let score = if along > 0.0 { along * along / size } else { 0.0 };
        if score > best.score || found.is_none() {
            best.score = score;
            best.absorbed = 1.0 - size / whole;
            best.best_start = start;
            found = Some(start);
        }
    }
    best.threshold = (settings.structure_margin * structural).powi(2) + noise.powi(2);
    Ok((best, found.map(|start| signals.swap_remove(start))))
}

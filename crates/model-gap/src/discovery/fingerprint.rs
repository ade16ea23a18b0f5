//! What each explanation does to the traces, beside what is left of them.

use super::evidence::{Evidence, difference, residual};
use super::{Finding, Signal, Simulator, Trace, Verdict};
use crate::{Candidate, Effect, GapError};

/// Explanations that are shown beside the causes found, the nearest first.
const RIVALS: usize = 3;

/// How an explanation stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// It was found.
    Found,
    /// It cannot be excluded in the place of what was found.
    Open,
    /// It was fitted alone and does not explain the data as well; or nothing has a name.
    Alone,
}

/// What one cause does to every trace, as it was fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Fingerprint {
    /// Position among the candidates.
    pub candidate: usize,
    /// How it stands.
    pub standing: Standing,
    /// What it adds to the predictions, in the units of the traces.
    pub adds: Signal,
    /// The same less what the nuisance explains of it: what a residual, its nuisance taken out, would show of it.
    pub shows: Signal,
    /// Cosine between it and the misfit of the base model, the nuisance moved at its cost: 1 of the same form, 0 where one
    /// tells nothing of the other. Its square is the part of chi-square that it takes off, scaled freely.
    pub likeness: f64,
}

/// Predictions before and after, and what each explanation does.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fingerprints {
    /// Predictions without and with the causes found; the same where none was.
    pub predicted: [Signal; 2],
    /// The causes found, largest drop first; then their nearest rivals, each name once.
    pub causes: Vec<Fingerprint>,
}

/// What was found, and its nearest rivals, as they act on the traces.
///
/// Rivals are those that are open, then every other one fitted alone, the largest drop first.
///
/// # Errors
/// As [`Simulator::predict`]; [`GapError::NotPositiveDefinite`] for bad nuisance columns.
pub fn fingerprints<S: Simulator>(
    simulator: &S,
    traces: &[Trace],
    candidates: &[Candidate],
    finding: &Finding,
) -> Result<Fingerprints, GapError> {
    let evidence = Evidence::new(traces)?;
    let plain = simulator.predict(&[])?;
    let misfit = residual(traces, &plain);
    let misfit = evidence.see(&misfit);
    let chi2 = evidence.inner(&misfit, &misfit);
    let mut causes = Vec::new();
    for (effects, candidate, standing) in explanations(candidates, finding) {
        let others: Vec<Effect> =
            effects.iter().filter(|own| own.candidate != candidate).cloned().collect();
        let without = if others.is_empty() { plain.clone() } else { simulator.predict(&others)? };
        let adds = difference(&simulator.predict(effects)?, &without);
        let own = evidence.see(&adds);
        let both = (evidence.inner(&own, &own) * chi2).sqrt();
        let likeness = if both > 0.0 { evidence.inner(&own, &misfit) / both } else { 0.0 };
        let shows = evidence.cleaned(&own);
        causes.push(Fingerprint { candidate, standing, adds, shows, likeness });
    }
    let after = simulator.predict(&finding.effects)?;
    Ok(Fingerprints { predicted: [plain, after], causes })
}

/// Explanations to show: their effects, which of these is meant, and how it stands.
fn explanations<'a>(
    candidates: &[Candidate],
    finding: &'a Finding,
) -> Vec<(&'a [Effect], usize, Standing)> {
    let mut all: Vec<(&[Effect], usize, Standing)> = Vec::new();
    if finding.verdict != Verdict::Unknown {
        let found = finding.causes.iter().map(|own| own.candidate);
        all.extend(found.map(|own| (&finding.effects[..], own, Standing::Found)));
    }
    let most = all.len() + RIVALS;
    let open = finding.causes.iter().flat_map(|own| &own.rivals);
    let open = open.map(|own| (&own.effects[..], own.candidate, Standing::Open));
    let mut singles: Vec<&(Effect, f64)> = finding.singles.iter().flatten().collect();
    singles.sort_by(|a, b| b.1.total_cmp(&a.1));
    let singles = singles
        .into_iter()
        .map(|own| (std::slice::from_ref(&own.0), own.0.candidate, Standing::Alone));
    for next in open.chain(singles) {
        let is_same =
            |own: &(&[Effect], usize, Standing)| candidates[own.1].id == candidates[next.1].id;
        if all.len() < most && !all.iter().any(is_same) {
            all.push(next);
        }
    }
    all
}

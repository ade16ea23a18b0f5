//! What can be said at the end.

use super::thresholds::{AS_LIKELY, SURELY};
use super::{BandLeft, Gain, OnlyRun, Reason, Rival, Screened};
use crate::{Class, Effect};
use serde::{Deserialize, Serialize};

/// The six verdicts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The misfit is what the base model leaves of systems with nothing missing.
    NothingMissing,
    /// The causes explain the excess; nothing but the floor is left.
    Named,
    /// The causes are real, but structure is left that they do not explain.
    NamedStructureRemains,
    /// Several causes explain the data alike.
    Ambiguous,
    /// Something is missing, and no known cause explains it.
    Unknown,
    /// The data cannot show what could be missing.
    NotObservable,
}

/// How sure a verdict is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Confidence {
    /// All acceptance tests passed.
    Confident,
    /// Something speaks against it, or too little for it.
    Tentative,
}

/// A fitted parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedParameter {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Value.
    pub value: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
    /// Whether it only shapes the effect.
    pub is_shape: bool,
    /// What must be measured besides before the value means anything; its interval is then the range.
    pub needs: Option<&'static str>,
}

/// A cause that was found, or could be it.
#[derive(Debug, Clone, PartialEq)]
pub struct Found {
    /// Position among the candidates.
    pub candidate: usize,
    /// Its parameters.
    pub parameters: Vec<FittedParameter>,
    /// Drop of chi-square by it.
    pub drop: f64,
    /// The part of that drop on the outputs, further channels left out.
    pub output_drop: f64,
    /// The same on experiments that its fit has not seen; none where no other experiment could foretell one.
    pub held_out_drop: Option<f64>,
    /// The experiment that shows nearly all of it, where there is one such that the others cannot foretell.
    pub only_run: Option<OnlyRun>,
    /// The candidates that explain the same data about as well, best first, itself left out.
    pub alternatives: Vec<Alternative>,
    /// It and every candidate that cannot be excluded, as fitted: a further experiment has to distinguish them.
    pub rivals: Vec<Rival>,
    /// Every other candidate fitted in its place, the smallest `delta_chi2` first.
    pub compared: Vec<Compared>,
}

/// An experiment that the base model misses by more than any surrogate there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StandsOut {
    /// Its number, from 0.
    pub experiment: usize,
    /// What it leaves, in amplitude, over what the worst surrogate or the doubt of the noise leaves.
    pub times: f64,
}

/// A candidate as likely as the one found, in its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Alternative {
    /// Position among the candidates.
    pub candidate: usize,
    /// Its parameters, were it the one.
    pub parameters: Vec<FittedParameter>,
}

/// Another candidate fitted in the place of the one found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Compared {
    /// Position among the candidates.
    pub candidate: usize,
    /// Chi-square above that of the cause found, the penalties on parameters included.
    pub delta_chi2: f64,
    /// `delta_chi2` from which on the two causes are distinguished: noise, errors of form and structure of the
    /// base model could reverse a smaller one.
    pub discrimination_threshold: f64,
}

impl Compared {
    /// Whether it cannot be excluded.
    pub fn is_open(&self) -> bool {
        self.delta_chi2 < self.discrimination_threshold
    }

    /// Whether it is too close for a sure name.
    pub fn is_near(&self) -> bool {
        self.delta_chi2 < SURELY * self.discrimination_threshold
    }

    /// Whether it is so close that it belongs to the answer.
    pub fn is_as_likely(&self) -> bool {
        self.delta_chi2 < AS_LIKELY * self.discrimination_threshold
    }
}

/// What kind of effect is missing: said more surely than which cause it is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct FoundClass {
    /// The class of the leading cause.
    pub class: Class,
    /// Its members that the data leave open, positions among the candidates, the leading one first.
    pub members: Vec<usize>,
    /// How sure the class is.
    pub confidence: Confidence,
}

/// Everything found.
#[derive(Debug, Clone)]
pub struct Finding {
    /// The verdict.
    pub verdict: Verdict,
    /// How sure it is.
    pub confidence: Confidence,
    /// The causes, largest drop first.
    pub causes: Vec<Found>,
    /// What kind of effect is missing; none where nothing is named.
    pub class: Option<FoundClass>,
    /// Size of every candidate, in the yardstick, that these data would have shown with 90 % probability; none of one that they cannot show.
    pub limits: Vec<Option<f64>>,
    /// Every candidate as fitted alone, its effect and what it takes off chi-square; none of one that promised too little.
    pub singles: Vec<Option<(Effect, f64)>>,
    /// The effects as fitted together.
    pub effects: Vec<Effect>,
    /// Whether the causes named leave structure that they do not explain.
    pub structure_remains: bool,
    /// The candidate that what is missing looks most like, where the data show that it is not there.
    pub looks_like: Option<usize>,
    /// Whether nothing is named and the output changes slowly in all runs alike.
    pub is_slow: bool,
    /// Experiments whose own misfit to the base model lies above their own floor.
    pub standing_out: Vec<StandsOut>,
    /// What the causes leave band by band; empty where none is named.
    pub bands_left: Vec<BandLeft>,
    /// Why the verdict is what it is, in order of the decisions.
    pub reasons: Vec<Reason>,
    /// The screening, candidate by candidate.
    pub screen: Vec<Screened>,
    /// Held-out error before and after; none where nothing is named, or where no experiment could be held out.
    pub gain: Option<Gain>,
    /// Residual of the base model, its nuisance taken out.
    pub residual_before: Vec<Vec<f64>>,
    /// Residual of the extended model, likewise.
    pub residual_after: Vec<Vec<f64>>,
    /// Residuals of base and extended model on experiments that their fits have not seen; with [`Self::gain`].
    pub held_out_residuals: Option<[Vec<Vec<f64>>; 2]>,
}

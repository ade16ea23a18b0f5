//! Explanations that the data leave open, and how far an experiment not yet done would part them.

use super::evidence::{Evidence, columns, difference, normal_equations, ridged};
use super::fit::{Fitted, Fitter};
use super::{Signal, Simulator, Trace};
use crate::{Candidate, Effect, GapError};
use nalgebra::DMatrix;
use rayon::prelude::*;

/// An explanation as the data fit it.
#[derive(Debug, Clone, PartialEq)]
pub struct Rival {
    /// The candidate in question, position among the candidates.
    pub candidate: usize,
    /// All effects of the explanation, its own last or in its place.
    pub effects: Vec<Effect>,
    /// What the data at hand say about the coordinates of the effects, in units of the noise variance.
    information: DMatrix<f64>,
    free: Vec<(usize, usize)>,
}

impl Rival {
    pub(super) fn of(evidence: &Evidence<'_>, fit: &Fitted, candidate: usize) -> Self {
        let (information, _) = normal_equations(&evidence.project(&fit.products));
        Self { candidate, effects: fit.effects.clone(), information, free: fit.free.clone() }
    }
}

/// How far an experiment would part rivals.
#[derive(Debug, Clone, PartialEq)]
pub struct Separation {
    /// Row `a`, column `b`: what would be left of the misfit if `a` were true and `b` were fitted, in
    /// units of the noise variance; 0 on the diagonal.
    pub distance: DMatrix<f64>,
    /// What the effects of each rival add to the misfit of the base model there, on the outputs: further
    /// channels show a cause directly and ask for no model of its form.
    pub energy: Vec<f64>,
}

/// Distances between rivals on the traces of an experiment not yet done.
///
/// ```text
/// d(a, b) = min over x, n of |y_a - y_b - J_b x - B n|^2 / sigma^2 + x' H_b x + |n|^2
/// ```
/// `x` are shifts of the parameters of `b`, which the data at hand hold with the information `H_b`; `n` is
/// what the base model may move by (the covariance of the reference fit; what the measured runs add to it
/// is left out, so the distance is rather too small). The T-optimality criterion of A. C. Atkinson and
/// V. V. Fedorov, *The design of experiments for discriminating between two rival models*, Biometrika 62
/// (1975), with the model straight in its parameters.
///
/// # Errors
/// As [`Simulator::predict`]; [`GapError::NotPositiveDefinite`] for bad nuisance columns.
pub fn separations<S: Simulator>(
    simulator: &S,
    traces: &[Trace],
    candidates: &[Candidate],
    rivals: &[Rival],
) -> Result<Separation, GapError> {
    let evidence = Evidence::new(traces)?;
    let fitter = Fitter { simulator, evidence: &evidence, candidates };
    let base = fitter.residual(&[])?;
    let looked_at: Vec<_> = rivals
        .par_iter()
        .map(|rival| {
            let residual = fitter.residual(&rival.effects)?;
            let slopes = fitter.slopes(&rival.effects, &residual, &rival.free)?;
            Ok((residual, slopes))
        })
        .collect::<Result<_, GapError>>()?;
    let on_outputs =
        |effect: &Signal| (fitter.cost_of(effect) - evidence.energy_beside(effect)).max(0.0);
    let energy = looked_at.iter().map(|own| on_outputs(&difference(&base, &own.0))).collect();
    let count = rivals.len();
    let mut distance = DMatrix::zeros(count, count);
    for (a, truth) in looked_at.iter().enumerate() {
        for (b, (residual, slopes)) in looked_at.iter().enumerate() {
            if a == b {
                continue;
            }
            let apart = difference(residual, &truth.0);
            let gram = evidence.gram(&columns(&apart, slopes));
            let (normal, along) = normal_equations(&gram);
            let normal = ridged(normal + &rivals[b].information, 1e-9, 1e-12);
            let taken = normal.cholesky().map_or(0.0, |c| along.dot(&c.solve(&along)));
            distance[(a, b)] = (gram[(0, 0)] - taken).max(0.0);
        }
    }
    Ok(Separation { distance, energy })
}

//! What the extension is worth on data not used for it.

use super::evidence::Evidence;
use super::fit::Fitted;
use nalgebra::DVector;

/// Held-out error before and after, in the output's unit, with the block bootstrap of the error
/// after.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gain {
    /// RMS of the base model on held-out experiments.
    pub rms_before: f64,
    /// RMS of the extended model on held-out experiments.
    pub rms_after: f64,
    /// 95 % interval of the drop of the RMS.
    pub drop_ci95: [f64; 2],
}

/// Squares of held-out residuals, block by block: of the base model, of the extended one, samples.
type Block = (f64, f64, f64);

/// Resamples experiments first, then blocks inside them.
pub(crate) fn gain(
    evidence: &Evidence<'_>,
    base: &Fitted,
    extended: &Fitted,
    resamplings: usize,
) -> Gain {
    let before = held_out_residual(evidence, base);
    let after = held_out_residual(evidence, extended);
    let mut experiments: Vec<Vec<Block>> = vec![Vec::new(); evidence.experiments];
    for (number, trace) in evidence.traces.iter().enumerate() {
        if !trace.is_output {
            continue;
        }
        let pairs = before[number].chunks(trace.block).zip(after[number].chunks(trace.block));
        for (a, b) in pairs {
            let square = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>();
            experiments[trace.experiment].push((square(a), square(b), a.len() as f64));
        }
    }
    experiments.retain(|blocks| !blocks.is_empty());
    let sum = |a: Block, b: &Block| (a.0 + b.0, a.1 + b.1, a.2 + b.2);
    let rms = |s: Block| ((s.0 / s.2).sqrt(), (s.1 / s.2).sqrt());
    let total = experiments.iter().flatten().fold((0.0, 0.0, 0.0), sum);
    if total.2 == 0.0 {
        return Gain::default();
    }
    let (rms_before, rms_after) = rms(total);
    let mut random = SplitMix(0x9E37_79B9_7F4A_7C15);
    let mut drops: Vec<f64> = (0..resamplings)
        .map(|_| {
            let mut drawn = (0.0, 0.0, 0.0);
            for _ in 0..experiments.len() {
                let blocks = &experiments[random.below(experiments.len())];
                for _ in 0..blocks.len() {
                    drawn = sum(drawn, &blocks[random.below(blocks.len())]);
                }
            }
            let (before, after) = rms(drawn);
            before - after
        })
        .collect();
    drops.sort_by(f64::total_cmp);
    let at = |share: f64| quantile(&drops, share).unwrap_or(rms_before - rms_after);
    Gain { rms_before, rms_after, drop_ci95: [at(0.025), at(0.975)] }
}

/// Quantile of sorted values by linear interpolation.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of a length is a place in it"
)]
fn quantile(sorted: &[f64], share: f64) -> Option<f64> {
    let last = sorted.len().checked_sub(1)?;
    let place = share * last as f64;
    let below = (place.floor() as usize).min(last);
    let above = (below + 1).min(last);
    let part = place - below as f64;
    Some(sorted[below] + part * (sorted[above] - sorted[below]))
}

/// Residuals of every experiment predicted by a fit that has not seen its fold; one experiment alone
/// is its own judge.
pub(crate) fn held_out_residual(evidence: &Evidence<'_>, fitted: &Fitted) -> Vec<Vec<f64>> {
    let whole = evidence.projected(&fitted.products);
    let folds: Vec<_> = (0..evidence.fold_count)
        .map(|fold| {
            let left_out = (evidence.fold_count > 1).then_some(fold);
            let shift = fitted.shift(&evidence.project(&fitted.products, left_out), &whole);
            let nuisance = evidence.nuisance_of(&fitted.products, &shift, left_out);
            (shift, nuisance)
        })
        .collect();
    evidence
        .traces
        .iter()
        .enumerate()
        .map(|(number, trace)| {
            let (shift, nuisance) = &folds[evidence.folds[trace.experiment]];
            let moved = if trace.nuisance.ncols() == 0 {
                DVector::zeros(trace.measured.len())
            } else {
                &trace.nuisance * nuisance
            };
            (0..trace.measured.len())
                .map(|i| {
                    let straight: f64 = fitted
                        .slopes
                        .iter()
                        .zip(shift.iter().skip(1))
                        .map(|(slope, s)| slope[number][i] * s)
                        .sum();
                    fitted.residual[number][i] + straight - moved[i]
                })
                .collect()
        })
        .collect()
}

/// A small generator of random numbers with a fixed seed: resampling is part of the result.
///
/// Source: G. L. Steele, D. Lea, C. H. Flood, *Fast splittable pseudorandom number generators*,
/// OOPSLA (2014).
pub(crate) struct SplitMix(pub(crate) u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A whole number below `count`.
    #[expect(clippy::cast_possible_truncation, reason = "the remainder is below a usize")]
    fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }
}

//! What the extension is worth on data not used for it.

use super::{FoldFit, Folds};
use crate::GapError;
use crate::discovery::evidence::{Evidence, difference};
use crate::discovery::fit::Fitted;
use crate::discovery::{Signal, Simulator, TraceRole};
use crate::quantile::student_975;
use crate::resampling::{NoiseDraw, SplitMix};
use rayon::prelude::*;

/// Held-out error before and after, in the output's unit, with two intervals of the drop.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Gain {
    /// RMS of the base model on held-out experiments.
    pub rms_before: f64,
    /// RMS of the extended model on held-out experiments.
    pub rms_after: f64,
    /// 95 % interval of the drop on these experiments, were they measured again: the noise of the
    /// residuals drawn anew, both models fitted to it anew.
    pub drop_ci95: [f64; 2],
    /// 95 % interval of the drop on other experiments of these kinds: experiments drawn anew, blocks of
    /// a period and more within them.
    pub drop_elsewhere_ci95: [f64; 2],
}

/// Squares of held-out residuals, block by block: of the base model, of the extended one, samples.
type Block = (f64, f64, f64);

/// Samples below which a trace does not tell its own noise: that of its channel is drawn, as white.
const LEAST_DRAWN: usize = 64;
/// Draws of the noise; the interval takes the quantile of Student's distribution for as many.
const DRAWS: u64 = 40;

/// The gain of causes with both intervals, and the residuals of base and extended model held out; none where nothing can be held out.
pub(in crate::discovery) fn gain<S: Simulator>(
    folds: &Folds<'_, S>,
    evidence: &Evidence<'_>,
    extended: &Fitted,
    resamplings: usize,
) -> Result<Option<(Gain, [Signal; 2])>, GapError> {
    if extended.effects.is_empty() || !folds.hold_out() {
        return Ok(None);
    }
    let fits = [folds.fits(&[])?, folds.fits(&extended.causes())?];
    let [before, after] = [&fits[0], &fits[1]].map(|own| folds.residual(own, &fits[1]));
    let mut experiments: Vec<Vec<Block>> = vec![Vec::new(); evidence.experiments];
    for (number, trace) in evidence.of_role(TraceRole::Output) {
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
        return Ok(None);
    }
    let drop_ci95 = repeated(folds, evidence, extended, [&fits[0], &fits[1]], [&before, &after]);
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
    let drop_elsewhere_ci95 = [at(0.025), at(0.975)];
    let gain = Gain { rms_before, rms_after, drop_ci95, drop_elsewhere_ci95 };
    Ok(Some((gain, [before, after])))
}

/// Interval of the drop under other noise: a residual bootstrap, the residual less its noise held, the fits
/// straight in their parameters.
fn repeated<S: Simulator>(
    folds: &Folds<'_, S>,
    evidence: &Evidence<'_>,
    extended: &Fitted,
    fits: [&[FoldFit]; 2],
    held_out: [&Signal; 2],
) -> [f64; 2] {
    let left = extended.cleaned(evidence);
    let of_one = |left: &Vec<f64>| {
        if left.len() < LEAST_DRAWN { left.clone() } else { NoiseDraw::BROAD.noise_of(left) }
    };
    let noise: Signal = left.iter().map(of_one).collect();
    let still: Vec<Signal> = fits
        .iter()
        .zip(held_out)
        .map(|(fits, all)| difference(all, &folds.under(evidence, fits, &noise)))
        .collect();
    let drops: Vec<f64> = (0..DRAWS)
        .into_par_iter()
        .map(|draw| {
            let other: Signal = (0_u64..)
                .zip(&noise)
                .zip(evidence.traces)
                .map(|((number, own), trace)| {
                    let seed = (draw << 32) + number;
                    if own.len() < LEAST_DRAWN {
                        SplitMix(seed).normals(trace.noise, own.len())
                    } else {
                        NoiseDraw::BROAD.again(own, seed)
                    }
                })
                .collect();
            let size = |which: usize| {
                output_rms(evidence, &still[which], &folds.under(evidence, fits[which], &other))
            };
            size(0) - size(1)
        })
        .collect();
    let mean = drops.iter().sum::<f64>() / drops.len() as f64;
    let square: f64 = drops.iter().map(|d| (d - mean).powi(2)).sum();
    let spread =
        student_975(drops.len() as f64 - 1.0) * (square / (drops.len() as f64 - 1.0)).sqrt();
    let drop = output_rms(evidence, held_out[0], &[]) - output_rms(evidence, held_out[1], &[]);
    [drop - spread, drop + spread]
}

/// RMS of the sum of two signals on the outputs; the second may be missing.
fn output_rms(evidence: &Evidence<'_>, a: &Signal, b: &[Vec<f64>]) -> f64 {
    let (mut square, mut count) = (0.0, 0.0);
    for (number, _) in evidence.of_role(TraceRole::Output) {
        square += match b.get(number) {
            Some(b) => a[number].iter().zip(b).map(|(a, b)| (a + b).powi(2)).sum::<f64>(),
            None => a[number].iter().map(|a| a * a).sum(),
        };
        count += a[number].len() as f64;
    }
    (square / f64::max(count, 1.0)).sqrt()
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

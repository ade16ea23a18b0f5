//! Causes that the intermediate channels contradict.

use super::decide::Search;
use super::evidence::difference;
use super::fit::Fitted;
use super::thresholds::{SHOWN, SURE_ERRORS};
use super::{Reason, Simulator, TraceRole};
use crate::GapError;

impl<S: Simulator> Search<'_, S> {
    /// Why the intermediate channels show that the cause fitted last is absent, if they do.
    ///
    /// ```text
    /// part = <m, e> / <e, e>,   error = sqrt(sum over blocks of <m - part e, e>^2) / <e, e>
    /// ```
    /// `e` is what the cause as fitted does to these channels, `m` what they read beyond the other causes. A cause
    /// that is there shows as large as the output says, whatever the accuracy of the channels: an error of scale
    /// or of zero of a channel does not cancel the effect of a cause. The fit itself need not turn to it, since
    /// an output that is read finely outweighs a channel that is trusted less.
    pub(super) fn contradicted(&self, fit: &Fitted) -> Result<Option<Reason>, GapError> {
        let channels = || self.evidence.of_role(TraceRole::IntermediateChannel);
        if channels().next().is_none() {
            return Ok(None);
        }
        let Some((_, others)) = fit.effects.split_last() else { return Ok(None) };
        let without = self.fitter.residual(others)?;
        let effect = difference(&without, &fit.residual);
        let (mut both, mut own) = (0.0, 0.0);
        let mut blocks: Vec<(f64, f64)> = Vec::new();
        for (number, trace) in channels() {
            let weight = 1.0 / (trace.sigma * trace.sigma);
            let pairs = without[number].chunks(trace.block).zip(effect[number].chunks(trace.block));
            for (m, e) in pairs {
                let product = |a: &[f64], b: &[f64]| {
                    a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() * weight
                };
                let block = (product(m, e), product(e, e));
                both += block.0;
                own += block.1;
                blocks.push(block);
            }
        }
        if own <= 0.0 {
            return Ok(None);
        }
        let part = both / own;
        let left = |b: &(f64, f64)| (b.0 - part * b.1).powi(2);
        let error = blocks.iter().map(left).sum::<f64>().sqrt() / own;
        let most = part + SURE_ERRORS * error;
        Ok((most < SHOWN).then_some(Reason::Contradicted { part, most }))
    }
}

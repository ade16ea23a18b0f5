//! What is left above the floors: of everything, and run by run.

use super::decide::Search;
use super::evidence::{NoiseEnergy, less};
use super::fit::Fitted;
use super::thresholds::{
    BAND_MARGIN, FALSE_ALARM, FORM_LEFT, FORM_LEFT_OF_BAND, NOISE_COLOUR, RUN_MARGIN, STANDS_OUT,
};
use super::{BandLeft, Signal, Simulator, StandsOut, Trace, TraceRole};
use crate::bands::{Lines, octaves};
use crate::quantile::chi2_exceeded;
use std::ops::Range;

impl<S: Simulator> Search<'_, S> {
    /// Share of the misfit above the floor that a fit takes away; 1 where nothing stands out. The floor
    /// is what noise and the worst surrogate leave.
    pub(super) fn share_of_excess(&self, current: &Fitted) -> f64 {
        let energy = |f: &Fitted| f.cost - self.evidence.beside_output(f);
        let floor = self.evidence.noise_energy() + self.structure_energy;
        let before = energy(&self.base) - floor;
        let drop = self.output_drop(&self.base, current);
        if before > STANDS_OUT * floor { (drop / before).min(1.0) } else { 1.0 }
    }

    /// Share of what stands out run by run that a fit takes away; 1 where no run stands out.
    pub(super) fn share_of_runs(&self, current: &Fitted) -> f64 {
        let (before, after) = (self.runs_of(&self.base), self.runs_of(current));
        let (mut all, mut left) = (0.0, 0.0);
        for (before, after) in before.iter().zip(&after).filter(|(before, _)| before.stands_out()) {
            all += before.excess;
            left += after.excess.max(0.0);
        }
        if all > 0.0 { 1.0 - left / all } else { 1.0 }
    }

    /// Experiments that stand out after a fit too, by more than an error of form of its effects.
    pub(super) fn standing_out_after(&self, current: &Fitted) -> Vec<StandsOut> {
        let (before, after) = (self.runs_of(&self.base), self.runs_of(current));
        let left = |(experiment, (before, after)): (usize, (&Run, &Run))| {
            let is_left = after.stands_out() && after.excess > FORM_LEFT * before.excess;
            is_left.then_some(StandsOut { experiment, times: after.times() })
        };
        before.iter().zip(&after).enumerate().filter_map(left).collect()
    }

    /// Experiments whose own misfit lies above their own floor: one run far out is lost among many.
    ///
    /// The base model moves to meet a run far out, and misses others for it. So the run without which the others
    /// are met best is set aside, the base model moves back, and so on until no other stands out. Where that
    /// sets aside half of them, what is missing is in all: then it is those that stand out together.
    pub(super) fn standing_out(&self) -> Vec<StandsOut> {
        let products = self.evidence.output_products(&self.base.residual);
        let left_without = |aside: &[usize]| self.evidence.left_without(&products, aside);
        let together = self.above_floor(&left_without(&[]));
        let mut aside = Vec::new();
        let mut left = together.clone();
        while !left.is_empty() && 2 * (aside.len() + 1) < self.evidence.experiments {
            let others_without = |one: usize| {
                let mut without = aside.clone();
                without.push(one);
                let met = left_without(&without);
                let others = met.iter().enumerate().filter(|(e, _)| !without.contains(e));
                others.map(|(_, energy)| energy).sum::<f64>() - met[one]
            };
            let remaining = (0..self.evidence.experiments).filter(|e| !aside.contains(e));
            let next = remaining.map(|e| (e, others_without(e))).min_by(|a, b| a.1.total_cmp(&b.1));
            let Some((next, _)) = next else { break };
            aside.push(next);
            left = self.above_floor(&left_without(&aside));
            left.retain(|run| !aside.contains(&run.experiment));
        }
        if !left.is_empty() || aside.is_empty() {
            return together;
        }
        let mut alone = self.above_floor(&left_without(&aside));
        alone.retain(|run| aside.contains(&run.experiment));
        if alone.is_empty() { together } else { alone }
    }

    /// What a fit leaves in the bands of every channel of the chain, where it is more than noise, surrogates and an error
    /// of form of its causes leave.
    ///
    /// ```text
    /// most = M max over surrogates of S_b + 2 sigma^2 chi2(K_b) + F R_b + F' sum over bands of R_b
    /// ```
    /// `S_b` and `R_b` are the energies of what the base model leaves of a surrogate and of the data in a band of `K_b`
    /// lines. `chi2` is the quantile of the noise: two degrees of freedom a line, but under the window every other line
    /// alone is independent.
    pub(super) fn bands_left(&self, current: &Fitted) -> Vec<BandLeft> {
        let (before, after) = (self.base.cleaned(self.evidence), current.cleaned(self.evidence));
        let floors: Vec<Signal> =
            self.structures.iter().map(|s| self.evidence.cleaned(s)).collect();
        let traces = self.evidence.traces;
        let tests: usize = traces.iter().map(|trace| octaves(trace.measured.len()).len()).sum();
        let alarm = FALSE_ALARM / tests.max(1) as f64;
        let of_channel = |(number, trace): (usize, &Trace)| {
            let bands = octaves(trace.measured.len());
            let motion = less(&trace.measured, &after[number]);
            let [before, after, motion] =
                [&before[number], &after[number], &motion].map(|own| Lines::of(own));
            let floors: Vec<Lines> = floors.iter().map(|own| Lines::of(&own[number])).collect();
            let noise = match trace.role {
                TraceRole::Output => NOISE_COLOUR * trace.noise,
                // what such a channel is trusted to
                _ => trace.sigma,
            };
            let whole: f64 = bands.iter().map(|band| before.energy(band)).sum();
            let line_hz = 1.0 / (trace.step_s * trace.measured.len() as f64);
            let left = |band: &Range<usize>| {
                let floor = floors.iter().map(|own| own.energy(band)).fold(0.0, f64::max);
                let [there, elsewhere] = FORM_LEFT_OF_BAND;
                let form = there * before.energy(band) + elsewhere * whole;
                let by_noise = 2.0 * noise.powi(2) * chi2_exceeded(band.len() as f64, alarm);
                let most = BAND_MARGIN * floor + form + by_noise;
                let own = after.energy(band);
                (own > most).then(|| BandLeft {
                    experiment: trace.experiment,
                    role: trace.role,
                    low_hz: band.start as f64 * line_hz,
                    high_hz: band.end as f64 * line_hz,
                    times: (own / most).sqrt(),
                    coherence: after.coherence(&motion, band),
                })
            };
            bands.iter().filter_map(left).collect::<Vec<_>>()
        };
        let channels = traces.iter().enumerate();
        let counts = |(number, trace): &(usize, &Trace)| {
            trace.role != TraceRole::Covariate
                && self.discovery.simulator.carries(&current.effects, *number)
        };
        channels.filter(counts).flat_map(of_channel).collect()
    }

    /// Experiments above their own floors, from what is left of each.
    fn above_floor(&self, left: &[f64]) -> Vec<StandsOut> {
        let runs = self.runs(left).into_iter().enumerate().filter(|(_, run)| run.stands_out());
        runs.map(|(experiment, run)| StandsOut { experiment, times: run.times() }).collect()
    }

    /// What a fit leaves of every experiment.
    fn runs_of(&self, fit: &Fitted) -> Vec<Run> {
        let products = self.evidence.output_products(&fit.residual);
        self.runs(&self.evidence.left_without(&products, &[]))
    }

    /// What is left of every experiment, beside its floor.
    fn runs(&self, left: &[f64]) -> Vec<Run> {
        let noise = self.evidence.noise_by_experiment();
        let alarm = FALSE_ALARM / noise.len().max(1) as f64;
        let floors: Vec<Vec<f64>> =
            self.discovery.structures.iter().map(|s| self.evidence.by_experiment(s)).collect();
        let own = |(experiment, (noise, left)): (usize, (&NoiseEnergy, &f64))| {
            let floor = floors.iter().map(|f| f[experiment]).fold(0.0, f64::max);
            let beyond = RUN_MARGIN * floor + noise.exceeded(alarm);
            Run { excess: left - noise.mean(), floor: floor.max(noise.deviation()), beyond }
        };
        noise.iter().zip(left).enumerate().map(own).collect()
    }
}

/// What is left of an experiment; sums of squares over what they weigh with.
struct Run {
    /// What is left, less what noise alone would leave.
    excess: f64,
    /// What the worst surrogate, or the doubt of the noise, leaves there.
    floor: f64,
    /// What it must exceed to stand out.
    beyond: f64,
}

impl Run {
    fn stands_out(&self) -> bool {
        self.excess > self.beyond
    }

    /// What is left over its floor, in amplitude.
    fn times(&self) -> f64 {
        (self.excess / self.floor).max(0.0).sqrt()
    }
}

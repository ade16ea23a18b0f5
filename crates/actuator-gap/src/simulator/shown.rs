//! Measured outputs beside what is simulated of them and what each explanation does to them.

use super::bench::{BenchSimulator, ChannelKind, averaged};
use model_gap::discovery::{Finding, Fingerprint, Fingerprints, Trace};

/// The output of a run, judged samples alone, thinned as the engine sees it.
#[derive(Debug, Clone, PartialEq)]
pub struct RunShown {
    /// Name of the run.
    pub id: String,
    /// Time of the first sample, s.
    pub start_s: f64,
    /// Time between samples, s.
    pub step_s: f64,
    /// Input, in the unit of the inputs.
    pub input: Vec<f64>,
    /// Output as measured, in the unit of the outputs.
    pub measured: Vec<f64>,
    /// Output as simulated, in that unit: by the base model, and with what was found.
    pub simulated: [Vec<f64>; 2],
    /// Measured less simulated in that unit, before and after; what the base model may move by and the calibrations are taken
    /// off.
    pub residual: [Vec<f64>; 2],
    /// Noise of the reading, in that unit, standard deviation.
    pub noise: f64,
    /// Standard deviation that a sample weighs with, in that unit: noise and what the base model leaves with nothing missing.
    pub sigma: f64,
    /// What each of [`Diagnosis::fingerprints`](crate::Diagnosis::fingerprints) adds to the output, in that unit, and what of
    /// it would show in the residual.
    pub effects: Vec<[Vec<f64>; 2]>,
}

impl RunShown {
    /// Measured less simulated in the unit of the outputs, nothing taken off: by the base model (0), or with what was found
    /// (1).
    pub fn misfit(&self, which: usize) -> Vec<f64> {
        self.measured.iter().zip(&self.simulated[which]).map(|(a, b)| a - b).collect()
    }

    /// The outputs among the traces of a simulator.
    pub(crate) fn of(
        simulator: &BenchSimulator<'_>,
        traces: &[Trace],
        finding: &Finding,
        shown: &Fingerprints,
    ) -> Vec<Self> {
        let channels = simulator.channels.iter().enumerate();
        let outputs = channels.filter(|(_, channel)| channel.kind == ChannelKind::Output);
        outputs
            .map(|(number, channel)| {
                let run = simulator.runs[channel.run];
                let [before, after] = &shown.predicted;
                let effect =
                    |own: &Fingerprint| [&own.adds, &own.shows].map(|own| own[number].clone());
                Self {
                    id: run.id.clone(),
                    start_s: run.window.start as f64 * run.step_s,
                    step_s: run.step_s * simulator.block as f64,
                    input: averaged(run.judged_input(), simulator.block),
                    measured: traces[number].measured.clone(),
                    simulated: [before, after].map(|own| own[number].clone()),
                    residual: [&finding.residual_before, &finding.residual_after]
                        .map(|own| own[number].clone()),
                    noise: traces[number].noise,
                    sigma: traces[number].sigma,
                    effects: shown.causes.iter().map(effect).collect(),
                }
            })
            .collect()
    }
}

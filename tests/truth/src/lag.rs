//! How much of a run one clean lag explains: a yardstick for the data, not part of the physics.

use crate::actuator::ActuatorParameters;
use crate::bench::{BenchRun, steady_window};
use crate::error::TruthError;
use crate::measure::{golden_section, nrmse};
use crate::record::INTERNAL_RATE_HZ;
use crate::stage::HeldLag;

/// A measured run beside the true rate-independent state that caused it.
///
/// The lag acts on the *true* hysteresis, so what is left over is only what a lag cannot do, and
/// the noise. Errors are taken on the steady part ([`steady_window`]).
#[derive(Debug)]
pub struct LagStudy<'a> {
    bench: &'a BenchRun,
    substeps: usize,
    state_um: Vec<f64>,
}

impl<'a> LagStudy<'a> {
    /// Passes the run's command through the rate-independent hysteresis alone.
    ///
    /// # Errors
    /// As [`crate::record::Run::pass_through`].
    pub fn new(actuator: &ActuatorParameters, bench: &'a BenchRun) -> Result<Self, TruthError> {
        let mut chain = actuator.hysteresis_chain()?;
        let fine = bench.run.pass_through_finely(&mut chain, actuator, INTERNAL_RATE_HZ)?;
        let state_um = fine.into_iter().map(|(_, state)| state).collect();
        Ok(Self { bench, substeps: bench.run.substeps(INTERNAL_RATE_HZ)?, state_um })
    }

    /// NRMSE of the rate-independent state itself.
    pub fn nrmse_without_lag(&self) -> f64 {
        let model: Vec<f64> = self.state_um.iter().copied().step_by(self.substeps).collect();
        self.nrmse(&model)
    }

    /// NRMSE of the rate-independent state behind a first-order lag.
    pub fn nrmse_with_lag(&self, time_constant_s: f64) -> f64 {
        let lag = HeldLag::new(1.0 / f64::from(INTERNAL_RATE_HZ), time_constant_s);
        let mut lagged = self.state_um.first().copied().unwrap_or_default();
        let mut model = vec![lagged];
        for (step, pair) in self.state_um.windows(2).enumerate() {
            lagged = lag.step(lagged, pair[0], pair[1]);
            if (step + 1) % self.substeps == 0 {
                model.push(lagged);
            }
        }
        self.nrmse(&model)
    }

    /// Time constant between 1 and 100 ms with the smallest NRMSE, s.
    pub fn best_lag_s(&self) -> f64 {
        golden_section(0.001, 0.1, |time_s| self.nrmse_with_lag(time_s))
    }

    fn nrmse(&self, model: &[f64]) -> f64 {
        let run = &self.bench.run;
        let measured = &self.bench.measured.displacement_um;
        nrmse(steady_window(run, model), steady_window(run, measured))
    }
}

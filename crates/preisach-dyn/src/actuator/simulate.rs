//! Whole histories through an actuator, one or many at a time.

use crate::actuator::chain::{Chain, check_loads, diverged};
use crate::check::{check_count, check_positive, check_that};
use crate::{ActuatorMemory, ActuatorModel, PreisachError, StartState, StepCounts};
use rayon::prelude::*;

/// A simulated output history.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// Flap angle at every voltage sample, deg.
    pub output_deg: Vec<f64>,
    /// What happened to the steps.
    pub counts: StepCounts,
}

/// A simulated bench record: what its channels would show.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BenchSimulation {
    /// Flap angle, deg.
    pub output_deg: Vec<f64>,
    /// What the displacement sensor reads, as flap angle, deg.
    pub measured_deg: Vec<f64>,
    /// Voltage at the terminals of the actuator, V.
    pub terminal_volt: Vec<f64>,
    /// Temperature above the start, K; empty without a heating stage.
    pub temperature_k: Vec<f64>,
    /// What happened to the steps.
    pub counts: StepCounts,
}

/// A command history, evenly sampled, with the external load if there is one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive<'a> {
    /// Commanded voltage at every sample, V.
    pub voltages_volt: &'a [f64],
    /// External load at every sample, N, see [`crate::LoadStiffness`]; empty: none.
    pub loads_newton: &'a [f64],
    /// Time between two samples, s.
    pub time_step_s: f64,
}

impl<'a> Drive<'a> {
    /// A command history without load.
    pub fn new(voltages_volt: &'a [f64], time_step_s: f64) -> Self {
        Self { voltages_volt, loads_newton: &[], time_step_s }
    }

    fn load(&self, index: usize) -> f64 {
        self.loads_newton.get(index).copied().unwrap_or_default()
    }

    /// Whether a model can follow it.
    pub(crate) fn check(&self, model: &ActuatorModel) -> Result<(), PreisachError> {
        let (voltages, loads) = (self.voltages_volt.len(), self.loads_newton.len());
        let expected = format!("one for each of {voltages} voltages, or none");
        check_that(loads == 0 || loads == voltages, "number of loads", loads as f64, expected)?;
        check_positive("time_step_s", self.time_step_s)?;
        check_loads(model, self.loads_newton)?;
        let mut voltages = self.voltages_volt.iter().enumerate();
        voltages.try_for_each(|(index, &volt)| model.check_sample(index, volt))
    }
}

impl ActuatorModel {
    /// The flap angle at every sample of a voltage history, starting at rest at its first sample.
    ///
    /// # Errors
    /// As [`crate::Stepper::step`]; an empty history is [`PreisachError::OutOfRange`].
    pub fn simulate(
        &self,
        voltages_volt: &[f64],
        time_step_s: f64,
    ) -> Result<Simulation, PreisachError> {
        self.simulate_drive(&Drive::new(voltages_volt, time_step_s))
    }

    /// The flap angle at every sample of a command under its load, starting at rest at the first.
    ///
    /// # Errors
    /// As [`Self::simulate`]; [`PreisachError::OutOfRange`] for unequal numbers of loads, [`PreisachError::NoLoadStage`].
    pub fn simulate_drive(&self, drive: &Drive<'_>) -> Result<Simulation, PreisachError> {
        let mut output_deg = Vec::with_capacity(drive.voltages_volt.len());
        let memory = self.run(drive, |_, memory| output_deg.push(memory.output_deg()))?;
        Ok(Simulation { output_deg, counts: memory.counts() })
    }

    /// The channels of a bench record of a command, starting at rest at its first sample.
    ///
    /// # Errors
    /// As [`Self::simulate_drive`].
    pub fn simulate_bench(&self, drive: &Drive<'_>) -> Result<BenchSimulation, PreisachError> {
        let mut bench = BenchSimulation::default();
        let memory = self.run(drive, |chain, memory| {
            bench.output_deg.push(memory.output_deg());
            bench.terminal_volt.push(memory.terminal_volt());
            bench.temperature_k.extend(memory.temperature_k());
            let first = memory.counts().steps == 0;
            bench.measured_deg.push(if first { memory.measured_deg() } else { chain.read(memory) });
        })?;
        Ok(BenchSimulation { counts: memory.counts(), ..bench })
    }

    /// Many commands at once, on all cores. Every result is that of [`Self::simulate_drive`], to the
    /// last bit, whatever the number of threads.
    ///
    /// # Errors
    /// The error of the first drive, in their order, that has one.
    pub fn simulate_batch(&self, drives: &[Drive<'_>]) -> Result<Vec<Simulation>, PreisachError> {
        let results: Vec<_> = drives.par_iter().map(|drive| self.simulate_drive(drive)).collect();
        results.into_iter().collect()
    }

    /// The flap angle at every sample of a command that follows on a memory, under its load.
    ///
    /// # Errors
    /// As [`crate::Stepper::step`]; [`PreisachError::OutOfRange`] for unequal numbers of loads.
    pub fn continue_drive(
        &self,
        memory: &mut ActuatorMemory,
        drive: &Drive<'_>,
    ) -> Result<Vec<f64>, PreisachError> {
        let chain = self.chain(drive.time_step_s)?;
        chain.check(self, memory)?;
        drive.check(self)?;
        let mut outputs = Vec::with_capacity(drive.voltages_volt.len());
        self.follow(&chain, memory, drive, 0, |_, memory| outputs.push(memory.output_deg()))?;
        Ok(outputs)
    }

    /// Starts at rest at the first sample, follows the rest, and shows every sample.
    fn run(
        &self,
        drive: &Drive<'_>,
        mut show: impl FnMut(&Chain, &mut ActuatorMemory),
    ) -> Result<ActuatorMemory, PreisachError> {
        check_count("voltage samples", drive.voltages_volt.len(), 1)?;
        drive.check(self)?;
        let chain = self.chain(drive.time_step_s)?;
        let mut memory = chain.start(self, drive.voltages_volt[0], drive.load(0), StartState::Rest);
        show(&chain, &mut memory);
        self.follow(&chain, &mut memory, drive, 1, show)?;
        Ok(memory)
    }

    /// Steps through the samples of a drive from `first` on and shows each.
    fn follow(
        &self,
        chain: &Chain,
        memory: &mut ActuatorMemory,
        drive: &Drive<'_>,
        first: usize,
        mut show: impl FnMut(&Chain, &mut ActuatorMemory),
    ) -> Result<(), PreisachError> {
        for (index, &voltage_volt) in drive.voltages_volt.iter().enumerate().skip(first) {
            let before = memory.output_deg();
            let output = chain.advance(self, memory, voltage_volt, drive.load(index));
            if !output.is_finite() {
                Chain::count(self, memory);
                return Err(diverged(memory, before));
            }
            show(chain, memory);
        }
        Chain::count(self, memory);
        Ok(())
    }
}

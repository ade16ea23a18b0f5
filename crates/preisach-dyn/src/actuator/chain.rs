//! One sample through the whole chain: command, amplifier, law, linkage, flap, sensor.

use crate::check::{check_finite, check_positive};
use crate::{
    ActuatorModel, HysteresisLaw, LawMemory, LinkageStage, PreisachError, StartState, StepCounts,
};
use actuator_stages::{StageMemory, StageStep, Step};
use serde::{Deserialize, Serialize};

/// The state of an actuator between two samples: law, stages, counts.
///
/// Can be stored and taken up again: continued from a file that keeps all digits it gives the same
/// bits.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActuatorMemory {
    law: LawMemory,
    amplifier: Vec<StageMemory>,
    linkage: Vec<StageMemory>,
    sensor: Vec<StageMemory>,
    terminal_volt: f64,
    output_deg: f64,
    measured_deg: f64,
    counts: StepCounts,
}

impl ActuatorMemory {
    /// Present flap angle, deg.
    pub fn output_deg(&self) -> f64 {
        self.output_deg
    }

    /// Present voltage behind the amplifier, V.
    pub fn terminal_volt(&self) -> f64 {
        self.terminal_volt
    }

    /// Last reading of the bench sensor, deg: the first one unless the bench was simulated.
    pub fn measured_deg(&self) -> f64 {
        self.measured_deg
    }

    /// Temperature above the start, K; none without a heating stage.
    pub fn temperature_k(&self) -> Option<f64> {
        self.amplifier.iter().find_map(|memory| match memory {
            StageMemory::Heating(memory) => Some(memory.temperature_k()),
            _ => None,
        })
    }

    /// Steps counted since this memory was made.
    pub fn counts(&self) -> StepCounts {
        self.counts
    }

    /// Takes the slow linear states of amplifier and linkage to where a periodic command leads
    /// them, from their values one period earlier.
    pub(crate) fn settle(&mut self, chain: &Chain, before: &Self, period_s: f64) {
        let amplifier = (&chain.amplifier, &before.amplifier, &mut self.amplifier);
        let linkage = (&chain.linkage, &before.linkage, &mut self.linkage);
        for (steps, before, now) in [amplifier, linkage] {
            for ((step, before), now) in steps.iter().zip(before).zip(now) {
                step.settle(before, now, period_s);
            }
        }
    }
}

/// The stages of an actuator made ready for one time step.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Chain {
    pub(crate) step_s: f64,
    amplifier: Vec<StageStep>,
    linkage: Vec<StageStep>,
    sensor: Vec<StageStep>,
    /// Output of the rested law at 0 V, deg, where a stage scales it.
    neutral_deg: Option<f64>,
}

impl Chain {
    pub(crate) fn new(model: &ActuatorModel, step_s: f64) -> Self {
        let amplifier: Vec<StageStep> =
            model.amplifier.iter().map(|stage| stage.prepared(step_s)).collect();
        let scales =
            |step: &_| matches!(step, StageStep::Heating(_) | StageStep::Depolarisation(_));
        let neutral_deg = amplifier.iter().any(scales).then(|| {
            let range = model.range_volt;
            let neutral_volt = 0.0_f64.clamp(range.lowest_volt(), range.highest_volt());
            model.law.start(neutral_volt, StartState::Rest).1
        });
        let calibration = &model.calibration;
        Self {
            step_s,
            amplifier,
            linkage: model.linkage.iter().map(|s| s.prepared(step_s, calibration)).collect(),
            sensor: model.sensor.iter().map(|s| s.prepared(step_s, calibration)).collect(),
            neutral_deg,
        }
    }

    /// Refuses a memory of another chain.
    pub(crate) fn check(
        &self,
        model: &ActuatorModel,
        memory: &ActuatorMemory,
    ) -> Result<(), PreisachError> {
        model.law.check_memory(&memory.law)?;
        let parts = [
            ("amplifier stages", &self.amplifier, &memory.amplifier),
            ("linkage stages", &self.linkage, &memory.linkage),
            ("sensor stages", &self.sensor, &memory.sensor),
        ];
        for (part, steps, memories) in parts {
            let (found, expected) = (memories.len(), steps.len());
            if found != expected || steps.iter().zip(memories).any(|(step, m)| !step.owns(m)) {
                return Err(PreisachError::MemoryMismatch { part, found, expected });
            }
        }
        Ok(())
    }

    /// The law's output as heat and depolarisation scale it, deg.
    #[inline]
    fn scaled(&self, free_deg: f64, gain: f64) -> f64 {
        self.neutral_deg.map_or(free_deg, |neutral| neutral + gain * (free_deg - neutral))
    }

    /// The whole chain settled at a command, under a load.
    pub(crate) fn start(
        &self,
        model: &ActuatorModel,
        voltage_volt: f64,
        load_newton: f64,
        state: StartState,
    ) -> ActuatorMemory {
        let (mut volt, mut gain) = (voltage_volt, 1.0);
        let amplifier = self.amplifier.iter().map(|step| {
            let (memory, output) = step.start(volt);
            gain *= step.gain(&memory);
            volt = output;
            memory
        });
        let amplifier = amplifier.collect();
        let (law, free_deg) = model.law.start(volt, state);
        let mut deg = self.scaled(free_deg, gain);
        let linkage = self.linkage.iter().map(|step| {
            let (memory, output) = step.start(deg);
            deg = match step {
                StageStep::Load(step) => step.under(deg, load_newton),
                _ => output,
            };
            memory
        });
        let linkage = linkage.collect();
        let mut measured_deg = deg;
        let sensor = self.sensor.iter().map(|step| {
            let (memory, output) = step.start(measured_deg);
            measured_deg = output;
            memory
        });
        let sensor = sensor.collect();
        ActuatorMemory {
            law,
            amplifier,
            linkage,
            sensor,
            terminal_volt: volt,
            output_deg: deg,
            measured_deg,
            counts: StepCounts::default(),
        }
    }

    /// One sample on, unchecked: the flap angle, deg.
    #[inline]
    pub(crate) fn advance(
        &self,
        model: &ActuatorModel,
        memory: &mut ActuatorMemory,
        voltage_volt: f64,
        load_newton: f64,
    ) -> f64 {
        let (mut volt, mut gain) = (voltage_volt, 1.0);
        for (step, memory) in self.amplifier.iter().zip(&mut memory.amplifier) {
            volt = step.advance(memory, volt);
            gain *= step.gain(memory);
        }
        let mut deg = self.scaled(model.law.step(&mut memory.law, volt, self.step_s), gain);
        for (step, memory) in self.linkage.iter().zip(&mut memory.linkage) {
            deg = match step {
                StageStep::Load(step) => step.under(deg, load_newton),
                _ => step.advance(memory, deg),
            };
        }
        memory.counts.steps += 1;
        memory.terminal_volt = volt;
        memory.output_deg = deg;
        deg
    }

    /// What the bench sensor reads of the present flap angle, deg.
    pub(crate) fn read(&self, memory: &mut ActuatorMemory) -> f64 {
        let mut measured_deg = memory.output_deg;
        for (step, memory) in self.sensor.iter().zip(&mut memory.sensor) {
            measured_deg = step.advance(memory, measured_deg);
        }
        memory.measured_deg = measured_deg;
        measured_deg
    }

    /// Brings the counts up to date with those of the law.
    pub(crate) fn count(model: &ActuatorModel, memory: &mut ActuatorMemory) {
        let steps = memory.counts.steps;
        memory.counts = StepCounts { steps, ..model.law.counts(&memory.law) };
    }
}

/// An actuator made ready for one time step: for loops that bring one sample after another.
#[derive(Debug, Clone, PartialEq)]
pub struct Stepper<'a> {
    model: &'a ActuatorModel,
    chain: Chain,
}

impl Stepper<'_> {
    /// One sample on: moves the memory to a new voltage under an external load (N, see
    /// [`crate::LoadStiffness`]; 0 without one) and returns the flap angle, deg.
    ///
    /// # Errors
    /// [`PreisachError::NotFinite`], [`PreisachError::VoltageOutOfRange`],
    /// [`PreisachError::MemoryMismatch`], [`PreisachError::MemoryOfAnotherLaw`],
    /// [`PreisachError::NoLoadStage`] or [`PreisachError::Diverged`].
    pub fn step(
        &self,
        memory: &mut ActuatorMemory,
        voltage_volt: f64,
        load_newton: f64,
    ) -> Result<f64, PreisachError> {
        self.model.check_sample(memory.counts.steps, voltage_volt)?;
        check_loads(self.model, &[load_newton])?;
        self.chain.check(self.model, memory)?;
        let last_output_deg = memory.output_deg;
        let output = self.chain.advance(self.model, memory, voltage_volt, load_newton);
        Chain::count(self.model, memory);
        if output.is_finite() { Ok(output) } else { Err(diverged(memory, last_output_deg)) }
    }

    /// What the bench sensor reads after a step, deg. Call it once per sample.
    pub fn read(&self, memory: &mut ActuatorMemory) -> f64 {
        self.chain.read(memory)
    }
}

impl ActuatorModel {
    /// The chain made ready for one time step.
    pub(crate) fn chain(&self, time_step_s: f64) -> Result<Chain, PreisachError> {
        check_positive("time_step_s", time_step_s)?;
        self.check_stages()?;
        Ok(Chain::new(self, time_step_s))
    }

    /// A memory that starts at a voltage, everything settled and no load on it.
    ///
    /// # Errors
    /// [`PreisachError::NotFinite`], [`PreisachError::VoltageOutOfRange`], or a stage's parameters.
    pub fn start(
        &self,
        voltage_volt: f64,
        state: StartState,
    ) -> Result<ActuatorMemory, PreisachError> {
        self.start_loaded(voltage_volt, 0.0, state)
    }

    /// As [`Self::start`], under an external load, N.
    ///
    /// # Errors
    /// As [`Self::start`]; [`PreisachError::NoLoadStage`].
    pub fn start_loaded(
        &self,
        voltage_volt: f64,
        load_newton: f64,
        state: StartState,
    ) -> Result<ActuatorMemory, PreisachError> {
        self.check_sample(0, voltage_volt)?;
        check_loads(self, &[load_newton])?;
        // a settled state does not depend on the time step
        Ok(self.chain(1.0)?.start(self, voltage_volt, load_newton, state))
    }

    /// The actuator made ready for samples `time_step_s` apart.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`] for the time step, or a stage's parameters.
    pub fn stepper(&self, time_step_s: f64) -> Result<Stepper<'_>, PreisachError> {
        Ok(Stepper { model: self, chain: self.chain(time_step_s)? })
    }
}

/// Refuses loads that are not finite, and loads that nothing feels.
pub(crate) fn check_loads(model: &ActuatorModel, loads: &[f64]) -> Result<(), PreisachError> {
    check_finite("load_newton", loads.iter().copied())?;
    let feels = |stage: &LinkageStage| matches!(stage, LinkageStage::LoadStiffness(_));
    if loads.iter().any(|&load| load != 0.0) && !model.linkage.iter().any(feels) {
        return Err(PreisachError::NoLoadStage);
    }
    Ok(())
}

pub(crate) fn diverged(memory: &ActuatorMemory, last_output_deg: f64) -> PreisachError {
    let counts = memory.counts;
    PreisachError::Diverged { index: counts.steps, last_output_deg, bad_steps: counts.bad_steps() }
}

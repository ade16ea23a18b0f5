//! One actuator model: a law between voltage and flap angle, its range and its calibration.

use crate::{
    DynamicPreisach, OutputHistory, PlayMemory, PreisachError, StartState, StaticPreisach,
    StepCounts, VoltageRange,
};
use serde::{Deserialize, Serialize};

/// The ideal actuator: `delta = gain (u - bias)`, no memory, no lag.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LinearGain {
    /// Gain, deg/V.
    pub gain_deg_per_volt: f64,
    /// Voltage of zero flap angle, V.
    pub bias_volt: f64,
}

impl LinearGain {
    /// Flap angle at a voltage, deg.
    pub fn output_deg(&self, voltage_volt: f64) -> f64 {
        self.gain_deg_per_volt * (voltage_volt - self.bias_volt)
    }
}

/// The law between voltage and flap angle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum ActuatorLaw {
    /// Ideal linear actuator.
    Linear(LinearGain),
    /// Hysteresis without rate dependence, paper equation (2).
    StaticPreisach(StaticPreisach),
    /// Hysteresis with rate dependence, paper equation (5).
    DynamicPreisach(DynamicPreisach),
}

/// How the flap angle follows from the measured displacement.
///
/// ```text
/// delta = deg_per_um (x - zero_um)
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Equivalent flap angle per displacement, deg/um.
    pub deg_per_um: f64,
    /// Displacement at zero flap angle, um.
    pub zero_um: f64,
}

impl Calibration {
    /// Displacement that belongs to a flap angle, um.
    pub fn displacement_um(&self, output_deg: f64) -> f64 {
        output_deg / self.deg_per_um + self.zero_um
    }

    /// Flap angle that belongs to a displacement, deg.
    pub fn output_deg(&self, displacement_um: f64) -> f64 {
        self.deg_per_um * (displacement_um - self.zero_um)
    }
}

/// What a model was trained on: outside it, it extrapolates.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainedRange {
    /// Smallest voltage amplitude of the periodic training records, V.
    pub least_amplitude_volt: f64,
    /// Largest voltage amplitude of the periodic training records, V.
    pub largest_amplitude_volt: f64,
    /// Lowest drive frequency of the training records, Hz.
    pub lowest_hz: f64,
    /// Highest drive frequency of the training records, Hz.
    pub highest_hz: f64,
    /// Highest drive frequency of any record on the bench, trained or held out, Hz.
    pub bench_highest_hz: f64,
}

impl TrainedRange {
    /// Whether a drive frequency lies above everything the bench has seen.
    pub fn is_beyond_bench(&self, frequency_hz: f64) -> bool {
        frequency_hz > self.bench_highest_hz * 1.01
    }
}

/// A piezo actuator as the rest of the program sees it: voltage in, equivalent flap angle out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActuatorModel {
    /// The law.
    pub law: ActuatorLaw,
    /// Voltages it may see, V.
    pub range_volt: VoltageRange,
    /// Flap angle from displacement.
    pub calibration: Calibration,
    /// What it was trained on; none for a model that was written down, not identified.
    #[serde(default)]
    pub trained: Option<TrainedRange>,
}

/// The state of an actuator between two samples. Can be stored and taken up again.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActuatorMemory {
    plays: PlayMemory,
    history: OutputHistory,
    counts: StepCounts,
}

impl ActuatorMemory {
    /// Present output, deg.
    pub fn output_deg(&self) -> f64 {
        self.history.output_deg
    }

    /// The plays.
    pub fn plays(&self) -> &PlayMemory {
        &self.plays
    }

    /// Steps counted since this memory was made.
    pub fn counts(&self) -> StepCounts {
        self.counts
    }
}

/// A simulated output history.
#[derive(Debug, Clone, PartialEq)]
pub struct Simulation {
    /// Flap angle at every voltage sample, deg.
    pub output_deg: Vec<f64>,
    /// What happened to the steps.
    pub counts: StepCounts,
}

/// How far beyond the range a sampled voltage may lie and still be taken as its limit, as a
/// fraction of the span: amplifier read-back overshoots a little.
pub(crate) const SAMPLE_TOLERANCE: f64 = 0.005;

impl ActuatorModel {
    /// The ideal linear actuator: `amplitude_deg` at the ends of `range_volt`, zero in its middle.
    pub fn linear(range_volt: VoltageRange, amplitude_deg: f64, deg_per_um: f64) -> Self {
        let gain = LinearGain {
            gain_deg_per_volt: 2.0 * amplitude_deg / range_volt.span_volt(),
            bias_volt: range_volt.middle_volt(),
        };
        let calibration = Calibration { deg_per_um, zero_um: 0.0 };
        Self { law: ActuatorLaw::Linear(gain), range_volt, calibration, trained: None }
    }

    /// A memory that starts at a voltage, the output settled.
    ///
    /// # Errors
    /// [`PreisachError::NotFinite`] or [`PreisachError::VoltageOutOfRange`].
    pub fn start(
        &self,
        voltage_volt: f64,
        state: StartState,
    ) -> Result<ActuatorMemory, PreisachError> {
        self.check_sample(0, voltage_volt)?;
        let (plays, output_deg) = match &self.law {
            ActuatorLaw::Linear(gain) => (PlayMemory::empty(), gain.output_deg(voltage_volt)),
            ActuatorLaw::StaticPreisach(model) => {
                let plays = PlayMemory::new(model.grid(), voltage_volt, state);
                let output = model.output_deg(&plays);
                (plays, output)
            }
            ActuatorLaw::DynamicPreisach(model) => {
                let plays = PlayMemory::new(model.grid(), voltage_volt, state);
                let output = model.maps(&plays)[0];
                (plays, output)
            }
        };
        let history = OutputHistory::at_rest(output_deg);
        Ok(ActuatorMemory { plays, history, counts: StepCounts::default() })
    }

    /// One sample on: moves the memory to a new voltage and returns the flap angle, deg.
    ///
    /// # Errors
    /// [`PreisachError::NotFinite`], [`PreisachError::NotPositive`] for the time step,
    /// [`PreisachError::VoltageOutOfRange`], [`PreisachError::MemoryMismatch`],
    /// [`PreisachError::Diverged`].
    pub fn step(
        &self,
        memory: &mut ActuatorMemory,
        voltage_volt: f64,
        time_step_s: f64,
    ) -> Result<f64, PreisachError> {
        self.check_sample(memory.counts.steps, voltage_volt)?;
        check_positive("time_step_s", time_step_s)?;
        self.check_memory(memory)?;
        let before = memory.output_deg();
        let output = self.advance(memory, voltage_volt, time_step_s);
        if output.is_finite() { Ok(output) } else { Err(diverged(memory, before)) }
    }

    /// The flap angle at every sample of a voltage history, starting at rest at its first sample.
    ///
    /// # Errors
    /// As [`Self::step`]; an empty history is [`PreisachError::TooFew`].
    pub fn simulate(
        &self,
        voltages_volt: &[f64],
        time_step_s: f64,
    ) -> Result<Simulation, PreisachError> {
        let first = *voltages_volt.first().ok_or(PreisachError::TooFew {
            quantity: "voltage samples",
            value: 0,
            least: 1,
        })?;
        self.check_samples(voltages_volt)?;
        let mut memory = self.start(first, StartState::Rest)?;
        let mut output_deg = vec![memory.output_deg()];
        output_deg.extend(self.continue_from(&mut memory, &voltages_volt[1..], time_step_s)?);
        Ok(Simulation { output_deg, counts: memory.counts })
    }

    /// The flap angle at every sample of a voltage history that follows on a memory.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn continue_from(
        &self,
        memory: &mut ActuatorMemory,
        voltages_volt: &[f64],
        time_step_s: f64,
    ) -> Result<Vec<f64>, PreisachError> {
        check_positive("time_step_s", time_step_s)?;
        self.check_memory(memory)?;
        self.check_samples(voltages_volt)?;
        let mut outputs = Vec::with_capacity(voltages_volt.len());
        for &voltage_volt in voltages_volt {
            let before = memory.output_deg();
            let output = self.advance(memory, voltage_volt, time_step_s);
            if !output.is_finite() {
                return Err(diverged(memory, before));
            }
            outputs.push(output);
        }
        Ok(outputs)
    }

    /// One sample on, unchecked.
    pub(crate) fn advance(
        &self,
        memory: &mut ActuatorMemory,
        voltage_volt: f64,
        time_step_s: f64,
    ) -> f64 {
        let output = match &self.law {
            ActuatorLaw::Linear(gain) => gain.output_deg(voltage_volt),
            ActuatorLaw::StaticPreisach(model) => model.apply(&mut memory.plays, voltage_volt),
            ActuatorLaw::DynamicPreisach(model) => {
                let ActuatorMemory { plays, history, counts } = memory;
                return model.step(plays, history, counts, voltage_volt, time_step_s);
            }
        };
        memory.counts.steps += 1;
        memory.history = OutputHistory::at_rest(output);
        output
    }

    /// The same actuator with its flap angle moved by `shift_deg`; displacements stay what they
    /// were.
    #[must_use]
    pub fn shifted(mut self, shift_deg: f64) -> Self {
        self.law = match self.law {
            ActuatorLaw::Linear(mut gain) => {
                gain.bias_volt -= shift_deg / gain.gain_deg_per_volt;
                ActuatorLaw::Linear(gain)
            }
            ActuatorLaw::StaticPreisach(model) => {
                ActuatorLaw::StaticPreisach(model.shifted(shift_deg))
            }
            ActuatorLaw::DynamicPreisach(model) => {
                ActuatorLaw::DynamicPreisach(model.shifted(shift_deg))
            }
        };
        self.calibration.zero_um -= shift_deg / self.calibration.deg_per_um;
        self
    }

    fn check_memory(&self, memory: &ActuatorMemory) -> Result<(), PreisachError> {
        let expected = match &self.law {
            ActuatorLaw::Linear(_) => 0,
            ActuatorLaw::StaticPreisach(model) => model.grid().levels(),
            ActuatorLaw::DynamicPreisach(model) => model.grid().levels(),
        };
        let found = memory.plays.levels();
        if found == expected {
            Ok(())
        } else {
            Err(PreisachError::MemoryMismatch { found, expected })
        }
    }

    fn check_samples(&self, voltages_volt: &[f64]) -> Result<(), PreisachError> {
        voltages_volt.iter().enumerate().try_for_each(|(index, &u)| self.check_sample(index, u))
    }

    fn check_sample(&self, index: usize, voltage_volt: f64) -> Result<(), PreisachError> {
        if !voltage_volt.is_finite() {
            return Err(PreisachError::NotFinite {
                quantity: "voltage_volt",
                index,
                value: voltage_volt,
            });
        }
        let range = self.range_volt;
        if range.excess_volt(voltage_volt) > SAMPLE_TOLERANCE * range.span_volt() {
            return Err(PreisachError::VoltageOutOfRange {
                index,
                voltage_volt,
                lowest_volt: range.lowest_volt(),
                highest_volt: range.highest_volt(),
            });
        }
        Ok(())
    }
}

/// Refuses what is not a positive finite number.
pub(crate) fn check_positive(quantity: &'static str, value: f64) -> Result<(), PreisachError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(PreisachError::NotPositive { quantity, value })
    }
}

fn diverged(memory: &ActuatorMemory, last_output_deg: f64) -> PreisachError {
    let counts = memory.counts;
    PreisachError::Diverged { index: counts.steps, last_output_deg, bad_steps: counts.bad_steps() }
}

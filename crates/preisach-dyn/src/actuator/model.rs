//! One actuator: a chain from command to flap angle, its range and its calibration.

use crate::{
    ActuatorLaw, AmplifierStage, Calibration, HysteresisLaw, LinearGain, LinkageStage,
    PreisachError, SensorStage, VoltageRange,
};
use serde::{Deserialize, Serialize};

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
///
/// ```text
/// command -> amplifier stages -> law -> linkage stages -> flap angle -> sensor stages -> bench record
/// ```
/// Stages act in the order they stand in. Without any, the actuator is its law.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ActuatorModel {
    /// The law.
    pub law: ActuatorLaw,
    /// Voltages it may be commanded, V.
    pub range_volt: VoltageRange,
    /// Flap angle from displacement.
    pub calibration: Calibration,
    /// What it was trained on; none for a model that was written down, not identified.
    #[serde(default)]
    pub trained: Option<TrainedRange>,
    /// Between command and law.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub amplifier: Vec<AmplifierStage>,
    /// Between law and flap: creep and mechanics.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub linkage: Vec<LinkageStage>,
    /// Between flap and bench record; the rotor never sees them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensor: Vec<SensorStage>,
}

/// How far beyond the range a sampled voltage may lie and still be taken as its limit, as a
/// fraction of the span: amplifier read-back overshoots a little.
pub(crate) const SAMPLE_TOLERANCE: f64 = 0.005;

impl ActuatorModel {
    /// An untrained actuator without stages.
    pub fn new(law: ActuatorLaw, range_volt: VoltageRange, calibration: Calibration) -> Self {
        Self {
            law,
            range_volt,
            calibration,
            trained: None,
            amplifier: Vec::new(),
            linkage: Vec::new(),
            sensor: Vec::new(),
        }
    }

    /// The ideal linear actuator: `amplitude_deg` at the ends of `range_volt`, zero in its middle.
    pub fn linear(range_volt: VoltageRange, amplitude_deg: f64, deg_per_um: f64) -> Self {
        let gain = LinearGain {
            gain_deg_per_volt: 2.0 * amplitude_deg / range_volt.span_volt(),
            bias_volt: range_volt.middle_volt(),
        };
        let calibration = Calibration { deg_per_um, zero_um: 0.0 };
        Self::new(ActuatorLaw::Linear(gain), range_volt, calibration)
    }

    /// The same actuator with its free flap angle moved by `shift_deg`; displacements stay what they
    /// were, unless a stage knows zero flap angle (load spring, nonlinearity of the sensor).
    #[must_use]
    pub fn shifted(mut self, shift_deg: f64) -> Self {
        self.law = self.law.shifted(shift_deg);
        self.calibration.zero_um -= shift_deg / self.calibration.deg_per_um;
        self
    }

    /// Refuses stages with parameters outside their ranges.
    ///
    /// # Errors
    /// [`PreisachError::Stage`] names the first stage refused, its parameter and what it may be.
    pub fn check_stages(&self) -> Result<(), PreisachError> {
        self.refused_stages().next().map_or(Ok(()), Err)
    }

    /// Every stage with a parameter outside its range, as [`PreisachError::Stage`], in the order of
    /// the chain.
    pub fn refused_stages(&self) -> impl Iterator<Item = PreisachError> {
        let amplifier = self.amplifier.iter().map(AmplifierStage::checked).enumerate();
        let linkage = self.linkage.iter().map(LinkageStage::checked).enumerate();
        let sensor = self.sensor.iter().map(SensorStage::checked).enumerate();
        let amplifier = amplifier.map(|stage| ("amplifier", stage));
        let linkage = linkage.map(|stage| ("linkage", stage));
        let sensor = sensor.map(|stage| ("sensor", stage));
        let stages = amplifier.chain(linkage).chain(sensor);
        stages.filter_map(|(list, (index, (stage, checked)))| {
            let source = Box::new(checked.err()?.into());
            Some(PreisachError::Stage { list, index, stage, source })
        })
    }

    pub(crate) fn check_sample(
        &self,
        index: usize,
        voltage_volt: f64,
    ) -> Result<(), PreisachError> {
        if !voltage_volt.is_finite() {
            let (quantity, value) = ("voltage_volt", voltage_volt);
            return Err(PreisachError::NotFinite { quantity, index, value });
        }
        let range = self.range_volt;
        if range.excess_volt(voltage_volt) > SAMPLE_TOLERANCE * range.span_volt() {
            return Err(PreisachError::VoltageOutOfRange { index, voltage_volt, range });
        }
        Ok(())
    }
}

//! T followed by a Kalman filter on every measured pair.

use super::{Counts, Verified};
use crate::stepwise::{EstimatorSettings, LoadEstimator};
use crate::{ControlError, ControlStep, FeedbackLaw, OperatingPoint, Plant, RunError};

/// Settings of the adaptive controller.
#[derive(Debug, Clone, PartialEq)]
pub struct AdaptiveSettings {
    /// How T and Z0 are estimated.
    pub estimator: EstimatorSettings,
    /// Times a step may be rejected in full before the run ends: after the first, T has learnt from the
    /// rejected pairs; if it still asks for much the same, each control is moved by a
    /// twentieth of full scale to excite it.
    pub probes: u32,
}

impl AdaptiveSettings {
    /// Settings for a plant that answers exactly, with actuators of a given full scale, V.
    pub fn of_full_scale(full_scale_volt: f64) -> Self {
        Self { estimator: EstimatorSettings::of_exact_plant(full_scale_volt), probes: 4 }
    }
}

/// Part of full scale by which a control is moved to excite it.
const PROBE: f64 = 0.05;
/// Times that T may be verified where the loop would end.
const VERIFICATIONS: u32 = 10;

/// A filtered T, and the probes that excite it.
pub(super) struct Filtered {
    pub(super) filter: LoadEstimator,
    /// Size of a move that excites a control, V.
    probe_volt: f64,
    probes_left: u32,
    /// Target of the last step that was rejected in full.
    rejected_volt: Option<Vec<f64>>,
    /// Where the controls were probed last.
    probed_at: Option<Vec<f64>>,
    verifications_left: u32,
}

impl Filtered {
    pub(super) fn new(
        settings: &AdaptiveSettings,
        law: &FeedbackLaw,
        start: &ControlStep,
    ) -> Result<Self, ControlError> {
        let AdaptiveSettings { estimator, probes } = settings;
        Ok(Self {
            filter: LoadEstimator::new(estimator, law.t(), start.point())?,
            probe_volt: PROBE * estimator.full_scale_volt,
            probes_left: *probes,
            rejected_volt: None,
            probed_at: None,
            verifications_left: VERIFICATIONS,
        })
    }

    /// After a step that was rejected in full: whether another one is worth computing. The rejected measurements may
    /// have changed T already; the controls are probed where the target is still much the same.
    pub(super) fn learn<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        target_volt: &[f64],
        counts: &mut Counts,
    ) -> Result<bool, RunError<P::Error>> {
        if self.probes_left == 0 {
            return Ok(false);
        }
        self.probes_left -= 1;
        let away = |other: &[f64]| -> f64 {
            let pairs = target_volt.iter().zip(other);
            pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        let is_repeated = self
            .rejected_volt
            .replace(target_volt.to_vec())
            .is_some_and(|before| away(&before) < 0.5 * away(&here.control_volt));
        if is_repeated {
            self.probe(plant, here, target_volt, counts)?;
        }
        Ok(true)
    }

    /// Whether T is that of a control where the loop would end; it is probed there if not. A filter that has followed
    /// a path knows T along it only.
    pub(super) fn verify<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        target_volt: &[f64],
        counts: &mut Counts,
    ) -> Result<Verified, RunError<P::Error>> {
        if self.probed_at.as_ref() == Some(&here.control_volt) {
            return Ok(Verified::Yes);
        }
        if self.verifications_left == 0 {
            return Ok(Verified::Cannot);
        }
        self.verifications_left -= 1;
        self.probed_at = Some(here.control_volt.clone());
        self.probe(plant, here, target_volt, counts)?;
        Ok(Verified::Anew)
    }

    /// Moves every control once toward the target and lets the filter observe the outputs.
    fn probe<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        target_volt: &[f64],
        counts: &mut Counts,
    ) -> Result<(), RunError<P::Error>> {
        counts.identifications += 1;
        let probe_volt = self.probe_volt;
        for control in 0..target_volt.len() {
            let mut moved = here.control_volt.clone();
            let side = if target_volt[control] < moved[control] { -1.0 } else { 1.0 };
            moved[control] += side * probe_volt;
            if !plant.admits(&moved) {
                moved[control] -= 2.0 * side * probe_volt;
                if !plant.admits(&moved) {
                    continue;
                }
            }
            let measurement = plant.measure(&moved).map_err(RunError::plant("measured", &moved))?;
            counts.measurements += 1;
            let pair = OperatingPoint { control_volt: &moved, outputs: &measurement.outputs };
            self.filter.observe(pair)?;
        }
        // the last pair is that of the state itself
        self.filter.observe(here.point())?;
        Ok(())
    }
}

//! T followed by a Kalman filter on every measured pair.

use super::kalman::Kalman;
use super::{AdaptiveSettings, Counts, Verified};
use crate::{ControlStep, FeedbackLaw, Plant, RunError};

/// Times that T may be verified where the loop would end.
const VERIFICATIONS: u32 = 10;

/// A filtered T, and the probes that excite it.
pub(super) struct Filtered {
    pub(super) filter: Kalman,
    probes_left: u32,
    /// Target of the last step that was rejected in full.
    rejected_volt: Option<Vec<f64>>,
    /// Where the controls were probed last.
    probed_at: Option<Vec<f64>>,
    verifications_left: u32,
}

impl Filtered {
    pub(super) fn new(settings: &AdaptiveSettings, law: &FeedbackLaw, start: &ControlStep) -> Self {
        Self {
            filter: Kalman::new(settings, law, start),
            probes_left: settings.probes,
            rejected_volt: None,
            probed_at: None,
            verifications_left: VERIFICATIONS,
        }
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
        let probe_volt = self.filter.probe_volt();
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
            self.filter.observe(&moved, &measurement.outputs);
        }
        // the last pair is that of the state itself
        self.filter.observe(&here.control_volt, &here.measurement.outputs);
        Ok(())
    }
}

//! The drives of a case and the stroke limits they set.

use crate::error::StudyError;
use crate::flaps::{FlapDrive, FullScale};
use preisach_dyn::{ActuatorModel, VoltageRange};
use rayon::prelude::*;
use rotor_case::{Case, StrokeChoice};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The drives of a case and the stroke limits they set.
#[derive(Debug, Clone)]
pub struct Drives {
    /// Ideal linear actuator.
    pub ideal: FlapDrive,
    /// The identified actuator, if the case has one.
    pub hysteretic: Option<FlapDrive>,
    /// Stroke limits by harmonic per rev.
    limits: BTreeMap<usize, FullScale>,
}

impl Drives {
    /// Drives of a case, with the stroke limit at every harmonic it controls; `model` is the actuator
    /// identified or read for it.
    ///
    /// # Errors
    /// [`StudyError::Stroke`].
    pub fn new(case: &Case, model: Option<Arc<ActuatorModel>>) -> Result<Self, StudyError> {
        let control = &case.control;
        let gain = case.actuator.ideal_amplitude_deg / control.amplitude_volt;
        let bias = control.drive_bias();
        let bias_volt = bias.volt();
        let (low, high) = case.actuator.range_volt;
        let range_volt = VoltageRange::new(low, high).map_err(StudyError::Range)?;
        let mut drives = Self {
            ideal: FlapDrive::Ideal { gain_deg_per_volt: gain, bias_volt, range_volt },
            hysteretic: model.map(|model| FlapDrive::Model {
                model,
                range_volt,
                rev_hz: case.actuator.bench_rev_hz,
                bias,
            }),
            limits: BTreeMap::new(),
        };
        let harmonics: BTreeSet<usize> = control.harmonics.iter().flatten().copied().collect();
        drives.limits = harmonics
            .into_par_iter()
            .map(|n| Ok((n, drives.full_scale(case, n)?)))
            .collect::<Result<_, StudyError>>()?;
        Ok(drives)
    }

    /// Stroke limit at one harmonic and the voltage of the hysteretic actuator that belongs to it.
    pub(super) fn full_scale(&self, case: &Case, harmonic: usize) -> Result<FullScale, StudyError> {
        let control = &case.control;
        let drive = self.hysteretic.as_ref().unwrap_or(&self.ideal);
        let failed = |source| {
            let frequency_hz = case.bench_frequency_hz(harmonic);
            StudyError::Stroke { harmonic, frequency_hz, source }
        };
        let mut full = drive.full_scale(harmonic, control.amplitude_volt).map_err(failed)?;
        if let StrokeChoice::Given { amplitude_deg } = control.stroke_limit {
            if amplitude_deg < full.stroke_deg {
                let found = drive.voltage_of_stroke(harmonic, amplitude_deg, full);
                (full.amplitude_volt, full.motion_deg) = found.map_err(failed)?;
            }
            full.stroke_deg = amplitude_deg;
        }
        Ok(full)
    }

    /// The same drives with every stroke limit multiplied by a factor.
    #[must_use]
    pub fn with_strokes_scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        for limit in scaled.limits.values_mut() {
            limit.amplitude_volt *= factor;
            limit.stroke_deg *= factor;
            limit.reach_volt *= factor;
            limit.motion_deg = limit.motion_deg.map(|deg| factor * deg);
        }
        scaled
    }

    /// Stroke limit at a harmonic of the case; none at others.
    pub fn limit(&self, harmonic: usize) -> Option<FullScale> {
        self.limits.get(&harmonic).copied()
    }
}

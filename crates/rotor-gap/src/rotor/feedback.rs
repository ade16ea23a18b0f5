//! What hysteresis of the flaps costs, and what feedback wins back of it.

use crate::rotor::model::RotorModel;
use crate::rotor::sweep::{Sweep, SweepPoint};
use preisach_dyn::ActuatorModel;
use rotor_case::ControlActuator;
use rotor_study::{ControlStudy, Drives, StudyError, TrimmedRotor, control_all};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The actuators that are compared, in the order of [`WonBack::reduction_percent`].
const COMPARED: [ControlActuator; 3] =
    [ControlActuator::Ideal, ControlActuator::Ignored, ControlActuator::Hysteretic];

/// Vibration with control at one harmonic.
#[derive(Debug, Clone, PartialEq)]
pub struct WonBack {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// Harmonic of the flaps.
    pub harmonic: usize,
    /// How far the vibration index falls, percent: with ideal actuators, with hysteresis that is ignored, with it fed back.
    pub reduction_percent: [f64; 3],
}

impl WonBack {
    /// In words.
    pub fn text(&self) -> String {
        let [ideal, ignored, fed_back] = self.reduction_percent;
        format!(
            "flaps at {}/rev, mu {:.2}: vibration falls by {ideal:.0} % with ideal actuators, {ignored:.0} % with this hysteresis ignored, {fed_back:.0} % fed back",
            self.harmonic, self.advance_ratio
        )
    }
}

/// Controls a rotor at the fastest point of a sweep, once for each harmonic that its flaps were driven at.
///
/// # Errors
/// [`StudyError`] of the trim or the control.
pub(super) fn won_back(
    model: &RotorModel,
    sweep: &Sweep,
    hysteretic: &Arc<ActuatorModel>,
) -> Result<Vec<WonBack>, StudyError> {
    let faster = |a: &&SweepPoint, b: &&SweepPoint| a.advance_ratio.total_cmp(&b.advance_ratio);
    let Some(point) = sweep.points.iter().max_by(faster) else { return Ok(Vec::new()) };
    let driven = sweep.points.iter().flat_map(|own| own.flaps_volt.iter().flatten());
    let harmonics: BTreeSet<usize> = driven
        .filter(|(_, own)| own.cosine != 0.0 || own.sine != 0.0)
        .map(|(harmonic, _)| *harmonic)
        .collect();
    let mut case = model.case_at(point);
    case.control.harmonics = harmonics.iter().map(|harmonic| vec![*harmonic]).collect();
    case.control.actuators = COMPARED.to_vec();
    let trimmed = TrimmedRotor::new(&case, None)?;
    let drives = Drives::new(&case, Some(Arc::clone(hysteretic)))?;
    let studies = control_all(&case, &trimmed, &drives, &|| {})?;
    let of_set = |(harmonic, own): (&usize, &[ControlStudy])| {
        let reduction_percent = std::array::from_fn(|k| own[k].reduction_percent());
        WonBack { advance_ratio: point.advance_ratio, harmonic: *harmonic, reduction_percent }
    };
    Ok(harmonics.iter().zip(studies.chunks_exact(COMPARED.len())).map(of_set).collect())
}

//! Undamped modes at a harmonic of the rotor speed: looked for before a rotor is trimmed.

use crate::error::StudyError;
use rotor_case::{Case, DissimilarBlade};
use rotor_response::{ResponseError, Rotor};
use trim::TrimError;

/// Refuses a rotor, or one of its unlike blades, with an undamped coupled mode at a harmonic: at the
/// collective of a prescribed trim, else at none. The trim looks again at the collective it finds.
///
/// # Errors
/// [`StudyError::Response`] with mode, frequency and pitch at the field that is at fault;
/// [`StudyError::Blade`] and [`StudyError::Response`] if the rotor cannot be built.
pub fn refuse_resonance(case: &Case) -> Result<(), StudyError> {
    refuse_resonance_of(case, &case.rotor_of(&case.blade_properties()?, "rotor")?)
}

/// The same for the rotor of this case, already built.
pub(crate) fn refuse_resonance_of(case: &Case, rotor: &Rotor) -> Result<(), StudyError> {
    let pitch_rad = case.trim.collective_rad();
    let found = rotor.refuse_resonance(pitch_rad);
    found.map_err(|source| StudyError::Response { field: at_fault(&source), source })?;
    dissimilar_rotors(case, pitch_rad).map(drop)
}

/// The rotor of every blade unlike the rest, with the field of the blade; none may have an undamped mode at a
/// harmonic at a pitch.
pub(crate) fn dissimilar_rotors(
    case: &Case,
    pitch_rad: f64,
) -> Result<Vec<(String, Rotor)>, StudyError> {
    let rotor_of = |(i, own): (usize, &DissimilarBlade)| {
        let field = format!("rotor.dissimilar_blades[{i}]");
        let rotor = case.rotor_of(&case.dissimilar_blade(own)?, &field)?;
        match rotor.refuse_resonance(pitch_rad) {
            Ok(()) => Ok((field, rotor)),
            Err(source) => Err(StudyError::Response { field, source }),
        }
    };
    case.rotor.dissimilar_blades.iter().enumerate().map(rotor_of).collect()
}

/// An error of the trim at the field that is at fault.
pub(crate) fn trim_error(case: &Case, source: TrimError) -> StudyError {
    match source {
        TrimError::Response(source @ ResponseError::Resonance { .. }) => {
            StudyError::Response { field: at_fault(&source), source }
        }
        source => {
            if let (true, Some((stiffness, frequency_per_rev))) =
                (matches!(source, TrimError::Response(_)), case.soft_pitch())
            {
                let field = "rotor.root.pitch.stiffness".to_owned();
                return StudyError::SoftPitch { field, stiffness, frequency_per_rev, source };
            }
            StudyError::Trim { field: case.trim.loading_field().to_owned(), source }
        }
    }
}

/// Field that a resonance is due to: the damping, or the root that leaves a mode without frequency.
fn at_fault(error: &ResponseError) -> String {
    let steady = matches!(error, ResponseError::Resonance { frequency_per_rev, .. } if frequency_per_rev.round() == 0.0);
    if steady { "rotor.root" } else { "rotor.modal_damping" }.to_owned()
}

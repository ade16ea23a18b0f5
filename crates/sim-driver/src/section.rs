//! `hhc section`: harmonic response of a section with a trailing-edge flap.

use crate::SimError;
use crate::output::{Printable, table};
use flap_aero::{AttachedFlowModel, FlapChord, Mach, Motion, harmonic_response};
use serde::Serialize;

/// What is asked of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionQuestion {
    /// Section model.
    pub model: AttachedFlowModel,
    /// Mach number.
    pub mach: f64,
    /// Reduced frequency `k = omega c / (2 U)`, 0 and up.
    pub reduced_frequency: f64,
    /// Flap chord over chord.
    pub flap_chord: f64,
    /// Motion of unit amplitude.
    pub motion: Motion,
}

/// Complex amplitudes per radian (plunge: per unit of `h_dot / U`, down positive) as `[re, im]`;
/// moments on the full chord squared, about the quarter chord and the hinge.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SectionResult {
    /// Normal force coefficient.
    pub cn: [f64; 2],
    /// Moment coefficient about the quarter chord, nose-up positive.
    pub cm: [f64; 2],
    /// Hinge-moment coefficient, positive in the sense of the flap angle.
    pub ch: [f64; 2],
}

/// Answers a question about a section.
///
/// # Errors
/// [`SimError::Section`] for a Mach number, flap chord or frequency outside the model.
pub fn section_response(question: &SectionQuestion) -> Result<SectionResult, SimError> {
    let k = question.reduced_frequency;
    if !(k.is_finite() && k >= 0.0) {
        let source = flap_aero::AeroError::BadInput {
            quantity: "reduced frequency",
            value: k,
            expected: "a finite number, 0 or more",
        };
        return Err(source.into());
    }
    let mach = Mach::new(question.mach)?;
    let flap = FlapChord::new(question.flap_chord)?;
    let section = question.model.coefficients(mach, flap)?;
    let [cn, cm, ch] =
        harmonic_response(&section, k, question.motion).map(|value| [value.re, value.im]);
    Ok(SectionResult { cn, cm, ch })
}

impl Printable for SectionResult {
    fn text(&self) -> String {
        let rows = [
            ("Cn, normal force", self.cn),
            ("Cm, about c/4", self.cm),
            ("Ch, about the hinge", self.ch),
        ];
        table(
            &["per radian (plunge: per h_dot/U)", "real", "imaginary", "amplitude", "lag, deg"],
            rows.map(|(name, [re, im])| {
                let lag = -im.atan2(re).to_degrees();
                let amplitude = re.hypot(im);
                vec![
                    name.to_owned(),
                    format!("{re:.6}"),
                    format!("{im:.6}"),
                    format!("{amplitude:.6}"),
                    format!("{lag:.2}"),
                ]
            }),
        )
    }
}

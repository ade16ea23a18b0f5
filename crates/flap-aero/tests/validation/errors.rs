//! Errors of the section models against Possio's equation and against the first moments after a step.

use exact_section::{Possio, incompressible_loads, steady_loads};
use flap_aero::{AttachedFlowModel, FlapChord, Mach, Motion, harmonic_response};
use validation::Failure;

/// Largest errors of `Cn`, `Cm`, `Ch` in per cent of the magnitude of each load, `[k <= 0.3, k <= 1]`.
pub(crate) type ErrorBands = [[f64; 2]; 3];

/// Reduced frequencies at which the errors are taken.
const REDUCED_FREQUENCIES: [f64; 16] =
    [0.005, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

/// Motions with an error of their own, in the order of [`errors_of_flaps`].
pub(crate) const MOTIONS: [(Motion, exact_section::Motion); 3] = [
    (Motion::Flap, exact_section::Motion::Flap),
    (Motion::Pitch, exact_section::Motion::Pitch),
    (Motion::Plunge, exact_section::Motion::Plunge),
];

/// Largest errors against Possio's equation (Theodorsen's theory at Mach 0) of sections with several
/// flap chords: for each the errors of a flap motion, of pitch and of plunge.
pub(crate) fn errors_of_flaps(
    model: AttachedFlowModel,
    mach: f64,
    flap_chords: &[f64],
) -> Result<Vec<[ErrorBands; 3]>, Failure> {
    let sections = flap_chords
        .iter()
        .map(|e| Ok(model.coefficients(Mach::new(mach)?, FlapChord::new(*e)?)?))
        .collect::<Result<Vec<_>, Failure>>()?;
    let still: Vec<_> = flap_chords.iter().map(|e| steady_loads(0.0, *e)).collect();
    let mut worst = vec![[ErrorBands::default(); 3]; flap_chords.len()];
    for k in REDUCED_FREQUENCIES {
        let equation = if mach > 0.0 { Some(Possio::new(mach, k)?) } else { None };
        for (i, section) in sections.iter().enumerate() {
            let loads = match &equation {
                Some(equation) => equation.loads_with(flap_chords[i], &still[i])?,
                None => incompressible_loads(k, flap_chords[i])?,
            };
            for ((motion, of_exact), worst) in MOTIONS.into_iter().zip(&mut worst[i]) {
                let got = harmonic_response(section, k, motion);
                for ((w, g), x) in worst.iter_mut().zip(got).zip(of_exact.of(&loads, k)) {
                    let error = 100.0 * (g - x).norm() / x.norm();
                    w[1] = w[1].max(error);
                    if k < 0.301 {
                        w[0] = w[0].max(error);
                    }
                }
            }
        }
    }
    Ok(worst)
}

/// The errors of one motion of one section.
pub(crate) fn errors_against_possio(
    model: AttachedFlowModel,
    (mach, flap_chord): (f64, f64),
    motion: Motion,
) -> Result<ErrorBands, Failure> {
    let errors = errors_of_flaps(model, mach, &[flap_chord])?;
    let place = MOTIONS.iter().position(|(m, _)| *m == motion);
    Ok(place.map_or_else(ErrorBands::default, |place| errors[0][place]))
}

//! The errors that the section models say they have are those measured.

use flap_aero::{
    AttachedFlowModel, KNOWN_ERROR_FLAP_CHORDS, KNOWN_ERROR_MACHS, known_error_percent,
};
use validation::Failure;

use crate::errors::{ErrorBands, MOTIONS, errors_of_flaps};

/// Largest errors of a model over several flap chords: of a flap motion, of pitch
/// and of plunge.
fn worst_over_flaps(
    model: AttachedFlowModel,
    mach: f64,
    flap_chords: &[f64],
) -> Result<[ErrorBands; 3], Failure> {
    let mut worst = [ErrorBands::default(); 3];
    for errors in errors_of_flaps(model, mach, flap_chords)? {
        let pairs = worst.iter_mut().flatten().flatten().zip(errors.iter().flatten().flatten());
        for (worst, error) in pairs {
            *worst = worst.max(*error);
        }
    }
    Ok(worst)
}

/// At the Mach numbers measured to the digits kept, between them (and for flaps between) no worse.
#[test]
fn the_known_errors_are_those_measured() {
    for model in [AttachedFlowModel::HariharanLeishman, AttachedFlowModel::QuasiSteady] {
        let known = |mach| MOTIONS.map(|(m, _)| known_error_percent(model, m, mach).unwrap());
        for mach in KNOWN_ERROR_MACHS {
            let worst = worst_over_flaps(model, mach, &KNOWN_ERROR_FLAP_CHORDS).unwrap();
            for (known, worst) in pairs(&known(mach), &worst) {
                assert!((known - worst).abs() < 0.06, "{model:?} {mach}: {known} {worst}");
            }
        }
        for mach in [0.05, 0.2, 0.4, 0.6, 0.75] {
            let worst = worst_over_flaps(model, mach, &[0.15, 0.25, 0.35]).unwrap();
            for (known, worst) in pairs(&known(mach), &worst) {
                assert!(worst < 1.03 * known, "{model:?} {mach}: {known} {worst}");
            }
        }
    }
}

fn pairs(a: &[ErrorBands; 3], b: &[ErrorBands; 3]) -> Vec<(f64, f64)> {
    let flat =
        |e: &[ErrorBands; 3]| -> Vec<f64> { e.iter().flatten().flatten().copied().collect() };
    flat(a).into_iter().zip(flat(b)).collect()
}

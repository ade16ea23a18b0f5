//! Errors of the section models against exact theory, over Mach number and flap chord.
#![expect(clippy::print_stdout, reason = "an example shows its result")]

#[path = "../tests/validation/errors.rs"]
mod errors;

use errors::errors_against_possio;
use flap_aero::{AttachedFlowModel, Motion};
use validation::Failure;

/// Models whose error is shown.
const MODELS: [AttachedFlowModel; 3] = [
    AttachedFlowModel::QuasiSteady,
    AttachedFlowModel::HariharanLeishman,
    AttachedFlowModel::Calibrated,
];

/// `(M, E)` of the table of errors; those of the last rows took no part in the fit.
const CONDITIONS: [(f64, f64); 9] = [
    (0.1, 0.2),
    (0.3, 0.2),
    (0.5, 0.2),
    (0.7, 0.2),
    (0.8, 0.2),
    (0.35, 0.15),
    (0.45, 0.33),
    (0.62, 0.27),
    (0.69, 0.18),
];

fn main() -> Result<(), Failure> {
    println!("Largest error against Possio's equation, % of each load, k <= 0.3 / k <= 1\n");
    println!("| model | motion | M | E | Cn | Cm | Ch |\n|---|---|---|---|---|---|---|");
    for model in MODELS {
        for motion in [Motion::Flap, Motion::Pitch, Motion::Plunge] {
            for (mach, flap_chord) in CONDITIONS {
                let errors = errors_against_possio(model, (mach, flap_chord), motion)?;
                let errors = errors.map(|[slow, fast]| format!("{slow:.1} / {fast:.1}"));
                let (model, motion) = (model.name(), format!("{motion:?}").to_lowercase());
                println!("| {model} | {motion} | {mach} | {flap_chord} | {} |", errors.join(" | "));
            }
        }
    }
    Ok(())
}

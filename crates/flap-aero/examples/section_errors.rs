//! Errors of the section models against exact theory, over Mach number and flap chord.
#![expect(clippy::print_stdout, reason = "an example shows its result")]

#[path = "../tests/validation/errors.rs"]
mod errors;

use errors::errors_against_possio;
use exact_section::short_time;
use flap_aero::{AttachedFlowModel, FlapChord, Load, Mach, Mode, Motion, indicial_response};
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

/// Largest deviation of an indicial function from the exact first moments after a step, over its
/// start value; `None` where there is no closed form.
fn short_time_deviation(
    model: AttachedFlowModel,
    (mach, flap_chord): (f64, f64),
    (load, mode): (usize, Mode),
) -> Result<Option<f64>, Failure> {
    let section = model.coefficients(Mach::new(mach)?, FlapChord::new(flap_chord)?)?;
    let reach = match mode {
        Mode::Alpha | Mode::PitchRate if load != Load::Hinge.index() => 1.0,
        _ => flap_chord,
    };
    let end = 2.0 * mach * reach / (1.0 + mach);
    let start = short_time(mach, flap_chord, 0.0)?[load][mode.index()];
    let mut worst = None;
    for i in 0..=20 {
        let s = end * f64::from(i) / 20.0;
        if let (Some(exact), Some(start)) =
            (short_time(mach, flap_chord, s)?[load][mode.index()], start)
        {
            let deviation =
                (indicial_response(&section, mode, s)[load] - exact).abs() / start.abs();
            worst = Some(f64::max(worst.unwrap_or(0.0), deviation));
        }
    }
    Ok(worst)
}

/// A row of a table.
fn print(cells: &[String]) {
    println!("| {} |", cells.join(" | "));
}

fn main() -> Result<(), Failure> {
    println!("Largest error against Possio's equation, % of each load, k <= 0.3 / k <= 1\n");
    println!("| model | motion | M | E | Cn | Cm | Ch |\n|---|---|---|---|---|---|---|");
    for model in MODELS {
        for motion in [Motion::Flap, Motion::Pitch, Motion::Plunge] {
            for (mach, flap_chord) in CONDITIONS {
                let errors = errors_against_possio(model, (mach, flap_chord), motion)?;
                let motion = format!("{motion:?}").to_lowercase();
                let mut cells =
                    vec![model.name().to_owned(), motion, mach.to_string(), flap_chord.to_string()];
                cells.extend(errors.map(|[slow, fast]| format!("{slow:.1} / {fast:.1}")));
                print(&cells);
            }
        }
    }
    println!(
        "\nLargest deviation from the first moments after a step, % of the start value, E 0.2\n"
    );
    println!("each load over alpha, q, delta, q_delta\n");
    let loads = ["Cn", "Cm", "Ch"].map(|load| format!(" {load} |").repeat(4)).concat();
    println!("| model | M |{loads}\n|---|---|{}", "---|".repeat(12));
    for model in MODELS {
        for mach in [0.3, 0.5, 0.7] {
            let mut cells = vec![model.name().to_owned(), mach.to_string()];
            for (load, mode) in (0..3).flat_map(|load| Mode::ALL.map(|mode| (load, mode))) {
                let deviation = short_time_deviation(model, (mach, 0.2), (load, mode))?;
                cells.push(deviation.map_or("-".to_owned(), |d| format!("{:.1}", 100.0 * d)));
            }
            print(&cells);
        }
    }
    Ok(())
}

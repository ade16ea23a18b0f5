//! `cargo xtask calibrate`: poles and gains of the calibrated section model, from exact theory to source.

use std::path::Path;

use exact_section::calibration::{Calibration, calibrate};
use exact_section::{ExactError, Possio, incompressible_loads, short_time, steady_loads};
use flap_aero::{
    AttachedFlowModel, FlapChord, Load, Mach, Mode, Motion, harmonic_response, indicial_response,
};

use crate::validate::CheckError;
use crate::{XtaskError, files};

/// The file the calibration is stored in, from the root.
pub const TABLE: &str = "crates/flap-aero/src/calibrated/table.rs";

/// Numbers of a table that differ by more than this are different: the fit is iterative, and
/// logarithms are not the same to the last bit on every machine.
const SAME: f64 = 1e-5;

/// Fits the model anew and writes its table.
///
/// # Errors
/// [`XtaskError::Exact`] if the exact theory fails, [`XtaskError::Write`] if the file cannot be
/// written.
pub fn write(root: &Path) -> Result<Calibration, XtaskError> {
    let calibration = calibrate()?;
    files::write_atomically(&root.join(TABLE), &calibration.source())?;
    Ok(calibration)
}

/// Fits the model anew and compares with the stored table: the lines that differ.
///
/// # Errors
/// As [`write()`], and [`XtaskError::Read`] if there is no table.
pub fn check(root: &Path) -> Result<Vec<String>, XtaskError> {
    let stored = files::read(&root.join(TABLE))?;
    Ok(differences(&stored, &calibrate()?.source()))
}

/// Lines of two tables that differ by more than rounding.
fn differences(stored: &str, fitted: &str) -> Vec<String> {
    let count = stored.lines().count().max(fitted.lines().count());
    let line = |text: &str, i: usize| text.lines().nth(i).unwrap_or_default().to_owned();
    (0..count)
        .map(|i| (i + 1, line(stored, i), line(fitted, i)))
        .filter(|(_, a, b)| !same(a, b))
        .map(|(number, a, b)| {
            format!("{TABLE}:{number}: stored `{}`, fitted `{}`", a.trim(), b.trim())
        })
        .collect()
}

/// Whether two lines have the same words, and numbers near one another.
fn same(a: &str, b: &str) -> bool {
    let words = |line: &str| -> Vec<String> {
        line.split([',', '[', ']', ' ']).filter(|w| !w.is_empty()).map(str::to_owned).collect()
    };
    let (a, b) = (words(a), words(b));
    a.len() == b.len()
        && a.iter().zip(&b).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => (x - y).abs() <= SAME,
            _ => a == b,
        })
}

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

/// Largest errors of `Cn`, `Cm`, `Ch` in per cent of the magnitude of each load, `[k <= 0.3, k <= 1]`.
pub type ErrorBands = [[f64; 2]; 3];

/// Reduced frequencies at which the errors are taken.
const REDUCED_FREQUENCIES: [f64; 16] =
    [0.005, 0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0];

/// Motions with an error of their own, in the order of [`errors_of_flaps`].
const MOTIONS: [(Motion, exact_section::Motion); 3] = [
    (Motion::Flap, exact_section::Motion::Flap),
    (Motion::Pitch, exact_section::Motion::Pitch),
    (Motion::Plunge, exact_section::Motion::Plunge),
];

/// Largest errors against Possio's equation (Theodorsen's theory at Mach 0) of sections with several
/// flap chords: for each the errors of a flap motion, of pitch and of plunge.
///
/// # Errors
/// [`CheckError`] outside the theory or a model.
pub fn errors_of_flaps(
    model: AttachedFlowModel,
    mach: f64,
    flap_chords: &[f64],
) -> Result<Vec<[ErrorBands; 3]>, CheckError> {
    let sections = flap_chords
        .iter()
        .map(|e| Ok(model.coefficients(Mach::new(mach)?, FlapChord::new(*e)?)?))
        .collect::<Result<Vec<_>, CheckError>>()?;
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

/// Largest errors of a model over several flap chords: of a flap motion, of pitch
/// and of plunge.
///
/// # Errors
/// As [`errors_of_flaps`].
pub fn worst_over_flaps(
    model: AttachedFlowModel,
    mach: f64,
    flap_chords: &[f64],
) -> Result<[ErrorBands; 3], CheckError> {
    let mut worst = [ErrorBands::default(); 3];
    for errors in errors_of_flaps(model, mach, flap_chords)? {
        let pairs = worst.iter_mut().flatten().flatten().zip(errors.iter().flatten().flatten());
        for (worst, error) in pairs {
            *worst = worst.max(*error);
        }
    }
    Ok(worst)
}

/// The errors of one motion of one section.
///
/// # Errors
/// As [`errors_of_flaps`].
pub fn errors_against_possio(
    model: AttachedFlowModel,
    (mach, flap_chord): (f64, f64),
    motion: Motion,
) -> Result<ErrorBands, CheckError> {
    let errors = errors_of_flaps(model, mach, &[flap_chord])?;
    let place = MOTIONS.iter().position(|(m, _)| *m == motion);
    Ok(place.map_or_else(ErrorBands::default, |place| errors[0][place]))
}

/// Largest deviation of an indicial function from the exact first moments after a step, over its
/// start value; `None` where there is no closed form.
///
/// # Errors
/// [`CheckError`] outside the theory or a model.
pub fn short_time_deviation(
    model: AttachedFlowModel,
    (mach, flap_chord): (f64, f64),
    (load, mode): (usize, Mode),
) -> Result<Option<f64>, CheckError> {
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

/// The tables of errors of every compressible model.
///
/// # Errors
/// [`CheckError`] outside the theory or a model.
pub fn error_tables() -> Result<String, CheckError> {
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::ASCII_MARKDOWN);
    table.set_header(["model", "motion", "M", "E", "Cn, %", "Cm, %", "Ch, %"]);
    for model in MODELS {
        for motion in [Motion::Flap, Motion::Pitch, Motion::Plunge] {
            for (mach, flap_chord) in CONDITIONS {
                let errors = errors_against_possio(model, (mach, flap_chord), motion)?;
                let mut cells = vec![
                    model.name().to_owned(),
                    format!("{motion:?}").to_lowercase(),
                    mach.to_string(),
                    flap_chord.to_string(),
                ];
                cells.extend(errors.map(|[slow, fast]| format!("{slow:.1} / {fast:.1}")));
                table.add_row(cells);
            }
        }
    }
    let mut start = comfy_table::Table::new();
    start.load_style(comfy_table::presets::ASCII_MARKDOWN);
    let pairs: Vec<(usize, Mode)> =
        (0..3).flat_map(|load| Mode::ALL.map(|mode| (load, mode))).collect();
    let loads = ["Cn", "Cm", "Ch"];
    let modes = ["alpha", "q", "delta", "q_delta"];
    let names =
        pairs.iter().map(|(load, mode)| format!("{} {}", loads[*load], modes[mode.index()]));
    start.set_header(["model".to_owned(), "M".to_owned()].into_iter().chain(names));
    for model in MODELS {
        for mach in [0.3, 0.5, 0.7] {
            let mut cells = vec![model.name().to_owned(), mach.to_string()];
            for &pair in &pairs {
                let deviation = short_time_deviation(model, (mach, 0.2), pair)?;
                cells.push(deviation.map_or("-".to_owned(), |d| format!("{:.1}", 100.0 * d)));
            }
            start.add_row(cells);
        }
    }
    Ok(format!(
        "Largest error against Possio's equation, % of the magnitude of each load, k <= 0.3 / k <= 1\n\n\
         {table}\n\nLargest deviation from the exact first moments after a step, % of the start value, \
         E 0.2\n\n{start}\n"
    ))
}

impl From<ExactError> for XtaskError {
    fn from(source: ExactError) -> Self {
        Self::Exact { source }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flap_aero::{KNOWN_ERROR_FLAP_CHORDS, KNOWN_ERROR_MACHS, known_error_percent};

    #[test]
    fn the_stored_table_is_what_the_fit_gives() {
        let found = check(&crate::workspace::root()).unwrap();
        assert!(found.is_empty(), "{}", found.join("\n"));
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

    #[test]
    fn rounding_is_no_difference_and_anything_else_is() {
        let stored = "a [1.0, 2.0],\nb [3.0],";
        assert!(differences(stored, "a [1.000001, 2.0],\nb [3.0],").is_empty());
        assert_eq!(differences(stored, "a [1.001, 2.0],\nb [3.0],").len(), 1);
        assert_eq!(differences(stored, "a [1.0, 2.0],\nc [3.0],").len(), 1);
        assert_eq!(differences(stored, "a [1.0, 2.0],").len(), 1);
    }
}

//! Measured loops of pitching aerofoils, as tables by phase.

use crate::XtaskError;
use flap_aero::StallAirfoil;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::f64::consts::TAU;
use std::path::Path;

/// Lift, pressure drag and moment about the quarter chord.
pub const COEFFICIENTS: [&str; 3] = ["cl", "cd", "cm"];

/// One cycle, `mean + amplitude sin(phase)`.
#[derive(Debug, Clone)]
pub struct MeasuredLoop {
    /// Frame or run.
    pub id: String,
    /// Whose stall it is.
    pub airfoil: StallAirfoil,
    /// Mach number.
    pub mach: f64,
    /// By semichord.
    pub reduced_frequency: f64,
    /// Mean incidence, deg.
    pub mean_deg: f64,
    /// Amplitude, deg.
    pub amplitude_deg: f64,
    /// Phase in deg and value of each coefficient.
    pub values: [Vec<[f64; 2]>; 3],
}

#[derive(Deserialize)]
struct NasaRow {
    frame: String,
    airfoil: String,
    mach: f64,
    reduced_frequency: f64,
    mean_deg: f64,
    amplitude_deg: f64,
}

#[derive(Deserialize)]
struct Point {
    frame: String,
    coefficient: String,
    phase_deg: f64,
    value: f64,
}

#[derive(Deserialize)]
struct GlasgowRow {
    run: String,
    mach: f64,
    reduced_frequency: f64,
}

#[derive(Deserialize)]
struct Sample {
    alpha_deg: f64,
    cn: f64,
    ct: f64,
    cm: f64,
}

/// The loops of a folder: `nasa_index.csv` with `nasa_loops_by_phase.csv`, `glasgow_index.csv` with a table a run. Frames of
/// other aerofoils are left out.
///
/// # Errors
/// [`XtaskError::Read`] for a missing file, [`XtaskError::Study`] for a row that is not understood.
pub fn read(folder: &Path) -> Result<Vec<MeasuredLoop>, XtaskError> {
    let mut loops = Vec::new();
    for frame in table::<NasaRow>(&folder.join("nasa_index.csv"), b',')? {
        let airfoil = match frame.airfoil.as_str() {
            "NACA0012" => StallAirfoil::Naca0012Measured,
            "AMES-01" => StallAirfoil::Ames01,
            _ => continue,
        };
        loops.push(MeasuredLoop {
            id: frame.frame,
            airfoil,
            mach: frame.mach,
            reduced_frequency: frame.reduced_frequency,
            mean_deg: frame.mean_deg,
            amplitude_deg: frame.amplitude_deg,
            values: [const { Vec::new() }; 3],
        });
    }
    for point in table::<Point>(&folder.join("nasa_loops_by_phase.csv"), b',')? {
        let which = COEFFICIENTS.iter().position(|name| *name == point.coefficient);
        let of = loops.iter_mut().find(|of| of.id == point.frame);
        if let (Some(of), Some(which)) = (of, which) {
            of.values[which].push([point.phase_deg, point.value]);
        }
    }
    for run in table::<GlasgowRow>(&folder.join("glasgow_index.csv"), b',')? {
        let samples = table::<Sample>(&folder.join(format!("glasgow_{}.tsv", run.run)), b'\t')?;
        loops.push(of_samples(run, &samples));
    }
    Ok(loops)
}

/// A loop that is sampled evenly in time; its motion is the first harmonic of the incidence.
fn of_samples(run: GlasgowRow, samples: &[Sample]) -> MeasuredLoop {
    let count = samples.len() as f64;
    let phases = |n: usize| TAU * n as f64 / count;
    let mean_deg = samples.iter().map(|s| s.alpha_deg).sum::<f64>() / count;
    let (mut cosine, mut sine) = (0.0, 0.0);
    for (n, sample) in samples.iter().enumerate() {
        let (sin, cos) = phases(n).sin_cos();
        cosine += 2.0 / count * sample.alpha_deg * cos;
        sine += 2.0 / count * sample.alpha_deg * sin;
    }
    let ahead = cosine.atan2(sine);
    let mut values = [const { Vec::new() }; 3];
    for (n, sample) in samples.iter().enumerate() {
        let phase_deg = (phases(n) + ahead).to_degrees();
        let (sin, cos) = sample.alpha_deg.to_radians().sin_cos();
        let lift = sample.cn * cos + sample.ct * sin;
        let drag = sample.cn * sin - sample.ct * cos;
        for (of, value) in values.iter_mut().zip([lift, drag, sample.cm]) {
            of.push([phase_deg, value]);
        }
    }
    MeasuredLoop {
        id: run.run,
        airfoil: StallAirfoil::Naca23012a,
        mach: run.mach,
        reduced_frequency: run.reduced_frequency,
        mean_deg,
        amplitude_deg: cosine.hypot(sine),
        values,
    }
}

fn table<T: DeserializeOwned>(path: &Path, delimiter: u8) -> Result<Vec<T>, XtaskError> {
    let text = crate::files::read(path)?;
    let mut reader = csv::ReaderBuilder::new().delimiter(delimiter).from_reader(text.as_bytes());
    let rows = reader.deserialize().collect::<Result<Vec<T>, csv::Error>>();
    rows.map_err(|error| XtaskError::Study(format!("{}: {error}", path.display())))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sine whose first sample is anywhere keeps its phase: lowest incidence at -90 deg.
    #[test]
    fn the_phase_of_samples_is_that_of_their_incidence() {
        let samples: Vec<Sample> = (0..64)
            .map(|n| {
                let alpha_deg = 10.0 + 8.0 * (TAU * f64::from(n) / 64.0 - 1.3).sin();
                Sample { alpha_deg, cn: alpha_deg, ct: 0.0, cm: 0.0 }
            })
            .collect();
        let run = GlasgowRow { run: "a".to_owned(), mach: 0.1, reduced_frequency: 0.1 };
        let found = of_samples(run, &samples);
        assert!((found.mean_deg - 10.0).abs() < 1e-12, "{}", found.mean_deg);
        assert!((found.amplitude_deg - 8.0).abs() < 1e-12, "{}", found.amplitude_deg);
        let (phase, sample) = (found.values[2][7][0].to_radians(), &samples[7]);
        assert!((10.0 + 8.0 * phase.sin() - sample.alpha_deg).abs() < 1e-9);
    }
}

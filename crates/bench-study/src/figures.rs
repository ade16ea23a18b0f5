//! Data of the figures of an identification, as CSV tables for any plotting program.
//!
//! | file | columns |
//! |---|---|
//! | `loop_RUN.csv` | time, input, measured and simulated output, residual (measured less simulated), 1 for the samples judged and 0 outside the run's window |
//! | `forc_diagram.csv` | of reversal curves: reversal, input, half-width, centre, density |
//! | `residual_spectrum.csv` | run, frequency (Hz), rms of the residual's lines in the band about it, noise of repeated cycles |
//! | `forc_RUN.csv` | of a run that holds reversal curves: as `forc_diagram.csv` |
//! | `static_density.csv` | of the static Preisach model fitted beside: the columns of `density.csv`, standard deviation of the rise by noise, share of it that comes from the records |
//! | `density.csv` | half-width and centre of the cells of the Preisach triangle, rise and density, of the model or, if its law has none, of the static Preisach model fitted beside it |
//!
//! A record that begins at switch-on has its sample at 0 V first; its times are later by one step.
//! Columns carry their units: V and deg for an actuator, those of the data for a generic loop.

use crate::BenchError;
use crate::diagram::DiagramPoint;
use crate::identification::BenchIdentification;
use crate::reversals::of_records;
use crate::spectra::{spectra, spectra_csv};
use preisach_dyn::{ActuatorLaw, PlayMap, PreisachError, PreisachGrid};
use rayon::prelude::*;
use std::fmt::Write;

/// Names and texts of the tables.
///
/// # Errors
/// [`BenchError::Actuator`] or [`BenchError::Loop`] if the model cannot be simulated on one of its records.
pub fn figure_files(found: &BenchIdentification) -> Result<Vec<(String, String)>, BenchError> {
    let fail = |source: PreisachError| found.heading.failed(source);
    let simulated = found.simulated()?;
    let numbers = 0..found.records.len();
    let mut files: Vec<(String, String)> = numbers
        .into_par_iter()
        .map(|number| loop_table(found, number, &simulated[number]))
        .collect();
    files.extend(density_table(found).map_err(fail)?);
    let (input, _, unit) = labels(found);
    let spectra = spectra_csv(&spectra(found, &simulated), &unit);
    files.push(("residual_spectrum.csv".to_owned(), spectra));
    for own in of_records(&found.records) {
        files.push((format!("forc_{}.csv", own.id), diagram_csv(&own.points, &input)));
    }
    files.extend(spread_table(found));
    Ok(files)
}

/// The density of the static model with its deviation, where that was computed.
fn spread_table(found: &BenchIdentification) -> Option<(String, String)> {
    let spread = found.identification.density_spread.as_ref()?;
    let ActuatorLaw::StaticPreisach(model) = &found.identification.static_only.law else {
        return None;
    };
    let (input, _, unit) = labels(found);
    let cells = density_csv(model.grid(), model.map(), &input, &unit);
    let of = |values: &[Vec<Option<f64>>]| -> Vec<String> {
        let text = |own: &Option<f64>| own.map_or_else(String::new, |own| format!("{own:.9e}"));
        values.iter().flatten().map(text).collect()
    };
    let heads = (format!("rise_sd{unit}"), "record_share".to_owned());
    let columns = of(&spread.rise_std_deg).into_iter().zip(of(&spread.record_share));
    let mut text = String::new();
    for (line, (deviation, share)) in cells.lines().zip(std::iter::once(heads).chain(columns)) {
        let _ = writeln!(text, "{line},{deviation},{share}");
    }
    Some(("static_density.csv".to_owned(), text))
}

/// Labels of input and output, and the unit of the output alone with its underscore.
fn labels(found: &BenchIdentification) -> (String, String, String) {
    match &found.heading.channels {
        Some(channels) => {
            let [_, unit] = found.heading.subject().units();
            (channels.input.clone(), channels.output.clone(), format!("_{unit}"))
        }
        None => ("command_V".to_owned(), "flap_deg".to_owned(), "_deg".to_owned()),
    }
}

/// One record against its simulation, from its first sample on.
fn loop_table(found: &BenchIdentification, number: usize, simulated: &[f64]) -> (String, String) {
    let record = &found.records[number];
    let zero_deg = found.identification.zero_deg;
    let (input, output, unit) = labels(found);
    let mut text =
        format!("time_s,{input},measured_{output},simulated_{output},residual{unit},judged\n");
    let window = record.judged_samples();
    let samples = record.voltage_volt.iter().zip(&record.output_deg).zip(simulated);
    for (i, ((u, measured), simulated)) in samples.enumerate() {
        let time_s = record.time_step_s * i as f64;
        let measured = measured - zero_deg;
        let residual = measured - simulated;
        let judged = u8::from(window.contains(&i));
        let _ = writeln!(
            text,
            "{time_s:.9},{u:.9e},{measured:.9e},{simulated:.9e},{residual:.3e},{judged}"
        );
    }
    (format!("loop_{}.csv", record.id), text)
}

/// The static density of the model, cell by cell; for a law without one that of the static Preisach
/// model fitted beside it.
fn density_table(found: &BenchIdentification) -> Result<Option<(String, String)>, PreisachError> {
    let of = |law: &ActuatorLaw| match law {
        ActuatorLaw::StaticPreisach(model) => Ok(Some(model.clone())),
        ActuatorLaw::DynamicPreisach(model) => model.static_part().map(Some),
        _ => Ok(None),
    };
    let beside = || of(&found.identification.static_only.law);
    let model = of(&found.model.law)?.map_or_else(beside, |model| Ok(Some(model)))?;
    let Some(model) = model else { return Ok(None) };
    let (input, _, unit) = labels(found);
    let text = density_csv(model.grid(), model.map(), &input, &unit);
    Ok(Some(("density.csv".to_owned(), text)))
}

/// The cells of a Preisach triangle.
///
/// `rise` is the output's rise when the play crosses the cell, the integral of `2 mu`; `density` is
/// `mu = rise / (2 c^2)` with the cell's side `c`. The cells of half-width 0 are the reversible part:
/// their density is the same rise spread over a whole cell.
pub fn density_csv(grid: &PreisachGrid, map: &PlayMap, input: &str, unit: &str) -> String {
    let cell = grid.cell_volt();
    let mut text = format!("half_width_{input},centre_{input},rise{unit},density\n");
    for (play, rises) in map.rises().iter().enumerate() {
        for (knot, rise) in rises.iter().enumerate() {
            let centre = 0.5 * (grid.knot_volt(play, knot) + grid.knot_volt(play, knot + 1));
            let half_width = grid.half_width_volt(play);
            let density = rise / (2.0 * cell * cell);
            let _ = writeln!(text, "{half_width:.9e},{centre:.9e},{rise:.9e},{density:.9e}");
        }
    }
    text
}

/// A FORC diagram: reversal and input of every point, half-width and centre of the relays there, and
/// the density, output per squared input.
pub fn diagram_csv(points: &[DiagramPoint], input: &str) -> String {
    let mut text = format!("reversal_{input},{input},half_width_{input},centre_{input},density\n");
    for p in points {
        let _ = writeln!(
            text,
            "{:.9e},{:.9e},{:.9e},{:.9e},{:.9e}",
            p.reversal_input, p.input, p.half_width, p.centre, p.density
        );
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::VoltageRange;

    /// The rises of all cells add up to the output between the saturations, and the density times
    /// twice the area to the same.
    #[test]
    fn the_density_adds_up_to_the_stroke() {
        let grid = PreisachGrid::new(VoltageRange::new(-1.0, 3.0).unwrap(), 4).unwrap();
        let rises: Vec<Vec<f64>> = (0..4).map(|j| vec![0.5 + j as f64; 4 - j]).collect();
        let map = PlayMap::from_rises(&grid, 0.0, &rises).unwrap();
        let text = density_csv(&grid, &map, "field_Oe", "_emu");
        assert!(text.starts_with("half_width_field_Oe,centre_field_Oe,rise_emu,density\n"));
        let rows: Vec<Vec<f64>> = text
            .lines()
            .skip(1)
            .map(|l| l.split(',').map(|f| f.parse().unwrap()).collect())
            .collect();
        assert_eq!(rows.len(), 10);
        let stroke: f64 = rises.iter().flatten().sum();
        let (rise, twice): (f64, f64) =
            (rows.iter().map(|r| r[2]).sum(), rows.iter().map(|r| 2.0 * r[3]).sum());
        assert!((rise - stroke).abs() < 1e-8 && (twice - stroke).abs() < 1e-8);
        // the first cell of play 1: half-width c/2, between u_min + c/2 and u_min + 3c/2
        assert_eq!(rows[4][..2], [0.5, 0.0]);
    }
}

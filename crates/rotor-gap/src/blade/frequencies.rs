//! What was measured of the modes of a blade.

use crate::error::RotorGapError;
use measured_data::{PointData, Scatter};
use model_gap::points::{Grid, Point};
use rotor_case::ModeNumbers;

const SPEED: &str = "rotor_speed_rpm";
const MODE: &str = "mode";
const FREQUENCY: &str = "frequency_hz";
const KINDS: [&str; 3] = ["flap", "lag", "torsion"];
/// Highest mode of a kind that is looked for.
const HIGHEST: usize = 12;

/// Frequencies by rotor speed and mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Frequencies {
    /// Rotor speeds, rpm; one that was measured again is there again.
    pub speeds_rpm: Vec<f64>,
    /// Whether what is looked for does not act, by speed.
    pub references: Vec<bool>,
    /// Names of the modes, such as `flap 2`.
    pub modes: Vec<String>,
    /// Frequency, Hz, by speed and mode, with its place among the rows; none where it was not measured.
    pub read: Vec<Vec<Option<(usize, f64)>>>,
    /// How sure the rows are.
    pub scatter: Scatter,
}

impl Frequencies {
    /// Of a table with a row for each mode at each speed.
    ///
    /// # Errors
    /// [`RotorGapError::Column`]: a column that is missing or not known, a mode that is none, a blank speed.
    pub fn of(data: &PointData) -> Result<Self, RotorGapError> {
        let refused =
            |name: &str, reason: String| RotorGapError::Column { name: name.to_owned(), reason };
        let known = [SPEED, FREQUENCY];
        if let Some(own) = data.columns.iter().find(|own| !known.contains(&own.name.as_str())) {
            let reason = format!("expected {SPEED}, {MODE}, {FREQUENCY}, frequency_sd_hz");
            return Err(refused(&own.name, reason));
        }
        let column = |name: &str| {
            let found = data.columns.iter().find(|own| own.name == name);
            found.ok_or_else(|| refused(name, "it is missing".to_owned()))
        };
        let (speeds, frequencies) = (column(SPEED)?, column(FREQUENCY)?);
        let names = data.table.text_column(MODE);
        let names = names.ok_or_else(|| refused(MODE, "it is missing".to_owned()))?;
        let mut own = Self {
            speeds_rpm: Vec::new(),
            references: Vec::new(),
            modes: Vec::new(),
            read: Vec::new(),
            scatter: frequencies.scatter.clone(),
        };
        for (row, name) in names.iter().enumerate() {
            let mode = numbered_mode(name).ok_or_else(|| {
                let reason = format!(
                    "row {}: `{name}` is no mode: flap, lag or torsion and its number, such as `flap 2`",
                    row + 1
                );
                refused(MODE, reason)
            })?;
            let speed = speeds.values[row].filter(|own| *own >= 0.0).ok_or_else(|| {
                refused(SPEED, format!("row {}: expected a speed of 0 or more", row + 1))
            })?;
            if let Some(value) = frequencies.values[row] {
                own.add((speed, data.references[row], mode), (row, value));
            }
        }
        if own.speeds_rpm.is_empty() {
            return Err(refused(FREQUENCY, "no frequency was read".to_owned()));
        }
        Ok(own)
    }

    fn add(&mut self, (speed_rpm, is_reference, mode): (f64, bool, String), value: (usize, f64)) {
        let column = self.modes.iter().position(|own| *own == mode).unwrap_or_else(|| {
            self.modes.push(mode);
            for row in &mut self.read {
                row.push(None);
            }
            self.modes.len() - 1
        });
        let is_free = |row: usize| {
            let is_same = self.speeds_rpm[row].to_bits() == speed_rpm.to_bits();
            let is_same = is_same && self.references[row] == is_reference;
            is_same && self.read[row][column].is_none()
        };
        let row = (0..self.read.len()).find(|&row| is_free(row)).unwrap_or_else(|| {
            self.speeds_rpm.push(speed_rpm);
            self.references.push(is_reference);
            self.read.push(vec![None; self.modes.len()]);
            self.read.len() - 1
        });
        self.read[row][column] = Some(value);
    }

    /// Lets a blade have the modes that were measured.
    pub(super) fn widen(&self, modes: &mut ModeNumbers) {
        for own in &self.modes {
            let Some((kind, number)) = own.split_once(' ') else { continue };
            let number = number.parse().unwrap_or(1);
            let count = match kind {
                "flap" => &mut modes.flap,
                "lag" => &mut modes.lag,
                _ => &mut modes.torsion,
            };
            *count = number.max(*count);
        }
    }

    /// The points of the engine: one for each speed.
    pub(super) fn points(&self, predicted: &Grid) -> Vec<Point> {
        let rows: usize =
            self.read.iter().flatten().flatten().map(|own| own.0 + 1).max().unwrap_or(0);
        let (mut values, mut simulated) = (vec![None; rows], vec![0.0; rows]);
        for (point, row) in self.read.iter().enumerate() {
            for (mode, (place, value)) in
                row.iter().enumerate().filter_map(|(m, v)| Some((m, (*v)?)))
            {
                values[place] = Some(value);
                simulated[place] = predicted[point][mode];
            }
        }
        let deviations = self.scatter.deviations(&values, &simulated);
        let usual = (rotor_base::mean_square(&deviations)).sqrt();
        let of_speed = |(point, row): (usize, &Vec<Option<(usize, f64)>>)| Point {
            id: format!("{} rpm", self.speeds_rpm[point]),
            group: self
                .speeds_rpm
                .iter()
                .position(|own| own.to_bits() == self.speeds_rpm[point].to_bits())
                .unwrap_or(point),
            is_reference: self.references[point],
            conditions: vec![self.speeds_rpm[point]],
            measured: row.iter().map(|own| own.map(|own| own.1)).collect(),
            deviation: row.iter().map(|own| own.map_or(usual, |own| deviations[own.0])).collect(),
        };
        self.read.iter().enumerate().map(of_speed).collect()
    }
}

/// The name of a mode as the simulation numbers it: `Flap 2`, `flap_2` and `flap2` are `flap 2`.
fn numbered_mode(name: &str) -> Option<String> {
    let name = name.trim().to_lowercase();
    let kind = KINDS.into_iter().find(|own| name.starts_with(own))?;
    let number = name[kind.len()..].trim_matches([' ', '_']).parse::<usize>().ok()?;
    (1..=HIGHEST).contains(&number).then(|| format!("{kind} {number}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use measured_data::{DatasetKind, Source};

    fn read(text: &str) -> Result<Frequencies, RotorGapError> {
        let source = Source { name: "a.csv".into(), text: text.into() };
        Frequencies::of(
            &PointData::read_with(&source, DatasetKind::BladeFrequencies.words()).unwrap(),
        )
    }

    #[test]
    fn rows_make_speeds_and_modes() {
        let own = read(
            "rotor_speed_rpm,mode,frequency_hz,frequency_sd_hz\n0,flap 1,1.4,0.1\n0,Flap_2,10,0.2\n500,flap 2,25,0.3\n0,flap 1,1.5,0.1\n",
        );
        let own = own.unwrap();
        assert_eq!(own.speeds_rpm, [0.0, 500.0, 0.0]);
        assert_eq!(own.modes, ["flap 1", "flap 2"]);
        assert_eq!(own.read[1], [None, Some((2, 25.0))]);
        let points = own.points(&vec![vec![1.0, 9.0]; 3]);
        assert_eq!((points[2].group, points[1].deviation[1]), (0, 0.3));
        assert_eq!(points[2].measured, [Some(1.5), None]);
    }

    #[test]
    fn what_is_no_mode_is_refused() {
        let text = |text: &str| read(text).unwrap_err().to_string();
        let head = "rotor_speed_rpm,mode,frequency_hz";
        assert!(text(&format!("{head}\n0,bending,1\n")).contains("`bending` is no mode"));
        assert!(text(&format!("{head}\n,flap 1,1\n")).contains("row 1: expected a speed"));
        assert!(text(&format!("{head},torque_Nm\n0,flap 1,1,2\n")).contains("frequency_sd_hz"));
        assert!(text(&format!("{head}\n0,flap 1,\n")).contains("no frequency"));
    }
}

//! Induced inflow over the disk as a table.

use super::check_table;
use crate::WakeError;
use crate::WakeRotor;
use rotor_base::HarmonicSeries;

/// Induced inflow at the middles of the panels and at uniform azimuths, tip speed, down positive.
///
/// Between azimuths the value follows the harmonics of the table, between stations a straight line;
/// beyond the first and the last station it stays what it is there.
#[derive(Debug, Clone, PartialEq)]
pub struct InflowMap {
    stations: Vec<f64>,
    widths: Vec<f64>,
    values: Vec<f64>,
    series: Vec<HarmonicSeries>,
}

impl InflowMap {
    /// A table of given values, azimuth by azimuth.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a count that does not fit the panels or a value that is not finite.
    pub fn new(rotor: &WakeRotor, values: Vec<f64>) -> Result<Self, WakeError> {
        let panels = rotor.panels();
        check_table(["number of inflow values", "inflow value"], panels, &values)?;
        let series = series(&values, panels);
        Ok(Self { stations: rotor.stations(), widths: rotor.widths(), values, series })
    }

    /// A table of the same shape with other values.
    ///
    /// # Errors
    /// [`WakeError::ParameterCount`] if the count differs.
    pub(crate) fn with_values(&self, values: &[f64]) -> Result<Self, WakeError> {
        if values.len() != self.values.len() {
            let (expected, got) = (self.values.len(), values.len());
            return Err(WakeError::ParameterCount { expected, got });
        }
        let series = series(values, self.stations.len());
        Ok(Self { values: values.to_vec(), series, ..self.clone() })
    }

    /// Number of azimuths.
    pub fn azimuths(&self) -> usize {
        self.values.len() / self.stations.len()
    }

    /// Stations, unit `R`.
    pub fn stations(&self) -> &[f64] {
        &self.stations
    }

    /// All values, azimuth by azimuth.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Along the span at one azimuth of the table.
    pub fn row(&self, azimuth: usize) -> &[f64] {
        let panels = self.stations.len();
        &self.values[azimuth * panels..(azimuth + 1) * panels]
    }

    /// Induced inflow at several stations (unit `R`) of one azimuth, rad.
    pub fn along(&self, azimuth_rad: f64, stations: &[f64]) -> Vec<f64> {
        let table: Vec<f64> = self.series.iter().map(|s| s.value(azimuth_rad)).collect();
        let between = |&r: &f64| {
            let (a, b, t) = self.place(r);
            table[a] + t * (table[b] - table[a])
        };
        stations.iter().map(between).collect()
    }

    /// Induced inflow at one azimuth (rad) and station (unit `R`).
    pub fn at(&self, azimuth_rad: f64, r: f64) -> f64 {
        let (a, b, t) = self.place(r);
        let (low, high) = (self.series[a].value(azimuth_rad), self.series[b].value(azimuth_rad));
        low + t * (high - low)
    }

    fn place(&self, r: f64) -> (usize, usize, f64) {
        let last = self.stations.len() - 1;
        let above = self.stations.partition_point(|x| *x <= r);
        if above == 0 {
            return (0, 0, 0.0);
        }
        if above > last {
            return (last, last, 0.0);
        }
        let (low, high) = (self.stations[above - 1], self.stations[above]);
        (above - 1, above, (r - low) / (high - low))
    }

    /// Mean over the annulus of the lifting span, by area.
    pub fn mean(&self) -> f64 {
        let (mut sum, mut area) = (0.0, 0.0);
        for (k, value) in self.values.iter().enumerate() {
            let s = k % self.stations.len();
            let weight = self.stations[s] * self.widths[s];
            sum += weight * value;
            area += weight;
        }
        sum / area
    }
}

/// All harmonics of each panel that the azimuths resolve.
fn series(values: &[f64], panels: usize) -> Vec<HarmonicSeries> {
    let count = (values.len() / panels).saturating_sub(1) / 2;
    let of = |panel: usize| {
        let column: Vec<f64> = values.iter().skip(panel).step_by(panels).copied().collect();
        HarmonicSeries::from_uniform_samples(&column, count).unwrap_or_default()
    };
    (0..panels).map(of).collect()
}

//! Induced inflow over the disk as a table.

use super::check_table;
use crate::WakeError;
use crate::WakeRotor;
use rotor_base::{harmonic_waves, uniform_azimuths_rad};
use std::sync::OnceLock;

/// Induced inflow at the middles of the panels and at uniform azimuths, tip speed, down positive.
///
/// Between azimuths the value follows the harmonics of the table, between stations a straight line;
/// beyond the first and the last station it stays what it is there.
#[derive(Debug, Clone)]
pub struct InflowMap {
    stations: Vec<f64>,
    widths: Vec<f64>,
    values: Vec<f64>,
    /// All harmonics that the azimuths resolve, once they are asked for: [`harmonic_waves`] by panels.
    harmonics: OnceLock<Vec<f64>>,
}

impl PartialEq for InflowMap {
    fn eq(&self, other: &Self) -> bool {
        let own = (&self.stations, &self.widths, &self.values);
        own == (&other.stations, &other.widths, &other.values)
    }
}

impl InflowMap {
    /// A table of given values, azimuth by azimuth.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a count that does not fit the panels or a value that is not finite.
    pub fn new(rotor: &WakeRotor, values: Vec<f64>) -> Result<Self, WakeError> {
        let panels = rotor.panels();
        check_table(["number of inflow values", "inflow value"], panels, &values)?;
        let harmonics = OnceLock::new();
        Ok(Self { stations: rotor.stations(), widths: rotor.widths(), values, harmonics })
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
        let (stations, widths) = (self.stations.clone(), self.widths.clone());
        Ok(Self { stations, widths, values: values.to_vec(), harmonics: OnceLock::new() })
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
        let table = self.of_panels(azimuth_rad);
        let between = |&r: &f64| {
            let (a, b, t) = self.place(r);
            table[a] + t * (table[b] - table[a])
        };
        stations.iter().map(between).collect()
    }

    /// Induced inflow at one azimuth (rad) and station (unit `R`).
    pub fn at(&self, azimuth_rad: f64, r: f64) -> f64 {
        let (a, b, t) = self.place(r);
        let table = self.of_panels(azimuth_rad);
        table[a] + t * (table[b] - table[a])
    }

    /// Number of harmonics that the azimuths resolve.
    fn resolved(&self) -> usize {
        self.azimuths().saturating_sub(1) / 2
    }

    /// Induced inflow at the panels at an azimuth, rad.
    fn of_panels(&self, azimuth_rad: f64) -> Vec<f64> {
        let panels = self.stations.len();
        let harmonics = self.harmonics.get_or_init(|| self.harmonics());
        let mut sums = vec![0.0; panels];
        for (wave, row) in
            harmonic_waves(azimuth_rad, self.resolved()).zip(harmonics.chunks_exact(panels))
        {
            for (sum, coefficient) in sums.iter_mut().zip(row) {
                *sum += wave * coefficient;
            }
        }
        sums
    }

    /// All harmonics of each panel that the azimuths resolve, harmonic by harmonic.
    fn harmonics(&self) -> Vec<f64> {
        let (panels, azimuths) = (self.stations.len(), self.azimuths());
        let mut sums = vec![0.0; (1 + 2 * self.resolved()) * panels];
        for (azimuth, row) in
            uniform_azimuths_rad(azimuths).into_iter().zip(self.values.chunks_exact(panels))
        {
            let waves = harmonic_waves(azimuth, self.resolved());
            for (k, (sums, wave)) in sums.chunks_exact_mut(panels).zip(waves).enumerate() {
                let weight = wave * if k == 0 { 1.0 } else { 2.0 } / azimuths as f64;
                for (sum, value) in sums.iter_mut().zip(row) {
                    *sum += weight * value;
                }
            }
        }
        sums
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

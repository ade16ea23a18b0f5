//! Induced inflow over the disk as a table.

use super::check_table;
use crate::WakeError;
use crate::WakeRotor;
use rotor_base::{harmonic_waves, uniform_azimuths_rad};
use std::sync::OnceLock;

/// Mean by area of values at panels of given stations and widths, again and again around the disk.
pub(crate) fn mean_over_disk(stations: &[f64], widths: &[f64], values: &[f64]) -> f64 {
    let (mut sum, mut area) = (0.0, 0.0);
    for (k, value) in values.iter().enumerate() {
        let s = k % stations.len();
        let weight = stations[s] * widths[s];
        sum += weight * value;
        area += weight;
    }
    sum / area
}

/// Induced velocity at the middles of the panels and at uniform azimuths, tip speed: inflow, down positive,
/// and where it is known the velocity in the plane of the disk across the blade, from the leading to the
/// trailing edge positive.
///
/// Between azimuths the values follow the harmonics of the table, between stations a straight line;
/// beyond the first and the last station they stay what they are there.
#[derive(Debug, Clone, PartialEq)]
pub struct InflowMap {
    stations: Vec<f64>,
    widths: Vec<f64>,
    down: Table,
    /// None: there is no velocity in the plane.
    in_plane: Option<Table>,
}

/// Values azimuth by azimuth.
#[derive(Debug, Clone)]
struct Table {
    panels: usize,
    values: Vec<f64>,
    /// All harmonics that the azimuths resolve, once they are asked for: [`harmonic_waves`] by panels.
    harmonics: OnceLock<Vec<f64>>,
}

impl PartialEq for Table {
    fn eq(&self, other: &Self) -> bool {
        (self.panels, &self.values) == (other.panels, &other.values)
    }
}

impl Table {
    fn new(panels: usize, values: Vec<f64>) -> Result<Self, WakeError> {
        check_table(["number of inflow values", "inflow value"], panels, &values)?;
        Ok(Self { panels, values, harmonics: OnceLock::new() })
    }

    fn azimuths(&self) -> usize {
        self.values.len() / self.panels
    }

    /// Number of harmonics that the azimuths resolve.
    fn resolved(&self) -> usize {
        self.azimuths().saturating_sub(1) / 2
    }

    /// Values at the panels at an azimuth, rad.
    fn of_panels(&self, azimuth_rad: f64) -> Vec<f64> {
        let harmonics = self.harmonics.get_or_init(|| self.harmonics());
        let mut sums = vec![0.0; self.panels];
        for (wave, row) in
            harmonic_waves(azimuth_rad, self.resolved()).zip(harmonics.chunks_exact(self.panels))
        {
            for (sum, coefficient) in sums.iter_mut().zip(row) {
                *sum += wave * coefficient;
            }
        }
        sums
    }

    /// All harmonics of each panel that the azimuths resolve, harmonic by harmonic.
    fn harmonics(&self) -> Vec<f64> {
        let (panels, azimuths) = (self.panels, self.azimuths());
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
}

impl InflowMap {
    /// A table of given inflow, azimuth by azimuth, without velocity in the plane of the disk.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a count that does not fit the panels or a value that is not finite.
    pub fn new(rotor: &WakeRotor, values: Vec<f64>) -> Result<Self, WakeError> {
        let down = Table::new(rotor.panels(), values)?;
        Ok(Self { stations: rotor.stations(), widths: rotor.widths(), down, in_plane: None })
    }

    /// The same with a velocity in the plane of the disk, azimuth by azimuth, from the leading to the trailing
    /// edge, tip speed.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] for a count that does not fit the panels, a value that is not finite;
    /// [`WakeError::ParameterCount`] for other azimuths than those of the inflow.
    pub fn with_in_plane(self, values: Vec<f64>) -> Result<Self, WakeError> {
        let (expected, got) = (self.down.values.len(), values.len());
        if expected != got {
            return Err(WakeError::ParameterCount { expected, got });
        }
        let in_plane = Some(Table::new(self.stations.len(), values)?);
        Ok(Self { in_plane, ..self })
    }

    /// A table of the same shape with other [`parameters`](Self::parameters).
    ///
    /// # Errors
    /// [`WakeError::ParameterCount`] if the count differs.
    pub(crate) fn with_parameters(&self, parameters: &[f64]) -> Result<Self, WakeError> {
        let size = self.down.values.len();
        let expected = if self.in_plane.is_some() { 2 * size } else { size };
        if parameters.len() != expected {
            return Err(WakeError::ParameterCount { expected, got: parameters.len() });
        }
        let table = |values: &[f64]| Table::new(self.stations.len(), values.to_vec());
        let (down, in_plane) = parameters.split_at(size);
        let in_plane = self.in_plane.as_ref().map(|_| table(in_plane)).transpose()?;
        let (stations, widths) = (self.stations.clone(), self.widths.clone());
        Ok(Self { stations, widths, down: table(down)?, in_plane })
    }

    /// All values: the inflow, then the velocity in the plane if there is one, each azimuth by azimuth.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        let in_plane = self.in_plane.iter().flat_map(|table| &table.values);
        self.down.values.iter().chain(in_plane).copied().collect()
    }

    /// Number of azimuths.
    pub fn azimuths(&self) -> usize {
        self.down.azimuths()
    }

    /// Stations, unit `R`.
    pub fn stations(&self) -> &[f64] {
        &self.stations
    }

    /// All values of the inflow, azimuth by azimuth.
    pub fn values(&self) -> &[f64] {
        &self.down.values
    }

    /// All values of the velocity in the plane of the disk, azimuth by azimuth; none if it is left out.
    pub fn in_plane_values(&self) -> Option<&[f64]> {
        self.in_plane.as_ref().map(|table| table.values.as_slice())
    }

    /// Inflow along the span at one azimuth of the table.
    pub fn row(&self, azimuth: usize) -> &[f64] {
        let panels = self.stations.len();
        &self.down.values[azimuth * panels..(azimuth + 1) * panels]
    }

    /// Induced velocity down through the disk and in its plane at several stations (unit `R`) of one azimuth,
    /// rad.
    pub fn velocities(&self, azimuth_rad: f64, stations: &[f64]) -> Vec<[f64; 2]> {
        let down = self.down.of_panels(azimuth_rad);
        let in_plane = self.in_plane.as_ref().map(|table| table.of_panels(azimuth_rad));
        let at = |&r: &f64| {
            let (a, b, t) = self.place(r);
            let between = |table: &[f64]| table[a] + t * (table[b] - table[a]);
            [between(&down), in_plane.as_deref().map_or(0.0, between)]
        };
        stations.iter().map(at).collect()
    }

    /// Induced inflow at one azimuth (rad) and station (unit `R`).
    pub fn at(&self, azimuth_rad: f64, r: f64) -> f64 {
        self.velocities(azimuth_rad, &[r])[0][0]
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
        mean_over_disk(&self.stations, &self.widths, &self.down.values)
    }
}

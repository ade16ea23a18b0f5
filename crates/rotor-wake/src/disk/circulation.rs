//! Circulation over the disk.

use super::check_table;
use crate::WakeError;
use crate::WakeRotor;
use crate::error::ensure;

/// Bound circulation of a blade against its azimuth, `Gamma / (Omega R^2)`, positive with lift up.
///
/// Values at uniform azimuths from 0 and at the middles of the spanwise panels: `[azimuth][panel]`.
#[derive(Debug, Clone, PartialEq)]
pub struct CirculationMap {
    panels: usize,
    values: Vec<f64>,
}

impl CirculationMap {
    /// A map of given values, azimuth by azimuth.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] if the count is no multiple of `panels` or a value is not finite.
    pub fn new(panels: usize, values: Vec<f64>) -> Result<Self, WakeError> {
        check_table(["number of circulations", "circulation"], panels, &values)?;
        Ok(Self { panels, values })
    }

    /// The map of a function of the azimuth index and the panel.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn from_fn(
        azimuths: usize,
        panels: usize,
        f: impl Fn(usize, usize) -> f64,
    ) -> Result<Self, WakeError> {
        let values = (0..azimuths * panels).map(|k| f(k / panels.max(1), k % panels.max(1)));
        Self::new(panels, values.collect())
    }

    /// The same circulation everywhere.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn constant(azimuths: usize, panels: usize, value: f64) -> Result<Self, WakeError> {
        Self::new(panels, vec![value; azimuths * panels])
    }

    /// Elliptic along the span, of a thrust coefficient and without rolling moment.
    ///
    /// ```text
    /// Gamma = G sqrt((r - r_0) (1 - r)) (1 - b sin psi),      b: sum of r (r + mu sin psi) sin psi Gamma vanishes
    /// ```
    ///
    /// # Errors
    /// As [`new`](Self::new); none for a rotor.
    pub fn elliptic(
        rotor: &WakeRotor,
        azimuths: usize,
        thrust_coefficient: f64,
        advance_ratio: f64,
    ) -> Result<Self, WakeError> {
        let (stations, widths, root) = (rotor.stations(), rotor.widths(), rotor.nodes()[0]);
        let shape: Vec<f64> = stations.iter().map(|r| ((r - root) * (1.0 - r)).sqrt()).collect();
        let moment = |power: i32| -> f64 {
            let terms = stations.iter().zip(&widths).zip(&shape);
            terms.map(|((r, dr), gamma)| r.powi(power) * gamma * dr).sum()
        };
        let balance = advance_ratio * moment(1) / moment(2);
        let of = |scale: f64| {
            Self::from_fn(azimuths, shape.len(), |i, s| {
                let sin = (std::f64::consts::TAU * i as f64 / azimuths as f64).sin();
                scale * shape[s] * (1.0 - balance * sin)
            })
        };
        of(thrust_coefficient / of(1.0)?.thrust_coefficient(rotor, advance_ratio))
    }

    /// Number of azimuths.
    pub fn azimuths(&self) -> usize {
        self.values.len() / self.panels
    }

    /// Number of panels.
    pub fn panels(&self) -> usize {
        self.panels
    }

    /// All values, azimuth by azimuth.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Along the span at one azimuth.
    pub fn row(&self, azimuth: usize) -> &[f64] {
        &self.values[azimuth * self.panels..(azimuth + 1) * self.panels]
    }

    /// Thrust coefficient of this circulation by Kutta and Joukowski's law in the undisturbed rotor
    /// speed and free stream.
    ///
    /// ```text
    /// C_T = N_b/pi  mean over psi of  sum (r + mu sin psi) Gamma dr
    /// ```
    pub fn thrust_coefficient(&self, rotor: &WakeRotor, advance_ratio: f64) -> f64 {
        let (stations, widths) = (rotor.stations(), rotor.widths());
        let count = self.azimuths();
        let mut sum = 0.0;
        for i in 0..count {
            let sin = (std::f64::consts::TAU * i as f64 / count as f64).sin();
            for ((gamma, r), dr) in self.row(i).iter().zip(&stations).zip(&widths) {
                sum += (r + advance_ratio * sin) * gamma * dr;
            }
        }
        rotor.blades() as f64 / std::f64::consts::PI * sum / count as f64
    }

    /// The share `part` of this circulation and the rest of another one of the same grid.
    ///
    /// # Errors
    /// [`WakeError::BadInput`] if the grids differ.
    pub fn mixed(&self, other: &Self, part: f64) -> Result<Self, WakeError> {
        let count = other.values.len();
        let is_alike = self.panels == other.panels && self.values.len() == count;
        ensure(is_alike, "values of the other circulation", count as f64, "the same grid")?;
        let pairs = self.values.iter().zip(&other.values);
        Self::new(self.panels, pairs.map(|(a, b)| part * a + (1.0 - part) * b).collect())
    }

    /// The circulation at every `n`-th of its azimuths, from the first.
    #[must_use]
    pub fn at_every(&self, n: usize) -> Self {
        let rows = self.values.chunks_exact(self.panels).step_by(n.max(1));
        Self { panels: self.panels, values: rows.flatten().copied().collect() }
    }

    /// The mean over the azimuth at every azimuth, for an axial wake.
    #[must_use]
    pub fn axial(&self) -> Self {
        let azimuths = self.azimuths();
        let mean = |s: usize| (0..azimuths).map(|i| self.row(i)[s]).sum::<f64>() / azimuths as f64;
        let row: Vec<f64> = (0..self.panels).map(mean).collect();
        Self { panels: self.panels, values: row.repeat(azimuths) }
    }

    /// The panel of the outboard peak at every azimuth: from the tip inward, the first panel whose
    /// magnitude is not exceeded by its inboard neighbour. Where the circulation at the tip is small
    /// and of the other sign, the peak sought is of that sign.
    pub fn outboard_peaks(&self) -> Vec<usize> {
        (0..self.azimuths())
            .map(|i| {
                let row = self.row(i);
                let mut at = self.panels - 1;
                while at > 0 && row[at - 1] * row[at] > 0.0 && row[at - 1].abs() > row[at].abs() {
                    at -= 1;
                }
                at
            })
            .collect()
    }
}

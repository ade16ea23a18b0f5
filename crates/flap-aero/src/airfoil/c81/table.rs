//! One table of a C81 file: values against incidence and Mach number.

use crate::AeroError;
use crate::error::check;

/// Values on a grid of incidences (degrees) and Mach numbers, both ascending.
#[derive(Debug, Clone, PartialEq)]
pub struct C81Table {
    machs: Vec<f64>,
    incidences_deg: Vec<f64>,
    /// Row by row: one row per incidence.
    values: Vec<f64>,
}

/// That numbers ascend strictly, and that there are any.
pub(super) fn ascending(what: &'static str, numbers: &[f64]) -> Result<(), AeroError> {
    let fault = |index: usize| AeroError::C81Order { what, index };
    if numbers.is_empty() {
        return Err(fault(0));
    }
    if let Some(index) = numbers.iter().position(|x| !x.is_finite()) {
        return Err(fault(index));
    }
    match numbers.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(index) => Err(fault(index + 1)),
        None => Ok(()),
    }
}

/// An angle in degrees from -180 to 180; one that is not finite becomes 0's neighbour nowhere: NaN
/// stays NaN and gives NaN.
pub(super) fn wrapped_degrees(angle_rad: f64) -> f64 {
    let degrees = angle_rad.to_degrees();
    if (-180.0..=180.0).contains(&degrees) {
        return degrees;
    }
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

/// The cell of a value and its share of the way to the next node; at the ends the share is 0 or 1.
fn cell(nodes: &[f64], x: f64) -> (usize, f64, f64) {
    if nodes.len() == 1 {
        return (0, 0.0, 0.0);
    }
    let low = nodes.partition_point(|n| *n <= x).clamp(1, nodes.len() - 1) - 1;
    let width = nodes[low + 1] - nodes[low];
    let share = (x - nodes[low]) / width;
    // held beyond the ends: no slope there
    if share < 0.0 {
        (low, 0.0, 0.0)
    } else if share > 1.0 {
        (low, 1.0, 0.0)
    } else {
        (low, share, 1.0 / width)
    }
}

impl C81Table {
    /// A table; `values` has one row per incidence, one value per Mach number in it.
    ///
    /// # Errors
    /// [`AeroError::C81Order`] unless both axes ascend strictly; [`AeroError::C81Shape`] unless there
    /// is a finite value for each pair; [`AeroError::BadInput`] for a negative Mach number.
    pub fn new(
        machs: Vec<f64>,
        incidences_deg: Vec<f64>,
        values: Vec<f64>,
    ) -> Result<Self, AeroError> {
        ascending("Mach numbers", &machs)?;
        ascending("incidences", &incidences_deg)?;
        let first = [("first Mach number of a C81 table", machs[0])];
        check(&first, "0 or more", |mach| mach >= 0.0)?;
        let expected = machs.len() * incidences_deg.len();
        let found = values.iter().filter(|v| v.is_finite()).count();
        if values.len() != expected || found != expected {
            return Err(AeroError::C81Shape { found, expected });
        }
        Ok(Self { machs, incidences_deg, values })
    }

    /// Mach numbers.
    pub fn machs(&self) -> &[f64] {
        &self.machs
    }

    /// Incidences in degrees.
    pub fn incidences_deg(&self) -> &[f64] {
        &self.incidences_deg
    }

    /// The row of an incidence, by index: one value per Mach number.
    ///
    /// An index beyond the last is the last.
    pub fn row(&self, incidence: usize) -> &[f64] {
        let n = self.machs.len();
        let i = incidence.min(self.incidences_deg.len() - 1);
        &self.values[i * n..(i + 1) * n]
    }

    /// Value, slope per degree and slope per unit of Mach number, by bilinear interpolation; beyond
    /// the ends the end value.
    pub fn at(&self, incidence_deg: f64, mach: f64) -> [f64; 3] {
        let (i, u, per_degree) = cell(&self.incidences_deg, incidence_deg);
        let (j, v, per_mach) = cell(&self.machs, mach);
        let next = |i: usize, n: usize| (i + 1).min(n - 1);
        let [low, high] = [self.row(i), self.row(next(i, self.incidences_deg.len()))];
        let k = next(j, self.machs.len());
        let mix = |a: f64, b: f64, share: f64| a + share * (b - a);
        let [near, far] = [low, high].map(|row| mix(row[j], row[k], v));
        [
            mix(near, far, u),
            (far - near) * per_degree,
            mix(low[k] - low[j], high[k] - high[j], u) * per_mach,
        ]
    }

    /// The table with every number changed by a function that keeps order.
    pub(super) fn mapped(&self, f: impl Fn(f64) -> f64) -> Self {
        let all = |numbers: &[f64]| numbers.iter().map(|x| f(*x)).collect();
        Self {
            machs: all(&self.machs),
            incidences_deg: all(&self.incidences_deg),
            values: all(&self.values),
        }
    }
}

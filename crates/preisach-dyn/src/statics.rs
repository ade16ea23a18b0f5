//! The static (classical) Preisach actuator, paper equation (2).

use crate::memory::moved;
use crate::play_map::split;
use crate::{PlayMap, PlayMemory, PreisachError, PreisachGrid};
use serde::{Deserialize, Serialize};

/// A static Preisach actuator with an output continuous in the voltage.
///
/// ```text
/// delta = II mu0(alpha, beta) gamma_ab[u] dalpha dbeta = constant + sum_j g_j(play_{r_j}[u])
/// ```
/// Input in volt, output in degrees of equivalent flap angle, never falling with the voltage.
/// Has the wiping-out and congruency properties exactly.
///
/// Not modelled: any dependence on rate; see [`crate::DynamicPreisach`].
/// Source: Viswamurthy and Ganguli, equation (2); play form: Brokate and Sprekels, *Hysteresis and
/// Phase Transitions* (1996), section 2.4.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StaticFile", into = "StaticFile")]
pub struct StaticPreisach {
    grid: PreisachGrid,
    map: PlayMap,
    /// All rows behind one another, each with its last node doubled.
    table: Vec<f64>,
}

/// The model as it is written to files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StaticFile {
    grid: PreisachGrid,
    g0_deg: PlayMap,
}

impl TryFrom<StaticFile> for StaticPreisach {
    type Error = PreisachError;

    fn try_from(file: StaticFile) -> Result<Self, PreisachError> {
        Self::new(file.grid, file.g0_deg)
    }
}

impl From<StaticPreisach> for StaticFile {
    fn from(model: StaticPreisach) -> Self {
        Self { grid: model.grid, g0_deg: model.map }
    }
}

impl StaticPreisach {
    /// The model with output map `map` (deg) on `grid`.
    ///
    /// # Errors
    /// [`PreisachError::NodeCount`], [`PreisachError::NotFinite`] or
    /// [`PreisachError::NegativeDensity`].
    pub fn new(grid: PreisachGrid, map: PlayMap) -> Result<Self, PreisachError> {
        map.check(&grid, "g0_deg")?;
        map.check_rising()?;
        let mut table = Vec::with_capacity(map.nodes.iter().map(|row| row.len() + 1).sum());
        for row in &map.nodes {
            table.extend_from_slice(row);
            table.extend(row.last());
        }
        Ok(Self { grid, map, table })
    }

    /// Its grid.
    pub fn grid(&self) -> &PreisachGrid {
        &self.grid
    }

    /// Its output map, deg.
    pub fn map(&self) -> &PlayMap {
        &self.map
    }

    /// Output in a given memory state, deg.
    pub fn output_deg(&self, memory: &PlayMemory) -> f64 {
        self.map.value(memory)
    }

    /// Moves the memory to a voltage and returns the output, deg.
    ///
    /// Voltages beyond the grid's range act as its limits. The memory must belong to this grid.
    pub fn apply(&self, memory: &mut PlayMemory, voltage_volt: f64) -> f64 {
        let top = self.grid.coordinate(voltage_volt);
        let mut rest = self.table.as_slice();
        let mut sum = self.map.constant;
        for (j, x) in memory.cells_mut().iter_mut().enumerate() {
            *x = moved(*x, top, j);
            let (row, after) = rest.split_at(self.grid.knots(j) + 1);
            let (knot, t) = split(*x);
            sum += row[knot] + t * (row[knot + 1] - row[knot]);
            rest = after;
        }
        sum
    }

    /// The same model with its output moved by `shift_deg`.
    #[must_use]
    pub(crate) fn shifted(mut self, shift_deg: f64) -> Self {
        self.map.constant += shift_deg;
        self
    }
}

//! The static (classical) Preisach actuator, paper equation (2).

use crate::play_map::NodeTable;
use crate::{HysteresisLaw, PlayMap, PlayMemory, PreisachError, PreisachGrid, StartState};
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
    table: NodeTable<2>,
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
        let table = NodeTable::new(&grid, |play, knot| {
            let row = &map.nodes[play];
            let value = row[knot];
            [value, row.get(knot + 1).map_or(0.0, |next| next - value)]
        });
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
        memory.apply(&self.grid, voltage_volt);
        let cells = memory.cells();
        let at = |play: usize, x: f64| {
            let (&[value, rise], t) = self.table.at(play, x);
            value + t * rise
        };
        // four sums at a time: a single one would wait for every addition before it
        let mut sums = [self.map.constant, 0.0, 0.0, 0.0];
        let quads = cells.chunks_exact(4);
        let first_left = cells.len() - quads.remainder().len();
        for (i, &x) in quads.remainder().iter().enumerate() {
            sums[i] += at(first_left + i, x);
        }
        for (quad, x) in quads.enumerate() {
            for (lane, sum) in sums.iter_mut().enumerate() {
                *sum += at(4 * quad + lane, x[lane]);
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }
}

impl HysteresisLaw for StaticPreisach {
    type Memory = PlayMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (PlayMemory, f64) {
        let memory = PlayMemory::new(&self.grid, voltage_volt, state);
        let output_deg = self.output_deg(&memory);
        (memory, output_deg)
    }

    #[inline]
    fn step(&self, memory: &mut PlayMemory, voltage_volt: f64, _: f64) -> f64 {
        self.apply(memory, voltage_volt)
    }

    fn check_memory(&self, memory: &PlayMemory) -> Result<(), PreisachError> {
        memory.check(&self.grid)
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.map.constant += shift_deg;
        self
    }
}

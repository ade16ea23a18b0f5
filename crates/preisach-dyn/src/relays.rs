//! The definition itself: a grid of two-position relays.

use crate::{HysteresisLaw, PlayMap, PreisachError, PreisachGrid, StartState};
use serde::{Deserialize, Serialize};

/// A static Preisach model as a finite sum of relays, as the literature draws it.
///
/// ```text
/// delta = constant + sum_i weight_i gamma_i[u],   gamma = +1 once u >= alpha, -1 once u <= beta
/// ```
/// The density between two knots of a play is carried by `relays_per_cell` relays in the middles of
/// equal parts. The output jumps by `2 weight` at every switching: a cost computed from it is
/// piecewise constant, which is why [`crate::StaticPreisach`] is the default. Both converge to each
/// other at first order in `1 / relays_per_cell`.
///
/// Relays of one half-width switch in the order of their centres, so those that are up are always
/// the lowest: the memory is their number per half-width.
///
/// Source: Viswamurthy and Ganguli, equation (2); Mayergoyz, *Mathematical Models of Hysteresis*
/// (1991), chapter 1, section 1.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "RelayFile", into = "RelayFile")]
pub struct RelayGrid {
    grid: PreisachGrid,
    map: PlayMap,
    relays_per_cell: u32,
    /// Per play: its contribution with 0, 1, 2... relays up, deg.
    sums: Vec<Vec<f64>>,
}

/// The model as it is written to files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct RelayFile {
    grid: PreisachGrid,
    g0_deg: PlayMap,
    relays_per_cell: u32,
}

impl TryFrom<RelayFile> for RelayGrid {
    type Error = PreisachError;

    fn try_from(file: RelayFile) -> Result<Self, PreisachError> {
        Self::new(file.grid, file.g0_deg, file.relays_per_cell)
    }
}

impl From<RelayGrid> for RelayFile {
    fn from(model: RelayGrid) -> Self {
        Self { grid: model.grid, g0_deg: model.map, relays_per_cell: model.relays_per_cell }
    }
}

/// Number of relays that are up, per half-width.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct RelayMemory {
    up: Vec<u32>,
}

/// Relays of one grid at most: more make no output less grainy that a record could show.
const MOST_RELAYS: usize = 10_000_000;

impl RelayGrid {
    /// The relays of the density of `map` (deg).
    ///
    /// # Errors
    /// [`PreisachError::NodeCount`], [`PreisachError::NotFinite`],
    /// [`PreisachError::NegativeDensity`], [`PreisachError::TooFew`] relays, or
    /// [`PreisachError::OutOfRange`] for more than ten million in all.
    pub fn new(
        grid: PreisachGrid,
        map: PlayMap,
        relays_per_cell: u32,
    ) -> Result<Self, PreisachError> {
        map.check(&grid, "g0_deg")?;
        map.check_rising()?;
        if relays_per_cell == 0 {
            return Err(PreisachError::TooFew { quantity: "relays_per_cell", value: 0, least: 1 });
        }
        let cells: usize = map.nodes.iter().map(|row| row.len() - 1).sum();
        let most = f64::from(u32::try_from(MOST_RELAYS / cells.max(1)).unwrap_or(u32::MAX));
        let parts = f64::from(relays_per_cell);
        if parts > most {
            let quantity = "relays_per_cell";
            return Err(PreisachError::OutOfRange { quantity, value: parts, least: 1.0, most });
        }
        let sums = map
            .nodes
            .iter()
            .map(|row| {
                let mut sums = vec![row[0]];
                for pair in row.windows(2) {
                    let rise = pair[1] - pair[0];
                    sums.extend(
                        (1..=relays_per_cell).map(|i| pair[0] + rise * f64::from(i) / parts),
                    );
                }
                sums
            })
            .collect();
        Ok(Self { grid, map, relays_per_cell, sums })
    }

    /// Its grid.
    pub fn grid(&self) -> &PreisachGrid {
        &self.grid
    }

    /// The map whose density the relays carry, deg.
    pub fn map(&self) -> &PlayMap {
        &self.map
    }

    /// Number of relays.
    pub fn relays(&self) -> usize {
        self.sums.iter().map(|row| row.len() - 1).sum()
    }

    /// Switches the relays to a voltage in cells and returns the output, deg.
    fn switch(&self, up: &mut [u32], top: f64) -> f64 {
        let parts = f64::from(self.relays_per_cell);
        // relay i of a play sits (i + 1/2) / parts cells above its lowest centre
        let above = whole((parts * top - 0.5).ceil());
        let per_cell = i64::from(self.relays_per_cell);
        let reached = whole((parts * top + 0.5).floor());
        let mut sum = self.map.constant;
        for ((count, row), play) in up.iter_mut().zip(&self.sums).zip(0_i64..) {
            let most = i64::try_from(row.len()).unwrap_or(i64::MAX) - 1;
            let least = (reached - per_cell * play).clamp(0, most);
            let now = i64::from(*count).max(least).min(above.clamp(0, most));
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0..=most")]
            {
                *count = now as u32;
            }
            sum += row[*count as usize];
        }
        sum
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a count of relays, small")]
fn whole(x: f64) -> i64 {
    x as i64
}

impl HysteresisLaw for RelayGrid {
    type Memory = RelayMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (RelayMemory, f64) {
        let top = self.grid.coordinate(voltage_volt);
        let parts = f64::from(self.relays_per_cell);
        let mut up: Vec<u32> = self
            .sums
            .iter()
            .zip(0_u32..)
            .map(|(row, play)| {
                let most = row.len() - 1;
                let centre = match state {
                    StartState::Rest => top - 0.5 * f64::from(play),
                    StartState::RisingFromLowest => 0.0,
                    StartState::FallingFromHighest => self.grid.levels() as f64,
                };
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "held inside 0..=most"
                )]
                {
                    (parts * centre).round().clamp(0.0, most as f64) as u32
                }
            })
            .collect();
        let output_deg = self.switch(&mut up, top);
        (RelayMemory { up }, output_deg)
    }

    fn step(&self, memory: &mut RelayMemory, voltage_volt: f64, _: f64) -> f64 {
        self.switch(&mut memory.up, self.grid.coordinate(voltage_volt))
    }

    fn check_memory(&self, memory: &RelayMemory) -> Result<(), PreisachError> {
        let (found, expected) = (memory.up.len(), self.sums.len());
        if found != expected {
            return Err(PreisachError::MemoryMismatch { found, expected });
        }
        if memory.up.iter().zip(&self.sums).any(|(&up, row)| up as usize >= row.len()) {
            return Err(PreisachError::MemoryOfAnotherLaw { expected: "relay grid" });
        }
        Ok(())
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.map.constant += shift_deg;
        self
    }
}

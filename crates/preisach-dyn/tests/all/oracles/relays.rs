//! The definition itself: a grid of two-position relays.

use super::coordinate;
use preisach_dyn::{PreisachGrid, StartState, StaticPreisach};

/// A static Preisach model as a finite sum of relays, as the literature draws it.
///
/// ```text
/// delta = constant + sum_i weight_i gamma_i[u],   gamma = +1 once u >= alpha, -1 once u <= beta
/// ```
/// The density between two knots of a play is carried by `relays_per_cell` relays in the middles of
/// equal parts. The output jumps by `2 weight` at every switching: a cost computed from it is
/// piecewise constant, which is why [`StaticPreisach`] is the product form. Both converge to each
/// other at first order in `1 / relays_per_cell`.
///
/// Relays of one half-width switch in the order of their centres, so those that are up are always
/// the lowest: the memory is their number per half-width.
///
/// Source: Viswamurthy and Ganguli, equation (2); Mayergoyz, *Mathematical Models of Hysteresis*
/// (1991), chapter 1, section 1.
pub(crate) struct RelayGrid {
    grid: PreisachGrid,
    constant_deg: f64,
    relays_per_cell: u32,
    /// Per play: its contribution with 0, 1, 2... relays up, deg.
    sums: Vec<Vec<f64>>,
}

/// Number of relays that are up, per half-width.
pub(crate) struct RelayMemory {
    up: Vec<u32>,
}

impl RelayGrid {
    /// The relays of the density of a model, at least one per cell.
    pub(crate) fn of(model: &StaticPreisach, relays_per_cell: u32) -> Self {
        let (grid, map) = (*model.grid(), model.map());
        let parts = f64::from(relays_per_cell);
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
        Self { grid, constant_deg: map.constant, relays_per_cell, sums }
    }

    /// Number of relays.
    pub(crate) fn relays(&self) -> usize {
        self.sums.iter().map(|row| row.len() - 1).sum()
    }

    /// Switches the relays to a voltage in cells and returns the output, deg.
    fn switch(&self, up: &mut [u32], top: f64) -> f64 {
        let parts = f64::from(self.relays_per_cell);
        // relay i of a play sits (i + 1/2) / parts cells above its lowest centre
        let above = whole((parts * top - 0.5).ceil());
        let per_cell = i64::from(self.relays_per_cell);
        let reached = whole((parts * top + 0.5).floor());
        let mut sum = self.constant_deg;
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

    /// A memory settled at a voltage, and the output there, deg.
    pub(crate) fn start(&self, voltage_volt: f64, state: StartState) -> (RelayMemory, f64) {
        let top = coordinate(&self.grid, voltage_volt);
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

    /// Moves the memory to a voltage and returns the output there, deg.
    pub(crate) fn step(&self, memory: &mut RelayMemory, voltage_volt: f64) -> f64 {
        self.switch(&mut memory.up, coordinate(&self.grid, voltage_volt))
    }
}

#[expect(clippy::cast_possible_truncation, reason = "a count of relays, small")]
fn whole(x: f64) -> i64 {
    x as i64
}

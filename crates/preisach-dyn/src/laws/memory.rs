//! The memory of a Preisach operator: one state per play.

use crate::check::check_that;
use crate::{PreisachError, PreisachGrid, VoltageRange};
use serde::{Deserialize, Serialize};

/// The state an actuator is in before its first sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
pub enum StartState {
    /// Every play rests centred on the starting voltage, as far as the triangle allows: the
    /// actuator has forgotten its past (demagnetised about that voltage).
    #[default]
    Rest,
    /// The voltage came up from the lower limit without turning.
    RisingFromLowest,
    /// The voltage came down from the upper limit without turning.
    FallingFromHighest,
}

/// States of the plays of a [`PreisachGrid`], shared by every map on that grid.
///
/// ```text
/// play of half-width r:   w <- max(u - r, min(u + r, w))
/// ```
/// The memory depends on the sequence of voltages alone, not on their timing. It is written to and
/// read from files as it stands.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Vec<f64>", into = "Vec<f64>")]
pub struct PlayMemory {
    /// States in cells, `x_j` in 0 ..= n - j.
    cells: Vec<f64>,
}

impl TryFrom<Vec<f64>> for PlayMemory {
    type Error = PreisachError;

    fn try_from(cells: Vec<f64>) -> Result<Self, PreisachError> {
        let levels = cells.len();
        for (play, &x) in cells.iter().enumerate() {
            let most = levels - play;
            let expected = format!(
                "0 to {most} for play {play} of {levels}: the memory was not written by this program"
            );
            let inside = (0.0..=most as f64).contains(&x);
            check_that(inside, "stored play (cells)", x, expected)?;
        }
        Ok(Self { cells })
    }
}

impl From<PlayMemory> for Vec<f64> {
    fn from(memory: PlayMemory) -> Self {
        memory.cells
    }
}

impl PlayMemory {
    /// The memory of an actuator that starts at `voltage_volt`.
    pub fn new(grid: &PreisachGrid, voltage_volt: f64, start: StartState) -> Self {
        let top = grid.coordinate(voltage_volt);
        let cells = (0..grid.levels())
            .map(|j| {
                let width = j as f64;
                let last = (grid.levels() - j) as f64;
                let x = match start {
                    StartState::Rest => top - 0.5 * width,
                    StartState::RisingFromLowest => top - width,
                    StartState::FallingFromHighest => top,
                };
                x.clamp(0.0, last)
            })
            .collect();
        Self { cells }
    }

    /// Refuses a memory of another grid.
    pub(crate) fn check(&self, grid: &PreisachGrid) -> Result<(), PreisachError> {
        check_plays(self.levels(), grid.levels())
    }

    /// Number of plays.
    pub fn levels(&self) -> usize {
        self.cells.len()
    }

    /// Moves every play to a new voltage.
    pub fn apply(&mut self, grid: &PreisachGrid, voltage_volt: f64) {
        self.apply_coordinate(grid.coordinate(voltage_volt));
    }

    /// Moves every play; `top` is the voltage in cells.
    pub(crate) fn apply_coordinate(&mut self, top: f64) {
        // i32, because its conversion to f64 runs in vector registers
        for (x, width) in self.cells.iter_mut().zip(0_i32..) {
            *x = moved(*x, top, f64::from(width));
        }
    }

    /// States in cells.
    pub(crate) fn cells(&self) -> &[f64] {
        &self.cells
    }
}

/// A play of full width `width` cells after its input moved to `top` cells.
#[inline]
pub(crate) fn moved(x: f64, top: f64, width: f64) -> f64 {
    let lifted = if x < top { x } else { top };
    let floor = top - width;
    if lifted > floor { lifted } else { floor }
}

impl StartState {
    /// A memory that has come to this state and then to a voltage, and the output there: `moved` takes
    /// the memory to a voltage of the range, from wherever it is.
    pub(crate) fn led<M>(
        self,
        mut memory: M,
        range: VoltageRange,
        voltage_volt: f64,
        moved: impl Fn(&mut M, f64) -> f64,
    ) -> (M, f64) {
        let fractions: &[f64] = match self {
            Self::Rest => &[],
            Self::RisingFromLowest => &[1.0, 0.0],
            Self::FallingFromHighest => &[0.0, 1.0],
        };
        for fraction in fractions {
            moved(&mut memory, range.lowest_volt() + fraction * range.span_volt());
        }
        let output_deg = moved(&mut memory, voltage_volt);
        (memory, output_deg)
    }
}

/// Outputs of plays of any half-widths, and the voltage they belong to, V.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WidthsMemory {
    pub(crate) plays_volt: Vec<f64>,
    pub(crate) voltage_volt: f64,
}

impl WidthsMemory {
    /// Every play at a voltage.
    pub(crate) fn at(count: usize, voltage_volt: f64) -> Self {
        Self { plays_volt: vec![voltage_volt; count], voltage_volt }
    }

    /// Refuses a memory of another number of plays.
    pub(crate) fn check(&self, expected: usize) -> Result<(), PreisachError> {
        check_plays(self.plays_volt.len(), expected)
    }

    /// What the input leaves of the plays, V: the outputs of stops of the same half-widths.
    pub fn stops_volt(&self) -> impl Iterator<Item = f64> {
        self.plays_volt.iter().map(|play| self.voltage_volt - play)
    }
}

fn check_plays(found: usize, expected: usize) -> Result<(), PreisachError> {
    if found == expected {
        Ok(())
    } else {
        Err(PreisachError::MemoryMismatch { part: "plays", found, expected })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::VoltageRange;
    use approx::assert_abs_diff_eq;

    #[test]
    fn plays_follow_their_definition_in_volt() {
        let grid = PreisachGrid::new(VoltageRange::amplified_stack(), 12).unwrap();
        let mut memory = PlayMemory::new(&grid, 65.0, StartState::Rest);
        let plays_volt = |memory: &PlayMemory| -> Vec<f64> {
            let volt = |(j, x): (usize, &f64)| grid.knot_volt(j, 0) + x * grid.cell_volt();
            memory.cells().iter().enumerate().map(volt).collect()
        };
        let mut direct = plays_volt(&memory);
        for u in [80.0, 20.0, 149.0, -20.0, 3.0, 64.0, 10.0] {
            memory.apply(&grid, u);
            for (j, w) in direct.iter_mut().enumerate() {
                let r = grid.half_width_volt(j);
                *w = w.min(u + r).max(u - r);
            }
            for (got, want) in plays_volt(&memory).iter().zip(&direct) {
                assert_abs_diff_eq!(got, want, epsilon = 1e-12);
            }
        }
    }

    #[test]
    fn a_stored_memory_outside_the_triangle_is_refused() {
        assert!(PlayMemory::try_from(vec![2.0, 1.0]).is_ok());
        assert!(PlayMemory::try_from(vec![2.0, 1.5]).is_err());
        assert!(PlayMemory::try_from(vec![f64::NAN]).is_err());
    }
}

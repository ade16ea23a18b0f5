//! The classical form: Everett's integral and the staircase of past extremes.

use super::coordinate;
use preisach_dyn::{PreisachGrid, StartState, StaticPreisach};

/// A static Preisach model in its classical form.
///
/// ```text
/// E(alpha, beta) = integral of 2 mu over the triangle between beta and alpha
///                = sum_j max(0, R_j(alpha - r_j) - R_j(beta + r_j)),   R_j(s) = int_{-inf}^{s} 2 mu_j ds
/// rising from the turn (m, y):   y + E(u, m)
/// falling from the turn (M, y):  y - E(M, u)
/// ```
/// over the alternating past maxima `M_k` and minima `m_k` that no later excursion has wiped out.
/// The memory is that list of extremes, not a set of plays; only the density is shared with
/// [`StaticPreisach`], with which it agrees to rounding. Input in volt, output in degrees.
///
/// The density sits on the half-widths of the grid, so inside a cell of the plane (alpha, beta) `E`
/// is linear but for the line of half-width that crosses the cell: one look into four tables gives
/// it exactly, whatever the number of levels.
///
/// Source: Mayergoyz, *Mathematical Models of Hysteresis* (1991), chapter 1, section 3.
pub(crate) struct EverettStaircase {
    grid: PreisachGrid,
    lowest_deg: f64,
    /// Cell `(floor alpha, floor beta)`: `E` at its lower corner, slopes in `alpha` and `beta`
    /// without the crossing half-width, and the slope of that one in `alpha - beta`.
    cells: Vec<[f64; 4]>,
}

/// A turning point of the voltage: where, in cells above the lower limit, and the output there.
#[derive(Clone, Copy)]
struct Turn {
    cells: f64,
    output_deg: f64,
}

/// The staircase: past extremes that still matter, a minimum first, the present voltage last.
pub(crate) struct StaircaseMemory {
    turns: Vec<Turn>,
}

impl StaircaseMemory {
    /// Number of extremes remembered, the present voltage included.
    pub(crate) fn turns(&self) -> usize {
        self.turns.len()
    }
}

impl EverettStaircase {
    /// The classical form of a model.
    pub(crate) fn of(model: &StaticPreisach) -> Self {
        let (grid, map) = (*model.grid(), model.map());
        let lowest_deg = map.nodes.iter().fold(map.constant, |sum, row| sum + row[0]);
        let levels = grid.levels();
        let rise = |play: usize, knot: usize| map.nodes[play][knot + 1] - map.nodes[play][knot];
        let mut cells = vec![[0.0; 4]; levels * levels];
        for top in 0..levels {
            for low in 0..=top {
                let cell = &mut cells[top * levels + low];
                for play in 0..top - low {
                    cell[0] += map.nodes[play][top - play] - map.nodes[play][low];
                    cell[1] += rise(play, top - play);
                    cell[2] += rise(play, low);
                }
                cell[3] = rise(top - low, low);
            }
        }
        Self { grid, lowest_deg, cells }
    }

    /// Everett's integral between two voltages, deg; zero unless the first is the higher.
    pub(crate) fn everett(&self, upper_volt: f64, lower_volt: f64) -> f64 {
        self.everett_cells(coordinate(&self.grid, upper_volt), coordinate(&self.grid, lower_volt))
    }

    fn everett_cells(&self, upper: f64, lower: f64) -> f64 {
        if upper <= lower {
            return 0.0;
        }
        let last = self.grid.levels() - 1;
        let (top, s) = split_at_most(upper, last);
        let (low, t) = split_at_most(lower, last);
        let [corner, by_upper, by_lower, crossing] = self.cells[top * (last + 1) + low];
        corner + s * by_upper - t * by_lower + crossing * f64::max(s - t, 0.0)
    }

    /// Moves to a voltage in cells and returns the output, deg.
    fn move_to(&self, turns: &mut Vec<Turn>, u: f64) -> f64 {
        let Some(&last) = turns.last() else {
            let output_deg = self.lowest_deg;
            turns.push(Turn { cells: 0.0, output_deg });
            return if u > 0.0 { self.move_to(turns, u) } else { output_deg };
        };
        let rises = u > last.cells;
        if !(rises || u < last.cells) {
            return last.output_deg;
        }
        // a minimum stands at every even place: a rise ends at an odd one
        if rises == turns.len().is_multiple_of(2) {
            turns.pop();
        }
        // wiping out: an excursion that reaches past an earlier extreme of its kind erases it
        while let [.., same_kind, _] = *turns.as_slice() {
            let passed = if rises { u >= same_kind.cells } else { u <= same_kind.cells };
            if !passed {
                break;
            }
            turns.truncate(turns.len() - 2);
        }
        let output_deg = match turns.last() {
            Some(from) if rises => from.output_deg + self.everett_cells(u, from.cells),
            Some(from) => from.output_deg - self.everett_cells(from.cells, u),
            None => self.lowest_deg,
        };
        turns.push(Turn { cells: u, output_deg });
        output_deg
    }

    /// A memory settled at a voltage, and the output there, deg.
    pub(crate) fn start(&self, voltage_volt: f64, state: StartState) -> (StaircaseMemory, f64) {
        let top = coordinate(&self.grid, voltage_volt);
        let levels = self.grid.levels();
        let mut turns = Vec::new();
        self.move_to(&mut turns, 0.0);
        match state {
            StartState::RisingFromLowest => {}
            StartState::FallingFromHighest => {
                self.move_to(&mut turns, levels as f64);
            }
            StartState::Rest => {
                // a swing that dies away about the voltage: its extreme u + r_j or u - r_j centres
                // play j, and no later one moves it
                if top > 0.5 * levels as f64 {
                    self.move_to(&mut turns, levels as f64);
                }
                let mut below = turns.len().is_multiple_of(2);
                for play in (1..levels).rev() {
                    let half = 0.5 * play as f64;
                    let extreme = if below { top - half } else { top + half };
                    if (top - half >= 0.0) && (top + half <= levels as f64) {
                        self.move_to(&mut turns, extreme);
                        below = !below;
                    }
                }
            }
        }
        let output_deg = self.move_to(&mut turns, top);
        (StaircaseMemory { turns }, output_deg)
    }

    /// Moves the memory to a voltage and returns the output there, deg.
    pub(crate) fn step(&self, memory: &mut StaircaseMemory, voltage_volt: f64) -> f64 {
        self.move_to(&mut memory.turns, coordinate(&self.grid, voltage_volt))
    }
}

/// The knot at or below `x >= 0`, held at `last`, with the remainder.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "in 0..=levels")]
fn split_at_most(x: f64, last: usize) -> (usize, f64) {
    let knot = (x as usize).min(last);
    (knot, x - knot as f64)
}

//! The classical form: Everett's integral and the staircase of past extremes.

use crate::play_map::interpolate;
use crate::{PlayMap, PreisachError, PreisachGrid};

/// A static Preisach model in its classical form, kept beside the play form as its cross-check.
///
/// ```text
/// E(alpha, beta) = integral of 2 mu over the triangle between beta and alpha
///                = sum_j max(0, R_j(alpha - r_j) - R_j(beta + r_j)),   R_j(s) = int_{-inf}^{s} 2 mu_j ds
/// output = lowest + sum_k [ E(M_k, m_{k-1}) - E(M_k, m_k) ]
/// ```
/// with the alternating past maxima `M_k` and minima `m_k` that no later excursion has wiped out,
/// and `m_0 = u_min`. The memory here is that list of extremes, not a set of plays; only the
/// density is shared.
///
/// Assumes: the voltage started at the lower limit.
/// Source: Mayergoyz, *Mathematical Models of Hysteresis* (1991), chapter 1, section 3.
#[derive(Debug, Clone, PartialEq)]
pub struct EverettStaircase {
    grid: PreisachGrid,
    /// `R_j` at the knots, zero at the first.
    cumulative: Vec<Vec<f64>>,
    lowest_output: f64,
    /// `m_0, M_1, m_1, M_2 ...` in cells, the last being the present voltage.
    turns: Vec<f64>,
}

impl EverettStaircase {
    /// The model of the density of `map`, at the lower voltage limit.
    ///
    /// # Errors
    /// [`PreisachError::NodeCount`] or [`PreisachError::NotFinite`] if the map does not fit the
    /// grid.
    pub fn new(grid: PreisachGrid, map: &PlayMap) -> Result<Self, PreisachError> {
        map.check(&grid, "static map")?;
        let cumulative =
            map.nodes.iter().map(|row| row.iter().map(|v| v - row[0]).collect()).collect();
        let lowest_output = map.nodes.iter().fold(map.constant, |sum, row| sum + row[0]);
        Ok(Self { grid, cumulative, lowest_output, turns: vec![0.0] })
    }

    /// Everett's integral between two voltages, in the unit of the map.
    pub fn everett(&self, upper_volt: f64, lower_volt: f64) -> f64 {
        self.everett_cells(self.grid.coordinate(upper_volt), self.grid.coordinate(lower_volt))
    }

    fn everett_cells(&self, upper: f64, lower: f64) -> f64 {
        let rows = self.cumulative.iter().enumerate();
        rows.map(|(j, row)| {
            // s = alpha - r and s = beta + r, in cells above the first centre of the play
            let top = (upper - j as f64).max(0.0);
            if top > lower { interpolate(row, top) - interpolate(row, lower) } else { 0.0 }
        })
        .sum()
    }

    /// Moves to a new voltage and returns the output, in the unit of the map.
    pub fn apply(&mut self, voltage_volt: f64) -> f64 {
        let u = self.grid.coordinate(voltage_volt);
        let last = self.turns.len() - 1;
        let (ends_a_rise, rises, falls) =
            (last % 2 == 1, u > self.turns[last], u < self.turns[last]);
        if !(rises || falls) {
            return self.output();
        }
        if ends_a_rise == rises {
            self.turns[last] = u;
        } else {
            self.turns.push(u);
        }
        // wiping out: an excursion that reaches past an earlier extreme of its kind erases it
        while let [.., same_kind, _, now] = *self.turns.as_slice() {
            let passed = if rises { now >= same_kind } else { now <= same_kind };
            if !passed {
                break;
            }
            let keep = self.turns.len() - 3;
            self.turns.truncate(keep);
            self.turns.push(now);
        }
        self.output()
    }

    /// The output in the present state.
    pub fn output(&self) -> f64 {
        let mut sum = self.lowest_output;
        for pair in self.turns.chunks(2).zip(self.turns[1..].chunks(2)) {
            let ([minimum, ..], [maximum, then @ ..]) = pair else {
                continue;
            };
            sum += self.everett_cells(*maximum, *minimum);
            if let Some(next) = then.first() {
                sum -= self.everett_cells(*maximum, *next);
            }
        }
        sum
    }
}

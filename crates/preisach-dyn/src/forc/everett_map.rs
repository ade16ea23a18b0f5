//! Everett's integral at the nodes of a grid.

use crate::identify::fit::program::Row;
use crate::laws::play_map::split;
use crate::{PlayMap, PreisachGrid};

/// Everett's integral `E(alpha, beta)` at the nodes of a grid, straight between them.
///
/// ```text
/// E(alpha_i, beta_k) = rise of the output when the input goes from beta_k up to alpha_i,
///                      every relay between them having switched down before
/// rise of play j between knots q and q + 1
///     = E(q+j+1, q) - E(q+j+1, q+1) - E(q+j, q) + E(q+j, q+1),    E(i, k) = 0 for i <= k
/// ```
/// Between nodes `E` is linear on the triangles into which the lines `alpha = const`,
/// `beta = const` and `alpha - beta = const` cut the plane: exactly what a [`PlayMap`] does, so a map
/// of plays and its Everett values are two ways of writing the same operator.
#[derive(Debug, Clone, PartialEq)]
pub struct EverettMap {
    grid: PreisachGrid,
    /// Row `i - 1` holds `E(i, k)`, `k = 0 .. i - 1`.
    rows: Vec<Vec<f64>>,
    /// The output at the upper end of the range after saturation.
    top_output: f64,
}

impl EverettMap {
    /// The values of a vector of unknowns: `top_output`, then the rows.
    pub(super) fn from_unknowns(grid: PreisachGrid, x: &[f64], scale: f64) -> Self {
        let rows = (1..=grid.levels())
            .map(|i| (0..i).map(|k| scale * x[unknown(i, k)]).collect())
            .collect();
        Self { grid, rows, top_output: scale * x[0] }
    }

    /// Its grid.
    pub fn grid(&self) -> &PreisachGrid {
        &self.grid
    }

    /// The output at the upper end of the range after saturation there.
    pub fn top_output(&self) -> f64 {
        self.top_output
    }

    /// `E(i, k)` at node `i` of `alpha` and `k` of `beta`; zero unless `levels >= i > k`.
    pub fn node(&self, i: usize, k: usize) -> f64 {
        i.checked_sub(1).and_then(|row| self.rows.get(row)?.get(k)).copied().unwrap_or(0.0)
    }

    /// `E` between an upper and a lower input, which act as the limits of the range beyond it.
    pub fn value(&self, upper: f64, lower: f64) -> f64 {
        let mut row = Row::new();
        weights(&self.grid, upper, lower, 1.0, &mut row);
        row.iter()
            .map(|&(index, weight)| {
                let (i, k) = place(index);
                weight * self.node(i, k)
            })
            .sum()
    }

    /// The rises of the plays: density times cell, row by row; negative ones become zero.
    fn rises(&self) -> Vec<Vec<f64>> {
        let levels = self.grid.levels();
        (0..levels)
            .map(|j| {
                (0..levels - j)
                    .map(|q| {
                        let ends = corners(j, q);
                        ends.iter()
                            .map(|&(i, k, sign)| sign * self.node(i, k))
                            .sum::<f64>()
                            .max(0.0)
                    })
                    .collect()
            })
            .collect()
    }

    /// The map of plays that writes the same operator. What the solver left of negative density, to
    /// its tolerance, is dropped.
    pub fn play_map(&self) -> PlayMap {
        let mut constant = self.top_output;
        let nodes = self
            .rises()
            .into_iter()
            .map(|row| {
                let mut value = 0.0;
                let mut nodes = vec![value];
                for rise in row {
                    value += rise;
                    nodes.push(value);
                }
                constant -= value;
                nodes
            })
            .collect();
        PlayMap { constant, nodes }
    }
}

/// The four nodes whose signed sum is the rise of play `j` between knots `q` and `q + 1`.
pub(super) fn corners(j: usize, q: usize) -> [(usize, usize, f64); 4] {
    [(q + j + 1, q, 1.0), (q + j + 1, q + 1, -1.0), (q + j, q, -1.0), (q + j, q + 1, 1.0)]
}

/// Number of the unknown `E(i, k)`, `i > k`; 0 is the output at the top.
pub(super) fn unknown(i: usize, k: usize) -> usize {
    1 + i * (i - 1) / 2 + k
}

/// The node of an unknown.
fn place(index: usize) -> (usize, usize) {
    let mut i = 1;
    while unknown(i + 1, 0) <= index {
        i += 1;
    }
    (i, index - unknown(i, 0))
}

/// Appends `scale E(upper, lower)` as weights of the unknowns.
pub(super) fn weights(grid: &PreisachGrid, upper: f64, lower: f64, scale: f64, row: &mut Row) {
    let (a, b) = (grid.coordinate(upper), grid.coordinate(lower));
    if a <= b {
        return;
    }
    let ((i, s), (k, t)) = (split(a), split(b));
    let corners = if s >= t {
        [(i, k, 1.0 - s), (i + 1, k, s - t), (i + 1, k + 1, t)]
    } else {
        [(i, k, 1.0 - t), (i, k + 1, t - s), (i + 1, k + 1, s)]
    };
    for (i, k, weight) in corners {
        if i > k && weight > 0.0 {
            row.push((unknown(i, k), scale * weight));
        }
    }
}

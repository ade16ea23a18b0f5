//! Everett's integral `E(alpha, beta)` at the nodes of a grid, straight between them.
//!
//! ```text
//! E(alpha_i, beta_k) = rise of the output when the input goes from beta_k up to alpha_i,
//!                      every relay between them having switched down before
//! rise of play j between knots q and q + 1
//!     = E(q+j+1, q) - E(q+j+1, q+1) - E(q+j, q) + E(q+j, q+1),    E(i, k) = 0 for i <= k
//! ```
//! Between nodes `E` is linear on the triangles into which the lines `alpha = const`,
//! `beta = const` and `alpha - beta = const` cut the plane: exactly what a [`PlayMap`] does, so a map
//! of plays and its Everett values are two ways of writing the same operator.

use crate::identify::fit::program::Row;
use crate::laws::play_map::{risen, split};
use crate::{PlayMap, PreisachGrid};

/// The map of plays that writes the same operator as Everett values: `x` holds the output at the top of
/// the range, then `E(i, k)`, all over `scale`. What the solver left of negative density, to its
/// tolerance, is dropped.
pub(super) fn play_map(levels: usize, x: &[f64], scale: f64) -> PlayMap {
    let signed = |(i, k, sign): (usize, usize, f64)| {
        if i > k { sign * (scale * x[unknown(i, k)]) } else { 0.0 }
    };
    let rise = |j: usize, q: usize| corners(j, q).map(signed).iter().sum::<f64>().max(0.0);
    let mut constant = scale * x[0];
    let play = |j: usize| {
        let nodes = risen(0.0, (0..levels - j).map(|q| rise(j, q)));
        constant -= nodes.last().copied().unwrap_or(0.0);
        nodes
    };
    let nodes = (0..levels).map(play).collect();
    PlayMap { constant, nodes }
}

/// The four nodes whose signed sum is the rise of play `j` between knots `q` and `q + 1`.
pub(super) fn corners(j: usize, q: usize) -> [(usize, usize, f64); 4] {
    [(q + j + 1, q, 1.0), (q + j + 1, q + 1, -1.0), (q + j, q, -1.0), (q + j, q + 1, 1.0)]
}

/// Number of the unknown `E(i, k)`, `i > k`; 0 is the output at the top.
pub(super) fn unknown(i: usize, k: usize) -> usize {
    1 + i * (i - 1) / 2 + k
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

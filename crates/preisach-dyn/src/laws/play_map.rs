//! Output maps: what each play contributes to an output, and their extremes over all reachable
//! states.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::check::{check_finite, check_that, largest_above};
use crate::{PlayMemory, PreisachError, PreisachGrid};
use rotor_base::Lanes;
use serde::{Deserialize, Serialize};

/// A function of the memory, `G = constant + sum_j g_j(w_j)`, every `g_j` continuous and piecewise
/// linear between the knots of its play.
///
/// This is the play form of `II mu(alpha, beta) gamma_ab[u] dalpha dbeta`: the slope of `g_j`
/// between two knots is the density there (times the relay's jump of 2), so a density `>= 0`
/// means a map that never falls.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlayMap {
    /// The part that does not depend on the memory.
    pub constant: f64,
    /// Values `g_j` at the knots: row `j` = play, `n - j + 1` entries from the lowest centre up.
    pub nodes: Vec<Vec<f64>>,
}

impl PlayMap {
    /// The map that is `constant` in every state.
    pub fn constant(grid: &PreisachGrid, constant: f64) -> Self {
        let nodes = (0..grid.levels()).map(|j| vec![0.0; grid.knots(j)]).collect();
        Self { constant, nodes }
    }

    /// The map of a density given cell by cell.
    ///
    /// `rises[j][k]` is the integral of `2 mu` over the cell between knots `k` and `k + 1` of play
    /// `j`: the rise of the output when the play crosses it. The map is centred: `g_j` has opposite
    /// values at both ends, as the relays have (`gamma = +-1`).
    ///
    /// # Errors
    /// [`PreisachError::NodeCount`] unless row `j` has `n - j` entries.
    pub fn from_rises(
        grid: &PreisachGrid,
        constant: f64,
        rises: &[Vec<f64>],
    ) -> Result<Self, PreisachError> {
        let nodes = rises
            .iter()
            .map(|row| {
                let half = 0.5 * row.iter().sum::<f64>();
                risen(-half, row.iter().copied())
            })
            .collect();
        let map = Self { constant, nodes };
        map.check(grid, "density")?;
        Ok(map)
    }

    /// The rises of the map from knot to knot: the density integrated over its cells.
    pub fn rises(&self) -> Vec<Vec<f64>> {
        self.nodes
            .iter()
            .map(|row| row.windows(2).map(|pair| pair[1] - pair[0]).collect())
            .collect()
    }

    /// Value at a knot of a play, and the rise to the next.
    pub(crate) fn value_and_rise(&self, play: usize, knot: usize) -> [f64; 2] {
        let row = &self.nodes[play];
        [row[knot], row.get(knot + 1).map_or(0.0, |next| next - row[knot])]
    }

    /// Value for a memory on the same grid.
    pub fn value(&self, memory: &PlayMemory) -> f64 {
        self.value_at(memory.cells())
    }

    /// Value for the states of a memory on the same grid.
    pub(crate) fn value_at(&self, cells: &[f64]) -> f64 {
        let plays = self.nodes.iter().zip(cells);
        plays.fold(self.constant, |sum, (row, &x)| sum + interpolate(row, x))
    }

    /// Checks shape and finiteness.
    pub(crate) fn check(
        &self,
        grid: &PreisachGrid,
        map: &'static str,
    ) -> Result<(), PreisachError> {
        let levels = grid.levels();
        for play in 0..levels.max(self.nodes.len()) {
            let found = self.nodes.get(play).map_or(0, Vec::len);
            let expected = grid.knots(play);
            if found != expected {
                return Err(PreisachError::NodeCount { map, play, found, expected, levels });
            }
        }
        let values = std::iter::once(&self.constant).chain(self.nodes.iter().flatten());
        check_finite(map, values.copied())
    }

    /// Checks that the map never falls, up to rounding.
    pub(crate) fn check_rising(&self) -> Result<(), PreisachError> {
        let size = self.nodes.iter().flatten().fold(0.0_f64, |m, v| m.max(v.abs()));
        for (play, row) in self.nodes.iter().enumerate() {
            for (node, pair) in row.windows(2).enumerate() {
                let fall_deg = pair[0] - pair[1];
                if fall_deg > 1e-12 * size {
                    let expected = format!(
                        "0 or less at node {node} of play {play}: the density mu0 must not be negative"
                    );
                    return check_that(false, "fall of the static map (deg)", fall_deg, expected);
                }
            }
        }
        Ok(())
    }

    /// `a * self + b * other`.
    #[must_use]
    pub fn combined(&self, a: f64, other: &Self, b: f64) -> Self {
        let nodes = self
            .nodes
            .iter()
            .zip(&other.nodes)
            .map(|(p, q)| p.iter().zip(q).map(|(x, y)| a * x + b * y).collect())
            .collect();
        Self { constant: a * self.constant + b * other.constant, nodes }
    }

    /// Largest value over *all* reachable states, and a state that attains it.
    ///
    /// A reachable state is any staircase: neighbouring plays differ by at most the difference of
    /// their half-widths. Those are difference constraints with whole-number bounds, and the map
    /// is linear between whole numbers, so the maximum lies on knots and dynamic programming from
    /// the widest play inward finds it exactly.
    ///
    /// Returns the value and the knot index of every play.
    pub fn largest(&self) -> (f64, Vec<usize>) {
        let levels = self.nodes.len();
        // best[x]: largest sum over this play and all wider ones, given this play at knot x
        let mut best = vec![0.0];
        let mut choices: Vec<Vec<usize>> = Vec::with_capacity(levels);
        for row in self.nodes.iter().rev() {
            let mut choice = Vec::with_capacity(row.len());
            let sums = row
                .iter()
                .enumerate()
                .map(|(x, &value)| {
                    // the wider play sits at knot x or x - 1, inside 0 ..= its last
                    let stay = best.get(x).map(|&sum| (x, sum));
                    let lower = x.checked_sub(1).and_then(|i| Some((i, *best.get(i)?)));
                    let (next, sum) = match (stay, lower) {
                        (Some(stay), Some(lower)) if lower.1 > stay.1 => lower,
                        _ => stay.or(lower).unwrap_or((0, 0.0)),
                    };
                    choice.push(next);
                    value + sum
                })
                .collect();
            best = sums;
            choices.push(choice);
        }
        let (mut knot, value) = largest_above(f64::NEG_INFINITY, best);
        let mut state = Vec::with_capacity(levels);
        for choice in choices.iter().rev() {
            state.push(knot);
            knot = choice[knot];
        }
        (self.constant + value, state)
    }

    /// The same function on a finer grid whose levels are `factor` times as many.
    ///
    /// The plays of the coarse grid are every `factor`-th play of the fine one, so nothing is
    /// approximated.
    #[must_use]
    pub(crate) fn refined(&self, factor: usize) -> Self {
        let levels = self.nodes.len() * factor;
        let nodes = (0..levels)
            .map(|j| {
                let knots = levels - j + 1;
                match self.nodes.get(j / factor) {
                    Some(row) if j % factor == 0 => {
                        (0..knots).map(|k| interpolate(row, k as f64 / factor as f64)).collect()
                    }
                    _ => vec![0.0; knots],
                }
            })
            .collect();
        Self { constant: self.constant, nodes }
    }
}

/// Values at the knots of a play, from the first one and the rises.
pub(crate) fn risen(first: f64, rises: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let mut value = first;
    let later = rises.into_iter().map(|rise| {
        value += rise;
        value
    });
    std::iter::once(first).chain(later).collect()
}

/// Index of the knot at or below `x >= 0`, with the remainder.
#[inline]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "play states lie in 0..=levels"
)]
pub(crate) fn split(x: f64) -> (usize, f64) {
    let knot = x as u32;
    (knot as usize, x - f64::from(knot))
}

/// Numbers at every knot of every play, laid out for speed: rows of equal length.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NodeTable<E> {
    stride: usize,
    entries: Vec<E>,
}

impl<E: Clone + Default> NodeTable<E> {
    /// The table of `entry(play, knot)`.
    pub(crate) fn new(grid: &PreisachGrid, entry: impl Fn(usize, usize) -> E) -> Self {
        let stride = grid.levels() + 1;
        let mut entries = vec![E::default(); stride * grid.levels()];
        for play in 0..grid.levels() {
            for knot in 0..grid.knots(play) {
                entries[play * stride + knot] = entry(play, knot);
            }
        }
        Self { stride, entries }
    }

    /// The entry of the knot at or below a play state, and the remainder.
    #[inline(always)]
    pub(crate) fn at(&self, play: usize, x: f64) -> (&E, f64) {
        let (knot, t) = split(x);
        (&self.entries[play * self.stride + knot], t)
    }
}

impl NodeTable<(Lanes, Lanes)> {
    /// What a play in a state adds to several maps, of whose values and rises the table is.
    #[inline(always)]
    pub(crate) fn values(&self, play: usize, x: f64) -> Lanes {
        let (&(value, rise), t) = self.at(play, x);
        value + rise * t
    }
}

/// Linear interpolation between the knots 0, 1, 2... of a row.
pub(crate) fn interpolate(row: &[f64], x: f64) -> f64 {
    let (k, t) = split(x);
    match (row.get(k), row.get(k + 1)) {
        (Some(a), Some(b)) => a + t * (b - a),
        (Some(a), None) => *a,
        _ => row.last().copied().unwrap_or_default(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{StartState, VoltageRange};
    use approx::assert_abs_diff_eq;
    use proptest::prelude::*;

    fn grid(levels: usize) -> PreisachGrid {
        PreisachGrid::new(VoltageRange::amplified_stack(), levels).unwrap()
    }

    fn wavy(levels: usize, seed: f64) -> PlayMap {
        let nodes = (0..levels)
            .map(|j| {
                (0..=levels - j).map(|k| (seed * (3.1 * j as f64 + 1.7 * k as f64)).sin()).collect()
            })
            .collect();
        PlayMap { constant: 0.25, nodes }
    }

    /// Every staircase of knots, by brute force.
    fn staircases(levels: usize) -> Vec<Vec<usize>> {
        let mut all: Vec<Vec<usize>> = (0..=levels).map(|x| vec![x]).collect();
        for j in 1..levels {
            all = all
                .into_iter()
                .flat_map(|s| {
                    let x = s[j - 1];
                    (x.saturating_sub(1)..=x).filter(move |&y| y <= levels - j).map(move |y| {
                        let mut t = s.clone();
                        t.push(y);
                        t
                    })
                })
                .collect();
        }
        all
    }

    #[test]
    fn largest_is_what_trying_every_state_finds() {
        for (levels, seed) in [(1, 0.3), (4, 0.9), (7, 1.3), (8, 2.2)] {
            let map = wavy(levels, seed);
            let of = |s: &[usize]| -> f64 {
                map.constant + s.iter().zip(&map.nodes).map(|(&k, row)| row[k]).sum::<f64>()
            };
            let brute = staircases(levels).iter().map(|s| of(s)).fold(f64::NEG_INFINITY, f64::max);
            let (value, state) = map.largest();
            assert_abs_diff_eq!(value, brute, epsilon = 1e-12);
            assert_abs_diff_eq!(value, of(&state), epsilon = 1e-12);
        }
    }

    #[test]
    fn rises_and_nodes_round_trip() {
        let g = grid(5);
        let rises: Vec<Vec<f64>> =
            (0..5).map(|j| (0..5 - j).map(|k| f64::from(j + k)).collect()).collect();
        let map = PlayMap::from_rises(&g, 1.0, &rises).unwrap();
        for (got, want) in map.rises().iter().flatten().zip(rises.iter().flatten()) {
            assert_abs_diff_eq!(got, want, epsilon = 1e-12);
        }
        for row in &map.nodes {
            assert_abs_diff_eq!(row[0], -row[row.len() - 1], epsilon = 1e-12);
        }
        assert!(PlayMap::from_rises(&g, 0.0, &rises[1..]).is_err());
    }

    proptest! {
        #[test]
        fn largest_bounds_every_state_that_a_history_reaches(
            history in prop::collection::vec(-20.0..150.0_f64, 1..40)
        ) {
            let g = grid(9);
            let map = wavy(9, 1.1);
            let bound = map.largest().0;
            let mut memory = PlayMemory::new(&g, 40.0, StartState::Rest);
            for u in history {
                memory.apply(&g, u);
                prop_assert!(map.value(&memory) <= bound + 1e-12);
            }
        }

        #[test]
        fn a_refined_map_is_the_same_function(
            history in prop::collection::vec(-20.0..150.0_f64, 1..20)
        ) {
            let (coarse, fine) = (grid(4), grid(12));
            let map = wavy(4, 0.8);
            let refined = map.refined(3);
            let mut a = PlayMemory::new(&coarse, 65.0, StartState::Rest);
            let mut b = PlayMemory::new(&fine, 65.0, StartState::Rest);
            for u in history {
                a.apply(&coarse, u);
                b.apply(&fine, u);
                prop_assert!((map.value(&a) - refined.value(&b)).abs() < 1e-12);
            }
        }
    }
}

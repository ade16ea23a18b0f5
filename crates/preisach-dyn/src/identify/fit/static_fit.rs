//! The static map `G0` from quasi-static records, by constrained least squares.

use crate::identify::fit::program::{FINE_GAP, LeastSquaresProgram, Row};
use crate::identify::fit::training::Training;
use crate::identify::records::prepared::Prepared;
use crate::identify::records::record::spread;
use crate::laws::play_map::split;
use crate::{PlayMap, PreisachError, PreisachGrid};
use std::ops::Range;

/// `G0` of the density `mu0 >= 0` that fits targets in the least squares sense.
///
/// ```text
/// min  sum_records mean_i (offset + sum_jk v_jk N_jk(x_i) - target_i)^2 / spread^2 / records
///      + smoothness * cells * sum_neighbours (m_a - m_b)^2 / spread^2
/// m_jk = v_j,k+1 - v_jk >= 0,   v_j0 = 0
/// ```
/// `N_jk` are the hat functions of the knots. What is alike is said by [`Smoothness`];
/// the reversible part, which sits on the diagonal, is smoothed along it.
/// A cell no record crosses takes what its neighbours have.
///
/// `targets_deg` has one row per slow record, one value per sample.
pub(crate) fn fit(training: &Training, targets_deg: &[Vec<f64>]) -> Result<PlayMap, PreisachError> {
    let Training { grid, settings, slow: records, .. } = training;
    let unknowns = Unknowns::new(grid);
    let spread = targets_deg.iter().map(|targets| spread(targets)).fold(0.0, f64::max);
    let mut program = normal(training).clone();
    let mut row = Row::new();
    for (record, targets) in records.iter().zip(targets_deg) {
        let weight = weight(training, record);
        for (index, cells) in record.states() {
            unknowns.hats(cells, &mut row);
            program.aim(&row, targets[index], weight);
        }
    }
    unknowns.solved(grid, program, settings.static_smoothness, spread * spread)
}

/// What is to be alike in a density, with a weight relative to the squared error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Smoothness {
    /// Cells that share a side.
    Sides(f64),
    /// Plays of one width: loops of one size look alike wherever they are run, as in the operator of Prandtl and
    /// Ishlinskii. Neighbouring widths hang together weakly, so that none is free.
    EqualWidths(f64),
}

/// Weight between widths over that between plays of one width.
const BETWEEN_WIDTHS: f64 = 1e-3;
/// Numbers of a play that a loop and the rise to it determine, at most.
const OF_A_LOOP: usize = 3;

impl Smoothness {
    /// That of the density of some samples: plays of one width are alike where the samples are of one loop alone.
    pub(crate) fn of(samples: &LeastSquaresProgram, levels: usize, weight: f64) -> Self {
        let of_a_loop = OF_A_LOOP * levels;
        let is_more = samples.rank(RANK, of_a_loop + 1) > of_a_loop;
        if is_more { Self::Sides(weight) } else { Self::EqualWidths(weight) }
    }

    /// Weights of the plays of width `j` with each other and with the next width; the first is the reversible part.
    fn weights(self, j: usize) -> [f64; 2] {
        match (self, j) {
            (Self::Sides(weight), 0) => [weight, 0.0],
            (Self::Sides(weight), _) => [0.0, weight],
            (Self::EqualWidths(weight), _) => [weight, BETWEEN_WIDTHS * weight],
        }
    }
}

/// The samples of the slow records, the weights of all together 1, without targets.
pub(crate) fn normal<'a>(training: &'a Training) -> &'a LeastSquaresProgram {
    training.slow_once.normal.get_or_init(|| {
        let unknowns = Unknowns::new(&training.grid);
        let mut program = LeastSquaresProgram::new(unknowns.count);
        let mut row = Row::new();
        for record in &training.slow {
            let weight = weight(training, record);
            for (_, cells) in record.states() {
                unknowns.hats(cells, &mut row);
                program.add(&row, 0.0, weight);
            }
        }
        program
    })
}

/// Weight of a sample of a slow record: records weigh alike.
pub(crate) fn weight(training: &Training, record: &Prepared) -> f64 {
    1.0 / (training.slow.len() * record.samples.len()) as f64
}

/// As [`fit`], to the outputs of the records as they stand.
pub(crate) fn as_measured(training: &Training) -> Result<PlayMap, PreisachError> {
    let map = training.slow_once.map.get_or_init(|| {
        let measured = training.slow.iter().map(|r| r.record.output_deg.clone());
        fit(training, &measured.collect::<Vec<_>>())
    });
    map.clone()
}

/// Numbers of the density that the slow records determine, and how many there are.
pub(crate) fn determined(training: &Training) -> [usize; 2] {
    let count = Unknowns::new(&training.grid).count;
    [normal(training).rank(RANK, count), count]
}

/// Information of a direction below this share of the largest counts as none.
const RANK: f64 = 1e-6;

/// Sums entries of the same column; columns ascend.
pub(crate) fn merged(mut row: Row) -> Row {
    row.sort_by_key(|entry| entry.0);
    let mut result: Row = Vec::with_capacity(row.len());
    for (column, value) in row {
        match result.last_mut() {
            Some(last) if last.0 == column => last.1 += value,
            _ => result.push((column, value)),
        }
    }
    result
}

/// Bounds of the density, and its smoothness over `cells`: `rise(j, k, scale)` is `scale`
/// times the rise of play `j` between its knots `k` and `k + 1`, as a row.
pub(crate) fn smooth_density(
    levels: usize,
    cells: f64,
    smoothness: Smoothness,
    rise: impl Fn(usize, usize, f64) -> Row,
    program: &mut LeastSquaresProgram,
) {
    for j in 0..levels {
        let [along, across] = smoothness.weights(j);
        for k in 0..levels - j {
            program.at_least(rise(j, k, 1.0), 0.0);
            let lower = k.checked_sub(1).map(|lower| (j + 1, lower, across));
            let others = [Some((j, k + 1, along)), Some((j + 1, k, across)), lower];
            for (j2, k2, weight) in others.into_iter().flatten().filter(|other| other.2 > 0.0) {
                if j2 < levels && k2 < levels - j2 {
                    let mut difference = rise(j, k, 1.0);
                    difference.extend(rise(j2, k2, -1.0));
                    program.add(&merged(difference), 0.0, weight * cells);
                }
            }
        }
    }
}

/// The number of the first unknown of every row, from the lengths of the rows, and the count of all: 0
/// is the constant before them.
pub(crate) fn numbered(lengths: impl Iterator<Item = usize>) -> (Vec<usize>, usize) {
    let mut count = 1;
    let starts = lengths.map(|length| {
        count += length;
        count - length
    });
    (starts.collect(), count)
}

/// Numbering of the unknowns: the offset, then `v_jk` for `k >= 1`, play by play.
#[derive(Debug, Clone)]
pub(crate) struct Unknowns {
    starts: Vec<usize>,
    pub(crate) count: usize,
}

impl Unknowns {
    /// The map that a program of samples leads to, whose weights sum to one: with smoothness per cell
    /// and the bounds of the density. Where the samples are of one loop alone, plays of one width are alike instead.
    /// `variance` is that of the targets.
    pub(crate) fn solved(
        &self,
        grid: &PreisachGrid,
        mut program: LeastSquaresProgram,
        smoothness: f64,
        variance: f64,
    ) -> Result<PlayMap, PreisachError> {
        let smoothness = Smoothness::of(&program, grid.levels(), smoothness);
        // the map in spreads from the mean: neither the unit nor the zero of the targets says where the solver ends
        let spread = variance.sqrt();
        let mean = program.count_targets_in(spread);
        let rise = |j, k, scale| self.rise(j, k, scale);
        let cells = (self.count - 1) as f64;
        smooth_density(grid.levels(), cells, smoothness, rise, &mut program);
        let mut solution = program.solve_to(FINE_GAP, "static map")?;
        for value in &mut solution {
            *value *= spread;
        }
        solution[0] += mean;
        Ok(self.map(grid, &solution))
    }

    /// The map of a solution.
    fn map(&self, grid: &PreisachGrid, solution: &[f64]) -> PlayMap {
        let nodes = (0..grid.levels())
            .map(|j| {
                // the solver meets the bounds to its tolerance only: no density below zero is kept
                let mut value = 0.0_f64;
                let mut nodes = vec![value];
                for k in 1..grid.knots(j) {
                    value = value.max(solution[self.node(j, k)]);
                    nodes.push(value);
                }
                nodes
            })
            .collect();
        PlayMap { constant: solution[0], nodes }
    }

    pub(crate) fn new(grid: &PreisachGrid) -> Self {
        let (starts, count) = numbered((0..grid.levels()).map(|j| grid.levels() - j));
        Self { starts, count }
    }

    /// Numbers of the unknowns of every play, its lowest knot first.
    pub(crate) fn plays(&self) -> impl Iterator<Item = Range<usize>> {
        let ends = self.starts[1..].iter().copied().chain([self.count]);
        self.starts.iter().copied().zip(ends).map(|(start, end)| start..end)
    }

    /// Number of the rise of play `j` between its knots `k` and `k + 1`, where rises are the unknowns.
    pub(crate) fn cell(&self, j: usize, k: usize) -> usize {
        self.node(j, k + 1)
    }

    /// Number of `v_jk`, `k >= 1`.
    fn node(&self, j: usize, k: usize) -> usize {
        self.starts[j] + k - 1
    }

    /// `scale (v_j,k+1 - v_jk)` as a row.
    pub(crate) fn rise(&self, j: usize, k: usize, scale: f64) -> Row {
        let mut row = Row::new();
        if k > 0 {
            row.push((self.node(j, k), -scale));
        }
        row.push((self.node(j, k + 1), scale));
        row
    }

    /// The row of the offset and all hat functions in a memory state.
    pub(crate) fn hats(&self, cells: &[f64], row: &mut Row) {
        row.clear();
        row.push((0, 1.0));
        for (j, &x) in cells.iter().enumerate() {
            let (k, t) = split(x);
            if k > 0 {
                row.push((self.node(j, k), 1.0 - t));
            }
            if t > 0.0 {
                row.push((self.node(j, k + 1), t));
            }
        }
    }
}

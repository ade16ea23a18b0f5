//! The static part of the base model: plays with smooth output maps, linear in its coefficients.

use nalgebra::{DMatrix, DVector};

/// Number of plays.
const PLAYS: usize = 20;
/// Half-widths grow as this power of the number: small loops need narrow plays.
const GROWTH: f64 = 1.4;
/// Cells of the output map of the narrowest play.
const CELLS: f64 = 12.0;
/// Input up to which a law goes on beyond its range, over half of it: maps are straight there. An amplifier that is a little too
/// strong, hum or an overshoot leave the range of the commands.
const BEYOND: f64 = 1.3;
/// 1.5 times 2 to the 52: a sum with it ends in the digits of the nearest whole number.
const DIGITS: f64 = 6_755_399_441_055_744.0;
/// The digits of a cell's number; more than a map has cells.
const CELL: u64 = MAP as u64 - 1;
/// Places for the cells of a map.
const MAP: usize = 16;

/// Plays of fixed half-widths over an input range, each with a quadratic spline of its state.
///
/// ```text
/// h = offset + sum_i g_i(p_i),   p_i the play of half-width r_i,   g_i a quadratic spline
/// ```
/// the Preisach operator in play form, `g_i' = integral of the density`. In coefficients `c`:
/// `h = offset + sum c_k N_k`. The range is mapped onto -1 to 1.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Plays {
    middle: f64,
    half: f64,
    all: Vec<Play>,
    count: usize,
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Play {
    half_width: f64,
    /// Part of the half-widths that this play stands for.
    share: f64,
    cells: usize,
    /// Cells per unit of the state.
    per_unit: f64,
    /// Place of the first coefficient; `cells + 2` belong to the play.
    first: usize,
}

/// A quadratic on one cell: value, slope, curvature in the place inside it.
type Quadratic = [f64; 3];

/// The output maps laid out for speed.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OutputMap {
    offset: f64,
    cells: [[Quadratic; MAP]; PLAYS],
}

impl OutputMap {
    /// The same with all outputs higher.
    pub(crate) fn raised(mut self, by: f64) -> Self {
        self.offset += by;
        self
    }
}

impl Plays {
    pub(crate) fn new(low: f64, high: f64) -> Self {
        let n = PLAYS as f64;
        let width = |i: f64| (i / n).powf(GROWTH);
        let mut count = 0;
        let plays = (0..PLAYS)
            .map(|i| {
                let at = i as f64;
                let half_width = width(at);
                let share = width(at + 0.5) - if i == 0 { 0.0 } else { width(at - 0.5) };
                let cells = cells_of(1.0 - half_width);
                let first = count;
                count += cells + 2;
                let per_unit = cells as f64 / (2.0 * (1.0 - half_width));
                Play { half_width, share, cells, per_unit, first }
            })
            .collect();
        Self { middle: 0.5 * (low + high), half: 0.5 * (high - low), all: plays, count }
    }

    /// Number of coefficients.
    pub(crate) fn count(&self) -> usize {
        self.count
    }

    fn coordinate(&self, input: f64) -> f64 {
        ((input - self.middle) / self.half).clamp(-BEYOND, BEYOND)
    }

    /// The plays at rest at an input.
    pub(crate) fn rest(&self, input: f64) -> Vec<f64> {
        let x = self.coordinate(input);
        self.all.iter().map(|p| x.clamp(p.half_width - 1.0, 1.0 - p.half_width)).collect()
    }

    fn advance(&self, states: &mut [f64], input: f64) {
        let x = self.coordinate(input);
        for (state, play) in states.iter_mut().zip(&self.all) {
            *state = state.min(x + play.half_width).max(x - play.half_width);
        }
    }

    /// Hands the nonzero spline values of every sample to `visit`: sample, coefficients with values.
    pub(crate) fn rows(&self, inputs: &[f64], mut visit: impl FnMut(usize, &[(usize, f64)])) {
        let Some(&first) = inputs.first() else { return };
        let mut states = self.rest(first);
        let mut row = Vec::with_capacity(3 * self.all.len());
        for (i, &input) in inputs.iter().enumerate() {
            self.advance(&mut states, input);
            row.clear();
            for (play, &state) in self.all.iter().zip(&states) {
                let (cell, t) = play.place(state);
                let k = play.first + cell;
                // inside its cells `t` is from 0 to 1; what is beyond goes on straight
                let (t, past) = inside(t);
                row.push((k, 0.5 * (1.0 - t) * (1.0 - t) - past * (1.0 - t)));
                row.push((k + 1, 0.5 + t - t * t + past * (1.0 - 2.0 * t)));
                row.push((k + 2, 0.5 * t * t + past * t));
            }
            visit(i, &row);
        }
    }

    /// The output for a history of inputs that begins at rest.
    ///
    /// The most called loop of a diagnosis: the plays stand in columns of a fixed length, and the cell
    /// of a state is read from the last digits of a sum with [`DIGITS`]. A state on the border of two
    /// cells may be given to either: the maps are continuous there.
    pub(crate) fn outputs(&self, map: &OutputMap, inputs: &[f64]) -> Vec<f64> {
        let Some(&first) = inputs.first() else { return Vec::new() };
        if inputs.iter().any(|&input| self.coordinate(input).abs() > 1.0) {
            return self.outputs_beyond(map, first, inputs);
        }
        let column = |of: fn(&Play) -> f64| std::array::from_fn(|k| of(&self.all[k]));
        let half_width: [f64; PLAYS] = column(|play| play.half_width);
        let per_unit: [f64; PLAYS] = column(|play| play.per_unit);
        let last: [f64; PLAYS] = column(|play| DIGITS + (play.cells - 1) as f64);
        let mut states: [f64; PLAYS] = [0.0; PLAYS];
        states.copy_from_slice(&self.rest(first));
        inputs
            .iter()
            .map(|&input| {
                let x = self.coordinate(input);
                let (mut cells, mut places) = ([0_u64; PLAYS], [0.0; PLAYS]);
                for k in 0..PLAYS {
                    let state = above(below(states[k], x + half_width[k]), x - half_width[k]);
                    states[k] = state;
                    let from_end = above((state + 1.0 - half_width[k]) * per_unit[k], 0.0);
                    let cell = below((from_end - 0.5) + DIGITS, last[k]);
                    cells[k] = cell.to_bits();
                    places[k] = from_end - (cell - DIGITS);
                }
                let mut sum = map.offset;
                for ((maps, cell), t) in map.cells.iter().zip(cells).zip(places) {
                    let [a, b, c] = maps[(cell & CELL) as usize];
                    sum += a + t * (b + t * c);
                }
                sum
            })
            .collect()
    }

    /// The same where inputs leave the range: every map goes on straight beyond its ends.
    fn outputs_beyond(&self, map: &OutputMap, first: f64, inputs: &[f64]) -> Vec<f64> {
        let mut states = self.rest(first);
        let mut one = |&input: &f64| {
            self.advance(&mut states, input);
            let of = |((play, cells), &state): ((&Play, &[Quadratic; MAP]), &f64)| {
                let (cell, t) = play.place(state);
                let [a, b, c] = cells[cell];
                let (t, past) = inside(t);
                a + t * (b + t * c) + past * (b + 2.0 * t * c)
            };
            map.offset + self.all.iter().zip(&map.cells).zip(&states).map(of).sum::<f64>()
        };
        inputs.iter().map(&mut one).collect()
    }

    /// The output maps of given coefficients.
    pub(crate) fn map(&self, offset: f64, coefficients: &[f64]) -> OutputMap {
        let mut cells = [[[0.0; 3]; MAP]; PLAYS];
        for (play, map) in self.all.iter().zip(&mut cells) {
            for (k, cell) in map.iter_mut().enumerate().take(play.cells) {
                let c = &coefficients[play.first + k..play.first + k + 3];
                *cell = [0.5 * (c[0] + c[1]), c[1] - c[0], 0.5 * (c[0] - 2.0 * c[1] + c[2])];
            }
        }
        OutputMap { offset, cells }
    }

    /// The rises of the maps that stand behind the coefficients: `coefficients = matrix rises`. Every
    /// map has opposite values at its ends.
    pub(crate) fn rises_to_coefficients(&self) -> DMatrix<f64> {
        let mut matrix = DMatrix::zeros(self.count, self.rises());
        let mut column = 0;
        for play in &self.all {
            for k in 0..=play.cells {
                for j in 0..play.cells + 2 {
                    matrix[(play.first + j, column + k)] = if j > k { 0.5 } else { -0.5 };
                }
            }
            column += play.cells + 1;
        }
        matrix
    }

    /// Number of rises.
    fn rises(&self) -> usize {
        self.all.iter().map(|p| p.cells + 1).sum()
    }

    /// Rises and offset of a straight line, `output = at_zero + slope input`.
    pub(crate) fn line(&self, slope: f64, at_zero: f64) -> (DVector<f64>, f64) {
        let cells = self.all.first().map_or(1, |narrowest| narrowest.cells);
        let mut line = DVector::zeros(self.rises());
        line.rows_mut(0, cells + 1).fill(2.0 * slope * self.half / cells as f64);
        (line, at_zero + slope * self.middle)
    }

    /// Covariance of the rises: a density that is smooth over half-width and place, of a size
    /// `amplitude` (output per half range squared), over the length `length`, and a smooth
    /// reversible part of slope size `reversible`.
    pub(crate) fn prior(&self, amplitude: f64, reversible: f64, length: f64) -> DMatrix<f64> {
        let mut places = Vec::new();
        for play in &self.all {
            let step = 2.0 * (1.0 - play.half_width) / play.cells as f64;
            let place = |k: usize| (play, play.half_width - 1.0 + step * k as f64, step);
            places.extend((0..=play.cells).map(place));
        }
        let near = |d: f64| (-0.5 * d * d / (length * length)).exp();
        DMatrix::from_fn(places.len(), places.len(), |a, b| {
            let ((pa, at, step), (pb, bt, other)) = (places[a], places[b]);
            let nugget = if a == b { 1e-3 } else { 0.0 };
            let alike = near(at - bt);
            let sizes = (amplitude * step * pa.share) * (amplitude * other * pb.share);
            let dense = sizes * (near(pa.half_width - pb.half_width) * alike + nugget);
            if pa.first > 0 || pb.first > 0 {
                return dense;
            }
            dense + (reversible * step) * (reversible * other) * (alike + nugget)
        })
    }
}

impl Play {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a play state lies inside its cells"
    )]
    #[inline]
    fn place(&self, state: f64) -> (usize, f64) {
        let x = (state + 1.0 - self.half_width) * self.per_unit;
        let cell = (x.max(0.0) as u32 as usize).min(self.cells - 1);
        (cell, x - cell as f64)
    }
}

/// A place in a cell, held inside it, and how far it was beyond.
fn inside(place: f64) -> (f64, f64) {
    let held = place.clamp(0.0, 1.0);
    (held, place - held)
}

/// The smaller of two numbers that are there.
#[inline]
fn below(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// The larger of two numbers that are there.
#[inline]
fn above(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a small positive number"
)]
fn cells_of(room: f64) -> usize {
    ((CELLS * room).ceil() as usize).max(2)
}

/// Output of a first-order lag for an input straight between samples, at rest at first.
pub(crate) fn lagged(input: &[f64], tau_s: f64, step_s: f64) -> Vec<f64> {
    behind_lags(input, [(tau_s, 1.0)].into_iter(), step_s)
}

/// A signal with shares of its lags' deviations, `u + sum_k share_k (x_k - u)`, each `x_k` as of [`lagged`]:
/// time constant (s) and share of each. Four lags at a time, because each waits for its own last sample.
pub(crate) fn behind_lags(
    input: &[f64],
    lags: impl Iterator<Item = (f64, f64)>,
    step_s: f64,
) -> Vec<f64> {
    const SIDE_BY_SIDE: usize = 4;
    let mut output = input.to_vec();
    let lags: Vec<(f64, f64)> = lags.collect();
    for some in lags.chunks(SIDE_BY_SIDE) {
        // a lag that is not there has no share
        let (mut decay, mut ramp, mut share) =
            ([0.0; SIDE_BY_SIDE], [0.0; SIDE_BY_SIDE], [0.0; SIDE_BY_SIDE]);
        for (k, &(tau_s, own)) in some.iter().enumerate() {
            let x = step_s / tau_s;
            // what is left of a deviation after a step, and what a unit of the input's rise adds to it
            (decay[k], ramp[k], share[k]) = ((-x).exp(), -(-x).exp_m1() / x, own);
        }
        let mut deviation = [0.0; SIDE_BY_SIDE];
        let mut before = input.first().copied().unwrap_or_default();
        for (y, &u) in output.iter_mut().zip(input) {
            let rise = u - before;
            before = u;
            for k in 0..SIDE_BY_SIDE {
                deviation[k] = decay[k] * deviation[k] - ramp[k] * rise;
            }
            let part = |k: usize| share[k] * deviation[k];
            *y += (part(0) + part(1)) + (part(2) + part(3));
        }
    }
    output
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn lags_side_by_side_are_the_lags_one_by_one() {
        let input: Vec<f64> = (0..300).map(|i| (0.2 * f64::from(i)).sin()).collect();
        let lags: Vec<(f64, f64)> =
            (0..6).map(|k| (3e-3 * f64::from(1 + 5 * k), 0.1 * f64::from(k - 2))).collect();
        let together = behind_lags(&input, lags.iter().copied(), 1e-3);
        for (i, y) in together.iter().enumerate() {
            let own =
                |&(tau, share): &(f64, f64)| share * (lagged(&input, tau, 1e-3)[i] - input[i]);
            assert_abs_diff_eq!(input[i] + lags.iter().map(own).sum::<f64>(), *y, epsilon = 1e-14);
        }
    }

    #[test]
    fn rows_times_coefficients_are_the_output() {
        let plays = Plays::new(-20.0, 150.0);
        let coefficients: Vec<f64> = (0..plays.count()).map(|k| (0.7 * k as f64).sin()).collect();
        let inputs: Vec<f64> =
            (0..500).map(|i| 65.0 + 95.0 * (0.05 * f64::from(i)).sin()).collect();
        let direct = plays.outputs(&plays.map(0.3, &coefficients), &inputs);
        plays.rows(&inputs, |i, row| {
            let sum: f64 = row.iter().map(|&(k, v)| v * coefficients[k]).sum();
            assert_abs_diff_eq!(0.3 + sum, direct[i], epsilon = 1e-12);
        });
    }

    #[test]
    fn a_line_is_straight_over_any_range() {
        let plays = Plays::new(-20.0, 150.0);
        let (rises, offset) = plays.line(2.5, 7.0);
        let coefficients = plays.rises_to_coefficients() * rises;
        let inputs = [65.0, -13.0, 149.0, 155.0, 20.0, -26.0];
        let outputs = plays.outputs(&plays.map(offset, coefficients.as_slice()), &inputs);
        for (y, u) in outputs.iter().zip(inputs) {
            assert_abs_diff_eq!(*y, 7.0 + 2.5 * u, epsilon = 1e-10);
        }
    }

    #[test]
    fn equal_rises_of_the_narrowest_play_are_a_straight_line() {
        let plays = Plays::new(-1.0, 1.0);
        let matrix = plays.rises_to_coefficients();
        let mut rises = DVector::zeros(matrix.ncols());
        let cells = plays.all[0].cells;
        for k in 0..=cells {
            rises[k] = 2.0 / cells as f64;
        }
        let coefficients = matrix * rises;
        let inputs = [0.0, 0.3, -0.7, 1.0];
        let outputs = plays.outputs(&plays.map(0.0, coefficients.as_slice()), &inputs);
        for (y, u) in outputs.iter().zip(inputs) {
            assert_abs_diff_eq!(*y, u, epsilon = 1e-12);
        }
    }
}

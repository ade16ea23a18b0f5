//! What is known of the errors when nothing is missing.

use super::predicted::Tables;
use super::table::{Grid, Part, PointTable};
use crate::discovery::{Signal, Trace, TraceRole};
use crate::{GapError, Spectrum};
use nalgebra::{Cholesky, DMatrix, DVector};

/// Smooth error of the simulation that is always allowed for, over the deviation of a reading: points share what neither
/// repeats nor alternatives show, such as a density or a blockage.
const SMOOTH: f64 = 1.0;
/// Part of what the others do not explain of an alternative left out, in amplitude, by which the truth is taken to lie
/// beside all of them.
const LEFT_OUT: f64 = 0.4;

/// Two values of a condition that are taken for one, over the range of the table and over themselves.
const SAME_OF_RANGE: f64 = 0.01;
const SAME_OF_VALUE: f64 = 0.002;

/// The error of the simulation that no alternative holds, by channel and in its unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct ModelError {
    /// Of what the points of one condition share.
    pub(super) level: Vec<f64>,
    /// Of what they differ by: the answer to a drive.
    pub(super) change: Vec<f64>,
}

impl ModelError {
    /// Each alternative is left out in turn. What the others, the uncertain inputs and the calibrations do not explain of it is
    /// what two models differ by that are thought equally good; the truth, one more of them, is near these. The channels of one
    /// harmonic share it, so that the reference of azimuth does not matter.
    fn of(table: &PointTable, sets: &Sets) -> Result<Self, GapError> {
        let width = table.channels.len();
        let deviations: Grid = table.points.iter().map(|point| point.deviation.clone()).collect();
        let tables = Tables::of_measured(table, deviations);
        let away = |grid: &Grid| tables.signal(|p, c| grid[p][c] - table.predicted[p][c]).concat();
        let alternatives: Vec<Vec<f64>> = table.alternatives.iter().map(away).collect();
        let known: Vec<Vec<f64>> = table.uncertain.iter().map(away).collect();
        let (mut level, mut change) = (vec![Mean::default(); width], vec![Mean::default(); width]);
        for (out, left_out) in alternatives.iter().enumerate() {
            let others = alternatives.iter().enumerate().filter(|(other, _)| *other != out);
            let columns: Vec<&Vec<f64>> = others.map(|(_, own)| own).chain(&known).collect();
            let left = beyond(left_out, &columns)?;
            // values of every channel by set, in its unit
            let mut values = vec![vec![Vec::new(); sets.count]; width];
            let mut each = left.iter();
            for (p, channels) in &tables.rows {
                for (&c, value) in channels.iter().zip(&mut each) {
                    values[c][sets.of_point[*p]].push(LEFT_OUT * value * tables.sigma[*p][c]);
                }
            }
            for (c, of_set) in values.iter().enumerate() {
                for own in of_set.iter().filter(|own| !own.is_empty()) {
                    let mean = own.iter().sum::<f64>() / own.len() as f64;
                    level[c].add(mean * mean, 1.0);
                    let off: f64 = own.iter().map(|value| (value - mean).powi(2)).sum();
                    change[c].add(off, own.len() as f64 - 1.0);
                }
            }
        }
        for (c, channel) in table.channels.iter().enumerate() {
            if let Part::CosineOf(sine) = channel.part {
                for own in [&mut level, &mut change] {
                    let both = Mean {
                        sum: own[c].sum + own[sine].sum,
                        count: own[c].count + own[sine].count,
                    };
                    (own[c], own[sine]) = (both, both);
                }
            }
        }
        let root = |own: &Mean| (own.sum / own.count.max(1.0)).sqrt();
        Ok(Self {
            level: level.iter().map(root).collect(),
            change: change.iter().map(root).collect(),
        })
    }
}

/// A sum and how many values it is of.
#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    sum: f64,
    count: f64,
}

impl Mean {
    fn add(&mut self, sum: f64, count: f64) {
        self.sum += sum;
        self.count += count;
    }
}

/// The points of one condition, such as control off and on.
#[derive(Debug, Clone, PartialEq, Eq)]
struct Sets {
    /// Number of the set of every point.
    of_point: Vec<usize>,
    /// How many sets there are.
    count: usize,
}

impl Sets {
    fn of(table: &PointTable) -> Self {
        let same: Vec<f64> = (0..table.conditions.len())
            .map(|k| {
                let own = table.points.iter().map(|point| point.conditions[k]);
                let (low, high) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| {
                    (low.min(v), high.max(v))
                });
                SAME_OF_RANGE * (high - low)
            })
            .collect();
        let mut first: Vec<&[f64]> = Vec::new();
        let mut of_point = Vec::with_capacity(table.points.len());
        for point in &table.points {
            let own = &point.conditions[..];
            let is_same = |other: &&[f64]| {
                own.iter()
                    .zip(*other)
                    .zip(&same)
                    .all(|((a, b), same)| (a - b).abs() <= same.max(SAME_OF_VALUE * a.abs()))
            };
            let place = first.iter().position(is_same).unwrap_or_else(|| {
                first.push(own);
                first.len() - 1
            });
            of_point.push(place);
        }
        Self { of_point, count: first.len() }
    }

    /// The measured points of every set that reads a channel at two points at least.
    fn shared(&self, tables: &Tables<'_>, channel: usize) -> Vec<usize> {
        let mut counts = vec![0; self.count];
        for (p, channels) in &tables.rows {
            if channels.contains(&channel) {
                counts[self.of_point[*p]] += 1;
            }
        }
        (0..self.count).filter(|&set| counts[set] > 1).collect()
    }

    /// The mean of a grid over the points of every set.
    fn means(&self, grid: &Grid) -> Grid {
        let width = grid.first().map_or(0, Vec::len);
        let (mut sums, mut counts) = (vec![vec![0.0; width]; self.count], vec![0.0; self.count]);
        for (row, &set) in grid.iter().zip(&self.of_point) {
            counts[set] += 1.0;
            for (sum, value) in sums[set].iter_mut().zip(row) {
                *sum += value;
            }
        }
        for (sum, count) in sums.iter_mut().zip(&counts) {
            for value in sum {
                *value /= *count;
            }
        }
        self.of_point.iter().map(|&set| sums[set].clone()).collect()
    }
}

/// A vector less what columns explain of it, each with a factor of standard deviation 1.
fn beyond(vector: &[f64], columns: &[&Vec<f64>]) -> Result<Vec<f64>, GapError> {
    let (taken, _) = fitted(vector, columns, &[])?;
    Ok(vector.iter().zip(taken.as_slice()).map(|(a, b)| a - b).collect())
}

/// What columns explain of a vector, and their factors: each of standard deviation 1, the first about less than `moved`.
fn fitted(
    vector: &[f64],
    columns: &[&Vec<f64>],
    moved: &[f64],
) -> Result<(DVector<f64>, DVector<f64>), GapError> {
    let own = DVector::from_column_slice(vector);
    let matrix = DMatrix::from_fn(vector.len(), columns.len(), |i, k| columns[k][i]);
    let normal = matrix.tr_mul(&matrix) + DMatrix::identity(columns.len(), columns.len());
    let solver =
        Cholesky::new(normal).ok_or(GapError::NotPositiveDefinite { columns: columns.len() })?;
    let mut asked = matrix.tr_mul(&own);
    for (asked, moved) in asked.iter_mut().zip(moved) {
        *asked -= moved;
    }
    let factors = solver.solve(&asked);
    Ok((&matrix * &factors, factors))
}

/// Chi-square that columns leave of a vector, each with a factor of standard deviation 1, the first of which stand at `moved`
/// already; and where the fit puts these.
pub(super) fn explained(
    vector: &[f64],
    columns: &[Vec<f64>],
    moved: &[f64],
) -> Result<(f64, Vec<f64>), GapError> {
    let columns: Vec<&Vec<f64>> = columns.iter().collect();
    let (taken, factors) = fitted(vector, &columns, moved)?;
    let mut factors = factors.as_slice().to_vec();
    for (factor, moved) in factors.iter_mut().zip(moved) {
        *factor += moved;
    }
    let left: f64 = vector.iter().zip(taken.as_slice()).map(|(a, b)| (a - b).powi(2)).sum();
    let cost = left + factors.iter().map(|own| own * own).sum::<f64>();
    factors.truncate(moved.len());
    Ok((cost, factors))
}

/// Conditions that vary, from -1 to 1 over the table, each with its Chebyshev polynomials of first and second degree, by
/// point.
fn varied(table: &PointTable) -> Vec<Vec<f64>> {
    let of = |k: usize| -> Vec<f64> { table.points.iter().map(|own| own.conditions[k]).collect() };
    let scaled = |values: Vec<f64>| {
        let low = values.iter().copied().fold(f64::INFINITY, f64::min);
        let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (middle, half) = (f64::midpoint(low, high), 0.5 * (high - low));
        let varies = half > 1e-9 * middle.abs().max(1e-300);
        varies.then(|| values.iter().map(|v| (v - middle) / half).collect::<Vec<f64>>())
    };
    let straight: Vec<Vec<f64>> = (0..table.conditions.len()).map(of).filter_map(scaled).collect();
    let bend = |own: &Vec<f64>| own.iter().map(|x| 2.0f64.mul_add(x * x, -1.0)).collect();
    let bent: Vec<Vec<f64>> = straight.iter().map(bend).collect();
    [straight, bent].concat()
}

/// What a calibration or a smooth error of the simulation does to one channel, or to the two of a harmonic.
enum Shape<'a> {
    /// A constant on a channel.
    Zero(usize),
    /// What a set of channels is predicted to be.
    Gain(&'a [usize]),
    /// The same a quarter turn of the harmonic on.
    Turned(&'a [usize]),
}

impl Shape<'_> {
    /// Of what the channels are in a grid.
    fn at(&self, table: &PointTable, grid: &Grid, point: usize, channel: usize) -> f64 {
        let predicted = |c: usize| grid[point][c];
        match self {
            Self::Zero(own) => f64::from(*own == channel),
            Self::Gain(own) if own.contains(&channel) => predicted(channel),
            Self::Turned(own) if own.contains(&channel) => match table.channels[channel].part {
                Part::CosineOf(sine) => -predicted(sine),
                Part::SineOf(cosine) => predicted(cosine),
                Part::Scalar => 0.0,
            },
            Self::Gain(_) | Self::Turned(_) => 0.0,
        }
    }
}

/// The channels of every instrument.
fn by_instrument(table: &PointTable) -> Vec<Vec<usize>> {
    let of =
        |i: usize| (0..table.channels.len()).filter(move |&c| table.channels[c].instrument == i);
    (0..table.instruments.len()).map(|i| of(i).collect()).collect()
}

/// What the simulation and the calibrations may be off by.
pub(super) struct Floor {
    /// Standard deviation of every value, error of the simulation included.
    pub(super) sigma: Grid,
    /// Error of the simulation that alternatives show.
    pub(super) model_error: ModelError,
    /// Points of one condition.
    sets: Sets,
    /// Smooth error of the simulation by channel, in its unit.
    smooth_error: Vec<f64>,
    /// What a set with a reference may be off by, by channel and in its unit.
    at_reference: Vec<f64>,
}

/// Rms of what the references read less what is simulated there, by channel.
fn off_at_references(table: &PointTable) -> Vec<f64> {
    let of = |c: usize| {
        let all = table.points.iter().zip(&table.predicted).filter(|own| own.0.is_reference);
        let off: Vec<f64> =
            all.filter_map(|(point, row)| Some(point.measured[c]? - row[c])).collect();
        rotor_base::mean_square(&off).sqrt()
    };
    (0..table.channels.len()).map(of).collect()
}

/// Root of the mean square of some channels of a grid.
fn size(grid: &Grid, channels: &[usize]) -> f64 {
    let of =
        |c: usize| rotor_base::mean_square(&grid.iter().map(|row| row[c]).collect::<Vec<f64>>());
    channels.iter().map(|&c| of(c)).sum::<f64>().sqrt()
}

impl Floor {
    pub(super) fn of(table: &PointTable) -> Result<Self, GapError> {
        let sets = Sets::of(table);
        let model_error = ModelError::of(table, &sets)?;
        let ModelError { level, change } = &model_error;
        let mut sigma: Grid = table.points.iter().map(|point| point.deviation.clone()).collect();
        let tables = Tables::of_measured(table, Grid::new());
        for c in 0..table.channels.len() {
            let shared = sets.shared(&tables, c);
            for (row, set) in sigma.iter_mut().zip(&sets.of_point) {
                // what no other point of its condition shares is an error of its own
                let own = if shared.contains(set) { change[c] } else { level[c] };
                row[c] = row[c].hypot(own);
            }
        }
        let off = off_at_references(table);
        let smooth = |(c, model): (usize, &f64)| {
            let own: Vec<f64> = table.points.iter().map(|point| point.deviation[c]).collect();
            model.max(SMOOTH * rotor_base::mean_square(&own).sqrt()).max(off[c])
        };
        let smooth_error = level.iter().enumerate().map(smooth).collect();
        let at_reference = level.iter().zip(&off).map(|(level, off)| level.max(*off)).collect();
        Ok(Self { sigma, model_error, sets, smooth_error, at_reference })
    }

    /// Columns of the nuisance, each as a signal; the inputs that are not known well stand first.
    pub(super) fn nuisance(&self, tables: &Tables<'_>) -> Vec<Signal> {
        let table = tables.table;
        let base = &table.predicted;
        let away = |grid: &Grid| tables.signal(|p, c| grid[p][c] - base[p][c]);
        let mut columns: Vec<Signal> =
            table.uncertain.iter().chain(&table.alternatives).map(away).collect();
        let varied = varied(table);
        for (own, error) in self.smooth_error.iter().enumerate() {
            let at = |c: usize| if c == own { *error } else { 0.0 };
            columns.push(tables.signal(|_, c| at(c)));
            for varied in &varied {
                columns.push(tables.signal(|p, c| at(c) * varied[p]));
            }
        }
        let ModelError { level, change } = &self.model_error;
        for (own, level) in level.iter().enumerate() {
            for set in self.sets.shared(tables, own) {
                let mut points = table.points.iter().zip(&self.sets.of_point);
                let has_reference = points.any(|(p, of)| *of == set && p.is_reference);
                let error = if has_reference { self.at_reference[own] } else { *level };
                if error <= 0.0 {
                    continue;
                }
                let is_of = |p: usize, c: usize| c == own && self.sets.of_point[p] == set;
                columns.push(tables.signal(|p, c| if is_of(p, c) { error } else { 0.0 }));
            }
        }
        let means = self.sets.means(base);
        let less = |(a, b): (&f64, &f64)| a - b;
        let changes: Grid = base
            .iter()
            .zip(&means)
            .map(|(row, mean)| row.iter().zip(mean).map(less).collect())
            .collect();
        for (instrument, channels) in table.instruments.iter().zip(by_instrument(table)) {
            let mut add = |shape: Shape<'_>, grid: &Grid, size: f64| {
                if size > 0.0 {
                    columns.push(tables.signal(|p, c| size * shape.at(table, grid, p, c)));
                }
            };
            add(Shape::Gain(&channels), base, instrument.gain);
            // a simulation that is off by so much may be so by a factor and a turn
            for (grid, error) in [(&means, level), (&changes, change)] {
                let error = channels.iter().map(|&c| error[c].powi(2)).sum::<f64>().sqrt();
                let wrong =
                    if error > 0.0 { (error / size(grid, &channels)).min(1.0) } else { 0.0 };
                add(Shape::Gain(&channels), grid, wrong);
                add(Shape::Turned(&channels), grid, wrong);
            }
            if instrument.zero > 0.0 {
                for &own in &channels {
                    let zero = |c: usize| if c == own { instrument.zero } else { 0.0 };
                    columns.push(tables.signal(|_, c| zero(c)));
                }
            }
        }
        columns
    }

    /// What calibrations and errors of the simulation do not explain of a signal, its values in a row.
    pub(super) fn beyond(&self, tables: &Tables<'_>, signal: &[f64]) -> Result<Vec<f64>, GapError> {
        let columns: Vec<Vec<f64>> =
            self.nuisance(tables).into_iter().map(|own| own.concat()).collect();
        beyond(signal, &columns.iter().collect::<Vec<_>>())
    }

    /// The measured points as traces of the engine; and how many columns their nuisance has. All of these count as
    /// calibrations: where one of them must move far, nothing is denied with confidence.
    pub(super) fn traces(&self, tables: &Tables<'_>) -> (Vec<Trace>, usize) {
        let columns = self.nuisance(tables);
        let measured = tables.measured();
        let one = |(experiment, measured): (usize, Vec<f64>)| {
            let nuisance =
                DMatrix::from_fn(measured.len(), columns.len(), |i, k| columns[k][experiment][i]);
            Trace {
                experiment,
                step_s: 1.0,
                sigma: 1.0,
                spectrum: Spectrum::default(),
                // the error of the simulation is no noise, but is as little known
                noise: 1.0,
                nuisance,
                block: 1,
                role: TraceRole::Output,
                measured,
            }
        };
        (measured.into_iter().enumerate().map(one).collect(), columns.len())
    }

    /// Directions along which no suspect may leave structure: constants, gains and turns of every instrument, each also in
    /// proportion to every condition that varies.
    pub(super) fn generic(tables: &Tables<'_>) -> Vec<Signal> {
        let table = tables.table;
        let instruments = by_instrument(table);
        let of_channels = (0..table.channels.len()).map(Shape::Zero);
        let of_instruments =
            instruments.iter().flat_map(|own| [Shape::Gain(own), Shape::Turned(own)]);
        let shapes: Vec<Shape<'_>> = of_channels.chain(of_instruments).collect();
        let varied = varied(table);
        let mut all = Vec::new();
        for shape in &shapes {
            all.push(tables.signal(|p, c| shape.at(table, &table.predicted, p, c)));
            for varied in &varied {
                all.push(tables.signal(|p, c| varied[p] * shape.at(table, &table.predicted, p, c)));
            }
        }
        all.retain(|signal| signal.iter().flatten().any(|value| *value != 0.0));
        all
    }
}

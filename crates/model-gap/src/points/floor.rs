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

/// The error of the simulation that no alternative holds, by channel and in its unit.
///
/// Each alternative is left out in turn. What the others, the uncertain inputs and the calibrations do not explain of it is
/// what two models differ by that are thought equally good; the truth, one more of them, is near these. The channels of one harmonic share it, so that the reference
/// of azimuth does not matter.
pub(super) fn model_error(table: &PointTable) -> Result<Vec<f64>, GapError> {
    let width = table.channels.len();
    let deviations: Grid = table.points.iter().map(|point| point.deviation.clone()).collect();
    let tables = Tables::of_measured(table, deviations);
    let away = |grid: &Grid| tables.signal(|p, c| grid[p][c] - table.predicted[p][c]).concat();
    let alternatives: Vec<Vec<f64>> = table.alternatives.iter().map(away).collect();
    let known: Vec<Vec<f64>> = table.uncertain.iter().map(away).collect();
    let (mut squares, mut counts) = (vec![0.0; width], vec![0.0; width]);
    for (out, left_out) in alternatives.iter().enumerate() {
        let others = alternatives.iter().enumerate().filter(|(other, _)| *other != out);
        let columns: Vec<&Vec<f64>> = others.map(|(_, own)| own).chain(&known).collect();
        let left = beyond(left_out, &columns)?;
        let mut values = left.iter();
        for (p, channels) in &tables.rows {
            for (&c, value) in channels.iter().zip(&mut values) {
                squares[c] += (LEFT_OUT * value * tables.sigma[*p][c]).powi(2);
                counts[c] += 1.0;
            }
        }
    }
    for (c, channel) in table.channels.iter().enumerate() {
        if let Part::CosineOf(sine) = channel.part {
            let both = (squares[c] + squares[sine], counts[c] + counts[sine]);
            (squares[c], counts[c]) = both;
            (squares[sine], counts[sine]) = both;
        }
    }
    Ok(squares
        .iter()
        .zip(&counts)
        .map(|(sum, count)| (sum / f64::max(*count, 1.0)).sqrt())
        .collect())
}

/// A vector less what columns explain of it, each with a factor of standard deviation 1.
fn beyond(vector: &[f64], columns: &[&Vec<f64>]) -> Result<Vec<f64>, GapError> {
    let own = DVector::from_column_slice(vector);
    let matrix = DMatrix::from_fn(vector.len(), columns.len(), |i, k| columns[k][i]);
    let normal = matrix.tr_mul(&matrix) + DMatrix::identity(columns.len(), columns.len());
    let solver =
        Cholesky::new(normal).ok_or(GapError::NotPositiveDefinite { columns: columns.len() })?;
    let taken = &matrix * solver.solve(&matrix.tr_mul(&own));
    Ok((own - taken).as_slice().to_vec())
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
    fn at(&self, table: &PointTable, point: usize, channel: usize) -> f64 {
        let predicted = |c: usize| table.predicted[point][c];
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
    /// Error of the simulation by channel, in its unit, that alternatives show.
    pub(super) model_error: Vec<f64>,
    /// Smooth error of the simulation by channel, in its unit.
    smooth_error: Vec<f64>,
}

impl Floor {
    pub(super) fn of(table: &PointTable) -> Result<Self, GapError> {
        let model_error = model_error(table)?;
        let of_point = |deviation: &Vec<f64>| -> Vec<f64> {
            deviation.iter().zip(&model_error).map(|(own, model)| own.hypot(*model)).collect()
        };
        let sigma = table.points.iter().map(|point| of_point(&point.deviation)).collect();
        let smooth = |(c, model): (usize, &f64)| {
            let own: Vec<f64> = table.points.iter().map(|point| point.deviation[c]).collect();
            model.max(SMOOTH * rotor_base::mean_square(&own).sqrt())
        };
        let smooth_error = model_error.iter().enumerate().map(smooth).collect();
        Ok(Self { sigma, model_error, smooth_error })
    }

    /// Error of the simulation over what it predicts, of the channels of an instrument; no larger than 1.
    fn relative_error(&self, table: &PointTable, channels: &[usize]) -> f64 {
        let (mut error, mut size) = (0.0, 0.0);
        for &c in channels {
            let predicted: Vec<f64> = table.predicted.iter().map(|row| row[c]).collect();
            size += rotor_base::mean_square(&predicted);
            error += self.model_error[c].powi(2);
        }
        if size > error { (error / size).sqrt() } else { f64::from(u8::from(error > 0.0)) }
    }

    /// Columns of the nuisance, each as a signal.
    fn nuisance(&self, tables: &Tables<'_>) -> Vec<Signal> {
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
        for (instrument, channels) in table.instruments.iter().zip(by_instrument(table)) {
            let wrong = self.relative_error(table, &channels);
            // a simulation that is off by so much may be so by a factor and a turn
            let turned = Shape::Turned(&channels);
            let gain = instrument.gain.hypot(wrong);
            for (shape, size) in [(Shape::Gain(&channels), gain), (turned, wrong)] {
                if size > 0.0 {
                    columns.push(tables.signal(|p, c| size * shape.at(table, p, c)));
                }
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

    /// The measured points as traces of the engine; and how many columns their nuisance has. All of these count as
    /// calibrations: where one of them must move far, nothing is denied with confidence.
    pub(super) fn traces(&self, tables: &Tables<'_>) -> (Vec<Trace>, usize) {
        let columns = self.nuisance(tables);
        let points = &tables.table.points;
        let measured = tables.signal(|p, c| points[p].measured[c].unwrap_or_default());
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
            all.push(tables.signal(|p, c| shape.at(table, p, c)));
            for varied in &varied {
                all.push(tables.signal(|p, c| varied[p] * shape.at(table, p, c)));
            }
        }
        all.retain(|signal| signal.iter().flatten().any(|value| *value != 0.0));
        all
    }
}

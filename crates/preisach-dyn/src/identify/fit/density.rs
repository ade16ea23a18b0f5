//! How far the noise of the records leaves the static density open.

use crate::PlayMap;
use crate::identify::fit::program::{LeastSquaresProgram, Row};
use crate::identify::fit::static_fit::{Smoothness, Unknowns, normal, smooth_density, weight};
use crate::identify::fit::training::Training;
use crate::identify::records::prepared::Prepared;
use nalgebra::{DMatrix, DVector};
use rotor_base::mean_square;
use serde::{Deserialize, Serialize};

/// Where the noise of a [`DensitySpread`] comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseSource {
    /// What differs between repeated cycles of the training records: no model enters.
    Cycles,
    /// What the static model leaves of the slow records, its own error included: an upper bound.
    Residual,
}

/// What the noise of the slow records does to the static density.
///
/// ```text
/// H = N + P                        N: samples as weighed in the fit, P: smoothness
/// cov(m) = H^-1 ( sum_i w_i^2 sigma^2 a_i a_i' ) H^-1        on the rises m that are above their bound
/// ```
/// Gauss approximation: a rise at its bound stays there, the others move as if there were no bound.
///
/// Assumes: white noise, the same in every sample of a record. Not modelled: what the model itself cannot
/// follow, and the bias of the smoothness.
#[derive(Debug, Clone, PartialEq)]
pub struct DensitySpread {
    /// Standard deviation of the rise of every cell, deg, play by play as [`PlayMap::rises`]; none of a
    /// rise at its bound, zero.
    pub rise_std_deg: Vec<Vec<Option<f64>>>,
    /// Share of every rise that comes from the records, 0 to 1; the rest comes from its neighbours by
    /// the smoothness. None of a rise at its bound.
    pub record_share: Vec<Vec<Option<f64>>>,
    /// Standard deviation of the noise, root mean square over the slow records, deg.
    pub noise_deg: f64,
    /// Where it comes from.
    pub noise_source: NoiseSource,
}

/// The spread of the static map of the outputs as measured; none if its equations cannot be factored.
pub(crate) fn spread(training: &Training, map: &PlayMap) -> Option<DensitySpread> {
    let unknowns = Unknowns::new(&training.grid);
    let (noise_deg, noise_source) = noise(training, map);
    let samples = normal(training);
    let mut whole = samples.clone();
    let mut scatter = LeastSquaresProgram::new(unknowns.count);
    let mut row = Row::new();
    for (record, noise_deg) in training.slow.iter().zip(&noise_deg) {
        let weight = weight(training, record);
        for (index, cells) in record.states() {
            unknowns.hats(cells, &mut row);
            whole.aim(&row, record.record.output_deg[index], weight);
            scatter.add(&row, 0.0, (weight * noise_deg).powi(2));
        }
    }
    let levels = training.grid.levels();
    let smoothness = Smoothness::of(samples, levels, training.settings.static_smoothness);
    let rise = |j, k, scale| unknowns.rise(j, k, scale);
    smooth_density(levels, (unknowns.count - 1) as f64, smoothness, rise, &mut whole);

    let mut right = DMatrix::from_column_slice(unknowns.count, 1, whole.right());
    let [data, scatter, whole] =
        [samples, &scatter, &whole].map(|program| in_rises(program, &unknowns));
    sum_rows_above(&mut right, &unknowns);
    let found = map.rises().into_iter().flatten();
    let found = DVector::from_iterator(unknowns.count, std::iter::once(map.constant).chain(found));
    let slope = &whole * &found - right;
    // a step of Newton in this rise alone would lead below its bound
    let is_free = |i: &usize| *i == 0 || found[*i] * whole[(*i, *i)] > slope[*i];
    let free: Vec<usize> = (0..unknowns.count).filter(is_free).collect();
    let part = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(free.len(), free.len(), |i, j| matrix[(free[i], free[j])])
    };
    let factor = part(&whole).cholesky()?;
    let covariance = factor.solve(&factor.solve(&part(&scatter)).transpose());
    let shares = factor.solve(&part(&data));
    let of = |matrix: &DMatrix<f64>, value: fn(f64) -> f64| -> Vec<Vec<Option<f64>>> {
        let mut all = vec![None; unknowns.count];
        for (place, &i) in free.iter().enumerate() {
            all[i] = Some(value(matrix[(place, place)]));
        }
        (0..levels).map(|j| (0..levels - j).map(|k| all[unknowns.cell(j, k)]).collect()).collect()
    };
    Some(DensitySpread {
        rise_std_deg: of(&covariance, |variance| variance.max(0.0).sqrt()),
        record_share: of(&shares, |share| share.clamp(0.0, 1.0)),
        noise_deg: mean_square(&noise_deg).sqrt(),
        noise_source,
    })
}

/// The noise of every slow record, deg: of its own cycles, else of those of the other training records,
/// else what the map leaves.
fn noise(training: &Training, map: &PlayMap) -> (Vec<f64>, NoiseSource) {
    let own = |record: &&Prepared| record.noise.map(|noise| noise.std_deg);
    let known: Vec<f64> = training.all().iter().filter_map(own).collect();
    if known.is_empty() {
        let left = |record: &&Prepared| {
            let errors =
                record.states().map(|(i, cells)| record.record.output_deg[i] - map.value_at(cells));
            mean_square(&errors.collect::<Vec<_>>()).sqrt()
        };
        return (training.slow.iter().map(left).collect(), NoiseSource::Residual);
    }
    let usual = mean_square(&known).sqrt();
    let of = training.slow.iter().map(|record| own(record).unwrap_or(usual));
    (of.collect(), NoiseSource::Cycles)
}

/// A quadratic form in the values at the knots as one in the rises between them, the constant aside.
fn in_rises(program: &LeastSquaresProgram, unknowns: &Unknowns) -> DMatrix<f64> {
    let mut matrix = program.normal_matrix();
    sum_rows_above(&mut matrix, unknowns);
    // symmetric: the columns are what the rows were
    matrix.transpose_mut();
    sum_rows_above(&mut matrix, unknowns);
    matrix
}

/// The derivative by every rise from those by the values at the knots: a rise lifts all knots above it.
fn sum_rows_above(matrix: &mut DMatrix<f64>, unknowns: &Unknowns) {
    for own in unknowns.plays() {
        for row in own.rev().skip(1) {
            let above = matrix.row(row + 1).clone_owned();
            let mut own = matrix.row_mut(row);
            own += above;
        }
    }
}

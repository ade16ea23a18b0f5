//! The loading of a wake: circulation over the disk, from the lift of the sections.

use crate::response::revolution::{Lifting, unit_weights};
use crate::{ResponseError, Rotor, SpanGrid};
use nalgebra::DMatrix;
use rotor_base::{harmonic_waves, uniform_azimuths_rad};
use rotor_fem::TimeElements;
use rotor_wake::{CirculationMap, RotorLoading, WakeRotor};

/// Value at `r` of a table over ascending stations: linear between them, constant beyond.
pub(crate) fn between(stations: &[f64], values: &[f64], r: f64) -> f64 {
    let above = stations.partition_point(|x| *x <= r);
    match (above, stations.len()) {
        (_, 0) => 0.0,
        (0, _) => values[0],
        (above, count) if above == count => values[count - 1],
        (above, _) => {
            let (a, b) = (stations[above - 1], stations[above]);
            values[above - 1] + (r - a) / (b - a) * (values[above] - values[above - 1])
        }
    }
}

/// Overlap of two different harmonics under a quadrature above which it tells them apart no more.
const OVERLAP: f64 = 0.02;

/// Harmonics up to `most` that the points of the time elements resolve: of any two of them, and of one with itself, the
/// quadrature takes the mean of the product right.
pub(crate) fn resolved_harmonics(time: &TimeElements, weights: &[f64], most: usize) -> usize {
    let mut sums = vec![0.0; 1 + 4 * most];
    for (psi, weight) in time.points().iter().zip(weights) {
        for (sum, wave) in sums.iter_mut().zip(harmonic_waves(*psi, 2 * most)) {
            *sum += weight * wave;
        }
    }
    let overlap = |m: usize| sums[2 * m - 1].hypot(sums[2 * m]);
    (1..=most).take_while(|n| overlap(2 * n - 1).max(overlap(2 * n)) < OVERLAP).count()
}

/// Shares of the values of a table that [`between`] takes at `r`.
pub(crate) fn shares(stations: &[f64], r: f64) -> [(usize, f64); 2] {
    let last = stations.len() - 1;
    match stations.partition_point(|x| *x <= r) {
        0 => [(0, 1.0), (0, 0.0)],
        above if above > last => [(last, 1.0), (last, 0.0)],
        above => {
            let (a, b) = (stations[above - 1], stations[above]);
            let part = (r - a) / (b - a);
            [(above - 1, 1.0 - part), (above, part)]
        }
    }
}

/// `1 + 2 (cos x + ... + cos n x)`: what harmonics up to `n` make of one sample, over its weight.
pub(crate) fn of_harmonics(n: usize, x: f64) -> f64 {
    1.0 + 2.0 * (1..=n).map(|k| (k as f64 * x).cos()).sum::<f64>()
}

/// Weights of the lifting stations, the last ones of the blade, in the mean over each panel of a wake: what its integral
/// along the blade is does not depend on the panels.
pub(crate) fn panel_means(grid: &SpanGrid, lifting: usize, panels: &WakeRotor) -> DMatrix<f64> {
    let first = grid.len() - lifting;
    let outboard: Vec<Vec<f64>> =
        panels.nodes().iter().map(|r| grid.weights_outboard(*r)).collect();
    let widths = panels.widths();
    DMatrix::from_fn(panels.panels(), lifting, |k, s| {
        (outboard[k][first + s] - outboard[k + 1][first + s]) / widths[k]
    })
}

/// A property of the lifting sections on the panels of a wake: its mean over each, and in azimuth by the harmonics that both
/// the wake's azimuths and the time elements resolve. A row for each azimuth.
pub(crate) fn over_panels(
    rotor: &Rotor,
    time: &TimeElements,
    lifting: &[Vec<Lifting>],
    (panels, azimuths): (&WakeRotor, usize),
    property: impl Fn(&Lifting) -> f64,
) -> DMatrix<f64> {
    let stations = lifting.first().map_or(0, Vec::len);
    let means = panel_means(rotor.blade().grid(), stations, panels);
    let weights = unit_weights(time);
    let harmonics = resolved_harmonics(time, &weights, (azimuths - 1) / 2);
    let history =
        DMatrix::from_fn(lifting.len(), stations, |p, s| weights[p] * property(&lifting[p][s]));
    let history = history * means.transpose();
    // mean, then cosine and sine of every harmonic
    let mut coefficients = waves(harmonics, time.points()).tr_mul(&history);
    coefficients.rows_mut(1, 2 * harmonics).scale_mut(2.0);
    waves(harmonics, &uniform_azimuths_rad(azimuths)) * coefficients
}

/// Circulation of the panels of a wake.
pub(crate) fn circulation(
    rotor: &Rotor,
    time: &TimeElements,
    lifting: &[Vec<Lifting>],
    wake_rotor: &WakeRotor,
    azimuths: usize,
) -> Result<CirculationMap, ResponseError> {
    let values = over_panels(rotor, time, lifting, (wake_rotor, azimuths), |l| l.circulation);
    Ok(CirculationMap::from_fn(azimuths, wake_rotor.panels(), |i, s| values[(i, s)])?)
}

/// One, and cosine and sine of every harmonic, at azimuths: a row for each.
fn waves(harmonics: usize, azimuths_rad: &[f64]) -> DMatrix<f64> {
    let waves = azimuths_rad.iter().flat_map(|psi| harmonic_waves(*psi, harmonics));
    DMatrix::from_row_iterator(azimuths_rad.len(), 1 + 2 * harmonics, waves)
}

/// Mean over the revolution of the lift of one blade, `m0 Omega^2 R^2`.
pub(crate) fn mean_lift(rotor: &Rotor, time: &TimeElements, lifting: &[Vec<Lifting>]) -> f64 {
    let weight = rotor.blade().grid().weight();
    let first = weight.len() - lifting.first().map_or(0, Vec::len);
    let of = |row: &[Lifting]| -> f64 {
        row.iter().zip(&weight[first..]).map(|(l, w)| w * l.lift).sum()
    };
    unit_weights(time).iter().zip(lifting).map(|(share, row)| share * of(row)).sum()
}

/// The loading that an inflow model asks for, of the lift over the disk.
pub(crate) fn loading(
    rotor: &Rotor,
    time: &TimeElements,
    lifting: &[Vec<Lifting>],
    thrust_coefficient: f64,
    grid: Option<(&WakeRotor, usize)>,
) -> Result<RotorLoading, ResponseError> {
    let (x, weight) = (rotor.blade().grid().x(), rotor.blade().grid().weight());
    let first = x.len() - lifting.first().map_or(0, Vec::len);
    let mut harmonics = [0.0; 2];
    for ((azimuth, share), row) in time.points().iter().zip(unit_weights(time)).zip(lifting) {
        let moment: f64 =
            row.iter().enumerate().map(|(s, l)| weight[first + s] * x[first + s] * l.lift).sum();
        harmonics[0] += share * azimuth.cos() * moment;
        harmonics[1] += share * azimuth.sin() * moment;
    }
    let coefficient =
        |blade: f64| rotor.model().thrust_coefficient(rotor.model().blades as f64 * blade);
    let loading = RotorLoading::from_thrust_coefficient(thrust_coefficient)
        .with_moment_coefficients(harmonics.map(coefficient));
    match grid {
        None => Ok(loading),
        Some((panels, azimuths)) => {
            let found = circulation(rotor, time, lifting, panels, azimuths)?;
            Ok(loading.with_circulation(found))
        }
    }
}

//! What a wake wants to know of a response: circulation over the disk and where the blades are.

use crate::response::revolution::{Lifting, RevolutionLoads, unit_weights};
use crate::{Controls, ResponseError, Rotor, RotorSolution, RotorSolver};
use rotor_base::{HarmonicSeries, uniform_azimuths_rad};
use rotor_fem::TimeElements;
use rotor_wake::{BladeLines, CirculationMap, RotorLoading, WakeRotor};

/// Value at `r` of a table over ascending stations: linear between them, constant beyond.
fn between(stations: &[f64], values: &[f64], r: f64) -> f64 {
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
fn resolved_harmonics(time: &TimeElements, weights: &[f64], most: usize) -> usize {
    let overlap = |m: usize| {
        let (mut c, mut s) = (0.0, 0.0);
        for (psi, w) in time.points().iter().zip(weights) {
            let angle = m as f64 * psi;
            c += w * angle.cos();
            s += w * angle.sin();
        }
        c.hypot(s)
    };
    (1..=most).take_while(|n| overlap(2 * n - 1).max(overlap(2 * n)) < OVERLAP).count()
}

/// Circulation at the panels of a wake: linear between stations, and in azimuth by the harmonics that both the wake's
/// azimuths and the time elements resolve.
fn circulation(
    rotor: &Rotor,
    time: &TimeElements,
    lifting: &[Vec<Lifting>],
    wake_rotor: &WakeRotor,
    azimuths: usize,
) -> Result<CirculationMap, ResponseError> {
    let x = rotor.blade().grid().x();
    let stations = &x[x.len() - lifting.first().map_or(0, Vec::len)..];
    let weights = unit_weights(time);
    let harmonics = resolved_harmonics(time, &weights, (azimuths - 1) / 2);
    let rows: Vec<Vec<f64>> =
        lifting.iter().map(|row| row.iter().map(|l| l.circulation).collect()).collect();
    let series: Vec<HarmonicSeries> = wake_rotor
        .stations()
        .iter()
        .map(|&r| {
            let history: Vec<f64> = rows.iter().map(|row| between(stations, row, r)).collect();
            HarmonicSeries::project(time.points(), &weights, &history, harmonics)
        })
        .collect();
    let at = uniform_azimuths_rad(azimuths);
    Ok(CirculationMap::from_fn(azimuths, series.len(), |i, s| series[s].value(at[i]))?)
}

impl RevolutionLoads {
    /// The loading that an inflow model asks for.
    pub(crate) fn loading(
        &self,
        rotor: &Rotor,
        time: &TimeElements,
        thrust_coefficient: f64,
        grid: Option<(&WakeRotor, usize)>,
    ) -> Result<RotorLoading, ResponseError> {
        let (x, weight) = (rotor.blade().grid().x(), rotor.blade().grid().weight());
        let first = x.len() - self.lifting.first().map_or(0, Vec::len);
        let mut harmonics = [0.0; 2];
        for ((azimuth, share), row) in
            time.points().iter().zip(unit_weights(time)).zip(&self.lifting)
        {
            let moment: f64 = row
                .iter()
                .enumerate()
                .map(|(s, l)| weight[first + s] * x[first + s] * l.lift)
                .sum();
            harmonics[0] += share * azimuth.cos() * moment;
            harmonics[1] += share * azimuth.sin() * moment;
        }
        let blades = rotor.model().blades as f64;
        let moments = harmonics.map(|h| rotor.model().thrust_coefficient(blades * h));
        let loading = RotorLoading::from_thrust_coefficient(thrust_coefficient)
            .with_moment_coefficients(moments);
        match grid {
            None => Ok(loading),
            Some((panels, azimuths)) => {
                let found = circulation(rotor, time, &self.lifting, panels, azimuths)?;
                Ok(loading.with_circulation(found))
            }
        }
    }
}

impl RotorSolver {
    /// Bound circulation of a solution on the panels and azimuths of a wake.
    ///
    /// # Errors
    /// [`ResponseError::Wake`] if a value is not finite.
    pub fn circulation(
        &self,
        solution: &RotorSolution,
        wake_rotor: &WakeRotor,
        azimuths: usize,
    ) -> Result<CirculationMap, ResponseError> {
        circulation(self.rotor(), &self.time, &solution.lifting, wake_rotor, azimuths)
    }

    /// The lifting lines of the deflected blades under pitch controls: quarter chord of the coned blade, displaced by flap
    /// and lag bending; the wake leaves at the trailing edge of the pitched, twisted section, three
    /// quarters of its own chord further back.
    pub fn blade_lines(
        &self,
        solution: &RotorSolution,
        controls: &Controls,
        wake_rotor: &WakeRotor,
        azimuths: usize,
    ) -> BladeLines {
        let blade = self.rotor().blade();
        let x = blade.grid().x();
        let at_nodes = |values: &[f64]| -> Vec<f64> {
            wake_rotor.nodes().iter().map(|&r| between(x, values, r)).collect()
        };
        let of_modes = |modes: &[Vec<f64>]| modes.iter().map(|m| at_nodes(m)).collect::<Vec<_>>();
        let (flap, lag) = (of_modes(&blade.flap.value), of_modes(&blade.lag.value));
        let (torsion, twist) = (of_modes(&blade.torsion.value), at_nodes(&blade.twist));
        let psi = uniform_azimuths_rad(azimuths);
        let motion: Vec<Vec<f64>> =
            psi.iter().map(|&psi| solution.modal.iter().map(|m| m.value(psi)).collect()).collect();
        let sum = |shapes: &[Vec<f64>], q: &[f64], n: usize| -> f64 {
            shapes.iter().zip(q).map(|(shape, q)| q * shape[n]).sum()
        };
        let model = self.rotor().model();
        let chords: Vec<f64> = wake_rotor.nodes().iter().map(|r| model.chord_at(*r)).collect();
        let (bending, twisting) = (flap.len(), flap.len() + lag.len());
        BladeLines::deflected(wake_rotor, azimuths, |i, n| {
            let up = blade.precone * wake_rotor.nodes()[n] + sum(&flap, &motion[i], n);
            [up, blade.offsets.torque + sum(&lag, &motion[i][bending..], n)]
        })
        .with_trailing_edge(
            |n| 0.75 * chords[n],
            |i, n| {
                let root = controls.root_pitch(psi[i]).angle_rad;
                root + twist[n] + sum(&torsion, &motion[i][twisting..], n)
            },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest amplitude that a unit harmonic `n` leaves at other harmonics up to `limit`, at the points of eight time
    /// elements.
    fn aliased(n: usize, limit: usize) -> f64 {
        let time = TimeElements::new(8, 5, 8).unwrap();
        let samples: Vec<f64> = time.points().iter().map(|psi| (n as f64 * psi).cos()).collect();
        let series = HarmonicSeries::project(time.points(), &unit_weights(&time), &samples, limit);
        let others = (1..=limit).filter(|k| *k != n).map(|k| series.harmonic(k).amplitude());
        others.fold(series.mean.abs(), f64::max)
    }

    /// Harmonics that are passed on come out as themselves; what the points do not tell apart comes out as others, and
    /// as large as it is.
    #[test]
    fn harmonics_beyond_the_time_elements_are_not_passed_on() {
        let time = TimeElements::new(8, 5, 8).unwrap();
        // what 72 azimuth steps of a wake could hold, and what 8 elements of 8 points resolve
        let all = 35;
        let limit = resolved_harmonics(&time, &unit_weights(&time), all);
        assert_eq!(limit, 15);
        assert_eq!(resolved_harmonics(&time, &unit_weights(&time), 11), 11);
        let kept = (1..=limit).map(|n| aliased(n, limit)).fold(0.0, f64::max);
        assert!(kept < 0.01, "{kept}");
        let beyond = (1..=all).map(|n| aliased(n, all)).fold(0.0, f64::max);
        assert!(beyond > 0.5, "{beyond}");
    }
}

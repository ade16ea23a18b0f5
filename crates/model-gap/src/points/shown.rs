//! Readings beside what is simulated of them, and what is known of a channel beside what a cause does to it.

use super::floor::Floor;
use super::predicted::Tables;
use super::table::Grid;
use crate::discovery::{Finding, Fingerprint, Signal};

/// One reading with what is simulated of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reading {
    /// Number of the point in the table.
    pub point: usize,
    /// Position among the channels.
    pub channel: usize,
    /// What was read, in the unit of the channel.
    pub measured: f64,
    /// Standard deviation of the reading, in that unit, above zero.
    pub deviation: f64,
    /// Standard deviation that it weighs with, in that unit: of the reading and of the error of the simulation.
    pub sigma: f64,
    /// What is simulated, in that unit: without what was found, and with it.
    pub simulated: [f64; 2],
    /// Measured less simulated over `sigma`, before and after; what is known of the errors of readings and simulation is
    /// taken off.
    pub residual: [f64; 2],
}

impl Reading {
    /// Measured less simulated over `sigma`, without what was found and with it, nothing taken off.
    pub fn misfit(&self) -> [f64; 2] {
        self.simulated.map(|simulated| (self.measured - simulated) / self.sigma)
    }

    /// Every reading, point by point; `predicted` is over the standard deviations.
    pub(super) fn of(tables: &Tables<'_>, predicted: &[Signal; 2], finding: &Finding) -> Vec<Self> {
        let left = [&finding.residual_before, &finding.residual_after];
        let of_point = |(row, (point, channels)): (usize, &(usize, Vec<usize>))| {
            let (point, own) = (*point, &tables.table.points[*point]);
            let reading = |(place, &channel): (usize, &usize)| {
                let sigma = tables.sigma[point][channel];
                // a table predicts its base, the unit given back exactly
                let plain = tables.table.predicted[point][channel];
                Self {
                    point,
                    channel,
                    measured: own.measured[channel].unwrap_or_default(),
                    deviation: own.deviation[channel],
                    sigma,
                    simulated: [plain, sigma * predicted[1][row][place]],
                    residual: left.map(|own| own[row][place]),
                }
            };
            channels.iter().enumerate().map(reading).collect::<Vec<_>>()
        };
        tables.rows.iter().enumerate().flat_map(of_point).collect()
    }
}

/// What is not known of a channel beside what each explanation does to it: roots of mean squares over its readings, over
/// their standard deviations.
#[derive(Debug, Clone, PartialEq)]
pub struct ChannelFloor {
    /// Position among the channels.
    pub channel: usize,
    /// Error of the simulation that the other models do not hold.
    pub model_error: f64,
    /// The other models less the simulation, their squares added.
    pub alternatives: f64,
    /// The uncertain inputs, each moved by its standard deviation, their squares added.
    pub uncertain: f64,
    /// What each of [`PointFinding::fingerprints`](super::PointFinding::fingerprints) adds, and what of it no error that is
    /// allowed for explains.
    pub effects: Vec<[f64; 2]>,
}

impl ChannelFloor {
    /// Of every channel with readings.
    pub(super) fn of(
        (floor, tables): (&Floor, &Tables<'_>),
        readings: &[Reading],
        causes: &[Fingerprint],
    ) -> Vec<Self> {
        let table = tables.table;
        let signals: Vec<[Vec<f64>; 2]> =
            causes.iter().map(|own| [own.adds.concat(), own.shows.concat()]).collect();
        let of_channel = |channel: usize| {
            let own: Vec<(usize, &Reading)> =
                readings.iter().enumerate().filter(|own| own.1.channel == channel).collect();
            // root of the mean of squares over the deviations
            let rms = |square: &dyn Fn(usize, &Reading) -> f64| {
                let sum: f64 = own.iter().map(|(i, r)| square(*i, r) / r.deviation.powi(2)).sum();
                (sum / own.len() as f64).sqrt()
            };
            let away = |grids: &[Grid]| {
                rms(&|_, r| {
                    let base = table.predicted[r.point][channel];
                    grids.iter().map(|grid| (grid[r.point][channel] - base).powi(2)).sum()
                })
            };
            let [level, change] =
                [&floor.model_error.level, &floor.model_error.change].map(|own| own[channel]);
            let effect = |signal: &Vec<f64>| rms(&|i, r| (signal[i] * r.sigma).powi(2));
            (!own.is_empty()).then(|| Self {
                channel,
                model_error: rms(&|_, _| level.hypot(change).powi(2)),
                alternatives: away(&table.alternatives),
                uncertain: away(&table.uncertain),
                effects: signals.iter().map(|own| own.each_ref().map(effect)).collect(),
            })
        };
        (0..table.channels.len()).filter_map(of_channel).collect()
    }
}

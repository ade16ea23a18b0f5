//! What the lags of a station remember: their periodic states beyond those settled on their inputs.

use super::{Channels, FlightAir, StationAir};
use crate::sections::station_lag::{SectionChannel, StationLag};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_base::LANES;
use rotor_fem::LagChannel;

/// Change of the lag part of lift and moment at a point with the first two inputs at all points, beyond
/// what the settled lags make of the inputs at the point itself.
///
/// ```text
/// k_oi[p, p'] = sum over channels of gain_o(p) ( P[p, p'] - 1[p, p'] ) input_i
/// ```
/// Order `[output][input]`: lift, moment; `U alpha`, `c om`.
#[derive(Debug, Clone)]
pub(crate) struct StationMemory {
    pub(crate) kernels: [[DMatrix<f64>; 2]; 2],
}

impl FlightAir {
    /// The memory of every lifting station; none of those with finer azimuth points, which lie where the
    /// flow is slow, and of those without lags.
    ///
    /// `None` over tables: their settled lags are all the Newton matrix knows. What stall remembers beyond the
    /// attached flow is not in it either.
    pub(crate) fn memories(&self) -> Option<&[Option<StationMemory>]> {
        if self.stations.iter().any(|station| station.air.tables.is_some()) {
            return None;
        }
        let of = |station: &super::Station| match &station.fine {
            None => station.air.memory(),
            Some(_) => None,
        };
        if let Some(known) = self.memories.get() {
            return Some(known);
        }
        // made outside of the lock: a thread that waits for it must not hold up its own part
        let made: Vec<_> = self.stations.par_iter().map(of).collect();
        Some(self.memories.get_or_init(|| made))
    }

    /// The lags of every lifting station for its stability, of the first two inputs on lift and moment; none of those with finer azimuth points.
    ///
    /// `None` over tables and where sections stall dynamically: settled lags are all that is known there.
    pub(crate) fn channels(&self) -> Option<Vec<Vec<LagChannel>>> {
        let beyond = |air: &StationAir| air.tables.is_some() || air.stall.is_some();
        if self.stations.iter().any(|station| beyond(&station.air)) {
            return None;
        }
        let of = |station: &super::Station| match &station.fine {
            None => station.air.channels(),
            Some(_) => Vec::new(),
        };
        Some(self.stations.iter().map(of).collect())
    }
}

impl FlightAir {
    /// Change of the circulatory lift per speed of every lifting station at all points with its first input `U alpha`
    /// at all points; over tables, that of their linear sections.
    pub(crate) fn lift_slopes(&self) -> Vec<DMatrix<f64>> {
        self.stations.par_iter().map(|station| station.air.lift_slope()).collect()
    }
}

impl StationAir {
    /// The lags with states over a revolution; none of an instant.
    fn round(&self) -> &[StationLag] {
        match &self.channels {
            Channels::Round(lags, _) => lags,
            Channels::Passing(_) => &[],
        }
    }

    fn lift_slope(&self) -> DMatrix<f64> {
        let points = self.points;
        let mut slope = DMatrix::zeros(points, points);
        let has_waves = self.prompt.first().is_some_and(|prompt| prompt.has_waves);
        if !has_waves {
            for p in 0..points {
                slope[(p, p)] = self.prompt[p / LANES].direct[0][0].0[p % LANES];
            }
        }
        let makes = |lag: &&StationLag| {
            lag.channel.input[0] != 0.0 && (lag.channel.circulatory || !has_waves)
        };
        for StationLag { channel, lag } in self.round().iter().filter(makes) {
            for (_, gains) in channel.gains.iter().filter(|(output, _)| *output == 0) {
                let operator = lag.operator();
                for (mut sums, column) in slope.column_iter_mut().zip(operator.column_iter()) {
                    for ((sum, gain), value) in sums.iter_mut().zip(gains).zip(&column) {
                        *sum += gain * value * channel.input[0];
                    }
                }
            }
        }
        slope
    }

    fn channels(&self) -> Vec<LagChannel> {
        let points = self.points;
        let of = |lag: &SectionChannel| {
            let mut gains = vec![[0.0; 2]; points];
            for (output, along) in lag.gains.iter().filter(|(output, _)| *output < 2) {
                for (gain, value) in gains.iter_mut().zip(along) {
                    gain[*output] += value;
                }
            }
            let input = [lag.input[0], lag.input[1]];
            let nothing = |pair: &[f64; 2]| pair.iter().all(|v| v.abs() == 0.0);
            let idle = nothing(&input) || gains.iter().all(nothing);
            (!idle).then(|| LagChannel { rates: lag.rates.clone(), input, gains })
        };
        self.round().iter().filter_map(|lag| of(&lag.channel)).collect()
    }

    fn memory(&self) -> Option<StationMemory> {
        let points = self.points;
        let zero = || DMatrix::zeros(points, points);
        let mut kernels = [[zero(), zero()], [zero(), zero()]];
        let mut any = false;
        for StationLag { channel, lag } in self.round() {
            let inputs = [channel.input[0], channel.input[1]];
            let outputs = || channel.gains.iter().filter(|(output, _)| *output < 2);
            if inputs.iter().all(|v| *v == 0.0) || outputs().next().is_none() {
                continue;
            }
            any = true;
            let mut beyond = lag.operator();
            for p in 0..points {
                beyond[(p, p)] -= 1.0;
            }
            for (output, gains) in outputs() {
                for (kernel, input) in kernels[*output].iter_mut().zip(inputs) {
                    if input == 0.0 {
                        continue;
                    }
                    for (mut sum, column) in kernel.column_iter_mut().zip(beyond.column_iter()) {
                        for ((sum, gain), value) in sum.iter_mut().zip(gains).zip(&column) {
                            *sum += gain * value * input;
                        }
                    }
                }
            }
        }
        any.then_some(StationMemory { kernels })
    }
}

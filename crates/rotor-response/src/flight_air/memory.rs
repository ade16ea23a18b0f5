//! What the lags of a station remember: their periodic states beyond those settled on their inputs.

use super::{FlightAir, StationAir};
use nalgebra::DMatrix;
use rayon::prelude::*;

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
    pub(crate) fn memories(&self) -> Option<Vec<Option<StationMemory>>> {
        if self.stations.iter().any(|station| station.air.tables.is_some()) {
            return None;
        }
        let of = |station: &super::Station| match &station.fine {
            None => station.air.memory(),
            Some(_) => None,
        };
        Some(self.stations.par_iter().map(of).collect())
    }
}

impl StationAir {
    fn memory(&self) -> Option<StationMemory> {
        let points = self.prompt.len();
        let zero = || DMatrix::zeros(points, points);
        let mut kernels = [[zero(), zero()], [zero(), zero()]];
        let mut any = false;
        for channel in &self.lags {
            let inputs = [channel.input[0], channel.input[1]];
            let outputs = || channel.gains.iter().filter(|(output, _)| *output < 2);
            if inputs.iter().all(|v| *v == 0.0) || outputs().next().is_none() {
                continue;
            }
            any = true;
            let mut beyond = channel.lag.operator();
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

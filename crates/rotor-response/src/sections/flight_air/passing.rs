//! Lag states that are brought along from instant to instant, blade by blade.
//!
//! ```text
//! x1 = u1 - (u1 - u0) g + (x0 - u0) e,     e = exp(-z),   g = (1 - e) / z,   z = (rate0 + rate1)/2 dpsi,   u = input . w
//! ```
//! The solution of `dx/dpsi = rate (u - x)` for an input that runs straight over the step, at the mean rate: of second order in the
//! step, and stable for any.
//!
//! Source: the recurrence of `flap-aero` in time ([`flap_aero::SectionState`]), by azimuth.

use super::{Channels, FlightAir};
use crate::sections::air::{SectionFlow, SectionPast};
use crate::sections::station_lag::SectionChannel;
use rotor_base::{LANES, Lanes};

/// One channel of one blade at an instant.
#[derive(Debug, Clone, Copy, PartialEq)]
struct ChannelState {
    state: f64,
    /// What it follows.
    drive: f64,
    /// Rate, per rad.
    rate: f64,
}

/// The lags of one station at an instant: by channel, then by blade in the order of the azimuth points.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct PassingLags {
    blades: usize,
    states: Vec<ChannelState>,
}

/// How the states at the end of a step depend on their inputs there: `x1 = held + share u1`.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LagSteps {
    blades: usize,
    steps: Vec<[f64; 2]>,
}

impl PassingLags {
    /// Gives every blade the place of the one behind it, the last one the first place.
    pub(crate) fn turn(&mut self) {
        for channel in self.states.chunks_exact_mut(self.blades) {
            channel.rotate_right(1);
        }
    }
}

impl LagSteps {
    /// What the past adds to the loads of all blades.
    pub(super) fn fill_pasts(
        &self,
        channels: &[SectionChannel],
        flows: &[SectionFlow<Lanes>],
        pasts: &mut [SectionPast<Lanes>],
    ) {
        for (channel, steps) in channels.iter().zip(self.steps.chunks_exact(self.blades)) {
            for (p, [held, share]) in steps.iter().enumerate() {
                let (block, k) = (p / LANES, p % LANES);
                let flow = &flows[block];
                let drive = drive_of(channel, |i| flow.input[i].0[k]);
                let state = held + share * drive;
                let past = &mut pasts[block];
                for (output, gains) in &channel.gains {
                    past.lag[*output].0[k] += gains[p] * state;
                    if *output == 0 && channel.rigid {
                        past.rigid_lift.0[k] += gains[p] * state;
                    }
                    if *output == 0 && channel.circulatory {
                        past.circulatory_lift.0[k] += gains[p] * state;
                    }
                }
            }
        }
    }
}

/// What a channel follows.
fn drive_of(channel: &SectionChannel, input: impl Fn(usize) -> f64) -> f64 {
    (0..4).map(|i| channel.input[i] * input(i)).sum()
}

impl FlightAir {
    fn passing(&self, station: usize) -> &[SectionChannel] {
        match &self.stations[station].air.channels {
            Channels::Passing(channels) => channels,
            Channels::Round(..) => &[],
        }
    }

    /// States settled on the inputs of every lifting station, by azimuth point and station.
    pub(crate) fn settled_lags(&self, flows: &[Vec<SectionFlow>]) -> Vec<PassingLags> {
        let of = |station: usize| {
            let channels = self.passing(station).iter();
            let states = channels.flat_map(|channel| {
                flows.iter().enumerate().map(move |(p, flows)| {
                    let drive = drive_of(channel, |i| flows[station].input[i]);
                    ChannelState { state: drive, drive, rate: channel.rates[p] }
                })
            });
            PassingLags { blades: flows.len(), states: states.collect() }
        };
        (0..self.stations()).map(of).collect()
    }

    /// How states reach this instant from those of the instant before, over a step of azimuth (rad); blades stand in the order
    /// of the azimuth points of this one.
    pub(crate) fn lag_steps(&self, before: &[PassingLags], step_rad: f64) -> Vec<LagSteps> {
        let of = |(station, lags): (usize, &PassingLags)| {
            let rates = self.passing(station).iter().flat_map(|channel| &channel.rates);
            let step = |(from, rate): (&ChannelState, &f64)| {
                let z = 0.5 * (from.rate + rate) * step_rad;
                let gone = -(-z).exp_m1();
                let mean = if z > 0.0 { gone / z } else { 1.0 };
                let held = (from.state - from.drive) * (1.0 - gone) + from.drive * mean;
                [held, 1.0 - mean]
            };
            let steps = lags.states.iter().zip(rates).map(step).collect();
            LagSteps { blades: lags.blades, steps }
        };
        before.iter().enumerate().map(of).collect()
    }

    /// The states that these steps lead to for the flows of this instant, by azimuth point and station.
    pub(crate) fn passed(
        &self,
        steps: &[LagSteps],
        flows: &[Vec<SectionFlow>],
    ) -> Vec<PassingLags> {
        let of = |(station, steps): (usize, &LagSteps)| {
            let blades = steps.blades;
            let mut states = Vec::with_capacity(steps.steps.len());
            for (channel, steps) in
                self.passing(station).iter().zip(steps.steps.chunks_exact(blades))
            {
                for (p, [held, share]) in steps.iter().enumerate() {
                    let drive = drive_of(channel, |i| flows[p][station].input[i]);
                    let state = held + share * drive;
                    states.push(ChannelState { state, drive, rate: channel.rates[p] });
                }
            }
            PassingLags { blades, states }
        };
        steps.iter().enumerate().map(of).collect()
    }
}

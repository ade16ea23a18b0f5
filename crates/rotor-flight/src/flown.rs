//! The loop along a flight.

use crate::blades::{highest, of_order};
use crate::flaps::HARMONICS;
use crate::flight::motions;
use crate::pilot::Pilot;
use crate::{FlapMarch, FlapTurn, Flight, FlightError, Guidance, KnownBlade};
use chacha20::ChaCha8Rng;
use hhc_control::Cost;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rotor_base::HarmonicSeries;
use rotor_study::{HUB_OUTPUTS, scaled};
use serde::Serialize;

/// One cycle of a flight: what its window has seen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FlightPoint {
    /// End of the cycle, s.
    pub time_s: f64,
    /// Advance ratio there.
    pub advance_ratio: f64,
    /// Part of the step of the thrust that is made there, 0 to 1.
    pub thrust_share: f64,
    /// `J` of the loads without noise.
    pub cost: f64,
    /// `J / J0`: over that without control in the same state.
    pub cost_ratio: f64,
    /// `J` of the loads at 1/rev over `J0`; 0 while all blades are alike.
    pub once_per_rev_ratio: f64,
    /// `J` of those at 2 to twice the blade number less one per rev, but for the blade number, over `J0`; likewise.
    pub other_ratio: f64,
    /// Both without control in the same state: more than 0 where blades are unlike each other.
    pub off_blade_number_at_rest: [f64; 2],
    /// Loads without noise, cosine and sine of six at the blade number per rev, nondimensional.
    pub loads: [f64; HUB_OUTPUTS],
    /// The same without control.
    pub loads_at_rest: [f64; HUB_OUTPUTS],
    /// The control that acted, V.
    pub control_volt: Vec<f64>,
    /// Whether a limit of an amplitude bound when it was chosen.
    pub is_limited: bool,
    /// Amplitudes of every flap at 1, 2 ... 12 per rev in the last revolution, deg; of blades alike where one is not as they are.
    pub flap_deg: Vec<Vec<f64>>,
    /// Lowest and highest voltage of every flap in the cycle, likewise.
    pub volt: Vec<[f64; 2]>,
    /// Part of the samples of all these flaps whose voltage was held at an end of the range, 0 to 1.
    pub held_share: f64,
    /// Mean power that the actuators of one blade give in the last revolution, none taken back, W.
    pub power_watt: f64,
}

/// What flies: flaps and the noise of what is measured.
struct Flown<'a> {
    flight: &'a Flight<'a>,
    flaps: FlapMarch<'a>,
    /// Of the blades that the path knows one by one, where they have actuators of their own.
    own_flaps: Vec<Option<FlapMarch<'a>>>,
    weights: Vec<f64>,
    /// Standard deviation of a load in one revolution.
    noise: f64,
    random: ChaCha8Rng,
    revolutions: usize,
}

/// A revolution: what the flaps of blades alike did, and motions, deg, of these and of the blades known one by one.
struct Turned {
    turns: Vec<FlapTurn>,
    like: Vec<HarmonicSeries>,
    own: Vec<Vec<HarmonicSeries>>,
}

impl Flown<'_> {
    fn time_s(&self) -> f64 {
        self.revolutions as f64 / self.flight.rotor_rev_hz
    }

    fn cost(&self, loads: &[f64]) -> f64 {
        Cost::of(loads, &self.weights, &[], 0.0).loads
    }

    /// What a failure makes of the motions of a revolution, deg: of blades alike, or of one (from 0).
    fn fail(&self, motion: &mut [HarmonicSeries], blade: Option<usize>) {
        let failure = self.flight.failure.filter(|failure| self.time_s() > failure.time_s);
        let Some(failed) = failure.filter(|f| !f.is_on_one_blade || blade == Some(0)) else {
            return;
        };
        if let Some(flap) = motion.get_mut(failed.flap) {
            *flap = scaled(flap, failed.kept_share);
            flap.mean += failed.stuck_deg;
        }
    }

    /// A revolution under a control: what the flaps of blades alike did, their motions, deg, and those of the blades that the path
    /// knows one by one.
    fn revolve(&mut self, control_volt: &[f64]) -> Result<Turned, FlightError> {
        self.revolutions += 1;
        let turns = self.flaps.revolve(control_volt)?;
        let sound = motions(&turns);
        let mut own = Vec::with_capacity(self.own_flaps.len());
        let known = self.flight.path.own_blades();
        for (k, KnownBlade { blade, flap_motion }) in known.iter().enumerate() {
            let moved = match &mut self.own_flaps[k] {
                Some(flaps) => motions(&flaps.revolve(control_volt)?),
                None => sound.clone(),
            };
            let mut moved: Vec<_> = moved.iter().map(|flap| scaled(flap, *flap_motion)).collect();
            self.fail(&mut moved, Some(*blade));
            own.push(moved);
        }
        let mut like = sound;
        self.fail(&mut like, None);
        Ok(Turned { turns, like, own })
    }

    /// One cycle under a control: what it was, and the loads that were measured.
    fn cycle(&mut self, pilot: &Pilot) -> Result<(FlightPoint, [f64; HUB_OUTPUTS]), FlightError> {
        let (flight, path) = (self.flight, self.flight.path);
        let [settling, window] = flight.cycle_rev;
        let (mut loads, mut measured) = ([0.0; HUB_OUTPUTS], [0.0; HUB_OUTPUTS]);
        let blades = path.blades();
        let mut of_own = vec![0.0; highest(blades) * HUB_OUTPUTS];
        let mut volt = vec![[f64::INFINITY, f64::NEG_INFINITY]; flight.layout.flaps()];
        let (mut motion, mut held_share) = (Vec::new(), 0.0);
        for rev in 0..settling + window {
            let Turned { turns, like, own } = self.revolve(pilot.control_volt())?;
            for (turn, volt) in turns.iter().zip(&mut volt) {
                *volt = [volt[0].min(turn.volt[0]), volt[1].max(turn.volt[1])];
                held_share += turn.held_share / (turns.len() * (settling + window)) as f64;
            }
            motion = like;
            if rev < settling {
                continue;
            }
            let state = flight.state_at(self.time_s());
            let mut found = path.loads(state, &motion)?;
            let added = path.own_blade_loads(state, &motion, &own)?;
            for (found, added) in found.iter_mut().zip(&added[of_order(blades)]) {
                *found += added;
            }
            for (sum, added) in of_own.iter_mut().zip(added) {
                *sum += added / window as f64;
            }
            for ((load, seen), found) in loads.iter_mut().zip(&mut measured).zip(found) {
                let draw: f64 = StandardNormal.sample(&mut self.random);
                *load += found / window as f64;
                *seen += (found + self.noise * draw) / window as f64;
            }
        }
        let (time_s, state) = (self.time_s(), flight.state_at(self.time_s()));
        let (cost, loads_at_rest) = (self.cost(&loads), flight.rest(state)?);
        let (at_rest, own_at_rest) =
            (self.cost(&loads_at_rest), path.own_blade_loads(state, &[], &[])?);
        let off_number = |loads: &[f64]| {
            let share = |order: usize| self.cost(&loads[of_order(order)]) / at_rest;
            let others = (2..=highest(blades)).filter(|&n| n != blades);
            [share(1), others.map(share).sum()]
        };
        let [once_per_rev_ratio, other_ratio] = off_number(&of_own);
        let amplitudes = |flap: &HarmonicSeries| {
            (1..=HARMONICS as usize).map(|n| flap.harmonic(n).amplitude()).collect()
        };
        let point = FlightPoint {
            time_s,
            advance_ratio: state.advance_ratio,
            thrust_share: state.thrust_share,
            cost,
            cost_ratio: cost / at_rest,
            once_per_rev_ratio,
            other_ratio,
            off_blade_number_at_rest: off_number(&own_at_rest),
            loads,
            loads_at_rest,
            control_volt: pilot.control_volt().to_vec(),
            is_limited: pilot.is_limited(),
            flap_deg: motion.iter().map(amplitudes).collect(),
            volt,
            held_share,
            power_watt: path.power_watt(state, &motion)?,
        };
        Ok((point, measured))
    }
}

/// Flies one flight; a point for every cycle.
///
/// # Errors
/// [`FlightError`]: lengths and rates that are not positive, actuators, rotor, controller.
pub fn fly(flight: &Flight<'_>, guidance: &Guidance) -> Result<Vec<FlightPoint>, FlightError> {
    flight.check()?;
    let start = flight.rest(flight.state_at(0.0))?;
    let own_flaps = flight.path.own_blades().iter().map(|own| {
        let has_own = flight.own_actuators.iter().any(|one| one.blade == Some(own.blade));
        has_own.then(|| flight.flaps(Some(own.blade), false)).transpose()
    });
    let mut pilot = Pilot::new(flight, guidance, &start)?;
    let mut flown = Flown {
        flight,
        flaps: flight.flaps(None, false)?,
        own_flaps: own_flaps.collect::<Result<_, FlightError>>()?,
        weights: flight.settings.load_weights.diagonal(HUB_OUTPUTS)?,
        noise: flight.noise(&start),
        random: ChaCha8Rng::seed_from_u64(flight.seed),
        revolutions: 0,
    };
    let (mut points, mut failure) = (Vec::new(), flight.failure);
    loop {
        let (point, measured) = flown.cycle(&pilot)?;
        let (time_s, advance_ratio) = (point.time_s, point.advance_ratio);
        points.push(point);
        if time_s >= flight.duration_s {
            return Ok(points);
        }
        if let Some(failed) = failure.filter(|failure| time_s > failure.time_s) {
            failure = None;
            if failed.is_told {
                pilot.lose_flap(failed.flap)?;
            }
        }
        pilot.step(flight.path, advance_ratio, &measured)?;
    }
}

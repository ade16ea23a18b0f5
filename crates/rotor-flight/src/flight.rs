//! The loop along a flight.

use crate::{FlapMarch, FlightError, RotorPath};
use hhc_control::{
    ControlLayout, Cost, CycleController, EstimatorSettings, RelaxedController, RelaxedSettings,
    TMatrix,
};
use preisach_dyn::ActuatorModel;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use rand_distr::{Distribution, StandardNormal};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_study::HUB_OUTPUTS;

/// Revolutions that settle flaps and bias before T is identified.
const SETTLED_REV: usize = 12;

/// How T is known in flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Guidance {
    /// T of the first advance ratio, held.
    Fixed,
    /// T of the knots, interpolated over the advance ratio.
    Scheduled,
    /// T of the first advance ratio, then estimated with Z0 and the noise.
    Adaptive(EstimatorSettings),
}

/// A flap that stops at a time and stays at 0 deg.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlapFailure {
    /// Which one, from 0.
    pub flap: usize,
    /// When, s.
    pub time_s: f64,
    /// Whether the controller is told at the end of that cycle.
    pub is_told: bool,
}

/// One flight: rotor, actuators, schedule and loop.
#[derive(Debug, Clone)]
pub struct Flight<'a> {
    /// The rotor along its path.
    pub path: &'a RotorPath,
    /// The actuator of every flap.
    pub model: &'a ActuatorModel,
    /// Flaps and harmonics of the control.
    pub layout: ControlLayout,
    /// Revolutions per second of the actuators' time.
    pub actuator_rev_hz: f64,
    /// Bias at the start, V.
    pub bias_volt: f64,
    /// Revolutions per second of the rotor.
    pub rotor_rev_hz: f64,
    /// Advance ratio against time (s), linear in between and held beyond the ends.
    pub advance_ratio: Vec<(f64, f64)>,
    /// Length of the flight, s.
    pub duration_s: f64,
    /// Standard deviation of the noise of a load in one revolution, over the root mean square of the loads without control
    /// at the start.
    pub noise_share: f64,
    /// Of the noise.
    pub seed: u64,
    /// A flap that fails.
    pub failure: Option<FlapFailure>,
    /// Revolutions of a cycle that settle, and those of the analyser's window, 1 or more.
    pub cycle_rev: [usize; 2],
    /// Voltage by which T is identified at every knot, V, above 0.
    pub step_volt: f64,
    /// Weights and limits of the controller.
    pub settings: RelaxedSettings,
}

/// One cycle of a flight: what its window has seen.
#[derive(Debug, Clone, PartialEq)]
pub struct FlightPoint {
    /// End of the cycle, s.
    pub time_s: f64,
    /// Advance ratio there.
    pub advance_ratio: f64,
    /// `J / J0`: of the loads without noise, over those without control at this advance ratio.
    pub cost_ratio: f64,
    /// Loads without noise, cosine and sine of six, nondimensional.
    pub loads: [f64; HUB_OUTPUTS],
    /// The control that acted, V.
    pub control_volt: Vec<f64>,
    /// Amplitude of every flap at every controlled harmonic, deg, in the order of the layout.
    pub flap_deg: Vec<f64>,
}

impl Flight<'_> {
    fn check(&self) -> Result<(), FlightError> {
        for (what, value) in [
            ("length of the flight (s)", self.duration_s),
            ("revolutions per second of the rotor", self.rotor_rev_hz),
            ("step of T (V)", self.step_volt),
            ("window of the analyser (revolutions)", self.cycle_rev[1] as f64),
            ("points of the schedule", self.advance_ratio.len() as f64),
        ] {
            if !(value.is_finite() && value > 0.0) {
                return Err(FlightError::OutOfRange { what, value, expected: "above 0" });
            }
        }
        Ok(())
    }

    fn flaps(&self) -> Result<FlapMarch<'_>, FlightError> {
        FlapMarch::new(self.model, &self.layout, self.actuator_rev_hz, self.bias_volt)
    }

    /// Advance ratio at a time.
    fn advance_ratio_at(&self, time_s: f64) -> f64 {
        let after = self.advance_ratio.partition_point(|(time, _)| *time < time_s);
        match (self.advance_ratio.get(after.wrapping_sub(1)), self.advance_ratio.get(after)) {
            (Some((t0, from)), Some((t1, to))) => from + (to - from) * (time_s - t0) / (t1 - t0),
            (Some((_, held)), None) | (None, Some((_, held))) => *held,
            (None, None) => 0.0,
        }
    }

    /// T at an advance ratio about zero control, 1/V, by central differences of settled marches.
    ///
    /// # Errors
    /// As [`fly`].
    pub fn identify(&self, advance_ratio: f64) -> Result<TMatrix, FlightError> {
        let settled = |control: usize, step_volt: f64| {
            let mut control_volt = self.layout.zero();
            control_volt[control] = step_volt;
            let mut flaps = self.flaps()?;
            let mut motion = flaps.revolve(&control_volt)?;
            for _ in 1..SETTLED_REV {
                motion = flaps.revolve(&control_volt)?;
            }
            self.path.loads(advance_ratio, &motion)
        };
        let column = |control: usize| -> Result<Vec<f64>, FlightError> {
            let (up, down) =
                (settled(control, self.step_volt)?, settled(control, -self.step_volt)?);
            Ok(up.iter().zip(down).map(|(up, down)| (up - down) / (2.0 * self.step_volt)).collect())
        };
        let columns = (0..self.layout.len()).map(column).collect::<Result<Vec<_>, _>>()?;
        Ok(TMatrix::from_columns(&columns)?)
    }
}

/// T as the loop knows it.
enum Known {
    Fixed(TMatrix),
    Scheduled(Vec<Vec<Vec<f64>>>),
}

impl Known {
    fn at(&self, path: &RotorPath, advance_ratio: f64) -> Result<TMatrix, FlightError> {
        let knots = match self {
            Self::Fixed(t) => return Ok(t.clone()),
            Self::Scheduled(knots) => knots,
        };
        let [(low, share), (high, rest)] = path.weights(advance_ratio);
        let pairs = knots[low].iter().zip(&knots[high]);
        let columns: Vec<Vec<f64>> = pairs
            .map(|(a, b)| a.iter().zip(b).map(|(a, b)| share * a + rest * b).collect())
            .collect();
        Ok(TMatrix::from_columns(&columns)?)
    }
}

/// The controller of a flight.
enum Pilot {
    Relaxed(Box<RelaxedController>, Known),
    Adaptive(Box<CycleController>),
}

impl Pilot {
    fn new(flight: &Flight<'_>, guidance: &Guidance, start: &[f64]) -> Result<Self, FlightError> {
        let relaxed = RelaxedController::new(&flight.layout, start.len(), flight.settings.clone())?;
        let first = || flight.identify(flight.advance_ratio_at(0.0));
        Ok(match guidance {
            Guidance::Fixed => Self::Relaxed(Box::new(relaxed), Known::Fixed(first()?)),
            Guidance::Scheduled => {
                let knots = flight.path.advance_ratios().into_iter();
                let found = knots.map(|at| Ok(flight.identify(at)?.columns()));
                let found = found.collect::<Result<Vec<_>, FlightError>>()?;
                Self::Relaxed(Box::new(relaxed), Known::Scheduled(found))
            }
            Guidance::Adaptive(settings) => {
                let cycle = CycleController::new(relaxed, settings, &first()?, start)?;
                Self::Adaptive(Box::new(cycle))
            }
        })
    }

    fn control_volt(&self) -> &[f64] {
        match self {
            Self::Relaxed(relaxed, _) => relaxed.control_volt(),
            Self::Adaptive(cycle) => cycle.controller().control_volt(),
        }
    }

    fn step(
        &mut self,
        path: &RotorPath,
        advance_ratio: f64,
        outputs: &[f64],
    ) -> Result<(), FlightError> {
        match self {
            Self::Relaxed(relaxed, known) => {
                relaxed.step(&known.at(path, advance_ratio)?, outputs)?;
            }
            Self::Adaptive(cycle) => {
                cycle.step(outputs)?;
            }
        }
        Ok(())
    }

    fn lose_flap(&mut self, flap: usize) -> Result<(), FlightError> {
        match self {
            Self::Relaxed(relaxed, _) => relaxed.set_flap_lost(flap, true)?,
            Self::Adaptive(cycle) => cycle.lose_flap(flap)?,
        }
        Ok(())
    }
}

/// Flies one flight; a point for every cycle.
///
/// # Errors
/// [`FlightError`]: lengths and rates that are not positive, actuators, rotor, controller.
pub fn fly(flight: &Flight<'_>, guidance: &Guidance) -> Result<Vec<FlightPoint>, FlightError> {
    flight.check()?;
    let mut random = ChaCha8Rng::seed_from_u64(flight.seed);
    let start = flight.path.loads(flight.advance_ratio_at(0.0), &[])?;
    let rms = (start.iter().map(|z| z * z).sum::<f64>() / start.len() as f64).sqrt();
    let mut pilot = Pilot::new(flight, guidance, &start)?;
    let mut flaps = flight.flaps()?;
    let weights = flight.settings.load_weights.diagonal(HUB_OUTPUTS)?;
    let cost = |loads: &[f64]| Cost::of(loads, &weights, &[], 0.0).loads;
    let [settling, window] = flight.cycle_rev;
    let mut failure = flight.failure;
    let (mut points, mut revolutions) = (Vec::new(), 0_usize);
    loop {
        let mut loads = [0.0; HUB_OUTPUTS];
        let mut measured = [0.0; HUB_OUTPUTS];
        let mut motion = Vec::new();
        for rev in 0..settling + window {
            revolutions += 1;
            let time_s = revolutions as f64 / flight.rotor_rev_hz;
            motion = flaps.revolve(pilot.control_volt())?;
            if let Some(failed) = flight.failure.filter(|failure| time_s > failure.time_s)
                && let Some(flap) = motion.get_mut(failed.flap)
            {
                *flap = HarmonicSeries::zero(0);
            }
            if rev < settling {
                continue;
            }
            let found = flight.path.loads(flight.advance_ratio_at(time_s), &motion)?;
            for ((load, seen), found) in loads.iter_mut().zip(&mut measured).zip(found) {
                let draw: f64 = StandardNormal.sample(&mut random);
                *load += found / window as f64;
                *seen += (found + flight.noise_share * rms * draw) / window as f64;
            }
        }
        let time_s = revolutions as f64 / flight.rotor_rev_hz;
        let advance_ratio = flight.advance_ratio_at(time_s);
        let harmonics = flight.layout.harmonics();
        let amplitudes = motion.iter().flat_map(|flap| {
            harmonics.iter().map(|&n| Harmonic::amplitude(&flap.harmonic(n as usize)))
        });
        points.push(FlightPoint {
            time_s,
            advance_ratio,
            cost_ratio: cost(&loads) / cost(&flight.path.loads(advance_ratio, &[])?),
            loads,
            control_volt: pilot.control_volt().to_vec(),
            flap_deg: amplitudes.collect(),
        });
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

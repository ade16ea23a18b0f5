//! How a controller that flies stands noise, a wrong T and an actuator that drifts, and how wrong T may be.

use crate::control::drives::Drives;
use crate::control::set::{ControlSet, least_effort};
use crate::error::StudyError;
use crate::flaps::PlantError;
use crate::plant::{HUB_OUTPUTS, RotorPlant, linearised_answer, output_weights};
use crate::rotor::TrimmedRotor;
use chacha20::ChaCha8Rng;
use hhc_control::{
    ControlError, Cost, CycleController, EstimatorSettings, FeedbackLaw, Plant, RelaxedController,
    RelaxedSettings, RunError, TMatrix,
};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rayon::prelude::*;
use rotor_base::{Limit, limit};
use rotor_case::{Case, ControlActuator, EffortChoice};
use serde::{Deserialize, Serialize};

/// What is disturbed in one flight.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Disturbance {
    /// Standard deviation of the noise of a load, percent of the root mean square baseline load.
    pub noise_percent: f64,
    /// T handed to the controller over the true one.
    pub t_gain: f64,
    /// Phase error of that T, deg of harmonic phase.
    pub t_phase_deg: f64,
    /// The flap whose T is wrong, from 0; none for all.
    #[serde(default)]
    pub t_flap: Option<usize>,
    /// Loss of actuator gain with every cycle, percent.
    pub drift_percent: f64,
}

/// One cell of the map.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct RobustnessCell {
    /// Harmonic under control, per rev.
    pub harmonic: usize,
    /// `fixed`: T held, loads as measured; `adaptive`: T, Z0 and noise estimated; `adaptive-told`: told the noise.
    pub controller: String,
    /// What was disturbed.
    pub disturbance: Disturbance,
    /// Cycles of a flight.
    pub cycles: usize,
    /// Draws of the noise, their seeds the same for all controllers; 1 without noise.
    pub draws: usize,
    /// `J / J0` over the last ten cycles, mean of the draws; of the loads without noise.
    pub end_ratio: f64,
    /// The same of the best and of the worst draw.
    pub end_range: [f64; 2],
    /// Largest `J / J0` of any cycle of any draw.
    pub peak_ratio: f64,
}

/// How wrong T may be at one harmonic: an error of the rotor's own T, on top of what a T that is handed in errs by. A limit that
/// there is not is the word `unbounded` in results.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct MarginLine {
    /// Harmonic under control, per rev.
    pub harmonic: usize,
    /// Largest singular value of the weighted T over the smallest.
    pub condition: f64,
    /// Phase error of all flaps at which the loop diverges, deg; 180 for none.
    #[serde(serialize_with = "limit::phase", deserialize_with = "limit::read_phase")]
    pub common_phase_deg: f64,
    /// Gain of the rotor over that of T at which it does; infinity for none.
    #[serde(serialize_with = "limit::gain", deserialize_with = "limit::read_gain")]
    pub common_gain: f64,
    /// Phase error of all flaps from which `J` rises above `J0` on the way, deg; 180 for none.
    #[serde(serialize_with = "limit::phase", deserialize_with = "limit::read_phase")]
    pub common_overshoot_deg: f64,
    /// The same of one flap alone, flap by flap.
    #[serde(serialize_with = "limit::phases", deserialize_with = "limit::read_phases")]
    pub flap_overshoot_deg: Vec<f64>,
}

impl RobustnessCell {
    /// Name and value of every field, as of a table without loss.
    pub fn fields(&self) -> [(&'static str, String); 13] {
        let d = &self.disturbance;
        let ratio = |value: f64| format!("{value:.5}");
        [
            ("per_rev", self.harmonic.to_string()),
            ("controller", self.controller.clone()),
            ("noise_percent", d.noise_percent.to_string()),
            ("t_gain", d.t_gain.to_string()),
            ("t_phase_deg", d.t_phase_deg.to_string()),
            ("t_flap", d.t_flap.map_or_else(String::new, |flap| flap.to_string())),
            ("drift_percent", d.drift_percent.to_string()),
            ("cycles", self.cycles.to_string()),
            ("draws", self.draws.to_string()),
            ("end_j_over_j0", ratio(self.end_ratio)),
            ("end_best", ratio(self.end_range[0])),
            ("end_worst", ratio(self.end_range[1])),
            ("peak_j_over_j0", ratio(self.peak_ratio)),
        ]
    }

    /// `J / J0` at the end, with its spread where there is noise, and its peak, for people.
    pub fn summary(&self) -> String {
        let [least, most] = self.end_range;
        let spread =
            if self.draws > 1 { format!(" ({least:.3} to {most:.3})") } else { String::new() };
        format!("{:.3}{spread}, {:.2}", self.end_ratio, self.peak_ratio)
    }
}

impl MarginLine {
    /// Harmonic, condition, phase and gain of divergence, phases of overshoot, for people.
    pub fn cells(&self) -> [String; 6] {
        let phase = |deg: &f64| Limit::of_phase(*deg).rounded(0);
        let flaps: Vec<String> = self.flap_overshoot_deg.iter().map(phase).collect();
        [
            format!("{}/rev", self.harmonic),
            format!("{:.1}", self.condition),
            phase(&self.common_phase_deg),
            Limit::of_gain(self.common_gain).rounded(1),
            phase(&self.common_overshoot_deg),
            flaps.join(", "),
        ]
    }
}

const NOISE_PERCENT: [f64; 3] = [1.0, 3.0, 10.0];
const T_GAINS: [f64; 2] = [0.5, 2.0];
const T_PHASES_DEG: [f64; 6] = [-80.0, -60.0, -30.0, 30.0, 60.0, 80.0];
const FLAP_PHASE_DEG: f64 = 20.0;
const DRIFT_PERCENT: [f64; 2] = [0.5, 2.0];
/// First seed of the noise, draws of a cell with noise, cycles of a flight and those that count as its end.
const SEED: u64 = 20_260_101;
const DRAWS: usize = 10;
const CYCLES: usize = 40;
const END_CYCLES: usize = 10;
/// Part of the way that a step goes, and its largest change over the largest amplitude.
const GAIN: f64 = 0.5;
const RATE: f64 = 0.25;
/// Least noise that a filter is told of.
const LEAST_NOISE: f64 = 1e-3;

/// How T is known in a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Known {
    /// Held.
    Fixed,
    /// Estimated with Z0 and the noise.
    Estimated,
    /// Estimated with Z0, the noise told.
    NoiseTold,
}

impl Known {
    const ALL: [Self; 3] = [Self::Fixed, Self::Estimated, Self::NoiseTold];

    /// Its name in results.
    fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Estimated => "adaptive",
            Self::NoiseTold => "adaptive-told",
        }
    }
}

fn disturbances(flaps: usize) -> Vec<Disturbance> {
    let none = Disturbance { t_gain: 1.0, ..Disturbance::default() };
    let mut all = vec![none];
    all.extend(NOISE_PERCENT.map(|noise_percent| Disturbance { noise_percent, ..none }));
    all.extend(T_GAINS.map(|t_gain| Disturbance { t_gain, ..none }));
    all.extend(T_PHASES_DEG.map(|t_phase_deg| Disturbance { t_phase_deg, ..none }));
    all.extend((0..flaps).map(|flap| Disturbance {
        t_phase_deg: FLAP_PHASE_DEG,
        t_flap: Some(flap),
        ..none
    }));
    all.extend(DRIFT_PERCENT.map(|drift_percent| Disturbance { drift_percent, ..none }));
    all.push(Disturbance {
        noise_percent: 3.0,
        t_gain: 0.8,
        t_phase_deg: 30.0,
        t_flap: None,
        drift_percent: 0.5,
    });
    all
}

/// T with the loads of the hub multiplied by a gain and turned by a phase; the weight of the power is known.
fn wrong_t(t: &TMatrix, disturbance: &Disturbance, flaps: usize) -> Result<TMatrix, ControlError> {
    let width = t.controls() / flaps;
    let controls = match disturbance.t_flap {
        Some(flap) => flap * width..(flap + 1) * width,
        None => 0..t.controls(),
    };
    let phase_rad = disturbance.t_phase_deg.to_radians();
    let mut columns = t.turned_within(controls, disturbance.t_gain, phase_rad)?.columns();
    for (wrong, right) in columns.iter_mut().zip(t.columns()) {
        wrong[HUB_OUTPUTS..].copy_from_slice(&right[HUB_OUTPUTS..]);
    }
    TMatrix::from_columns(&columns)
}

/// Adds normal noise of a standard deviation to every load.
fn add_noise(loads: &mut [f64], deviation: f64, random: &mut ChaCha8Rng) {
    for load in loads {
        let draw: f64 = StandardNormal.sample(random);
        *load += deviation * draw;
    }
}

/// What the flights of one harmonic share. The rotor is linearised about its trim; the actuators are as identified.
struct Flights<'a> {
    set: &'a ControlSet<'a>,
    plant: RotorPlant,
    /// T of the rotor, and that of the controllers: the same, but for one that is handed in.
    own_t: TMatrix,
    t0: TMatrix,
    settings: RelaxedSettings,
    weights: Vec<f64>,
    baseline: Vec<f64>,
    rms: f64,
}

/// A controller in a flight.
enum Flying {
    Fixed(Box<RelaxedController>, TMatrix),
    Adaptive(Box<CycleController>),
}

impl Flying {
    fn control_volt(&self) -> &[f64] {
        match self {
            Self::Fixed(relaxed, _) => relaxed.control_volt(),
            Self::Adaptive(cycle) => cycle.control_volt(),
        }
    }

    fn step(&mut self, outputs: &[f64]) -> Result<(), ControlError> {
        match self {
            Self::Fixed(relaxed, t) => relaxed.step(t, outputs).map(|_| ()),
            Self::Adaptive(cycle) => cycle.step(outputs).map(|_| ()),
        }
    }
}

impl<'a> Flights<'a> {
    fn new(set: &'a ControlSet<'a>) -> Result<Self, StudyError> {
        let plant = set.plant(ControlActuator::Hysteretic)?;
        let failed = |source| set.failed(ControlActuator::Hysteretic, source);
        let own_t = set.t_at_rest(&plant).map_err(failed)?;
        let handed = set.handed_t(ControlActuator::Hysteretic, &plant)?;
        let t0 = handed.unwrap_or_else(|| own_t.clone());
        let zero = plant.layout().zero();
        let measured = linearised_answer(&plant, &zero, 1.0)
            .map_err(RunError::plant("measured", &zero))
            .map_err(failed)?;
        let baseline = measured.outputs;
        let weights = output_weights(&set.load_weights(), t0.loads());
        let refused = |error| failed(RunError::Control(error));
        let law = FeedbackLaw::new(&t0, &weights).map_err(refused)?;
        let effort_weight = match set.case.control.effort {
            EffortChoice::Given { rho } => rho,
            EffortChoice::MeetStroke | EffortChoice::Limits => least_effort(&law),
        };
        let amplitude_volt = set.limits.iter().map(|l| l.amplitude_volt).fold(f64::MAX, f64::min);
        let each_weight = weights.diagonal(t0.loads()).map_err(refused)?;
        let settings = RelaxedSettings {
            load_weights: weights,
            effort_weight,
            gain: GAIN,
            amplitude_limit_volt: vec![amplitude_volt; plant.layout().pairs()],
            rate_limit_volt: RATE * amplitude_volt,
            ..RelaxedSettings::of_layout(plant.layout())
        };
        let squares = baseline[..HUB_OUTPUTS].iter().map(|z| z * z).sum::<f64>();
        let rms = (squares / HUB_OUTPUTS as f64).sqrt();
        Ok(Self { set, plant, own_t, t0, settings, weights: each_weight, baseline, rms })
    }

    fn cost(&self, outputs: &[f64]) -> f64 {
        Cost::of(outputs, &self.weights, &[], 0.0).loads
    }

    fn controller(
        &self,
        known: Known,
        disturbance: &Disturbance,
        start: &[f64],
    ) -> Result<Flying, ControlError> {
        let layout = self.plant.layout();
        let t0 = wrong_t(&self.t0, disturbance, layout.flaps())?;
        let relaxed = RelaxedController::new(layout, t0.loads(), self.settings.clone())?;
        if known == Known::Fixed {
            return Ok(Flying::Fixed(Box::new(relaxed), t0));
        }
        let share = (0.01 * disturbance.noise_percent).max(LEAST_NOISE);
        let settings = EstimatorSettings {
            noise_share: (known == Known::NoiseTold).then_some(share),
            ..EstimatorSettings::in_flight(self.set.case.control.amplitude_volt)
        };
        let cycle = CycleController::new(relaxed, &settings, &t0, start)?;
        Ok(Flying::Adaptive(Box::new(cycle)))
    }

    /// `J / J0` of every cycle, without noise.
    fn fly(
        &self,
        known: Known,
        disturbance: &Disturbance,
        seed: u64,
    ) -> Result<Vec<f64>, RunError<PlantError>> {
        self.fly_seen(known, disturbance, seed, &mut |_| ())
    }

    /// The same; `seen` is handed the loads of every cycle as they are measured.
    fn fly_seen(
        &self,
        known: Known,
        disturbance: &Disturbance,
        seed: u64,
        seen: &mut dyn FnMut(&[f64]),
    ) -> Result<Vec<f64>, RunError<PlantError>> {
        let noise = 0.01 * disturbance.noise_percent * self.rms;
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut start = self.baseline.clone();
        add_noise(&mut start[..HUB_OUTPUTS], noise, &mut random);
        let mut flying = self.controller(known, disturbance, &start)?;
        let before = self.cost(&self.baseline);
        let mut ratios = Vec::with_capacity(CYCLES);
        let mut left = 1.0;
        for _ in 0..CYCLES {
            let control_volt = flying.control_volt();
            let mut outputs = linearised_answer(&self.plant, control_volt, left)
                .map_err(RunError::plant("measured", control_volt))?
                .outputs;
            ratios.push(self.cost(&outputs) / before);
            add_noise(&mut outputs[..HUB_OUTPUTS], noise, &mut random);
            seen(&outputs);
            flying.step(&outputs)?;
            left *= 1.0 - 0.01 * disturbance.drift_percent;
        }
        Ok(ratios)
    }

    fn cell(
        &self,
        known: Known,
        disturbance: Disturbance,
        done: &(dyn Fn() + Sync),
    ) -> Result<RobustnessCell, RunError<PlantError>> {
        let draws = if disturbance.noise_percent > 0.0 { DRAWS } else { 1 };
        let flights = (SEED..SEED + draws as u64)
            .map(|seed| self.fly(known, &disturbance, seed).inspect(|_| done()))
            .collect::<Result<Vec<_>, _>>()?;
        let ends: Vec<f64> = flights
            .iter()
            .map(|ratios| ratios[CYCLES - END_CYCLES..].iter().sum::<f64>() / END_CYCLES as f64)
            .collect();
        let largest = |numbers: &mut dyn Iterator<Item = f64>| numbers.fold(0.0, f64::max);
        Ok(RobustnessCell {
            harmonic: self.set.harmonics.first().copied().unwrap_or_default(),
            controller: known.name().to_owned(),
            disturbance,
            cycles: CYCLES,
            draws,
            end_ratio: ends.iter().sum::<f64>() / draws as f64,
            end_range: [
                ends.iter().copied().fold(f64::INFINITY, f64::min),
                largest(&mut ends.iter().copied()),
            ],
            peak_ratio: largest(&mut flights.iter().flatten().copied()),
        })
    }

    fn margins(&self) -> Result<MarginLine, ControlError> {
        let law = FeedbackLaw::new(&self.t0, &self.settings.load_weights)?;
        let layout = self.plant.layout();
        let found = law.margins(layout, &self.own_t, self.settings.step(layout), &self.baseline)?;
        Ok(MarginLine {
            harmonic: self.set.harmonics.first().copied().unwrap_or_default(),
            condition: law.condition(),
            common_phase_deg: found.common_phase_deg,
            common_gain: found.common_gain,
            common_overshoot_deg: found.common_overshoot_deg,
            flap_overshoot_deg: found.flap_overshoot_deg,
        })
    }
}

/// Harmonics that a case controls alone on the hysteretic actuator.
fn harmonics(case: &Case) -> impl Iterator<Item = usize> {
    let is_flown = case.control.actuators.contains(&ControlActuator::Hysteretic);
    case.control.harmonics.iter().filter(move |set| is_flown && set.len() == 1).flatten().copied()
}

/// Flights that the maps of a case take: the steps of its progress.
pub fn robustness_flights(case: &Case) -> usize {
    let draws = disturbances(case.flaps.len())
        .iter()
        .map(|d| if d.noise_percent > 0.0 { DRAWS } else { 1 })
        .sum::<usize>();
    harmonics(case).count() * draws * Known::ALL.len()
}

/// The maps and margins of every harmonic that a case controls alone on the hysteretic actuator: flights of a fixed number
/// of cycles without a line search, on the rotor linearised about its trim. `done` is called after each flight.
///
/// # Errors
/// [`StudyError::Robustness`] of the plant.
pub fn robustness_maps(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
    done: &(dyn Fn() + Sync),
) -> Result<(Vec<RobustnessCell>, Vec<MarginLine>), StudyError> {
    let (mut maps, mut margins) = (Vec::new(), Vec::new());
    if rotor.wake_diverged() || drives.hysteretic.is_none() {
        return Ok((maps, margins));
    }
    for harmonic in harmonics(case) {
        let located = |source| StudyError::Robustness { harmonic, source: Box::new(source) };
        let of_one = [harmonic];
        let set = ControlSet::new(case, rotor, drives, &of_one).map_err(located)?;
        let flights = Flights::new(&set).map_err(located)?;
        let failed = |source| located(set.failed(ControlActuator::Hysteretic, source));
        margins.push(flights.margins().map_err(RunError::Control).map_err(failed)?);
        let cells: Vec<(Disturbance, Known)> = disturbances(case.flaps.len())
            .into_iter()
            .flat_map(|disturbance| Known::ALL.map(|known| (disturbance, known)))
            .collect();
        let cells = cells
            .into_par_iter()
            .map(|(disturbance, known)| flights.cell(known, disturbance, done))
            .collect::<Result<Vec<_>, _>>()
            .map_err(failed)?;
        maps.extend(cells);
    }
    Ok((maps, margins))
}

#[cfg(test)]
#[path = "robustness_tests.rs"]
mod tests;

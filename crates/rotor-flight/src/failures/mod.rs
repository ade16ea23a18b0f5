//! What control reaches when a flap, an actuator or a load cell fails: with controllers that are told and not, for blades
//! under one control and for each blade under its own.

use crate::FlightError;
use crate::blades::{BladeByBlade, Motions, check_orders, highest, of_order};
use hhc_control::{
    ControlError, ControlLayout, FeedbackLaw, LoadWeights, RelaxedController, RelaxedSettings,
    TMatrix,
};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries, uniform_azimuths_rad};
use rotor_case::{Case, FlightValues};
use rotor_response::ResponseError;
use rotor_study::{HUB_OUTPUTS, HubLoads, Setting, TrimmedRotor, least_effort, loads_cost, scaled};
use serde::Serialize;

/// Cycles of a control.
const CYCLES: usize = 30;
/// Weight of the control of each blade, 1/V^2, over the square of the largest singular value of the weighted T, 1/V: many
/// motions of the blades cancel.
const EFFORT: f64 = 1e-6;
/// Azimuths of a revolution at which a voltage is held within its range, and harmonics of what is left.
const AZIMUTHS: usize = 144;
const HARMONICS: usize = 12;
/// What fails by how much.
const STUCK_DEG: [f64; 2] = [0.0, 3.0];
const WEAK_SHARE: f64 = 0.8;
const RANGE_SHARE: f64 = 0.5;

/// What fails: a flap of the first blade or its actuator, or the measurement of a hub load.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Failure {
    /// Nothing.
    Nothing,
    /// The flap stands.
    Stuck {
        /// Its angle, deg.
        deg: f64,
    },
    /// The flap moves less than commanded.
    Weak {
        /// Its motion over that commanded.
        share: f64,
    },
    /// The voltage of its actuator is cut off at a part of the range.
    CutOff {
        /// That part.
        share: f64,
    },
    /// A load is no longer measured, and reads zero.
    LoadLost {
        /// Which, `FX FY FZ MX MY MZ` from 0.
        load: usize,
    },
}

/// Who controls, and what he knows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum FailureControl {
    /// Nobody.
    None,
    /// One control for all blades, T of the sound rotor, loads at the blade number.
    AlikeNotTold,
    /// One control for all blades, T and limits of the failed rotor, a lost load left out.
    AlikeTold,
    /// A control for each blade, told, loads at 1 to twice the blade number less one per rev.
    EachTold,
}

impl FailureControl {
    const ALL: [Self; 4] = [Self::None, Self::AlikeNotTold, Self::AlikeTold, Self::EachTold];

    /// Its name in tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::AlikeNotTold => "alike (not told)",
            Self::AlikeTold => "alike (told)",
            Self::EachTold => "each blade (told)",
        }
    }
}

impl Failure {
    /// Its name in tables.
    pub fn name(self) -> String {
        match self {
            Self::Nothing => "nothing".to_owned(),
            Self::Stuck { deg } => format!("flap stuck at {deg} deg"),
            Self::Weak { share } => format!("flap {:.0} % weak", 100.0 * (1.0 - share)),
            Self::CutOff { share } => {
                format!("voltage cut off at {:.0} % of its range", 100.0 * share)
            }
            Self::LoadLost { load } => format!("{} not measured", load_name(load)),
        }
    }

    /// What is left of a commanded motion, over it: what a controller that is told counts on.
    fn left(self) -> f64 {
        match self {
            Self::Nothing | Self::CutOff { .. } | Self::LoadLost { .. } => 1.0,
            Self::Stuck { .. } => 0.0,
            Self::Weak { share } => share,
        }
    }
}

/// Name of a hub load, from 0.
fn load_name(load: usize) -> String {
    HubLoads::NAMES.get(load).map_or_else(String::new, |name| name.to_uppercase())
}

/// A failure under a control: loads of the nonlinear rotor, over `J0`, the sound one without control.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailureLine {
    /// What has failed.
    pub failure: Failure,
    /// Who controls.
    pub control: FailureControl,
    /// `J / J0` at the blade number per rev after the last cycle.
    pub cost_ratio: f64,
    /// The largest of any cycle under control after the first, which has none yet; none without control.
    pub worst_ratio: Option<f64>,
    /// `J` of the loads at 1/rev over `J0`.
    pub once_per_rev_ratio: f64,
    /// `J` of those at 2 to twice the blade number less one per rev, but for the blade number, over `J0`.
    pub other_ratio: f64,
    /// Largest amplitude of a harmonic of a voltage in the last cycle, V.
    pub largest_volt: f64,
}

/// What control reaches under failures.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FailureStudy {
    /// The flap of the first blade that fails, from 1: the one with the larger say in the loads.
    pub flap: usize,
    /// Name of the load whose measurement is lost: the one with the largest part in `J0`.
    pub load: String,
    /// Failure by failure.
    pub lines: Vec<FailureLine>,
}

/// What control reaches at the advance ratio of a validated case under the failures above, with the harmonics, limits and
/// steps of its flight.
///
/// The rotor is nonlinear, blade by blade, in the inflow and at the controls of its trim; its blades are alike but for the
/// failure. The flaps follow their voltages, held within the range of the case, without hysteresis.
///
/// # Errors
/// [`FlightError`]: trim, response, controller; load harmonics below twice the blade number less one.
pub fn failures_of_case(case: &Case, values: &FlightValues) -> Result<FailureStudy, FlightError> {
    let advance_ratio = case.advance_ratio;
    check_orders(case)?;
    let rotor = TrimmedRotor::new(case, None)
        .map_err(|source| FlightError::Trim { advance_ratio, source: Box::new(source) })?;
    if rotor.wake_diverged() {
        return Err(FlightError::WakeDiverged { advance_ratio });
    }
    let response = |source: ResponseError| FlightError::Response { advance_ratio, source };
    let blades = BladeByBlade::new(&rotor, &values.harmonics).map_err(response)?;
    let study = Study::new(case, values, &blades).map_err(response)?;
    let failures = STUCK_DEG.map(|deg| Failure::Stuck { deg }).into_iter().chain([
        Failure::Weak { share: WEAK_SHARE },
        Failure::CutOff { share: RANGE_SHARE },
        Failure::LoadLost { load: study.load },
    ]);
    let lines: Vec<(Failure, FailureControl)> = std::iter::once(Failure::Nothing)
        .chain(failures)
        .flat_map(|failure| FailureControl::ALL.map(|control| (failure, control)))
        .collect();
    let lines = lines
        .into_par_iter()
        .map(|(failure, control)| study.line(failure, control))
        .collect::<Result<_, FlightError>>()?;
    Ok(FailureStudy { flap: study.flap + 1, load: load_name(study.load), lines })
}

/// What all lines share.
struct Study<'a> {
    blades: &'a BladeByBlade<'a>,
    values: &'a FlightValues,
    advance_ratio: f64,
    gain_deg_per_volt: f64,
    /// Ends of the range of the voltages from the bias, V.
    range_volt: [f64; 2],
    weights: [f64; 6],
    /// Loads of the sound rotor without control.
    baseline: Vec<f64>,
    /// The flap and the load that fail, from 0.
    flap: usize,
    load: usize,
}

/// `J` of the loads of an order.
fn cost_of(weights: &[f64; 6], loads: &[f64], order: usize) -> f64 {
    let own: [f64; HUB_OUTPUTS] = std::array::from_fn(|k| loads[of_order(order)][k]);
    loads_cost(weights, &own)
}

impl<'a> Study<'a> {
    fn new(
        case: &Case,
        values: &'a FlightValues,
        blades: &'a BladeByBlade<'a>,
    ) -> Result<Self, ResponseError> {
        let still = vec![vec![HarmonicSeries::zero(0); blades.flaps()]; blades.blades()];
        let baseline = blades.loads(&still)?;
        let at_blades: [f64; HUB_OUTPUTS] =
            std::array::from_fn(|k| baseline[of_order(blades.blades())][k]);
        let weights = Setting::of_case(case, &HubLoads::from_parts(at_blades)).load_weights();
        let part = |load: usize| {
            weights[load] * (at_blades[2 * load].powi(2) + at_blades[2 * load + 1].powi(2))
        };
        let say = |flap: usize| {
            let each = (0..blades.harmonics().len()).flat_map(|h| blades.slope(0, flap, h));
            each.map(|column| cost_of(&weights, column, blades.blades())).sum::<f64>()
        };
        let largest = |count: usize, of: &dyn Fn(usize) -> f64| {
            (0..count).max_by(|a, b| of(*a).total_cmp(&of(*b))).unwrap_or_default()
        };
        let (low, high) = case.actuator.range_volt;
        let bias = case.control.drive_bias().volt();
        Ok(Self {
            flap: largest(blades.flaps(), &say),
            load: largest(6, &part),
            advance_ratio: case.advance_ratio,
            gain_deg_per_volt: case.actuator.ideal_amplitude_deg / case.control.amplitude_volt,
            range_volt: [low - bias, high - bias],
            blades,
            values,
            weights,
            baseline,
        })
    }

    fn line(&self, failure: Failure, control: FailureControl) -> Result<FailureLine, FlightError> {
        let advance_ratio = self.advance_ratio;
        let respond = |source: ResponseError| FlightError::Response { advance_ratio, source };
        let mut flown = match control {
            FailureControl::None => None,
            _ => Some(Controlled::new(self, failure, control)?),
        };
        let blades = self.blades.blades();
        let before = cost_of(&self.weights, &self.baseline, blades);
        let share = |loads: &[f64], order: usize| {
            let cost = cost_of(&self.weights, loads, order);
            if before > 0.0 { cost / before } else { 0.0 }
        };
        let (mut loads, mut worst_ratio, mut largest_volt) = (Vec::new(), None, 0.0_f64);
        for cycle in 0..if flown.is_some() { CYCLES } else { 1 } {
            let commanded_volt = match &flown {
                Some(own) => own.commanded_volt(self)?,
                None => vec![HarmonicSeries::zero(0); self.blades.flaps() * blades],
            };
            loads = self.blades.loads(&self.motions(failure, &commanded_volt)).map_err(respond)?;
            if let Some(own) = &mut flown {
                if cycle > 0 {
                    let worst = worst_ratio.unwrap_or_default();
                    worst_ratio = Some(share(&loads, blades).max(worst));
                }
                largest_volt = commanded_volt
                    .iter()
                    .flat_map(|flap| flap.harmonics.iter().map(Harmonic::amplitude))
                    .fold(0.0, f64::max);
                if cycle + 1 < CYCLES {
                    own.step(&loads)?;
                }
            }
        }
        let others = (2..=highest(blades)).filter(|&n| n != blades);
        Ok(FailureLine {
            failure,
            control,
            cost_ratio: share(&loads, blades),
            worst_ratio,
            once_per_rev_ratio: share(&loads, 1),
            other_ratio: others.map(|n| share(&loads, n)).sum(),
            largest_volt,
        })
    }

    /// How the flaps of all blades move, deg, under commands of every flap of every blade.
    fn motions(&self, failure: Failure, commanded_volt: &[HarmonicSeries]) -> Motions {
        let flaps = self.blades.flaps();
        let moved = |(k, own): (usize, &HarmonicSeries)| {
            let held = |share: f64| scaled(&self.within(own, share), self.gain_deg_per_volt);
            match failure {
                Failure::Stuck { deg } if k == self.flap => {
                    HarmonicSeries { mean: deg, ..HarmonicSeries::zero(0) }
                }
                Failure::Weak { share } if k == self.flap => scaled(&held(1.0), share),
                Failure::CutOff { share } if k == self.flap => held(share),
                _ => held(1.0),
            }
        };
        let all: Vec<HarmonicSeries> = commanded_volt.iter().enumerate().map(moved).collect();
        all.chunks_exact(flaps).map(<[HarmonicSeries]>::to_vec).collect()
    }

    /// A voltage held within a part of the range, V.
    fn within(&self, volt: &HarmonicSeries, share: f64) -> HarmonicSeries {
        let [low, high] = self.range_volt.map(|end| share * end);
        let azimuths = uniform_azimuths_rad(AZIMUTHS);
        let values: Vec<f64> = azimuths.iter().map(|&psi| volt.value(psi)).collect();
        if values.iter().all(|value| (low..=high).contains(value)) {
            return volt.clone();
        }
        let held: Vec<f64> = values.iter().map(|value| value.clamp(low, high)).collect();
        let weights = vec![1.0 / AZIMUTHS as f64; AZIMUTHS];
        HarmonicSeries::project(&azimuths, &weights, &held, HARMONICS)
    }
}

/// A controller with what it believes of the rotor.
struct Controlled {
    layout: ControlLayout,
    controller: RelaxedController,
    t: TMatrix,
    /// The orders it looks at.
    orders: std::ops::RangeInclusive<usize>,
    /// The load that reads zero.
    unread: Option<usize>,
}

impl Controlled {
    fn new(
        study: &Study<'_>,
        failure: Failure,
        control: FailureControl,
    ) -> Result<Self, ControlError> {
        let blades = study.blades;
        let (count, flaps) = (blades.blades(), blades.flaps());
        let is_each = control == FailureControl::EachTold;
        let is_told = control != FailureControl::AlikeNotTold;
        let orders = if is_each { 1..=highest(count) } else { count..=count };
        let harmonics = blades.harmonics().iter().filter_map(|&n| u32::try_from(n).ok()).collect();
        let layout = ControlLayout::new(if is_each { count * flaps } else { flaps }, harmonics)?;
        // the blades that a flap of the layout moves
        let moved = |flap: usize| if is_each { flap / flaps..flap / flaps + 1 } else { 0..count };
        let rows = (orders.start() - 1) * HUB_OUTPUTS..orders.end() * HUB_OUTPUTS;
        let column = |j: usize| {
            let (pair, part) = (j / 2, j % 2);
            let (flap, harmonic) =
                (pair / blades.harmonics().len(), pair % blades.harmonics().len());
            let mut sum = vec![0.0; rows.len()];
            for blade in moved(flap) {
                let is_hit = is_told && blade == 0 && flap % flaps == study.flap;
                let left = if is_hit { failure.left() } else { 1.0 } * study.gain_deg_per_volt;
                let slope = &blades.slope(blade, flap % flaps, harmonic)[part][rows.clone()];
                for (sum, own) in sum.iter_mut().zip(slope) {
                    *sum += left * own;
                }
            }
            sum
        };
        let t = TMatrix::from_columns(&(0..layout.len()).map(column).collect::<Vec<_>>())?;
        let lost = match failure {
            Failure::LoadLost { load } => Some(load),
            _ => None,
        };
        let weight = |load: usize| {
            if is_told && lost == Some(load) { 0.0 } else { study.weights[load] }
        };
        let weights = orders.clone().flat_map(|_| (0..6).flat_map(|load| [weight(load); 2]));
        let load_weights = LoadWeights::Diagonal(weights.collect());
        let law = FeedbackLaw::new(&t, &load_weights)?;
        let scale = law.singular_values().first().map_or(0.0, |s| s * s);
        let effort_weight = if is_each { EFFORT * scale } else { least_effort(&law) };
        let own_limit = study.values.amplitude_limit_volt;
        let free_volt = study.range_volt[1].min(-study.range_volt[0]);
        let limit = |pair: usize| {
            let flap = pair / blades.harmonics().len();
            let is_hit = is_told && moved(flap).contains(&0) && flap % flaps == study.flap;
            match failure {
                Failure::CutOff { share } if is_hit => {
                    own_limit.min(share * free_volt / blades.harmonics().len() as f64)
                }
                _ => own_limit,
            }
        };
        let settings = RelaxedSettings {
            load_weights,
            effort_weight,
            rate_weight: study.values.rate_weight,
            // what has failed is known; what is left is counted on
            flap_survival: 1.0,
            dead_flap_cost: f64::INFINITY,
            gain: study.values.gain,
            amplitude_limit_volt: (0..layout.pairs()).map(limit).collect(),
            rate_limit_volt: study.values.rate_limit_volt,
        };
        let controller = RelaxedController::new(&layout, rows.len(), settings)?;
        Ok(Self { controller, t, orders, unread: lost, layout })
    }

    /// Voltages of every flap of every blade, about the bias, V.
    fn commanded_volt(&self, study: &Study<'_>) -> Result<Vec<HarmonicSeries>, ControlError> {
        let highest = self.layout.harmonics().iter().max().map_or(0, |&n| n as usize);
        let mut own = vec![HarmonicSeries::zero(highest); self.layout.flaps()];
        let volt = self.layout.voltages_volt(self.controller.control_volt())?;
        for (pair, volt) in volt.into_iter().enumerate() {
            if let Some((flap, n)) = self.layout.flap_and_harmonic(pair) {
                own[flap].set_harmonic(n as usize, volt);
            }
        }
        let all = study.blades.blades() * study.blades.flaps();
        Ok(own.into_iter().cycle().take(all).collect())
    }

    /// The next control from the loads of every order.
    fn step(&mut self, loads: &[f64]) -> Result<(), ControlError> {
        let mut measured: Vec<f64> =
            self.orders.clone().flat_map(|n| loads[of_order(n)].to_vec()).collect();
        if let Some(load) = self.unread {
            for loads in measured.chunks_exact_mut(HUB_OUTPUTS) {
                loads[2 * load..2 * load + 2].fill(0.0);
            }
        }
        self.controller.step(&self.t, &measured).map(|_| ())
    }
}

#[cfg(test)]
mod tests;

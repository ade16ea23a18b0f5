//! The statistically steady state of a rotor and its wake: a trim on the means.

use crate::balance::Balance;
use crate::in_time::coupled::{CoupledInTime, FlapMotion, InTimeSettings};
use crate::in_time::statistics::{Interval, steady_mean};
use crate::vehicle::Attitude;
use crate::{TrimError, TrimSettings, TrimTarget, WakeTrim, trim};
use nalgebra::{DMatrix, DVector};
use rotor_response::{Condition, Controls, RotorSolver};
use rotor_wake::{FlightState, LinearInflow};

/// Revolutions over which the loads are averaged before the controls are corrected while the wake settles, and the share of a
/// whole correction: less than the wake takes to answer, so that small ones follow each other.
const WINDOW: usize = 4;
const SHARE: f64 = 0.5;
/// Times that a state is measured: where its mean is out of balance, the controls are corrected and it is measured again.
const MEASURED: usize = 3;
/// Half width of an interval that six means keep to together with 95 % probability, over that of one (99.2 % and 95 % quantiles of
/// Student's distribution with 9 degrees of freedom, 3.36 and 2.26).
const JOINTLY: f64 = 1.5;
/// Half width of a residual over the weight above which its interval does not excuse it.
const WIDEST: f64 = 0.02;
/// Largest correction of an unknown at a time, rad (weights for the tail thrust).
const LARGEST_CORRECTION: f64 = 0.02;

/// How a statistically steady state is found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SteadySettings {
    /// How blades and wake are marched.
    pub march: InTimeSettings,
    /// Revolutions that the wake is given to forget how it began, and its controls to find the balance.
    pub settling: usize,
    /// Revolutions that are measured, under controls that stay.
    pub revolutions: usize,
    /// Largest residual of the mean loads over the weight; residuals that their intervals together do not tell from none are as
    /// good.
    pub imbalance: f64,
}

impl Default for SteadySettings {
    fn default() -> Self {
        let march = InTimeSettings::default();
        Self { march, settling: 24, revolutions: 40, imbalance: 2e-3 }
    }
}

/// One revolution of a march.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RevolutionInTime {
    /// Whether it is one of those whose means are given.
    pub measured: bool,
    /// Pitch controls.
    pub controls: Controls,
    /// Mean loads of all blades on the hub: `m0 Omega^2 R^2`, `m0 Omega^2 R^3`.
    pub mean: [f64; 6],
    /// Their harmonic at the blade number: `[Fx_c, Fx_s, ... Mz_s]`, about the azimuth of the first blade.
    pub at_blade_number: [f64; 12],
    /// Mean over the disk of the inflow that the blades feel, tip speed.
    pub mean_inflow: f64,
}

impl RevolutionInTime {
    /// Amplitude of each load at the blade number.
    pub fn amplitudes(&self) -> [f64; 6] {
        std::array::from_fn(|k| self.at_blade_number[2 * k].hypot(self.at_blade_number[2 * k + 1]))
    }
}

/// A rotor in its wake as it is in the mean.
#[derive(Debug, Clone)]
pub struct SteadyInTime {
    /// Pitch controls.
    pub controls: Controls,
    /// Attitude and tail rotor, as of a trim.
    pub attitude: Attitude,
    /// Flight state of the rotor.
    pub flight: FlightState,
    /// Every revolution, those of settling first.
    pub history: Vec<RevolutionInTime>,
    /// Revolutions measured, the last ones.
    pub measured: usize,
    /// Mean loads on the hub.
    pub mean: [Interval; 6],
    /// Their harmonic at the blade number: that which repeats.
    pub at_blade_number: [Interval; 12],
    /// Its amplitude, revolution by revolution: that which is felt.
    pub amplitudes: [Interval; 6],
    /// Mean inflow, tip speed.
    pub mean_inflow: Interval,
    /// Residuals of the trim over the weight, of the means; none for prescribed controls.
    pub residuals: Vec<Interval>,
    /// Whether they are within what was asked, or not to be told from none with 95 % probability.
    pub balanced: bool,
    /// Controls and attitude that the means ask for, by the Jacobian of the trim: collective, lateral and longitudinal cyclic, and
    /// in level flight shaft tilt, bank (rad) and tail thrust (`m0 Omega^2 R^2`); none for prescribed controls. Their intervals say
    /// how sure the trim is, the rms what a pilot would have to do.
    pub asked_for: Vec<Interval>,
    /// Blades and wake at the end.
    pub end: CoupledInTime,
}

/// The march, its controls and its balance.
struct Pilot<'a> {
    march: CoupledInTime,
    balance: Balance,
    unknowns: DVector<f64>,
    /// Of the residuals; none where nothing is to be balanced.
    jacobian: Option<DMatrix<f64>>,
    flaps: &'a FlapMotion<'a>,
    history: Vec<RevolutionInTime>,
}

impl Pilot<'_> {
    fn condition(&self) -> (Condition, Attitude) {
        let (controls, attitude) = self.balance.state(&self.unknowns);
        let flight = self.balance.flight(attitude.shaft_tilt_rad);
        let flap_angles_rad = Vec::new();
        (Condition { flight, bank_rad: attitude.roll_rad, controls, flap_angles_rad }, attitude)
    }

    /// One revolution under the present controls.
    fn revolution(&mut self, measured: bool) -> Result<RevolutionInTime, TrimError> {
        let (condition, _) = self.condition();
        let (mut mean, mut at_blade_number, mut mean_inflow) = ([0.0; 6], [0.0; 12], 0.0);
        let (steps, blades) = (self.march.steps_per_revolution(), self.march.blade_count());
        for _ in 0..steps {
            let instants = self.march.step(&condition, self.flaps)?;
            let share = 1.0 / (steps * instants.len()) as f64;
            for instant in instants {
                let (sin, cos) = (blades as f64 * instant.azimuths_rad[0]).sin_cos();
                for (k, load) in instant.hub.iter().enumerate() {
                    mean[k] += share * load;
                    at_blade_number[2 * k] += 2.0 * share * load * cos;
                    at_blade_number[2 * k + 1] += 2.0 * share * load * sin;
                }
            }
            mean_inflow += self.march.mean_inflow() / steps as f64;
        }
        let controls = condition.controls;
        let seen = RevolutionInTime { measured, controls, mean, at_blade_number, mean_inflow };
        self.history.push(seen);
        Ok(seen)
    }

    /// Residuals of the last revolutions, one after the other.
    fn residuals(&self, count: usize) -> Vec<DVector<f64>> {
        let (_, attitude) = self.condition();
        let last = &self.history[self.history.len().saturating_sub(count)..];
        last.iter().map(|seen| self.balance.residual_of(seen.mean, &attitude)).collect()
    }

    /// What the unknowns would be in balance with each of the last revolutions.
    fn asked_for(&self, count: usize) -> Vec<DVector<f64>> {
        let Some(jacobian) = &self.jacobian else { return Vec::new() };
        let inverse = jacobian.clone().lu();
        let of = |residual: DVector<f64>| Some(&self.unknowns - inverse.solve(&residual)?);
        self.residuals(count).into_iter().filter_map(of).collect()
    }

    /// Moves the controls by a share of what the mean residual of the last revolutions asks for.
    fn correct(&mut self, count: usize, share: f64) {
        let Some(jacobian) = &self.jacobian else { return };
        let residuals = self.residuals(count);
        let mean: DVector<f64> = residuals.iter().sum::<DVector<f64>>() / residuals.len() as f64;
        if let Some(step) = jacobian.clone().lu().solve(&mean) {
            for (value, change) in self.unknowns.iter_mut().zip(&step) {
                *value -= (share * change).clamp(-LARGEST_CORRECTION, LARGEST_CORRECTION);
            }
        }
    }
}

/// Marches a rotor and its wake from a trim, settled or not, to a statistically steady state in which the means are trimmed, and
/// measures it. Where a periodic state exists and is stable, the march ends in it.
///
/// While it settles, the controls follow the mean residual of four revolutions by half of what the Jacobian of the trim asks
/// for. Then they stay while the loads are measured. Out of balance, they are corrected and all is measured again, twice at most.
///
/// `flaps` moves the flaps in time; `watch` is told every revolution and how many there are to be, at least.
///
/// # Errors
/// [`TrimError::Parameter`] for no revolutions; those of [`CoupledInTime`].
pub fn steady_in_time(
    solver: &RotorSolver,
    begun: &WakeTrim,
    target: &TrimTarget,
    settings: &SteadySettings,
    flaps: &FlapMotion<'_>,
    watch: &mut dyn FnMut(&RevolutionInTime, usize),
) -> Result<SteadyInTime, TrimError> {
    let (count, expected) = (settings.revolutions, "1 or more");
    if count == 0 {
        return Err(TrimError::Parameter { field: "revolutions", value: 0.0, expected });
    }
    let mu = begun.trim.flight.advance_ratio;
    let balance = Balance::new(solver, mu, target)?;
    let unknowns = balance.unknowns_of(&begun.trim.controls, &begun.trim.attitude);
    let jacobian = match &begun.trim.slope {
        _ if unknowns.is_empty() => None,
        Some(known) => Some(known.residuals.clone()),
        None => {
            let of_trim = TrimSettings { tolerance: 1e-6, ..TrimSettings::default() };
            let of = |inflow| trim(&mut solver.clone(), &inflow, mu, target, &of_trim, None);
            let found = of(LinearInflow::Drees).or_else(|_| of(LinearInflow::Uniform))?;
            found.slope.map(|slope| slope.residuals)
        }
    };
    let march = CoupledInTime::new(solver, begun, settings.march)?;
    let mut pilot = Pilot { march, balance, unknowns, jacobian, flaps, history: Vec::new() };
    let mut least = settings.settling + count;
    for revolution in 1..=settings.settling {
        watch(&pilot.revolution(false)?, least);
        // what a correction leaves is not to be measured
        if revolution.is_multiple_of(WINDOW) && revolution + 2 * WINDOW <= settings.settling {
            pilot.correct(WINDOW, SHARE);
        }
    }
    let mut measured = 0;
    let mut residuals = Vec::new();
    let mut balanced = false;
    while measured < MEASURED && !balanced {
        if measured > 0 {
            pilot.correct(count, 1.0);
            pilot.history.iter_mut().for_each(|seen| seen.measured = false);
            least = pilot.history.len() + 2 * WINDOW + count;
            for _ in 0..2 * WINDOW {
                watch(&pilot.revolution(false)?, least);
            }
        }
        for _ in 0..count {
            watch(&pilot.revolution(true)?, least);
        }
        measured += 1;
        residuals = intervals(&pilot.residuals(count));
        // a wide interval says little, and balance least of all
        let fits = |r: &Interval| {
            let chance = if r.half_width_95 <= WIDEST { JOINTLY * r.half_width_95 } else { 0.0 };
            r.mean.abs() <= settings.imbalance.max(chance)
        };
        balanced = residuals.iter().all(fits);
    }
    let (condition, attitude) = pilot.condition();
    let last = &pilot.history[pilot.history.len() - count..];
    let over = |value: &dyn Fn(&RevolutionInTime) -> f64| {
        steady_mean(&last.iter().map(value).collect::<Vec<f64>>())
    };
    Ok(SteadyInTime {
        controls: condition.controls,
        attitude,
        flight: condition.flight,
        measured: count,
        mean: std::array::from_fn(|k| over(&|seen| seen.mean[k])),
        at_blade_number: std::array::from_fn(|k| over(&|seen| seen.at_blade_number[k])),
        amplitudes: std::array::from_fn(|k| over(&|seen| seen.amplitudes()[k])),
        mean_inflow: over(&|seen| seen.mean_inflow),
        asked_for: intervals(&pilot.asked_for(count)),
        residuals,
        balanced,
        history: pilot.history,
        end: pilot.march,
    })
}

/// Mean and interval of every component over some revolutions.
fn intervals(vectors: &[DVector<f64>]) -> Vec<Interval> {
    let count = vectors.first().map_or(0, DVector::len);
    let of = |k: usize| steady_mean(&vectors.iter().map(|r| r[k]).collect::<Vec<f64>>());
    (0..count).map(of).collect()
}

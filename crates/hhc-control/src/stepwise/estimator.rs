//! T, Z0 and the noise from measured pairs: a Kalman filter with a model of drift.

use crate::{ControlError, OperatingPoint, TMatrix, error};
use nalgebra::{DMatrix, DVector};

/// Settings of the estimate of T and Z0. Shares of loads are parts of the root mean square of the loads at the start.
#[derive(Debug, Clone, PartialEq)]
pub struct EstimatorSettings {
    /// Control voltage over which the actuator is used, V: the unit of the excitation.
    pub full_scale_volt: f64,
    /// Standard deviation of the noise of one measured load, share of the loads, above 0; none: estimated from the
    /// innovations.
    pub noise_share: Option<f64>,
    /// Standard deviation of an element of T0, as a part of the root mean square of its elements.
    pub uncertainty: f64,
    /// Change of an element of T that a move of the control by full scale brings, as a part of the same:
    /// the random walk of T. Zero for a T that stays.
    pub drift: f64,
    /// Change of Z0 from one pair to the next, share of the loads: the random walk of Z0.
    pub baseline_drift: f64,
    /// Change from one pair to the next of the trend of Z0, which Z0 follows, share of the loads: the random walk of the trend.
    /// Zero for a Z0 without one.
    pub trend_drift: f64,
    /// Whether an innovation beyond all noise frees Z0, and T too where another follows soon.
    pub tests_jumps: bool,
    /// Angle by which a [`super::CycleController`] turns every harmonic of the control to and fro, rad, 0 to 0.5: the excitation
    /// by which T is learnt where limits hold the control. Zero for none.
    pub dither_rad: f64,
}

impl EstimatorSettings {
    /// Settings for a rotor that flies, full scale in V: T0 good to a fifth, a change of T by half of that over
    /// full scale, noise not told, Z0 that walks by 1 % of the loads a cycle and may jump.
    pub fn in_flight(full_scale_volt: f64) -> Self {
        Self {
            full_scale_volt,
            noise_share: None,
            uncertainty: 0.2,
            drift: 0.1,
            baseline_drift: 0.01,
            trend_drift: 0.0,
            tests_jumps: true,
            dither_rad: 0.0,
        }
    }

    /// Settings for a plant that answers exactly and stays as it is, full scale in V: T0 good to a half, a change of T
    /// by a half over full scale.
    pub fn of_exact_plant(full_scale_volt: f64) -> Self {
        Self {
            full_scale_volt,
            noise_share: Some(1e-7),
            uncertainty: 0.5,
            drift: 0.5,
            baseline_drift: 1e-7,
            trend_drift: 0.0,
            tests_jumps: false,
            dither_rad: 0.0,
        }
    }

    pub(crate) fn check(&self) -> Result<(), ControlError> {
        error::check_positive("full scale of the adaptive controller (V)", self.full_scale_volt)?;
        if let Some(share) = self.noise_share {
            error::check_positive("noise of a load (leave it out to have it estimated)", share)?;
        }
        error::check_positive("uncertainty of T0", self.uncertainty)?;
        error::check_not_negative("drift of T", self.drift)?;
        let (what, turn) = ("turn of the dither (rad)", self.dither_rad);
        error::check_range((0.0..=0.5).contains(&turn), what, turn, "0 to 0.5, 0 for none")?;
        error::check_not_negative("drift of the trend of Z0", self.trend_drift)?;
        error::check_positive("drift of Z0", self.baseline_drift)
    }
}

/// Noise that is not told: where its estimate starts, share of the loads; pairs that the start counts for, and the memory,
/// in pairs.
const NOISE_START: f64 = 0.1;
const NOISE_START_PAIRS: f64 = 4.0;
const NOISE_MEMORY_PAIRS: f64 = 50.0;
/// Pairs until an estimated noise is relied on.
const NOISE_LEARNT_PAIRS: f64 = 20.0;
/// What is left from pair to pair of the variance that a freed T may have beyond that of T0.
const CEILING_KEPT: f64 = 0.9;
/// Standard deviations of the sum of squared innovations beyond which it is a jump.
const JUMP_SIGMAS: f64 = 5.0;
/// Pairs after a jump within which another one is not of Z0 alone.
const JUMP_PAIRS: u32 = 5;

/// What a pair told.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Observed {
    /// An innovation of the size expected.
    AsExpected,
    /// A jump: Z0 was freed.
    BaselineJump,
    /// A second jump soon after: T was freed too.
    SensitivityJump,
}

/// The estimate `Z = Z0 + T u` with its covariance, the same for every load.
///
/// ```text
/// Z_i = theta_i . phi,   phi = (1, u / u_full, 0),   theta_i = (Z0_i, T_i u_full, s_i),   s the trend of Z0
/// predict   Z0 += s,  P = F P F' + Q,   Q = q_0 on Z0,  (drift |du| / u_full)^2 rms^2 on the elements of T,  q_s on s
/// update    k = P phi / (r + phi' P phi),   theta_i += k (Z_i - theta_i . phi)
///           P = (I - k phi') P (I - k phi')' + r k k'
/// noise     r += ( mean(e^2) + phi' P phi - r ) / m,     e the residuals after the update
/// jump      sum over L loads of innovation^2 / (r + phi' P phi)  >  L + 5 sqrt(2 L):   row of Z0 freed
/// ```
/// - The variance of an element of T never grows beyond that of T0, a freed one's for some ten pairs: directions that are
///   not excited cannot burst.
/// - At rest nothing is added to T, and the walk of Z0 takes what changes.
/// - A loop moves its control against a ramp of Z0, so that the loads hardly change. Without a trend of Z0 that looks like a T
///   that is weak.
/// - A jump is counted as noise only up to the limit of its test, so that noise that was taken for jumps is learnt.
///
/// Source: W. Johnson, NASA TP-1996 (1982), section on identification; B. Anderson, J. Moore, *Optimal Filtering*
/// (1979), chapter 3; form of the update after Joseph; noise from residuals: A. Mohamed, K. Schwarz, J. Geodesy 73
/// (1999) 193.
#[derive(Debug, Clone)]
pub struct LoadEstimator {
    settings: EstimatorSettings,
    /// Loads x (1 + controls + 1), and T in 1/V beside it.
    theta: DMatrix<f64>,
    t: TMatrix,
    covariance: DMatrix<f64>,
    /// Variance of a scaled element of T0, and the largest allowed now: more after T was freed.
    prior: f64,
    ceiling: f64,
    /// Mean square of the loads at the start.
    scale: f64,
    noise_variance: f64,
    pairs: f64,
    /// Pairs since the last jump.
    since_jump: u32,
    last_volt: Vec<f64>,
    is_load_lost: Vec<bool>,
    is_control_lost: Vec<bool>,
    regressor: DVector<f64>,
    spread: DVector<f64>,
    gain: DVector<f64>,
    innovation: DVector<f64>,
}

fn mean_square(numbers: &[f64]) -> f64 {
    numbers.iter().map(|v| v * v).sum::<f64>() / numbers.len().max(1) as f64
}

impl LoadEstimator {
    /// Least variance of a noise that is estimated, over the mean square of the loads at the start.
    pub const NOISE_FLOOR_VARIANCE: f64 = 1e-4 * 1e-4;

    /// The estimate as it stands after a first measured state, with a T0 (1/V).
    ///
    /// # Errors
    /// Settings out of range; vectors of another length than T0 has loads and controls.
    pub fn new(
        settings: &EstimatorSettings,
        t0: &TMatrix,
        start: OperatingPoint<'_>,
    ) -> Result<Self, ControlError> {
        settings.check()?;
        let (loads, controls) = (t0.loads(), t0.controls());
        error::check_vector("control vector (volt)", start.control_volt, controls)?;
        error::check_vector("measured outputs", start.outputs, loads)?;
        let t = t0.as_matrix() * settings.full_scale_volt;
        let prior = settings.uncertainty.powi(2) * mean_square(t.as_slice());
        let scale = mean_square(start.outputs).max(f64::MIN_POSITIVE);
        let noise = settings.noise_share.unwrap_or(NOISE_START);
        let noise_variance = (noise * noise * scale).max(f64::MIN_POSITIVE);
        // behind Z0 and T stands the trend of Z0
        let size = controls + 2;
        let mut covariance = DMatrix::identity(size, size) * prior;
        // Z0 is as good as the one measurement it comes from
        covariance[(0, 0)] = noise_variance;
        covariance[(size - 1, size - 1)] = 0.0;
        let mut this = Self {
            settings: settings.clone(),
            theta: t.insert_column(0, 0.0).insert_column(controls + 1, 0.0),
            t: t0.clone(),
            covariance,
            prior,
            ceiling: prior,
            scale,
            noise_variance,
            pairs: 0.0,
            since_jump: u32::MAX,
            last_volt: start.control_volt.to_vec(),
            is_load_lost: vec![false; loads],
            is_control_lost: vec![false; controls],
            regressor: DVector::zeros(size),
            spread: DVector::zeros(size),
            gain: DVector::zeros(size),
            innovation: DVector::zeros(loads),
        };
        this.innovate(start);
        let Self { theta, innovation, .. } = &mut this;
        theta.column_mut(0).axpy(1.0, innovation, 1.0);
        Ok(this)
    }

    /// Takes in one measured pair; what is lost is left out.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`]; the pair is then not taken.
    pub fn observe(&mut self, pair: OperatingPoint<'_>) -> Result<Observed, ControlError> {
        error::check_vector("control vector (volt)", pair.control_volt, self.last_volt.len())?;
        check_outputs(pair.outputs, &self.is_load_lost)?;
        self.predict(pair.control_volt);
        self.innovate(pair);
        let known = self.is_load_lost.iter().filter(|lost| !**lost).count().max(1) as f64;
        let squares = self.innovation.norm_squared();
        let told = self.told();
        let limit = known + JUMP_SIGMAS * (2.0 * known).sqrt();
        let is_jump = self.settings.tests_jumps && squares > limit * told;
        let squares = if is_jump { limit * told } else { squares };
        let r = self.noise_variance;
        // residuals after the update are the innovations times r / told
        let noise = r * (r * squares / known / told + (told - r)) / told;
        // while the noise is still being learnt, it is what looks like jumps
        let is_noise_known =
            self.settings.noise_share.is_some() || self.pairs >= NOISE_LEARNT_PAIRS;
        let observed = match (is_jump, self.since_jump < JUMP_PAIRS && is_noise_known) {
            (false, _) => Observed::AsExpected,
            (true, false) => Observed::BaselineJump,
            (true, true) => Observed::SensitivityJump,
        };
        if is_jump {
            self.free(observed == Observed::SensitivityJump);
        }
        self.since_jump = if is_jump { 0 } else { self.since_jump.saturating_add(1) };
        self.update();
        if self.settings.noise_share.is_none() {
            self.pairs += 1.0;
            let memory = (NOISE_START_PAIRS + self.pairs).min(NOISE_MEMORY_PAIRS);
            let floor = Self::NOISE_FLOOR_VARIANCE * self.scale;
            self.noise_variance = (r + (noise - r) / memory).max(floor);
        }
        Ok(observed)
    }

    /// Lets Z0, and T too, be learnt anew; what they were is where that starts.
    fn free(&mut self, also_t: bool) {
        let size = self.covariance.nrows();
        for k in 0..size {
            self.covariance[(0, k)] = 0.0;
            self.covariance[(k, 0)] = 0.0;
        }
        self.covariance[(0, 0)] = self.scale;
        if also_t {
            // as little is known as where nothing was: an element may be anything of their usual size
            self.ceiling = self.prior.max(self.prior / self.settings.uncertainty.powi(2));
            for k in 1..size - 1 {
                // more on the diagonal keeps what is known of the others
                let missing = self.ceiling - self.covariance[(k, k)];
                self.covariance[(k, k)] += missing.max(0.0);
            }
        }
    }

    /// Adds the random walks.
    fn predict(&mut self, control_volt: &[f64]) {
        let full_scale = self.settings.full_scale_volt;
        let moves = control_volt.iter().zip(&self.last_volt);
        let moved = moves.map(|(a, b)| ((a - b) / full_scale).powi(2)).sum::<f64>().sqrt();
        self.last_volt.copy_from_slice(control_volt);
        self.follow_trend();
        self.covariance[(0, 0)] += self.settings.baseline_drift.powi(2) * self.scale;
        let walk = self.settings.drift / self.settings.uncertainty * moved;
        self.ceiling = self.prior + CEILING_KEPT * (self.ceiling - self.prior);
        for k in 1..=control_volt.len() {
            self.covariance[(k, k)] += self.prior * walk * walk;
            let excess = (self.ceiling / self.covariance[(k, k)]).sqrt();
            if excess < 1.0 {
                self.covariance.row_mut(k).scale_mut(excess);
                self.covariance.column_mut(k).scale_mut(excess);
            }
        }
    }

    /// Lets Z0 go on by its trend.
    fn follow_trend(&mut self) {
        if self.settings.trend_drift == 0.0 {
            return;
        }
        let (size, loads) = (self.covariance.nrows(), self.theta.nrows());
        for load in 0..loads {
            self.theta[(load, 0)] += self.theta[(load, size - 1)];
        }
        for k in 0..size {
            self.covariance[(0, k)] += self.covariance[(size - 1, k)];
        }
        for k in 0..size {
            self.covariance[(k, 0)] += self.covariance[(k, size - 1)];
        }
        self.covariance[(size - 1, size - 1)] += self.settings.trend_drift.powi(2) * self.scale;
    }

    /// Regressor and innovations of a pair.
    fn innovate(&mut self, pair: OperatingPoint<'_>) {
        self.regressor[0] = 1.0;
        let controls = pair.control_volt.iter().zip(&self.is_control_lost);
        for (scaled, (volt, lost)) in self.regressor.iter_mut().skip(1).zip(controls) {
            *scaled = if *lost { 0.0 } else { volt / self.settings.full_scale_volt };
        }
        self.innovation.copy_from_slice(pair.outputs);
        self.innovation.gemv(-1.0, &self.theta, &self.regressor, 1.0);
        for (innovation, lost) in self.innovation.iter_mut().zip(&self.is_load_lost) {
            *innovation = if *lost { 0.0 } else { *innovation };
        }
    }

    /// Variance of an innovation.
    fn told(&mut self) -> f64 {
        self.spread.gemv(1.0, &self.covariance, &self.regressor, 0.0);
        self.noise_variance + self.regressor.dot(&self.spread).max(0.0)
    }

    /// The update of the whole row of every load, and of the covariance in Joseph's form.
    fn update(&mut self) {
        let told = self.told();
        self.gain.copy_from(&self.spread);
        self.gain /= told;
        self.theta.ger(1.0, &self.innovation, &self.gain, 1.0);
        self.covariance.ger(-1.0, &self.gain, &self.spread, 1.0);
        self.spread.gemv(1.0, &self.covariance, &self.regressor, 0.0);
        self.spread.axpy(-self.noise_variance, &self.gain, 1.0);
        self.covariance.ger(-1.0, &self.spread, &self.gain, 1.0);
        for row in 0..self.covariance.nrows() {
            for column in 0..row {
                let mean =
                    f64::midpoint(self.covariance[(row, column)], self.covariance[(column, row)]);
                self.covariance[(row, column)] = mean;
                self.covariance[(column, row)] = mean;
            }
        }
        let per_volt = 1.0 / self.settings.full_scale_volt;
        self.t.set_scaled(&self.theta, per_volt);
    }

    /// Leaves a load (from 0) out, or takes it in again; its row stays as it was when it was lost.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a load that there is not.
    pub fn set_load_lost(&mut self, load: usize, is_lost: bool) -> Result<(), ControlError> {
        set_flag(&mut self.is_load_lost, "load that is lost (from 0)", load, is_lost)
    }

    /// Takes controls (from 0) for dead: their columns of T become 0 and stay.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a control that there is not.
    pub fn lose_controls(&mut self, controls: std::ops::Range<usize>) -> Result<(), ControlError> {
        let (found, expected) = (controls.end as f64, "controls of T");
        let is_known = controls.end <= self.last_volt.len();
        error::check_range(is_known, "controls that are lost", found, expected)?;
        // Z0 goes on from where the loads are
        for control in controls {
            let k = control + 1;
            let (volt, per_volt) = (self.last_volt[control], 1.0 / self.settings.full_scale_volt);
            for mut row in self.theta.row_iter_mut() {
                row[0] += per_volt * (row[k] * volt);
                row[k] = 0.0;
            }
            self.covariance.row_mut(k).fill(0.0);
            self.covariance.column_mut(k).fill(0.0);
            self.is_control_lost[control] = true;
        }
        self.t.set_scaled(&self.theta, 1.0 / self.settings.full_scale_volt);
        Ok(())
    }

    /// The loads that the estimate gives at a control vector (volt), nondimensional, as many as `loads` takes.
    pub fn loads_at(&self, control_volt: &[f64], loads: &mut [f64]) {
        let t = self.t.as_matrix();
        for (i, load) in loads.iter_mut().enumerate().take(t.nrows()) {
            let change: f64 = t.row(i).iter().zip(control_volt).map(|(t, u)| t * u).sum();
            *load = self.theta[(i, 0)] + change;
        }
    }

    /// The estimate of T, 1/V.
    pub fn t(&self) -> &TMatrix {
        &self.t
    }

    /// Covariance of `theta_i = (Z0_i, T_i u_full, trend of Z0_i)`, the same for every load: nondimensional loads squared.
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Standard deviation of the noise of one load, told or estimated, nondimensional.
    pub fn noise(&self) -> f64 {
        self.noise_variance.sqrt()
    }
}

/// Accepts measured loads, one for every flag; those that are lost may be no numbers.
pub(super) fn check_outputs(outputs: &[f64], is_lost: &[bool]) -> Result<(), ControlError> {
    error::check_length("measured outputs", outputs.len(), is_lost.len())?;
    let mut known = outputs.iter().zip(is_lost).enumerate().filter(|(_, (_, lost))| !**lost);
    match known.find(|(_, (value, _))| !value.is_finite()) {
        Some((index, (&value, _))) => {
            Err(ControlError::NotFinite { what: "measured outputs", index, value })
        }
        None => Ok(()),
    }
}

/// Sets one flag of a list.
pub(super) fn set_flag(
    flags: &mut [bool],
    what: &'static str,
    index: usize,
    value: bool,
) -> Result<(), ControlError> {
    let count = flags.len();
    error::check_range(index < count, what, index as f64, "one that there is")?;
    flags[index] = value;
    Ok(())
}

#[cfg(test)]
#[path = "estimator_tests.rs"]
mod tests;

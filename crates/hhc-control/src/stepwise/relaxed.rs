//! The relaxed controller: one step of every cycle, no line search.

use super::estimator::{check_outputs, set_flag};
use super::program::DiscProgram;
use crate::{ControlError, ControlLayout, LoadWeights, RelaxedStep, TMatrix, error};
use nalgebra::{DMatrix, DVector};

/// Weights and limits of a relaxed controller.
#[derive(Debug, Clone, PartialEq)]
pub struct RelaxedSettings {
    /// `W_Z`.
    pub load_weights: LoadWeights,
    /// `rho`, 1/V^2, 0 or above.
    pub effort_weight: f64,
    /// `s`, `S = s I`, 1/V^2, 0 or above.
    pub rate_weight: f64,
    /// `q`, the chance that a flap acts, above 0 and at most 1: below 1 the flaps lean less on each other.
    pub flap_survival: f64,
    /// Largest `J` that any one flap that stops may leave, over `J` at zero control, 1 or above; infinity for none.
    pub dead_flap_cost: f64,
    /// Part of the way to the optimum that a step goes, above 0 and at most 1.
    pub gain: f64,
    /// Largest voltage amplitude of every pair of the layout, V; infinity for none.
    pub amplitude_limit_volt: Vec<f64>,
    /// Largest change of any voltage harmonic in a step, V; infinity for none.
    pub rate_limit_volt: f64,
}

impl RelaxedSettings {
    /// Equal loads, whole steps, no weight and no limit.
    pub fn of_layout(layout: &ControlLayout) -> Self {
        Self {
            load_weights: LoadWeights::Identity,
            effort_weight: 0.0,
            rate_weight: 0.0,
            flap_survival: 1.0,
            dead_flap_cost: f64::INFINITY,
            gain: 1.0,
            amplitude_limit_volt: vec![f64::INFINITY; layout.pairs()],
            rate_limit_volt: f64::INFINITY,
        }
    }

    /// The step without its limits of the controls of a layout.
    pub fn step(&self, layout: &ControlLayout) -> RelaxedStep {
        RelaxedStep {
            rho: self.effort_weight,
            rate_weight: self.rate_weight,
            gain: self.gain,
            flap_survival: self.flap_survival,
            controls_of_flap: layout.len() / layout.flaps(),
        }
    }
}

/// One step of control a cycle, from T and the loads.
///
/// ```text
/// J   = E(Z'WZ)/q + rho u'u + du' S du,   Z = Z_here + T du,   E over which flaps act, each with the chance q:
///       the blocks of T'WT between two flaps are multiplied by q
/// u   <-  u_here + min(g, c) ( u~ - u_here ),   c: the largest change is at most the rate
/// u~:     argmin J  over |u_p| <= U_p, moved as little as need be toward that of q = 0, so that no flap that stops leaves more than
///         `dead_flap_cost` times J of zero control
/// ```
/// - Without a limit that binds, `du = -g (T'WT + rho I + S)^-1 (T'W Z + rho u)`.
/// - The optimum keeps the amplitudes; it is never a clipped one. The rate only shortens the step: every part of the way
///   to an optimum of a convex cost lowers it.
/// - *Start without a bump.* The control goes on from whatever acts ([`Self::engage`]).
/// - *A load is lost*: its weight is 0. *A flap is lost*: its columns are left out, its voltage makes nothing of the loads
///   that are measured, and goes to 0 within the rate. The others do not wait for that.
///
/// Source: W. Johnson, NASA TP-1996 (1982), with the rate term and without (deterministic controllers); J. Shaw,
/// *Higher harmonic blade pitch control for helicopter vibration reduction* (1980); D. Patt, L. Liu, P. Friedmann, J.
/// American Helicopter Society 50 (2005) for the relaxed step. The limits are this project's.
#[derive(Debug, Clone)]
pub struct RelaxedController {
    settings: RelaxedSettings,
    weights: Vec<f64>,
    is_load_lost: Vec<bool>,
    is_flap_lost: Vec<bool>,
    pairs_of_flap: usize,
    control_volt: Vec<f64>,
    /// Where the last step led; the next search starts there.
    target: DVector<f64>,
    /// Where the step goes, so that a flap that stops can be borne.
    aim: DVector<f64>,
    /// The optimum of flaps that each count on themselves alone, the way to it, and zero control.
    alone: DVector<f64>,
    way: DVector<f64>,
    still: DVector<f64>,
    program: DiscProgram,
    weighted: DMatrix<f64>,
    loads: DVector<f64>,
    is_limited: bool,
}

impl RelaxedController {
    /// A controller at zero control of `loads` loads.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::OutOfRange`] of the settings.
    pub fn new(
        layout: &ControlLayout,
        loads: usize,
        settings: RelaxedSettings,
    ) -> Result<Self, ControlError> {
        error::check_not_negative("control weight rho (1/V^2)", settings.effort_weight)?;
        error::check_not_negative("rate weight (1/V^2)", settings.rate_weight)?;
        error::check_gain(settings.gain)?;
        error::check_chance(settings.flap_survival)?;
        let (least, most) = (settings.dead_flap_cost >= 1.0, settings.dead_flap_cost);
        let what = "cost that a flap that stops may leave, over that of zero control";
        error::check_range(least, what, most, "1 or above, infinity for none")?;
        let limits = &settings.amplitude_limit_volt;
        error::check_length("amplitude limits", limits.len(), layout.pairs())?;
        for &limit in limits.iter().chain([&settings.rate_limit_volt]) {
            let what = "limit of amplitude or rate (V)";
            error::check_range(limit > 0.0, what, limit, "above 0, infinity for none")?;
        }
        let size = layout.len();
        Ok(Self {
            weights: settings.load_weights.diagonal(loads)?,
            is_load_lost: vec![false; loads],
            is_flap_lost: vec![false; layout.flaps()],
            pairs_of_flap: layout.harmonics().len(),
            control_volt: layout.zero(),
            target: DVector::zeros(size),
            aim: DVector::zeros(size),
            alone: DVector::zeros(size),
            way: DVector::zeros(size),
            still: DVector::zeros(size),
            program: DiscProgram::new(settings.amplitude_limit_volt.clone()),
            weighted: DMatrix::zeros(loads, size),
            loads: DVector::zeros(loads),
            is_limited: false,
            settings,
        })
    }

    /// Goes on from the control (volt) that acts.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`].
    pub fn engage(&mut self, control_volt: &[f64]) -> Result<(), ControlError> {
        error::check_vector("control vector (volt)", control_volt, self.control_volt.len())?;
        self.control_volt.copy_from_slice(control_volt);
        // the search starts there, inside the discs
        for (pair, radius) in self.program.radius.iter().enumerate() {
            let here = &control_volt[2 * pair..2 * pair + 2];
            let share = (radius / here[0].hypot(here[1]).max(f64::MIN_POSITIVE)).min(1.0);
            self.target[2 * pair] = share * here[0];
            self.target[2 * pair + 1] = share * here[1];
        }
        Ok(())
    }

    /// The next control, volt, from T (1/V) and the loads at the present control, measured or estimated.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`]; the control then stays.
    pub fn step(&mut self, t: &TMatrix, outputs: &[f64]) -> Result<&[f64], ControlError> {
        let size = self.control_volt.len();
        error::check_length("controls of the T matrix", t.controls(), size)?;
        error::check_length("loads of the T matrix", t.loads(), self.weights.len())?;
        check_outputs(outputs, &self.is_load_lost)?;
        self.form(t, outputs);
        self.is_limited = self.program.solve(&mut self.target);
        self.bear_a_dead_flap(t);
        // flaps that are lost go to 0 apart: the others do not wait for them
        let shares = [false, true].map(|is_lost| self.share(is_lost));
        for (k, to) in self.aim.iter().enumerate() {
            let is_lost = self.is_flap_lost[k / (2 * self.pairs_of_flap)];
            self.control_volt[k] += shares[usize::from(is_lost)] * (to - self.control_volt[k]);
        }
        Ok(&self.control_volt)
    }

    /// Where the step goes: to the optimum, or as near to it as no flap that stops leaves more than the limit.
    ///
    /// It turns toward the optimum of flaps that each count on themselves alone, as far as needed. Of three flaps and more that may
    /// not be enough: then toward zero control.
    fn bear_a_dead_flap(&mut self, t: &TMatrix) {
        self.aim.copy_from(&self.target);
        let loads = self.loads.as_slice();
        let at_rest: f64 = loads.iter().enumerate().map(|(i, z)| self.weight(i) * z * z).sum();
        let limit = self.settings.dead_flap_cost * at_rest;
        let room = limit - at_rest;
        if !room.is_finite() || self.part_that_is_borne(t, room) >= 1.0 {
            return;
        }
        let controls_of_flap = 2 * self.pairs_of_flap;
        for (j, mut column) in self.program.normal.column_iter_mut().enumerate() {
            for (i, value) in column.iter_mut().enumerate() {
                *value *= if i / controls_of_flap == j / controls_of_flap { 1.0 } else { 0.0 };
            }
        }
        self.program.solve(&mut self.alone);
        self.way.copy_from(&self.alone);
        self.way -= &self.target;
        let mut part = 0.0_f64;
        for dead in 0..self.is_flap_lost.len() {
            let [a, b, c] = self.without(dead, t, &self.target, &self.way);
            let over = c - limit;
            if over > 0.0 {
                let part_of_it = over / ((b * b - a * over).max(0.0).sqrt() - b);
                part = part.max(if b < 0.0 { part_of_it.min(1.0) } else { 1.0 });
            }
        }
        self.aim.axpy(part, &self.way, 1.0);
        self.aim *= self.part_that_is_borne(t, room);
    }

    fn weight(&self, load: usize) -> f64 {
        if self.is_load_lost[load] { 0.0 } else { self.weights[load] }
    }

    /// `J` without a flap at the control `x + s d` over `s`: `a s^2 + 2 b s + c`.
    fn without(&self, dead: usize, t: &TMatrix, x: &DVector<f64>, d: &DVector<f64>) -> [f64; 3] {
        let (t, controls_of_flap) = (t.as_matrix(), 2 * self.pairs_of_flap);
        let [mut a, mut b, mut c] = [0.0; 3];
        for (i, z) in self.loads.iter().enumerate() {
            let (mut at, mut along) = (*z, 0.0);
            for k in (0..x.len()).filter(|k| k / controls_of_flap != dead) {
                at += t[(i, k)] * x[k];
                along += t[(i, k)] * d[k];
            }
            a += self.weight(i) * along * along;
            b += self.weight(i) * at * along;
            c += self.weight(i) * at * at;
        }
        [a, b, c]
    }

    /// The largest part of the aim, up to 1, with which `J` rises by no more than `room` whichever flap stops: a root of
    /// `a s^2 + 2 b s = room`.
    fn part_that_is_borne(&self, t: &TMatrix, room: f64) -> f64 {
        let mut part = 1.0_f64;
        for dead in 0..self.is_flap_lost.len() {
            let [a, b, _] = self.without(dead, t, &self.still, &self.aim);
            let root = (b * b + a * room).sqrt();
            if a > 0.0 {
                part = part.min(if b > 0.0 { room / (b + root) } else { (root - b) / a });
            }
        }
        part
    }

    /// Part of the way to the target that the flaps which are lost, or those which are not, go: gain and rate.
    fn share(&self, is_lost: bool) -> f64 {
        let pairs = self.aim.as_slice().chunks_exact(2).zip(self.control_volt.chunks_exact(2));
        let mut fastest = 0.0_f64;
        for (pair, (to, from)) in pairs.enumerate() {
            if self.is_flap_lost[pair / self.pairs_of_flap] == is_lost {
                fastest = fastest.max((to[0] - from[0]).hypot(to[1] - from[1]));
            }
        }
        self.settings.gain.min(self.settings.rate_limit_volt / fastest.max(f64::MIN_POSITIVE))
    }

    /// The quadratic form of the next control.
    fn form(&mut self, t: &TMatrix, outputs: &[f64]) {
        let t = t.as_matrix();
        let controls_of_flap = 2 * self.pairs_of_flap;
        let Self {
            settings,
            weights,
            is_load_lost,
            is_flap_lost,
            program,
            weighted,
            loads,
            control_volt,
            ..
        } = self;
        weighted.copy_from(t);
        loads.copy_from_slice(outputs);
        for (i, mut row) in weighted.row_iter_mut().enumerate() {
            row *= if is_load_lost[i] { 0.0 } else { weights[i] };
            loads[i] = if is_load_lost[i] { 0.0 } else { loads[i] };
        }
        program.normal.gemm_tr(1.0, t, weighted, 0.0);
        for (j, mut column) in program.normal.column_iter_mut().enumerate() {
            for (i, value) in column.iter_mut().enumerate() {
                let is_of_one = i / controls_of_flap == j / controls_of_flap;
                *value *= if is_of_one { 1.0 } else { settings.flap_survival };
            }
        }
        // J over the next control: Z at zero control of the flaps that move, and the rate about the present one
        for (k, (column, volt)) in t.column_iter().zip(control_volt.iter()).enumerate() {
            if !is_flap_lost[k / controls_of_flap] {
                loads.axpy(-volt, &column, 1.0);
            }
        }
        program.linear.gemv_tr(1.0, weighted, loads, 0.0);
        let diagonal = settings.effort_weight + settings.rate_weight;
        for (k, volt) in control_volt.iter().enumerate() {
            program.normal[(k, k)] += diagonal;
            program.linear[k] -= settings.rate_weight * volt;
        }
        for (flap, _) in is_flap_lost.iter().enumerate().filter(|(_, lost)| **lost) {
            for k in flap * controls_of_flap..(flap + 1) * controls_of_flap {
                program.normal.row_mut(k).fill(0.0);
                program.normal.column_mut(k).fill(0.0);
                program.normal[(k, k)] = 1.0;
                program.linear[k] = 0.0;
            }
        }
    }

    /// Gives a load (from 0) the weight 0, or its own again.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a load that there is not.
    pub fn set_load_lost(&mut self, load: usize, is_lost: bool) -> Result<(), ControlError> {
        set_flag(&mut self.is_load_lost, "load that is lost (from 0)", load, is_lost)
    }

    /// Leaves a flap (from 0) out, or takes it in again.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a flap that there is not.
    pub fn set_flap_lost(&mut self, flap: usize, is_lost: bool) -> Result<(), ControlError> {
        set_flag(&mut self.is_flap_lost, "flap that is lost (from 0)", flap, is_lost)
    }

    /// The control that acts, volt.
    pub fn control_volt(&self) -> &[f64] {
        &self.control_volt
    }

    /// Largest change of a harmonic in a step, volt.
    pub(super) fn rate_limit_volt(&self) -> f64 {
        self.settings.rate_limit_volt
    }

    /// Controls of a flap, positions in the control vector.
    pub(super) fn controls_of(&self, flap: usize) -> std::ops::Range<usize> {
        let width = 2 * self.pairs_of_flap;
        flap * width..(flap + 1) * width
    }

    /// Whether the last step went elsewhere than to the optimum, because a flap that stops would leave too much.
    pub fn is_held_back(&self) -> bool {
        self.aim != self.target
    }

    /// Whether a limit of an amplitude bound in the last step.
    pub fn is_limited(&self) -> bool {
        self.is_limited
    }
}

//! Every figure of a result, computed from what the result holds raw.
//!
//! ```text
//! J_Z = sum_k w_k (Z_kc^2 + Z_ks^2),      reduction = 100 (1 - J_Z / J_Z0)
//! ```
//! A run writes the figures that these functions give, and `hhc report` computes them again from the file: there
//! is no other way to them.

use crate::case::{ControlActuator, ControllerChoice, StrokeChoice};
use crate::raw::{CertificateLine, ControlRecord, EndLine, FlapRecord, Setting, loads_cost};
use crate::results::{ControlLine, FlapLine, Forecast, HistoryLine, RunResult};
use crate::study::{HingePower, cost_tolerance};
use hhc_control::{
    Controller, Cost, FLAT_STEPS, FeedbackLaw, LoadWeights, LoopEnd, TMatrix, lag_deg, lag_loss,
};
use rotor_base::{Harmonic, HarmonicSeries, RotorScales};
use rotor_response::HingeMoment;

impl RunResult {
    /// The same result with every figure computed from its raw numbers.
    #[must_use]
    pub fn refigured(&self, setting: &Setting) -> Self {
        let mut result = self.clone();
        let said = result.own_warnings(setting).len();
        // a rotor whose wake has parted is not controlled, whatever the case asks for
        let harmonics: &[_] = if self.wake_parted() { &[] } else { &setting.control.harmonics };
        let asked = harmonics.iter().flat_map(|set| {
            setting.control.actuators.iter().map(move |actuator| (set.clone(), *actuator))
        });
        let stored = self.control.iter().map(Some).chain(std::iter::repeat(None));
        result.control = asked
            .zip(stored)
            .map(|((harmonics, actuator), line)| {
                let line = ControlLine {
                    harmonics,
                    actuator: actuator.name().to_owned(),
                    ..line.cloned().unwrap_or_default()
                };
                let ideal = self
                    .control
                    .iter()
                    .find(|other| other.harmonics == line.harmonics && other.actuator == "ideal");
                line.refigured(setting, actuator, ideal)
            })
            .collect();
        result.mean_loads = self.mean_loads.map(|loads| loads.refigured(setting));
        let sets = setting.control.harmonics.iter();
        let forecasts = self.forecasts.iter().zip(sets);
        result.forecasts = forecasts
            .map(|(line, set)| Forecast { harmonics: set.clone(), ..line.refigured(setting) })
            .collect();
        crate::study::refigure_sensitivity(&mut result.sensitivity, setting);
        result.robustness = self.robustness.iter().map(|c| c.refigured(setting)).collect();
        // what they say of the control stands at the end
        result.warnings.truncate(result.warnings.len().saturating_sub(said));
        result.warnings.extend(result.own_warnings(setting));
        result
    }

    /// What a reader should know of controls that were not taken over as a whole, and of a rotor without vibration.
    fn own_warnings(&self, setting: &Setting) -> Vec<String> {
        let shares = self.control.iter().filter_map(ControlLine::share_warning);
        let still = (setting.is_still() && !self.control.is_empty()).then(|| {
            "without control the hub loads at the blade number per rev are zero to rounding: there is nothing to reduce, and percentages are left out".to_owned()
        });
        shares.chain(still).collect()
    }
}

impl ControlLine {
    /// The line with every figure computed from its raw numbers; `ideal` is the ideal actuator with the same
    /// harmonics.
    fn refigured(
        &self,
        setting: &Setting,
        actuator: ControlActuator,
        ideal: Option<&Self>,
    ) -> Self {
        let load_weights = setting.load_weights();
        let j_before = loads_cost(&load_weights, &setting.baseline);
        let j_after = loads_cost(&load_weights, &self.hub_nb_per_rev.parts());
        let history = self.refigured_history(&load_weights);
        let record = self.refigured_record(actuator, setting, &history);
        let powers = record.flaps.iter().map(|flap| hinge_power(flap, &setting.scales).given_watt);
        let means = record.flaps.iter().map(|flap| flap.flap_deg.0.mean);
        let recorded = history.iter().flat_map(|step| step.mean_flap_deg.iter().copied());
        let (motion_share, voltage_share) = self.shares(ideal);
        let taken = history.iter().map(|step| step.halvings);
        let halvings = taken.chain(record.refused.iter().map(|step| step.halvings)).sum();
        Self {
            j_before,
            j_after,
            reduction_percent: setting.reduction_percent(j_before, j_after),
            j_power: power_cost(&record),
            actuation_power_watt: powers.sum(),
            flaps: flap_lines(&self.harmonics, &record, &setting.scales),
            controller: controller_name(actuator, setting.control.controller).to_owned(),
            load_weights,
            motion_error_percent: motion_error(&self.harmonics, &record).map(|e| 100.0 * e),
            motion_share,
            voltage_share,
            within_reach: record.reach_share.map(|share| share >= 1.0),
            kkt_residual: record.optimum.as_ref().map(CertificateLine::residual),
            largest_mean_flap_deg: recorded.chain(means).fold(0.0, |m, mean| mean.abs().max(m)),
            steps: history.len().saturating_sub(1),
            halvings,
            largest_rise_percent: if setting.is_still() {
                0.0
            } else {
                largest_rise_percent(&history)
            },
            contraction: contraction(&history),
            spectral_radius: spectral_radius(&record, &load_weights),
            t_renewals: record.identified_after.len(),
            outcome: ended(actuator, &record, (&history, setting)),
            t_norm_per_volt: record.t_per_volt.iter().flatten().map(|t| t * t).sum::<f64>().sqrt(),
            // voltages taken over have the weight of those they come from
            rho_per_volt2: match (&record.end, ideal) {
                (Some(end), _) => end.rho_per_volt2,
                (None, Some(ideal)) => ideal.rho_per_volt2,
                (None, None) => self.rho_per_volt2,
            },
            stroke_limit_deg: stroke_limits_deg(&record, setting.control.stroke_limit),
            history,
            record,
            ..self.clone()
        }
    }

    /// The history: costs from loads and controls, what was asked for from the steps taken; it ends where the line
    /// does.
    fn refigured_history(&self, load_weights: &[f64; 6]) -> Vec<HistoryLine> {
        let mut history: Vec<HistoryLine> = self.history.clone();
        if let Some(last) = history.last_mut() {
            let (loads, flaps) = (self.hub_nb_per_rev.parts(), &self.record.flaps);
            for (load, found) in last.loads.iter_mut().zip(loads) {
                *load = found;
            }
            last.control_volt = controlled_volt(&self.harmonics, flaps);
            last.mean_flap_deg = flaps.iter().map(|flap| flap.flap_deg.0.mean).collect();
        }
        if let Some(start) = history.first_mut() {
            // from zero control, its cost with the weight of the end
            start.control_volt.fill(0.0);
            (start.asked_volt, start.halvings) = (0.0, 0);
            start.rho_per_volt2 =
                self.record.end.as_ref().map_or(start.rho_per_volt2, |end| end.rho_per_volt2);
        }
        let controls: Vec<Vec<f64>> =
            history.iter().map(|step| step.control_volt.clone()).collect();
        for (step, before) in history.iter_mut().skip(1).zip(&controls) {
            let taken = step.control_volt.iter().zip(before).map(|(a, b)| a - b);
            step.asked_volt = 2.0_f64.powi(step.halvings.cast_signed())
                * largest_amplitude(&taken.collect::<Vec<f64>>());
        }
        history.iter().map(|step| step.refigured(load_weights)).collect()
    }

    /// The record: the control from the voltages of the flaps, the end of the loop from T and the loads seen there.
    fn refigured_record(
        &self,
        actuator: ControlActuator,
        setting: &Setting,
        history: &[HistoryLine],
    ) -> ControlRecord {
        let mut record = self.record.clone();
        record.control_volt = controlled_volt(&self.harmonics, &record.flaps);
        let Some(end) = &record.end else { return record };
        let weights = setting.load_weights();
        let anew = law_of(&record.t_per_volt, &weights).and_then(|law| {
            let seen = match setting.control.controller {
                // what a filter makes of the loads is its own
                ControllerChoice::Adaptive if actuator != ControlActuator::Ideal => {
                    end.seen_loads.clone()
                }
                _ => history.last().map(|step| step.loads.clone()).unwrap_or_default(),
            };
            let (rho, control) = (end.rho_per_volt2, record.control_volt.as_slice());
            let optimum = match &record.optimum {
                None => None,
                Some(line) => {
                    let (hessian, linear) =
                        law.scaled_quadratic(rho, (control, &seen), line.volt).ok()?;
                    Some(CertificateLine { hessian, linear, ..line.clone() })
                }
            };
            let aim = match &optimum {
                Some(line) => line.control_volt(),
                None => law.optimum_volt(rho, control, &seen).ok()?,
            };
            let found = LoopEnd::new(&law, rho, (control, &seen), &aim).ok()?;
            // a step that nothing holds near the control is the whole one
            let held = end.next_volt < end.asked_volt * (1.0 - WHOLE);
            Some((EndLine::of(&found, held.then_some(end.next_volt), end), optimum))
        });
        // numbers that do not fit together stay, and the end with them is none
        let (end, optimum) = match anew {
            Some((end, optimum)) => (end, optimum),
            None => (EndLine::default(), record.optimum.clone()),
        };
        (record.end, record.optimum) = (Some(end), optimum);
        record
    }

    /// Part of the ideal actuator's motion that was asked of the inverse and part of its voltages that were taken
    /// over; as stored where there is no ideal actuator beside.
    fn shares(&self, ideal: Option<&Self>) -> (Option<f64>, Option<f64>) {
        let Some(ideal) = ideal else { return (self.motion_share, self.voltage_share) };
        let size = |numbers: &[f64]| numbers.iter().map(|v| v * v).sum::<f64>().sqrt();
        let part = |own: &[f64], whole: &[f64]| {
            let whole = size(whole);
            if whole > 0.0 { size(own) / whole } else { 1.0 }
        };
        let pairs = |series: &dyn Fn(&FlapRecord) -> Option<HarmonicSeries>, line: &Self| {
            let flaps: Option<Vec<_>> = line.record.flaps.iter().map(series).collect();
            flaps.map(|flaps| controlled(&line.harmonics, &flaps))
        };
        let motion = pairs(&|flap| flap.wanted_deg.as_ref().map(|w| w.0.clone()), self)
            .zip(pairs(&|flap| Some(flap.flap_deg.0.clone()), ideal))
            .map(|(wanted, whole)| part(&wanted, &whole));
        let voltage =
            self.voltage_share.map(|_| part(&self.record.control_volt, &ideal.record.control_volt));
        (self.motion_share.and(motion), voltage)
    }

    /// What a reader should know of a control that was not taken over as a whole.
    pub fn share_warning(&self) -> Option<String> {
        let (share, what) = match (self.voltage_share, self.motion_share) {
            (Some(share), _) => (
                share,
                "of the ideal actuator's voltages; all of them leave no room for the bias that centres the flap",
            ),
            (_, Some(share)) => (
                share,
                "of the size of the ideal actuator's flap motion, the best in reach; all of it takes voltages beyond the range",
            ),
            _ => return None,
        };
        (share < 1.0 - WHOLE).then(|| {
            format!("{}/rev, {}: {:.1} % {what}", self.set_name(), self.actuator, 100.0 * share)
        })
    }
}

/// What a controller knows of T, by name.
fn controller_name(actuator: ControlActuator, choice: ControllerChoice) -> &'static str {
    match (actuator, choice) {
        (ControlActuator::Ignored | ControlActuator::Inverse, _) => "none",
        (_, ControllerChoice::Local) => "local",
        (ControlActuator::Ideal, _) | (_, ControllerChoice::Global) => "global",
        (_, ControllerChoice::Adaptive) => "adaptive",
    }
}

/// The name of the end of a loop: converged where what it still asks for is within the tolerances of the case.
fn ended(
    actuator: ControlActuator,
    record: &ControlRecord,
    (history, setting): (&[HistoryLine], &Setting),
) -> String {
    let Some(end) = &record.end else { return "taken-over".to_owned() };
    let control = &setting.control;
    let step_volt = Vec::new();
    let way = match (actuator, control.controller) {
        (_, ControllerChoice::Local) => Controller::Local { step_volt },
        (ControlActuator::Ideal, _) => Controller::Global,
        (_, ControllerChoice::Global) => Controller::Renewed { step_volt, renewals: 0 },
        _ => Controller::Local { step_volt },
    };
    let tolerances = [control.step_tolerance, cost_tolerance(&way, control.effort)];
    let start_cost = history.first().map_or(0.0, |start| start.j_loads);
    let is_settled = end.loop_end().is_settled(tolerances, start_cost);
    match (is_settled, end.stopped.as_deref()) {
        (true, None) => "converged",
        (false, Some("step-limit")) if history.len() > control.max_steps => "step-limit",
        (false, Some("out-of-range")) => "out-of-range",
        (false, Some("flat")) if is_flat(end, history, tolerances[1] * start_cost) => "flat",
        (true, Some(_)) | (false, Some("stalled")) => "stalled",
        (false, _) => "not converged",
    }
    .to_owned()
}

/// Whether what a loop promises at its end and what its last steps brought are both within a fall of the cost.
fn is_flat(end: &EndLine, history: &[HistoryLine], fall: f64) -> bool {
    let costs: Vec<f64> = history.iter().map(|step| step.j_loads + step.j_control).collect();
    let last = costs.len().saturating_sub(FLAT_STEPS + 1);
    end.promise <= fall
        && costs.len() > FLAT_STEPS
        && costs[last..].windows(2).all(|pair| pair[0] - pair[1] <= fall)
}

/// Stroke limit of each harmonic, deg: as given, or what the actuator makes of the voltage that belongs to it.
fn stroke_limits_deg(record: &ControlRecord, choice: StrokeChoice) -> Vec<f64> {
    let reached = record.at_stroke_deg.iter().map(|[cosine, sine]| cosine.hypot(*sine));
    match choice {
        StrokeChoice::FromActuator => reached.collect(),
        StrokeChoice::Given { amplitude_deg } => reached.map(|_| amplitude_deg).collect(),
    }
}

/// The law of a T matrix and the weights of the hub loads; loads beyond those stand for power, of weight 1.
fn law_of(t_per_volt: &[Vec<f64>], load_weights: &[f64; 6]) -> Option<FeedbackLaw> {
    let t = TMatrix::from_columns(t_per_volt).ok()?;
    let weights: Vec<f64> = load_weights.iter().flat_map(|w| [*w, *w]).collect();
    let further = t.loads().saturating_sub(weights.len());
    let weights = weights.into_iter().chain(std::iter::repeat_n(1.0, further)).collect();
    FeedbackLaw::new(&t, &LoadWeights::Diagonal(weights)).ok()
}

/// Spectral radius of the loop with its T and weight held, about where it ended.
fn spectral_radius(record: &ControlRecord, load_weights: &[f64; 6]) -> Option<f64> {
    let there = TMatrix::from_columns(&record.t_at_end_per_volt).ok()?;
    let law = law_of(&record.t_per_volt, load_weights)?;
    law.iteration_spectral_radius(record.end.as_ref()?.rho_per_volt2, &there).ok()
}

/// The controlled voltages of flaps as a control vector, V.
fn controlled_volt(harmonics: &[usize], flaps: &[FlapRecord]) -> Vec<f64> {
    let voltages: Vec<HarmonicSeries> =
        flaps.iter().map(|flap| flap.voltage_volt.0.clone()).collect();
    controlled(harmonics, &voltages)
}

/// Largest amplitude of the harmonics of a control vector, V.
fn largest_amplitude(control_volt: &[f64]) -> f64 {
    control_volt.chunks_exact(2).map(|u| u[0].hypot(u[1])).fold(0.0, f64::max)
}

/// How far a share may be from 1 by rounding.
pub(crate) const WHOLE: f64 = 1e-12;

/// Cosines and sines of harmonics, flap by flap.
fn controlled(harmonics: &[usize], flaps: &[HarmonicSeries]) -> Vec<f64> {
    let each = flaps.iter().flat_map(|flap| harmonics.iter().map(|&n| flap.harmonic(n)));
    each.flat_map(|h| [h.cosine, h.sine]).collect()
}

/// Part of the weighted power in the cost.
fn power_cost(record: &ControlRecord) -> f64 {
    let pairs = record.control_volt.chunks_exact(2).zip(&record.power_gains_per_volt);
    pairs.map(|(u, gain)| gain * gain * (u[0] * u[0] + u[1] * u[1])).fold(0.0, |sum, j| sum + j)
}

fn hinge_power(flap: &FlapRecord, scales: &RotorScales) -> HingePower {
    let hinge = HingeMoment {
        aerodynamic: flap.aerodynamic_moment.0.clone(),
        inertial: flap.inertial_moment.0.clone(),
    };
    HingePower::new(&hinge, &flap.flap_deg.0, scales)
}

/// Largest error of a wanted flap harmonic over the largest wanted one of the flap.
fn motion_error(harmonics: &[usize], record: &ControlRecord) -> Option<f64> {
    let errors = record.flaps.iter().filter_map(|flap| {
        let wanted = &flap.wanted_deg.as_ref()?.0;
        let sizes = harmonics.iter().map(|&n| wanted.harmonic(n).amplitude());
        let size = sizes.fold(f64::MIN_POSITIVE, f64::max);
        let errors = harmonics.iter().map(|&n| {
            let (a, b) = (flap.flap_deg.0.harmonic(n), wanted.harmonic(n));
            (a.cosine - b.cosine).hypot(a.sine - b.sine) / size
        });
        Some(errors.fold(0.0, f64::max))
    });
    errors.fold(None, |worst: Option<f64>, error| Some(worst.map_or(error, |w| w.max(error))))
}

fn flap_lines(harmonics: &[usize], record: &ControlRecord, scales: &RotorScales) -> Vec<FlapLine> {
    let powers: Vec<HingePower> =
        record.flaps.iter().map(|flap| hinge_power(flap, scales)).collect();
    let each = harmonics.iter().flat_map(|&n| {
        let inboard = record.flaps.first().map(|flap| flap.flap_deg.0.harmonic(n));
        record.flaps.iter().zip(&powers).enumerate().map(move |(k, (flap, power))| {
            let (voltage, angle) = (flap.voltage_volt.0.harmonic(n), flap.flap_deg.0.harmonic(n));
            let lead = match inboard {
                Some(inboard) if k > 0 => lag_deg(angle, inboard),
                _ => 0.0,
            };
            FlapLine {
                flap: k,
                harmonic: n,
                voltage_amplitude_volt: voltage.amplitude(),
                voltage_phase_deg: voltage.phase_deg(),
                flap_phase_deg: angle.phase_deg(),
                flap_amplitude_deg: angle.amplitude(),
                lag_deg: lag_deg(voltage, angle),
                lead_over_inboard_deg: lead,
                bias_volt: flap.voltage_volt.0.mean,
                mean_flap_deg: flap.flap_deg.0.mean,
                peak_hinge_moment_newton_metre: power.peak_newton_metre,
                peak_aerodynamic_newton_metre: power.peak_aerodynamic_newton_metre,
                peak_inertial_newton_metre: power.peak_inertial_newton_metre,
                actuation_power_watt: power.given_watt,
                net_actuation_power_watt: power.net_watt,
            }
        })
    });
    each.collect()
}

impl HistoryLine {
    /// The cost of the loads as measured, those that stand for the power included, and of the control.
    fn refigured(&self, load_weights: &[f64; 6]) -> Self {
        let further = self.loads.len().saturating_sub(12);
        let weights: Vec<f64> = load_weights
            .iter()
            .flat_map(|&w| [w, w])
            .chain(std::iter::repeat_n(1.0, further))
            .collect();
        let cost = Cost::of(&self.loads, &weights, &self.control_volt, self.rho_per_volt2);
        Self { j_loads: cost.loads, j_control: cost.control, ..self.clone() }
    }
}

/// Largest rise of the cost in one step, both sides with the weight of the step, over the cost at the start,
/// percent.
fn largest_rise_percent(history: &[HistoryLine]) -> f64 {
    let Some(start) = history.first() else { return 0.0 };
    let pairs = history.iter().zip(history.iter().skip(1));
    let rises = pairs.map(|(before, after)| {
        let square: f64 = before.control_volt.iter().map(|u| u * u).sum();
        let before = before.j_loads + after.rho_per_volt2 * square;
        100.0 * (after.j_loads + after.j_control - before) / start.j_loads
    });
    rises.fold(0.0, f64::max)
}

/// Factor by which what a step asks for shrinks from step to step, the geometric mean over the whole steps that
/// a loop ends with; none of fewer than three.
fn contraction(history: &[HistoryLine]) -> Option<f64> {
    let asked: Vec<f64> = history
        .iter()
        .skip(1)
        .rev()
        .take_while(|step| step.halvings == 0)
        .map(|step| step.asked_volt)
        .collect();
    let (last, first) = (asked.first()?, asked.last()?);
    (asked.len() > 2 && *first > 0.0).then(|| (last / first).powf(1.0 / (asked.len() - 1) as f64))
}

impl Forecast {
    /// The forecast computed from its T matrices and controls; numbers that do not fit together give NaN.
    #[must_use]
    pub fn refigured(&self, setting: &Setting) -> Self {
        let made = self.computed(setting);
        made.unwrap_or_else(|| {
            let nan = f64::NAN;
            let (cone, clipped, free, lag_loss_percent) = (nan, nan, nan, nan);
            Self { lag_loss_percent, cone, clipped, free, ..self.clone() }
        })
    }

    fn computed(&self, setting: &Setting) -> Option<Self> {
        let record = &self.record;
        if record.t_per_volt.is_empty() {
            return Some(Self { harmonics: self.harmonics.clone(), ..Self::default() });
        }
        let t = TMatrix::from_columns(&record.t_per_volt).ok()?;
        let weights: Vec<f64> = setting.load_weights().into_iter().flat_map(|w| [w, w]).collect();
        let load_weights = LoadWeights::Diagonal(weights.clone());
        let law = FeedbackLaw::new(&t, &load_weights).ok()?;
        let zero = vec![0.0; t.controls()];
        let baseline = &setting.baseline;
        let free = law.optimum_volt(record.rho_per_volt2, &zero, baseline).ok()?;
        let clipped = clipped(&free, &record.stroke_volt);
        let cost = |u: &[f64]| -> Option<f64> {
            let change = t.loads_for(u).ok()?;
            let pairs = weights.iter().zip(baseline.iter().zip(change));
            Some(pairs.map(|(w, (z, dz))| w * (z + dz) * (z + dz)).sum())
        };
        let before = cost(&zero)?;
        let lags_rad: Vec<f64> = record
            .at_stroke_deg
            .iter()
            .map(|&[cosine, sine]| {
                let voltage = Harmonic { cosine: 1.0, sine: 0.0 };
                lag_deg(voltage, Harmonic { cosine, sine }).to_radians()
            })
            .collect();
        let of_pairs: Vec<f64> = lags_rad.iter().copied().cycle().take(t.controls() / 2).collect();
        let (dynamic, settled) = (&record.dynamic_t_per_volt, &record.settled_t_per_volt);
        let loss = lag_loss(&t, &load_weights, &free, &of_pairs).ok()?;
        Some(Self {
            harmonics: self.harmonics.clone(),
            lag_deg: lags_rad.iter().map(|lag| lag.to_degrees()).collect(),
            lag_loss_percent: 100.0 * loss.part,
            isotropic_loss_percent: 100.0 * loss.isotropic,
            cone: cost(&record.cone_volt)? / before,
            clipped: cost(&clipped)? / before,
            free: cost(&free)? / before,
            gain_at_step_percent: apart(dynamic, &record.gain_t_at_step_per_volt)?,
            gain_at_stroke_percent: apart(dynamic, &record.gain_t_at_stroke_per_volt)?,
            frozen_percent: apart(settled, &record.frozen_t_per_volt)?,
            reconverged_percent: match record.reconverged_t_per_volt.as_slice() {
                [] => None,
                reconverged => Some(apart(settled, reconverged)?),
            },
            record: record.clone(),
        })
    }
}

/// Distance of one T from another, over the latter, percent.
fn apart(from: &[Vec<f64>], other: &[Vec<f64>]) -> Option<f64> {
    let from = TMatrix::from_columns(from).ok()?;
    let other = TMatrix::from_columns(other).ok()?;
    Some(100.0 * other.relative_difference(&from).ok()?)
}

/// Every harmonic cut to its stroke, its phase kept: what is not done.
fn clipped(control_volt: &[f64], stroke_volt: &[f64]) -> Vec<f64> {
    let pairs = control_volt.chunks_exact(2).zip(stroke_volt.iter().cycle());
    pairs
        .flat_map(|(u, limit)| {
            let part = (limit / u[0].hypot(u[1])).min(1.0);
            [part * u[0], part * u[1]]
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{FLAT_STEPS, is_flat};
    use crate::raw::EndLine;
    use crate::results::HistoryLine;

    #[test]
    fn a_flat_end_is_told_from_the_last_costs_and_the_promise() {
        let history = |falls: &[f64]| -> Vec<HistoryLine> {
            let mut j_loads = 1.0;
            let mut lines = vec![HistoryLine { j_loads, ..HistoryLine::default() }];
            for fall in falls {
                j_loads -= fall;
                lines.push(HistoryLine { j_loads, ..HistoryLine::default() });
            }
            lines
        };
        let end = |promise: f64| EndLine { promise, ..EndLine::default() };
        let mut falls = vec![0.5];
        falls.extend([1e-6; FLAT_STEPS]);
        assert!(is_flat(&end(1e-6), &history(&falls), 1e-5));
        // a promise, or a fall among the last steps, says that it goes on
        assert!(!is_flat(&end(1e-4), &history(&falls), 1e-5));
        falls[2] = 1e-3;
        assert!(!is_flat(&end(1e-6), &history(&falls), 1e-5));
        assert!(!is_flat(&end(1e-6), &history(&[1e-6; 2]), 1e-5));
    }
}

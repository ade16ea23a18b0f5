//! The loop all controllers share.

use crate::controller::Knowledge;
use crate::stroke::{Strokes, track_effort};
use crate::{
    ControlError, ControlLayout, ControlLimits, ControlRun, ControlStep, Cost, FeedbackController,
    KktResidual, Measurement, Outcome, Plant, PlantCall, RunError, error, layout::as_harmonics,
};
use rotor_base::Harmonic;

/// Changes below a picovolt are rounding, should the optimum be no control at all.
const SMALLEST_CHANGE_VOLT: f64 = 1e-12;

/// A step no longer than this part of the step before belongs to a loop that settles.
const SETTLING: f64 = 0.8;

/// Use of the limits above which a state has left them: they move with the control, and a step that kept
/// them as they stood may not keep them as they are now.
const USAGE_LEFT: f64 = 1.0 + 1e-3;

/// Part of the starting cost below which a difference is rounding.
const COST_ROUNDING: f64 = 1e-14;

/// How the loop weights the control.
pub(crate) enum Effort<'a> {
    /// A given `rho`.
    Fixed(f64),
    /// At every step the `rho` for which the step's control has the target stroke.
    Tracked(&'a Strokes),
    /// A given `rho`, and the plant's limits.
    Cone(f64),
}

/// Where a step leads.
struct Aim {
    control_volt: Vec<f64>,
    kkt: Option<KktResidual>,
}

/// The search along one step.
#[derive(Default)]
struct Search {
    taken: Option<ControlStep>,
    shortest: Option<Cost>,
    left_range: bool,
    measurements: usize,
}

/// Where a step sets out from.
struct Departure<'a> {
    here: &'a ControlStep,
    step: &'a [f64],
    /// Largest amplitude of the step.
    asked_volt: f64,
    rho: f64,
    /// Cost without control at this `rho`.
    start_cost: f64,
    /// Whether the step leads back into limits that the state has left, whatever that costs.
    back: bool,
}

impl FeedbackController {
    /// The state before the first step, measured.
    pub(crate) fn start<P: Plant>(
        &self,
        plant: &mut P,
        start_volt: &[f64],
    ) -> Result<ControlStep, RunError<P::Error>> {
        let (_, controls) = self.law.shape();
        let layout = plant.layout();
        if layout.len() != controls {
            Err(ControlError::Length {
                what: "controls of the plant, against columns of the T matrix",
                found: layout.len(),
                expected: controls,
            })?;
        }
        layout.check(start_volt)?;
        let measurement = self.measured(plant, start_volt, &[])?;
        let cost = self.cost(&measurement, start_volt, 0.0);
        let control_volt = start_volt.to_vec();
        Ok(ControlStep { control_volt, measurement, rho: 0.0, cost, asked_volt: 0.0, halvings: 0 })
    }

    /// The loop itself, from a measured start; counts no measurement for the start.
    pub(crate) fn iterate<P: Plant>(
        &self,
        plant: &mut P,
        start: &ControlStep,
        effort: &mut Effort<'_>,
    ) -> Result<ControlRun, RunError<P::Error>> {
        let mut here = start.clone();
        let mut steps: Vec<ControlStep> = Vec::new();
        let mut measurements = 0;
        let mut kkt = None;
        let mut known = Knowledge::new(&self.controller, &self.law, start);
        let strict = self.settings.cost_tolerance > 0.0;
        let outcome = loop {
            known.refresh(plant, &here)?;
            let rho = match effort {
                Effort::Fixed(rho) | Effort::Cone(rho) => *rho,
                Effort::Tracked(strokes) => track_effort(&known, plant, strokes, &here)?,
            };
            here = self.weighed(&here, rho);
            let start_cost = self.weighed(start, rho).cost.total();
            let limits = match effort {
                Effort::Cone(_) => Some(limits_at(plant, &here.control_volt)?),
                _ => None,
            };
            let loads = &here.measurement.hub_loads;
            let aim = aim_of(&known, rho, (&here.control_volt, loads), limits.as_ref())?;
            kkt = aim.kkt.or(kkt);
            let step = difference(&aim.control_volt, &here.control_volt);
            let asked_volt = largest_amplitude(&step);
            let size =
                largest_amplitude(&aim.control_volt).max(largest_amplitude(&here.control_volt));
            if asked_volt <= (self.settings.step_tolerance * size).max(SMALLEST_CHANGE_VOLT) {
                break Outcome::Converged;
            }
            let back = match &limits {
                Some(limits) => limits.usage(&here.control_volt)? > USAGE_LEFT,
                None => false,
            };
            if strict
                && !back
                && known.promise(rho, &here, &aim.control_volt)?
                    <= self.settings.cost_tolerance * start_cost
            {
                break Outcome::Converged;
            }
            if steps.len() >= self.settings.max_steps {
                break Outcome::StepLimit;
            }
            let history =
                || -> Vec<ControlStep> { std::iter::once(start).chain(&steps).cloned().collect() };
            let from = Departure { here: &here, step: &step, asked_volt, rho, start_cost, back };
            let search = self.search(plant, &mut known, &from, (limits.as_ref(), &history))?;
            measurements += search.measurements;
            if let Some(step) = search.taken {
                let fall = here.cost.total() - step.cost.total();
                // a part of a step that brings little does not say that the whole would not
                let whole = step.halvings == 0;
                steps.push(step.clone());
                here = step;
                if strict && whole && !back && fall <= self.settings.cost_tolerance * start_cost {
                    break Outcome::Converged;
                }
                continue;
            }
            if known.learn(plant, &here, &aim.control_volt)? {
                continue;
            }
            if !steps.is_empty() {
                break if search.left_range { Outcome::OutOfRange } else { Outcome::Stalled };
            }
            let divisor = 1_u64 << self.settings.max_halvings;
            let history = vec![here.clone()];
            Err(match search.shortest {
                Some(shortest) => {
                    let start = here.cost;
                    ControlError::Diverges { rho, divisor, start, shortest, history }
                }
                None => ControlError::NotAdmitted { rho, divisor, history },
            })?;
        };
        Ok(ControlRun {
            rho: here.rho,
            outcome,
            start: self.weighed(start, here.rho),
            steps,
            measurements: measurements + known.measurements,
            identifications: known.identifications,
            t: known.t()?,
            kkt,
        })
    }

    /// The step or the longest part of it, halved and halved again, that lowers the cost.
    fn search<P: Plant>(
        &self,
        plant: &mut P,
        known: &mut Knowledge<'_>,
        from: &Departure<'_>,
        (limits, history): (Option<&ControlLimits>, &dyn Fn() -> Vec<ControlStep>),
    ) -> Result<Search, RunError<P::Error>> {
        let Departure { here, step, asked_volt, rho, start_cost, back } = *from;
        let strict = self.settings.cost_tolerance > 0.0;
        let mut search = Search::default();
        for halvings in 0..=self.settings.max_halvings {
            let part = 0.5_f64.powi(halvings.cast_signed());
            let control_volt: Vec<f64> =
                here.control_volt.iter().zip(step).map(|(u, d)| u + part * d).collect();
            if !plant.admits(&control_volt) {
                search.left_range = true;
                continue;
            }
            let measurement = self.measured(plant, &control_volt, &history())?;
            search.measurements += 1;
            known.observe(&control_volt, &measurement.hub_loads);
            let cost = self.cost(&measurement, &control_volt, rho);
            let rise = (cost.total() - here.cost.total()) / start_cost;
            let settles = || -> Result<bool, ControlError> {
                let there = (control_volt.as_slice(), measurement.hub_loads.as_slice());
                let next = aim_of(known, rho, there, limits)?.control_volt;
                Ok(largest_amplitude(&difference(&next, &control_volt)) <= SETTLING * asked_volt)
            };
            let allowed = !strict && halvings == 0 && rise <= self.settings.cost_rise_allowance;
            if back || rise <= COST_ROUNDING || (allowed && settles()?) {
                search.taken = Some(ControlStep {
                    control_volt,
                    measurement,
                    rho,
                    cost,
                    asked_volt,
                    halvings,
                });
                break;
            }
            search.shortest = Some(cost);
        }
        Ok(search)
    }

    /// One checked measurement.
    fn measured<P: Plant>(
        &self,
        plant: &mut P,
        control_volt: &[f64],
        history: &[ControlStep],
    ) -> Result<Measurement, RunError<P::Error>> {
        let measurement = plant.measure(control_volt).map_err(|source| RunError::Plant {
            call: PlantCall::Measure { control_volt: control_volt.to_vec() },
            history: history.to_vec(),
            source,
        })?;
        let (loads, _) = self.law.shape();
        error::check_vector("measured hub loads", &measurement.hub_loads, loads)?;
        let layout: &ControlLayout = plant.layout();
        if measurement.flap_motion_deg.len() != layout.pairs() {
            Err(ControlError::Length {
                what: "measured flap harmonics",
                found: measurement.flap_motion_deg.len(),
                expected: layout.pairs(),
            })?;
        }
        error::check_vector("mean flap angle (deg)", &measurement.mean_flap_deg, layout.flaps())?;
        Ok(measurement)
    }

    fn cost(&self, measurement: &Measurement, control_volt: &[f64], rho: f64) -> Cost {
        Cost::of(&measurement.hub_loads, self.law.load_weights(), control_volt, rho)
    }

    /// The same state with its cost formed with another weight.
    fn weighed(&self, step: &ControlStep, rho: f64) -> ControlStep {
        let cost = self.cost(&step.measurement, &step.control_volt, rho);
        ControlStep { rho, cost, ..step.clone() }
    }
}

/// Largest amplitude of the harmonics of a control vector, volt.
fn largest_amplitude(control_volt: &[f64]) -> f64 {
    as_harmonics(control_volt).iter().map(Harmonic::amplitude).fold(0.0, f64::max)
}

fn difference(to: &[f64], from: &[f64]) -> Vec<f64> {
    to.iter().zip(from).map(|(a, b)| a - b).collect()
}

/// The control the law aims at from a measured state `(u, Z)`.
fn aim_of(
    known: &Knowledge<'_>,
    rho: f64,
    (control_volt, hub_loads): (&[f64], &[f64]),
    limits: Option<&ControlLimits>,
) -> Result<Aim, ControlError> {
    let target = known.target(control_volt, hub_loads)?;
    Ok(match limits {
        None => Aim { control_volt: known.law.optimum_of(rho, &target), kkt: None },
        Some(limits) => {
            let found = known.law.optimum_of_target_within(rho, &target, limits)?;
            Aim { control_volt: found.control_volt, kkt: Some(found.kkt) }
        }
    })
}

fn limits_at<P: Plant>(
    plant: &mut P,
    control_volt: &[f64],
) -> Result<ControlLimits, RunError<P::Error>> {
    plant.limits(control_volt).map_err(|source| RunError::Plant {
        call: PlantCall::Limits { control_volt: control_volt.to_vec() },
        history: Vec::new(),
        source,
    })
}

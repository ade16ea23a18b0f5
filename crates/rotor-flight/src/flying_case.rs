//! A case ready to be flown: its rotor along the schedule, its actuator, its flights.

use crate::case_flight::{flight_of, flown_path_of, guidance_of, last_disturbance_s, ranged};
use crate::{
    Flight, FlightError, FlightPoint, FlightSummary, FlownCase, FlownController, RotorPath, fly,
};
use preisach_dyn::ActuatorModel;
use rayon::prelude::*;
use rotor_case::{Case, FlightController, FlightValues};
use serde::Serialize;

/// Shares of the draws at which a spread is given: all but one in twenty lie below the last, and above the first.
const SHARES: [f64; 3] = [0.05, 0.5, 0.95];

/// A validated case with a flight, trimmed and linearised along its schedule.
#[derive(Debug, Clone)]
pub struct FlyingCase<'a> {
    case: &'a Case,
    values: &'a FlightValues,
    path: RotorPath,
    model: ActuatorModel,
}

/// Many draws of the noise, the same for every controller.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnCase {
    /// First seed; the others follow one by one.
    pub first_seed: u64,
    /// Draws of each controller.
    pub draws: usize,
    /// In the order of the case.
    pub controllers: Vec<DrawnController>,
}

/// The draws of one controller. Of each three numbers 5, 50 and 95 % of the draws lie at or below.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DrawnController {
    /// Its name.
    pub controller: &'static str,
    /// Mean of `J / J0` over all cycles of a draw.
    pub mean_cost_ratio: [f64; 3],
    /// Largest `J / J0` of a cycle with control.
    pub worst_cost_ratio: [f64; 3],
    /// Mean over the last ten cycles.
    pub end_cost_ratio: [f64; 3],
    /// Draws with a cycle above `J0`.
    pub above_j0: usize,
    /// `J / J0` of every cycle, and the end of the cycle, s.
    pub cycles: Vec<(f64, [f64; 3])>,
}

impl<'a> FlyingCase<'a> {
    /// Trims and linearises the rotor along the schedule.
    ///
    /// # Errors
    /// [`FlightError`]: trims, the linearised rotor; a range of voltages that is none.
    pub fn new(
        case: &'a Case,
        values: &'a FlightValues,
        model: &ActuatorModel,
    ) -> Result<Self, FlightError> {
        Ok(Self { case, values, path: flown_path_of(case, values)?, model: ranged(case, model)? })
    }

    pub(crate) fn values(&self) -> &FlightValues {
        self.values
    }

    /// Whether T is known for a control of some harmonics: it is, but where T is handed in for others alone.
    pub(crate) fn knows_t_of(&self, harmonics: &[usize]) -> bool {
        self.case.control.handed_t.as_ref().is_none_or(|handed| handed.set(harmonics).is_ok())
    }

    /// The rotor along the schedule.
    pub fn path(&self) -> &RotorPath {
        &self.path
    }

    /// The flight with a control of other harmonics, per rev.
    ///
    /// # Errors
    /// As [`Self::fly`].
    pub fn flight_at(&self, harmonics: &[usize]) -> Result<Flight<'_>, FlightError> {
        let values = FlightValues { harmonics: harmonics.to_vec(), ..self.values.clone() };
        flight_of(self.case, &values, &self.path, &self.model)
    }

    /// Flies all controllers; `done` is called after each flight.
    ///
    /// # Errors
    /// [`FlightError`]: actuators, rotor, controllers.
    pub fn fly(&self, done: &(dyn Fn() + Sync)) -> Result<FlownCase, FlightError> {
        let flight = self.flight_at(&self.values.harmonics)?;
        let start = flight.rest(flight.state_at(0.0))?;
        let one = |&controller: &FlightController| {
            let points = self.flown(&flight, controller)?;
            done();
            let summary = FlightSummary::of(&points, last_disturbance_s(self.values));
            Ok(FlownController { controller: controller.name(), summary, points })
        };
        let flights =
            self.values.controllers.par_iter().map(one).collect::<Result<_, FlightError>>()?;
        Ok(FlownCase { start, flights })
    }

    fn flown(
        &self,
        flight: &Flight<'_>,
        controller: FlightController,
    ) -> Result<Vec<FlightPoint>, FlightError> {
        fly(flight, &guidance_of(controller, self.case, self.values))
    }

    /// Flies all controllers under many draws of the noise, from the seed of the case on; `done` is called after each flight.
    ///
    /// # Errors
    /// As [`Self::fly`]; [`FlightError::OutOfRange`] for no draws.
    pub fn draws(&self, draws: usize, done: &(dyn Fn() + Sync)) -> Result<DrawnCase, FlightError> {
        if draws == 0 {
            let (what, value) = ("draws of the noise", 0.0);
            return Err(FlightError::OutOfRange { what, value, expected: "1 or more" });
        }
        let flight = self.flight_at(&self.values.harmonics)?;
        let (first_seed, disturbed_s) = (flight.seed, last_disturbance_s(self.values));
        let of_controller = |&controller: &FlightController| {
            let flights = (0..draws as u64)
                .into_par_iter()
                .map(|draw| {
                    let flight = Flight { seed: first_seed + draw, ..flight.clone() };
                    let points = self.flown(&flight, controller)?;
                    done();
                    Ok(Draw::of(&points, disturbed_s))
                })
                .collect::<Result<Vec<Draw>, FlightError>>()?;
            Ok(DrawnController::of(controller.name(), &flights))
        };
        let controllers = self.values.controllers.iter().map(of_controller);
        let controllers = controllers.collect::<Result<_, FlightError>>()?;
        Ok(DrawnCase { first_seed, draws, controllers })
    }
}

/// What is kept of one flight of many: no more than the spread needs.
struct Draw {
    summary: FlightSummary,
    /// End of every cycle, s, and its `J / J0`.
    cycles: Vec<(f64, f64)>,
}

impl Draw {
    /// Of the points of a flight, one at least.
    fn of(points: &[FlightPoint], disturbed_s: f64) -> Self {
        Self {
            summary: FlightSummary::of(points, disturbed_s),
            cycles: points.iter().map(|point| (point.time_s, point.cost_ratio)).collect(),
        }
    }
}

impl DrawnController {
    /// Of flights, one at least, which have the same cycles.
    fn of(controller: &'static str, draws: &[Draw]) -> Self {
        let of = |part: fn(&FlightSummary) -> f64| {
            spread(draws.iter().map(|draw| part(&draw.summary)).collect())
        };
        let first = draws.first().map(|draw| draw.cycles.as_slice()).unwrap_or_default();
        let cycle = |(k, &(time_s, _)): (usize, &(f64, f64))| {
            (time_s, spread(draws.iter().map(|draw| draw.cycles[k].1).collect()))
        };
        Self {
            controller,
            mean_cost_ratio: of(|s| s.mean_cost_ratio),
            worst_cost_ratio: of(|s| s.worst_cost_ratio),
            end_cost_ratio: of(|s| s.end_cost_ratio),
            above_j0: draws.iter().filter(|draw| draw.summary.worst_cost_ratio > 1.0).count(),
            cycles: first.iter().enumerate().map(cycle).collect(),
        }
    }
}

/// What 5, 50 and 95 % of some values, one at least, lie at or below.
fn spread(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    let count = values.len();
    // the least value with so many at or below it
    SHARES.map(|share| {
        let least = (1..=count).find(|n| *n as f64 >= share * count as f64 - 1e-9);
        values[least.unwrap_or(count) - 1]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_holds_its_shares() {
        let of = |count: u32| spread((1..=count).rev().map(f64::from).collect());
        for (count, exact) in [(20, [1.0, 10.0, 19.0]), (100, [5.0, 50.0, 95.0]), (1, [1.0; 3])] {
            assert_eq!(of(count).map(f64::to_bits), exact.map(f64::to_bits));
        }
    }
}

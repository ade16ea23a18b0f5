//! What moving flaps do to the hub once the free wake has changed its shape as well.

use crate::coupling::{MIXED, at_azimuths, at_azimuths_of, felt, lines_of};
use crate::wake::WakeTrim;
use crate::wake_settings::WakeTrimSettings;
use rotor_response::{Condition, ResponseError, RotorSolution, RotorSolver};
use rotor_wake::{CirculationMap, FreeWake, FrozenWake, momentum_inflow};

/// Updates of the geometry at most.
const UPDATES: usize = 20;
/// Change of the difference of the hub loads in one update, over the difference, at which it has settled.
const TOLERANCE: f64 = 1e-3;

/// Hub loads of two conditions, each in a wake of its own, one less the other.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeDifference {
    /// Difference of the hub loads at the blade number per rev after every update; the first with the wake of the
    /// trim held still, its circulation settled.
    pub hub: Vec<[f64; 12]>,
    /// Change of that difference in the last update, over its size.
    pub change: f64,
}

impl WakeDifference {
    /// The difference after the last update.
    pub fn last(&self) -> [f64; 12] {
        self.hub.last().copied().unwrap_or([0.0; 12])
    }
}

/// A response of the rotor in a wake of its own.
struct WakeResponse<'a> {
    condition: &'a Condition,
    rotor: RotorSolution,
    wake: FreeWake,
    moving: CirculationMap,
    frozen: FrozenWake,
}

impl<'a> WakeResponse<'a> {
    /// In the wake of a trim, held still.
    fn new(
        about: &WakeTrim,
        solver: &RotorSolver,
        condition: &'a Condition,
    ) -> Result<Self, ResponseError> {
        let start = Some(&about.trim.rotor);
        let rotor = solver.clone().solve(condition, &about.frozen, start)?;
        let (wake, frozen) = (about.wake.clone(), about.frozen.clone());
        Ok(Self { condition, rotor, wake, moving: about.moving.clone(), frozen })
    }

    /// The wake moved on under the present loading, and the response in it.
    fn update(
        &mut self,
        solver: &RotorSolver,
        settings: &WakeTrimSettings,
    ) -> Result<(), ResponseError> {
        let panels = self.wake.rotor().clone();
        let (lines, circulation) = at_azimuths(
            self.moving.azimuths(),
            solver,
            &self.rotor,
            &self.condition.controls,
            &panels,
            self.wake.settings(),
        )?;
        let circulation = circulation.mixed(&self.moving, MIXED)?;
        let flight = self.condition.flight;
        let mean = momentum_inflow(&flight, self.rotor.thrust_coefficient)?;
        self.wake.set_condition(flight, mean, lines_of(&self.wake, &lines))?;
        let of_the_wake = at_azimuths_of(&self.wake, &circulation);
        self.wake.carry_on(settings.method, settings.sweeps, &of_the_wake)?;
        let induction = felt(&self.wake, lines, &circulation)?;
        self.frozen = self.frozen.moved_on(induction, &circulation)?;
        self.rotor = solver.clone().solve(self.condition, &self.frozen, Some(&self.rotor))?;
        self.moving = circulation;
        Ok(())
    }
}

/// Difference of the hub loads of two conditions near a trim, the geometry of the free wake converged anew under
/// each.
///
/// Both set out from the wake of the trim and are updated side by side, update for update in the same way, so that
/// what the trim itself has left unsettled is in both and drops out. One update is that of
/// [`crate::trim_in_free_wake`]: half of the change of the circulation, sweeps of the wake, a response in the wake
/// held still whose inflow follows the circulation at once. Pilot controls are those of the conditions.
///
/// # Errors
/// Those of the response and of the wake, which may run away.
pub fn wake_difference(
    about: &WakeTrim,
    solver: &RotorSolver,
    coupling: &WakeTrimSettings,
    [plus, minus]: [&Condition; 2],
) -> Result<WakeDifference, ResponseError> {
    let blades = solver.rotor().model().blades;
    let mut plus = WakeResponse::new(about, solver, plus)?;
    let mut minus = WakeResponse::new(about, solver, minus)?;
    let difference = |plus: &WakeResponse, minus: &WakeResponse| -> [f64; 12] {
        let (a, b) = (plus.rotor.hub.harmonic(blades), minus.rotor.hub.harmonic(blades));
        std::array::from_fn(|k| a[k] - b[k])
    };
    let size = |z: &[f64; 12]| z.iter().map(|v| v * v).sum::<f64>().sqrt();
    let mut found = WakeDifference { hub: vec![difference(&plus, &minus)], change: f64::INFINITY };
    for _ in 0..UPDATES {
        plus.update(solver, coupling)?;
        minus.update(solver, coupling)?;
        let (before, here) = (found.last(), difference(&plus, &minus));
        let moved: [f64; 12] = std::array::from_fn(|k| here[k] - before[k]);
        found.hub.push(here);
        found.change = size(&moved) / size(&here).max(f64::MIN_POSITIVE);
        if found.change <= TOLERANCE {
            break;
        }
    }
    Ok(found)
}

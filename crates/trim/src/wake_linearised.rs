//! The linearised rotor with the whole answer of its free wake: circulation and geometry.
//!
//! ```text
//! dlambda = A dGamma + h(dGamma, dq),     h = d(A Gamma) by the geometry that circulation and blade motion move
//! S: flap motion, inflow from elsewhere -> dZ, dGamma, dq        the rotor linearised in its wake held still
//!
//! dZ = S(delta, 0) + S(0, h_1) + S(0, h_2) + ...,     h_1 = h S(delta, 0),   h_k+1 = h S(0, h_k)
//! ```
//! The geometry answers by a few percent of what the circulation does, so that the series falls by as much from term to
//! term.

use crate::coupling::{at_azimuths_of, axial_as_the_wake, felt, lines_of};
use crate::wake::WakeTrim;
use crate::wake_settings::WakeTrimSettings;
use rayon::prelude::*;
use rotor_response::{
    Condition, Disturbance, FlapDirection, HubSensitivity, InflowState, ResponseError, RotorSolver,
};
use rotor_wake::{
    BladeLines, CirculationMap, FreeWake, InducedInflow, InflowModel, RotorLoading, momentum_inflow,
};

/// Updates of the geometry at most.
const UPDATES: usize = 12;
/// Sweeps of the wake, or revolutions of its march, per update.
const SWEEPS: usize = 1;
/// Change in one update of what the geometry adds to the inflow, over its size, at which it has settled.
const GEOMETRY_TOLERANCE: f64 = 5e-2;
/// Terms of the series at most.
const TERMS: usize = 6;
/// Size of a term of the series, over the first, at which it ends: the next one is smaller by an order.
const TERM_TOLERANCE: f64 = 1e-2;

/// Derivatives of the hub loads with the free wake answering, and how they were reached.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeLinearised {
    /// One change of the hub loads at the blade number per rev per direction, per unit of it.
    pub hub: Vec<[f64; 12]>,
    /// The same with the geometry of the wake held, its circulation settled.
    pub held: Vec<[f64; 12]>,
    /// Updates of the geometry that the slowest direction took.
    pub updates: usize,
    /// Size of the last term of the series over the first, largest.
    pub change: f64,
}

/// A wake on its way, and the inflow of its circulation in it: blades and circulation at the azimuths of the sections.
struct Moved {
    wake: FreeWake,
    lines: BladeLines,
    circulation: CirculationMap,
    inflow: Vec<f64>,
}

impl Moved {
    /// The geometry after one more update.
    fn update(&mut self, settings: &WakeTrimSettings) -> Result<(), ResponseError> {
        let of_the_wake = at_azimuths_of(&self.wake, &self.circulation);
        self.wake.carry_on(settings.method, SWEEPS, &of_the_wake)?;
        let induction = felt(&self.wake, self.lines.clone(), &self.circulation)?;
        self.inflow = InducedInflow::Map(induction.inflow(&self.circulation)?).parameters();
        Ok(())
    }
}

/// What the geometry makes of one change.
struct Geometry {
    /// With the step of the change added and taken away.
    moved: [Moved; 2],
    /// Change of the inflow that it adds.
    added: Vec<f64>,
    updates: usize,
}

/// The trim whose wake is moved.
struct Base<'a> {
    about: &'a WakeTrim,
    solver: &'a RotorSolver,
    settings: &'a WakeTrimSettings,
    condition: &'a Condition,
    /// Step of the differences of the wake, units of a direction.
    step: f64,
}

fn size(values: &[f64]) -> f64 {
    values.iter().map(|v| v * v).sum::<f64>().sqrt()
}

impl Base<'_> {
    /// The wake of the trim under the circulation and the motion that a part of a change makes of its own.
    fn moved(&self, change: &HubSensitivity, part: f64) -> Result<Option<Moved>, ResponseError> {
        let Some(drive) = &change.drive else { return Ok(None) };
        let Self { about, solver, condition, .. } = self;
        let (rotor, settings) = (&about.trim.rotor, about.wake.settings());
        let (panels, azimuths) = (about.wake.rotor().clone(), about.moving.azimuths());
        let circulation = solver.circulation(rotor, &panels, azimuths)?;
        let pairs = circulation.values().iter().zip(&drive.circulation);
        let values = pairs.map(|(value, change)| value + part * change).collect();
        let circulation = CirculationMap::new(panels.panels(), values)?;
        let modal = drive.moved(&rotor.modal, part);
        let lines = solver.blade_lines(&modal, &condition.controls, &panels, azimuths);
        let (lines, circulation) = axial_as_the_wake(lines, circulation, settings)?;
        let mut wake = about.wake.clone();
        let thrust = rotor.thrust_coefficient + part * change.thrust_coefficient;
        let mean = momentum_inflow(&condition.flight, thrust)?;
        wake.set_condition(condition.flight, mean, lines_of(&wake, &lines))?;
        Ok(Some(Moved { wake, lines, circulation, inflow: Vec::new() }))
    }

    /// What the geometry adds to the inflow by a change: one term of `h`; none without a circulation. Wakes with the step
    /// added and taken away are updated side by side, so that what the trim itself has left unsettled drops out.
    fn geometry(&self, change: &HubSensitivity) -> Result<Option<Geometry>, ResponseError> {
        let sides = [self.moved(change, self.step)?, self.moved(change, -self.step)?];
        let (Some(drive), [Some(plus), Some(minus)]) = (&change.drive, sides) else {
            return Ok(None);
        };
        let panels = self.about.moving.panels();
        let circulation = CirculationMap::new(panels, drive.circulation.clone())?;
        let loading = RotorLoading::from_thrust_coefficient(change.thrust_coefficient)
            .with_circulation(circulation);
        let held = self.about.frozen.induced(&self.condition.flight, &loading)?.parameters();
        let mut found = Geometry { moved: [plus, minus], added: vec![0.0; held.len()], updates: 0 };
        for update in 1..=UPDATES {
            found.updates = update;
            for side in &mut found.moved {
                side.update(self.settings)?;
            }
            let [plus, minus] = &found.moved;
            let before = std::mem::take(&mut found.added);
            let pairs = plus.inflow.iter().zip(&minus.inflow).zip(&held);
            found.added = pairs.map(|((a, b), held)| (a - b) / (2.0 * self.step) - held).collect();
            let moved: Vec<f64> = found.added.iter().zip(&before).map(|(a, b)| a - b).collect();
            if size(&moved) <= GEOMETRY_TOLERANCE * size(&found.added) {
                break;
            }
        }
        Ok(Some(found))
    }

    /// The rotor linearised along directions in the wake held still.
    fn linearised(&self, along: &[Disturbance]) -> Result<Vec<HubSensitivity>, ResponseError> {
        let at = (self.condition, &self.about.trim.rotor);
        let mut solver = self.solver.clone();
        let settled = InflowState::Settled;
        Ok(solver.linearised_along(at, &self.about.frozen, along, settled)?.sensitivities)
    }
}

/// Derivatives of the hub loads along flap motions about a trim, circulation and geometry of its free wake answering:
/// what [`crate::wake_difference`] takes differences of.
///
/// `condition` is that of the trim; pilot controls are held. Differences of the wake alone take `step` units of a
/// direction to either side: circulation peaks move from panel to panel, so that the geometry answers in small jumps.
///
/// # Errors
/// Those of the linearised response and of the wake, which may run away.
pub fn linearised_in_wake(
    about: &WakeTrim,
    solver: &RotorSolver,
    settings: &WakeTrimSettings,
    condition: &Condition,
    directions: &[FlapDirection],
    step: f64,
) -> Result<WakeLinearised, ResponseError> {
    let blades = solver.rotor().model().blades;
    let base = Base { about, solver, settings, condition, step };
    let along: Vec<Disturbance> = directions.iter().cloned().map(Disturbance::Flaps).collect();
    let mut term = base.linearised(&along)?;
    let held: Vec<[f64; 12]> = term.iter().map(|change| change.hub.harmonic(blades)).collect();
    let mut found = WakeLinearised { hub: held.clone(), held, updates: 0, change: f64::INFINITY };
    let still = vec![0.0; about.trim.rotor.inflow.parameters().len()];
    for _ in 0..TERMS {
        let geometry = term
            .par_iter()
            .map(|change| base.geometry(change))
            .collect::<Result<Vec<Option<Geometry>>, ResponseError>>()?;
        let inflows = geometry.into_iter().map(|moved| {
            found.updates = found.updates.max(moved.as_ref().map_or(0, |moved| moved.updates));
            Disturbance::Inflow(moved.map_or_else(|| still.clone(), |moved| moved.added))
        });
        let inflows: Vec<Disturbance> = inflows.collect();
        term = base.linearised(&inflows)?;
        found.change = 0.0;
        for ((sum, first), more) in found.hub.iter_mut().zip(&found.held).zip(&term) {
            let more = more.hub.harmonic(blades);
            for (sum, part) in sum.iter_mut().zip(more) {
                *sum += part;
            }
            let share = size(&more) / size(first).max(f64::MIN_POSITIVE);
            found.change = found.change.max(share);
        }
        if found.change <= TERM_TOLERANCE {
            break;
        }
    }
    Ok(found)
}

//! The updates of wake and trim that bring them together.

use crate::{
    TrimError, TrimSettings, TrimSolution, TrimTarget, WakeOutcome, WakeTrimSettings, WakeUpdate,
    trim,
};
use rotor_response::{Controls, ResponseError, RotorSolution, RotorSolver};
use rotor_wake::{
    BladeLines, CirculationMap, FreeWake, FreeWakeSettings, FrozenWake, InducedInflow, InflowModel,
    LineInduction, WakeError, WakeMethod, WakeRotor, WakeSymmetry, momentum_inflow,
};

/// Halvings of the part of a sweep that is gone, at most.
const MOST_HALVINGS: u32 = 3;
/// A change above this share of the least so far halves the part.
const LEAST_GAIN: f64 = 0.9;
/// Share of a change of circulation that moves the wake: near passages of vortices answer strongly.
pub(crate) const MIXED: f64 = 0.5;
/// Displacement of a rough sweep over the tolerance of a sweep, from which on whole ones go on.
const NEAR: f64 = 3.0;
/// Sweeps over those asked for where they go in part or the wake still moves.
const MORE_SWEEPS: usize = 3;
/// Updates without gain at the least part, after which a stage ends, unless the last one still fell from that before.
const MOST_STAGNANT: usize = 10;
/// Change of the inflow in one update, tip speed, that no rotor's wake makes: vortices and blades run away from each other.
const RUNAWAY: f64 = 0.3;
/// Change of the inflow, tip speed, above which a state is not kept as a good one.
const TRUSTED: f64 = 0.1;
/// Updates in turn that may fail, each with half of the part before.
const FAILURES: usize = 3;

/// Lifting lines and circulation of a response at uniform azimuths; in an axial wake, those that turn with the blades.
pub(crate) fn at_azimuths(
    azimuths: usize,
    solver: &RotorSolver,
    response: &RotorSolution,
    controls: &Controls,
    panels: &WakeRotor,
    settings: &FreeWakeSettings,
) -> Result<(BladeLines, CirculationMap), ResponseError> {
    let lines = solver.blade_lines(&response.modal, controls, panels, azimuths);
    let circulation = solver.circulation(response, panels, azimuths)?;
    axial_as_the_wake(lines, circulation, settings)
}

/// A circulation on the grid of a wake, from azimuths that are a multiple of it.
pub(crate) fn at_azimuths_of(wake: &FreeWake, circulation: &CirculationMap) -> CirculationMap {
    circulation.at_every(circulation.azimuths() / wake.settings().azimuths)
}

/// Lifting lines on the grid of a wake, from azimuths that are a multiple of it.
pub(crate) fn lines_of(wake: &FreeWake, lines: &BladeLines) -> BladeLines {
    lines.at_every(lines.azimuths() / wake.settings().azimuths)
}

/// What a circulation induces at the blades at its azimuths, with the geometry of the wake interpolated to them.
pub(crate) fn felt(
    wake: &FreeWake,
    lines: BladeLines,
    circulation: &CirculationMap,
) -> Result<LineInduction, WakeError> {
    let azimuths = circulation.azimuths();
    if azimuths == wake.settings().azimuths {
        return wake.line_induction(circulation);
    }
    wake.on_grid(azimuths, lines)?.line_induction(circulation)
}

/// Lines and circulation as a wake takes them: those that turn with the blades, if it is axial.
pub(crate) fn axial_as_the_wake(
    lines: BladeLines,
    circulation: CirculationMap,
    settings: &FreeWakeSettings,
) -> Result<(BladeLines, CirculationMap), ResponseError> {
    if settings.symmetry == WakeSymmetry::Periodic {
        return Ok((lines, circulation));
    }
    let lines = lines.axial()?;
    Ok((lines, circulation.axial()))
}

/// Wake and trim after an update.
#[derive(Debug, Clone)]
pub(crate) struct State {
    pub(crate) trim: TrimSolution,
    pub(crate) wake: FreeWake,
    pub(crate) frozen: FrozenWake,
    /// Circulation that moved the wake, at the azimuths at which the sections feel it.
    pub(crate) moving: CirculationMap,
    /// Largest change of the inflow that led here, tip speed.
    pub(crate) inflow_change: f64,
    /// RMS displacement of the last sweep before, unit `R`.
    pub(crate) displacement: f64,
}

/// What all updates have in common.
pub(crate) struct Coupling<'a> {
    pub(crate) solver: RotorSolver,
    pub(crate) settings: &'a WakeTrimSettings,
    pub(crate) target: &'a TrimTarget,
    pub(crate) trim_settings: TrimSettings,
    pub(crate) updates: Vec<WakeUpdate>,
    /// Share of a change of circulation that moves the wake in a whole update.
    pub(crate) share: f64,
}

impl Coupling<'_> {
    pub(crate) fn trimmed(
        &mut self,
        inflow: &dyn InflowModel,
        advance_ratio: f64,
        start: Option<&TrimSolution>,
    ) -> Result<TrimSolution, TrimError> {
        let (target, settings) = (self.target, &self.trim_settings);
        trim(&mut self.solver, inflow, advance_ratio, target, settings, start)
    }

    /// The trim in a wake held still.
    fn in_still_wake(
        &mut self,
        (wake, frozen): (FreeWake, FrozenWake),
        moving: CirculationMap,
        start: &TrimSolution,
    ) -> Result<State, TrimError> {
        let mu = start.flight.advance_ratio;
        let trim = self.trimmed(&frozen, mu, Some(start))?;
        let (inflow_change, displacement) = (f64::INFINITY, f64::INFINITY);
        Ok(State { trim, wake, frozen, moving, inflow_change, displacement })
    }

    /// The start of a stage: the wake of the stage before on a new grid, or undistorted helices.
    pub(crate) fn begin(
        &mut self,
        azimuths: usize,
        panels: &WakeRotor,
        start: &TrimSolution,
        before: Option<&FreeWake>,
    ) -> Result<State, TrimError> {
        let settings = self.settings.wake.with_azimuths(azimuths);
        let sections = self.settings.sections_of(azimuths);
        let (solver, controls) = (&self.solver, &start.controls);
        let (lines, circulation) =
            at_azimuths(sections, solver, &start.rotor, controls, panels, &settings)?;
        let of_the_wake = lines.at_every(sections / azimuths);
        let wake = if let Some(wake) = before {
            wake.on_grid(azimuths, of_the_wake)?
        } else {
            let mean = momentum_inflow(&start.flight, start.rotor.thrust_coefficient)?;
            FreeWake::undistorted(panels.clone(), settings, start.flight, mean, of_the_wake)?
        };
        let slope = self.solver.circulation_slope(controls, panels, sections);
        let frozen = FrozenWake::new(felt(&wake, lines, &circulation)?, &circulation, &slope)?;
        self.in_still_wake((wake, frozen), circulation, start)
    }

    /// The start of the last stage from a state nearby: the rotor trimmed in its wake, which is then taken over.
    pub(crate) fn begin_near(
        &mut self,
        near: State,
        panels: &WakeRotor,
    ) -> Result<State, TrimError> {
        let (mu, settings) = (near.trim.flight.advance_ratio, self.settings.wake.clone());
        let trim = self.trimmed(&near.frozen, mu, Some(&near.trim))?;
        let modal = &trim.rotor.modal;
        let lines = self.solver.blade_lines(modal, &trim.controls, panels, settings.azimuths);
        let wake = near.wake.remade(panels.clone(), settings, lines)?;
        Ok(State { trim, wake, ..near })
    }

    /// How far a state is from rest: what is left of inflow and geometry over what may be.
    fn normalised_residual(&self, state: &State) -> f64 {
        let inflow = state.inflow_change / self.settings.inflow_tolerance;
        inflow.max(state.displacement / self.settings.displacement_tolerance)
    }

    /// Updates on one grid until inflow and geometry stay, no more are allowed or nothing is gained any more.
    pub(crate) fn stage(&mut self, start: State) -> (State, WakeOutcome) {
        let azimuths = start.wake.settings().azimuths;
        // a stage that only prepares the next one need not settle as well
        let enough = if azimuths == self.settings.wake.azimuths { 1.0 } else { 10.0 };
        let first = self.updates.len();
        let mut best = start.clone();
        let mut now = start;
        let (mut halvings, mut least, mut stagnant, mut failures) = (0, f64::INFINITY, 0, 0);
        let (mut least_change, mut failure) = (f64::INFINITY, None);
        for _ in 0..self.settings.updates {
            match self.update(&now, halvings) {
                Ok(next) => {
                    let before = self.normalised_residual(&now);
                    now = next;
                    failures = 0;
                    let normalised_residual = self.normalised_residual(&now);
                    let falls = normalised_residual < LEAST_GAIN * before;
                    stagnant = if normalised_residual > LEAST_GAIN * least {
                        halvings = MOST_HALVINGS.min(halvings + 1);
                        stagnant + 1
                    } else {
                        0
                    };
                    least = least.min(normalised_residual);
                    least_change = least_change.min(now.inflow_change);
                    if now.inflow_change < TRUSTED
                        && normalised_residual < self.normalised_residual(&best)
                    {
                        best.clone_from(&now);
                    }
                    if normalised_residual <= enough {
                        return (now, WakeOutcome::Settled);
                    }
                    if stagnant >= MOST_STAGNANT && halvings == MOST_HALVINGS && !falls {
                        break;
                    }
                }
                Err(error) => {
                    failures += 1;
                    halvings = MOST_HALVINGS.min(halvings + 1);
                    if failures == FAILURES {
                        let updates = self.updates.len() - first;
                        let inflow_change = best.inflow_change;
                        return (best, WakeOutcome::Failed { updates, inflow_change, error });
                    }
                    failure = Some(error);
                }
            }
        }
        let done = &self.updates[first..];
        if least_change > TRUSTED {
            let (updates, inflow_change) = (done.len(), f64::INFINITY);
            let ran_away = || runaway(updates, least_change, TRUSTED);
            let error = failure.filter(|_| updates == 0).unwrap_or_else(ran_away);
            return (best, WakeOutcome::Failed { updates, inflow_change, error });
        }
        // the state kept is one of those the band is of
        let angles = done[done.len() / 2..].iter().map(|u| u.theta0_rad);
        let band = angles
            .chain([best.trim.controls.theta0_rad])
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], a| [low.min(a), high.max(a)]);
        let outcome = WakeOutcome::NotSettled {
            updates: done.len(),
            inflow_change: best.inflow_change,
            tolerance: enough * self.settings.inflow_tolerance,
            displacement: best.displacement,
            displacement_tolerance: enough * self.settings.displacement_tolerance,
            theta0_band_rad: band,
        };
        (best, outcome)
    }

    /// One update: the wake moved with the circulation of the trim, and the trim in it.
    fn update(&mut self, now: &State, halvings: u32) -> Result<State, TrimError> {
        let part = 0.5_f64.powf(f64::from(halvings));
        let panels = now.wake.rotor();
        let (lines, circulation) = at_azimuths(
            now.moving.azimuths(),
            &self.solver,
            &now.trim.rotor,
            &now.trim.controls,
            panels,
            now.wake.settings(),
        )?;
        let share = self.share * f64::max(part, 0.4);
        let circulation = circulation.mixed(&now.moving, share)?;
        let of_the_wake = at_azimuths_of(&now.wake, &circulation);
        let mean = momentum_inflow(&now.trim.flight, now.trim.rotor.thrust_coefficient)?;
        let mut wake = now.wake.clone();
        wake.set_condition(now.trim.flight, mean, lines_of(&now.wake, &lines))?;
        // on a new grid the wake is far from where it settles
        if now.displacement.is_infinite() && self.settings.method == WakeMethod::Relaxed {
            self.brought_near(&mut wake, &of_the_wake)?;
        }
        let (displacement, gone) = self.carried_on(&mut wake, &of_the_wake, part)?;
        let frozen = now.frozen.moved_on(felt(&wake, lines, &circulation)?, &circulation)?;
        let mut next = self.in_still_wake((wake, frozen), circulation, &now.trim)?;
        next.displacement = displacement;
        next.inflow_change = largest_change(&next.trim.rotor.inflow, &now.trim.rotor.inflow) / gone;
        if next.inflow_change > RUNAWAY {
            return Err(runaway(self.updates.len() + 1, next.inflow_change, RUNAWAY));
        }
        self.updates.push(WakeUpdate {
            azimuths: next.wake.settings().azimuths,
            displacement,
            inflow_change: next.inflow_change,
            part,
            theta0_rad: next.trim.controls.theta0_rad,
        });
        Ok(next)
    }

    /// Moves the wake on by rough sweeps while it is far from settled.
    fn brought_near(
        &self,
        wake: &mut FreeWake,
        circulation: &CirculationMap,
    ) -> Result<(), WakeError> {
        for _ in 0..MORE_SWEEPS * self.settings.sweeps {
            if wake.rough_sweep(circulation)? <= NEAR * self.settings.displacement_tolerance {
                break;
            }
        }
        Ok(())
    }

    /// Moves the wake on by the sweeps or revolutions of an update, of which it goes a part; returns the last displacement
    /// and the share of the whole way that was gone.
    fn carried_on(
        &self,
        wake: &mut FreeWake,
        circulation: &CirculationMap,
        part: f64,
    ) -> Result<(f64, f64), WakeError> {
        let (method, count) = (self.settings.method, self.settings.sweeps);
        let mut displacement = wake.carry_on_in_part(method, count, circulation, part)?;
        if method == WakeMethod::Marched {
            return Ok((displacement, part));
        }
        let mut done = count;
        while done < MORE_SWEEPS * count
            && (part < 1.0 || displacement > self.settings.displacement_tolerance)
        {
            displacement = wake.sweep_in_part(circulation, part)?;
            done += 1;
        }
        Ok((displacement, 1.0 - (1.0 - part).powf(done as f64)))
    }
}

fn runaway(update: usize, change: f64, largest: f64) -> TrimError {
    WakeError::InflowRunsAway { update, change, largest }.into()
}

fn largest_change(a: &InducedInflow, b: &InducedInflow) -> f64 {
    let (a, b) = (a.parameters(), b.parameters());
    a.iter().zip(&b).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()))
}

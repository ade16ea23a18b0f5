//! Trim and free wake together.

use crate::{TrimError, TrimSettings, TrimSolution, TrimTarget, trim};
use rotor_response::{ResponseError, ResponseTolerances, RotorSolver};
use rotor_wake::{
    BladeLines, CirculationMap, ClosestPassage, FreeWake, FreeWakeSettings, FrozenWake,
    InducedInflow, LinearInflow, WakeError, WakeMethod, WakeRotor, WakeSymmetry, momentum_inflow,
};

/// Residual of the trim between updates of the wake, over the weight.
const ROUGH_TRIM: f64 = 1e-5;
/// Mismatch of circulation and inflow between updates, tip speed.
const ROUGH_INFLOW: f64 = 1e-6;
/// Iterations allowed for the inflow of a wake, at least.
const WAKE_ITERATIONS: usize = 200;

/// How a trim is coupled with a free wake.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeTrimSettings {
    /// The wake; its azimuth steps are those of the last stage.
    pub wake: FreeWakeSettings,
    /// Spanwise panels, spread by a cosine between cut-out and tip.
    pub panels: usize,
    /// Azimuth steps of the coarser stages before.
    pub stages: Vec<usize>,
    /// Largest change of the inflow between two updates of the last stage, tip speed.
    pub inflow_tolerance: f64,
    /// Updates of the geometry allowed in each stage.
    pub updates: usize,
    /// Relaxation or march in time.
    pub method: WakeMethod,
    /// Sweeps of the wake per update, or revolutions of the march.
    pub sweeps: usize,
}

impl Default for WakeTrimSettings {
    fn default() -> Self {
        Self {
            wake: FreeWakeSettings::default(),
            panels: 20,
            stages: vec![12],
            inflow_tolerance: 2e-4,
            updates: 12,
            method: WakeMethod::default(),
            sweeps: 3,
        }
    }
}

/// One update of the geometry and the trim after it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WakeUpdate {
    /// Azimuth steps of the stage.
    pub azimuths: usize,
    /// RMS displacement of the last sweep, unit `R`.
    pub displacement: f64,
    /// Largest change of the inflow against the update before, tip speed.
    pub inflow_change: f64,
    /// Collective after it, rad.
    pub theta0_rad: f64,
}

/// How the coupling ended.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum WakeOutcome {
    /// Inflow and trim agree to the tolerance.
    Settled,
    /// The updates allowed were used up; the last state is kept.
    NotSettled {
        /// Largest change of the inflow in the last update, tip speed.
        inflow_change: f64,
    },
    /// The wake ran away; the state before is kept.
    WakeFailed(WakeError),
}

/// A trimmed rotor in its free wake.
#[derive(Debug, Clone)]
pub struct WakeTrim {
    /// The trim; its inflow is that of the wake.
    pub trim: TrimSolution,
    /// The wake.
    pub wake: FreeWake,
    /// The wake held still, as an inflow model for responses near the trim.
    pub frozen: FrozenWake,
    /// How the coupling ended.
    pub outcome: WakeOutcome,
    /// Every update.
    pub updates: Vec<WakeUpdate>,
    /// Nearest approach of a tip vortex to a blade.
    pub closest_passage: Option<ClosestPassage>,
    /// Circulation that moved the wake in the last update.
    moving: CirculationMap,
}

/// Trims a rotor in its free wake, flaps at rest.
///
/// First a trim with Drees's inflow; then, stage by stage on finer grids, in turn: some sweeps of the wake
/// with the circulation and the blade motion of the trim, and a trim in the wake held still, whose inflow
/// follows the circulation at once ([`FrozenWake`]). The metric is the largest change of the inflow anywhere
/// on the disk between two updates.
///
/// # Errors
/// Those of [`trim()`], and of the wake for settings or a flight state that are none (vortex-ring state).
/// A wake that runs away or does not settle is no error: [`WakeOutcome`] says so and the last good state is
/// given.
pub fn trim_in_free_wake(
    solver: &mut RotorSolver,
    settings: &WakeTrimSettings,
    advance_ratio: f64,
    target: &TrimTarget,
    trim_settings: &TrimSettings,
) -> Result<WakeTrim, TrimError> {
    let model = solver.rotor().model();
    let (chord, cutout, blades) = (model.chord, model.root_cutout, model.blades);
    let wrong = |source: WakeError| TrimError::from(ResponseError::from(source));
    let panels = WakeRotor::cosine(blades, cutout, settings.panels).map_err(wrong)?;
    settings.wake.validate(blades).map_err(wrong)?;
    // between updates the trim need not be better than the wake
    let final_settings = *trim_settings;
    let trim_settings =
        &TrimSettings { tolerance: final_settings.tolerance.max(ROUGH_TRIM), ..final_settings };
    let exact = solver.tolerances();
    let iterations = exact.inflow_iterations.max(WAKE_ITERATIONS);
    let solver = &mut solver.with_tolerances(ResponseTolerances {
        inflow: exact.inflow.max(ROUGH_INFLOW),
        inflow_iterations: iterations,
        ..exact
    });
    let drees = trim(solver, &LinearInflow::Drees, advance_ratio, target, trim_settings, None)?;
    let mut stages = settings.stages.clone();
    stages.retain(|&n| n < settings.wake.azimuths && n.is_multiple_of(blades) && n >= 8);
    stages.push(settings.wake.azimuths);
    let mut state: Option<WakeTrim> = None;
    for azimuths in stages {
        let start = state.as_ref().map_or(&drees, |s| &s.trim);
        let (lines, circulation) =
            on_the_grid(solver, start, &panels, &settings.wake.with_azimuths(azimuths))?;
        let wake = match &state {
            Some(s) => s.wake.on_grid(azimuths, lines),
            None => FreeWake::undistorted(
                panels.clone(),
                settings.wake.with_azimuths(azimuths),
                start.flight,
                momentum_inflow(&start.flight, start.rotor.thrust_coefficient).map_err(wrong)?,
                lines,
            ),
        }
        .map_err(wrong)?;
        let induction = wake.line_induction(&circulation).map_err(wrong)?;
        let frozen =
            FrozenWake::new(induction, &circulation, chord, advance_ratio).map_err(wrong)?;
        let trimmed = trim(solver, &frozen, advance_ratio, target, trim_settings, Some(start))?;
        let updates = state.take().map_or_else(Vec::new, |s| s.updates);
        let outcome = WakeOutcome::NotSettled { inflow_change: f64::INFINITY };
        let mut stage = WakeTrim {
            trim: trimmed,
            wake,
            frozen,
            outcome,
            updates,
            closest_passage: None,
            moving: circulation,
        };
        for _ in 0..settings.updates {
            if stage.update(solver, settings, target, trim_settings)? {
                break;
            }
        }
        state = Some(stage);
    }
    let mut done = state.ok_or(TrimError::Parameter {
        field: "stages",
        value: 0.0,
        expected: "one grid at least",
    })?;
    done.closest_passage = done.wake.closest_passage();
    let mut fine =
        solver.with_tolerances(ResponseTolerances { inflow_iterations: iterations, ..exact });
    let start = Some(&done.trim);
    done.trim = trim(&mut fine, &done.frozen, advance_ratio, target, &final_settings, start)?;
    Ok(done)
}

/// Lifting lines and circulation of a trimmed rotor on the grid of a wake; in an axial wake, those that turn with the
/// blades.
fn on_the_grid(
    solver: &RotorSolver,
    trimmed: &TrimSolution,
    panels: &WakeRotor,
    settings: &FreeWakeSettings,
) -> Result<(BladeLines, CirculationMap), TrimError> {
    let lines = solver.blade_lines(&trimmed.rotor, panels, settings.azimuths);
    let circulation = solver.circulation(&trimmed.rotor, panels, settings.azimuths)?;
    if settings.symmetry == WakeSymmetry::Periodic {
        return Ok((lines, circulation));
    }
    let lines = lines.axial().map_err(ResponseError::from)?;
    Ok((lines, circulation.axial()))
}

impl WakeTrim {
    /// One update; whether the stage is over.
    fn update(
        &mut self,
        solver: &mut RotorSolver,
        settings: &WakeTrimSettings,
        target: &TrimTarget,
        trim_settings: &TrimSettings,
    ) -> Result<bool, TrimError> {
        let wrong = |source: WakeError| TrimError::from(ResponseError::from(source));
        let azimuths = self.wake.settings().azimuths;
        let panels = self.wake.rotor().clone();
        let (lines, circulation) = on_the_grid(solver, &self.trim, &panels, self.wake.settings())?;
        // half of a change at once: near passages of vortices answer strongly
        let circulation = circulation.mixed(&self.moving, 0.5).map_err(wrong)?;
        let mean = momentum_inflow(&self.trim.flight, self.trim.rotor.thrust_coefficient);
        let mut wake = self.wake.clone();
        let mut displacement = f64::INFINITY;
        let moved = mean
            .and_then(|mean| wake.set_condition(self.trim.flight, mean, lines))
            .and_then(|()| {
                displacement = wake.carry_on(settings.method, settings.sweeps, &circulation)?;
                wake.line_induction(&circulation)
            });
        let induction = match moved {
            Ok(induction) => induction,
            Err(error) => {
                self.outcome = WakeOutcome::WakeFailed(error);
                return Ok(true);
            }
        };
        let chord = solver.rotor().model().chord;
        let mu = self.trim.flight.advance_ratio;
        let frozen = FrozenWake::new(induction, &circulation, chord, mu).map_err(wrong)?;
        let trimmed = trim(solver, &frozen, mu, target, trim_settings, Some(&self.trim))?;
        let inflow_change = largest_change(&trimmed.rotor.inflow, &self.trim.rotor.inflow);
        self.updates.push(WakeUpdate {
            azimuths,
            displacement,
            inflow_change,
            theta0_rad: trimmed.controls.theta0_rad,
        });
        (self.trim, self.wake, self.frozen) = (trimmed, wake, frozen);
        self.moving = circulation;
        let last = azimuths == settings.wake.azimuths;
        // a stage that only prepares the next one need not settle as well
        let tolerance = if last { 1.0 } else { 10.0 } * settings.inflow_tolerance;
        let settled = inflow_change <= tolerance;
        self.outcome =
            if settled { WakeOutcome::Settled } else { WakeOutcome::NotSettled { inflow_change } };
        Ok(settled)
    }
}

fn largest_change(a: &InducedInflow, b: &InducedInflow) -> f64 {
    let (a, b) = (a.parameters(), b.parameters());
    a.iter().zip(&b).fold(0.0, |m: f64, (x, y)| m.max((x - y).abs()))
}

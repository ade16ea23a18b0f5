//! Trim and free wake together.

use crate::coupling::{Coupling, MIXED, State, at_azimuths_of};
use crate::{
    TrimError, TrimSettings, TrimSolution, TrimTarget, WakeOutcome, WakeTrimSettings, WakeUpdate,
    trim,
};
use rotor_response::{ResponseError, ResponseTolerances, RotorSolver};
use rotor_wake::{
    CirculationMap, ClosestPassage, FreeWake, FrozenWake, LinearInflow, WakeError, WakeMethod,
    WakeRotor, WakeSymmetry, inflow_over_momentum,
};

/// How exact trims between updates of the wake are.
#[derive(Debug, Clone, Copy)]
struct Between {
    /// Residual over the weight.
    trim: f64,
    /// Mismatch of circulation and inflow, tip speed.
    inflow: f64,
    /// Weak residual of the orbit, generalised force in rotor units.
    periodicity: f64,
}

/// Mismatch of inflow and thrust where the wake begins: at no thrust momentum theory's inflow has no slope.
const START_INFLOW: f64 = 1e-6;
/// On the grids that prepare the last one, and at its start.
const PREPARING: Between = Between { trim: 1e-6, inflow: 1e-7, periodicity: 1e-8 };
/// On the last grid. A test holds the loads at the blade number per rev against those of trims that are exact throughout.
const ON_THE_LAST: Between = Between { trim: 3e-8, inflow: 3e-9, periodicity: 3e-10 };
/// Iterations of a trim between updates: what needs more is far from any trim.
const ROUGH_ITERATIONS: usize = 12;
/// Sweeps of an update from a trim nearby: two leave a hundredth of the way.
const NEAR_SWEEPS: usize = 2;
/// Mean inflow over momentum theory's below which a wake does not carry the thrust.
const LEAST_OF_MOMENTUM: f64 = 0.2;
/// Thrust over solidity from which on that is asked.
const LEAST_LOADING: f64 = 0.01;
/// Iterations allowed for the inflow of a wake, at least.
const WAKE_ITERATIONS: usize = 200;

/// How exact all trims are: the last one, and those between updates.
#[derive(Debug, Clone, Copy)]
struct Exactness {
    response: ResponseTolerances,
    trim: TrimSettings,
    preparing: Between,
    on_the_last: Between,
}

impl Exactness {
    fn new(solver: &RotorSolver, trim: &TrimSettings) -> Self {
        let response = solver.tolerances();
        Self { response, trim: *trim, preparing: PREPARING, on_the_last: ON_THE_LAST }
    }

    /// The inflow of a wake takes more iterations.
    fn in_a_wake(&self) -> ResponseTolerances {
        let inflow_iterations = self.response.inflow_iterations.max(WAKE_ITERATIONS);
        ResponseTolerances { inflow_iterations, ..self.response }
    }

    /// Between updates a trim need not be better than the wake.
    fn between(&self, rough: Between) -> (ResponseTolerances, TrimSettings) {
        let of = self.in_a_wake();
        let periodicity = of.periodicity.max(rough.periodicity);
        let response =
            ResponseTolerances { periodicity, inflow: of.inflow.max(rough.inflow), ..of };
        let tolerance = self.trim.tolerance.max(rough.trim);
        let max_iterations = self.trim.max_iterations.min(ROUGH_ITERATIONS);
        (response, TrimSettings { tolerance, max_iterations })
    }
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
    /// Circulation that moved the wake in the last update, at the azimuths at which the sections feel it.
    pub moving: CirculationMap,
}

impl WakeTrim {
    /// Circulation that moved the wake in the last update, on its own grid.
    pub fn moving_of_the_wake(&self) -> CirculationMap {
        at_azimuths_of(&self.wake, &self.moving)
    }

    /// The state to set out from.
    fn state(&self) -> State {
        State {
            trim: self.trim.clone(),
            wake: self.wake.clone(),
            frozen: self.frozen.clone(),
            moving: self.moving.clone(),
            inflow_change: f64::INFINITY,
            displacement: f64::INFINITY,
        }
    }
}

/// Trims a rotor in its free wake, flaps at rest.
///
/// First a trim with Drees's inflow, with uniform inflow in a windmill-brake descent; then, stage by stage on finer grids, in turn: some sweeps of the wake
/// with the circulation and the blade motion of the trim, and a trim in the wake held still, whose inflow
/// follows the circulation at once ([`FrozenWake`]). Two metrics say that it has settled: the largest change of the inflow
/// anywhere on the disk between two updates, and the displacement of the wake in its last sweep.
///
/// An update that gains nothing halves the part of the way that the sweeps go, down to an eighth: a wake whose vortices pass
/// blades closely goes back and forth otherwise.
///
/// # Errors
/// Those of [`trim()`] in that inflow and in the undistorted wake, and of the wake for settings or a flight state that
/// are none (vortex-ring state). A wake that runs away, one that does not settle and one in which the rotor finds no
/// trim are no errors: [`WakeOutcome`] says so and the last good state is given; nor is one that settles on too little inflow.
pub fn trim_in_free_wake(
    solver: &mut RotorSolver,
    settings: &WakeTrimSettings,
    advance_ratio: f64,
    target: &TrimTarget,
    trim_settings: &TrimSettings,
) -> Result<WakeTrim, TrimError> {
    let exactness = Exactness::new(solver, trim_settings);
    coupled(solver, settings, advance_ratio, target, exactness, None)
}

/// The same from a trim nearby, of another rotor or in another wake at its advance ratio: on the last grid alone, from its
/// controls, motion and wake, which whole changes of the circulation move. Few updates then settle it.
///
/// # Errors
/// As [`trim_in_free_wake`], of the trim in the wake of the other one.
pub fn trim_in_free_wake_near(
    solver: &mut RotorSolver,
    settings: &WakeTrimSettings,
    near: &WakeTrim,
    target: &TrimTarget,
    trim_settings: &TrimSettings,
) -> Result<WakeTrim, TrimError> {
    let mu = near.trim.flight.advance_ratio;
    let exactness = Exactness::new(solver, trim_settings);
    coupled(solver, settings, mu, target, exactness, Some(near))
}

/// Trim and wake, from momentum theory or from a trim nearby.
fn coupled(
    solver: &mut RotorSolver,
    settings: &WakeTrimSettings,
    advance_ratio: f64,
    target: &TrimTarget,
    exactness: Exactness,
    near: Option<&WakeTrim>,
) -> Result<WakeTrim, TrimError> {
    let model = solver.rotor().model();
    let (cutout, blades) = (model.root_cutout, model.blades);
    let ends: Vec<f64> = model.flaps.iter().flat_map(|flap| [flap.start, flap.end]).collect();
    let panels = WakeRotor::through(blades, cutout, settings.panels, &ends)?;
    settings.wake.validate(blades)?;
    settings.validate_sections()?;
    let mut settings = settings.clone();
    if near.is_some() && settings.method == WakeMethod::Relaxed {
        settings.sweeps = NEAR_SWEEPS;
    }
    let settings = &settings;
    let (response, of_trim) = exactness.between(exactness.on_the_last);
    let mut coupling = Coupling {
        solver: solver.with_tolerances(response),
        settings,
        target,
        trim_settings: of_trim,
        updates: Vec::new(),
        share: if near.is_some() { 1.0 } else { MIXED },
    };
    let state = match near {
        Some(near) => {
            let begun = coupling.begin_near(near.state(), &panels)?;
            Some(coupling.stage(begun))
        }
        None => by_stages(&mut coupling, &panels, advance_ratio, exactness)?,
    };
    let Some((mut state, mut outcome)) = state else {
        let expected = "one grid at least";
        return Err(TrimError::Parameter { field: "stages", value: 0.0, expected });
    };
    // with the Newton matrix that the updates have left, which serves the responses that follow too
    *solver = coupling.solver.with_tolerances(exactness.response);
    let mut fine = solver.with_tolerances(exactness.in_a_wake());
    let last = Some(&state.trim);
    match trim(&mut fine, &state.frozen, advance_ratio, target, &exactness.trim, last) {
        Ok(trimmed) => state.trim = trimmed,
        // the reason why it has not settled comes first
        Err(_) if outcome.is_diverged() => {}
        Err(error) => {
            let (updates, inflow_change) = (coupling.updates.len(), state.inflow_change);
            outcome = WakeOutcome::Failed { updates, inflow_change, error };
        }
    }
    if let Some(of_momentum) = too_little_inflow(&state.trim, solver.rotor().model().solidity())
        && outcome == WakeOutcome::Settled
    {
        outcome = WakeOutcome::TooLittleInflow { of_momentum };
    }
    Ok(WakeTrim {
        closest_passage: state.wake.closest_passage(&at_azimuths_of(&state.wake, &state.moving))?,
        trim: state.trim,
        wake: state.wake,
        moving: state.moving,
        frozen: state.frozen,
        outcome,
        updates: coupling.updates,
    })
}

/// The mean inflow over momentum theory's where it is too little for the thrust; momentum theory says nothing of descents,
/// and a rotor with hardly any thrust may have any inflow.
fn too_little_inflow(trim: &TrimSolution, solidity: f64) -> Option<f64> {
    let (flight, thrust) = (&trim.flight, trim.rotor.thrust_coefficient);
    let of_momentum = inflow_over_momentum(flight, thrust, trim.rotor.inflow.mean())?;
    let counts = thrust.abs() >= LEAST_LOADING * solidity;
    (counts && of_momentum < LEAST_OF_MOMENTUM).then_some(of_momentum)
}

/// From momentum theory's inflow, stage by stage on finer grids.
fn by_stages(
    coupling: &mut Coupling<'_>,
    panels: &WakeRotor,
    advance_ratio: f64,
    exactness: Exactness,
) -> Result<Option<(State, WakeOutcome)>, TrimError> {
    let set = |coupling: &mut Coupling<'_>, between: Between| {
        let (response, trim_settings) = exactness.between(between);
        coupling.solver = coupling.solver.with_tolerances(response);
        coupling.trim_settings = trim_settings;
    };
    set(coupling, Between { inflow: START_INFLOW, ..exactness.preparing });
    let mut start = coupling.trimmed(&LinearInflow::Drees, advance_ratio, None).or_else(
        |error| match error {
            // the wake leaves upward: momentum theory knows its mean alone
            TrimError::Response(ResponseError::Wake(WakeError::WakeAboveDisk { .. })) => {
                coupling.trimmed(&LinearInflow::Uniform, advance_ratio, None)
            }
            error => Err(error),
        },
    )?;
    let (wake, blades) = (&coupling.settings.wake, panels.blades());
    let mut stages = coupling.settings.stages.clone();
    // an axial wake costs little, and its vortices pass the blades too closely for coarse steps
    let periodic = wake.symmetry == WakeSymmetry::Periodic;
    stages.retain(|&n| periodic && n < wake.azimuths && n.is_multiple_of(blades) && n >= 8);
    stages.push(wake.azimuths);
    let mut state: Option<(State, WakeOutcome)> = None;
    for azimuths in stages {
        set(coupling, exactness.preparing);
        let begun = coupling.begin(azimuths, panels, &start, state.as_ref().map(|s| &s.0.wake));
        let begun = match (begun, &mut state) {
            (Ok(begun), _) => begun,
            (Err(error), None) => return Err(error),
            (Err(error), Some((_, outcome))) => {
                *outcome = WakeOutcome::Failed { updates: 0, inflow_change: f64::INFINITY, error };
                break;
            }
        };
        if azimuths == wake.azimuths {
            set(coupling, exactness.on_the_last);
        }
        let (reached, outcome) = coupling.stage(begun);
        start = reached.trim.clone();
        state = Some((reached, outcome));
    }
    Ok(state)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::print_stdout, reason = "the measured differences are worth seeing")]

    use super::*;
    use crate::Vehicle;
    use nalgebra::DVector;
    use rotor_fem::{BladeProperties, BladeSpec};
    use rotor_response::{Couplings, Discretisation, Rotor, RotorModel};
    use std::sync::Arc;

    /// Trims between updates do not move the loads at the blade number per rev of the shipped rotor; as rough ones on the
    /// last grid as there were would.
    #[test]
    fn trims_between_updates_are_as_exact_as_the_loads() {
        let mu = 0.3;
        let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
        let rotor = Rotor::new(RotorModel::paper_case(), &blade, Discretisation::default());
        let rotor = Arc::new(rotor.unwrap());
        let target = TrimTarget::Propulsive { weight_ct_sigma: 0.07, vehicle: Vehicle::default() };
        let settings = WakeTrimSettings::default();
        let loads = |preparing: Between, on_the_last: Between| {
            let tolerances = ResponseTolerances::default();
            let mut solver = RotorSolver::new(Arc::clone(&rotor), mu, tolerances).unwrap();
            let usual = Exactness::new(&solver, &TrimSettings::default());
            let exactness = Exactness { preparing, on_the_last, ..usual };
            let found = coupled(&mut solver, &settings, mu, &target, exactness, None).unwrap();
            assert_eq!(found.outcome, WakeOutcome::Settled);
            DVector::from_column_slice(&found.trim.rotor.hub.harmonic(4))
        };
        let exact = Between { trim: 1e-12, inflow: 1e-11, periodicity: 1e-12 };
        let exact = loads(exact, exact);
        let apart = |loads: DVector<f64>| (loads - &exact).norm() / exact.norm();
        let usual = apart(loads(PREPARING, ON_THE_LAST));
        let before = Between { trim: 1e-5, ..PREPARING };
        let rough = apart(loads(before, before));
        println!("4/rev loads off by {usual:.1e}, by {rough:.1e} with 1e-5 on all grids");
        assert!(usual < 1e-7 && rough > 1e-7, "{usual:e} {rough:e}");
    }

    /// An inflow of a tenth of momentum theory's does not carry the thrust of a trim; that of a rotor with hardly any
    /// thrust, and of a descent, is not asked.
    #[test]
    fn an_inflow_that_does_not_carry_the_thrust_is_too_little() {
        let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
        let few =
            Discretisation { modes: [2, 1, 1], time_elements: 4, ..Discretisation::default() };
        let model = RotorModel::table_1(Couplings::Full);
        let rotor = Arc::new(Rotor::new(model, &blade, few).unwrap());
        let share = |induced_inflow: f64, (ct_sigma, shaft_tilt_rad): (f64, f64)| {
            let tolerances = ResponseTolerances::default();
            let mut solver = RotorSolver::new(Arc::clone(&rotor), 0.2, tolerances).unwrap();
            let target = TrimTarget::WindTunnel { ct_sigma, shaft_tilt_rad, hub_moments: [0.0; 2] };
            let inflow = LinearInflow::Prescribed { induced_inflow };
            let settings = TrimSettings::default();
            let found = trim(&mut solver, &inflow, 0.2, &target, &settings, None).unwrap();
            too_little_inflow(&found, rotor.model().solidity())
        };
        // momentum theory has 0.012 in level flight
        let little = share(0.0012, (0.07, 0.05)).unwrap();
        assert!((0.05..0.2).contains(&little), "{little}");
        assert_eq!(share(0.012, (0.07, 0.05)), None);
        assert_eq!(share(0.0, (0.005, 0.05)), None);
        assert_eq!(share(0.0012, (0.07, -0.05)), None);
    }
}

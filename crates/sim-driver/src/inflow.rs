//! The inflow of a case: a linear model, or a free wake settled with the trim.

use crate::SimError;
use crate::case::{
    Case, CirculationChoice, ControlPointChoice, CoreChoice, FarFieldChoice, FreeWakeFile,
    InflowChoice, LoadedCase, NearWakeChoice, ReleaseChoice, RolledUpChoice, SymmetryChoice,
    WakeMethodChoice,
};
use crate::problem::{Fault, Problem};
use crate::results::{WAKE_NOT_SETTLED, WAKE_PARTED};
use rotor_response::{ResponseTolerances, RotorSolver};
use rotor_wake::{
    ClosestPassage, ControlPoint, CoreModel, CoreSettings, FarField, FarTrailers, FlightState,
    FreeWakeSettings, FrozenWake, InducedInflow, InflowModel, LinearInflow, NearWakeMotion,
    PittPeters, ReleasePoint, RotorLoading, WAKE_BREAKDOWN_TRANSPORT, WakeError, WakeMethod,
    WakeRotor, WakeSymmetry, descent_transport, momentum_inflow,
};
use std::sync::Arc;
use trim::{
    TrimError, TrimSolution, WakeOutcome, WakeTrim, WakeTrimSettings, trim, trim_in_free_wake,
};

/// Kinematic viscosity of air at sea level, m^2/s (ISA).
const VISCOSITY_M2_S: f64 = 1.46e-5;

/// Where the sheet inboard of the tip vortex goes on as vortices, unit `R`.
const SHEET_STATIONS: [f64; 4] = [0.35, 0.5, 0.65, 0.78];

/// Iterations of circulation and inflow allowed in a free wake, at least.
const WAKE_ITERATIONS: usize = 200;

/// The inflow model that a trim has settled on.
#[derive(Debug, Clone)]
pub enum SettledInflow {
    /// Linear over the disk.
    Linear(LinearInflow),
    /// Pitt and Peters.
    PittPeters,
    /// The free wake of the trim, held still.
    FreeWake(Arc<FrozenWake>),
}

impl SettledInflow {
    fn model(&self) -> &dyn InflowModel {
        match self {
            Self::Linear(model) => model,
            Self::PittPeters => &PittPeters,
            Self::FreeWake(model) => model.as_ref(),
        }
    }
}

impl InflowModel for SettledInflow {
    fn name(&self) -> &'static str {
        self.model().name()
    }

    fn follows_loading(&self) -> bool {
        self.model().follows_loading()
    }

    fn induced(
        &self,
        flight: &FlightState,
        loading: &RotorLoading,
    ) -> Result<InducedInflow, WakeError> {
        self.model().induced(flight, loading)
    }

    fn circulation_grid(&self) -> Option<(&WakeRotor, usize)> {
        self.model().circulation_grid()
    }

    fn improved_step(&self, change: &[f64]) -> Option<Vec<f64>> {
        self.model().improved_step(change)
    }
}

/// A trim with the inflow it settled on, and the wake if there is a free one.
#[derive(Debug, Clone)]
pub struct SettledTrim {
    /// The trim.
    pub trim: TrimSolution,
    /// Its inflow.
    pub inflow: SettledInflow,
    /// The free wake.
    pub wake: Option<Arc<WakeTrim>>,
}

impl LoadedCase {
    /// Refuses to trim a rotor in the wake of a circulation that is not its own.
    ///
    /// # Errors
    /// [`SimError::Rejected`].
    pub(crate) fn refuse_prescribed_circulation(&self) -> Result<(), SimError> {
        let InflowChoice::FreeWake(FreeWakeFile {
            circulation: CirculationChoice::Prescribed(_),
            ..
        }) = self.case.inflow
        else {
            return Ok(());
        };
        let message = "a rotor is trimmed with the circulation it has: leave it out, or look at the wake alone with `hhc wake`";
        let place = self.index.place("inflow.model.circulation");
        Err(Problem::new(place, Fault::Refused { message: message.to_owned() }).into())
    }
}

impl Case {
    /// The coupling with a free wake.
    pub fn wake_trim_settings(&self, file: &FreeWakeFile) -> WakeTrimSettings {
        let speed = self.scales.tip_speed_m_s() * self.scales.radius_m();
        let far = match file.rolled_up {
            RolledUpChoice::Tip => FarTrailers::Tip,
            RolledUpChoice::TipAndRoot => FarTrailers::TipAndRoot,
            RolledUpChoice::TipRootAndFlaps => {
                FarTrailers::Stations(self.flaps.iter().flat_map(|f| [f.start, f.end]).collect())
            }
            RolledUpChoice::TipRootAndSheet => FarTrailers::Stations(SHEET_STATIONS.to_vec()),
        };
        let wake = FreeWakeSettings {
            azimuths: file.azimuths_for(self.blades),
            turns: file.turns,
            far_turns: file.far_turns_at(self.advance_ratio),
            near_wake_rad: file.near_wake_deg.to_radians(),
            near_wake_motion: match file.near_wake {
                NearWakeChoice::BladePlane => NearWakeMotion::BladePlane,
                NearWakeChoice::Convected => NearWakeMotion::Convected,
                NearWakeChoice::FollowsTip => NearWakeMotion::FollowsTip,
                NearWakeChoice::Free => NearWakeMotion::Free,
            },
            far,
            release: match file.release {
                ReleaseChoice::Station => ReleasePoint::Station,
                ReleaseChoice::Centroid => ReleasePoint::Centroid,
            },
            control_point: match file.control_point {
                ControlPointChoice::LiftingLine => ControlPoint::LiftingLine,
                ControlPointChoice::ThreeQuarterChord => ControlPoint::ThreeQuarterChord,
            },
            core: CoreSettings {
                model: match file.core {
                    CoreChoice::Vatistas => CoreModel::Vatistas,
                    CoreChoice::Corrected => CoreModel::RosenheadMoore,
                },
                radius: file.core_r,
                mutual_radius: file.mutual_core_r,
                near_radius: file.near_core_r.unwrap_or(self.rotor_model().chord),
                panel_share: file.panel_share,
                viscosity: VISCOSITY_M2_S / speed,
                ..CoreSettings::default()
            },
            symmetry: match file.symmetry {
                SymmetryChoice::Periodic => WakeSymmetry::Periodic,
                SymmetryChoice::Axial => WakeSymmetry::Axial,
            },
            far_field: match file.far_field {
                FarFieldChoice::Double => FarField::Double,
                FarFieldChoice::Single => FarField::Single,
            },
            velocity_stride: file.velocity_stride,
            ..FreeWakeSettings::default()
        };
        let usual = WakeTrimSettings::default();
        WakeTrimSettings {
            wake,
            panels: file.panels,
            // of the coarse grid before, too, the blades get whole steps
            stages: usual.stages.iter().map(|n| n.next_multiple_of(self.blades)).collect(),
            inflow_tolerance: file.tolerance,
            displacement_tolerance: file.displacement_tolerance_r,
            updates: file.updates,
            method: match file.method {
                WakeMethodChoice::Relaxed => WakeMethod::Relaxed,
                WakeMethodChoice::Marched => WakeMethod::Marched,
            },
            ..usual
        }
    }
}

/// Trims the rotor of a case in the inflow the case asks for.
///
/// # Errors
/// The errors of the trim and of the wake.
pub fn settled_trim(
    loaded: &LoadedCase,
    solver: &mut RotorSolver,
    start: Option<&TrimSolution>,
) -> Result<SettledTrim, TrimError> {
    let case = &loaded.case;
    let (mu, target, settings) = (case.advance_ratio, case.trim_target(), case.trim_settings());
    let inflow = match case.inflow {
        InflowChoice::Uniform => SettledInflow::Linear(LinearInflow::Uniform),
        InflowChoice::Drees => SettledInflow::Linear(LinearInflow::Drees),
        InflowChoice::PittPeters => SettledInflow::PittPeters,
        InflowChoice::Prescribed { lambda_i } => {
            SettledInflow::Linear(LinearInflow::Prescribed { induced_inflow: lambda_i })
        }
        InflowChoice::FreeWake(file) => {
            let coupling = case.wake_trim_settings(&file);
            let tolerances = solver.tolerances();
            let inflow_iterations = tolerances.inflow_iterations.max(WAKE_ITERATIONS);
            *solver =
                solver.with_tolerances(ResponseTolerances { inflow_iterations, ..tolerances });
            let wake = trim_in_free_wake(solver, &coupling, mu, &target, &settings)?;
            return Ok(SettledTrim {
                trim: wake.trim.clone(),
                inflow: SettledInflow::FreeWake(Arc::new(wake.frozen.clone())),
                wake: Some(Arc::new(wake)),
            });
        }
    };
    let trim = trim(solver, &inflow, mu, &target, &settings, start)?;
    Ok(SettledTrim { trim, inflow, wake: None })
}

/// What may help a wake that does not settle.
const WAKE_REMEDY: &str = "Remedy: `mutual_core_r` of 0.1, `near_core_r` of 0.1, fewer `turns`, more `updates` if all were used";

/// Mean inflow over that of momentum theory, least and most, that a rotor in its wake has.
const MOMENTUM: [f64; 2] = [0.5, 2.5];

/// Where a coupling that failed has stopped, on a grid of so many steps per revolution.
fn kept(
    azimuths: usize,
    updates: usize,
    inflow_change: f64,
    error: &dyn std::error::Error,
) -> String {
    let state = if inflow_change.is_finite() {
        format!(
            "what is given is the state of the least change of the inflow, {inflow_change:.1e} of the tip speed, on {azimuths} steps per revolution"
        )
    } else {
        format!(
            "what is given is the last state before, on {azimuths} steps per revolution: of a coarser grid if the case asks for more"
        )
    };
    format!("wake and trim part after {updates} updates: {error}; {state}. {WAKE_REMEDY}")
}

/// How the coupling with a wake ended, in a word.
pub fn wake_word(wake: &WakeTrim) -> &'static str {
    match wake.outcome {
        WakeOutcome::Settled => "settled",
        WakeOutcome::NotSettled { .. } => WAKE_NOT_SETTLED,
        _ => WAKE_PARTED,
    }
}

/// What a user should know about a wake; empty if there is nothing.
pub fn wake_warnings(wake: &WakeTrim) -> Vec<String> {
    let mut warnings = Vec::new();
    let azimuths = wake.wake.settings().azimuths;
    match &wake.outcome {
        WakeOutcome::NotSettled {
            updates,
            inflow_change,
            tolerance,
            displacement,
            displacement_tolerance,
            theta0_band_rad,
        } => {
            let [low, high] = theta0_band_rad.map(f64::to_degrees);
            warnings.push(format!(
                "the free wake has not settled in {updates} updates: the inflow still changes by {inflow_change:.1e} of the tip speed ({tolerance:.1e} was asked) and the wake moves by {displacement:.1e} R ({displacement_tolerance:.1e}) in the update kept, the nearest to rest; theta0 between {low:.3} and {high:.3} deg in it and the second half of the updates, on {azimuths} steps per revolution. {WAKE_REMEDY}"
            ));
        }
        WakeOutcome::WakeFailed { updates, inflow_change, error } => {
            warnings.push(kept(azimuths, *updates, *inflow_change, error));
        }
        WakeOutcome::TrimFailed { updates, inflow_change, error } => {
            warnings.push(kept(azimuths, *updates, *inflow_change, error));
        }
        _ => {}
    }
    let (flight, thrust) = (&wake.trim.flight, wake.trim.rotor.thrust_coefficient);
    let settled = wake.outcome == WakeOutcome::Settled;
    warnings.extend(descent_warning(flight, thrust, settled));
    warnings.extend(momentum_warning(flight, thrust, wake.trim.rotor.inflow.mean()));
    warnings.extend(wake.closest_passage.and_then(passage_warning));
    warnings
}

/// What a user should know about the wake of a descent.
pub(crate) fn descent_warning(
    flight: &FlightState,
    thrust_coefficient: f64,
    settled: bool,
) -> Option<String> {
    let transport = descent_transport(flight, thrust_coefficient)?;
    let breaks_down = transport < WAKE_BREAKDOWN_TRANSPORT;
    let state = if breaks_down { "in the" } else { "near the" };
    (breaks_down || (transport < 1.0 && !settled)).then(|| {
        format!(
            "{state} vortex-ring state: in this descent the wake is carried away with {transport:.2} of the hover induced velocity, and below {WAKE_BREAKDOWN_TRANSPORT} wakes break down and the flow is unsteady: a periodic wake stands for its mean at best. Fly faster, or descend less or much more steeply"
        )
    })
}

/// What a user should know about an inflow that does not go with the thrust.
fn momentum_warning(flight: &FlightState, thrust_coefficient: f64, mean: f64) -> Option<String> {
    if descent_transport(flight, thrust_coefficient).is_some() {
        return None;
    }
    let ratio = mean / momentum_inflow(flight, thrust_coefficient).ok()?;
    let [least, most] = MOMENTUM;
    (!(least..=most).contains(&ratio)).then(|| {
        format!(
            "the mean inflow is {ratio:.2} of momentum theory's for this thrust, {least} to {most} are usual: lightly loaded blades carry lift of both senses along the span, the wake has more than one state, and neither trim nor power can be trusted. Remedy: more thrust, or compare with inflow.model: Uniform"
        )
    })
}

/// What a user should know about a vortex that passes a blade closely.
pub(crate) fn passage_warning(passage: ClosestPassage) -> Option<String> {
    passage.within_core().then(|| {
        format!(
            "a tip vortex of age {:.0} deg passes the blade at azimuth {:.0} deg, {:.2} R, at {:.4} R, closer than its core ({:.4} R): the core radius decides the load there",
            passage.age_rad.to_degrees(),
            passage.azimuth_rad.to_degrees(),
            passage.station,
            passage.distance,
            passage.core_radius
        )
    })
}

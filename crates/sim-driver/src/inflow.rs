//! The inflow of a case: a linear model, or a free wake settled with the trim.

use crate::case::{
    Case, ControlPointChoice, CoreChoice, FreeWakeFile, InflowChoice, LoadedCase, NearWakeChoice,
    ReleaseChoice, RolledUpChoice, SymmetryChoice, WakeMethodChoice,
};
use rotor_response::{ResponseTolerances, RotorSolver};
use rotor_wake::{
    ControlPoint, CoreModel, CoreSettings, FarTrailers, FlightState, FreeWakeSettings, FrozenWake,
    InducedInflow, InflowModel, LinearInflow, NearWakeMotion, PittPeters, ReleasePoint,
    RotorLoading, WakeError, WakeMethod, WakeRotor, WakeSymmetry,
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
            azimuths: file.azimuths,
            turns: file.turns,
            far_turns: file.far_turns,
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
                near_radius: file.near_core_r,
                panel_share: file.panel_share,
                viscosity: VISCOSITY_M2_S / speed,
                ..CoreSettings::default()
            },
            symmetry: match file.symmetry {
                SymmetryChoice::Periodic => WakeSymmetry::Periodic,
                SymmetryChoice::Axial => WakeSymmetry::Axial,
            },
            ..FreeWakeSettings::default()
        };
        WakeTrimSettings {
            wake,
            panels: file.panels,
            inflow_tolerance: file.tolerance,
            updates: file.updates,
            method: match file.method {
                WakeMethodChoice::Relaxed => WakeMethod::Relaxed,
                WakeMethodChoice::Marched => WakeMethod::Marched,
            },
            ..WakeTrimSettings::default()
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

/// What a user should know about a wake; empty if there is nothing.
pub fn wake_warnings(wake: &WakeTrim) -> Vec<String> {
    let mut warnings = Vec::new();
    match &wake.outcome {
        WakeOutcome::NotSettled { inflow_change } => warnings.push(format!(
            "the free wake has not settled: the inflow still changes by {inflow_change:.1e} of the tip speed between updates; allow more updates or a larger core"
        )),
        WakeOutcome::WakeFailed(error) => warnings.push(error.to_string()),
        _ => {}
    }
    if let Some(passage) = wake.closest_passage.filter(rotor_wake::ClosestPassage::within_core) {
        warnings.push(format!(
            "a tip vortex of age {:.0} deg passes the blade at azimuth {:.0} deg, {:.2} R, at {:.4} R, closer than its core ({:.4} R): the core radius decides the load there",
            passage.age_rad.to_degrees(),
            passage.azimuth_rad.to_degrees(),
            passage.station,
            passage.distance,
            passage.core_radius
        ));
    }
    warnings
}

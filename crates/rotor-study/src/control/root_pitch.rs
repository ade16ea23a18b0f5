//! Flaps and root pitch on one rotor, compared at equal reduction of `J_Z`.

use crate::control::drives::Drives;
use crate::control::set::ControlSet;
use crate::error::StudyError;
use crate::flaps::{HingePower, PlantError};
use crate::loads::HubLoads;
use crate::plant::{RootPitchPlant, RotorPlant, angles_rad};
use crate::rotor::TrimmedRotor;
use hhc_control::{
    ControlLayout, ControlRun, Controller, FeedbackController, Plant, RunError, TMatrix,
};
use rayon::prelude::*;
use rotor_base::series::scaled;
use rotor_base::{HarmonicSeries, RotorScales};
use rotor_case::{Case, ControlActuator, EffortChoice};
use rotor_response::{HingeMoment, RotorSolution, StationLoads};
use serde::{Deserialize, Serialize};

/// Flaps and root pitch that reduce `J_Z` by the same part.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RootPitchComparison {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// `J_Z` that root pitch reaches without a limit.
    pub root_pitch_reaches: f64,
    /// `J_Z` that flaps within their stroke reach; none without flaps.
    pub flaps_reach: Option<f64>,
    /// Without control.
    pub no_control: Actuation,
    /// Flaps on ideal actuators, to the larger of the two.
    pub flaps: Option<Actuation>,
    /// Root pitch, to the same.
    pub root_pitch: Actuation,
}

/// What one actuation takes, and what it does to blade, hub and shaft.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Actuation {
    /// Motions: of every flap, root to tip, or of the root.
    pub motions: Vec<MotionHarmonic>,
    /// `J_Z`.
    pub j_z: f64,
    /// Hub loads at the blade number per rev, `m0 Omega^2 R^2` and `m0 Omega^2 R^3`.
    pub hub: HubLoads,
    /// Mean power that the actuators of one blade give, none taken back, W.
    #[serde(rename = "given_W")]
    pub given_watt: f64,
    /// Mean of their power, W.
    #[serde(rename = "net_W")]
    pub net_watt: f64,
    /// Mean power of the shaft, all blades, W.
    #[serde(rename = "shaft_W")]
    pub shaft_watt: f64,
    /// Half the peak-to-peak moments at the root of the blade, flap, lag and torsion, N m. That of torsion is what
    /// the pitch link holds.
    #[serde(rename = "root_moments_N_m")]
    pub root_moments_newton_metre: [f64; 3],
    /// Half the peak-to-peak flapwise moment where along the span it is largest outboard of a tenth of it, N m.
    #[serde(rename = "span_flap_moment_N_m")]
    pub span_flap_moment_newton_metre: f64,
}

/// One harmonic of one motion, `amplitude cos(n psi - phase)`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MotionHarmonic {
    /// Which flap, from the root and from 0; 0 for the root.
    pub actuator: usize,
    /// Per rev.
    pub harmonic: usize,
    /// deg.
    pub amplitude_deg: f64,
    /// deg.
    pub phase_deg: f64,
}

/// Part of the span inboard of which the flapwise moment is that of the root.
const NEAR_ROOT: f64 = 0.1;
/// Stations of the flapwise moment along the span.
const STATIONS: usize = 18;

/// Compares the flaps of a case, on ideal actuators within their stroke, with pitch at the root of the blades, for
/// every set of harmonics: both controlled to the same `J_Z`, the lowest that both reach. Without flaps, root pitch
/// alone.
///
/// # Errors
/// [`StudyError::Refused`] without a harmonic to control or for one that the swashplate of the case does not give;
/// [`StudyError::Control`].
pub fn compare_root_pitch(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
) -> Result<Vec<RootPitchComparison>, StudyError> {
    let refused = |message| StudyError::Refused { field: "control.harmonics".to_owned(), message };
    let sets = &case.control.harmonics;
    if sets.is_empty() {
        return Err(refused("there is none to control; give [[3]], for example".to_owned()));
    }
    if let Some(message) = sets.iter().flatten().find_map(|&n| case.beyond_swashplate(n)) {
        return Err(refused(message));
    }
    // made once before the sets run side by side; a failure is that of the set that needs it
    let _ = rotor.authority();
    let compared = |harmonics: &Vec<usize>| {
        ControlSet::new(case, rotor, drives, harmonics)?.against_root_pitch()
    };
    sets.par_iter().map(compared).collect()
}

impl ControlSet<'_> {
    fn against_root_pitch(&self) -> Result<RootPitchComparison, StudyError> {
        let by_flaps = |error| self.failed(ControlActuator::Ideal, error);
        let by_root = |source| StudyError::Control {
            harmonics: self.harmonics.to_vec(),
            actuator: "root pitch",
            source: Box::new(source),
        };
        let mut root = self.root_pitch().map_err(by_root)?;
        let mut pitched = root.controller.run(&mut root.plant, 0.0).map_err(by_root)?;
        let root_pitch_reaches = loads_cost(&pitched);
        let mut flaps_reach = None;
        let mut flaps = None;
        if !self.case.flaps.is_empty() {
            let mut plant = self.plant(ControlActuator::Ideal)?;
            let (reached, flapped) =
                self.flaps_to(&mut plant, root_pitch_reaches).map_err(by_flaps)?;
            flaps = Some(self.with_flaps(&plant, &flapped).map_err(looked_at).map_err(by_flaps)?);
            if reached > root_pitch_reaches {
                pitched = root.controller.run_to_cost(&mut root.plant, reached).map_err(by_root)?.0;
            }
            flaps_reach = Some(reached);
        }
        let root_pitch = self.with_pitch(&root.plant, &pitched);
        let trimmed = &self.rotor.trim().rotor;
        let loads = self.rotor.station_loads(&self.stations());
        let loads = loads.map_err(PlantError::from).map_err(looked_at).map_err(by_root)?;
        Ok(RootPitchComparison {
            harmonics: self.harmonics.to_vec(),
            root_pitch_reaches,
            flaps_reach,
            no_control: self.actuation(trimmed, &loads, pitched.start.cost.loads),
            flaps,
            root_pitch: root_pitch.map_err(looked_at).map_err(by_root)?,
        })
    }

    /// Root pitch with its controller.
    fn root_pitch(&self) -> Result<Controlled, RunError<PlantError>> {
        let plant = RootPitchPlant::new(self.rotor.clone(), self.harmonics)?;
        let t = plant.t_at_rest()?;
        Ok(Controlled { controller: self.constant_t(&t)?, plant })
    }

    /// Flaps within their stroke to a given `J_Z`, or as low as they come; with the lowest.
    fn flaps_to(
        &self,
        plant: &mut RotorPlant,
        loads: f64,
    ) -> Result<(f64, ControlRun), RunError<PlantError>> {
        let controller = self.constant_t(&self.t_at_rest(&plant.settled())?)?;
        let run = controller.run_within_stroke(plant)?.run;
        let reached = loads_cost(&run);
        if reached >= loads {
            return Ok((reached, run));
        }
        Ok((reached, controller.run_to_cost(plant, loads)?.0))
    }

    /// The loop of eq. (8)-(10) with a constant T: both plants are nearly linear.
    fn constant_t(&self, t: &TMatrix) -> Result<FeedbackController, RunError<PlantError>> {
        self.controller(t, Controller::Global, EffortChoice::Given { rho: 0.0 })
    }

    /// Stations whose loads are looked at, R: the root first.
    fn stations(&self) -> Vec<f64> {
        let along =
            (0..STATIONS).map(|k| NEAR_ROOT + (1.0 - NEAR_ROOT) * k as f64 / STATIONS as f64);
        let root = self.case.rotor.root_offset_r;
        std::iter::once(root).chain(along.filter(|station| *station > root)).collect()
    }

    /// Flaps at the end of a run.
    fn with_flaps(&self, plant: &RotorPlant, run: &ControlRun) -> Result<Actuation, PlantError> {
        let state = plant.state(&run.last().control_volt)?;
        let angles = angles_rad(&state.flaps);
        let loads = self.rotor.station_loads_with(angles, &state.rotor, &self.stations())?;
        let powers = state.rotor.hinge.iter().zip(&state.flaps);
        let powers: Vec<HingePower> = powers
            .map(|(hinge, flap)| HingePower::new(hinge, &flap.flap_deg, self.rotor.scales()))
            .collect();
        Ok(Actuation {
            motions: motions(run, plant.layout()),
            given_watt: powers.iter().map(|p| p.given_watt).sum(),
            net_watt: powers.iter().map(|p| p.net_watt).sum(),
            ..self.actuation(&state.rotor, &loads, run.last().cost.loads)
        })
    }

    /// Root pitch at the end of a run.
    fn with_pitch(
        &self,
        plant: &RootPitchPlant,
        run: &ControlRun,
    ) -> Result<Actuation, PlantError> {
        let control_deg = &run.last().control_volt;
        let pitch_rad = plant.pitch_rad(control_deg)?;
        let response = plant.response(control_deg)?;
        let loads = self.rotor.station_loads_pitched(&pitch_rad, &response, &self.stations())?;
        let power = root_power(&loads[0], &pitch_rad, self.rotor.scales());
        Ok(Actuation {
            motions: motions(run, plant.layout()),
            given_watt: power.given_watt,
            net_watt: power.net_watt,
            ..self.actuation(&response, &loads, run.last().cost.loads)
        })
    }

    /// Hub, shaft and blade of a response, its actuators left out.
    fn actuation(&self, response: &RotorSolution, loads: &[StationLoads], j_z: f64) -> Actuation {
        let (scales, blades) = (self.rotor.scales(), self.case.rotor.blades);
        let unit = 0.5 * scales.moment_newton_metre();
        let power_watt = scales.moment_newton_metre() * scales.omega_rad_s();
        let swings = |at: &StationLoads| at.moments.peak_to_peak().map(|swing| unit * swing);
        let outboard = loads.iter().skip(1).map(|at| swings(at)[0]);
        Actuation {
            j_z,
            hub: HubLoads::from_parts(response.hub.harmonic(blades)),
            shaft_watt: response.power.shaft * blades as f64 * power_watt,
            root_moments_newton_metre: loads.first().map_or([0.0; 3], swings),
            span_flap_moment_newton_metre: outboard.fold(0.0, f64::max),
            ..Actuation::default()
        }
    }
}

/// Root pitch with its controller.
struct Controlled {
    plant: RootPitchPlant,
    controller: FeedbackController,
}

/// The failure of a state that was reached.
fn looked_at(error: PlantError) -> RunError<PlantError> {
    RunError::plant("looked at", &[])(error)
}

/// Power of what pitches a blade at its root, from its loads there.
fn root_power(root: &StationLoads, pitch_rad: &HarmonicSeries, scales: &RotorScales) -> HingePower {
    let hinge = HingeMoment {
        aerodynamic: root.moments.harmonics[2].clone(),
        inertial: HarmonicSeries::zero(0),
    };
    HingePower::new(&hinge, &scaled(pitch_rad, 1.0_f64.to_degrees()), scales)
}

/// Motions at the end of a run.
fn motions(run: &ControlRun, layout: &ControlLayout) -> Vec<MotionHarmonic> {
    let each = run.last().measurement.flap_motion_deg.iter().enumerate();
    each.filter_map(|(pair, motion)| {
        let (actuator, harmonic) = layout.flap_and_harmonic(pair)?;
        let (amplitude_deg, phase_deg) = (motion.amplitude(), motion.phase_deg());
        Some(MotionHarmonic { actuator, harmonic: harmonic as usize, amplitude_deg, phase_deg })
    })
    .collect()
}

/// `J_Z` at the end of a run.
fn loads_cost(run: &ControlRun) -> f64 {
    run.last().cost.loads
}

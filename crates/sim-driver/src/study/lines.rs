//! From a control study to what is printed and stored.

use super::ControlStudy;
use crate::case::LoadedCase;
use crate::raw::{CertificateLine, ControlRecord, FlapRecord, SeriesLine};
use crate::results::{ControlLine, CouplingLine, HistoryLine, HubLoads, Residuals};
use hhc_control::{ControlRun, ControlStep, Outcome, StepLeave};

/// The raw numbers of one control study; its figures are those of [`ControlLine::refigured`].
pub fn control_line(loaded: &LoadedCase, study: &ControlStudy) -> ControlLine {
    let rotor = &study.state.rotor;
    ControlLine {
        harmonics: study.harmonics.clone(),
        actuator: study.actuator.name().to_owned(),
        hub_4_per_rev: HubLoads::from_parts(rotor.hub.harmonic(loaded.case.blades)),
        controller: study.controller.unwrap_or("none").to_owned(),
        motion_share: study.motion_share,
        voltage_share: study.voltage_share,
        within_reach: study.within_reach,
        halvings: study.halvings(),
        t_renewals: study.run.as_ref().map_or(0, |run| run.identifications),
        outcome: outcome_name(study.outcome()).to_owned(),
        rho_per_volt2: study.rho,
        stroke_limit_deg: study.stroke_limit_deg.clone(),
        residuals: Residuals {
            trim: study.trim_imbalance,
            periodicity: rotor.residuals.periodicity,
            inflow: rotor.residuals.inflow,
        },
        coupling: study
            .state
            .coupling
            .map(|c| CouplingLine { iterations: c.iterations, residual_deg: c.residual_deg }),
        history: study.run.iter().flat_map(ControlRun::history).map(history_line).collect(),
        record: record(study),
        ..ControlLine::default()
    }
}

fn record(study: &ControlStudy) -> ControlRecord {
    let wanted = study.wanted_deg.iter().map(Some).chain(std::iter::repeat(None));
    let flaps = study.state.flaps.iter().zip(&study.state.rotor.hinge).zip(wanted);
    ControlRecord {
        control_volt: study.control_volt.clone(),
        flaps: flaps
            .map(|((motion, hinge), wanted)| FlapRecord {
                voltage_volt: SeriesLine(motion.voltage_volt.clone()),
                flap_deg: SeriesLine(motion.flap_deg.clone()),
                aerodynamic_moment: SeriesLine(hinge.aerodynamic.clone()),
                inertial_moment: SeriesLine(hinge.inertial.clone()),
                wanted_deg: wanted.cloned().map(SeriesLine),
            })
            .collect(),
        t_per_volt: study.t.as_ref().map(hhc_control::TMatrix::columns).unwrap_or_default(),
        power_gains_per_volt: study.power_gains_per_volt.clone(),
        optimum: study.run.as_ref().and_then(|run| run.kkt.as_ref()).map(CertificateLine::from),
    }
}

fn history_line(step: &ControlStep) -> HistoryLine {
    HistoryLine {
        rho_per_volt2: step.rho,
        asked_volt: step.asked_volt,
        halvings: step.halvings,
        leave: match step.leave {
            StepLeave::None => None,
            StepLeave::Limits => Some("limits".to_owned()),
            StepLeave::Settling => Some("settling".to_owned()),
        },
        loads: step.measurement.hub_loads.clone(),
        control_volt: step.control_volt.clone(),
        mean_flap_deg: step.measurement.mean_flap_deg.clone(),
        ..HistoryLine::default()
    }
}

/// Name of the end of a loop.
pub(super) fn outcome_name(outcome: Option<Outcome>) -> &'static str {
    match outcome {
        None => "taken-over",
        Some(Outcome::Converged) => "converged",
        Some(Outcome::Stalled) => "stalled",
        Some(Outcome::OutOfRange) => "out-of-range",
        Some(Outcome::StepLimit) => "step-limit",
    }
}

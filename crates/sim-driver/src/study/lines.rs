//! From a control study to what is printed and stored.

use super::ControlStudy;
use crate::case::LoadedCase;
use crate::raw::{CertificateLine, ControlRecord, EndLine, FlapRecord, RefusedLine, SeriesLine};
use crate::results::{ControlLine, CouplingLine, HistoryLine, HubLoads, Residuals};
use hhc_control::{ControlRun, ControlStep, Outcome, RefusedStep, StepLeave};

/// The raw numbers of one control study; its figures are those of `ControlLine::refigured`.
pub fn control_line(loaded: &LoadedCase, study: &ControlStudy) -> ControlLine {
    let rotor = &study.state.rotor;
    ControlLine {
        harmonics: study.harmonics.clone(),
        actuator: study.actuator.name().to_owned(),
        hub_nb_per_rev: HubLoads::from_parts(rotor.hub.harmonic(loaded.case.blades)),
        motion_share: study.motion_share,
        voltage_share: study.voltage_share,
        rho_per_volt2: study.rho,
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
        end: study.run.as_ref().map(|run| end_line(study, run)),
        refused: study.run.iter().flat_map(|run| &run.refused).map(refused_line).collect(),
        identified_after: study.run.iter().flat_map(|r| r.identified_after.clone()).collect(),
        t_at_end_per_volt: study
            .t_at_end
            .as_ref()
            .map(hhc_control::TMatrix::columns)
            .unwrap_or_default(),
        at_stroke_deg: study.at_stroke_deg.clone(),
        reach_share: study.reach_share,
    }
}

fn end_line(study: &ControlStudy, run: &ControlRun) -> EndLine {
    let tolerances = [study.step_tolerance, study.cost_tolerance];
    let start_cost = run.start.cost.loads;
    EndLine::new(&run.end, run.outcome, run.end.is_settled(tolerances, start_cost))
}

fn refused_line(step: &RefusedStep) -> RefusedLine {
    let RefusedStep { after_steps, asked_volt, halvings } = *step;
    RefusedLine { after_steps, asked_volt, halvings }
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
        Some(Outcome::Flat) => "flat",
    }
}

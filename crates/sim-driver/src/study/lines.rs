//! From a control study to what is printed and stored.

use super::{ControlStudy, HingePower};
use crate::case::LoadedCase;
use crate::results::{ControlLine, CouplingLine, FlapLine, HistoryLine, HubLoads, Residuals};
use hhc_control::{ControlRun, ControlStep, Outcome, lag_deg};

/// The line of one control study.
pub fn control_line(loaded: &LoadedCase, study: &ControlStudy) -> ControlLine {
    let rotor = &study.state.rotor;
    let scales = &loaded.case.scales;
    let flaps = study
        .harmonics
        .iter()
        .flat_map(|&n| {
            let inboard = study.state.flaps.first().map(|f| f.flap_deg.harmonic(n));
            study.state.flaps.iter().zip(&rotor.hinge).enumerate().map(
                move |(k, (motion, hinge))| {
                    let (voltage, angle) =
                        (motion.voltage_volt.harmonic(n), motion.flap_deg.harmonic(n));
                    let lead = match inboard {
                        Some(inboard) if k > 0 => lag_deg(angle, inboard),
                        _ => 0.0,
                    };
                    let power = HingePower::new(hinge, &motion.flap_deg, scales);
                    FlapLine {
                        flap: k,
                        harmonic: n,
                        voltage_amplitude_volt: voltage.amplitude(),
                        voltage_phase_deg: voltage.phase_deg(),
                        flap_phase_deg: angle.phase_deg(),
                        flap_amplitude_deg: angle.amplitude(),
                        lag_deg: lag_deg(voltage, angle),
                        lead_over_inboard_deg: lead,
                        bias_volt: motion.voltage_volt.mean,
                        mean_flap_deg: motion.flap_deg.mean,
                        peak_hinge_moment_newton_metre: power.peak_newton_metre,
                        peak_aerodynamic_newton_metre: power.peak_aerodynamic_newton_metre,
                        peak_inertial_newton_metre: power.peak_inertial_newton_metre,
                        actuation_power_watt: power.given_watt,
                        net_actuation_power_watt: power.net_watt,
                    }
                },
            )
        })
        .collect();
    let given_watt = study
        .state
        .flaps
        .iter()
        .zip(&rotor.hinge)
        .map(|(motion, hinge)| HingePower::new(hinge, &motion.flap_deg, scales).given_watt);
    ControlLine {
        j_power: study.j_power,
        actuation_power_watt: given_watt.sum(),
        harmonics: study.harmonics.clone(),
        actuator: study.actuator.name().to_owned(),
        j_before: study.j_before,
        j_after: study.j_after,
        reduction_percent: study.reduction_percent(),
        hub_4_per_rev: HubLoads::from_parts(rotor.hub.harmonic(loaded.case.blades)),
        flaps,
        controller: study.controller.unwrap_or("none").to_owned(),
        load_weights: study.load_weights,
        motion_error_percent: study.motion_error.map(|error| 100.0 * error),
        motion_share: study.motion_share,
        voltage_share: study.voltage_share,
        kkt_residual: study.run.as_ref().and_then(|run| run.kkt.as_ref()).map(|kkt| kkt.residual().largest()),
        largest_mean_flap_deg: study.largest_mean_flap_deg(),
        steps: study.steps(),
        halvings: study.halvings(),
        outcome: outcome_name(study.outcome()).to_owned(),
        t_norm_per_volt: study.t_norm,
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
    }
}

fn history_line(step: &ControlStep) -> HistoryLine {
    HistoryLine {
        j_loads: step.cost.loads,
        j_control: step.cost.control,
        rho_per_volt2: step.rho,
        asked_volt: step.asked_volt,
        halvings: step.halvings,
        control_volt: step.control_volt.clone(),
        mean_flap_deg: step.measurement.mean_flap_deg.clone(),
    }
}

fn outcome_name(outcome: Option<Outcome>) -> &'static str {
    match outcome {
        None => "taken-over",
        Some(Outcome::Converged) => "converged",
        Some(Outcome::Stalled) => "stalled",
        Some(Outcome::OutOfRange) => "out-of-range",
        Some(Outcome::StepLimit) => "step-limit",
    }
}

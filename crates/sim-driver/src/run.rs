//! `hhc run`: a case trimmed, its baseline vibration, its control.

use crate::SimError;
use crate::actuator::{CaseActuators, case_actuators};
use crate::blade_loads::{moments_table, station_lines};
use crate::case::LoadedCase;
use crate::dissimilar::{each_unlike_blade, unlike_lines};
use crate::inflow::{wake_warnings, wake_word};
use crate::mean_loads::MeanLoads;
use crate::output::{Printable, Sheet, table};
use crate::progress::Progress;
use crate::raw::{Setting, is_still};
use crate::refigure::WHOLE;
use crate::results::{
    Baseline, ControlLine, HubLoads, Residuals, RunResult, TrimLine, WAKE_NOT_SETTLED, WAKE_PARTED,
    flap_name,
};
use crate::stability::StabilityLine;
use crate::study::{ControlStudy, Drives, TrimmedRotor, control_all, control_line, forecasts};
use crate::sweep::continued_trim;
use rotor_response::StationLoads;
use std::sync::Arc;
use trim::TrimSolution;

/// What a run leaves behind.
#[derive(Debug, Clone)]
pub struct RunOutcome {
    /// What is printed and stored.
    pub result: RunResult,
    /// The actuators used.
    pub actuators: CaseActuators,
    /// The trimmed rotor.
    pub trimmed: TrimmedRotor,
    /// Loads of one blade at the stations of the case, flaps at rest.
    pub blade_loads: Vec<StationLoads>,
    /// The drives of the flaps with their stroke limits.
    pub drives: Drives,
    /// Every control study, in the order of the result.
    pub studies: Vec<ControlStudy>,
}

/// Steps of the progress bar of [`run_case`]: actuator, trim and every control study.
pub fn steps_of(loaded: &LoadedCase) -> usize {
    2 + loaded.case.control.harmonics.len() * loaded.case.control.actuators.len()
}

/// Runs a case.
///
/// # Errors
/// Problems of the data, and failures of identification, trim and response, each with the place of
/// the case that asked for it.
pub fn run_case(loaded: &LoadedCase, progress: &Progress) -> Result<RunOutcome, SimError> {
    progress.doing("actuator");
    let actuators = case_actuators(loaded)?;
    progress.step();
    progress.doing("trim");
    let trimmed = continued_trim(loaded, None)?;
    progress.step();
    run_trimmed(loaded, actuators, trimmed, progress)
}

/// The same from the trim on.
///
/// # Errors
/// As [`run_case`].
pub fn run_trimmed(
    loaded: &LoadedCase,
    actuators: CaseActuators,
    trimmed: TrimmedRotor,
    progress: &Progress,
) -> Result<RunOutcome, SimError> {
    progress.doing("control");
    let failed = |source| SimError::Study { place: loaded.index.place("control"), source };
    let drives = Drives::new(&loaded.case, actuators.real.clone().map(Arc::new)).map_err(failed)?;
    let stability = StabilityLine::from(&trimmed.stability().map_err(|source| {
        let place = loaded.index.place("rotor");
        SimError::Response { place, source }
    })?);
    // a rotor whose wake has parted from it is nowhere: nothing is controlled there
    let controlled = !trimmed.wake_parted();
    let studies = if controlled {
        control_all(&loaded.case, &trimmed, &drives, &|| progress.step())
            .map_err(|source| failed(source).in_doubt(unstable(&stability, &trimmed)))?
    } else {
        Vec::new()
    };
    let forecasts = if controlled {
        forecasts(&loaded.case, &trimmed, &drives).map_err(failed)?
    } else {
        Vec::new()
    };
    let blade_loads = trimmed.station_loads(&loaded.case.load_stations_r()).map_err(|source| {
        let place = loaded.index.place("response.load_stations_r");
        SimError::Response { place, source }
    })?;
    let mut warnings = actuators.warnings.clone();
    let found = trimmed.trim();
    let about = (found.controls.theta0_rad, &found.rotor);
    let most = trimmed.largest_section_lift();
    warnings.extend(loaded.doubts_in_flight(trimmed.rotor(), about, most)?);
    warnings.extend(trimmed.wake().into_iter().flat_map(wake_warnings));
    let advance_ratio = found.flight.advance_ratio;
    warnings.extend(unstable(&stability, &trimmed));
    let each_unlike = each_unlike_blade(loaded, &trimmed)?;
    warnings.extend(each_unlike.iter().flat_map(|line| line.warnings(advance_ratio)));
    let baseline = HubLoads::from_parts(trimmed.trim().rotor.hub.harmonic(loaded.case.blades));
    let setting = Setting::of_case(&loaded.case, &baseline);
    let unlike_blades = unlike_lines(loaded, &trimmed, &studies)?;
    // the rest stands first; with every blade alike there is no line
    let mean = unlike_blades.first().map_or_else(|| found.rotor.hub.mean(), |rest| rest.mean);
    let result = RunResult {
        mean_loads: Some(MeanLoads::new(mean, &setting)),
        trim: trim_line(loaded, trimmed.trim()),
        wake: trimmed.wake().map(|wake| wake_word(wake).to_owned()),
        residuals: residuals(trimmed.trim()),
        baseline: Baseline { hub_nb_per_rev: baseline },
        blade_loads: station_lines(&blade_loads, &loaded.case.scales),
        stability,
        unlike_blades,
        each_unlike_blade: each_unlike,
        control: studies.iter().map(|study| control_line(loaded, study)).collect(),
        forecasts,
        warnings,
        ..RunResult::default()
    };
    let result = result.refigured(&setting);
    Ok(RunOutcome { result, actuators, trimmed, blade_loads, drives, studies })
}

/// What the stability of the trimmed rotor warns of.
fn unstable(stability: &StabilityLine, trimmed: &TrimmedRotor) -> Vec<String> {
    stability.warnings(trimmed.trim().flight.advance_ratio)
}

fn trim_line(loaded: &LoadedCase, solution: &TrimSolution) -> TrimLine {
    let (controls, attitude) = (&solution.controls, &solution.attitude);
    let case = &loaded.case;
    let model = case.rotor_model();
    TrimLine {
        theta0_deg: controls.theta0_rad.to_degrees(),
        theta1c_deg: controls.theta1c_rad.to_degrees(),
        theta1s_deg: controls.theta1s_rad.to_degrees(),
        alpha_s_deg: attitude.shaft_tilt_rad.to_degrees(),
        phi_s_deg: attitude.roll_rad.to_degrees(),
        tail_thrust: attitude.tail_thrust,
        ct_sigma: solution.rotor.thrust_coefficient / model.solidity(),
        induced_inflow: solution.rotor.inflow.mean(),
        iterations: solution.iterations,
    }
}

fn residuals(solution: &TrimSolution) -> Residuals {
    Residuals {
        trim: solution.residual,
        periodicity: solution.rotor.residuals.periodicity,
        inflow: solution.rotor.residuals.inflow,
    }
}

impl Printable for RunResult {
    fn text(&self) -> String {
        let (t, r) = (&self.trim, &self.residuals);
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "Trim       theta0 {:.4} deg, theta1c {:.4} deg, theta1s {:.4} deg, shaft tilt {:.4} deg, bank {:.4} deg",
            t.theta0_deg, t.theta1c_deg, t.theta1s_deg, t.alpha_s_deg, t.phi_s_deg
        ));
        sheet.line(format_args!(
            "           C_T/sigma {:.5}, induced inflow {:.5}, {} iterations",
            t.ct_sigma, t.induced_inflow, t.iterations
        ));
        match self.wake.as_deref() {
            Some(WAKE_NOT_SETTLED) => sheet.line(format_args!(
                "Wake       NOT SETTLED: the state nearest to rest; see the warning"
            )),
            Some(WAKE_PARTED) => sheet.line(format_args!(
                "Wake       PARTED from the rotor: no solution, the last good state; see the warning"
            )),
            _ => {}
        }
        if let Some([loads, shaft]) = self.mean_loads.as_ref().map(MeanLoads::text) {
            sheet.line(format_args!("Mean       {loads}"));
            sheet.line(format_args!("           {shaft}"));
        }
        sheet.line(format_args!(
            "Residuals  trim {:.1e}, periodicity {:.1e}, inflow {:.1e}",
            r.trim, r.periodicity, r.inflow
        ));
        if let Some(stability) = self.stability.text() {
            let of = if self.each_unlike_blade.is_empty() { "" } else { "each like blade " };
            sheet.line(format_args!("Stability  {of}{stability}"));
        }
        for line in &self.each_unlike_blade {
            if let Some(stability) = line.stability.text() {
                sheet.line(format_args!(
                    "           blade {}, unlike the rest, {stability}",
                    line.blade
                ));
            }
        }
        sheet.line(format_args!(""));
        let baseline = self.baseline.hub_nb_per_rev;
        let parts = [baseline.fx, baseline.fy, baseline.fz, baseline.mx, baseline.my, baseline.mz];
        sheet.line(format_args!(
            "Hub loads at the blade number per rev, fixed frame, without control"
        ));
        sheet.block(&table(
            &["load", "cosine", "sine", "amplitude"],
            HubLoads::NAMES.iter().zip(parts).map(|(name, [c, s])| {
                vec![
                    name.to_uppercase(),
                    format!("{c:.6e}"),
                    format!("{s:.6e}"),
                    format!("{:.6e}", c.hypot(s)),
                ]
            }),
        ));
        if !self.blade_loads.is_empty() {
            let whose =
                if self.each_unlike_blade.is_empty() { "one blade" } else { "each like blade" };
            sheet.line(format_args!(
                "\nMoments of {whose} without control, N m: tip up, tip forward, nose up"
            ));
            sheet.block(&moments_table(&self.blade_loads));
        }
        for line in &self.each_unlike_blade {
            sheet.line(format_args!(
                "\nMoments of blade {}, unlike the rest, without control, N m",
                line.blade
            ));
            sheet.block(&moments_table(&line.blade_loads));
        }
        if !self.control.is_empty() {
            sheet.line(format_args!(
                "\nControl: reduction of J = 100 (1 - J/J0) and of the loads, percent"
            ));
            sheet.block(&self.control_table());
            if self.is_still() {
                sheet.line(format_args!(
                    "-  no vibration without control: every load at the blade number per rev is rounding, nothing is to be\n   reduced and a percentage of nothing says nothing"
                ));
            }
            for note in self.control_notes() {
                sheet.line(format_args!("{note}"));
            }
            sheet.line(format_args!("\nFlaps"));
            sheet.block(&self.flap_table());
        }
        if !self.forecasts.is_empty() {
            sheet.line(format_args!("\nWhat the linearised rotor says beforehand, ideal actuator"));
            sheet.block(&self.forecast_table());
        }
        for line in &self.unlike_blades {
            sheet.line(format_args!(
                "\nHub loads with the unlike blades, amplitudes; flaps: {}",
                line.flaps
            ));
            sheet.block(&line.text());
        }
        sheet.finish()
    }
}

impl RunResult {
    /// Whether there is nothing to reduce.
    fn is_still(&self) -> bool {
        is_still(&self.baseline.hub_nb_per_rev.parts())
    }

    fn control_table(&self) -> String {
        let before = self.baseline.hub_nb_per_rev.amplitudes();
        let is_still = self.is_still();
        let share = |text: String| if is_still { "-".to_owned() } else { text };
        table(
            &[
                "per rev", "actuator", "T", "J/J0", "J %", "FX %", "FY %", "FZ %", "MX %", "MY %",
                "MZ %", "power W", "J_P/J0", "steps", "halved", "rise %", "shrinks", "radius",
                "ended",
            ],
            self.control.iter().map(|line| {
                let mut cells = vec![
                    line.set_name(),
                    line.actuator_cell(),
                    line.controller_cell(),
                    share(format!("{:.4}", line.j_after / line.j_before)),
                    share(format!("{:.1}", line.reduction_percent)),
                ];
                let after = line.hub_nb_per_rev.amplitudes();
                cells.extend(
                    after
                        .iter()
                        .zip(&before)
                        .map(|(a, b)| share(format!("{:.0}", 100.0 * (1.0 - a / b)))),
                );
                cells.extend([
                    format!("{:.2}", line.actuation_power_watt),
                    share(format!("{:.4}", line.j_power / line.j_before)),
                    line.steps.to_string(),
                    line.halvings.to_string(),
                    format!("{:.1}", line.largest_rise_percent),
                    line.contraction.map_or_else(String::new, |factor| format!("{factor:.2}")),
                    line.spectral_radius.map_or_else(String::new, |radius| format!("{radius:.2}")),
                    line.outcome.clone(),
                ]);
                cells
            }),
        )
    }

    /// What the marks of the table mean, where there are any.
    fn control_notes(&self) -> Vec<&'static str> {
        let any = |which: &dyn Fn(&ControlLine) -> bool| self.control.iter().any(which);
        let marks = [
            (
                any(&|l| l.within_reach == Some(false)),
                "*   out of reach: the identified actuator makes this motion with voltages beyond its range only",
            ),
            (
                any(&|l| l.motion_share.is_some_and(|s| (s - 1.0).abs() > WHOLE)),
                "**  not the ideal actuator's motion, which the range of voltages does not hold, but the best in the range, planned\n    by a cone program on the model of actuators and linearised rotor, whatever `effort` the fed-back rows have",
            ),
            (
                any(&|l| l.controller == "global" && l.t_renewals > 0),
                "+n  constant T led no further and was identified again about the control reached, n times",
            ),
            (
                any(&|l| l.largest_rise_percent > 0.05),
                "rise %: largest rise of J in one step over J0: back into limits that moved with the control, over a\n        hill to the fixed point of eq. (10), or the allowance of a loop that settles (`leave` in result.json)",
            ),
            (
                any(&|l| l.contraction.is_some()),
                "shrinks: factor from what one step asks for to the next, whole steps at the end",
            ),
            (
                any(&|l| l.spectral_radius.is_some()),
                "radius: spectral radius of eq. (10) with T and weight held, about the end: whole steps settle below 1, and\n        only halving or a new T helps above",
            ),
            (
                any(&|l| l.outcome == "out-of-range"),
                "out-of-range: not an optimum. What eq. (10) asks for lies beyond the range of voltages, and the part inside does\n              not lower J: ask for the optimum within the range with effort: Limits and controller: Local, or for less with a\n              larger rho",
            ),
            (
                any(&|l| l.outcome == "step-limit"),
                "step-limit: the loop had not settled after the steps allowed; what is shown is its last step: allow more with\n            max_steps, or, where `shrinks` is near 1, take another controller or weight: more steps of that kind lead nowhere",
            ),
            (
                any(&|l| l.outcome == "stalled" && l.actuator == "ideal" && !self.is_still()),
                "stalled, ideal: no part of a step lowers J: the T of the rotor at rest is held while the rotor bends, and J is\n         the best found, not shown to be the least; controller: Local renews it",
            ),
            (
                any(&|l| {
                    l.controller == "global" && l.outcome == "stalled" && l.actuator != "ideal"
                }),
                "stalled, global: no part of a step lowers J and full steps do not settle: a constant T is no guide there;\n         use controller: Local with effort: Limits",
            ),
            (
                any(&|l| l.controller != "global" && l.outcome == "stalled"),
                "stalled: no part of a step lowers J, though T still asks for one larger than step_tolerance: J is the best\n         found, not shown to be the least",
            ),
        ];
        marks.into_iter().filter_map(|(there, note)| there.then_some(note)).collect()
    }

    /// One row per set of harmonics.
    fn forecast_table(&self) -> String {
        let is_still = self.is_still();
        let share = |text: String| if is_still { "-".to_owned() } else { text };
        let join = |values: &[f64]| {
            let all: Vec<String> = values.iter().map(|v| format!("{v:.1}")).collect();
            all.join(" ")
        };
        table(
            &[
                "per rev",
                "lag deg",
                "lost by lag %",
                "4 sin^2(lag/2) %",
                "J/J0 free",
                "cone program",
                "clipped",
                "T by gain %",
                "by gain at stroke %",
                "T frozen %",
                "reconverged %",
            ],
            self.forecasts.iter().map(|line| {
                let set: Vec<String> = line.harmonics.iter().map(usize::to_string).collect();
                vec![
                    set.join("+"),
                    join(&line.lag_deg),
                    format!("{:.1}", line.lag_loss_percent),
                    format!("{:.1}", line.isotropic_loss_percent),
                    share(format!("{:.4}", line.free)),
                    share(format!("{:.4}", line.cone)),
                    share(format!("{:.4}", line.clipped)),
                    format!("{:.3}", line.gain_at_step_percent),
                    format!("{:.1}", line.gain_at_stroke_percent),
                    format!("{:.1}", line.frozen_percent),
                    line.reconverged_percent.map_or_else(|| "-".to_owned(), |p| format!("{p:.1}")),
                ]
            }),
        )
    }

    /// One row per set of harmonics, actuator, harmonic and flap.
    fn flap_table(&self) -> String {
        let rows = self.control.iter().flat_map(|line| {
            line.flaps.iter().map(|f| {
                vec![
                    line.set_name(),
                    line.actuator.clone(),
                    format!("{}/rev {}", f.harmonic, flap_name(f.flap)),
                    format!("{:.2}", f.flap_amplitude_deg),
                    format!("{:.1}", f.flap_phase_deg),
                    format!("{:.2}", f.voltage_amplitude_volt),
                    format!("{:.1}", f.voltage_phase_deg),
                    format!("{:.1}", f.lag_deg),
                    format!("{:.1}", f.lead_over_inboard_deg),
                    format!("{:.2}", f.bias_volt),
                    format!("{:.3}", f.peak_hinge_moment_newton_metre),
                    format!("{:.3}", f.peak_aerodynamic_newton_metre),
                    format!("{:.3}", f.peak_inertial_newton_metre),
                    format!("{:.2}", f.actuation_power_watt),
                    format!("{:.2}", f.net_actuation_power_watt),
                ]
            })
        });
        table(
            &[
                "per rev",
                "actuator",
                "motion of",
                "flap deg",
                "phase",
                "volt",
                "phase",
                "lag deg",
                "lead deg",
                "bias V",
                "hinge N m",
                "air N m",
                "inertia N m",
                "power W",
                "net W",
            ],
            rows,
        )
    }
}

//! Every table of a result.

use crate::output::{Sheet, table_of};
use crate::report::state_lines;
use crate::results::{ControlLine, Figures, flap_name, set_name};
use rotor_study::{Forecast, HubLoads, UnlikeBladeLine, is_still};
use study_text::{cost_sections, front_sections, moments_table, unlike_table};

/// Every table of a result.
pub(crate) fn details(figures: &Figures) -> String {
    let mut sheet = Sheet::default();
    for (label, text) in state_lines(figures) {
        sheet.line(format_args!("{label:11}{text}"));
    }
    sheet.line("\nHub loads at the blade number per rev, fixed frame, without control");
    let parts = figures.baseline.hub_nb_per_rev.parts();
    sheet.block(&table_of(
        HubLoads::NAMES.iter().zip(parts.chunks_exact(2)),
        &[
            ("load", &|(name, _)| name.to_uppercase()),
            ("cosine", &|(_, z)| format!("{:.6e}", z[0])),
            ("sine", &|(_, z)| format!("{:.6e}", z[1])),
            ("amplitude", &|(_, z)| format!("{:.6e}", z[0].hypot(z[1]))),
        ],
    ));
    if !figures.blade_loads.is_empty() {
        let are_alike = figures.each_unlike_blade.is_empty();
        let whose = if are_alike { "one blade" } else { "each like blade" };
        sheet.line(format_args!(
            "\nMoments of {whose} without control, N m: tip up, tip forward, nose up"
        ));
        sheet.block(&moments_table(&figures.blade_loads));
    }
    for UnlikeBladeLine { blade, blade_loads, .. } in &figures.each_unlike_blade {
        sheet.line(format_args!("\nMoments of blade {blade}, dissimilar, without control, N m"));
        sheet.block(&moments_table(blade_loads));
    }
    // percentages of a vibration that is rounding say nothing
    let is_still = is_still(&parts);
    let share = |text: String| if is_still { "-".to_owned() } else { text };
    if !figures.control.is_empty() {
        sheet.line("\nControl: reduction of J = 100 (1 - J/J0) and of the loads, percent");
        sheet.block(&control_table(figures, &share));
        if is_still {
            sheet.line(
                "-  no vibration without control: every load at the blade number per rev is rounding, nothing is to be\n   reduced and a percentage of nothing says nothing",
            );
        }
        for note in control_notes(&figures.control, is_still) {
            sheet.line(note);
        }
        sheet.line("\nFlaps");
        sheet.block(&flap_table(&figures.control));
    }
    if !figures.forecasts.is_empty() {
        sheet.line("\nWhat the linearised rotor says beforehand, ideal actuator");
        sheet.block(&forecast_table(&figures.forecasts, &share));
    }
    for section in cost_sections(&figures.costs).iter().chain(&front_sections(&figures.fronts)) {
        sheet.block(&section.to_string());
    }
    for line in &figures.unlike_blades {
        sheet.line(format_args!(
            "\nHub loads with the dissimilar blades, amplitudes; flaps: {}; J/J0 {:.4}",
            line.flaps, line.cost_ratio
        ));
        sheet.block(&unlike_table(line));
    }
    sheet.finish()
}

/// One row per set of harmonics and actuator.
fn control_table(figures: &Figures, share: &dyn Fn(String) -> String) -> String {
    let before = figures.baseline.hub_nb_per_rev.amplitudes();
    let load = |line: &ControlLine, k: usize| {
        let left = line.head.hub_nb_per_rev.amplitudes()[k] / before[k];
        share(format!("{:.0}", 100.0 * (1.0 - left)))
    };
    let factor = |value: Option<f64>| value.map_or_else(String::new, |v| format!("{v:.2}"));
    table_of(
        &figures.control,
        &[
            ("per rev", &|l| set_name(&l.head.harmonics)),
            ("actuator", &|l| actuator_cell(l)),
            ("T", &|l| controller_cell(l)),
            ("J/J0", &|l| share(format!("{:.4}", l.j_after / l.j_before))),
            ("J %", &|l| share(format!("{:.1}", l.reduction_percent))),
            ("FX %", &|l| load(l, 0)),
            ("FY %", &|l| load(l, 1)),
            ("FZ %", &|l| load(l, 2)),
            ("MX %", &|l| load(l, 3)),
            ("MY %", &|l| load(l, 4)),
            ("MZ %", &|l| load(l, 5)),
            ("power W", &|l| format!("{:.2}", l.actuation_power_watt)),
            ("J_P/J0", &|l| share(format!("{:.4}", l.j_power / l.j_before))),
            ("steps", &|l| l.steps.to_string()),
            ("backtracks", &|l| l.head.backtracks.to_string()),
            ("overshoot %", &|l| format!("{:.1}", l.overshoot_percent)),
            ("contraction", &|l| factor(l.contraction)),
            ("spectral radius", &|l| factor(l.spectral_radius)),
            ("status", &|l| l.head.status.clone()),
        ],
    )
}

/// What the marks of the table mean, where there are any.
fn control_notes(control: &[ControlLine], is_still: bool) -> Vec<&'static str> {
    let any = |which: &dyn Fn(&ControlLine) -> bool| control.iter().any(which);
    let marks = [
        (
            any(&|l| l.within_reach == Some(false)),
            "*   out of reach: the identified actuator makes this motion with voltages beyond its range only",
        ),
        (
            any(&ControlLine::motion_differs),
            "**  not the ideal actuator's motion, which the range of voltages does not hold, but the best in the range, planned\n    by a cone program on the model of actuators and linearised rotor, whatever `effort` the fed-back rows have",
        ),
        (
            any(&|l| l.controller == "global" && l.head.t_renewals > 0),
            "+n  constant T led no further and was identified again about the control reached, n times",
        ),
        (
            any(&|l| l.overshoot_percent > 0.05),
            "overshoot %: largest rise of J in one step over J0: back into limits that moved with the control, a non-monotone\n             step to the fixed point of eq. (10), or the allowance near the end (`allowed_increase` in result.json)",
        ),
        (
            any(&|l| l.contraction.is_some()),
            "contraction: factor from what one step asks for to the next, whole steps at the end",
        ),
        (
            any(&|l| l.spectral_radius.is_some()),
            "spectral radius: of eq. (10) with T and weight held, about the end: whole steps converge below 1, and\n                 only backtracking or a new T helps above",
        ),
        (
            any(&|l| l.head.status == "out-of-range"),
            "out-of-range: not an optimum. What eq. (10) asks for lies beyond the range of voltages, and the part inside does\n              not lower J: ask for the optimum within the range with effort: Limits and controller: Local, or for less with a\n              larger rho",
        ),
        (
            any(&|l| l.head.status == "step-limit"),
            "step-limit: the loop had not converged after the steps allowed; what is shown is its last step: allow more with\n            max_steps, or, where `contraction` is near 1, take another controller or weight: more steps of that kind lead nowhere",
        ),
        (
            any(&|l| l.head.status == "stalled" && l.head.actuator == "ideal" && !is_still),
            "stalled, ideal: no part of a step lowers J: the T of the rotor at rest is held while the rotor bends, and J is\n         the best found, not shown to be the least; controller: Local renews it",
        ),
        (
            any(&|l| {
                l.controller == "global" && l.head.status == "stalled" && l.head.actuator != "ideal"
            }),
            "stalled, global: no part of a step lowers J and full steps do not converge: a constant T is no guide there;\n         use controller: Local with effort: Limits",
        ),
        (
            any(&|l| l.controller != "global" && l.head.status == "stalled"),
            "stalled: no part of a step lowers J, though T still asks for one larger than step_tolerance: J is the best\n         found, not shown to be the least",
        ),
    ];
    marks.into_iter().filter_map(|(there, note)| there.then_some(note)).collect()
}

/// One row per set of harmonics.
fn forecast_table(forecasts: &[Forecast], share: &dyn Fn(String) -> String) -> String {
    let lags = |values: &[f64]| {
        let all: Vec<String> = values.iter().map(|v| format!("{v:.1}")).collect();
        all.join(" ")
    };
    let optional = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |p| format!("{p:.1}"));
    table_of(
        forecasts,
        &[
            ("per rev", &|l| set_name(&l.harmonics)),
            ("lag deg", &|l| lags(&l.lag_deg)),
            ("lost by lag %", &|l| format!("{:.1}", l.lag_loss_percent)),
            ("4 sin^2(lag/2) %", &|l| format!("{:.1}", l.isotropic_loss_percent)),
            ("J/J0 free", &|l| share(format!("{:.4}", l.free))),
            ("cone program", &|l| share(format!("{:.4}", l.cone))),
            ("clipped", &|l| share(format!("{:.4}", l.clipped))),
            ("T by gain %", &|l| format!("{:.3}", l.gain_at_step_percent)),
            ("by gain at stroke %", &|l| format!("{:.1}", l.gain_at_stroke_percent)),
            ("T frozen %", &|l| format!("{:.1}", l.frozen_percent)),
            ("reconverged %", &|l| optional(l.reconverged_percent)),
        ],
    )
}

/// One row per set of harmonics, actuator, harmonic and flap.
fn flap_table(control: &[ControlLine]) -> String {
    table_of(
        control.iter().flat_map(|line| line.flaps.iter().map(move |flap| (line, flap))),
        &[
            ("per rev", &|(line, _)| set_name(&line.head.harmonics)),
            ("actuator", &|(line, _)| line.head.actuator.clone()),
            ("motion of", &|(_, f)| format!("{}/rev {}", f.harmonic, flap_name(f.flap))),
            ("flap deg", &|(_, f)| format!("{:.2}", f.flap_amplitude_deg)),
            ("phase", &|(_, f)| format!("{:.1}", f.flap_phase_deg)),
            ("volt", &|(_, f)| format!("{:.2}", f.voltage_amplitude_volt)),
            ("phase", &|(_, f)| format!("{:.1}", f.voltage_phase_deg)),
            ("lag deg", &|(_, f)| format!("{:.1}", f.lag_deg)),
            ("lead deg", &|(_, f)| format!("{:.1}", f.lead_over_inboard_deg)),
            ("bias V", &|(_, f)| format!("{:.2}", f.bias_volt)),
            ("hinge N m", &|(_, f)| format!("{:.3}", f.peak_hinge_moment_newton_metre)),
            ("air N m", &|(_, f)| format!("{:.3}", f.peak_aerodynamic_newton_metre)),
            ("inertia N m", &|(_, f)| format!("{:.3}", f.peak_inertial_newton_metre)),
            ("power W", &|(_, f)| format!("{:.2}", f.actuation_power_watt)),
            ("net W", &|(_, f)| format!("{:.2}", f.net_actuation_power_watt)),
        ],
    )
}

/// The actuator, marked where its motion is not the one it stands beside.
fn actuator_cell(line: &ControlLine) -> String {
    let mark = match line.within_reach {
        Some(false) => "*",
        _ if line.motion_differs() => "**",
        _ => "",
    };
    format!("{}{mark}", line.head.actuator)
}

/// The controller, with the renewals of a constant T.
fn controller_cell(line: &ControlLine) -> String {
    match line.head.t_renewals {
        times if times > 0 && line.controller == "global" => {
            format!("{}+{times}", line.controller)
        }
        _ => line.controller.clone(),
    }
}

//! Every table of a result.

use super::wake_note;
use crate::output::{Sheet, table};
use crate::print::blade_loads::{moments_table, unlike_table};
use crate::results::{ControlLine, Figures, flap_name};
use rotor_study::MeanLoads;
use rotor_study::{HubLoads, is_still};

/// Every table of a result.
pub(crate) fn details(figures: &Figures) -> String {
    Tables(figures).text()
}

struct Tables<'a>(&'a Figures);

impl Tables<'_> {
    fn text(&self) -> String {
        let this = self.0;
        let (t, r) = (&this.trim, &this.residuals);
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "Trim       theta0 {:.4} deg, theta1c {:.4} deg, theta1s {:.4} deg, shaft tilt {:.4} deg, bank {:.4} deg",
            t.theta0_deg, t.theta1c_deg, t.theta1s_deg, t.alpha_s_deg, t.phi_s_deg
        ));
        sheet.line(format_args!(
            "           C_T/sigma {:.5}, induced inflow {:.5}, {} iterations",
            t.ct_sigma, t.induced_inflow, t.iterations
        ));
        if let Some(wake) = this.wake.and_then(wake_note) {
            sheet.line(format_args!("Wake       {wake}"));
        }
        if let Some([loads, shaft]) = this.mean_loads.as_ref().map(MeanLoads::text) {
            sheet.line(format_args!("Mean       {loads}"));
            sheet.line(format_args!("           {shaft}"));
        }
        sheet.line(format_args!(
            "Residuals  trim {:.1e}, periodicity {:.1e}, inflow {:.1e}",
            r.trim, r.periodicity, r.inflow
        ));
        if let Some(stability) = this.stability.text() {
            let of = if this.each_unlike_blade.is_empty() { "" } else { "each like blade " };
            sheet.line(format_args!("Stability  {of}{stability}"));
        }
        for line in &this.each_unlike_blade {
            if let Some(stability) = line.stability.text() {
                sheet
                    .line(format_args!("           blade {}, dissimilar, {stability}", line.blade));
            }
        }
        sheet.line(format_args!(""));
        let baseline = this.baseline.hub_nb_per_rev;
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
        if !this.blade_loads.is_empty() {
            let whose =
                if this.each_unlike_blade.is_empty() { "one blade" } else { "each like blade" };
            sheet.line(format_args!(
                "\nMoments of {whose} without control, N m: tip up, tip forward, nose up"
            ));
            sheet.block(&moments_table(&this.blade_loads));
        }
        for line in &this.each_unlike_blade {
            sheet.line(format_args!(
                "\nMoments of blade {}, dissimilar, without control, N m",
                line.blade
            ));
            sheet.block(&moments_table(&line.blade_loads));
        }
        if !this.control.is_empty() {
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
        if !this.forecasts.is_empty() {
            sheet.line(format_args!("\nWhat the linearised rotor says beforehand, ideal actuator"));
            sheet.block(&self.forecast_table());
        }
        for line in &this.unlike_blades {
            sheet.line(format_args!(
                "\nHub loads with the dissimilar blades, amplitudes; flaps: {}",
                line.flaps
            ));
            sheet.block(&unlike_table(line));
        }
        sheet.finish()
    }

    /// Whether there is nothing to reduce.
    fn is_still(&self) -> bool {
        is_still(&self.0.baseline.hub_nb_per_rev.parts())
    }

    fn control_table(&self) -> String {
        let before = self.0.baseline.hub_nb_per_rev.amplitudes();
        let is_still = self.is_still();
        let share = |text: String| if is_still { "-".to_owned() } else { text };
        table(
            &[
                "per rev",
                "actuator",
                "T",
                "J/J0",
                "J %",
                "FX %",
                "FY %",
                "FZ %",
                "MX %",
                "MY %",
                "MZ %",
                "power W",
                "J_P/J0",
                "steps",
                "backtracks",
                "overshoot %",
                "contraction",
                "spectral radius",
                "status",
            ],
            self.0.control.iter().map(|line| {
                let mut cells = vec![
                    line.set_name(),
                    actuator_cell(line),
                    controller_cell(line),
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
                    line.backtracks.to_string(),
                    format!("{:.1}", line.overshoot_percent),
                    line.contraction.map_or_else(String::new, |factor| format!("{factor:.2}")),
                    line.spectral_radius.map_or_else(String::new, |radius| format!("{radius:.2}")),
                    line.status.clone(),
                ]);
                cells
            }),
        )
    }

    /// What the marks of the table mean, where there are any.
    fn control_notes(&self) -> Vec<&'static str> {
        let any = |which: &dyn Fn(&ControlLine) -> bool| self.0.control.iter().any(which);
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
                any(&|l| l.controller == "global" && l.t_renewals > 0),
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
                any(&|l| l.status == "out-of-range"),
                "out-of-range: not an optimum. What eq. (10) asks for lies beyond the range of voltages, and the part inside does\n              not lower J: ask for the optimum within the range with effort: Limits and controller: Local, or for less with a\n              larger rho",
            ),
            (
                any(&|l| l.status == "step-limit"),
                "step-limit: the loop had not converged after the steps allowed; what is shown is its last step: allow more with\n            max_steps, or, where `contraction` is near 1, take another controller or weight: more steps of that kind lead nowhere",
            ),
            (
                any(&|l| l.status == "stalled" && l.actuator == "ideal" && !self.is_still()),
                "stalled, ideal: no part of a step lowers J: the T of the rotor at rest is held while the rotor bends, and J is\n         the best found, not shown to be the least; controller: Local renews it",
            ),
            (
                any(&|l| {
                    l.controller == "global" && l.status == "stalled" && l.actuator != "ideal"
                }),
                "stalled, global: no part of a step lowers J and full steps do not converge: a constant T is no guide there;\n         use controller: Local with effort: Limits",
            ),
            (
                any(&|l| l.controller != "global" && l.status == "stalled"),
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
            self.0.forecasts.iter().map(|line| {
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
        let rows = self.0.control.iter().flat_map(|line| {
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

/// The actuator, marked where its motion is not the one it stands beside.
fn actuator_cell(line: &ControlLine) -> String {
    let mark = match line.within_reach {
        Some(false) => "*",
        _ if line.motion_differs() => "**",
        _ => "",
    };
    format!("{}{mark}", line.actuator)
}

/// The controller, with the renewals of a constant T.
fn controller_cell(line: &ControlLine) -> String {
    match line.t_renewals {
        times if times > 0 && line.controller == "global" => {
            format!("{}+{times}", line.controller)
        }
        _ => line.controller.clone(),
    }
}

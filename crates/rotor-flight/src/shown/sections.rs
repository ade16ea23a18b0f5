//! Failures, margins and draws of a flight as tables for people.

use crate::{
    DrawnCase, DrawnController, FailureLine, FailureStudy, FlownCase, FlownController, MarginPoint,
    MarginSet, MarginStudy,
};
use report_page::Section;
use rotor_base::Limit;
use rotor_study::HubLoads;

/// The controllers of a flight beside each other, for people.
pub fn controllers_section(flown: &FlownCase) -> Section {
    let row = |own: &FlownController| {
        let s = &own.summary;
        vec![
            own.controller.to_owned(),
            format!("{:.3}", s.mean_cost_ratio),
            format!("{:.2} at {:.1} s", s.worst_cost_ratio, s.worst_at_s),
            format!("{:.3}", s.end_cost_ratio),
            beside(s.end_once_per_rev_ratio, s.end_off_blade_number_at_rest[0]),
            beside(s.end_other_ratio, s.end_off_blade_number_at_rest[1]),
            s.settles_in_s.map_or_else(|| "no".to_owned(), |time_s| format!("{time_s:.1} s")),
            format!("{:.0} %", 100.0 * s.limited_share),
            format!("{:.1} %", 100.0 * s.held_share),
            format!("{:.2} W", s.power_watt),
        ]
    };
    let header = [
        "T",
        "mean J/J0",
        "worst",
        "end",
        "1/rev",
        "others",
        "settles in",
        "at limit",
        "held",
        "power",
    ];
    Section {
        title: "Controllers".to_owned(),
        text: "J0 is without control in the same state. 1/rev, others: at the end, J of the loads at 1/rev and at the other harmonics that blades alike cancel, over J0, in brackets without control where it is not 0. Settles: from the last change until J/J0 stays within 0.05 of its end. At limit: cycles in which an amplitude is at its limit. Held: samples of the voltage at an end of the range. Power: of the actuators of one blade.".to_owned(),
        header: header.map(str::to_owned).into(),
        rows: flown.flights.iter().map(row).collect(),
    }
}

/// A share with control, and in brackets that without where there is one.
fn beside(with: f64, without: f64) -> String {
    if without > 0.0 { format!("{with:.3} ({without:.3})") } else { format!("{with:.3}") }
}

/// What control reaches under failures, for people.
pub fn failures_section(study: &FailureStudy) -> Section {
    let row = |line: &FailureLine| {
        vec![
            line.failure.name(),
            line.control.name().to_owned(),
            format!("{:.3}", line.cost_ratio),
            line.worst_ratio.map_or_else(|| "-".to_owned(), |worst| format!("{worst:.2}")),
            format!("{:.4}", line.once_per_rev_ratio),
            format!("{:.4}", line.other_ratio),
            format!("{:.1}", line.largest_volt),
        ]
    };
    let header = ["fails", "control", "J/J0", "worst", "1/rev", "others", "largest, V"];
    Section {
        title: "Failures".to_owned(),
        text: format!(
            "Flap {} of one blade, or the cell of {}. The rotor is nonlinear, each blade for itself, in the inflow and at the controls of its trim; flaps follow their voltages without hysteresis. J/J0 is at the blade number per rev after 30 cycles, worst of any under control; 1/rev and others: J of the loads that blades alike cancel, over the same J0.",
            study.flap, study.load
        ),
        header: header.map(str::to_owned).into(),
        rows: study.lines.iter().map(row).collect(),
    }
}

/// Many draws of the noise, for people.
pub fn draws_section(drawn: &DrawnCase) -> Section {
    let spread = |[low, middle, high]: [f64; 3]| format!("{middle:.3} ({low:.3} to {high:.3})");
    let row = |own: &DrawnController| {
        vec![
            own.controller.to_owned(),
            spread(own.mean_cost_ratio),
            spread(own.worst_cost_ratio),
            spread(own.end_cost_ratio),
            format!("{} of {}", own.above_j0, drawn.draws),
        ]
    };
    Section {
        title: "Draws of the noise".to_owned(),
        text: format!(
            "{} flights of each controller under the same draws, seeds from {} on. J/J0: the median, and 5 to 95 % of the draws.",
            drawn.draws, drawn.first_seed
        ),
        header: ["T", "mean J/J0", "worst", "end", "above J0"].map(str::to_owned).into(),
        rows: drawn.controllers.iter().map(row).collect(),
    }
}

/// The least of some numbers, and where it is.
fn least(values: impl IntoIterator<Item = f64>) -> Option<(usize, f64)> {
    values.into_iter().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))
}

/// How wrong T may be, for people: of each set what is worst over the speeds.
pub fn margins_section(study: &MarginStudy) -> Section {
    let row = |set: &MarginSet| {
        let worst = |of: fn(&MarginPoint) -> f64| {
            least(set.points.iter().map(of)).map_or(f64::INFINITY, |(_, value)| value)
        };
        let largest = set.points.iter().map(|point| point.condition).fold(0.0, f64::max);
        let of_one = |values: fn(&MarginPoint) -> &[f64], name: &dyn Fn(usize) -> String| {
            let each = set.points.iter().filter_map(|point| least(values(point).iter().copied()));
            let worst = each.min_by(|a, b| a.1.total_cmp(&b.1));
            match worst.map(|(at, deg)| (at, Limit::of_phase(deg))) {
                Some((at, limit @ Limit::At(_))) => format!("{} ({})", limit.rounded(0), name(at)),
                _ => Limit::Unbounded.rounded(0),
            }
        };
        let flap = of_one(|p| &p.flap_overshoot_deg, &|flap| format!("flap {}", flap + 1));
        let load = of_one(|p| &p.load_phase_deg, &|load| HubLoads::NAMES[load].to_uppercase());
        let reach = |point: Option<&MarginPoint>, end: usize| {
            Limit::of_reach(point.and_then(|point| point.holds_within[end])).rounded(3)
        };
        vec![
            harmonic_names(set),
            Limit::of_gain(largest).rounded(1),
            Limit::of_phase(worst(|p| p.common_phase_deg)).rounded(0),
            Limit::of_gain(worst(|p| p.common_gain)).rounded(1),
            Limit::of_phase(worst(|p| p.common_overshoot_deg)).rounded(0),
            flap,
            load,
            reach(set.points.first(), 1),
            reach(set.points.last(), 0),
        ]
    };
    let header = [
        "per rev",
        "condition",
        "phase",
        "gain",
        "J > J0",
        "one flap",
        "one load",
        "slowest T to",
        "fastest T to",
    ];
    Section {
        title: "How wrong T may be".to_owned(),
        text: format!(
            "The worst over the speeds, each error alone, angles in deg. Phase, gain and one load: where the loop with steps of {} diverges. J > J0, one flap: where J rises above J0 on the way. Slowest (fastest) T to: the advance ratio at which whole steps with the T of the lowest (highest) one diverge. Unbounded: no phase up to 180 deg, no gain up to 1000, no speed of the flight.",
            study.gain
        ),
        header: header.map(str::to_owned).into(),
        rows: study.sets.iter().map(row).collect(),
    }
}

/// Harmonics of a set, per rev, such as `2, 3`.
pub fn harmonic_names(set: &MarginSet) -> String {
    set.harmonics.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

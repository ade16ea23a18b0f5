//! Flights and failures as CSV text.

use crate::{
    DrawnCase, FailureLine, FailureStudy, FlightPoint, FlownCase, FlownController, MarginStudy,
};
use rotor_study::HubLoads;
use std::fmt::Write as _;

/// Amplitudes of the six hub loads, N and N m, of cosine and sine parts in the units `m0 Omega^2 R^2` (N) and
/// `m0 Omega^2 R^3` (N m).
pub fn load_amplitudes(parts: [f64; 12], [newton, newton_metre]: [f64; 2]) -> [f64; 6] {
    let mut amplitudes = HubLoads::from_parts(parts).amplitudes();
    for (k, amplitude) in amplitudes.iter_mut().enumerate() {
        *amplitude *= if k < 3 { newton } else { newton_metre };
    }
    amplitudes
}

/// Every cycle of every controller as CSV text, a row each: the harmonics commanded and the blade number, per rev, and the units
/// of force and moment, N and N m, of the flights.
pub fn flight_csv(
    flown: &FlownCase,
    harmonics: &[usize],
    blades: usize,
    units: [f64; 2],
) -> String {
    let mut rows: Vec<String> = Vec::new();
    for FlownController { controller, points, .. } in &flown.flights {
        for point in points {
            let (names, values): (Vec<String>, Vec<f64>) =
                fields(point, harmonics, blades, units).into_iter().unzip();
            if rows.is_empty() {
                rows.push(format!("controller,{}\n", names.join(",")));
            }
            let values: Vec<String> = values.iter().map(f64::to_string).collect();
            rows.push(format!("{controller},{}\n", values.join(",")));
        }
    }
    rows.concat()
}

/// Names and values of a cycle.
fn fields(
    point: &FlightPoint,
    harmonics: &[usize],
    blades: usize,
    units: [f64; 2],
) -> Vec<(String, f64)> {
    let mut fields: Vec<(String, f64)> = [
        ("time_s", point.time_s),
        ("advance_ratio", point.advance_ratio),
        ("thrust_share", point.thrust_share),
        ("j", point.cost),
        ("j_over_j0", point.cost_ratio),
        ("power_W", point.power_watt),
        ("limited", f64::from(u8::from(point.is_limited))),
        ("held_percent", 100.0 * point.held_share),
    ]
    .map(|(name, value)| (name.to_owned(), value))
    .into();
    let both = [("", point.loads), ("_without_control", point.loads_at_rest)];
    for (ending, loads) in both {
        let named = HubLoads::NAMES.iter().zip(load_amplitudes(loads, units)).enumerate();
        fields.extend(named.map(|(k, (name, value))| {
            let unit = if k < 3 { "N" } else { "N_m" };
            (format!("{name}_{blades}_per_rev{ending}_{unit}"), value)
        }));
    }
    let pairs = point.control_volt.chunks_exact(2 * harmonics.len()).enumerate();
    for (flap, control) in pairs {
        let of_flap = |name: String| format!("flap{}_{name}", flap + 1);
        let each = harmonics.iter().zip(control.chunks_exact(2));
        fields
            .extend(each.map(|(n, own)| (of_flap(format!("{n}_per_rev_V")), own[0].hypot(own[1]))));
        let [low, high] = point.volt[flap];
        fields.extend(
            [("lowest_V", low), ("highest_V", high)].map(|(n, v)| (of_flap(n.to_owned()), v)),
        );
        let moved = point.flap_deg[flap].iter().enumerate();
        fields.extend(moved.map(|(k, deg)| (of_flap(format!("{}_per_rev_deg", k + 1)), *deg)));
    }
    fields
}

/// Failures as CSV text, a row for each failure and control.
pub fn failures_csv(study: &FailureStudy) -> String {
    let header =
        "failure,control,j_over_j0,worst_j_over_j0,once_per_rev_over_j0,others_over_j0,largest_V\n";
    let row = |line: &FailureLine| {
        let number = |value: f64| format!("{value:.6}");
        let numbers = [
            number(line.cost_ratio),
            line.worst_ratio.map_or_else(String::new, number),
            number(line.once_per_rev_ratio),
            number(line.other_ratio),
            number(line.largest_volt),
        ];
        format!("{},{},{}\n", line.failure.name(), line.control.name(), numbers.join(","))
    };
    header.to_owned() + &study.lines.iter().map(row).collect::<String>()
}

/// Draws as CSV text, a row for each controller and cycle: 5, 50 and 95 % of the draws lie at or below.
pub fn draws_csv(drawn: &DrawnCase) -> String {
    let mut text =
        "controller,time_s,j_over_j0_5_percent,j_over_j0_median,j_over_j0_95_percent\n".to_owned();
    for own in &drawn.controllers {
        for (time_s, [low, middle, high]) in &own.cycles {
            let _ = writeln!(text, "{},{time_s},{low},{middle},{high}", own.controller);
        }
    }
    text
}

/// Margins as CSV text, a row for each set of harmonics and advance ratio of its T. `none` stands where nothing diverges.
pub fn margins_csv(study: &MarginStudy) -> String {
    let Some(first) = study.sets.first().and_then(|set| set.points.first()) else {
        return String::new();
    };
    let flaps = (1..=first.flap_overshoot_deg.len()).map(|k| format!("flap{k}_overshoot_deg"));
    let loads = HubLoads::NAMES.iter().map(|name| format!("{name}_phase_deg"));
    let gains = HubLoads::NAMES.iter().map(|name| format!("{name}_gain"));
    let places = || study.advance_ratios.iter();
    let radii = places().map(|mu| format!("radius_at_{mu}"));
    let whole = places().map(|mu| format!("whole_step_radius_at_{mu}"));
    let start = [
        "per_rev",
        "t_of_advance_ratio",
        "condition",
        "common_phase_deg",
        "common_gain",
        "common_overshoot_deg",
        "holds_from",
        "holds_to",
    ];
    let names = start.into_iter().map(str::to_owned);
    let names: Vec<String> =
        names.chain(flaps).chain(loads).chain(gains).chain(radii).chain(whole).collect();
    let mut text = names.join(",") + "\n";
    let number = |value: f64| if value.is_finite() { value.to_string() } else { "none".to_owned() };
    for set in &study.sets {
        let harmonics = set.harmonics.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
        for point in &set.points {
            let of_all = [
                point.advance_ratio,
                point.condition,
                point.common_phase_deg,
                point.common_gain,
                point.common_overshoot_deg,
            ];
            let within = point.holds_within.iter().map(|mu| mu.unwrap_or(f64::INFINITY));
            let each = of_all
                .into_iter()
                .chain(within)
                .chain(point.flap_overshoot_deg.iter().copied())
                .chain(point.load_phase_deg.iter().copied())
                .chain(point.load_gain.iter().copied())
                .chain(point.radius.iter().copied())
                .chain(point.whole_step_radius.iter().copied());
            let values: Vec<String> = each.map(number).collect();
            let _ = writeln!(text, "{harmonics},{}", values.join(","));
        }
    }
    text
}

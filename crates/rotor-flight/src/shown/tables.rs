//! Flights and failures as CSV text.

use crate::{
    DrawnCase, FailureLine, FailureStudy, FlightPoint, FlownCase, FlownController, MarginStudy,
};
use rotor_base::Limit;
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
        ("once_per_rev_over_j0", point.once_per_rev_ratio),
        ("others_over_j0", point.other_ratio),
        ("once_per_rev_over_j0_without_control", point.off_blade_number_at_rest[0]),
        ("others_over_j0_without_control", point.off_blade_number_at_rest[1]),
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

/// Margins as CSV text, a row for each set of harmonics and advance ratio of its T. `unbounded` stands where no limit was found:
/// no phase up to 180 deg, no gain up to 1000, no speed of the flight.
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
    for set in &study.sets {
        let harmonics = set.harmonics.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
        for point in &set.points {
            let limits = [
                Limit::At(point.advance_ratio),
                Limit::of_gain(point.condition),
                Limit::of_phase(point.common_phase_deg),
                Limit::of_gain(point.common_gain),
                Limit::of_phase(point.common_overshoot_deg),
            ];
            let phases = point.flap_overshoot_deg.iter().chain(&point.load_phase_deg);
            let radii = point.radius.iter().chain(&point.whole_step_radius);
            let each = limits
                .into_iter()
                .chain(point.holds_within.map(Limit::of_reach))
                .chain(phases.map(|deg| Limit::of_phase(*deg)))
                .chain(point.load_gain.iter().map(|gain| Limit::of_gain(*gain)))
                .chain(radii.map(|radius| Limit::At(*radius)));
            let values: Vec<String> = each.map(Limit::exact).collect();
            let _ = writeln!(text, "{harmonics},{}", values.join(","));
        }
    }
    text
}

/// Tables that are written when they are asked for, each with the beginning of its first line.
pub const BESIDE_FILES: [(&str, &str); 3] = [
    ("failures.csv", "failure,control,j_over_j0,worst_j_over_j0,"),
    ("margins.csv", "per_rev,t_of_advance_ratio,condition,"),
    ("draws.csv", "controller,time_s,j_over_j0_5_percent,"),
];

/// Whether a text is the table that a flight writes under a name of [`BESIDE_FILES`], and not a file of somebody else.
pub fn is_own_table(name: &str, text: &str) -> bool {
    BESIDE_FILES.iter().any(|(own, head)| *own == name && text.starts_with(head))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{MarginPoint, MarginSet, margins_section};

    /// A T without a limit in some places.
    fn study() -> MarginStudy {
        let point = MarginPoint {
            advance_ratio: 0.2,
            condition: f64::INFINITY,
            common_phase_deg: 75.5,
            common_gain: f64::INFINITY,
            common_overshoot_deg: 180.0,
            flap_overshoot_deg: vec![46.0, 180.0],
            load_phase_deg: vec![180.0, 180.0, 77.0, 180.0, 180.0, 180.0],
            load_gain: vec![f64::INFINITY; 6],
            radius: vec![0.5],
            whole_step_radius: vec![0.0],
            holds_within: [None, Some(0.225)],
        };
        let sets = vec![MarginSet { harmonics: vec![2], points: vec![point] }];
        MarginStudy { gain: 0.5, advance_ratios: vec![0.2], sets }
    }

    /// What has no limit is the same word everywhere: no null, no infinity, no number that is none.
    #[test]
    fn no_limit_is_one_word_in_every_form() {
        let study = study();
        let json = serde_json::to_value(&study).unwrap();
        let point = &json["sets"][0]["points"][0];
        for unbounded in [
            &point["condition"],
            &point["common_gain"],
            &point["common_overshoot_deg"],
            &point["flap_overshoot_deg"][1],
            &point["load_gain"][5],
            &point["holds_within"][0],
        ] {
            assert_eq!(unbounded, "unbounded", "{point}");
        }
        assert_eq!(point["common_phase_deg"], 75.5);
        assert_eq!(point["holds_within"][1], 0.225);
        let (csv, told) = (margins_csv(&study), margins_section(&study).to_string());
        let row = csv.lines().nth(1).unwrap();
        let expected = "2,0.2,unbounded,75.5,unbounded,unbounded,unbounded,0.225,46,unbounded,";
        assert!(row.starts_with(expected), "{row}");
        assert_eq!(csv.lines().next().unwrap().split(',').count(), row.split(',').count());
        for text in [json.to_string(), csv, told] {
            for wrong in ["null", "inf", "NaN", "none"] {
                assert!(!text.contains(wrong), "{wrong}: {text}");
            }
        }
    }

    /// The heads by which old tables are known are those that are written.
    #[test]
    fn a_table_knows_its_own() {
        let none = FailureStudy { flap: 1, load: String::new(), lines: vec![] };
        let drawn = DrawnCase { first_seed: 1, draws: 1, controllers: vec![] };
        let written = [failures_csv(&none), margins_csv(&study()), draws_csv(&drawn)];
        for ((name, _), text) in BESIDE_FILES.iter().zip(&written) {
            assert!(is_own_table(name, text), "{name}: {text}");
            assert!(!is_own_table(name, "controller,time\n") && !is_own_table("flight.csv", text));
        }
    }
}

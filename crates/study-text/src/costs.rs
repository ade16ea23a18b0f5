//! What control costs as tables and as CSV.

use crate::names::{flap_name, set_name};
use report_page::{Section, csv_of};
use rotor_study::{
    BladeCost, ControlCost, FlapCost, FrontAgainst, FrontLine, FrontState, MeanLoads,
};
use std::fmt::Write as _;

/// Harmonics of the blade loads in a table; the CSV has all.
const SHOWN_HARMONICS: usize = 5;
/// Points of a front in a table; the CSV has all.
const SHOWN_POINTS: usize = 6;

/// What is said where the case gives no capacitance.
const NO_CAPACITANCE: &str =
    "No capacitance given: `actuator.capacitance_uF` of the data sheet gives the electrical power.";
/// What stands where there is no load line.
const NO_LOAD_LINE: &str = " No load line: it takes actuator.blocked_force_N and actuator.free_stroke_um, and an identified linkage.";

fn three(value: f64) -> String {
    format!("{value:.3}")
}

fn optional(value: Option<f64>) -> String {
    value.map_or_else(|| "-".to_owned(), three)
}

/// Costs of the flaps, of the blade and of the shaft, as tables; none without a controlled set.
pub fn cost_sections(costs: &[ControlCost]) -> Vec<Section> {
    if costs.is_empty() {
        return Vec::new();
    }
    [flap_section(costs), blade_section(costs)].into_iter().chain(mean_section(costs)).collect()
}

fn flap_section(costs: &[ControlCost]) -> Section {
    let has = |which: &dyn Fn(&FlapCost) -> bool| costs.iter().flat_map(|c| &c.flaps).any(which);
    let electrical = has(&|flap| flap.electrical.is_some());
    let load_line = has(&|flap| flap.load_line.is_some());
    let mut header = vec![
        "per rev",
        "actuator",
        "flap",
        "J/J0",
        "given W",
        "net W",
        "hinge N m",
        "rate deg/s",
        "angle deg",
        "mean deg",
    ];
    let mut text = "Of one blade. Given: mean power where the actuator gives it, none taken back; net: its mean. Peaks over the revolution. ".to_owned();
    if electrical {
        header.extend(["apparent VA", "loss W", "current A"]);
        text.push_str("Electrical: apparent power of the capacitance, mean loss in the static loop of the actuator (- without a loop), peak current.");
    } else {
        text.push_str(NO_CAPACITANCE);
    }
    if load_line {
        header.extend(["of blocked force", "of load line"]);
        text.push_str(" Shares of the load line above 1 are beyond the actuator.");
    } else {
        text.push_str(NO_LOAD_LINE);
    }
    let rows = costs.iter().flat_map(|cost| {
        cost.flaps.iter().enumerate().map(move |(k, flap)| {
            let mut row = vec![
                set_name(&cost.harmonics),
                cost.actuator.clone(),
                flap_name(k),
                if cost.cost_ratio.is_finite() {
                    format!("{:.4}", cost.cost_ratio)
                } else {
                    "-".to_owned()
                },
                three(flap.given_watt),
                three(flap.net_watt),
                three(flap.peak_hinge_newton_metre),
                format!("{:.1}", flap.peak_rate_deg_s),
                three(flap.peak_angle_deg),
                three(flap.mean_angle_deg),
            ];
            if electrical {
                row.extend([
                    optional(flap.electrical.map(|e| e.apparent_voltampere)),
                    optional(flap.electrical.and_then(|e| e.loss_watt)),
                    optional(flap.electrical.map(|e| e.peak_current_ampere)),
                ]);
            }
            if load_line {
                row.extend([
                    optional(flap.load_line.map(|line| line.force_share)),
                    optional(flap.load_line.map(|line| line.load_line_share)),
                ]);
            }
            row
        })
    });
    Section {
        title: "What control costs: flaps and their actuators".to_owned(),
        text,
        rows: rows.collect(),
        header: header.into_iter().map(str::to_owned).collect(),
    }
}

fn blade_section(costs: &[ControlCost]) -> Section {
    let mut header: Vec<String> =
        ["per rev", "actuator", "load", "half p-p", "without", "ratio"].map(str::to_owned).into();
    header.extend((1..=SHOWN_HARMONICS).map(|n| format!("{n}/rev")));
    let row = |cost: &ControlCost, load: &BladeCost| {
        let [rest, own] = load.half_peak_to_peak;
        let mut row = vec![
            set_name(&cost.harmonics),
            cost.actuator.clone(),
            format!("{} {}", load.load, load.unit),
            format!("{own:.1}"),
            format!("{rest:.1}"),
            optional(Some(load.ratio()).filter(|ratio| ratio.is_finite())),
        ];
        let shown = load.amplitudes.iter().take(SHOWN_HARMONICS);
        row.extend(shown.map(|[rest, own]| format!("{own:.1} ({rest:.1})")));
        row
    };
    let rows = costs.iter().flat_map(|cost| cost.root.iter().map(move |load| row(cost, load)));
    Section {
        title: "What control costs: loads at the root of the blade".to_owned(),
        text: "Half the peak-to-peak load with control and without, and amplitudes with control, in brackets without. The pitch link holds the torsion.".to_owned(),
        header,
        rows: rows.collect(),
    }
}

/// A mean load by name and unit, and how it is taken from a rotor.
type MeanLoad = (&'static str, &'static str, fn(&MeanLoads) -> f64);

/// The mean loads that are shown.
const MEAN_LOADS: [MeanLoad; 7] = [
    ("shaft power", "kW", |own| 1e-3 * own.shaft_power_watt),
    ("FX", "N", |own| own.hub_force_newton[0]),
    ("FY", "N", |own| own.hub_force_newton[1]),
    ("FZ", "N", |own| own.hub_force_newton[2]),
    ("MX", "N m", |own| own.hub_moment_newton_metre[0]),
    ("MY", "N m", |own| own.hub_moment_newton_metre[1]),
    ("MZ", "N m", |own| own.hub_moment_newton_metre[2]),
];

/// Mean loads on the hub and power of the shaft; none of a result of an earlier version.
fn mean_section(costs: &[ControlCost]) -> Option<Section> {
    let known: Vec<(&ControlCost, &[MeanLoads; 2])> =
        costs.iter().filter_map(|cost| Some((cost, cost.mean_loads.as_ref()?))).collect();
    let (_, [rest, _]) = known.first()?;
    // tenths, or thousandths of a power in kW, without the sign of a zero
    let shown = |unit: &str, value: f64| {
        if unit == "kW" { three(value + 0.0) } else { format!("{:.1}", value + 0.0) }
    };
    let row = |set: String, actuator: &str, of: &dyn Fn(&MeanLoad) -> f64| {
        let numbers = MEAN_LOADS.iter().map(|load| shown(load.1, of(load)));
        [set, actuator.to_owned()].into_iter().chain(numbers).collect::<Vec<String>>()
    };
    let without = row("none".to_owned(), "-", &|load| (load.2)(rest));
    let changed = known.iter().map(|(cost, [rest, own])| {
        row(set_name(&cost.harmonics), &cost.actuator, &|load| (load.2)(own) - (load.2)(rest))
    });
    let names = MEAN_LOADS.iter().map(|(name, unit, _)| format!("{name} {unit}"));
    let header = ["per rev", "actuator"].map(str::to_owned).into_iter().chain(names);
    Some(Section {
        title: "What control costs: shaft and trim".to_owned(),
        text: "Mean loads on the hub and power of the shaft without control (first row), and what control adds. Pilot controls are held: a pilot would trim the added loads away.".to_owned(),
        header: header.collect(),
        rows: std::iter::once(without).chain(changed).collect(),
    })
}

/// Fronts as tables: what a fall of `J` costs; none without a front.
pub fn front_sections(fronts: &[FrontLine]) -> Vec<Section> {
    let of = |against: FrontAgainst| {
        let lines: Vec<&FrontLine> = fronts.iter().filter(|line| line.against == against).collect();
        (!lines.is_empty()).then(|| front_section(against, &lines))
    };
    FrontAgainst::ALL.into_iter().filter_map(of).collect()
}

/// Name of the cost of a front with its unit.
pub fn front_axis(against: FrontAgainst) -> String {
    match against {
        FrontAgainst::Power => "power of the pairs of one blade (C.13), W".to_owned(),
        FrontAgainst::RootTorsion | FrontAgainst::RootFlap => {
            format!("{}, rms, N m", against.name())
        }
    }
}

fn front_section(against: FrontAgainst, lines: &[&FrontLine]) -> Section {
    let mut text = "Least J for a given cost, actuators as their gain at full scale, rotor linearised about the trim. First row: without control; then from the least cost to the least J, where J is no more than without control.".to_owned();
    for line in lines {
        if let Some(why) = &line.failure {
            let _ = write!(text, " None for {}/rev: {why}.", set_name(&line.harmonics));
        }
    }
    let header = [
        "per rev".to_owned(),
        "J/J0".to_owned(),
        front_axis(against),
        "power given W".to_owned(),
        "flap half p-p N m".to_owned(),
        "torsion half p-p N m".to_owned(),
    ];
    let row = |line: &FrontLine, state: &FrontState| {
        let [flap, torsion] = state.half_peak_to_peak_newton_metre;
        vec![
            set_name(&line.harmonics),
            format!("{:.4}", state.cost_ratio),
            three(state.second),
            three(state.given_watt),
            format!("{flap:.1}"),
            format!("{torsion:.1}"),
        ]
    };
    let rows = lines.iter().flat_map(|line| {
        let points: Vec<&FrontState> = line.useful().collect();
        let last = points.len().saturating_sub(1);
        let mut shown: Vec<usize> =
            (0..SHOWN_POINTS).map(|k| k * last / (SHOWN_POINTS - 1)).collect();
        shown.dedup();
        let points: Vec<&FrontState> =
            shown.into_iter().filter_map(|k| points.get(k).copied()).collect();
        // the least power is that of no control: once is enough
        let is_apart =
            |first: &&FrontState| first.second.to_bits() != line.at_rest.second.to_bits();
        let rest = points.first().filter(|first| is_apart(first)).map(|_| &line.at_rest);
        rest.into_iter().chain(points).map(|state| row(line, state)).collect::<Vec<_>>()
    });
    Section {
        title: format!("What a fall of J costs: {}", against.name()),
        text,
        rows: rows.collect(),
        header: header.into(),
    }
}

/// Costs as CSV text, a row for each number: every digit kept, nothing where the case does not give it.
///
/// Columns: `per_rev`, `actuator`, `of` (flap or load), `quantity`, `unit`, `without_control`, `with_control`.
pub fn costs_csv(costs: &[ControlCost]) -> String {
    let rows = costs.iter().flat_map(|cost| {
        let flaps = cost.flaps.iter().enumerate();
        let flaps = flaps.flat_map(move |(k, flap)| {
            let numbers = flap_numbers(flap);
            numbers.into_iter().map(move |(quantity, unit, value)| {
                (cost, flap_name(k), quantity.to_owned(), unit, None, value)
            })
        });
        let loads = cost.root.iter().flat_map(move |load| {
            let [rest, own] = load.half_peak_to_peak;
            let half = ("half_peak_to_peak".to_owned(), rest, own);
            let each = load.amplitudes.iter().enumerate();
            let each =
                each.map(|(k, [rest, own])| (format!("amplitude_{}_per_rev", k + 1), *rest, *own));
            std::iter::once(half).chain(each).map(move |(quantity, rest, own)| {
                (cost, format!("root {}", load.load), quantity, load.unit, Some(rest), own)
            })
        });
        let whole = ("power_given".to_owned(), "W", cost.given_of_all_blades_watt);
        let whole = (cost, "all blades".to_owned(), whole.0, whole.1, None, whole.2);
        let mean = cost.mean_loads.iter().flat_map(move |[rest, own]| {
            MEAN_LOADS.iter().map(move |(name, unit, of)| {
                let quantity = name.replace(' ', "_");
                (cost, "hub mean".to_owned(), quantity, *unit, Some(of(rest)), of(own))
            })
        });
        std::iter::once(whole).chain(flaps).chain(loads).chain(mean)
    });
    csv_of(
        rows,
        &[
            ("per_rev", &|(cost, ..)| set_name(&cost.harmonics)),
            ("actuator", &|(cost, ..)| cost.actuator.clone()),
            ("of", &|(_, of, ..)| of.clone()),
            ("quantity", &|(_, _, quantity, ..)| quantity.clone()),
            ("unit", &|(.., unit, _, _)| (*unit).to_owned()),
            ("without_control", &|(.., rest, _)| {
                rest.map_or_else(String::new, |v| format!("{v:e}"))
            }),
            ("with_control", &|(.., own)| format!("{own:e}")),
        ],
    )
}

fn flap_numbers(flap: &FlapCost) -> Vec<(&'static str, &'static str, f64)> {
    let mut numbers = vec![
        ("power_given", "W", flap.given_watt),
        ("power_net", "W", flap.net_watt),
        ("peak_hinge_moment", "N m", flap.peak_hinge_newton_metre),
        ("peak_rate", "deg/s", flap.peak_rate_deg_s),
        ("peak_angle", "deg", flap.peak_angle_deg),
        ("mean_angle", "deg", flap.mean_angle_deg),
    ];
    if let Some(electrical) = &flap.electrical {
        numbers.push(("apparent_power", "VA", electrical.apparent_voltampere));
        numbers.push(("peak_current", "A", electrical.peak_current_ampere));
        numbers.extend(electrical.loss_watt.map(|loss| ("hysteresis_loss", "W", loss)));
    }
    if let Some(line) = &flap.load_line {
        numbers.push(("share_of_blocked_force", "", line.force_share));
        numbers.push(("share_of_free_stroke", "", line.stroke_share));
        numbers.push(("share_of_load_line", "", line.load_line_share));
    }
    numbers
}

/// Fronts as CSV text, a row for each point, every digit kept; the state without control is point 0.
pub fn fronts_csv(fronts: &[FrontLine]) -> String {
    let rows = fronts.iter().filter(|line| !line.points.is_empty()).flat_map(|line| {
        let states = std::iter::once(&line.at_rest).chain(&line.points).enumerate();
        states.map(move |(k, state)| (line, k, state))
    });
    let unit = |line: &FrontLine| if line.against == FrontAgainst::Power { "W" } else { "N m" };
    let volts = |state: &FrontState| -> String {
        let each: Vec<String> = state.control_volt.iter().map(|v| format!("{v:e}")).collect();
        each.join(" ")
    };
    csv_of(
        rows,
        &[
            ("per_rev", &|(line, ..)| set_name(&line.harmonics)),
            ("against", &|(line, ..)| line.against.name().to_owned()),
            ("point", &|(_, k, _)| k.to_string()),
            ("j_over_j0", &|(.., state)| format!("{:e}", state.cost_ratio)),
            ("cost", &|(.., state)| format!("{:e}", state.second)),
            ("cost_unit", &|(line, ..)| unit(line).to_owned()),
            ("power_given_W", &|(.., s)| format!("{:e}", s.given_watt)),
            ("flap_half_p_p_N_m", &|(.., s)| format!("{:e}", s.half_peak_to_peak_newton_metre[0])),
            ("torsion_half_p_p_N_m", &|(.., s)| {
                format!("{:e}", s.half_peak_to_peak_newton_metre[1])
            }),
            ("control_V", &|(.., state)| volts(state)),
        ],
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_study::ElectricalPower;

    fn cost(electrical: Option<ElectricalPower>) -> ControlCost {
        ControlCost {
            harmonics: vec![3, 4],
            actuator: "hysteretic".to_owned(),
            cost_ratio: 0.25,
            given_of_all_blades_watt: 4.0,
            flaps: vec![FlapCost { given_watt: 1.0, electrical, ..FlapCost::default() }],
            root: vec![BladeCost {
                load: "torsion",
                unit: "N m",
                half_peak_to_peak: [40.0, 160.0],
                amplitudes: vec![[30.0, 31.0], [0.0, 2.0]],
            }],
            mean_loads: None,
        }
    }

    #[test]
    fn mean_loads_are_told_as_what_control_adds() {
        let of = |power: f64, lift: f64| MeanLoads {
            shaft_power_watt: power,
            hub_force_newton: [0.0, 0.0, lift],
            ..MeanLoads::default()
        };
        let own =
            ControlCost { mean_loads: Some([of(3e5, 2e4), of(3.015e5, 1.99e4)]), ..cost(None) };
        assert_eq!(cost_sections(&[cost(None)]).len(), 2);
        let sections = cost_sections(std::slice::from_ref(&own));
        let rows = &sections[2].rows;
        assert_eq!(rows[0], ["none", "-", "300.000", "0.0", "0.0", "20000.0", "0.0", "0.0", "0.0"]);
        assert_eq!(
            rows[1],
            ["3+4", "hysteretic", "1.500", "0.0", "0.0", "-100.0", "0.0", "0.0", "0.0"]
        );
        let csv = costs_csv(&[own]);
        assert!(csv.contains("3+4,hysteretic,hub mean,shaft_power,kW,3e2,3.015e2"), "{csv}");
    }

    #[test]
    fn what_is_not_given_is_said_and_not_made_up() {
        let [flaps, blade] = &cost_sections(&[cost(None)])[..] else { panic!() };
        assert!(
            flaps.text.contains("No capacitance given") && !flaps.header.contains(&"loss W".into())
        );
        assert!(blade.rows[0].contains(&"4.000".to_owned()), "{:?}", blade.rows);
        assert!(!costs_csv(&[cost(None)]).contains("apparent"));
        let given =
            ElectricalPower { apparent_voltampere: 7.5, peak_current_ampere: 0.2, loss_watt: None };
        let [flaps, _] = &cost_sections(&[cost(Some(given))])[..] else { panic!() };
        assert!(!flaps.text.contains("No capacitance") && flaps.header.contains(&"loss W".into()));
        assert!(
            flaps.rows[0].contains(&"7.500".to_owned()) && flaps.rows[0].contains(&"-".to_owned())
        );
        let csv = costs_csv(&[cost(Some(given))]);
        assert!(csv.contains("3+4,hysteretic,inboard,apparent_power,VA,,7.5e0"), "{csv}");
        assert!(
            csv.contains("3+4,hysteretic,root torsion,half_peak_to_peak,N m,4e1,1.6e2"),
            "{csv}"
        );
        assert!(
            csv.contains("root torsion,amplitude_2_per_rev,N m,0e0,2e0") && !csv.contains("loss")
        );
    }

    #[test]
    fn a_front_that_failed_says_why_and_the_others_are_shown() {
        let state = |cost_ratio: f64, second: f64| FrontState {
            control_volt: vec![1.0, -2.5],
            cost_ratio,
            second,
            ..FrontState::default()
        };
        let line = FrontLine {
            harmonics: vec![3],
            against: FrontAgainst::Power,
            at_rest: state(1.0, 0.0),
            points: (0..20).map(|k| state(1.0 - 0.04 * f64::from(k), f64::from(k))).collect(),
            failure: None,
        };
        let failed = FrontLine {
            harmonics: vec![2],
            points: Vec::new(),
            failure: Some("it stalls".to_owned()),
            ..line.clone()
        };
        let sections = front_sections(&[line.clone(), failed.clone()]);
        assert_eq!(sections.len(), 1);
        // no control is the first point of a front of power, and stands before one of a load
        assert_eq!(sections[0].rows.len(), SHOWN_POINTS);
        let load = FrontLine {
            against: FrontAgainst::RootTorsion,
            at_rest: state(1.0, 5.0),
            ..line.clone()
        };
        assert_eq!(front_sections(&[load])[0].rows.len(), 1 + SHOWN_POINTS);
        assert!(sections[0].text.contains("None for 2/rev: it stalls."), "{}", sections[0].text);
        assert_eq!(sections[0].rows.last().unwrap()[1], "0.2400");
        let csv = fronts_csv(&[line, failed]);
        assert_eq!(csv.lines().count(), 1 + 21);
        assert!(csv.contains("3,actuation power,20,2.4"), "{csv}");
        assert!(csv.contains("1e0 -2.5e0"), "{csv}");
    }
}

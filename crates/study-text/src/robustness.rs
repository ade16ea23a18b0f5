//! How a loop stands noise, a wrong T and drift: tables, CSV and pictures, harmonic by harmonic.

use crate::names::flap_name;
use report_page::pictures::{Look, Mark, MarkForm, PointForm, Row, RowScale, Rows, legend};
use report_page::{Markup, Section, titled};
use rotor_base::{Limit, UNBOUNDED};
use rotor_study::{Disturbance, MarginLine, RobustnessCell};

/// Controllers of the robustness maps, in the order of their cells.
const CONTROLLERS: [&str; 3] = ["fixed T", "adaptive", "adaptive, told"];
/// Least `J / J0` of a picture, where a smaller one stands.
const LEAST_RATIO: f64 = 0.1;
/// Columns of the margins in the table of the cells.
const MARGIN_COLUMNS: [&str; 5] = [
    "condition",
    "diverges_at_deg",
    "diverges_at_gain",
    "overshoots_at_deg",
    "one_flap_overshoots_at_deg",
];

/// Cells that hold flights: those of an older version do not.
fn flown(cells: &[RobustnessCell]) -> impl Iterator<Item = &RobustnessCell> {
    cells.iter().filter(|cell| cell.cycles > 0)
}

/// What a disturbance is, in words: noise, T and drift.
fn words(d: &Disturbance) -> [String; 3] {
    let flap = d.t_flap.map_or_else(String::new, |flap| format!(", {}", flap_name(flap)));
    [
        d.noise_percent.to_string(),
        format!("{} / {} deg{flap}", d.t_gain, d.t_phase_deg),
        d.drift_percent.to_string(),
    ]
}

/// How wrong T may be, and `J / J0` under every disturbance, a column for each controller; none without flights.
pub fn robustness_sections(cells: &[RobustnessCell], margins: &[MarginLine]) -> Vec<Section> {
    let cells: Vec<_> = flown(cells).collect();
    if cells.is_empty() {
        return Vec::new();
    }
    let rows = cells.chunks(CONTROLLERS.len()).map(|each| {
        let mut row = vec![format!("{}/rev", each[0].harmonic)];
        row.extend(words(&each[0].disturbance));
        row.extend(each.iter().map(|cell| cell.summary()));
        row
    });
    let head = ["per rev", "noise %", "T error", "drift %"].into_iter().chain(CONTROLLERS);
    let flights = Section {
        title: "Flights under noise, a wrong T and drift".to_owned(),
        text: format!(
            "J/J0 over the last cycles of {} (of {} draws with noise: mean, best and worst; seeds alike for all controllers), then its largest on the way, loads without noise. Fixed number of cycles, no line search, half a step a cycle. Noise of a load over the baseline, T wrong by gain and phase, loss of actuator gain per cycle. The rotor is linearised about its trim, the actuators are as identified.",
            cells[0].cycles,
            cells.iter().map(|cell| cell.draws).max().unwrap_or_default()
        ),
        header: head.map(str::to_owned).collect(),
        rows: rows.collect(),
    };
    let header = [
        "per rev",
        "condition",
        "diverges at, deg",
        "diverges at gain",
        "J above J0 at, deg",
        "one flap alone, deg",
    ];
    let margins = Section {
        title: "How wrong T may be".to_owned(),
        text: format!(
            "Least phase error of T common to all flaps, and gain of the rotor over it, at which a loop without limits diverges (radius of (C.14) with half a step a cycle); then the least phase error from which J rises above J0 on the way, of all flaps and of one alone, root to tip. {UNBOUNDED}: no phase up to 180 deg, no gain up to 1000."
        ),
        header: header.map(str::to_owned).to_vec(),
        rows: margins.iter().map(|line| line.cells().to_vec()).collect(),
    };
    vec![margins, flights]
}

/// The cells as CSV text, with the margins of their harmonic in every row; empty where there are none.
pub fn robustness_csv(cells: &[RobustnessCell], margins: &[MarginLine]) -> String {
    let names = RobustnessCell::default().fields().map(|(name, _)| name);
    let header = names.into_iter().chain(MARGIN_COLUMNS).collect::<Vec<_>>().join(",");
    let row = |cell: &RobustnessCell| {
        let own = margins.iter().find(|line| line.harmonic == cell.harmonic);
        let of_margins = own.map_or_else(|| MARGIN_COLUMNS.map(|_| String::new()), margin_fields);
        let of_cell = cell.fields().map(|(_, value)| value);
        of_cell.into_iter().chain(of_margins).collect::<Vec<_>>().join(",") + "\n"
    };
    header + "\n" + &cells.iter().map(row).collect::<String>()
}

/// Every digit of the margins; those of the flaps with spaces between them.
fn margin_fields(line: &MarginLine) -> [String; 5] {
    let flaps: Vec<String> =
        line.flap_overshoot_deg.iter().map(|deg| Limit::of_phase(*deg).exact()).collect();
    [
        line.condition.to_string(),
        Limit::of_phase(line.common_phase_deg).exact(),
        Limit::of_gain(line.common_gain).exact(),
        Limit::of_phase(line.common_overshoot_deg).exact(),
        flaps.join(" "),
    ]
}

/// Pictures: the margins of every harmonic, then `J / J0` at the end of the flights of each; none without flights.
pub fn robustness_pictures(cells: &[RobustnessCell], margins: &[MarginLine]) -> Vec<Markup> {
    let flights: Vec<&RobustnessCell> = flown(cells).collect();
    let harmonics = flights.chunk_by(|a, b| a.harmonic == b.harmonic);
    let maps = harmonics.map(|own| {
        let title = format!("{}/rev under disturbance", own[0].harmonic);
        let text =
            "Disc: J/J0 of the last cycles, mean of the draws. Stroke: the largest on the way.";
        let key = legend(&CONTROLLERS.iter().enumerate().map(look).collect::<Vec<_>>());
        titled("", &title, text, &[key, flight_rows(own).markup()])
    });
    let text = "Bar: phase error of all flaps at which the loop diverges. Stroke: from which J rises above J0 on the way. Discs: the same of one flap alone, root to tip. No mark: no error up to 180 deg does harm.";
    let figure = margin_rows(margins).markup();
    let of_margins = (!margins.is_empty())
        .then(|| titled("", "How wrong T may be, per harmonic", text, &[figure]));
    let of_margins = of_margins.filter(|_| !flights.is_empty());
    of_margins.into_iter().chain(maps).collect()
}

fn look((k, name): (usize, &&str)) -> Look {
    Look { name: (*name).to_owned(), colour: k + 1, form: PointForm::Dots }
}

fn margin_rows(margins: &[MarginLine]) -> Rows {
    let mark = |form, colour, deg: f64, what: &str| {
        (deg < 180.0).then(|| Mark {
            form,
            colour,
            value: deg,
            told: format!("{what}: {deg:.1} deg"),
        })
    };
    let row = |line: &MarginLine| {
        let common = [
            mark(MarkForm::Bar, 0, line.common_phase_deg, "all flaps diverge"),
            mark(MarkForm::Tick, 2, line.common_overshoot_deg, "all flaps overshoot"),
        ];
        let flaps = line.flap_overshoot_deg.iter().enumerate().map(|(flap, deg)| {
            mark(MarkForm::Dot, 3 + flap, *deg, &format!("{} overshoots", flap_name(flap)))
        });
        Row {
            label: format!("{}/rev", line.harmonic),
            note: format!("gain {}", Limit::of_gain(line.common_gain).rounded(1)),
            marks: common.into_iter().chain(flaps).flatten().collect(),
            ..Row::default()
        }
    };
    Rows {
        axis: "phase error of T, deg".to_owned(),
        rows: margins.iter().map(row).collect(),
        ..Rows::default()
    }
}

/// A row for every disturbance, a disc and a stroke for every controller.
fn flight_rows(cells: &[&RobustnessCell]) -> Rows {
    let row = |each: &[&RobustnessCell]| {
        let [noise, t, drift] = words(&each[0].disturbance);
        let marks = each.iter().zip(CONTROLLERS).enumerate().flat_map(|(k, (cell, name))| {
            let mark = |form, value: f64, what: &str| Mark {
                form,
                colour: k + 1,
                value,
                told: format!("{name}, {what}: {value:.3}"),
            };
            [
                mark(MarkForm::Tick, cell.peak_ratio, "largest"),
                mark(MarkForm::Dot, cell.end_ratio, "end"),
            ]
        });
        Row {
            label: format!("T {t}"),
            note: format!("noise {noise} %, drift {drift} %"),
            marks: marks.collect(),
            ..Row::default()
        }
    };
    Rows {
        axis: "J/J0".to_owned(),
        scale: RowScale::LogFrom(LEAST_RATIO),
        rows: cells.chunks(CONTROLLERS.len()).map(row).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cells() -> Vec<RobustnessCell> {
        let cell = |harmonic, controller: &str, end_ratio| RobustnessCell {
            harmonic,
            controller: controller.to_owned(),
            disturbance: Disturbance { t_gain: 1.0, t_phase_deg: -80.0, ..Disturbance::default() },
            cycles: 40,
            draws: 1,
            end_ratio,
            end_range: [end_ratio; 2],
            peak_ratio: 2.0 * end_ratio,
        };
        let of = |harmonic, size: f64| {
            ["fixed", "adaptive", "adaptive-told"]
                .into_iter()
                .enumerate()
                .map(move |(k, name)| cell(harmonic, name, size + k as f64))
        };
        of(3, 0.25).chain(of(4, 0.75)).collect()
    }

    fn margins() -> Vec<MarginLine> {
        let line = |harmonic, common_gain| MarginLine {
            harmonic,
            condition: 4.9,
            common_phase_deg: 75.5,
            common_gain,
            common_overshoot_deg: 180.0,
            flap_overshoot_deg: vec![65.0, 180.0],
        };
        vec![line(3, 4.0), line(4, f64::INFINITY)]
    }

    /// Every row of the table has the margins of its own harmonic; what has no limit is a word.
    #[test]
    fn margins_stand_beside_the_flights_of_their_harmonic() {
        let csv = robustness_csv(&cells(), &margins());
        let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
        assert!(rows.iter().all(|row| row.len() == rows[0].len()) && rows.len() == 7, "{csv}");
        let at = |row: usize, name: &str| {
            let place = rows[0].iter().position(|own| *own == name).unwrap();
            rows[row][place]
        };
        for (row, harmonic, gain) in [(1, "3", "4"), (6, "4", "unbounded")] {
            assert_eq!((at(row, "per_rev"), at(row, "diverges_at_gain")), (harmonic, gain));
            assert_eq!(at(row, "overshoots_at_deg"), "unbounded");
            assert_eq!(at(row, "one_flap_overshoots_at_deg"), "65 unbounded");
        }
        assert!(robustness_csv(&cells(), &[]).lines().all(|line| line.split(',').count() == 18));
        let told: String =
            robustness_sections(&cells(), &margins()).iter().map(ToString::to_string).collect();
        assert!(told.contains("unbounded") && !told.contains(" 0.0 "), "{told}");
    }

    #[test]
    fn every_harmonic_has_its_figure() {
        let parts = robustness_pictures(&cells(), &margins());
        let page: String = parts.into_iter().map(Markup::into_string).collect();
        for told in [
            "all flaps diverge: 75.5 deg",
            "inboard overshoots: 65.0 deg",
            "fixed T, end: 0.250",
            "adaptive, told, largest: 5.500",
        ] {
            assert!(page.contains(told), "{told}: {page}");
        }
        assert!(page.contains("4/rev under disturbance") && !page.contains("180.0 deg"), "{page}");
        assert!(robustness_pictures(&[], &margins()).is_empty());
    }
}

//! Rotors: measured controls, airloads of measured flights, and flaps with a hysteresis that the simulation ignores.

use super::figure::{Axis, Mark, Panel, Series, drawn};
use super::{Done, Run, Study, Teller, Told, answers, figured, table};
use model_gap::ChannelGainValue;

pub(super) const INFLOW: Study = Study {
    name: "inflow-and-controls",
    is_quick: true,
    runs: &[Run {
        label: "controls at two speeds",
        case: "fixtures/points/elliott_althoff/case.ron",
        data: "elliott_althoff",
    }],
    told: Teller::Plain(controls),
};

pub(super) const HYSTERESIS: Study = Study {
    name: "ignored-hysteresis",
    is_quick: false,
    runs: &[Run {
        label: "hysteretic flaps",
        case: "fixtures/points/ignored_hysteresis/case.ron",
        data: "ignored_hysteresis",
    }],
    told: Teller::Plain(hysteresis),
};

fn series(name: &'static str, colour: usize, mark: Mark, points: Vec<[f64; 2]>) -> Series {
    Series { name, colour, mark, points }
}

fn controls(done: &[Done]) -> Told {
    let found = &done[0].diagnosis.table;
    let (mut rows, mut pairs) = (Vec::new(), Vec::new());
    for (point, predicted) in found.points.iter().zip(&found.predicted) {
        for (c, channel) in found.channels.iter().enumerate() {
            let Some(read) = point.measured[c] else { continue };
            pairs.push((c, [read, predicted[c]]));
            rows.push(vec![
                format!("{}, `{}`", point.id, channel.name),
                format!("{read:.2}"),
                format!("{:.2}", predicted[c]),
                format!("{:+.2}", predicted[c] - read),
            ]);
        }
    }
    let of = |c: usize| pairs.iter().filter(|own| own.0 == c).map(|own| own.1).collect();
    let panel = Panel {
        title: "agreement is on the line".to_owned(),
        x: Axis { label: "stated, deg", ends: [-6.0, 10.0], step: 4.0 },
        y: Axis { label: "computed, deg", ends: [-6.0, 10.0], step: 4.0 },
        series: vec![
            series("collective", 1, Mark::Dots, of(0)),
            series("cos", 2, Mark::Dots, of(1)),
            series("sin", 3, Mark::Dots, of(2)),
            series("equal", 0, Mark::Line, vec![[-6.0, -6.0], [10.0, 10.0]]),
        ],
    };
    let titles = ["", "stated, deg", "computed", "computed less stated"];
    Told {
        numbers: format!("{}\n{}", answers(done), table(&titles, &rows)),
        figure: drawn("Controls of Elliott and Althoff", &[panel]),
    }
}

const DRIVES: &str = include_str!("../../shared/ignored_hysteresis.csv");

/// Amplitude of the voltage at a point of the table, V.
fn volt(id: &str) -> f64 {
    let mut lines = DRIVES.lines();
    let titles: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let row = lines.find(|line| line.split(',').next() == Some(id)).unwrap_or_default();
    let squares = titles.iter().zip(row.split(',')).filter(|(title, _)| title.ends_with("_V"));
    let squares = squares.map(|(_, cell)| cell.parse::<f64>().unwrap_or(0.0).powi(2));
    squares.sum::<f64>().sqrt()
}

fn hysteresis(done: &[Done]) -> Told {
    let own = &done[0];
    let found = &own.diagnosis.found;
    let rms = |rows: &[Vec<f64>]| -> Vec<[f64; 2]> {
        let at = |(&p, row): (&usize, &Vec<f64>)| {
            [volt(&own.diagnosis.table.points[p].id), rotor_base::mean_square(row).sqrt()]
        };
        found.measured.iter().zip(rows).map(at).collect()
    };
    let (before, after) = (rms(&found.finding.residual_before), rms(&found.finding.residual_after));
    let mut gains: Vec<_> = own.findings.gain_by_channel.iter().collect();
    let fall = |own: &[f64; 2]| own[0] - own[1];
    gains.sort_by(|a, b| fall(&b.in_deviations).total_cmp(&fall(&a.in_deviations)));
    let row = |own: &&ChannelGainValue| {
        vec![
            format!("`{}`", own.channel),
            figured(own.heldout_rms_before),
            figured(own.heldout_rms_after),
        ]
    };
    let rows: Vec<Vec<String>> = gains.iter().take(4).map(row).collect();
    let panel = Panel {
        title: "residual of all channels of a point".to_owned(),
        x: Axis { label: "voltage of the flaps, V", ends: [0.0, 35.0], step: 5.0 },
        y: Axis { label: "rms, standard deviations", ends: [0.0, 6.0], step: 1.0 },
        series: vec![
            series("ideal flaps", 1, Mark::Dots, before),
            series("with what was found", 2, Mark::Dots, after),
        ],
    };
    let titles = ["channel, held out", "rms before", "after"];
    Told {
        numbers: format!("{}\n{}", answers(done), table(&titles, &rows)),
        figure: drawn("Hub loads of hysteretic flaps", &[panel]),
    }
}

pub(super) const LEVEL_FLIGHT: Study = Study {
    name: "level-flight",
    is_quick: false,
    runs: &[Run {
        label: "HeliNOVI, level flight",
        case: "fixtures/cases/helinovi_level.ron",
        data: "helinovi_level",
    }],
    told: Teller::Plain(level_flight),
};

/// Measured and simulated amplitude of the harmonics of a quantity at the first point, by harmonic.
fn amplitudes(own: &Done, what: &str, scale: f64) -> [Vec<[f64; 2]>; 2] {
    let found = &own.diagnosis.table;
    let place = |name: String| {
        found.channels.iter().position(|channel| channel.name.trim_end_matches("_deg") == name)
    };
    let mut all = [vec![], vec![]];
    for n in 1..=6 {
        let pair = ["cos", "sin"].map(|part| place(format!("{what}_n{n}_{part}")));
        let [Some(cos), Some(sin)] = pair else { continue };
        let read = |c: usize| found.points[0].measured[c].unwrap_or(f64::NAN);
        let row = &found.predicted[0];
        let at = f64::from(n);
        all[0].push([at, scale * read(cos).hypot(read(sin))]);
        all[1].push([at, scale * row[cos].hypot(row[sin])]);
    }
    all
}

fn level_flight(done: &[Done]) -> Told {
    let mut rows = Vec::new();
    for own in done {
        let found = &own.diagnosis.found;
        let mut left: Vec<(String, f64)> = Vec::new();
        for (&p, residual) in found.measured.iter().zip(&found.finding.residual_after) {
            let point = &own.diagnosis.table.points[p];
            let read = (0..point.measured.len()).filter(|&c| point.measured[c].is_some());
            let name = |c: usize| &own.diagnosis.table.channels[c].name;
            left.extend(
                read.zip(residual).map(|(c, off)| (format!("{} `{}`", point.id, name(c)), *off)),
            );
        }
        left.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
        let one = |(name, off): &(String, f64)| format!("{name} {off:+.1}");
        let most: Vec<String> = left.iter().take(4).map(one).collect();
        rows.push(vec![own.label.to_owned(), most.join(", ")]);
    }
    let [measured, simulated] = amplitudes(&done[0], "cn_m2_r0p87", 1e3);
    let panel = Panel {
        title: "airload at 0.87 R".to_owned(),
        x: Axis { label: "per rev", ends: [0.0, 7.0], step: 1.0 },
        y: Axis { label: "amplitude of C_n M^2, 1e-3", ends: [0.0, 30.0], step: 5.0 },
        series: vec![
            series("measured", 0, Mark::Diamonds, measured),
            series("computed", 1, Mark::Dots, simulated),
        ],
    };
    let titles = ["", "readings furthest off, standard deviations"];
    Told {
        numbers: format!("{}\n{}", answers(done), table(&titles, &rows)),
        figure: drawn("HeliNOVI at mu 0.275", &[panel]),
    }
}

//! Measured loops of the NACA 0012 through stall.

use super::figure::{Axis, Mark, Panel, Series, drawn};
use super::{Done, Run, Study, Teller, Told, answers, table};

const DATA: &str = "stall_naca0012";
pub(super) const STUDY: Study = Study {
    name: "dynamic-stall",
    is_quick: true,
    runs: &[
        Run {
            label: "attached flow",
            case: "fixtures/points/stall_naca0012/attached.ron",
            data: DATA,
        },
        Run {
            label: "stalled flow",
            case: "fixtures/points/stall_naca0012/stalled.ron",
            data: DATA,
        },
    ],
    told: Teller::Plain(told),
};

/// Loops by their highest incidence, deg: attached, the onset, stalled.
const BANDS: [(&str, [f64; 2]); 3] =
    [("to 13", [0.0, 13.1]), ("13 to 17", [13.1, 17.0]), ("beyond 17", [17.0, 90.0])];

/// Highest incidence of a loop, deg: its conditions do not hold it, its row does.
fn highest_deg(root_text: &str, id: &str) -> f64 {
    let row = root_text.lines().find(|line| line.split(',').next() == Some(id));
    let cells: Vec<f64> =
        row.unwrap_or_default().split(',').map(|c| c.parse().unwrap_or(0.0)).collect();
    cells.get(4).zip(cells.get(5)).map_or(f64::NAN, |(mean, amplitude)| mean + amplitude)
}

const POINTS: &str = include_str!("../../shared/stall_naca0012.csv");

/// Rms of measured less simulated over the amplitude of each loop of a load, in the unit of its coefficient: mean and
/// harmonics added up.
fn left(own: &Done, load: &str) -> Vec<[f64; 2]> {
    let table = &own.diagnosis.table;
    let of = |(point, predicted): (&model_gap::points::Point, &Vec<f64>)| {
        let row = POINTS.lines().find(|line| line.split(',').next() == Some(&point.id));
        let amplitude: f64 = row.and_then(|own| own.split(',').nth(5)?.parse().ok()).unwrap_or(0.0);
        let amplitude = amplitude.to_radians();
        let mut square = 0.0;
        for (c, channel) in table.channels.iter().enumerate() {
            let Some(read) = point.measured[c].filter(|_| channel.name.starts_with(load)) else {
                continue;
            };
            let off = read - predicted[c];
            let is_mean = channel.name.ends_with("_n0");
            square += if is_mean { off * off } else { 0.5 * (off * amplitude).powi(2) };
        }
        [highest_deg(POINTS, &point.id), square.sqrt()]
    };
    table.points.iter().zip(&table.predicted).map(of).collect()
}

fn told(done: &[Done]) -> Told {
    let mut rows = Vec::new();
    for (name, [low, high]) in BANDS {
        let mut row = vec![name.to_owned()];
        for load in ["cn", "cm"] {
            for own in done {
                let inside: Vec<f64> = left(own, load)
                    .into_iter()
                    .filter(|[deg, _]| (low..high).contains(deg))
                    .map(|own| own[1])
                    .collect();
                if row.len() == 1 {
                    row.push(inside.len().to_string());
                }
                row.push(format!("{:.3}", rotor_base::mean_square(&inside).sqrt()));
            }
        }
        rows.push(row);
    }
    let titles = [
        "highest incidence, deg",
        "loops",
        "`cn` left, rms: attached",
        "stalled",
        "`cm` left: attached",
        "stalled",
    ];
    let panel = |load: &str, high, step| Panel {
        title: format!("what is left of {load}"),
        x: Axis { label: "highest incidence of the loop, deg", ends: [8.0, 32.0], step: 4.0 },
        y: Axis { label: "rms", ends: [0.0, high], step },
        series: vec![
            Series {
                name: "simulated with attached flow",
                colour: 1,
                mark: Mark::Dots,
                points: left(&done[0], load),
            },
            Series {
                name: "with dynamic stall",
                colour: 2,
                mark: Mark::Dots,
                points: left(&done[1], load),
            },
        ],
    };
    let panels = [panel("cn", 1.0, 0.2), panel("cm", 0.16, 0.04)];
    let figure = drawn("NACA 0012 at Mach 0.3, k 0.1: onset of dynamic stall", &panels);
    Told { numbers: format!("{}\n{}", answers(done), table(&titles, &rows)), figure }
}

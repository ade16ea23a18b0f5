//! The oscillating flap of the NACA 64A006 at two Mach numbers.

use super::figure::{Axis, Mark, Panel, Series, drawn};
use super::{Done, Run, Study, Teller, Told, answers};

const CASE: &str = "fixtures/points/flap_two_mach/case.ron";
pub(super) const STUDY: Study = Study {
    name: "oscillating-flap",
    is_quick: true,
    runs: &[
        Run { label: "harmonics at both Mach numbers", case: CASE, data: "flap_two_mach" },
        Run { label: "the loop at Mach 0.5", case: CASE, data: "flap_m0500" },
    ],
    told: Teller::Plain(told),
};

const LOADS: [&str; 3] = ["lift", "moment", "hinge moment"];

/// Real and imaginary part of a load.
type Part = [f64; 2];

/// A load of a point as measured and as simulated.
fn of_load(own: &Done, point: usize, load: usize) -> [Part; 2] {
    let table = &own.diagnosis.table;
    let measured = &table.points[point].measured;
    let read = |c: usize| measured[c].unwrap_or(f64::NAN);
    let (re, im) = (2 * load, 2 * load + 1);
    [[read(re), read(im)], [table.predicted[point][re], table.predicted[point][im]]]
}

fn told(done: &[Done]) -> Told {
    let both = &done[0];
    let parts = |which: usize, point: usize, load: usize| vec![of_load(both, point, load)[which]];
    let ends = [[0.0, 4.0], [-1.4, 0.0], [-0.09, 0.0]];
    let heights = [[-1.6, 0.0], [-0.2, 0.0], [-0.03, 0.0]];
    let steps = [(1.0, 0.4), (0.2, 0.05), (0.03, 0.01)];
    let panel = |load: usize| {
        let of = |name, colour, mark, which, point| Series {
            name,
            colour,
            mark,
            points: parts(which, point, load),
        };
        Panel {
            title: format!("first harmonic of the {}", LOADS[load]),
            x: Axis { label: "in phase, per rad", ends: ends[load], step: steps[load].0 },
            y: Axis { label: "in quadrature", ends: heights[load], step: steps[load].1 },
            series: vec![
                of("measured, Mach 0.5", 3, Mark::Diamonds, 0, 0),
                of("theory, Mach 0.5", 3, Mark::Dots, 1, 0),
                of("measured, Mach 0.748", 1, Mark::Diamonds, 0, 1),
                of("theory, Mach 0.748", 1, Mark::Dots, 1, 1),
            ],
        }
    };
    let figure =
        drawn("Oscillating flap: measured loads and calibrated theory", &[0, 1, 2].map(panel));
    Told { numbers: answers(done), figure }
}

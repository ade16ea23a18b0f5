//! The numbers the paper reports, beside ours.
//!
//! Source: S. R. Viswamurthy, R. Ganguli, *Experimental and computational investigation of piezoceramic
//! actuator hysteresis phenomenon in helicopter vibration control using dual trailing-edge flaps*,
//! results and conclusions.

use crate::report::HeadlineRow;
use crate::results::{ControlLine, RunResult};

/// Advance ratio of every number the paper reports.
pub(super) const ADVANCE_RATIO: f64 = 0.30;

/// What the paper reports of one harmonic.
struct PaperHarmonic {
    per_rev: usize,
    reduction: &'static str,
    lag: &'static str,
    lead: &'static str,
}

const HARMONICS: [PaperHarmonic; 3] = [
    PaperHarmonic {
        per_rev: 2,
        reduction: "about 29",
        lag: "about 47 (94 if read as azimuth; 32 to 40 in the conclusions)",
        lead: "about 65",
    },
    PaperHarmonic {
        per_rev: 3,
        reduction: "about 78",
        lag: "about 41 (123 if read as azimuth)",
        lead: "nearly 180",
    },
    PaperHarmonic {
        per_rev: 4,
        reduction: "about 66",
        lag: "about 36 (144 if read as azimuth)",
        lead: "about -37",
    },
];

/// Reductions of the six load amplitudes at 3/rev, percent.
const THREE_PER_REV_LOADS: [(&str, &str); 6] =
    [("FX", "43"), ("FY", "38"), ("FZ", "67"), ("MX", "28"), ("MY", "34"), ("MZ", "50")];

fn lines(result: &RunResult, per_rev: usize) -> impl Iterator<Item = &ControlLine> {
    result.control.iter().filter(move |line| line.harmonics == [per_rev])
}

fn row<'a>(
    quantity: String,
    paper: &str,
    lines: impl Iterator<Item = &'a ControlLine>,
    ours: impl Fn(&ControlLine) -> String,
) -> HeadlineRow {
    let ours = lines.map(|line| (line.actuator.clone(), ours(line))).collect();
    HeadlineRow { quantity, paper: paper.to_owned(), ours }
}

/// Our numbers beside the paper's, in the order of the paper.
pub(super) fn headline(result: &RunResult) -> Vec<HeadlineRow> {
    let mut rows = Vec::new();
    let each_flap = |line: &ControlLine, pick: fn(&crate::results::FlapLine) -> f64| {
        let all: Vec<String> = line.flaps.iter().map(|f| format!("{:.1}", pick(f))).collect();
        all.join(" / ")
    };
    for paper in &HARMONICS {
        let n = paper.per_rev;
        rows.push(row(
            format!("{n}/rev: reduction of J, %"),
            paper.reduction,
            lines(result, n),
            |l| format!("{:.1}", l.reduction_percent),
        ));
        rows.push(row(
            format!("{n}/rev: flap lags voltage, deg, inboard / outboard"),
            paper.lag,
            lines(result, n),
            |l| each_flap(l, |f| f.lag_deg),
        ));
        rows.push(row(
            format!("{n}/rev: outboard leads inboard, deg"),
            paper.lead,
            lines(result, n),
            |l| {
                l.flaps
                    .get(1)
                    .map_or_else(String::new, |f| format!("{:.0}", f.lead_over_inboard_deg))
            },
        ));
        rows.push(row(
            format!("{n}/rev: flap amplitude, deg, inboard / outboard"),
            "equal, the largest stroke",
            lines(result, n),
            |l| each_flap(l, |f| f.flap_amplitude_deg),
        ));
    }
    let before = result.baseline.hub_nb_per_rev.amplitudes();
    for (k, (name, paper)) in THREE_PER_REV_LOADS.iter().enumerate() {
        rows.push(row(
            format!("3/rev: reduction of 4/rev {name}, %"),
            paper,
            lines(result, 3),
            |l| format!("{:.0}", 100.0 * (1.0 - l.hub_nb_per_rev.amplitudes()[k] / before[k])),
        ));
    }
    rows
}

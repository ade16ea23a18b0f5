//! The numbers the paper reports, beside ours.
//!
//! Source: S. R. Viswamurthy, R. Ganguli, *Experimental and computational investigation of piezoceramic
//! actuator hysteresis phenomenon in helicopter vibration control using dual trailing-edge flaps*,
//! results and conclusions.

use super::HeadlineRow;
use crate::case::Case;
use crate::results::{ControlLine, Figures, FlapLine};

/// Advance ratio of every number the paper reports.
const ADVANCE_RATIO: f64 = 0.30;

/// Whether a case is flown where the paper's numbers are.
pub(crate) fn is_paper(case: &Case) -> bool {
    (case.advance_ratio - ADVANCE_RATIO).abs() < 1e-9
}

/// Numbers of the paper for one harmonic, feedback on the hysteretic actuator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PaperNumbers {
    /// Reduction of J, percent.
    pub reduction_percent: f64,
    /// Phase by which the flap lags the voltage, deg.
    pub lag_deg: f64,
    /// Reductions of the six loads, percent, where the paper has them.
    pub loads_percent: Option<[f64; 6]>,
}

/// The paper's numbers for a set of harmonics; none for sets it does not report.
pub(crate) fn paper_numbers(harmonics: &[usize]) -> Option<PaperNumbers> {
    let [per_rev] = harmonics else { return None };
    let found = HARMONICS.iter().find(|row| row.per_rev == *per_rev)?;
    let loads = THREE_PER_REV_LOADS.map(|(_, percent)| percent);
    Some(PaperNumbers {
        reduction_percent: found.reduction_percent,
        lag_deg: found.lag_deg,
        loads_percent: (*per_rev == 3).then_some(loads),
    })
}

/// What the paper reports of one harmonic.
struct PaperHarmonic {
    per_rev: usize,
    reduction_percent: f64,
    lag_deg: f64,
    reduction: &'static str,
    lag: &'static str,
    lead: &'static str,
}

const HARMONICS: [PaperHarmonic; 3] = [
    PaperHarmonic {
        per_rev: 2,
        reduction_percent: 29.0,
        lag_deg: 47.0,
        reduction: "about 29",
        lag: "about 47 (94 if read as azimuth; 32 to 40 in the conclusions)",
        lead: "about 65",
    },
    PaperHarmonic {
        per_rev: 3,
        reduction_percent: 78.0,
        lag_deg: 41.0,
        reduction: "about 78",
        lag: "about 41 (123 if read as azimuth)",
        lead: "nearly 180",
    },
    PaperHarmonic {
        per_rev: 4,
        reduction_percent: 66.0,
        lag_deg: 36.0,
        reduction: "about 66",
        lag: "about 36 (144 if read as azimuth)",
        lead: "about -37",
    },
];

/// Reductions of the six load amplitudes at 3/rev, percent.
const THREE_PER_REV_LOADS: [(&str, f64); 6] =
    [("FX", 43.0), ("FY", 38.0), ("FZ", 67.0), ("MX", 28.0), ("MY", 34.0), ("MZ", 50.0)];

fn lines(result: &Figures, per_rev: usize) -> impl Iterator<Item = &ControlLine> {
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
pub(super) fn headline(result: &Figures) -> Vec<HeadlineRow> {
    let mut rows = Vec::new();
    let each_flap = |line: &ControlLine, pick: fn(&FlapLine) -> f64| {
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
            &format!("{paper:.0}"),
            lines(result, 3),
            |l| format!("{:.0}", 100.0 * (1.0 - l.hub_nb_per_rev.amplitudes()[k] / before[k])),
        ));
    }
    rows
}

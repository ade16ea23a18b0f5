//! The numbers the paper reports, beside ours.
//!
//! Source: S. R. Viswamurthy, R. Ganguli, *Experimental and computational investigation of piezoceramic
//! actuator hysteresis phenomenon in helicopter vibration control using dual trailing-edge flaps*,
//! results and conclusions.

use crate::case::{Case, RotorValues};
use crate::output::unique;
use crate::results::{ControlLine, Figures};
use report_page::Section;

/// Advance ratio of every number the paper reports.
const ADVANCE_RATIO: f64 = 0.30;

/// Whether a case is the paper's: its advance ratio, and the rotor of its Table 1 with two flaps.
pub(crate) fn is_paper(case: &Case) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
    let (own, table) = (&case.rotor, RotorValues::default());
    near(case.advance_ratio, ADVANCE_RATIO)
        && own.blades == table.blades
        && case.flaps.len() == 2
        && [
            (own.lock_number, table.lock_number),
            (own.chord_r, table.chord_r),
            (own.ei_flap, table.ei_flap),
            (own.ei_lag, table.ei_lag),
            (own.gj, table.gj),
        ]
        .into_iter()
        .all(|(own, table)| near(own, table))
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
    lag: &'static str,
    lead: &'static str,
}

const HARMONICS: [PaperHarmonic; 3] = [
    PaperHarmonic {
        per_rev: 2,
        reduction_percent: 29.0,
        lag_deg: 47.0,
        lag: "about 47 (94 if read as azimuth; 32 to 40 in the conclusions)",
        lead: "about 65",
    },
    PaperHarmonic {
        per_rev: 3,
        reduction_percent: 78.0,
        lag_deg: 41.0,
        lag: "about 41 (123 if read as azimuth)",
        lead: "nearly 180",
    },
    PaperHarmonic {
        per_rev: 4,
        reduction_percent: 66.0,
        lag_deg: 36.0,
        lag: "about 36 (144 if read as azimuth)",
        lead: "about -37",
    },
];

/// Reductions of the six load amplitudes at 3/rev, percent.
const THREE_PER_REV_LOADS: [(&str, f64); 6] =
    [("FX", 43.0), ("FY", 38.0), ("FZ", 67.0), ("MX", 28.0), ("MY", 34.0), ("MZ", 50.0)];

/// Our numbers beside the paper's, in the order of the paper; none without control at its harmonics.
pub(super) fn beside_paper(result: &Figures) -> Option<Section> {
    let ours = result.control.iter().filter(|line| paper_numbers(&line.head.harmonics).is_some());
    let actuators = unique(ours.map(|line| line.head.actuator.as_str()));
    let mut rows = Vec::new();
    let mut row = |n: usize, quantity: &str, paper: &str, ours: &dyn Fn(&ControlLine) -> String| {
        let lines = || result.control.iter().filter(|line| line.head.harmonics == [n]);
        if lines().next().is_some() {
            let ours = actuators.iter().map(|actuator| {
                lines().find(|line| line.head.actuator == *actuator).map(ours).unwrap_or_default()
            });
            let head = [format!("{n}/rev: {quantity}"), paper.to_owned()];
            rows.push(head.into_iter().chain(ours).collect());
        }
    };
    let lead = |line: &ControlLine| {
        let outboard = line.flaps.get(1);
        outboard.map_or_else(String::new, |f| format!("{:.0}", f.lead_over_inboard_deg))
    };
    for paper in &HARMONICS {
        let n = paper.per_rev;
        let reduction = format!("about {}", paper.reduction_percent);
        row(n, "reduction of J, %", &reduction, &|l| format!("{:.1}", l.reduction_percent));
        row(n, "flap lags voltage, deg, inboard / outboard", paper.lag, &|l| {
            l.each_flap(|f| f.lag_deg)
        });
        row(n, "outboard leads inboard, deg", paper.lead, &lead);
        let stroke = "equal, the largest stroke";
        row(n, "flap amplitude, deg, inboard / outboard", stroke, &|l| {
            l.each_flap(|f| f.flap_amplitude_deg)
        });
    }
    let before = result.baseline.hub_nb_per_rev.amplitudes();
    for (k, (name, paper)) in THREE_PER_REV_LOADS.iter().enumerate() {
        row(3, &format!("reduction of 4/rev {name}, %"), &format!("{paper:.0}"), &|l| {
            format!("{:.0}", 100.0 * (1.0 - l.head.hub_nb_per_rev.amplitudes()[k] / before[k]))
        });
    }
    let header = ["quantity", "paper"].into_iter().chain(actuators);
    (!rows.is_empty()).then(|| Section {
        title: "Beside the paper".to_owned(),
        text: "The paper's numbers are for feedback on the hysteretic actuator. Reduction counts J_Z alone: the hysteretic actuator can beat the ideal one at the same stroke, as its flap motion holds harmonics of its own, which shake the hub too.".to_owned(),
        header: header.map(str::to_owned).collect(),
        rows,
    })
}

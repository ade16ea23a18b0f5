//! The one screen of a run: the reduction of vibration first, then what it rests on.

use crate::output::{Sheet, table, table_of};
use crate::report::{
    StudyReport, actuator_title, is_paper, paper_numbers, residuals_text, vibration_text, wake_note,
};
use crate::results::{ControlLine, Figures, FlapLine, by_set, set_name};
use rotor_study::{HubLoads, is_still, most_moved};
use std::path::Path;

/// Rows of controls that leave room for the rest of a screen.
const MOST_ROWS: usize = 24;
/// Controls whose reduction with dissimilar blades is told; the rest is in the details.
const MOST_UNLIKE: usize = 6;

/// The screen of a run, whose results and report are in a folder.
pub(crate) fn summary(report: &StudyReport<'_>, folder: &Path) -> String {
    let (figures, case) = (report.figures, &report.stored.case);
    let mut screen = Sheet::default();
    screen.line(&case.title);
    if figures.control.is_empty() {
        baseline(figures, &mut screen);
    } else {
        control(figures, is_paper(case), &mut screen);
    }
    screen.line("");
    let t = &figures.trim;
    screen.labelled(
        "Trim",
        &format!(
            "theta0 {:.2} deg, theta1c {:.2}, theta1s {:.2}, tilt {:.2}, bank {:.2}; C_T/sigma {:.4}",
            t.theta0_deg, t.theta1c_deg, t.theta1s_deg, t.alpha_s_deg, t.phi_s_deg, t.ct_sigma
        ),
    );
    if let Some(mean) = &figures.mean_loads {
        screen.labelled(
            "Shaft",
            &format!(
                "power {:.1} kW, torque {:.0} N m; mean vertical force {:.0} N",
                1e-3 * mean.shaft_power_watt,
                mean.shaft_torque_newton_metre,
                mean.hub_force_newton[2]
            ),
        );
    }
    if let Some(text) = vibration_text(figures) {
        screen.labelled("Vibration", &text);
    }
    if let Some(note) = figures.wake.and_then(wake_note) {
        screen.labelled("Wake", note);
    }
    screen.labelled("Residuals", &residuals_text(&figures.residuals));
    if let Some(stability) = figures.stability.text() {
        screen.labelled("Stability", &stability);
    }
    let sets = case.control.harmonics.iter().filter(|set| set.len() == 1);
    for (set, (row, by)) in sets.zip(most_moved(&figures.sensitivity)).take(4) {
        screen.labelled(
            "Uncertain",
            &format!("J at {}/rev moves most, by {by:+.1} points, with {}", set[0], row.assumption),
        );
    }
    for line in report.stored.result.margins.iter().take(4) {
        let [set, _, phase, gain, overshoot, flaps] = line.cells();
        let text = format!(
            "T at {set}: phase off by {phase} deg diverges, gain {gain}; J above J0 from {overshoot} deg, one flap alone {flaps}"
        );
        screen.labelled("May err", &text);
    }
    let folder = folder.display();
    screen.labelled("Report", &format!("{folder}/report.html, numbers in {folder}/result.json"));
    screen.labelled("Details", &format!("every table: hhc report {folder} --details"));
    screen.screen()
}

/// The loads of a run without control.
fn baseline(figures: &Figures, screen: &mut Sheet) {
    screen.line("\nHub loads at the blade number per rev, fixed frame, nondimensional; nothing is controlled");
    let amplitudes = figures.baseline.hub_nb_per_rev.amplitudes();
    screen.block(&table_of(
        HubLoads::NAMES.iter().zip(amplitudes),
        &[
            ("load", &|(name, _)| name.to_uppercase()),
            ("amplitude", &|(_, amplitude)| format!("{amplitude:.4e}")),
        ],
    ));
}

/// What control does, the paper's numbers beside where it has them.
fn control(figures: &Figures, with_paper: bool, screen: &mut Sheet) {
    screen.line(
        "\nReduction of hub vibration, percent: J and the six loads at the blade number per rev",
    );
    let mut rows: Vec<Vec<String>> = Vec::new();
    for (harmonics, lines) in by_set(&figures.control) {
        let mut set = format!("{}/rev", set_name(harmonics));
        for line in lines {
            rows.push(row(std::mem::take(&mut set), line, figures));
        }
        if let Some(paper) = paper_numbers(harmonics).filter(|_| with_paper) {
            let loads = paper.loads_percent.map(|all| all.map(|percent| format!("{percent:.0}")));
            let mut cells = vec![String::new(), "paper".to_owned()];
            cells.push(format!("{:.0}", paper.reduction_percent));
            cells.extend(loads.unwrap_or_default());
            cells.extend([format!("{:.0}", paper.lag_deg), String::new(), String::new()]);
            rows.push(cells);
        }
    }
    let more = rows.len().saturating_sub(MOST_ROWS);
    rows.truncate(MOST_ROWS);
    let header = [
        "flaps at", "actuator", "J", "FX", "FY", "FZ", "MX", "MY", "MZ", "lag deg", "flap deg",
        "loop",
    ];
    screen.block(&table(&header, rows));
    if more > 0 {
        screen.line(format!("{more} more rows with --details"));
    }
    let meanings = [
        ("ideal", "ideal: actuator without hysteresis"),
        ("ignored", "ignored: its voltages on the real actuator"),
        ("hysteretic", "fed back: control on the real actuator"),
        ("inverse", "inverse: its motion through the inverse of the real actuator"),
    ];
    let shown = |name: &str| figures.control.iter().any(|line| line.head.actuator == name);
    let meanings: Vec<&str> = meanings.iter().filter(|m| shown(m.0)).map(|m| m.1).collect();
    screen.paragraphs(&format!("{}.", meanings.join("; ")));
    screen.paragraphs("A negative number is a rise. lag: of the flap behind its voltage; flap: amplitude; both inboard / outboard.");
    unlike(figures, screen);
    if with_paper {
        screen.paragraphs(
            "The paper's numbers are for feedback on its own actuator, read from its text.",
        );
    }
}

/// What dissimilar blades leave of the reductions of the table, which is that of blades alike.
fn unlike(figures: &Figures, screen: &mut Sheet) {
    let Some((_, controlled)) = figures.unlike_blades.split_first() else { return };
    let each = controlled.iter().take(MOST_UNLIKE).map(|line| {
        let falls_percent = 100.0 * (1.0 - line.cost_ratio);
        format!("{} {falls_percent:.1} ({:.2})", line.flaps, line.other_cost_ratio)
    });
    let each = each.collect::<Vec<_>>().join("; ");
    screen.paragraphs(&format!(
        "The table is of blades alike. With the dissimilar blades of the case J falls by, percent (J of the other harmonics over J0): {each}."
    ));
}

fn row(set: String, line: &ControlLine, figures: &Figures) -> Vec<String> {
    let before = figures.baseline.hub_nb_per_rev.amplitudes();
    let after = line.head.hub_nb_per_rev.amplitudes();
    // a rotor without vibration has nothing to reduce
    let is_still = is_still(&figures.baseline.hub_nb_per_rev.parts());
    let percent = |text: String| if is_still { "-".to_owned() } else { text };
    let mut cells = vec![set, actuator_title(&line.head.actuator).to_owned()];
    cells.push(percent(format!("{:.1}", line.reduction_percent)));
    let loads = after.iter().zip(&before);
    cells.extend(loads.map(|(a, b)| percent(format!("{:.0}", 100.0 * (1.0 - a / b)))));
    let each = |pick: fn(&FlapLine) -> f64| match line.head.harmonics.as_slice() {
        [_] => line.each_flap(pick),
        _ => "-".to_owned(),
    };
    cells.extend([each(|flap| flap.lag_deg), each(|flap| flap.flap_amplitude_deg)]);
    cells.push(line.head.status.clone());
    cells
}

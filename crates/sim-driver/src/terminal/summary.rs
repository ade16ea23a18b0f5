//! The one screen of a run: the reduction of vibration first, then what it rests on.

use super::wake_note;
use crate::output::{Screen, table};
use crate::report::{actuator_title, is_paper, paper_numbers};
use crate::results::{ControlLine, Figures, StoredResult};
use rotor_study::{HubLoads, most_moved};
use std::path::Path;

/// What a summary is made of.
pub(crate) struct Summary<'a> {
    /// The result with its case.
    pub stored: &'a StoredResult,
    /// Its figures.
    pub figures: &'a Figures,
    /// Folder of the results and the report.
    pub folder: &'a Path,
}

/// Rows of controls that leave room for the rest of a screen.
const MOST_ROWS: usize = 24;

/// The screen of a run.
pub(crate) fn summary(of: &Summary<'_>) -> String {
    let (figures, case) = (of.figures, &of.stored.case);
    let mut screen = Screen::default();
    screen.line(&case.title);
    if figures.control.is_empty() {
        baseline(figures, &mut screen);
    } else {
        control(of, &mut screen);
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
    if let Some(note) = figures.wake.and_then(wake_note) {
        screen.labelled("Wake", note);
    }
    let r = &figures.residuals;
    screen.labelled(
        "Residuals",
        &format!("trim {:.1e}, periodicity {:.1e}, inflow {:.1e}", r.trim, r.periodicity, r.inflow),
    );
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
    let folder = of.folder.display();
    screen.labelled("Report", &format!("{folder}/report.html, numbers in {folder}/result.json"));
    screen.labelled("Details", &format!("every table: hhc report {folder} --details"));
    screen.finish()
}

/// The loads of a run without control.
fn baseline(figures: &Figures, screen: &mut Screen) {
    screen.line("\nHub loads at the blade number per rev, fixed frame, nondimensional; nothing is controlled");
    let amplitudes = figures.baseline.hub_nb_per_rev.amplitudes();
    screen.block(&table(
        &["load", "amplitude"],
        HubLoads::NAMES
            .iter()
            .zip(amplitudes)
            .map(|(name, a)| vec![name.to_uppercase(), format!("{a:.4e}")]),
    ));
}

/// What control does, the paper's numbers beside where it has them.
fn control(of: &Summary<'_>, screen: &mut Screen) {
    let figures = of.figures;
    let with_paper = is_paper(&of.stored.case);
    screen.line(
        "\nReduction of hub vibration, percent: J and the six loads at the blade number per rev",
    );
    let mut rows: Vec<Vec<String>> = Vec::new();
    for (k, line) in figures.control.iter().enumerate() {
        let is_first = k == 0 || figures.control[k - 1].harmonics != line.harmonics;
        let set = if is_first { format!("{}/rev", line.set_name()) } else { String::new() };
        rows.push(row(set, line, figures));
        let is_last =
            figures.control.get(k + 1).is_none_or(|next| next.harmonics != line.harmonics);
        if let Some(paper) = paper_numbers(&line.harmonics).filter(|_| with_paper && is_last) {
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
        screen.line(&format!("{more} more rows with --details"));
    }
    let any = |name: &str| figures.control.iter().any(|line| line.actuator == name);
    let meanings = [
        (any("ideal"), "ideal: actuator without hysteresis"),
        (any("ignored"), "ignored: its voltages on the real actuator"),
        (any("hysteretic"), "fed back: control on the real actuator"),
        (any("inverse"), "inverse: its motion through the inverse of the real actuator"),
    ];
    let meanings: Vec<&str> = meanings.iter().filter(|m| m.0).map(|m| m.1).collect();
    screen.wrapped(&format!("{}.", meanings.join("; ")));
    screen
        .wrapped("A negative number is a rise. lag: of the flap behind its voltage; flap: amplitude; both inboard / outboard.");
    if with_paper {
        screen.wrapped(
            "The paper's numbers are for feedback on its own actuator, read from its text.",
        );
    }
}

fn row(set: String, line: &ControlLine, figures: &Figures) -> Vec<String> {
    let before = figures.baseline.hub_nb_per_rev.amplitudes();
    let after = line.hub_nb_per_rev.amplitudes();
    // a rotor without vibration has nothing to reduce
    let is_still = line.reduction_percent == 0.0
        && rotor_study::is_still(&figures.baseline.hub_nb_per_rev.parts());
    let percent = |text: String| if is_still { "-".to_owned() } else { text };
    let mut cells = vec![set, actuator_title(&line.actuator).to_owned()];
    cells.push(percent(format!("{:.1}", line.reduction_percent)));
    let loads = after.iter().zip(&before);
    cells.extend(loads.map(|(a, b)| percent(format!("{:.0}", 100.0 * (1.0 - a / b)))));
    let each = |pick: &dyn Fn(&crate::results::FlapLine) -> f64| {
        if line.harmonics.len() != 1 {
            return "-".to_owned();
        }
        let all: Vec<String> = line.flaps.iter().map(|flap| format!("{:.1}", pick(flap))).collect();
        all.join(" / ")
    };
    cells.extend([each(&|flap| flap.lag_deg), each(&|flap| flap.flap_amplitude_deg)]);
    cells.push(line.status.clone());
    cells
}

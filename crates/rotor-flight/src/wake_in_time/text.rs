//! A rotor and its wake in time as a table and as CSV.

use super::{AGREES_PERCENT, Agreement, MeanLine, Verdict, WakeInTimeResult};
use report_page::{Column, Sheet, table_of};
use rotor_study::HubLoads;
use trim::RevolutionInTime;

/// The found means as text: controls, inflow, loads, each with its interval and what the periodic wake had.
pub fn wake_in_time_text(found: &WakeInTimeResult) -> String {
    let mut sheet = Sheet::default();
    let [all, measured] = found.revolutions;
    sheet.line(format_args!(
        "Rotor and free wake in time at mu {:.3}: {measured} of {all} revolutions measured, {}",
        found.advance_ratio,
        match (found.residual, found.balanced) {
            (None, _) => "controls prescribed".to_owned(),
            (Some(residual), true) => format!("means in trim to {residual:.1e} of the weight"),
            (Some(residual), false) => format!("means NOT in trim: {residual:.1e} of the weight"),
        }
    ));
    sheet.line(format_args!(
        "Steps per revolution: {} of the wake, {} of the blades. The periodic wake it began with had {}.",
        found.steps[0],
        found.steps[1],
        if found.periodic_settled { "settled" } else { "not settled" }
    ));
    if let Some(agreement) = &found.agreement {
        sheet.line(agreement_text(agreement));
    }
    sheet.line("");
    let lines: Vec<&MeanLine> = found.controls_deg.iter().chain(&found.inflow).collect();
    sheet.block(&mean_table(&lines, &[]));
    sheet.line("");
    sheet.line(
        "Hub loads at the blade number per rev, rotor units: amplitude, revolution by revolution",
    );
    let loads: Vec<&MeanLine> = found.amplitudes.iter().collect();
    sheet.block(&mean_table(&loads, &found.repeating));
    sheet.finish()
}

/// Whether the march and the periodic wake agree, and what to use.
fn agreement_text(found: &Agreement) -> String {
    let percent = |value: f64| format!("{value:.2} %");
    let half = found.loads_half_width_95_percent;
    let half = half.map_or("unknown".to_owned(), percent);
    let says = match found.verdict {
        Verdict::Agrees => format!("they agree to {AGREES_PERCENT} %: use either"),
        Verdict::Differs => format!(
            "they do NOT agree to {AGREES_PERCENT} %: the rotor does not keep the periodic wake, use the means"
        ),
        Verdict::Open => {
            format!("whether they agree to {AGREES_PERCENT} % is open: measure more revolutions")
        }
    };
    format!(
        "Means against the periodic wake: loads at the blade number {} of the vector off (+- {half}), mean inflow {} off; {says}.",
        percent(found.loads_off_percent),
        percent(found.inflow_off_percent)
    )
}

/// A mean, and of a load what repeats.
type MeanRow<'a> = (&'a MeanLine, Option<&'a f64>);

/// Means with their intervals, and of loads what repeats.
fn mean_table(lines: &[&MeanLine], repeating: &[f64]) -> String {
    let rows = lines.iter().enumerate().map(|(k, line)| (*line, repeating.get(k)));
    let interval = |(line, _): &MeanRow<'_>| line.half_width_95.map_or("unknown".to_owned(), four);
    let mut columns: Vec<Column<'_, MeanRow<'_>>> = vec![
        ("", &|(line, _)| line.name.clone()),
        ("mean", &|(line, _)| four(line.mean)),
        ("+- (95 %)", &interval),
        ("rms", &|(line, _)| four(line.rms)),
    ];
    if !repeating.is_empty() {
        columns
            .push(("repeats", &|(_, repeating)| repeating.map(|r| four(*r)).unwrap_or_default()));
    }
    columns.push(("periodic wake", &|(line, _)| line.periodic.map(four).unwrap_or_default()));
    table_of(rows, &columns)
}

fn four(value: f64) -> String {
    if value.abs() >= 0.01 { format!("{value:.4}") } else { format!("{value:.3e}") }
}

/// Every revolution of a march, a row each.
///
/// | column | meaning |
/// |---|---|
/// | `revolution` | from 1 |
/// | `measured` | 1 if it is one of those measured, 0 of settling |
/// | `theta0_deg`, `theta1c_deg`, `theta1s_deg` | controls |
/// | `mean_inflow` | over the disk, tip speed, down positive |
/// | `fx_mean` ... `mz_mean` | mean hub loads, rotor units |
/// | `fx_cos`, `fx_sin` ... `mz_sin` | hub loads at the blade number per rev, rotor units |
pub fn wake_in_time_csv(history: &[RevolutionInTime]) -> String {
    let mut header: Vec<String> =
        ["revolution", "measured", "theta0_deg", "theta1c_deg", "theta1s_deg", "mean_inflow"]
            .map(str::to_owned)
            .to_vec();
    header.extend(HubLoads::NAMES.map(|name| format!("{name}_mean")));
    header.extend(HubLoads::NAMES.iter().flat_map(|n| [format!("{n}_cos"), format!("{n}_sin")]));
    let row = |(k, r): (usize, &RevolutionInTime)| {
        let c = &r.controls;
        let mut cells = vec![(k + 1).to_string(), u8::from(r.measured).to_string()];
        cells.extend([c.theta0_rad, c.theta1c_rad, c.theta1s_rad].map(deg));
        cells.push(format!("{:.8}", r.mean_inflow));
        cells.extend(r.mean.iter().chain(&r.at_blade_number).map(|load| format!("{load:e}")));
        cells.join(",") + "\n"
    };
    let rows = history.iter().enumerate().map(row);
    std::iter::once(header.join(",") + "\n").chain(rows).collect()
}

fn deg(angle_rad: f64) -> String {
    format!("{:.6}", angle_rad.to_degrees())
}

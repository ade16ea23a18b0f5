//! The Preisach density with its deviation.

use crate::identification::{IdentifyResult, LEAST_SHARE};
use preisach_dyn::StaticPreisach;
use preisach_dyn::identify::DensitySpread;
use report_page::pictures::{HeatMap, short};
use report_page::{Markup, grid, titled};

const TITLE: &str = "Preisach density";

/// A value of a play and a cell of it.
type CellValue<'a> = dyn Fn(usize, usize) -> Option<f64> + 'a;

/// A map over the thresholds of the relays, upper upwards and lower across.
fn map(
    law: &StaticPreisach,
    title: &str,
    value: &CellValue<'_>,
    [input, output]: [&str; 2],
) -> Markup {
    let grid = law.grid();
    let (levels, cell) = (grid.levels(), grid.cell_volt());
    // a rise as the density of its cell
    let density = |rise: f64| rise / (2.0 * cell * cell);
    let middle = |k: usize| short(grid.range().lowest_volt() + (k as f64 + 0.5) * cell);
    // the row of alpha holds the cells of beta up to it
    let of = |alpha: usize| (0..=alpha).map(move |beta| value(alpha - beta, beta).map(density));
    let values: Vec<Vec<Option<f64>>> =
        (0..levels).rev().map(|alpha| of(alpha).collect()).collect();
    // the diagonal, the reversible part, may be far above all others
    let beside = values.iter().flat_map(|row| &row[..row.len() - 1]).flatten();
    let limit = beside.copied().fold(0.0, f64::max);
    HeatMap {
        title: title.to_owned(),
        note: format!(
            "up: alpha, across: beta, {input}; full colour {} {output}/{input}\u{b2}",
            short(limit)
        ),
        rows: (0..levels).rev().map(middle).collect(),
        columns: (0..levels).map(middle).collect(),
        values,
        limit: if limit > 0.0 { limit } else { 1.0 },
        is_square: true,
        ..HeatMap::default()
    }
    .markup()
}

/// Density and deviation of the static model of the slow runs.
pub(super) fn section(
    law: Option<&StaticPreisach>,
    spread: Option<&DensitySpread>,
    result: &IdentifyResult,
    units: [&str; 2],
) -> Markup {
    let Some(law) = law else {
        let text =
            "No static Preisach model was fitted. Record a slow major loop and reversal curves.";
        return titled("density", TITLE, text, &[]);
    };
    let rises = law.map().rises();
    let mut figures = vec![map(law, "density", &|j, k| Some(rises[j][k]), units)];
    let [determined, unknowns] = result.density_determined;
    let mut text = format!(
        "Of the static Preisach model fitted to the slow runs: relays that switch up at alpha and down at beta. The diagonal is the reversible part, its rise spread over a whole cell. The training runs determine {determined} of {unknowns} numbers."
    );
    match (spread, &result.density_spread) {
        (Some(spread), Some(line)) => {
            let known = |j: usize, k: usize| {
                let share = spread.record_share[j][k]?;
                spread.rise_std_deg[j][k].filter(|_| share >= LEAST_SHARE)
            };
            figures.push(map(law, "standard deviation", &known, units));
            text += " The deviation is what white noise of the runs does to the fit, by its equations with the smoothness and the bounds in use. What the model itself cannot follow is not in it. Empty cells are at their bound, or have less than a twentieth from the runs and the rest from their neighbours. ";
            text += &line.text(units[1]);
        }
        _ => {
            text += " Its deviation could not be computed: the equations of the fit are singular. Record a slow major loop and reversal curves.";
        }
    }
    titled("density", TITLE, &text, &[grid("grid wide", figures)])
}

/// Density of a model of reversal curves.
pub(super) fn of_curves(law: &StaticPreisach, units: [&str; 2]) -> Markup {
    let rises = law.map().rises();
    let figure = map(law, "density", &|j, k| Some(rises[j][k]), units);
    let text = "Relays that switch up at alpha and down at beta. The diagonal is the reversible part, its rise spread over a whole cell. No deviation: every curve was recorded once, so that its noise is not known. Record slow loops in several cycles as runs in time.";
    titled("density", TITLE, text, &[grid("grid wide", [figure])])
}

//! The page of a sweep: maps and carpets over two axes, parallel coordinates, what reduction costs in power.

use crate::store::Cell;
use crate::{Merged, MergedCase, SweepError};
use maud::{Markup, html};
use report_page::{
    Charts, Place3, carpet_chart, fronts_chart, grid, map_chart, page, parallel_chart, trade_chart,
};

/// What a page shows.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PageChoice {
    /// Axis to the right; the first with several numbers if left out.
    pub x: Option<String>,
    /// Axis upwards; the next one if left out.
    pub y: Option<String>,
    /// Columns to show; if empty every reduction of J, the loads at the blade number per rev without control, and every flap
    /// amplitude.
    pub of: Vec<String>,
    /// Only cases with these values on axes, `FIELD=VALUE`.
    pub at: Vec<String>,
}

/// Ends of the names of columns that are compared in the trade.
const REDUCTION: &str = "reduction_percent";
const POWER: &str = "actuation_power_W";
/// End of the names of flap amplitudes, and what follows the name of a load.
const AMPLITUDE: &str = "flap_amplitude_deg";
const LOAD: &str = "_nb_per_rev_";

/// Whether a column is shown if none is asked for.
fn is_usual(name: &str) -> bool {
    // fx_nb_per_rev_N: under a control the name begins with that
    let is_load = name.split_once(LOAD).is_some_and(|(load, _)| load.len() == 2);
    name.ends_with(REDUCTION) || is_load || name.ends_with(AMPLITUDE)
}

impl Merged {
    /// The HTML page of a sweep, whole in itself.
    ///
    /// # Errors
    /// A name that is no axis or column; a choice of cases that leaves none with numbers.
    pub fn page(&self, title: &str, choice: &PageChoice) -> Result<String, SweepError> {
        let cases = self.chosen(&choice.at)?;
        let of = if choice.of.is_empty() {
            self.columns.iter().filter(|name| is_usual(name)).cloned().collect()
        } else {
            choice.of.clone()
        };
        for name in of.iter().chain(&choice.x).chain(&choice.y) {
            self.known(name)?;
        }
        let axes: Vec<&String> = self.axes.iter().filter(|axis| spans(&cases, axis)).collect();
        if choice.x.is_some() && choice.x == choice.y {
            let message = "--x and --y are the same; give two axes".to_owned();
            return Err(SweepError::Choice(message));
        }
        let other = |than: Option<&String>| axes.iter().copied().find(|own| Some(*own) != than);
        let x = choice.x.as_ref().or_else(|| other(choice.y.as_ref()));
        let y = choice.y.as_ref().or_else(|| other(x));
        let mut charts = Charts::default();
        let body = html! {
            h1 { (title) }
            p { (cases.len()) " cases with numbers, " (self.cases.len() - cases.len()) " others of the " (self.cases.len()) }
            @if let (Some(x), Some(y)) = (x, y) {
                h2 { "Over two axes" }
                p { "Contours and a carpet where the cases are a grid; --at FIELD=VALUE takes a slice of one with further axes." }
                @for name in &of { (self.maps(&mut charts, &cases, [x, y], name)) }
            } @else if let Some(x) = x {
                h2 { "Over one axis" }
                @for name in &of { (self.curve(&mut charts, &cases, x, name)) }
            }
            h2 { "All axes" }
            (self.parallel(&mut charts, &cases, axes.iter().copied().chain(&of)))
            h2 { "Reduction of J against power" }
            p { "Power of the actuators of one blade. No case has more reduction for less power than those on the line." }
            @for name in self.columns.iter().filter(|name| name.ends_with(REDUCTION)) {
                (trade(&mut charts, &cases, name))
            }
            (self.failed())
        };
        Ok(page(title, &body, &charts))
    }

    fn known(&self, name: &str) -> Result<(), SweepError> {
        if self.axes.iter().chain(&self.columns).any(|own| own == name) {
            return Ok(());
        }
        let axes = self.axes.join(", ");
        Err(SweepError::Choice(format!(
            "{name} is no axis ({axes}) and no column of the sweep; the header of sweep.csv has all names"
        )))
    }

    /// The cases with numbers that have the wanted values.
    fn chosen(&self, at: &[String]) -> Result<Vec<&MergedCase>, SweepError> {
        let mut cases: Vec<&MergedCase> =
            self.cases.iter().filter(|case| case.failed.is_none()).collect();
        for wanted in at {
            let Some((field, value)) = wanted.split_once('=') else {
                let message =
                    format!("--at {wanted}: expected FIELD=VALUE, such as advance_ratio=0.2");
                return Err(SweepError::Choice(message));
            };
            if !self.axes.iter().any(|own| own == field) {
                let axes = self.axes.join(", ");
                let message = format!("--at {wanted}: {field} is no axis of the sweep ({axes})");
                return Err(SweepError::Choice(message));
            }
            cases.retain(|case| {
                let cell = case.values.iter().find(|(own, _)| own == field).map(|(_, cell)| cell);
                match (cell, value.parse::<f64>()) {
                    (Some(Cell::Number(own)), Ok(wanted)) => {
                        (own - wanted).abs() <= 1e-9 * own.abs()
                    }
                    (Some(Cell::Text(own)), _) => own == value,
                    _ => false,
                }
            });
        }
        if cases.is_empty() {
            let message = "no case with numbers is left to show; run the sweep, or choose other values with --at";
            return Err(SweepError::Choice(message.to_owned()));
        }
        Ok(cases)
    }

    /// A column over two axes: its map, and beside it a carpet where the cases are a grid.
    fn maps(
        &self,
        charts: &mut Charts,
        cases: &[&MergedCase],
        [x, y]: [&String; 2],
        name: &str,
    ) -> Markup {
        let place = |case: &&MergedCase| -> Option<Place3> {
            Some([Self::number(case, x)?, Self::number(case, y)?, Self::number(case, name)?])
        };
        let places: Vec<Place3> = cases.iter().filter_map(place).collect();
        let [x, y] = [x, y].map(|axis| self.with_unit(axis));
        let map = charts.figure("chart", name, "", &map_chart([&x, &y], &places));
        let carpet = carpet_chart([&x, &y, name], &places).map(|carpet| {
            let note = format!("Lines of one {x} and of one {y}; both go to the right.");
            charts.figure("chart", name, &note, &carpet)
        });
        grid("grid", std::iter::once(map).chain(carpet))
    }

    /// A column over one axis.
    fn curve(&self, charts: &mut Charts, cases: &[&MergedCase], x: &str, name: &str) -> Markup {
        let point = |case: &&MergedCase| -> Option<[f64; 2]> {
            Some([Self::number(case, x)?, Self::number(case, name)?])
        };
        let mut points: Vec<[f64; 2]> = cases.iter().filter_map(point).collect();
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        let plot = fronts_chart([&self.with_unit(x), name], &[(name.to_owned(), points)]);
        charts.figure("chart", name, "", &plot)
    }

    fn parallel<'a>(
        &self,
        charts: &mut Charts,
        cases: &[&MergedCase],
        names: impl Iterator<Item = &'a String>,
    ) -> Markup {
        // a column of some cases alone, as of one set of harmonics, would leave no line of the others
        let has = |case: &&MergedCase, name: &str| Self::number(case, name).is_some();
        let names: Vec<&String> =
            names.filter(|name| cases.iter().all(|case| has(case, name))).collect();
        let row = |case: &&MergedCase| -> Option<Vec<f64>> {
            names.iter().map(|name| Self::number(case, name)).collect()
        };
        let rows: Vec<Vec<f64>> = cases.iter().filter_map(row).collect();
        let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<f64>>();
        let columns = names.iter().enumerate().map(|(i, name)| (self.with_unit(name), column(i)));
        charts.figure(
            "chart tall",
            "Parallel coordinates",
            "Drag along an axis to choose cases. Only what every case has is shown.",
            &parallel_chart(columns.collect()),
        )
    }

    fn failed(&self) -> Markup {
        let failed = || self.cases.iter().filter_map(|case| Some((case, case.failed.as_ref()?)));
        html! {
            @if failed().next().is_some() {
                h2 { "Failed cases" }
                table {
                    tr { th { "case" } th { "key" } th { "reason" } }
                    @for (case, reason) in failed() {
                        tr { td { (case.case) } td { (case.key.chars().take(12).collect::<String>()) } td { (reason) } }
                    }
                }
            }
        }
    }
}

/// Whether an axis has several numbers.
fn spans(cases: &[&MergedCase], axis: &str) -> bool {
    let mut values = cases.iter().map(|case| Merged::number(case, axis));
    let first = values.next().flatten();
    first.is_some() && values.any(|value| value.is_some() && value != first)
}

fn trade(charts: &mut Charts, cases: &[&MergedCase], reduction: &str) -> Markup {
    let power = reduction.replace(REDUCTION, POWER);
    let point = |case: &&MergedCase| -> Option<[f64; 2]> {
        Some([Merged::number(case, &power)?, Merged::number(case, reduction)?])
    };
    let points: Vec<[f64; 2]> = cases.iter().filter_map(point).collect();
    let plot = trade_chart([&power, reduction], &points, &front(&points));
    charts.figure("chart", reduction, "", &plot)
}

/// The points `[cost, gain]` that no other beats in both, from the cheapest on.
fn front(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let mut sorted = points.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]).then(b[1].total_cmp(&a[1])));
    let mut best = f64::NEG_INFINITY;
    sorted.retain(|[_, gain]| {
        let better = *gain > best;
        best = best.max(*gain);
        better
    });
    sorted
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_what_no_point_beats() {
        let points = [[3.0, 5.0], [1.0, 2.0], [2.0, 1.0], [2.0, 4.0], [2.0, 3.0], [4.0, 5.0]];
        assert_eq!(front(&points), [[1.0, 2.0], [2.0, 4.0], [3.0, 5.0]]);
    }

    fn merged() -> Merged {
        let case = |i: usize| {
            let [a, b] = [0.1 * (i / 2) as f64, (i % 2) as f64];
            let found =
                [("ideal_reduction_percent", 10.0 * a + b), ("ideal_actuation_power_W", a + b)];
            MergedCase {
                case: i + 1,
                key: format!("{i:064}"),
                values: vec![
                    ("a".into(), a.into()),
                    ("b".into(), b.into()),
                    ("m".into(), Cell::Text("X".into())),
                ],
                failed: (i == 6).then(|| "<why>".to_owned()),
                found: found.map(|(name, value)| (name.to_owned(), value.into())).to_vec(),
                warnings: vec![],
            }
        };
        let names = |all: &[&str]| all.iter().map(|name| (*name).to_owned()).collect();
        Merged {
            axes: names(&["a", "b", "m"]),
            axis_units: names(&["kg", "", ""]),
            columns: names(&["ideal_reduction_percent", "ideal_actuation_power_W"]),
            cases: (0..7).map(case).collect(),
        }
    }

    #[test]
    fn the_usual_columns_are_reductions_loads_without_control_and_flap_amplitudes() {
        for (name, usual) in [
            ("ideal_3_per_rev_reduction_percent", true),
            ("fz_nb_per_rev_N", true),
            ("mx_nb_per_rev_N_m", true),
            ("ideal_3_per_rev_fz_nb_per_rev_N", false),
            ("ideal_3_per_rev_outboard_flap_amplitude_deg", true),
            ("ideal_3_per_rev_outboard_voltage_amplitude_V", false),
            ("fz_mean_N", false),
            ("theta0_deg", false),
        ] {
            assert_eq!(is_usual(name), usual, "{name}");
        }
    }

    #[test]
    fn the_page_shows_maps_lines_trade_and_failures() {
        let page = |choice: &PageChoice| merged().page("S & T", choice).map_err(|e| e.to_string());
        let text = page(&PageChoice::default()).unwrap();
        for part in [
            "S &amp; T",
            "\"contour\"",
            "Lines of one a [kg] and of one b",
            "parcoords",
            "&lt;why&gt;",
            "6 cases with numbers, 1 others",
        ] {
            assert!(text.contains(part), "{part}");
        }
        let choice = PageChoice { at: vec!["b=1".into()], ..PageChoice::default() };
        let text = page(&choice).unwrap();
        assert!(text.contains("3 cases with numbers"));
        // one axis is left: a curve over it
        assert!(text.contains("Over one axis") && !text.contains("Lines of one"));
        let named = |of: &str| PageChoice { of: vec![of.into()], ..PageChoice::default() };
        assert!(page(&named("nope")).unwrap_err().contains("nope is no axis (a, b, m)"));
        let at = |at: &str| PageChoice { at: vec![at.into()], ..PageChoice::default() };
        assert!(page(&at("b")).unwrap_err().contains("FIELD=VALUE"));
        assert!(page(&at("b=7")).unwrap_err().contains("no case with numbers"));
        assert!(page(&at("m=X")).is_ok());
        assert!(page(&at("ideal_actuation_power_W=1")).unwrap_err().contains("is no axis"));
        // an axis upwards leaves the other one to the right
        let axes = |x: Option<&str>, y: &str| PageChoice {
            x: x.map(str::to_owned),
            y: Some(y.to_owned()),
            ..PageChoice::default()
        };
        assert!(page(&axes(None, "a")).unwrap().contains("Lines of one b and of one a [kg]"));
        assert!(page(&axes(Some("a"), "a")).unwrap_err().contains("are the same"));
    }

    /// A column that some cases lack takes no line from the others.
    #[test]
    fn the_lines_are_of_what_every_case_has() {
        let lines = |merged: &Merged| -> usize {
            let page = merged.page("S", &PageChoice::default()).unwrap();
            let values = page.split("\"dimensions\":").nth(1).unwrap().split("\"values\":[").nth(1);
            values.unwrap().split(']').next().unwrap().split(',').filter(|v| !v.is_empty()).count()
        };
        let whole = merged();
        assert_eq!(lines(&whole), 6);
        let mut some = whole.clone();
        some.columns.push("other_reduction_percent".into());
        some.cases[0].found.push(("other_reduction_percent".into(), 1.0.into()));
        assert_eq!(lines(&some), 6);
    }
}

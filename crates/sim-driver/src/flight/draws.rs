//! Many draws of the noise, as a table and bands against time.

use super::page::{looks, panel};
use maud::{Markup, html};
use report_page::Section;
use report_page::pictures::{Look, PointForm, Series};
use rotor_flight::{DrawnCase, DrawnController};

/// For people.
pub(super) fn section(drawn: &DrawnCase) -> Section {
    let spread = |[low, middle, high]: [f64; 3]| format!("{middle:.3} ({low:.3} to {high:.3})");
    let row = |own: &DrawnController| {
        vec![
            own.controller.to_owned(),
            spread(own.mean_cost_ratio),
            spread(own.worst_cost_ratio),
            spread(own.end_cost_ratio),
            format!("{} of {}", own.above_j0, drawn.draws),
        ]
    };
    Section {
        title: "Draws of the noise".to_owned(),
        text: format!(
            "{} flights of each controller under the same draws, seeds from {} on. J/J0: the median, and 5 to 95 % of the draws.",
            drawn.draws, drawn.first_seed
        ),
        header: ["T", "mean J/J0", "worst", "end", "above J0"].map(str::to_owned).into(),
        rows: drawn.controllers.iter().map(row).collect(),
    }
}

/// The table, and a picture of every controller.
pub(super) fn markup(drawn: &DrawnCase) -> Markup {
    let lines = |own: &DrawnController| -> Vec<Series> {
        let names = ["5 % of the draws", "median", "95 %"];
        let of = |(k, name): (usize, &str)| Series {
            look: Look { name: name.to_owned(), colour: k, form: PointForm::Line },
            points: own.cycles.iter().map(|(time_s, shares)| [*time_s, shares[k]]).collect(),
            told: vec![],
        };
        names.into_iter().enumerate().map(of).collect()
    };
    html! {
        (section(drawn))
        @if let Some(first) = drawn.controllers.first() { (looks(&lines(first))) }
        div.grid {
            @for own in &drawn.controllers {
                (panel(&format!("{} T: J over J without control", own.controller), "J/J0", lines(own)))
            }
        }
    }
}

//! How wrong T may be along a flight, as a table of the worst and maps over speed.

use maud::{Markup, html};
use report_page::Section;
use report_page::pictures::HeatMap;
use rotor_flight::{MarginPoint, MarginSet, MarginStudy};
use rotor_study::HubLoads;

/// The least of some numbers, and where it is.
fn least(values: impl IntoIterator<Item = f64>) -> Option<(usize, f64)> {
    values.into_iter().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))
}

/// For people: of each set what is worst over the speeds.
pub(super) fn section(study: &MarginStudy) -> Section {
    let row = |set: &MarginSet| {
        let worst = |of: fn(&MarginPoint) -> f64| {
            least(set.points.iter().map(of)).map_or(f64::NAN, |(_, value)| value)
        };
        let of_one = |values: fn(&MarginPoint) -> &[f64], name: &dyn Fn(usize) -> String| {
            let each = set.points.iter().filter_map(|point| least(values(point).iter().copied()));
            let worst = each.min_by(|a, b| a.1.total_cmp(&b.1));
            worst.map_or_else(String::new, |(at, deg)| format!("{deg:.0} ({})", name(at)))
        };
        let flap = of_one(|p| &p.flap_overshoot_deg, &|flap| format!("flap {}", flap + 1));
        let load = of_one(|p| &p.load_phase_deg, &|load| HubLoads::NAMES[load].to_uppercase());
        let reach = |point: Option<&MarginPoint>, end: usize| {
            let held = point.and_then(|point| point.holds_within[end]);
            held.map_or_else(|| "all".to_owned(), |mu| format!("{mu:.3}"))
        };
        vec![
            names(set),
            format!("{:.1}", -worst(|p| -p.condition)),
            format!("{:.0}", worst(|p| p.common_phase_deg)),
            format!("{:.1}", worst(|p| p.common_gain)),
            format!("{:.0}", worst(|p| p.common_overshoot_deg)),
            flap,
            load,
            reach(set.points.first(), 1),
            reach(set.points.last(), 0),
        ]
    };
    let header = [
        "per rev",
        "condition",
        "phase",
        "gain",
        "J > J0",
        "one flap",
        "one load",
        "slowest T to",
        "fastest T to",
    ];
    Section {
        title: "How wrong T may be".to_owned(),
        text: format!(
            "The worst over the speeds, each error alone, angles in deg. Phase, gain and one load: where the loop with steps of {} diverges. J > J0, one flap: where J rises above J0 on the way. Slowest (fastest) T to: the advance ratio at which whole steps with the T of the lowest (highest) one diverge; all: nowhere within the flight.",
            study.gain
        ),
        header: header.map(str::to_owned).into(),
        rows: study.sets.iter().map(row).collect(),
    }
}

/// Harmonics of a set.
fn names(set: &MarginSet) -> String {
    set.harmonics.iter().map(usize::to_string).collect::<Vec<_>>().join(", ")
}

/// The table, and a map of every set.
pub(super) fn markup(study: &MarginStudy) -> Markup {
    let places: Vec<String> = study.advance_ratios.iter().map(|mu| format!("{mu:.3}")).collect();
    let map = |set: &MarginSet| {
        let beyond = |radius: &f64| Some(radius - 1.0);
        HeatMap {
            title: format!("{} per rev: T of a row flown at a column", names(set)),
            note: "Spectral radius of whole steps less 1: above zero the loop diverges.".to_owned(),
            rows: places.clone(),
            columns: places.clone(),
            values: set
                .points
                .iter()
                .map(|point| point.whole_step_radius.iter().map(beyond).collect())
                .collect(),
            limit: 1.0,
            ..HeatMap::default()
        }
    };
    html! {
        (section(study))
        div.grid { @for set in &study.sets { (map(set).markup()) } }
    }
}

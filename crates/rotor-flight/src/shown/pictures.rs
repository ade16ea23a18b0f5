//! Draws and margins of a flight as pictures of a page.

use crate::{DrawnCase, DrawnController, MarginPoint, MarginSet, MarginStudy, harmonic_names};
use report_page::pictures::{HeatMap, Look, Panel, PointForm, Series, legend};
use report_page::{Markup, grid};
use rotor_base::Limit;

/// A line through points and a dot on each of them, so that one point is seen too.
fn line(name: &str, colour: usize, points: Vec<[f64; 2]>) -> [Series; 2] {
    let of = |form| Look { name: name.to_owned(), colour, form };
    let told = points.iter().map(|[_, y]| format!("{name}: {y:.1}")).collect();
    [
        Series { look: of(PointForm::Line), points: points.clone(), told: vec![] },
        Series { look: of(PointForm::Dots), points, told },
    ]
}

/// What the lines of some series mean.
fn looks<'a>(series: impl IntoIterator<Item = &'a Series>) -> Markup {
    let lines = series.into_iter().filter(|own| own.look.form == PointForm::Line);
    legend(&lines.map(|own| own.look.clone()).collect::<Vec<_>>())
}

/// `J / J0` that 5, 50 and 95 % of the draws lie at or below against time, a picture for each controller.
pub fn draws_pictures(drawn: &DrawnCase) -> Vec<Markup> {
    let lines = |own: &DrawnController| -> Vec<Series> {
        let names = ["5 % of the draws", "median", "95 %"];
        let of = |(k, name): (usize, &str)| Series {
            look: Look { name: name.to_owned(), colour: k, form: PointForm::Line },
            points: own.cycles.iter().map(|(time_s, shares)| [*time_s, shares[k]]).collect(),
            told: vec![],
        };
        names.into_iter().enumerate().map(of).collect()
    };
    let panel = |own: &DrawnController| {
        let title = format!("{} T: J over J without control", own.controller);
        let axes = ["time, s", "J/J0"].map(str::to_owned);
        Panel { title, axes, series: lines(own), ..Panel::default() }.markup()
    };
    let key = drawn.controllers.first().map(|own| looks(&lines(own)));
    key.into_iter().chain([grid("grid", drawn.controllers.iter().map(panel))]).collect()
}

/// How wrong T may be against the advance ratio, and where it is flown at another one: pictures of every set of harmonics.
pub fn margins_pictures(study: &MarginStudy) -> Vec<Markup> {
    let phases = study.sets.iter().map(phase_panel);
    let gains = study.sets.iter().map(gain_panel);
    let maps = study.sets.iter().map(|set| speed_map(study, set));
    let keys = study.sets.first().map(|set| [looks(&phase_lines(set)), looks(&gain_lines(set))]);
    let [phase_key, gain_key] = keys.map_or([None, None], |keys| keys.map(Some));
    phase_key
        .into_iter()
        .chain([grid("grid", phases)])
        .chain(gain_key)
        .chain([grid("grid", gains)])
        .chain([grid("grid", maps)])
        .collect()
}

/// A limit at every advance ratio of its T; no number where there is none.
fn along(set: &MarginSet, of: impl Fn(&MarginPoint) -> Limit) -> Vec<[f64; 2]> {
    set.points.iter().map(|point| [point.advance_ratio, of(point).place()]).collect()
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Phase errors, deg: of all flaps and of one load where the loop diverges, of all flaps and of each where `J` overshoots.
fn phase_lines(set: &MarginSet) -> Vec<Series> {
    let flaps = set.points.first().map_or(0, |point| point.flap_overshoot_deg.len());
    let own = |name: &str, colour: usize, of: &dyn Fn(&MarginPoint) -> f64| {
        line(name, colour, along(set, |point| Limit::of_phase(of(point))))
    };
    let all = [
        own("all flaps: diverges", 0, &|p| p.common_phase_deg),
        own("worst load: diverges", 1, &|p| least(&p.load_phase_deg)),
        own("all flaps: J above J0", 2, &|p| p.common_overshoot_deg),
    ];
    let each = (0..flaps).map(|flap| {
        let name = format!("flap {}: J above J0", flap + 1);
        own(&name, 3 + flap, &|p| p.flap_overshoot_deg[flap])
    });
    all.into_iter().chain(each).flatten().collect()
}

/// Gains of the rotor over that of T where the loop diverges.
fn gain_lines(set: &MarginSet) -> Vec<Series> {
    let own = |name: &str, colour: usize, of: &dyn Fn(&MarginPoint) -> f64| {
        line(name, colour, along(set, |point| Limit::of_gain(of(point))))
    };
    let all = [
        own("all flaps: diverges", 0, &|p| p.common_gain),
        own("worst load: diverges", 1, &|p| least(&p.load_gain)),
    ];
    all.into_iter().flatten().collect()
}

fn phase_panel(set: &MarginSet) -> Markup {
    Panel {
        title: format!("{} per rev: phase error of T", harmonic_names(set)),
        note: "No point: no error up to 180 deg does harm.".to_owned(),
        axes: ["advance ratio of T", "phase error, deg"].map(str::to_owned),
        series: phase_lines(set),
        ..Panel::default()
    }
    .markup()
}

fn gain_panel(set: &MarginSet) -> Markup {
    Panel {
        title: format!("{} per rev: gain of the rotor over that of T", harmonic_names(set)),
        note: "No point: no gain up to 1000 does harm.".to_owned(),
        axes: ["advance ratio of T", "gain"].map(str::to_owned),
        is_log: [false, true],
        series: gain_lines(set),
        ..Panel::default()
    }
    .markup()
}

/// The radius with the T of every advance ratio at every other one.
fn speed_map(study: &MarginStudy, set: &MarginSet) -> Markup {
    let places: Vec<String> = study.advance_ratios.iter().map(|mu| format!("{mu:.3}")).collect();
    let beyond = |radius: &f64| Some(radius - 1.0);
    HeatMap {
        title: format!("{} per rev: T of a row flown at a column", harmonic_names(set)),
        note: "Spectral radius of whole steps less 1: above zero the loop diverges.".to_owned(),
        rows: places.clone(),
        columns: places,
        values: set
            .points
            .iter()
            .map(|point| point.whole_step_radius.iter().map(beyond).collect())
            .collect(),
        limit: 1.0,
        ..HeatMap::default()
    }
    .markup()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_study::HubLoads;

    fn study(gains: [f64; 2]) -> MarginStudy {
        let point = |(k, gain): (usize, f64)| MarginPoint {
            advance_ratio: 0.15 + 0.15 * k as f64,
            condition: 5.0,
            common_phase_deg: 75.5,
            common_gain: gain,
            common_overshoot_deg: 74.0,
            flap_overshoot_deg: vec![46.0, 47.0 - 30.0 * k as f64],
            load_phase_deg: vec![180.0, 180.0, 84.0, 180.0, 180.0, 180.0],
            load_gain: vec![f64::INFINITY; HubLoads::NAMES.len()],
            radius: vec![0.5; 2],
            whole_step_radius: vec![0.0, 1.2],
            holds_within: [None; 2],
        };
        let points: Vec<MarginPoint> = gains.into_iter().enumerate().map(point).collect();
        let sets = vec![MarginSet { harmonics: vec![2], points }];
        MarginStudy { gain: 0.5, advance_ratios: vec![0.15, 0.30], sets }
    }

    /// Every limit is a mark that says its value; what is unbounded is none, and not a number at the edge.
    #[test]
    fn every_limit_is_a_mark_and_an_unbounded_one_is_none() {
        let text = |gains| {
            let parts = margins_pictures(&study(gains));
            parts.into_iter().map(Markup::into_string).collect::<String>()
        };
        let page = text([4.0, f64::INFINITY]);
        for told in [
            "all flaps: diverges: 75.5",
            "worst load: diverges: 84.0",
            "all flaps: J above J0: 74.0",
            "flap 2: J above J0: 47.0",
            "flap 2: J above J0: 17.0",
            "all flaps: diverges: 4.0",
        ] {
            assert!(page.contains(&format!("<title>{told}</title>")), "{told}: {page}");
        }
        assert!(!page.contains("diverges: inf") && !page.contains("NaN"), "{page}");
        assert!(page.contains("2 per rev: T of a row flown at a column"));
        assert!(text([4.0; 2]).matches("diverges: 4.0").count() == 2);
    }
}

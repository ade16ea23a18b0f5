//! The page: complete, self-contained, safe against what titles may hold.

use super::{StudyReport, report_html};
use crate::case::{FreeWakeValues, InflowChoice, PAPER_CASE, shipped_case};
use crate::files::{SHIPPED_BENCH, read_bench, shipped};
use crate::results::{
    Baseline, BenchPart, ControlEnd, ControlHead, ControlRecord, FlapRecord, RunResult, SeriesLine,
    StoredResult, bench_loops, figures,
};
use crate::terminal::summary;
use bench_study::identification::identify_bench;
use preisach_dyn::identify::Settings;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_study::{HubLoads, MarginLine, RobustnessCell, Sensitivity, SensitivityRecord};
use std::path::Path;

/// A result with every part, the loops from the shipped bench.
fn example() -> StoredResult {
    let data = read_bench(&shipped(SHIPPED_BENCH)).unwrap();
    let settings = Settings { refinement_patience: 0, rounds: 1, ..Settings::default() };
    let found = identify_bench(&data, &settings, None).unwrap();
    let series = |mean: f64, amplitude: f64, phase: f64| {
        let mut series = HarmonicSeries::zero(3);
        series.mean = mean;
        series.set_harmonic(3, Harmonic::from_amplitude_phase(amplitude, phase));
        SeriesLine(series)
    };
    let flap = |phase: f64| FlapRecord {
        voltage_volt: series(65.0, 85.0, phase),
        flap_deg: series(0.0, 4.0, phase + 1.2),
        ..FlapRecord::default()
    };
    let loads =
        |size: f64| HubLoads::from_parts(std::array::from_fn(|k| size * 1e-4 / (k + 1) as f64));
    let control = |harmonic: usize, actuator: &str, left: f64| ControlRecord {
        head: ControlHead {
            harmonics: vec![harmonic],
            actuator: actuator.to_owned(),
            hub_nb_per_rev: loads(left),
            ..ControlHead::default()
        },
        end: ControlEnd { flaps: vec![flap(0.3), flap(2.0)], ..ControlEnd::default() },
        ..ControlRecord::default()
    };
    let record = SensitivityRecord { baseline: loads(4.0), hub_nb_per_rev: vec![loads(2.0)] };
    let result = RunResult {
        baseline: Baseline { hub_nb_per_rev: loads(4.0) },
        control: vec![
            control(2, "ideal", 2.0),
            control(3, "ideal", 2.0),
            control(3, "ignored", 3.5),
            control(3, "hysteretic </script>", 2.1),
        ],
        sensitivity: vec![Sensitivity {
            id: "case".to_owned(),
            assumption: "uniform inflow".to_owned(),
            record: Some(record),
            ..Sensitivity::default()
        }],
        robustness: vec![
            RobustnessCell { harmonic: 3, cycles: 40, ..RobustnessCell::default() };
            3
        ],
        margins: vec![MarginLine { harmonic: 3, common_phase_deg: 75.5, ..MarginLine::default() }],
        warnings: vec!["4/rev = 25.5 Hz is outside the tested range".to_owned()],
        ..RunResult::default()
    };
    let bench = BenchPart {
        data_title: data.title.clone(),
        fits: found.stored().runs,
        loops: bench_loops(&data, &found).unwrap(),
    };
    let mut case = shipped_case(PAPER_CASE).unwrap().case;
    case.title = "Example </script><b>page".to_owned();
    StoredResult::new(&case, Vec::new(), Some(bench), result).unwrap()
}

/// The page of a result.
fn page_of(stored: &StoredResult) -> String {
    let figures = figures(&stored.result, &stored.setting().unwrap());
    report_html(&StudyReport { stored, figures: &figures })
}

#[test]
fn the_screen_tells_how_wrong_t_may_be() {
    let stored = example();
    let figures = figures(&stored.result, &stored.setting().unwrap());
    let told = summary(&StudyReport { stored: &stored, figures: &figures }, Path::new("out"));
    assert!(told.contains("T at 3/rev: phase off by 76 deg diverges"), "{told}");
}

#[test]
fn the_page_is_complete_and_loads_nothing() {
    let stored = example();
    let page = page_of(&stored);
    assert_eq!(stored.bench.unwrap().loops.len(), 17, "every periodic run of the bench");
    let boxes = page.matches("<div class=\"chart").count();
    assert_eq!(boxes, 17 + 4 + 2, "loops, controls and sets of harmonics");
    for text in [
        "Beside the paper",
        "about 78",
        "Read first",
        "25.5 Hz",
        "What the paper leaves open",
        "uniform inflow",
        "Synthetic",
        "held out",
        "How wrong T may be, per harmonic",
        "3/rev under disturbance",
    ] {
        assert!(page.contains(text), "{text}");
    }
    // the plotting library is inside, the page's own part asks no network for anything
    assert!(page.contains("plotly.js v"), "plotly is embedded");
    let own = page.rsplit_once("plotly.js v").map(|(_, rest)| rest).unwrap();
    let own = own.split_once("</script>").map(|(_, rest)| rest).unwrap();
    // the namespace of the picture is a name, nothing to load
    let own = own.replace("xmlns=\"http://www.w3.org/2000/svg\"", "");
    for word in ["http://", "https://", "src=", "<link", "@import"] {
        assert!(!own.contains(word), "{word}");
    }
    // 4.7 MB of plotting library; the formula library that comes with it would add two more
    assert!(page.len() < 6_000_000, "{} bytes", page.len());
}

#[test]
fn titles_cannot_break_the_page() {
    let page = page_of(&example());
    // two scripts open and two close: library and charts
    assert!(!page.contains("</script><b>"), "title is escaped");
    let own = page.rfind("const charts").map(|i| &page[i..]).unwrap();
    assert_eq!(own.matches("</script>").count(), 1, "only the end of the script itself");
}

/// What the programs of this language print of a value for themselves.
#[test]
fn no_debug_text_is_on_a_page() {
    let mut stored = example();
    stored.case.inflow.model = InflowChoice::FreeWake(FreeWakeValues::default());
    let page = page_of(&stored);
    let own = page.rsplit_once("<body>").map(|(_, rest)| rest).unwrap();
    let own = own.split_once("<script>").map_or(own, |(text, _)| text);
    assert!(own.contains("free wake") && own.contains("Assumptions"));
    for debug in ["Some(", "None", "::", "File {", ": {", "[[", "FreeWake", "true,", "\\\""] {
        assert!(!own.contains(debug), "{debug}");
    }
}

#[test]
fn an_empty_report_is_a_page() {
    let case = shipped_case(PAPER_CASE).unwrap().case;
    let page = page_of(&StoredResult::new(&case, vec![], None, RunResult::default()).unwrap());
    assert!(page.contains("Trim and residuals") && !page.contains("Beside the paper"));
}

//! The page: complete, self-contained, safe against what titles may hold.

use super::{
    AzimuthChart, FlapTrace, HeadlineRow, LoadBars, ResultSection, StudyReport, report_html,
};
use crate::case::{FreeWakeValues, InflowChoice, PAPER_CASE, shipped_case};
use crate::files::{SHIPPED_BENCH, read_bench, shipped};
use crate::identification::identify_bench;
use crate::results::bench_loops;
use preisach_dyn::identify::Settings;

/// A report with every part, the loops from the shipped bench.
fn example() -> StudyReport {
    let data = read_bench(&shipped(SHIPPED_BENCH)).unwrap();
    let settings = Settings { refinement_patience: 0, rounds: 1, ..Settings::default() };
    let found = identify_bench(&data, &settings).unwrap();
    let azimuth_deg: Vec<f64> = (0..=72).map(|i| 5.0 * f64::from(i)).collect();
    let wave = |amplitude: f64, phase: f64| -> Vec<f64> {
        azimuth_deg.iter().map(|p| amplitude * ((3.0 * p).to_radians() - phase).cos()).collect()
    };
    let flap = |name: &str, phase: f64| FlapTrace {
        name: name.to_owned(),
        voltage_volt: wave(85.0, phase).iter().map(|u| 65.0 + u).collect(),
        flap_deg: wave(4.0, phase + 1.2),
    };
    StudyReport {
        title: "Example </script><b>page".to_owned(),
        program: format!("hhc {}", crate::VERSION),
        key: "0123456789abcdef".to_owned(),
        setting: vec!["A page to look at, not a result.".to_owned()],
        warnings: vec!["4/rev = 25.5 Hz is outside the tested range".to_owned()],
        data_title: data.title.clone(),
        headline: vec![
            HeadlineRow {
                quantity: "3/rev: reduction of J, %".to_owned(),
                paper: "about 78".to_owned(),
                ours: vec![("ideal".into(), "71".into()), ("hysteretic".into(), "68".into())],
            },
            HeadlineRow {
                quantity: "3/rev: lag, deg".to_owned(),
                paper: "about 41".to_owned(),
                ours: vec![("ideal".into(), "0".into()), ("hysteretic".into(), "65".into())],
            },
        ],
        fits: found.stored().runs,
        loops: bench_loops(&data, &found).unwrap(),
        azimuth: ["2/rev, hysteretic", "3/rev, hysteretic", "4/rev </script>"]
            .iter()
            .map(|title| AzimuthChart {
                title: (*title).to_owned(),
                azimuth_deg: azimuth_deg.clone(),
                flaps: vec![flap("inboard", 0.3), flap("outboard </script>", 2.0)],
            })
            .collect(),
        loads: ["2/rev", "3/rev", "4/rev"]
            .iter()
            .map(|title| LoadBars {
                title: (*title).to_owned(),
                before: [4.0e-4, 4.2e-4, 3.1e-4, 8.8e-5, 9.6e-5, 9.3e-6],
                after: vec![
                    ("ideal".into(), [2.0e-4, 2.2e-4, 1.1e-4, 5.8e-5, 6.6e-5, 7.3e-6], 71.0),
                    ("ignored".into(), [3.5e-4, 3.2e-4, 3.0e-4, 7.8e-5, 8.6e-5, 9.9e-6], 30.0),
                    ("hysteretic".into(), [2.1e-4, 2.4e-4, 1.2e-4, 5.9e-5, 6.7e-5, 7.5e-6], 68.0),
                ],
            })
            .collect(),
        sections: vec![ResultSection {
            title: "Sensitivity".to_owned(),
            text: "How the numbers move with what the paper leaves open.".to_owned(),
            header: vec!["assumption".into(), "2/rev".into(), "3/rev".into()],
            rows: vec![vec!["uniform inflow".into(), "20".into(), "60".into()]],
        }],
        ..StudyReport::default()
    }
}

#[test]
fn the_page_is_complete_and_loads_nothing() {
    let report = example();
    let page = report_html(&report);
    assert_eq!(report.loops.len(), 17, "every periodic run of the bench");
    let boxes = page.matches("<div class=\"chart").count();
    assert_eq!(boxes, report.loops.len() + report.azimuth.len() + report.loads.len());
    for text in
        ["Beside the paper", "about 78", "Read first", "25.5 Hz", "Sensitivity", "Synthetic"]
    {
        assert!(page.contains(text), "{text}");
    }
    // the plotting library is inside, the page's own part asks no network for anything
    assert!(page.contains("plotly.js v"), "plotly is embedded");
    let own = page.rsplit_once("plotly.js v").map(|(_, rest)| rest).unwrap();
    let own = own.split_once("</script>").map(|(_, rest)| rest).unwrap();
    for word in ["http://", "https://", "src=", "<link", "@import"] {
        assert!(!own.contains(word), "{word}");
    }
    // 4.7 MB of plotting library; the formula library that comes with it would add two more
    assert!(page.len() < 6_000_000, "{} bytes", page.len());
}

#[test]
fn titles_cannot_break_the_page() {
    let page = report_html(&example());
    // two scripts open and two close: library and charts
    assert!(!page.contains("</script><b>"), "title is escaped");
    let own = page.rfind("const charts").map(|i| &page[i..]).unwrap();
    assert_eq!(own.matches("</script>").count(), 1, "only the end of the script itself");
}

/// What the programs of this language print of a value for themselves.
#[test]
fn no_debug_text_is_on_a_page() {
    let mut report = example();
    let mut file = shipped_case(PAPER_CASE).unwrap().case;
    file.inflow.model = InflowChoice::FreeWake(FreeWakeValues::default());
    report.setting = super::assumptions::setting(&file);
    report.assumptions = super::assumptions::assumptions(&file);
    let page = report_html(&report);
    let own = page.rsplit_once("<body>").map(|(_, rest)| rest).unwrap();
    let own = own.split_once("<script>").map_or(own, |(text, _)| text);
    assert!(own.contains("free wake") && own.contains("Assumptions"));
    for debug in ["Some(", "None", "::", "File {", ": {", "[[", "FreeWake", "true,", "\\\""] {
        assert!(!own.contains(debug), "{debug}");
    }
}

#[test]
fn an_empty_report_is_a_page() {
    let page = report_html(&StudyReport { title: "empty".into(), ..StudyReport::default() });
    assert!(page.contains("Trim and residuals") && !page.contains("Beside the paper"));
}

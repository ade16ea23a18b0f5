//! The page that `hhc diagnose` writes: complete, well-formed, self-contained, and of the numbers in the files beside it.

use crate::place::{Place, QUICK_CASE};
use std::fmt::Write;

/// Sections that a page has, whatever the kind of data and the verdict.
const SECTIONS: [&str; 6] = ["why", "compared", "residuals", "fingerprints", "costs", "ground"];

/// Asserts what holds of every page, and returns it.
#[track_caller]
pub(crate) fn page(place: &Place, folder: &str) -> String {
    let page = place.read(&format!("{folder}/report.html"));
    assert!(page.starts_with("<!DOCTYPE html>") && page.len() < 2_000_000, "{}", page.len());
    for name in SECTIONS {
        section(&page, name);
    }
    for word in [
        "http://", "https://", "src=", "<link", "@import", "url(", "<script", "NaN", ">inf<",
        "\"inf\"",
    ] {
        assert!(!page.contains(word), "{word}");
    }
    let mut open: Vec<&str> = Vec::new();
    for tag in page.split('<').skip(2) {
        let (tag, _) = tag.split_once('>').unwrap();
        let name = tag.split([' ', '/']).find(|own| !own.is_empty()).unwrap();
        if tag.starts_with('/') {
            assert_eq!(open.pop(), Some(name), "</{name}>");
        } else if !tag.ends_with('/') && !["meta", "br"].contains(&name) {
            open.push(name);
        }
    }
    assert!(open.is_empty(), "{open:?}");
    page
}

/// The text of a section.
#[track_caller]
pub(crate) fn section<'a>(page: &'a str, name: &str) -> &'a str {
    let start =
        page.find(&format!("<section class=\"{name}\"")).unwrap_or_else(|| panic!("{name}"));
    let length = page[start..].find("</section>").unwrap();
    &page[start..start + length]
}

/// Asserts that the first map of a section shows a column of `residuals.csv`, number by number.
#[track_caller]
pub(crate) fn shows_residuals(page: &str, csv: &str, map: usize, column: usize) {
    let figure = section(page, "residuals").split("<figure>").nth(map + 1).unwrap();
    let mut rows = 0;
    for line in csv.lines().skip(1) {
        let cells: Vec<&str> = line.split(',').collect();
        let expected: f64 = cells[column].parse().unwrap();
        let told = format!("<title>{}, {}: ", cells[0], cells[1]);
        let shown = figure.split(&told).nth(1).unwrap_or_else(|| panic!("{told}"));
        let shown: f64 = shown.split(' ').next().unwrap().parse().unwrap();
        assert!((shown - expected).abs() <= 0.006 * expected.abs() + 1e-4, "{line}: {shown}");
        rows += 1;
    }
    assert_eq!(figure.matches("<title>").count(), rows, "nothing else is shown");
}

/// Names and lengths of the bars of the costs.
pub(crate) fn cost_bars(page: &str) -> Vec<(String, f64)> {
    let own = section(page, "costs").split("<figure").nth(1).unwrap();
    let own = own.split("</figure>").next().unwrap();
    let names = own
        .split("class=\"end")
        .skip(1)
        .map(|own| own.split_once('>').unwrap().1.split('<').next().unwrap().to_owned());
    let width = |own: &str| own.split("width=\"").nth(1)?.split('"').next()?.parse().ok();
    let widths = own.split("<rect").skip(1).filter_map(width);
    names.zip(widths).collect()
}

/// Asserts that the cause found stands first and costs least.
#[track_caller]
pub(crate) fn costs_least(page: &str, name: &str) {
    let bars = cost_bars(page);
    assert_eq!(bars[0].0, name, "{bars:?}");
    assert!(bars.len() > 1 && bars[1..].iter().all(|own| own.1 > bars[0].1), "{bars:?}");
    assert!(section(page, "costs").contains("nothing in its place"));
}

/// Two runs of a straight actuator, as it was and measured again with a stroke that grew by a fifth.
fn bench(place: &Place) {
    let mut runs = String::new();
    for (id, role, gain) in [
        ("slow", "Reference", 2.5),
        ("other", "Reference", 2.5),
        ("again", "Measured", 3.0),
        ("later", "Measured", 3.0),
    ] {
        let mut text = "time_s,command_V,displacement_um\n".to_owned();
        for i in 0..1500_u32 {
            let t = 0.002 * f64::from(i);
            let slower = if id == "slow" || id == "again" { 1.0 } else { 0.7 };
            let u = 65.0 + 70.0 * slower * (5.5 * slower * t).sin() * (0.85 * t).cos();
            let jitter = 0.05 * (f64::from(i * 7919 % 101) / 50.0 - 1.0);
            writeln!(text, "{t:.3},{u:.4},{:.4}", gain * (u - 65.0) + jitter).unwrap();
        }
        place.write(&format!("bench/{id}.csv"), &text);
        writeln!(runs, "(id: \"{id}\", file: \"{id}.csv\", role: {role}),").unwrap();
    }
    let head = "kind: ActuatorBench, title: \"grown </title><b>\", command_range_V: (-20, 150)";
    place.write("bench/dataset.ron", &format!("({head}, runs: [{runs}])"));
}

#[test]
fn runs_of_a_bench_have_a_page() {
    let place = Place::new();
    bench(&place);
    place.write("case.ron", QUICK_CASE);
    let told = place.hhc(&["diagnose", "case.ron", "--data", "bench", "-o", "out"]).done();
    // nothing in the folder of work but what was asked for
    let is_asked_for =
        |name: &String| ["bench/", "case.ron", "out/"].iter().any(|own| name.starts_with(own));
    assert!(place.listing().iter().all(is_asked_for), "{:?}", place.listing());
    assert!(!place.listing().iter().any(|name| name.contains("cache")), "{:?}", place.listing());
    let page = page(&place, "out");
    assert!(page.contains("Diagnosis: grown &lt;/title&gt;&lt;b&gt;"), "escaped");
    // the page says what the terminal says
    let verdict = told.lines().next().unwrap();
    assert!(section(&page, "why").contains("95 %") && page.contains(&verdict[..40]), "{verdict}");
    assert!(section(&page, "next").contains("Measure next: "));
    let found: serde_json::Value = serde_json::from_str(&place.read("out/findings.json")).unwrap();
    costs_least(&page, found["compared"][0]["instead_of"].as_str().unwrap());
    // the residual of every run, over the deviation that the table says
    for run in ["again", "later"] {
        let csv = place.read(&format!("out/residual_{run}.csv"));
        let column = |k: usize| -> f64 {
            let values: Vec<f64> = csv
                .lines()
                .skip(1)
                .map(|line| line.split(',').nth(k).unwrap().parse().unwrap())
                .collect();
            (values.iter().map(|v| v * v).sum::<f64>() / values.len() as f64).sqrt()
        };
        let row = page.split(&format!("<th>{run}</th>")).nth(1).unwrap();
        let numbers: Vec<f64> = row
            .split("<td>")
            .skip(1)
            .take(5)
            .map(|own| own.split('<').next().unwrap().parse().unwrap())
            .collect();
        for (shown, expected) in [(numbers[3], column(1)), (numbers[4], column(2))] {
            assert!((shown / expected - 1.0).abs() < 0.01, "{run}: {shown} {expected}");
        }
        let marks: Vec<f64> = section(&page, "residuals")
            .split("<title>before: ")
            .skip(1)
            .map(|own| own.split(' ').next().unwrap().parse().unwrap())
            .collect();
        let expected = column(1) / numbers[2];
        assert!(
            marks.iter().any(|own| (own / expected - 1.0).abs() < 0.02),
            "{marks:?} {expected}"
        );
    }
}

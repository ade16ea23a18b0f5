//! The page that `hhc identify` writes: complete, self-contained, and of the numbers that are printed.

use crate::diagnosis_page::section;
use crate::import::measured;
use crate::place::{Place, write_bench};
use serde_json::Value;
use std::f64::consts::TAU;

const SECTIONS: [&str; 8] =
    ["found", "loops", "response", "spectrum", "density", "forc", "models", "parameters"];

/// Asserts what holds of every page, and returns it.
#[track_caller]
fn page(place: &Place, name: &str) -> String {
    let page = place.read(name);
    assert!(page.starts_with("<!DOCTYPE html>") && page.len() < 2_000_000, "{}", page.len());
    for name in SECTIONS {
        assert!(section(&page, name).len() > 100, "{name}");
    }
    for word in ["http://", "https://", "src=", "<link", "<script", "NaN", ">inf<", "\"inf\""] {
        assert!(!page.contains(word), "{word}");
    }
    page
}

/// Cells of the rows of the table of a section.
fn rows(section: &str) -> Vec<Vec<String>> {
    // a section may have no table
    let body = section.split("<tbody>").nth(1).unwrap_or_default();
    let body = body.split("</tbody>").next().unwrap();
    let cells = |row: &str| {
        let cells = row.split("<t").filter(|cell| cell.starts_with("h>") || cell.starts_with("d>"));
        cells.map(|cell| cell[2..].split('<').next().unwrap().to_owned()).collect()
    };
    body.split("</tr>").filter(|row| row.contains("<t")).map(cells).collect()
}

/// Gain and lag, deg, of the last whole cycles of a loop table, by sums over them.
fn response(table: &str, hz: f64) -> [f64; 2] {
    let rows: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .map(|line| line.split(',').take(3).map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let step_s = rows[1][0] - rows[0][0];
    let end_s = rows[rows.len() - 1][0] + step_s;
    let used = rows.iter().filter(|row| row[0] > end_s - 3.0 / hz - 0.5 * step_s);
    let mut sums = [0.0; 4];
    for row in used {
        let (sin, cos) = (TAU * hz * row[0]).sin_cos();
        for (k, term) in
            [row[1] * cos, row[1] * sin, row[2] * cos, row[2] * sin].into_iter().enumerate()
        {
            sums[k] += term;
        }
    }
    let [uc, us, yc, ys] = sums;
    let lag = (ys.atan2(yc) - us.atan2(uc)).to_degrees();
    [yc.hypot(ys) / uc.hypot(us), (lag + 540.0).rem_euclid(360.0) - 180.0]
}

/// Every table of the page is that of the terminal.
#[track_caller]
fn shows_the_details(page: &str, details: &str) {
    for name in ["loops", "models", "parameters"] {
        for row in rows(section(page, name)) {
            let shown = |line: &&str| row.iter().all(|cell| line.contains(cell.as_str()));
            assert!(details.lines().any(|line| shown(&line)), "{name}: {row:?} in\n{details}");
        }
    }
    let start = section(page, "density").rfind("Of ").unwrap();
    let told = section(page, "density")[start..].split(';').next().unwrap();
    assert!(details.contains(told), "{told}");
}

/// Every number of the page is one of the JSON.
#[track_caller]
fn shows_the_json(page: &str, json: &Value) {
    let runs = json["runs"].as_array().unwrap();
    for run in runs {
        let (id, error) = (run["id"].as_str().unwrap(), run["nrmse_percent"].as_f64().unwrap());
        assert!(section(page, "loops").contains(&format!("NRMSE {error:.2} %")), "{id}");
    }
    let spread = &json["density_spread"];
    let told = format!(
        "Of {} cells {} are at their bound, zero, and {} have less than a twentieth",
        spread["cells"], spread["at_bound"], spread["from_neighbours"]
    );
    assert!(section(page, "density").contains(&told), "{told}");
    let found = rows(section(page, "response"));
    for row in &found {
        let run = runs.iter().find(|run| run["id"] == row[0].as_str()).unwrap();
        let near = |cell: usize, value: f64| {
            let shown: f64 = row[cell].parse().unwrap();
            assert!((shown - value).abs() <= 1e-3 * value.abs() + 1e-9, "{row:?}: {value}");
        };
        let number = |value: &Value| value.as_f64().unwrap();
        let own = &run["response"];
        let (gain, lag) = (number(&own["gain"]), number(&own["lag_deg"]));
        near(3, gain);
        near(5, gain * (1.0 + number(&run["amplitude_error_percent"]) / 100.0));
        near(6, lag);
        near(8, lag + number(&run["phase_error_deg"]));
    }
    let periodic = runs.iter().filter(|run| run["response"].is_object()).count();
    assert_eq!(found.len(), periodic);
}

#[test]
fn the_page_of_the_shipped_bench_shows_what_is_printed() {
    let place = Place::new();
    let bench = measured("../bench/apa500l_synthetic");
    let args = ["identify", &bench, "-o", "a.ron", "--figures", "f", "--format", "json"];
    let json = place.hhc(&args).json();
    assert_eq!(json["page_written_to"], "a.html");
    let page = page(&place, "a.html");
    shows_the_json(&page, &json);
    for part in ["sine_20hz_85v, held out", "major_0p2hz, trained"] {
        assert!(section(&page, "loops").contains(part), "{part}");
    }
    // both runs with reversals have a diagram, and tables of their points
    assert_eq!(section(&page, "forc").matches("<figure>").count(), 2);
    for name in ["forc_forc_from_150v", "forc_forc_from_minus20v", "residual_spectrum"] {
        assert!(place.read(&format!("f/{name}.csv")).lines().count() > 50, "{name}");
    }
    // gain and lag against the samples of the table of the loop
    for (run, hz) in [("sine_1hz_85v", 1.0), ("sine_20hz_25v", 20.0)] {
        let [gain, lag_deg] = response(&place.read(&format!("f/loop_{run}.csv")), hz);
        let all = rows(section(&page, "response"));
        let row = all.iter().find(|row| row[0] == run).unwrap();
        let shown: Vec<f64> = row[1..].iter().map(|cell| cell.parse().unwrap()).collect();
        assert!((shown[2] / gain - 1.0).abs() < 5e-3, "{run}: {gain} {row:?}");
        assert!((shown[5] - lag_deg).abs() < 0.3, "{run}: {lag_deg} {row:?}");
    }
    let spread = place.read("f/static_density.csv");
    assert!(spread.lines().next().unwrap().ends_with(",rise_sd_deg,record_share"), "{spread}");
}

/// One frequency and no reversal curves: each picture that is missing says what to record.
#[test]
fn the_page_of_a_measured_stage_says_what_is_missing() {
    let place = Place::new();
    let args = ["identify", &measured("piezo_stage"), "-o", "a.ron", "--format", "json"];
    let json = place.hhc(&args).json();
    let details =
        place.hhc(&["identify", &measured("piezo_stage"), "-o", "b.ron", "--details"]).done();
    let page = page(&place, "a.html");
    assert!(details.contains("Page written to b.html"), "{details}");
    assert_eq!(page, self::page(&place, "b.html"), "the same data, the same page");
    shows_the_json(&page, &json);
    shows_the_details(&page, &details);
    assert!(section(&page, "forc").contains("hold no first-order reversal curves. Record a run"));
    assert!(section(&page, "response").contains("record sines"));
}

#[test]
fn the_page_of_reversal_curves_has_every_section() {
    let place = Place::new();
    place.hhc(&["import", &measured("forc/hchb_forc"), "-o", "forc"]).done();
    let text = place.hhc(&["identify", "forc", "-o", "a.ron"]).done();
    assert!(text.contains("Page written to a.html"), "{text}");
    let page = page(&place, "a.html");
    assert_eq!(section(&page, "forc").matches("<figure>").count(), 1);
    assert!(section(&page, "response").contains("Record sines at three frequencies"));
}

#[test]
fn no_page_but_its_own_is_replaced_and_tables_are_those_printed() {
    let place = Place::new();
    write_bench(&place, "bench");
    place.write("a.html", "<html>mine</html>");
    let args = ["identify", "bench", "-o", "a.ron", "--model", "linear"];
    place
        .hhc(&args)
        .rejected(&["a.html exists already and is no file of kind page of hhc", "--force"]);
    assert_eq!(place.read("a.html"), "<html>mine</html>");
    assert!(!place.listing().contains(&"a.ron".to_owned()));
    let forced = ["identify", "bench", "-o", "a.ron", "--force", "--details"];
    let details = place.hhc(&forced).done();
    let found = page(&place, "a.html");
    shows_the_details(&found, &details);
    assert!(rows(section(&found, "parameters")).len() > 1, "{details}");
    place.hhc(&args).done();
    // nothing beside a device
    let text = place.hhc(&["identify", "bench", "-o", "/dev/null", "--model", "linear"]).done();
    assert!(!text.contains("Page written"), "{text}");
}

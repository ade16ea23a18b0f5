//! The page of a diagnosis of thrust measured at eight points: what was measured, what is left.
//!
//! ```text
//! cargo run --release -p diagnosis-page --example thrust_points > thrust.html
//! ```
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "the example prints what it makes")]

use diagnosis_page::{Words, points_page};
use model_gap::GapError;
use model_gap::points::{Channel, Instrument, Point, PointTable};

/// Thrust over the collective: measured and simulated, N.
const THRUST: [(f64, f64); 8] = [
    (101.2, 101.0),
    (149.6, 150.0),
    (200.3, 200.0),
    (250.9, 251.0),
    (299.2, 300.0),
    (350.4, 350.0),
    (401.1, 401.0),
    (449.5, 450.0),
];

fn main() -> Result<(), GapError> {
    let point = |(k, (measured, _)): (usize, (f64, f64))| Point {
        id: (k + 1).to_string(),
        measured: vec![Some(measured)],
        deviation: vec![0.5],
        ..Point::default()
    };
    let table = PointTable {
        points: THRUST.into_iter().enumerate().map(point).collect(),
        channels: vec![Channel { name: "thrust_N".into(), unit: "N".into(), ..Channel::default() }],
        instruments: vec![Instrument::default()],
        predicted: THRUST.iter().map(|(_, simulated)| vec![*simulated]).collect(),
        ..PointTable::default()
    };
    let found = table.find()?;
    eprintln!("verdict: {:?}", found.finding.verdict);
    let words = Words { verdict: "Nothing is missing.".into(), ..Words::default() };
    println!("{}", points_page(&table, &found, &found.findings(&table, "EffectTable"), &words));
    Ok(())
}

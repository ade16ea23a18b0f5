//! The same numbers as a table for the terminal and as a picture on a page that loads nothing.
//!
//! ```text
//! cargo run -p report-page --example loads_two_ways > loads.html
//! ```
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "the example prints what it makes")]

use report_page::pictures::{Mark, MarkForm, Row, RowScale, Rows};
use report_page::{Charts, page, table};

fn main() {
    let loads = [("without control", 312.0), ("with 3/rev", 88.0), ("with 2, 3 and 4/rev", 61.0)];
    let rows = loads.map(|(name, newton)| vec![name.to_owned(), format!("{newton:.0}")]);
    eprint!("{}", table(&["control", "4/rev thrust, N"], rows));

    let row = |(name, newton): (&str, f64)| Row {
        label: name.to_owned(),
        marks: vec![Mark {
            form: MarkForm::Bar,
            colour: 1,
            value: newton,
            told: format!("{name}: {newton} N"),
        }],
        ..Row::default()
    };
    let picture = Rows {
        axis: "4/rev thrust, N".to_owned(),
        scale: RowScale::Linear,
        rows: loads.map(row).into(),
    };
    println!("{}", page("Hub loads", &picture.markup(), &Charts::default()));
}

//! The validation page: every check has its row, failures are seen, staleness is noticed.
#![expect(clippy::disallowed_methods, reason = "tests read the shipped page")]

use xtask::validate::{
    AREAS, Check, CheckError, Criterion, Repeatability, Row, ids, render, run, stale_lines, text,
};
use xtask::workspace;

const HEADING: &str = "Area";

fn check(id: &'static str, measure: fn() -> Result<f64, CheckError>) -> Check {
    Check {
        id,
        quantity: "quantity",
        unit: "deg",
        source: "theory",
        criterion: Criterion::AtMost(1e-3),
        repeatability: Repeatability::Everywhere,
        measure,
    }
}

fn rows() -> Vec<Row> {
    let time = Check {
        repeatability: Repeatability::MachineDependent,
        criterion: Criterion::AtMost(20.0),
        unit: "s",
        ..check("time", || Ok(3.25))
    };
    let near = Check {
        criterion: Criterion::Near { expected: 2.0, within: 0.1 },
        ..check("near", || Ok(2.05))
    };
    vec![
        Row::of(HEADING, check("error", || Ok(4e-4))),
        Row::of(HEADING, near),
        Row::of("Times", time),
    ]
}

#[test]
fn a_page_is_fresh_until_a_figure_moves_by_more_than_the_scatter_of_machines() {
    let rows = rows();
    let page = render(&rows);
    assert!(rows.iter().all(Row::passes));
    assert_eq!(stale_lines(&page, &rows), Vec::<String>::new());
    let fresh = |from: &str, to: &str| {
        assert!(page.contains(from), "{page}");
        stale_lines(&page.replace(from, to), &rows)
    };
    // 1 % of the bound 1e-3 is 1e-5; a time may be anything
    assert!(fresh("4e-4", "4.05e-4").is_empty());
    assert!(fresh("3.25", "17").is_empty());
    for (from, to) in [
        ("4e-4", "4.2e-4"),
        ("2.05", "2.06"),
        ("≤ 20", "≤ 30"),
        ("quantity", "quality"),
        ("2.05", "not computed"),
        ("3 of 3", "2 of 3"),
        ("## Times", "## Clocks"),
    ] {
        assert!(!fresh(from, to).is_empty(), "{from} -> {to} passed unseen");
    }
    let shorter = page.lines().take(9).collect::<Vec<_>>().join("\n");
    assert!(!stale_lines(&shorter, &rows).is_empty());
}

#[test]
fn a_check_that_fails_or_cannot_be_computed_shows() {
    let too_large = Row::of(HEADING, check("large", || Ok(2e-3)));
    let no_number = Row::of(HEADING, check("nan", || Ok(f64::NAN)));
    let broken = Row::of(
        HEADING,
        check("broken", || Err(CheckError::TooFew { what: "modes", found: 1, needed: 8 })),
    );
    let rows = [too_large, no_number, broken];
    assert!(!rows.iter().any(Row::passes));
    let page = render(&rows);
    assert_eq!(page.matches("**no**").count(), 3, "{page}");
    assert!(page.contains("0 of 3 checks passed") && page.contains("not computed"), "{page}");
    assert!(text(&rows).contains("broken: only 1 values of modes"), "{}", text(&rows));
}

#[test]
fn ids_are_unique_and_follow_the_pattern() {
    let ids = ids();
    for (index, id) in ids.iter().enumerate() {
        assert_eq!(xtask::tidy::ids_in(id), [*id], "not V-AREA-NN");
        assert!(!ids[..index].contains(id), "{id} twice");
    }
    assert!(AREAS.iter().all(|area| !area.checks.is_empty()));
}

#[test]
fn a_filter_chooses_and_refuses_with_the_choice() {
    let rows = run("rotor-wake").unwrap();
    assert!(!rows.is_empty() && rows.iter().all(|row| row.check.id.starts_with("V-WAKE-")));
    let message = run("no such check").unwrap_err().to_string();
    assert!(message.contains("rotor-fem"), "{message}");
}

/// The page itself is compared by `cargo xtask validate --check`, which computes everything; here the
/// stored figures alone must say yes.
#[test]
fn the_shipped_page_has_no_failed_row() {
    let page = workspace::root().join("docs/src/validation.md");
    let page = std::fs::read_to_string(page).unwrap();
    assert!(!page.contains("**no**"), "a row of the page fails");
    let count = ids().len();
    assert!(page.contains(&format!("{count} of {count} checks passed")));
}

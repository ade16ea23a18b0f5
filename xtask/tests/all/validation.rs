//! The validation page: every check has its row, failures are seen, staleness is noticed.
#![expect(clippy::disallowed_methods, reason = "tests read the shipped page")]

use validation::{AREAS, Row, heading_of, ids, row};
use xtask::validate::{Collected, collect, render, run_tests, stale_lines, text};
use xtask::workspace;

/// Three rows of two areas.
fn rows() -> Vec<Row> {
    let [error, near, time] = [AREAS[0].ids[0], AREAS[0].ids[1], AREAS[1].ids[0]];
    let draft = |id, unit| row(id, "quantity", unit).against("theory");
    vec![
        Row::of(&draft(error, "deg").at_most(1e-3, || Ok(4e-4))),
        Row::of(&draft(near, "deg").near(2.0, 0.1, || Ok(2.05))),
        Row::of(&draft(time, "s").at_most(20.0, || Ok(3.25)).machine_dependent()),
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
        ("## Blade with", "## Clock of"),
    ] {
        assert!(!fresh(from, to).is_empty(), "{from} -> {to} passed unseen");
    }
    let shorter = page.lines().take(9).collect::<Vec<_>>().join("\n");
    assert!(!stale_lines(&shorter, &rows).is_empty());
}

#[test]
fn a_long_row_that_was_left_out_is_counted_and_compared_but_for_its_figure() {
    let stored = render(&rows());
    let mut rows = rows();
    let near = row(AREAS[0].ids[1], "quantity", "deg").against("theory").near(2.0, 0.1, || Ok(9.0));
    rows[1] = Row::left_out(&near.long());
    let fresh = |from: &str, to: &str| {
        assert!(stored.contains(from), "{stored}");
        stale_lines(&stored.replace(from, to), &rows)
    };
    assert!(fresh("2.05", "2.06").is_empty());
    let line = stored.lines().find(|line| line.contains("2.05")).unwrap();
    for (from, to) in [
        (line.to_owned(), line.replace("yes", "**no**")),
        (line.to_owned(), line.replace("2.05", "left out")),
        (line.to_owned(), line.replace("± 0.1", "± 0.2")),
        (format!("{line}\n"), String::new()),
        ("4e-4".to_owned(), "4.2e-4".to_owned()),
        ("3 of 3".to_owned(), "2 of 2".to_owned()),
    ] {
        assert!(!fresh(&from, &to).is_empty(), "{from} -> {to} passed unseen");
    }
    let folder = tempfile::tempdir().unwrap();
    for row in &rows {
        row.write(folder.path()).unwrap();
    }
    let collected = Collected { rows, missing: Vec::new() };
    assert!(collected.passes() && collected.left_out() == 1);
    let text = text(&collected);
    assert!(text.contains("2 of 3 checks passed, 1 were left to `cargo xtask validate`"), "{text}");
    let found = collect(folder.path(), AREAS[0].ids[1]).unwrap();
    assert!(found.missing.is_empty() && found.left_out() == 1);
}

#[test]
fn a_row_that_fails_cannot_be_computed_or_is_missing_shows() {
    let folder = tempfile::tempdir().unwrap();
    let area = &AREAS[2];
    let draft = |n: usize| row(area.ids[n], "quantity", "deg").against("theory");
    let bad = [
        draft(0).at_most(1e-3, || Ok(2e-3)),
        draft(1).at_most(1e-3, || Ok(f64::NAN)),
        draft(2).at_most(1e-3, || Err("no modes".into())),
    ];
    for check in &bad {
        Row::of(check).write(folder.path()).unwrap();
    }
    let collected = collect(folder.path(), area.heading).unwrap();
    assert!(!collected.passes() && !collected.rows.iter().any(Row::passes));
    assert_eq!(collected.missing, area.ids[3..]);
    let page = render(&collected.rows);
    assert_eq!(page.matches("**no**").count(), 3, "{page}");
    assert!(page.contains("0 of 3 checks passed") && page.contains("not computed"), "{page}");
    let text = text(&collected);
    assert!(text.contains(&format!("{}: no modes", area.ids[2])), "{text}");
    assert!(text.contains(&format!("{}: no test has written it", area.ids[3])), "{text}");
    std::fs::write(folder.path().join(format!("{}.ron", area.ids[3])), "no row").unwrap();
    let message = collect(folder.path(), "").unwrap_err().to_string();
    assert!(message.contains(area.ids[3]), "{message}");
}

#[test]
fn ids_are_unique_and_follow_the_pattern() {
    let ids: Vec<&str> = ids().collect();
    for (index, id) in ids.iter().enumerate() {
        assert_eq!(xtask::tidy::ids_in(id), [*id], "not V-AREA-NN");
        assert!(!ids[..index].contains(id), "{id} twice");
        assert!(heading_of(id).is_some());
    }
    assert!(AREAS.iter().all(|area| !area.ids.is_empty()));
}

#[test]
fn a_filter_that_matches_nothing_is_refused_with_the_choice() {
    let refused = run_tests(&workspace::root(), "no such check", "dev");
    let message = refused.unwrap_err().to_string();
    assert!(message.contains("rotor-fem"), "{message}");
}

/// The page itself is compared by `cargo xtask validate --check`, which computes everything; here the
/// stored figures alone must say yes.
#[test]
fn the_shipped_page_has_no_failed_row() {
    let page = workspace::root().join("docs/src/validation.md");
    let page = std::fs::read_to_string(page).unwrap();
    assert!(!page.contains("**no**"), "a row of the page fails");
    let count = ids().count();
    assert!(page.contains(&format!("{count} of {count} checks passed")));
}

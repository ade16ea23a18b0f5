//! The thresholds of the engine are those that the book lists.

/// One row for each constant of the thresholds: name, value, the first sentence of its description.
fn table() -> String {
    let mut rows = vec!["| number | value | meaning |\n|---|---|---|\n".to_owned()];
    let mut description = String::new();
    for line in include_str!("../../src/discovery/thresholds.rs").lines() {
        if let Some(text) = line.strip_prefix("///") {
            description += text;
            continue;
        }
        let own = line.strip_prefix("pub(super) ").or_else(|| line.strip_prefix("pub(crate) "));
        let constant = own.unwrap_or(line).strip_prefix("const ");
        if let Some((name, rest)) = constant.and_then(|own| own.split_once(':')) {
            let value = rest.split_once('=').map_or("", |own| own.1).trim().trim_end_matches(';');
            let meaning = description.trim().split(". ").next().unwrap_or_default();
            let meaning = meaning.trim_end_matches('.');
            rows.push(format!("| `{name}` | {value} | {meaning} |\n"));
        }
        description.clear();
    }
    rows.concat()
}

#[test]
fn the_book_lists_the_numbers_as_they_are() {
    let page = include_str!("../../../../docs/src/theory/discovery.md");
    assert!(
        page.contains(&table()),
        "the table of docs/src/theory/discovery.md must be:\n{}",
        table()
    );
}

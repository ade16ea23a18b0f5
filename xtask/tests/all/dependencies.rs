//! Every dependency is used; planted unused ones and licences are found.

use xtask::dependencies::{unlicensed, unused};
use xtask::layers::{Dependency, DependencyKind, Member};
use xtask::tidy::Tree;
use xtask::workspace;

#[test]
fn every_dependency_of_this_workspace_is_used() {
    let root = workspace::root();
    let found = unused(&workspace::members(&root).unwrap(), &Tree::load(&root).unwrap());
    let lines: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert!(lines.is_empty(), "{}", lines.join("\n"));
}

fn found(dependency: &str, kind: DependencyKind, files: &[(&str, &str)]) -> Vec<String> {
    let member = Member {
        name: "small".to_owned(),
        floor: Some(0),
        dependencies: vec![Dependency { name: dependency.to_owned(), kind }],
    };
    let mut all = vec![("crates/small/Cargo.toml", "[package]\nname = \"small\"\n")];
    all.extend_from_slice(files);
    unused(&[member], &Tree::of(&all)).iter().map(ToString::to_string).collect()
}

#[test]
fn a_dependency_counts_where_its_table_says() {
    use DependencyKind::{Development, Normal};
    let source = "//! num_complex in words only\nuse nalgebra::DMatrix;\n#[cfg(test)]\nmod tests { use approx::x; }\n";
    let files =
        [("crates/small/src/lib.rs", source), ("crates/small/tests/t.rs", "use proptest::p;")];
    assert!(found("nalgebra", Normal, &files).is_empty());
    assert!(found("approx", Development, &files).is_empty());
    assert!(found("proptest", Development, &files).is_empty());
    assert!(found("num-complex", Normal, &files)[0].contains("move it to [dev-dependencies]"));
    assert!(found("proptest", Normal, &files)[0].contains("move it to [dev-dependencies]"));
    assert!(found("faer", Normal, &files)[0].contains("remove the line"));
    // a word that only begins alike is another word
    assert!(found("nal", Normal, &files)[0].contains("remove the line"));
}

#[test]
fn licences_outside_the_list_are_found() {
    let package = |name: &str, licence: &str| {
        format!(r#"{{"name": "{name}", "version": "1.0.0", "license": {licence}}}"#)
    };
    let packages = [
        package("a", r#""MIT OR Apache-2.0""#),
        package("b", r#""MIT/Apache-2.0""#),
        package("c", r#""(MIT OR Apache-2.0) AND Unicode-3.0""#),
        package("d", r#""GPL-3.0-only""#),
        package("e", r#""MIT AND GPL-2.0-only""#),
        package("f", "null"),
    ];
    let json = format!(r#"{{"packages": [{}]}}"#, packages.join(","));
    let (count, refused) = unlicensed(json.as_bytes()).unwrap();
    let names: Vec<&str> = refused.iter().map(|found| found.package.as_str()).collect();
    assert_eq!((count, names), (6, vec!["d 1.0.0", "e 1.0.0", "f 1.0.0"]));
}

//! The rules of the house hold in this tree, and each is seen to fail on a planted breach.
#![expect(clippy::unwrap_used, reason = "a helper that fails is a test that fails")]

use xtask::layers::{Dependency, DependencyKind, LayerFault, Member, STUDY, brought_in, check};
use xtask::tidy::{self, Finding, Tree};
use xtask::{files, workspace};

fn member(name: &str, floor: u32, dependencies: &[(&str, DependencyKind)]) -> Member {
    Member {
        name: name.to_owned(),
        floor: Some(floor),
        dependencies: dependencies
            .iter()
            .map(|(name, kind)| Dependency { name: (*name).to_owned(), kind: *kind })
            .collect(),
    }
}

/// A small house without faults.
fn sound_house() -> Vec<Member> {
    use DependencyKind::{Development, Normal};
    vec![
        member("rotor-base", 0, &[("thiserror", Normal), ("proptest", Development)]),
        member("rotor-fem", 1, &[("rotor-base", Normal), ("csv", Development)]),
        member("flap-aero", 1, &[("rotor-base", Normal)]),
        member("rotor-response", 2, &[("rotor-fem", Normal), ("flap-aero", Normal)]),
        member("rotor-study", 4, &[("rotor-response", Normal)]),
        member("sim-driver", 6, &[("rotor-study", Normal), ("clap", Normal), ("ron", Normal)]),
        member("truth", 0, &[("clap", Normal)]),
        member("everyday-bench", 0, &[("clap", Normal)]),
        member(
            "score",
            1,
            &[("truth", Normal), ("everyday-bench", Normal), ("serde_json", Normal)],
        ),
        member("xtask", 9, &[("sim-driver", Normal), ("score", Normal), ("csv", Normal)]),
        member("e2e", 9, &[("sim-driver", Development), ("truth", Development)]),
    ]
}

/// The only fault of the sound house after one more line in the manifest of `user`.
fn fault_of(user: &str, dependency: &str, kind: DependencyKind) -> LayerFault {
    let mut house = sound_house();
    let planted = house.iter_mut().find(|member| member.name == user).unwrap();
    planted.dependencies.push(Dependency { name: dependency.to_owned(), kind });
    let mut faults = check(&house);
    assert_eq!(faults.len(), 1, "{faults:?}");
    let fault = faults.remove(0);
    let message = fault.to_string();
    assert!(message.contains(user) && message.contains(dependency), "{message}");
    fault
}

#[test]
fn this_workspace_keeps_the_layer_rule() {
    let members = workspace::members(&workspace::root()).unwrap();
    let faults: Vec<String> = check(&members).iter().map(ToString::to_string).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
    for name in
        ["rotor-base", "trim", "rotor-study", "sim-driver", "truth", "score", "xtask", "e2e"]
    {
        assert!(members.iter().any(|member| member.name == name), "{name} is no member");
    }
}

/// The studies know no file and no terminal, by whatever way.
#[test]
fn the_studies_are_built_without_files_and_terminal() {
    let found = workspace::tree(&workspace::root(), STUDY).unwrap();
    assert!(found.iter().any(|name| name == "hhc-control"), "{found:?}");
    assert_eq!(brought_in(&found), Vec::<&str>::new());
    let planted = [found, vec!["csv".to_owned(), "clap".to_owned()]].concat();
    assert_eq!(brought_in(&planted), ["csv", "clap"]);
}

#[test]
fn a_sound_house_has_no_faults() {
    assert_eq!(check(&sound_house()), []);
}

#[test]
fn an_upward_edge_is_a_fault_in_every_table() {
    use DependencyKind::{Build, Development, Normal};
    for kind in [Normal, Build, Development] {
        let fault = fault_of("rotor-fem", "rotor-response", kind);
        assert!(
            matches!(fault, LayerFault::NotDownward { floor: 1, dependency_floor: 2, .. }),
            "{fault}"
        );
    }
}

#[test]
fn a_sideways_edge_is_a_fault() {
    let fault = fault_of("flap-aero", "rotor-fem", DependencyKind::Normal);
    assert!(
        matches!(fault, LayerFault::NotDownward { floor: 1, dependency_floor: 1, .. }),
        "{fault}"
    );
    let fault = fault_of("e2e", "xtask", DependencyKind::Development);
    assert!(matches!(fault, LayerFault::NotDownward { floor: 9, .. }), "{fault}");
}

#[test]
fn truth_and_product_stay_apart() {
    for (user, dependency) in [
        ("truth", "rotor-base"),
        ("everyday-bench", "truth"),
        ("everyday-bench", "rotor-base"),
        ("sim-driver", "everyday-bench"),
        ("sim-driver", "truth"),
        ("rotor-fem", "truth"),
        ("score", "rotor-base"),
        ("sim-driver", "score"),
    ] {
        let fault = fault_of(user, dependency, DependencyKind::Development);
        assert!(matches!(fault, LayerFault::TruthNotApart { .. }), "{fault}");
    }
}

#[test]
fn a_reserved_crate_below_the_driver_is_a_fault() {
    for name in ["csv", "clap", "ron", "plotly", "tempfile"] {
        let fault = fault_of("flap-aero", name, DependencyKind::Normal);
        assert!(matches!(fault, LayerFault::Reserved { .. }), "{fault}");
    }
    assert!(matches!(
        fault_of("rotor-response", "ron", DependencyKind::Build),
        LayerFault::Reserved { .. }
    ));
}

#[test]
fn a_member_needs_a_floor_the_house_has() {
    let mut house = sound_house();
    house[2].floor = None;
    house.push(member("attic", 10, &[]));
    let faults = check(&house);
    assert_eq!(
        faults,
        [
            LayerFault::NoFloor { member: "flap-aero".to_owned() },
            LayerFault::UnknownFloor { member: "attic".to_owned(), floor: 10 }
        ]
    );
}

#[test]
fn the_answer_of_cargo_is_read() {
    use DependencyKind::{Build, Development, Normal};
    let answer = r#"{"packages": [
        {"name": "a", "metadata": {"house": {"layer": 1}}, "dependencies": [
            {"name": "b", "kind": null, "rename": "c"}, {"name": "d", "kind": "dev"},
            {"name": "e", "kind": "build"}]},
        {"name": "b", "metadata": null, "dependencies": []}]}"#;
    let members = workspace::members_of(answer.as_bytes()).unwrap();
    let kinds: Vec<DependencyKind> = members[0].dependencies.iter().map(|d| d.kind).collect();
    assert_eq!((members[0].floor, members[1].floor), (Some(1), None));
    assert_eq!(kinds, [Normal, Development, Build]);
    assert!(workspace::members_of(b"{}").is_err());
}

#[test]
fn this_tree_is_tidy() {
    let root = workspace::root();
    let tree = Tree::load(&root).unwrap();
    let members = workspace::members(&root).unwrap();
    let findings: Vec<String> =
        tidy::check(&tree, &members).iter().map(ToString::to_string).collect();
    assert!(findings.is_empty(), "{}", findings.join("\n"));
    assert!(tree.texts.len() > 100, "only {} texts were read", tree.texts.len());
}

/// The only finding of a rule in a tree.
fn one(findings: &[Finding], fault: &str) {
    assert_eq!(findings.len(), 1, "{findings:?}");
    assert!(findings[0].fault.contains(fault), "{findings:?}");
}

#[test]
fn breaches_in_sources_are_found() {
    let rust = |path: &str, text: &str| tidy::rust(&Tree::of(&[(path, text)]));
    let sound =
        "//! Sound.\n\n/// A todo list is fine.\n#[ignore = \"needs a cluster\"]\nfn f() {}\n";
    assert_eq!(rust("crates/trim/src/a.rs", sound), []);
    one(&rust("a.rs", "fn f() {}\n"), "//!");
    one(&rust("a.rs", "//! A.\n    #[should_panic(expected = \"x\")]\n"), "should_panic");
    one(&rust("a.rs", "//! A.\n#[ignore]\n"), "reason");
    one(&rust("a.rs", &"//! Long.\n".repeat(tidy::LINE_LIMIT + 1)), "lines");
    assert_eq!(rust("a.rs", &"//! Long.\n".repeat(tidy::LINE_LIMIT)), []);
    let example = |path: &str, lines: usize| rust(path, &"//! Long.\n".repeat(lines));
    for path in ["crates/trim/examples/a.rs", "crates/trim/examples/a.py"] {
        one(&example(path, tidy::EXAMPLE_LIMIT), "one task");
        assert_eq!(example(path, tidy::EXAMPLE_LIMIT - 1), []);
    }
    for word in [concat!("to", "do!()"), concat!("unimple", "mented!()"), concat!("// FIX", "ME")] {
        one(&rust("a.rs", &format!("//! A.\n{word}\n")), "undone");
    }
    let home = concat!("//! See /ho", "me/me/notes.\n");
    one(&rust("a.rs", home), "machine");
    assert_eq!(rust("a.rs", concat!("//! See framewo", "rk/a and docs/ho", "me/a.\n")), []);
}

#[test]
fn only_measured_data_and_the_driver_know_files() {
    let using = "//! A.\nuse std::fs::File;\n";
    let rust = |path: &str| tidy::rust(&Tree::of(&[(path, using)]));
    one(&rust("crates/trim/src/solve.rs"), "std::fs");
    for allowed in [
        "crates/sim-driver/src/a.rs",
        "crates/measured-data/src/a.rs",
        "crates/trim/tests/a.rs",
        "xtask/src/a.rs",
    ] {
        assert_eq!(rust(allowed), [], "{allowed}");
    }
    let documented = Tree::of(&[("crates/trim/src/a.rs", "//! A.\n/// No `std::time` here.\n")]);
    assert_eq!(tidy::rust(&documented), []);
}

#[test]
fn tests_without_the_checks_of_our_own_code_are_found() {
    let profile = |text: &str| tidy::profiles(&Tree::of(&[("Cargo.toml", text)]));
    let sound = "[profile.dev]\nopt-level = 2 # overflow-checks = false\n[profile.dev.package]\n\
                 \"*\" = { opt-level = 0, debug-assertions = false, overflow-checks = false }\n\
                 [profile.dev.package.\"*\"]\noverflow-checks = false\n\
                 [profile.release]\noverflow-checks = false\n";
    assert_eq!(profile(sound), []);
    for off in [
        "[profile.dev]\noverflow-checks = false",
        "[profile.test]\ndebug-assertions=false",
        "[profile.dev.package]\ntrim = { opt-level = 1, debug-assertions = false }",
        "[profile.dev.package.trim]\noverflow-checks = false",
    ] {
        one(&profile(&format!("{sound}{off}\n")), "leave them on");
    }
}

#[test]
fn breaches_in_manifests_are_found() {
    let sound = "[package]\nversion.workspace = true\n[lints]\nworkspace = true\n[dependencies]\n\
                 a.workspace = true\nb = { workspace = true, features = [\"c\"] }\n";
    let tree = |manifest: &str| {
        Tree::of(&[("crates/trim/Cargo.toml", manifest), ("crates/trim/README.md", "# trim")])
    };
    assert_eq!(tidy::manifests(&tree(sound)), []);
    one(&tidy::manifests(&tree(&format!("{sound}c = \"1\"\n"))), "workspace = true");
    one(&tidy::manifests(&tree("[package]\n")), "lints");
    one(&tidy::manifests(&Tree::of(&[("crates/trim/Cargo.toml", sound)])), "ten lines");
    let untested = |target: &str, source: &str, text: &str| {
        let manifest = format!("{sound}[{target}]\ntest = false # none\n");
        tidy::manifests(&Tree::of(&[("xtask/Cargo.toml", &manifest), (source, text)]))
    };
    let test = "    #[test]\n";
    one(&untested("lib", "xtask/src/a/b.rs", test), "never run");
    one(&untested("[bin]", "xtask/src/main.rs", test), "never run");
    for (target, source, text) in [
        ("lib", "xtask/src/a/b.rs", "/// `#[test]`\n"),
        ("lib", "xtask/src/main.rs", test),
        ("lib", "xtask/tests/a.rs", test),
        ("[bin]", "xtask/src/a.rs", test),
        ("[bench]", "xtask/src/main.rs", "fn main() {}"),
    ] {
        assert_eq!(untested(target, source, text), [], "{target} {source}");
    }
}

#[test]
fn breaches_in_documents_are_found() {
    let everything: Vec<(&str, &str)> =
        tidy::REQUIRED_FILES.into_iter().map(|path| (path, "")).collect();
    assert_eq!(tidy::required(&Tree::of(&everything)), []);
    one(&tidy::required(&Tree::of(&everything[1..])), "missing");
    let data = ("fixtures/reference/aero/table.csv", "");
    let unsourced: Vec<_> = everything.iter().copied().chain([data]).collect();
    one(&tidy::required(&Tree::of(&unsourced)), "where the numbers are from");

    let changelog = |text: &str| tidy::changelog(&Tree::of(&[("CHANGELOG.md", text)]));
    assert_eq!(changelog("# C\n\n## 1.0\n\n### Numbers changed\n\nNone.\n"), []);
    one(&changelog("# C\n\n## 1.0\n\n### Added\n"), "Numbers changed");
    one(&changelog("# C\n"), "no version");
}

#[test]
fn dead_links_and_lost_pages_are_found() {
    let files = [
        ("docs/src/SUMMARY.md", "# A\n[A](a.md)\n[Licence](../../LICENSE)\n"),
        (
            "docs/src/a.md",
            "[out](https://example.org) [in](SUMMARY.md#a) `x`](b)\n```\n[no](c.md)\n```\n",
        ),
        ("LICENSE", ""),
    ];
    one(&tidy::links(&Tree::of(&files)), "`b` leads nowhere");
    assert_eq!(tidy::summary(&Tree::of(&files)), []);
    let lost = [files[0], files[1], files[2], ("docs/src/lost.md", "")];
    one(&tidy::summary(&Tree::of(&lost)), "nobody will find it");
}

/// A link to a heading, here or on another page, by the name that the book gives it.
#[test]
fn links_lead_to_headings_that_are_there() {
    let page = "# How `x` is [checked](b.md)\n```text\n# no heading\n```\n## Twice\n## Twice\n";
    let findings = |link: &str| {
        let first = format!("{page}[l]({link})\n");
        tidy::links(&Tree::of(&[
            ("docs/src/a.md", &first),
            ("docs/src/b.md", "## A_b, c-d (e)!\n"),
        ]))
    };
    for link in ["#how-x-is-checked", "a.md#twice", "#twice-1", "b.md#a_b-c-d-e", "b.md"] {
        assert_eq!(findings(link), [], "{link}");
    }
    for (link, said) in [
        ("#no-heading", "`#no-heading` is no heading of docs/src/a.md"),
        ("b.md#how-x-is-checked", "is no heading of docs/src/b.md"),
        ("#twice-2", "no heading"),
        ("c.md#a", "`c.md` leads nowhere"),
    ] {
        one(&findings(link), said);
    }
}

#[test]
fn a_named_path_that_is_gone_and_a_row_that_is_a_paragraph_are_found() {
    let gone = "`crates/trim/src/law.rs`, `solve` and `crates/NAME/src`, `docs/src/a.md::x`\n";
    let files = [("docs/src/a.md", gone), ("crates/trim/src/solve.rs", "")];
    one(&tidy::named_paths(&Tree::of(&files)), "`crates/trim/src/law.rs` is not in the tree");
    let row = |length: usize| format!("| {} |\n{}\n", "x".repeat(length - 4), "y".repeat(400));
    assert_eq!(tidy::long_rows(&Tree::of(&[("docs/src/a.md", &row(300))])), []);
    one(&tidy::long_rows(&Tree::of(&[("docs/src/a.md", &row(301))])), "a row of 301 characters");
}

#[test]
fn the_code_map_must_agree_with_the_manifests() {
    let members = [member("trim", 3, &[]), member("truth", 0, &[])];
    let map = |text: &str| {
        tidy::floors_of_the_code_map(&Tree::of(&[("ARCHITECTURE.md", text)]), &members)
    };
    let truth = "| [`truth`](tests/truth) | 0 | data |\n";
    assert_eq!(
        map(&format!("| member | floor | |\n| [`trim`](crates/trim) | 3 | a |\n{truth}")),
        []
    );
    one(&map(&format!("| `trim` | 2 | a |\n{truth}")), "by its manifest");
    one(&map("| `trim` | 3 | a |\n"), "does not name `truth`");
    one(&map(&format!("| `trim` | 3 | a |\n{truth}| `attic` | 1 | b |\n")), "no member");
}

#[test]
fn validation_ids_belong_to_one_test_and_stand_on_the_page() {
    // put together here, so that this file mentions no id itself
    let id = |number: &str| format!("V-QQ-{number}");
    let (first, second) = (id("01"), id("02"));
    let page = format!("| id |\n|---|\n| {first} | a |\n| {second} | b |\n");
    let test = format!("row(\"{first}\", ..), row(\"{second}\", ..)");
    let found = |page: &str, texts: &[(&str, &str)], known: &[&str]| {
        let mut tree = vec![("docs/src/validation.md", page), ("tests/a.rs", test.as_str())];
        tree.extend(texts);
        tidy::validation_ids(&Tree::of(&tree), known)
    };
    let ids = |page: &str, source: &str, known: &[&str]| found(page, &[("b.rs", source)], known);
    let known = [first.as_str(), second.as_str()];
    assert_eq!(ids(&page, &format!("//! Test: {first}.\n"), &known), []);
    one(&ids(&page, "//! A.\n", &[known[0], known[1], known[1]]), "share");
    one(&ids(&page, &format!("//! {}\n", id("77")), &known), "no validation row");
    one(&ids(&format!("| {first} | a |\n"), "//! A.\n", &known), "has no row");
    // a row stated twice, and one that no test states
    one(&ids(&page, &format!("row(\"{first}\", ..)"), &known), "2 tests");
    let third = id("03");
    let longer = format!("{page}| {third} | c |\n");
    one(&ids(&longer, "//! A.\n", &[known[0], known[1], &third]), "0 tests");
    let odd = ids(&page, "//! A.\n", &[known[0], known[1], "V-qq-1"]);
    assert!(odd.iter().any(|finding| finding.fault.contains("V-AREA-NN")), "{odd:?}");
}

/// Every crate shows its user a task of his in a program that is read in one go; `.ci/examples` runs them.
#[test]
fn every_crate_has_an_example_of_at_most_80_lines() {
    let crates = files::in_folder(&workspace::root().join("crates")).unwrap();
    assert!(crates.len() > 20, "{crates:?}");
    for folder in crates {
        let examples = files::in_folder(&folder.join("examples")).unwrap();
        let is_short = |path: &std::path::PathBuf| {
            let ending = path.extension().is_some_and(|e| e == "rs" || e == "py");
            ending && files::read(path).unwrap().lines().count() <= 80
        };
        assert!(examples.iter().any(is_short), "{} has none", folder.display());
    }
}

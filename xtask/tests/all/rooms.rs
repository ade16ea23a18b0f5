//! The room rule holds in this tree, and is seen to fail on planted breaches.

use xtask::rooms::{FILES_OF_A_FOLDER, LINES_OF_A_CRATE, RoomFault, check, check_but};
use xtask::tidy::Tree;
use xtask::workspace;

/// A small crate without faults: two folders one above the other, an error that names what it carries, a folder
/// whose `mod.rs` uses what lies in it, tests that look upward.
const SOUND: [(&str, &str); 7] = [
    ("crates/a/src/lib.rs", "//! A.\nmod error;\nmod high;\nmod low;\npub use low::sum::Sum;\n"),
    ("crates/a/src/error.rs", "//! E.\nuse crate::high::top::Top;\npub enum Fault { At(Top) }\n"),
    ("crates/a/src/low/mod.rs", "//! L.\npub mod sum;\nfn f() { sum::g() }\n"),
    ("crates/a/src/low/sum.rs", "//! S.\nuse super::f;\npub struct Sum;\n"),
    ("crates/a/src/high/mod.rs", "//! H.\npub mod side;\npub mod top;\n"),
    ("crates/a/src/high/top.rs", "//! T.\nuse crate::{Sum, error::Fault};\npub struct Top;\n"),
    (
        "crates/a/src/high/side.rs",
        "//! D.\nuse super::top::Top;\n#[cfg(test)]\nmod tests { use crate::high::top; }\n",
    ),
];

/// The faults of the sound crate with the text of one file after its own.
fn faults_with(path: &str, text: &str) -> Vec<RoomFault> {
    let mut files: Vec<(&str, String)> =
        SOUND.iter().map(|(path, text)| (*path, (*text).to_owned())).collect();
    match files.iter_mut().find(|file| file.0 == path) {
        Some(file) => file.1.push_str(text),
        None => files.push((path, text.to_owned())),
    }
    let files: Vec<(&str, &str)> = files.iter().map(|(path, text)| (*path, &text[..])).collect();
    check_but(&Tree::of(&files), &[])
}

/// Folder and uses of the only fault, a circle.
fn circle(path: &str, text: &str) -> (String, Vec<String>) {
    let mut faults = faults_with(path, text);
    assert_eq!(faults.len(), 1, "{faults:?}");
    match faults.remove(0) {
        RoomFault::Circle { folder, uses } => (folder, uses),
        other => panic!("{other}"),
    }
}

#[test]
fn this_tree_keeps_the_room_rule() {
    let tree = Tree::load(&workspace::root()).unwrap();
    let faults: Vec<String> = check(&tree).iter().map(ToString::to_string).collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn a_sound_crate_has_no_faults() {
    assert_eq!(faults_with("crates/a/src/low/sum.rs", ""), []);
}

#[test]
fn a_circle_of_two_files_is_a_fault() {
    let (folder, uses) = circle("crates/a/src/high/top.rs", "fn f(x: super::side::Side) {}\n");
    assert_eq!(folder, "crates/a/src/high");
    assert_eq!(
        uses,
        [
            "  crates/a/src/high/side.rs:2: super::top::Top",
            "  crates/a/src/high/top.rs:4: super::side::Side",
        ]
    );
}

#[test]
fn a_use_from_a_low_folder_upward_is_a_fault_by_any_path() {
    for planted in [
        "use crate::high::top::Top;\n",
        "use crate::{high::{side, top as upper}};\n",
        "fn f() { crate::high::side::go() }\n",
        "use super::super::high;\nfn f() { high::top::go() }\n",
    ] {
        let (folder, uses) = circle("crates/a/src/low/sum.rs", planted);
        assert_eq!((folder.as_str(), uses.len()), ("crates/a/src", 2), "{planted}: {uses:?}");
        assert!(uses.iter().any(|line| line.contains("low/sum.rs:")), "{uses:?}");
    }
}

#[test]
fn a_use_through_a_re_export_counts() {
    // `high` uses `Sum` by the name at the root: the module that defines it is found
    let (_, uses) = circle("crates/a/src/low/mod.rs", "use crate::high::top::Top;\n");
    assert!(uses.iter().any(|line| line.ends_with("top.rs:2: crate::Sum")), "{uses:?}");
}

#[test]
fn a_circle_over_three_modules_is_shown_once() {
    let files = [
        ("crates/a/src/lib.rs", "//! A.\nmod b;\nmod c;\nmod d;\n"),
        ("crates/a/src/b.rs", "//! B.\nuse crate::c::X;\n"),
        ("crates/a/src/c.rs", "//! C.\nuse crate::d::X;\n"),
        ("crates/a/src/d.rs", "//! D.\nuse crate::b::X;\n"),
    ];
    let faults = check_but(&Tree::of(&files), &[]);
    assert!(matches!(&faults[..], [RoomFault::Circle { uses, .. }] if uses.len() == 3));
}

#[test]
fn comments_strings_and_test_files_use_nothing() {
    for text in [
        "// use crate::high::top::Top;\n",
        "const X: &str = \"\nuse crate::high::top::Top;\n\";\n",
        "#[cfg(test)]\nmod tests { use crate::high::top::Top; }\n",
    ] {
        assert_eq!(faults_with("crates/a/src/low/sum.rs", text), [], "{text}");
    }
    let files = [
        ("crates/a/src/lib.rs", "//! A.\nmod b;\nmod c;\n"),
        ("crates/a/src/b.rs", "//! B.\n#[cfg(test)]\nmod tests;\n"),
        ("crates/a/src/b/tests.rs", "//! T.\nuse crate::c::X;\n"),
        ("crates/a/src/c.rs", "//! C.\nuse crate::b::X;\n"),
    ];
    assert_eq!(check_but(&Tree::of(&files), &[]), []);
}

#[test]
fn a_crowded_folder_is_a_fault_unless_it_is_a_list() {
    let files: Vec<(String, &str)> = (0..=FILES_OF_A_FOLDER)
        .map(|i| (format!("crates/a/src/causes/c{i}.rs"), "//! C.\n"))
        .collect();
    let files: Vec<(&str, &str)> = files.iter().map(|(path, text)| (&path[..], *text)).collect();
    let tree = Tree::of(&files);
    let folder = "crates/a/src/causes".to_owned();
    let fault = RoomFault::Folder { folder, files: FILES_OF_A_FOLDER + 1 };
    assert_eq!(check_but(&tree, &[]), [fault]);
    let list = [("crates/a/src/causes", "one file a cause")];
    assert_eq!(check_but(&tree, &list), []);
    assert_eq!(check_but(&Tree::of(&files[1..]), &list).len(), 1, "a needless exception");
}

#[test]
fn a_long_crate_is_a_fault_whatever_its_comments_and_tests() {
    let of = |lines: usize| {
        let code = "fn f() {} // code\n\n/// not code\n".repeat(lines);
        let text = format!("//! A.\n{code}#[cfg(test)]\nmod tests {{\n{code}}}\n");
        check_but(&Tree::of(&[("crates/a/src/lib.rs", &text)]), &[])
    };
    assert_eq!(of(LINES_OF_A_CRATE), []);
    let fault = RoomFault::Length { member: "crates/a".to_owned(), lines: LINES_OF_A_CRATE + 1 };
    assert_eq!(of(LINES_OF_A_CRATE + 1), [fault]);
}

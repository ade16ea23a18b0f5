//! The command: its help, what it writes, and how it fails.
#![expect(clippy::disallowed_methods, reason = "the command's files are what is tested")]

use std::path::Path;
use std::process::{Command, Output};

fn truth(arguments: &[&str]) -> Output {
    match Command::new(env!("CARGO_BIN_EXE_truth")).args(arguments).output() {
        Ok(output) => output,
        Err(error) => panic!("the command does not start: {error}"),
    }
}

#[test]
fn help_says_what_it_is_for() {
    let help = String::from_utf8(truth(&["--help"]).stdout).unwrap();
    for word in ["synthetic", "hysteresis", "bench"] {
        assert!(help.contains(word), "no `{word}` in\n{help}");
    }
    let help = String::from_utf8(truth(&["bench", "--help"]).stdout).unwrap();
    assert!(help.contains("--out") && help.contains("--seed"), "{help}");
}

#[test]
fn another_seed_writes_a_complete_set_and_says_so_in_its_readme() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bench_seed_5");
    let output = truth(&["bench", "--out", folder.to_str().unwrap(), "--seed", "5"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let names: Vec<String> = std::fs::read_dir(&folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(names.len(), 21, "{names:?}");
    assert!(names.iter().all(|name| !name.contains("part")), "{names:?}");
    let readme = std::fs::read_to_string(folder.join("README.md")).unwrap();
    assert!(readme.contains("(this set: 5)") && !readme.contains('{'), "{readme}");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn an_unwritable_folder_is_named() {
    let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("not_a_folder");
    std::fs::write(&file, "").unwrap();
    let output = truth(&["bench", "--out", file.join("x").to_str().unwrap()]);
    assert!(!output.status.success());
    let message = String::from_utf8(output.stderr).unwrap();
    assert!(message.contains("not_a_folder") && message.contains("cannot write"), "{message}");
    std::fs::remove_file(file).unwrap();
}

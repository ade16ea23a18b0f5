//! The program alone in a folder of its own, killed in a study, and on a full disk. `cargo xtask kills` does more of it.
#![cfg(unix)]
#![expect(clippy::disallowed_methods, reason = "the program is copied, and its files are compared")]

use crate::place::{Place, QUICK_CASE};
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::time::Instant;

const STUDY: [&str; 6] = ["run", "case.ron", "--mu", "0.15,0.2,0.25", "--out", "out"];

/// Files of `out` with their content, but those that were being written.
fn whole_files(place: &Place) -> Vec<(String, Vec<u8>)> {
    let names = place.listing().into_iter();
    let whole = names.filter(|name| name.starts_with("out/") && !name.contains("/.hhc-"));
    whole.map(|name| (name.clone(), std::fs::read(place.path().join(&name)).unwrap())).collect()
}

/// At three moments of its run a study is killed: each file there is one of an undisturbed run, none is lost, and the next run
/// ends with the same bytes.
#[test]
fn a_killed_study_leaves_no_half_file() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    let begun = Instant::now();
    place.hhc(&STUDY).done();
    let took = begun.elapsed();
    let whole = whole_files(&place);
    assert!(whole.len() > 3 * 5, "{}", whole.len());
    std::fs::remove_dir_all(place.path().join("out")).unwrap();
    let mut met = 0;
    // other tests may end meanwhile, and the program be faster: earlier moments then
    for part in [0.9, 0.7, 0.4, 0.2, 0.1, 0.05] {
        if met == 3 {
            break;
        }
        let before = whole_files(&place);
        let mut child = Command::new(env!("CARGO_BIN_EXE_hhc"))
            .args(STUDY)
            .current_dir(place.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        std::thread::sleep(took.mul_f64(part));
        let ended = child.try_wait().unwrap().is_some();
        met += u32::from(!ended);
        child.kill().unwrap();
        child.wait().unwrap();
        let now = whole_files(&place);
        for file in &now {
            assert!(whole.contains(file), "{} is half there", file.0);
        }
        for (name, _) in before {
            assert!(now.iter().any(|(other, _)| *other == name), "{name} is lost");
        }
        if ended {
            // a study that is done is not computed again: nothing would be left to be met
            std::fs::remove_dir_all(place.path().join("out")).unwrap();
        }
    }
    assert!(met > 0, "no kill met the program running");
    place.hhc(&STUDY).done();
    assert!(whole_files(&place) == whole, "{:?}", place.listing());
}

fn shell(place: &Place, script: &str, args: &[&str]) -> Output {
    let mut command = Command::new("sh");
    command.args(["-c", script, env!("CARGO_BIN_EXE_hhc")]).args(args);
    command.current_dir(place.path()).output().unwrap()
}

/// A write that fails in its middle, a standard output without space, a place that takes no file: each an error that says so.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_told_and_leaves_nothing_half_there() {
    let place = Place::new();
    place.write("case.ron", QUICK_CASE);
    // the limit of file size stands for a full disk
    let full = "trap '' XFSZ; ulimit -f 1; exec \"$0\" \"$@\"";
    for args in [&STUDY[..], &["--inflow", "uniform", "--out", "out"], &["init", "new.ron"]] {
        let output = shell(&place, full, args);
        let said = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{args:?}: {said}");
        assert!(said.contains("cannot be written"), "{args:?}: {said}");
        assert_eq!(place.listing(), ["case.ron"], "{args:?}");
    }
    let output = shell(&place, "exec \"$0\" \"$@\" >/dev/full", &["modes", "case.ron"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(said.contains("standard output") && !said.contains("panicked"), "{said}");
    // a log on a full disk changes nothing
    let output = shell(&place, "exec \"$0\" \"$@\" 2>/dev/full", &["modes", "none.ron"]);
    assert_eq!(output.status.code(), Some(2));
    for args in
        [["run", "case.ron", "--out", "/proc/study"], ["run", "case.ron", "--out", "/dev/null/x"]]
    {
        place.hhc(&args).rejected(&["cannot be written"]);
    }
}

/// Copied elsewhere, without environment and with the repository out of sight where the system allows it, the program does
/// what needs shipped files.
#[test]
fn the_program_needs_no_file_of_the_repository() {
    let (place, other) = (Place::new(), Place::new());
    let program = other.path().join("hhc");
    std::fs::copy(env!("CARGO_BIN_EXE_hhc"), &program).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap();
    let hidden = "mount -t tmpfs none \"$1\" && shift && exec \"$@\"";
    let run = |hide: bool, args: &[&str]| {
        let mut command = Command::new(if hide { Path::new("unshare") } else { &program });
        if hide {
            command.args(["-rm", "sh", "-c", hidden, "sh"]).arg(&root).arg(&program);
        }
        let output = command.args(args).current_dir(place.path()).env_clear().output();
        output.is_ok_and(|output| output.status.success())
    };
    let hide = run(true, &["--version"]);
    place.write("quick.ron", QUICK_CASE);
    for args in [
        &["--version"][..],
        &["init", "case.ron"],
        &["check", "case.ron"],
        &["modes"],
        &["run", "quick.ron", "--out", "quick"],
        // the paper's study on the shipped bench
        &["--inflow", "uniform", "--out", "out"],
    ] {
        assert!(run(hide, args), "{args:?}, repository hidden: {hide}");
    }
    assert!(place.path().join("out/report.html").is_file());
}

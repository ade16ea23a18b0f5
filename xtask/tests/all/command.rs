//! The command `cargo xtask` from outside: exit codes and messages, and the sweep it runs.
#![expect(clippy::disallowed_methods, reason = "tests read and write golden files")]
#![expect(clippy::unwrap_used, reason = "a helper that fails is a test that fails")]

use std::process::{Command, Output};

use xtask::regress::{Program, Snapshot, SweepInflow, SweepPoint};
use xtask::workspace;

const POINT: SweepPoint =
    SweepPoint { advance_ratio: 0.30, harmonic_per_rev: 3, inflow: SweepInflow::Drees };

fn xtask(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_xtask")).args(arguments).output().unwrap()
}

fn shown(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn the_layer_rule_holds() {
    let output = xtask(&["layers"]);
    assert_eq!(output.status.code(), Some(0), "{}", shown(&output.stdout));
    assert!(shown(&output.stdout).contains("36 members, 0 faults"), "{}", shown(&output.stdout));
}

#[test]
fn bad_requests_are_exit_code_2_with_the_remedy() {
    for (arguments, remedy) in [
        (["regress", "--filter", "mu=0.31"], "0.15"),
        (["regress", "--filter", "speed=3"], "mu=0.30,n=3"),
        (["validate", "--filter", "no such check"], "rotor-fem"),
    ] {
        let output = xtask(&arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(shown(&output.stderr).contains(remedy), "{}", shown(&output.stderr));
    }
}

/// A shipped golden with one channel moved by 1 %: the command says which. (That the goldens as they
/// are agree is what `cargo xtask regress` itself is for.)
#[test]
fn a_moved_golden_makes_the_command_exit_with_code_3_and_name_the_channel() {
    let shipped = workspace::root().join("fixtures/golden").join(POINT.file_name());
    let mut golden = Snapshot::from_ron(&std::fs::read_to_string(shipped).unwrap()).unwrap();
    let controlled = |name: &str| name.starts_with("controlled");
    let group = golden.groups.iter_mut().find(|group| controlled(&group.name)).unwrap();
    let (name, value) = &mut group.channels[4];
    *value *= 1.01;
    let name = name.clone();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(POINT.file_name()), golden.to_ron().unwrap()).unwrap();
    let case = POINT.to_string();
    let folder = folder.path().to_str().unwrap();
    let output = xtask(&["regress", "--filter", &case, "--golden", folder]);
    let stdout = shown(&output.stdout);
    assert_eq!(output.status.code(), Some(3), "{stdout}");
    let named: Vec<&str> = stdout.lines().filter(|line| line.contains(&case)).collect();
    assert_eq!(named.len(), 1, "{stdout}");
    assert!(named[0].contains(&name) && named[0].contains("0.990 %"), "{stdout}");
}

#[test]
fn one_and_two_threads_give_the_same_bits() {
    let program = Program::new().unwrap();
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| program.sweep_point(POINT).unwrap())
    };
    assert_eq!(on(1), on(2));
}

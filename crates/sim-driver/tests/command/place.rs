//! Running `hhc` in a folder of its own.
#![expect(clippy::disallowed_methods, reason = "tests write the files they try the command on")]
#![expect(clippy::unwrap_used, reason = "a test that cannot set up its folder fails")]

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Output};

/// A folder for one test.
pub(crate) struct Place {
    folder: tempfile::TempDir,
}

impl Place {
    pub(crate) fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub(crate) fn path(&self) -> &Path {
        self.folder.path()
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        let path = self.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, text).unwrap();
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path().join(name)).unwrap()
    }

    /// Names of everything in the folder, sorted, folders ending in `/`.
    pub(crate) fn listing(&self) -> Vec<String> {
        let mut names = Vec::new();
        list(self.path(), "", &mut names);
        names.sort();
        names
    }

    /// Runs `hhc` here.
    pub(crate) fn hhc(&self, args: &[&str]) -> Ran {
        let output = Command::new(env!("CARGO_BIN_EXE_hhc"))
            .args(args)
            .current_dir(self.path())
            .output()
            .unwrap();
        Ran::new(args, &output)
    }
}

fn list(folder: &Path, prefix: &str, names: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().display());
        if entry.path().is_dir() {
            list(&entry.path(), &format!("{name}/"), names);
        } else {
            names.push(name);
        }
    }
}

/// What a run of `hhc` left.
pub(crate) struct Ran {
    pub(crate) code: i32,
    pub(crate) out: String,
    pub(crate) err: String,
    args: String,
}

impl Ran {
    fn new(args: &[&str], output: &Output) -> Self {
        Self {
            code: output.status.code().unwrap(),
            out: String::from_utf8(output.stdout.clone()).unwrap(),
            err: String::from_utf8(output.stderr.clone()).unwrap(),
            args: args.join(" "),
        }
    }

    /// Asserts success and returns what was printed.
    #[track_caller]
    pub(crate) fn done(self) -> String {
        assert_eq!(self.code, 0, "hhc {}\n{}\n{}", self.args, self.out, self.err);
        self.out
    }

    /// Asserts success and parses the JSON printed.
    #[track_caller]
    pub(crate) fn json(self) -> serde_json::Value {
        let out = self.done();
        match serde_json::from_str(&out) {
            Ok(value) => value,
            Err(error) => panic!("{error} in\n{out}"),
        }
    }

    /// Asserts exit code 2, nothing on standard output, and that the message holds every part.
    #[track_caller]
    pub(crate) fn rejected(self, parts: &[&str]) -> String {
        assert!(self.out.is_empty(), "hhc {} printed\n{}", self.args, self.out);
        self.failed(2, parts)
    }

    /// Asserts an exit code and that the message holds every part.
    #[track_caller]
    pub(crate) fn failed(self, code: i32, parts: &[&str]) -> String {
        assert_eq!(self.code, code, "hhc {}\n{}\n{}", self.args, self.out, self.err);
        assert!(!self.err.contains("panicked") && !self.err.contains("bug"), "{}", self.err);
        assert!(self.err.contains("error: "), "{}", self.err);
        for part in parts {
            assert!(self.err.contains(part), "hhc {}: no `{part}` in\n{}", self.args, self.err);
        }
        self.err
    }
}

/// A case that is quick to run: few modes, coarse in time, prescribed controls, no control.
pub(crate) const QUICK_CASE: &str = include_str!("quick.ron");

/// A small free wake: steps of 30 deg, two turns, eight panels.
pub(crate) const SMALL_WAKE: &str =
    "FreeWake(azimuths: 12, turns: 2, panels: 8, core_r: 0.05, near_core_r: 0.05, tolerance: 0.002,
        rolled_up: TipRootAndSheet, control_point: ThreeQuarterChord)";

/// A small bench: one slow loop, one faster one at two amplitudes.
pub(crate) fn write_bench(place: &Place, folder: &str) {
    let mut runs = String::new();
    for (id, hz, amplitude, step_s) in [
        ("slow", 0.2, 80.0, 0.02_f64),
        ("one_large", 1.0, 80.0, 0.005),
        ("one_small", 1.0, 20.0, 0.005),
        ("five", 5.0, 80.0, 0.001),
    ] {
        let mut text = "time_s,command_V,displacement_um\n".to_owned();
        let mut x = 0.0;
        for i in 0..=20_000 {
            let time = f64::from(i) * step_s;
            if time > 4.0 / hz {
                break;
            }
            let u = 65.0 + amplitude * (std::f64::consts::TAU * hz * time).sin();
            // a play and a lag: hysteresis of its own kind, stepped finely
            for _ in 0..20 {
                x += step_s / 20.0 / 0.01 * (2.5 * (u - 65.0) - x);
            }
            writeln!(text, "{time:.4},{u:.5},{x:.5}").unwrap();
        }
        place.write(&format!("{folder}/{id}.csv"), &text);
        writeln!(runs, "        (id: \"{id}\", file: \"{id}.csv\", role: Reference),").unwrap();
    }
    place.write(
        &format!("{folder}/dataset.ron"),
        &format!("(\n    kind: ActuatorBench,\n    title: \"a test's own bench\",\n    runs: [\n{runs}    ],\n    command_range_V: (-20, 150),\n)\n"),
    );
}

//! The discovery ladder: from a straight line to the extended actuator by data alone.
#![expect(clippy::disallowed_methods, reason = "tests write the folders they hand in")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sim_driver::case::{PAPER_CASE, shipped_case};
use sim_driver::diagnose::{Ladder, Records, Story, climb};
use sim_driver::files::{Folder, read_bench};
use sim_driver::output::{Printable, SCREEN};
use truth::hidden::{File, Hidden, Request, Size, measured_set, reference_files};

fn records(files: &[File], folder: &Path) -> Records {
    std::fs::create_dir_all(folder).unwrap();
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
    Records::from(&read_bench(&Folder::Disk(folder.to_path_buf())).unwrap())
}

/// The ladder on an actuator whose faster runs hide an effect of 7 % of the output; with further
/// experiments, if any.
fn ladder(hidden: &str, experiment: Option<&str>, cache: &Path) -> Ladder {
    let base = 8;
    let request = Request {
        hidden: Some(Hidden::parse(hidden).unwrap()),
        base: Some(base),
        share: Some(0.07),
        experiment: experiment.map(str::to_owned),
        ..Request::new(4, 40.0)
    };
    let folder = tempfile::tempdir().unwrap();
    let reference = reference_files(base, 40.0, Size::Small).unwrap();
    let reference = records(&reference, &folder.path().join("reference")).runs;
    let measured = measured_set(&request).unwrap();
    let measured = records(&measured.files, &folder.path().join("measured"));
    let loaded = shipped_case(PAPER_CASE).unwrap();
    let (ladder, found) = climb(&measured, &reference, &loaded, Some(cache), &|_| ()).unwrap();
    // what `hhc diagnose` prints fits a screen, the verdict first
    let text = Story::of(&found).text();
    let [width, height] = SCREEN;
    assert!(text.lines().count() <= height, "{text}");
    assert!(text.lines().all(|line| line.chars().count() <= width), "{text}");
    assert!(text.starts_with("Missing"), "{text}");
    ladder
}

#[test]
fn every_step_is_taken_because_data_ask_for_it() {
    let cache = tempfile::tempdir().unwrap();
    // a lag of the domains is told from one of the amplifier or of the sensor by a monitor and a second sensor
    let second_sensor = Some("laser-cross-check+amplifier-monitor");
    for (hidden, experiment) in
        [("rate-dependence", second_sensor), ("amplifier-current-limit", None)]
    {
        let ladder = ladder(hidden, experiment, cache.path());
        let [line, loops, extended] = ladder.rungs.as_slice() else {
            panic!("{hidden}: {ladder:?}");
        };
        // slow runs show a loop, and the loop is hysteresis, no lag and no play
        assert_eq!(line.lacks, ["hysteresis"], "{hidden}: {line:?}");
        // faster runs show what else is missing
        assert_eq!(loops.lacks, [hidden], "{hidden}: {loops:?}");
        assert!(extended.lacks.is_empty() && extended.verdict.is_none());
        // each step is a gain where it was asked for; the noise of 1 % stays
        for rung in [line, loops] {
            let [before, after] = rung.heldout_rms.unwrap();
            assert!(after < 0.9 * before, "{hidden}: {rung:?}");
        }
        assert!(loops.error_percent[0] < 0.5 * line.error_percent[0], "{hidden}: {ladder:?}");
        assert!(extended.error_percent[1] < loops.error_percent[1], "{hidden}: {ladder:?}");
        // loops make the flap later, and a rate makes it later still
        let lag = |i: usize| ladder.rungs[i].flap_3_per_rev[1];
        assert!(lag(0).abs() < 0.5 && lag(1) > lag(0) + 3.0, "{hidden}: {ladder:?}");
        assert!(hidden != "rate-dependence" || lag(2) > lag(1) + 1.0, "{hidden}: {ladder:?}");
        for rung in &ladder.rungs {
            assert!(rung.cost[1] < rung.cost[0], "{hidden}: {rung:?}");
        }
    }
}

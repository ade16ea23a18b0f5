//! Sets with hidden effects as the product meets them.
#![expect(clippy::disallowed_methods, reason = "tests write the folders they hand in")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::Path;

use sim_driver::files::{Folder, RunRole, read_bench};
use truth::hidden::{EXPERIMENTS, File, Hidden, Request, Size, measured_set, reference_files};

fn write(folder: &Path, files: &[File]) {
    std::fs::create_dir_all(folder).unwrap();
    for (name, text) in files {
        std::fs::write(folder.join(name), text).unwrap();
    }
}

/// Reads a folder of these files as the product does; its runs and samples.
fn accepted(files: &[File], role: RunRole, what: &str) -> (usize, usize) {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), files);
    match read_bench(&Folder::Disk(folder.path().to_path_buf())) {
        Ok(data) => {
            assert!(data.runs.iter().all(|run| run.role == role), "{what}");
            let samples = data.runs.iter().map(|run| run.table.time_s.len()).sum();
            (data.runs.len(), samples)
        }
        Err(problems) => panic!("{what}: {problems}"),
    }
}

/// The effects that could be taken for a broken record: much noise, leads, jumps, holds, more than the range.
const ROUGH: [&str; 5] = [
    "mechanical-resonance",
    "mains-hum",
    "voltage-saturation",
    "outside-random-jumps",
    "outside-intermittent-dropout",
];

#[test]
fn every_design_is_read_without_a_problem_even_with_much_noise() {
    for base in [1, 7, 9, 10] {
        let reference = reference_files(base, 20.0, Size::Small).unwrap();
        let (runs, samples) = accepted(&reference, RunRole::Reference, &format!("base {base}"));
        assert!(runs == 9 && samples < 30_000, "{runs} runs, {samples} samples");
        for id in ROUGH {
            let request = Request {
                hidden: Some(Hidden::parse(id).unwrap()),
                base: Some(base),
                share: Some(0.08),
                ..Request::new(base, 20.0)
            };
            let set = measured_set(&request).unwrap();
            accepted(&set.files, RunRole::Measured, &format!("{id} on base {base}"));
        }
    }
}

#[test]
fn every_experiment_is_read_without_a_problem() {
    for experiment in EXPERIMENTS {
        let request = Request { experiment: Some(experiment.to_owned()), ..Request::new(4, 20.0) };
        let set = measured_set(&request).unwrap();
        accepted(&set.files, RunRole::Measured, experiment);
    }
}

#[test]
fn a_full_set_has_twenty_runs_and_half_a_million_samples() {
    let request = Request { base: Some(0), size: Size::Full, ..Request::new(1, 40.0) };
    let base = request.assignment().base;
    let reference = reference_files(base, 40.0, Size::Full).unwrap();
    let (first, a) = accepted(&reference, RunRole::Reference, "reference");
    let (second, b) =
        accepted(&measured_set(&request).unwrap().files, RunRole::Measured, "measured");
    assert_eq!(first + second, 20);
    assert!((4e5..6e5).contains(&((a + b) as f64)), "{} samples", a + b);
}

//! The committed bench data are exactly what the generator writes, and within their limits.
#![expect(clippy::unwrap_used, reason = "a helper that fails fails its test")]
#![expect(clippy::disallowed_methods, reason = "the committed files are what is tested")]

use std::path::{Path, PathBuf};

use truth::actuator::ActuatorParameters;
use truth::bench::{self, BenchData};
use truth::record::{INTERNAL_RATE_HZ, Run};
use truth::report;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/bench/apa500l_synthetic")
}

fn committed(name: &str) -> String {
    let path = folder().join(name);
    match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) => panic!("{}: {error}", path.display()),
    }
}

fn generated(seed: u64) -> BenchData {
    bench::generate(ActuatorParameters::apa500l(), seed).unwrap()
}

#[test]
fn generator_reproduces_the_committed_files_byte_for_byte() {
    let files = report::files(&generated(bench::SEED)).unwrap();
    for (name, content) in &files {
        assert!(
            *content == committed(name),
            "{name} differs; regenerate with `cargo run --release -p truth -- bench --out \
             fixtures/bench/apa500l_synthetic`"
        );
    }
    let mut there: Vec<String> = std::fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    let mut expected: Vec<String> = files.into_iter().map(|(name, _)| name).collect();
    there.sort();
    expected.sort();
    assert_eq!(there, expected, "the folder holds the generated files and nothing else");
    let bytes: u64 = there.iter().map(|name| committed(name).len() as u64).sum();
    assert!(bytes < 3_000_000, "{bytes} bytes");
}

#[test]
fn every_record_is_finite_evenly_spaced_within_range_and_starts_at_rest() {
    for run in bench::programme(&ActuatorParameters::apa500l()) {
        let text = committed(&format!("{}.csv", run.id));
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("time_s,command_V,displacement_um"));
        let rate = f64::from(run.sample_rate_hz);
        let mut samples = 0;
        for line in lines {
            let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let [time_s, command_volt, displacement_um] = row[..] else { panic!("{line}") };
            assert!((time_s - f64::from(samples) / rate).abs() < 1e-9, "{}: {line}", run.id);
            assert!((-20.0..=150.0).contains(&command_volt), "{}: {line}", run.id);
            assert!(displacement_um.abs() < 300.0, "{}: {line}", run.id);
            if time_s <= run.rest_s {
                assert!((command_volt - 65.0).abs() < 1e-9, "{}: {line}", run.id);
                // Six standard deviations of the noise: 2e-5 chances in the 9000 samples of rest.
                assert!(displacement_um.abs() < 1.5, "{}: {line}", run.id);
            }
            samples += 1;
        }
        assert_eq!(usize::try_from(samples), Ok(run.samples(65.0)), "{}", run.id);
    }
}

#[test]
fn the_programme_holds_the_runs_a_dynamic_identification_needs() {
    let ids: Vec<String> =
        bench::programme(&ActuatorParameters::apa500l()).into_iter().map(|run| run.id).collect();
    let mut expected = vec!["major_0p2hz".to_owned()];
    expected.extend(["forc_from_150v", "forc_from_minus20v"].map(str::to_owned));
    for frequency in [1, 5, 10, 15, 20] {
        expected.extend([85, 55, 25].map(|volt| format!("sine_{frequency}hz_{volt}v")));
    }
    expected.push("mix_2_3_4_per_rev".to_owned());
    assert_eq!(ids, expected);
}

#[test]
fn another_seed_changes_the_noise_and_nothing_else() {
    let (first, other) = (generated(7), generated(8));
    for (a, b) in first.runs.iter().zip(&other.runs) {
        assert_eq!(a.exact, b.exact);
        assert_ne!(a.measured.displacement_um, b.measured.displacement_um);
    }
    // Two runs of one seed do not share their noise either.
    let rest = |run: usize| first.runs[run].measured.displacement_um[..50].to_vec();
    assert_ne!(rest(1), rest(2));
}

#[test]
fn halving_the_internal_step_changes_every_run_by_far_less_than_the_noise() {
    let actuator = ActuatorParameters::apa500l();
    for run in bench::programme(&actuator) {
        let at =
            |rate: u32| run.pass_through(&mut actuator.chain().unwrap(), &actuator, rate).unwrap();
        let change = largest_difference(
            &at(INTERNAL_RATE_HZ).displacement_um,
            &at(2 * INTERNAL_RATE_HZ).displacement_um,
        );
        // Noise 0.25 um, one count 0.015 um.
        assert!(change < 0.001, "{}: {change} um", run.id);
    }
}

#[test]
fn integration_is_of_second_order() {
    let actuator = ActuatorParameters::apa500l();
    let run: Run =
        bench::programme(&actuator).into_iter().find(|run| run.id == "sine_20hz_85v").unwrap();
    let at = |rate: u32| {
        run.pass_through(&mut actuator.chain().unwrap(), &actuator, rate).unwrap().displacement_um
    };
    let exact = at(256_000);
    let errors = [8_000, 16_000, 32_000].map(|rate| largest_difference(&at(rate), &exact));
    for pair in errors.windows(2) {
        let ratio = pair[0] / pair[1];
        assert!((3.5..4.6).contains(&ratio), "ratio {ratio}, errors {errors:?} um");
    }
}

fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

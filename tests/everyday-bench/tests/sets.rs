//! Whole sets: strengths, step of integration, bytes.

use everyday_bench::catalogue::{CATALOGUE, LIBRARY};
use everyday_bench::family::Family;
use everyday_bench::hidden::{Deal, Hidden, Kind};
use everyday_bench::set::{Request, Truth, set, truth};
use everyday_bench::simulate::Trace;

fn request(family: Family, seed: u64, hidden: &str) -> Request {
    let hidden = hidden.parse().unwrap_or_else(|error| panic!("{error}"));
    Request { hidden, ..Request::new(family, seed, Deal::All) }
}

fn rms_apart(a: &Trace, b: &Trace) -> f64 {
    let pairs = a.displacement_um.iter().zip(&b.displacement_um);
    let sum: f64 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
    (sum / a.displacement_um.len() as f64).sqrt()
}

/// Measured runs of an effect; half the step changes them by less than a tenth of the noise at 40 dB.
fn checked(i: usize) -> Truth {
    let entry = CATALOGUE[i];
    let family = if i.is_multiple_of(2) { Family::Relays } else { Family::Duhem };
    let asked = Request { share: Some(0.03), ..request(family, 100 + i as u64, entry.id) };
    let (usual, fine) = (truth(&asked, 1), truth(&asked, 2));
    let pairs = usual.measured.iter().zip(&fine.measured);
    let worst = pairs.map(|(a, b)| rms_apart(&a.1, &b.1)).fold(0.0, f64::max);
    let noise = usual.noise_um;
    assert!(worst < 0.1 * noise, "{}: {worst} um, noise {noise} um", entry.id);
    usual
}

#[test]
fn causes_of_the_library_reach_their_share_whatever_the_step() {
    for (i, entry) in CATALOGUE[..LIBRARY].iter().enumerate() {
        let share = checked(i).effect_share;
        assert!((share / 0.03 - 1.0).abs() < 0.03, "{}: {share}", entry.id);
    }
}

#[test]
fn everyday_errors_have_an_effect_where_they_should_whatever_the_step() {
    for (i, entry) in CATALOGUE.iter().enumerate().skip(LIBRARY) {
        let share = checked(i).effect_share;
        if entry.id.starts_with("monitor") || entry.id == "small-reference" {
            assert!(share.abs() < 1e-12, "{}", entry.id);
        } else {
            assert!((0.002..0.6).contains(&share), "{}: {share}", entry.id);
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_bytes_and_another_draw_other_noise() {
    let asked = Request::new(Family::Duhem, 12, Deal::Everyday);
    let first = set(&asked);
    assert_eq!(first, set(&asked));
    let other = set(&Request { draw: 1, ..asked.clone() });
    assert_eq!(other.answer, first.answer);
    assert_ne!(other.measured[0].1, first.measured[0].1);
    assert_ne!(other.reference[0].1, first.reference[0].1);
    let samples = |files: &[(String, String)]| -> usize {
        files.iter().map(|(_, text)| text.lines().count()).sum()
    };
    assert_eq!((first.reference.len(), first.measured.len()), (11, 10));
    for files in [&first.reference, &first.measured] {
        assert!((20_000..33_000).contains(&samples(files)), "{}", samples(files));
    }
}

#[test]
fn a_repeated_run_has_the_input_of_its_reference_run() {
    let found = truth(&request(Family::Relays, 5, "null"), 1);
    let (run, trace) = found.measured.last().unwrap();
    let twin = run.id.strip_prefix("again_").unwrap();
    let (_, reference) = found.reference.iter().find(|(run, _)| run.id == twin).unwrap();
    assert_eq!(trace, reference);
}

#[test]
fn columns_are_those_of_the_seed_and_of_what_is_hidden() {
    let header = |hidden: &str| {
        let set = set(&request(Family::Relays, 2, hidden));
        set.measured[0].1.lines().next().unwrap().to_owned()
    };
    assert!(header("monitor-zero").contains("amplifier_V"));
    assert!(header("spring-always").contains("load_N"));
    let null: Hidden = "null".parse().unwrap();
    assert_eq!(null.kind(), Kind::Null);
}

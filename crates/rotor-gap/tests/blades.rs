//! Frequencies of blades: the strip of Epps and Chandra, and blades with something planted.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use measured_data::{DatasetKind, PointData, Source};
use model_gap::SplitMix;
use model_gap::discovery::{Confidence, Verdict};
use rotor_case::Case;
use rotor_gap::blade::{Frequencies, diagnose_blade, usual_blade_uncertain};
use rotor_gap::{CaseDiagnosis, CaseQuestion};
use rotor_study::{ModesQuestion, numbered, rotating_modes};
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

const INCH_M: f64 = 0.0254;
const MEASURED: &str =
    include_str!("../../../fixtures/reference/rotor/epps_chandra_frequencies_hz.csv");

/// The strip with its nominal data: 1 by 0.063 in, clamped 2.5 in from the axis, 40 in to the tip.
fn strip() -> Case {
    let (radius, width, thickness) = (40.0_f64, 1.0, 0.063_f64);
    let (young, poisson, density) = (1.06e7, 0.325, 2.51e-4);
    let omega = 750.0 * TAU / 60.0;
    let force = density * width * thickness * (omega * radius).powi(2);
    let unit = force * radius * radius;
    let shear = young / (2.0 * (1.0 + poisson));
    let narrow = 1.0 - 192.0 * thickness / (PI.powi(5) * width);
    let gyration = |length: f64| length / 12.0_f64.sqrt() / radius;
    let mut case = Case { flaps: vec![], ..Case::default() };
    let r = &mut case.rotor;
    r.radius_m = radius * INCH_M;
    r.omega_rpm = 750.0;
    // lb s^2 / in^4 times in^2: lb s^2 / in^2
    r.mass_kg_m = density * width * thickness * 4.448_222 / INCH_M / INCH_M;
    r.ei_flap = young * width * thickness.powi(3) / 12.0 / unit;
    r.ei_lag = young * thickness * width.powi(3) / 12.0 / unit;
    r.gj = shear * width * thickness.powi(3) / 3.0 * narrow / unit;
    r.ea = young * width * thickness / force;
    (r.km1_r, r.km2_r) = (gyration(thickness), gyration(width));
    r.ka_r = gyration(width.hypot(thickness));
    r.chord_r = width / radius;
    r.root_offset_r = 2.5 / radius;
    (r.twist_deg, r.root_cutout_r) = (0.0, 0.1);
    case
}

/// Bending modes of a sweep angle; the columns are read to the last digit, 0.05 Hz, and rotor speed and clamping to half a
/// percent.
fn measured(sweep_deg: &str, modes: &[&str]) -> Frequencies {
    let mut text = String::from("rotor_speed_rpm,mode,frequency_hz,frequency_sd_hz\n");
    for line in MEASURED.lines().filter(|line| line.starts_with('B')) {
        let cells: Vec<&str> = line.split(',').collect();
        if cells[1] != sweep_deg || !modes.contains(&cells[0]) {
            continue;
        }
        for (speed, value) in [0, 500, 750].into_iter().zip(&cells[2..]) {
            let hz: f64 = value.parse().unwrap();
            let mode = cells[0].replace('B', "flap ");
            writeln!(text, "{speed},{mode},{hz},{}", 0.05_f64.hypot(0.005 * hz)).unwrap();
        }
    }
    frequencies(text)
}

fn frequencies(text: String) -> Frequencies {
    let source = Source { name: "a.csv".into(), text };
    let words = DatasetKind::BladeFrequencies.words();
    Frequencies::of(&PointData::read_with(&source, words).unwrap()).unwrap()
}

fn diagnosed(case: &Case, measured: &Frequencies, only: &[String]) -> CaseDiagnosis {
    let uncertain = usual_blade_uncertain();
    let question = CaseQuestion { case, uncertain: &uncertain, only, begun: &|_, _| {} };
    diagnose_blade(&question, measured).unwrap()
}

/// Rms of measured over simulated less one, percent, as it is and with what was found.
fn rms_percent(own: &CaseDiagnosis) -> f64 {
    let t = &own.table;
    let off = t.points.iter().zip(&t.predicted).flat_map(|(point, row)| {
        point
            .measured
            .iter()
            .zip(row)
            .filter_map(|(read, own)| Some(100.0 * (own / (*read)? - 1.0)))
    });
    rotor_base::mean_square(&off.collect::<Vec<_>>()).sqrt()
}

/// The causes found, each with what may be it instead, both in the order of the alphabet.
fn sets(own: &CaseDiagnosis) -> Vec<Vec<&'static str>> {
    let id = |candidate: usize| own.found.candidates[candidate].id;
    let mut all: Vec<Vec<&str>> = Vec::new();
    for found in &own.found.finding.causes {
        let mut set = vec![id(found.candidate)];
        set.extend(found.alternatives.iter().map(|other| id(other.candidate)));
        set.sort_unstable();
        all.push(set);
    }
    all.sort();
    all
}

#[test]
fn the_strip_is_stiffer_and_sits_further_out_or_turns_faster() {
    let case = strip();
    let data = measured("0", &["B2", "B3"]);
    let own = diagnosed(&case, &data, &[]);
    assert!((rms_percent(&own) - 6.37).abs() < 0.2, "{}", rms_percent(&own));
    assert_eq!(own.found.finding.verdict, Verdict::Ambiguous);
    assert_eq!(sets(&own), [vec!["mass", "stiffness-flap"], vec!["root-offset", "rotor-speed"]]);
    // nothing of the bench tells them apart; what does is said
    let next = own.found.next.as_ref().unwrap();
    assert!(next.told_apart <= 0.0, "{next:?}");
    let place = own.found.candidates.iter().position(|own| own.id == "root-offset").unwrap();
    assert!(own.found.candidates[place].separating.contains(&"where the root is, measured"));
    let after = diagnosed(own.extended.as_ref().unwrap(), &data, &[]);
    assert!(rms_percent(&after) < 1.5, "{}", rms_percent(&after));
}

/// Frequencies of a blade of another stiffness in every direction, by as much as that is uncertain, with noise of 0.3 %.
fn planted(seed: u64, plant: impl Fn(&mut Case)) -> Frequencies {
    let mut random = SplitMix(seed);
    let mut case = Case::default();
    case.rotor.ei_flap *= 0.01f64.mul_add(random.normal(), 1.0);
    case.rotor.ei_lag *= 0.01f64.mul_add(random.normal(), 1.0);
    case.rotor.gj *= 0.02f64.mul_add(random.normal(), 1.0);
    case.structure.elements *= 2;
    plant(&mut case);
    let mut text = String::from("rotor_speed_rpm,mode,frequency_hz,frequency_sd_hz\n");
    let stated_rpm = Case::default().rotor.omega_rpm;
    let speed_ratios = vec![0.0, 0.4, 0.7, 1.0];
    let question = ModesQuestion { speed_ratios: speed_ratios.clone(), ..ModesQuestion::default() };
    let found = rotating_modes(&case, &question).unwrap();
    for (ratio, own) in speed_ratios.iter().zip(&found.fan) {
        for (name, mode) in numbered(&own.modes).zip(&own.modes) {
            if ["flap 1", "flap 2", "flap 3", "lag 1", "lag 2", "torsion 1"].contains(&&*name) {
                let sd = 0.003 * mode.hz;
                let hz = mode.hz + sd * random.normal();
                // the true speed of the case over the stated one of the default
                let rpm = ratio * stated_rpm;
                writeln!(text, "{rpm},{name},{hz},{sd}").unwrap();
            }
        }
    }
    frequencies(text)
}

#[test]
fn a_blade_with_something_planted_is_known_by_it() {
    let case = Case::default();
    let named = |seed: u64, wanted: &str, plant: &dyn Fn(&mut Case)| {
        let own = diagnosed(&case, &planted(seed, plant), &[]);
        let found = sets(&own);
        assert!(found.len() == 1 && found[0].contains(&wanted), "{wanted}: {found:?}");
        let is_sure = own.found.finding.confidence == Confidence::Confident;
        assert!(!is_sure || found[0] == [wanted], "{wanted}: {found:?}");
    };
    for seed in 0..2 {
        named(seed, "stiffness-torsion", &|case| case.rotor.gj *= 0.85);
        named(seed, "stiffness-lag", &|case| case.rotor.ei_lag *= 1.2);
        named(seed, "stiffness-flap", &|case| case.rotor.ei_flap *= 0.85);
        named(seed, "tip-mass", &|case| {
            let mass = &mut case.rotor.tables.mass;
            *mass = vec![(0.0, 1.0), (0.96, 1.0), (1.0, 3.0)];
        });
        let nothing = diagnosed(&case, &planted(seed, |_| {}), &[]);
        let verdict = nothing.found.finding.verdict;
        assert_eq!(verdict, Verdict::NothingMissing, "{:?}", sets(&nothing));
    }
}

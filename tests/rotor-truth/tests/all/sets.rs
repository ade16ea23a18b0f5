//! Sets of points: their determinism, what their effects change, how finely they are resolved.

use rotor_truth::asked::Asked;
use rotor_truth::physics::balance::Resolution;
use rotor_truth::physics::blade::Blade;
use rotor_truth::physics::fourier::Pair;
use rotor_truth::set::catalogue::CATALOGUE;
use rotor_truth::set::fly::{Condition, Group, Readings, fly};
use rotor_truth::set::machine::{Machine, OddBlade};
use rotor_truth::set::made::make;

const COARSE: Resolution = Resolution { harmonics: 5, azimuths: 24, points: 4, segment: 0.35 };

fn asked(effect: &str) -> Asked {
    Asked {
        seed: 5,
        snr_db: 40.0,
        effect: Some(effect.to_owned()),
        size: None,
        points: Some(6),
        base_error: true,
    }
}

fn group(advance_ratio: f64) -> Group {
    let condition = Condition { advance_ratio, ct_sigma: 0.07, tilt_deg: 4.0, omega_rpm: 383.0 };
    let volt = vec![(3, Pair { cosine: 20.0, sine: 10.0 })];
    Group { condition, drives: vec![vec![vec![], vec![]], vec![vec![], volt]] }
}

/// 4/rev of all loads.
fn fourth(own: &Readings) -> Vec<f64> {
    own.hub.iter().flat_map(|all| [all[4].cosine, all[4].sine]).collect()
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let norm = |own: &mut dyn Iterator<Item = f64>| own.map(|x| x * x).sum::<f64>().sqrt();
    norm(&mut a.iter().zip(b).map(|(a, b)| a - b)) / norm(&mut b.iter().copied())
}

#[test]
fn every_effect_changes_the_readings_and_nothing_else() {
    let null = make(&asked("null"), COARSE).unwrap();
    for entry in CATALOGUE {
        let made = make(&asked(entry.name), COARSE).unwrap();
        let lines = made.sweep_csv.lines();
        assert_eq!(lines.count(), made.answer.points + 1, "{}", entry.name);
        assert!(!made.sweep_csv.contains(entry.name), "{}", entry.name);
        let is_alike = made.case_ron == null.case_ron;
        assert!(is_alike || entry.name == "compressibility", "{}", entry.name);
        let is_null = entry.name == "null";
        assert_eq!(made.sweep_csv == null.sweep_csv, is_null, "{}", entry.name);
        assert_eq!(made.answer.parameters.is_empty(), is_null, "{}", entry.name);
    }
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| make(&asked("blade-dissimilarity"), COARSE).unwrap().sweep_csv)
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn a_finer_rotor_gives_the_same_loads() {
    let machine = Machine::believed(Blade::default());
    let fine = Resolution { harmonics: 14, azimuths: 96, points: 6, segment: 0.1 };
    for (mu, most) in [(0.15, 1e-4), (0.30, 0.012)] {
        let usual = &fly(&machine, &[group(mu)], Resolution::default()).unwrap()[0];
        let exact = &fly(&machine, &[group(mu)], fine).unwrap()[0];
        for (a, b) in usual.iter().zip(exact) {
            let loads = apart(&fourth(a), &fourth(b));
            println!("mu {mu}: {loads:.1e} of |Z4|");
            assert!(loads < most, "{mu}: {loads:e}");
            for (a, b) in a.controls_deg.iter().zip(b.controls_deg) {
                assert!((a - b).abs() < 1e-3);
            }
        }
    }
}

#[test]
fn like_blades_pass_on_multiples_of_their_number_alone() {
    let mut machine = Machine::believed(Blade::default());
    let alike = fly(&machine, &[group(0.2)], Resolution::default()).unwrap();
    let odd = OddBlade { blade: 2, mass_ratio: 1.0, pitch_rad: 0.0, flaps_late_rad: 0.0 };
    machine.odd = Some(odd);
    let same = fly(&machine, &[group(0.2)], Resolution::default()).unwrap();
    for (a, b) in alike[0].iter().zip(&same[0]) {
        assert!(apart(&fourth(a), &fourth(b)) < 1e-6);
        assert!(b.hub.iter().all(|own| own[1].cosine.hypot(own[1].sine) < 1e-2));
    }
    // a blade heavier by 1 % pulls the hub with 1 % of its centrifugal force
    machine.odd = Some(OddBlade { mass_ratio: 1.01, ..odd });
    let heavy = &fly(&machine, &[group(0.2)], Resolution::default()).unwrap()[0][0];
    let pull = heavy.hub[0][1].cosine.hypot(heavy.hub[0][1].sine);
    let half = 0.5 * 0.01 * machine.scales(383.0).force_newton;
    assert!((pull / half - 1.0).abs() < 0.05, "{pull} {half}");
}

#[test]
fn what_cannot_be_is_refused() {
    assert!(make(&asked("gremlins"), COARSE).unwrap_err().to_string().contains("stiffness-lag"));
    let few = Asked { points: Some(1), ..asked("null") };
    assert!(make(&few, COARSE).unwrap_err().to_string().contains("4 to 400"));
}

//! Sets of blades and sections: their determinism, what their effects change, what is refused.

use rotor_truth::asked::Asked;
use rotor_truth::kind::{SetKind, SetText};

fn made(kind: SetKind, effect: &str, seed: u64) -> SetText {
    kind.make(&Asked {
        seed,
        snr_db: 60.0,
        effect: Some(effect.to_owned()),
        size: None,
        points: None,
        base_error: true,
    })
    .unwrap()
}

/// The largest change of a reading against those of another set, in their stated or usual deviations of 1e-3.
fn moved(a: &str, b: &str) -> f64 {
    let numbers = |text: &str| -> Vec<f64> {
        text.lines()
            .skip(1)
            .flat_map(|line| line.split(','))
            .filter_map(|own| own.parse().ok())
            .collect()
    };
    let (a, b) = (numbers(a), numbers(b));
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(a, b)| (a - b).abs() / (1e-3 * (a.abs() + b.abs()) + 1e-4))
        .fold(0.0, f64::max)
}

#[test]
fn every_effect_moves_the_readings_and_says_nothing_of_itself() {
    for kind in [SetKind::Blade, SetKind::Section] {
        for effect in kind.effects() {
            for seed in [3, 8] {
                let (own, null) = (made(kind, effect, seed), made(kind, "null", seed));
                assert!(!own.table_csv.contains(effect), "{effect}");
                let is_null = effect == "null";
                assert_eq!(
                    own.answer["parameters"] == null.answer["parameters"],
                    is_null,
                    "{effect}"
                );
                // stall asks for histories
                if own.answer["layout"] == null.answer["layout"] {
                    let moved = moved(&own.table_csv, &null.table_csv);
                    assert!(if is_null { moved < 1e-9 } else { moved > 4.0 }, "{effect} {moved}");
                }
                // the product's other section model has no Mach number
                assert!(own.case_ron == null.case_ron || effect == "compressibility", "{effect}");
            }
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_text_on_any_number_of_threads() {
    for kind in [SetKind::Blade, SetKind::Section] {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let own = pool.install(|| made(kind, "null", 4));
            (own.table_csv, own.case_ron)
        };
        assert_eq!(on(1), on(3));
        assert_ne!(on(1).0, made(kind, "null", 5).table_csv);
    }
}

#[test]
fn another_noise_moves_nothing_but_the_readings() {
    let at = |snr_db: f64| {
        let asked = Asked {
            seed: 6,
            snr_db,
            effect: Some("tip-mass".to_owned()),
            size: None,
            points: Some(4),
            base_error: false,
        };
        SetKind::Blade.make(&asked).unwrap()
    };
    let (loud, quiet) = (at(40.0), at(60.0));
    assert_eq!(loud.case_ron, quiet.case_ron);
    assert_eq!(loud.answer["parameters"], quiet.answer["parameters"]);
    assert_eq!((loud.points, loud.answer["base_ratios"].as_object().unwrap().len()), (4, 0));
}

#[test]
fn what_cannot_be_is_refused() {
    let asked = |effect: &str, size, points| Asked {
        seed: 1,
        snr_db: 50.0,
        effect: Some(effect.to_owned()),
        size,
        points,
        base_error: true,
    };
    for kind in [SetKind::Blade, SetKind::Section] {
        let said = |own: &Asked| kind.make(own).unwrap_err().to_string();
        assert!(said(&asked("gremlins", None, None)).contains("null"));
        assert!(said(&asked("null", None, Some(2))).contains("3 to 60"));
        assert!(said(&asked("null", Some(f64::NAN), None)).contains("finite"));
    }
    // a blade without stiffness has no modes
    let none = SetKind::Blade.make(&asked("stiffness-flap", Some(-1.0), None));
    assert!(none.unwrap_err().to_string().contains("flap modes"));
}

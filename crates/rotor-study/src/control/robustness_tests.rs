//! Flights of the maps beside the loop of the study, and what each disturbance does.

use super::*;
use rotor_case::{ControllerChoice, HandedSet, HandedT};

fn case() -> Case {
    let mut case = Case::default();
    case.control.harmonics = vec![vec![3]];
    case.control.actuators = vec![ControlActuator::Hysteretic];
    case.control.effort = EffortChoice::Limits;
    case.control.controller = ControllerChoice::Local;
    case
}

fn with_flights(test: impl FnOnce(&Flights<'_>, &Case, &TrimmedRotor, &Drives)) {
    let case = case();
    let model = Some(std::sync::Arc::new(crate::control::memory_actuator()));
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let drives = Drives::new(&case, model).unwrap();
    let set = ControlSet::new(&case, &rotor, &drives, &[3]).unwrap();
    test(&Flights::new(&set).unwrap(), &case, &rotor, &drives);
}

const NONE: Disturbance = Disturbance {
    noise_percent: 0.0,
    t_gain: 1.0,
    t_phase_deg: 0.0,
    t_flap: None,
    drift_percent: 0.0,
};

fn end(ratios: &[f64]) -> f64 {
    ratios[CYCLES - END_CYCLES..].iter().sum::<f64>() / END_CYCLES as f64
}

/// The map of disturbances: each alone, each once.
#[test]
fn every_disturbance_stands_once_in_the_map() {
    let all = disturbances(2);
    assert_eq!(all.len(), 1 + 3 + 2 + 6 + 2 + 2 + 1);
    for (k, one) in all.iter().enumerate() {
        assert!(!all[..k].contains(one), "{one:?}");
    }
    assert_eq!(robustness_flights(&case()), (12 + 4 * DRAWS + 1) * 3);
}

/// Undisturbed, every controller ends within a point of the loop of the study on the rotor itself; each disturbance is
/// felt as it should be.
#[test]
fn flights_end_where_the_study_does_and_feel_what_disturbs_them() {
    with_flights(|flights, case, rotor, drives| {
        let study = crate::control::control_set(case, rotor, drives, &[3], &|| ()).unwrap();
        let least = study[0].j_after / study[0].j_before;
        let fly = |name, disturbance| flights.fly(name, &disturbance, SEED).unwrap();
        for name in Known::ALL {
            let ratios = fly(name, NONE);
            println!("{name:?}: {:.4} {:.4}, study {least:.4}", ratios[0], end(&ratios));
            assert!((ratios[0] - 1.0).abs() < 1e-12);
            assert!((end(&ratios) - least).abs() < 0.01, "{name:?}: {} {least}", end(&ratios));
        }
        // a gain that is lost with every cycle is given back by more voltage where there is some, and costs little
        let drift = fly(Known::Fixed, Disturbance { drift_percent: 2.0, ..NONE });
        assert!(end(&drift) > end(&fly(Known::Fixed, NONE)) + 1e-4, "{}", end(&drift));
        // a phase beyond the margin of theory, acos(gain / 2), leads away; one well below ends near, where limits bind
        let beyond = fly(Known::Fixed, Disturbance { t_phase_deg: 100.0, ..NONE });
        let below = fly(Known::Fixed, Disturbance { t_phase_deg: 45.0, ..NONE });
        assert!(end(&beyond) > 1.0 && (end(&below) - least).abs() < 0.05, "{beyond:?} {below:?}");
    });
}

/// The seeds of the noise are those of the draw, not of the controller; cells hold what the flights say.
#[test]
fn controllers_share_their_noise() {
    with_flights(|flights, _, _, _| {
        let noisy = Disturbance { noise_percent: 10.0, ..NONE };
        let cell = flights.cell(Known::Fixed, noisy, &|| ()).unwrap();
        assert_eq!((cell.draws, cell.cycles), (DRAWS, CYCLES));
        assert!(cell.end_range[0] < cell.end_ratio && cell.end_ratio < cell.end_range[1]);
        // at zero control all measure the same to the last bit, noise with it, and other loads under another seed
        let first = |name, seed| {
            let mut first = Vec::new();
            let mut seen = |loads: &[f64]| {
                if first.is_empty() {
                    first.extend(loads.iter().map(|load| load.to_bits()));
                }
            };
            flights.fly_seen(name, &noisy, seed, &mut seen).unwrap();
            first
        };
        let own = first(Known::Fixed, SEED);
        assert_eq!(own, first(Known::Estimated, SEED));
        assert_eq!(own, first(Known::NoiseTold, SEED));
        assert_ne!(own, first(Known::Fixed, SEED + 1));
        // and the draws of another controller's cell are flights of the same seeds
        let cell = flights.cell(Known::Estimated, noisy, &|| ()).unwrap();
        let ends: Vec<f64> = (SEED..SEED + DRAWS as u64)
            .map(|seed| end(&flights.fly(Known::Estimated, &noisy, seed).unwrap()))
            .collect();
        let least = ends.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = ends.iter().copied().fold(0.0, f64::max);
        assert_eq!(cell.end_range.map(f64::to_bits), [least, largest].map(f64::to_bits));
        let margins = flights.margins().unwrap();
        let theory = (GAIN / 2.0).acos().to_degrees();
        assert!((margins.common_phase_deg - theory).abs() < 1.0, "{margins:?}");
        assert!(margins.condition > 1.0 && margins.flap_overshoot_deg.len() == 2);
    });
}

/// A T that is handed in is that of the controllers, the rotor answers with its own: what the one errs by is taken off the margins,
/// and nothing is left where that alone diverges.
#[test]
fn a_t_that_is_handed_in_is_not_turned_against_itself() {
    with_flights(|flights, case, rotor, drives| {
        let own = flights.margins().unwrap();
        let of = |phase_deg: f64| {
            let columns = flights.own_t.turned(1.0, phase_deg.to_radians()).unwrap().columns();
            let advance_ratios = vec![case.advance_ratio];
            let handed = HandedSet { harmonics: vec![3], advance_ratios, columns: vec![columns] };
            let mut case = case.clone();
            let handed = HandedT { sets: vec![handed], ..HandedT::default() };
            case.control.handed_t = Some(std::sync::Arc::new(handed));
            let set = ControlSet::new(&case, rotor, drives, &[3]).unwrap();
            let flights = Flights::new(&set).unwrap();
            let ratio = end(&flights.fly(Known::Fixed, &NONE, SEED).unwrap());
            (flights.margins().unwrap(), ratio)
        };
        let (off, _) = of(30.0);
        println!("{} deg, {} left", own.common_phase_deg, off.common_phase_deg);
        assert!((off.common_phase_deg - (own.common_phase_deg - 30.0)).abs() < 1.0, "{off:?}");
        let (beyond, ratio) = of(100.0);
        assert!(beyond.common_phase_deg == 0.0 && beyond.common_gain <= 1.0, "{beyond:?}");
        assert!(ratio > 1.0, "and it does diverge: {ratio}");
    });
}

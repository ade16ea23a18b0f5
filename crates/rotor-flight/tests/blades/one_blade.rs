//! A flap that fails on one blade: what the hub feels against the nonlinear rotor blade by blade, and flights through it.

use crate::common::actuator;
use crate::{ADVANCE_RATIO, BLADES, case, of_order, size};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::{FailedFlap, FailedOn, FlightController, FlightValues, Notice};
use rotor_flight::{FlightError, FlightPoint, FlightState, FlyingCase, RotorPath};
use rotor_response::hub_loads;
use rotor_study::{TrimmedRotor, scaled};

/// One blade moves its inboard flap otherwise: at every order the loads that this adds are those of the nonlinear rotor whose
/// blades answer each for itself. Half of the motion would not be taken for it.
#[test]
fn one_blade_adds_what_the_nonlinear_rotor_says() {
    let case = case();
    let path = RotorPath::new(&case, &[ADVANCE_RATIO]).unwrap();
    let state = FlightState { advance_ratio: ADVANCE_RATIO, thrust_share: 0.0 };
    let mut sound = HarmonicSeries::zero(4);
    sound.set_harmonic(2, Harmonic { cosine: 0.6, sine: -0.3 });
    sound.set_harmonic(4, Harmonic { cosine: -0.2, sine: 0.4 });
    let stuck = HarmonicSeries { mean: 1.0, ..HarmonicSeries::zero(0) };
    let (like, own) = (vec![sound.clone()], vec![vec![stuck.clone()]]);
    let unknown = path.own_blade_loads(state, &like, &own).unwrap_err();
    assert!(matches!(unknown, FlightError::OwnBlade { asked: 1, known: 0 }), "{unknown}");
    assert!(path.clone().with_blades(&case, &[(0, 2)]).is_err(), "there are two flaps");
    assert!(path.clone().with_blades(&case, &[(4, 0)]).is_err(), "there are four blades");
    let found = path.with_blades(&case, &[(0, 0)]).unwrap();
    let found = found.own_blade_loads(state, &like, &own).unwrap();
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let root = |flap: &HarmonicSeries| {
        let rad = scaled(flap, 1f64.to_radians());
        rotor.blade_root_loads(vec![rad, HarmonicSeries::zero(0)]).unwrap()
    };
    let (alike, failed) = (root(&sound), root(&stuck));
    let highest = 2 * BLADES - 1;
    let mut blades = vec![alike; BLADES];
    let before = hub_loads(&blades, highest);
    blades[0] = failed;
    let after = hub_loads(&blades, highest);
    for n in 1..=highest {
        let (before, after) = (before.harmonic(n), after.harmonic(n));
        let truth: Vec<f64> = after.iter().zip(before).map(|(a, b)| a - b).collect();
        let off: Vec<f64> = found[of_order(n)].iter().zip(&truth).map(|(a, b)| a - b).collect();
        println!("{n}/rev: off by {:.1e} of {:.2e}", size(&off), size(&truth));
        assert!(size(&off) < 0.05 * size(&truth), "{n}/rev: {:e}", size(&off) / size(&truth));
    }
}

/// Flights of 3/rev at one speed through a flap that stands still on one blade from 4 s on.
fn flown(notice: Notice, on: FailedOn, kept_percent: f64) -> Vec<FlightPoint> {
    let values = FlightValues {
        start_advance_ratio: ADVANCE_RATIO,
        end_advance_ratio: ADVANCE_RATIO,
        harmonics: vec![3],
        noise_percent: 0.0,
        duration_s: 14.0,
        amplitude_limit_volt: 60.0,
        // what binds is the limit of the amplitude alone
        dead_flap_percent: 1e6,
        controllers: vec![FlightController::Fixed],
        failed_flap: Some(FailedFlap {
            flap: 1,
            at_s: 4.0,
            stuck_deg: 0.0,
            kept_percent,
            notice,
            on,
        }),
        ..FlightValues::default()
    };
    let (case, model) = (case(), actuator());
    let flying = FlyingCase::new(&case, &values, &model).unwrap();
    flying.fly(&|| ()).unwrap().flights.swap_remove(0).points
}

/// Blades alike have no load off their number. One that fails brings it, unless the controller is told and leaves the flap out
/// on every blade, which costs what that flap did.
#[test]
fn a_flap_that_stands_on_one_blade_is_felt_off_the_blade_number() {
    let every = flown(Notice::Untold, FailedOn::EveryBlade, 0.0);
    assert!(every.iter().all(|p| p.other_ratio == 0.0 && p.once_per_rev_ratio == 0.0));
    let untold = flown(Notice::Untold, FailedOn::OneBlade, 0.0);
    let (before, after): (Vec<_>, Vec<_>) = untold.iter().partition(|p| p.time_s < 4.0);
    assert!(before.iter().all(|p| p.other_ratio == 0.0));
    let end = |points: &[FlightPoint]| points.last().cloned().unwrap();
    let told = end(&flown(Notice::Told, FailedOn::OneBlade, 0.0));
    let (untold, every) = (end(&untold), end(&every));
    for (name, p) in [("untold", &untold), ("told", &told), ("every blade", &every)] {
        println!(
            "{name}: J {:.3}, 1/rev {:.4}, others {:.4} J0",
            p.cost_ratio, p.once_per_rev_ratio, p.other_ratio
        );
    }
    assert!(after.iter().all(|p| p.other_ratio > 0.0), "{after:?}");
    assert!(untold.other_ratio > 0.01 && untold.once_per_rev_ratio > 0.0);
    assert!(told.other_ratio < 0.01 * untold.other_ratio, "{}", told.other_ratio);
    // three blades go on, so that less is lost at the blade number than where all have stopped
    assert!(untold.cost_ratio < every.cost_ratio, "{} {}", untold.cost_ratio, every.cost_ratio);
    assert!((told.cost_ratio - every.cost_ratio).abs() < 0.05, "{}", told.cost_ratio);
    // a flap that keeps 80 % of its motion is felt as a fifth of one that stands: a twenty-fifth of J, as the control is not alike
    let weak = end(&flown(Notice::Untold, FailedOn::OneBlade, 80.0));
    let share = weak.other_ratio / untold.other_ratio;
    println!("weak: J {:.3}, others {:.4} J0, {share:.3}", weak.cost_ratio, weak.other_ratio);
    assert!((0.02..0.08).contains(&share), "{share}");
    // one that keeps all of it has not failed
    let whole = end(&flown(Notice::Untold, FailedOn::OneBlade, 100.0));
    assert!(whole.other_ratio < 1e-20 && whole.cost_ratio < weak.cost_ratio + 1e-3);
}

#[test]
fn too_few_load_harmonics_are_refused() {
    let mut case = case();
    case.response.load_harmonics = 6;
    let failed = FailedFlap { on: FailedOn::OneBlade, ..FailedFlap::default() };
    let values = FlightValues { failed_flap: Some(failed), knots: 2, ..FlightValues::default() };
    let error = FlyingCase::new(&case, &values, &actuator()).unwrap_err();
    assert!(error.to_string().contains("load_harmonics"), "{error}");
}

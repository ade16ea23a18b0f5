//! Rough sweeps go where whole ones go.

use rotor_wake::{BladeLines, CirculationMap, FlightState, FreeWake, FreeWakeSettings, WakeRotor};

/// From the same start, far from settled, both come to the same wake: nodes apart by a small part of the way.
#[test]
fn a_rough_sweep_goes_where_a_whole_one_goes() {
    let rotor = WakeRotor::uniform(4, 0.2, 8).unwrap();
    let settings = FreeWakeSettings { azimuths: 36, turns: 2, ..FreeWakeSettings::default() };
    let flight = FlightState { advance_ratio: 0.2, shaft_tilt_rad: 0.05 };
    let lines = BladeLines::flat(&rotor, 36);
    let circulation = CirculationMap::elliptic(&rotor, 36, 0.006, 0.2).unwrap();
    let start = FreeWake::undistorted(rotor, settings, flight, 0.015, lines).unwrap();
    let (mut whole, mut rough) = (start.clone(), start.clone());
    let [way, by_rough] =
        [whole.sweep(&circulation).unwrap(), rough.rough_sweep(&circulation).unwrap()];
    assert_eq!(rough.settings(), start.settings());
    let tip = |wake: &FreeWake| wake.vortices().pop().unwrap().points;
    let (mut square, mut count) = (0.0, 0);
    for (a, b) in tip(&whole).iter().flatten().zip(tip(&rough).iter().flatten()) {
        square += a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        count += 1;
    }
    let apart = (square / f64::from(count)).sqrt();
    println!("way {way:.2e} and {by_rough:.2e} R, apart by {apart:.2e} R");
    assert!(way > 0.01 && apart > 0.0 && apart < 0.05 * way, "{apart:e} of {way:e}");
    assert!((by_rough / way - 1.0).abs() < 0.02, "{by_rough:e} {way:e}");
}

//! A wake without circulation in the flow round a body: it goes where the air goes.

#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

use rotor_wake::{
    BladeLines, Body, CirculationMap, FlightState, FreeWake, FreeWakeSettings, Vec3, WakeMethod,
    WakeRotor,
};

const BODY: Body =
    Body { half_length: 0.45, radius: 0.18, middle: [0.0, 0.0, -0.25], nose_up_rad: 0.0 };
const FLIGHT: FlightState = FlightState { advance_ratio: 0.2, shaft_tilt_rad: -0.08 };
const PANELS: usize = 8;

fn settled(azimuths: usize, method: WakeMethod, body: Option<Body>) -> FreeWake {
    let rotor = WakeRotor::uniform(4, 0.2, PANELS).unwrap();
    let settings = FreeWakeSettings {
        azimuths,
        turns: 1,
        near_wake_rad: 0.5,
        body,
        ..FreeWakeSettings::default()
    };
    let lines = BladeLines::flat(&rotor, azimuths);
    let mut wake = FreeWake::undistorted(rotor, settings, FLIGHT, 0.0, lines).unwrap();
    let none = CirculationMap::constant(azimuths, PANELS, 0.0).unwrap();
    wake.carry_on(method, 12, &none).unwrap();
    wake
}

fn stream() -> Vec3 {
    [FLIGHT.advance_ratio, 0.0, -FLIGHT.normal_inflow()]
}

fn moved(at: Vec3, by: Vec3, part: f64) -> Vec3 {
    std::array::from_fn(|k| at[k] + part * by[k])
}

/// Where the air from a point has come to after an angle, by Runge and Kutta's method.
fn carried(mut at: Vec3, angle: f64) -> Vec3 {
    let wind = |at: Vec3| moved(stream(), BODY.velocity(at, stream()), 1.0);
    let steps = 400;
    let step = angle / f64::from(steps);
    for _ in 0..steps {
        let a = wind(at);
        let b = wind(moved(at, a, 0.5 * step));
        let c = wind(moved(at, b, 0.5 * step));
        let d = wind(moved(at, c, step));
        for (slope, part) in [(a, 1.0), (b, 2.0), (c, 2.0), (d, 1.0)] {
            at = moved(at, slope, part * step / 6.0);
        }
    }
    at
}

/// Largest distance of what the body did to a tip vortex from what it did to the air that the vortex was released into, and
/// how large that is.
fn distances(wake: &FreeWake, without: &FreeWake) -> [f64; 2] {
    let [tip, free] = [wake, without].map(|wake| wake.vortices().pop().unwrap().points);
    let (azimuths, step) = (tip.len(), wake.settings().step_rad());
    let norm = |v: Vec3| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (mut off, mut by_the_body) = (0.0_f64, 0.0_f64);
    for i in (0..azimuths).step_by(azimuths / 12) {
        // after a revolution
        let (release, angle) = (tip[i][0], azimuths as f64 * step);
        let of_air = moved(carried(release, angle), moved(release, stream(), angle), -1.0);
        let of_vortex = moved(tip[i][azimuths], free[i][azimuths], -1.0);
        off = off.max(norm(moved(of_vortex, of_air, -1.0)));
        by_the_body = by_the_body.max(norm(of_air));
    }
    [off, by_the_body]
}

#[test]
fn a_wake_without_circulation_goes_with_the_air_round_the_body() {
    let found = |azimuths, method| {
        distances(&settled(azimuths, method, Some(BODY)), &settled(azimuths, method, None))
    };
    let [coarse, _] = found(36, WakeMethod::Relaxed);
    let [fine, moved] = found(72, WakeMethod::Relaxed);
    println!("off the air {coarse:.1e}, {fine:.1e}; moved by the body {moved:.3}");
    assert!(moved > 0.02 && fine < 0.03 * moved, "{fine:e} of {moved}");
    let order = (coarse / fine).log2();
    assert!(order > 1.7, "{order}");
    // a marched helix is turned on its way, by d^2/3 rad per rad of age: another part of the flow
    let [marched, _] = found(72, WakeMethod::Marched);
    println!("marched: {marched:.1e}");
    assert!(marched < 0.4 * moved, "{marched:e}");
}

#[test]
fn blades_feel_the_flow_round_the_body() {
    let wake = settled(36, WakeMethod::Relaxed, Some(BODY));
    let none = CirculationMap::constant(36, PANELS, 0.0).unwrap();
    let inflow = wake.line_induction(&none).unwrap().inflow(&none).unwrap();
    for (i, azimuth) in (0..36).map(|i| f64::from(i) * std::f64::consts::TAU / 36.0).enumerate() {
        let (sin, cos) = azimuth.sin_cos();
        for (s, r) in inflow.stations().iter().enumerate() {
            let [x, y, z] = BODY.velocity([r * cos, r * sin, 0.0], stream());
            let place = i * PANELS + s;
            assert!((inflow.row(i)[s] + z).abs() < 1e-12);
            let along = inflow.in_plane_values().unwrap()[place];
            assert!((along - (x * sin - y * cos)).abs() < 1e-12);
        }
    }
}

//! The free wake.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use reference_rotors::{BladeElementSolution, CouplingSettings};
use reference_rotors::{olaf as olaf_rotor, olaf_flight, olaf_settings, olaf_thrust_newton};
use rotor_wake::{
    BladeLines, CoreModel, FlightState, FreeWake, FreeWakeSettings, SegmentSet, Vec3, WakeError,
    WakeRotor, arc_velocity, induced_velocities, momentum_inflow,
};
use validation::{Check, Failure, Table, row, worst};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-WAKE-05",
        "velocity at the centre of a polygon ring, 36 to 288 segments: order of \
         convergence, farthest from 2",
        "-",
    )
    .against("Gamma / 2 R, exact for the circle")
    .at_most(0.02, ring_order),
    row(
        "V-WAKE-06",
        "speed of a ring of 2000 segments, core 0.05 and 0.02 R, Vatistas: largest \
         relative error",
        "-",
    )
    .against(
        "converged value of the kernel, 0.215298 and 0.252013 Gamma/R, computed \
         apart",
    )
    .at_most(0.005, || {
        let one = |core: f64, speed: f64| {
            Ok((ring_speed(2000, CoreModel::Vatistas, core) / speed - 1.0).abs())
        };
        worst("cores", 2, [one(0.05, 0.215_298), one(0.02, 0.252_013)])
    }),
    row(
        "V-WAKE-07",
        "speed of a ring of 72 to 288 segments, corrected core: largest relative \
         error",
        "-",
    )
    .against("Kelvin, (ln(8 R / r_c) - 1/4) Gamma / 4 pi R")
    .at_most(0.005, || {
        let cases = [72, 144, 288].into_iter().flat_map(|n| [(n, 0.05), (n, 0.02)]);
        worst(
            "rings",
            6,
            cases.map(|(n, core)| {
                let kelvin = (f64::ln(8.0 / core) - 0.25) / (4.0 * PI);
                Ok((ring_speed(n, CoreModel::RosenheadMoore, core) / kelvin - 1.0).abs())
            }),
        )
    }),
    row(
        "V-WAKE-08",
        "undistorted tip helices, mu 0.1 to 0.35: mean inflow over Glauert's, \
         largest relative distance from 1.06, 1.10, 1.21, 1.24",
        "-",
    )
    .against(
        "the same helices computed apart; 40 stations (with 80, mu 0.35 is 2.4 % \
         off)",
    )
    .at_most(0.02, || {
        let cases = [(0.1, 1.06), (0.2, 1.10), (0.3, 1.21), (0.35, 1.24)];
        worst(
            "advance ratios",
            4,
            cases.map(|(mu, expected)| Ok((helices(mu)? / expected - 1.0).abs())),
        )
    }),
    row(
        "V-WAKE-09",
        "rotor of an independent free wake, full-revolution near wake: mean thrust, \
         relative error",
        "-",
    )
    .against("OLAF, fixtures/reference/wake/full72_lastrev.csv")
    .at_most(0.02, || Ok((thrust(360)?[0] / olaf()?[0] - 1.0).abs())),
    row("V-WAKE-10", "the same: amplitude of the 4/rev thrust, relative error", "-")
        .against("the same")
        .at_most(0.10, || Ok((thrust(360)?[1] / olaf()?[1] - 1.0).abs())),
    row("V-WAKE-11", "the same: phase of the 4/rev thrust, error", "deg")
        .against("the same")
        .at_most(10.0, || Ok((thrust(360)?[2] - olaf()?[2]).abs())),
    row(
        "V-WAKE-12",
        "the same: rotating sums that vanish with four alike blades, largest over \
         the thrust",
        "-",
    )
    .against("symmetry")
    .at_most(1e-6, asymmetry)
    .machine_dependent(),
    row(
        "V-WAKE-13",
        "4/rev thrust with a near wake of 90 deg over that of a full revolution \
         (OLAF: 0.69)",
        "-",
    )
    .against("must differ visibly: the near wake is physics to converge")
    .between(0.60, 0.95, || Ok(thrust(90)?[1] / thrust(360)?[1])),
    row(
        "V-WAKE-46",
        "the same with steps of 10 deg in place of 15: 4/rev thrust with its phase, \
         relative change",
        "-",
    )
    .against("converged; `cargo xtask wake-refinement` has the whole table")
    .at_most(0.02, || Ok(apart(thrust_after(|s| s.azimuths = 36)?, thrust(360)?)))
    .machine_dependent(),
    row("V-WAKE-47", "the same with 5 turns in place of 3: mean thrust, relative change", "-")
        .against("the same")
        .at_most(0.003, || Ok((thrust_after(|s| s.turns = 5)?[0] / thrust(360)?[0] - 1.0).abs()))
        .machine_dependent(),
];

/// A ring of unit circulation and radius and its nodes.
fn ring(segments: usize, core: CoreModel, radius: f64) -> (SegmentSet, Vec<Vec3>) {
    let node = |k: usize| {
        let angle = TAU * (k % segments) as f64 / segments as f64;
        [angle.cos(), angle.sin(), 0.0]
    };
    let mut set = SegmentSet::new(core);
    for k in 0..segments {
        set.push(node(k), node(k + 1), 1.0, radius);
    }
    (set, (0..segments).map(node).collect())
}

fn ring_order() -> Result<f64, Failure> {
    let error = |n: usize| {
        let (set, _) = ring(n, CoreModel::Vatistas, 1e-6);
        (induced_velocities(&[[0.0; 3]], &set)[0][2] / 0.5 - 1.0).abs()
    };
    let steps = [(36, 72), (72, 144), (144, 288)];
    worst("refinements", 3, steps.map(|(a, b)| Ok(((error(a) / error(b)).log2() - 2.0).abs())))
}

fn ring_speed(n: usize, core: CoreModel, radius: f64) -> f64 {
    let (set, nodes) = ring(n, core, radius);
    let chords = induced_velocities(&nodes[..1], &set)[0][2];
    match core {
        CoreModel::RosenheadMoore => {
            chords + arc_velocity([nodes[n - 1], nodes[0], nodes[1]], 1.0, radius)[2]
        }
        _ => chords,
    }
}

const THRUST: f64 = 0.0049;

/// Mean over the disk, by area, at the blade that turns through it, over Glauert's.
fn helices(advance_ratio: f64) -> Result<f64, Failure> {
    const STATIONS: usize = 40;
    let flight = FlightState { advance_ratio, shaft_tilt_rad: 5.0_f64.to_radians() };
    let inflow = momentum_inflow(&flight, THRUST)?;
    let rotor = WakeRotor::uniform(4, 0.2, 20)?;
    let azimuths = 72;
    let settings = FreeWakeSettings { azimuths, turns: 3, ..FreeWakeSettings::default() };
    let lines = BladeLines::flat(&rotor, azimuths);
    let wake = FreeWake::undistorted(rotor, settings, flight, inflow, lines)?;
    let vortices = wake.vortices();
    let (mut sum, mut area) = (0.0, 0.0);
    for i in 0..azimuths {
        let mut set = SegmentSet::new(CoreModel::Vatistas);
        for b in 0..4 {
            for ends in vortices[0].points[(i + 18 * b) % azimuths].windows(2) {
                set.push(ends[0], ends[1], TAU * THRUST / 4.0, 0.02);
            }
        }
        let (sin, cos) = (TAU * i as f64 / azimuths as f64).sin_cos();
        let radii = (0..STATIONS).map(|k| (k as f64 + 0.5) / STATIONS as f64);
        let targets: Vec<Vec3> = radii.clone().map(|r| [r * cos, r * sin, 0.0]).collect();
        for (r, v) in radii.zip(induced_velocities(&targets, &set)) {
            sum -= r * v[2];
            area += r;
        }
    }
    Ok(sum / area / inflow)
}

fn reference(near_wake_deg: u32) -> Result<BladeElementSolution, WakeError> {
    in_wake(&olaf_settings(f64::from(near_wake_deg).to_radians()))
}

fn in_wake(settings: &FreeWakeSettings) -> Result<BladeElementSolution, WakeError> {
    let rotor = olaf_rotor(20)?;
    let mut wake = rotor.starting_wake(settings, olaf_flight(), 0.005)?;
    let coupling =
        CouplingSettings { inflow_tolerance: 2e-4, sweeps: 3, ..CouplingSettings::default() };
    rotor.solve(&mut wake, &coupling)
}

type Reference = LazyLock<Result<BladeElementSolution, WakeError>>;
static FULL_NEAR_WAKE: Reference = LazyLock::new(|| reference(360));
static SHORT_NEAR_WAKE: Reference = LazyLock::new(|| reference(90));

fn solved(near_wake_deg: u32) -> Result<&'static BladeElementSolution, Failure> {
    let solution = if near_wake_deg == 360 { &*FULL_NEAR_WAKE } else { &*SHORT_NEAR_WAKE };
    Ok(solution.as_ref().map_err(Clone::clone)?)
}

/// Mean, and amplitude and phase (deg) of 4/rev, of samples at azimuths in rad.
fn four_per_rev(samples: &[(f64, f64)]) -> [f64; 3] {
    let count = samples.len() as f64;
    let (mut mean, mut c, mut s) = (0.0, 0.0, 0.0);
    for (azimuth, value) in samples {
        mean += value / count;
        c += 2.0 * value * (4.0 * azimuth).cos() / count;
        s += 2.0 * value * (4.0 * azimuth).sin() / count;
    }
    [mean, c.hypot(s), s.atan2(c).to_degrees()]
}

/// Thrust of the reference rotor, N.
fn thrust(near_wake_deg: u32) -> Result<[f64; 3], Failure> {
    Ok(thrust_of(solved(near_wake_deg)?))
}

/// The same after a change of the wake.
fn thrust_after(change: impl Fn(&mut FreeWakeSettings)) -> Result<[f64; 3], Failure> {
    let mut settings = olaf_settings(TAU);
    change(&mut settings);
    Ok(thrust_of(&in_wake(&settings)?))
}

/// Distance of two 4/rev thrusts in the plane of amplitude and phase, over the second.
fn apart([_, a, phase_a]: [f64; 3], [_, b, phase_b]: [f64; 3]) -> f64 {
    let turned = (phase_a - phase_b).to_radians();
    (a * turned.cos() - b).hypot(a * turned.sin()) / b
}

fn thrust_of(solution: &BladeElementSolution) -> [f64; 3] {
    let scale = olaf_thrust_newton();
    let sums = solution.rotating_sums(4);
    let step = TAU / sums.len() as f64;
    let samples: Vec<(f64, f64)> =
        sums.iter().enumerate().map(|(i, sum)| (i as f64 * step, sum[2] * scale)).collect();
    four_per_rev(&samples)
}

/// The same of the independent wake: azimuth 0 of its table is psi 180 deg.
fn olaf() -> Result<[f64; 3], Failure> {
    let table = Table::read("wake/full72_lastrev.csv")?;
    let samples = table
        .rows()
        .map(|row| {
            let azimuth = (row.number("Azimuth")? + 180.0).to_radians();
            Ok((azimuth, row.number("RtAeroFxh")?))
        })
        .collect::<Result<Vec<_>, Failure>>()?;
    Ok(four_per_rev(&samples))
}

fn asymmetry() -> Result<f64, Failure> {
    let solution = solved(360)?;
    let sums = solution.rotating_sums(4);
    let count = sums.len();
    let amplitude = |component: usize, n: usize| {
        let (mut c, mut s) = (0.0, 0.0);
        for (i, sum) in sums.iter().enumerate() {
            let angle = TAU * (n * i) as f64 / count as f64;
            c += sum[component] * angle.cos() / count as f64;
            s += sum[component] * angle.sin() / count as f64;
        }
        Ok(c.hypot(s) / solution.thrust_coefficient)
    };
    let vanishing = [(2, 1), (2, 2), (2, 3), (0, 0), (0, 2), (0, 4), (1, 0), (1, 2), (1, 4)];
    worst("sums", 9, vanishing.map(|(component, n)| amplitude(component, n)))
}

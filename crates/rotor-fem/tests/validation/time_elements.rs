//! Time finite elements on the flap equation of a rotor in forward flight.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};
use rotor_base::HarmonicSeries;
use rotor_fem::{Floquet, LocalTangent, Orbit, PeriodicSettings, PeriodicSolver, TimeElements};

use crate::linear::{LinearCoefficients, LinearPeriodic};
use validation::{Check, Failure, Table, row, worst};

pub(crate) const ROWS: &[Check] = &[
    row("V-TIME-01", "flap equation, mu 0.3, 8 elements of order 5: largest error to 5/rev", "deg")
        .against("harmonic balance with 24 harmonics, timefe_flap_reference.csv")
        .at_most(4e-8, || flap_error(8, 0..=5)),
    row("V-TIME-02", "the same at 6/rev", "deg")
        .against("harmonic balance with 24 harmonics, timefe_flap_reference.csv")
        .at_most(2e-7, || flap_error(8, 6..=6)),
    row(
        "V-TIME-03",
        "order of convergence of the harmonics 1 to 3, from 8 to 16 elements of \
         order 3",
        "-",
    )
    .against("theory: harmonics converge with twice the polynomial order")
    .between(5.5, 7.0, flap_order),
    row(
        "V-TIME-04",
        "Floquet exponents of the flap equation: largest error of growth (per rad) \
         and frequency (per rev)",
        "-",
    )
    .against("Runge-Kutta integration in 20 000 steps; growth -gamma/16 by Liouville")
    .at_most(1e-6, floquet_error),
];

/// Advance ratio, Lock number and flap frequency of the reference case.
const MU: f64 = 0.3;
const LOCK: f64 = 5.2;
const FLAP_FREQUENCY: f64 = 1.125_789_21;

/// The rigid-blade flap equation at an azimuth, angles in degrees.
///
/// ```text
/// b'' + (g/8)(1 + 4/3 mu s) b' + [nu^2 + (g/8)(4/3 mu c + mu^2 sin 2 psi)] b
///   = (g/8)[theta (1 + 8/3 mu s + 2 mu^2 s^2) + theta_tw (4/5 + 2 mu s + 4/3 mu^2 s^2)
///           - lambda (4/3 + 2 mu s)],   theta = 8 + 2 c - 6 s, theta_tw = -8 deg, lambda 0.02
/// ```
fn flap_equation(psi: f64) -> LinearCoefficients {
    let (s, c) = psi.sin_cos();
    let g8 = LOCK / 8.0;
    let theta = 8.0 + 2.0 * c - 6.0 * s;
    let twist = -8.0;
    let lambda = 0.02_f64.to_degrees();
    let damping = g8 * (1.0 + 4.0 / 3.0 * MU * s);
    let stiffness =
        FLAP_FREQUENCY.powi(2) + g8 * (4.0 / 3.0 * MU * c + MU * MU * (2.0 * psi).sin());
    let load = g8
        * (theta * (1.0 + 8.0 / 3.0 * MU * s + 2.0 * (MU * s).powi(2))
            + twist * (0.8 + 2.0 * MU * s + 4.0 / 3.0 * (MU * s).powi(2))
            - lambda * (4.0 / 3.0 + 2.0 * MU * s));
    LinearCoefficients {
        damping: DMatrix::from_element(1, 1, damping),
        stiffness: DMatrix::from_element(1, 1, stiffness),
        load: DVector::from_element(1, load),
    }
}

/// Harmonics of the solution in degrees.
fn flap_harmonics(elements: usize, order: usize) -> Result<HarmonicSeries, Failure> {
    let time = TimeElements::new(elements, order, 8)?;
    let settings = PeriodicSettings { tolerance: 1e-12, ..PeriodicSettings::default() };
    let system = LinearPeriodic::new(DMatrix::identity(1, 1), flap_equation);
    let mut solver = PeriodicSolver::new(time.clone(), settings)?;
    let solution = solver.solve(&system, &Orbit::zero(&time, 1))?;
    Ok(solution.orbit.harmonics(&time, 0, 6))
}

/// Largest error of the harmonics in a range, deg.
fn harmonic_error(
    elements: usize,
    order: usize,
    range: std::ops::RangeInclusive<usize>,
) -> Result<f64, Failure> {
    let table = Table::read("rotor/timefe_flap_reference.csv")?;
    let truth = table.row(["method_deg", "method_deg"], ["harmonic_balance_N24"; 2])?;
    let got = flap_harmonics(elements, order)?;
    let mut errors = Vec::new();
    for n in range {
        if n == 0 {
            errors.push(Ok((got.mean - truth.number("b0")?).abs()));
        } else {
            let harmonic = got.harmonic(n);
            errors.push(Ok((harmonic.cosine - truth.number(&format!("b{n}c"))?).abs()));
            errors.push(Ok((harmonic.sine - truth.number(&format!("b{n}s"))?).abs()));
        }
    }
    worst("harmonics", 1, errors)
}

fn flap_error(elements: usize, range: std::ops::RangeInclusive<usize>) -> Result<f64, Failure> {
    harmonic_error(elements, 5, range)
}

fn flap_order() -> Result<f64, Failure> {
    let (coarse, fine) = (harmonic_error(8, 3, 1..=3)?, harmonic_error(16, 3, 1..=3)?);
    Ok((coarse / fine).log2())
}

/// Trace of the monodromy matrix by the classical Runge-Kutta method.
fn integrated_trace(steps: u32) -> f64 {
    let rate = |psi: f64, [x, v]: [f64; 2]| {
        let c = flap_equation(psi);
        [v, -c.damping[(0, 0)] * v - c.stiffness[(0, 0)] * x]
    };
    let h = TAU / f64::from(steps);
    let shift = |[x, v]: [f64; 2], [a, b]: [f64; 2], s: f64| [x + s * a, v + s * b];
    let carried = |start: [f64; 2]| {
        (0..steps).fold(start, |y, i| {
            let psi = h * f64::from(i);
            let k1 = rate(psi, y);
            let k2 = rate(psi + 0.5 * h, shift(y, k1, 0.5 * h));
            let k3 = rate(psi + 0.5 * h, shift(y, k2, 0.5 * h));
            let k4 = rate(psi + h, shift(y, k3, h));
            [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)]
                .into_iter()
                .fold(y, |sum, (k, weight)| shift(sum, k, weight * h / 6.0))
        })
    };
    carried([1.0, 0.0])[0] + carried([0.0, 1.0])[1]
}

fn floquet_error() -> Result<f64, Failure> {
    // the growths add up to the mean damping, gamma / 8
    let growth = -LOCK / 16.0;
    let half = 0.5 * integrated_trace(20_000);
    let frequency = ((2.0 * TAU * growth).exp() - half * half).sqrt().atan2(half) / TAU;
    let time = TimeElements::default();
    let tangents: Vec<LocalTangent> = time
        .points()
        .iter()
        .map(|&psi| {
            let c = flap_equation(psi);
            LocalTangent { dq: c.stiffness, dqd: c.damping, dqdd: DMatrix::zeros(1, 1) }
        })
        .collect();
    let found = Floquet::of(&time, &DMatrix::identity(1, 1), &tangents, &[])?;
    let modes = found.modes.iter();
    let errors = modes.flat_map(|m| {
        [Ok((m.growth_per_rad - growth).abs()), Ok((m.frequency_per_rev - frequency).abs())]
    });
    worst("exponents", 2, errors)
}

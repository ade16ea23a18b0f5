//! The periodic-orbit solver: exactness, order, memory, nonlinearity, resonance, bad input.
#![expect(clippy::unwrap_used, reason = "a test may fail by unwrapping")]

use crate::linear;

use std::convert::Infallible;

use approx::assert_abs_diff_eq;
use linear::{LinearCoefficients, LinearPeriodic};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rotor_base::HarmonicSeries;
use rotor_fem::{
    LocalTangent, Orbit, OrbitSamples, PeriodicError, PeriodicSettings, PeriodicSolver,
    PeriodicSystem, TimeElements,
};

fn solver(time: &TimeElements) -> PeriodicSolver {
    PeriodicSolver::new(time.clone(), PeriodicSettings::default()).unwrap()
}

/// One oscillator `q'' + 2 zeta w q' + w^2 q = load(psi)`.
fn oscillator(
    frequency: f64,
    zeta: f64,
    load: impl Fn(f64) -> f64 + Sync,
) -> LinearPeriodic<impl Fn(f64) -> LinearCoefficients + Sync> {
    LinearPeriodic::new(DMatrix::identity(1, 1), move |psi| LinearCoefficients {
        damping: DMatrix::from_element(1, 1, 2.0 * zeta * frequency),
        stiffness: DMatrix::from_element(1, 1, frequency * frequency),
        load: DVector::from_element(1, load(psi)),
    })
}

/// Manufactured motion `exp(sin psi)`: displacement and rate errors fall with order + 1 and order.
#[test]
fn displacement_and_rate_converge_with_their_orders() {
    let (frequency, zeta) = (1.7_f64, 0.05);
    let load = |psi: f64| {
        let (s, c) = psi.sin_cos();
        s.exp() * (c * c - s + 2.0 * zeta * frequency * c + frequency * frequency)
    };
    let errors = |elements: usize, order: usize| -> [f64; 2] {
        let time = TimeElements::new(elements, order, 12).unwrap();
        let system = oscillator(frequency, zeta, load);
        let solution = solver(&time).solve(&system, &Orbit::zero(&time, 1)).unwrap();
        // integral norms at the 12 Gauss points per element
        let mut squares = [0.0_f64; 2];
        let samples = solution.samples;
        for (i, psi) in samples.azimuth_rad.iter().enumerate() {
            let exact = psi.sin().exp();
            squares[0] += time.weights()[i] * (samples.q[(0, i)] - exact).powi(2);
            squares[1] += time.weights()[i] * (samples.qd[(0, i)] - exact * psi.cos()).powi(2);
        }
        squares.map(f64::sqrt)
    };
    for order in [2, 3, 4, 5] {
        let (coarse, fine) = (errors(20, order), errors(40, order));
        let rate = [0, 1].map(|k| (coarse[k] / fine[k]).log2());
        println!("order {order}: rates {rate:.2?}, errors {fine:?}");
        assert!((rate[0] - (order as f64 + 1.0)).abs() < 0.1, "{rate:?}");
        assert!((rate[1] - order as f64).abs() < 0.1, "{rate:?}");
    }
}

/// An oscillator with a first-order lag `z' = b (q' - z)` that loads it with `-a z`.
///
/// The lag is periodic by construction (harmonic by harmonic) and unknown to the tangent.
struct Lagging {
    mass: DMatrix<f64>,
    time: TimeElements,
    frequency: f64,
    zeta: f64,
    gain: f64,
    rate: f64,
}

impl PeriodicSystem for Lagging {
    type Error = Infallible;
    type Seen = ();
    type Work = ();

    fn dof(&self) -> usize {
        1
    }

    fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        (): &mut (),
        out: &mut DMatrix<f64>,
    ) -> Result<(), Infallible> {
        let weights: Vec<f64> =
            self.time.weights().iter().map(|w| w / std::f64::consts::TAU).collect();
        let rates: Vec<f64> = orbit.qd.iter().copied().collect();
        let mut lag = HarmonicSeries::project(&orbit.azimuth_rad, &weights, &rates, 16);
        for (k, h) in lag.harmonics.iter_mut().enumerate() {
            // q' / (1 + i n / b) for q' = c cos + s sin
            let t = (k as f64 + 1.0) / self.rate;
            let (c, s) = (h.cosine, h.sine);
            h.cosine = (c - t * s) / (1.0 + t * t);
            h.sine = (s + t * c) / (1.0 + t * t);
        }
        for (i, psi) in orbit.azimuth_rad.iter().enumerate() {
            out[(0, i)] = 2.0 * self.zeta * self.frequency * orbit.qd[(0, i)]
                + self.frequency.powi(2) * orbit.q[(0, i)]
                + self.gain * lag.value(*psi)
                - psi.cos();
        }
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
        let mut tangent = LocalTangent::zero(1);
        tangent.dq[(0, 0)] = self.frequency.powi(2);
        tangent.dqd[(0, 0)] = 2.0 * self.zeta * self.frequency;
        Ok(vec![tangent; orbit.azimuth_rad.len()])
    }
}

/// A lag so strong that steps with the tangent that knows nothing of it run away, and none before is mixed in: the careful
/// search finds the exact answer by the true derivative.
#[test]
fn a_lag_that_the_tangent_contradicts_is_found_by_the_true_derivative() {
    let time = TimeElements::default();
    let (frequency, zeta, gain, rate) = (1.3, 0.05, -4.0, 0.5);
    let mass = DMatrix::identity(1, 1);
    let system = Lagging { mass, time: time.clone(), frequency, zeta, gain, rate };
    let settings = PeriodicSettings { mixing_depth: 0, ..PeriodicSettings::default() };
    let mut solver = PeriodicSolver::new(time.clone(), settings).unwrap();
    let solution = solver.solve(&system, &Orbit::zero(&time, 1)).unwrap();
    println!("{} steps: {:.1?}", solution.iterations, solution.residual_history);
    // (w^2 - 1 + 2 i zeta w + a i b / (b + i)) q = 1
    let of_lag = [gain * rate / (rate * rate + 1.0), gain * rate * rate / (rate * rate + 1.0)];
    let (real, imaginary) =
        (frequency * frequency - 1.0 + of_lag[0], 2.0 * zeta * frequency + of_lag[1]);
    let square = real * real + imaginary * imaginary;
    for (psi, q) in solution.samples.azimuth_rad.iter().zip(solution.samples.q.iter()) {
        let exact = (real * psi.cos() + imaginary * psi.sin()) / square;
        assert_abs_diff_eq!(*q, exact, epsilon = 3e-7);
    }
}

/// The tangent knows nothing of the lag: chord steps leave 8 and 64 % of the residual each, mixing
/// makes up for it. The answer is exact: `(w^2 - 1 + 2 i zeta w + i a b / (b + i)) q = 1` at 1/rev.
#[test]
fn a_hidden_lag_state_converges_by_chord_steps_to_the_exact_answer() {
    let time = TimeElements::default();
    for (gain, zeta, rate, plain_steps) in [(0.3, 0.1, 0.2, 8), (1.0, 0.05, 0.5, 40)] {
        let mass = DMatrix::identity(1, 1);
        let system = Lagging { mass, time: time.clone(), frequency: 1.3, zeta, gain, rate };
        let run = |mixing_depth| {
            let settings = PeriodicSettings { mixing_depth, ..PeriodicSettings::default() };
            let mut solver = PeriodicSolver::new(time.clone(), settings).unwrap();
            solver.solve(&system, &Orbit::zero(&time, 1)).unwrap()
        };
        let mixed = run(3);
        let plain = run(0);
        println!("gain {gain}: mixed {} steps, plain {}", mixed.iterations, plain.iterations);
        assert!(mixed.residual_norm <= 1e-11 && plain.residual_norm <= 1e-11);
        assert!(mixed.iterations <= 5 && plain.iterations >= plain_steps);
        assert_eq!(mixed.factorisations, 1);

        let w = system.frequency;
        let real = w * w - 1.0 + gain * rate / (rate * rate + 1.0);
        let imag = 2.0 * zeta * w + gain * rate * rate / (rate * rate + 1.0);
        let size = real * real + imag * imag;
        for solution in [mixed, plain] {
            // q = Re(Q e^{i psi}), Q = 1 / (real + i imag)
            let first = solution.orbit.harmonics(&time, 0, 1).harmonic(1);
            assert_abs_diff_eq!(first.cosine, real / size, epsilon = 1e-9);
            assert_abs_diff_eq!(first.sine, imag / size, epsilon = 1e-9);
        }
    }
}

/// Coupled oscillators with a cubic spring, driven so that the answer is known.
struct Cubic {
    mass: DMatrix<f64>,
    /// Fraction of the inertia that is handed over inside `f`.
    hidden_inertia: f64,
    spring: f64,
}

impl Cubic {
    fn exact(psi: f64) -> [DVector<f64>; 3] {
        let (s, c) = psi.sin_cos();
        let (s2, c2) = (2.0 * psi).sin_cos();
        [
            DVector::from_vec(vec![0.3 + 0.8 * c, 0.4 * s2]),
            DVector::from_vec(vec![-0.8 * s, 0.8 * c2]),
            DVector::from_vec(vec![-0.8 * c, -1.6 * s2]),
        ]
    }

    fn force(&self, q: &DVector<f64>, qd: &DVector<f64>, qdd: &DVector<f64>) -> DVector<f64> {
        let (x, y) = (q[0], q[1]);
        let elastic = DVector::from_vec(vec![
            2.0 * x + 0.3 * y + self.spring * x.powi(3),
            7.0 * y + 0.3 * x + 0.5 * x * y,
        ]);
        elastic + qd * 0.2 + &self.mass * qdd * self.hidden_inertia
    }
}

impl PeriodicSystem for Cubic {
    type Error = Infallible;
    type Seen = ();
    type Work = ();

    fn dof(&self) -> usize {
        2
    }

    fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        (): &mut (),
        out: &mut DMatrix<f64>,
    ) -> Result<(), Infallible> {
        for (i, psi) in orbit.azimuth_rad.iter().enumerate() {
            let [q, qd, qdd] = Self::exact(*psi);
            let load = &self.mass * &qdd + self.force(&q, &qd, &qdd);
            let own = [&orbit.q, &orbit.qd, &orbit.qdd].map(|m| m.column(i).into_owned());
            out.set_column(i, &(self.force(&own[0], &own[1], &own[2]) - load));
        }
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
        let tangent = |i: usize| {
            let (x, y) = (orbit.q[(0, i)], orbit.q[(1, i)]);
            let mut tangent = LocalTangent::zero(2);
            tangent.dq[(0, 0)] = 2.0 + 3.0 * self.spring * x * x;
            tangent.dq[(0, 1)] = 0.3;
            tangent.dq[(1, 0)] = 0.3 + 0.5 * y;
            tangent.dq[(1, 1)] = 7.0 + 0.5 * x;
            tangent.dqd.fill_diagonal(0.2);
            tangent.dqdd = &self.mass * self.hidden_inertia;
            tangent
        };
        Ok((0..orbit.azimuth_rad.len()).map(tangent).collect())
    }
}

fn cubic(hidden_inertia: f64, spring: f64) -> Cubic {
    let mass = DMatrix::from_row_slice(2, 2, &[1.0, 0.1, 0.1, 1.2]);
    Cubic { mass, hidden_inertia, spring }
}

#[test]
fn a_nonlinear_orbit_is_found_from_rest() {
    let time = TimeElements::new(16, 5, 8).unwrap();
    for spring in [0.2, 2.0] {
        for hidden_inertia in [0.0, 0.2] {
            let system = cubic(hidden_inertia, spring);
            let found = solver(&time).solve(&system, &Orbit::zero(&time, 2)).unwrap();
            println!("{} steps, {} matrices", found.iterations, found.factorisations);
            // inertia inside f is not integrated by parts and costs one order of accuracy
            let loss = if hidden_inertia > 0.0 { 30.0 } else { 1.0 };
            for (p, psi) in found.samples.azimuth_rad.iter().enumerate() {
                let [exact, exact_rate, _] = Cubic::exact(*psi);
                let (q, qd) = (found.samples.q.column(p), found.samples.qd.column(p));
                assert_abs_diff_eq!(q.into_owned(), exact, epsilon = 3e-7 * loss);
                assert_abs_diff_eq!(qd.into_owned(), exact_rate, epsilon = 2e-5 * loss);
            }
            assert!(found.residual_norm <= 1e-11);
            assert_eq!(found.residual_history.len(), found.iterations + 1);
        }
    }
}

#[test]
fn a_kept_factorisation_serves_the_next_solve_and_is_renewed_when_it_no_longer_does() {
    let time = TimeElements::default();
    let new = solver(&time);
    let mut solver = new.clone();
    let zero = Orbit::zero(&time, 1);
    let first = solver.solve(&oscillator(1.4, 0.1, f64::cos), &zero).unwrap();
    assert_eq!(first.factorisations, 1);
    let near = oscillator(1.41, 0.1, f64::sin);
    let kept = solver.solve(&near, &first.orbit).unwrap();
    assert_eq!(kept.factorisations, 0);
    assert!(kept.iterations > 1);
    let far = solver.solve(&oscillator(4.5, 0.01, |psi| (4.0 * psi).sin()), &kept.orbit).unwrap();
    assert_eq!(far.factorisations, 1);
    let fresh = new.clone().solve(&near, &zero).unwrap();
    assert_eq!((fresh.factorisations, fresh.iterations), (1, 1));
    assert_abs_diff_eq!(fresh.orbit.nodal, kept.orbit.nodal, epsilon = 1e-10);
}

/// The answer to `cos psi` of the plain oscillator is `1 / (w^2 - 1)`; through resonance it changes sign.
#[test]
fn an_undamped_mode_at_an_integer_is_named_and_its_neighbours_are_not() {
    let time = TimeElements::default();
    let zero = Orbit::zero(&time, 2);
    let pair = |frequency: f64, zeta: f64| {
        LinearPeriodic::new(DMatrix::from_diagonal_element(2, 2, 2e-4), move |psi: f64| {
            let damping = DVector::from_vec(vec![0.2, 2.0 * zeta * frequency]) * 2e-4;
            let stiffness = DVector::from_vec(vec![1.7, frequency.powi(2)]) * 2e-4;
            LinearCoefficients {
                damping: DMatrix::from_diagonal(&damping),
                stiffness: DMatrix::from_diagonal(&stiffness),
                load: DVector::from_element(2, 2e-4 * psi.cos()),
            }
        })
    };
    for n in 0..=6_u32 {
        let frequency = f64::from(n);
        let error = solver(&time).solve(&pair(frequency, 0.0), &zero).unwrap_err();
        let PeriodicError::Resonance { dof, per_rev, dynamic_stiffness, .. } = error else {
            panic!("{n}: {error}");
        };
        println!("{n}/rev: {error}");
        assert_eq!((dof, per_rev), (1, n as usize));
        assert!(dynamic_stiffness < 0.1);
    }
    let sound = [
        (0.7, 0.0),
        (1.02, 0.0),
        (3.05, 0.0),
        (4.3, 0.0),
        (4.0, 0.005),
        (20.66, 0.0),
        (13.92, 0.0),
    ];
    for (frequency, zeta) in sound {
        let found = solver(&time).solve(&pair(frequency, zeta), &zero).unwrap();
        let first = found.orbit.harmonics(&time, 1, 1).harmonic(1);
        let (re, im) = (frequency * frequency - 1.0, 2.0 * zeta * frequency);
        assert_abs_diff_eq!(first.cosine, re / (re * re + im * im), epsilon = 1e-6);
    }
}

/// On a coarse mesh the sixth harmonic is 2 off in its square of 36: a mode nearby is not in resonance,
/// it is merely not resolved.
#[test]
fn an_unresolved_harmonic_is_no_resonance() {
    let time = TimeElements::new(6, 4, 8).unwrap();
    for frequency in [5.6, 5.7, 5.8, 5.9, 6.0, 6.1, 6.2] {
        let system = oscillator(frequency, 0.002, f64::cos);
        let found = solver(&time).solve(&system, &Orbit::zero(&time, 1)).unwrap();
        let first = found.orbit.harmonics(&time, 0, 1).harmonic(1);
        assert_abs_diff_eq!(first.cosine, 1.0 / (frequency * frequency - 1.0), epsilon = 1e-5);
    }
}

/// `m q'' + c q' + k q = cos psi` with part of the inertia inside `f`.
struct SplitInertia {
    mass: DMatrix<f64>,
    hidden: f64,
}

impl PeriodicSystem for SplitInertia {
    type Error = Infallible;
    type Seen = ();
    type Work = ();

    fn dof(&self) -> usize {
        1
    }

    fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        (): &mut (),
        out: &mut DMatrix<f64>,
    ) -> Result<(), Infallible> {
        *out = &orbit.qdd * self.hidden + &orbit.qd * 0.1 + &orbit.q * 2.3;
        for (i, psi) in orbit.azimuth_rad.iter().enumerate() {
            out[(0, i)] -= psi.cos();
        }
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
        let tangent = LocalTangent {
            dq: DMatrix::from_element(1, 1, 2.3),
            dqd: DMatrix::from_element(1, 1, 0.1),
            dqdd: DMatrix::from_element(1, 1, self.hidden),
        };
        Ok(vec![tangent; orbit.azimuth_rad.len()])
    }
}

#[test]
fn inertia_inside_the_load_is_part_of_the_newton_matrix() {
    let time = TimeElements::default();
    for hidden in [-0.1, 0.1, 0.3] {
        let system = SplitInertia { mass: DMatrix::from_element(1, 1, 1.0 - hidden), hidden };
        let found = solver(&time).solve(&system, &Orbit::zero(&time, 1)).unwrap();
        assert_eq!(found.iterations, 1);
        let first = found.orbit.harmonics(&time, 0, 1).harmonic(1);
        assert_abs_diff_eq!(first.cosine, 1.3 / (1.3 * 1.3 + 0.01), epsilon = 1e-5);
    }
}

/// `q'' + 0.3 q' + atan(3 (q - 1)) + q / 100 = 0.2 cos psi`: far from rest the tangent is nearly flat
/// and a full Newton step goes astray.
struct Saturating {
    mass: DMatrix<f64>,
}

impl PeriodicSystem for Saturating {
    type Error = Infallible;
    type Seen = ();
    type Work = ();

    fn dof(&self) -> usize {
        1
    }

    fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        (): &mut (),
        out: &mut DMatrix<f64>,
    ) -> Result<(), Infallible> {
        for (i, psi) in orbit.azimuth_rad.iter().enumerate() {
            let q = orbit.q[(0, i)];
            out[(0, i)] =
                0.3 * orbit.qd[(0, i)] + (3.0 * (q - 1.0)).atan() + 0.01 * q - 0.2 * psi.cos();
        }
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, Infallible> {
        let tangent = |q: &f64| {
            let mut tangent = LocalTangent::zero(1);
            tangent.dq[(0, 0)] = 3.0 / (1.0 + (3.0 * (q - 1.0)).powi(2)) + 0.01;
            tangent.dqd[(0, 0)] = 0.3;
            tangent
        };
        Ok(orbit.q.iter().map(tangent).collect())
    }
}

#[test]
fn a_step_that_goes_astray_is_shortened() {
    let time = TimeElements::default();
    let system = Saturating { mass: DMatrix::identity(1, 1) };
    let far = Orbit::interpolate(&time, 1, |_| DVector::from_element(1, 4.0));
    for mixing_depth in [0, 5] {
        let settings = PeriodicSettings { mixing_depth, ..PeriodicSettings::default() };
        let mut solver = PeriodicSolver::new(time.clone(), settings).unwrap();
        let found = solver.solve(&system, &far).unwrap();
        println!("{} steps, {} matrices", found.iterations, found.factorisations);
        assert!(found.residual_norm <= 1e-11);
        // the mean of the equation over a revolution: the spring pulls to q = 1 but for q / 100
        let mean = found.orbit.harmonics(&time, 0, 1).mean;
        assert!((0.98..1.0).contains(&mean), "{mean}");
    }
}

/// A system that answers with what it is told to.
struct Faulty {
    mass: DMatrix<f64>,
    value: f64,
}

#[derive(Debug, PartialEq, thiserror::Error)]
#[error("table left at {0}")]
struct TableLeft(f64);

impl PeriodicSystem for Faulty {
    type Error = TableLeft;
    type Seen = ();
    type Work = ();

    fn dof(&self) -> usize {
        1
    }

    fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    fn residual(
        &self,
        orbit: &OrbitSamples,
        (): &mut (),
        out: &mut DMatrix<f64>,
    ) -> Result<(), TableLeft> {
        if self.value < 0.0 {
            return Err(TableLeft(self.value));
        }
        for (i, psi) in orbit.azimuth_rad.iter().enumerate() {
            out[(0, i)] = if *psi > 3.0 { self.value } else { 1.0 } + orbit.q[(0, i)].abs();
        }
        Ok(())
    }

    fn tangents(&self, orbit: &OrbitSamples) -> Result<Vec<LocalTangent>, TableLeft> {
        let mut tangent = LocalTangent::zero(1);
        tangent.dq[(0, 0)] = 1.7;
        tangent.dqd[(0, 0)] = 0.1;
        Ok(vec![tangent; orbit.azimuth_rad.len()])
    }
}

#[test]
fn faults_are_reported_with_what_is_known() {
    let time = TimeElements::default();
    let mut solver = solver(&time);
    let zero = Orbit::zero(&time, 1);
    let mut run = |mass: f64, value: f64, start: &Orbit| {
        let mass = DMatrix::from_element(1, 1, mass);
        solver.solve(&Faulty { mass, value }, start).unwrap_err()
    };
    let wrong = Orbit::zero(&TimeElements::new(4, 5, 8).unwrap(), 1);
    assert!(matches!(run(1.0, 1.0, &wrong), PeriodicError::Shape { found: 20, expected: 40, .. }));
    assert!(matches!(run(-1.0, 1.0, &zero), PeriodicError::Mass { row: 0, column: 0, .. }));
    assert!(matches!(run(f64::NAN, 1.0, &zero), PeriodicError::Mass { .. }));
    let refused = run(1.0, -2.0, &zero);
    assert!(refused.to_string().contains("table left at -2"), "{refused}");
    let PeriodicError::NotFinite { azimuth_rad, iteration: 0, dof: 0, .. } =
        run(1.0, f64::NAN, &zero)
    else {
        panic!("a NaN was not recognised");
    };
    assert!((3.0..3.3).contains(&azimuth_rad));
    // |q| + 1 = -q'' has no periodic solution: the mean cannot vanish
    let PeriodicError::NotConverged { iterations, residual, history, best, .. } =
        run(1.0, 1.0, &zero)
    else {
        panic!("convergence to something that does not exist");
    };
    assert_eq!(history.len(), iterations + 1);
    assert!(residual > 0.1 && best.nodal.iter().all(|q| q.is_finite()));
}

#[test]
fn settings_are_checked() {
    let good = PeriodicSettings::default();
    for bad in [
        PeriodicSettings { tolerance: 0.0, ..good },
        PeriodicSettings { tolerance: f64::NAN, ..good },
        PeriodicSettings { max_iterations: 0, ..good },
        PeriodicSettings { refresh_contraction: 1.0, ..good },
        PeriodicSettings { mixing_depth: 11, ..good },
    ] {
        assert!(PeriodicSolver::new(TimeElements::default(), bad).is_err(), "{bad:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 64,
        failure_persistence: None,
        // the same cases every time
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    /// Linear systems superpose, and the answer to a load is scaled with it.
    #[test]
    fn answers_superpose(
        frequency in 1.2..5.8_f64, zeta in 0.01..0.2_f64, a in -2.0..2.0_f64, b in -2.0..2.0_f64,
    ) {
        let time = TimeElements::new(6, 4, 8).unwrap();
        let zero = Orbit::zero(&time, 1);
        let answer = |a: f64, b: f64| {
            let system = oscillator(frequency, zeta, move |psi| a * psi.cos() + b * (2.0 * psi).sin());
            solver(&time).solve(&system, &zero).unwrap().orbit.nodal
        };
        let sum = answer(1.0, 0.0) * a + answer(0.0, 1.0) * b;
        prop_assert!((answer(a, b) - sum).amax() < 1e-9);
    }

    /// Turning the load by one element turns the answer by one element.
    #[test]
    fn the_mesh_has_no_seam(frequency in 1.2..3.8_f64, shift in 1_usize..6) {
        let time = TimeElements::new(6, 4, 8).unwrap();
        let zero = Orbit::zero(&time, 1);
        let angle = shift as f64 * std::f64::consts::TAU / 6.0;
        let load = |psi: f64| (psi.cos() + 0.3 * (2.0 * psi).sin()).exp();
        let here = solver(&time).solve(&oscillator(frequency, 0.05, load), &zero).unwrap();
        let turned = oscillator(frequency, 0.05, |psi| load(psi - angle));
        let there = solver(&time).solve(&turned, &zero).unwrap();
        let nodes = time.unknowns_per_dof();
        for node in 0..nodes {
            let moved = (node + shift * time.order()) % nodes;
            let gap = here.orbit.nodal[(0, node)] - there.orbit.nodal[(0, moved)];
            prop_assert!(gap.abs() < 1e-9, "{gap:e}");
        }
    }
}

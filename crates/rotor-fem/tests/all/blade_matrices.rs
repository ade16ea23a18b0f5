//! What the blade's matrices and modes must be whatever the numbers: symmetry, rigid motions,
//! orthogonality, nesting, and clear refusals.
#![expect(clippy::unwrap_used, reason = "a test may fail by unwrapping")]

use nalgebra::{Complex, DMatrix, DVector};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use rotor_base::gauss_legendre;
use rotor_fem::{
    BladeModel, BladeProperties, BladeSpec, Distribution, FemError, GyroscopicTerms, ModalBasis,
    ModeCount, ModeKind, RootSupport, Twist, modes, uncoupled_modes,
};

fn uniform() -> BladeSpec {
    BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 300.0)
}

/// A blade with steps, tapers, twist, pitch, precone and offset.
fn varied() -> BladeSpec {
    BladeSpec {
        flap_stiffness: Distribution::PiecewiseLinear {
            stations: vec![0.0, 0.33, 1.0],
            values: vec![0.02, 0.011, 0.008],
        },
        mass: Distribution::PiecewiseConstant {
            edges: vec![0.0, 0.27, 0.61, 1.0],
            values: vec![1.4, 1.0, 0.9],
        },
        twist: Twist::Linear { rate_rad: -0.14 },
        pitch_rad: 0.15,
        precone_rad: 0.05,
        root_offset: 0.06,
        ..uniform()
    }
}

fn model(spec: BladeSpec, elements: usize) -> BladeModel {
    BladeModel::new(BladeProperties::new(spec).unwrap(), elements).unwrap()
}

/// A motion over all degrees of freedom from functions of the station: (u, v, v', w, w', phi).
fn motion(model: &BladeModel, section: impl Fn(f64) -> [f64; 6]) -> DVector<f64> {
    let mut all = DVector::zeros(model.mass().nrows());
    for (joint, x) in model.edges().iter().enumerate() {
        all.fixed_rows_mut::<6>(9 * joint).copy_from_slice(&section(*x));
    }
    for (e, pair) in model.edges().windows(2).enumerate() {
        let at = |s: f64| section(pair[0] + s * (pair[1] - pair[0]));
        all[9 * e + 6] = at(1.0 / 3.0)[0];
        all[9 * e + 7] = at(2.0 / 3.0)[0];
        all[9 * e + 8] = at(0.5)[5];
    }
    all
}

fn form(matrix: &DMatrix<f64>, a: &DVector<f64>, b: &DVector<f64>) -> f64 {
    a.dot(&(matrix * b))
}

#[test]
fn sizes_follow_the_element() {
    for n in [1, 4, 10] {
        let clamped = model(uniform(), n);
        assert_eq!(clamped.mass().nrows(), 9 * n + 6);
        assert_eq!(clamped.free().len(), 9 * n);
        let hinged = model(BladeSpec { root: RootSupport::HINGED, ..uniform() }, n);
        assert_eq!(hinged.free().len(), 9 * n + 2);
    }
}

#[test]
fn matrices_are_symmetric_and_skew() {
    let model = model(varied(), 6);
    for (matrix, sign) in
        [(model.mass(), 1.0), (model.stiffness(), 1.0), (model.gyroscopic(), -1.0)]
    {
        let gap = (matrix - matrix.transpose() * sign).amax();
        assert!(gap <= 1e-14 * matrix.amax(), "{gap:e}");
    }
    assert!(model.mass().clone().cholesky().is_some());
}

/// Rigid motions of a free uniform blade have the inertia, weightlessness and Coriolis force of a rod.
#[test]
fn rigid_motions_are_those_of_a_rod() {
    let speed = 1.3;
    let rod = model(BladeSpec { rotor_speed: speed, ..uniform() }, 5);
    let shift =
        |k: usize| motion(&rod, move |_| std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 }));
    let turn_lag = motion(&rod, |x| [0.0, x, 1.0, 0.0, 0.0, 0.0]);
    let turn_flap = motion(&rod, |x| [0.0, 0.0, 0.0, x, 1.0, 0.0]);
    let (radial, inplane, up) = (shift(0), shift(1), shift(3));
    let square = speed * speed;
    let expected = [
        ("mass", form(rod.mass(), &up, &up), 1.0),
        ("moment of inertia", form(rod.mass(), &turn_lag, &turn_lag), 1.0 / 3.0),
        ("static moment", form(rod.mass(), &up, &turn_flap), 0.5),
        ("radial shift", form(rod.stiffness(), &radial, &radial), -square),
        ("in-plane shift", form(rod.stiffness(), &inplane, &inplane), -square),
        ("vertical shift", form(rod.stiffness(), &up, &up), 0.0),
        ("turn in the plane", form(rod.stiffness(), &turn_lag, &turn_lag), 0.0),
        ("turn out of the plane", form(rod.stiffness(), &turn_flap, &turn_flap), square / 3.0),
        // turning faster by 1 raises the centrifugal force by 2 Omega x: left side of the equation
        ("Coriolis, radial", form(rod.gyroscopic(), &radial, &turn_lag), -speed),
        ("Coriolis, in-plane", form(rod.gyroscopic(), &turn_lag, &radial), speed),
    ];
    for (what, got, want) in expected {
        assert!((got - want).abs() < 1e-11, "{what}: {got} instead of {want}");
    }
    let at_rest = model(BladeSpec { rotor_speed: 0.0, pitch_rad: 0.3, ..uniform() }, 5);
    for rigid in [&radial, &inplane, &up, &turn_lag, &turn_flap] {
        assert!((at_rest.stiffness() * rigid).amax() < 1e-9);
    }
}

/// A smooth motion's energies against direct integration of the expressions, steps and all.
#[test]
fn energies_of_a_smooth_motion_meet_direct_integration() {
    let spec = varied();
    let model = model(spec.clone(), 7);
    let blade = model.properties();
    // cubic u, v, w and quadratic phi are held exactly
    let u = |x: f64| [0.2 * x - x * x, 0.2 - 2.0 * x];
    let v = |x: f64| [x * x - 0.4 * x.powi(3), 2.0 * x - 1.2 * x * x, 2.0 - 2.4 * x];
    let w = |x: f64| [0.3 * x + x.powi(3), 0.3 + 3.0 * x * x, 6.0 * x];
    let p = |x: f64| [0.1 * x + 0.5 * x * x, 0.1 + x];
    let q = motion(&model, |x| [u(x)[0], v(x)[0], v(x)[1], w(x)[0], w(x)[1], p(x)[0]]);
    let (mut strain, mut kinetic) = (0.0, 0.0);
    let rule = gauss_legendre(12);
    for ends in blade.breaks().windows(2) {
        for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
            let half = 0.5 * (ends[1] - ends[0]);
            let x = 0.5 * (ends[0] + ends[1]) + half * node;
            let dx = half * weight;
            let theta = spec.pitch_rad - 0.14 * (x - 0.75);
            let (s, c) = theta.sin_cos();
            let (sb, cb) = spec.precone_rad.sin_cos();
            let m = blade.mass(x);
            let (km1, km2, ka) = (0.0132_f64, 0.0247_f64, 0.029_f64);
            let tension = blade.tension(x);
            strain += dx
                * (0.0268 * (v(x)[2] * c + w(x)[2] * s).powi(2)
                    + blade.flap_stiffness(x) * (w(x)[2] * c - v(x)[2] * s).powi(2)
                    + 300.0 * (u(x)[1] - ka * ka * 0.14 * p(x)[1]).powi(2)
                    + (0.006_15 + tension * ka * ka) * p(x)[1].powi(2)
                    + tension * (v(x)[1].powi(2) + w(x)[1].powi(2))
                    - m * v(x)[0].powi(2)
                    - m * (u(x)[0] * cb - w(x)[0] * sb).powi(2)
                    + m * cb
                        * cb
                        * (km2 * km2 - km1 * km1)
                        * (2.0 * theta).cos()
                        * p(x)[0].powi(2));
            kinetic += dx
                * m
                * (u(x)[0].powi(2)
                    + v(x)[0].powi(2)
                    + w(x)[0].powi(2)
                    + (km1 * km1 + km2 * km2) * p(x)[0].powi(2));
        }
    }
    assert!((form(model.mass(), &q, &q) / kinetic - 1.0).abs() < 1e-12);
    // pitch with twist is not polynomial: six Gauss points leave a little
    assert!((form(model.stiffness(), &q, &q) / strain - 1.0).abs() < 1e-10);
    let motion = model.motion(&q, 0.613).unwrap();
    assert!((motion.flap[0] - w(0.613)[0]).abs() < 1e-12);
    assert!((motion.lag[2] - v(0.613)[2]).abs() < 1e-9);
    assert!((motion.axial[1] - u(0.613)[1]).abs() < 1e-11);
    assert!((motion.twist[1] - p(0.613)[1]).abs() < 1e-11);
}

#[test]
fn coupled_modes_are_orthogonal_and_solve_their_equations() {
    let model = model(varied(), 8);
    let count = ModeCount { flap: 4, lag: 4, torsion: 2, axial: 1 };
    let real = modes(&model, GyroscopicTerms::Neglected, count).unwrap();
    for (i, a) in real.iter().enumerate() {
        assert!(a.quadrature.iter().all(|part| part.abs() < f64::MIN_POSITIVE));
        for (j, b) in real.iter().enumerate() {
            let unit = f64::from(u8::from(i == j));
            let mass = form(model.mass(), &a.in_phase, &b.in_phase);
            let stiffness = form(model.stiffness(), &a.in_phase, &b.in_phase);
            assert!((mass - unit).abs() < 1e-9, "{i} {j} {mass}");
            let scale = a.frequency * b.frequency;
            assert!((stiffness / scale - unit).abs() < 1e-8, "{i} {j} {stiffness}");
        }
    }
    let turning = modes(&model, GyroscopicTerms::Included, count).unwrap();
    let free = model.free();
    let cut = |m: &DMatrix<f64>| {
        DMatrix::from_fn(free.len(), free.len(), |i, j| Complex::from(m[(free[i], free[j])]))
    };
    let (m, g, k) = (cut(model.mass()), cut(model.gyroscopic()), cut(model.stiffness()));
    for (mode, still) in turning.iter().zip(&real) {
        let q = DVector::from_fn(free.len(), |i, _| {
            Complex::new(mode.in_phase[free[i]], mode.quadrature[free[i]])
        });
        let w = Complex::from(mode.frequency);
        let left: DVector<Complex<f64>> =
            &k * &q + &g * &q * Complex::new(0.0, mode.frequency) - &m * &q * (w * w);
        let size = (&k * &q).map(Complex::norm).amax();
        let rest = left.map(Complex::norm).amax();
        assert!(rest < 1e-9 * size, "{} {}: {rest:e} of {size:e}", mode.kind, mode.number);
        assert!((q.dotc(&(&m * &q)).re - 1.0).abs() < 1e-10);
        assert_eq!((mode.kind, mode.number), (still.kind, still.number));
        let energy = ModeKind::ALL.map(|kind| mode.energy.of(kind));
        assert!((energy.iter().sum::<f64>() - 1.0).abs() < 1e-12);
    }
    // the coupling moves the modes, and lag carries axial motion a quarter cycle away
    let lag = turning.iter().position(|mode| mode.kind == ModeKind::Lag).unwrap();
    assert!((turning[lag].frequency - real[lag].frequency).abs() > 1e-4);
    let tip = turning[lag].in_phase.len() - 6;
    assert!(turning[lag].quadrature[tip].abs() > 100.0 * turning[lag].in_phase[tip].abs());
}

#[test]
fn the_mode_set_is_normalised_ordered_and_orthogonal() {
    let blade = BladeProperties::new(varied()).unwrap();
    let set = uncoupled_modes(&blade, 10, ModeCount::default(), ModalBasis::Natural).unwrap();
    assert_eq!(set.len(), 10);
    let kinds: Vec<ModeKind> = set.modes().iter().map(|mode| mode.kind).collect();
    assert_eq!(kinds[..4], [ModeKind::Flap; 4]);
    assert_eq!(kinds[4..8], [ModeKind::Lag; 4]);
    assert_eq!(kinds[8..], [ModeKind::Torsion; 2]);

    // quadrature that respects elements and jumps
    let rule = gauss_legendre(6);
    let mut ends: Vec<f64> = blade.breaks().to_vec();
    ends.extend((0..=10).map(|i| 0.06 + 0.94 * f64::from(i) / 10.0));
    ends.sort_by(f64::total_cmp);
    let (mut stations, mut weights) = (Vec::new(), Vec::new());
    for pair in ends.windows(2) {
        let half = 0.5 * (pair[1] - pair[0]);
        stations.extend(rule.nodes.iter().map(|s| 0.5 * (pair[0] + pair[1]) + half * s));
        weights.extend(rule.weights.iter().map(|w| half * w));
    }
    let samples = set.sample(&stations).unwrap();
    for (mode, shape) in set.modes().iter().zip(&samples) {
        let [tip, ..] = mode.shape(1.0).unwrap();
        assert!((tip - 1.0).abs() < 1e-12);
        assert!(mode.shape(0.03).unwrap().iter().all(|part| part.abs() < f64::MIN_POSITIVE));
        for (other, other_shape) in set.modes().iter().zip(&samples) {
            if mode.kind != other.kind {
                continue;
            }
            let product: f64 = (0..stations.len())
                .map(|i| {
                    let radius = match mode.kind {
                        ModeKind::Torsion => blade.squared_polar_radius(stations[i]),
                        _ => 1.0,
                    };
                    let m = blade.mass(stations[i]) * radius;
                    weights[i] * m * shape[i][0] * other_shape[i][0]
                })
                .sum();
            let expected = if mode.number == other.number { mode.modal_mass } else { 0.0 };
            assert!((product - expected).abs() < 1e-9 * mode.modal_mass.max(1e-5), "{product}");
        }
        // derivatives belong to the values
        let h = 1e-5;
        let x = 0.437;
        let [at, before, after] = [x, x - h, x + h].map(|x| mode.shape(x).unwrap());
        assert!(((after[0] - before[0]) / (2.0 * h) - at[1]).abs() < 1e-5);
        assert!(((after[1] - before[1]) / (2.0 * h) - at[2]).abs() < 1e-4);
    }
}

/// Turning about the axis of rotation is free, with Coriolis terms and without.
#[test]
fn a_lag_hinge_on_the_axis_is_neutral() {
    for elements in 3..=10 {
        let hinged = model(BladeSpec { root: RootSupport::HINGED, ..uniform() }, elements);
        let count = ModeCount { flap: 1, lag: 2, torsion: 0, axial: 0 };
        for terms in [GyroscopicTerms::Neglected, GyroscopicTerms::Included] {
            let found = modes(&hinged, terms, count).unwrap();
            let frequencies: Vec<f64> = found.iter().map(|mode| mode.frequency).collect();
            assert!((frequencies[0] - 1.0).abs() < 1e-7, "{frequencies:?}");
            assert_eq!(found[1].kind, ModeKind::Lag);
            assert!(frequencies[1] < 1e-4, "{frequencies:?}");
            assert!((frequencies[2] - 3.5).abs() < 0.5, "{frequencies:?}");
        }
    }
}

/// A blade that does not feel its rotation in torsion, under a uniform moment `q`: the rate of twist at its
/// root is `q / GJ`. Natural modes miss it by `1/N`; with the completion two shapes are enough.
#[test]
fn the_completion_carries_a_load_up_to_the_root() {
    let spec = BladeSpec {
        thickness_gyration_radius: 0.02.into(),
        chord_gyration_radius: 0.02.into(),
        area_gyration_radius: 0.0.into(),
        ..uniform()
    };
    let blade = BladeProperties::new(spec).unwrap();
    let exact = blade.torsion_stiffness(0.0).recip();
    let root_rate = |modes: usize, basis: ModalBasis| -> f64 {
        let count = ModeCount { flap: 1, lag: 1, torsion: modes, axial: 0 };
        let set = uncoupled_modes(&blade, 40, count, basis).unwrap();
        set.of(ModeKind::Torsion)
            .iter()
            .map(|mode| {
                let rule = gauss_legendre(3);
                let points = (0..40).flat_map(|e| {
                    let at = move |s: &f64| (f64::from(e) + 0.5 * (s + 1.0)) / 40.0;
                    rule.nodes.iter().map(at).zip(&rule.weights).collect::<Vec<_>>()
                });
                let work: f64 =
                    points.map(|(x, w)| 0.5 / 40.0 * w * mode.shape(x).unwrap()[0]).sum();
                // the slope of a quadratic element is best in its middle: extrapolated to the root
                let slope = |e: f64| mode.shape((e + 0.5) / 40.0).unwrap()[1];
                let at_root = 1.5 * slope(0.0) - 0.5 * slope(1.0);
                work * at_root / (mode.frequency.powi(2) * mode.modal_mass)
            })
            .sum()
    };
    for modes in [2, 3, 5] {
        let [natural, completed] = [ModalBasis::Natural, ModalBasis::Completed]
            .map(|basis| (root_rate(modes, basis) / exact - 1.0).abs());
        println!("{modes} shapes: {natural:.1e}, {completed:.1e}");
        assert!(completed <= 1e-3 * natural, "{modes} shapes: {natural:e}, {completed:e}");
        // 2 / (pi^2 N): the rest of the series of 8 / ((2n - 1) pi)^2
        let rest = 2.0 / (std::f64::consts::PI.powi(2) * modes as f64);
        assert!((natural / rest - 1.0).abs() < 0.1, "{modes} shapes: {natural:e}, {rest:e}");
    }
}

/// The completion is orthogonal to the modes it stands beside, which stay what they are; one mode alone
/// is kept.
#[test]
fn the_completion_leaves_the_modes_alone() {
    let blade = BladeProperties::new(varied()).unwrap();
    let count = ModeCount { flap: 4, lag: 3, torsion: 1, axial: 0 };
    let [natural, completed] = [ModalBasis::Natural, ModalBasis::Completed]
        .map(|basis| uncoupled_modes(&blade, 10, count, basis).unwrap());
    for (kind, kept) in [(ModeKind::Flap, 3), (ModeKind::Lag, 2), (ModeKind::Torsion, 1)] {
        let (natural, completed) = (natural.of(kind), completed.of(kind));
        assert_eq!(natural[..kept], completed[..kept]);
        if let (Some(last), Some(rest)) = (natural.get(kept), completed.get(kept)) {
            assert!(rest.frequency > last.frequency);
            assert!((rest.shape(1.0).unwrap()[0] - 1.0).abs() < 1e-12);
        }
    }
    let rule = gauss_legendre(8);
    let mut ends: Vec<f64> = blade.breaks().to_vec();
    ends.extend((0..=10).map(|i| 0.06 + 0.94 * f64::from(i) / 10.0));
    ends.sort_by(f64::total_cmp);
    let flap = completed.of(ModeKind::Flap);
    for mode in &flap[..3] {
        let mut product = 0.0;
        for pair in ends.windows(2) {
            let half = 0.5 * (pair[1] - pair[0]);
            for (s, w) in rule.nodes.iter().zip(&rule.weights) {
                let x = 0.5 * (pair[0] + pair[1]) + half * s;
                let shapes = [mode, &flap[3]].map(|m| m.shape(x).unwrap()[0]);
                product += half * w * blade.mass(x) * shapes[0] * shapes[1];
            }
        }
        let scale = (mode.modal_mass * flap[3].modal_mass).sqrt();
        assert!(product.abs() < 1e-10 * scale, "{product:e}");
    }
}

#[test]
fn refusals_say_what_to_do() {
    let blade = BladeProperties::new(uniform()).unwrap();
    assert!(matches!(
        BladeModel::new(blade.clone(), 0),
        Err(FemError::Parameter { value: 0.0, .. })
    ));
    let wanted = ModeCount { flap: 40, ..ModeCount::default() };
    assert!(matches!(
        uncoupled_modes(&blade, 3, wanted, ModalBasis::Natural),
        Err(FemError::TooFewModes { kind: ModeKind::Flap, wanted: 40, available: 6 })
    ));
    let axial = ModeCount { axial: 1, ..ModeCount::default() };
    assert!(matches!(
        uncoupled_modes(&blade, 3, axial, ModalBasis::Natural),
        Err(FemError::TooFewModes { .. })
    ));
    let set = uncoupled_modes(&blade, 5, ModeCount::default(), ModalBasis::Natural).unwrap();
    for station in [-0.1, 1.1, f64::NAN] {
        assert!(matches!(set.sample(&[0.5, station]), Err(FemError::Station { .. })));
    }
    // a lag hinge on the axis of a preconed rotor turns over
    let preconed = model(BladeSpec { root: RootSupport::HINGED, precone_rad: 0.2, ..uniform() }, 5);
    let error = modes(&preconed, GyroscopicTerms::Included, ModeCount::default()).unwrap_err();
    let FemError::NotStable { squared_frequency } = error else { panic!("{error}") };
    assert!((squared_frequency + 0.2_f64.sin().powi(2)).abs() < 1e-6, "{squared_frequency}");
    // mass spread out of the plane with hardly any stiffness: the propeller moment turns it over
    let floppy = BladeSpec {
        torsion_stiffness: 1e-7.into(),
        thickness_gyration_radius: 0.04.into(),
        area_gyration_radius: 0.0.into(),
        ..uniform()
    };
    let floppy = BladeProperties::new(floppy).unwrap();
    let error = uncoupled_modes(&floppy, 5, ModeCount::default(), ModalBasis::Natural).unwrap_err();
    let FemError::NotStable { squared_frequency } = error else { panic!("{error}") };
    assert!(squared_frequency < -0.1, "{squared_frequency}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 24,
        failure_persistence: None,
        // the same cases every time
        rng_seed: RngSeed::Fixed(1),
        ..ProptestConfig::default()
    })]

    /// Halving the elements nests the spaces: no frequency may rise. Sections that all have the same
    /// properties are a uniform blade, wherever they are cut.
    #[test]
    fn refinement_lowers_and_cuts_do_not_matter(
        flap in 0.002..0.05_f64, lag in 0.01..0.1_f64, twist in -0.3..0.3_f64, pitch in -0.3..0.4_f64,
        speed in 0.2..1.5_f64, cut in 0.05..0.95_f64,
    ) {
        let spec = BladeSpec {
            flap_stiffness: flap.into(),
            lag_stiffness: lag.into(),
            twist: Twist::Linear { rate_rad: twist },
            pitch_rad: pitch,
            rotor_speed: speed,
            ..uniform()
        };
        // the lowest of all, whatever their family: families trade names where frequencies cross
        let frequencies = |spec: &BladeSpec, n: usize| -> Vec<f64> {
            let count = ModeCount { flap: 4, lag: 3, torsion: 2, axial: 0 };
            let found = modes(&model(spec.clone(), n), GyroscopicTerms::Neglected, count).unwrap();
            let mut all: Vec<f64> = found.iter().map(|mode| mode.frequency).collect();
            all.sort_by(f64::total_cmp);
            all.truncate(5);
            all
        };
        let (coarse, fine) = (frequencies(&spec, 4), frequencies(&spec, 8));
        for (c, f) in coarse.iter().zip(&fine) {
            prop_assert!(*f <= c * (1.0 + 1e-10), "{f} above {c}");
        }
        let sections = BladeSpec {
            mass: Distribution::PiecewiseConstant {
                edges: vec![0.0, cut, 1.0],
                values: vec![1.0, 1.0],
            },
            ..spec
        };
        for (whole, pieces) in coarse.iter().zip(frequencies(&sections, 4)) {
            prop_assert!((whole - pieces).abs() < 1e-8 * whole);
        }
    }
}

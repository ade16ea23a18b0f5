//! Rotating frequencies of uniform blades against exact series, closed forms and published values.
#![expect(clippy::unwrap_used, reason = "a test may fail by unwrapping")]

use std::f64::consts::PI;
use std::path::Path;

use rotor_fem::{
    BladeModel, BladeProperties, BladeSpec, GyroscopicTerms, ModalBasis, ModeCount, ModeKind,
    RootSupport, Twist, modes, uncoupled_modes,
};

/// The uniform blade of the paper's Table 1 with a stiff axis.
fn table_1() -> BladeSpec {
    BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 1e6)
}

fn blade(spec: BladeSpec) -> BladeProperties {
    BladeProperties::new(spec).unwrap()
}

/// Rows of a reference table, cut at commas outside quotes.
fn table(name: &str) -> Vec<Vec<String>> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/reference/rotor").join(name);
    let mut reader = csv::ReaderBuilder::new().flexible(true).from_path(path).unwrap();
    reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect()
}

/// Frequencies per rev in the row of `family` and `method`.
fn table_1_row(family: &str, method: &str) -> Vec<f64> {
    let rows = table("bo105_uniform_frequencies.csv");
    let row = rows.iter().find(|row| row[0] == family && row[1] == method).unwrap();
    row[2..].iter().map(|v| v.parse().unwrap()).collect()
}

/// Coupled frequencies per rev without gyroscopic terms.
fn coupled(spec: BladeSpec, elements: usize, kind: ModeKind, count: usize) -> Vec<f64> {
    let model = BladeModel::new(blade(spec), elements).unwrap();
    let mut wanted = ModeCount { flap: 0, lag: 0, torsion: 0, axial: 0 };
    match kind {
        ModeKind::Flap => wanted.flap = count,
        ModeKind::Lag => wanted.lag = count,
        ModeKind::Torsion => wanted.torsion = count,
        ModeKind::Axial => wanted.axial = count,
    }
    let found = modes(&model, GyroscopicTerms::Neglected, wanted).unwrap();
    found.iter().map(|mode| mode.per_rev).collect()
}

fn relative_errors(got: &[f64], exact: &[f64]) -> Vec<f64> {
    got.iter().zip(exact).map(|(g, e)| (g - e).abs() / e).collect()
}

fn worst(errors: &[f64]) -> f64 {
    errors.iter().copied().fold(0.0, f64::max)
}

#[test]
fn table_1_frequencies_meet_the_series_and_converge_with_the_fourth_power() {
    for (family, kind) in [("flap", ModeKind::Flap), ("lag", ModeKind::Lag)] {
        let exact = &table_1_row(family, "exact")[..4];
        let errors = [10, 20, 40].map(|n| relative_errors(&coupled(table_1(), n, kind, 4), exact));
        println!("{family}: 10 el. {:.2e}, 20 el. {:.2e}", worst(&errors[0]), worst(&errors[1]));
        assert!(worst(&errors[0]) <= 1e-3);
        assert!(worst(&errors[1]) <= 6e-5);
        for (coarse, fine) in errors[1].iter().zip(&errors[2]) {
            println!("{family}: ratio 20 to 40 {:.3}", coarse / fine);
            assert!((15.0..=17.0).contains(&(coarse / fine)), "{}", coarse / fine);
        }
    }
}

/// An independent program with Hermite elements has the same errors: ours are those of the element.
#[test]
fn table_1_frequencies_equal_those_of_an_independent_program() {
    for (family, kind) in [("flap", ModeKind::Flap), ("lag", ModeKind::Lag)] {
        for (elements, method) in [(5, "FE5"), (10, "FE10"), (20, "FE20"), (40, "FE40")] {
            let theirs = &table_1_row(family, method)[..4];
            let set = uncoupled_modes(
                &blade(table_1()),
                elements,
                ModeCount::default(),
                ModalBasis::Natural,
            )
            .unwrap();
            let ours: Vec<f64> = set.of(kind).iter().map(|mode| mode.per_rev).collect();
            let gap = worst(&relative_errors(&ours, theirs));
            assert!(gap < 1e-8, "{family} {method}: {gap:e}");
        }
    }
    let family = "torsion km1=.0132,km2=.0247,kA=.029";
    for (elements, method) in [(5, "FE5"), (10, "FE10"), (20, "FE20"), (40, "FE40")] {
        let theirs = table_1_row(family, method);
        let gap =
            worst(&relative_errors(&coupled(table_1(), elements, ModeKind::Torsion, 3), &theirs));
        assert!(gap < 1e-8, "{family} {method}: {gap:e}");
    }
}

#[test]
fn at_rest_the_blade_is_a_cantilever() {
    let spec = BladeSpec { rotor_speed: 0.0, ..table_1() };
    let set = uncoupled_modes(&blade(spec), 20, ModeCount::default(), ModalBasis::Natural).unwrap();
    for (family, kind) in [("flap", ModeKind::Flap), ("lag", ModeKind::Lag)] {
        let exact = &table_1_row(family, "nonrot")[..4];
        let got: Vec<f64> = set.of(kind).iter().map(|mode| mode.frequency).collect();
        assert!(worst(&relative_errors(&got, exact)) < 1e-4);
        assert!(set.of(kind).iter().all(|mode| mode.per_rev.is_infinite()));
    }
}

#[test]
fn lag_and_flap_of_equal_stiffness_differ_by_one_rev_squared() {
    for (elements, offset) in [(7, 0.0), (20, 0.1)] {
        let spec = BladeSpec { flap_stiffness: 0.0268.into(), root_offset: offset, ..table_1() };
        let set =
            uncoupled_modes(&blade(spec), elements, ModeCount::default(), ModalBasis::Natural)
                .unwrap();
        for (flap, lag) in set.of(ModeKind::Flap).iter().zip(set.of(ModeKind::Lag)) {
            let gap = flap.per_rev.powi(2) - lag.per_rev.powi(2) - 1.0;
            assert!(gap.abs() < 1e-9 * flap.per_rev.powi(2), "{gap:e}");
        }
    }
}

/// Without trapeze effect, `T_n^2 = ((2 n - 1) pi / 2)^2 GJ / k_m^2 + (k_m2^2 - k_m1^2) / k_m^2`.
#[test]
fn torsion_meets_its_closed_form() {
    for (km1, km2) in [(0.0_f64, 0.025_f64), (0.0132, 0.0247)] {
        let spec = BladeSpec {
            thickness_gyration_radius: km1.into(),
            chord_gyration_radius: km2.into(),
            area_gyration_radius: 0.0.into(),
            ..table_1()
        };
        let km_2 = km1 * km1 + km2 * km2;
        let exact: Vec<f64> = (1..=2)
            .map(|n| {
                let wave = (2.0 * f64::from(n) - 1.0) * PI / 2.0;
                (wave * wave * 0.006_15 / km_2 + (km2 * km2 - km1 * km1) / km_2).sqrt()
            })
            .collect();
        let errors = [20, 40]
            .map(|n| relative_errors(&coupled(spec.clone(), n, ModeKind::Torsion, 2), &exact));
        println!("torsion, 40 elements: {:?}", errors[1]);
        assert!(worst(&errors[1]) <= 1e-6);
        let ratio = errors[0][1] / errors[1][1];
        assert!((15.0..=17.0).contains(&ratio), "{ratio}");
    }
    let paper = coupled(table_1(), 40, ModeKind::Torsion, 2);
    assert!(worst(&relative_errors(&paper, &[4.588_073, 13.521_86])) < 1e-6, "{paper:?}");
}

/// The beam of length L on a hub of radius e, in units of the tip radius R = L + e.
fn rotating_beam(root: RootSupport, offset_over_length: f64, eta: f64) -> BladeProperties {
    let radius = 1.0 + offset_over_length;
    let stiffness = radius.powi(-4);
    blade(BladeSpec {
        root_offset: offset_over_length / radius,
        root,
        rotor_speed: eta,
        ..BladeSpec::uniform(stiffness, stiffness, 1.0, 1e4)
    })
}

#[test]
fn rotating_beams_meet_the_exact_table() {
    let mut largest = 0.0_f64;
    let mut rows = 0;
    for row in table("rotating_beam_exact.csv") {
        let root = match row[0].as_str() {
            "clamped" => RootSupport::CLAMPED,
            "hinged" => RootSupport::HINGED,
            other => panic!("unknown root {other}"),
        };
        let numbers: Vec<f64> = row[1..].iter().map(|v| v.parse().unwrap()).collect();
        let (offset, eta, exact) = (numbers[0], numbers[1], &numbers[2..]);
        // at rest the hinged beam's rigid mode, frequency 0, is not in the table
        let skip = usize::from(root == RootSupport::HINGED && eta == 0.0);
        let count = ModeCount { flap: 5 + skip, lag: 0, torsion: 0, axial: 0 };
        let set =
            uncoupled_modes(&rotating_beam(root, offset, eta), 24, count, ModalBasis::Natural)
                .unwrap();
        let got: Vec<f64> = set.modes().iter().map(|mode| mode.frequency).collect();
        assert!(skip == 0 || got[0] < 1e-3, "{got:?}");
        let error = worst(&relative_errors(&got[skip..], exact));
        assert!(error <= 5e-4, "{row:?}: {error:e}");
        largest = largest.max(error);
        rows += 1;
    }
    assert_eq!(rows, 60);
    println!("rotating beams, 24 elements: largest error {largest:.2e}");
}

#[test]
fn a_hinged_blade_flaps_rigidly_once_per_rev() {
    for speed in [0.5, 1.0, 1.2] {
        let spec = BladeSpec { root: RootSupport::HINGED, rotor_speed: speed, ..table_1() };
        let count = ModeCount { flap: 1, lag: 1, torsion: 0, axial: 0 };
        let set = uncoupled_modes(&blade(spec), 10, count, ModalBasis::Natural).unwrap();
        let [flap, lag] = set.modes() else { panic!("two modes") };
        assert!((flap.per_rev - 1.0).abs() < 1e-9, "{}", flap.per_rev);
        // a lag hinge on the axis of rotation has no stiffness
        assert!(lag.per_rev < 1e-5, "{}", lag.per_rev);
        for x in [0.0, 0.33, 0.8, 1.0] {
            let [value, slope, curvature] = flap.shape(x).unwrap();
            assert!((value - x).abs() < 1e-8 && (slope - 1.0).abs() < 1e-8, "{x} {value} {slope}");
            assert!(curvature.abs() < 1e-5);
        }
    }
}

/// Rigid flapping about a hinge on the axis of a rotor with precone b: `nu^2 = cos 2b`.
#[test]
fn precone_weakens_the_centrifugal_spring() {
    let b = 0.2_f64;
    let spec = BladeSpec {
        root: RootSupport::HINGED,
        precone_rad: b,
        flap_stiffness: 1.0.into(),
        lag_stiffness: 1.0.into(),
        ..table_1()
    };
    let model = BladeModel::new(blade(spec), 10).unwrap();
    // the motion w = x over all degrees of freedom
    let mut rigid = nalgebra::DVector::zeros(model.mass().nrows());
    for (joint, x) in model.edges().iter().enumerate() {
        rigid[9 * joint + 3] = *x;
        rigid[9 * joint + 4] = 1.0;
    }
    let stiffness = rigid.dot(&(model.stiffness() * &rigid));
    let mass = rigid.dot(&(model.mass() * &rigid));
    assert!((stiffness / mass - (2.0 * b).cos()).abs() < 1e-10);
}

#[test]
fn pitch_and_twist_couple_flap_and_lag_as_in_the_table() {
    let mut largest = 0.0_f64;
    for row in table("bo105_pitch_coupled_frequencies.csv") {
        let (pitch_deg, twist_deg) = match row[0].as_str() {
            "pitch_0deg" => (0.0, 0.0),
            "pitch_5deg" => (5.0, 0.0),
            "pitch_10deg" => (10.0, 0.0),
            "pitch_15deg" => (15.0, 0.0),
            "th75=8deg,twist=-8deg" => (8.0, -8.0),
            other => panic!("unknown case {other}"),
        };
        let spec = BladeSpec {
            pitch_rad: f64::to_radians(pitch_deg),
            twist: Twist::Linear { rate_rad: f64::to_radians(twist_deg) },
            ..table_1()
        };
        let exact: Vec<f64> = row[1..].iter().map(|v| v.parse().unwrap()).collect();
        let (flap, lag) =
            (coupled(spec.clone(), 20, ModeKind::Flap, 3), coupled(spec, 20, ModeKind::Lag, 3));
        let got = [lag[0], flap[0], flap[1], lag[1], flap[2], lag[2]];
        let error = worst(&relative_errors(&got, &exact));
        largest = largest.max(error);
        // the table prints six decimals, 7e-7 of L1
        assert!(error < 2e-6, "{}: {error:e} {got:?}", row[0]);
    }
    println!("pitch-coupled frequencies: largest error {largest:.1e}");
}

/// Lag frequencies of a beam of slenderness 70: the Coriolis force on axial motion lowers them.
///
/// Source: Hamza Cherif and Houmat, as kept in the test suite of mboct-fem-pkg
/// (`fem_tests_060.tst`, commit b0fc510).
#[test]
fn lag_axial_coriolis_coupling_meets_published_values() {
    let published = [(2.0_f64, 3.6195), (4.0, 3.888), (6.0, 4.2393), (8.0, 4.6105), (10.0, 4.97)];
    let count = ModeCount { flap: 1, lag: 1, torsion: 0, axial: 0 };
    let flap = [4.1373, 5.5850, 7.3603, 9.2568, 11.2023];
    for ((eta, theirs), flap) in published.into_iter().zip(flap) {
        let spec = BladeSpec { rotor_speed: eta, ..BladeSpec::uniform(1.0, 1.0, 1.0, 4900.0) };
        let model = BladeModel::new(blade(spec), 20).unwrap();
        let lag = |terms| {
            let found = modes(&model, terms, count).unwrap();
            assert!((found[0].frequency / flap - 1.0).abs() < 2e-5, "{}", found[0].frequency);
            found[1].frequency
        };
        let (with, without) = (lag(GyroscopicTerms::Included), lag(GyroscopicTerms::Neglected));
        println!("eta {eta}: {with:.5} (published {theirs}), without {without:.5}");
        assert!((with / theirs - 1.0).abs() <= 3e-5);
        // the bound sees the effect: at every speed it fails without the Coriolis terms
        assert!((without / theirs - 1.0).abs() > 5e-4);
        assert!((without - (flap * flap - eta * eta).sqrt()).abs() < 2e-3 * without);
    }
}

#[test]
fn stretch_lowers_the_lag_frequency_of_the_paper_rotor() {
    for (stiffness, l1) in [(200.0, 0.698_69), (1000.0, 0.700_83), (1e6, 0.701_363)] {
        let spec = BladeSpec { axial_stiffness: stiffness.into(), ..table_1() };
        let model = BladeModel::new(blade(spec), 20).unwrap();
        let found = modes(&model, GyroscopicTerms::Included, ModeCount::default()).unwrap();
        let lag = found.iter().find(|mode| mode.kind == ModeKind::Lag).unwrap();
        assert!((lag.per_rev - l1).abs() < 1e-5, "{stiffness}: {}", lag.per_rev);
    }
}

#[test]
fn a_root_offset_raises_the_frequencies_of_the_shorter_blade() {
    let spec = BladeSpec { root_offset: 0.05, ..table_1() };
    let (flap, lag) =
        (coupled(spec.clone(), 20, ModeKind::Flap, 1)[0], coupled(spec, 20, ModeKind::Lag, 1)[0]);
    assert!((flap - 1.1766).abs() < 5e-5 && (lag - 0.8081).abs() < 5e-5, "{flap} {lag}");
}

/// Along the fan plot the modes obey Southwell's form: frequencies rise, between the bounds
/// `w0^2 + a W^2` of tension alone.
#[test]
fn the_fan_plot_starts_at_rest_and_rises() {
    let speeds = [0.0, 0.25, 0.5, 0.75, 1.0, 1.2];
    let count = ModeCount { flap: 3, lag: 2, torsion: 1, axial: 0 };
    let spec = BladeSpec { pitch_rad: 0.14, axial_stiffness: 500.0.into(), ..table_1() };
    let fan = speeds.map(|rotor_speed| {
        let spec = BladeSpec { rotor_speed, ..spec.clone() };
        let model = BladeModel::new(blade(spec), 8).unwrap();
        modes(&model, GyroscopicTerms::Included, count).unwrap()
    });
    for pair in fan.windows(2) {
        for (slow, fast) in pair[0].iter().zip(&pair[1]) {
            assert_eq!((slow.kind, slow.number), (fast.kind, fast.number));
            assert!(fast.frequency > slow.frequency, "{} {}", fast.kind, fast.number);
        }
    }
}

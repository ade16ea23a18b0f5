//! Hinge moments of the flaps against closed forms, and flaps that weigh beside the blade.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use approx::assert_relative_eq;
use common::{paper_blade, paper_flaps, paper_model, paper_spec};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Distribution};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, FlapMass, ResponseTolerances, Rotor,
    RotorModel, RotorSolution, RotorSolver, TrailingEdgeFlap,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

const CHORD: f64 = 0.055;

/// A blade that hardly moves, in hover without pitch and without inflow.
fn stiff() -> BladeProperties {
    BladeProperties::new(BladeSpec::uniform(1e5, 1e5, 1e5, 1e5)).unwrap()
}

fn still_air(angle: HarmonicSeries) -> (Condition, LinearInflow) {
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
        controls: Controls::default(),
        flap_angles_rad: vec![HarmonicSeries::zero(1), angle],
    };
    (condition, LinearInflow::Prescribed { induced_inflow: 0.0 })
}

fn solver(model: RotorModel, blade: &BladeProperties, advance_ratio: f64) -> RotorSolver {
    let rotor = Rotor::new(model, blade, Discretisation::default()).unwrap();
    RotorSolver::new(Arc::new(rotor), advance_ratio, ResponseTolerances::default()).unwrap()
}

fn solved(model: RotorModel, angle: HarmonicSeries) -> RotorSolution {
    let (condition, inflow) = still_air(angle);
    solver(model, &stiff(), 0.0).solve(&condition, &inflow, None).unwrap()
}

/// Outboard flap with its span integrals `int x^n dx`.
fn outboard() -> (TrailingEdgeFlap, impl Fn(i32) -> f64) {
    let flap = paper_flaps()[1];
    let moment = move |n: i32| (flap.end.powi(n + 1) - flap.start.powi(n + 1)) / f64::from(n + 1);
    (flap, moment)
}

/// `I_hinge delta''` and the centrifugal moment `(I_hinge + m d X) delta`, over the span of the flap.
#[test]
fn inertial_hinge_moment_of_a_driven_flap_on_a_stiff_blade() {
    let mut angle = HarmonicSeries::zero(4);
    angle.set_harmonic(4, Harmonic { cosine: 0.01, sine: 0.02 });
    let (flap, moment) = outboard();
    for gyration_fraction in [None, Some(0.5)] {
        let model = || {
            let flaps = paper_flaps();
            let flaps = flaps.iter().map(|f| TrailingEdgeFlap { gyration_fraction, ..*f });
            RotorModel { flaps: flaps.collect(), ..paper_model(Couplings::Full) }
        };
        let flap_chord = flap.chord_fraction * CHORD;
        let (cg, d) = (flap.cg_fraction * flap_chord, 0.55 * CHORD);
        let about_hinge = match gyration_fraction {
            None => cg * cg + flap_chord * flap_chord / 12.0,
            Some(k) => (k * flap_chord).powi(2),
        };
        // n^2 I - (I + m d X), with delta'' = -n^2 delta
        let stiffness = flap.mass_fraction * (15.0 * about_hinge - d * cg) * moment(0);
        let got = solved(model(), angle.clone()).hinge[1].inertial.harmonic(4);
        assert_relative_eq!(got.cosine, stiffness * 0.01, max_relative = 2e-4);
        assert_relative_eq!(got.sine, stiffness * 0.02, max_relative = 2e-4);
        println!("{gyration_fraction:?}: {:e}", got.cosine / (stiffness * 0.01) - 1.0);
    }
}

fn forward(angles: Vec<HarmonicSeries>) -> Condition {
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 0.09 },
        controls: Controls { theta0_rad: 0.14, theta1c_rad: 0.017, theta1s_rad: -0.08 },
        flap_angles_rad: angles,
    }
}

fn with_mass(mass: FlapMass, mass_fraction: f64) -> RotorModel {
    let flaps = paper_flaps();
    let flaps = flaps.iter().map(|f| TrailingEdgeFlap { mass, mass_fraction, ..*f }).collect();
    RotorModel { flaps, ..paper_model(Couplings::Full) }
}

fn flown(model: RotorModel, blade: &BladeProperties) -> RotorSolution {
    let mut angle = HarmonicSeries::zero(4);
    angle.set_harmonic(4, Harmonic { cosine: 0.03, sine: 0.02 });
    let condition = forward(vec![HarmonicSeries::zero(1), angle]);
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.01 };
    solver(model, blade, 0.3).solve(&condition, &inflow, None).unwrap()
}

/// Mass beside the blade, uniform or tapered: the mean radial force at the root grows by `m_f int x dx` of every
/// flap.
#[test]
fn a_flap_beside_the_blade_pulls_by_its_mass() {
    let line = |root, tip| Distribution::PiecewiseLinear {
        stations: vec![0.0, 1.0],
        values: vec![root, tip],
    };
    let tapered = BladeSpec {
        mass: line(1.2, 0.8),
        thickness_gyration_radius: line(0.015, 0.012),
        chord_gyration_radius: line(0.027, 0.023),
        ..paper_spec()
    };
    for blade in [paper_spec(), tapered] {
        let blade = BladeProperties::new(blade).unwrap();
        let [inside, beside] = [FlapMass::PartOfBlade, FlapMass::AddedToBlade]
            .map(|mass| flown(with_mass(mass, 0.1), &blade).root.mean()[0]);
        let pull: f64 =
            paper_flaps().iter().map(|f| 0.1 * 0.5 * (f.end.powi(2) - f.start.powi(2))).sum();
        println!("{:e}", (beside - inside) / pull - 1.0);
        assert_relative_eq!(beside - inside, pull, max_relative = 0.01);
    }
}

/// A table of one value is the value, for a blade that flaps make heavier too.
#[test]
fn a_table_of_one_value_beside_a_flap_is_the_value() {
    let same = Distribution::PiecewiseLinear { stations: vec![0.0, 1.0], values: vec![1.0, 1.0] };
    let listed = BladeProperties::new(BladeSpec { mass: same, ..paper_spec() }).unwrap();
    let [uniform, listed] = [paper_blade(), listed]
        .map(|blade| flown(with_mass(FlapMass::AddedToBlade, 0.1), &blade).hub.harmonic(4));
    for (a, b) in uniform.iter().zip(&listed) {
        assert_relative_eq!(a, b, epsilon = 1e-12, max_relative = 1e-9);
    }
}

/// Without mass both ways are the blade alone, and the same flap counted in or out of a blade that is
/// lighter by it makes nearly the same vibration: the difference is its distance from the axis.
#[test]
fn counted_in_or_out_the_flap_is_the_same_body() {
    let size = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let gap = |a: &RotorSolution, b: &RotorSolution| {
        let (a, b) = (a.hub.harmonic(4), b.hub.harmonic(4));
        size(&std::array::from_fn::<f64, 12, _>(|i| a[i] - b[i])) / size(&a)
    };
    let blade = paper_blade();
    let none = [FlapMass::PartOfBlade, FlapMass::AddedToBlade]
        .map(|mass| flown(with_mass(mass, 0.0), &blade));
    assert!(gap(&none[0], &none[1]) <= 1e-9, "{:e}", gap(&none[0], &none[1]));

    let lighter = BladeProperties::new(BladeSpec {
        mass: Distribution::PiecewiseConstant {
            edges: vec![0.0, 0.70, 0.75, 0.80, 0.85, 1.0],
            values: vec![1.0, 0.9, 1.0, 0.9, 1.0],
        },
        ..paper_spec()
    })
    .unwrap();
    let inside = flown(with_mass(FlapMass::PartOfBlade, 0.1), &blade);
    let beside = flown(with_mass(FlapMass::AddedToBlade, 0.1), &lighter);
    let counted_wrong = flown(with_mass(FlapMass::AddedToBlade, 0.1), &blade);
    let (near, far) = (gap(&inside, &beside), gap(&inside, &counted_wrong));
    println!("counted in or out {near:e}, counted twice {far:e}");
    assert!(near < 0.05 && near > 1e-4, "{near:e}");
    assert!(far > 1.5 * near, "{far:e}");
}

#[test]
fn bad_flap_masses_are_refused_with_the_field() {
    let refuse = |change: &dyn Fn(&mut TrailingEdgeFlap), blade: &BladeProperties| {
        let mut model = with_mass(FlapMass::AddedToBlade, 0.1);
        change(&mut model.flaps[0]);
        Rotor::new(model, blade, Discretisation::default()).unwrap_err().to_string()
    };
    let blade = paper_blade();
    assert!(refuse(&|f| f.cg_fraction = 1.2, &blade).contains("trailing edge"));
    assert!(refuse(&|f| f.gyration_fraction = Some(0.1), &blade).contains("gyration_fraction"));
}

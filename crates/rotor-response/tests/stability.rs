//! Floquet exponents of the blade in flight against closed forms of the flapping blade.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

mod common;

use common::{paper_blade, paper_model};
use flap_aero::{AttachedFlowModel, FlapChord, Mach, SectionCoefficients};
use nalgebra::Complex;
use rotor_base::gauss_legendre;
use rotor_fem::{BladeProperties, BladeSpec, Joint, ModeKind, RootSupport, TorsionTerms};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, ResponseTolerances, Rotor, RotorModel,
    RotorSolver, Stability,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

fn stability(model: RotorModel, blade: &BladeProperties, modes: [usize; 3], mu: f64) -> Stability {
    let discretisation = Discretisation { modes, ..Discretisation::default() };
    let rotor = Rotor::new(model, blade, discretisation).unwrap();
    let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default()).unwrap();
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: mu, shaft_tilt_rad: 0.1 * mu },
        controls: Controls { theta0_rad: 0.14, theta1c_rad: 0.01, theta1s_rad: -0.2 * mu },
        flap_angles_rad: vec![],
    };
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.05 };
    let solution = solver.solve(&condition, &inflow, None).unwrap();
    solver.stability(&condition, &solution).unwrap()
}

/// A hinged rigid blade in hover: `b'' + (g/8) b' + (1 - g c/12) b = 0`. The last term is the lift of the
/// pitch rate `Omega b` of a flapped section at its three-quarter chord, `(g/2) (c/2) int x^2 dx b`.
#[test]
fn hovering_blade_flaps_with_a_sixteenth_of_the_lock_number() {
    let blade = BladeProperties::new(BladeSpec {
        root: RootSupport::HINGED,
        ..BladeSpec::uniform(0.0108, 0.0268, 0.00615, 1000.0)
    })
    .unwrap();
    let model = RotorModel {
        root_cutout: 0.0,
        modal_damping: 0.0,
        drag_coefficient: 0.0,
        ..paper_model(Couplings::Linear)
    };
    let result = stability(model, &blade, [1, 0, 0], 0.0);
    let motion = result.least_stable().unwrap();
    let expected = -5.2 / 16.0;
    let frequency = (1.0_f64 - 5.2 * 0.055 / 12.0 - expected * expected).sqrt();
    println!("{motion:?}, expected {expected}, {frequency}");
    assert!((motion.growth_per_rad - expected).abs() < 1e-6, "{motion:?}");
    assert!((motion.frequency_per_rev - (1.0 - frequency)).abs() < 1e-6, "{motion:?}");
    // of 0.054, 0.946 and 1.054 per rev the size of the exponent picks the true one
    assert!((motion.modal_frequency_per_rev - frequency).abs() < 1e-6, "{motion:?}");
    let damping = -expected / (1.0_f64 - 5.2 * 0.055 / 12.0).sqrt();
    assert!((motion.damping_ratio() - damping).abs() < 1e-6, "{motion:?}");
    assert!((motion.multiplier.norm().ln() / std::f64::consts::TAU - expected).abs() < 1e-6);
}

/// Exponent of a hinged rigid blade in hover with all lag states of its sections, by Newton's method on its
/// characteristic equation; with `settled` they follow their inputs at once:
///
/// ```text
/// (s^2 + 1) / 3 = (rho c / 2) int x [ x ( direct . w + sum output input . w a p / (s + a p) ) + (c / 2) s rate . w ] dx
/// w = [ -x s, c ],   a = x / (c / 2)
/// ```
fn flapping_exponent(
    section: &SectionCoefficients,
    model: &RotorModel,
    settled: bool,
) -> Complex<f64> {
    let rule = gauss_legendre(40);
    let (chord, semichord) = (model.chord, 0.5 * model.chord);
    let residual = |s: Complex<f64>| {
        let lift: Complex<f64> = rule
            .nodes
            .iter()
            .zip(&rule.weights)
            .map(|(node, weight)| {
                let x = 0.5 * (node + 1.0);
                let w = [-s * x, Complex::from(chord)];
                let along = |row: &[f64; 4]| w[0] * row[0] + w[1] * row[1];
                let lags: Complex<f64> = section
                    .lags
                    .iter()
                    .map(|lag| {
                        let pole = lag.pole * x / semichord;
                        let follows = if settled { 1.0.into() } else { pole / (s + pole) };
                        along(&lag.input) * lag.output[0] * follows
                    })
                    .sum();
                let circulating = (along(&section.direct[0]) + lags) * x;
                (circulating + along(&section.rate[0]) * s * semichord) * (0.5 * weight * x)
            })
            .sum();
        (s * s + 1.0) / 3.0 - lift * (0.5 * model.density_chord())
    };
    let mut s = Complex::new(-0.3, 0.9);
    for _ in 0..50 {
        let step = 1e-6;
        let slope = (residual(s + step) - residual(s - step)) / (2.0 * step);
        s -= residual(s) / slope;
    }
    assert!(residual(s).norm() < 1e-12);
    s
}

/// The exponents leave the lag states out: with them settled they are those of the same equation solved in
/// closed form, apparent mass included; the lags themselves raise the frequency of the flapping blade in the air and hardly change its damping.
#[test]
fn settled_lags_are_what_the_exponents_hold() {
    let blade = BladeProperties::new(BladeSpec {
        root: RootSupport::HINGED,
        ..BladeSpec::uniform(0.0108, 0.0268, 0.00615, 1000.0)
    })
    .unwrap();
    let section_model = AttachedFlowModel::Incompressible;
    let model = RotorModel {
        root_cutout: 0.0,
        modal_damping: 0.0,
        drag_coefficient: 0.0,
        section_model,
        ..paper_model(Couplings::Linear)
    };
    let chord = FlapChord::new(0.2).unwrap();
    let section = section_model.coefficients(Mach::ZERO, chord).unwrap();
    let [settled, with_lags] = [true, false].map(|s| flapping_exponent(&section, &model, s));
    let result = stability(model, &blade, [1, 0, 0], 0.0);
    let motion = result.least_stable().unwrap();
    println!("{motion:?}, settled {settled}, with lags {with_lags}");
    assert!((motion.growth_per_rad - settled.re).abs() < 1e-5, "{motion:?} {settled}");
    assert!((motion.modal_frequency_per_rev - settled.im).abs() < 1e-5, "{motion:?} {settled}");
    assert!((with_lags.re / settled.re - 1.0).abs() < 0.02, "{with_lags}");
    assert!((0.04..0.07).contains(&(with_lags.im - settled.im)), "{with_lags}");
}

/// The blade of the paper is stable in flight, its first lag motion least: little air damps it.
#[test]
fn the_paper_blade_is_stable_and_lags_longest() {
    let result = stability(paper_model(Couplings::Full), &paper_blade(), [4, 4, 2], 0.3);
    for motion in &result.motions {
        println!(
            "{} {}: {:+.4} per rad, {:.4} per rev",
            motion.kind, motion.number, motion.growth_per_rad, motion.frequency_per_rev
        );
    }
    assert!(result.is_stable());
    assert_eq!(result.motions.len(), 10);
    let least = result.least_stable().unwrap();
    assert_eq!(least.kind, ModeKind::Lag);
    let damped = result.least_damped().unwrap();
    assert!(damped.damping_ratio() > 0.004 && damped.damping_ratio() < 0.02, "{damped:?}");
    // every motion is found near its mode: frequencies of the uncoupled modes of the paper's blade
    for (kind, number, natural) in
        [(ModeKind::Lag, 1, 0.701), (ModeKind::Lag, 2, 4.30), (ModeKind::Torsion, 1, 4.59)]
    {
        let found = result.motions.iter().find(|m| (m.kind, m.number) == (kind, number)).unwrap();
        assert!((found.modal_frequency_per_rev - natural).abs() < 0.15, "{found:?}");
    }
}

/// What damps is the air and the modal damping: without both nothing is left.
#[test]
fn a_blade_in_vacuum_without_damping_neither_grows_nor_dies() {
    let model =
        RotorModel { lock_number: 0.0, modal_damping: 0.0, ..paper_model(Couplings::Linear) };
    let result = stability(model, &paper_blade(), [2, 2, 1], 0.0);
    assert!(result.motions.iter().all(|m| m.growth_per_rad.abs() < 1e-9), "{:?}", result.motions);
}

/// A spring at the flap hinge raises the frequency of a rigid blade: `nu^2 = 1 + 3 k`, in the second-order
/// equations and in those of moderate deflection alike.
#[test]
fn a_hinge_spring_stiffens_the_flapping_blade() {
    let nu = 1.125_789_21_f64;
    let spring = Joint::Spring { stiffness: (nu * nu - 1.0) / 3.0 };
    let blade = BladeProperties::new(BladeSpec {
        root: RootSupport { flap: spring, ..RootSupport::CLAMPED },
        ..BladeSpec::uniform(1e3, 1e3, 1e3, 1e6)
    })
    .unwrap();
    for couplings in
        [Couplings::Linear, Couplings::Full, Couplings::Moderate(TorsionTerms::default())]
    {
        let model = RotorModel { lock_number: 1e-9, modal_damping: 0.0, ..paper_model(couplings) };
        let motion = stability(model, &blade, [1, 0, 0], 0.0).motions[0];
        assert!((motion.frequency_per_rev - (nu - 1.0)).abs() < 1e-5, "{couplings:?} {motion:?}");
    }
}

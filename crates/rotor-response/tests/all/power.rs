//! Power of a blade over a revolution: what the air takes, the shaft gives.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "the measured balance is worth seeing")]

use crate::common;

use common::{paper_blade, paper_flaps, paper_model, paper_spec};
use flap_aero::AttachedFlowModel;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, TorsionTerms};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, PowerBalance,
    ResponseTolerances, Rotor, RotorModel, RotorSolver, SectionOffsets,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

fn balance(
    model: RotorModel,
    time_elements: usize,
    flap_angles: &[HarmonicSeries],
) -> PowerBalance {
    blade_balance((model, &paper_blade()), time_elements, flap_angles)
}

/// Forward flight at mu .3 with controls near trim.
fn blade_balance(
    (model, blade): (RotorModel, &BladeProperties),
    time_elements: usize,
    flap_angles: &[HarmonicSeries],
) -> PowerBalance {
    let discretisation = Discretisation { time_elements, ..Discretisation::default() };
    let rotor = Rotor::new(model, blade, discretisation).unwrap();
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap();
    let deg = f64::to_radians;
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: deg(5.5) },
        controls: Controls { theta0_rad: deg(8.7), theta1c_rad: deg(1.7), theta1s_rad: deg(-5.3) },
        flap_angles_rad: flap_angles.to_vec(),
    };
    let solution = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
    println!("{:?}, imbalance {:.3e}", solution.power, solution.power.imbalance());
    solution.power
}

fn moderate() -> RotorModel {
    paper_model(Couplings::Moderate(TorsionTerms::default()))
}

/// The default sections, with lags and at the local Mach number.
fn unsteady(couplings: Couplings) -> RotorModel {
    RotorModel {
        section_model: AttachedFlowModel::HariharanLeishman,
        compressibility: Compressibility::LocalMach { tip_mach: 0.58 },
        ..paper_model(couplings)
    }
}

/// Air, damping, shaft and pitch control add up to nothing, the better the finer the time elements until the
/// tolerance of the orbit is reached; without one of them they do not.
#[test]
fn power_balances_with_unsteady_sections() {
    for couplings in [Couplings::Full, Couplings::Moderate(TorsionTerms::default())] {
        let [power, twelve, sixteen] =
            [8, 12, 16].map(|elements| balance(unsteady(couplings), elements, &[]));
        let [eight, twelve, sixteen] = [power, twelve, sixteen].map(|p| p.imbalance().abs());
        assert!(eight <= 1e-5, "{couplings:?}: {eight:e}");
        assert!(twelve < 0.5 * eight && sixteen <= 1e-7, "{couplings:?}: {twelve:e} {sixteen:e}");
        let without = [
            PowerBalance { aerodynamic: 0.0, ..power },
            PowerBalance { damping: 0.0, ..power },
            PowerBalance { pitch: 0.0, ..power },
        ];
        for less in without {
            assert!(less.imbalance().abs() > 5e-5, "{couplings:?}: {less:?}");
        }
        let air = power.aerodynamic + power.damping + power.pitch;
        assert!(air.abs() > 0.9 * power.shaft, "{couplings:?}: {power:?}");
        assert!(power.aerodynamic < 0.0 && power.shaft > 0.0 && power.damping < 0.0);
    }
}

/// Moving flaps are part of the loads: their inertia too.
#[test]
fn power_balances_with_moving_flaps() {
    let model = RotorModel { flaps: paper_flaps(), ..moderate() };
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: 0.05, sine: 0.02 });
    let power = balance(model, 8, &[angle.clone(), angle]);
    assert!(power.imbalance().abs() <= 2e-5, "{power:?}");
}

/// What gravity gives on the way down it takes on the way up.
#[test]
fn weight_does_no_work_over_a_revolution() {
    let power = balance(RotorModel { gravity: 0.05, ..moderate() }, 8, &[]);
    assert!(power.imbalance().abs() <= 1e-5, "{power:?}");
}

/// Imbalance that a weak residual of 1e-11 at rates of 0.1 makes over a power of 1e-3, and as much again.
const TOLERANCE_LEAVES: f64 = 2e-9;

/// The couplings of lower order leave terms out of equations, root loads and power alike.
#[test]
fn power_balances_with_every_coupling() {
    for couplings in [Couplings::Linear, Couplings::Full] {
        let imbalance = |elements| balance(paper_model(couplings), elements, &[]).imbalance().abs();
        let [four, six, eight] = [4, 6, 8].map(imbalance);
        assert!(eight <= 1e-6, "{couplings:?}: {eight:e}");
        // what the tolerance of the orbit leaves is no less with finer elements
        let six_or_tolerance = six.max(TOLERANCE_LEAVES);
        assert!(
            four > six && six_or_tolerance > eight,
            "{couplings:?}: {four:e} {six:e} {eight:e}"
        );
    }
}

/// A coned blade ahead of the rotor centre, under its weight, with moving flaps.
#[test]
fn power_of_the_second_order_couplings_balances_whatever_the_rotor() {
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: 0.05, sine: 0.02 });
    let offsets = SectionOffsets { torque: 0.01, ..SectionOffsets::default() };
    let model =
        RotorModel { flaps: paper_flaps(), gravity: 0.01, offsets, ..paper_model(Couplings::Full) };
    let blade = BladeProperties::new(BladeSpec { precone_rad: 0.06, ..paper_spec() }).unwrap();
    let power = blade_balance((model, &blade), 8, &[angle.clone(), angle]);
    assert!(power.imbalance().abs() <= 1e-5, "{power:?}");
}

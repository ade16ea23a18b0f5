//! The circulation that a wake gets from the sections.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use approx::assert_relative_eq;
use flap_aero::{AttachedFlowModel, FlapChord, Mach};
use nalgebra::Complex;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Distribution};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, ResponseTolerances, Rotor,
    RotorModel, RotorSolver,
};
use rotor_wake::{FlightState, LinearInflow, WakeRotor};
use std::sync::Arc;

const AZIMUTHS: usize = 36;

type Complex64 = Complex<f64>;

/// Whatever the panels, they hold the whole integral of the circulation along the blade, whose flaps are deflected: values
/// at their middles miss up to a fifth of a flap. A panel between the ends of a flap has nothing of its neighbours.
#[test]
fn panels_share_out_the_whole_circulation() {
    let (mut solver, mut condition) = (common::solver(), common::condition());
    condition.flap_angles_rad = vec![HarmonicSeries { mean: 0.08, ..HarmonicSeries::zero(0) }; 2];
    let solution = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
    let ends: Vec<f64> = common::paper_flaps().iter().flat_map(|f| [f.start, f.end]).collect();
    let cutout = solver.rotor().model().root_cutout;
    let integrals = |panels: &WakeRotor| -> Vec<f64> {
        let map = solver.circulation(&solution, panels, AZIMUTHS).unwrap();
        let widths = panels.widths();
        let sum = |i: usize| map.row(i).iter().zip(&widths).map(|(g, w)| g * w).sum();
        (0..AZIMUTHS).map(sum).collect()
    };
    let fine = integrals(&WakeRotor::uniform(4, cutout, 60).unwrap());
    for panels in [6, 20, 33] {
        let uniform = WakeRotor::uniform(4, cutout, panels).unwrap();
        let through = WakeRotor::through(4, cutout, panels, &ends).unwrap();
        for panels in [uniform, WakeRotor::cosine(4, cutout, panels).unwrap(), through] {
            for (found, expected) in integrals(&panels).iter().zip(&fine) {
                assert_relative_eq!(found, expected, max_relative = 1e-12);
            }
        }
    }
}

/// A flap that oscillates on a stiff blade in hover: the circulation of its panel is that of the lags that shed vorticity,
/// by the frequency response of the section; pressure waves, a tenth of it, have none.
#[test]
fn pressure_waves_of_a_flap_have_no_circulation() {
    const HARMONIC: usize = 8;
    const AMPLITUDE_RAD: f64 = 0.02;
    const TIP_MACH: f64 = 0.3;
    let stiff = Distribution::Uniform(1e3);
    let spec = BladeSpec {
        flap_stiffness: stiff.clone(),
        lag_stiffness: stiff.clone(),
        torsion_stiffness: stiff,
        ..BladeSpec::table_1()
    };
    let model = RotorModel {
        couplings: Couplings::Linear,
        compressibility: Compressibility::LocalMach { tip_mach: TIP_MACH },
        ..RotorModel::paper_case()
    };
    let (chord, flap) = (model.chord, model.flaps[0]);
    let blade = BladeProperties::new(spec).unwrap();
    let rotor = Arc::new(Rotor::new(model, &blade, Discretisation::default()).unwrap());
    let mut solver = RotorSolver::new(rotor, 0.0, ResponseTolerances::default()).unwrap();
    let panels = WakeRotor::new(4, vec![0.2, flap.start, flap.end, 1.0]).unwrap();
    let mut of = |amplitude_rad: f64| {
        let mut motion = HarmonicSeries::zero(HARMONIC);
        motion.set_harmonic(HARMONIC, Harmonic { cosine: amplitude_rad, sine: 0.0 });
        let condition = Condition {
            bank_rad: 0.0,
            flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
            controls: Controls { theta0_rad: 0.1, theta1c_rad: 0.0, theta1s_rad: 0.0 },
            flap_angles_rad: vec![motion, HarmonicSeries::zero(0)],
        };
        let inflow = LinearInflow::Prescribed { induced_inflow: 0.04 };
        let solution = solver.solve(&condition, &inflow, None).unwrap();
        let map = solver.circulation(&solution, &panels, AZIMUTHS).unwrap();
        let at = |i: usize| (i as f64 * std::f64::consts::TAU / AZIMUTHS as f64, map.row(i)[1]);
        let parts = (0..AZIMUTHS).map(at).map(|(psi, gamma)| {
            Complex64::from_polar(2.0 / AZIMUTHS as f64, -(HARMONIC as f64) * psi) * gamma
        });
        parts.sum::<Complex64>()
    };
    let found = (of(AMPLITUDE_RAD) - of(-AMPLITUDE_RAD)) / 2.0;
    // the section at the middle of the flap
    let r = 0.5 * (flap.start + flap.end);
    let k = HARMONIC as f64 * 0.5 * chord / r;
    let mach = Mach::new(TIP_MACH * r).unwrap();
    let hinge = FlapChord::new(flap.chord_fraction).unwrap();
    let section = AttachedFlowModel::HariharanLeishman.coefficients(mach, hinge).unwrap();
    let input = [
        Complex64::new(0.0, 0.0),
        Complex64::new(0.0, 0.0),
        Complex64::new(1.0, 0.0),
        Complex64::new(0.0, 2.0 * k),
    ];
    let drive = |weights: [f64; 4]| -> Complex64 {
        weights.iter().zip(input).map(|(w, input)| input * *w).sum()
    };
    let (mut circulatory, mut waves) = (Complex64::new(0.0, 0.0), drive(section.direct[0]));
    for lag in &section.lags {
        let share = drive(lag.input) / Complex64::new(1.0, k / lag.pole) * lag.output[0];
        *(if lag.is_circulatory { &mut circulatory } else { &mut waves }) += share;
    }
    let scale = 0.5 * chord * r * AMPLITUDE_RAD;
    let off = (found - scale * circulatory).norm() / (scale * circulatory).norm();
    println!("circulation off by {off:.1e}, waves {:.2}", waves.norm() / circulatory.norm());
    assert!(off < 0.02, "{off}");
    assert!(waves.norm() > 0.08 * circulatory.norm());
}

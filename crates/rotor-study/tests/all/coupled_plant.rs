//! The plant whose flaps give way to their hinge moments, against closed forms.
#![expect(clippy::unwrap_used, reason = "a helper whose rotor is missing cannot go on")]

use approx::{assert_abs_diff_eq, assert_relative_eq};
use flap_aero::{AttachedFlowModel, FlapChord, Mach};
use hhc_control::Plant;
use preisach_dyn::{ActuatorModel, LinkageStage, LoadStiffness, VoltageRange};
use rotor_case::{Bias, Case, CompressibilityChoice, InflowChoice, PrescribedTrim, TrimValues};
use rotor_study::{COUPLING_TOLERANCE_DEG, FlapDrive, FullScale, RotorPlant, TrimmedRotor};
use std::sync::Arc;

/// A linear actuator of 0.1 deg/V whose linkage gives way by `compliance_um_per_newton`.
fn soft(compliance_um_per_newton: f64) -> FlapDrive {
    let range = VoltageRange::new(-20.0, 150.0).unwrap();
    let mut model = ActuatorModel::linear(range, 8.5, 0.04);
    let load = LoadStiffness { stiffness_ratio: 0.0, compliance_um_per_newton };
    model.linkage.push(LinkageStage::LoadStiffness(load));
    let bias = Bias::Centred { guess_volt: 65.0 };
    FlapDrive::Model { model: Arc::new(model), range_volt: range, rev_hz: 5.0, bias }
}

/// Hover without pitch and inflow, blades that hardly move, quasi-steady sections.
fn stiff_rotor() -> TrimmedRotor {
    let mut case = Case { advance_ratio: 0.0, ..Case::default() };
    let rotor = &mut case.rotor;
    (rotor.ei_flap, rotor.ei_lag, rotor.gj, rotor.ea) = (1e5, 1e5, 1e5, 1e5);
    rotor.twist_deg = 0.0;
    case.aerodynamics.model = AttachedFlowModel::QuasiSteady;
    case.aerodynamics.compressibility = CompressibilityChoice::None;
    case.inflow.model = InflowChoice::Prescribed { lambda_i: 0.0 };
    case.trim = TrimValues::Prescribed(PrescribedTrim {
        theta0_deg: 0.0,
        theta1c_deg: 0.0,
        theta1s_deg: 0.0,
        shaft_tilt_deg: 0.0,
    });
    TrimmedRotor::new(&case, None).unwrap()
}

/// The whole plant: linear actuator, hinge moment of air and inertia in closed form.
///
/// ```text
/// H = (1/2) rho c^2 ( C_h,delta delta int x^2 dx + C_h,delta' c delta' int x dx )
///     + I n^2 delta L - (I + m d X) delta L        delta' = i n delta
/// ```
#[test]
fn the_plant_settles_on_the_closed_form_of_a_stiff_rotor() {
    let rotor = stiff_rotor();
    let model = rotor.rotor().model().clone();
    let scale = FullScale {
        amplitude_volt: 85.0,
        stroke_deg: 8.5,
        reach_volt: 85.0,
        motion_deg: [8.5, 0.0],
    };
    let volts = [0.0, 0.0, 0.0, 40.0];
    let plant =
        |compliance| RotorPlant::new(rotor.clone(), soft(compliance), &[4], &[scale]).unwrap();
    let free = plant(0.0).state(&volts).unwrap();
    assert!(free.coupling.is_none());
    let (drive, flap) = (soft(0.2), model.flaps[1]);
    let coupled = plant(0.2).state(&volts).unwrap();
    let residual = coupled.coupling.unwrap();
    println!("{} responses, {:e} deg", residual.iterations, residual.residual_deg);

    let section =
        AttachedFlowModel::QuasiSteady.of_flap(FlapChord::new(flap.chord_fraction).unwrap());
    let direct = section.unwrap().coefficients(Mach::new(0.0).unwrap()).unwrap().direct[2];
    let span = |n: i32| (flap.end.powi(n + 1) - flap.start.powi(n + 1)) / f64::from(n + 1);
    let (c, n) = (model.chord, 4.0);
    let pressure = 0.5 * model.density_chord() * c;
    let cf = flap.chord_fraction * c;
    let (x, d) = (flap.cg_fraction * cf, (0.75 - flap.chord_fraction) * c);
    let inertia = flap.mass_fraction * (x * x + cf * cf / 12.0);
    let mass = flap.mass_fraction;
    let real =
        pressure * direct[2] * span(2) + (n * n * inertia - inertia - mass * d * x) * span(0);
    let imaginary = pressure * direct[3] * c * n * span(1);
    // 383 rpm, 4.94 m, 6.46 kg/m
    let omega = 383.0 * std::f64::consts::TAU / 60.0;
    let unit = 6.46 * omega * omega * 4.94_f64.powi(3);
    let give = drive.compliance_deg_per_newton_metre().to_radians() * unit;
    let (re, im) = (1.0 - give * real, -give * imaginary);
    let size = re * re + im * im;
    let (got, before) = (coupled.flaps[1].flap_deg.harmonic(4), free.flaps[1].flap_deg.harmonic(4));
    assert_relative_eq!(before.sine, 4.0, max_relative = 1e-9);
    println!("{got:?}, closed {} {}", -4.0 * im / size, 4.0 * re / size);
    assert_relative_eq!(got.sine, 4.0 * re / size, max_relative = 1e-3);
    assert_abs_diff_eq!(got.cosine, -4.0 * im / size, epsilon = 4e-3);
    // taken out, the bound does not hold
    assert!((got.amplitude() / before.amplitude() - 1.0).abs() > 0.2);
    // and what the rotor answers is what the flap was moved by
    let hinge = coupled.rotor.hinge[1].total().harmonic(4);
    let turned = give.to_degrees() * hinge.amplitude();
    let gap = (got.cosine - before.cosine).hypot(got.sine - before.sine);
    assert_relative_eq!(turned, gap, max_relative = 1e-5);
}

/// In forward flight too, and from the voltages alone: the same bits whatever was asked before.
#[test]
fn the_coupled_answer_depends_on_the_voltages_alone() {
    let rotor = TrimmedRotor::new(&Case::default(), None).unwrap();
    let scale = FullScale {
        amplitude_volt: 85.0,
        stroke_deg: 8.5,
        reach_volt: 85.0,
        motion_deg: [8.5, 0.0],
    };
    let plant =
        |compliance| RotorPlant::new(rotor.clone(), soft(compliance), &[3], &[scale]).unwrap();
    let (first, second) = ([20.0, -10.0, 5.0, 30.0], [-15.0, 10.0, 25.0, 0.0]);
    let mut one = plant(0.9);
    let alone = one.measure(&second).unwrap();
    let mut other = plant(0.9);
    other.measure(&first).unwrap();
    let strokes_deg = other.strokes_deg(&second).unwrap();
    assert_eq!(other.measure(&second).unwrap(), alone);
    let state = one.state(&second).unwrap();
    let residual = state.coupling.unwrap();
    println!("forward flight: {} responses, {:e} deg", residual.iterations, residual.residual_deg);
    assert!(residual.residual_deg <= COUPLING_TOLERANCE_DEG && residual.iterations <= 6);
    // the stroke comes from the linear answer of the rotor
    let predicted = other.flap_motion(&second).unwrap();
    for (flap, motion) in predicted.iter().zip(&alone.flap_motion_deg) {
        let got = flap.flap_deg.harmonic(3);
        let gap = (got.cosine - motion.cosine).hypot(got.sine - motion.sine) / motion.amplitude();
        println!("linear answer: {gap:e}");
        assert!(gap < 0.01);
    }
    assert!(strokes_deg[0] >= predicted[0].flap_deg.harmonic(3).amplitude());
    // the free actuator answers otherwise
    let free = plant(0.0).measure(&second).unwrap();
    assert!(free.flap_motion_deg[0].amplitude() > 1.1 * alone.flap_motion_deg[0].amplitude());
}

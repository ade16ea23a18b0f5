//! A bias that the amplifier holds: the mean flap angle is what actuator and hinge moment leave.
#![expect(clippy::unwrap_used, reason = "a helper whose actuator is missing cannot go on")]

use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Envelope, LinkageStage, LoadStiffness, PrandtlIshlinskii,
    PrandtlParameters, VoltageRange, WeightedPlay,
};
use rotor_case::{Bias, BiasChoice, Case, ControlActuator};
use rotor_study::{Drives, control_set};
use rotor_study::{FlapDrive, FullScale, RotorPlant, TrimmedRotor};
use std::sync::Arc;

/// Plays behind a bent curve, on a linkage that gives way by a compliance.
fn actuator(compliance_um_per_newton: f64) -> ActuatorModel {
    let range_volt = VoltageRange::new(-20.0, 150.0).unwrap();
    let play = |threshold_volt| WeightedPlay { threshold_volt, weight_deg_per_volt: 0.01 };
    let law = PrandtlIshlinskii::new(PrandtlParameters {
        range_volt,
        gain_deg_per_volt: 0.07,
        plays: [5.0, 15.0].map(play).to_vec(),
        threshold_growth_s: 0.0,
        envelope: Envelope { quadratic: 0.05, ..Envelope::default() },
    });
    let law = ActuatorLaw::PrandtlIshlinskii(law.unwrap());
    let mut model = ActuatorModel { law, ..ActuatorModel::linear(range_volt, 8.5, 0.04) };
    if compliance_um_per_newton > 0.0 {
        let stage = LoadStiffness { stiffness_ratio: 0.0, compliance_um_per_newton };
        model.linkage.push(LinkageStage::LoadStiffness(stage));
    }
    model
}

/// The loop on a bias that is held: the voltage keeps it to the bit, and the mean angle is there; centred it vanishes.
#[test]
fn a_held_bias_stays_and_the_mean_angle_comes_out() {
    let mut case = Case::default();
    case.control.harmonics = vec![vec![3]];
    case.control.actuators = vec![ControlActuator::Ideal, ControlActuator::Hysteretic];
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let mut ends = Vec::new();
    for bias in [BiasChoice::Centred, BiasChoice::Fixed(60.0)] {
        case.control.bias = bias;
        case.control.amplitude_volt = 80.0;
        case.check().unwrap();
        let drives = Drives::new(&case, Some(Arc::new(actuator(0.0)))).unwrap();
        let studies = control_set(&case, &rotor, &drives, &[3], &|| ()).unwrap();
        let [ideal, own] = &studies[..] else { panic!("{}", studies.len()) };
        // what the inverse, which sets the bias, would make of the ideal motion is no question where the bias is held
        assert_eq!(ideal.reach_share.is_some(), bias == BiasChoice::Centred);
        assert!(own.j_after < 0.6 * own.j_before, "{} {}", own.j_after, own.j_before);
        for flap in &own.state.flaps {
            let (volt, mean_deg) = (flap.voltage_volt.mean, flap.flap_deg.mean);
            println!("{bias:?}: {volt} V, {mean_deg} deg");
            if bias == BiasChoice::Centred {
                assert!(mean_deg.abs() < 1e-5 && (volt - 60.0).abs() > 0.5, "{volt} {mean_deg}");
            } else {
                assert_eq!(volt.to_bits(), 60.0_f64.to_bits());
                assert!(mean_deg.abs() > 0.1, "{mean_deg}");
            }
        }
        ends.push(own.state.rotor.hub.mean()[2]);
    }
    // the mean angle lifts
    assert!((ends[1] - ends[0]).abs() > 1e-4 * ends[0].abs(), "{ends:?}");
}

/// A soft linkage and a held bias: the mean angle of the free actuator and the give to the steady hinge moment.
#[test]
fn a_steady_hinge_moment_turns_the_mean_of_a_held_bias() {
    let rotor = TrimmedRotor::new(&Case::default(), None).unwrap();
    let scale = FullScale {
        amplitude_volt: 80.0,
        stroke_deg: 8.0,
        reach_volt: 80.0,
        motion_deg: [8.0, 0.0],
    };
    let model = Arc::new(actuator(0.3));
    let range_volt = model.range_volt;
    let drive =
        |bias| FlapDrive::Model { model: Arc::clone(&model), range_volt, rev_hz: 5.0, bias };
    let volts = [20.0, -10.0, 5.0, 30.0];
    let held = drive(Bias::Fixed { volt: 65.0 });
    let give = held.compliance_deg_per_newton_metre();
    let plant = RotorPlant::new(rotor.clone(), held.clone(), &[3], &[scale]).unwrap();
    let state = plant.state(&volts).unwrap();
    println!("{:?}", state.coupling);
    let unit = rotor.scales().moment_newton_metre();
    for (k, flap) in state.flaps.iter().enumerate() {
        let voltages = [(3, rotor_base::Harmonic { cosine: volts[2 * k], sine: volts[2 * k + 1] })];
        let free = held.motion(&voltages).unwrap().flap_deg.mean;
        let turned = give * unit * state.rotor.hinge[k].total().mean;
        let found = flap.flap_deg.mean;
        assert!((found - free - turned).abs() < 1e-6, "{found} {free} {turned}");
        assert!(turned.abs() > 1e-3, "{turned}");
        assert_eq!(flap.voltage_volt.mean.to_bits(), 65.0_f64.to_bits());
        // the linear answer of the rotor knows the mean as well
        let predicted = plant.flap_motion(&volts).unwrap()[k].flap_deg.mean;
        assert!((predicted - found).abs() < 0.02 * turned.abs(), "{predicted} {found} {turned}");
    }
    let centred = drive(Bias::Centred { guess_volt: 65.0 });
    let plant = RotorPlant::new(rotor, centred, &[3], &[scale]).unwrap();
    for flap in plant.state(&volts).unwrap().flaps {
        assert!(flap.flap_deg.mean.abs() < 1e-5, "{}", flap.flap_deg.mean);
    }
}

/// What makes no sense beside a held bias is refused in words.
#[test]
fn rules_of_a_held_bias() {
    let refused = |change: &dyn Fn(&mut Case)| {
        let mut case = Case::default();
        case.control.bias = BiasChoice::Fixed(65.0);
        case.check().unwrap();
        change(&mut case);
        case.check().unwrap_err().0.iter().map(|f| format!("{}: {}", f.field, f.fault)).collect()
    };
    let told: Vec<String> = refused(&|case| case.control.bias_volt = 50.0);
    assert!(
        told[0].starts_with("control.bias_V: 50 V is of no use beside bias: Fixed(65)"),
        "{told:?}"
    );
    let told: Vec<String> =
        refused(&|case| case.control.actuators = vec![ControlActuator::Inverse]);
    assert!(
        told[0].starts_with("control.actuators[0]: Inverse gives the whole voltage"),
        "{told:?}"
    );
    let told: Vec<String> = refused(&|case| case.control.bias = BiasChoice::Fixed(50.0));
    assert!(
        told[0].contains("the voltage 50 V +- 85 V leaves")
            && told[0].contains("move control.bias"),
        "{told:?}"
    );
    let told: Vec<String> = refused(&|case| case.control.bias = BiasChoice::Fixed(f64::NAN));
    assert!(!told.is_empty());
}

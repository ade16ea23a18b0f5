//! The paper's own lesson, discovered: hub loads made with hysteretic flaps, the simulation with ideal ones.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::page::check_page;
use measured_data::{PointData, Scatter, Source};
use model_gap::SplitMix;
use model_gap::discovery::{Confidence, Verdict};
use preisach_dyn::{ActuatorModel, VoltageRange};
use rotor_base::{Harmonic, mean_square};
use rotor_case::{ActuatorChoice, Case, ModeNumbers, TrimValues, WindTunnelTrim};
use rotor_gap::{RotorDiagnosis, RotorModel, RotorQuestion, Sweep, diagnose, predict};
use rotor_study::FlapDrive;
use sim_driver::actuator::case_actuators;
use sim_driver::case::{PAPER_CASE, shipped_case};
use sim_driver::diagnose::{PAGE_FILE, PointDiagnosis};
use std::fmt::Write;
use std::sync::Arc;

/// Amplitudes of the voltage at each condition, V: off, and steps at one harmonic.
const STEPS_VOLT: [f64; 5] = [0.0, 15.0, 30.0, 45.0, 60.0];
const MIDDLE_VOLT: f64 = 45.0;
const ADVANCE_RATIOS: [f64; 3] = [0.2, 0.25, 0.3];

fn small_rotor() -> Case {
    let trim = TrimValues::WindTunnel(WindTunnelTrim::default());
    let mut case = Case { trim, ..Case::default() };
    case.actuator.model = ActuatorChoice::Ideal;
    case.structure.elements = 5;
    case.structure.modes = ModeNumbers { flap: 3, lag: 3, torsion: 2 };
    case.response.time_elements = 6;
    case
}

/// Control off and on at a few speeds; the hub loads of 4/rev are yet to be read.
fn control_off_and_on(case: &Case) -> Sweep {
    let mut text =
        String::from("advance_ratio,flap1_n3_cos_V,flap1_n3_sin_V,flap2_n3_cos_V,flap2_n3_sin_V");
    for load in ["fx_n4_cos_N", "fx_n4_sin_N", "fz_n4_cos_N", "fz_n4_sin_N"] {
        write!(text, ",{load},{}", load.replace('f', "m").replace("_N", "_Nm")).unwrap();
    }
    for (k, mu) in ADVANCE_RATIOS.into_iter().enumerate() {
        for amplitude in STEPS_VOLT {
            let (sin, cos) = (2.1 * k as f64).sin_cos();
            let (s, c) = (amplitude * sin, amplitude * cos);
            write!(text, "\n{mu},{c},{s},{s},{c}{}", ",0".repeat(8)).unwrap();
        }
    }
    text.push('\n');
    let data = PointData::read(&Source { name: "made".into(), text }).unwrap();
    Sweep::of(&data, case).unwrap()
}

/// What is found in readings of a rotor with some actuator, at a noise of a part of each load, by a simulation with ideal ones.
fn found(
    truth: Option<&Arc<ActuatorModel>>,
    hysteretic: &Arc<ActuatorModel>,
    noise: f64,
) -> RotorDiagnosis {
    let case = small_rotor();
    let mut sweep = control_off_and_on(&case);
    let truth = predict(&RotorModel::of(case.clone()), &sweep, truth.cloned(), None).unwrap();
    let mut random = SplitMix(7);
    for (c, channel) in sweep.channels.iter_mut().enumerate() {
        let values: Vec<f64> = truth.iter().map(|row| row[c]).collect();
        let deviation = noise * mean_square(&values).sqrt();
        channel.values = values.iter().map(|v| Some(v + deviation * random.normal())).collect();
        channel.scatter = Scatter::Stated(vec![deviation; values.len()]);
    }
    let question = RotorQuestion {
        case: &case,
        actuator: None,
        hysteretic: Some(Arc::clone(hysteretic)),
        uncertain: &rotor_gap::usual_uncertain(),
        sweep: &sweep,
        only: &[],
        begun: &|_, _| {},
    };
    diagnose(&question).unwrap()
}

/// Lag of the actuator itself at the middle amplitude, deg.
fn lag_deg(actuator: &Arc<ActuatorModel>) -> f64 {
    let case = small_rotor();
    let (low, high) = case.actuator.range_volt;
    let drive = FlapDrive::Model {
        model: Arc::clone(actuator),
        range_volt: VoltageRange::new(low, high).unwrap(),
        rev_hz: case.actuator.bench_rev_hz,
        bias: case.control.drive_bias(),
    };
    let middle = Harmonic { cosine: MIDDLE_VOLT, sine: 0.0 };
    let moved = drive.motion(&[(3, middle)]).unwrap().flap_deg.harmonic(3);
    moved.sine.atan2(moved.cosine).to_degrees()
}

#[test]
fn hysteresis_that_the_simulation_ignores_is_named_from_hub_loads() {
    let actuators = case_actuators(&shipped_case(PAPER_CASE).unwrap()).unwrap();
    let actuator = Arc::new(actuators.real.unwrap());
    let lag_deg = lag_deg(&actuator);
    // 30 dB
    let own = found(Some(&actuator), &actuator, 0.0316);
    let finding = &own.found.finding;
    assert_eq!(finding.verdict, Verdict::Named, "{:?}", finding.reasons);
    assert_eq!(finding.confidence, Confidence::Confident, "{:?}", finding.reasons);
    let ids: Vec<&str> =
        finding.causes.iter().map(|named| own.causes[named.candidate].id).collect();
    assert_eq!(ids, ["actuator-hysteresis"], "{:?}", finding.reasons);
    let named = &finding.causes[0].parameters[0];
    assert_eq!(named.name, "lag_deg");
    assert!((named.value - lag_deg).abs() < 5.0, "{named:?}, {lag_deg}");
    // the paper's lesson: to ignore it costs vibration, feedback wins most of it back
    let [ideal, ignored, fed_back] = own.won_back[0].reduction_percent;
    assert!(ignored < fed_back - 30.0, "{:?}", own.won_back);
    assert!((fed_back - ideal).abs() < 1.0, "{:?}", own.won_back);
    let notes = own.notes(&[], "the test");
    let RotorDiagnosis { table, found: points, .. } = own;
    let own = PointDiagnosis {
        title: "hub loads".into(),
        data_kind: "RotorSweep",
        table,
        found: points,
        besides: vec![],
        notes,
    };
    let page = own.files().unwrap().into_iter().find(|own| own.0 == PAGE_FILE).unwrap().1;
    check_page(&page, &["compared", "residuals", "fingerprints", "parameters", "floors", "costs"]);
    assert!(page.contains("actuator-hysteresis: lag_deg, deg: "), "its parameter");
    // one plane a load and harmonic
    for plane in ["fx_n4_N", "fz_n4_N", "mx_n4_Nm", "mz_n4_Nm"] {
        assert!(page.contains(&format!("<strong>{plane}</strong>")), "{plane}");
    }
    let nothing = found(None, &actuator, 0.01);
    let finding = &nothing.found.finding;
    assert_eq!(finding.verdict, Verdict::NothingMissing, "{:?}", finding.reasons);
}

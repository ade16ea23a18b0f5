//! Sweeps of a small rotor with something planted; the truth has another inflow, other section lags and another mode.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use measured_data::{PointData, Scatter, Source};
use model_gap::SplitMix;
use model_gap::discovery::Verdict;
use rotor_base::mean_square;
use rotor_case::{
    ActuatorChoice, AttachedFlowModel, Case, CompressibilityChoice, DissimilarBlade, FlapValues,
    FreeWakeValues, InflowChoice, ModeNumbers, RotorValues, TrimValues, UncertainField,
    WindTunnelTrim,
};
use rotor_gap::{RotorDiagnosis, RotorModel, RotorQuestion, Sweep, diagnose, predict};
use std::fmt::Write;

/// A rotor of few modes in a wind tunnel, as it is simulated.
fn simulated() -> Case {
    let mut case =
        Case { trim: TrimValues::WindTunnel(WindTunnelTrim::default()), ..Case::default() };
    case.actuator.model = ActuatorChoice::Ideal;
    case.structure.elements = 5;
    case.structure.modes = ModeNumbers { flap: 2, lag: 1, torsion: 1 };
    case.aerodynamics.model = AttachedFlowModel::Calibrated;
    case.response.time_elements = 6;
    case
}

/// The rotor that is measured, but for what is planted.
fn flown() -> RotorModel {
    let mut case = simulated();
    case.inflow.model = InflowChoice::PittPeters;
    case.aerodynamics.model = AttachedFlowModel::HariharanLeishman;
    case.structure.modes.flap = 3;
    RotorModel::of(case)
}

/// Eight points, with or without driven flaps, and what is read there.
fn points(is_driven: bool) -> Sweep {
    let mut header = String::from("advance_ratio,ct_sigma,shaft_tilt_deg,theta0_deg,power_W");
    for (load, unit) in
        [("fx", "N"), ("fy", "N"), ("fz", "N"), ("mx", "Nm"), ("my", "Nm"), ("mz", "Nm")]
    {
        write!(header, ",{load}_n4_cos_{unit},{load}_n4_sin_{unit}").unwrap();
    }
    header += ",fx_n1_cos_N,fx_n1_sin_N,fx_n2_cos_N,fx_n2_sin_N";
    if is_driven {
        header += ",flap1_n3_cos_V,flap1_n3_sin_V";
    }
    let mut text = header + "\n";
    for p in 0..8_u32 {
        let mu = 0.12 + 0.05 * f64::from(p % 4);
        write!(text, "{mu},{},{}", 0.06 + 0.02 * f64::from(p / 4), 2.0 + 10.0 * mu).unwrap();
        text += &",0".repeat(18);
        if is_driven {
            // steps of amplitude at one harmonic, and of phase
            let (size, phase) = (10.0 * f64::from(p % 4 + 1), 1.3 * f64::from(p));
            write!(text, ",{},{}", size * phase.cos(), size * phase.sin()).unwrap();
        }
        text.push('\n');
    }
    let data = PointData::read(&Source { name: "made".into(), text }).unwrap();
    Sweep::of(&data, &simulated()).unwrap()
}

/// The sweep as a rotor gives it, with noise of a part of each group of channels.
fn measured(truth: &RotorModel, mut sweep: Sweep, noise: f64, seed: u64) -> Sweep {
    let grid = predict(truth, &sweep, None, None).unwrap();
    let mut random = SplitMix(seed);
    let rms = |from: usize, to: usize| {
        let values: Vec<f64> = grid.iter().flat_map(|row| row[from..to].iter().copied()).collect();
        mean_square(&values).sqrt()
    };
    let (forces, moments, power) = (rms(2, 8), rms(8, 14), rms(1, 2));
    for (c, channel) in sweep.channels.iter_mut().enumerate() {
        let deviation = noise
            * match c {
                0 => 1.0,
                1 => power,
                8..14 => moments,
                _ => forces,
            };
        channel.values =
            grid.iter().map(|row| Some(row[c] + deviation * random.normal())).collect();
        channel.scatter = Scatter::Stated(vec![deviation; grid.len()]);
    }
    sweep
}

fn found(sweep: &Sweep) -> RotorDiagnosis {
    let case = simulated();
    let known = |field: &str, percent| UncertainField {
        field: field.into(),
        sd_percent: Some(percent),
        sd: None,
    };
    let uncertain =
        [known("rotor.gj", 2.0), known("rotor.ei_flap", 1.0), known("rotor.lock_number", 1.0)];
    let question = RotorQuestion {
        case: &case,
        actuator: None,
        hysteretic: None,
        uncertain: &uncertain,
        sweep,
        only: &[],
        begun: &|_, _| {},
    };
    diagnose(&question).unwrap()
}

/// The names of what was found, each with those that may be it instead, in alphabetical order.
fn names(found: &RotorDiagnosis) -> Vec<&'static str> {
    let mut all = Vec::new();
    for own in &found.found.finding.causes {
        all.push(found.causes[own.candidate].id);
        all.extend(own.alternatives.iter().map(|other| found.causes[other.candidate].id));
    }
    all.sort_unstable();
    all.dedup();
    all
}

fn value(found: &RotorDiagnosis) -> f64 {
    found.found.finding.causes[0].parameters[0].value
}

#[test]
fn a_rotor_of_another_fidelity_lacks_nothing() {
    for (seed, is_driven) in [(1, false), (2, true)] {
        let found = found(&measured(&flown(), points(is_driven), 0.02, seed));
        assert!(names(&found).is_empty(), "{:?}", names(&found));
        assert_eq!(
            found.found.finding.verdict,
            Verdict::NothingMissing,
            "{:?}",
            found.found.finding.reasons
        );
    }
}

#[test]
fn what_was_planted_is_named() {
    let mut turned = flown();
    turned.path.azimuth_deg = 8.0;
    let mut reversed = flown();
    reversed.path.gains.insert("my_n4_Nm".into(), -1.0);
    let mut heavy = flown();
    heavy.case.rotor.dissimilar_blades =
        vec![DissimilarBlade { blade: 3, mass: 1.02, ..DissimilarBlade::default() }];
    let mut weak = flown();
    weak.case.flaps.iter_mut().for_each(|flap| flap.effectiveness.lift = 0.7);
    for (what, truth, is_driven, expected, planted) in [
        ("azimuth", turned, false, vec!["azimuth-offset", "channel-delay"], 8.0),
        ("sign", reversed, false, vec!["sensor-gain"], -1.0),
        ("blade", heavy, false, vec!["blade-dissimilarity"], 1.02),
        ("flaps", weak, true, vec!["flap-effectiveness", "actuator-gain"], 0.7),
    ] {
        let found = found(&measured(&truth, points(is_driven), 0.01, 5));
        let reasons = &found.found.finding.reasons;
        let names = names(&found);
        assert!(
            !names.is_empty() && names.iter().all(|own| expected.contains(own)),
            "{what}: {names:?} {reasons:?}"
        );
        if found.causes[found.found.finding.causes[0].candidate].id == expected[0] {
            let own = &found.found.finding.causes[0].parameters[0];
            let [low, high] = own.ci95;
            let near = (own.value - planted).abs() < 0.25 * planted.abs();
            assert!(near || (low..=high).contains(&planted), "{what}: {own:?}");
        }
    }
}

/// The case that was extended is the one that was flown: what its diagnosis names is in it.
#[test]
fn the_extended_case_holds_what_was_found() {
    let mut truth = flown();
    truth.case.rotor.ei_flap *= 1.5;
    let found = found(&measured(&truth, points(false), 0.005, 9));
    assert_eq!(names(&found), ["stiffness-flap"], "{:?}", found.found.finding.reasons);
    assert_eq!(found.found.finding.verdict, Verdict::Named);
    let extended = found.extended.clone().unwrap();
    assert!((extended.rotor.ei_flap / simulated().rotor.ei_flap - value(&found)).abs() < 1e-9);
    assert!((value(&found) - 1.5).abs() < 0.12, "{}", value(&found));
    let rotor = RotorValues { ei_flap: simulated().rotor.ei_flap, ..extended.rotor.clone() };
    assert_eq!(Case { rotor, ..extended }, simulated());
}

#[test]
fn columns_that_mean_nothing_and_points_that_no_trim_reaches_are_told() {
    let case = simulated();
    let of = |text: &str| {
        let data = PointData::read(&Source { name: "a.csv".into(), text: text.into() }).unwrap();
        Sweep::of(&data, &case)
    };
    let refused = |text: &str| of(text).unwrap_err().to_string();
    assert!(refused("advance_ratio,fz_n4_cos_kN\n0.1,3\n").contains("`fz_n4_cos_kN`"));
    assert!(refused("fz_n4_cos_N\n3\n").contains("advance_ratio"));
    assert!(refused("advance_ratio,ct_sigma\n0.1,0.07\n").contains("no column was read"));
    assert!(refused("advance_ratio,flap3_n4_cos_V,fz_n4_cos_N\n0.1,3,3\n").contains("2 flaps"));
    assert!(refused("advance_ratio,fz_n4_cos_N\n,3\n0.1,3\n").contains("blank"));
    let propulsive = Case { trim: TrimValues::default(), ..case.clone() };
    let text = "advance_ratio,shaft_tilt_deg,fz_n4_cos_N\n0.1,5,3\n";
    let data = PointData::read(&Source { name: "a.csv".into(), text: text.into() }).unwrap();
    assert!(Sweep::of(&data, &propulsive).unwrap_err().to_string().contains("WindTunnel"));
    // no blade lifts that much: the point is set aside
    let mut sweep = measured(&flown(), points(false), 0.02, 3);
    sweep.points[4].ct_sigma = Some(5.0);
    let found = found(&sweep);
    assert_eq!((found.aside.len(), found.aside[0].point.as_str()), (1, "5"));
    assert_eq!(found.table.points.len(), 7);
}

/// What a diverged wake leaves is no rotor in flight: nothing is read of it. One update already shows it: more would be chaos, other on
/// every machine.
#[test]
fn a_wake_that_diverges_is_not_flown() {
    let mut case = simulated();
    case.advance_ratio = 0.03;
    case.structure.elements = 4;
    case.flaps.truncate(1);
    case.flaps[0] = FlapValues { start_r: 0.7, end_r: 0.8, ..case.flaps[0].clone() };
    case.aerodynamics.model = AttachedFlowModel::QuasiSteady;
    case.aerodynamics.compressibility = CompressibilityChoice::None;
    case.inflow.model = InflowChoice::FreeWake(FreeWakeValues {
        azimuths: Some(12),
        turns: Some(3),
        panels: 10,
        core_r: 0.01,
        near_core_r: Some(0.01),
        mutual_core_r: 0.0,
        updates: 1,
        ..FreeWakeValues::default()
    });
    let text = "advance_ratio,ct_sigma,shaft_tilt_deg,theta0_deg\n0.03,0.15,-30,0\n";
    let data = PointData::read(&Source { name: "made".into(), text: text.into() }).unwrap();
    let sweep = Sweep::of(&data, &case).unwrap();
    let own = predict(&RotorModel::of(case), &sweep, None, None).unwrap_err();
    assert!(own.to_string().contains("wake and trim found no solution"), "{own}");
}

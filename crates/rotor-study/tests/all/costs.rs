//! What control costs: the fronts of the paper's rotor against what shares no code with them.

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::{Case, ControlActuator, EffortChoice};
use rotor_study::{
    CostedSet, Drives, FrontAgainst, HubLoads, RotorPlant, Setting, TrimmedRotor, control_costs,
    control_set, fronts,
};

fn ideal_case(harmonics: &[usize]) -> Case {
    let mut case = Case::default();
    let control = &mut case.control;
    control.actuators = vec![ControlActuator::Ideal];
    control.harmonics = vec![harmonics.to_vec()];
    control.effort = EffortChoice::Limits;
    case
}

fn one(flaps: usize, flap: usize, n: usize, amplitude: Harmonic) -> Vec<HarmonicSeries> {
    let mut all = vec![HarmonicSeries::zero(0); flaps];
    all[flap].set_harmonic(n, amplitude);
    all
}

/// The change of the root moments in the linearised rotor against differences of whole responses.
#[test]
fn root_moments_follow_the_flaps_as_in_whole_responses() {
    let case = ideal_case(&[3]);
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let (step_deg, mut worst) = (0.05_f64, 0.0_f64);
    for (flap, n, unit) in [
        (0, 3, Harmonic { cosine: 1.0, sine: 0.0 }),
        (1, 2, Harmonic { cosine: 0.0, sine: 1.0 }),
        (1, 4, Harmonic { cosine: 0.6, sine: -0.8 }),
    ] {
        let whole = |deg: f64| {
            let rad = deg.to_radians();
            let own = Harmonic { cosine: rad * unit.cosine, sine: rad * unit.sine };
            let angles = one(2, flap, n, own);
            let response = rotor.with_flaps(angles.clone()).unwrap();
            rotor.station_loads_with(angles, &response, &[0.0]).unwrap().remove(0).moments
        };
        let (up, down) = (whole(step_deg), whole(-step_deg));
        let motion = one(1, 0, n, unit).remove(0);
        let linear = rotor.moments_along((flap, &motion), 0.0).unwrap();
        for (moment, linear) in linear.iter().enumerate() {
            let sizes = (1..=12).map(|n| linear.harmonic(n).amplitude());
            let size = sizes.fold(linear.mean.abs(), f64::max);
            let (up, down) = (&up.harmonics[moment], &down.harmonics[moment]);
            for n in 1..=8 {
                let (up, down, found) = (up.harmonic(n), down.harmonic(n), linear.harmonic(n));
                let off = (found.cosine - (up.cosine - down.cosine) / (2.0 * step_deg))
                    .hypot(found.sine - (up.sine - down.sine) / (2.0 * step_deg));
                worst = worst.max(off / size);
                let place = format!("flap {flap}, moment {moment}, {n}/rev");
                assert!(off <= 1e-3 * size, "{place}: {off:e} of {size:e}");
            }
        }
    }
    println!("moments along the flaps: {worst:.1e}");
}

/// Ends and shape of every front, and its points flown by the nonlinear rotor.
#[test]
fn fronts_reach_from_no_control_to_the_optimum_and_the_rotor_flies_them() {
    let case = ideal_case(&[3]);
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let drives = Drives::new(&case, None).unwrap();
    let lines = fronts(&case, &rotor, &drives);
    assert_eq!(lines.len(), 3);
    let optimum = control_set(&case, &rotor, &drives, &[3], &|| ()).unwrap().remove(0);
    let least = optimum.j_after / optimum.j_before;
    let full = drives.limit(3).unwrap();
    let plant = RotorPlant::new(rotor.clone(), drives.ideal.clone(), &[3], &[full]).unwrap();
    let unit = rotor.scales().moment_newton_metre();
    for line in &lines {
        assert_eq!(line.failure, None);
        assert!((line.at_rest.cost_ratio - 1.0).abs() < 1e-14 && line.points.len() > 8);
        for pair in line.points.windows(2) {
            assert!(pair[1].cost_ratio < pair[0].cost_ratio && pair[1].second > pair[0].second);
        }
        let (first, last) = (&line.points[0], line.points.last().unwrap());
        // the ideal actuator in the linearised rotor: near to the end of the loop on the whole one
        assert!((last.cost_ratio - least).abs() < 0.01, "{} {least}", last.cost_ratio);
        if line.against == FrontAgainst::Power {
            assert!(first.control_volt.iter().all(|volt| *volt == 0.0) && first.second == 0.0);
            assert!((first.cost_ratio - 1.0).abs() < 1e-12);
        } else {
            println!("{:?}: {} of {}", line.against, first.second, line.at_rest.second);
            assert!(first.second < 0.999 * line.at_rest.second, "{:?}", line.against);
        }
        for point in line.points.iter().step_by(4) {
            let state = plant.state(&point.control_volt).unwrap();
            let hub = HubLoads::from_parts(state.rotor.hub.harmonic(4)).parts();
            let before: f64 = rotor.trim().rotor.hub.harmonic(4).iter().map(|z| z * z).sum();
            let flown = hub.iter().map(|z| z * z).sum::<f64>() / before;
            assert!((flown / point.cost_ratio - 1.0).abs() < 0.05, "{flown} {}", point.cost_ratio);
            let angles = state.flaps.iter().map(rotor_study::FlapMotion::angle_rad).collect();
            let root = rotor.station_loads_with(angles, &state.rotor, &[0.0]).unwrap().remove(0);
            let swing = root.moments.peak_to_peak().map(|swing| 0.5 * unit * swing);
            let told = point.half_peak_to_peak_newton_metre;
            for (found, told) in [swing[0], swing[2]].into_iter().zip(told) {
                assert!((found / told - 1.0).abs() < 0.03, "{:?}: {found} {told}", line.against);
            }
            let moment =
                &root.moments.harmonics[if line.against == FrontAgainst::RootFlap { 0 } else { 2 }];
            let square: f64 = moment.harmonics.iter().map(|h| 0.5 * h.amplitude().powi(2)).sum();
            if line.against != FrontAgainst::Power {
                assert!(
                    (unit * square.sqrt() / point.second - 1.0).abs() < 0.02,
                    "{:?}",
                    line.against
                );
            }
        }
    }
}

/// Costs of a set in plain numbers: what the case gives is told, what it does not give is not.
#[test]
fn costs_say_what_the_case_gives_and_no_more() {
    let mut case = ideal_case(&[3]);
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let drives = Drives::new(&case, None).unwrap();
    let studies = control_set(&case, &rotor, &drives, &[3], &|| ()).unwrap();
    let records = control_costs(&case, &rotor, &drives, &studies).unwrap();
    let baseline = HubLoads::from_parts(rotor.trim().rotor.hub.harmonic(4));
    let study = &studies[0];
    let told = |case: &Case| {
        let flaps = study.state.rotor.hinge.iter().zip(&study.state.flaps);
        let set = CostedSet {
            harmonics: &study.harmonics,
            actuator: "ideal",
            cost_ratio: study.j_after / study.j_before,
            flaps: flaps.map(|(h, f)| (h.clone(), &f.voltage_volt, &f.flap_deg)).collect(),
        };
        records.figures(0, set, &Setting::of_case(case, &baseline)).unwrap()
    };
    let none = told(&case);
    assert!(none.flaps.iter().all(|flap| flap.electrical.is_none() && flap.load_line.is_none()));
    assert_eq!(
        none.root.iter().map(|cost| cost.load).collect::<Vec<_>>(),
        ["flap", "lag", "torsion"]
    );
    case.actuator.capacitance_microfarad = Some(40.0);
    case.rotor.pitch_link_arm_r = Some(0.02);
    let given = told(&case);
    let voltage = study.state.flaps[0].voltage_volt.harmonic(3).amplitude();
    let omega = rotor.scales().omega_rad_s();
    let exact = 0.5 * 3.0 * omega * 40e-6 * voltage * voltage;
    let electrical = given.flaps[0].electrical.unwrap();
    assert!((electrical.apparent_voltampere / exact - 1.0).abs() < 1e-12, "{electrical:?} {exact}");
    // an ideal actuator has no loop
    assert_eq!(electrical.loss_watt, None);
    let (torsion, link) = (&given.root[2], &given.root[3]);
    let arm_m = 0.02 * case.rotor.radius_m;
    assert_eq!((link.load, link.unit), ("pitch link", "N"));
    for (link, torsion) in link.half_peak_to_peak.iter().zip(torsion.half_peak_to_peak) {
        assert!((link * arm_m / torsion - 1.0).abs() < 1e-12);
    }
    // control of 3/rev twists the blade: what the link holds is not what it held
    assert!((torsion.ratio() - 1.0).abs() > 0.5, "{}", torsion.ratio());
    let sum: f64 = given.flaps.iter().map(|flap| flap.given_watt).sum();
    assert!((given.given_of_all_blades_watt / (4.0 * sum) - 1.0).abs() < 1e-12);
}

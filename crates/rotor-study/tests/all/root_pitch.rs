//! Root pitch as the plant of a controller, and against flaps.

use hhc_control::{Plant, identify_t};
use nalgebra::{DMatrix, DVector};
use rotor_base::{HarmonicSeries, uniform_azimuths_rad};
use rotor_case::{Case, RootPitchBy};
use rotor_study::{Drives, RootPitchPlant, TrimmedRotor, compare_root_pitch};

/// The paper's rotor in Drees's inflow.
fn case() -> Case {
    let mut case = Case::default();
    case.control.harmonics = vec![vec![3]];
    case
}

/// T about a control is the slope of what is measured there.
#[test]
fn t_of_root_pitch_is_that_of_differences() {
    let rotor = TrimmedRotor::new(&case(), None).unwrap();
    let mut plant = RootPitchPlant::new(rotor, &[3, 4]).unwrap();
    let zero = plant.layout().zero();
    let linear = plant.linearised_t(&zero).unwrap().unwrap();
    let differences = identify_t(&mut plant, &[0.01; 4]).unwrap();
    let off = (linear.as_matrix() - differences.as_matrix()).norm() / linear.as_matrix().norm();
    println!("T of root pitch against differences: {off:.1e}");
    assert!(off < 1e-4, "{off:e}");
    // about another control, along one direction of it
    let (control, step) = ([0.3, -0.2, 0.1, 0.4], 0.01);
    let t = plant.linearised_t(&control).unwrap().unwrap();
    let mut at = |part: f64| {
        let mut moved = control;
        moved[2] += part * step;
        DVector::from_vec(plant.measure(&moved).unwrap().outputs)
    };
    let slope = (at(1.0) - at(-1.0)) / (2.0 * step);
    let off = (t.as_matrix().column(2) - &slope).norm() / slope.norm();
    println!("about another control: {off:.1e}");
    assert!(off < 1e-4, "{off:e}");
}

/// What root moment and pitch rate say of the power of the pitch control is what the power balance of the rotor says.
#[test]
fn the_moment_at_the_root_gives_the_power_of_the_pitch_control() {
    let case = case();
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let plant = RootPitchPlant::new(rotor.clone(), &[3]).unwrap();
    let control_deg = [0.8, -0.5];
    let response = plant.response(&control_deg).unwrap();
    let mut pitch_rad: HarmonicSeries = plant.pitch_rad(&control_deg).unwrap();
    let at_root = [case.rotor.root_offset_r];
    let root = rotor.station_loads_pitched(&pitch_rad, &response, &at_root).unwrap().remove(0);
    let controls = rotor.trim().controls;
    pitch_rad.harmonics[0].cosine += controls.theta1c_rad;
    pitch_rad.harmonics[0].sine += controls.theta1s_rad;
    let (moment, rate) = (&root.moments.harmonics[2], pitch_rad.derivative());
    let azimuths = 360;
    let of = |azimuth: f64| -moment.value(azimuth) * rate.value(azimuth);
    let power: f64 =
        uniform_azimuths_rad(azimuths).into_iter().map(of).sum::<f64>() / azimuths as f64;
    let off = (power - response.power.pitch).abs() / response.power.pitch.abs();
    println!("{power:e} against {:e}: {off:.1e}", response.power.pitch);
    assert!(off < 1e-9, "{off:e}");
}

/// Both end at the same `J_Z`. Root pitch at one harmonic has two controls: its best is that of the normal equations.
#[test]
fn flaps_and_root_pitch_are_compared_at_equal_reduction() {
    let case = case();
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let drives = Drives::new(&case, None).unwrap();
    let found = compare_root_pitch(&case, &rotor, &drives).unwrap().remove(0);
    let [before, flaps, root] =
        [found.no_control.j_z, found.flaps.as_ref().unwrap().j_z, found.root_pitch.j_z];
    assert!((flaps - root).abs() < 2e-5 * (before - root), "{flaps:e} {root:e}");
    assert!(root >= found.root_pitch_reaches && flaps >= found.flaps_reach.unwrap());

    let t = RootPitchPlant::new(rotor.clone(), &[3]).unwrap().t_at_rest().unwrap();
    let t: &DMatrix<f64> = t.as_matrix();
    let z = DVector::from_column_slice(&rotor.trim().rotor.hub.harmonic(case.rotor.blades));
    let best = (t.transpose() * t).lu().solve(&(-t.transpose() * &z)).unwrap();
    let linear = (&z + t * &best).norm_squared() / z.norm_squared();
    let reached = found.root_pitch_reaches / before;
    println!("left of J: {reached:.4}, by the normal equations {linear:.4}");
    assert!((reached - linear).abs() < 2e-3, "{reached} {linear}");
    let amplitude_deg = best[0].hypot(best[1]);
    let made_deg = found.root_pitch.motions[0].amplitude_deg;
    assert!((made_deg / amplitude_deg - 1.0).abs() < 2e-2, "{made_deg} {amplitude_deg}");
}

/// A rotor without flaps has root pitch alone; a swashplate refuses what it cannot give.
#[test]
fn cases_without_flaps_and_with_a_swashplate() {
    let mut case = case();
    case.flaps.clear();
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let drives = Drives::new(&case, None).unwrap();
    let found = compare_root_pitch(&case, &rotor, &drives).unwrap().remove(0);
    assert!(found.flaps.is_none() && found.root_pitch.j_z < found.no_control.j_z);

    case.rotor.root_pitch_by = RootPitchBy::Swashplate;
    assert!(compare_root_pitch(&case, &rotor, &drives).is_ok());
    case.control.harmonics = vec![vec![3], vec![2]];
    let error = compare_root_pitch(&case, &rotor, &drives).unwrap_err().to_string();
    assert!(error.contains("gives 3 to 5 per rev"), "{error}");
    case.control.harmonics.clear();
    let error = compare_root_pitch(&case, &rotor, &drives).unwrap_err().to_string();
    assert!(error.starts_with("control.harmonics"), "{error}");
}

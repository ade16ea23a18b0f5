//! A T that is handed in, in the loops of a study.

use hhc_control::Plant;
use rotor_case::{Case, ControlActuator, ControllerChoice, HandedSet, HandedT};
use rotor_study::{Drives, RotorPlant, StudyError, TrimmedRotor, control_set};
use std::sync::Arc;

fn case() -> Case {
    let mut case = Case::default();
    case.control.harmonics = vec![vec![3]];
    case.control.actuators = vec![ControlActuator::Ideal];
    case
}

fn handed(columns: Vec<Vec<f64>>) -> Arc<HandedT> {
    let set = HandedSet { harmonics: vec![3], advance_ratios: vec![0.3], columns: vec![columns] };
    Arc::new(HandedT { sets: vec![set], ..HandedT::default() })
}

/// The T that the loop identifies, handed back, gives the same control to the last bit; another one another control,
/// on the same rotor.
#[test]
fn the_own_t_handed_back_gives_the_same_control() {
    let mut case = case();
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    let drives = Drives::new(&case, None).unwrap();
    let control = |case: &Case| control_set(case, &rotor, &drives, &[3], &|| ()).unwrap().remove(0);
    let own = control(&case);
    let columns = own.t.as_ref().unwrap().columns();
    case.control.handed_t = Some(handed(columns.clone()));
    let back = control(&case);
    let bits = |volt: &[f64]| volt.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
    assert_eq!(bits(&back.control_volt), bits(&own.control_volt));
    assert_eq!(back.run.as_ref().unwrap().identifications, 0);
    let off =
        |factor: f64| columns.iter().map(|c| c.iter().map(|v| factor * v).collect()).collect();
    case.control.handed_t = Some(handed(off(1.3)));
    let other = control(&case);
    assert_ne!(bits(&other.control_volt), bits(&own.control_volt));
    assert_eq!(other.t.as_ref().unwrap().columns(), off(1.3));
    // the plant is the rotor all the same
    let full = drives.limit(3).unwrap();
    let mut plant = RotorPlant::new(rotor.clone(), drives.ideal.clone(), &[3], &[full]).unwrap();
    let measured = plant.measure(&other.control_volt).unwrap().outputs;
    assert_eq!(measured, other.run.as_ref().unwrap().last().measurement.outputs);
}

#[test]
fn a_t_that_does_not_serve_is_refused_with_its_field() {
    let mut case = case();
    let rotor = TrimmedRotor::new(&case, None).unwrap();
    case.control.harmonics = vec![vec![4]];
    let drives = Drives::new(&case, None).unwrap();
    case.control.handed_t = Some(handed(vec![vec![1e-6; 12]; 4]));
    let error = control_set(&case, &rotor, &drives, &[4], &|| ()).unwrap_err();
    assert!(matches!(error, StudyError::Refused { .. }) && error.field() == "control.t_file");
    assert!(error.to_string().contains("T of 3 per rev, not of 4 per rev"), "{error}");
    case.control.t_file = Some("t.json".to_owned());
    case.control.controller = ControllerChoice::Local;
    let faults = case.check().unwrap_err().0;
    assert!(faults.iter().any(|f| f.field == "control.t_file"), "{faults:?}");
}

//! The weight of the actuation power on the ideal actuator: where it moves the optimum.

use hhc_control::Plant;
use nalgebra::{DMatrix, DVector};
use rotor_case::{Case, ControlActuator, EffortChoice};
use rotor_response::InflowState;
use rotor_study::{Drives, RotorPlant, TrimmedRotor, control_set};

fn ideal_case(weight_per_watt: f64) -> Case {
    let mut case = Case::default();
    let control = &mut case.control;
    control.actuators = vec![ControlActuator::Ideal];
    control.harmonics = vec![vec![4]];
    control.effort = EffortChoice::Given { rho: 0.0 };
    control.power_weight_per_watt = weight_per_watt;
    case
}

/// `(T' W T + w P) u = -T' W Z0`, `P` the power of each pair per V^2: the optimum of the loop is that of the
/// closed form, which lies at a fraction of the power of the free one.
#[test]
fn the_weight_of_the_power_moves_the_optimum_as_the_closed_form_says() {
    let rotor = TrimmedRotor::new(&ideal_case(0.0), None).unwrap();
    // every clone of a rotor knows what one of them has linearised
    let linearised = rotor.linearised(InflowState::Settled).unwrap();
    assert!(std::ptr::eq(linearised, rotor.clone().linearised(InflowState::Settled).unwrap()));
    let weight = 2e-7;
    let found = [0.0, weight].map(|weight| {
        let case = ideal_case(weight);
        let drives = Drives::new(&case, None).unwrap();
        let study = control_set(&case, &rotor, &drives, &[4], &|| ()).unwrap().remove(0);
        let pairs = study.control_volt.chunks_exact(2).zip(study.power.gains_per_volt());
        let j_power: f64 = pairs.map(|(u, g)| g * g * (u[0] * u[0] + u[1] * u[1])).sum();
        (study.control_volt.clone(), j_power, case, drives)
    });
    let [(free, ..), (weighed, j_power, case, drives)] = found;
    let full = drives.limit(4).unwrap();
    let mut plant = RotorPlant::new(rotor.clone(), drives.ideal.clone(), &[4], &[full])
        .unwrap()
        .with_power(None, weight)
        .unwrap();
    let zero = plant.layout().zero();
    let t = plant.linearised_t(&zero).unwrap().unwrap();
    let t = t.as_matrix().rows(0, 12).into_owned();
    let z = DVector::from_column_slice(&rotor.trim().rotor.hub.harmonic(case.rotor.blades));
    let power_outputs = plant.power_outputs();
    let unit_power = |k: usize| {
        let mut unit = zero.clone();
        unit[k] = 1.0;
        power_outputs.cost(&unit)
    };
    let power = DMatrix::from_diagonal(&DVector::from_fn(zero.len(), |k, _| unit_power(k)));
    let closed = |power: &DMatrix<f64>| {
        (t.transpose() * &t + power).lu().solve(&(-t.transpose() * &z)).unwrap()
    };
    for (found, exact) in [(&free, closed(&(&power * 0.0))), (&weighed, closed(&power))] {
        let off = (DVector::from_column_slice(found) - &exact).norm() / exact.norm();
        println!("loop against closed form: {off:.1e}");
        assert!(off <= 5e-3, "{off:e}");
    }
    let moved = (DVector::from_column_slice(&free) - DVector::from_column_slice(&weighed)).norm();
    let size = DVector::from_column_slice(&free).norm();
    println!("moved by {:.2} of the free optimum", moved / size);
    assert!(moved > 0.1 * size, "{moved} {size}");
    assert!(power_outputs.cost(&weighed) < 0.7 * power_outputs.cost(&free));
    let told = power_outputs.cost(&weighed);
    assert!((j_power - told).abs() <= 1e-12 * told, "{j_power} {told}");
}

//! A distribution of relaxation times behind a linear actuator.

use approx::assert_abs_diff_eq;
use preisach_dyn::{ActuatorModel, LinkageStage, Relaxation, RelaxationElement, VoltageRange};

fn model(elements: &[(f64, f64)]) -> ActuatorModel {
    let mut model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
    let element = |&(share, time_constant_s)| RelaxationElement { share, time_constant_s };
    let elements = elements.iter().map(element).collect();
    model.linkage.push(LinkageStage::Relaxation(Relaxation { elements }));
    model
}

#[test]
fn a_step_follows_the_sum_of_exponentials_whatever_the_sampling() {
    for step_s in [1e-3, 7e-3] {
        // at rest at 65 V, then up by 40 V over one sample, as straight as the hold takes it
        let mut volts = vec![65.0];
        volts.resize(60, 105.0);
        let parts = [(0.7, 0.02), (0.2, 0.005)];
        let got = model(&parts).simulate(&volts, step_s).unwrap().output_deg;
        let height = 40.0 * 20.0 / 170.0;
        for (i, y) in got.iter().enumerate().skip(1) {
            let t = (i - 1) as f64 * step_s;
            let left: f64 = parts
                .iter()
                .map(|(f, tau)| {
                    // a ramp of one step length, then decay
                    f * tau / step_s * (1.0 - (-step_s / tau).exp()) * (-t / tau).exp()
                })
                .sum();
            assert_abs_diff_eq!(*y, height * (1.0 - left), epsilon = 1e-10);
        }
    }
}

#[test]
fn without_shares_it_is_the_identity_and_too_large_shares_are_refused() {
    let volts: Vec<f64> = (0..50).map(|i| 65.0 + 40.0 * f64::from(i).sin()).collect();
    let plain = model(&[]).simulate(&volts, 1e-3).unwrap();
    let zero = model(&[(0.0, 0.1)]).simulate(&volts, 1e-3).unwrap();
    assert_eq!(plain.output_deg, zero.output_deg);
    assert!(model(&[(0.7, 0.1), (0.4, 0.2)]).simulate(&volts, 1e-3).is_err());
    assert!(model(&[(0.7, 0.0)]).simulate(&volts, 1e-3).is_err());
}

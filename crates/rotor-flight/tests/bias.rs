//! A bias that is held in flight, and one that is led by the mean flap angle.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod common;

use common::actuator;
use hhc_control::ControlLayout;
use rotor_case::Bias;
use rotor_flight::FlapMarch;

#[test]
fn a_held_bias_stays_and_a_centred_one_is_led() {
    let model = actuator();
    let layout = ControlLayout::new(1, vec![3]).unwrap();
    let ends = [Bias::Fixed { volt: 50.0 }, Bias::Centred { guess_volt: 50.0 }].map(|bias| {
        let mut flaps = FlapMarch::new(&model, &layout, 5.0, bias).unwrap();
        let mut turn = None;
        for _ in 0..40 {
            turn = flaps.revolve(&[30.0, 0.0]).unwrap().pop();
        }
        turn.unwrap()
    });
    let [held, led] = ends;
    let middle = |volt: [f64; 2]| 0.5 * (volt[0] + volt[1]);
    assert!((middle(held.volt) - 50.0).abs() < 0.05, "{:?}", held.volt);
    assert!(held.flap_deg.mean.abs() > 0.3, "{}", held.flap_deg.mean);
    assert!(led.flap_deg.mean.abs() < 0.05, "{}", led.flap_deg.mean);
    assert!((middle(led.volt) - 50.0).abs() > 2.0, "{:?}", led.volt);
}

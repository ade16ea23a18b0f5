//! Filter of the sensor.

use super::cause::{BenchCause, lag, lags_s, linear, shape, usual};
use model_gap::{Candidate, Class};
use preisach_dyn::{Lag, SensorStage};

/// Filter of the sensor.
///
/// Two real poles share the delay at low frequency, `tau`: one alone at a share of 0, two alike at 0.5.
/// A conditioner rarely has one pole, and a filter that is taken for one is taken for a delay.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "sensor-filter",
        physics: "Low-pass filter of the displacement sensor, (1 + (1 - c) tau s)(1 + c tau s) y = x.",
        parameters: vec![lag("tau", design), shape(linear("second_share", "1", 0.0, 0.5))],
        class: Class::LagBehindTerminals,
        is_common: true,
        fingerprint: "a lag of the reading behind everything else, amplitude and phase",
        confused_with: &["transport-delay", "electrical-lag", "rate-dependence"],
        separating: &["laser-cross-check", "multisine-5-181Hz"],
        starts: lags_s(design).map(|tau| [vec![tau, 0.02], vec![tau, 0.3]]).concat(),
        blocked: design.one_frequency(),
        ..usual()
    },
    apply: |chain, values| {
        let (tau_s, second) = (values[0], values[1]);
        let poles = [1.0 - second, second].into_iter().filter(|share| *share > 0.0);
        let stage = |share: f64| SensorStage::Filter(Lag { tau_s: share * tau_s });
        chain.rear.sensor.extend(poles.map(stage));
    },
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::causes::Chain;

    #[test]
    fn both_poles_share_the_delay_and_two_fall_off_faster() {
        let poles = |second: f64| {
            let mut chain = Chain::default();
            (CAUSE.apply)(&mut chain, &[2e-3, second]);
            let tau = |s: &SensorStage| {
                if let SensorStage::Filter(lag) = s { Some(lag.tau_s) } else { None }
            };
            chain.rear.sensor.iter().filter_map(tau).collect::<Vec<f64>>()
        };
        for second in [0.0, 0.02, 0.3, 0.5] {
            let taus = poles(second);
            assert_eq!(taus.len(), if second > 0.0 { 2 } else { 1 });
            assert!((taus.iter().sum::<f64>() - 2e-3).abs() < 1e-15, "{taus:?}");
        }
        let gain = |second: f64, hz: f64| {
            let w = std::f64::consts::TAU * hz;
            poles(second).iter().map(|tau| 1.0 / (1.0 + (w * tau).powi(2)).sqrt()).product::<f64>()
        };
        assert!((gain(0.5, 1.0) / gain(0.0, 1.0) - 1.0).abs() < 1e-3);
        assert!(gain(0.5, 1000.0) < 0.5 * gain(0.0, 1000.0));
    }
}

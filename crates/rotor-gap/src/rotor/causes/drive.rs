//! What the drives of the flaps may lack.

use super::{Occasion, RotorCause};
use crate::rotor::model::RotorModel;
use model_gap::points::{CauseParameter, Shown};

const HYSTERESIS: &str = "the actuators have hysteresis that the simulation lacks: the flaps lag the voltage, by more at larger amplitude";

fn of_actuators(
    o: &Occasion<'_>,
    parameters: Vec<CauseParameter>,
    apply: impl Fn(&mut RotorModel, &[f64]) + Send + Sync + 'static,
) -> RotorCause {
    RotorCause::new("actuator-hysteresis", HYSTERESIS, parameters, apply)
        .beside(
            &["azimuth-offset", "channel-delay"],
            &["amplitude steps at one harmonic", "the motion of the flaps measured"],
        )
        .blocked_if(!o.is_driven, "no flap is driven at any point")
        .blocked_if(!o.is_ideal, "the actuator of the case has hysteresis already")
}

/// Two ways of one cause. A part of the difference between an actuator with hysteresis and an ideal one, the stroke that it
/// loses with it; its lag is reported. And a lag of which a part grows with amplitude, the rest with frequency, and a stroke.
pub(super) fn actuator_hysteresis(o: &Occasion<'_>) -> [RotorCause; 2] {
    let degrees = |name, range, amounts: &[f64], shown| {
        let (unit, none, amounts) = ("deg", 0.0, amounts.to_vec());
        CauseParameter { name, unit, none, range, amounts, shown }
    };
    let beside = Shown::Beside(o.lag_deg.to_vec());
    let part = degrees("lag_deg", (0.0, 2.0), &[0.5, 1.0], beside);
    let of_lag = vec![
        degrees("lag_deg", (0.0, 80.0), &[20.0, 45.0], Shown::Itself),
        degrees("relaxation_deg", (-20.0, 60.0), &[15.0, -10.0], Shown::Itself),
        CauseParameter::ratio(&[0.9, 0.7], (0.2, 2.5)).named("stroke"),
    ];
    [
        of_actuators(o, vec![part], |m, v| m.drive.hysteresis += v[0])
            .blocked_if(!o.has_hysteretic, "no actuator with hysteresis is at hand"),
        of_actuators(o, of_lag, |m, v| {
            m.drive.lag_deg += v[0];
            m.drive.relaxation_deg += v[1];
            m.drive.gain *= v[2];
        }),
    ]
}

pub(super) fn actuator_gain(o: &Occasion<'_>) -> RotorCause {
    let physics = "the flaps move more or less than the drive says: motion times a ratio";
    let parameters = vec![CauseParameter::ratio(&[0.95], (0.0, 2.5))];
    RotorCause::new("actuator-gain", physics, parameters, |m, v| m.drive.gain *= v[0])
        .beside(&["flap-effectiveness"], &["the motion of the flaps measured"])
        .exact_to(0.02)
        .blocked_if(!o.is_driven, "no flap is driven at any point")
}

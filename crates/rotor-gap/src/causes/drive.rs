//! What the drives of the flaps may lack.

use super::{Occasion, RotorCause, RotorParameter};
use model_gap::points::Shown;

/// Part of the difference between an actuator with hysteresis and an ideal one; its lag is reported.
pub(super) fn actuator_hysteresis(o: &Occasion<'_>) -> RotorCause {
    let physics = "the actuators have hysteresis that the simulation lacks: the flaps lag the voltage, by more at larger amplitude";
    let parameter = RotorParameter {
        name: "lag_deg",
        unit: "deg",
        none: 0.0,
        range: (0.0, 2.0),
        amounts: vec![0.5, 1.0],
        shown: Shown::Beside(o.lag_deg.to_vec()),
    };
    RotorCause::new("actuator-hysteresis", physics, vec![parameter], |m, v| {
        m.drive.hysteresis += v[0];
    })
    .beside(
        &["azimuth-offset", "channel-delay"],
        &["amplitude steps at one harmonic", "the motion of the flaps measured"],
    )
    .blocked_if(!o.is_driven, "no flap is driven at any point")
    .blocked_if(!o.has_hysteretic, "the actuator of the case has hysteresis already")
}

pub(super) fn actuator_gain(o: &Occasion<'_>) -> RotorCause {
    let physics = "the flaps move more or less than the drive says: motion times a ratio";
    let parameters = vec![RotorParameter::ratio(&[0.95], (0.0, 2.5))];
    RotorCause::new("actuator-gain", physics, parameters, |m, v| m.drive.gain *= v[0])
        .beside(&["flap-effectiveness"], &["the motion of the flaps measured"])
        .exact_to(0.02)
        .blocked_if(!o.is_driven, "no flap is driven at any point")
}

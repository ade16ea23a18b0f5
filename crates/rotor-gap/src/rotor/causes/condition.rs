//! What the stated condition may be off by.

use super::RotorCause;
use model_gap::points::CauseParameter;

pub(super) fn rotor_speed() -> RotorCause {
    let physics = "the rotor turns faster or slower than stated: true speed over the stated one";
    let parameters = vec![CauseParameter::ratio(&[1.01], (0.8, 1.25))];
    RotorCause::new("rotor-speed", physics, parameters, |m, v| m.speed *= v[0])
        .beside(&["air-density", "mass"], &["a count of revolutions"])
}

pub(super) fn air_density() -> RotorCause {
    let physics = "the air is denser or thinner than stated: true density over the stated one";
    let parameters = vec![CauseParameter::ratio(&[1.03], (0.7, 1.4))];
    RotorCause::new("air-density", physics, parameters, |m, v| m.density *= v[0])
        .beside(&["lift-slope", "mass", "rotor-speed"], &["pressure and temperature of the tunnel"])
}

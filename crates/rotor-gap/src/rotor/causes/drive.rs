//! What the drives of the flaps may lack.

use super::{Occasion, RotorCause};
use crate::rotor::model::RotorModel;
use model_gap::points::{CauseParameter, Shown};

const HYSTERESIS: &str = "the actuators have hysteresis that the simulation lacks: the flaps lag the voltage, by more at larger amplitude";

fn of_actuators(
    o: &Occasion<'_>,
    parameter: CauseParameter,
    apply: impl Fn(&mut RotorModel, f64) + Send + Sync + 'static,
) -> RotorCause {
    RotorCause::new("actuator-hysteresis", HYSTERESIS, vec![parameter], move |m, v| apply(m, v[0]))
        .beside(
            &["azimuth-offset", "channel-delay"],
            &["amplitude steps at one harmonic", "the motion of the flaps measured"],
        )
        .blocked_if(!o.is_driven, "no flap is driven at any point")
        .blocked_if(!o.is_ideal, "the actuator of the case has hysteresis already")
}

/// Two ways of one cause. A part of the difference between an actuator with hysteresis and an ideal one, lost stroke with it;
/// its lag is reported. And a lag that keeps the stroke.
pub(super) fn actuator_hysteresis(o: &Occasion<'_>) -> [RotorCause; 2] {
    let lag = |range, amounts, shown| {
        let (name, unit, none) = ("lag_deg", "deg", 0.0);
        CauseParameter { name, unit, none, range, amounts, shown }
    };
    let part = lag((0.0, 2.0), vec![0.5, 1.0], Shown::Beside(o.lag_deg.to_vec()));
    let kept = lag((0.0, 80.0), vec![20.0, 45.0], Shown::Itself);
    let root_volt = o.middle_volt.sqrt();
    [
        of_actuators(o, part, |m, v| m.drive.hysteresis += v)
            .blocked_if(!o.has_hysteretic, "no actuator with hysteresis is at hand"),
        of_actuators(o, kept, move |m, v| m.drive.lag_deg_per_root_volt += v / root_volt),
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

//! What the way of the loads to the readings may lack.

use super::{Occasion, RotorCause};
use model_gap::points::{CauseParameter, Shown, lasting};

/// Error of form of what turns and scales readings: none but rounding and what the sampling does.
const EXACT: f64 = 0.005;

pub(super) fn pitch_reference() -> RotorCause {
    let physics =
        "the pitch was read at another radius or with an offset: collective read less the true one";
    let parameters = vec![CauseParameter::both_ways("collective_deg", "deg", &[0.1, -0.1], 6.0)];
    RotorCause::new("pitch-reference", physics, parameters, |m, v| m.path.collective_deg += v[0])
        .beside(&["lift-slope", "twist"], &["the collective at zero thrust"])
        .exact_to(EXACT)
}

/// The compliance of the support over its mass is what adds up; its frequency is reported.
pub(super) fn hub_impedance() -> RotorCause {
    let physics = "the hub moves on its support: loads at n/rev pass a mode of the support, damped by 5 % of critical";
    let square = |hz: f64| 1.0 / (hz * hz);
    let frequencies = [200.0, 120.0, 80.0, 60.0, 50.0, 42.0, 36.0, 32.0];
    let parameter = CauseParameter {
        name: "frequency_hz",
        unit: "Hz",
        none: 0.0,
        range: (0.0, square(30.0)),
        amounts: frequencies.map(square).to_vec(),
        shown: Shown::ReciprocalRoot,
    };
    let damping = CauseParameter::label("damping_ratio", 0.05);
    RotorCause::new("hub-impedance", physics, vec![parameter, damping], |m, v| {
        m.path.compliance_s2 += v[0];
    })
    .beside(&["sensor-gain"], &["points at other rotor speeds", "a shaker on the hub"])
}

pub(super) fn azimuth_offset() -> RotorCause {
    let physics =
        "the hub channels are turned against the drive: n/rev by n times an angle, late positive";
    let angles = [1.0, -1.0, 3.0, -3.0, 7.0, -7.0, 12.0, -12.0, 18.0, -18.0, 25.0, -25.0];
    let parameters = vec![CauseParameter::both_ways("deg", "deg", &angles, 30.0)];
    RotorCause::new("azimuth-offset", physics, parameters, |m, v| m.path.azimuth_deg += v[0])
        .beside(&["channel-delay", "actuator-hysteresis"], &["points at other rotor speeds"])
        .exact_to(EXACT)
}

pub(super) fn channel_delay() -> RotorCause {
    let physics = "the hub channels are late: n/rev by n Omega times a time";
    let times =
        [2.5e-4, -2.5e-4, 8e-4, -8e-4, 2e-3, -2e-3, 4e-3, -4e-3, 7e-3, -7e-3, 0.012, -0.012];
    let parameters = vec![CauseParameter::both_ways("s", "s", &times, 0.015)];
    RotorCause::new("channel-delay", physics, parameters, |m, v| m.path.delay_s += v[0])
        .beside(&["azimuth-offset", "actuator-hysteresis"], &["points at other rotor speeds"])
        .exact_to(EXACT)
}

/// One cause for every instrument; a ratio of -1 is a reversed sign.
pub(super) fn sensor_gains(o: &Occasion<'_>) -> Vec<RotorCause> {
    let one = |name: &String| {
        let instrument = name.clone();
        let physics = lasting(&format!(
            "the instrument {name} reads its channels times a ratio; -1 is a reversed sign"
        ));
        let parameters = vec![CauseParameter::ratio(&[1.05], (-2.0, 4.0))];
        RotorCause::new("sensor-gain", physics, parameters, move |m, v| {
            if v[0] - 1.0 != 0.0 {
                *m.path.gains.entry(instrument.clone()).or_insert(1.0) *= v[0];
            }
        })
        .beside(&["hub-impedance"], &["the instrument calibrated again"])
        .exact_to(EXACT)
    };
    o.instruments.iter().map(one).collect()
}

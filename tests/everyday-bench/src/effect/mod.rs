//! The physics of what is hidden, by the place where it sits.

mod amplifier;
mod ceramic;
mod mechanics;
mod sensor;

pub(crate) use amplifier::Amplifier;
pub(crate) use ceramic::Ceramic;
pub(crate) use mechanics::Mechanics;
pub(crate) use sensor::{Moment, Sensor};

/// One physical change.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Physics {
    /// Before the terminals.
    Amplifier(Amplifier),
    /// In the ceramic.
    Ceramic(Ceramic),
    /// Between ceramic and target.
    Mechanics(Mechanics),
    /// In the displacement sensor.
    Sensor(Sensor),
    /// The monitor shows `(1 + gain) V + zero_volt`.
    Monitor { gain: f64, zero_volt: f64 },
}

//! Data sets with a hidden effect, for tests of programs that look for what is missing in a model.
//!
//! A reference folder shows an actuator as it is: hysteresis, ordinary relaxation, ordinary creep. A
//! measured folder shows the same actuator with an effect that a hash of the seed has chosen, or with none.
//! The answer is kept apart. `EXPERIMENTS.md` of this package describes sets, stages and experiments.
//!
//! ```text
//! command -> amplifier -> ceramic -> relaxation -> creep -> mechanics -> sensor -> noise
//! ```
//! Every effect has richer physics than its name asks for: soft knees, two modes, five elements,
//! jitter, harmonics. Signals are whole records that pass from stage to stage.

mod amplifier;
mod answer;
mod assignment;
mod base;
mod bouc_wen;
mod catalogue;
mod ceramic;
mod design;
mod draw;
mod effect;
mod mechanics;
mod relays;
mod sensor;
mod set;
mod simulate;
mod text;
mod waveform;

pub use amplifier::Amplifier;
pub use answer::{Answer, HiddenEffect, Quantity, RunAnswer};
pub use assignment::{Assignment, BLOCK, SHARE};
pub use base::{BaseActuator, Family, creep};
pub use bouc_wen::{BoucWen, BoucWenParameters};
pub use catalogue::{Cause, Hidden, Outside, PAIRS};
pub use ceramic::Ceramic;
pub use design::{
    BASES, BIAS_VOLT, Design, EXPERIMENTS, Experiment, Fitting, Monitor, Monitors, Plan,
    RANGE_VOLT, Size, experiment, is_experiment, measured, reference,
};
pub use effect::{Character, Element, Parameter, Physics};
pub use mechanics::Mechanics;
pub use relays::{RelayParameters, Relays};
pub use sensor::Sensor;
pub use set::{MeasuredSet, Request, Truth, measured_set, noise_um, reference_files, truth};
pub use simulate::{Exact, Prepared, STIFFNESS_NEWTON_PER_UM, internal_rate_hz};
pub use text::File;
pub use waveform::Waveform;

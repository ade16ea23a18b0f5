//! Control in time along a flight whose advance ratio and thrust change and whose flaps may fail.
//!
//! - *Rotor* ([`RotorPath`]): trims at knots of advance ratio, and at a second thrust; loads and their answer to the flaps are
//!   linearised there and interpolated linearly in between. Every revolution is a steady state.
//! - *Flaps* ([`FlapMarch`]): every actuator is marched sample by sample through its hysteresis, all harmonics at once, its
//!   bias slowly led so that the mean flap angle vanishes. A flap may have an actuator of its own ([`OwnActuator`]).
//! - *Blades* ([`RotorPath::with_blades`]): what blades that are unlike the rest, or move a flap otherwise, bring to the hub, at
//!   every harmonic.
//! - *Loop* ([`fly`]): a cycle is some revolutions to settle and a window of the analyser; then the next control.
//! - *Case* ([`FlyingCase`]): the flight that a case describes, its controllers side by side, many draws of its noise, and how
//!   wrong T may be along it.
//! - *Failures* ([`failures_of_case`]): what control reaches when a flap or an actuator of one blade, or a load cell, fails.
//! - *What leaves it* ([`exported_case`]): T over the knots, as arrays with names and units; its controllers, for other languages
//!   ([`controllers_of_case`]); T that comes back ([`handed_t`]); the rotor as state space ([`state_space_of_case`]).
//! - *Wake in time* ([`wake_in_time`]): rotor and free wake marched together where no wake is periodic; means and their intervals.
//!
//! Values in, values out: no file, no terminal.

mod blades;
mod case_flight;
mod error;
mod failures;
mod flaps;
mod flight;
mod flown;
mod flying_case;
mod leaving;
mod margins;
mod path;
mod pilot;
mod shown;
mod wake_in_time;

pub use case_flight::{FlightSummary, FlownCase, FlownController};
pub use error::FlightError;
pub use failures::{Failure, FailureControl, FailureLine, FailureStudy, failures_of_case};
pub use flaps::{FlapMarch, FlapTurn};
pub use flight::{FlapFailure, Flight, OwnActuator};
pub use flown::{FlightPoint, fly};
pub use flying_case::{DrawnCase, DrawnController, FlyingCase};
pub use leaving::{controllers_of_case, exported_case, handed_t, state_space_of_case};
pub use margins::{MarginPoint, MarginSet, MarginStudy};
pub use path::{FlightState, KnownBlade, RotorPath};
pub use pilot::Guidance;
pub use shown::{
    BESIDE_FILES, controllers_section, draws_csv, draws_pictures, draws_section, failures_csv,
    failures_section, flight_csv, flight_notes, harmonic_names, is_own_table, load_amplitudes,
    margins_csv, margins_pictures, margins_section,
};
pub use wake_in_time::text::{wake_in_time_csv, wake_in_time_text};
pub use wake_in_time::{
    Agreement, FoundInTime, InTimeQuestion, MeanLine, Verdict, WakeInTimeResult, wake_in_time,
};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

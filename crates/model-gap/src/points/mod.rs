//! Values at points of test against a simulation that is known by tables: anyone's simulator.
//!
//! A sweep gives a few values at each of many points: hub loads, controls, frequencies. The simulation is there as what it
//! predicts for them, and what it would predict with a stated amount of each suspect.
//!
//! ```text
//! y_pc = f_pc + sum over suspects  e_pc(x) + sum over nuisance  B_pc,k d_k + error,   d_k ~ N(0, 1)
//! ```
//! `p` counts points, `c` channels. `e` is straight in its amount `x` between the tables given, a parabola where there are
//! two. Every value is taken over its standard deviation: N, N m and degrees are never added.

mod cause;
mod finding;
mod floor;
mod inputs;
mod kind;
mod names;
mod next;
mod predicted;
mod shown;
mod table;
mod told;

pub use cause::{CauseParameter, PointCause};
pub use finding::{ChannelGain, PointFinding};
pub use kind::{KindFinding, KindQuestion, PointKind, WithInputs};
pub use names::{channels_of, lasting};
pub use next::NextPoints;
pub use shown::{ChannelFloor, Reading};
pub use table::{
    Channel, Grid, Instrument, Part, Point, PointTable, Shown, Suspect, SuspectParameter,
};

//! Studies of a rotor with driven trailing-edge flaps: values in, values out.
//!
//! Floor 5: a [`Case`](rotor_case::Case) holds the values of a rotor, its flaps and its control; a [`TrimmedRotor`] flies it; a
//! [`RotorPlant`] answers voltages with hub loads; [`control_all`] closes the loop over it. No file, no terminal: an
//! error names the field of the case that is at fault ([`StudyError::field`]), who has read the case adds the line.
//!
//! | idea | module |
//! |---|---|
//! | from a voltage to the motion of a flap; hinge moment, power | `flaps` |
//! | the rotor in trim, its inflow, T of the linearised rotor | `rotor` |
//! | both as the `Plant` of a controller: outputs, limits, tangents | `plant` |
//! | control of all sets, forecasts, robustness | `control` |
//! | what control costs: power, piezo, blade loads, and the fronts of `J` against them | `costs` |
//! | assumptions changed one at a time | `sensitivity` |
//! | modes, stability, loads, dissimilar blades | `blade` |
//! | the free wake of a case | `wake` |
//! | measured airloads, tip motion and vortices beside the computed ones | `measured` |

mod blade;
mod control;
mod costs;
mod error;
mod flaps;
mod loads;
mod measured;
mod plant;
mod rotor;
mod sensitivity;
mod wake;

pub use blade::*;
pub use control::*;
pub use costs::*;
pub use error::StudyError;
pub use flaps::*;
pub use loads::{HubLoads, Setting, is_still, loads_cost};
pub use measured::*;
pub use plant::*;
pub use rotor::*;
pub use rotor_base::series::{scaled, weighted};
pub use sensitivity::{
    Assumptions, Sensitivity, SensitivityLine, SensitivityRecord, most_moved, sensitivities,
    sensitivity_lines,
};
pub use wake::{FoundWake, PassageLine, WakeResult, WakeUpdateLine, wake_of_case};

/// Version of the model, part of the key of every stored result: equal versions, cases and inputs give equal numbers.
///
/// It is the version of the program with a count behind it. The count is raised with every change that moves a number,
/// so that results of two states between releases are told apart. It is stated and not the hash of the sources: those
/// of the crates below are out of sight once each crate is a package of its own, and a comment would make every result
/// foreign. A test keeps it honest: where golden values differ from those listed in `fixtures/golden/versions.tsv`, a
/// new row with a new count is asked for. What no golden sees is in the hands of who changes it; at the latest the
/// next release has keys of its own.
pub const MODEL_VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "+model.", "6");

/// The example of the crate's README, run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
pub struct ReadmeExample;

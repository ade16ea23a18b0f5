//! The measured runs under the effects of causes, and how their traces are weighed.

mod bench;
mod response;
mod shown;
mod smooth;
mod traces;

pub(crate) use bench::{BenchSimulator, ChannelKind, Setting, inputs_of, is_same_input};
pub use shown::RunShown;
pub(crate) use traces::CALIBRATIONS;

//! What to measure next.

mod catalogue;
mod excitation;
mod proposal;

pub(crate) use excitation::Span;
pub use proposal::Proposal;
pub(crate) use proposal::{Bench, proposal};

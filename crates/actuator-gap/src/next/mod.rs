//! What to measure next.

mod catalogue;
mod excitation;
mod proposal;

pub use proposal::Proposal;
pub(crate) use proposal::{Bench, proposal};

//! Stability of a periodic orbit, and oscillations read from a decaying record.

pub(crate) mod floquet;
pub(crate) mod monodromy;
pub(crate) mod oscillations;

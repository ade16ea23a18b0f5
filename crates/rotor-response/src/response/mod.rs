//! The periodic response: the blade as a system, its solution, the loads of a revolution.

pub(crate) mod evaluated;
pub(crate) mod evaluation;
pub(crate) mod hinge;
pub(crate) mod lag_memory;
pub(crate) mod revolution;
pub(crate) mod root_reaction;
pub(crate) mod rotor;
pub(crate) mod solver;
pub(crate) mod system;
pub(crate) mod wake_coupling;
pub(crate) mod wake_loading;

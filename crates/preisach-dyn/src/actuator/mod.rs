//! One actuator: the chain of stages around its law, simulated and closed to orbits.

pub(crate) mod chain;
pub(crate) mod model;
pub(crate) mod periodic;
pub(crate) mod simulate;

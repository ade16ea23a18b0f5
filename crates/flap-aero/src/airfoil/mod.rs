//! Aerofoil tables and the steady flow they describe.

pub(crate) mod c81;
pub(crate) mod steady_flow;

//! The rotor as wake and inflow see it: panels, lifting lines, circulation and inflow over the disk.

pub(crate) mod blades;
pub(crate) mod circulation;
pub(crate) mod inflow_map;
pub(crate) mod rotor;

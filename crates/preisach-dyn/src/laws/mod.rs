//! The laws between voltage and free flap angle, and the Preisach plane they live on.

pub(crate) mod bouc_wen;
pub(crate) mod dynamics;
pub(crate) mod envelope;
pub(crate) mod grid;
pub(crate) mod hysteresis;
pub(crate) mod law;
pub(crate) mod memory;
pub(crate) mod play_map;
pub(crate) mod prandtl;
pub(crate) mod statics;
pub(crate) mod stop;

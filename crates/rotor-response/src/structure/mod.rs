//! The blade at its stations: mode shapes, motion, modal equations.

pub(crate) mod blade;
pub(crate) mod equations;
pub(crate) mod load_station;
pub(crate) mod motion;

//! The actuator: laws, stages, closed orbits, identification.

mod against_plays;
mod chain;
mod common;
mod density;
mod dynamics;
mod forc;
mod hysteresis;
mod identifiability;
mod intervals;
mod inverse;
mod laws;
mod mode;
mod model_table;
mod offset;
mod oracles;
mod oscillator;
mod own_truth;
mod periodic;
mod relaxation;
mod shipped_bench;
mod stages;
mod stop;

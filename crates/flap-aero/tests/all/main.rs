//! The section against exact theory, published data and itself.

mod c81;
mod calibrated;
mod compressible;
mod exact_theory;
mod free_stream;
mod marching;
mod stall;
mod steady_flow;
mod tables;

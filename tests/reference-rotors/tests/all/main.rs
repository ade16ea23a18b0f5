//! Rigid rotors of the literature in their own free wake.

mod common;
mod control_point;
mod forward_flight;
mod hover;
mod limits;

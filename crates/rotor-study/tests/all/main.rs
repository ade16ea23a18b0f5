//! The rotor with driven flaps as a plant.

mod costs;
mod coupled_plant;
mod handed_t;
mod held_bias;
mod power_weight;
mod root_pitch;

//! The rules of the house, kept and broken.

mod case_studies;
mod command;
mod dependencies;
mod fuzz;
mod goldens;
mod release;
mod rooms;
mod rules;
mod validation;

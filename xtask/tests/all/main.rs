//! The rules of the house, kept and broken.

mod command;
mod dependencies;
mod goldens;
mod rooms;
mod rules;
mod validation;

//! The `hhc` command as users meet it: a process in a folder of its own.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod actuator_use;
mod bad_input;
mod commands;
mod compare;
mod costs;
mod diagnosis_page;
mod disk;
mod export;
mod fly;
mod hardness;
mod identify;
mod identify_page;
mod import;
mod lab;
mod manners;
mod measured;
mod place;
mod points;
mod replace;
mod rotor;
mod screen;
mod stages_doc;
mod sweep;
mod wake;

//! The `hhc` command as users meet it: a process in a folder of its own.

mod bad_input;
mod commands;
mod import;
mod place;

//! The command from outside: files in, text and exit codes out.

mod case_studies;
mod crosscheck;
mod everyday;
mod hidden_effects;
mod ladder;
mod metamorphic;
mod page;
mod part_truth;
mod rotor_points;
mod rotor_truth;
mod shipped_bench;
mod threads;
mod three_sets;

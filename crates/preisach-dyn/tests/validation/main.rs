//! Rows of the validation page: laws and stages of the actuator.

mod actuator;
mod actuator_stages;
mod bouc_wen_benchmark;
#[path = "../all/oracles/mod.rs"]
mod oracles;

use validation::hold;

#[test]
fn actuator_rows() {
    hold(actuator::ROWS);
}

#[test]
fn actuator_stages_rows() {
    hold(actuator_stages::ROWS);
}

#[test]
fn bouc_wen_benchmark_rows() {
    hold(bouc_wen_benchmark::ROWS);
}

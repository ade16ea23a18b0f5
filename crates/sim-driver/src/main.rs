//! The `hhc` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    sim_driver::cli::main()
}

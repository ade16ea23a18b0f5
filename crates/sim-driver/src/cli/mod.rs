//! The `hhc` command: arguments, dispatch, exit codes.

mod args;
mod commands;
mod section;

pub use args::{
    CheckArgs, Cli, Command, DiagnoseArgs, FormatArgs, IdentifyArgs, ImportArgs, InflowOverride,
    InitArgs, ModesArgs, ReportArgs, RunArgs, SectionArgs, StudyArgs, WakeArgs,
};

use crate::SimError;
use clap::Parser;
use std::process::ExitCode;

/// Runs the command with the arguments of the process.
///
/// Exit codes: 0 done, 1 the physics or numerics failed (or a bug, which says so), 2 bad input, 3 a
/// comparison failed. A panic never reaches the user as such.
pub fn main() -> ExitCode {
    std::panic::set_hook(Box::new(|info| {
        eprintln!("{}", bug_message(&info.to_string()));
    }));
    let cli = Cli::parse();
    let outcome = std::panic::catch_unwind(|| execute(&cli));
    match outcome {
        Ok(Ok(())) => ExitCode::SUCCESS,
        Ok(Err(error)) => {
            eprintln!("{error}");
            ExitCode::from(error.exit_code())
        }
        // the hook has printed what happened
        Err(_) => ExitCode::from(1),
    }
}

fn bug_message(panic: &str) -> String {
    format!(
        "hhc {} has met a bug of its own and stops; files already complete are kept, none is half-written.\nPlease report it with the command and the files used:\n{panic}",
        crate::VERSION
    )
}

/// Does what the arguments ask for and prints the result.
///
/// # Errors
/// Whatever stopped it; [`SimError::exit_code`] says what the process should return.
pub fn execute(cli: &Cli) -> Result<(), SimError> {
    match &cli.command {
        None => commands::study(&cli.study),
        Some(Command::Run(args)) => commands::run(args),
        Some(Command::Identify(args)) => commands::identify(args),
        Some(Command::Diagnose(args)) => commands::diagnose(args),
        Some(Command::Ladder(args)) => commands::ladder(args),
        Some(Command::Import(args)) => commands::import(args),
        Some(Command::Modes(args)) => commands::modes(args),
        Some(Command::Wake(args)) => commands::wake(args),
        Some(Command::Section(args)) => section::section(args),
        Some(Command::Check(args)) => commands::check(args),
        Some(Command::Init(args)) => commands::init(args),
        Some(Command::Report(args)) => commands::report(args),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_argument_definitions_are_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn a_bug_is_called_a_bug() {
        let text = bug_message("panicked at somewhere");
        assert!(text.contains("bug") && text.contains("panicked at somewhere"), "{text}");
    }
}

//! The generated code compiled, run and compared with the model it was made from.

#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]
#![expect(clippy::print_stdout, reason = "tests print the figures they check")]
#![expect(clippy::disallowed_methods, reason = "tests read fixtures and write what they compile")]

mod c;
mod common;
mod json;
mod matlab;
mod messages;
mod monitor;
mod python;

//! What the terminal shows of a run: one screen, and every table on request.

mod details;
mod summary;

pub(crate) use details::details;
pub(crate) use summary::{Summary, summary};

use rotor_study::WakeStatus;

/// What a free wake that is not converged means for the numbers shown.
pub(crate) fn wake_note(wake: WakeStatus) -> Option<&'static str> {
    match wake {
        WakeStatus::Converged => None,
        WakeStatus::NotConverged => {
            Some("NOT CONVERGED: the state with the least change; see the warning")
        }
        WakeStatus::Diverged => Some(
            "DIVERGED: no solution, the last state before; nothing is controlled; see the warning",
        ),
    }
}

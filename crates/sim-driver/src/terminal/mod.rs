//! What the terminal shows of a run: one screen, and every table on request.

mod details;
mod summary;

pub(crate) use details::details;
pub(crate) use summary::summary;

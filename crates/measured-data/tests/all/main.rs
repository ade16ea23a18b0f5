//! What `hhc import` makes of recordings.

mod instruments;

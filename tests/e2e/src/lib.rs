//! End-to-end tests of the hhc command.

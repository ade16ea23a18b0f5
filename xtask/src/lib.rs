//! Project chores: layer check, tidy check, validation page, regression sweeps.

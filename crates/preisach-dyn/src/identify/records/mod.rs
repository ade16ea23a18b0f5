//! Bench records: what a command does, what is wrong with a record, what it is prepared for.

pub(crate) mod drive;
pub(crate) mod findings;
pub(crate) mod flat_top;
pub(crate) mod fourier;
pub(crate) mod noise;
pub(crate) mod plausibility;
pub(crate) mod prepared;
pub(crate) mod record;
pub(crate) mod repetition;
pub(crate) mod settings;
pub(crate) mod spikes;
pub(crate) mod split_rule;
pub(crate) mod subject;

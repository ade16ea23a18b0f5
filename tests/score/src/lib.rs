//! Compares what a diagnosis says with what a synthetic set hides.
//!
//! It knows findings by their published layout ([`findings`]) and answers by the generator ([`truth`]);
//! it depends on no crate of the product. [`metrics::metrics`] computes every metric of the
//! acceptance suite with the number of cases behind it, [`everyday`] those of benches with everyday errors
//! (answers by [`everyday_bench`]), [`points`] those of points of a rotor, a blade or a section, [`binomial`] the bounds of a share,
//! [`report`] the tables, [`classes`] says which causes count as one.

pub mod binomial;
pub mod case;
pub mod classes;
pub mod everyday;
pub mod findings;
pub mod metrics;
pub mod points;
pub mod report;

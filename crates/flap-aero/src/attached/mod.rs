//! Attached flow: linear section models with lags, and the functions they are built from.

pub(crate) mod calibrated;
pub(crate) mod coefficients;
pub(crate) mod effectiveness;
pub(crate) mod hariharan_leishman;
pub(crate) mod incompressible;
pub(crate) mod model;
pub(crate) mod quasi_steady;
pub(crate) mod theodorsen;
pub(crate) mod values;

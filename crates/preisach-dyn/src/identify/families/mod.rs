//! Families of models fitted to the same records and compared.

pub(crate) mod by_family;
pub(crate) mod comparison;
pub(crate) mod family;
pub(crate) mod folds;
pub(crate) mod layered;
pub(crate) mod mode;
pub(crate) mod plays_fit;
pub(crate) mod quantities;
pub(crate) mod stop_fit;

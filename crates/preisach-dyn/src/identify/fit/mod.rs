//! Fits to prepared records: linear programs, rate maps, output error, their validation.

pub(crate) mod compare;
pub(crate) mod density;
pub(crate) mod linear_mode;
pub(crate) mod output_error;
pub(crate) mod passage;
pub(crate) mod preisach;
pub(crate) mod program;
pub(crate) mod rate_fit;
pub(crate) mod refine;
pub(crate) mod roles;
pub(crate) mod static_fit;
pub(crate) mod stream;
pub(crate) mod training;
pub(crate) mod validate;

//! The rotating beam: what it is made of, its elements and matrices.

pub(crate) mod assembly;
pub(crate) mod distribution;
pub(crate) mod element;
pub(crate) mod mode_kind;
pub(crate) mod properties;
pub(crate) mod root_support;
pub(crate) mod shape;

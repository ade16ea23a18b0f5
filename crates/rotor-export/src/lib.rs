//! What leaves the rotor for other programs: arrays with names and units, and the controller.
//!
//! | idea | items |
//! |---|---|
//! | arrays with named indices | [`LabelledArray`], [`Axis`], [`Document`] |
//! | JSON, CSV, MAT of level 5 | [`data_files`], [`DataFormat`] |
//! | a controller that flies, as C99 | [`controller_files`], [`ControllerSpec`], [`TKnowledge`] |
//! | what cannot be written | [`RotorExportError`] |
//!
//! Values in, texts and bytes out: no file is written here.

mod controller;
mod document;
mod error;
mod formats;

pub use controller::{ControllerSpec, TKnowledge, controller_files};
pub use document::{Axis, Document, LabelledArray};
pub use error::RotorExportError;
pub use formats::{DataFormat, data_files};

/// Compiles and runs the example of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExample;

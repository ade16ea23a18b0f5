//! What a release must hold: packages that stand alone, data with licences, keys that follow the model.
//!
//! | idea | module |
//! |---|---|
//! | packages: manifests, files that they include, a build and an installed program from them alone | [`packages`] |
//! | source and licence of every folder of data, and the page of the book | [`data_licences`] |
//! | the version of the model against the golden values | [`model_version`] |

pub mod data_licences;
pub mod model_version;
pub mod packages;

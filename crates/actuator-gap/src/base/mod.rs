//! The base model: what is known of the actuator with nothing missing.

mod equations;
mod errors;
mod model;

pub(crate) use errors::{ErrorModel, white_noise};
pub(crate) use model::BaseModel;

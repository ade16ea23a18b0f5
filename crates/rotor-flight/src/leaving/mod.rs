//! What leaves a case as arrays with names and units, and what comes back.

mod exported;
mod handed;
mod labels;
mod settings;
mod state_space;

pub(crate) use exported::dissimilar_note;
pub use exported::{controllers_of_case, exported_case};
pub use handed::handed_t;
pub use state_space::state_space_of_case;

//! What is computed from a section: response to motion, marching in time, slopes, loads in a varying stream.

pub(crate) mod decay;
pub(crate) mod free_stream;
pub(crate) mod known_error;
pub(crate) mod layout;
pub(crate) mod linearise;
pub(crate) mod march;
pub(crate) mod periodic;
pub(crate) mod response;

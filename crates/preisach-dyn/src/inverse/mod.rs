//! Inverses: which voltage makes the flap do what is wanted.
//!
//! | wanted | item |
//! |---|---|
//! | the next output of a static model, exactly | [`StaticPreisach::inverse`](crate::StaticPreisach::inverse) |
//! | a periodic flap history of any actuator | [`ActuatorModel::periodic_inverse`](crate::ActuatorModel::periodic_inverse) |
//!
//! The bias that keeps a mean of zero under a given control is another question: the mean is then the
//! only unknown, and the controller answers it.

mod joints;
mod newton;
mod periodic;
mod sample;
mod settings;

pub use settings::{InverseSettings, PeriodicInverse};

//! The laws between voltage and free flap angle, and the Preisach plane they live on.

/// A law that files hold as its parameters: it is checked when it is read.
macro_rules! stored_as_parameters {
    ($law:ident, $parameters:ident) => {
        impl TryFrom<$parameters> for $law {
            type Error = PreisachError;

            fn try_from(parameters: $parameters) -> Result<Self, PreisachError> {
                Self::new(parameters)
            }
        }

        impl From<$law> for $parameters {
            fn from(law: $law) -> Self {
                law.parameters
            }
        }
    };
}

pub(crate) mod bouc_wen;
pub(crate) mod dynamics;
pub(crate) mod envelope;
pub(crate) mod grid;
pub(crate) mod hysteresis;
pub(crate) mod law;
pub(crate) mod memory;
pub(crate) mod oscillator;
pub(crate) mod play_map;
pub(crate) mod prandtl;
pub(crate) mod statics;
pub(crate) mod stop;

//! How the bias voltage of an actuator is set.

/// How the bias voltage of an actuator is set.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bias {
    /// Solved so that the mean flap angle vanishes (paper equation 6).
    Centred {
        /// Where the search starts, V.
        guess_volt: f64,
    },
    /// Held, as by an amplifier: the mean flap angle follows from voltage and load.
    Fixed {
        /// The bias, V.
        volt: f64,
    },
}

impl Bias {
    /// The bias that is held, or where the search for it starts, V.
    pub fn volt(self) -> f64 {
        match self {
            Self::Centred { guess_volt } => guess_volt,
            Self::Fixed { volt } => volt,
        }
    }

    /// Whether the voltage is held, so that the mean flap angle is not.
    pub fn is_fixed(self) -> bool {
        matches!(self, Self::Fixed { .. })
    }
}

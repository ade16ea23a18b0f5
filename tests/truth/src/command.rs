//! Voltage commands as functions of the time since the end of the initial rest.

use std::f64::consts::TAU;

/// One sine of a [`Command::Mix`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tone {
    /// Frequency as a multiple of the revolution.
    pub per_rev: u32,
    /// Amplitude, V.
    pub amplitude_volt: f64,
    /// Phase `p` of `sin(2 pi f t + p)`, deg.
    pub phase_deg: f64,
}

/// A command; zero time is the end of the initial rest at the bias.
#[derive(Debug, Clone, PartialEq)]
pub enum Command {
    /// `bias + amplitude sin(2 pi f t)`.
    Sine {
        /// Frequency, Hz.
        frequency_hz: f64,
        /// Amplitude, V.
        amplitude_volt: f64,
        /// Number of cycles.
        cycles: u32,
    },
    /// Straight ramps at one speed from the bias through the voltages given.
    Ramps {
        /// Speed, V/s.
        speed_volt_per_s: f64,
        /// Turning points, V.
        turning_points_volt: Vec<f64>,
    },
    /// A sum of multiples of the revolution, faded in over the first revolution by `(1 - cos)/2`.
    Mix {
        /// Revolutions per second.
        revolution_hz: f64,
        /// The tones.
        tones: Vec<Tone>,
        /// Number of revolutions, the first one included.
        revolutions: u32,
    },
}

impl Command {
    /// Duration without the initial rest, s.
    pub fn duration_s(&self, bias_volt: f64) -> f64 {
        match self {
            Self::Sine { frequency_hz, cycles, .. } => f64::from(*cycles) / frequency_hz,
            Self::Ramps { speed_volt_per_s, turning_points_volt } => {
                let mut path_volt = 0.0;
                let mut from = bias_volt;
                for &to in turning_points_volt {
                    path_volt += (to - from).abs();
                    from = to;
                }
                path_volt / speed_volt_per_s
            }
            Self::Mix { revolution_hz, revolutions, .. } => f64::from(*revolutions) / revolution_hz,
        }
    }

    /// Voltage at a time since the end of the rest, V.
    ///
    /// Before that (`time_s <= 0`) it is the bias; ramps stay at their last turning point.
    pub fn voltage_volt(&self, bias_volt: f64, time_s: f64) -> f64 {
        if time_s <= 0.0 {
            return bias_volt;
        }
        match self {
            Self::Sine { frequency_hz, amplitude_volt, .. } => {
                bias_volt + amplitude_volt * (TAU * frequency_hz * time_s).sin()
            }
            Self::Ramps { speed_volt_per_s, turning_points_volt } => {
                let mut left_volt = speed_volt_per_s * time_s;
                let mut from = bias_volt;
                for &to in turning_points_volt {
                    let stretch = (to - from).abs();
                    if left_volt < stretch {
                        return from + (to - from).signum() * left_volt;
                    }
                    left_volt -= stretch;
                    from = to;
                }
                from
            }
            Self::Mix { revolution_hz, tones, .. } => {
                let azimuth_rad = TAU * revolution_hz * time_s;
                let fade =
                    if azimuth_rad < TAU { 0.5 - 0.5 * (0.5 * azimuth_rad).cos() } else { 1.0 };
                let sum: f64 = tones
                    .iter()
                    .map(|tone| {
                        let phase = tone.phase_deg.to_radians();
                        tone.amplitude_volt * (f64::from(tone.per_rev) * azimuth_rad + phase).sin()
                    })
                    .sum();
                bias_volt + fade * sum
            }
        }
    }
}

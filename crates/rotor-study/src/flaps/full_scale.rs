//! How far an actuator moves its flap at most.

use crate::flaps::motion::FlapMotion;
use rotor_base::Harmonic;

/// Full-scale voltage of an actuator at one harmonic and the stroke it gives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FullScale {
    /// Voltage amplitude, V.
    pub amplitude_volt: f64,
    /// Flap amplitude, deg.
    pub stroke_deg: f64,
    /// Largest amplitude that the range of voltages leaves to this harmonic alone, V.
    pub reach_volt: f64,
    /// Flap motion for a cosine of the voltage amplitude, `[cosine, sine]`, deg.
    pub motion_deg: [f64; 2],
}

impl FullScale {
    /// That of a motion which a cosine of one harmonic makes, where the range of voltages ends.
    pub(crate) fn of(motion: &FlapMotion, harmonic: usize, amplitude_volt: f64) -> Self {
        let Harmonic { cosine, sine } = motion.flap_deg.harmonic(harmonic);
        let (reach_volt, motion_deg) = (amplitude_volt, [cosine, sine]);
        Self { amplitude_volt, stroke_deg: cosine.hypot(sine), reach_volt, motion_deg }
    }
}

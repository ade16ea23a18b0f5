//! Which motions are made, and how they are read.

use crate::draw::{log_within, rounded};
use crate::section::theory::Motion;
use chacha20::ChaCha8Rng;
use rand::RngExt;
use std::f64::consts::PI;

/// Chord, m.
pub const CHORD_M: f64 = 0.3;
/// Speed of sound, m/s.
pub const SOUND_M_S: f64 = 340.3;

/// A motion that is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Run {
    /// What moves: pitch or flap.
    pub motion: Motion,
    /// Mach number of the tunnel.
    pub mach: f64,
    /// `omega c / (2 U)`.
    pub reduced_frequency: f64,
    /// Mean incidence, deg.
    pub mean_deg: f64,
    /// Amplitude, deg.
    pub amplitude_deg: f64,
    /// Number of its condition, from 1; repeats share it.
    pub group: usize,
}

impl Run {
    /// Frequency, Hz.
    pub fn frequency_hz(&self) -> f64 {
        rounded(self.reduced_frequency * self.mach * SOUND_M_S / (PI * CHORD_M), 1e3)
    }
}

/// What a set is made of.
#[derive(Debug, Clone, PartialEq)]
pub struct Layout {
    /// The motions.
    pub runs: Vec<Run>,
    /// Whether histories are told, or first harmonics per radian.
    pub has_histories: bool,
    /// Whether the hinge moment is read.
    pub has_hinge: bool,
    /// Flap chord over chord.
    pub flap_chord: f64,
    /// Section model of the case.
    pub model: &'static str,
}

impl Layout {
    /// Draws a layout; `points` is the number of motions if it is given.
    pub fn draw(rng: &mut ChaCha8Rng, points: Option<usize>, needs_histories: bool) -> Self {
        let has_histories = rng.random_range(0..2) == 0 || needs_histories;
        let has_hinge = rng.random_range(0..3) > 0;
        let flap_chord = rounded(rng.random_range(0.15..0.32), 100.0);
        let model = if rng.random_range(0..2) == 0 { "Incompressible" } else { "Calibrated" };
        let drawn = if has_histories { rng.random_range(6..=10) } else { rng.random_range(8..=16) };
        let points = points.unwrap_or(drawn);
        let machs = [(0.1, 0.22), (0.25, 0.45)]
            .map(|(low, high)| rounded(rng.random_range(low..high), 100.0));
        let repeats = if has_histories { 1 } else { rng.random_range(1..=2) };
        let conditions = points.div_ceil(repeats);
        let top = rng.random_range(0.2..0.4);
        let run = |number: usize| {
            let k = log_within(rng, 0.03, top);
            let motion = if number.is_multiple_of(2) { Motion::Pitch } else { Motion::Flap };
            let (mean, amplitude) = if has_histories {
                (rng.random_range(0.0..10.0), rng.random_range(2.0..7.0))
            } else {
                (0.0, 1.0)
            };
            Run {
                motion,
                mach: machs[(number / 2) % 2],
                reduced_frequency: rounded(k, 1e3),
                mean_deg: rounded(mean, 2.0),
                amplitude_deg: rounded(amplitude, 2.0),
                group: number + 1,
            }
        };
        let conditions: Vec<Run> = (0..conditions).map(run).collect();
        let runs = conditions.iter().flat_map(|own| vec![*own; repeats]).take(points).collect();
        Self { runs, has_histories, has_hinge, flap_chord, model }
    }
}

//! What a set of any kind is asked to be, and what comes of it.

use crate::draw::Parameters;
use crate::error::RotorTruthError;
use chacha20::ChaCha8Rng;
use rand::RngExt;
use serde::Serialize;
use std::collections::BTreeMap;

/// Nothing hidden.
pub const NULL: &str = "null";

/// What a set is asked to be.
#[derive(Debug, Clone, PartialEq)]
pub struct Asked {
    /// Seed of everything that is drawn.
    pub seed: u64,
    /// Noise below the readings, dB.
    pub snr_db: f64,
    /// Effect; drawn by the seed if none.
    pub effect: Option<String>,
    /// Size of its first parameter; drawn if none.
    pub size: Option<f64>,
    /// Number of points; drawn if none.
    pub points: Option<usize>,
    /// Whether what the engineer does not know well is off by its deviation.
    pub base_error: bool,
}

impl Asked {
    /// Noise over the readings.
    pub fn noise_share(&self) -> f64 {
        10.0_f64.powf(-self.snr_db / 20.0)
    }

    /// The number of points: the one asked for, or `drawn`.
    ///
    /// # Errors
    /// [`RotorTruthError::Value`] outside 3 to 60.
    pub fn points_or(&self, drawn: usize) -> Result<usize, RotorTruthError> {
        let points = self.points.unwrap_or(drawn);
        if (3..=60).contains(&points) {
            return Ok(points);
        }
        let (what, expected) = ("the number of points", "3 to 60");
        Err(RotorTruthError::Value { what, value: points as f64, expected })
    }
}

/// An effect of a blade or a section.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effect {
    /// Its name in the answer.
    pub name: &'static str,
    /// Whether the list of the product has it.
    pub is_known: bool,
}

/// An effect that the list of the product has.
pub const fn known(name: &'static str) -> Effect {
    Effect { name, is_known: true }
}

/// An effect that it has not.
pub const fn outside(name: &'static str) -> Effect {
    Effect { name, is_known: false }
}

/// The effect of a name, or one that is drawn.
///
/// # Errors
/// [`RotorTruthError::UnknownName`].
pub fn chosen(
    catalogue: &[Effect],
    name: Option<&str>,
    rng: &mut ChaCha8Rng,
) -> Result<Effect, RotorTruthError> {
    let drawn = catalogue[rng.random_range(0..catalogue.len())];
    let Some(name) = name else { return Ok(drawn) };
    catalogue.iter().copied().find(|own| own.name == name).ok_or_else(|| {
        let known = catalogue.iter().map(|own| own.name).collect::<Vec<_>>().join(", ");
        RotorTruthError::UnknownName { what: "effect", found: name.to_owned(), known }
    })
}

/// What is hidden in a set of a blade or a section.
#[derive(Debug, Clone, Serialize)]
pub struct Answer {
    /// Name of the effect.
    pub effect: String,
    /// Its parameters, by the names of the causes.
    pub parameters: Parameters,
    /// Whether the list of the product has it.
    pub in_library: bool,
    /// Seed.
    pub seed: u64,
    /// Noise, dB below the readings.
    pub snr_db: f64,
    /// Number of points: rotor speeds or motions.
    pub points: usize,
    /// How the points are laid out.
    pub layout: &'static str,
    /// True over believed value of what is uncertain.
    pub base_ratios: BTreeMap<&'static str, f64>,
}

/// A set of a blade or a section as text.
#[derive(Debug, Clone)]
pub struct Made {
    /// The table of points.
    pub table_csv: String,
    /// The case of the engineer.
    pub case_ron: String,
    /// What is hidden.
    pub answer: Answer,
}

//! What the seed draws: streams, sizes of effects, and how they are told.

use crate::error::RotorTruthError;
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use serde_json::{Map, Value};

/// Parameters of an effect, by name.
pub type Parameters = Map<String, Value>;

/// A generator of its own for each thing that is drawn: another size draws no other noise.
pub fn stream(seed: u64, number: u64) -> ChaCha8Rng {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    rng.set_stream(number);
    rng
}

/// A normal number of deviation 1.
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    StandardNormal.sample(rng)
}

/// A number of which every factor is as likely, between two positive ones.
pub fn log_within(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    rng.random_range(low.ln()..high.ln()).exp()
}

/// A value to the nearest multiple of `1 / steps`.
pub fn rounded(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps
}

/// A size that is a number, if one is given.
///
/// # Errors
/// [`RotorTruthError::Value`].
pub fn checked_size(size: Option<f64>) -> Result<(), RotorTruthError> {
    match size {
        Some(own) if !own.is_finite() => {
            let (what, expected) = ("the size", "a finite number");
            Err(RotorTruthError::Value { what, value: own, expected })
        }
        _ => Ok(()),
    }
}

/// Parameters with their names.
pub fn told<const N: usize>(values: [(&str, Value); N]) -> Parameters {
    values.into_iter().map(|(name, value)| (name.to_owned(), value)).collect()
}

/// Draws sizes unless one is given.
#[derive(Debug)]
pub struct Draw<'a> {
    rng: &'a mut ChaCha8Rng,
    size: Option<f64>,
}

impl<'a> Draw<'a> {
    /// Draws from a stream; `size` stands in place of the first parameter of an effect.
    pub fn new(rng: &'a mut ChaCha8Rng, size: Option<f64>) -> Self {
        Self { rng, size }
    }

    /// Whether a size is given.
    pub fn is_given(&self) -> bool {
        self.size.is_some()
    }

    /// A value between two.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        self.rng.random_range(low..high)
    }

    /// A size between two values.
    pub fn size(&mut self, low: f64, high: f64) -> f64 {
        let drawn = self.within(low, high);
        self.size.unwrap_or(drawn)
    }

    /// A size between two positive values, every factor as likely.
    pub fn log_size(&mut self, low: f64, high: f64) -> f64 {
        let drawn = log_within(self.rng, low, high);
        self.size.unwrap_or(drawn)
    }

    /// One of two, as likely.
    pub fn is_up(&mut self) -> bool {
        self.rng.random_range(0..2) == 0
    }

    /// A size of either sign.
    pub fn signed(&mut self, low: f64, high: f64) -> f64 {
        let sign = if self.is_up() { 1.0 } else { -1.0 };
        let drawn = sign * self.within(low, high);
        self.size.unwrap_or(drawn)
    }

    /// A ratio above or below 1.
    pub fn ratio(&mut self, low: f64, high: f64) -> f64 {
        let up = self.is_up();
        let by = 1.0 + self.within(low, high);
        self.size.unwrap_or(if up { by } else { 1.0 / by })
    }

    /// A ratio above or below 1, every factor of its excess as likely.
    pub fn log_ratio(&mut self, low: f64, high: f64) -> f64 {
        let up = self.is_up();
        let by = 1.0 + log_within(self.rng, low, high);
        self.size.unwrap_or(if up { by } else { 1.0 / by })
    }

    /// A number below `count`.
    pub fn number(&mut self, count: usize) -> usize {
        self.rng.random_range(0..count)
    }
}

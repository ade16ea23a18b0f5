//! Random numbers that are a function of a list of keys alone.

use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

/// What a stream of random numbers is for: the first of its keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u64)]
pub(super) enum Purpose {
    Assignment = 1,
    Base = 2,
    Phases = 3,
    Effect = 4,
    Noise = 5,
    Run = 6,
    Monitor = 7,
}

/// A stream of random numbers.
#[derive(Debug)]
pub(super) struct Draw(ChaCha8Rng);

impl Draw {
    /// The stream of these keys.
    pub(super) fn new(purpose: Purpose, keys: &[u64]) -> Self {
        Self(ChaCha8Rng::seed_from_u64(hash(purpose as u64, keys)))
    }

    /// Uniform in `low..high`.
    pub(super) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// Uniform in the logarithm between two positive numbers.
    pub(super) fn log_uniform(&mut self, low: f64, high: f64) -> f64 {
        self.uniform(low.ln(), high.ln()).exp()
    }

    /// Gaussian of mean 0 and deviation 1.
    pub(super) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// Time to the next of events that happen at random, `rate_hz` of them a second on average; s.
    pub(super) fn waiting_s(&mut self, rate_hz: f64) -> f64 {
        -(-self.uniform(0.0, 1.0)).ln_1p() / rate_hz
    }

    /// One of `0..n`, `n > 0`.
    pub(super) fn below(&mut self, n: usize) -> usize {
        self.0.random_range(0..n)
    }

    /// A random order of `0..n` (Fisher and Yates).
    pub(super) fn permutation(&mut self, n: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..n).collect();
        for i in (1..n).rev() {
            order.swap(i, self.below(i + 1));
        }
        order
    }
}

/// Mixes keys into one number: each step is the finaliser of `SplitMix64`.
///
/// Source: Steele, Lea, Flood, OOPSLA 2014 (constants of the finaliser, variant 13 of D. Stafford).
fn hash(first: u64, keys: &[u64]) -> u64 {
    keys.iter().fold(mix(first), |state, key| mix(state ^ mix(*key)))
}

fn mix(key: u64) -> u64 {
    let z = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

//! Random numbers that are a function of a purpose and a list of keys alone.

use chacha20::ChaCha12Rng;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};

/// A stream of random numbers.
#[derive(Debug)]
pub(crate) struct Draw(ChaCha12Rng);

impl Draw {
    /// The stream of a purpose and its keys (FNV-1a over their bytes).
    pub(crate) fn new(purpose: &str, keys: &[u64]) -> Self {
        let bytes = purpose.bytes().chain(keys.iter().flat_map(|key| key.to_le_bytes()));
        let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        Self(ChaCha12Rng::seed_from_u64(hash))
    }

    /// Uniform in `low..high`.
    pub(crate) fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    /// Gaussian of mean 0 and deviation 1.
    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// One of `0..n`, `n > 0`.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0.random_range(0..n)
    }

    /// The numbers `0..n` in a random order.
    pub(crate) fn order(&mut self, n: usize) -> Vec<usize> {
        let mut keyed: Vec<(f64, usize)> = (0..n).map(|i| (self.uniform(0.0, 1.0), i)).collect();
        keyed.sort_by(|a, b| a.0.total_cmp(&b.0));
        keyed.into_iter().map(|(_, i)| i).collect()
    }
}

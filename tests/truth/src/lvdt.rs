//! The displacement sensor: gaussian noise, limits and quantisation.
//!
//! ```text
//! reading = q round( clip(y + sigma n, -F, F) / q ),   q = 2 F / 2^bits,   n ~ N(0, 1)
//! ```
//!
//! It reads at the rate of the record, after the chain. Not modelled: the bandwidth of the
//! demodulator (kHz, far above the tests) and hum.

use chacha20::ChaCha8Rng;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

use crate::error::{TruthError, require};

/// Parameters of [`Lvdt`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LvdtParameters {
    /// Range `F`: readings lie in -F..F, um.
    pub range_um: f64,
    /// Standard deviation `sigma` of the noise, um.
    pub noise_um: f64,
    /// Resolution of the converter, bits over the whole range.
    pub bits: u32,
}

impl LvdtParameters {
    /// The smallest step of a reading, `q`, um.
    pub fn resolution_um(&self) -> f64 {
        2.0 * self.range_um / f64::from(self.bits).exp2()
    }
}

/// The sensor with its own stream of noise.
#[derive(Debug)]
pub struct Lvdt {
    parameters: LvdtParameters,
    noise: ChaCha8Rng,
}

impl Lvdt {
    /// A sensor whose noise is a function of the seed and the stream alone.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for a range that is not positive, negative noise, or a resolution
    /// outside 1..=32 bits.
    pub fn new(parameters: LvdtParameters, seed: u64, stream: u64) -> Result<Self, TruthError> {
        const STAGE: &str = "LVDT";
        let p = parameters;
        require(p.range_um > 0.0, STAGE, "range_um", p.range_um, "positive")?;
        require(p.noise_um >= 0.0, STAGE, "noise_um", p.noise_um, "not negative")?;
        let bits = f64::from(p.bits);
        require((1..=32).contains(&p.bits), STAGE, "bits", bits, "in 1..=32")?;
        let mut noise = ChaCha8Rng::seed_from_u64(seed);
        noise.set_stream(stream);
        Ok(Self { parameters, noise })
    }

    /// One reading of the displacement, um.
    pub fn read_um(&mut self, displacement_um: f64) -> f64 {
        let p = &self.parameters;
        let normal: f64 = StandardNormal.sample(&mut self.noise);
        let seen = (displacement_um + p.noise_um * normal).clamp(-p.range_um, p.range_um);
        let q = p.resolution_um();
        q * (seen / q).round()
    }
}

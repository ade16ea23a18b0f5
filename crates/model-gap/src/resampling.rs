//! Noise taken from a residual and drawn again.

/// How noise is taken from a residual and drawn again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NoiseDraw {
    /// Half the window of the mean that noise is taken about, samples: what is smoother counts as structure.
    pub half_window: usize,
    /// Samples that are drawn together: their colour is kept. Well below the window, or the slow part that the
    /// mean took is missed.
    pub together: usize,
}

impl NoiseDraw {
    /// For records with structure that is not noise: what is smooth over nine samples stays out.
    pub const SHARP: Self = Self { half_window: 4, together: 16 };
    /// For residuals of a model that explains them: noise of a colour up to tens of samples, and with it what
    /// structure of that kind is left.
    pub const BROAD: Self = Self { half_window: 100, together: 48 };

    /// What is noise in a residual: each sample about the mean of its window, made as large as the noise would
    /// be without a mean taken out.
    pub fn noise_of(self, residual: &[f64]) -> Vec<f64> {
        let n = residual.len();
        let mut sums = vec![0.0; n + 1];
        for (i, v) in residual.iter().enumerate() {
            sums[i + 1] = sums[i] + v;
        }
        (0..n)
            .map(|i| {
                let (from, to) =
                    (i.saturating_sub(self.half_window), (i + self.half_window + 1).min(n));
                let count = (to - from) as f64;
                let off = residual[i] - (sums[to] - sums[from]) / count;
                // the mean holds a share of the sample itself
                off * (count / (count - 1.0).max(1.0)).sqrt()
            })
            .collect()
    }

    /// Noise drawn again in blocks from anywhere in a record (moving-block bootstrap: H. R. Kuensch,
    /// Annals of Statistics 17 (1989)); the same for the same seed.
    ///
    /// The mean that noise was taken about has taken a part of the mean of every block with it: of `L` samples drawn
    /// together from a window of `W`, the variance of their mean is `1 - L/W` of what it was. It is given back, or what
    /// feels the slow part of noise alone, as creep does, would be called better known than it is.
    pub fn again(self, noise: &[f64], seed: u64) -> Vec<f64> {
        let n = noise.len();
        let together = self.together.max(1).min(n.max(1));
        let window = (2 * self.half_window + 1) as f64;
        let kept = 1.0 - together as f64 / window;
        // what is smoother than a window narrower than the block stays out on purpose
        let lost = if kept > 0.0 { 1.0 / kept.sqrt() - 1.0 } else { 0.0 };
        let mut random = SplitMix(seed);
        let mut drawn = Vec::with_capacity(n + together);
        while drawn.len() < n {
            let first = random.below(n.saturating_sub(together) + 1);
            let block = &noise[first..first + together];
            let mean = block.iter().sum::<f64>() / together as f64;
            drawn.extend(block.iter().map(|v| v + lost * mean));
        }
        drawn.truncate(n);
        drawn
    }
}

/// A small generator of random numbers from a fixed seed: what is drawn is part of the result.
///
/// Source: G. L. Steele, D. Lea, C. H. Flood, *Fast splittable pseudorandom number generators*,
/// OOPSLA (2014).
#[derive(Debug)]
pub struct SplitMix(pub u64);

impl SplitMix {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// A whole number below `count`, which is at least 1.
    #[expect(clippy::cast_possible_truncation, reason = "the remainder is below a usize")]
    pub(crate) fn below(&mut self, count: usize) -> usize {
        (self.next() % count as u64) as usize
    }

    /// A number of the standard normal distribution (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        let mut uniform = || (self.next() >> 11) as f64 / (1_u64 << 53) as f64;
        let radius = (-2.0 * (1.0 - uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * uniform()).cos()
    }

    /// So many normal numbers of a standard deviation.
    pub fn normals(&mut self, deviation: f64, count: usize) -> Vec<f64> {
        (0..count).map(|_| deviation * self.normal()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Normal numbers of an autoregression: sums of twelve uniform ones, `rho` from sample to sample.
    fn noise(count: usize, rho: f64) -> Vec<f64> {
        let mut random = SplitMix(5);
        let mut before = 0.0;
        (0..count)
            .map(|_| {
                let fresh =
                    (0..12).map(|_| random.below(1_000_000) as f64 / 1e6).sum::<f64>() - 6.0;
                before = rho * before + (1.0 - rho * rho).sqrt() * fresh;
                before
            })
            .collect()
    }

    #[test]
    fn noise_drawn_again_has_the_size_and_colour_of_the_residual_and_not_its_structure() {
        let residual: Vec<f64> = (0..)
            .zip(noise(20_000, 0.6))
            .map(|(i, e)| 0.1 * e + 3.0 * (1e-3 * f64::from(i)).sin())
            .collect();
        let sharp = NoiseDraw::SHARP;
        let drawn = sharp.again(&sharp.noise_of(&residual), 7);
        assert_eq!(drawn.len(), residual.len());
        let size = (drawn.iter().map(|v| v * v).sum::<f64>() / drawn.len() as f64).sqrt();
        assert!((0.07..0.11).contains(&size), "{size}");
        let next: f64 = drawn.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / drawn.len() as f64;
        assert!(next > 0.15 * size * size, "{next}");
        assert_ne!(drawn, sharp.again(&sharp.noise_of(&residual), 8));
    }

    #[test]
    fn a_broad_window_keeps_the_slow_part_of_noise() {
        for (rho, least) in [(0.0, 0.93), (0.9, 0.7)] {
            let noise = noise(40_000, rho);
            let broad = NoiseDraw::BROAD;
            let drawn = broad.again(&broad.noise_of(&noise), 3);
            for span in [1, 4, 16, 64] {
                let energy = |v: &[f64]| {
                    v.chunks_exact(span).map(|c| c.iter().sum::<f64>().powi(2)).sum::<f64>()
                };
                let ratio = energy(&drawn) / energy(&noise);
                println!("{ratio} over {span} at {rho}");
                assert!((least..1.15).contains(&ratio), "{ratio} over {span} at {rho}");
            }
        }
    }

    #[test]
    fn short_records_are_drawn_again_without_a_panic() {
        for n in [0, 1, 5, 16, 17] {
            let noise = NoiseDraw::SHARP.noise_of(&vec![1.0; n]);
            assert_eq!(NoiseDraw::SHARP.again(&noise, 3).len(), n);
        }
    }
}

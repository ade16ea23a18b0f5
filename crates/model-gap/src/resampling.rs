//! Noise taken from a residual and drawn again.

/// Samples of noise that are drawn together: a colour of a few samples is kept.
const TOGETHER: usize = 16;
/// Half the window of the mean that noise is taken about.
const HALF_WINDOW: usize = 4;

/// What is noise in a residual: each sample about the mean of itself and the four on either side, made as
/// large as the noise would be without a mean taken out. What is smooth over nine samples stays out.
pub fn noise_of(residual: &[f64]) -> Vec<f64> {
    let n = residual.len();
    (0..n)
        .map(|i| {
            let about = &residual[i.saturating_sub(HALF_WINDOW)..(i + HALF_WINDOW + 1).min(n)];
            let count = about.len() as f64;
            let off = residual[i] - about.iter().sum::<f64>() / count;
            // the mean holds a share of the sample itself
            off * (count / (count - 1.0).max(1.0)).sqrt()
        })
        .collect()
}

/// Noise drawn again in blocks of 16 samples from anywhere in a record (moving-block bootstrap: H. R. Kuensch,
/// Annals of Statistics 17 (1989)); the same for the same seed.
pub fn drawn_again(noise: &[f64], seed: u64) -> Vec<f64> {
    let n = noise.len();
    let mut random = SplitMix(seed);
    let mut drawn = Vec::with_capacity(n + TOGETHER);
    while drawn.len() < n {
        let first = random.below(n.saturating_sub(TOGETHER) + 1);
        drawn.extend(noise[first..].iter().take(TOGETHER));
    }
    drawn.truncate(n);
    drawn
}

/// A small generator of random numbers with a fixed seed: resampling is part of the result.
///
/// Source: G. L. Steele, D. Lea, C. H. Flood, *Fast splittable pseudorandom number generators*,
/// OOPSLA (2014).
pub(crate) struct SplitMix(pub(crate) u64);

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
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_drawn_again_has_the_size_and_colour_of_the_residual_and_not_its_structure() {
        let mut random = SplitMix(5);
        let mut uniform = || random.below(1_000_000) as f64 / 1e6;
        let mut before = 0.0;
        let residual: Vec<f64> = (0..20_000)
            .map(|i| {
                // noise with a correlation of 0.6 from sample to sample, on a slow structure
                let normal = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
                before = 0.6 * before + 0.8 * normal;
                0.1 * before + 3.0 * (1e-3 * f64::from(i)).sin()
            })
            .collect();
        let drawn = drawn_again(&noise_of(&residual), 7);
        assert_eq!(drawn.len(), residual.len());
        let size = (drawn.iter().map(|v| v * v).sum::<f64>() / drawn.len() as f64).sqrt();
        assert!((0.07..0.11).contains(&size), "{size}");
        let next: f64 = drawn.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / drawn.len() as f64;
        assert!(next > 0.15 * size * size, "{next}");
        assert_ne!(drawn, drawn_again(&noise_of(&residual), 8));
    }

    #[test]
    fn short_records_are_drawn_again_without_a_panic() {
        for n in [0, 1, 5, 16, 17] {
            let noise = noise_of(&vec![1.0; n]);
            assert_eq!(drawn_again(&noise, 3).len(), n);
        }
    }
}

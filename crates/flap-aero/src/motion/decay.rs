//! Decay factors of a lag over a step, four lags at a time.

use std::f64::consts::{LN_2, LOG2_E};

/// Lags are marched in blocks of this many: plain loops over such arrays compile to vector code.
pub(crate) const LANES: usize = 4;

/// One number per lag of a block.
pub(crate) type Lanes = [f64; LANES];

/// Adding and subtracting it rounds a small number to an integer, which is then in its last bits.
const ROUNDER: f64 = 1.5 * (1_u64 << 52) as f64;

/// Beyond it nothing is left of `e^(-z)`, and the power of two still is a normal number.
const GONE: f64 = 700.0;

/// Decay of a block over a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Decay {
    /// `1 - e^(-z)`.
    pub(crate) gone: Lanes,
    /// `(1 - e^(-z)) / z`, 1 for no step.
    pub(crate) mean: Lanes,
}

impl Decay {
    /// No step.
    pub(crate) const NONE: Self = Self { gone: [0.0; LANES], mean: [1.0; LANES] };
}

/// Decay factors for `z = pole step`, a step above 0, without loss of digits at small `z`.
///
/// ```text
/// 1 - e^(-z) = (1 - 2^-n) - 2^-n (e^r - 1),    r = n ln 2 - z,    |r| <= (ln 2)/2
/// e^r - 1 = 2 O / (E - O)                      the [6/6] Pade approximant, error below 1e-18
/// ```
/// `inverse` is `1 / z`, which a caller has cheaper than by dividing lag by lag. Written without
/// branches or calls: the standard library's `exp_m1` takes lags one by one. The error is below
/// 3e-16, absolute for `gone`, and some more for `mean`, relative.
#[inline]
pub(crate) fn decay(z: &Lanes, inverse: &Lanes) -> Decay {
    let mut gone = [0.0; LANES];
    let mut mean = [0.0; LANES];
    for lane in 0..LANES {
        let z = if z[lane] < GONE { z[lane] } else { GONE };
        let rounded = z * LOG2_E + ROUNDER;
        let halvings = rounded - ROUNDER;
        let r = halvings * LN_2 - z;
        let power = rounded.to_bits().wrapping_sub(ROUNDER.to_bits());
        let scale = f64::from_bits(1023_u64.wrapping_sub(power) << 52);
        let r2 = r * r;
        let even = 1.0 + r2 * (5.0 / 44.0 + r2 * (1.0 / 792.0 + r2 * (1.0 / 665_280.0)));
        let odd = r * (0.5 + r2 * (1.0 / 66.0 + r2 * (1.0 / 15_840.0)));
        let grown = 2.0 * odd / (even - odd);
        gone[lane] = (1.0 - scale) - scale * grown;
        mean[lane] = gone[lane] * inverse[lane];
    }
    Decay { gone, mean }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        let mut z = 1e-300_f64;
        let mut worst = [0.0_f64; 2];
        while z < 1e6 {
            let exact = -(-z).exp_m1();
            let got = decay(&[z; LANES], &[1.0 / z; LANES]);
            worst[0] = worst[0].max((got.gone[3] - exact).abs());
            worst[1] = worst[1].max((got.mean[0] * z / exact - 1.0).abs());
            z *= if z < 1e-6 { 1.7 } else { 1.003 };
        }
        assert!(worst[0] < 3e-16 && worst[1] < 7e-16, "{worst:?}");
    }
}

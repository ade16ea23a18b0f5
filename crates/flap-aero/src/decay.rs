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

/// Decay factors for `z = pole dS >= 0`, without loss of digits at small `z`.
///
/// ```text
/// 1 - e^(-z) = (1 - 2^-n) - 2^-n (e^r - 1),    r = n ln 2 - z,    |r| <= (ln 2)/2
/// e^r - 1 = 2 O / (E - O)                      the [6/6] Pade approximant, error below 1e-18
/// ```
/// Written without branches or calls: the standard library's `exp_m1` takes lags one by one. The
/// error is below 3e-16, absolute for `gone`, relative for `mean`.
#[inline]
pub(crate) fn decay(z: &Lanes) -> Decay {
    let mut gone = [0.0; LANES];
    let mut mean = [0.0; LANES];
    for lane in 0..LANES {
        // a step of nothing has the limit value, which this number gives too
        let z = if z[lane] > f64::MIN_POSITIVE { z[lane] } else { f64::MIN_POSITIVE };
        let held = if z < GONE { z } else { GONE };
        let rounded = held * LOG2_E + ROUNDER;
        let halvings = rounded - ROUNDER;
        let r = halvings * LN_2 - held;
        let power = rounded.to_bits().wrapping_sub(ROUNDER.to_bits());
        let scale = f64::from_bits(1023_u64.wrapping_sub(power) << 52);
        let r2 = r * r;
        let even = 1.0 + r2 * (5.0 / 44.0 + r2 * (1.0 / 792.0 + r2 * (1.0 / 665_280.0)));
        let odd = r * (0.5 + r2 * (1.0 / 66.0 + r2 * (1.0 / 15_840.0)));
        let grown = 2.0 * odd / (even - odd);
        gone[lane] = (1.0 - scale) - scale * grown;
        mean[lane] = gone[lane] / z;
    }
    Decay { gone, mean }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_standard_library() {
        let mut z = 1e-12_f64;
        let mut worst = [0.0_f64; 2];
        while z < 2000.0 {
            let exact = -(-z).exp_m1();
            let got = decay(&[z; LANES]);
            worst[0] = worst[0].max((got.gone[3] - exact).abs());
            worst[1] = worst[1].max((got.mean[0] * z / exact - 1.0).abs());
            z *= 1.003;
        }
        assert!(worst[0] < 3e-16 && worst[1] < 4e-16, "{worst:?}");
    }

    #[test]
    fn a_step_of_nothing_and_a_step_of_everything() {
        let got = decay(&[0.0, 1e-300, 1e6, f64::MAX]);
        assert_eq!(got.mean.map(f64::to_bits)[..2], [1.0_f64.to_bits(); 2]);
        assert!(got.gone[0] < 1e-300);
        assert_eq!(got.gone.map(f64::to_bits)[2..], [1.0_f64.to_bits(); 2]);
        assert!((got.mean[2] - 1e-6).abs() < 1e-21);
    }
}

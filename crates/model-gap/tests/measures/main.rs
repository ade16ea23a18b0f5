//! Measures of misfit against exact answers.

mod energy_and_noise;
mod harmonics;
mod misfit;
mod sine;

use std::f64::consts::TAU;

/// `sum_n A_n cos(2 pi n f t - phase_n)` sampled from a start time.
fn wave(harmonics: &[(f64, f64)], frequency_hz: f64, time_step_s: f64, count: usize) -> Vec<f64> {
    (0..count)
        .map(|i| {
            let turn = TAU * frequency_hz * time_step_s * i as f64;
            (1..)
                .zip(harmonics)
                .map(|(n, (a, phase))| a * (f64::from(n) * turn - phase).cos())
                .sum()
        })
        .collect()
}

/// Uniform noise of variance 1 from a seed (splitmix64).
fn noise(seed: u64, count: usize) -> Vec<f64> {
    let mut state = seed;
    (0..count)
        .map(|_| {
            state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = state;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            z ^= z >> 31;
            12.0_f64.sqrt() * ((z >> 11) as f64 / (1_u64 << 53) as f64 - 0.5)
        })
        .collect()
}

//! Loads of the hub in the fixed frame from those of every blade's root.

use super::fourier::{Fourier, Pair, harmonic_of};

/// Force and moment of a blade on the rotor centre in its own frame, `f_x f_y f_z m_x m_y m_z`.
pub type Root = [f64; 6];

/// Hub loads by azimuth of blade 1; blade `k` flies `k` parts of the revolution ahead, its roots by its own azimuth.
pub fn hub_loads(fourier: &Fourier, blades: &[&[Root]]) -> Vec<[f64; 6]> {
    let n = fourier.azimuths;
    let step = n / blades.len().max(1);
    (0..n)
        .map(|sample| {
            let mut sum = [0.0; 6];
            for (k, root) in blades.iter().enumerate() {
                let own = (sample + k * step) % n;
                let (sin, cos) = fourier.azimuth(own).sin_cos();
                let load = &root[own];
                for at in [0, 3] {
                    sum[at] += load[at] * cos - load[at + 1] * sin;
                    sum[at + 1] += load[at] * sin + load[at + 1] * cos;
                    sum[at + 2] += load[at + 2];
                }
            }
            sum
        })
        .collect()
}

/// Harmonics of a hub load from 0.
pub fn harmonics(loads: &[[f64; 6]], component: usize, highest: usize) -> Vec<Pair> {
    let samples: Vec<f64> = loads.iter().map(|own| own[component]).collect();
    (0..=highest).map(|n| harmonic_of(&samples, n)).collect()
}

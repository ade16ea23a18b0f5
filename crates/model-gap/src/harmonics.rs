//! Harmonics of records, and the error of the first one.

use crate::{GapError, error};
use nalgebra::{DMatrix, DVector};
use rotor_base::{Harmonic, wrap_degrees};
use std::f64::consts::TAU;

/// A record as mean and harmonics of one frequency, by least squares.
///
/// ```text
/// y(t) ~ mean + sum_n ( c_n cos(2 pi n f t) + s_n sin(2 pi n f t) ),   t = 0 at the first sample
/// ```
/// Least squares, not a Fourier sum: exact for a signal of this form also when the record holds a
/// broken number of cycles or a cycle a broken number of samples.
///
/// Not modelled: drift. A creeping mean leaks into the harmonics of a record of few cycles.
#[derive(Debug, Clone, PartialEq)]
pub struct HarmonicFit {
    /// The fundamental frequency, Hz.
    pub frequency_hz: f64,
    /// Mean, in the record's unit.
    pub mean: f64,
    /// Harmonics 1, 2, 3..., in the record's unit.
    pub harmonics: Vec<Harmonic>,
}

/// Least distance of the highest harmonic from its own alias, in units of the resolution.
const CLOSEST_ALIAS: f64 = 0.05;

impl HarmonicFit {
    /// Fits `count` harmonics of `frequency_hz` to a record.
    ///
    /// | argument | unit | range |
    /// |---|---|---|
    /// | `time_step_s` | s | > 0 |
    /// | `frequency_hz` | Hz | > 0, harmonics below half the sampling rate |
    /// | `count` | - | >= 1 |
    ///
    /// # Errors
    /// [`GapError::TooFewCycles`] below one cycle, [`GapError::AboveNyquist`],
    /// [`GapError::NotSeparable`] if the highest comes too close to half the sampling rate for the
    /// length of the record, and what makes no record.
    pub fn of(
        samples: &[f64],
        time_step_s: f64,
        frequency_hz: f64,
        count: usize,
    ) -> Result<Self, GapError> {
        error::check_positive("time step (s)", time_step_s)?;
        error::check_positive("fundamental frequency (Hz)", frequency_hz)?;
        error::check_positive("number of harmonics", count as f64)?;
        error::check_record("record", samples, 2)?;
        let nyquist_hz = 0.5 / time_step_s;
        let at = |harmonic: usize| harmonic as f64 * frequency_hz;
        if let Some(harmonic) = (1..=count).find(|&n| at(n) >= nyquist_hz * (1.0 - 1e-9)) {
            let frequency_hz = at(harmonic);
            return Err(GapError::AboveNyquist { harmonic, frequency_hz, nyquist_hz });
        }
        let duration_s = samples.len() as f64 * time_step_s;
        let cycles = duration_s * frequency_hz;
        if cycles < 1.0 - 1e-9 {
            return Err(GapError::TooFewCycles { what: "a fit of harmonics", cycles, needed: 1 });
        }
        let not_separable =
            || GapError::NotSeparable { harmonics: count, cycles, samples: samples.len() };
        let alias_distance_hz = 2.0 * (nyquist_hz - at(count));
        if alias_distance_hz * duration_s < CLOSEST_ALIAS {
            return Err(not_separable());
        }
        let size = 2 * count + 1;
        let mut normal = DMatrix::zeros(size, size);
        let mut right = DVector::zeros(size);
        let mut row = vec![0.0; size];
        for (i, &value) in samples.iter().enumerate() {
            basis(TAU * (frequency_hz * time_step_s * i as f64).fract(), &mut row);
            for a in 0..size {
                right[a] += row[a] * value;
                for b in 0..=a {
                    normal[(a, b)] += row[a] * row[b];
                }
            }
        }
        let cholesky = normal.cholesky().ok_or_else(not_separable)?;
        let found = cholesky.solve(&right);
        let harmonics = found.as_slice()[1..]
            .chunks_exact(2)
            .map(|pair| Harmonic { cosine: pair[0], sine: pair[1] })
            .collect();
        Ok(Self { frequency_hz, mean: found[0], harmonics })
    }

    /// The first harmonic.
    pub fn fundamental(&self) -> Harmonic {
        self.harmonics.first().copied().unwrap_or_default()
    }
}

/// `1, cos a, sin a, cos 2a, sin 2a, ...`
fn basis(angle_rad: f64, row: &mut [f64]) {
    row[0] = 1.0;
    let (sin1, cos1) = angle_rad.sin_cos();
    let (mut sin_n, mut cos_n) = (sin1, cos1);
    for pair in row[1..].chunks_exact_mut(2) {
        (pair[0], pair[1]) = (cos_n, sin_n);
        (cos_n, sin_n) = (cos_n * cos1 - sin_n * sin1, sin_n * cos1 + cos_n * sin1);
    }
}

/// Amplitude and phase of the simulated first harmonic against the measured one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FirstHarmonicError {
    /// Simulated over measured amplitude.
    pub amplitude_ratio: f64,
    /// How much later the simulation is, degrees of phase in (-180, 180].
    pub phase_error_deg: f64,
    /// The measured first harmonic, in the output's unit.
    pub measured: Harmonic,
    /// The simulated first harmonic, in the output's unit.
    pub simulated: Harmonic,
}

impl FirstHarmonicError {
    /// Compares the components of two records at one frequency (Hz); time step in s.
    ///
    /// Both are fitted with up to three harmonics, as the sampling allows, so that a distorted
    /// wave in a broken number of cycles does not leak into the first.
    ///
    /// # Errors
    /// As [`HarmonicFit::of`], [`GapError::Length`], and [`GapError::Constant`] if the measured record
    /// has no component at that frequency.
    pub fn of(
        measured: &[f64],
        simulated: &[f64],
        time_step_s: f64,
        frequency_hz: f64,
    ) -> Result<Self, GapError> {
        error::check_pair(measured, simulated, 2)?;
        let count = harmonics_below_nyquist(time_step_s, frequency_hz, 3);
        let fit = |samples: &[f64]| HarmonicFit::of(samples, time_step_s, frequency_hz, count);
        let (measured, simulated) = (fit(measured)?.fundamental(), fit(simulated)?.fundamental());
        if measured.amplitude() == 0.0 {
            let what = format!("the measured output at {frequency_hz} Hz");
            return Err(GapError::Constant { what, value: 0.0 });
        }
        Ok(Self {
            amplitude_ratio: simulated.amplitude() / measured.amplitude(),
            phase_error_deg: wrap_degrees(simulated.phase_deg() - measured.phase_deg()),
            measured,
            simulated,
        })
    }
}

/// The largest count up to `wanted` whose harmonics lie below half the sampling rate, at least 1.
fn harmonics_below_nyquist(time_step_s: f64, frequency_hz: f64, wanted: usize) -> usize {
    (1..=wanted)
        .rev()
        .find(|&n| n as f64 * frequency_hz < 0.5 / time_step_s * (1.0 - 1e-9))
        .unwrap_or(1)
}

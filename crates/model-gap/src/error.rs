//! What can be wrong with the numbers handed in.

/// Rejected input of this crate.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GapError {
    /// NaN or infinity in a record.
    #[error(
        "{what}: sample {index} (from 0) is {value}, expected a finite number; cut or mend the record"
    )]
    NotFinite {
        /// Name of the signal.
        what: String,
        /// Position in the record.
        index: usize,
        /// The value found.
        value: f64,
    },
    /// Two records that belong together differ in length.
    #[error("{what}: found {found} samples, expected {expected}")]
    Length {
        /// Name of the signal.
        what: String,
        /// Samples found.
        found: usize,
        /// Samples expected.
        expected: usize,
    },
    /// A record too short for what is asked of it.
    #[error("{what}: {samples} samples, at least {needed} are needed")]
    TooShort {
        /// Name of the signal.
        what: String,
        /// Samples found.
        samples: usize,
        /// Samples needed.
        needed: usize,
    },
    /// A signal without variation, against which nothing can be normalised.
    #[error("{what} is {value} throughout: an error relative to its variation is not defined")]
    Constant {
        /// Name of the signal.
        what: String,
        /// Its one value.
        value: f64,
    },
    /// Too few cycles of a periodic signal.
    #[error("{what}: {cycles:.3} cycles, at least {needed} are needed; record longer")]
    TooFewCycles {
        /// What the cycles are needed for.
        what: &'static str,
        /// Cycles in the record.
        cycles: f64,
        /// Cycles needed.
        needed: usize,
    },
    /// A number outside its range.
    #[error("{what} is {value}, expected {expected}")]
    OutOfRange {
        /// Name of the quantity, with its unit.
        what: &'static str,
        /// The value found.
        value: f64,
        /// The range expected.
        expected: &'static str,
    },
    /// A harmonic that the sampling cannot carry.
    #[error(
        "harmonic {harmonic} lies at {frequency_hz} Hz, not below half the sampling rate ({nyquist_hz} Hz); \
         ask for fewer harmonics"
    )]
    AboveNyquist {
        /// The harmonic.
        harmonic: usize,
        /// Its frequency, Hz.
        frequency_hz: f64,
        /// Half the sampling rate, Hz.
        nyquist_hz: f64,
    },
    /// Sampling and period have no common multiple, so no sample is ever repeated.
    #[error(
        "a cycle of {samples_per_cycle} samples does not repeat on the sampling grid within {tried} cycles; \
         sample at a multiple of the frequency"
    )]
    NoRepeat {
        /// Samples per cycle.
        samples_per_cycle: f64,
        /// Cycles tried.
        tried: usize,
    },
    /// The harmonics cannot be separated in this record.
    #[error(
        "{harmonics} harmonics cannot be separated in {cycles:.3} cycles sampled {samples} times: the \
         highest lies too close to half the sampling rate; ask for fewer harmonics"
    )]
    NotSeparable {
        /// Harmonics asked for.
        harmonics: usize,
        /// Cycles in the record.
        cycles: f64,
        /// Samples in the record.
        samples: usize,
    },
    /// The simulator could not simulate.
    #[error("simulation of {what} failed: {message}")]
    Simulation {
        /// The effects asked for.
        what: String,
        /// The simulator's own words.
        message: String,
    },
    /// A covariance that is none.
    #[error(
        "the information of {columns} nuisance columns is not positive definite: a column holds NaN or is out of scale"
    )]
    NotPositiveDefinite {
        /// Number of columns.
        columns: usize,
    },
}

/// Accepts a record of finite samples, at least `needed`.
pub(crate) fn check_record(what: &str, samples: &[f64], needed: usize) -> Result<(), GapError> {
    if samples.len() < needed {
        return Err(GapError::TooShort { what: what.into(), samples: samples.len(), needed });
    }
    match samples.iter().position(|v| !v.is_finite()) {
        Some(index) => Err(GapError::NotFinite { what: what.into(), index, value: samples[index] }),
        None => Ok(()),
    }
}

/// Accepts a measured and a simulated record of the same length.
pub(crate) fn check_pair(
    measured: &[f64],
    simulated: &[f64],
    needed: usize,
) -> Result<(), GapError> {
    check_record("measured output", measured, needed)?;
    if simulated.len() != measured.len() {
        let (found, expected) = (simulated.len(), measured.len());
        return Err(GapError::Length { what: "simulated output".into(), found, expected });
    }
    check_record("simulated output", simulated, needed)
}

/// Accepts a finite number above zero.
pub(crate) fn check_positive(what: &'static str, value: f64) -> Result<(), GapError> {
    if value.is_finite() && value > 0.0 {
        Ok(())
    } else {
        Err(GapError::OutOfRange { what, value, expected: "a finite number above 0" })
    }
}

//! What the records cannot tell: the summary of identifiability.

use serde::{Deserialize, Serialize};
use std::fmt;

/// What a finding means for the identified model.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Severity {
    /// A remark: the model is what it claims to be.
    Remark,
    /// The model holds, but part of it is a guess: the smoothness filled in what no record shows.
    Limits,
    /// The records are suspect: the model may be wrong.
    Suspect,
}

/// One thing the records cannot tell, or that is wrong with them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Finding {
    /// Only one frequency trains: nothing is known about rate, and a static model is returned.
    OneFrequency {
        /// The frequency, Hz.
        hz: f64,
    },
    /// Several frequencies are there, but none beyond the slow ones can train the rate maps.
    NoRateRecords {
        /// Up to this frequency records trained the static map, Hz.
        slow_hz: f64,
    },
    /// No record is slow: the static map was trained on the slowest there is and holds dynamics.
    NoSlowRecords {
        /// Frequency of the slowest training records, Hz.
        lowest_hz: f64,
        /// Up to this frequency a record counts as slow, Hz.
        limit_hz: f64,
    },
    /// No record was marked or matched for training; the slowest were taken.
    TrainedByDefault {
        /// How many were taken.
        records: usize,
    },
    /// The slow records leave most of the density free: it is not unique.
    DensityNotUnique {
        /// Directions of the density that the records determine.
        determined: usize,
        /// Unknowns of the density.
        unknowns: usize,
    },
    /// All records of the rate maps have one amplitude.
    OneAmplitude {
        /// The amplitude, V.
        amplitude_volt: f64,
    },
    /// The command of a record never changes: the record tells nothing but its noise.
    ConstantCommand {
        /// The record.
        id: String,
    },
    /// The output rests at its extreme while the command moves: the sensor was at its limit.
    ClippedOutput {
        /// The record.
        id: String,
        /// The level, deg.
        level_deg: f64,
        /// Share of the samples at that level, percent.
        share_percent: f64,
    },
    /// A periodic command rests at its extreme: the amplifier was at its limit.
    ClippedCommand {
        /// The record.
        id: String,
        /// The level, V.
        level_volt: f64,
        /// Share of the steady samples at that level, percent.
        share_percent: f64,
    },
    /// Samples of the output stand out from their neighbours while the command does not move: they were
    /// left out, straight lines in their place.
    OutputSpikes {
        /// The record.
        id: String,
        /// Samples left out.
        samples: usize,
        /// First sample of the largest spike.
        index: usize,
        /// Time of it from the first sample, s.
        time_s: f64,
        /// Output recorded there, deg.
        value_deg: f64,
    },
    /// Samples of the command stand out from their neighbours while the output does not move: they were
    /// left out, straight lines in their place.
    CommandSpikes {
        /// The record.
        id: String,
        /// Samples left out.
        samples: usize,
        /// First sample of the largest spike.
        index: usize,
        /// Time of it from the first sample, s.
        time_s: f64,
        /// Command recorded there, V.
        value_volt: f64,
    },
    /// The output leads the command: the columns may have changed places.
    OutputLeads {
        /// The record.
        id: String,
        /// Lead of the output at the strongest harmonic, deg of harmonic phase.
        lead_deg: f64,
    },
    /// The loop is nearly as wide as it is high although the record is slow: not this actuator.
    LoopTooWide {
        /// The record.
        id: String,
        /// Greatest width at the middle of the command over the range of the output, percent.
        width_percent: f64,
    },
    /// Even the records that trained are not described: the data are outside the class of the model.
    NotDescribed {
        /// Root mean square of the NRMSE of the training records, percent.
        nrmse_percent: f64,
    },
}

impl Finding {
    /// What it means for the model.
    pub fn severity(&self) -> Severity {
        match self {
            Self::ConstantCommand { .. }
            | Self::TrainedByDefault { .. }
            | Self::OutputSpikes { .. }
            | Self::CommandSpikes { .. } => Severity::Remark,
            Self::OneFrequency { .. }
            | Self::NoRateRecords { .. }
            | Self::NoSlowRecords { .. }
            | Self::DensityNotUnique { .. }
            | Self::OneAmplitude { .. } => Severity::Limits,
            Self::ClippedOutput { .. }
            | Self::ClippedCommand { .. }
            | Self::OutputLeads { .. }
            | Self::LoopTooWide { .. }
            | Self::NotDescribed { .. } => Severity::Suspect,
        }
    }

    /// What to record or correct.
    pub fn remedy(&self) -> &'static str {
        match self {
            Self::OneFrequency { .. } | Self::NoRateRecords { .. } => {
                "record periodic runs at two or more frequencies, for instance 1 and 10 Hz"
            }
            Self::NoSlowRecords { .. } => {
                "record a slow major loop and reversal curves, or raise quasi_static_hz"
            }
            Self::TrainedByDefault { .. } => "mark the runs that shall train",
            Self::DensityNotUnique { .. } => {
                "record reversal curves, or slow loops of several amplitudes; trust the model on loops like the trained ones only"
            }
            Self::OneAmplitude { .. } => {
                "record the trained frequencies at two or more amplitudes: one hides large errors at others"
            }
            Self::ConstantCommand { .. } => "leave it out, or use it for the noise alone",
            Self::ClippedOutput { .. } => "widen the sensor's range and record again",
            Self::ClippedCommand { .. } => {
                "record the voltage at the actuator's terminals, or keep the amplifier off its limit"
            }
            Self::OutputSpikes { .. } | Self::CommandSpikes { .. } => {
                "look at the samples; check contacts and the recorder"
            }
            Self::OutputLeads { .. } => {
                "exchange the columns, or correct the delay between the channels"
            }
            Self::LoopTooWide { .. } => {
                "check the columns, the sign of the output and the synchronisation of the channels"
            }
            Self::NotDescribed { .. } => {
                "check the sign of the output, which has to rise with the input; otherwise another kind of model is needed: do not use this one"
            }
        }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OneFrequency { hz } => write!(
                f,
                "all training records are at {hz:.3} Hz: nothing is known about rate, the model is static"
            ),
            Self::NoRateRecords { slow_hz } => write!(
                f,
                "no periodic record faster than {slow_hz:.3} Hz trains: nothing is known about rate, the model is static"
            ),
            Self::NoSlowRecords { lowest_hz, limit_hz } => write!(
                f,
                "no training record is slow (up to {limit_hz} Hz): the static map was trained at {lowest_hz:.3} Hz and holds the dynamics of that frequency"
            ),
            Self::TrainedByDefault { records } => {
                write!(f, "no record was marked for training: the {records} slowest were taken")
            }
            Self::DensityNotUnique { determined, unknowns } => write!(
                f,
                "the slow records determine {determined} of {unknowns} numbers of the density: it is not unique"
            ),
            Self::OneAmplitude { amplitude_volt } => {
                write!(f, "the rate records all have an amplitude of {amplitude_volt:.1} V")
            }
            Self::ConstantCommand { id } => write!(f, "record {id}: the command never changes"),
            Self::ClippedOutput { id, level_deg, share_percent } => write!(
                f,
                "record {id}: the output rests at {level_deg:.4} deg for {share_percent:.1} % of the samples while the command moves: it is clipped"
            ),
            Self::ClippedCommand { id, level_volt, share_percent } => write!(
                f,
                "record {id}: the periodic command rests at {level_volt:.2} V for {share_percent:.1} % of the samples: it is clipped"
            ),
            Self::OutputSpikes { id, samples, index, time_s, value_deg } => write!(
                f,
                "record {id}: {samples} samples of the output are spikes and were left out, the largest at sample {index}, {time_s:.4} s: {value_deg:.4} deg"
            ),
            Self::CommandSpikes { id, samples, index, time_s, value_volt } => write!(
                f,
                "record {id}: {samples} samples of the command are spikes and were left out, the largest at sample {index}, {time_s:.4} s: {value_volt:.2} V"
            ),
            Self::OutputLeads { id, lead_deg } => write!(
                f,
                "record {id}: the output leads the command by {lead_deg:.2} deg, which no actuator does"
            ),
            Self::LoopTooWide { id, width_percent } => write!(
                f,
                "record {id}: the slow loop is {width_percent:.0} % as wide as the output's range"
            ),
            Self::NotDescribed { nrmse_percent } => write!(
                f,
                "the model leaves {nrmse_percent:.0} % of the training records unexplained: they are outside its class"
            ),
        }
    }
}

/// What the records can tell and what they cannot.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Identifiability {
    /// What was found, in order of the model's parts.
    pub findings: Vec<Finding>,
    /// Numbers of the static density that the training records determine, of how many.
    pub density_determined: [usize; 2],
    /// Frequencies of the periodic records that train, Hz, ascending, those within 5 % counted once.
    pub trained_hz: Vec<f64>,
}

impl Identifiability {
    /// The most serious severity; none without findings.
    pub fn worst(&self) -> Option<Severity> {
        self.findings.iter().map(Finding::severity).max()
    }
}

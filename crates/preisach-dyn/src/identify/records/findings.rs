//! What the records cannot tell: the summary of identifiability.

use crate::identify::BenchRecord;
use crate::identify::records::noise::RestNoise;
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

/// A column of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Channel {
    /// The command, V.
    Command,
    /// The output, deg.
    Output,
}

impl Channel {
    fn name(self) -> &'static str {
        match self {
            Self::Command => "command",
            Self::Output => "output",
        }
    }
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
    /// The command of a record never changes: the record tells noise, drift and hum, and nothing for a model.
    ConstantCommand {
        /// The record.
        id: String,
        /// What it says of the output.
        noise: RestNoise,
    },
    /// The output falls where the command rises: the sensor may be inverted.
    OutputFalls {
        /// The record.
        id: String,
        /// Slope of the straight line through the record, deg/V.
        slope: f64,
    },
    /// A channel rests at its extreme: the output while the command moves, or a periodic command. The
    /// sensor or the amplifier was at its limit.
    Clipped {
        /// The record.
        id: String,
        /// The channel.
        channel: Channel,
        /// The level, deg or V.
        level: f64,
        /// Share of the samples at that level, of a command the steady ones, percent.
        share_percent: f64,
    },
    /// The record begins when the amplifier is switched on: the actuator came from 0 V.
    SwitchedOn {
        /// The record.
        id: String,
    },
    /// Samples of a channel stand out from their neighbours while the other does not move: they were
    /// left out, straight lines in their place.
    Spikes {
        /// The record.
        id: String,
        /// The channel.
        channel: Channel,
        /// Samples left out.
        samples: usize,
        /// First sample of the largest spike.
        index: usize,
        /// Time of it from the first sample, s.
        time_s: f64,
        /// What was recorded there, deg or V.
        value: f64,
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
    /// Held-out records are far better foretold by another model than by the one chosen.
    BetterHeldOut {
        /// The other model.
        model: String,
        /// Root mean square of its NRMSE of the held-out records, percent.
        nrmse_percent: f64,
        /// The same of the model chosen, percent.
        chosen_percent: f64,
    },
    /// Much of what the model leaves are levels that differ between records: they did not begin at rest with one history.
    LevelsDiffer {
        /// What the model leaves over the noise of repeated cycles.
        noise_times: f64,
        /// Difference of the levels over the largest range of an output, percent.
        level_percent: f64,
    },
}

impl Finding {
    /// What a record whose command never changes tells.
    pub fn of_rest(record: &BenchRecord) -> Self {
        Self::ConstantCommand { id: record.id.clone(), noise: RestNoise::of_record(record) }
    }

    /// What it means for the model.
    pub fn severity(&self) -> Severity {
        self.said(ACTUATOR_UNITS).0
    }

    /// What to record or correct.
    pub fn remedy(&self) -> &'static str {
        self.said(ACTUATOR_UNITS).2
    }

    /// It as a sentence, with symbols of the units of input and output.
    pub(crate) fn sentence(&self, units: [&str; 2]) -> String {
        self.said(units).1
    }

    /// What it means for the model, what was found, and what to record or correct.
    fn said(&self, [input, output]: [&str; 2]) -> (Severity, String, &'static str) {
        match self {
            Self::OneFrequency { hz } => (
                Severity::Limits,
                format!(
                    "all training records are at {hz:.3} Hz: nothing is known about rate, the model is static"
                ),
                TWO_FREQUENCIES,
            ),
            Self::NoRateRecords { slow_hz } => (
                Severity::Limits,
                format!(
                    "no periodic record faster than {slow_hz:.3} Hz trains: nothing is known about rate, the model is static"
                ),
                TWO_FREQUENCIES,
            ),
            Self::NoSlowRecords { lowest_hz, limit_hz } => (
                Severity::Limits,
                format!(
                    "no training record is slow (up to {limit_hz} Hz): the static map was trained at {lowest_hz:.3} Hz and holds the dynamics of that frequency"
                ),
                "record a slow major loop and reversal curves, or raise quasi_static_hz",
            ),
            Self::TrainedByDefault { records } => (
                Severity::Remark,
                format!("no record was marked for training: the {records} slowest were taken"),
                "mark the runs that shall train",
            ),
            Self::DensityNotUnique { determined, unknowns } => (
                Severity::Limits,
                format!(
                    "the slow records determine {determined} of {unknowns} numbers of the density: it is not unique"
                ),
                "record reversal curves, or slow loops of several amplitudes; trust the model on loops like the trained ones only",
            ),
            Self::OneAmplitude { amplitude_volt } => (
                Severity::Limits,
                format!("the rate records all have an amplitude of {amplitude_volt:.1} {input}"),
                "record the trained frequencies at two or more amplitudes: one hides large errors at others",
            ),
            Self::ConstantCommand { id, noise } => (
                Severity::Remark,
                format!("record {id} is at rest: {}", noise.words(output)),
                "it serves for noise, drift and hum; no model is fitted to it or judged by it",
            ),
            Self::OutputFalls { id, slope } => (
                Severity::Suspect,
                format!(
                    "record {id}: the output falls as the command rises, by {:.4} {output}/{input}",
                    slope.abs()
                ),
                "check the sign of the output: of an inverted sensor import it with --scale NAME=-1",
            ),
            Self::Clipped { id, channel, level, share_percent } => {
                let (sentence, remedy) = clipped(*channel, [input, output], *level, *share_percent);
                (Severity::Suspect, format!("record {id}: the {sentence}: it is clipped"), remedy)
            }
            Self::SwitchedOn { id } => (
                Severity::Remark,
                format!(
                    "record {id}: the output jumps while the command has hardly moved: it came up from 0 {input} at the first sample"
                ),
                "begin a record before the amplifier is switched on, or wait until the output rests",
            ),
            Self::Spikes { id, channel, samples, index, time_s, value } => (
                Severity::Remark,
                format!(
                    "record {id}: {samples} samples of the {} are spikes and were left out, the largest at sample {index}, {time_s:.4} s: {}",
                    channel.name(),
                    match channel {
                        Channel::Output => format!("{value:.4} {output}"),
                        Channel::Command => format!("{value:.2} {input}"),
                    }
                ),
                "look at the samples; check contacts and the recorder",
            ),
            Self::OutputLeads { id, lead_deg } => (
                Severity::Suspect,
                format!(
                    "record {id}: the output leads the command by {lead_deg:.2} deg, which no actuator does"
                ),
                "exchange the columns, or correct the delay between the channels",
            ),
            Self::LoopTooWide { id, width_percent } => (
                Severity::Suspect,
                format!(
                    "record {id}: the slow loop is {width_percent:.0} % as wide as the output's range"
                ),
                "check the columns, the sign of the output and the synchronisation of the channels",
            ),
            Self::NotDescribed { nrmse_percent } => not_described(*nrmse_percent),
            Self::BetterHeldOut { model, nrmse_percent, chosen_percent } => {
                better_held_out(model, *nrmse_percent, *chosen_percent)
            }
            Self::LevelsDiffer { noise_times, level_percent } => {
                levels_differ(*noise_times, *level_percent)
            }
        }
    }
}

fn not_described(nrmse_percent: f64) -> (Severity, String, &'static str) {
    (
        Severity::Suspect,
        format!(
            "the model leaves {nrmse_percent:.0} % of the training records unexplained: they are outside its class"
        ),
        "check the sign of the output, which has to rise with the input; otherwise another kind of model is needed: do not use this one",
    )
}

fn better_held_out(
    model: &str,
    nrmse_percent: f64,
    chosen_percent: f64,
) -> (Severity, String, &'static str) {
    (
        Severity::Remark,
        format!(
            "held-out runs, which take no part in the choice, are far better foretold by {model}: NRMSE {nrmse_percent:.2} % rms against {chosen_percent:.2} %"
        ),
        "take that model if they are what it is for, or let more runs train",
    )
}

fn levels_differ(noise_times: f64, level_percent: f64) -> (Severity, String, &'static str) {
    (
        Severity::Limits,
        format!(
            "what the model leaves of the training runs is {noise_times:.0} times their noise, much of it levels that differ between runs by {level_percent:.1} % of the output's range: each run began from another history"
        ),
        "begin every record at rest after the same history, such as cycles that fade, or record the run-up to it too",
    )
}

/// What is said of a clipped channel, and the remedy.
fn clipped(
    channel: Channel,
    [input, output]: [&str; 2],
    level: f64,
    share_percent: f64,
) -> (String, &'static str) {
    let of = format!("{share_percent:.1} % of the samples");
    match channel {
        Channel::Output => (
            format!("output rests at {level:.4} {output} for {of} while the command moves"),
            "widen the sensor's range and record again",
        ),
        Channel::Command => (
            format!("periodic command rests at {level:.2} {input} for {of}"),
            "record the voltage at the actuator's terminals, or keep the amplifier off its limit",
        ),
    }
}

/// Symbols of the units of an actuator's input and output.
pub(crate) const ACTUATOR_UNITS: [&str; 2] = ["V", "deg"];
const TWO_FREQUENCIES: &str =
    "record periodic runs at two or more frequencies, for instance 1 and 10 Hz";

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence(ACTUATOR_UNITS))
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

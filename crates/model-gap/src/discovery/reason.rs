//! Why a verdict is what it is.

use super::TraceRole;

/// Coherence from which on what is left follows the motion.
const DRIVEN: f64 = 0.5;

/// What the causes leave of a channel of an experiment in a band of frequency, where it is more than noise, surrogates
/// and errors of form leave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BandLeft {
    /// Number of the experiment, from 0.
    pub experiment: usize,
    /// What the channel says of a cause.
    pub role: TraceRole,
    /// Where the band begins, Hz.
    pub low_hz: f64,
    /// Where it ends, Hz.
    pub high_hz: f64,
    /// What is left, in amplitude, over what may be.
    pub times: f64,
    /// Share of its energy that follows the channel's own motion with one gain and phase, 0 to 1: what follows it is an
    /// error of the chain, what does not comes from elsewhere.
    pub coherence: f64,
}

/// The one experiment that shows a cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OnlyRun {
    /// Its number, from 0.
    pub experiment: usize,
    /// Whether each of its halves is foretold by the other and all other experiments.
    pub halves_agree: bool,
}

/// A reason of a verdict, with the numbers it rests on.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Reason {
    /// The extended model is worse on held-out runs.
    #[error("the extended model is worse on held-out runs")]
    WorseHeldOut,
    /// The interval of the gain on held-out runs contains zero.
    #[error("the gain on held-out runs may be zero: the name is tentative")]
    GainMayBeZero,
    /// One measured experiment: nothing can be held out.
    #[error(
        "there is one measured run, or one kind of it: no run that was not fitted bears the name out"
    )]
    NothingHeldOut,
    /// One experiment alone shows a cause.
    #[error(
        "one run alone shows {cause}, so that no gain on other runs can be stated; {}",
        if .run.halves_agree { "its two halves foretell each other" }
        else { "its two halves do not foretell each other: repeat it" }
    )]
    OneRunOnly {
        /// The cause.
        cause: &'static str,
        /// The run, and whether its halves agree.
        run: OnlyRun,
    },
    /// The simulation asked about leaves most of what it should describe.
    #[error(
        "this simulation is not of this bench: it leaves {percent:.0} % of the output of runs with nothing missing, which \
         move {scale:.2} times as much as it says; identify the actuator of these data, or see whether every column has \
         the unit of its name"
    )]
    OtherBench {
        /// What it leaves, rms over the spread of the output, percent.
        percent: f64,
        /// Motion of those runs over that simulated.
        scale: f64,
    },
    /// The measured runs move where the reference runs have not been.
    #[error(
        "{:.0} % of the measured samples have an input that no reference run has reached: the base model is stretched \
         there, and nothing is sure; measure reference runs over the whole range",
        .share * 100.0
    )]
    BeyondReference {
        /// Share of the samples.
        share: f64,
    },
    /// A name was dropped, because the base model alone stays within the floor.
    #[error("the misfit of the base model is within the floor: the name is dropped")]
    NameDropped,
    /// Too little of the excess along the generic directions is explained.
    #[error(
        "{:.0} % of the excess is explained; structure is left along the generic directions: \
         chi-square {chi2:.0}, floor {floor:.0}",
        .share * 100.0
    )]
    StructureLeft {
        /// Explained share, 0 to 1.
        share: f64,
        /// Chi-square left along the generic directions.
        chi2: f64,
        /// Its floor.
        floor: f64,
    },
    /// Too little of the misfit above the floor is explained.
    #[error(
        "{:.0} % of the misfit of the base model above its floor is explained: most of it has \
         another cause",
        .share * 100.0
    )]
    MisfitLeft {
        /// Explained share, at most 1.
        share: f64,
    },
    /// Too little of the misfit of the runs that stand out is explained.
    #[error(
        "{:.0} % of the misfit of the runs that stand out is explained: most of it has another \
         cause",
        .share * 100.0
    )]
    MisfitOfRunsLeft {
        /// Explained share, at most 1.
        share: f64,
    },
    /// A cause that looks alike was not tried.
    #[error("{other} looks like {cause} and was not tried: no model with it could be read")]
    NotTried {
        /// The cause found.
        cause: &'static str,
        /// The other.
        other: &'static str,
    },
    /// What a cause explains is small beside what nothing explains.
    #[error(
        "{cause} takes {:.0} % as much off the error of the readings as is left of it: the name is tentative",
        .share * 100.0
    )]
    SmallBesideRest {
        /// The cause.
        cause: &'static str,
        /// Mean square that it takes off, over that which is left beyond the noise.
        share: f64,
    },
    /// Runs stand out with the named causes too.
    #[error(
        "{runs} of the runs stand out with the named causes too, the worst by {times:.1} \
         times the residual of the worst surrogate there"
    )]
    RunsStandOut {
        /// Their number.
        runs: usize,
        /// Residual of the worst over that of the worst surrogate there, in amplitude.
        times: f64,
    },
    /// Part of the spectrum stands out with the named causes too.
    #[error(
        "the named causes leave {:.1} times what noise, surrogates and errors of form can leave at {:.3} to {:.3} Hz of \
         one channel{}: {}",
        .worst.times, .worst.low_hz, .worst.high_hz,
        if *.bands > 1 { format!(", and more than that in {} other bands", .bands - 1) } else { String::new() },
        if .worst.coherence > DRIVEN { "it follows the motion" } else { "it does not follow the motion" }
    )]
    BandsLeft {
        /// Number of bands, over all experiments and channels.
        bands: usize,
        /// The one that leaves most.
        worst: BandLeft,
    },
    /// The channels of a point of test show what the causes do not explain.
    #[error(
        "the named causes leave {times:.1} times what noise, surrogates and errors of form can leave across the channels of one \
         point{}",
        if *.others > 0 { format!(", and more than that {others} times besides") } else { String::new() }
    )]
    ChannelsLeft {
        /// What is left, in amplitude, over what may be.
        times: f64,
        /// How often it is more elsewhere.
        others: usize,
    },
    /// Points of test could be explained by an instrument that is further off than it is said to be.
    #[error(
        "beside the named causes a gain or a smooth error would have to be {times:.1} times its stated accuracy: check the \
         calibration, or state a larger error"
    )]
    InstrumentOff {
        /// By how many standard deviations.
        times: f64,
    },
    /// A signal that fixes a parameter was not measured.
    #[error("the name is tentative: {signal} was not measured")]
    NotMeasured {
        /// The signal.
        signal: &'static str,
    },
    /// Another cause is not excluded with certainty.
    #[error(
        "{other} in the place of {cause} is {} excluded: its chi-square is higher by \
         {delta_chi2:.0}, the discrimination threshold is {threshold:.0}",
        if *.is_open { "not" } else { "barely" }
    )]
    NotExcluded {
        /// The cause found.
        cause: &'static str,
        /// The other.
        other: &'static str,
        /// Whether it lies below the threshold, not close above it.
        is_open: bool,
        /// Its chi-square above that of the cause found.
        delta_chi2: f64,
        /// Difference from which on the two are distinguished.
        threshold: f64,
    },
    /// No parameter of a cause is determined.
    #[error("no parameter of {cause} is determined: the name is tentative")]
    Undetermined {
        /// The cause.
        cause: &'static str,
    },
    /// The interval of a parameter reaches an end of its range.
    #[error(
        "{parameter} of {cause} is not determined: its interval reaches an end of its range, \
         the name is tentative"
    )]
    OpenEnded {
        /// The cause.
        cause: &'static str,
        /// The parameter.
        parameter: &'static str,
    },
    /// A parameter lies at an end of its range.
    #[error("{parameter} of {cause} lies at an end of its range, {value:.3e} {unit}")]
    AtBound {
        /// The cause.
        cause: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Its value.
        value: f64,
        /// Unit of the value.
        unit: &'static str,
    },
    /// A parameter differs from run to run.
    #[error(
        "{parameter} of {cause} drifts by {:.0} % from run to run: the name may be wrong",
        .spread * 100.0
    )]
    Drifts {
        /// The cause.
        cause: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Its relative spread over the runs.
        spread: f64,
    },
    /// No known cause explains what is left along the generic directions.
    #[error(
        "no known cause explains the structure that is left: chi-square {chi2:.0}, floor \
         {floor:.0}"
    )]
    NoKnownCause {
        /// Chi-square left along them.
        chi2: f64,
        /// Its floor.
        floor: f64,
    },
    /// The output changes slowly in all runs alike.
    #[error(
        "the output changes slowly in all runs alike, and no known cause explains it: \
         chi-square {chi2:.0} along the slow trends, floor {floor:.0}"
    )]
    ChangesSlowly {
        /// Chi-square along the slow trends.
        chi2: f64,
        /// Its floor.
        floor: f64,
    },
    /// Some runs are missed by more than any surrogate is.
    #[error(
        "{runs} of the runs are missed by more than any surrogate is: the missing effect \
         differs from run to run"
    )]
    RunsMissed {
        /// Their number.
        runs: usize,
    },
    /// The best candidate explains a few runs only.
    #[error("it explains a few runs only, and no cause acts in a few runs only")]
    FewRuns,
    /// No cause of usual strength would be visible.
    #[error("no cause of usual strength would be visible in these data")]
    NothingVisible,
    /// The causes were asked for, and no other was looked at.
    #[error("the causes were taken for true: no other was tried in their place")]
    TakenForTrue,
    /// A calibration is off by more than its accuracy.
    #[error(
        "gain or zero of a channel is off by {times:.1} times its accuracy between the reference and the measured \
         runs: calibrate, or repeat the reference runs"
    )]
    CalibrationOff {
        /// By how many standard deviations.
        times: f64,
    },
    /// A common cause of a size that matters could have been missed.
    #[error(
        "nothing was seen, but these would have been missed at {}: {}",
        .share.map_or_else(
            || "the amount stated".to_owned(),
            |share| format!("{:.0} % of the output", share * 100.0)
        ),
        .causes.join(", ")
    )]
    WouldBeMissed {
        /// The size, over the output; none where every cause has its own.
        share: Option<f64>,
        /// The causes.
        causes: Vec<&'static str>,
    },
    /// A further cause is not added.
    #[error("{cause} is not added to the causes found before: {why}")]
    NotAdded {
        /// The cause.
        cause: &'static str,
        /// Why not.
        why: Box<Reason>,
    },
    /// A further cause shows too little on the outputs.
    #[error(
        "it lowers the chi-square of the outputs by {drop:.0}, and errors of form of those \
         causes can leave {needed:.0}"
    )]
    HardlyShown {
        /// Drop of their chi-square by it.
        drop: f64,
        /// What errors of form of the causes before can leave.
        needed: f64,
    },
    /// A candidate explains no more than surrogates with nothing missing reach.
    #[error(
        "{cause} explains most: it lowers chi-square by {drop:.0} within the chain. \
         Surrogates with nothing missing reach {threshold:.0}"
    )]
    WithinSurrogates {
        /// The candidate.
        cause: &'static str,
        /// Drop of chi-square by it, within the chain.
        drop: f64,
        /// What surrogates reach.
        threshold: f64,
    },
    /// A candidate hardly changes the error of the outputs.
    #[error(
        "{cause} hardly changes the outputs: it would take {drop:.1e} off the mean square of their error, and {needed:.1e} \
         is the base model's own"
    )]
    Negligible {
        /// The candidate.
        cause: &'static str,
        /// What it would take off, in the square of the output's unit.
        drop: f64,
        /// What it must.
        needed: f64,
    },
    /// Too little of the drop of a candidate shows on held-out runs.
    #[error(
        "{cause} lowers chi-square by {drop:.0} where it is fitted, but by {held_out:.0} on \
         held-out runs; {needed:.0} are required"
    )]
    LostHeldOut {
        /// The candidate.
        cause: &'static str,
        /// Drop of chi-square where it is fitted.
        drop: f64,
        /// What surrogates reach.
        threshold: f64,
        /// Drop on held-out runs.
        held_out: f64,
        /// Drop required there.
        needed: f64,
    },
    /// The missing effect resembles a candidate that cannot be named.
    #[error("the missing effect resembles {cause} most, but {why}")]
    Resembles {
        /// The candidate.
        cause: &'static str,
        /// Why it is not named.
        why: Box<Reason>,
    },
    /// A measurement of its agent refutes a cause: the words of the caller.
    #[error("{0}")]
    Refuted(String),
    /// A candidate is a decoy.
    #[error("this is no cause of the library; it would be {what}")]
    Decoy {
        /// What it would be.
        what: &'static str,
    },
    /// The intermediate channels do not show the effect of a cause.
    #[error(
        "the intermediate channels show {:.0} % of its effect, {:.0} % at most",
        .part * 100.0, .most * 100.0
    )]
    Contradicted {
        /// Part of the effect that they show.
        part: f64,
        /// Largest part within the errors.
        most: f64,
    },
    /// Gain or zero of the reading changes from run to run with the time of the session.
    #[error(
        "{} changes with {}, from {first_percent:+.1} to {last_percent:+.1} %{}: a sensor or an amplifier that drifts, or \
         warmth; repeat the first run at the end",
        if *.is_gain { "the gain of the reading" } else { "the zero of the reading" },
        if *.is_stated { "the time of the session" } else { "the order of the runs" },
        if *.is_gain { "" } else { " of the spread of the output" },
    )]
    ChangesOverSession {
        /// Whether it is the gain, else the zero.
        is_gain: bool,
        /// At the first run, percent.
        first_percent: f64,
        /// At the last run, percent.
        last_percent: f64,
        /// Whether the data say when every run began; else the runs are taken in their order.
        is_stated: bool,
    },
    /// The reading of a run is noisier than that of the reference runs.
    #[error(
        "the reading of run {run} has {times:.1} times the noise of the reference runs: look \
         at sensor and amplifier"
    )]
    Noisier {
        /// The run.
        run: String,
        /// Its noise over theirs.
        times: f64,
    },
}

impl Reason {
    /// The reason in words of points of test, which have neither frequencies nor reference runs.
    pub(crate) fn of_points(self) -> Self {
        match self {
            Self::BandsLeft { bands, worst } => {
                Self::ChannelsLeft { times: worst.times, others: bands.saturating_sub(1) }
            }
            Self::CalibrationOff { times } => Self::InstrumentOff { times },
            Self::NotAdded { cause, why } => {
                Self::NotAdded { cause, why: Box::new(why.of_points()) }
            }
            Self::Resembles { cause, why } => {
                Self::Resembles { cause, why: Box::new(why.of_points()) }
            }
            other => other,
        }
    }
}

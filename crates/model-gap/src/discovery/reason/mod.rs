//! Why a verdict is what it is. The words are in `text`.

mod text;

/// A reason of a verdict, with the numbers it rests on.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Reason {
    /// The extended model is worse on held-out runs.
    WorseHeldOut,
    /// The interval of the gain on held-out runs contains zero.
    GainMayBeZero,
    /// A name was dropped, because the base model alone stays within the floor.
    NameDropped,
    /// Too little of the excess along the generic directions is explained.
    StructureLeft {
        /// Explained share, 0 to 1.
        share: f64,
        /// Chi-square left along the generic directions.
        chi2: f64,
        /// Its floor.
        floor: f64,
    },
    /// Too little of the misfit above the floor is explained.
    MisfitLeft {
        /// Explained share, at most 1.
        share: f64,
    },
    /// Too little of the misfit of the runs that stand out is explained.
    MisfitOfRunsLeft {
        /// Explained share, at most 1.
        share: f64,
    },
    /// Runs stand out with the named causes too.
    RunsStandOut {
        /// Their number.
        runs: usize,
        /// Residual of the worst over that of the worst surrogate there, in amplitude.
        times: f64,
    },
    /// A signal that fixes a parameter was not measured.
    NotMeasured {
        /// The signal.
        signal: &'static str,
    },
    /// Another cause is not excluded with certainty.
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
    Undetermined {
        /// The cause.
        cause: &'static str,
    },
    /// The interval of a parameter reaches an end of its range.
    OpenEnded {
        /// The cause.
        cause: &'static str,
        /// The parameter.
        parameter: &'static str,
    },
    /// A parameter lies at an end of its range.
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
    Drifts {
        /// The cause.
        cause: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Its relative spread over the runs.
        spread: f64,
    },
    /// No known cause explains what is left along the generic directions.
    NoKnownCause {
        /// Chi-square left along them.
        chi2: f64,
        /// Its floor.
        floor: f64,
    },
    /// The output changes slowly in all runs alike.
    ChangesSlowly {
        /// Chi-square along the slow trends.
        chi2: f64,
        /// Its floor.
        floor: f64,
    },
    /// Some runs are missed by more than any surrogate is.
    RunsMissed {
        /// Their number.
        runs: usize,
    },
    /// The best candidate explains a few runs only.
    FewRuns,
    /// No cause of usual strength would be visible.
    NothingVisible,
    /// A further cause is not added.
    NotAdded {
        /// The cause.
        cause: &'static str,
        /// Why not.
        why: Box<Reason>,
    },
    /// A further cause shows too little on the outputs.
    HardlyShown {
        /// Drop of their chi-square by it.
        drop: f64,
        /// What errors of form of the causes before can leave.
        needed: f64,
    },
    /// A candidate explains no more than surrogates with nothing missing reach.
    WithinSurrogates {
        /// The candidate.
        cause: &'static str,
        /// Drop of chi-square by it, within the chain.
        drop: f64,
        /// What surrogates reach.
        threshold: f64,
    },
    /// Too little of the drop of a candidate shows on held-out runs.
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
    Resembles {
        /// The candidate.
        cause: &'static str,
        /// Why it is not named.
        why: Box<Reason>,
    },
    /// A measurement of its agent refutes a cause: the words of the caller.
    Refuted(String),
    /// A candidate is a decoy.
    Decoy {
        /// What it would be.
        what: &'static str,
    },
    /// The intermediate channels do not show the effect of a cause.
    Contradicted {
        /// Part of the effect that they show.
        part: f64,
        /// Largest part within the errors.
        most: f64,
    },
    /// The reading of a run is noisier than that of the reference runs.
    Noisier {
        /// The run.
        run: String,
        /// Its noise over theirs.
        times: f64,
    },
}

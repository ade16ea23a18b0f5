//! The errors of this crate.

use crate::{StageError, VoltageRange};
use std::borrow::Cow;

/// What can go wrong with an actuator model, its simulation or its identification.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PreisachError {
    // ---- rejected input ----
    /// A quantity lies outside the values it may have.
    #[error("{quantity} is {value}, expected {expected}")]
    OutOfRange {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// What it may be.
        expected: Cow<'static, str>,
    },
    /// A parameter of a stage of an actuator is refused.
    #[error("{list}[{index}] ({stage}): {source}")]
    Stage {
        /// List of the stage: `amplifier`, `linkage` or `sensor`.
        list: &'static str,
        /// Place in the list, from 0.
        index: usize,
        /// Name of the stage.
        stage: &'static str,
        /// The parameter, its value and what it may be.
        source: Box<PreisachError>,
    },
    /// A parameter of a stage alone, without its place in an actuator.
    #[error(transparent)]
    StageParameter(#[from] StageError),
    /// A number is NaN or infinite.
    #[error("{quantity} at index {index} is {value}, expected a finite number")]
    NotFinite {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// Place in the array handed over (0 for a single number).
        index: usize,
        /// The value found.
        value: f64,
    },
    /// A table of node values does not have the triangular shape its grid asks for.
    #[error("{map}: play {play} has {found} nodes, a grid of {levels} levels needs {expected}")]
    NodeCount {
        /// Which of the three maps.
        map: &'static str,
        /// Index of the play, 0 being the reversible part.
        play: usize,
        /// Nodes found.
        found: usize,
        /// Nodes needed.
        expected: usize,
        /// Levels of the grid.
        levels: usize,
    },
    /// A memory was made by another law, or is no memory at all.
    #[error("the memory does not belong to the law {expected}; start a memory from this model")]
    MemoryOfAnotherLaw {
        /// The law of the model.
        expected: &'static str,
    },
    /// A memory was made for another grid, other plays or another chain of stages.
    #[error(
        "the memory's {part} are not those of the model ({found} against {expected}, or of other kinds); start a memory from this model"
    )]
    MemoryMismatch {
        /// What differs: the plays, or a part of the chain.
        part: &'static str,
        /// How many the memory has.
        found: usize,
        /// How many the model has.
        expected: usize,
    },
    /// Loads were given to an actuator that has nothing to feel them.
    #[error("loads are given, but the linkage has no LoadStiffness stage; add one")]
    NoLoadStage,
    /// A sampled voltage leaves the actuator's range.
    #[error("sample {index}: {voltage_volt} V is outside the actuator's range of {range}")]
    VoltageOutOfRange {
        /// Index of the sample.
        index: usize,
        /// The voltage, V.
        voltage_volt: f64,
        /// The range.
        range: VoltageRange,
    },
    /// A periodic command leaves the actuator's range.
    #[error(
        "the command reaches {voltage_volt} V at azimuth {azimuth_deg} deg, outside the actuator's range of {range}; lower the harmonics or move the bias"
    )]
    CommandOutOfRange {
        /// Azimuth of the largest excess, deg.
        azimuth_deg: f64,
        /// The voltage there, V.
        voltage_volt: f64,
        /// The range.
        range: VoltageRange,
    },
    /// Values from the base crate were refused.
    #[error(transparent)]
    Base(#[from] rotor_base::BaseError),

    // ---- records that cannot be used ----
    /// A record, a window of it or a reversal curve cannot be used.
    #[error("{record}, sample {index}: {problem} ({value})")]
    BadRecord {
        /// The record or the curve.
        record: String,
        /// Index of the sample.
        index: usize,
        /// What is wrong with it.
        problem: &'static str,
        /// The value found.
        value: f64,
    },
    /// The commands cannot be in volt.
    #[error(
        "the commands span {found_volt} V, the declared range {declared_volt} V: they look like {likely}; convert the column to volt or correct the declared range"
    )]
    UnitMismatch {
        /// Largest span of a command as read, V.
        found_volt: f64,
        /// Span of the declared range, V.
        declared_volt: f64,
        /// The unit they look like.
        likely: &'static str,
    },
    /// Command and output of a record have changed places.
    #[error(
        "record {id}: the command column spans {command_volt} V and leaves the declared range, the output column spans {output_um} um and looks like the command; exchange the columns"
    )]
    SwappedColumns {
        /// The record.
        id: String,
        /// Span of the command column, V.
        command_volt: f64,
        /// Span of the output column, um.
        output_um: f64,
    },
    /// No record can train a part of the model.
    #[error("no training record for {part}; {remedy}")]
    NoTrainingRecord {
        /// The part of the model.
        part: &'static str,
        /// What to record or mark for training.
        remedy: &'static str,
    },

    /// The records are outside the class of the model.
    #[error(
        "the model leaves {nrmse_percent:.0} % of the training records unexplained: no actuator of this kind; check the sign of the displacement, which has to rise with the voltage, and the columns"
    )]
    NotDescribed {
        /// Root mean square of the NRMSE of the training records, percent.
        nrmse_percent: f64,
    },

    /// Stops fitted to an output that lags its input.
    #[error(
        "the output lags the input: its loops enclose {:.1} % of their frame, anticlockwise; stops lead, so they have nothing to fit",
        -100.0 * area_share
    )]
    OutputLags {
        /// `integral y du` over half the output's range and the travel of the input; negative: the
        /// output lags.
        area_share: f64,
    },

    // ---- inverse ----
    /// A periodic motion needs more voltage than there is.
    #[error(
        "a flap motion of {wanted_deg:.4} deg (half peak to peak) at {rev_hz} rev/s is out of reach: harmonic {harmonic} takes most of the voltage, which reaches {voltage_volt:.2} V at azimuth {azimuth_deg:.1} deg, outside {range}; about {reachable_deg:.4} deg of the same shape can be reached"
    )]
    MotionOutOfReach {
        /// Half peak to peak of the wanted motion, deg.
        wanted_deg: f64,
        /// Half peak to peak of the largest motion of this shape that was found, deg.
        reachable_deg: f64,
        /// The harmonic that takes the largest voltage.
        harmonic: usize,
        /// Revolutions per second.
        rev_hz: f64,
        /// Azimuth at which the voltage leaves the range, deg.
        azimuth_deg: f64,
        /// The voltage there, V.
        voltage_volt: f64,
        /// The range.
        range: VoltageRange,
    },
    /// Newton's method for a periodic voltage stopped.
    #[error(
        "the periodic inverse stopped after {iterations} Newton steps with {residual_deg:e} deg left at {share} of the wanted motion; raise tolerance_deg or try other voltage_harmonics: fewer for corners of the law, more behind a joint that sticks"
    )]
    InverseNotConverged {
        /// Newton steps done at the last amplitude.
        iterations: usize,
        /// Largest error of a coefficient, deg.
        residual_deg: f64,
        /// Share of the wanted motion that was solved.
        share: f64,
    },

    // ---- numerical failure ----
    /// The output became infinite or NaN: the model has left its domain.
    #[error(
        "the output diverged at sample {index} (last finite output {last_output_deg} deg, {bad_steps} steps with G1 >= 0 or a fold before); the Literal form is not well posed there, use WellPosed"
    )]
    Diverged {
        /// Index of the first sample that is not finite.
        index: usize,
        /// Last finite output, deg.
        last_output_deg: f64,
        /// Steps before it with G1 >= 0 or a negative discriminant.
        bad_steps: usize,
    },
    /// The orbit did not close.
    #[error(
        "the orbit has not closed after {revolutions} revolutions: it still moves by {closure_deg:e} deg per revolution, allowed {allowed_deg:e} deg; allow more revolutions"
    )]
    OrbitNotClosed {
        /// Revolutions marched.
        revolutions: usize,
        /// Largest change over the last revolution, deg.
        closure_deg: f64,
        /// Allowed change, deg.
        allowed_deg: f64,
    },
    /// No start of a fit led to a model.
    #[error(
        "{family}: no start of the fit gave a model of the family; check the sign of the output and the range of the input"
    )]
    NotFitted {
        /// The family of models.
        family: &'static str,
    },
    /// The quadratic program of an identification stage was not solved.
    #[error(
        "{stage}: the quadratic program ended as {status} after {iterations} iterations with primal residual {primal_residual:e}; check the scaling of the records"
    )]
    QuadraticProgram {
        /// The stage.
        stage: &'static str,
        /// How the solver ended, in its own words; `Refused`: it did not take the problem.
        status: String,
        /// Iterations done.
        iterations: u32,
        /// Primal residual, relative.
        primal_residual: f64,
    },
}

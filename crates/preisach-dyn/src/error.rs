//! The errors of this crate.

use crate::identify::QpStatus;

/// What can go wrong with an actuator model, its simulation or its identification.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PreisachError {
    // ---- rejected input ----
    /// A quantity that must be positive and finite is not.
    #[error("{quantity} is {value}, expected a positive finite number")]
    NotPositive {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// The value found.
        value: f64,
    },
    /// A quantity that must not be negative is, or is not finite.
    #[error("{quantity} is {value}, expected a finite number that is not negative")]
    Negative {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// The value found.
        value: f64,
    },
    /// A quantity lies outside the values it may have.
    #[error("{quantity} is {value}, expected {least} to {most}")]
    OutOfRange {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// Smallest value allowed.
        least: f64,
        /// Largest value allowed.
        most: f64,
    },
    /// A quantity lies below the one it belongs to, or is not finite.
    #[error("{quantity} is {value}, expected a finite number {relation} ({bound})")]
    TooLow {
        /// Name of the quantity, with its unit.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// What it has to be, in terms of the other quantity.
        relation: &'static str,
        /// The same as a number.
        bound: f64,
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
    /// A voltage range is empty or not finite.
    #[error(
        "voltage range {lowest_volt} V to {highest_volt} V is empty or not finite; give the lower limit first"
    )]
    EmptyVoltageRange {
        /// Lower limit, V.
        lowest_volt: f64,
        /// Upper limit, V.
        highest_volt: f64,
    },
    /// A count is too small to mean anything.
    #[error("{quantity} is {value}, expected at least {least}")]
    TooFew {
        /// What was counted.
        quantity: &'static str,
        /// The number found.
        value: usize,
        /// The smallest number that works.
        least: usize,
    },
    /// The number of levels of the rate maps does not divide the number of levels of the memory.
    #[error("rate_levels {rate_levels} does not divide levels {levels}; choose a divisor")]
    LevelsDoNotDivide {
        /// Levels of the rate maps.
        rate_levels: usize,
        /// Levels of the memory.
        levels: usize,
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
    /// The static map falls somewhere, that is, the density mu0 is negative there.
    #[error(
        "static map of play {play} falls by {fall_deg} deg at node {node}: the density mu0 must not be negative"
    )]
    NegativeDensity {
        /// Index of the play.
        play: usize,
        /// Index of the node after which the map falls.
        node: usize,
        /// How much it falls, deg.
        fall_deg: f64,
    },
    /// A well-posed model is asked for, but G1 is not negative in some reachable state.
    #[error(
        "G1 reaches {largest_g1_s} s in a reachable state; a well-posed model needs G1 < 0 everywhere, so raise tau0 or use the Literal form"
    )]
    NotWellPosed {
        /// Largest G1 over all reachable states, s.
        largest_g1_s: f64,
    },
    /// A well-posed model folds below the output rate it claims to cover.
    #[error(
        "2 |G2| d exceeds |G1| by {excess_s} s in a reachable state at the output rate d = {rate_deg_s} deg/s; scale G2 down or lower unfolded_rate_deg_s"
    )]
    FoldsTooEarly {
        /// By how much, s.
        excess_s: f64,
        /// The output rate claimed to be covered, deg/s.
        rate_deg_s: f64,
    },
    /// A stored play state lies outside the Preisach triangle.
    #[error(
        "stored play {play} of {levels} is at {cells} cells, expected 0 to {largest}: the memory was not written by this program"
    )]
    PlayOutsideTriangle {
        /// Index of the play.
        play: usize,
        /// Number of plays.
        levels: usize,
        /// Its state, cells.
        cells: f64,
        /// Largest state it can have, cells.
        largest: usize,
    },
    /// A memory was made for another grid.
    #[error("the memory has {found} plays, the model {expected}; start a memory from this model")]
    MemoryMismatch {
        /// Plays in the memory.
        found: usize,
        /// Plays in the model.
        expected: usize,
    },
    /// A memory was made by another law, or is no memory at all.
    #[error("the memory does not belong to the law {expected}; start a memory from this model")]
    MemoryOfAnotherLaw {
        /// The law of the model.
        expected: &'static str,
    },
    /// A memory was made for another chain of stages.
    #[error(
        "the memory's {part} stages are not those of the model ({found} against {expected}, or of other kinds); start a memory from this model"
    )]
    StageMismatch {
        /// The part of the chain.
        part: &'static str,
        /// Stages in the memory.
        found: usize,
        /// Stages in the model.
        expected: usize,
    },
    /// An output curve falls somewhere.
    #[error("the output curve falls: its least slope is {least_slope}; lower quadratic or cubic")]
    EnvelopeFalls {
        /// Least slope, that of the straight line being 1.
        least_slope: f64,
    },
    /// A Bouc-Wen loop would give energy back.
    #[error(
        "sigma = {sigma} with exponent {exponent} is not dissipative: expected sigma >= 1/2 and an exponent of 1 to 10"
    )]
    NotDissipative {
        /// Shape found.
        sigma: f64,
        /// Exponent found.
        exponent: f64,
    },
    /// A Bouc-Wen output would fall with a rising voltage.
    #[error(
        "the loop is as steep as {steepest_deg_per_volt} deg/V, the gain only {gain_deg_per_volt} deg/V: the output would fall while the voltage rises; raise rise_volt or lower half_height_deg"
    )]
    OutputFalls {
        /// Steepest change of the hysteretic part, deg/V.
        steepest_deg_per_volt: f64,
        /// Gain, deg/V.
        gain_deg_per_volt: f64,
    },
    /// Loads were given to an actuator that has nothing to feel them.
    #[error("loads are given, but the linkage has no LoadStiffness stage; add one")]
    NoLoadStage,
    /// Two histories that belong together differ in length.
    #[error("{voltages} voltages but {loads} loads; give one load for every voltage")]
    UnequalLoads {
        /// Number of voltages.
        voltages: usize,
        /// Number of loads.
        loads: usize,
    },
    /// A sampled voltage leaves the actuator's range.
    #[error(
        "sample {index}: {voltage_volt} V is outside the actuator's range of {lowest_volt} V to {highest_volt} V"
    )]
    VoltageOutOfRange {
        /// Index of the sample.
        index: usize,
        /// The voltage, V.
        voltage_volt: f64,
        /// Lower limit, V.
        lowest_volt: f64,
        /// Upper limit, V.
        highest_volt: f64,
    },
    /// A periodic command leaves the actuator's range.
    #[error(
        "the command reaches {voltage_volt} V at azimuth {azimuth_deg} deg, outside the actuator's range of {lowest_volt} V to {highest_volt} V; lower the harmonics or move the bias"
    )]
    CommandOutOfRange {
        /// Azimuth of the largest excess, deg.
        azimuth_deg: f64,
        /// The voltage there, V.
        voltage_volt: f64,
        /// Lower limit, V.
        lowest_volt: f64,
        /// Upper limit, V.
        highest_volt: f64,
    },
    /// Values from the base crate were refused.
    #[error(transparent)]
    Base(#[from] rotor_base::BaseError),

    // ---- records that cannot be used ----
    /// Two columns of a record differ in length.
    #[error("record {id}: {voltages} voltages but {outputs} outputs")]
    UnequalColumns {
        /// The record.
        id: String,
        /// Number of voltages.
        voltages: usize,
        /// Number of outputs.
        outputs: usize,
    },
    /// A value in a record cannot be used.
    #[error("record {id}, sample {index}: {problem} ({value})")]
    BadRecord {
        /// The record.
        id: String,
        /// Index of the sample.
        index: usize,
        /// What is wrong with it.
        problem: &'static str,
        /// The value found.
        value: f64,
    },
    /// A training or judging window does not lie in its record, or is too short.
    #[error(
        "record {id}: the window of samples {start}..{end} does not hold 16 samples of the {samples} there are"
    )]
    BadWindow {
        /// The record.
        id: String,
        /// First sample of the window.
        start: usize,
        /// Sample after the last of the window.
        end: usize,
        /// Samples of the record.
        samples: usize,
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

    // ---- reversal curves ----
    /// A reversal curve cannot be used.
    #[error("reversal curve {curve}, point {index}: {problem} ({value})")]
    ForcCurve {
        /// Place of the curve in the family, from 0.
        curve: usize,
        /// Index of the point.
        index: usize,
        /// What is wrong with it.
        problem: &'static str,
        /// The value found.
        value: f64,
    },
    /// Calibration readings and curves do not go together.
    #[error(
        "{readings} calibration readings for {curves} reversal curves: give one before each curve, or none"
    )]
    ForcCalibration {
        /// Readings found.
        readings: usize,
        /// Curves found.
        curves: usize,
    },

    // ---- inverse ----
    /// A static model cannot reach an output with its next sample.
    #[error(
        "an output of {wanted_deg} deg is wanted, but the next sample can reach {lowest_deg} to {highest_deg} deg only; lower the target or widen the voltage range"
    )]
    OutputOutOfReach {
        /// The output wanted, deg.
        wanted_deg: f64,
        /// Output at the lower end of the range, deg.
        lowest_deg: f64,
        /// Output at the upper end of the range, deg.
        highest_deg: f64,
    },
    /// A periodic motion needs more voltage than there is.
    #[error(
        "a flap motion of {wanted_deg:.4} deg (half peak to peak) at {rev_hz} rev/s is out of reach: harmonic {harmonic} takes most of the voltage, which reaches {voltage_volt:.2} V at azimuth {azimuth_deg:.1} deg, outside {lowest_volt} V to {highest_volt} V; about {reachable_deg:.4} deg of the same shape can be reached"
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
        /// Lower limit, V.
        lowest_volt: f64,
        /// Upper limit, V.
        highest_volt: f64,
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
        "{stage}: the quadratic program ended as {status:?} after {iterations} iterations with primal residual {primal_residual:e}; check the scaling of the records"
    )]
    QuadraticProgram {
        /// The stage.
        stage: &'static str,
        /// How the solver ended.
        status: QpStatus,
        /// Iterations done.
        iterations: u32,
        /// Primal residual, relative.
        primal_residual: f64,
    },
}

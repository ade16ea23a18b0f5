//! What can be wrong with measured records and with the files they are imported from.

/// A fault of a measured record or of its import.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RecordFault {
    // ---- refused ----
    /// A column never changes.
    #[error(
        "every sample is {value} {unit}: nothing can be learnt from a constant {role}; check that the right column was recorded"
    )]
    Constant {
        /// The value.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// `input` or `output`.
        role: &'static str,
    },
    /// The declared unit does not fit the range.
    #[error(
        "reaches {reached} {unit}, {times:.0} times the largest of the range ({low}, {high}) {unit}, and would fit as {likely}: name the column `{column}_{likely}` and convert it with `hhc import`, or multiply it by {factor}"
    )]
    UnitByRange {
        /// Name of the column without unit.
        column: &'static str,
        /// Largest magnitude found.
        reached: f64,
        /// The declared unit.
        unit: &'static str,
        /// Lower limit of the range.
        low: f64,
        /// Upper limit of the range.
        high: f64,
        /// Magnitude over the largest of the range.
        times: f64,
        /// The unit it looks like.
        likely: &'static str,
        /// Factor that converts it.
        factor: f64,
    },
    /// The time column does not increase, but another one increases evenly.
    #[error(
        "does not increase, but `{other}` increases in equal steps: the two columns are swapped; swap their names in the header"
    )]
    TimeSwapped {
        /// The column that looks like the time.
        other: String,
    },
    /// The displacement leads the command.
    #[error(
        "the displacement leads the command by {lead_deg:.1} deg over the record, expected a lag: an actuator at rest does not move before it is driven; command and displacement are swapped, or one has the wrong delay. Swap their names in the header; if it is no actuator, make the data set a GenericLoop"
    )]
    OutputLeads {
        /// Lead of the output, deg of an equivalent sine.
        lead_deg: f64,
    },
    /// A record file is too large to be read whole.
    #[error(
        "has {megabytes} MB, more than the {limit_megabytes} MB read at once; `hhc import FILE -o DIR` streams it and averages it to fewer samples"
    )]
    TooLarge {
        /// Size, MB.
        megabytes: u64,
        /// Limit, MB.
        limit_megabytes: u64,
    },
    /// A data set of another kind is wanted.
    #[error("is {found}, expected {expected}; {remedy}")]
    OtherKind {
        /// The kind found.
        found: &'static str,
        /// The kind wanted.
        expected: &'static str,
        /// What to do.
        remedy: &'static str,
    },
    /// A key of `dataset.ron` that its kind does not have.
    #[error("belongs to kind {belongs}, the data set is {kind}; remove it, or change the kind")]
    KeyOfOtherKind {
        /// The kind that has it.
        belongs: &'static str,
        /// The kind of the data set.
        kind: &'static str,
    },
    /// The window of a run does not lie inside its record.
    #[error(
        "the window ({from_s}, {to_s}) s holds {samples} samples of the record, which runs from {first_s} to {last_s} s; give (t0, t1) with t0 < t1 inside the record and at least {least} samples"
    )]
    Window {
        /// Begin, s.
        from_s: f64,
        /// End, s.
        to_s: f64,
        /// Samples inside.
        samples: usize,
        /// First time of the record, s.
        first_s: f64,
        /// Last time of the record, s.
        last_s: f64,
        /// Fewest samples wanted.
        least: usize,
    },
    /// A column has no unit, or one that is not known.
    #[error("the column `{found}` has no known unit; name it `NAME_UNIT` with a unit of: {known}")]
    UnknownUnit {
        /// The column.
        found: String,
        /// All units.
        known: String,
    },
    /// It is not said which columns are input and output.
    #[error(
        "the columns {columns} leave open which is the input and which the output; say it: {remedy}"
    )]
    AmbiguousColumns {
        /// The columns besides the time.
        columns: String,
        /// How to say it.
        remedy: &'static str,
    },
    /// A column that is asked for is not there.
    #[error("there is no column `{wanted}`, the file has {found}; {remedy}")]
    NoSuchColumn {
        /// The column asked for.
        wanted: String,
        /// The columns there.
        found: String,
        /// What to do.
        remedy: &'static str,
    },
    /// Columns of one name, of which only one can be taken.
    #[error(
        "{count} columns are called `{name}`: say which one is meant by its number, --columns time_s=#1,{name}_UNIT=#2,... (the others are then left out), or rename them in the header"
    )]
    RepeatedName {
        /// The name without unit.
        name: String,
        /// How many columns have it.
        count: usize,
    },
    /// The fields of a record of a data folder are not separated by commas.
    #[error(
        "the fields are separated by {separator}, expected commas; `hhc import FILE -o DIR` reads such tables and writes the record as it should be"
    )]
    OtherSeparator {
        /// What separates them, in words.
        separator: &'static str,
    },
    /// Two runs of a data set have different columns.
    #[error("the columns are {found}, those of the runs before {expected}; convert one of them")]
    OtherColumns {
        /// Columns found.
        found: String,
        /// Columns of the runs before.
        expected: String,
    },
    /// Units that measure different things.
    #[error("{from} cannot be converted into {to}: they measure different things")]
    NoConversion {
        /// The unit given.
        from: &'static str,
        /// The unit wanted.
        to: &'static str,
    },

    // ---- import ----
    /// The kind of source is not recognised.
    #[error("is not recognised as CSV, MAT v5 or a MicroMag FORC file; say what it is with --as")]
    UnknownSource,
    /// MATLAB v7.3 or another HDF5 file.
    #[error(
        "is an HDF5 file (MATLAB's format 7.3), which is not read; in MATLAB: load it and save('file.mat', '-v7', 'your_variable')"
    )]
    Hdf5,
    /// MATLAB v4.
    #[error(
        "is a MATLAB file of format 4, which is not read; in MATLAB: load it and save('file.mat', '-v7')"
    )]
    Mat4,
    /// A damaged or unusual MAT file.
    #[error(
        "damaged MAT file at byte {offset}{}: {what}; save it again with save('file.mat', '-v7')",
        if *.compressed { " of a compressed variable" } else { "" }
    )]
    Mat {
        /// Byte offset, from 0.
        offset: usize,
        /// Whether the offset counts decompressed bytes of a variable.
        compressed: bool,
        /// What is wrong.
        what: &'static str,
    },
    /// A MAT variable that is not there, or of the wrong kind.
    #[error("`{path}` {what}; the file has: {found}; choose one with --variable")]
    MatVariable {
        /// The path asked for.
        path: String,
        /// What is wrong.
        what: &'static str,
        /// The numeric variables there.
        found: String,
    },
    /// The header of a MicroMag file lacks something.
    #[error("the MicroMag header has no line `{key}`; it is no FORC file, or it is damaged")]
    MicroMagHeader {
        /// The key.
        key: &'static str,
    },
    /// A MicroMag file that is not complete.
    #[error(
        "{found} {of}, the header promises {promised}: the file is truncated or damaged; copy it again from the instrument"
    )]
    MicroMagCount {
        /// What is counted.
        of: &'static str,
        /// Found.
        found: usize,
        /// Promised by the header.
        promised: usize,
    },
    /// The description of the columns makes no sense.
    #[error(
        "the entry `{entry}` of --columns is not understood; write NAME_UNIT, NAME_UNIT=SOURCE (a header, a MAT field or #number), or - for a column to leave out"
    )]
    ColumnEntry {
        /// The entry.
        entry: String,
    },
    /// A file without a header whose columns are not named.
    #[error(
        "the {count} columns have no names; name them: --columns time_s,... with units, - for a column to leave out"
    )]
    NoHeader {
        /// Columns of the file.
        count: usize,
    },
    /// Wrong number of columns named.
    #[error("--columns names {named} columns, the file has {found}")]
    ColumnCount {
        /// Named.
        named: usize,
        /// Found.
        found: usize,
    },
    /// There is no time.
    #[error("there is no time column; name one `time_s`, or give --sampling-hz")]
    NoTime,
    /// Sources of different kinds cannot share a data folder.
    #[error("holds {found}, the files before it {expected}; import them into folders of their own")]
    MixedKinds {
        /// Kind of this file.
        found: &'static str,
        /// Kind of the files before.
        expected: &'static str,
    },

    // ---- warnings ----
    /// The id of a run stands for what has a key of its own.
    #[error(
        "the id says how the run was measured; write `{key}` beside it: ids will lose that meaning"
    )]
    MeantById {
        /// The key and its value.
        key: &'static str,
    },
    /// A record was brought onto even steps.
    #[error(
        "the time steps differ by up to {jitter_percent} %; resampled to {step_s} s by straight lines"
    )]
    Resampled {
        /// Largest deviation, percent of the step.
        jitter_percent: f64,
        /// The even step, s.
        step_s: f64,
    },
    /// Long flat tops at the limit of the output.
    #[error(
        "the output stays at its {end} {value} {unit} for {samples} samples while the input moves through {input_percent:.0} % of its range: the record looks clipped; check the range of sensor and amplifier (a wide backlash looks the same)"
    )]
    Clipped {
        /// `largest` or `smallest`.
        end: &'static str,
        /// The limit.
        value: f64,
        /// Its unit.
        unit: &'static str,
        /// Samples of the longest flat top.
        samples: usize,
        /// Movement of the input meanwhile, percent of its range.
        input_percent: f64,
    },
    /// No record comes near the range.
    #[error(
        "no command uses more than {percent:.2} % of command_range_V ({low}, {high}): are the commands in kV, or in V over a divider?"
    )]
    RangeUnused {
        /// Share of the range used, percent.
        percent: f64,
        /// Lower limit, V.
        low: f64,
        /// Upper limit, V.
        high: f64,
    },
    /// Samples at the end that fill no block of an average.
    #[error("{count} samples at the end fill no block of {block} and are left out")]
    Remainder {
        /// Samples left out.
        count: usize,
        /// Samples of a block.
        block: usize,
    },
}

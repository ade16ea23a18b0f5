//! A record of its own, out of any source: nothing is written.

use super::columns::{ColumnOptions, is_free_name};
use super::gather::Reduction;
use super::{Imported, OpenSource, Reading, fault_of_rate};
use crate::files::Source;
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::Channel;
use std::io::Cursor;
use std::path::Path;

/// Part of a step by which another may differ in memory.
const EVEN: f64 = 0.01;

/// An evenly sampled record: a time and columns with units.
#[derive(Debug, Clone, PartialEq)]
pub struct EvenRecord {
    /// Name of the source.
    pub name: String,
    /// Times of the samples, s, in equal steps; three or more.
    pub time_s: Vec<f64>,
    /// Time between two samples, s, above 0.
    pub step_s: f64,
    /// What a reader should know of how it was read.
    pub warnings: Vec<Problem>,
    columns: Vec<(Channel, Vec<f64>)>,
    /// Names of columns without a known unit.
    left_out: Vec<String>,
}

/// A column of a record.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordColumn {
    /// Its own name, without unit.
    pub name: String,
    /// Its own name with its own unit: `u_mV`.
    pub label: String,
    /// Its numbers, in the unit that was asked for.
    pub values: Vec<f64>,
}

impl EvenRecord {
    /// Reads a record as [`import`](super::import) does: text tables of any instrument, packed or not, workbooks, TDMS and MAT
    /// files. `-` is standard input.
    ///
    /// | argument | meaning |
    /// |---|---|
    /// | `options` | `columns`, `scale` and `offset`; the others mean nothing here |
    /// | `sampling_hz` | rate of a source without a time, Hz, above 0 |
    ///
    /// # Errors
    /// A source that is not recognised or holds no record, no time, uneven steps, many samples without a number, a rate that is
    /// none: each at its place.
    pub fn open(
        path: &Path,
        options: &ColumnOptions,
        sampling_hz: Option<f64>,
    ) -> Result<Self, Problems> {
        if let Some(fault) = sampling_hz.and_then(fault_of_rate) {
            return Err(Problem::new(Place::file("--sampling-hz"), fault).into());
        }
        Self::of(OpenSource::open(path, None)?, options, sampling_hz)
    }

    /// Reads a record of a text in memory.
    ///
    /// # Errors
    /// As [`EvenRecord::open`].
    pub fn read(source: &Source) -> Result<Self, Problems> {
        let reader = Box::new(Cursor::new(source.text.clone().into_bytes()));
        let source = OpenSource::of(reader, Path::new(&source.name), None)?;
        Self::of(source, &ColumnOptions::default(), None)
    }

    fn of(
        source: OpenSource,
        options: &ColumnOptions,
        sampling_hz: Option<f64>,
    ) -> Result<Self, Problems> {
        let name = source.name.clone();
        let refused =
            |message: &str| Problem::new(Place::file(&name), Fault::Other(message.to_owned()));
        let reduction =
            Reduction { most_samples: usize::MAX, reduce_to_hz: None, sampling_hz, split: false };
        let Imported::Record(table) =
            source.imported((options, None), Reading::Record, reduction)?.0
        else {
            return Err(refused("holds reversal curves, expected a record over time").into());
        };
        let channels = table.choice.columns.iter().map(|taken| taken.channel.clone());
        let channels: Vec<Channel> = channels.collect();
        let left_out = table.choice.left_out.clone();
        let part = table.parts.into_iter().next();
        let part = part.ok_or_else(|| refused("holds no sample, expected three or more"))?;
        let step_s = Self::step_of(&part.time_s).map_err(|(_, message)| refused(&message))?;
        let columns = channels.into_iter().zip(part.columns).collect();
        Ok(Self { time_s: part.time_s, step_s, warnings: part.warnings, columns, left_out, name })
    }

    /// Time between two samples, s, of samples at these times.
    ///
    /// # Errors
    /// The sample, from 0, and what is wrong there: fewer than two samples, a step that differs from the others by more than 1 %.
    pub fn step_of(time_s: &[f64]) -> Result<f64, (usize, String)> {
        let [first, .., last] = time_s[..] else {
            return Err((0, "one sample is no record: give two or more".to_owned()));
        };
        let step_s = (last - first) / (time_s.len() - 1) as f64;
        let is_even = |pair: &[f64]| (pair[1] - pair[0] - step_s).abs() <= EVEN * step_s;
        if let Some(row) = time_s.windows(2).position(|pair| !(step_s > 0.0 && is_even(pair))) {
            let found = time_s[row + 1] - time_s[row];
            let message = format!(
                "{found} s after the sample before, expected {step_s} s: give evenly spaced samples"
            );
            return Err((row + 1, message));
        }
        Ok(step_s)
    }

    /// The numbers of a column, in the unit of a label such as `displacement_um`.
    ///
    /// It is the column of that name in whatever unit of the same quantity. Without one it is the only column of the quantity, if
    /// `beside`, the label of the other column that is wanted, is of another quantity, and the column is not named as another
    /// quantity of a bench, such as `amplifier` or `sensor`. None if there is none.
    ///
    /// # Errors
    /// Two columns of that name.
    pub fn column(&self, label: &str, beside: &str) -> Result<Option<RecordColumn>, Problem> {
        let (Some(wanted), beside) = (Channel::parse(label), Channel::parse(beside)) else {
            return Ok(None);
        };
        let of_kind =
            self.columns.iter().filter(|(own, _)| own.unit.dimension == wanted.unit.dimension);
        let of_kind: Vec<_> = of_kind.collect();
        let named: Vec<_> =
            of_kind.iter().copied().filter(|(own, _)| own.name == wanted.name).collect();
        let is_alone = beside.is_none_or(|own| own.unit.dimension != wanted.unit.dimension);
        let found = match (&named[..], &of_kind[..]) {
            ([one], _) => one,
            ([], [one]) if is_alone && is_free_name(&one.0.name) => one,
            ([], _) => return Ok(None),
            _ => {
                let message = format!(
                    "{} columns are called `{}`: rename all but one in the header, or say which one is meant with --columns",
                    named.len(),
                    wanted.name
                );
                return Err(Problem::new(Place::file(&self.name), Fault::Other(message)));
            }
        };
        let (own, values) = found;
        // no factor leads from one temperature to another
        let factor = own.unit.factor_to(wanted.unit);
        Ok(factor.map(|factor| RecordColumn {
            name: own.name.clone(),
            label: own.label(),
            values: values.iter().map(|value| factor * value).collect(),
        }))
    }

    /// That a column is missing.
    pub fn missing(&self, wanted: &str) -> Problem {
        let own = self.columns.iter().map(|(own, _)| own.label());
        let found = own
            .chain(self.left_out.iter().filter(|name| !name.trim().is_empty()).cloned())
            .collect::<Vec<_>>()
            .join(", ");
        let remedy = "name it so in the header, or say which column it is: --columns time_s=#1,... with its label and number";
        let fault = Fault::MissingColumn { wanted: wanted.to_owned(), found, remedy };
        Problem::new(Place::file(&self.name), fault)
    }
}

//! A table of an evenly sampled record.

use super::PointCsv;
use crate::files::Source;
use crate::problem::{Fault, Problem, Problems};

const TIME: &str = "time_s";
/// Part of a step by which another may differ.
const EVEN: f64 = 0.01;

/// A table whose column `time_s` rises by one step.
#[derive(Debug, Clone, PartialEq)]
pub struct EvenRecord {
    /// The table.
    pub table: PointCsv,
    /// Times of the samples, s; two or more.
    pub time_s: Vec<f64>,
    /// Time between two samples, s, above 0.
    pub step_s: f64,
}

impl EvenRecord {
    /// Reads a record.
    ///
    /// # Errors
    /// As [`PointCsv::read`]; no `time_s`, a blank one, one sample alone, a step that differs from the others by more than 1 %:
    /// each with its line.
    pub fn read(source: &Source) -> Result<Self, Problems> {
        let table = PointCsv::read(source, &[])?;
        let time_s = table.full_column(TIME, "give the time of every sample, s")?;
        let step_s = Self::step_of(&time_s).map_err(|(row, message)| {
            Problem::new(table.place(row, TIME), Fault::Refused { message })
        })?;
        Ok(Self { table, time_s, step_s })
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

    /// The first of some columns that is there, with its name.
    ///
    /// # Errors
    /// A blank cell, with its line.
    pub fn one_of(&self, names: &[String]) -> Result<Option<(String, Vec<f64>)>, Problem> {
        let Some(name) = names.iter().find(|name| self.table.has(name)) else { return Ok(None) };
        Ok(Some((name.clone(), self.table.full_column(name, "give every sample")?)))
    }

    /// That a column is missing.
    pub fn missing(&self, wanted: &str) -> Problem {
        self.table.missing(wanted, "name the columns in the first line, with units")
    }
}

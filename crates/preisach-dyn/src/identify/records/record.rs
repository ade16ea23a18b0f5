//! Bench records.

use crate::actuator::model::SAMPLE_TOLERANCE;
use crate::check::{check_count, check_positive, extremes, not_finite};
use crate::{PreisachError, VoltageRange};
use rotor_base::RecordUse;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The parts of a record that train and that judge, as samples.
///
/// Whatever they are, a record is always simulated from its first sample, so that the memory is what
/// the whole history made of it.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct RecordWindows {
    /// Samples that train; none: all of them.
    pub train: Option<Range<usize>>,
    /// Samples the model is judged by; none: all of them.
    pub judge: Option<Range<usize>>,
}

/// One bench record: equally spaced samples of command and output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct BenchRecord {
    /// Name, used in reports and messages.
    pub id: String,
    /// Time between samples, s.
    pub time_step_s: f64,
    /// Command, V.
    pub voltage_volt: Vec<f64>,
    /// Measured output as equivalent flap angle, deg: displacement times the bench gain.
    pub output_deg: Vec<f64>,
    /// Training or test; none leaves it to [`crate::identify::SplitRule`].
    pub record_use: Option<RecordUse>,
    /// Frequency of the command's period, Hz; none has it found from the command.
    pub base_frequency_hz: Option<f64>,
    /// Parts that train and judge.
    pub windows: RecordWindows,
}

/// The fewest samples a record may have.
const FEWEST_SAMPLES: usize = 16;
/// Share of the command's swing within which the command has hardly moved yet.
const HARDLY: f64 = 0.05;
/// The output then moves by this share of its range at least, and by this many times what it does anywhere else
/// while the command moves as little.
const JUMP: f64 = 0.1;
const TIMES: f64 = 2.5;
/// Such stretches after which what follows the jump has settled.
const SETTLED: usize = 8;

impl BenchRecord {
    /// Checks lengths, numbers and range.
    ///
    /// # Errors
    /// [`PreisachError::BadRecord`], [`PreisachError::OutOfRange`].
    pub fn check(&self, range: VoltageRange) -> Result<(), PreisachError> {
        let (inputs, outputs) = (self.voltage_volt.len(), self.output_deg.len());
        let bad = |index: usize, problem: &'static str, value: f64| {
            let record = format!("record {}", self.id);
            Err(PreisachError::BadRecord { record, index, problem, value })
        };
        if inputs != outputs {
            return bad(inputs, UNEQUAL, outputs as f64);
        }
        check_count("samples of a record", inputs, FEWEST_SAMPLES)?;
        check_positive("time_step_s", self.time_step_s)?;
        if let Some(hz) = self.base_frequency_hz {
            check_positive("base_frequency_hz", hz)?;
        }
        for (index, (&u, &y)) in self.voltage_volt.iter().zip(&self.output_deg).enumerate() {
            if let Some((problem, value)) = sample_problem(u, y, range) {
                return bad(index, problem, value);
            }
        }
        if spread(&self.output_deg) == 0.0 {
            return bad(0, "the output never changes", self.output_deg[0]);
        }
        for window in [&self.windows.train, &self.windows.judge].into_iter().flatten() {
            if window.end > outputs || window.len() < FEWEST_SAMPLES {
                let problem = "the window from here to the end given does not hold 16 samples";
                return bad(window.start, problem, window.end as f64);
            }
        }
        Ok(())
    }

    /// The record with one sample more before its first, at 0 V, where its beginning shows that the actuator came
    /// from there: the output jumps while the command has hardly moved. What the output was at 0 V is
    /// the first sample's, before it moves. None where nothing shows it, or 0 V is out of the range.
    ///
    /// The memory of a hysteretic actuator depends on it: with the command coming up from 0 V it is on
    /// the rising side of its loop, at rest it is in the middle.
    pub fn from_switch_on(&self, range: VoltageRange) -> Option<Self> {
        let (u, y) = (&self.voltage_volt, &self.output_deg);
        let [low, high] = extremes(u.iter().copied());
        let [lowest, highest] = extremes(y.iter().copied());
        let (first, near) = (*u.first()?, HARDLY * (high - low));
        let begins =
            u.iter().take_while(|volt| (*volt - first).abs() <= near).count().saturating_sub(1);
        if begins == 0
            || begins > u.len() / 8
            || range.excess_volt(0.0) > 0.0
            || first.abs() <= near
        {
            return None;
        }
        let move_at = |i: usize| (u[i + begins] - u[i], y[i + begins] - y[i]);
        let (_, jump) = move_at(0);
        let others = (SETTLED * begins..u.len() - begins).map(move_at);
        let usual =
            others.filter(|(du, _)| du.abs() <= near).fold(0.0, |m: f64, (_, dy)| m.max(dy.abs()));
        let jumps = jump.abs() >= JUMP * (highest - lowest) && jump.abs() >= TIMES * usual;
        jumps.then(|| {
            let mut record = self.clone();
            record.voltage_volt.insert(0, 0.0);
            record.output_deg.insert(0, y[0]);
            for window in
                [&mut record.windows.train, &mut record.windows.judge].into_iter().flatten()
            {
                *window = window.start + 1..window.end + 1;
            }
            record
        })
    }

    /// Whether the command never changes where the record is judged.
    pub fn is_at_rest(&self) -> bool {
        let [low, high] = extremes(self.voltage_volt[self.judged_samples()].iter().copied());
        low >= high
    }

    /// The samples that train.
    pub fn trained_samples(&self) -> Range<usize> {
        self.windows.train.clone().unwrap_or(0..self.output_deg.len())
    }

    /// The samples the model is judged by.
    pub fn judged_samples(&self) -> Range<usize> {
        self.windows.judge.clone().unwrap_or(0..self.output_deg.len())
    }
}

/// What is wrong with columns of which one is longer than the other.
pub(crate) const UNEQUAL: &str = "inputs and outputs differ in number";

/// What is wrong with a sample of command and output, and the value it has.
pub(crate) fn sample_problem(u: f64, y: f64, range: VoltageRange) -> Option<(&'static str, f64)> {
    let outside = range.excess_volt(u) > SAMPLE_TOLERANCE * range.span_volt();
    not_finite(u, y).or_else(|| outside.then_some(("the input is outside its range", u)))
}

/// Standard deviation.
pub(crate) fn spread(values: &[f64]) -> f64 {
    rotor_base::variance(values).sqrt()
}

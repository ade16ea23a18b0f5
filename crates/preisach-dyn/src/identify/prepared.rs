//! Records made ready for the fits.

use super::fourier::{self, FourierFit};
use super::record::spread;
use super::{BenchRecord, Drive, RecordUse, Settings, Waveform};
use crate::{PlayMemory, PreisachError, PreisachGrid, StartState};

/// Samples a quasi-static record gives to the static fit at most; a denser one is thinned.
const MOST_STATIC_SAMPLES: usize = 4000;
/// Samples the steady cycles of a record give to the rate fit at most.
const MOST_RATE_SAMPLES: usize = 600;

/// A record made ready: its drive, its averaged cycles, the play states where they are needed.
pub(crate) struct Prepared<'a> {
    pub(super) record: &'a BenchRecord,
    pub(super) spread_deg: f64,
    pub(super) drive: Drive,
    pub(super) record_use: RecordUse,
    /// Whether it trains the static map; if not it trains the rate maps.
    pub(super) is_slow: bool,
    /// Fourier series of the steady cycles; none for transients.
    pub(super) cycles: Option<FourierFit>,
    /// Samples the fits look at; empty for held-out records.
    pub(super) samples: Vec<usize>,
    levels: usize,
    /// Play states at those samples, one row of `levels` each.
    states: Vec<f64>,
}

impl<'a> Prepared<'a> {
    pub(super) fn new(
        record: &'a BenchRecord,
        drive: Drive,
        record_use: RecordUse,
        grid: &PreisachGrid,
        settings: &Settings,
    ) -> Result<Self, PreisachError> {
        let cycles = if drive.is_periodic() {
            let count = drive.harmonics_within(record.time_step_s, settings.harmonics);
            let cycles_per_sample = drive.base_hz * record.time_step_s;
            Some(fourier::fit(&record.output_deg, drive.steady.clone(), cycles_per_sample, count)?)
        } else {
            None
        };
        let is_slow = settings.split.is_quasi_static(&drive);
        let trains = record_use == RecordUse::Train && drive.waveform != Waveform::Constant;
        let (range, most) = match (trains, is_slow) {
            (false, _) => (0..0, 1),
            (true, true) => (0..record.output_deg.len(), MOST_STATIC_SAMPLES),
            (true, false) => (drive.steady.clone(), MOST_RATE_SAMPLES),
        };
        let stride = range.len().div_ceil(most).max(1);
        let mut prepared = Self {
            record,
            spread_deg: spread(&record.output_deg),
            drive,
            record_use,
            is_slow,
            cycles,
            samples: range.step_by(stride).collect(),
            levels: grid.levels(),
            states: Vec::new(),
        };
        prepared.find_states(grid);
        Ok(prepared)
    }

    /// Runs the memory over the record, from rest at its first voltage.
    fn find_states(&mut self, grid: &PreisachGrid) {
        let voltages = &self.record.voltage_volt;
        let mut memory = PlayMemory::new(grid, voltages[0], StartState::Rest);
        let mut next = self.samples.iter().copied().peekable();
        for (index, &u) in voltages.iter().enumerate() {
            if next.peek().is_none() {
                break;
            }
            memory.apply(grid, u);
            if next.next_if_eq(&index).is_some() {
                self.states.extend_from_slice(memory.cells());
            }
        }
    }

    /// Sample indices with the play states there.
    pub(super) fn states(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.samples.iter().copied().zip(self.states.chunks_exact(self.levels))
    }
}

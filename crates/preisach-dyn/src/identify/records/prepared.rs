//! Records made ready for the fits.

use crate::identify::records::fourier::{self, FourierFit};
use crate::identify::records::noise::CycleNoise;
use crate::identify::records::record::spread;
use crate::identify::{BenchRecord, Drive, RecordUse, Settings, Waveform};
use crate::{PlayMemory, PreisachError, PreisachGrid, StartState};
use std::ops::Range;

/// Samples a quasi-static record gives to the static fit at most; a denser one is thinned.
const MOST_STATIC_SAMPLES: usize = 4000;
/// Samples the steady cycles of a record give to the rate fit at most.
const MOST_RATE_SAMPLES: usize = 600;

/// A record made ready: its drive, its averaged cycles, the play states where they are needed.
#[derive(Clone)]
pub(crate) struct Prepared<'a> {
    pub(crate) record: &'a BenchRecord,
    pub(crate) spread_deg: f64,
    pub(crate) drive: Drive,
    pub(crate) record_use: RecordUse,
    /// Whether it trains the static map; if not it trains the rate maps.
    pub(crate) is_slow: bool,
    /// Fourier series of the steady cycles that train; none for transients.
    pub(crate) cycles: Option<FourierFit>,
    /// Scatter of the repeated cycles; none for transients and single cycles.
    pub(crate) noise: Option<CycleNoise>,
    /// Samples the fits look at; empty for held-out records.
    pub(crate) samples: Vec<usize>,
    /// A block in time among those that train which fits do not look at; empty for none.
    pub(crate) left_out: Range<usize>,
    levels: usize,
    /// Play states at those samples, one row of `levels` each.
    states: Vec<f64>,
}

impl<'a> Prepared<'a> {
    pub(crate) fn new(
        record: &'a BenchRecord,
        drive: Drive,
        record_use: RecordUse,
        is_slow: bool,
        grid: &PreisachGrid,
        settings: &Settings,
    ) -> Result<Self, PreisachError> {
        let steady = drive.steady_within(&record.trained_samples(), record.time_step_s);
        let per_sample = drive.base_hz * record.time_step_s;
        let count = drive.harmonics_within(record.time_step_s, settings.harmonics);
        let cycles = steady
            .clone()
            .map(|steady| fourier::fit(&record.output_deg, steady, per_sample, count))
            .transpose()?;
        let noise =
            steady.clone().and_then(|s| CycleNoise::of(&record.output_deg[s], 1.0 / per_sample));
        let trains = record_use == RecordUse::Train && drive.waveform != Waveform::Constant;
        let (range, most) = match (trains, is_slow) {
            (false, _) => (0..0, 1),
            (true, true) => (record.trained_samples(), MOST_STATIC_SAMPLES),
            (true, false) => (steady.unwrap_or(record.trained_samples()), MOST_RATE_SAMPLES),
        };
        let stride = range.len().div_ceil(most).max(1);
        let mut prepared = Self {
            record,
            spread_deg: spread(&record.output_deg[record.trained_samples()]),
            drive,
            record_use,
            is_slow,
            cycles,
            noise,
            samples: range.step_by(stride).collect(),
            left_out: 0..0,
            levels: grid.levels(),
            states: Vec::new(),
        };
        prepared.find_states(grid);
        Ok(prepared)
    }

    /// With a block in time left out of what fits look at; the memory is run through it all the same.
    pub(crate) fn without(mut self, block: Range<usize>) -> Self {
        let kept = self.states().filter(|(index, _)| !block.contains(index));
        let (samples, states): (Vec<usize>, Vec<&[f64]>) = kept.unzip();
        let states = states.concat();
        (self.samples, self.states, self.left_out) = (samples, states, block);
        self
    }

    /// Runs the memory over the record, from rest at its first voltage.
    fn find_states(&mut self, grid: &PreisachGrid) {
        let voltages = &self.record.voltage_volt;
        let mut memory = PlayMemory::new(grid, voltages[0], StartState::Rest);
        let end = self.samples.last().map_or(0, |last| last + 1);
        for (index, &u) in voltages[..end].iter().enumerate() {
            memory.apply(grid, u);
            if self.samples.binary_search(&index).is_ok() {
                self.states.extend_from_slice(memory.cells());
            }
        }
    }

    /// Sample indices with the play states there.
    pub(crate) fn states(&self) -> impl Iterator<Item = (usize, &[f64])> {
        self.samples.iter().copied().zip(self.states.chunks_exact(self.levels))
    }
}

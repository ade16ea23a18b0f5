//! The static fit of records that do not fit into memory.

use crate::check::{check_count, check_positive};
use crate::identify::Settings;
use crate::identify::fit::program::{LeastSquaresProgram, Row};
use crate::identify::fit::static_fit::Unknowns;
use crate::identify::records::record::{UNEQUAL, sample_problem};
use crate::{PlayMemory, PreisachError, PreisachGrid, StartState, StaticPreisach};

/// Builds a static Preisach model from samples that come piece by piece.
///
/// Every sample moves the plays, so that no turning point is missed; one in `stride` enters the normal
/// equations. What is kept is those equations and one memory, however many samples come: about
/// `levels^4 / 8` numbers.
///
/// ```text
/// min  mean_i (offset + sum_jk v_jk N_jk(x_i) - y_i)^2 / spread^2 + smoothness as in the batch fit
/// ```
/// Differs from the batch fit: samples weigh alike, there records do.
#[derive(Debug, Clone)]
pub struct StaticAccumulator {
    grid: PreisachGrid,
    unknowns: Unknowns,
    program: LeastSquaresProgram,
    smoothness: f64,
    stride: usize,
    memory: Option<PlayMemory>,
    row: Row,
    seen: usize,
    used: usize,
    /// Sum and sum of squares of the outputs used, about the first one, as the equations have them.
    sums: [f64; 2],
    first_deg: f64,
}

impl StaticAccumulator {
    /// An accumulator for a grid of `settings.levels` over `settings.range_volt`.
    ///
    /// # Errors
    /// Refused settings; [`PreisachError::OutOfRange`] for `stride = 0`.
    pub fn new(settings: &Settings, stride: usize) -> Result<Self, PreisachError> {
        settings.check()?;
        check_count("stride", stride, 1)?;
        let grid = PreisachGrid::new(settings.range_volt, settings.levels)?;
        let unknowns = Unknowns::new(&grid);
        Ok(Self {
            grid,
            program: LeastSquaresProgram::new(unknowns.count),
            unknowns,
            smoothness: settings.static_smoothness,
            stride,
            memory: None,
            row: Row::new(),
            seen: 0,
            used: 0,
            sums: [0.0; 2],
            first_deg: 0.0,
        })
    }

    /// The next sample begins a new record, at rest at its first voltage.
    pub fn begin_record(&mut self) {
        self.memory = None;
    }

    /// Takes the next samples of the present record: V and deg.
    ///
    /// # Errors
    /// [`PreisachError::BadRecord`] with the place of the sample, counted over all that came. Nothing of a refused piece is used beyond the sample named.
    pub fn push(&mut self, voltage_volt: &[f64], output_deg: &[f64]) -> Result<(), PreisachError> {
        let bad = |index: usize, problem: &'static str, value: f64| {
            Err(PreisachError::BadRecord { record: "stream".into(), index, problem, value })
        };
        if voltage_volt.len() != output_deg.len() {
            return bad(self.seen, UNEQUAL, output_deg.len() as f64);
        }
        for (&u, &y) in voltage_volt.iter().zip(output_deg) {
            if let Some((problem, value)) = sample_problem(u, y, self.grid.range()) {
                return bad(self.seen, problem, value);
            }
            let grid = &self.grid;
            let memory =
                self.memory.get_or_insert_with(|| PlayMemory::new(grid, u, StartState::Rest));
            memory.apply(grid, u);
            if self.seen.is_multiple_of(self.stride) {
                if self.used == 0 {
                    self.first_deg = y;
                }
                self.unknowns.hats(memory.cells(), &mut self.row);
                let off = y - self.first_deg;
                self.program.add(&self.row, off, 1.0);
                self.sums[0] += off;
                self.sums[1] += off * off;
                self.used += 1;
            }
            self.seen += 1;
        }
        Ok(())
    }

    /// Samples that came, and samples that entered the equations.
    pub fn samples(&self) -> [usize; 2] {
        [self.seen, self.used]
    }

    /// Numbers kept at present, however many samples came.
    pub fn kept_numbers(&self) -> usize {
        self.program.kept_numbers() + self.memory.as_ref().map_or(0, PlayMemory::levels)
    }

    /// The model of all samples so far; more may follow.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`] samples, [`PreisachError::OutOfRange`] if the output never changed,
    /// [`PreisachError::QuadraticProgram`].
    pub fn fit(&self) -> Result<StaticPreisach, PreisachError> {
        const LEAST: usize = 16;
        check_count("samples of a static fit", self.used, LEAST)?;
        let count = self.used as f64;
        let mean = self.sums[0] / count;
        let variance = self.sums[1] / count - mean * mean;
        check_positive("variance of the outputs, deg^2", variance)?;
        let mut program = self.program.clone();
        program.scale(1.0 / count);
        let mut map = self.unknowns.solved(&self.grid, program, self.smoothness, variance)?;
        map.constant += self.first_deg;
        StaticPreisach::new(self.grid, map)
    }
}

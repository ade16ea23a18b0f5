//! The static (classical) Preisach actuator, paper equation (2).

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::laws::play_map::NodeTable;
use crate::{HysteresisLaw, PlayMap, PlayMemory, PreisachError, PreisachGrid, StartState};
use pulp::{Arch, Simd, WithSimd};
use rotor_base::{LANES, Lanes};
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

/// A static Preisach actuator with an output continuous in the voltage.
///
/// ```text
/// delta = II mu0(alpha, beta) gamma_ab[u] dalpha dbeta = constant + sum_j g_j(play_{r_j}[u])
/// ```
/// Input in volt, output in degrees of equivalent flap angle, never falling with the voltage.
/// Has the wiping-out and congruency properties exactly.
///
/// Not modelled: any dependence on rate; see [`crate::DynamicPreisach`].
/// Source: Viswamurthy and Ganguli, equation (2); play form: Brokate and Sprekels, *Hysteresis and
/// Phase Transitions* (1996), section 2.4.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StaticFile", into = "StaticFile")]
pub struct StaticPreisach {
    grid: PreisachGrid,
    map: PlayMap,
    table: NodeTable<[f64; 2]>,
}

/// The model as it is written to files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StaticFile {
    grid: PreisachGrid,
    g0_deg: PlayMap,
    /// Of a file that names the law `RelayGrid`.
    #[serde(default, skip_serializing, deserialize_with = "refuse_relays")]
    relays_per_cell: (),
}

/// Refuses a file of bare relays.
fn refuse_relays<'de, D: Deserializer<'de>>(_: D) -> Result<(), D::Error> {
    Err(D::Error::custom(
        "relays_per_cell belongs to the law RelayGrid, which is not offered any more: name the law \
         StaticPreisach and leave relays_per_cell out (the same density, without steps)",
    ))
}

impl TryFrom<StaticFile> for StaticPreisach {
    type Error = PreisachError;

    fn try_from(file: StaticFile) -> Result<Self, PreisachError> {
        Self::new(file.grid, file.g0_deg)
    }
}

impl From<StaticPreisach> for StaticFile {
    fn from(model: StaticPreisach) -> Self {
        Self { grid: model.grid, g0_deg: model.map, relays_per_cell: () }
    }
}

impl StaticPreisach {
    /// The model with output map `map` (deg) on `grid`.
    ///
    /// # Errors
    /// [`PreisachError::NodeCount`], [`PreisachError::NotFinite`] or
    /// [`PreisachError::OutOfRange`].
    pub fn new(grid: PreisachGrid, map: PlayMap) -> Result<Self, PreisachError> {
        map.check(&grid, "g0_deg")?;
        map.check_rising()?;
        let table = NodeTable::new(&grid, |play, knot| map.value_and_rise(play, knot));
        Ok(Self { grid, map, table })
    }

    /// Its grid.
    pub fn grid(&self) -> &PreisachGrid {
        &self.grid
    }

    /// Its output map, deg.
    pub fn map(&self) -> &PlayMap {
        &self.map
    }

    /// Output in a given memory state, deg.
    pub fn output_deg(&self, memory: &PlayMemory) -> f64 {
        self.map.value(memory)
    }

    /// Moves the memory to a voltage and returns the output, deg.
    ///
    /// Voltages beyond the grid's range act as its limits. The memory must belong to this grid.
    pub fn apply(&self, memory: &mut PlayMemory, voltage_volt: f64) -> f64 {
        memory.apply(&self.grid, voltage_volt);
        let cells = memory.cells();
        let at = |play: usize, x: f64| {
            let (&[value, rise], t) = self.table.at(play, x);
            value + t * rise
        };
        // four sums at a time: a single one would wait for every addition before it
        let mut sums = [self.map.constant, 0.0, 0.0, 0.0];
        let quads = cells.chunks_exact(4);
        let first_left = cells.len() - quads.remainder().len();
        for (i, &x) in quads.remainder().iter().enumerate() {
            sums[i] += at(first_left + i, x);
        }
        for (quad, x) in quads.enumerate() {
            for (lane, sum) in sums.iter_mut().enumerate() {
                *sum += at(4 * quad + lane, x[lane]);
            }
        }
        (sums[0] + sums[1]) + (sums[2] + sums[3])
    }

    /// The outputs of models on one grid over the same voltages, from rest at the first: the plays
    /// move once for all of them. Each is that of its own simulation, to the last bit.
    pub(crate) fn side_by_side(models: &[&Self], voltages_volt: &[f64]) -> Vec<Vec<f64>> {
        models.chunks(LANES).flat_map(|group| Self::group(group, voltages_volt)).collect()
    }

    /// As [`Self::side_by_side`], of at most [`LANES`] models.
    fn group(models: &[&Self], voltages_volt: &[f64]) -> Vec<Vec<f64>> {
        let (Some(first), Some(&start)) = (models.first(), voltages_volt.first()) else {
            return vec![Vec::new(); models.len()];
        };
        let grid = &first.grid;
        let of = |lane: usize| models.get(lane).unwrap_or(first);
        let table = NodeTable::new(grid, |play, knot| {
            let entry = |lane: usize| *of(lane).table.at(play, knot as f64).0;
            (Lanes::from_fn(|lane| entry(lane)[0]), Lanes::from_fn(|lane| entry(lane)[1]))
        });
        let constants = Lanes::from_fn(|lane| of(lane).map.constant);
        let memory = PlayMemory::new(grid, start, StartState::Rest);
        let starts: Vec<f64> = models.iter().map(|model| model.output_deg(&memory)).collect();
        let sums = Arch::new().dispatch(Sums { grid, table, constants, memory, voltages_volt });
        let rest = |lane: usize| sums.iter().map(move |at| at.0[lane]);
        starts
            .into_iter()
            .enumerate()
            .map(|(lane, start)| std::iter::once(start).chain(rest(lane)).collect())
            .collect()
    }
}

/// Outputs of models side by side after the first voltage: a type of its own, for a closure would be called, not inlined,
/// by the function that is compiled for the vector unit.
struct Sums<'a> {
    grid: &'a PreisachGrid,
    /// Values of all models, and their rises.
    table: NodeTable<(Lanes, Lanes)>,
    constants: Lanes,
    memory: PlayMemory,
    voltages_volt: &'a [f64],
}

impl WithSimd for Sums<'_> {
    type Output = Vec<Lanes>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self { grid, table, constants, mut memory, voltages_volt } = self;
        let mut outputs = Vec::with_capacity(voltages_volt.len());
        for &volt in voltages_volt.iter().skip(1) {
            memory.apply(grid, volt);
            let (quads, left) = memory.cells().as_chunks::<4>();
            // the order of additions is that of `apply`
            let mut sums = [constants, Lanes::default(), Lanes::default(), Lanes::default()];
            for (i, &x) in left.iter().enumerate() {
                sums[i] += table.values(4 * quads.len() + i, x);
            }
            let [mut a, mut b, mut c, mut d] = sums;
            for (quad, x) in quads.iter().enumerate() {
                let play = 4 * quad;
                a += table.values(play, x[0]);
                b += table.values(play + 1, x[1]);
                c += table.values(play + 2, x[2]);
                d += table.values(play + 3, x[3]);
            }
            outputs.push((a + b) + (c + d));
        }
        outputs
    }
}

impl HysteresisLaw for StaticPreisach {
    type Memory = PlayMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (PlayMemory, f64) {
        let memory = PlayMemory::new(&self.grid, voltage_volt, state);
        let output_deg = self.output_deg(&memory);
        (memory, output_deg)
    }

    #[inline]
    fn step(&self, memory: &mut PlayMemory, voltage_volt: f64, _: f64) -> f64 {
        self.apply(memory, voltage_volt)
    }

    fn check_memory(&self, memory: &PlayMemory) -> Result<(), PreisachError> {
        memory.check(&self.grid)
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.map.constant += shift_deg;
        self
    }
}

//! Inputs that are not known well, moved to where the points put them.
//!
//! The engine lets such an input act in proportion. Near a resonance it does not, and a suspect whose effect is computed anew
//! where it was found would win by that alone. What the inputs do is computed anew too before a name is given.

use super::finding::PointFinding;
use super::floor::{Floor, explained};
use super::kind::{KindQuestion, PointKind};
use super::predicted::Tables;
use super::table::{Grid, PointTable};
use crate::GapError;
use crate::discovery::{AS_LIKELY, SURELY, Signal, Simulator, needed_to_separate};

/// Times the inputs are linearised anew, parts of a step that are tried, and standard deviations that an input moves at most.
const ROUNDS: usize = 3;
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];
const FURTHEST: f64 = 3.0;
/// By how many it moves first.
const FIRST: f64 = 2.0;
/// Standard deviations within which they have settled.
const SETTLED: f64 = 0.1;

/// The simulation with its inputs moved.
pub(super) struct MovedInputs<M> {
    /// Standard deviations that each is moved by.
    pub(super) by: Vec<f64>,
    pub(super) model: M,
    /// What it reads.
    pub(super) predicted: Grid,
    /// What it reads with one of them further by one standard deviation.
    pub(super) further: Vec<Grid>,
    /// Chi-square that it leaves, that of the inputs included.
    cost: f64,
    /// That over what was found leaves, and the least that would tell them apart.
    pub(super) higher: [f64; 2],
}

impl<M> MovedInputs<M> {
    /// Whether it explains the points as well as what was found.
    pub(super) fn is_as_likely(&self) -> bool {
        self.higher[0] < AS_LIKELY * self.higher[1]
    }
}

/// What the points say of moved inputs.
struct Search<'a> {
    tables: Tables<'a>,
    measured: Vec<f64>,
    /// What calibrations and errors of the simulation do; the inputs stand first.
    columns: Vec<Vec<f64>>,
}

impl Search<'_> {
    /// Chi-square of a prediction, and where the fit puts the inputs, now at `by`.
    fn explained(&self, predicted: &Signal, by: &[f64]) -> Result<(f64, Vec<f64>), GapError> {
        let left: Vec<f64> =
            self.measured.iter().zip(predicted.concat()).map(|(a, b)| a - b).collect();
        explained(&left, &self.columns, by)
    }
}

impl<K: PointKind> KindQuestion<'_, K> {
    /// The model with one input moved further by one standard deviation, for each of them.
    pub(super) fn further(&self, by: &[f64]) -> Result<Vec<K::Model>, K::Error> {
        let one = |k: usize| {
            let mut by = by.to_vec();
            by[k] += 1.0;
            (self.with_inputs)(&by)
        };
        (0..self.uncertain).map(one).collect()
    }

    /// The simulation with its inputs moved to where the points put them with nothing missing, where that is not surely worse
    /// than what was found.
    ///
    /// Gauss and Newton's method from where the points put inputs that act in proportion, or from one input off by
    /// [`FIRST`], the best of all.
    pub(super) fn explaining_inputs(
        &self,
        table: &PointTable,
        found: &PointFinding,
    ) -> Result<Option<MovedInputs<K::Model>>, K::Error> {
        let floor = Floor::of(table)?;
        let tables = Tables::of_measured(table, floor.sigma.clone());
        let columns = floor.nuisance(&tables).into_iter().map(|own| own.concat()).collect();
        let measured = tables.measured().concat();
        let mut search = Search { tables, measured, columns };
        let effects = &found.finding.effects;
        let here = vec![0.0; self.uncertain];
        let (named, _) = search.explained(&search.tables.predict(effects)?, &here)?;
        let (base, step) = search.explained(&search.tables.predict(&[])?, &here)?;
        // what the simulation reads has no error of form
        let needed = needed_to_separate(0.0);
        // where nothing was named it must better the simulation as it is
        let named = if effects.is_empty() { base - needed } else { named };
        let enough = AS_LIKELY.mul_add(needed, named);
        // inputs that cannot be simulated explain nothing
        let mut starts = vec![step];
        for (k, first) in (0..self.uncertain).flat_map(|k| [(k, FIRST), (k, -FIRST)]) {
            let mut by = here.clone();
            by[k] = first;
            starts.push(by);
        }
        let starts = starts.into_iter().map(|by| self.moved(&search, by).ok());
        let least =
            |a: &MovedInputs<K::Model>, b: &MovedInputs<K::Model>| a.cost.total_cmp(&b.cost);
        let Some(mut best) = starts.flatten().min_by(least) else { return Ok(None) };
        for round in 1..=ROUNDS {
            let further = self.further(&best.by)?;
            let further = further.iter().map(|own| self.kind.read(own)).collect::<Result<_, _>>();
            let Ok(further) = further else { return Ok(None) };
            best.further = further;
            for (column, grid) in search.columns.iter_mut().zip(&best.further) {
                *column = search.tables.signal(|p, c| grid[p][c] - best.predicted[p][c]).concat();
            }
            let predicted = search.tables.signal(|p, c| best.predicted[p][c]);
            let (cost, step) = search.explained(&predicted, &best.by)?;
            best.cost = cost;
            let far = step.iter().zip(&best.by).fold(0.0_f64, |far, (a, b)| far.max((a - b).abs()));
            if cost < enough || far < SETTLED || round == ROUNDS {
                break;
            }
            let part = |part: f64| -> Vec<f64> {
                step.iter().zip(&best.by).map(|(a, b)| part.mul_add(a - b, *b)).collect()
            };
            let tried = PARTS.map(part);
            let mut tried = tried.into_iter().filter_map(|by| self.moved(&search, by).ok());
            match tried.find(|own| own.cost < cost) {
                Some(next) => best = next,
                None => break,
            }
        }
        best.higher = [best.cost - named, needed];
        Ok(Some(best).filter(|own| own.higher[0] < SURELY * needed))
    }

    /// The simulation with its inputs moved within their limits.
    fn moved(
        &self,
        search: &Search<'_>,
        mut by: Vec<f64>,
    ) -> Result<MovedInputs<K::Model>, K::Error> {
        for own in &mut by {
            *own = own.clamp(-FURTHEST, FURTHEST);
        }
        let model = (self.with_inputs)(&by)?;
        let predicted = self.kind.read(&model)?;
        let signal = search.tables.signal(|p, c| predicted[p][c]);
        let (cost, _) = search.explained(&signal, &by)?;
        Ok(MovedInputs { by, model, predicted, further: Vec::new(), cost, higher: [f64::NAN; 2] })
    }
}

impl PointTable {
    /// Moves the simulation, and what was computed about it with it.
    pub(super) fn move_base<M>(&mut self, moved: &MovedInputs<M>) {
        let shift: Grid = moved
            .predicted
            .iter()
            .zip(&self.predicted)
            .map(|(new, old)| new.iter().zip(old).map(|(a, b)| a - b).collect())
            .collect();
        let of_suspects = self.suspects.iter_mut().flat_map(|own| &mut own.parameters);
        let tables = of_suspects.flat_map(|own| own.tables.iter_mut().map(|table| &mut table.1));
        for grid in tables.chain(&mut self.alternatives) {
            for (row, shift) in grid.iter_mut().zip(&shift) {
                for (value, shift) in row.iter_mut().zip(shift) {
                    *value += shift;
                }
            }
        }
        self.predicted.clone_from(&moved.predicted);
        self.uncertain.clone_from(&moved.further);
    }
}

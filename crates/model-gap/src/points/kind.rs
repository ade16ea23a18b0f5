//! A kind of simulation, asked what it lacks: its effects are computed, and computed anew where they were found.

use super::cause::PointCause;
use super::finding::PointFinding;
use super::table::{Channel, Grid, Instrument, Point, PointTable, Suspect, SuspectParameter};
use crate::discovery::{Found, Verdict};
use crate::{Effect, GapError, places};

/// Rounds in which the effects of what is left are computed anew where they were found.
const ROUNDS: usize = 4;
/// Part of a value by which it must be off those that its effect was computed at.
const MOVED: f64 = 0.1;
/// Part of its first amount by which a parameter moves beside others, to see what it does there.
const STEP: f64 = 0.02;
/// Part of the most that any cause explains alone from which on its effect is computed anew, and the most of these.
const GOOD_PART: f64 = 0.15;
const SURVIVORS: usize = 8;

/// A kind of simulation: what is read of a model at every point.
pub trait PointKind: Sync {
    /// What a cause changes.
    type Model: Clone + Send + Sync;
    /// Why a model cannot be read.
    type Error: std::error::Error + From<GapError>;

    /// What a model reads at every point, in the units of the channels.
    ///
    /// # Errors
    /// A model that cannot be simulated at a point.
    fn read(&self, model: &Self::Model) -> Result<Grid, Self::Error>;
}

/// A model whose inputs are moved by so many of their standard deviations.
pub type WithInputs<'a, K> =
    dyn Fn(&[f64]) -> Result<<K as PointKind>::Model, <K as PointKind>::Error> + 'a;

/// What is asked of a simulation and what was measured.
pub struct KindQuestion<'a, K: PointKind> {
    /// Its kind.
    pub kind: &'a K,
    /// The simulation.
    pub model: &'a K::Model,
    /// What it may lack.
    pub causes: &'a [PointCause<K::Model>],
    /// Other models that are thought as good, with their names. One that cannot be read is left out.
    pub alternatives: Vec<(&'static str, K::Model)>,
    /// How many inputs are not known well.
    pub uncertain: usize,
    /// The model with each of them moved by so many of its standard deviations.
    pub with_inputs: &'a WithInputs<'a, K>,
    /// The channels.
    pub channels: Vec<Channel>,
    /// What they are calibrated by.
    pub instruments: Vec<Instrument>,
    /// Names of the conditions.
    pub conditions: Vec<String>,
    /// The points, from what is predicted for them.
    pub points: &'a dyn Fn(&Grid) -> Vec<Point>,
    /// Whether the standard deviations were measured or stated.
    pub knows_deviations: bool,
    /// Causes to fit, nothing refused; all are looked for where there is none.
    pub only: &'a [String],
    /// Hears what is begun, and the percent of the work done by then.
    pub begun: &'a (dyn Fn(usize, &str) + Sync),
}

/// What was found of a simulation.
#[derive(Debug, Clone)]
pub struct KindFinding<M> {
    /// The points with what the simulation says of them.
    pub table: PointTable,
    /// What was found there.
    pub found: PointFinding,
    /// Names of the other models.
    pub alternatives: Vec<&'static str>,
    /// Standard deviations by which the inputs that are not known well were moved to explain the points; 0 where they were not.
    pub inputs: Vec<f64>,
    /// The model with what was found; as it was where nothing was.
    pub extended: M,
}

impl<K: PointKind> KindQuestion<'_, K> {
    /// Finds what the simulation lacks, or says that nothing is, or that it has no name.
    ///
    /// # Errors
    /// The simulation itself or with an uncertain input moved cannot be read; the engine.
    pub fn answer(&self) -> Result<KindFinding<K::Model>, K::Error> {
        let (mut table, alternatives) = self.table()?;
        (self.begun)(90, "search for what is missing");
        let ids: Vec<&str> = self.causes.iter().map(|own| own.id).collect();
        let only = places(&ids, self.only)?;
        let find = |table: &PointTable| match &only[..] {
            [] => table.find(),
            given => table.refit(given),
        };
        let mut found = self.refined(self.model, &mut table, &find)?;
        let mut inputs = vec![0.0; self.uncertain];
        let is_asked = self.uncertain > 0 && only.is_empty();
        if is_asked && found.finding.verdict != Verdict::NothingMissing {
            (self.begun)(95, "whether inputs that are not known well explain it");
            match self.explaining_inputs(&table, &found)? {
                Some(moved) if moved.is_as_likely() => {
                    table.move_base(&moved);
                    found = self.refined(&moved.model, &mut table, &find)?;
                    inputs = moved.by;
                }
                Some(moved) => found.doubt_beside_inputs(moved.higher),
                None => {}
            }
        }
        let mut extended = self.model.clone();
        for effect in &found.finding.effects {
            extended = self.causes[effect.candidate].applied(&extended, &effect.values);
        }
        Ok(KindFinding { table, found, alternatives, inputs, extended })
    }

    /// What is found with effects on a model that are computed anew where they were found.
    fn refined(
        &self,
        model: &K::Model,
        table: &mut PointTable,
        find: &dyn Fn(&PointTable) -> Result<PointFinding, GapError>,
    ) -> Result<PointFinding, GapError> {
        let mut found = find(table)?;
        for _ in 0..ROUNDS {
            if !self.refine(model, table, &found) {
                break;
            }
            found = find(table)?;
        }
        Ok(found)
    }

    /// The points with what the simulation says of them, with some of each cause, and with what it is not sure of.
    fn table(&self) -> Result<(PointTable, Vec<&'static str>), K::Error> {
        let begun = self.begun;
        // an input that is none is refused before anything is simulated
        self.further(&vec![0.0; self.uncertain])?;
        begun(0, "the simulation at every point");
        let predicted = self.kind.read(self.model)?;
        begun(5, "other levels of fidelity");
        let (mut names, mut alternatives) = (Vec::new(), Vec::new());
        for (name, model) in &self.alternatives {
            // a level that cannot be read here tells nothing
            if let Ok(grid) = self.kind.read(model) {
                names.push(*name);
                alternatives.push(grid);
            }
        }
        begun(15, "inputs that are not known well");
        let uncertain = (0..self.uncertain).map(|input| self.beside(input, &predicted));
        let uncertain = uncertain.collect::<Result<_, _>>()?;
        let mut suspects = Vec::with_capacity(self.causes.len());
        for (k, cause) in self.causes.iter().enumerate() {
            begun(25 + 65 * k / self.causes.len(), cause.id);
            suspects.push(self.suspect(cause));
        }
        let table = PointTable {
            points: (self.points)(&predicted),
            channels: self.channels.clone(),
            instruments: self.instruments.clone(),
            conditions: self.conditions.clone(),
            predicted,
            suspects,
            alternatives,
            uncertain,
            knows_deviations: self.knows_deviations,
        };
        Ok((table, names))
    }

    /// What is read with an input moved by one standard deviation; where that cannot be simulated, as if it did the opposite of
    /// what it does the other way.
    fn beside(&self, input: usize, base: &Grid) -> Result<Grid, K::Error> {
        let moved = |way: f64| {
            let mut by = vec![0.0; self.uncertain];
            by[input] = way;
            self.kind.read(&(self.with_inputs)(&by)?)
        };
        moved(1.0).or_else(|error| {
            let back = moved(-1.0).map_err(|_| error)?;
            let row = |(back, base): (Vec<f64>, &Vec<f64>)| {
                back.iter().zip(base).map(|(back, base)| 2.0 * base - back).collect()
            };
            Ok(back.into_iter().zip(base).map(row).collect())
        })
    }

    /// A cause as a suspect: what is read with some of it. Amounts that cannot be read are left out; it is blocked where a
    /// parameter has no other.
    fn suspect(&self, cause: &PointCause<K::Model>) -> Suspect {
        let mut blocked = cause.blocked.clone();
        let mut is_unread = false;
        let none = cause.none();
        let mut parameter = |k: usize| {
            let own = &cause.parameters[k];
            let (mut tables, mut failure) = (Vec::new(), None);
            for &amount in own.amounts.iter().filter(|_| blocked.is_none()) {
                let mut values = none.clone();
                values[k] = amount;
                match self.kind.read(&cause.applied(self.model, &values)) {
                    Ok(grid) => tables.push((amount, grid)),
                    Err(error) => failure = Some(error),
                }
            }
            if let (true, Some(error)) = (tables.is_empty(), failure) {
                blocked = Some(format!("the model with it cannot be read: {error}"));
                is_unread = true;
            }
            SuspectParameter {
                name: own.name,
                unit: own.unit,
                none: own.none,
                range: own.range,
                tables,
                shown: own.shown.clone(),
            }
        };
        let parameters = (0..cause.parameters.len()).map(&mut parameter).collect();
        Suspect {
            name: cause.id,
            physics: cause.physics,
            form_error: cause.form_error,
            confused_with: cause.confused_with,
            separating: cause.separating,
            parameters,
            blocked,
            is_unread,
            ..Suspect::default()
        }
    }

    /// Computes effects anew where they were found: of the causes found, of what may be it instead, and of those that fitted
    /// alone explain a good part. False where none of them has moved.
    fn refine(&self, model: &K::Model, table: &mut PointTable, found: &PointFinding) -> bool {
        let finding = &found.finding;
        let rivals = finding.causes.iter().flat_map(|own: &Found| &own.rivals);
        let mut effects: Vec<&Effect> = rivals.flat_map(|rival| &rival.effects).collect();
        let mut singles: Vec<&(Effect, f64)> = finding.singles.iter().flatten().collect();
        singles.sort_by(|a, b| b.1.total_cmp(&a.1));
        let most = singles.first().map_or(0.0, |own| own.1);
        let is_good = |own: &&&(Effect, f64)| own.1 > GOOD_PART * most;
        effects.extend(singles.iter().filter(is_good).take(SURVIVORS).map(|own| &own.0));
        let mut moved = false;
        for effect in effects {
            let suspect = &mut table.suspects[effect.candidate];
            moved |= self.recompute(suspect, effect, (model, &table.predicted, &table.points));
        }
        moved
    }

    /// Computes an effect anew at its values, where these are off those it is known at. False where nothing was computed.
    fn recompute(
        &self,
        suspect: &mut Suspect,
        effect: &Effect,
        (model, base, points): (&K::Model, &Grid, &[Point]),
    ) -> bool {
        let (cause, values) = (&self.causes[effect.candidate], &effect.values);
        let is_off = |(own, &value): (&SuspectParameter, &f64)| {
            let Some(size) = own.tables.first().map(|table| (table.0 - own.none).abs()) else {
                return false;
            };
            let known = own.tables.iter().map(|table| table.0).chain([own.none]);
            let nearest = known.map(|at| (value - at).abs()).fold(f64::INFINITY, f64::min);
            nearest > MOVED * size.max((value - own.none).abs())
        };
        if !suspect.parameters.iter().zip(values).any(is_off) {
            return false;
        }
        let read = |values: &[f64]| self.kind.read(&cause.applied(model, values)).ok();
        let none = cause.none();
        let acting: Vec<usize> = (0..values.len())
            .filter(|&k| !suspect.parameters[k].tables.is_empty() && values[k] - none[k] != 0.0)
            .collect();
        // where it cannot be read its effect stays as it was
        let Some(together) = read(values) else { return false };
        if let [k] = acting[..] {
            suspect.parameters[k].know((values[k], together));
            return true;
        }
        let mut near = Vec::new();
        for &k in &acting {
            let mut at = values.clone();
            at[k] += suspect.parameters[k].step(values[k]);
            let Some(grid) = read(&at) else { return false };
            near.push((at[k], grid));
        }
        let of = |&k: &usize| suspect.parameters[k].read(values[k], base);
        let mut parts: Vec<Grid> = acting.iter().map(of).collect();
        // what they do beyond the sum is put to the one that does most: one that hardly moved would turn steep by it
        let most = largest(&parts, base, points);
        let mut rest = together.clone();
        for (_, part) in parts.iter().enumerate().filter(|(k, _)| *k != most) {
            shift(&mut rest, part, base, -1.0);
        }
        parts[most] = rest;
        for ((&k, part), (at, grid)) in acting.iter().zip(parts).zip(near) {
            let mut beside = part.clone();
            shift(&mut beside, &grid, &together, 1.0);
            let own = &mut suspect.parameters[k];
            // beside other values of the others it read something else
            own.tables.truncate(1);
            own.know((values[k], part));
            own.know((at, beside));
        }
        true
    }
}

/// Adds a factor times one grid less another.
fn shift(grid: &mut Grid, one: &Grid, other: &Grid, factor: f64) {
    for ((row, one), other) in grid.iter_mut().zip(one).zip(other) {
        for ((value, one), other) in row.iter_mut().zip(one).zip(other) {
            *value += factor * (one - other);
        }
    }
}

impl SuspectParameter {
    /// Takes up what is read at a value; the first table stays the amount that matters.
    fn know(&mut self, table: (f64, Grid)) {
        self.tables.retain(|own| own.0 - table.0 != 0.0);
        self.tables.push(table);
    }

    /// A small step from a value, inside the range.
    fn step(&self, value: f64) -> f64 {
        let size = self.tables.first().map_or(1.0, |table| STEP * (table.0 - self.none).abs());
        if value + size > self.range.1 { -size } else { size }
    }

    /// What the tables read at a value.
    fn read(&self, value: f64, base: &Grid) -> Grid {
        let mut grid = base.clone();
        for (factor, table) in self.factors(value).into_iter().zip(&self.tables) {
            shift(&mut grid, &table.1, base, factor);
        }
        grid
    }
}

/// Which of some effects is the largest over the deviations of the readings.
fn largest(grids: &[Grid], base: &Grid, points: &[Point]) -> usize {
    let size = |grid: &Grid| -> f64 {
        let rows = grid.iter().zip(base).zip(points);
        let cells = rows.flat_map(|((row, base), point)| {
            row.iter().zip(base).zip(&point.deviation).map(|((a, b), sd)| ((a - b) / sd).powi(2))
        });
        cells.filter(|own| own.is_finite()).sum()
    };
    let sizes: Vec<f64> = grids.iter().map(size).collect();
    (0..sizes.len()).max_by(|&a, &b| sizes[a].total_cmp(&sizes[b])).unwrap_or_default()
}

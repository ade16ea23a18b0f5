//! A folder of tables: what was measured, what a simulator predicts, what it predicts with some of each suspect.

use super::points::{PointColumn, PointData, Scatter};
use crate::files::{Folder, RonIndex, Source, read_ron};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::tables::PointCsv;
use serde::Deserialize;

const MEASURED: &str = "measured.csv";
const PREDICTED: &str = "predicted.csv";
const DESCRIPTION: &str = "table.ron";
const EFFECT: &str = "effect_";
const ALTERNATIVE: &str = "alternative_";
const UNCERTAIN: &str = "uncertain_";
const TABLE: &str = ".csv";
/// Column of names of the points.
const POINT: &str = "point";
/// Relative difference below which a column is the same in two files: what printing leaves.
const SAME: f64 = 1e-9;

/// `table.ron`.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct TableFile {
    title: String,
    conditions: Vec<String>,
    effects: Vec<EffectFile>,
    gain_percent: f64,
    accuracy: Vec<ChannelAccuracy>,
}

impl Default for TableFile {
    fn default() -> Self {
        let (conditions, effects, accuracy) = (vec![], vec![], vec![]);
        Self { title: String::new(), conditions, effects, gain_percent: 0.5, accuracy }
    }
}

/// One table of a suspect, as `table.ron` says it.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EffectFile {
    /// Name of the suspect.
    pub name: String,
    /// Value that the table was computed with.
    pub amount: f64,
    /// Value without effect.
    pub none: f64,
    /// Values it may have; none where nothing is said.
    pub range: Option<(f64, f64)>,
    /// Name of the parameter.
    pub parameter: String,
    /// Its unit.
    pub unit: String,
    /// File of the table; that of the suspect's name where nothing is said.
    pub file: Option<String>,
    /// The physics in a sentence.
    pub physics: String,
    /// Part of the effect by which the table of it is wrong along itself, percent.
    pub form_error_percent: f64,
}

impl Default for EffectFile {
    fn default() -> Self {
        Self {
            name: String::new(),
            amount: 1.0,
            none: 0.0,
            range: None,
            parameter: "amount".to_owned(),
            unit: "1".to_owned(),
            file: None,
            physics: String::new(),
            form_error_percent: 5.0,
        }
    }
}

impl EffectFile {
    fn file(&self) -> String {
        self.file.clone().unwrap_or_else(|| format!("{EFFECT}{}{TABLE}", self.name))
    }
}

/// Calibration of an instrument, as `table.ron` says it.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ChannelAccuracy {
    /// Name of the instrument.
    pub channel: String,
    /// Standard deviation of its gain, percent; that of all where nothing is said.
    pub gain_percent: Option<f64>,
    /// Standard deviation of its zero, in the unit of its channels.
    pub zero: f64,
}

/// Values by point and channel.
type Grid = Vec<Vec<f64>>;

/// A folder of tables as read: rows and columns of all of them are the same.
#[derive(Debug, Clone)]
pub struct EffectTables {
    /// One line about the data.
    pub title: String,
    /// The folder.
    pub folder: String,
    /// The points.
    pub points: PointData,
    /// The columns that were read.
    pub readings: Vec<PointColumn>,
    /// Names and values, by point, of the conditions.
    pub conditions: Vec<(String, Vec<f64>)>,
    /// What is predicted, by point and reading.
    pub predicted: Grid,
    /// What is predicted with some of each suspect.
    pub effects: Vec<(EffectFile, Grid)>,
    /// What other models predict that are thought as good.
    pub alternatives: Vec<Grid>,
    /// What is predicted with an uncertain input moved by its standard deviation.
    pub uncertain: Vec<Grid>,
    /// Standard deviation of the gain of every instrument, percent.
    pub gain_percent: f64,
    /// Instruments that are said to be otherwise.
    pub accuracy: Vec<ChannelAccuracy>,
    /// The places of the fields of `table.ron`.
    pub index: RonIndex,
    /// What a reader should know.
    pub warnings: Vec<Problem>,
}

/// Reads a folder of tables.
///
/// # Errors
/// Every problem of its files, each with file and line.
pub fn read_effect_tables(folder: &Folder) -> Result<EffectTables, Problems> {
    let mut problems = Problems::default();
    let measured = problems.note(folder.read(MEASURED));
    let measured = measured.and_then(|source| noted(PointData::read(&source), &mut problems));
    let predicted = problems.note(folder.read(PREDICTED));
    let predicted = predicted.and_then(|own| noted(PointCsv::read(&own, &[POINT]), &mut problems));
    let file = description(folder, &mut problems);
    let (Some(measured), Some(predicted), Some((file, index))) = (measured, predicted, file) else {
        return problems.into_result(None);
    };
    let mut reading = Reading { folder, measured, file, index, problems, warnings: vec![] };
    let parts = reading.parts(&predicted);
    let Reading { measured: points, file, index, problems, warnings, .. } = reading;
    let shown = folder.display("").trim_end_matches('/').to_owned();
    let title = if file.title.is_empty() { shown.clone() } else { file.title };
    let (gain_percent, accuracy) = (file.gain_percent, file.accuracy);
    problems.into_result(parts.map(|parts| EffectTables {
        title,
        folder: shown,
        points,
        readings: parts.readings,
        conditions: parts.conditions,
        predicted: parts.predicted,
        effects: parts.effects,
        alternatives: parts.alternatives,
        uncertain: parts.uncertain,
        gain_percent,
        accuracy,
        index,
        warnings,
    }))
}

/// What the tables hold.
struct Parts {
    readings: Vec<PointColumn>,
    conditions: Vec<(String, Vec<f64>)>,
    predicted: Grid,
    effects: Vec<(EffectFile, Grid)>,
    alternatives: Vec<Grid>,
    uncertain: Vec<Grid>,
}

/// The value of a result; its problems are noted.
fn noted<T>(result: Result<T, Problems>, problems: &mut Problems) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(more) => {
            problems.append(more);
            None
        }
    }
}

/// `table.ron`, or what stands for it where there is none.
fn description(folder: &Folder, problems: &mut Problems) -> Option<(TableFile, RonIndex)> {
    if !folder.contains(DESCRIPTION) {
        return Some((TableFile::default(), RonIndex::new(&folder.display(DESCRIPTION), "()")));
    }
    let source = problems.note(folder.read(DESCRIPTION))?;
    let read = read_ron::<TableFile>(&source);
    problems.append(read.problems);
    Some((read.value?, read.index))
}

/// The tables while they are read.
struct Reading<'a> {
    folder: &'a Folder,
    measured: PointData,
    file: TableFile,
    index: RonIndex,
    problems: Problems,
    warnings: Vec<Problem>,
}

impl Reading<'_> {
    fn parts(&mut self, predicted: &PointCsv) -> Option<Parts> {
        self.same_rows(predicted)?;
        let files = self.folder.files();
        let of_kind = |kind: &str| -> Vec<String> {
            let own = files.iter().filter(|name| name.starts_with(kind) && name.ends_with(TABLE));
            own.cloned().collect()
        };
        let effects = self.effects(&of_kind(EFFECT));
        let tables: Vec<PointCsv> =
            effects.iter().filter_map(|own| self.other(&own.file())).collect();
        let swept = self.conditions(predicted, &tables);
        let readings = self.measured.columns.iter().filter(|own| !swept.contains(&own.name));
        let readings: Vec<PointColumn> = readings.cloned().collect();
        if readings.is_empty() {
            let message = "no column is left that was measured: all are conditions".to_owned();
            self.problems.push(self.measured.table.header_place(), Fault::Other(message));
        }
        let names: Vec<&str> = readings.iter().map(|own| own.name.as_str()).collect();
        let predicted = self.grid(predicted, &names)?;
        let alternatives = self.grids(&of_kind(ALTERNATIVE), &names);
        let uncertain = self.grids(&of_kind(UNCERTAIN), &names);
        let grids: Vec<Grid> = tables.iter().filter_map(|own| self.grid(own, &names)).collect();
        if grids.len() < effects.len() {
            return None;
        }
        if readings.iter().any(|own| own.scatter == Scatter::Unknown) {
            let message = "no column `_sd` stands beside every reading and no `repeat` numbers repeated rows: \
                 nothing is said with confidence";
            let place = self.measured.table.header_place();
            self.warnings.push(Problem::new(place, Fault::Other(message.to_owned())));
        }
        let values = |name: String| {
            let values = self.measured.table.full_column(&name, "").ok()?;
            Some((name, values))
        };
        Some(Parts {
            readings,
            conditions: swept.into_iter().filter_map(values).collect(),
            predicted,
            effects: effects.into_iter().zip(grids).collect(),
            alternatives: alternatives?,
            uncertain: uncertain?,
        })
    }

    /// The effects of `table.ron`, and those of further files.
    fn effects(&mut self, files: &[String]) -> Vec<EffectFile> {
        let mut effects = self.file.effects.clone();
        for (number, own) in effects.iter().enumerate() {
            let path = |field: &str| self.index.place(&format!("effects[{number}].{field}"));
            if own.name.is_empty() {
                self.problems.push(path("name"), Fault::Empty { of: "the name of a suspect" });
            }
            if let Some(fault) = self.folder.leads_out(&own.file()) {
                self.problems.push(path("file"), fault);
            }
            if !own.amount.is_finite() || own.amount - own.none == 0.0 {
                let message = format!(
                    "is {}, and {} is no effect: expected the amount that the table was computed with",
                    own.amount, own.none
                );
                self.problems.push(path("amount"), Fault::Other(message));
            }
            if let Some((low, high)) = own.range
                && !(low <= own.none && own.none <= high && low < high)
            {
                let message = format!(
                    "is ({low}, {high}), expected lower and upper limit with {} between: that is no effect",
                    own.none
                );
                self.problems.push(path("range"), Fault::Other(message));
            }
        }
        let listed: Vec<String> = effects.iter().map(EffectFile::file).collect();
        effects.retain(|own| self.folder.leads_out(&own.file()).is_none());
        for file in files.iter().filter(|file| !listed.contains(file)) {
            let name = file.trim_start_matches(EFFECT).trim_end_matches(TABLE).to_owned();
            let message = format!(
                "{DESCRIPTION} says nothing of it: it is taken for an amount of 1, where 0 is no effect"
            );
            let place = Place::file(self.folder.display(file));
            self.warnings.push(Problem::new(place, Fault::Other(message)));
            effects.push(EffectFile { name, ..EffectFile::default() });
        }
        if effects.is_empty() {
            let message = format!(
                "there is no suspect: give what is predicted with some of each as `{EFFECT}NAME{TABLE}`"
            );
            self.problems.push(Place::file(self.folder.display("")), Fault::Other(message));
        }
        effects
    }

    /// Reads a further table and sees that its rows are the same.
    fn other(&mut self, file: &str) -> Option<PointCsv> {
        let source: Source = self.problems.note(self.folder.read(file))?;
        let table = noted(PointCsv::read(&source, &[POINT]), &mut self.problems)?;
        self.same_rows(&table)?;
        Some(table)
    }

    fn same_rows(&mut self, other: &PointCsv) -> Option<()> {
        let (own, found) = (&self.measured.table, other.rows());
        if found != own.rows() {
            let message = format!(
                "has {found} rows, {MEASURED} has {}; give the same points in the same order",
                own.rows()
            );
            self.problems.push(other.header_place(), Fault::Other(message));
            return None;
        }
        let ids = other.text_column(POINT).filter(|_| own.has(POINT));
        let differs =
            ids.and_then(|ids| ids.iter().zip(&self.measured.ids).position(|(a, b)| a != b));
        if let Some(row) = differs {
            let message = format!(
                "the point is `{}` in {MEASURED}; give the same points in the same order",
                self.measured.ids[row]
            );
            self.problems.push(other.place(row, POINT), Fault::Other(message));
            return None;
        }
        Some(())
    }

    /// Names of the conditions: those of `table.ron`, and columns without a deviation that are the same in every file.
    fn conditions(&mut self, predicted: &PointCsv, effects: &[PointCsv]) -> Vec<String> {
        for (number, name) in self.file.conditions.iter().enumerate() {
            let place = self.index.place(&format!("conditions[{number}]"));
            if !self.measured.columns.iter().any(|own| own.name == *name) {
                let fault = self.measured.table.missing(name, "name columns of measured.csv").fault;
                self.problems.push(place, fault);
            } else if let Err(problem) = self.measured.table.full_column(name, "") {
                self.problems.push(problem.place, problem.fault);
            }
        }
        let is_same = |own: &PointColumn, other: &PointCsv| {
            let column = other.column(&own.name);
            column.is_none_or(|column| {
                own.values.iter().zip(&column).all(|(a, b)| match (a, b) {
                    (Some(a), Some(b)) => (a - b).abs() <= SAME * a.abs().max(b.abs()),
                    _ => false,
                })
            })
        };
        let is_condition = |own: &&PointColumn| {
            let mut all = std::iter::once(predicted).chain(effects);
            let is_stated = matches!(own.scatter, Scatter::Stated(_));
            self.file.conditions.contains(&own.name)
                || !is_stated && all.all(|other| is_same(own, other))
        };
        self.measured.columns.iter().filter(is_condition).map(|own| own.name.clone()).collect()
    }

    /// The channels of a table by point.
    fn grid(&mut self, table: &PointCsv, names: &[&str]) -> Option<Grid> {
        let remedy =
            "predict every column of measured.csv, or name it in `conditions` of table.ron";
        let columns: Vec<Option<Vec<f64>>> =
            names.iter().map(|name| self.problems.note(table.full_column(name, remedy))).collect();
        let columns = columns.into_iter().collect::<Option<Vec<_>>>()?;
        let row = |p: usize| columns.iter().map(|column| column[p]).collect();
        Some((0..table.rows()).map(row).collect())
    }

    fn grids(&mut self, files: &[String], names: &[&str]) -> Option<Vec<Grid>> {
        let each = files.iter().map(|file| {
            let table = self.other(file)?;
            self.grid(&table, names)
        });
        each.collect()
    }
}

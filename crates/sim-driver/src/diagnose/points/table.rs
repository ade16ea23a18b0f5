//! A folder of tables: what was measured, what a simulator predicts, what it predicts with some of each suspect.

use crate::files::{Folder, RonIndex, Source, read_ron};
use crate::problem::{Fault, Place, Problem, Problems};
use measured_data::{PointColumn, PointCsv, PointData, Scatter};
use model_gap::points::{
    Grid, Instrument, Point, PointTable, Shown, Suspect, SuspectParameter, channels_of,
};
use rotor_base::mean_square;
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
/// Amounts that a range reaches to where none is stated.
const USUAL_RANGE: f64 = 20.0;
/// Part of the prediction that a reading without any misfit is taken to scatter by, where nothing else is known.
const LEAST_SCATTER: f64 = 1e-6;

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

/// One table of a suspect.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct EffectFile {
    name: String,
    amount: f64,
    none: f64,
    range: Option<(f64, f64)>,
    parameter: String,
    unit: String,
    file: Option<String>,
    physics: String,
    form_error_percent: f64,
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

/// Calibration of an instrument.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct ChannelAccuracy {
    channel: String,
    gain_percent: Option<f64>,
    zero: f64,
}

/// A folder of tables as read.
#[derive(Debug, Clone, PartialEq)]
pub struct TableData {
    /// One line about the data.
    pub title: String,
    /// The folder.
    pub folder: String,
    /// The tables.
    pub table: PointTable,
    /// What a reader should know of them.
    pub warnings: Vec<Problem>,
}

/// Reads a folder of tables.
///
/// # Errors
/// Every problem of its files, each with file and line.
pub fn read_table(folder: &Folder) -> Result<TableData, Problems> {
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
    let table = reading.table(&predicted);
    let Reading { file, problems, warnings, .. } = reading;
    let shown = folder.display("").trim_end_matches('/').to_owned();
    let title = if file.title.is_empty() { shown.clone() } else { file.title };
    problems.into_result(table.map(|table| TableData { title, folder: shown, table, warnings }))
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

/// A name of a file as one of the program: names of suspects live as long as it does.
fn lasting(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
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
    fn table(&mut self, predicted: &PointCsv) -> Option<PointTable> {
        self.same_rows(predicted)?;
        let files = self.folder.files();
        let of_kind = |kind: &str| -> Vec<String> {
            let own = files.iter().filter(|name| name.starts_with(kind) && name.ends_with(TABLE));
            own.cloned().collect()
        };
        let effects = self.effects(&of_kind(EFFECT));
        let effect_tables: Vec<PointCsv> =
            effects.iter().filter_map(|own| self.other(&own.file())).collect();
        let conditions = self.conditions(predicted, &effect_tables);
        let readings = self.measured.columns.iter().filter(|own| !conditions.contains(&own.name));
        let readings: Vec<PointColumn> = readings.cloned().collect();
        if readings.is_empty() {
            let message = "no column is left that was measured: all are conditions".to_owned();
            self.problems.push(self.measured.table.header_place(), Fault::Other(message));
        }
        let names: Vec<&str> = readings.iter().map(|own| own.name.as_str()).collect();
        let (channels, instruments) = channels_of(&names);
        let base = self.grid(predicted, &names)?;
        let alternatives = self.grids(&of_kind(ALTERNATIVE), &names);
        let uncertain = self.grids(&of_kind(UNCERTAIN), &names);
        let instruments = self.instruments(instruments);
        if effect_tables.len() < effects.len() {
            return None;
        }
        let grids: Vec<Grid> =
            effect_tables.iter().filter_map(|own| self.grid(own, &names)).collect();
        let suspects = self.suspects(&effects, grids)?;
        let values = |name: &String| self.measured.table.full_column(name, "");
        let swept: Vec<Vec<f64>> = conditions.iter().filter_map(|name| values(name).ok()).collect();
        let deviations: Vec<Vec<f64>> =
            readings.iter().enumerate().map(|(c, own)| deviations(own, &base, c)).collect();
        let point = |p: usize| Point {
            id: self.measured.ids[p].clone(),
            group: self.measured.groups[p],
            conditions: swept.iter().map(|column| column[p]).collect(),
            measured: readings.iter().map(|own| own.values[p]).collect(),
            deviation: deviations.iter().map(|own| own[p]).collect(),
        };
        let knows_deviations = readings.iter().all(|own| own.scatter != Scatter::Unknown);
        if !knows_deviations {
            let message = "no column `_sd` stands beside every reading and no `repeat` numbers repeated rows: \
                 nothing is said with confidence";
            let place = self.measured.table.header_place();
            self.warnings.push(Problem::new(place, Fault::Other(message.to_owned())));
        }
        Some(PointTable {
            points: (0..self.measured.ids.len()).map(point).collect(),
            channels,
            instruments,
            conditions,
            predicted: base,
            suspects,
            alternatives: alternatives?,
            uncertain: uncertain?,
            knows_deviations,
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

    fn instruments(&mut self, names: Vec<String>) -> Vec<Instrument> {
        for (number, own) in self.file.accuracy.iter().enumerate() {
            if !names.contains(&own.channel) {
                let place = self.index.place(&format!("accuracy[{number}].channel"));
                let fault = Fault::Unknown {
                    what: "channel",
                    found: own.channel.clone(),
                    known: names.join(", "),
                    nearest: None,
                };
                self.problems.push(place, fault);
            }
            let given = [own.gain_percent.unwrap_or_default(), own.zero];
            if given.iter().any(|value| !(value.is_finite() && *value >= 0.0)) {
                let place = self.index.place(&format!("accuracy[{number}]"));
                let message = "a standard deviation is at least 0".to_owned();
                self.problems.push(place, Fault::Other(message));
            }
        }
        let one = |name: String| {
            let stated = self.file.accuracy.iter().find(|own| own.channel == name);
            let gain = stated.and_then(|own| own.gain_percent).unwrap_or(self.file.gain_percent);
            Instrument { gain: gain / 100.0, zero: stated.map_or(0.0, |own| own.zero), name }
        };
        names.into_iter().map(one).collect()
    }

    /// Suspects from their tables: those of one name are one suspect, those of one parameter beside it two of its amounts.
    fn suspects(&mut self, effects: &[EffectFile], grids: Vec<Grid>) -> Option<Vec<Suspect>> {
        if grids.len() != effects.len() {
            return None;
        }
        let mut suspects: Vec<Suspect> = Vec::new();
        for ((number, effect), grid) in effects.iter().enumerate().zip(grids) {
            let place =
                suspects.iter().position(|own| own.name == effect.name).unwrap_or_else(|| {
                    suspects.push(Suspect {
                        name: lasting(&effect.name),
                        physics: lasting(&effect.physics),
                        form_error: effect.form_error_percent / 100.0,
                        ..Suspect::default()
                    });
                    suspects.len() - 1
                });
            let parameters = &mut suspects[place].parameters;
            let table = (effect.amount, grid);
            match parameters.iter_mut().find(|own| own.name == effect.parameter) {
                None => {
                    let wide = USUAL_RANGE * (effect.amount - effect.none).abs();
                    parameters.push(SuspectParameter {
                        name: lasting(&effect.parameter),
                        unit: lasting(&effect.unit),
                        none: effect.none,
                        range: effect.range.unwrap_or((effect.none - wide, effect.none + wide)),
                        tables: vec![table],
                        shown: Shown::Itself,
                    });
                }
                Some(own) if own.tables.iter().all(|own| own.0 - effect.amount != 0.0) => {
                    own.tables.push(table);
                }
                Some(_) => {
                    let message = format!(
                        "`{}` of `{}` has this amount already: give each amount once",
                        effect.parameter, effect.name
                    );
                    let path = format!("effects[{number}].amount");
                    self.problems.push(self.index.place(&path), Fault::Other(message));
                }
            }
        }
        Some(suspects)
    }
}

/// Standard deviations of a column, by point.
fn deviations(own: &PointColumn, predicted: &Grid, channel: usize) -> Vec<f64> {
    match &own.scatter {
        Scatter::Stated(stated) => stated.clone(),
        Scatter::Repeated(one) => vec![*one; own.values.len()],
        Scatter::Unknown => {
            let pairs = own.values.iter().zip(predicted);
            let off: Vec<f64> =
                pairs.filter_map(|(read, row)| read.map(|read| read - row[channel])).collect();
            let size: Vec<f64> = predicted.iter().map(|row| row[channel]).collect();
            let least = LEAST_SCATTER * mean_square(&size).sqrt().max(LEAST_SCATTER);
            vec![mean_square(&off).sqrt().max(least); own.values.len()]
        }
    }
}

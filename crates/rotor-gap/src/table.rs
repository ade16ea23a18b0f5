//! A folder of tables as what the engine asks for.

use measured_data::problem::{Fault, Problem, Problems};
use measured_data::{EffectTables, Folder, Scatter, read_effect_tables};
use model_gap::points::{
    Instrument, Point, PointTable, Shown, Suspect, SuspectParameter, channels_of, lasting,
};

/// Amounts that a range reaches to where none is stated.
const USUAL_RANGE: f64 = 20.0;

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
    let read = read_effect_tables(folder)?;
    let mut problems = Problems::default();
    let names: Vec<&str> = read.readings.iter().map(|own| own.name.as_str()).collect();
    let (channels, instruments) = channels_of(&names);
    let instruments = instruments_of(&read, instruments, &mut problems);
    let suspects = suspects_of(&read, &mut problems);
    let deviations: Vec<Vec<f64>> = read
        .readings
        .iter()
        .enumerate()
        .map(|(c, own)| {
            let predicted: Vec<f64> = read.predicted.iter().map(|row| row[c]).collect();
            own.scatter.deviations(&own.values, &predicted)
        })
        .collect();
    let point = |p: usize| Point {
        id: read.points.ids[p].clone(),
        group: read.points.groups[p],
        is_reference: read.points.references[p],
        conditions: read.conditions.iter().map(|(_, values)| values[p]).collect(),
        measured: read.readings.iter().map(|own| own.values[p]).collect(),
        deviation: deviations.iter().map(|own| own[p]).collect(),
    };
    let table = PointTable {
        points: (0..read.points.ids.len()).map(point).collect(),
        channels,
        instruments,
        conditions: read.conditions.iter().map(|(name, _)| name.clone()).collect(),
        suspects,
        knows_deviations: read.readings.iter().all(|own| own.scatter != Scatter::Unknown),
        predicted: read.predicted,
        alternatives: read.alternatives,
        uncertain: read.uncertain,
    };
    let EffectTables { title, folder, warnings, .. } = read;
    problems.into_result(Some(TableData { title, folder, table, warnings }))
}

fn instruments_of(
    read: &EffectTables,
    names: Vec<String>,
    problems: &mut Problems,
) -> Vec<Instrument> {
    for (number, own) in read.accuracy.iter().enumerate() {
        if !names.contains(&own.channel) {
            let place = read.index.place(&format!("accuracy[{number}].channel"));
            let fault = Fault::Unknown {
                what: "channel",
                found: own.channel.clone(),
                known: names.join(", "),
                nearest: None,
            };
            problems.push(place, fault);
        }
        let given = [own.gain_percent.unwrap_or_default(), own.zero];
        if given.iter().any(|value| !(value.is_finite() && *value >= 0.0)) {
            let place = read.index.place(&format!("accuracy[{number}]"));
            problems.push(place, Fault::Other("a standard deviation is at least 0".to_owned()));
        }
    }
    let one = |name: String| {
        let stated = read.accuracy.iter().find(|own| own.channel == name);
        let gain = stated.and_then(|own| own.gain_percent).unwrap_or(read.gain_percent);
        Instrument { gain: gain / 100.0, zero: stated.map_or(0.0, |own| own.zero), name }
    };
    names.into_iter().map(one).collect()
}

/// Suspects from their tables: those of one name are one suspect, those of one parameter beside it more of its amounts.
fn suspects_of(read: &EffectTables, problems: &mut Problems) -> Vec<Suspect> {
    let mut suspects: Vec<Suspect> = Vec::new();
    for (number, (effect, grid)) in read.effects.iter().enumerate() {
        let place = suspects.iter().position(|own| own.name == effect.name).unwrap_or_else(|| {
            suspects.push(Suspect {
                name: lasting(&effect.name),
                physics: lasting(&effect.physics),
                form_error: effect.form_error_percent / 100.0,
                ..Suspect::default()
            });
            suspects.len() - 1
        });
        let parameters = &mut suspects[place].parameters;
        let table = (effect.amount, grid.clone());
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
                problems.push(read.index.place(&path), Fault::Other(message));
            }
        }
    }
    suspects
}

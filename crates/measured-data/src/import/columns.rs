//! Which columns of a source are taken, under which name, in which unit.

use crate::problem::RecordFault;
use crate::tables::{Channel, Dimension, Unit};

/// A column that is taken.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Taken {
    /// Its number in the source, from 0.
    pub(super) source: usize,
    /// Its name, and the unit it is written in.
    pub(super) channel: Channel,
    /// Factor from the source's unit.
    pub(super) factor: f64,
}

/// What the user says about the columns.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ColumnOptions {
    /// `--columns`: `NAME_UNIT`, `NAME_UNIT=SOURCE`, or `-`, separated by commas.
    pub columns: Option<String>,
    /// `--input`: name of the input, for generic loops.
    pub input: Option<String>,
    /// `--response`: name of the output, for generic loops.
    pub response: Option<String>,
    /// `--convert`: names with the unit to convert into, separated by commas.
    pub convert: Option<String>,
}

/// The columns of a source that are named, before they are chosen from.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Named {
    pub(super) columns: Vec<(usize, Channel)>,
    /// Columns left out because they have no known unit.
    pub(super) left_out: Vec<String>,
}

/// Names the columns of a source of `count` columns with the names it gives itself, if any.
pub(super) fn name_columns(
    options: &ColumnOptions,
    own: Option<&[String]>,
    count: usize,
) -> Result<Named, RecordFault> {
    let Some(text) = &options.columns else {
        let Some(own) = own else {
            return Err(RecordFault::NoHeader { count });
        };
        let mut named = Named { columns: vec![], left_out: vec![] };
        for (i, name) in own.iter().enumerate() {
            match Channel::parse(name) {
                Some(channel) => named.columns.push((i, channel)),
                None => named.left_out.push(name.clone()),
            }
        }
        return Ok(named);
    };
    let entries: Vec<&str> = text.split(',').map(str::trim).collect();
    let find = |source: &str| -> Option<usize> {
        if let Some(number) = source.strip_prefix('#') {
            return number.parse::<usize>().ok()?.checked_sub(1).filter(|i| *i < count);
        }
        own?.iter().position(|name| name == source || Channel::plain_name(name) == source)
    };
    let parts = |entry: &str| -> Result<(Channel, Option<String>), RecordFault> {
        let (name, source) = match entry.split_once('=') {
            Some((name, source)) => (name, Some(source.trim().to_owned())),
            None => (entry, None),
        };
        let unknown = || RecordFault::ColumnEntry { entry: entry.to_owned() };
        Channel::parse(name).map(|channel| (channel, source)).ok_or_else(unknown)
    };
    let by_name = entries.iter().any(|e| e.contains('='))
        || (own.is_some() && entries.iter().all(|e| *e == "-" || find(e).is_some()));
    if !by_name && entries.len() != count {
        return Err(RecordFault::ColumnCount { named: entries.len(), found: count });
    }
    let mut columns = Vec::new();
    for (i, entry) in entries.iter().enumerate().filter(|(_, e)| **e != "-") {
        let (channel, source) = parts(entry)?;
        let at = if by_name {
            let wanted = source.unwrap_or_else(|| (*entry).to_owned());
            find(&wanted).ok_or_else(|| RecordFault::NoSuchColumn {
                wanted,
                found: own.map_or_else(|| format!("#1 to #{count}"), |own| own.join(", ")),
                remedy: "correct --columns",
            })?
        } else {
            i
        };
        columns.push((at, channel));
    }
    Ok(Named { columns, left_out: vec![] })
}

/// What the columns make up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Shape {
    /// `command` and `displacement` of an actuator.
    Bench,
    /// Any input and any output.
    Loop,
}

/// The columns taken: the time first (none if the source has none), then input and output, then what
/// a bench may have besides.
pub(super) struct Choice {
    pub(super) time: Option<Taken>,
    pub(super) columns: Vec<Taken>,
    pub(super) shape: Shape,
    pub(super) left_out: Vec<String>,
}

impl Choice {
    /// Labels of the columns written.
    pub(super) fn labels(&self) -> Vec<String> {
        std::iter::once("time_s".to_owned())
            .chain(self.columns.iter().map(|c| c.channel.label()))
            .collect()
    }

    /// Takes the columns out of a row of the source; `index` stands for the time where there is none.
    pub(super) fn take(&self, row: &[f64], step_s: f64, index: usize, into: &mut Vec<f64>) {
        into.clear();
        into.push(match &self.time {
            Some(time) => time.factor * row[time.source],
            None => step_s * index as f64,
        });
        into.extend(self.columns.iter().map(|c| c.factor * row[c.source]));
    }
}

/// Chooses from the named columns. `wanted` forces the shape.
pub(super) fn choose(
    named: Named,
    options: &ColumnOptions,
    wanted: Option<Shape>,
    sampling_hz: Option<f64>,
) -> Result<Choice, RecordFault> {
    let Named { columns, mut left_out } = named;
    let (times, data): (Vec<_>, Vec<_>) = columns.into_iter().partition(|(_, c)| c.is_time());
    let second = Unit::find("s").ok_or(RecordFault::NoTime)?;
    let time = match times.first() {
        Some((source, channel)) => {
            let factor = channel.unit.factor_to(second).ok_or(RecordFault::NoTime)?;
            let channel = Channel { name: "time".to_owned(), unit: second };
            Some(Taken { source: *source, channel, factor })
        }
        None if sampling_hz.is_some() => None,
        None => {
            // a time without unit is the likelier flaw than no time
            return Err(match left_out.iter().find(|n| n.trim().to_lowercase().starts_with('t')) {
                Some(found) if Channel::plain_name(found) == "time" || found.trim() == "t" => {
                    RecordFault::UnknownUnit { found: found.clone(), known: Unit::known() }
                }
                _ => RecordFault::NoTime,
            });
        }
    };
    let is = |channel: &Channel, name: &str, dimension: Dimension| {
        channel.name == name && channel.unit.dimension == dimension
    };
    let has = |name: &str, d: Dimension| data.iter().any(|(_, c)| is(c, name, d));
    let bench = has("command", Dimension::Voltage) && has("displacement", Dimension::Length);
    let shape =
        wanted.unwrap_or(if bench && options.input.is_none() && options.response.is_none() {
            Shape::Bench
        } else {
            Shape::Loop
        });
    let columns = match shape {
        Shape::Bench => bench_columns(&data, &mut left_out)?,
        Shape::Loop => loop_columns(&data, options, &mut left_out)?,
    };
    for taken in time.iter().chain(&columns) {
        let name = &taken.channel.name;
        let alike =
            |c: &Channel| if taken.channel.is_time() { c.is_time() } else { c.name == *name };
        let count = times.iter().chain(&data).filter(|(_, c)| alike(c)).count();
        if count > 1 {
            return Err(RecordFault::RepeatedName { name: name.clone(), count });
        }
    }
    Ok(Choice { time, columns, shape, left_out })
}

fn names(data: &[(usize, Channel)]) -> String {
    data.iter().map(|(_, c)| c.label()).collect::<Vec<_>>().join(", ")
}

/// The columns of an actuator's bench, in its units.
fn bench_columns(
    data: &[(usize, Channel)],
    left_out: &mut Vec<String>,
) -> Result<Vec<Taken>, RecordFault> {
    let known = [
        ("command", "V", true),
        ("displacement", "um", true),
        ("amplifier", "V", false),
        ("temperature", "C", false),
        ("load", "N", false),
    ];
    let mut taken = Vec::new();
    for (name, unit, required) in known {
        let Some((source, channel)) = data.iter().find(|(_, c)| c.name == name) else {
            if required {
                return Err(RecordFault::NoSuchColumn {
                    wanted: format!("{name}_{unit}"),
                    found: names(data),
                    remedy: "name it with --columns, or import with --kind generic-loop",
                });
            }
            continue;
        };
        taken.push(converted(*source, channel, unit)?);
    }
    left_out.extend(
        data.iter().filter(|(i, _)| taken.iter().all(|t| t.source != *i)).map(|(_, c)| c.label()),
    );
    Ok(taken)
}

fn converted(source: usize, channel: &Channel, unit: &str) -> Result<Taken, RecordFault> {
    let from = channel.unit;
    let unknown = || RecordFault::UnknownUnit { found: unit.to_owned(), known: Unit::known() };
    let unit = Unit::find(unit).ok_or_else(unknown)?;
    let factor = from
        .factor_to(unit)
        .ok_or(RecordFault::NoConversion { from: from.symbol, to: unit.symbol })?;
    Ok(Taken { source, channel: Channel { name: channel.name.clone(), unit }, factor })
}

/// Input and output of a generic loop, in their own units or those asked for.
fn loop_columns(
    data: &[(usize, Channel)],
    options: &ColumnOptions,
    left_out: &mut Vec<String>,
) -> Result<Vec<Taken>, RecordFault> {
    let find = |wanted: &String| {
        let matches = |c: &Channel| c.name == *wanted || c.label() == *wanted;
        data.iter().position(|(_, c)| matches(c)).ok_or_else(|| RecordFault::NoSuchColumn {
            wanted: wanted.clone(),
            found: names(data),
            remedy: "correct --input or --response",
        })
    };
    let input = options.input.as_ref().map(find).transpose()?;
    let output = options.response.as_ref().map(find).transpose()?;
    let other = |taken: usize| (data.len() == 2).then_some(1 - taken);
    let (input, output) = match (input, output) {
        (Some(i), Some(o)) => (Some(i), Some(o)),
        (Some(i), None) => (Some(i), other(i)),
        (None, Some(o)) => (other(o), Some(o)),
        (None, None) if data.len() == 2 => (Some(0), Some(1)),
        (None, None) => (None, None),
    };
    let (Some(input), Some(output)) = (input, output) else {
        let remedy = "--input NAME --response NAME";
        return Err(RecordFault::AmbiguousColumns { columns: names(data), remedy });
    };
    let wanted = wanted_units(options)?;
    if let Some(unknown) = wanted.iter().find(|w| data.iter().all(|(_, c)| c.name != w.name)) {
        return Err(RecordFault::NoSuchColumn {
            wanted: unknown.name.clone(),
            found: names(data),
            remedy: "correct --convert",
        });
    }
    left_out.extend(
        data.iter()
            .enumerate()
            .filter(|(i, _)| *i != input && *i != output)
            .map(|(_, (_, c))| c.label()),
    );
    [input, output]
        .into_iter()
        .map(|i| {
            let (source, channel) = &data[i];
            let unit =
                wanted.iter().find(|w| w.name == channel.name).map_or(channel.unit, |w| w.unit);
            converted(*source, channel, unit.symbol)
        })
        .collect()
}

/// The units of `--convert`.
pub(super) fn wanted_units(options: &ColumnOptions) -> Result<Vec<Channel>, RecordFault> {
    let Some(text) = &options.convert else {
        return Ok(vec![]);
    };
    text.split(',')
        .map(|entry| {
            let unknown = || RecordFault::UnknownUnit {
                found: entry.trim().to_owned(),
                known: Unit::known(),
            };
            Channel::parse(entry).ok_or_else(unknown)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(columns: &str) -> ColumnOptions {
        ColumnOptions { columns: Some(columns.to_owned()), ..ColumnOptions::default() }
    }

    fn named(columns: &str, own: Option<&[&str]>, count: usize) -> Result<String, RecordFault> {
        let own: Option<Vec<String>> = own.map(|o| o.iter().map(|s| (*s).to_owned()).collect());
        let named = name_columns(&options(columns), own.as_deref(), count)?;
        let text: Vec<String> =
            named.columns.iter().map(|(i, c)| format!("{i}:{}", c.label())).collect();
        Ok(text.join(" "))
    }

    #[test]
    fn by_position_by_name_and_by_number() {
        assert_eq!(
            named("-,time_s,displacement_um,command_V", None, 4).unwrap(),
            "1:time_s 2:displacement_um 3:command_V"
        );
        let own = Some(&["t", "x", "u"][..]);
        assert_eq!(named("time_s=t,command_V=u", own, 3).unwrap(), "0:time_s 2:command_V");
        assert_eq!(named("time_ms,x_um,u_V", own, 3).unwrap(), "0:time_ms 1:x_um 2:u_V");
        assert_eq!(named("u_mV=#3,time_s=#1", None, 3).unwrap(), "2:u_mV 0:time_s");
    }

    #[test]
    fn entries_that_make_no_sense() {
        assert!(matches!(named("time_s,x", None, 2), Err(RecordFault::ColumnEntry { .. })));
        assert!(matches!(named("time_s", None, 2), Err(RecordFault::ColumnCount { .. })));
        assert!(matches!(named("time_s=#9", None, 2), Err(RecordFault::NoSuchColumn { .. })));
        let none = name_columns(&ColumnOptions::default(), None, 4);
        assert!(matches!(none, Err(RecordFault::NoHeader { count: 4 })));
    }

    fn chosen(columns: &str, more: &ColumnOptions) -> Result<String, RecordFault> {
        let count = columns.split(',').count();
        let named = name_columns(&options(columns), None, count)?;
        let choice = choose(named, more, None, None)?;
        let taken: Vec<String> =
            choice.columns.iter().map(|c| format!("{} {}", c.channel.label(), c.factor)).collect();
        Ok(format!("{:?} {}", choice.shape, taken.join(", ")))
    }

    #[test]
    fn benches_are_converted_and_loops_keep_their_units() {
        let none = ColumnOptions::default();
        assert_eq!(
            chosen("time_ms,displacement_mm,command_mV,load_lb", &none).unwrap(),
            "Bench command_V 0.001, displacement_um 1000, load_N 4.4482216152605"
        );
        assert_eq!(
            chosen("time_s,displacement_in,force_kip", &none).unwrap(),
            "Loop displacement_in 1, force_kip 1"
        );
        let turned = ColumnOptions { input: Some("force".into()), ..none.clone() };
        assert_eq!(
            chosen("time_s,displacement_in,force_kip", &turned).unwrap(),
            "Loop force_kip 1, displacement_in 1"
        );
        let si = ColumnOptions { convert: Some("displacement_mm".into()), ..none.clone() };
        assert_eq!(
            chosen("time_s,displacement_in,force_kip", &si).unwrap(),
            "Loop displacement_mm 25.4, force_kip 1"
        );
        let wrong = ColumnOptions { convert: Some("displacement_N".into()), ..none.clone() };
        assert!(matches!(
            chosen("time_s,displacement_in,force_kip", &wrong),
            Err(RecordFault::NoConversion { .. })
        ));
        assert!(matches!(
            chosen("time_s,a_V,b_V,c_V", &none),
            Err(RecordFault::AmbiguousColumns { .. })
        ));
        assert!(matches!(chosen("a_V,b_V", &none), Err(RecordFault::NoTime)));
    }
}

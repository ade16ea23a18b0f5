//! Which columns of a source are taken, under which name, in which unit.

use super::ImportKind;
use super::gather::{Gather, Reduction};
use crate::problem::Fault;
use crate::tables::{Channel, Dimension, QUANTITIES, Unit, input_and_output, unknown_unit};

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

/// The columns of a source that are named, before they are chosen from, and those left out because
/// they have no known unit.
type Named = (Vec<(usize, Channel)>, Vec<String>);

/// Names the columns of a source of `count` columns with the names it gives itself, if any.
pub(super) fn name_columns(
    options: &ColumnOptions,
    own: Option<&[String]>,
    count: usize,
) -> Result<Named, Fault> {
    let Some(text) = &options.columns else {
        let Some(own) = own else {
            return Err(Fault::Other(format!(
                "the {count} columns have no names; name them: --columns time_s,... with units, - for a column to leave out"
            )));
        };
        let (mut columns, mut left_out) = Named::default();
        for (i, name) in own.iter().enumerate() {
            match Channel::parse(name) {
                Some(channel) => columns.push((i, channel)),
                None => left_out.push(name.clone()),
            }
        }
        return Ok((columns, left_out));
    };
    let entries: Vec<&str> = text.split(',').map(str::trim).collect();
    let find = |source: &str| -> Option<usize> {
        if let Some(number) = source.strip_prefix('#') {
            return number.parse::<usize>().ok()?.checked_sub(1).filter(|i| *i < count);
        }
        own?.iter().position(|name| name == source || Channel::plain_name(name) == source)
    };
    let by_name = entries.iter().any(|e| e.contains('='))
        || (own.is_some() && entries.iter().all(|e| *e == "-" || find(e).is_some()));
    if !by_name && entries.len() != count {
        let named = entries.len();
        let message = format!("--columns names {named} columns, the file has {count}");
        return Err(Fault::Other(message));
    }
    let mut columns = Vec::new();
    for (i, entry) in entries.iter().enumerate().filter(|(_, e)| **e != "-") {
        let (name, source) = entry.split_once('=').unwrap_or((*entry, *entry));
        let channel = Channel::parse(name).ok_or_else(|| {
            Fault::Other(format!(
                "the entry `{entry}` of --columns is not understood; write NAME_UNIT, NAME_UNIT=SOURCE (a header, a MAT field or #number), or - for a column to leave out"
            ))
        })?;
        let missing = || Fault::MissingColumn {
            wanted: source.trim().to_owned(),
            found: own.map_or_else(|| format!("#1 to #{count}"), |own| own.join(", ")),
            remedy: "correct --columns",
        };
        let at = if by_name { find(source.trim()).ok_or_else(missing)? } else { i };
        columns.push((at, channel));
    }
    Ok((columns, vec![]))
}

/// The columns taken: the time first (none if the source has none), then input and output, then what
/// a bench may have besides.
pub(super) struct Choice {
    pub(super) time: Option<Taken>,
    pub(super) columns: Vec<Taken>,
    pub(super) kind: ImportKind,
    pub(super) left_out: Vec<String>,
}

impl Choice {
    /// Labels of the columns written.
    pub(super) fn labels(&self) -> Vec<String> {
        std::iter::once("time_s".to_owned())
            .chain(self.columns.iter().map(|c| c.channel.label()))
            .collect()
    }

    /// The columns taken, the time first if the source has one.
    pub(super) fn taken(&self) -> impl Iterator<Item = &Taken> {
        self.time.iter().chain(&self.columns)
    }

    /// The numbers of the columns taken, in the units written.
    pub(super) fn converted(
        &self,
        numbers: impl IntoIterator<Item = f64>,
    ) -> impl Iterator<Item = f64> {
        self.taken().zip(numbers).map(|(taken, number)| taken.factor * number)
    }

    /// An empty record of these columns.
    pub(super) fn gather(&self, file: &str, reduction: Reduction) -> Gather {
        let sampling_hz = reduction.sampling_hz.filter(|_| self.time.is_none());
        Gather::new(file, self.labels(), Reduction { sampling_hz, ..reduction })
    }
}

/// Chooses from the named columns. `wanted` forces the kind of data folder.
pub(super) fn choose(
    (columns, mut left_out): Named,
    options: &ColumnOptions,
    wanted: Option<ImportKind>,
    sampling_hz: Option<f64>,
) -> Result<Choice, Fault> {
    let (times, data): (Vec<_>, Vec<_>) = columns.into_iter().partition(|(_, c)| c.is_time());
    let time = match times.first() {
        Some((source, channel)) => {
            let time = converted(*source, channel, "s")?;
            Some(Taken { channel: Channel { name: "time".to_owned(), ..time.channel }, ..time })
        }
        None if sampling_hz.is_some() => None,
        None => {
            // a time without unit is the likelier flaw than no time
            let unitless =
                |name: &&String| Channel::plain_name(name) == "time" || name.trim() == "t";
            let message = "there is no time column; name one `time_s`, or give --sampling-hz";
            let no_time = || Fault::Other(message.to_owned());
            return Err(left_out.iter().find(unitless).map_or_else(no_time, |n| unknown_unit(n)));
        }
    };
    let has = |name: &str, dimension: Dimension| {
        data.iter().any(|(_, c)| c.name == name && c.unit.dimension == dimension)
    };
    let bench = has("command", Dimension::Voltage) && has("displacement", Dimension::Length);
    let is_loop = !bench || options.input.is_some() || options.response.is_some();
    let found = if is_loop { ImportKind::GenericLoop } else { ImportKind::ActuatorBench };
    let kind = wanted.unwrap_or(found);
    let columns = match kind {
        ImportKind::ActuatorBench => bench_columns(&data)?,
        _ => loop_columns(&data, options)?,
    };
    let is_taken = |source: usize| columns.iter().any(|taken| taken.source == source);
    left_out.extend(data.iter().filter(|(i, _)| !is_taken(*i)).map(|(_, c)| c.label()));
    let choice = Choice { time, columns, kind, left_out };
    for Taken { channel, .. } in choice.taken() {
        let name = &channel.name;
        let alike = |c: &Channel| if channel.is_time() { c.is_time() } else { c.name == *name };
        let count = times.iter().chain(&data).filter(|(_, c)| alike(c)).count();
        if count > 1 {
            return Err(Fault::Other(format!(
                "{count} columns are called `{name}`: say which one is meant by its number, --columns time_s=#1,{name}_UNIT=#2,... (the others are then left out), or rename them in the header"
            )));
        }
    }
    Ok(choice)
}

fn names(data: &[(usize, Channel)]) -> String {
    data.iter().map(|(_, c)| c.label()).collect::<Vec<_>>().join(", ")
}

/// The columns of an actuator's bench, in its units.
fn bench_columns(data: &[(usize, Channel)]) -> Result<Vec<Taken>, Fault> {
    let mut taken = Vec::new();
    for (name, unit, required) in &QUANTITIES[1..] {
        match data.iter().find(|(_, c)| c.name == *name) {
            Some((source, channel)) => taken.push(converted(*source, channel, unit)?),
            None if *required => {
                let (wanted, found) = (format!("{name}_{unit}"), names(data));
                let remedy = "name it with --columns, or import with --kind generic-loop";
                return Err(Fault::MissingColumn { wanted, found, remedy });
            }
            None => {}
        }
    }
    Ok(taken)
}

fn converted(source: usize, channel: &Channel, unit: &str) -> Result<Taken, Fault> {
    let from = channel.unit;
    let unit = Unit::find(unit).ok_or_else(|| unknown_unit(unit))?;
    let factor = from.factor_to(unit).ok_or_else(|| {
        Fault::Other(format!(
            "{} cannot be converted into {}: they measure different things",
            from.symbol, unit.symbol
        ))
    })?;
    Ok(Taken { source, channel: Channel { name: channel.name.clone(), unit }, factor })
}

/// Input and output of a generic loop, in their own units or those asked for.
fn loop_columns(data: &[(usize, Channel)], options: &ColumnOptions) -> Result<Vec<Taken>, Fault> {
    let missing = |wanted: &str, remedy| Fault::MissingColumn {
        wanted: wanted.to_owned(),
        found: names(data),
        remedy,
    };
    let find = |wanted: &String| {
        let at = data.iter().position(|(_, c)| c.name == *wanted || c.label() == *wanted);
        at.ok_or_else(|| missing(wanted, "correct --input or --response"))
    };
    let input = options.input.as_ref().map(find).transpose()?;
    let output = options.response.as_ref().map(find).transpose()?;
    let all: Vec<usize> = (0..data.len()).collect();
    let pair = input_and_output(&all, [input, output]).ok_or_else(|| {
        let remedy = "--input NAME --response NAME";
        Fault::AmbiguousColumns { columns: names(data), remedy }
    })?;
    let wanted = wanted_units(options)?;
    if let Some(unknown) = wanted.iter().find(|w| data.iter().all(|(_, c)| c.name != w.name)) {
        return Err(missing(&unknown.name, "correct --convert"));
    }
    pair.into_iter()
        .map(|i| {
            let (source, channel) = &data[i];
            let unit =
                wanted.iter().find(|w| w.name == channel.name).map_or(channel.unit, |w| w.unit);
            converted(*source, channel, unit.symbol)
        })
        .collect()
}

/// The units of `--convert`.
fn wanted_units(options: &ColumnOptions) -> Result<Vec<Channel>, Fault> {
    let entries = options.convert.iter().flat_map(|text| text.split(','));
    entries.map(|entry| Channel::parse(entry).ok_or_else(|| unknown_unit(entry.trim()))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn options(columns: &str) -> ColumnOptions {
        ColumnOptions { columns: Some(columns.to_owned()), ..ColumnOptions::default() }
    }

    fn named(columns: &str, own: Option<&[&str]>, count: usize) -> Result<String, Fault> {
        let own: Option<Vec<String>> = own.map(|o| o.iter().map(|s| (*s).to_owned()).collect());
        let named = name_columns(&options(columns), own.as_deref(), count)?;
        let text: Vec<String> = named.0.iter().map(|(i, c)| format!("{i}:{}", c.label())).collect();
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
        let said = |columns| named(columns, None, 2).unwrap_err().to_string();
        assert!(said("time_s,x").contains("the entry `x` of --columns is not understood"));
        assert!(said("time_s").contains("--columns names 1 columns, the file has 2"));
        assert!(said("time_s=#9").contains("the column `#9` is missing, the header has #1 to #2"));
        let none = name_columns(&ColumnOptions::default(), None, 4).unwrap_err().to_string();
        assert!(none.contains("the 4 columns have no names"), "{none}");
    }

    fn chosen(columns: &str, more: &ColumnOptions) -> Result<String, Fault> {
        let count = columns.split(',').count();
        let named = name_columns(&options(columns), None, count)?;
        let choice = choose(named, more, None, None)?;
        let taken: Vec<String> =
            choice.columns.iter().map(|c| format!("{} {}", c.channel.label(), c.factor)).collect();
        Ok(format!("{:?} {}", choice.kind, taken.join(", ")))
    }

    #[test]
    fn benches_are_converted_and_loops_keep_their_units() {
        let none = ColumnOptions::default();
        assert_eq!(
            chosen("time_ms,displacement_mm,command_mV,load_lb", &none).unwrap(),
            "ActuatorBench command_V 0.001, displacement_um 1000, load_N 4.4482216152605"
        );
        assert_eq!(
            chosen("time_s,displacement_in,force_kip", &none).unwrap(),
            "GenericLoop displacement_in 1, force_kip 1"
        );
        let turned = ColumnOptions { input: Some("force".into()), ..none.clone() };
        assert_eq!(
            chosen("time_s,displacement_in,force_kip", &turned).unwrap(),
            "GenericLoop force_kip 1, displacement_in 1"
        );
        let si = ColumnOptions { convert: Some("displacement_mm".into()), ..none.clone() };
        assert_eq!(
            chosen("time_s,displacement_in,force_kip", &si).unwrap(),
            "GenericLoop displacement_mm 25.4, force_kip 1"
        );
        let wrong = ColumnOptions { convert: Some("displacement_N".into()), ..none.clone() };
        let text = chosen("time_s,displacement_in,force_kip", &wrong).unwrap_err().to_string();
        assert!(text.contains("in cannot be converted into N"), "{text}");
        assert!(matches!(chosen("time_s,a_V,b_V,c_V", &none), Err(Fault::AmbiguousColumns { .. })));
        let text = chosen("a_V,b_V", &none).unwrap_err().to_string();
        assert!(text.contains("there is no time column"), "{text}");
    }
}

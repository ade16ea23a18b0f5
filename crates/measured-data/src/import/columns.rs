//! Which columns of a source are taken, under which name, in which unit.

use super::gather::{Gather, Reduction};
use super::{ImportKind, Reading};
use crate::problem::Fault;
use crate::tables::{Channel, Dimension, QUANTITIES, UNITS, Unit, input_and_output, unknown_unit};

/// A column that is taken.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Taken {
    /// Its number in the source, from 0.
    pub(super) source: usize,
    /// Its name, and the unit it is written in.
    pub(super) channel: Channel,
    /// Factor from the source's number.
    pub(super) factor: f64,
    /// What is added to it then, in the unit written.
    pub(super) shift: f64,
    /// Factor from the unit of the source's column.
    from_unit: f64,
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
    /// `--scale`: `NAME=FACTOR` of what the recorder divided by, separated by commas.
    pub scale: Option<String>,
    /// `--offset`: `NAME=NUMBER` to add after the factor, in the unit of the column, separated by commas.
    pub offset: Option<String>,
}

/// The columns of a source that are named, before they are chosen from, and those left out because
/// they have no known unit.
type Named = (Numbered, Vec<String>);

/// Columns with their numbers in the source, from 0.
type Numbered = Vec<(usize, Channel)>;

/// What a voltage of an output is called.
const SENSOR: &str = "sensor";

/// The columns of a bench.
const USUAL: [&str; 3] = ["time_s", "command_V", "displacement_um"];

/// The fault of columns without units, with what to write for the first ones.
fn unitless(named: &[(usize, Channel)], left_out: &[String]) -> Fault {
    let first = left_out.first().map_or("", String::as_str);
    let mut named = named.to_vec();
    for (at, (name, _)) in bench_places(&named).into_iter().zip(BENCH) {
        if let Some(at) = at {
            name.clone_into(&mut named[at].1.name);
        }
    }
    // a quantity that is there in another unit is not asked for again
    let is_there = |own: &Channel| {
        let alike = |c: &Channel| c.unit.dimension == own.unit.dimension;
        named.iter().any(|(_, c)| alike(c) && (c.name == own.name || own.is_time()))
    };
    let taken = USUAL.into_iter().filter(|own| !Channel::parse(own).is_some_and(|c| is_there(&c)));
    let plain = |name: &&String| !name.is_empty() && !name.contains([',', '=', '[', '"']);
    let sources = left_out.iter().filter(plain);
    let kept = named.iter().map(|(i, c)| format!("{}=#{}", c.label(), i + 1));
    let mut rate = "";
    let said = taken.zip(sources).filter_map(|(own, source)| match own {
        "time_s" if counts_samples(source) => {
            rate = " --sampling-hz RATE, for stamps without a unit are no seconds";
            None
        }
        "time_s" => {
            rate = " (in s; time_ms if its stamps are in ms: their unit is not told)";
            Some(format!("{own}={source}"))
        }
        "displacement_um" if is_told_in_volt(source) => Some(format!("{SENSOR}_V={source}")),
        _ => Some(format!("{own}={source}")),
    });
    let example = kept.chain(said).take(3).collect::<Vec<_>>().join(",");
    Fault::Other(format!(
        "the column `{first}` has no known unit; say which column is which, in its unit: --columns '{example}'{rate}; units are {}",
        UNITS.map(|unit| unit.symbol).join(", ")
    ))
}

/// Whether the name of a column is that of a voltage of an instrument, such as `CH2V`, `Ampl` or `Volts`.
fn is_told_in_volt(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    let is_channel = name.starts_with("ch") && name.ends_with('v');
    is_channel || ["volt", "ampl", "auxin"].iter().any(|part| name.contains(part))
}

/// Whether the name of a column is that of a counter of ticks or samples.
fn counts_samples(name: &str) -> bool {
    let name = name.trim().to_lowercase();
    ["stamp", "tick", "clock", "index", "sample", "count"].iter().any(|part| name.contains(part))
}

/// Names the columns of a source of `count` columns with the names it gives itself, if any.
pub(super) fn name_columns(
    options: &ColumnOptions,
    own: Option<&[String]>,
    count: usize,
) -> Result<Named, Fault> {
    let Some(text) = &options.columns else {
        let Some(own) = own else {
            let usual = (0..count).map(|i| USUAL.get(i).copied().unwrap_or("-"));
            let example = usual.collect::<Vec<_>>().join(",");
            return Err(Fault::Other(format!(
                "the {count} columns have no names; name them: --columns {example} with their units, - for a column to leave out"
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
        // as it stands in the source, or without the unit that was found elsewhere
        let bare =
            |name: &str| name.rsplit_once(" [").map_or(name.to_owned(), |(bare, _)| bare.into());
        let is = |name: &String| {
            name == source || bare(name) == source || Channel::plain_name(name) == source
        };
        own?.iter().position(is)
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
    /// What was done to the numbers, in words: `command x 15`.
    pub(super) corrections: Vec<String>,
    /// Columns that were called otherwise, in words: ``command is the column `u_V` ``.
    pub(super) renamed: Vec<String>,
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
        self.taken().zip(numbers).map(|(taken, number)| taken.factor * number + taken.shift)
    }

    /// Takes up `--scale` and `--offset`: factor, then offset, in the unit of the source's column.
    fn correct(&mut self, options: &ColumnOptions) -> Result<(), Fault> {
        for (option, text) in [("--scale", &options.scale), ("--offset", &options.offset)] {
            for (name, number) in named_numbers(option, text.as_deref())? {
                let names = self.taken().map(|taken| taken.channel.name.clone());
                let found = names.collect::<Vec<_>>().join(", ");
                let named = |taken: &&mut Taken| taken.channel.name == name;
                let Some(taken) = self.time.iter_mut().chain(&mut self.columns).find(named) else {
                    let remedy = "name a column that is taken, without its unit";
                    return Err(Fault::MissingColumn { wanted: name, found, remedy });
                };
                if option == "--scale" {
                    taken.factor *= number;
                    self.corrections.push(format!("{name} x {number}"));
                } else {
                    taken.shift += taken.from_unit * number;
                    self.corrections.push(format!("{name} {number:+}"));
                }
            }
        }
        Ok(())
    }

    /// An empty record of these columns.
    pub(super) fn gather(&self, file: &str, reduction: Reduction) -> Gather {
        let sampling_hz = reduction.sampling_hz.filter(|_| self.time.is_none());
        let numbered = |taken: &Taken| format!("{}=#{}", taken.channel.label(), taken.source + 1);
        let others = self.columns.iter().map(numbered).collect::<Vec<_>>().join(",");
        let reduction = Reduction { sampling_hz, ..reduction };
        Gather::new(file, self.labels(), reduction).without_time(others)
    }
}

/// The columns of the time, then the others.
fn times_apart(columns: Numbered) -> [Numbered; 2] {
    let (mut times, mut data): (Numbered, Numbered) =
        columns.into_iter().partition(|(_, c)| c.is_time());
    if times.is_empty() {
        let is_one = |(_, c): &(usize, Channel)| c.unit.dimension == Dimension::Time;
        if let [at] = (0..data.len()).filter(|i| is_one(&data[*i])).collect::<Vec<_>>()[..] {
            times.push(data.remove(at));
        }
    }
    [times, data]
}

/// The time, s; none of a source that has a rate instead.
fn time_taken(
    time: Option<&(usize, Channel)>,
    sampling_hz: Option<f64>,
) -> Result<Option<Taken>, Fault> {
    match (time, sampling_hz) {
        (Some(_), Some(_)) => Err(no_effect(
            "--sampling-hz",
            "the file has a time column",
            "leave it out, or leave the time column out: --columns with - in its place",
        )),
        (Some((source, channel)), None) => {
            let time = converted(*source, channel, "s")?;
            let channel = Channel { name: "time".to_owned(), ..time.channel };
            Ok(Some(Taken { channel, ..time }))
        }
        (None, Some(_)) => Ok(None),
        (None, None) => {
            let message = "there is no time column; name one `time_s`, or give --sampling-hz";
            Err(Fault::Other(message.to_owned()))
        }
    }
}

/// Chooses from the named columns what they are read into.
pub(super) fn choose(
    (columns, mut left_out): Named,
    options: &ColumnOptions,
    into: Reading,
    sampling_hz: Option<f64>,
) -> Result<Choice, Fault> {
    let [times, mut data] = times_apart(columns);
    let (wanted, least) = match into {
        Reading::Folder(wanted) => (wanted, 2),
        Reading::Record => (None, 1),
    };
    if into != Reading::Record && !times.is_empty() && data.len() + left_out.len() == 1 {
        let only = data.first().map(|(_, channel)| channel.label());
        return Err(one_channel(&only.unwrap_or_else(|| left_out.remove(0))));
    }
    // columns without units are the likelier flaw than no time
    if (times.is_empty() && sampling_hz.is_none() || data.len() < least) && !left_out.is_empty() {
        let named: Vec<_> = times.into_iter().chain(data).collect();
        return Err(unitless(&named, &left_out));
    }
    let time = time_taken(times.first(), sampling_hz)?;
    if into == Reading::Record {
        let columns = data.iter().map(|(source, c)| converted(*source, c, c.unit.symbol));
        let columns = columns.collect::<Result<_, _>>()?;
        let kind = ImportKind::GenericLoop;
        let [corrections, renamed] = [const { Vec::new() }; 2];
        let mut choice = Choice { time, columns, kind, left_out, corrections, renamed };
        choice.correct(options)?;
        return Ok(choice);
    }
    let said = [&options.columns, &options.convert, &options.input, &options.response];
    let is_own = said.into_iter().all(Option::is_none);
    let may_name = is_own && wanted.is_none_or(|kind| kind == ImportKind::ActuatorBench);
    let mut renamed = if may_name { name_bench(&mut data) } else { Vec::new() };
    let has = |name: &str, dimension: Dimension| {
        data.iter().any(|(_, c)| c.name == name && c.unit.dimension == dimension)
    };
    let bench = has("command", Dimension::Voltage) && has("displacement", Dimension::Length);
    let is_loop = !bench || options.input.is_some() || options.response.is_some();
    let found = if is_loop { ImportKind::GenericLoop } else { ImportKind::ActuatorBench };
    let kind = wanted.unwrap_or(found);
    let columns = match kind {
        ImportKind::ActuatorBench => {
            let given = [
                (
                    "--convert",
                    &options.convert,
                    "a bench is always brought to s, V and um; a factor is --scale command=15",
                ),
                (
                    "--input",
                    &options.input,
                    "its input is the column `command`; name it with --columns",
                ),
                (
                    "--response",
                    &options.response,
                    "its output is the column `displacement`; name it with --columns",
                ),
            ];
            if let Some((option, _, remedy)) =
                given.into_iter().find(|(_, given, _)| given.is_some())
            {
                return Err(no_effect(option, "this is an actuator bench", remedy));
            }
            bench_columns(&data)?
        }
        _ => loop_columns(&data, options)?,
    };
    let is_taken = |source: usize| columns.iter().any(|taken| taken.source == source);
    left_out.extend(data.iter().filter(|(i, _)| !is_taken(*i)).map(|(_, c)| c.label()));
    if may_name && kind == ImportKind::GenericLoop {
        renamed.extend(no_command(times.first(), &data));
    }
    let corrections = Vec::new();
    let mut choice = Choice { time, columns, kind, left_out, corrections, renamed };
    choice.correct(options)?;
    for Taken { channel, .. } in choice.taken() {
        let name = &channel.name;
        let alike = |c: &Channel| if channel.is_time() { c.is_time() } else { c.name == *name };
        let count = times.iter().chain(&data).filter(|(_, c)| alike(c)).count();
        if count > 1 {
            let number = |taken: &Taken| format!("{}=#{}", taken.channel.label(), taken.source + 1);
            let all: Vec<String> = choice.taken().map(number).collect();
            return Err(Fault::Other(format!(
                "{count} columns are called `{name}`: say which one is meant by its number, --columns {} (the others are then left out), or rename them in the header",
                all.join(",")
            )));
        }
    }
    Ok(choice)
}

/// What is said of the only voltage beside the only length, where its name keeps it from being the command.
fn no_command(time: Option<&(usize, Channel)>, data: &[(usize, Channel)]) -> Option<String> {
    let only = |dimension: Dimension| {
        let of_kind: Vec<_> = data.iter().filter(|own| own.1.unit.dimension == dimension).collect();
        if let [one] = of_kind[..] { Some(one) } else { None }
    };
    let [(voltage_at, voltage), (length_at, length)] =
        [only(Dimension::Voltage)?, only(Dimension::Length)?];
    let column =
        |name: &str, own: &Channel, at: usize| format!("{name}_{}=#{}", own.unit.symbol, at + 1);
    let time = time.map(|(at, own)| format!("{},", column("time", own, *at)));
    Some(format!(
        "`{}` is not taken for the command, by its name; if it is: --columns {}{},{}",
        voltage.label(),
        time.unwrap_or_default(),
        column("command", voltage, *voltage_at),
        column("displacement", length, *length_at)
    ))
}

/// What a bench calls its command and its displacement.
const BENCH: [(&str, Dimension); 2] =
    [("command", Dimension::Voltage), ("displacement", Dimension::Length)];

/// The columns that are, or can only be, command and displacement.
fn bench_places(data: &[(usize, Channel)]) -> [Option<usize>; 2] {
    BENCH.map(|(name, dimension)| {
        let is = |i: &usize| data[*i].1.unit.dimension == dimension;
        let all: Vec<usize> = (0..data.len()).filter(is).collect();
        let named = all.iter().copied().find(|i| data[*i].1.name == name);
        let is_free = |i: &usize| is_free_name(&data[*i].1.name);
        named.or(if let [one] = all[..] { Some(one).filter(is_free) } else { None })
    })
}

/// Whether a column of this name may be command or displacement: none that is another quantity of a bench by its name.
pub(super) fn is_free_name(name: &str) -> bool {
    let is = |own: &str| name.eq_ignore_ascii_case(own);
    !(is(SENSOR) || QUANTITIES.iter().any(|(own, ..)| is(own)))
}

/// Calls the only voltage the command and the only length the displacement, where no column has these names; says so.
fn name_bench(data: &mut [(usize, Channel)]) -> Vec<String> {
    let mut said = Vec::new();
    if let [Some(command), Some(displacement)] = bench_places(data) {
        for (at, (name, _)) in [command, displacement].into_iter().zip(BENCH) {
            let own = &mut data[at].1;
            if own.name != name {
                said.push(format!("{name} is the column `{}`", own.label()));
                name.clone_into(&mut own.name);
            }
        }
    }
    said
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
    let channel = Channel { name: channel.name.clone(), unit };
    Ok(Taken { source, channel, factor, shift: 0.0, from_unit: factor })
}

/// The fault of a record of one channel.
fn one_channel(only: &str) -> Fault {
    Fault::Other(format!(
        "there is one channel beside the time, `{only}`, and a record needs input and output: export both into one file, or import the two files together"
    ))
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
    if let [(_, only)] = data {
        return Err(one_channel(&only.label()));
    }
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

/// The names and numbers of `--scale` or `--offset`.
fn named_numbers(option: &str, text: Option<&str>) -> Result<Vec<(String, f64)>, Fault> {
    let entry = |entry: &str| {
        let read = || {
            let (name, number) = entry.split_once('=')?;
            let number = number.trim().parse::<f64>().ok().filter(|v| v.is_finite())?;
            let is_factor = option == "--scale" && number.abs() <= 0.0;
            (!is_factor).then(|| (name.trim().to_owned(), number))
        };
        read().ok_or_else(|| {
            Fault::Other(format!(
                "the entry `{entry}` of {option} is not understood; write NAME=NUMBER with the name of a column without its unit and a finite number, such as command=15"
            ))
        })
    };
    text.into_iter().flat_map(|text| text.split(',')).map(entry).collect()
}

/// The fault of an option that would do nothing.
pub(super) fn no_effect(option: &str, why: &str, remedy: &str) -> Fault {
    Fault::Other(format!("{option} would have no effect: {why}; {remedy}"))
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
        let choice = choose(named, more, Reading::Folder(None), None)?;
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
        let monitor = ColumnOptions {
            scale: Some("command=15, displacement=0.1".into()),
            offset: Some("displacement=-30".into()),
            ..none.clone()
        };
        let count = name_columns(&options("time_s,command_V,displacement_mm"), None, 3).unwrap();
        let choice = choose(count, &monitor, Reading::Folder(None), None).unwrap();
        let numbers: Vec<f64> = choice.converted([1.0, 2.0, 301.0]).collect();
        assert_eq!(numbers[..2], [1.0, 30.0]);
        assert!(
            (numbers[2] - 100.0).abs() < 1e-9,
            "factor, then offset, then the unit: {numbers:?}"
        );
        assert_eq!(
            choice.corrections.join(", "),
            "command x 15, displacement x 0.1, displacement -30"
        );
        for (scale, part) in [
            ("command", "the entry `command` of --scale is not understood"),
            ("command=0", "the entry `command=0`"),
            ("voltage=15", "the column `voltage` is missing"),
        ] {
            let wrong = ColumnOptions { scale: Some(scale.into()), ..none.clone() };
            let text = chosen("time_s,command_V,displacement_um", &wrong).unwrap_err().to_string();
            assert!(text.contains(part), "{text}");
        }
        for (wrong, part) in [
            (ColumnOptions { convert: Some("command_V=15".into()), ..none.clone() }, "--convert"),
            (ColumnOptions { convert: Some("command_mV".into()), ..none.clone() }, "--convert"),
        ] {
            let text = chosen("time_s,command_V,displacement_um", &wrong).unwrap_err().to_string();
            assert!(text.contains(part) && text.contains("would have no effect"), "{text}");
        }
        let wrong = ColumnOptions { convert: Some("displacement_N".into()), ..none.clone() };
        let text = chosen("time_s,displacement_in,force_kip", &wrong).unwrap_err().to_string();
        assert!(text.contains("in cannot be converted into N"), "{text}");
        assert!(matches!(chosen("time_s,a_V,b_V,c_V", &none), Err(Fault::AmbiguousColumns { .. })));
        let text = chosen("a_V,b_V", &none).unwrap_err().to_string();
        assert!(text.contains("there is no time column"), "{text}");
    }
}

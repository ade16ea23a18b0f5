//! How a text table is laid out: where its numbers begin, what separates and names its columns.
//!
//! Nothing is known of the instrument. The rows of numbers are looked for; what stands above them is read as names, units
//! and stated sampling.

use super::numbers::{number, stamp};
use super::preamble::{Preamble, is_key, is_unit_key, unit_of, word};
use super::row::Row;
use crate::import::columns::{Choice, ColumnOptions};
use crate::problem::Fault;
use crate::tables::{Channel, Dimension};

/// Rows above the numbers in which names and units are looked for.
const ABOVE: usize = 12;
/// Part of the longest run of rows that another reading must reach to be preferred for fewer cells of text.
const AS_LONG: f64 = 0.7;

/// What a cell is.
#[derive(Clone, Copy, PartialEq)]
enum Cell {
    Number,
    Text,
    Blank,
}

fn kind(text: &str, decimal: char) -> Cell {
    match number(text, decimal) {
        Some(value) if value.is_nan() => Cell::Blank,
        Some(_) => Cell::Number,
        None if stamp(text).is_some() => Cell::Number,
        None => Cell::Text,
    }
}

/// A run of rows of numbers, in one reading of separator and decimals.
struct Block {
    separator: char,
    decimal: char,
    rows: Vec<Row>,
    /// Its first row and the one behind its last.
    start: usize,
    end: usize,
    /// Columns that hold numbers alone.
    numeric: Vec<usize>,
    /// Columns that hold text.
    texts: usize,
    /// Columns up to the last that holds anything.
    width: usize,
}

/// Whether a number is a whole one with commas of thousands, as `1,234`.
fn has_thousands(text: &str) -> bool {
    let digits = text.trim_start_matches(['+', '-']);
    let mut groups = digits.split(',');
    let plain = |group: &str| group.bytes().all(|b| b.is_ascii_digit());
    let leads = |lead: &str| (1..=3).contains(&lead.len()) && plain(lead) && !lead.starts_with('0');
    groups.next().is_some_and(leads) && groups.all(|group| group.len() == 3 && plain(group))
}

impl Block {
    /// Whether fields in quotes, separated by commas, are read with decimal commas where all of a column may be thousands.
    fn takes_thousands_for_decimals(&self) -> bool {
        let rows = &self.rows[self.start..self.end];
        let is_whole = |column: &usize| {
            let cells = rows.iter().filter_map(|row| row.cells.get(*column));
            let mut with_commas = cells.filter(|cell| cell.contains(',')).peekable();
            with_commas.peek().is_some() && with_commas.all(|cell| has_thousands(cell))
        };
        (self.separator, self.decimal) == (',', ',') && self.numeric.iter().any(is_whole)
    }

    /// The longest run of rows with two columns of numbers.
    fn find(lines: &[&str], separator: char, decimal: char) -> Option<Self> {
        let rows: Vec<Row> = lines.iter().map(|line| Row::of(line, separator)).collect();
        let kinds: Vec<Vec<Cell>> = rows
            .iter()
            .map(|row| row.filled().iter().map(|cell| kind(cell, decimal)).collect())
            .collect();
        // comments and blank lines part no run
        let data: Vec<usize> =
            (0..rows.len()).filter(|i| !rows[*i].is_comment && !kinds[*i].is_empty()).collect();
        let (mut best, mut from) = (0..0, 0);
        let mut seen = Vec::new();
        for at in 0..data.len() {
            note(&mut seen, &kinds[data[at]]);
            if numeric(&seen).len() < 2 {
                from = at + 1;
                seen.clear();
                // the row that ends a run may begin another
                note(&mut seen, &kinds[data[at]]);
                if numeric(&seen).len() < 2 {
                    seen.clear();
                } else {
                    from = at;
                }
            }
            if at + 1 - from > best.len() {
                best = from..at + 1;
            }
        }
        let run = &data[best];
        let mut seen = Vec::new();
        run[run.len() / 2..].iter().for_each(|i| note(&mut seen, &kinds[*i]));
        let numeric = numeric(&seen);
        // lines above the numbers that look like some
        let fits = |i: &&usize| {
            let is = |column: &usize| kinds[**i].get(*column).is_none_or(|k| *k != Cell::Text);
            let filled = |column: &&usize| kinds[**i].get(**column) == Some(&Cell::Number);
            numeric.iter().all(is) && numeric.iter().filter(filled).count() > 1
        };
        let mut from = run.iter().position(|i| fits(&i))?;
        // a word with two numbers right above them, unless they go on from its numbers
        let word = |i: usize| {
            let blank = |column: &usize| seen.get(*column) == Some(&(false, false));
            let cells = kinds[i].iter().enumerate();
            cells.filter(|(_, kind)| **kind == Cell::Text).any(|(column, _)| blank(&column))
        };
        let goes_on = |i: usize| {
            let value = |i: &usize| number(rows[*i].cells.get(*numeric.first()?)?, decimal);
            let values: Vec<f64> = run[i..].iter().take(3).filter_map(value).collect();
            let &[a, b, c] = &values[..] else { return true };
            ((b - a) - (c - b)).abs() <= 0.02 * (c - b).abs()
        };
        while from + 1 < run.len() && word(run[from]) && !goes_on(from) {
            from += 1;
        }
        // an earlier row that is as complete begins the record, whatever stands between
        let is_whole = |i: &&usize| {
            let is_number = |column: &usize| kinds[**i].get(*column) == Some(&Cell::Number);
            numeric.iter().all(is_number) && !word(**i)
        };
        let start = data.iter().find(is_whole).map_or(run[from], |first| run[from].min(*first));
        let end = run.last()? + 1;
        let texts = seen.iter().filter(|column| column.1).count();
        Some(Self { separator, decimal, width: seen.len(), rows, start, end, numeric, texts })
    }

    fn len(&self) -> usize {
        self.end - self.start
    }

    /// The first row of the record: one right behind its names is none the less a row of it for a cell of text.
    fn begin_behind(&self, names: Option<usize>) -> usize {
        let Some(names) = names else { return self.start };
        let is_row = |at: &usize| {
            let row = &self.rows[*at];
            let is = |column: usize, of: Cell| {
                row.cells.get(column).is_some_and(|cell| kind(cell, self.decimal) == of)
            };
            let is_word = !self.numeric.contains(&0) && is(0, Cell::Text);
            let count = |of: Cell| self.numeric.iter().filter(|column| is(**column, of)).count();
            let is_more = count(Cell::Number) > count(Cell::Text);
            let is_first = self.numeric.first().is_some_and(|first| is(*first, Cell::Number));
            !row.is_comment && (is_more || is_first) && !is_word
        };
        (names + 1..self.start).find(is_row).unwrap_or(self.start)
    }

    /// Words and values that stand in the rows before their first number.
    fn beside(&self) -> impl Iterator<Item = Row> {
        let first = self.numeric.first().copied().unwrap_or(0);
        let rows = self.rows[self.start..self.end].iter();
        rows.filter(move |row| first > 1 && row.cells.first().is_some_and(|cell| is_key(cell))).map(
            move |row| Row {
                cells: row.cells.iter().take(first).cloned().collect(),
                ..row.clone()
            },
        )
    }

    /// What a column rises by from row to row that counts the rows, some of which may be missing: whole numbers, most of
    /// them by the same step above the last.
    fn counts(&self, column: usize) -> Option<f64> {
        let values: Vec<f64> = self.column(column).filter(|value| value.is_finite()).collect();
        let mut steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
        steps.sort_by(f64::total_cmp);
        let usual = steps.get(steps.len() / 2).copied().filter(|step| *step > 0.5)?;
        let by_usual = steps.iter().filter(|step| (*step - usual).abs() < 1e-9).count();
        let is_whole = values.iter().all(|value| value.fract().abs() < 1e-9);
        (is_whole && values.len() > 3 && 10 * by_usual >= 9 * steps.len()).then_some(usual)
    }

    /// The numbers of a column in the head.
    fn column(&self, column: usize) -> impl Iterator<Item = f64> {
        let rows = self.rows[self.start..self.end].iter().filter(|row| !row.is_comment);
        rows.filter_map(move |row| {
            let text = row.cells.get(column)?;
            number(text, self.decimal).or_else(|| stamp(text))
        })
    }
}

/// Whether each column was seen with numbers and with text.
fn note(seen: &mut Vec<(bool, bool)>, kinds: &[Cell]) {
    if seen.len() < kinds.len() {
        seen.resize(kinds.len(), (false, false));
    }
    for (column, kind) in seen.iter_mut().zip(kinds) {
        column.0 |= *kind == Cell::Number;
        column.1 |= *kind == Cell::Text;
    }
}

fn numeric(seen: &[(bool, bool)]) -> Vec<usize> {
    (0..seen.len()).filter(|i| seen[*i] == (true, false)).collect()
}

/// How a table is laid out.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Layout {
    pub(super) separator: char,
    pub(super) decimal: char,
    /// Lines before the first row of numbers.
    pub(super) before: usize,
    /// Line of the names, from 1.
    pub(super) header_line: usize,
    /// Columns of a row.
    pub(super) width: usize,
    /// Names with units, of every column; none without any.
    pub(super) names: Option<Vec<String>>,
    /// Columns of numbers.
    pub(super) numeric: Vec<usize>,
    /// Columns of times of day.
    pub(super) stamps: Vec<usize>,
    /// Time between two rows that is stated above them, s.
    pub(super) step_s: Option<f64>,
    /// Columns that count the rows, and what they rise by from row to row.
    counters: Vec<(usize, f64)>,
}

impl Layout {
    /// Finds it in the first lines of a table; none without rows of numbers.
    ///
    /// # Errors
    /// Commas that separate fields and decimals alike.
    pub(super) fn find(lines: &[&str]) -> Result<Option<Self>, Fault> {
        let separators = [';', '\t', ',', '|', ' '].into_iter();
        let readings = separators.flat_map(|s| [(s, '.'), (s, ',')]);
        let found = readings.filter_map(|(s, d)| Block::find(lines, s, d));
        let blocks: Vec<Block> =
            found.filter(|block| !block.takes_thousands_for_decimals()).collect();
        let longest = blocks.iter().map(Block::len).max().unwrap_or(0) as f64;
        let long = blocks.into_iter().filter(|block| block.len() as f64 >= AS_LONG * longest);
        let Some(block) = long.min_by_key(|block| block.texts) else { return Ok(None) };
        let above = &block.rows[..block.start];
        let (names, units) = names_and_units(above, block.width);
        if names.is_none() && units.is_none() && block.separator == ',' {
            refuse_double_commas(above, block.width)?;
        }
        let before = block.begin_behind(names.max(units));
        let Block { separator, decimal, width, .. } = &block;
        let stated_names = |names: &usize| {
            let preamble = Preamble::read(above, *decimal, [&[], &[]], *width);
            !above[*names].is_comment || preamble.names.len() != block.numeric.len()
        };
        let names = names.filter(stated_names);
        let extra = [names, units].map(|at| at.map_or(&[][..], |at| &above[at].cells[..]));
        let mut stated = above.to_vec();
        stated.extend(block.beside());
        let preamble = Preamble::read(&stated, *decimal, extra, *width);
        let is_stamp = |column: usize| {
            let row = &block.rows[block.start];
            row.cells.get(column).is_some_and(|text| number(text, *decimal).is_none())
        };
        let stamps: Vec<usize> =
            block.numeric.iter().copied().filter(|column| is_stamp(*column)).collect();
        let mut layout = Self {
            separator: *separator,
            decimal: *decimal,
            before,
            header_line: names.or(units).unwrap_or(before) + 1,
            width: *width,
            names: None,
            numeric: block.numeric.clone(),
            stamps,
            step_s: preamble.step_s,
            counters: Vec::new(),
        };
        layout.name(&block, extra, &preamble);
        let mut names = layout.names.iter().flatten();
        if preamble.has_times && names.any(|name| word(name) == "xvalues") {
            layout.step_s = None;
        }
        let is_time = |i: usize| {
            let of_time = |c: Channel| c.unit.dimension == Dimension::Time;
            let name = layout.names.as_ref().map_or("", |names| &names[i]);
            is_time_word(name) || Channel::parse(name).is_some_and(of_time)
        };
        // who leaves a time out has his reasons
        let counters = block.numeric.iter().copied();
        let counters = counters.filter(|i| !is_time(*i));
        layout.counters = counters.filter_map(|i| Some((i, block.counts(i)?))).collect();
        Ok(Some(layout))
    }

    /// A column that counts the rows and is not taken, and its step; none that `-` leaves out in its place of `--columns`.
    pub(super) fn counter(&self, choice: &Choice, options: &ColumnOptions) -> Option<(usize, f64)> {
        let entries: Vec<&str> =
            options.columns.iter().flat_map(|text| text.split(',')).map(str::trim).collect();
        let in_place = entries.len() == self.width;
        let is_free = |column: usize| {
            let is_taken = choice.taken().any(|taken| taken.source == column);
            !(is_taken || in_place && entries[column] == "-")
        };
        self.counters.iter().copied().find(|(column, _)| is_free(*column))
    }

    /// Whether it holds a time and one channel, which another table may complete.
    pub(super) fn is_single(&self) -> bool {
        let Some(names) = &self.names else { return false };
        let is_time = |i: usize| {
            let of_time = |c: Channel| c.unit.dimension == Dimension::Time;
            Channel::parse(&names[i]).map_or_else(|| is_time_word(&names[i]), of_time)
        };
        matches!(self.numeric[..], [a, b] if is_time(a) && !is_time(b))
    }

    /// The layout of rows of this table with those of another behind them, which begin at column `at`.
    pub(super) fn beside(mut self, other: Self, at: usize) -> Self {
        let shifted = |columns: Vec<usize>| columns.into_iter().map(move |own| own + at);
        let both = self.names.take().zip(other.names);
        self.names = both.map(|(mut names, others)| {
            names.resize(at, String::new());
            let time = self.numeric.first().map(|i| names[*i].clone()).unwrap_or_default();
            for (i, name) in others.into_iter().enumerate() {
                let is_time = other.numeric.first() == Some(&i);
                let same = |own: &String| !name.is_empty() && *own == name;
                let second = |name: String| match name.rsplit_once(" [") {
                    Some((bare, unit)) => format!("{bare} 2 [{unit}"),
                    None => format!("{name} 2"),
                };
                names.push(match () {
                    () if is_time && !time.is_empty() => String::new(),
                    () if names.iter().any(same) => second(name),
                    () => name,
                });
            }
            names
        });
        self.numeric.extend(shifted(other.numeric));
        self.stamps.extend(shifted(other.stamps));
        self.width = at + other.width;
        self.before = 0;
        self.header_line = 1;
        self
    }

    /// Names the columns.
    fn name(&mut self, block: &Block, [names, units]: [&[String]; 2], preamble: &Preamble) {
        let width = self.width;
        let given = preamble.names.len() == block.numeric.len() && names.is_empty();
        let names = if given { &preamble.names } else { names };
        let mut own: Vec<String> =
            (0..width).map(|i| names.get(i).cloned().unwrap_or_default()).collect();
        // beside units alone the time may have its name: `time_s,V,um`
        if let (true, [first, ..]) = (names.is_empty(), units)
            && (is_time_word(first) || Channel::parse(first).is_some())
        {
            first.clone_into(&mut own[0]);
        }
        let rises_by = |i: usize, step: f64| {
            let values: Vec<f64> = block.column(i).collect();
            let is_step = |w: &[f64]| ((w[1] - w[0]) / step - 1.0).abs() < 0.02;
            values.len() > 2 && values.windows(2).all(is_step)
        };
        // the numbers of rows have no name where all others have one
        let first = block.numeric.first().copied().unwrap_or(0);
        if names.iter().filter(|n| !n.is_empty()).count() + 1 == width
            && own[width - 1].is_empty()
            && rises_by(0, 1.0)
        {
            own.rotate_right(1);
        }
        let own_unit = |i: usize| unit_of(&own[i]).or_else(|| unit_of(units.get(i)?));
        let is_time = |i: usize| {
            self.stamps.contains(&i)
                || is_time_word(&own[i])
                || own[i].is_empty()
                    && i == first
                    && block.numeric.len() > preamble.units.len().max(1)
        };
        let channels: Vec<usize> = block.numeric.iter().copied().filter(|i| !is_time(*i)).collect();
        let mut full = own.clone();
        for i in 0..width {
            if Channel::parse(&own[i]).is_some() && !self.stamps.contains(&i) {
                continue;
            }
            let place = channels.iter().position(|own| *own == i);
            let stated = place.and_then(|place| preamble.unit(place, channels.len()));
            let of_time = || {
                let by_step = self.step_s.is_some_and(|step| i == first && rises_by(i, step));
                if by_step || preamble.has_times && word(&own[i]) == "xvalue" {
                    Some("s".to_owned())
                } else {
                    preamble.time_unit.clone()
                }
            };
            let unit = match () {
                () if self.stamps.contains(&i) => Some("s".to_owned()),
                () if own_unit(i).is_some() => own_unit(i).map(|unit| unit.symbol.to_owned()),
                () if is_time(i) => of_time(),
                () => stated,
            };
            let is_bare = own[i].starts_with("in ") || own[i].chars().count() < 3;
            let by_itself = is_bare && unit_of(&own[i]).is_some();
            let name = match (&unit, own[i].as_str()) {
                (Some(unit), "") => usual_name(unit).to_owned(),
                (Some(unit), _) if by_itself => usual_name(unit).to_owned(),
                (_, name) if !name.is_empty() && name.bytes().all(|b| b.is_ascii_digit()) => {
                    format!("ch{name}")
                }
                (_, name) => name.replace(['[', '('], " ").replace([']', ')'], ""),
            };
            full[i] = match unit {
                Some(unit) => {
                    let alike = full[..i].iter().filter(|f| f.starts_with(&name)).count();
                    let is_usual = own[i].is_empty() || by_itself;
                    let number = if is_usual && alike > 0 {
                        format!("_{}", alike + 1)
                    } else {
                        String::new()
                    };
                    format!("{name}{number} [{unit}]")
                }
                None => name,
            };
        }
        // further columns of the same times say nothing
        let times = |i: &usize| {
            Channel::parse(&full[*i]).is_some_and(|c| c.unit.dimension == Dimension::Time)
        };
        let all: Vec<usize> = (0..width).filter(times).collect();
        for later in all.iter().skip(1) {
            if block.column(*later).eq(block.column(all[0])) {
                full[*later] = format!("#{}", later + 1);
            }
        }
        let is_named = full.iter().any(|name| !name.is_empty());
        self.names = is_named.then_some(full);
    }
}

/// Whether instruments call the time so.
fn is_time_word(name: &str) -> bool {
    const WORDS: [&str; 8] = ["time", "zeit", "temps", "tiempo", "x_value", "x-axis", "x", "t"];
    WORDS.contains(&name.to_lowercase().as_str())
}

/// The name of a column that has only a unit.
fn usual_name(unit: &str) -> &'static str {
    match unit_of(unit).map(|unit| unit.dimension) {
        Some(Dimension::Time) => "time",
        Some(Dimension::Voltage) => "voltage",
        Some(Dimension::Length) => "displacement",
        Some(Dimension::Force) => "force",
        Some(Dimension::Current) => "current",
        _ => "channel",
    }
}

/// Which rows above the numbers hold the names and the units of the columns.
///
/// Of the rows that fit, the one with most units in its names is taken, else the nearest; rows of the file before comments.
fn names_and_units(above: &[Row], width: usize) -> (Option<usize>, Option<usize>) {
    let mut units = None;
    let mut best: Option<((usize, bool), usize)> = None;
    let near = (0..above.len()).rev().filter(|i| !above[*i].filled().is_empty());
    for at in near.take(ABOVE) {
        let row = &above[at];
        let cells = row.filled();
        if units.is_none() && best.is_none() && is_units(cells, width) {
            units = Some(at);
            continue;
        }
        let is_wide = cells.len() + 1 >= width && cells.len() > 1 && cells.len() <= width + 3;
        let below_units = units == Some(at + 1);
        let in_width = &cells[..cells.len().min(width)];
        let is_number = |cell: &String| kind(cell, '.') == Cell::Number;
        let is_pair = row.is_comment && row.text.contains('=');
        let is_text = !is_pair
            && !is_number(&in_width[0])
            && (below_units || !in_width.iter().any(is_number));
        if !is_wide || !is_text || is_key(&cells[0]) || cells[0].ends_with(':') {
            continue;
        }
        let known = cells.iter().filter(|cell| Channel::parse(cell).is_some()).count();
        let rank = (known, !row.is_comment);
        if best.is_none_or(|(other, _)| rank > other) {
            best = Some((rank, at));
        }
    }
    (best.map(|(_, at)| at), units)
}

/// Whether cells are units: each that is filled, in brackets or not, perhaps behind a word that says so.
fn is_units(cells: &[String], width: usize) -> bool {
    let cells = &cells[..cells.len().min(width)];
    let first = cells.first().map_or("", String::as_str);
    let skip = usize::from(is_unit_key(first));
    if skip == 0 && is_key(first) {
        return false;
    }
    let is_bracketed = |cell: &str| {
        cell.starts_with(['(', '[']) && cell.ends_with([')', ']']) && cell.chars().count() < 16
    };
    let is_unit = |cell: &&String| unit_of(cell).is_some() || is_bracketed(cell);
    let filled: Vec<&String> = cells[skip..].iter().filter(|cell| !cell.is_empty()).collect();
    let known = filled.iter().filter(|cell| is_unit(cell)).count();
    let others = filled.len() - known;
    // the unit of a count is none
    known > 0 && 2 * (known + skip) >= width && others <= usize::from(!is_unit(&filled[0]))
}

/// Refuses decimal commas where commas separate the fields.
fn refuse_double_commas(above: &[Row], width: usize) -> Result<(), Fault> {
    let nearest = above.iter().rev().find(|row| !row.filled().is_empty());
    let names = nearest.map_or(0, |row| row.filled().len());
    if names < 2 || names + 1 >= width {
        return Ok(());
    }
    let message = format!(
        "the header has {names} names, the rows have {width} fields: commas separate the fields and the decimals, which cannot be told apart; export it again with semicolons or tabs between the fields, or with decimal points"
    );
    Err(Fault::Other(message))
}

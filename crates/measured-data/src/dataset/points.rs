//! Readings at points of test: what was read, how sure each reading is, which points belong together.

use crate::files::Source;
use crate::problem::{Fault, Problems};
use crate::tables::PointCsv;
use rotor_base::mean_square;
use std::collections::BTreeMap;

/// Column of names of the points.
const POINT: &str = "point";
/// Column of numbers of sweeps: the points of one are held out together.
const GROUP: &str = "group";
/// Column of numbers of conditions: rows of one number repeat it.
const REPEAT: &str = "repeat";
/// Column of 1 for points at which nothing is missing, 0 for the others.
const REFERENCE: &str = "reference";
/// Ending of the column of standard deviations of another; it may stand before the unit.
const DEVIATION: &str = "_sd";
/// Part of the rms of a column, or of its prediction, that is the least scatter: repeats or a prediction may agree to the last
/// digit.
const LEAST_SCATTER: f64 = 1e-6;

/// Readings at points of test.
#[derive(Debug, Clone, PartialEq)]
pub struct PointData {
    /// Name of every point.
    pub ids: Vec<String>,
    /// Number of the sweep of every point, from 0: each alone where none is given, repeats of one condition together.
    pub groups: Vec<usize>,
    /// Whether a point is a reference: what is looked for does not act there.
    pub references: Vec<bool>,
    /// The columns of readings and conditions, in the order of the file.
    pub columns: Vec<PointColumn>,
    /// The table they were read from.
    pub table: PointCsv,
}

/// A column of readings or conditions.
#[derive(Debug, Clone, PartialEq)]
pub struct PointColumn {
    /// Its name.
    pub name: String,
    /// Its cells, none where one is blank.
    pub values: Vec<Option<f64>>,
    /// How sure they are.
    pub scatter: Scatter,
}

/// Where the standard deviations of a column come from.
#[derive(Debug, Clone, PartialEq)]
pub enum Scatter {
    /// They stand beside it, one for each row.
    Stated(Vec<f64>),
    /// From rows that repeat one condition, one for all rows.
    Repeated(f64),
    /// Nothing says.
    Unknown,
}

impl Scatter {
    /// Standard deviations of readings, row by row. Where nothing says, the misfit to what is predicted is taken for it.
    pub fn deviations(&self, values: &[Option<f64>], predicted: &[f64]) -> Vec<f64> {
        let one = match self {
            Self::Stated(stated) => return stated.clone(),
            Self::Repeated(one) => *one,
            Self::Unknown => {
                let off =
                    values.iter().zip(predicted).filter_map(|(read, own)| Some((*read)? - own));
                let least = LEAST_SCATTER * mean_square(predicted).sqrt().max(LEAST_SCATTER);
                mean_square(&off.collect::<Vec<_>>()).sqrt().max(least)
            }
        };
        vec![one; values.len()]
    }
}

impl PointData {
    /// Reads a table of readings.
    ///
    /// # Errors
    /// As [`PointCsv::read`]; a standard deviation that is not above zero or is missing beside a reading, a name of a point
    /// that is there twice, a number of a sweep or a repeat that is blank: each with its line.
    pub fn read(source: &Source) -> Result<Self, Problems> {
        Self::read_with(source, &[])
    }

    /// The same with columns that hold words: they stand in [`Self::table`] alone.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_with(source: &Source, words: &[&str]) -> Result<Self, Problems> {
        let table = PointCsv::read(source, &[&[POINT], words].concat())?;
        let mut problems = Problems::default();
        let rows = table.rows();
        let ids =
            table.text_column(POINT).unwrap_or_else(|| (1..=rows).map(|n| n.to_string()).collect());
        for (row, id) in ids.iter().enumerate() {
            if id.is_empty() {
                problems.push(table.place(row, POINT), Fault::Empty { of: "a name of the point" });
            } else if ids[..row].contains(id) {
                let message =
                    format!("the point `{id}` is there twice; give each row its own name");
                problems.push(table.place(row, POINT), Fault::Other(message));
            }
        }
        let numbered = |name: &str, problems: &mut Problems| {
            let column = table.has(name).then(|| table.full_column(name, ""))?;
            problems.note(column)
        };
        let repeats = numbered(REPEAT, &mut problems);
        let given = numbered(GROUP, &mut problems).or_else(|| repeats.clone());
        let groups = given.map_or_else(|| (0..rows).collect(), |own| places(&own));
        let repeats = repeats.map(|own| places(&own));
        let references = numbered(REFERENCE, &mut problems).unwrap_or_else(|| vec![0.0; rows]);
        let references = flags(&table, &references, &mut problems);
        let is_own = |name: &&str| {
            ![POINT, GROUP, REPEAT, REFERENCE].contains(name) && !words.contains(name)
        };
        let names: Vec<&str> = table.names().filter(is_own).collect();
        let mut columns = Vec::new();
        for name in &names {
            if names.iter().any(|of| deviation_names(of).iter().any(|own| own == name)) {
                continue;
            }
            let values = table.column(name).unwrap_or_default();
            let beside = deviation_names(name).into_iter().find(|own| table.has(own));
            let stated = beside.and_then(|own| Some((table.column(&own)?, own)));
            let scatter = match stated {
                Some((stated, beside)) => {
                    Scatter::Stated(deviations(&table, &beside, (&values, &stated), &mut problems))
                }
                None => repeats
                    .as_ref()
                    .and_then(|repeats| pooled(&values, repeats))
                    .map_or(Scatter::Unknown, Scatter::Repeated),
            };
            columns.push(PointColumn { name: (*name).to_owned(), values, scatter });
        }
        problems.into_result(Some(Self { ids, groups, references, columns, table }))
    }
}

/// What the column of standard deviations of another may be called: `f_hz_sd` or `f_sd_hz` of `f_hz`.
fn deviation_names(of: &str) -> Vec<String> {
    let before_unit = of.rsplit_once('_').map(|(stem, unit)| format!("{stem}{DEVIATION}_{unit}"));
    std::iter::once(format!("{of}{DEVIATION}")).chain(before_unit).collect()
}

/// Which rows are references: one at least is none.
fn flags(table: &PointCsv, numbers: &[f64], problems: &mut Problems) -> Vec<bool> {
    let flag = |(row, number): (usize, &f64)| {
        let is_set = (number - 1.0).abs() < 1e-9;
        if !is_set && number.abs() > 1e-9 {
            let message =
                format!("{number} says nothing: give 1 where nothing is missing, 0 elsewhere");
            problems.push(table.place(row, REFERENCE), Fault::Other(message));
        }
        is_set
    };
    let own: Vec<bool> = numbers.iter().enumerate().map(flag).collect();
    if !own.is_empty() && own.iter().all(|is_set| *is_set) {
        let message = "every point is a reference: nothing is left to explain; give 0 where something may be missing";
        problems.push(table.place(0, REFERENCE), Fault::Other(message.to_owned()));
    }
    own
}

/// Places of numbers among those that differ, in their order.
fn places(numbers: &[f64]) -> Vec<usize> {
    let mut seen: Vec<u64> = Vec::new();
    let place = |number: &f64| {
        let bits = (number + 0.0).to_bits();
        seen.iter().position(|own| *own == bits).unwrap_or_else(|| {
            seen.push(bits);
            seen.len() - 1
        })
    };
    numbers.iter().map(place).collect()
}

/// The deviations that stand beside a column; where nothing was read one that is not stated is that of the others.
fn deviations(
    table: &PointCsv,
    name: &str,
    (values, stated): (&[Option<f64>], &[Option<f64>]),
    problems: &mut Problems,
) -> Vec<f64> {
    let squares: Vec<f64> = stated.iter().flatten().map(|own| own * own).collect();
    let usual = (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt();
    let one = |(row, (value, own)): (usize, (&Option<f64>, &Option<f64>))| match own {
        Some(own) if *own > 0.0 => *own,
        Some(own) => {
            let remedy = "leave the column out where the deviation is not known";
            let (value, unit) = (*own, "");
            problems.push(table.place(row, name), Fault::NotPositive { value, unit, remedy });
            usual
        }
        None if value.is_none() => usual,
        None => {
            let of = "the standard deviation of the reading beside it";
            problems.push(table.place(row, name), Fault::Empty { of });
            usual
        }
    };
    values.iter().zip(stated).enumerate().map(one).collect()
}

/// Standard deviation of one reading from those that repeat a condition; none where nothing repeats.
fn pooled(values: &[Option<f64>], repeats: &[usize]) -> Option<f64> {
    let mut by_condition: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (value, repeat) in values.iter().zip(repeats) {
        by_condition.entry(*repeat).or_default().extend(value);
    }
    let (mut square, mut degrees) = (0.0, 0.0);
    for own in by_condition.values().filter(|own| own.len() > 1) {
        square += rotor_base::variance(own) * own.len() as f64;
        degrees += own.len() as f64 - 1.0;
    }
    let read: Vec<f64> = values.iter().flatten().copied().collect();
    let least = LEAST_SCATTER * mean_square(&read).sqrt();
    (degrees > 0.0).then(|| (square / degrees).sqrt().max(least)).filter(|own| *own > 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<PointData, Problems> {
        PointData::read(&Source { name: "a.csv".into(), text: text.into() })
    }

    #[test]
    fn deviations_may_stand_before_the_unit() {
        let data = read("mu,f_hz,f_sd_hz\n0.1,10,0.5\n0.2,11,0.25\n").unwrap();
        assert_eq!(data.columns.len(), 2);
        assert_eq!(data.columns[1].scatter, Scatter::Stated(vec![0.5, 0.25]));
        let words = Source { name: "a.csv".into(), text: "mode,f_hz\nflap 1,10\n".into() };
        let data = PointData::read_with(&words, &["mode"]).unwrap();
        assert_eq!(
            (data.columns.len(), data.table.text_column("mode").unwrap()),
            (1, vec!["flap 1".to_owned()])
        );
        assert!(PointData::read(&words).is_err());
    }

    #[test]
    fn deviations_are_stated_or_come_from_repeats() {
        let data = read(
            "repeat,mu,fz_N,fz_N_sd,fx_N\n7,0.1,10,0.5,1\n7,0.1,11,0.5,3\n8,0.2,,,5\n8,0.2,13,1.5,9\n",
        );
        let data = data.unwrap();
        assert_eq!((data.ids[3].as_str(), &data.groups[..]), ("4", &[0, 0, 1, 1][..]));
        let names: Vec<&str> = data.columns.iter().map(|own| own.name.as_str()).collect();
        assert_eq!(names, ["mu", "fz_N", "fx_N"]);
        let Scatter::Stated(stated) = &data.columns[1].scatter else { panic!() };
        assert_eq!((stated[0], stated[3]), (0.5, 1.5));
        // of the unread one: rms of .5, .5 and 1.5
        assert!((stated[2] - (2.75_f64 / 3.0).sqrt()).abs() < 1e-12);
        // (2^2 / 2 + 4^2 / 2) / 2 degrees of freedom
        assert_eq!(data.columns[2].scatter, Scatter::Repeated(5.0_f64.sqrt()));
        assert_eq!(read("mu,fz_N\n0.1,3\n").unwrap().columns[1].scatter, Scatter::Unknown);
    }

    #[test]
    fn bad_deviations_and_names_are_told_with_their_line() {
        let text = |text: &str| read(text).unwrap_err().to_string();
        assert!(text("fz_N,fz_N_sd\n1,0\n").starts_with("a.csv:2: fz_N_sd: "));
        assert!(text("fz_N,fz_N_sd\n1,0.5\n2,\n").starts_with("a.csv:3: fz_N_sd: "));
        assert!(text("point,fz_N\na,1\na,2\n").contains("twice"));
        assert!(text("reference,fz_N\n1,1\n2,2\n").starts_with("a.csv:3: reference: "));
        assert!(text("reference,fz_N\n1,1\n1,2\n").contains("every point is a reference"));
        assert_eq!(read("reference,fz_N\n1,1\n0,2\n").unwrap().references, [true, false]);
        assert!(text("group,fz_N\n1,1\n,2\n").starts_with("a.csv:3: group: "));
    }
}

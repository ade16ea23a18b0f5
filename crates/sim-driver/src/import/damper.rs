//! The JSON of the friction damper tests of Lehigh University.
//!
//! `{"data": [[time, displacement, friction force, velocity, actuator force 1, actuator force 2], ...],
//! "dt": s, "displacement units": "in", ...}`. Rows stream: none is kept but in the averaged record.
//!
//! Source: ARTS-Laboratory, Dataset-Friction-Damper-with-Backlash (CC BY-SA 4.0), its `data/README.md`.

use super::columns::{Named, Shape, choose};
use super::gather::{Gather, Reduction};
use super::{ColumnOptions, Table};
use crate::files::{Channel, Unit};
use crate::problem::{Place, Problem, Problems, RecordFault};
use serde::de::{DeserializeSeed, Error as _, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;
use std::io::BufRead;

/// Columns in the order of the rows, the key that gives the unit, and the unit without that key.
const COLUMNS: [(&str, &str, &str); 6] = [
    ("time", "time units", "s"),
    ("displacement", "displacement units", "in"),
    ("friction_force", "friction force units", "kip"),
    ("velocity", "", "in_per_s"),
    ("actuator_force_1", "actuator force units", "lb"),
    ("actuator_force_2", "actuator force units", "lb"),
];
const WIDTH: usize = COLUMNS.len();

/// Whether a text begins like the damper's JSON.
pub(super) fn is_damper(start: &[u8]) -> bool {
    let text: Vec<u8> =
        start.iter().copied().filter(|b| !b.is_ascii_whitespace()).take(9).collect();
    text.starts_with(b"{\"data\":[")
}

/// Reads the damper's JSON: displacement to friction force, unless the options say otherwise.
pub(super) fn read_damper(
    reader: impl BufRead,
    file: &str,
    options: &ColumnOptions,
    reduction: Reduction,
) -> Result<Table, Problems> {
    let refused = |fault: RecordFault| Problem::new(Place::file(file), fault.into());
    let mut options = options.clone();
    if options.input.is_none() && options.response.is_none() {
        options.input = Some("displacement".into());
        options.response = Some("friction_force".into());
    }
    let mut problems = Problems::default();
    let labels = COLUMNS.map(|(name, _, unit)| format!("{name}_{unit}")).to_vec();
    let mut gather = Gather::new(file, labels, reduction);
    let mut json = serde_json::Deserializer::from_reader(reader);
    let rows = Rows { gather: &mut gather, problems: &mut problems };
    let units = rows
        .deserialize(&mut json)
        .and_then(|units| json.end().map(|()| units))
        .map_err(|e| refused(RecordFault::DamperJson { message: e.to_string() }))?;
    let mut columns = Vec::new();
    for (i, ((name, _, _), symbol)) in COLUMNS.iter().zip(units).enumerate() {
        let unit = Unit::find(&symbol).ok_or_else(|| {
            let found = format!("{name}_{symbol}");
            refused(RecordFault::UnknownUnit { found, known: Unit::known() })
        })?;
        columns.push((i, Channel { name: (*name).to_owned(), unit }));
    }
    let choice = choose(Named { columns, left_out: vec![] }, &options, Some(Shape::Loop), None)
        .map_err(refused)?;
    let Some(mut gathered) = gather.finish(&mut problems) else {
        return problems.into_result(None);
    };
    // the first column of the source is the time, which is gathered apart
    gathered.columns = choice
        .columns
        .iter()
        .map(|c| gathered.columns[c.source - 1].iter().map(|v| c.factor * v).collect())
        .collect();
    let factor = choice.time.as_ref().map_or(1.0, |t| t.factor);
    for time in &mut gathered.time_s {
        *time *= factor;
    }
    gathered.sampling.step_s *= factor;
    problems.into_result(Some(Table { gathered, choice }))
}

/// The whole file: rows into the record, units out.
struct Rows<'a> {
    gather: &'a mut Gather,
    problems: &'a mut Problems,
}

impl<'de> DeserializeSeed<'de> for Rows<'_> {
    type Value = [String; WIDTH];

    fn deserialize<D: serde::Deserializer<'de>>(self, json: D) -> Result<Self::Value, D::Error> {
        json.deserialize_map(self)
    }
}

impl<'de> Visitor<'de> for Rows<'_> {
    type Value = [String; WIDTH];

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with the key data")
    }

    fn visit_map<M: MapAccess<'de>>(mut self, mut map: M) -> Result<Self::Value, M::Error> {
        let mut units = COLUMNS.map(|(_, _, unit)| unit.to_owned());
        let mut seen = false;
        while let Some(key) = map.next_key::<String>()? {
            if key == "data" {
                if seen {
                    return Err(M::Error::custom("data is given twice"));
                }
                seen = true;
                map.next_value_seed(Data(&mut self))?;
            } else if COLUMNS.iter().any(|(_, k, _)| *k == key) {
                let unit: String = map.next_value()?;
                for (own, _) in units.iter_mut().zip(COLUMNS).filter(|(_, c)| c.1 == key) {
                    own.clone_from(&unit);
                }
            } else {
                map.next_value::<IgnoredAny>()?;
            }
        }
        if seen { Ok(units) } else { Err(M::Error::missing_field("data")) }
    }
}

/// The list of rows.
struct Data<'a, 'b>(&'a mut Rows<'b>);

impl<'de> DeserializeSeed<'de> for Data<'_, '_> {
    type Value = ();

    fn deserialize<D: serde::Deserializer<'de>>(self, json: D) -> Result<(), D::Error> {
        json.deserialize_seq(self)
    }
}

impl<'de> Visitor<'de> for Data<'_, '_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "rows of {WIDTH} numbers")
    }

    fn visit_seq<S: SeqAccess<'de>>(self, mut rows: S) -> Result<(), S::Error> {
        while let Some(row) = rows.next_element::<[f64; WIDTH]>()? {
            self.0.gather.push(&row, 0, self.0.problems);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const GOOD: &str = "{\"data\": [[0.0, 0.1, -1.0, 0, 1, 2], [0.5, 0.2, -0.5, 0, 1, 2], [1.0, 0.3, 0.5, 0, 1, 2], [1.5, 0.2, 0.25, 0, 1, 2]], \"dt\": 0.5, \"displacement units\": \"in\", \"friction force units\": \"kip\"}";

    fn read(text: &str, options: &ColumnOptions) -> Result<Table, Problems> {
        let reduction = Reduction { most_samples: 100, reduce_to_hz: None, sampling_hz: None };
        read_damper(text.as_bytes(), "d.json", options, reduction)
    }

    #[test]
    fn displacement_to_force_in_the_files_units() {
        let table = read(GOOD, &ColumnOptions::default()).unwrap();
        assert_eq!(table.choice.labels(), ["time_s", "displacement_in", "friction_force_kip"]);
        assert_eq!(table.gathered.columns, [[0.1, 0.2, 0.3, 0.2], [-1.0, -0.5, 0.5, 0.25]]);
        assert_eq!(table.gathered.time_s, [0.0, 0.5, 1.0, 1.5]);
        let options = ColumnOptions {
            convert: Some("displacement_mm,friction_force_N".into()),
            ..ColumnOptions::default()
        };
        let table = read(&GOOD.replace("\"in\"", "\"mm\""), &options).unwrap();
        assert!((table.gathered.columns[0][2] - 0.3).abs() < 1e-15, "the file's own unit counts");
        assert!((table.gathered.columns[1][0] + 4_448.221_615_260_5).abs() < 1e-9);
        let options = ColumnOptions {
            input: Some("velocity".into()),
            response: Some("actuator_force_2".into()),
            ..ColumnOptions::default()
        };
        let table = read(GOOD, &options).unwrap();
        assert_eq!(table.choice.labels()[1..], ["velocity_in_per_s", "actuator_force_2_lb"]);
    }

    #[test]
    fn other_json_and_damage_are_refused() {
        let error =
            |text: &str| read(text, &ColumnOptions::default()).map(|_| ()).unwrap_err().to_string();
        assert!(error("{\"rows\": []}").contains("missing field `data`"));
        assert!(error("[1, 2]").contains("expected an object with the key data"));
        assert!(error(&GOOD.replace("-0.5, 0, 1, 2", "-0.5")).contains("line 1 column"));
        assert!(error(&GOOD.replace("-0.5", "null")).contains("not the friction damper's JSON"));
        assert!(error(&GOOD.replace("\"kip\"", "\"stone\"")).contains("`friction_force_stone`"));
        for cut in 0..GOOD.len() {
            assert!(read(&GOOD[..cut], &ColumnOptions::default()).is_err(), "cut at {cut}");
        }
    }
}

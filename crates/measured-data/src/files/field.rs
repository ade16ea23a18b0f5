//! A field of a value, found by its path and moved.

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

/// How a number is moved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Change {
    /// By a factor.
    Times(f64),
    /// By an amount in its unit.
    Plus(f64),
}

impl Change {
    fn of(self, value: f64) -> f64 {
        match self {
            Self::Times(factor) => value * factor,
            Self::Plus(amount) => value + amount,
        }
    }

    /// Moves a number, or the second of every pair of a table; false of anything else.
    fn apply(self, place: &mut Value) -> bool {
        if let Some(value) = place.as_f64() {
            *place = Value::from(self.of(value));
            return true;
        }
        let Some(rows) = place.as_array_mut().filter(|rows| !rows.is_empty()) else { return false };
        rows.iter_mut().all(|row| match row.as_array_mut().map(Vec::as_mut_slice) {
            Some([_, value]) => match value.as_f64() {
                Some(own) => {
                    *value = Value::from(self.of(own));
                    true
                }
                None => false,
            },
            _ => false,
        })
    }
}

/// A value with the number at a path, such as `rotor.gj`, moved; of a table of pairs the second of each.
///
/// # Errors
/// In words: no such field, no number there, a value that cannot be written and read again.
pub fn with_field_moved<T: Serialize + DeserializeOwned>(
    value: &T,
    path: &str,
    change: Change,
) -> Result<T, String> {
    let failed = |error: serde_json::Error| format!("cannot be moved: {error}");
    let mut whole = serde_json::to_value(value).map_err(failed)?;
    let pointer = format!("/{}", path.replace('.', "/"));
    let place = whole
        .pointer_mut(&pointer)
        .ok_or("is no field that has a value; write it there, or mend the name")?;
    if !change.apply(place) {
        return Err("is no number and no table of numbers".to_owned());
    }
    serde_json::from_value(whole).map_err(failed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_or_a_table_moves_and_nothing_else() {
        let value =
            serde_json::json!({ "a": { "b": 2.0, "t": [[0.0, 1.0], [1.0, 3.0]], "n": "x" } });
        let moved = |path, change| with_field_moved(&value, path, change);
        assert_eq!(moved("a.b", Change::Times(1.5)).unwrap()["a"]["b"], 3.0);
        assert_eq!(moved("a.t", Change::Plus(0.5)).unwrap()["a"]["t"][1][1], 3.5);
        assert!(moved("a.n", Change::Plus(1.0)).unwrap_err().contains("no number"));
        assert!(moved("a.c", Change::Plus(1.0)).unwrap_err().contains("no field"));
    }
}

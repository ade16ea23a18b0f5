//! Values of the axes of every case.

use crate::file::{Axis, AxisValues, MOST_CASES, Sampling, SweepFile};
use chacha20::ChaCha8Rng;
use measured_data::problem::{Fault, Place, Problem};
use rand::{Rng, RngExt, SeedableRng};

/// A value as RON text, and where the sweep gives it.
pub(crate) type Value = (String, Place);

/// The cases of a sweep: the value of every axis, case by case.
///
/// # Errors
/// A grid with too many cases.
pub(crate) fn samples(file: &SweepFile) -> Result<Vec<Vec<Value>>, Problem> {
    match file.sampling {
        Sampling::Grid => grid(file),
        Sampling::LatinHypercube { count, seed } => Ok(latin_hypercube(&file.axes, count, seed)),
        Sampling::Rows => {
            let columns: Vec<Vec<Value>> = file.axes.iter().map(grid_values).collect();
            let rows = columns.first().map_or(0, Vec::len);
            Ok((0..rows).map(|row| columns.iter().map(|c| c[row].clone()).collect()).collect())
        }
    }
}

/// A number as RON text that fields of whole numbers take too.
fn number(value: f64) -> String {
    // the shortest text that reads back to the same bits
    format!("{value}")
}

fn grid_values(axis: &Axis) -> Vec<Value> {
    match &axis.values {
        AxisValues::List(values) => values.clone(),
        AxisValues::Range { from, to, count, place } => {
            let last = count.unwrap_or(2) - 1;
            let at = |i: usize| match i {
                i if i == last => *to,
                i => from + (to - from) * i as f64 / last as f64,
            };
            (0..=last).map(|i| (number(at(i)), place.clone())).collect()
        }
    }
}

fn grid(file: &SweepFile) -> Result<Vec<Vec<Value>>, Problem> {
    let axes: Vec<Vec<Value>> = file.axes.iter().map(grid_values).collect();
    let count = axes.iter().try_fold(1_usize, |all, axis| all.checked_mul(axis.len()));
    let Some(count) = count.filter(|&count| count <= MOST_CASES) else {
        let message = format!(
            "the grid has more than {MOST_CASES} cases; give fewer values, or a LatinHypercube"
        );
        return Err(Problem::new(Place::file(&file.name).field("axes"), Fault::Other(message)));
    };
    let case = |mut at: usize| {
        let mut values: Vec<Value> = Vec::with_capacity(axes.len());
        for axis in axes.iter().rev() {
            values.push(axis[at % axis.len()].clone());
            at /= axis.len();
        }
        values.reverse();
        values
    };
    Ok((0..count).map(case).collect())
}

fn latin_hypercube(axes: &[Axis], count: usize, seed: u64) -> Vec<Vec<Value>> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let columns: Vec<Vec<Value>> = axes
        .iter()
        .map(|axis| {
            let parts = shuffled(count, &mut random).into_iter();
            parts.map(|part| within(axis, part, count, random.random())).collect()
        })
        .collect();
    (0..count).map(|case| columns.iter().map(|column| column[case].clone()).collect()).collect()
}

/// 0 to `count - 1` in random order.
fn shuffled(count: usize, random: &mut impl Rng) -> Vec<usize> {
    let mut order: Vec<usize> = (0..count).collect();
    for i in (1..count).rev() {
        let other = random.random_range(0..=i as u64);
        order.swap(i, usize::try_from(other).unwrap_or(i));
    }
    order
}

/// The value of an axis in one of `count` equal parts, a share from 0 to 1 into it.
fn within(axis: &Axis, part: usize, count: usize, share: f64) -> Value {
    match &axis.values {
        AxisValues::List(values) => values[part * values.len() / count].clone(),
        AxisValues::Range { from, to, place, .. } => {
            let way = (part as f64 + share) / count as f64;
            (number(from + (to - from) * way), place.clone())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(axes: Vec<AxisValues>, sampling: Sampling) -> SweepFile {
        let place = Place::file("s.ron");
        let axes = axes.into_iter().enumerate();
        SweepFile {
            name: "s.ron".into(),
            base: "c.ron".into(),
            base_place: place.clone(),
            axes: axes
                .map(|(i, values)| Axis { field: format!("f{i}"), values, place: place.clone() })
                .collect(),
            sampling,
        }
    }

    fn list(values: &[&str]) -> AxisValues {
        AxisValues::List(values.iter().map(|v| ((*v).to_owned(), Place::file("s.ron"))).collect())
    }

    fn range(from: f64, to: f64, count: usize) -> AxisValues {
        AxisValues::Range { from, to, count: Some(count), place: Place::file("s.ron") }
    }

    fn texts(file: &SweepFile) -> Vec<Vec<String>> {
        let all = samples(file).unwrap();
        all.into_iter().map(|case| case.into_iter().map(|(text, _)| text).collect()).collect()
    }

    #[test]
    fn a_grid_is_every_value_with_every_other() {
        let of = file(vec![list(&["A", "B"]), range(4.0, 8.0, 3)], Sampling::Grid);
        let all = texts(&of);
        assert_eq!(all.len(), 6);
        assert_eq!(all[1], ["A", "6"]);
        assert_eq!(all[5], ["B", "8"]);
        let many = file(vec![range(0.0, 1.0, 2000), range(0.0, 1.0, 2000)], Sampling::Grid);
        assert!(samples(&many).unwrap_err().to_string().contains("more than 1000000 cases"));
    }

    /// One case in each part of each axis, every value of a list as often as the others; the seed is all that matters.
    #[test]
    fn a_latin_hypercube_has_one_case_in_each_part() {
        let sampling = Sampling::LatinHypercube { count: 40, seed: 1 };
        let of = file(vec![range(1.0, 3.0, 2), list(&["A", "B"]), range(0.0, 1.0, 2)], sampling);
        let all = texts(&of);
        for (column, from, span) in [(0, 1.0, 2.0), (2, 0.0, 1.0)] {
            let place =
                |case: &Vec<String>| 40.0 * (case[column].parse::<f64>().unwrap() - from) / span;
            let mut places: Vec<f64> = all.iter().map(place).collect();
            assert!(!places.is_sorted());
            places.sort_by(f64::total_cmp);
            for (part, place) in places.into_iter().enumerate() {
                assert!((part as f64..=part as f64 + 1.0).contains(&place), "{part}: {place}");
            }
        }
        assert_eq!(all.iter().filter(|case| case[1] == "A").count(), 20);
        assert_eq!(all, texts(&of));
        let other = SweepFile { sampling: Sampling::LatinHypercube { count: 40, seed: 2 }, ..of };
        assert_ne!(all, texts(&other));
    }
}

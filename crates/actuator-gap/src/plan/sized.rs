//! A cause made so strong that it has a size.

use crate::numbers::less;
use crate::record::Record;
use crate::simulator::BenchSimulator;
use model_gap::{Candidate, Effect, GapError};
use rotor_base::variance;

/// Places of a parameter at which the size of its effect is looked at, and halvings between two of them.
const PLACES: usize = 25;
const HALVINGS: usize = 16;

/// Part by which the size of a planned effect may miss.
const NEAR: f64 = 0.02;

/// Spread of the output in all runs, about its mean in each.
pub(super) fn spread(runs: &[Record]) -> f64 {
    let (mut squares, mut samples) = (0.0, 0.0);
    for run in runs {
        let judged = run.judged_output();
        squares += judged.len() as f64 * variance(judged);
        samples += judged.len() as f64;
    }
    (squares / f64::max(samples, 1.0)).sqrt()
}

/// A cause of a size, its spread over that of the motion, of either sign where it has two; none where it has none so large.
/// The first parameter that a weak effect grows with makes the size, the first of all where none is; the others stay where a
/// search starts. Each with the value of that parameter.
pub(super) fn sized(
    simulator: &BenchSimulator<'_>,
    (candidate, own): (usize, &Candidate),
    size: f64,
) -> Result<Vec<(f64, Effect)>, GapError> {
    let at = own.parameters.iter().position(|p| p.is_amount || p.grows).unwrap_or(0);
    let (Some(start), Some(first)) = (own.starts.first(), own.parameters.get(at)) else {
        return Ok(Vec::new());
    };
    let effect = |value: f64| {
        let mut values = start.clone();
        values[at] = value;
        Effect { candidate, values }
    };
    let without = simulator.rehearsed(&[])?;
    let motion = spread(&without);
    let share = |value: f64| -> Result<f64, GapError> {
        let mut change = simulator.rehearsed(&[effect(value)])?;
        for (with, without) in change.iter_mut().zip(&without) {
            with.output = less(&with.output, &without.output);
        }
        Ok(spread(&change) / motion)
    };
    let sides = if first.is_amount {
        vec![[first.none, first.high], [first.none, first.low]]
    } else {
        vec![[first.low, first.high]]
    };
    let mut found = Vec::new();
    for [from, to] in sides.into_iter().filter(|[from, to]| (from - to).abs() > 0.0) {
        let [from, to] = [from, to].map(|end| first.coordinate(end));
        let place = |k: usize| first.value(from + (to - from) * k as f64 / (PLACES - 1) as f64);
        let shares: Vec<f64> = (0..PLACES).map(|k| share(place(k))).collect::<Result<_, _>>()?;
        let crosses = |k: &usize| (shares[*k] - size) * (shares[*k + 1] - size) <= 0.0;
        let away = |k: usize| (place(k) - start[at]).abs();
        let nearest = (0..PLACES - 1).filter(crosses);
        let Some(k) = nearest.min_by(|&a, &b| away(a).total_cmp(&away(b))) else { continue };
        let (mut below, mut above) = if shares[k] < shares[k + 1] {
            (place(k), place(k + 1))
        } else {
            (place(k + 1), place(k))
        };
        for _ in 0..HALVINGS {
            let middle =
                first.value(f64::midpoint(first.coordinate(below), first.coordinate(above)));
            let reached = share(middle)?;
            if (reached / size - 1.0).abs() < NEAR {
                found.push((middle, effect(middle)));
                break;
            }
            if reached < size { below = middle } else { above = middle }
        }
    }
    Ok(found)
}

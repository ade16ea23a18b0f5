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

/// A cause of a size, its spread over that of the motion; none where it has none so large. The first parameter that a weak
/// effect grows with makes the size, the first of all where none is; the others stay where a search starts.
pub(super) fn sized(
    simulator: &BenchSimulator<'_>,
    (candidate, own): (usize, &Candidate),
    size: f64,
) -> Result<Option<Effect>, GapError> {
    let at = own.parameters.iter().position(|p| p.is_amount || p.grows).unwrap_or(0);
    let (Some(start), Some(first)) = (own.starts.first(), own.parameters.get(at)) else {
        return Ok(None);
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
    let low = first.coordinate(if first.is_amount { 0.0 } else { first.low });
    let span = first.coordinate(first.high) - low;
    let place = |k: usize| first.value(low + span * k as f64 / (PLACES - 1) as f64);
    let shares: Vec<f64> = (0..PLACES).map(|k| share(place(k))).collect::<Result<_, _>>()?;
    let crosses = |k: &usize| (shares[*k] - size) * (shares[*k + 1] - size) <= 0.0;
    let nearest = (0..PLACES - 1).filter(crosses).min_by(|&a, &b| {
        let away = |k: usize| (place(k) - start[at]).abs();
        away(a).total_cmp(&away(b))
    });
    let Some(k) = nearest else { return Ok(None) };
    let rises = shares[k] < shares[k + 1];
    let (mut below, mut above) =
        if rises { (place(k), place(k + 1)) } else { (place(k + 1), place(k)) };
    for _ in 0..HALVINGS {
        let middle = first.value(f64::midpoint(first.coordinate(below), first.coordinate(above)));
        let found = share(middle)?;
        if (found / size - 1.0).abs() < NEAR {
            return Ok(Some(effect(middle)));
        }
        if found < size { below = middle } else { above = middle }
    }
    Ok(None)
}

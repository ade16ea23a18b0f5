//! A trim led to its flight from an easier one.

use crate::error::StudyError;
use crate::rotor::trimmed::TrimmedRotor;
use rotor_case::{Case, InflowChoice};
use trim::TrimSolution;

/// Halvings of a step in advance ratio that cannot be taken at once.
const MOST_HALVINGS: i32 = 4;

/// A case at another advance ratio.
fn at(case: &Case, advance_ratio: f64) -> Case {
    Case { advance_ratio, ..case.clone() }
}

/// Advance ratio of the flight from which a trim that loses its way is led to its own: the wake of hover
/// has gone, and the retreating side is far from stall.
const EASY_ADVANCE_RATIO: f64 = 0.15;

/// Trims a case, from a nearby trim if there is one. Where that does not converge the way in advance ratio is
/// halved, up to four times: continuation. Without a start, a trim that loses its way is started from that at an
/// advance ratio of 0.15; a free wake is not, its own relaxation being what fails.
///
/// # Errors
/// As [`TrimmedRotor::new`]: what stopped the shortest step, or the case itself without a start.
pub fn continued_trim(
    case: &Case,
    start: Option<&TrimSolution>,
) -> Result<TrimmedRotor, StudyError> {
    let goal = case.advance_ratio;
    let take = |mu: f64, from: &TrimSolution| {
        let trimmed = TrimmedRotor::new(&at(case, mu), Some(from))?;
        Ok((trimmed.trim().clone(), trimmed))
    };
    let from =
        |start: &TrimSolution| continuation(start.flight.advance_ratio, goal, start.clone(), take);
    match start {
        Some(start) => from(start),
        None => TrimmedRotor::new(case, None).or_else(|error| {
            let has_wake = matches!(case.inflow.model, InflowChoice::FreeWake(_));
            if !error.is_lost() || has_wake || (goal - EASY_ADVANCE_RATIO).abs() < 0.01 {
                return Err(error);
            }
            let easy = TrimmedRotor::new(&at(case, EASY_ADVANCE_RATIO), None);
            easy.and_then(|easy| from(easy.trim())).map_err(|_| error)
        }),
    }
}

/// Follows a solution from one value of a parameter to another: the whole way at once if that goes, else
/// half of what is left, at most [`MOST_HALVINGS`] times over.
fn continuation<S, T, E>(
    from: f64,
    goal: f64,
    start: S,
    take: impl Fn(f64, &S) -> Result<(S, T), E>,
) -> Result<T, E> {
    let (mut here, mut state) = (from, start);
    let mut part = 1.0;
    let least = 0.5_f64.powi(MOST_HALVINGS);
    loop {
        let next = here + part * (goal - from);
        let last = (goal - next).abs() <= 1e-9 * (goal - from).abs().max(1e-9);
        match take(if last { goal } else { next }, &state) {
            Ok((_, done)) if last => return Ok(done),
            Ok((reached, _)) => (here, state) = (next, reached),
            Err(error) if part <= least || (goal - from).abs() < 1e-12 => return Err(error),
            Err(_) => part *= 0.5,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    /// A method that takes no step longer than 0.06 is carried from 0.1 to 0.3 in steps of an eighth... of
    /// a quarter of the way, and one that takes none gives up with its error.
    #[test]
    fn a_way_too_long_is_halved() {
        let taken = RefCell::new(Vec::new());
        let take = |limit: f64| {
            let taken = &taken;
            move |mu: f64, from: &f64| {
                if (mu - from).abs() > limit {
                    return Err(format!("too far from {from}"));
                }
                taken.borrow_mut().push(mu);
                Ok((mu, mu))
            }
        };
        let reached = continuation(0.1, 0.3, 0.1, take(0.06)).unwrap();
        assert!((reached - 0.3).abs() < 1e-15);
        assert_eq!(taken.borrow().len(), 4, "{taken:?}");
        assert!(continuation(0.1, 0.3, 0.1, take(0.01)).unwrap_err().contains("0.1"));
        assert!((continuation(0.3, 0.3, 0.3, take(0.01)).unwrap() - 0.3_f64).abs() < 1e-15);
    }
}

//! Gain and zero of the reading from run to run, against the time of the session.

use crate::base::BaseModel;
use crate::numbers::{less, slope};
use crate::record::Record;
use model_gap::discovery::Reason;
use model_gap::student_exceeded;
use rotor_base::{mean, variance};

/// Fewest runs that show a change with time.
const LEAST_RUNS: usize = 5;
/// Part of the spread of the output below which a run does not tell a gain.
const LEAST_MOTION: f64 = 0.2;
/// Probability of so large a change by chance, each of gain and zero, for a change to be told.
pub(super) const TOLD: f64 = 5e-3;
/// The same for a change to make a constant gain doubtful.
pub(super) const DOUBTED: f64 = 0.05;
/// Change over the session from which it matters: of the gain, and of the zero over the spread of the output.
const LEAST_CHANGE: f64 = 0.01;

/// A gain or a zero that changes with the time of the session, the likelier one of both.
///
/// ```text
/// x_i = a + b t_i + e_i,   t = b / s(b) with n - 2 degrees of freedom
/// ```
/// `x_i` is what run `i` moves over what the base model expects of it, less 1, or its mean error. `t_i` is when the run began
/// (`start_s`), or its place among the runs where one of them does not say it. Scatter of the base model from run to run
/// is in `s(b)`.
pub(super) fn change_over_session(
    runs: &[&Record],
    base: &BaseModel,
    by_chance: f64,
) -> Option<Reason> {
    let stated: Option<Vec<f64>> = runs.iter().map(|run| run.start_s).collect();
    let is_stated = stated.is_some();
    let times = stated.unwrap_or_else(|| (0..runs.len()).map(|i| i as f64).collect());
    let (mut gains, mut zeros) = (Vec::new(), Vec::new());
    for (run, time) in runs.iter().zip(times) {
        let expected = base.predict(&run.input, run.step_s);
        let (expected, read) = (run.judged(&expected), run.judged_output());
        zeros.push((time, mean(&less(read, expected)) / base.spread));
        if variance(expected).sqrt() > LEAST_MOTION * base.spread {
            gains.push((time, slope(expected, read) - 1.0));
        }
    }
    let found = [(true, line(&gains)), (false, line(&zeros))].into_iter();
    let found = found.filter_map(|(is_gain, line)| Some((is_gain, line?)));
    let sure =
        found.filter(|(_, own)| own.by_chance < by_chance && own.change().abs() > LEAST_CHANGE);
    let (is_gain, own) = sure.min_by(|a, b| a.1.by_chance.total_cmp(&b.1.by_chance))?;
    let [first, last] = own.ends.map(|end| 100.0 * end);
    Some(Reason::ChangesOverSession {
        is_gain,
        first_percent: first,
        last_percent: last,
        is_stated,
    })
}

/// A straight line through values over time.
struct Line {
    /// Its values at the first and the last time.
    ends: [f64; 2],
    /// Probability of so large a slope by chance, of either sign.
    by_chance: f64,
}

impl Line {
    fn change(&self) -> f64 {
        self.ends[1] - self.ends[0]
    }
}

/// The line through pairs of time and value; none of fewer than [`LEAST_RUNS`] or of one time.
fn line(pairs: &[(f64, f64)]) -> Option<Line> {
    let n = pairs.len();
    if n < LEAST_RUNS {
        return None;
    }
    let (times, values): (Vec<f64>, Vec<f64>) = pairs.iter().copied().unzip();
    let (at, value) = (mean(&times), mean(&values));
    let square = variance(&times) * n as f64;
    if square <= 0.0 {
        return None;
    }
    let rise = slope(&times, &values);
    let of = |time: f64| value + rise * (time - at);
    let left: f64 = pairs.iter().map(|(time, own)| (own - of(*time)).powi(2)).sum();
    let degrees = (n - 2) as f64;
    let error = (left / degrees / square).sqrt();
    let first = times.iter().copied().fold(f64::INFINITY, f64::min);
    let last = times.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let by_chance =
        if error > 0.0 { 2.0 * student_exceeded(degrees, rise.abs() / error) } else { 0.0 };
    Some(Line { ends: [of(first), of(last)], by_chance })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slope, its error and t against a case worked by hand: values 0, 1, 1, 2, 6 at times 0..4.
    #[test]
    fn a_line_has_its_slope_and_the_probability_of_students_t() {
        let pairs = [0.0, 1.0, 1.0, 2.0, 6.0].into_iter().enumerate();
        let pairs: Vec<(f64, f64)> = pairs.map(|(i, value)| (i as f64, value)).collect();
        let own = line(&pairs).unwrap();
        // slope 1.3, residual sum 5.1, error sqrt(5.1 / 3 / 10) = 0.4123, t = 3.153 with 3 degrees
        assert!((own.change() - 5.2).abs() < 1e-12 && (own.ends[0] + 0.6).abs() < 1e-12);
        assert!((own.by_chance - 0.0511).abs() < 5e-4, "{}", own.by_chance);
        assert!(line(&pairs[..4]).is_none());
    }
}

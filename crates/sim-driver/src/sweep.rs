//! A case at several advance ratios, each trim started from the last.

use crate::SimError;
use crate::case::{InflowChoice, LoadedCase};
use crate::output::{Printable, Sheet, table};
use crate::results::{RunResult, WAKE_NOT_SETTLED, WAKE_PARTED};
use crate::study::TrimmedRotor;
use serde::Serialize;
use std::fmt::Write as _;
use trim::TrimSolution;

/// Halvings of a step in advance ratio that cannot be taken at once.
const MOST_HALVINGS: i32 = 4;

/// A case at another advance ratio.
pub fn at_advance_ratio(loaded: &LoadedCase, advance_ratio: f64) -> LoadedCase {
    let mut moved = loaded.clone();
    moved.case.advance_ratio = advance_ratio;
    moved.file.advance_ratio = advance_ratio;
    moved
}

/// Advance ratio of the flight from which a trim that loses its way is led to its own: the wake of hover
/// has gone, and the retreating side is far from stall.
const EASY_ADVANCE_RATIO: f64 = 0.15;

/// Trims a case, from a nearby trim if there is one. Where that does not converge the way in advance ratio is
/// halved, up to four times: continuation. Without a start, a trim that loses its way is started from that at an
/// advance ratio of 0.15; a free wake is not, its own relaxation being what fails.
///
/// # Errors
/// As [`TrimmedRotor::new`]: what stopped the shortest step, or the case itself without a start, with the
/// doubts about the case.
pub fn continued_trim(
    loaded: &LoadedCase,
    start: Option<&TrimSolution>,
) -> Result<TrimmedRotor, SimError> {
    let goal = loaded.case.advance_ratio;
    let take = |mu: f64, from: &TrimSolution| {
        let trimmed = TrimmedRotor::new(&at_advance_ratio(loaded, mu), Some(from))?;
        Ok((trimmed.trim().clone(), trimmed))
    };
    let from =
        |start: &TrimSolution| continuation(start.flight.advance_ratio, goal, start.clone(), take);
    let trimmed = match start {
        Some(start) => from(start),
        None => TrimmedRotor::new(loaded, None).or_else(|error| {
            let has_wake = matches!(loaded.case.inflow, InflowChoice::FreeWake(_));
            if !error.is_lost() || has_wake || (goal - EASY_ADVANCE_RATIO).abs() < 0.01 {
                return Err(error);
            }
            let easy = TrimmedRotor::new(&at_advance_ratio(loaded, EASY_ADVANCE_RATIO), None);
            easy.and_then(|easy| from(easy.trim())).map_err(|_| error)
        }),
    };
    trimmed.map_err(|error| error.in_doubt(loaded.value_doubts()))
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

/// What is found at one advance ratio.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepRow {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// The whole result, also stored in its own folder.
    pub result: RunResult,
}

/// A case over advance ratios.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepResult {
    /// One row for each, in the order asked for.
    pub rows: Vec<SweepRow>,
}

impl SweepRow {
    /// The mark of a free wake that is not at rest, and what it means.
    fn mark(&self) -> Option<(&'static str, &'static str)> {
        match self.result.wake.as_deref() {
            Some(WAKE_PARTED) => {
                Some(("**", "** wake and trim have parted: no solution, the last good state"))
            }
            Some(WAKE_NOT_SETTLED) => {
                Some(("*", "*  the wake has not settled: the state nearest to rest"))
            }
            _ => None,
        }
    }

    fn cells(&self) -> Vec<String> {
        let (t, r) = (&self.result.trim, &self.result);
        let mark = self.mark().map_or("", |(mark, _)| mark);
        let mut cells = vec![format!("{:.3}{mark}", self.advance_ratio)];
        let angles = [t.theta0_deg, t.theta1c_deg, t.theta1s_deg, t.alpha_s_deg, t.phi_s_deg];
        cells.extend(angles.map(|a| format!("{a:.3}")));
        cells.push(format!("{:.5}", t.induced_inflow));
        let power = r.mean_loads.map(|loads| format!("{:.2}", 1e-3 * loads.shaft_power_watt));
        cells.push(power.unwrap_or_default());
        cells.extend(r.baseline.hub_nb_per_rev.amplitudes().map(|a| format!("{a:.3e}")));
        let least = r.stability.least_damped.as_ref();
        cells.push(least.map_or_else(String::new, |m| format!("{:.4}", m.damping_ratio)));
        let best = r.control.iter().map(|c| c.reduction_percent).fold(f64::NAN, f64::max);
        cells.push(if best.is_nan() { "-".to_owned() } else { format!("{best:.1}") });
        cells
    }
}

const HEADER: [&str; 16] = [
    "mu", "theta0", "theta1c", "theta1s", "tilt", "bank", "inflow", "power kW", "FX", "FY", "FZ",
    "MX", "MY", "MZ", "damping", "best J %",
];

impl Printable for SweepResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!(
            "Trim (deg), power of the shaft, hub loads at the blade number per rev without control, least damping ratio, best reduction of J"
        ));
        sheet.block(&table(&HEADER, self.rows.iter().map(SweepRow::cells)));
        let mut notes: Vec<&str> = self.rows.iter().filter_map(|row| Some(row.mark()?.1)).collect();
        notes.sort_unstable();
        notes.dedup();
        for note in notes {
            sheet.line(format_args!("{note}"));
        }
        sheet.finish()
    }
}

/// The same as CSV, every digit kept; `wake` says how a free wake ended.
pub fn sweep_csv(sweep: &SweepResult) -> String {
    let mut text = String::from(
        "advance_ratio,theta0_deg,theta1c_deg,theta1s_deg,alpha_s_deg,phi_s_deg,induced_inflow,fx,fy,fz,mx,my,mz,least_damping_ratio,iterations,shaft_power_W,wake\n",
    );
    for row in &sweep.rows {
        let t = &row.result.trim;
        let least = row.result.stability.least_damped.as_ref();
        let numbers = [
            row.advance_ratio,
            t.theta0_deg,
            t.theta1c_deg,
            t.theta1s_deg,
            t.alpha_s_deg,
            t.phi_s_deg,
            t.induced_inflow,
        ]
        .into_iter()
        .chain(row.result.baseline.hub_nb_per_rev.amplitudes())
        .chain([least.map_or(f64::NAN, |m| m.damping_ratio)]);
        let power = row.result.mean_loads.map_or(f64::NAN, |loads| loads.shaft_power_watt);
        let wake = row.result.wake.as_deref().unwrap_or_default();
        let cells: Vec<String> = numbers.map(|n| format!("{n:e}")).collect();
        // writing to a string cannot fail
        let _ = writeln!(text, "{},{},{power:e},{wake}", cells.join(","), t.iterations);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{PAPER_CASE, SectionModelChoice, shipped_case};
    use std::cell::RefCell;

    fn small_paper_rotor() -> LoadedCase {
        let mut loaded = shipped_case(PAPER_CASE).unwrap();
        loaded.case.blade.elements = 4;
        loaded.case.blade.modes = [1, 1, 1];
        loaded.case.section.model = SectionModelChoice::QuasiSteady;
        loaded.case.response.span_points_per_piece = 2;
        loaded
    }

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
    /// The rotor itself: with one trim step less than the whole way takes, the whole way fails, and the
    /// continuation arrives at the same trim.
    #[test]
    fn a_rotor_that_cannot_be_trimmed_at_once_is_continued() {
        let loaded = small_paper_rotor();
        let start = TrimmedRotor::new(&at_advance_ratio(&loaded, 0.05), None).unwrap();
        let mut far = at_advance_ratio(&loaded, 0.40);
        let at_once = TrimmedRotor::new(&far, Some(start.trim())).unwrap();
        let steps = at_once.trim().iterations;
        far.case.tolerances.trim_iterations = steps - 1;
        assert!(TrimmedRotor::new(&far, Some(start.trim())).is_err(), "{steps} steps");
        let continued = continued_trim(&far, Some(start.trim())).unwrap();
        let (got, expected) = (continued.trim(), at_once.trim());
        let off = (got.controls.theta0_rad - expected.controls.theta0_rad).abs();
        assert!(off < 1e-6, "{off:e} rad");
        assert!(got.iterations < steps);
    }

    /// Without a start, the way begins at an advance ratio where the trim is easy.
    #[test]
    fn a_rotor_that_cannot_be_trimmed_from_nothing_is_led_to_its_flight() {
        let mut loaded = small_paper_rotor();
        loaded.case.advance_ratio = 0.40;
        let at_once = TrimmedRotor::new(&loaded, None).unwrap();
        let steps = at_once.trim().iterations;
        loaded.case.tolerances.trim_iterations = steps - 1;
        assert!(TrimmedRotor::new(&loaded, None).is_err(), "{steps} steps");
        let led = continued_trim(&loaded, None).unwrap();
        let off = (led.trim().controls.theta0_rad - at_once.trim().controls.theta0_rad).abs();
        assert!(off < 1e-6, "{off:e} rad");
        // and where no way leads there, the error is that of the case itself, not of the way
        loaded.case.tolerances.trim_iterations = 1;
        let text = continued_trim(&loaded, None).err().unwrap().to_string();
        assert!(text.contains("stopped after 1 iterations"), "{text}");
    }
}

//! A case at several advance ratios, and how each is trimmed.

use crate::SimError;
use crate::case::{LoadedCase, MeasuredRotor};
use crate::output::{Printable, Sheet, table};
use crate::results::Figures;
use rotor_study::{TrimmedRotor, WakeStatus};
use serde::Serialize;
use trim::TrimSolution;

/// Largest difference of advance ratios that are the same.
const SAME_FLIGHT: f64 = 1e-9;

/// A case at another advance ratio. What was measured at its own is left out.
pub fn at_advance_ratio(loaded: &LoadedCase, advance_ratio: f64) -> LoadedCase {
    let mut moved = loaded.clone();
    if (advance_ratio - loaded.case.advance_ratio).abs() > SAME_FLIGHT {
        moved.measured = MeasuredRotor::default();
    }
    moved.case.advance_ratio = advance_ratio;
    moved
}

/// Trims a case, from a nearby trim if there is one, with the plausibility warnings about the case in its error.
///
/// # Errors
/// As [`study::continued_trim`](rotor_study::continued_trim).
pub fn continued_trim(
    loaded: &LoadedCase,
    start: Option<&TrimSolution>,
) -> Result<TrimmedRotor, SimError> {
    rotor_study::continued_trim(&loaded.case, start).map_err(|error| {
        loaded.located(error).in_doubt(loaded.in_words(loaded.case.value_warnings()))
    })
}

/// Ends in failure what is no solution, after what was found is stored and shown.
///
/// # Errors
/// [`SimError::WakeDiverged`].
pub fn refuse_diverged(loaded: &LoadedCase, diverged: bool) -> Result<(), SimError> {
    if diverged {
        return Err(SimError::WakeDiverged { place: loaded.index.place("inflow.model") });
    }
    Ok(())
}

/// What is found at one advance ratio.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepRow {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// The figures of the result, which is stored in its own folder.
    pub result: Figures,
}

/// A case over advance ratios.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepResult {
    /// One row for each, in the order asked for.
    pub rows: Vec<SweepRow>,
}

impl SweepRow {
    /// The mark of a free wake that is not converged, and what it means.
    fn mark(&self) -> Option<(&'static str, &'static str)> {
        match self.result.wake? {
            WakeStatus::Converged => None,
            WakeStatus::NotConverged => {
                Some(("*", "*  the wake is not converged: the state with the least change"))
            }
            WakeStatus::Diverged => {
                Some(("**", "** wake and trim are no solution; see the warning"))
            }
        }
    }

    fn cells(&self) -> Vec<String> {
        let (t, r) = (&self.result.trim, &self.result);
        let mark = self.mark().map_or("", |(mark, _)| mark);
        let mut cells = vec![format!("{:.3}{mark}", self.advance_ratio)];
        let angles = [t.theta0_deg, t.theta1c_deg, t.theta1s_deg, t.alpha_s_deg, t.phi_s_deg];
        cells.extend(angles.map(|a| format!("{a:.3}")));
        cells.push(format!("{:.5}", t.induced_inflow));
        let loads = r.mean_loads.as_ref();
        let power = loads.map(|loads| format!("{:.2}", 1e-3 * loads.shaft_power_watt));
        cells.push(power.unwrap_or_default());
        cells.extend(r.baseline.hub_nb_per_rev.amplitudes().map(|a| format!("{a:.3e}")));
        let least = r.stability.least_damped.as_ref();
        cells.push(least.map_or_else(String::new, |m| format!("{:.4}", m.damping_ratio)));
        let best = r.control.iter().map(|c| c.reduction_percent).reduce(f64::max);
        cells.push(best.map_or_else(|| "-".to_owned(), |best| format!("{best:.1}")));
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
        sheet.line(
            "Trim (deg), power of the shaft, hub loads at the blade number per rev without control, least damping ratio, best reduction of J",
        );
        sheet.block(&table(&HEADER, self.rows.iter().map(SweepRow::cells)));
        let mut notes: Vec<&str> = self.rows.iter().filter_map(|row| Some(row.mark()?.1)).collect();
        notes.sort_unstable();
        notes.dedup();
        for note in notes {
            sheet.line(note);
        }
        sheet.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{AttachedFlowModel, PAPER_CASE, shipped_case};

    fn small_paper_rotor() -> LoadedCase {
        let mut loaded = shipped_case(PAPER_CASE).unwrap();
        loaded.case.structure.elements = 4;
        loaded.case.structure.modes = [1, 1, 1].into();
        loaded.case.aerodynamics.model = AttachedFlowModel::QuasiSteady;
        loaded.case.response.span_points_per_piece = 2;
        loaded
    }

    /// The rotor itself: with one trim step less than the whole way takes, the whole way fails, and the
    /// continuation arrives at the same trim.
    #[test]
    fn a_rotor_that_cannot_be_trimmed_at_once_is_continued() {
        let loaded = small_paper_rotor();
        let start = TrimmedRotor::new(&at_advance_ratio(&loaded, 0.05).case, None).unwrap();
        let mut far = at_advance_ratio(&loaded, 0.40);
        let at_once = TrimmedRotor::new(&far.case, Some(start.trim())).unwrap();
        let steps = at_once.trim().iterations;
        far.case.tolerances.trim_iterations = steps - 1;
        assert!(TrimmedRotor::new(&far.case, Some(start.trim())).is_err(), "{steps} steps");
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
        let at_once = TrimmedRotor::new(&loaded.case, None).unwrap();
        let steps = at_once.trim().iterations;
        loaded.case.tolerances.trim_iterations = steps - 1;
        assert!(TrimmedRotor::new(&loaded.case, None).is_err(), "{steps} steps");
        let led = continued_trim(&loaded, None).unwrap();
        let off = (led.trim().controls.theta0_rad - at_once.trim().controls.theta0_rad).abs();
        assert!(off < 1e-6, "{off:e} rad");
        // and where no way leads there, the error is that of the case itself, not of the way
        loaded.case.tolerances.trim_iterations = 1;
        let text = continued_trim(&loaded, None).err().unwrap().to_string();
        assert!(text.contains("stopped after 1 iterations"), "{text}");
    }
}

//! Every reduction computed again from a stored result alone.

use crate::SimError;
use crate::results::{HubLoads, RunResult, StoredResult};
use crate::study::loads_cost;
use hhc_control::reduction_percent;
use std::fmt;

/// What was computed again and how well it agrees.
#[derive(Debug, Clone, PartialEq)]
pub struct Recomputed {
    /// Reductions computed again.
    pub reductions: usize,
    /// Largest difference from the stored one, percentage points.
    pub largest_difference: f64,
}

/// Difference, in percentage points, that the digits of a stored number leave.
const ROUNDING: f64 = 1e-9;

/// Computes every `J_Z` and every reduction of a stored result from its hub loads and load weights.
///
/// ```text
/// J_Z = sum_k w_k (Z_kc^2 + Z_ks^2),      reduction = 100 (1 - J_Z / J_Z0)
/// ```
/// # Errors
/// [`SimError::NotReproduced`] for the first reduction that does not follow.
pub fn recomputed(stored: &StoredResult<RunResult>) -> Result<Recomputed, SimError> {
    let result = &stored.result;
    let mut largest_difference = 0.0_f64;
    for line in &result.control {
        let cost = |loads: &HubLoads| loads_cost(&line.load_weights, &loads.parts());
        let (before, after) = (cost(&result.baseline.hub_4_per_rev), cost(&line.hub_4_per_rev));
        let recomputed_percent = reduction_percent(before, after);
        let off = |a: f64, b: f64| (a - b).abs() > 1e-9 * b.abs();
        let difference = (recomputed_percent - line.reduction_percent).abs();
        let agrees = difference <= ROUNDING * (1.0 + recomputed_percent.abs());
        if !agrees || off(before, line.j_before) || off(after, line.j_after) {
            return Err(SimError::NotReproduced {
                set: line.set_name(),
                actuator: line.actuator.clone(),
                stored_percent: line.reduction_percent,
                recomputed_percent,
            });
        }
        largest_difference = largest_difference.max(difference);
    }
    Ok(Recomputed { reductions: result.control.len(), largest_difference })
}

impl fmt::Display for Recomputed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "{} reductions computed again from the stored loads and weights, largest difference {:.1e} points",
            self.reductions, self.largest_difference
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{PAPER_CASE, shipped_case};
    use crate::results::ControlLine;

    fn stored() -> StoredResult<RunResult> {
        let parts = |size: f64| std::array::from_fn(|k| size * (1.0 + k as f64));
        let weights = [1.0, 2.0, 0.5, 1.0, 3.0, 0.0];
        let (before, after) = (parts(1e-4), parts(6e-5));
        let (j_before, j_after) = (loads_cost(&weights, &before), loads_cost(&weights, &after));
        let line = ControlLine {
            harmonics: vec![3],
            actuator: "hysteretic".to_owned(),
            j_before,
            j_after,
            reduction_percent: reduction_percent(j_before, j_after),
            hub_4_per_rev: HubLoads::from_parts(after),
            load_weights: weights,
            ..ControlLine::default()
        };
        let mut result = RunResult { control: vec![line], ..RunResult::default() };
        result.baseline.hub_4_per_rev = HubLoads::from_parts(before);
        let case = shipped_case(PAPER_CASE).unwrap().file;
        StoredResult::new(&case, vec![], result).unwrap()
    }

    #[test]
    fn a_result_as_written_is_reproduced() {
        let text = serde_json::to_string(&stored()).unwrap();
        let read: StoredResult<RunResult> = serde_json::from_str(&text).unwrap();
        let found = recomputed(&read).unwrap();
        assert_eq!(found.reductions, 1);
        assert!(found.largest_difference < 1e-9);
    }

    #[test]
    fn a_changed_load_weight_or_reduction_is_noticed() {
        let change = |f: &dyn Fn(&mut ControlLine)| {
            let mut stored = stored();
            f(&mut stored.result.control[0]);
            recomputed(&stored)
        };
        assert!(change(&|_| ()).is_ok());
        let changed = [
            change(&|line| line.hub_4_per_rev.fz[0] *= 1.001),
            change(&|line| line.load_weights[1] = 1.0),
            change(&|line| line.reduction_percent += 0.01),
            change(&|line| line.j_after *= 1.0001),
        ];
        for result in changed {
            assert!(matches!(result, Err(SimError::NotReproduced { .. })), "{result:?}");
        }
    }
}

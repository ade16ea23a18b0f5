//! The control weight that meets a stroke limit.

use crate::root::{Bracketed, Trial, root_between};
use crate::sensitivity::Sensitivity;
use crate::{ControlError, ControlStep, Plant, RunError, error};

/// Where the larger stroke ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrokeStatus {
    /// Below the limit without weighting the control: `rho = 0`.
    Free,
    /// At the limit, within the tolerance and not above it.
    AtLimit,
    /// Below the limit by more than the tolerance, though a weight smaller by rounding leads above
    /// it: the end of the loop jumps there (its line searches take another pattern).
    BelowJump,
}

/// The limits of the strokes, and the stroke aimed at.
pub(crate) struct StrokeLimits {
    limits_deg: Vec<f64>,
    /// The stroke aimed at, over the limit: half the tolerance below 1.
    target: f64,
    /// Relative tolerance on the stroke.
    tolerance: f64,
}

/// A control weight and what goes with it.
#[derive(Debug, Clone)]
pub(crate) struct Weighted<S> {
    pub(crate) rho: f64,
    pub(crate) ratio: f64,
    pub(crate) state: S,
}

/// `ln rho` of the unweighted control.
const UNWEIGHTED: f64 = f64::NEG_INFINITY;

/// `ln rho` beyond which no stroke can be left, and below the negative of which a weight is none.
const LARGEST_LN_RHO: f64 = 300.0;

/// The `rho` for which the next control of the law has the target stroke, from cheap calls alone.
pub(crate) fn track_effort<P: Plant>(
    model: &Sensitivity<'_>,
    plant: &mut P,
    strokes: &StrokeLimits,
    here: &ControlStep,
) -> Result<f64, RunError<P::Error>> {
    let target = model.modal_target(here.point())?;
    let law = &model.law;
    let guess = (here.rho > 0.0).then_some(here.rho);
    // The first guess takes strokes to be in proportion to the norm of the control.
    let from_norm = |ratio: f64| {
        let shrink = if ratio.is_finite() { strokes.target / ratio } else { 0.1 };
        law.effort_for_norm(shrink * law.optimum_norm(0.0, &target), &target)
    };
    let found = find_effort(strokes.accepted(0.2), guess, from_norm, |rho| {
        Ok((strokes.ratio(plant, &law.optimum_of(rho, &target))?, ()))
    })?;
    Ok(found.0.rho)
}

impl StrokeLimits {
    pub(crate) fn of<P: Plant>(plant: &P, tolerance: f64) -> Result<Self, ControlError> {
        let limits_deg = plant.stroke_limits_deg();
        let what = "stroke limit (deg)";
        for (index, &value) in limits_deg.iter().enumerate() {
            if value.is_nan() {
                return Err(ControlError::NotFinite { what, index, value });
            }
            error::check_range(value > 0.0, what, value, "above 0")?;
        }
        Ok(Self { limits_deg, target: 1.0 - 0.5 * tolerance, tolerance })
    }

    /// Target ratio, and the accepted distance from it as a part of the tolerance.
    pub(crate) fn accepted(&self, part: f64) -> [f64; 2] {
        [self.target, part * self.tolerance]
    }

    /// Largest stroke over its limit at a control vector; infinity is an answer, NaN is not.
    pub(crate) fn ratio<P: Plant>(
        &self,
        plant: &mut P,
        control_volt: &[f64],
    ) -> Result<f64, RunError<P::Error>> {
        let strokes_deg = plant
            .strokes_deg(control_volt)
            .map_err(RunError::plant("asked for its strokes", control_volt))?;
        error::check_length("strokes", strokes_deg.len(), self.limits_deg.len())?;
        if let Some(index) = strokes_deg.iter().position(|stroke| stroke.is_nan()) {
            let (what, value) = ("stroke (deg)", strokes_deg[index]);
            Err(ControlError::NotFinite { what, index, value })?;
        }
        let pairs = strokes_deg.iter().zip(&self.limits_deg);
        let ratios =
            pairs.filter(|(_, limit)| limit.is_finite()).map(|(stroke, limit)| stroke / limit);
        Ok(ratios.fold(0.0, f64::max))
    }

    /// Whether a control of a given weight meets the limit: below it without a weight, at it with one.
    pub(crate) fn met(&self, rho: f64, ratio: f64) -> Option<StrokeStatus> {
        if ratio > 1.0 {
            None
        } else if rho == 0.0 {
            Some(StrokeStatus::Free)
        } else {
            (ratio >= 1.0 - self.tolerance).then_some(StrokeStatus::AtLimit)
        }
    }
}

/// Searches `ln rho` for the target stroke; `evaluate` gives the stroke ratio of a weight.
///
/// The stroke falls to zero as `rho` grows; if it is within its limit at `rho = 0`, that is the
/// answer, and otherwise there is a root above 0.
pub(crate) fn find_effort<S, E: std::error::Error + 'static>(
    [target, tolerance]: [f64; 2],
    guess: Option<f64>,
    first_guess: impl FnOnce(f64) -> f64,
    mut evaluate: impl FnMut(f64) -> Result<(f64, S), RunError<E>>,
) -> Result<(Weighted<S>, StrokeStatus), RunError<E>> {
    let mut at = |x: f64| -> Result<Trial<Weighted<S>>, RunError<E>> {
        let rho = x.exp();
        let (ratio, state) = evaluate(rho)?;
        Ok(Trial { x, f: (ratio / target).ln(), state: Weighted { rho, ratio, state } })
    };
    let guessed = guess.map(|rho| at(rho.ln())).transpose()?;
    let mut here = match guessed {
        Some(guessed) if guessed.f >= -tolerance => guessed,
        below => {
            let free = at(UNWEIGHTED)?;
            let ratio = free.state.ratio;
            if ratio <= 1.0 {
                return Ok((free.state, StrokeStatus::Free));
            }
            below.map_or_else(|| at(first_guess(ratio).ln()), Ok)?
        }
    };
    let mut stride: f64 = 0.1;
    let mut trials = 1;
    loop {
        if here.f.abs() <= tolerance {
            return Ok((here.state, StrokeStatus::AtLimit));
        }
        let upward = here.f > 0.0;
        if upward && here.x > LARGEST_LN_RHO {
            let Weighted { rho, ratio: stroke_ratio, .. } = here.state;
            Err(ControlError::StrokeNotMet { rho, stroke_ratio, trials })?;
        }
        if !upward && here.x < -LARGEST_LN_RHO {
            // runs that go on from the one before may end below the limit with any weight
            return Ok((here.state, StrokeStatus::BelowJump));
        }
        // The stroke of a linear actuator falls no faster than 1 / rho: the root is |f| away or more.
        stride = (2.0 * stride).max(if here.f.is_finite() { 1.5 * here.f.abs() } else { 1.0 });
        let next = at(if upward { here.x + stride } else { here.x - stride })?;
        if next.f.abs() > tolerance && (next.f > 0.0) != upward {
            let found = root_between((here, next), tolerance, &mut at)?;
            return Ok(match found {
                Bracketed::Root(root) => (root.state, StrokeStatus::AtLimit),
                Bracketed::Jump { negative, .. } => (negative.state, StrokeStatus::BelowJump),
            });
        }
        here = next;
        trials += 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    /// Runs that go on from the one before need not come back to an end above the limit.
    #[test]
    fn a_stroke_that_stays_below_its_limit_ends_the_search() {
        let mut runs = 0;
        let found: Result<_, RunError<Infallible>> = find_effort(
            [1.0, 1e-3],
            Some(1.0),
            |_| 1.0,
            |_| {
                runs += 1;
                assert!(runs < 100, "no end");
                Ok((if runs == 2 { 2.0 } else { 0.5 }, ()))
            },
        );
        let (found, status) = found.unwrap();
        assert_eq!((status, found.ratio), (StrokeStatus::BelowJump, 0.5));
    }
}

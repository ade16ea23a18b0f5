//! Root of one scalar function inside a bracket, frugal in evaluations.

/// One evaluation: argument, value, and what was computed on the way.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Trial<S> {
    pub(crate) x: f64,
    pub(crate) f: f64,
    pub(crate) state: S,
}

/// What a bracket holds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Bracketed<S> {
    /// `|f| <= tolerance` here.
    Root(Trial<S>),
    /// The function jumps over zero between two neighbouring numbers: negative and positive side.
    Jump { negative: Trial<S>, positive: Trial<S> },
}

/// Root of `f` between two trials of opposite sign, by the regula falsi with the Anderson-Bjorck
/// weight, bisecting when a value is infinite or when three steps have not halved the bracket.
///
/// Superlinear on a smooth function, never slower than bisection by more than a factor of four.
///
/// Source: N. Anderson, A. Bjorck, *A new high order method of regula falsi type for computing a root
/// of an equation*, BIT 13 (1973).
pub(crate) fn root_between<S, E>(
    ends: (Trial<S>, Trial<S>),
    tolerance: f64,
    mut evaluate: impl FnMut(f64) -> Result<Trial<S>, E>,
) -> Result<Bracketed<S>, E> {
    let (mut held, mut fresh) = ends;
    let mut held_weight = 1.0;
    let mut width_before = (fresh.x - held.x).abs();
    let mut slow_steps = 0;
    loop {
        let width = (fresh.x - held.x).abs();
        let middle = f64::midpoint(held.x, fresh.x);
        let spacing = 4.0 * f64::EPSILON * middle.abs();
        if width <= spacing.max(f64::MIN_POSITIVE) {
            let (negative, positive) = if fresh.f < 0.0 { (fresh, held) } else { (held, fresh) };
            return Ok(Bracketed::Jump { negative, positive });
        }
        let secant = fresh.x - fresh.f * (fresh.x - held.x) / (fresh.f - held_weight * held.f);
        let inside = secant > held.x.min(fresh.x) && secant < held.x.max(fresh.x);
        if width > 0.5 * width_before {
            slow_steps += 1;
        } else {
            (slow_steps, width_before) = (0, width);
        }
        let bisect = !inside || slow_steps >= 3;
        if bisect {
            (slow_steps, width_before) = (0, width);
        }
        let trial = evaluate(if bisect { middle } else { secant })?;
        let f = trial.f;
        if f.abs() <= tolerance {
            return Ok(Bracketed::Root(trial));
        }
        if f.is_sign_negative() == fresh.f.is_sign_negative() {
            let weight = 1.0 - f / fresh.f;
            held_weight *= if weight > 0.0 && weight.is_finite() { weight } else { 0.5 };
            fresh = trial;
        } else {
            held_weight = 1.0;
            held = std::mem::replace(&mut fresh, trial);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn solve(
        f: impl Fn(f64) -> f64,
        low: f64,
        high: f64,
        tolerance: f64,
    ) -> (Bracketed<()>, usize) {
        let mut evaluations = 0;
        let trial = |x: f64| Trial { x, f: f(x), state: () };
        let found: Result<_, Infallible> =
            root_between((trial(low), trial(high)), tolerance, |x| {
                evaluations += 1;
                Ok(trial(x))
            });
        (found.unwrap(), evaluations)
    }

    fn root(found: &Bracketed<()>) -> f64 {
        match found {
            Bracketed::Root(trial) => trial.x,
            Bracketed::Jump { .. } => f64::NAN,
        }
    }

    #[test]
    fn smooth_functions_take_few_evaluations() {
        type Case<'a> = (&'a dyn Fn(f64) -> f64, [f64; 2], f64);
        let cases: [Case<'_>; 4] = [
            (&|x| x.exp() - 2.0, [-1.0, 3.0], 2.0_f64.ln()),
            (&|x| x.powi(3) - 8.0, [0.0, 10.0], 2.0),
            (&|x| 1.0 - x, [-5.0, 7.0], 1.0),
            (&|x| (x - 0.3).atan() * 40.0, [-20.0, 90.0], 0.3),
        ];
        for (f, [low, high], exact) in cases {
            let (found, evaluations) = solve(f, low, high, 1e-12);
            assert!((root(&found) - exact).abs() < 1e-11, "{found:?}");
            assert!(evaluations <= 16, "{evaluations}");
            let (swapped, _) = solve(f, high, low, 1e-12);
            assert!((root(&swapped) - exact).abs() < 1e-11, "{swapped:?}");
        }
    }

    #[test]
    fn infinite_values_are_bisected_away() {
        let (found, evaluations) =
            solve(|x| if x > 2.0 { f64::INFINITY } else { x - 1.999 }, 0.0, 9.0, 1e-6);
        assert!((root(&found) - 1.999).abs() < 1e-6);
        assert!(evaluations < 40, "{evaluations}");
    }

    #[test]
    fn a_jump_is_told_from_a_root() {
        let (found, _) = solve(|x| if x > 0.5 { 1.0 } else { -2.0 }, 0.0, 3.0, 1e-6);
        let Bracketed::Jump { negative, positive } = found else { panic!("{found:?}") };
        assert!(negative.f < 0.0 && positive.f > 0.0);
        assert!((negative.x - 0.5).abs() < 1e-14 && (positive.x - 0.5).abs() < 1e-14);
    }
}

//! Rate dependence of the hysteresis.

use super::cause::{BenchCause, lag, lags_s, linear, shape, usual};
use super::chain::Rate;
use model_gap::{Candidate, Class};

/// Rate dependence of the hysteresis.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| Candidate {
        id: "rate-dependence",
        physics: "Domains take time: the law relaxes towards its static value, with a time that depends on its state.",
        parameters: vec![lag("tau", design), shape(linear("position", "1", -0.6, 0.6))],
        class: Class::LagBehindTerminals,
        fingerprint: "phase and loop area grow with frequency and depend on amplitude and place; odd harmonics",
        confused_with: &["electrical-lag", "transport-delay", "sensor-filter"],
        separating: &["multisine-5-181Hz", "amplitude-sweep", "laser-cross-check"],
        starts: lags_s(design).map(|tau| [vec![tau, 0.1], vec![tau, -0.1]]).concat(),
        blocked: design.one_frequency(),
        ..usual()
    },
    apply: |chain, values| {
        chain.front.rate = Some(Rate { tau_s: values[0], position: values[1] });
    },
};

/// The law's output relaxing towards its static value.
///
/// ```text
/// y' = (h - y) / tau(y),   tau(y) = tau (1 + position (y - middle) / spread)
/// ```
/// Each step takes the relaxation time of its first state and is then exact for an `h` straight over
/// the step. `scale` is middle and spread of the output.
/// Source: I. D. Mayergoyz, *Dynamic Preisach models of hysteresis*, IEEE Transactions on Magnetics 24
/// (1988): relaxation towards the static value, with a state-dependent time.
pub(crate) fn rate_dependent(
    law: &[f64],
    tau_s: f64,
    position: f64,
    scale: (f64, f64),
    step_s: f64,
) -> Vec<f64> {
    let (middle, spread) = scale;
    let per_output = position / spread;
    let steps = step_s / tau_s;
    let mut before = law.first().copied().unwrap_or_default();
    let mut deviation = 0.0;
    law.iter()
        .map(|&h| {
            let of_law = 1.0 + per_output * (before - middle);
            let slower = (of_law + per_output * deviation).clamp(0.1, 10.0);
            let (decay, ramp) = decay_and_ramp(steps, slower);
            deviation = decay * deviation - ramp * (h - before);
            before = h;
            h + deviation
        })
        .collect()
}

/// `exp(-x / s)` and `(1 - exp(-x / s)) s / x`, for a step of `x` relaxation times that are `s` times as long.
///
/// Short steps take the diagonal Pade fraction of fourth order, which is within `4e-8 (x / s)^9` of the
/// exponential: every sample waits for the one before it, and the fraction needs a single division.
fn decay_and_ramp(x: f64, s: f64) -> (f64, f64) {
    const SHORT: f64 = 0.5;
    if x > SHORT * s {
        let decay = (-x / s).exp();
        return (decay, (1.0 - decay) * s / x);
    }
    let (xx, ss) = (x * x, s * s);
    let even = ss * (ss + xx * (3.0 / 28.0)) + xx * xx * (1.0 / 1680.0);
    let odd = s * (0.5 * ss + xx * (1.0 / 84.0));
    let whole = 1.0 / (even + x * odd);
    ((even - x * odd) * whole, 2.0 * s * odd * whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn short_steps_are_steps() {
        for x in [1e-6_f64, 1e-3, 0.1, 0.3, 0.499_999, 0.5, 0.500_001, 2.0, 40.0] {
            for slower in [0.1, 0.7, 1.0, 10.0] {
                let (decay, ramp) = decay_and_ramp(x * slower, slower);
                assert_relative_eq!(decay, (-x).exp(), max_relative = 2e-10);
                assert_relative_eq!(ramp, -(-x).exp_m1() / x, max_relative = 2e-10);
            }
        }
    }
}

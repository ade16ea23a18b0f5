//! The exact step of a first-order lag.

/// The exact step of a first-order lag, for the deviation `d = y - u` of its output from its input.
///
/// ```text
/// d1 = e d0 - phi (u1 - u0),   x = h / tau,   e = exp(-x),   phi = (1 - e) / x
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LagStep {
    tau_s: f64,
    decay: f64,
    ramp: f64,
}

impl LagStep {
    pub(crate) fn new(tau_s: f64, step_s: f64) -> Self {
        let x = step_s / tau_s;
        let (decay, ramp) =
            if tau_s == 0.0 { (0.0, 0.0) } else { ((-x).exp(), -(-x).exp_m1() / x) };
        Self { tau_s, decay, ramp }
    }

    /// The deviation one step on, the input changing by `change` in a straight line.
    #[inline]
    pub(crate) fn deviation(&self, deviation: f64, change: f64) -> f64 {
        self.decay * deviation - self.ramp * change
    }

    /// The deviation that a periodic input leads to, from those before and after one period; the
    /// present one where the lag is short enough to get there by itself.
    pub(crate) fn settled(&self, before: f64, now: f64, period_s: f64) -> f64 {
        let x = period_s / self.tau_s;
        if x > SHORT_PERIOD { now } else { before - (now - before) / (-x).exp_m1() }
    }
}

/// Periods of less than this many time constants are too short to wait for.
const SHORT_PERIOD: f64 = 1.5;

//! Linear filters, each stepped exactly while its input runs in straight lines.

/// A first-order lag `tau z' + z = x`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Lag {
    keep: f64,
    tau_steps: f64,
    input: f64,
    output: f64,
}

impl Lag {
    /// The lag at rest at `rest`.
    pub(crate) fn new(tau_s: f64, dt_s: f64, rest: f64) -> Self {
        let tau_steps = tau_s / dt_s;
        Self { keep: (-1.0 / tau_steps).exp(), tau_steps, input: rest, output: rest }
    }

    /// The same lag with another time constant from here on.
    pub(crate) fn retuned(self, tau_s: f64, dt_s: f64) -> Self {
        let tau_steps = tau_s / dt_s;
        Self { keep: (-1.0 / tau_steps).exp(), tau_steps, ..self }
    }

    /// The output when the input has run straight to `x`.
    ///
    /// ```text
    /// z = x - m tau + (z0 - x0 + m tau) exp(-dt/tau),   m = (x - x0)/dt
    /// ```
    pub(crate) fn step(&mut self, x: f64) -> f64 {
        let behind = (x - self.input) * self.tau_steps;
        self.output = x - behind + (self.output - self.input + behind) * self.keep;
        self.input = x;
        self.output
    }

    /// The output.
    pub(crate) fn output(&self) -> f64 {
        self.output
    }
}

/// A second-order system `y'' + 2 zeta w y' + w^2 y = w^2 x`, `zeta < 1`.
///
/// Behind a ramp of slope `m` the rest `e = y - x + 2 zeta m/w` turns and decays:
/// `(e, (e' + zeta w e)/w_d)` is rotated by `w_d dt` and shrinks by `exp(-zeta w dt)`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SecondOrder {
    dt_s: f64,
    behind_s: f64,
    decay_per_s: f64,
    damped_per_s: f64,
    rotation: (f64, f64),
    input: f64,
    output: f64,
    speed: f64,
}

impl SecondOrder {
    /// The system at rest at `rest`.
    pub(crate) fn new(frequency_hz: f64, damping_ratio: f64, dt_s: f64, rest: f64) -> Self {
        let omega = std::f64::consts::TAU * frequency_hz;
        let (decay_per_s, damped_per_s) =
            (damping_ratio * omega, omega * (1.0 - damping_ratio * damping_ratio).sqrt());
        let (sine, cosine) = (damped_per_s * dt_s).sin_cos();
        let shrink = (-decay_per_s * dt_s).exp();
        Self {
            dt_s,
            behind_s: 2.0 * damping_ratio / omega,
            decay_per_s,
            damped_per_s,
            rotation: (shrink * cosine, shrink * sine),
            input: rest,
            output: rest,
            speed: 0.0,
        }
    }

    /// The output when the input has run straight to `x`.
    pub(crate) fn step(&mut self, x: f64) -> f64 {
        let slope = (x - self.input) / self.dt_s;
        let behind = slope * self.behind_s;
        let rest = self.output - self.input + behind;
        let other = (self.speed - slope + self.decay_per_s * rest) / self.damped_per_s;
        let (cosine, sine) = self.rotation;
        let (rest, other) = (cosine * rest + sine * other, cosine * other - sine * rest);
        self.output = x - behind + rest;
        self.speed = slope + self.damped_per_s * other - self.decay_per_s * rest;
        self.input = x;
        self.output
    }
}

/// Replaces a signal of straight lines by itself, `steps` samples later; at rest before its beginning.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a sample number between 0 and the length of the record"
)]
pub(crate) fn delay(signal: &mut [f64], steps: f64) {
    let whole = steps.floor() as usize;
    let share = steps - steps.floor();
    for i in (0..signal.len()).rev() {
        let at = |back: usize| signal[i.saturating_sub(back)];
        signal[i] = (1.0 - share) * at(whole) + share * at(whole + 1);
    }
}

/// Changes every sample in turn.
pub(crate) fn each(signal: &mut [f64], change: impl FnMut(&mut f64)) {
    signal.iter_mut().for_each(change);
}

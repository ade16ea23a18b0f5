//! The chain: a signal passes through physical stages one after the other.
//!
//! Every effect of an actuator is one [`Stage`] in one file. A generator for another actuator, with
//! an effect more or less, is another list of stages.

use std::fmt::Debug;

/// One physical effect between its input and its output.
///
/// The input is taken to run linearly from the value of the previous call to that of this one
/// (first-order hold), so that a stage can be exact for piecewise linear inputs.
pub trait Stage: Debug + Send {
    /// The state after an infinitely long rest at `input`; returns the output there.
    fn settle(&mut self, input: f64) -> f64;

    /// Moves the input linearly to `input` during `dt_s` seconds; returns the output at the end.
    fn step(&mut self, input: f64, dt_s: f64) -> f64;
}

/// Stages in the order in which the signal meets them.
#[derive(Debug, Default)]
pub struct Chain {
    stages: Vec<Box<dyn Stage>>,
}

impl Chain {
    /// An empty chain: output equals input.
    pub fn new() -> Self {
        Self::default()
    }

    /// The chain with `stage` appended at its output end.
    #[must_use]
    pub fn then(mut self, stage: impl Stage + 'static) -> Self {
        self.stages.push(Box::new(stage));
        self
    }
}

impl Stage for Chain {
    fn settle(&mut self, input: f64) -> f64 {
        self.stages.iter_mut().fold(input, |signal, stage| stage.settle(signal))
    }

    fn step(&mut self, input: f64, dt_s: f64) -> f64 {
        self.stages.iter_mut().fold(input, |signal, stage| stage.step(signal, dt_s))
    }
}

/// Exact step of `tau x' = h - x` while `h` runs linearly from `h0` to `h1`.
///
/// ```text
/// x(t) = h0 + s (t - tau) + (x0 - h0 + s tau) exp(-t/tau),   s = (h1 - h0)/t
/// ```
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `x` | `x0` | as the input | any |
/// | `from`, `to` | `h0`, `h1` | as the input | any |
/// | `dt_s` | `t` | s | > 0 |
/// | `time_constant_s` | `tau` | s | > 0 |
///
/// Returns `x(t)`. Source: variation of constants.
pub fn first_order_hold(x: f64, from: f64, to: f64, dt_s: f64, time_constant_s: f64) -> f64 {
    HeldLag::new(dt_s, time_constant_s).step(x, from, to)
}

/// [`first_order_hold`] for many steps of one length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeldLag {
    dt_s: f64,
    time_constant_s: f64,
    decay: f64,
}

impl HeldLag {
    /// A lag `tau > 0` stepped by `t > 0`, both in seconds.
    pub fn new(dt_s: f64, time_constant_s: f64) -> Self {
        Self { dt_s, time_constant_s, decay: (-dt_s / time_constant_s).exp() }
    }

    /// The state one step after `x`, the input running from `from` to `to`.
    pub fn step(&self, x: f64, from: f64, to: f64) -> f64 {
        let lead = (to - from) / self.dt_s * self.time_constant_s;
        to - lead + (x - from + lead) * self.decay
    }
}

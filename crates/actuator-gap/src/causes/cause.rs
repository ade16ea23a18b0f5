//! What a cause is: where it enters the chain, what data must contain to show it, where a search begins.

use super::chain::Chain;
use super::design::Design;
use model_gap::{Candidate, Parameter, Scale};

/// One cause of the bench.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BenchCause {
    /// What it is for data of a design: parameters, starts of a search, and why these data cannot show it or
    /// show that it is not there.
    pub(super) candidate: fn(&Design) -> Candidate,
    /// Switches it on in a chain: the one place where it enters the model.
    pub(super) apply: fn(&mut Chain, &[f64]),
}

/// A candidate that any data may show, whose model is as wrong as that of a cause usually is: no lag is of
/// one pole, no joint dry alone.
pub(super) fn usual() -> Candidate {
    Candidate { form_error: 0.05, ..Candidate::default() }
}

/// A parameter searched on a logarithmic scale.
pub(super) fn logarithmic(
    name: &'static str,
    unit: &'static str,
    low: f64,
    high: f64,
) -> Parameter {
    Parameter { scale: Scale::Log, ..linear(name, unit, low, high) }
}

/// A parameter that a weak effect grows in proportion to.
pub(super) fn growing(parameter: Parameter) -> Parameter {
    Parameter { grows: true, ..parameter }
}

/// A parameter searched on a straight scale.
pub(super) fn linear(name: &'static str, unit: &'static str, low: f64, high: f64) -> Parameter {
    Parameter { name, unit, low, high, ..Parameter::default() }
}

/// An amount of an effect, which is none at zero.
pub(super) fn amount(name: &'static str, unit: &'static str, low: f64, high: f64) -> Parameter {
    Parameter { is_amount: true, ..linear(name, unit, low, high) }
}

/// Gain and zero of a voltage over a range of so many volts, as errors.
pub(super) fn gain_and_zero(span: f64) -> Vec<Parameter> {
    vec![amount("gain_error", "1", -0.5, 0.5), amount("zero", "V", -0.2 * span, 0.2 * span)]
}

/// A parameter that only shapes the effect.
pub(super) fn shape(parameter: Parameter) -> Parameter {
    Parameter { is_shape: true, ..parameter }
}

/// Starts of a single parameter.
pub(super) fn singles<const N: usize>(values: [f64; N]) -> Vec<Vec<f64>> {
    values.map(|value| vec![value]).to_vec()
}

/// A lag or a delay, s: 10 us to 50 ms, and as many times longer as the bench is slower than usual.
pub(super) fn lag(name: &'static str, design: &Design) -> Parameter {
    growing(logarithmic(name, "s", 1e-5 * design.slower, 0.05 * design.slower))
}

/// Time constants that a search for a lag or a delay begins at, s.
pub(super) fn lags_s(design: &Design) -> [f64; 4] {
    [2e-4, 1e-3, 4e-3, 0.015].map(|tau| tau * design.slower)
}

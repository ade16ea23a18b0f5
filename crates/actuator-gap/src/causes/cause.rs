//! What a cause is: where it enters the chain, what data must contain to show it, where a search begins.

use super::chain::Chain;
use super::design::Design;
use model_gap::{Cause, Parameter, Scale};

/// Part of its effect by which the model of a cause is usually wrong: no lag is of one pole, no joint dry
/// alone.
pub(super) const FORM_ERROR: f64 = 0.05;

/// One cause of the bench.
pub(crate) trait BenchCause: Sync + Send {
    /// What it is.
    fn cause(&self, design: &Design) -> Cause;
    /// Where a search begins.
    fn starts(&self, design: &Design) -> Vec<Vec<f64>>;
    /// Why these data cannot show it, seen before any fit.
    fn blocked(&self, _: &Design) -> Option<String> {
        None
    }
    /// Why these data show that it is not there, seen before any fit.
    fn refuted(&self, _: &Design) -> Option<String> {
        None
    }
    /// What it would be, where it is a decoy and no cause of the library.
    fn decoy(&self) -> Option<&'static str> {
        None
    }
    /// Switches it on in a chain: the one place where it enters the model.
    fn apply(&self, chain: &mut Chain, values: &[f64]);
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

/// A parameter searched on a straight scale.
pub(super) fn linear(name: &'static str, unit: &'static str, low: f64, high: f64) -> Parameter {
    Parameter {
        name,
        unit,
        low,
        high,
        scale: Scale::Linear,
        is_shape: false,
        is_amount: false,
        needs: None,
        held: None,
        step: None,
    }
}

/// An amount of an effect, which is none at zero.
pub(super) fn amount(name: &'static str, unit: &'static str, low: f64, high: f64) -> Parameter {
    Parameter { is_amount: true, ..linear(name, unit, low, high) }
}

/// A parameter that only shapes the effect.
pub(super) fn shape(parameter: Parameter) -> Parameter {
    Parameter { is_shape: true, ..parameter }
}

/// A parameter that is taken and not fitted, with its standard deviation.
pub(super) fn held(parameter: Parameter, std: f64) -> Parameter {
    Parameter { held: Some(std), ..shape(parameter) }
}

/// Starts of a single parameter.
pub(super) fn singles(values: &[f64]) -> Vec<Vec<f64>> {
    values.iter().map(|&v| vec![v]).collect()
}

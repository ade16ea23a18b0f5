//! Parameters in physical terms: what a search calls `ln gain` as a gain with its 95 % interval.

use super::KnownQuantity;
use preisach_dyn::identify::{Estimate, QuantityUnit};
use preisach_dyn::{ActuatorLaw, ActuatorModel};
use serde::Serialize;

/// A parameter of a model in physical terms.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct PhysicalParameter {
    /// What it is.
    pub name: String,
    /// Its unit; empty of a plain number.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Ends of its 95 % interval; none if the records do not determine it.
    pub interval: Option<[f64; 2]>,
    /// What else is to be known of the interval: where it comes from, that it reaches a bound.
    pub remark: Option<&'static str>,
}

/// Half of a 95 % interval over the standard deviation.
const HALF: f64 = 1.96;
/// Step of the slope of a reading.
const SLOPE: f64 = 1e-6;
/// Part of an interval that ends next to a bound.
const NEAR: f64 = 1e-3;

const TIED: &str = "tied to its usual value";
const AT_BOUND: &str = "at its bound";

/// Unit of a parameter, in terms of those of input and output.
#[derive(Clone, Copy)]
enum Of {
    Input,
    Output,
    Gain,
    Word(&'static str),
}

/// How a number of a search is read.
struct Reading {
    name: &'static str,
    unit: Of,
    /// The physical value, up to a factor.
    of: fn(f64) -> f64,
    /// Where the model has it: gives the factor.
    at: fn(&ActuatorModel) -> Option<f64>,
    /// Bounds of it, before the factor.
    bounds: [f64; 2],
}

const FREE: [f64; 2] = [f64::NEG_INFINITY, f64::INFINITY];

fn share(x: f64) -> f64 {
    1.0 / (1.0 + (-x).exp())
}

fn nowhere(_: &ActuatorModel) -> Option<f64> {
    None
}

fn gain(model: &ActuatorModel) -> Option<f64> {
    match &model.law {
        ActuatorLaw::Linear(law) => Some(law.gain_deg_per_volt),
        ActuatorLaw::BoucWen(law) => Some(law.parameters().gain_deg_per_volt),
        ActuatorLaw::PrandtlIshlinskii(law) => Some(law.parameters().gain_deg_per_volt),
        ActuatorLaw::HystereticOscillator(law) => Some(law.parameters().gain_deg_per_volt),
        _ => None,
    }
}

fn half_height(model: &ActuatorModel) -> Option<f64> {
    let ActuatorLaw::BoucWen(law) = &model.law else { return None };
    Some(law.parameters().half_height_deg)
}

fn reading(name: &str) -> Option<Reading> {
    let plain = |name, unit, of, bounds| Reading { name, unit, of, at: nowhere, bounds };
    Some(match name {
        "gain, relative" => Reading { at: gain, ..plain("gain", Of::Gain, |x| 1.0 + x, FREE) },
        "ln gain" => Reading { at: gain, ..plain("gain", Of::Gain, f64::exp, FREE) },
        "ln time constant, s" => plain("time constant of the lag", Of::Word("s"), f64::exp, FREE),
        "quadratic, artanh" => plain(
            "quadratic part of the output curve",
            Of::Word(""),
            |x| 0.45 * x.tanh(),
            [-0.45, 0.45],
        ),
        "cubic, artanh" => {
            plain("cubic part of the output curve", Of::Word(""), |x| 0.3 * x.tanh(), [-0.3, 0.3])
        }
        "loop height, logit" => Reading {
            at: half_height,
            ..plain("half height of a wide loop", Of::Output, share, [0.0, 1.0])
        },
        "ln rise over 20 V" => plain("rise of a loop", Of::Input, |x| 20.0 * x.exp(), FREE),
        "ln (2 sigma - 1)" => {
            plain("sigma", Of::Word(""), |x| 0.5 + 0.5 * x.exp(), [0.5, f64::INFINITY])
        }
        "ln growth of the half-widths, s" => {
            plain("growth of the half-widths", Of::Word("s"), f64::exp, FREE)
        }
        "ln natural frequency, Hz" => {
            plain("natural frequency of the mode", Of::Word("Hz"), f64::exp, FREE)
        }
        "ln damping ratio" => plain("damping ratio of the mode", Of::Word(""), f64::exp, FREE),
        "hysteretic share of the stiffness, logit" => plain(
            "hysteretic share of the stiffness",
            Of::Word("%"),
            |x| 99.0 * share(x),
            [0.0, 99.0],
        ),
        "ln relaxation time, s" => plain("relaxation time", Of::Word("s"), f64::exp, FREE),
        "share at once, logit" => {
            plain("share that follows at once", Of::Word("%"), |x| 30.0 * share(x), [0.0, 30.0])
        }
        "creep per decade, logit" => {
            plain("creep", Of::Word("%/decade"), |x| 6.0 * share(x), [0.0, 6.0])
        }
        "root of the share of the accommodation" => plain(
            "share of the accommodation",
            Of::Word("%"),
            |x| (100.0 * x * x).min(50.0),
            [0.0, 50.0],
        ),
        _ => return None,
    })
}

/// What a model says in physical terms: the parameters of its search that have a meaning, and its quantities. Where both have
/// a name, the wider interval stands. Numbers of a shape are left out.
pub(super) fn physical(
    estimates: &[Estimate],
    known: &[KnownQuantity],
    model: &ActuatorModel,
    units: [&str; 2],
) -> Vec<PhysicalParameter> {
    let read = estimates.iter().filter_map(|own| read(own, model, units));
    let mut all: Vec<PhysicalParameter> = read.collect();
    for own in known.iter().map(|own| told(own, units)) {
        match all.iter_mut().find(|there| there.name == own.name) {
            Some(there) => {
                // what the records do not determine stays so
                if let (Some(new), Some(old)) = (own.interval, &mut there.interval)
                    && new[1] - new[0] > old[1] - old[0]
                {
                    *old = new;
                }
            }
            None => all.push(own),
        }
    }
    all
}

/// A quantity as a parameter.
fn told(known: &KnownQuantity, [input, output]: [&str; 2]) -> PhysicalParameter {
    let KnownQuantity { quantity, interval } = known;
    // what cannot be negative is not negative
    let is_positive = !matches!(quantity.unit, QuantityUnit::Output | QuantityUnit::Percent);
    PhysicalParameter {
        name: quantity.name.to_owned(),
        unit: match quantity.unit {
            QuantityUnit::Output => output.to_owned(),
            QuantityUnit::OutputRate => format!("{output} s/{input}"),
            QuantityUnit::Seconds => "s".to_owned(),
            QuantityUnit::Hertz => "Hz".to_owned(),
            QuantityUnit::Percent => "%".to_owned(),
            QuantityUnit::PercentPerDecade => "%/decade".to_owned(),
            QuantityUnit::Plain => String::new(),
        },
        value: quantity.value,
        interval: interval.map(|[low, high]| [if is_positive { low.max(0.0) } else { low }, high]),
        remark: interval.is_none().then_some("no interval: a fit to drawn residuals failed"),
    }
}

/// A parameter of a search in physical terms; none of a shape.
fn read(
    estimate: &Estimate,
    model: &ActuatorModel,
    [input, output]: [&str; 2],
) -> Option<PhysicalParameter> {
    let Estimate { value, std_deviation, .. } = *estimate;
    let half = HALF * std_deviation;
    let tied = estimate.is_tied().then_some(TIED);
    let Reading { name, unit, of, at, bounds } = reading(&estimate.name)?;
    let here = of(value);
    let factor = at(model).filter(|_| here != 0.0).map_or(1.0, |own| own / here);
    // a square is not negative on either side of zero
    let ends = [of(value - half), of(value + half)];
    let is_square = estimate.name.starts_with("root");
    // a share that is zero lies infinitely far away on its own scale: there the straight line counts
    let slope = (of(value + SLOPE) - of(value - SLOPE)) / (2.0 * SLOPE);
    let is_share = estimate.name.ends_with("logit") && half * slope >= here;
    let has_zero = is_share || (is_square && half > value.abs());
    let low = if has_zero { 0.0 } else { f64::min(ends[0], ends[1]) };
    let high = f64::max(ends[0], ends[1]);
    let is_near = |bound: f64| {
        bound.is_finite() && (here - bound).abs() <= NEAR * (bounds[1] - bounds[0]).abs().min(1.0)
    };
    let at_bound = bounds.into_iter().any(is_near).then_some(AT_BOUND);
    let scaled = [factor * low, factor * high];
    Some(PhysicalParameter {
        name: name.to_owned(),
        unit: match unit {
            Of::Input => input.to_owned(),
            Of::Output => output.to_owned(),
            Of::Gain => format!("{output}/{input}"),
            Of::Word(word) => word.to_owned(),
        },
        value: factor * here,
        interval: half
            .is_finite()
            .then_some([f64::min(scaled[0], scaled[1]), f64::max(scaled[0], scaled[1])]),
        remark: at_bound.or(tied),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::VoltageRange;
    use preisach_dyn::identify::Quantity;

    fn estimate(name: &str, value: f64, std_deviation: f64) -> Estimate {
        Estimate { name: name.into(), value, std_deviation, usual_share: 0.0 }
    }

    #[test]
    fn logarithms_are_read_as_what_they_are_of() {
        let model = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04);
        let estimates = [
            estimate("gain, relative", 0.25, 0.05),
            estimate("ln time constant, s", 0.01_f64.ln(), 0.1),
            estimate("ln rise over 20 V", 0.0, f64::INFINITY),
            estimate("creep per decade, logit", -20.0, 0.5),
            estimate("ln mu0 per centre", 0.3, 0.1),
        ];
        let quantity = |name, unit, value| Quantity { name, unit, value };
        let lag = quantity("time constant of the lag", QuantityUnit::Seconds, 0.01);
        let stroke = quantity("stroke", QuantityUnit::Output, -20.0);
        let known = [
            KnownQuantity { quantity: lag, interval: Some([-0.01, 0.03]) },
            KnownQuantity { quantity: stroke, interval: Some([-21.0, -19.0]) },
        ];
        let found = physical(&estimates, &[], &model, ["V", "deg"]);
        let own = gain(&model).unwrap();
        assert_eq!((found[0].value, found[0].unit.as_str()), (own, "deg/V"));
        let [low, high] = found[0].interval.unwrap();
        assert!((high - low - own * 2.0 * HALF * 0.05 / 1.25).abs() < 1e-12);
        assert_eq!(found[1].unit, "s");
        let [low, high] = found[1].interval.unwrap();
        assert!((low - 0.01 * (-0.196_f64).exp()).abs() < 1e-12 && high > 0.012, "{low} {high}");
        assert_eq!((found[2].value, found[2].interval), (20.0, None));
        assert_eq!(found[3].remark, Some("at its bound"));
        // half a percent of creep give or take as much may be none
        let creep = |std_deviation| {
            let own = estimate("creep per decade, logit", (0.5_f64 / 5.5).ln(), std_deviation);
            physical(&[own], &[], &model, ["V", "deg"])[0].interval.unwrap()[0]
        };
        assert!(creep(0.6) <= 0.0 && creep(0.3) > 0.2);
        // a shape has no physical value; of two intervals the wider one stands
        assert_eq!(found.len(), 4);
        let found = physical(&estimates, &known, &model, ["V", "deg"]);
        assert_eq!(found[1].interval, Some([0.0, 0.03]));
        assert_eq!((found[4].name.as_str(), found[4].unit.as_str()), ("stroke", "deg"));
        assert_eq!(found[4].interval, Some([-21.0, -19.0]));
    }
}

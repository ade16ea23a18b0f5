//! The Pareto front of the load cost against a second quadratic cost: what the one gives up for the other.
//!
//! ```text
//! J(u) = |W_Z^(1/2) (Z + T u)|^2,      S(u) = |s + M u|^2
//! min  J(u) + w S(u)   within the limits,      w from 0 to infinity
//! ```
//! Both are convex and so are the limits: every point of the front is the minimum for some weight `w`, and `-dJ/dS = w`
//! there. `S` enters as further loads `sqrt(w) (s + M u)`, the T matrix extended by as many rows.
//!
//! Source: S. Boyd, L. Vandenberghe, *Convex Optimization* (2004), section 4.7.4 (scalarisation).

use crate::{ControlError, ControlLimits, Cost, FeedbackLaw, LoadWeights, TMatrix, error};

/// The second cost, `S(u) = |s + M u|^2`.
#[derive(Debug, Clone, PartialEq)]
pub struct SecondCost {
    /// `s`: its outputs without control.
    pub at_rest: Vec<f64>,
    /// `M`: change of its outputs with each control, per V.
    pub t: TMatrix,
}

/// One point of a front.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontPoint {
    /// The control vector, V; it keeps every limit.
    pub control_volt: Vec<f64>,
    /// `J`, nondimensional load squared.
    pub loads_cost: f64,
    /// `S`, square of the unit of its outputs.
    pub second_cost: f64,
    /// `w`: fall of `J` that one unit of `S` more would buy; infinite where `S` is least.
    pub weight: f64,
    /// Largest KKT residual of the cone program behind it.
    pub kkt: f64,
}

/// Decades of the weight about the one that balances the ends, to either side, and weights in each.
const DECADES: i32 = 3;
const WEIGHTS_PER_DECADE: i32 = 4;
/// Singular value of the weighted T over the largest, below which a control is not answered.
const NO_ANSWER: f64 = 1e-9;
/// Weight, over the balancing one, that chooses among controls alike in the cost that an end is the least of.
const AMONG_EQUALS: f64 = 1e-6;
/// A point nearer to the one before it than this, as a part of the front's extent in both costs, is left out.
const LEAST_GAP: f64 = 0.01;

impl SecondCost {
    /// `S` at a control vector, V.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`].
    pub fn at(&self, control_volt: &[f64]) -> Result<f64, ControlError> {
        let change = self.t.loads_for(control_volt)?;
        error::check_vector("second cost without control", &self.at_rest, change.len())?;
        Ok(self.at_rest.iter().zip(change).map(|(s, ds)| (s + ds) * (s + ds)).sum())
    }
}

impl FeedbackLaw {
    /// The front of `J` against a second cost, from the least `S` to the least `J`, about zero control.
    ///
    /// | argument | symbol | unit |
    /// |---|---|---|
    /// | `at_rest` | `Z` | nondimensional, without control |
    /// | `second` | `s`, `M` | any |
    ///
    /// One point where both costs are least at the same control. Among controls alike in the cost of an end the other cost
    /// chooses.
    ///
    /// # Errors
    /// [`ControlError::ConeProgram`]; lengths that do not fit; [`ControlError::NoAuthority`] where no control moves `S`.
    pub fn front(
        &self,
        at_rest: &[f64],
        second: &SecondCost,
        limits: &ControlLimits,
    ) -> Result<Vec<FrontPoint>, ControlError> {
        let traded = Traded { law: self, at_rest, second, limits };
        let whole = FeedbackLaw::new(&second.t, &LoadWeights::Identity)?;
        let zero = vec![0.0; self.t().controls()];
        let least_effort = |law: &FeedbackLaw| {
            let largest = law.singular_values().first().map_or(0.0, |s| s * s);
            if has_choice(law) { AMONG_EQUALS * largest } else { 0.0 }
        };
        let found = self.optimum_within(least_effort(self), &zero, at_rest, limits)?;
        let mut best = traded.point(found.control_volt, 0.0, found.kkt.largest())?;
        let found = whole.optimum_within(least_effort(&whole), &zero, &second.at_rest, limits)?;
        let mut least = traded.point(found.control_volt, f64::INFINITY, found.kkt.largest())?;
        let balance = (least.loads_cost - best.loads_cost) / (best.second_cost - least.second_cost);
        if !(balance.is_finite() && balance > 0.0) {
            return Ok(vec![best]);
        }
        if has_choice(self) {
            best = FrontPoint { weight: 0.0, ..traded.at(AMONG_EQUALS * balance)? };
        }
        if has_choice(&whole) {
            let found = traded.at(balance / AMONG_EQUALS)?;
            least = FrontPoint { weight: f64::INFINITY, ..found };
        }
        let extent = [least.loads_cost - best.loads_cost, best.second_cost - least.second_cost];
        let is_apart = |a: &FrontPoint, b: &FrontPoint| {
            (a.loads_cost - b.loads_cost).abs() > LEAST_GAP * extent[0]
                || (a.second_cost - b.second_cost).abs() > LEAST_GAP * extent[1]
        };
        let mut front = vec![least];
        for k in (-DECADES * WEIGHTS_PER_DECADE..=DECADES * WEIGHTS_PER_DECADE).rev() {
            let weight = balance * 10.0_f64.powf(f64::from(k) / f64::from(WEIGHTS_PER_DECADE));
            let point = traded.at(weight)?;
            if front.last().is_none_or(|last| is_apart(last, &point)) && is_apart(&best, &point) {
                front.push(point);
            }
        }
        front.push(best);
        Ok(front)
    }
}

/// Whether other controls have the same weighted loads: more of them than the weighted T has singular values that count. A
/// weight of zero takes a row away.
fn has_choice(law: &FeedbackLaw) -> bool {
    let values = law.singular_values();
    let largest = values.first().copied().unwrap_or(0.0);
    let rank = values.iter().filter(|value| **value > NO_ANSWER * largest).count();
    rank < law.t().controls()
}

/// Two costs within limits.
struct Traded<'a> {
    law: &'a FeedbackLaw,
    at_rest: &'a [f64],
    second: &'a SecondCost,
    limits: &'a ControlLimits,
}

impl Traded<'_> {
    fn point(
        &self,
        control_volt: Vec<f64>,
        weight: f64,
        kkt: f64,
    ) -> Result<FrontPoint, ControlError> {
        let change = self.law.t().loads_for(&control_volt)?;
        let loads: Vec<f64> = self.at_rest.iter().zip(change).map(|(z, dz)| z + dz).collect();
        let loads_cost = Cost::of(&loads, self.law.load_weights(), &[], 0.0).loads;
        let second_cost = self.second.at(&control_volt)?;
        Ok(FrontPoint { control_volt, loads_cost, second_cost, weight, kkt })
    }

    /// The minimum of `J + weight S`, by the law of the T matrix extended by the rows of `S`.
    fn at(&self, weight: f64) -> Result<FrontPoint, ControlError> {
        let share = weight.sqrt();
        let extended = |own: Vec<f64>, further: &[f64]| -> Vec<f64> {
            own.into_iter().chain(further.iter().map(|s| share * s)).collect()
        };
        let columns = self.law.t().columns().into_iter().zip(self.second.t.columns());
        let columns: Vec<Vec<f64>> = columns.map(|(z, s)| extended(z, &s)).collect();
        let t = TMatrix::from_columns(&columns)?;
        let loads = extended(self.at_rest.to_vec(), &self.second.at_rest);
        let ones = std::iter::repeat_n(1.0, self.second.at_rest.len());
        let weights = self.law.load_weights().iter().copied().chain(ones).collect();
        let law = FeedbackLaw::new(&t, &LoadWeights::Diagonal(weights))?;
        let zero = vec![0.0; t.controls()];
        let found = law.optimum_within(0.0, &zero, &loads, self.limits)?;
        self.point(found.control_volt, weight, found.kkt.largest())
    }
}

//! A cause of a kind of simulation: what it may lack, and where that enters.

use super::table::Shown;
use std::fmt;
use std::sync::Arc;

/// What a cause does to a model, with values of its parameters.
type Apply<M> = Arc<dyn Fn(&mut M, &[f64]) + Send + Sync>;

/// A cause, ready for one model `M`.
pub struct PointCause<M> {
    /// Name in every report.
    pub id: &'static str,
    /// The physics in a sentence.
    pub physics: &'static str,
    /// Its parameters.
    pub parameters: Vec<CauseParameter>,
    /// Where it enters: the extended model is what this makes.
    pub apply: Apply<M>,
    /// Causes that look alike.
    pub confused_with: &'static [&'static str],
    /// What tells it from those.
    pub separating: &'static [&'static str],
    /// Part of its effect by which the model of it is wrong.
    pub form_error: f64,
    /// Why the data cannot show it; none if they may.
    pub blocked: Option<String>,
}

impl<M> Clone for PointCause<M> {
    fn clone(&self) -> Self {
        let (parameters, apply) = (self.parameters.clone(), Arc::clone(&self.apply));
        Self { parameters, apply, blocked: self.blocked.clone(), ..*self }
    }
}

impl<M> fmt::Debug for PointCause<M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PointCause").field("id", &self.id).finish_non_exhaustive()
    }
}

/// A parameter of a cause.
#[derive(Debug, Clone, PartialEq)]
pub struct CauseParameter {
    /// Name in every report.
    pub name: &'static str,
    /// Unit; `1` for a pure number.
    pub unit: &'static str,
    /// Its value in the model as it is.
    pub none: f64,
    /// Values it may have.
    pub range: (f64, f64),
    /// Values that its effect is computed at, the first an amount that matters; none of what only says which cause it is.
    pub amounts: Vec<f64>,
    /// What is reported of it.
    pub shown: Shown,
}

impl CauseParameter {
    /// A factor, 1 as it is, whose effect is computed at some amounts.
    pub fn ratio(amounts: &[f64], range: (f64, f64)) -> Self {
        let (name, unit, none) = ("ratio", "1", 1.0);
        Self { name, unit, none, range, amounts: amounts.to_vec(), shown: Shown::Itself }
    }

    /// A value, 0 as it is, from minus to plus a limit.
    pub fn both_ways(name: &'static str, unit: &'static str, amounts: &[f64], most: f64) -> Self {
        let (amounts, range) = (amounts.to_vec(), (-most, most));
        Self { name, unit, none: 0.0, range, amounts, shown: Shown::Itself }
    }

    /// What only says which cause it is.
    pub fn label(name: &'static str, value: f64) -> Self {
        let (unit, range, amounts) = ("1", (value, value), Vec::new());
        Self { name, unit, none: value, range, amounts, shown: Shown::Itself }
    }

    /// The same by another name.
    #[must_use]
    pub fn named(mut self, name: &'static str) -> Self {
        self.name = name;
        self
    }
}

impl<M: Clone> PointCause<M> {
    /// A cause that looks like no other, of the usual error of form.
    pub fn new(
        id: &'static str,
        physics: &'static str,
        parameters: Vec<CauseParameter>,
        apply: impl Fn(&mut M, &[f64]) + Send + Sync + 'static,
    ) -> Self {
        let (confused_with, separating): (&[&str], &[&str]) = (&[], &[]);
        let (apply, form_error, blocked): (Apply<M>, _, _) = (Arc::new(apply), 0.05, None);
        Self { id, physics, parameters, apply, confused_with, separating, form_error, blocked }
    }

    /// The same with causes that look alike and what tells it from them.
    #[must_use]
    pub fn beside(mut self, alike: &'static [&'static str], told: &'static [&'static str]) -> Self {
        (self.confused_with, self.separating) = (alike, told);
        self
    }

    /// The same, whose model is exact to a part.
    #[must_use]
    pub fn exact_to(mut self, form_error: f64) -> Self {
        self.form_error = form_error;
        self
    }

    /// The same, blocked where something is so.
    #[must_use]
    pub fn blocked_if(mut self, is_so: bool, why: &str) -> Self {
        if is_so {
            self.blocked = Some(why.to_owned());
        }
        self
    }

    /// The model with it.
    #[must_use]
    pub fn applied(&self, model: &M, values: &[f64]) -> M {
        let mut own = model.clone();
        (self.apply)(&mut own, values);
        own
    }

    /// Values of its parameters as they are in the model.
    pub fn none(&self) -> Vec<f64> {
        self.parameters.iter().map(|own| own.none).collect()
    }
}

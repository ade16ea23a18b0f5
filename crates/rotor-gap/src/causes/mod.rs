//! The cause library: what a rotor may lack.
//!
//! A cause is where it enters the model: [`RotorCause::apply`]. The extended model is what that made. A group is one file, a
//! cause one function of it and one line of [`library`].

mod aerodynamics;
mod blades;
mod condition;
mod drive;
mod reading;

use crate::model::RotorModel;
use model_gap::points::Shown;
use std::fmt;
use std::sync::Arc;

/// What a cause does to a model, with values of its parameters.
type Apply = Arc<dyn Fn(&mut RotorModel, &[f64]) + Send + Sync>;

/// A cause, ready for one model.
#[derive(Clone)]
pub struct RotorCause {
    /// Name in every report.
    pub id: &'static str,
    /// The physics in a sentence.
    pub physics: &'static str,
    /// Its parameters.
    pub parameters: Vec<RotorParameter>,
    /// Where it enters.
    pub apply: Apply,
    /// Causes that look alike.
    pub confused_with: &'static [&'static str],
    /// What tells it from those.
    pub separating: &'static [&'static str],
    /// Part of its effect by which the model of it is wrong.
    pub form_error: f64,
    /// Why the data cannot show it; none if they may.
    pub blocked: Option<String>,
}

impl fmt::Debug for RotorCause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("RotorCause").field("id", &self.id).finish_non_exhaustive()
    }
}

/// A parameter of a cause.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorParameter {
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

impl RotorParameter {
    /// A factor, 1 as it is, whose effect is computed at some amounts.
    pub(crate) fn ratio(amounts: &[f64], range: (f64, f64)) -> Self {
        let (name, unit, none) = ("ratio", "1", 1.0);
        Self { name, unit, none, range, amounts: amounts.to_vec(), shown: Shown::Itself }
    }

    /// A value, 0 as it is, from minus to plus a limit.
    pub(crate) fn both_ways(
        name: &'static str,
        unit: &'static str,
        amounts: &[f64],
        most: f64,
    ) -> Self {
        let (amounts, range) = (amounts.to_vec(), (-most, most));
        Self { name, unit, none: 0.0, range, amounts, shown: Shown::Itself }
    }

    /// What only says which cause it is.
    pub(crate) fn label(name: &'static str, value: f64) -> Self {
        let (unit, range, amounts) = ("1", (value, value), Vec::new());
        Self { name, unit, none: value, range, amounts, shown: Shown::Itself }
    }
}

impl RotorCause {
    /// A cause that looks like no other, of the usual error of form.
    pub(crate) fn new(
        id: &'static str,
        physics: &'static str,
        parameters: Vec<RotorParameter>,
        apply: impl Fn(&mut RotorModel, &[f64]) + Send + Sync + 'static,
    ) -> Self {
        let (confused_with, separating): (&[&str], &[&str]) = (&[], &[]);
        let (apply, form_error, blocked) = (Arc::new(apply), 0.05, None);
        Self { id, physics, parameters, apply, confused_with, separating, form_error, blocked }
    }

    /// The same with causes that look alike and what tells it from them.
    #[must_use]
    pub(crate) fn beside(
        mut self,
        alike: &'static [&'static str],
        told: &'static [&'static str],
    ) -> Self {
        (self.confused_with, self.separating) = (alike, told);
        self
    }

    /// The same, whose model is exact to a part.
    #[must_use]
    pub(crate) fn exact_to(mut self, form_error: f64) -> Self {
        self.form_error = form_error;
        self
    }

    /// The same, blocked where something is so.
    #[must_use]
    pub(crate) fn blocked_if(mut self, is_so: bool, why: &str) -> Self {
        if is_so {
            self.blocked = Some(why.to_owned());
        }
        self
    }

    /// The model with it.
    #[must_use]
    pub fn applied(&self, model: &RotorModel, values: &[f64]) -> RotorModel {
        let mut own = model.clone();
        (self.apply)(&mut own, values);
        own
    }

    /// Values of its parameters as they are in the model.
    pub fn none(&self) -> Vec<f64> {
        self.parameters.iter().map(|own| own.none).collect()
    }
}

/// What the library is made for.
#[derive(Debug)]
pub(crate) struct Occasion<'a> {
    pub(crate) model: &'a RotorModel,
    /// Names of the instruments of the channels.
    pub(crate) instruments: &'a [String],
    /// Whether an actuator with hysteresis is there that the simulation lacks.
    pub(crate) has_hysteretic: bool,
    /// Whether the drive of the case is an ideal one.
    pub(crate) is_ideal: bool,
    /// Whether flaps are driven at any point.
    pub(crate) is_driven: bool,
    /// Middle amplitude of the driven points, V.
    pub(crate) middle_volt: f64,
    /// Lag of that actuator by its part of the motion, deg, at the middle amplitude of the points.
    pub(crate) lag_deg: &'a [(f64, f64)],
}

/// Names of the causes of a rotor.
pub const LIBRARY: [&str; 25] = [
    "actuator-hysteresis",
    "actuator-gain",
    "flap-effectiveness",
    "stiffness-flap",
    "stiffness-lag",
    "stiffness-torsion",
    "pitch-link",
    "mass",
    "cg-offset",
    "aerodynamic-centre",
    "structural-damping",
    "blade-dissimilarity",
    "pitch-reference",
    "twist",
    "lift-slope",
    "drag",
    "inflow",
    "dynamic-stall",
    "compressibility",
    "hub-impedance",
    "sensor-gain",
    "azimuth-offset",
    "channel-delay",
    "rotor-speed",
    "air-density",
];

/// The causes for a model and its channels.
pub(crate) fn library(o: &Occasion<'_>) -> Vec<RotorCause> {
    let single = [
        drive::actuator_gain(o),
        aerodynamics::flap_effectiveness(o),
        blades::stiffness_flap(),
        blades::stiffness_lag(),
        blades::stiffness_torsion(),
        blades::pitch_link(o),
        blades::mass(),
        blades::cg_offset(o),
        aerodynamics::aerodynamic_centre(o),
        blades::structural_damping(o),
        reading::pitch_reference(),
        aerodynamics::twist(),
        aerodynamics::lift_slope(),
        aerodynamics::drag(o),
        aerodynamics::inflow(o),
        aerodynamics::dynamic_stall(o),
        aerodynamics::compressibility(o),
        reading::hub_impedance(),
        reading::azimuth_offset(),
        reading::channel_delay(),
        condition::rotor_speed(),
        condition::air_density(),
    ];
    let mut all = drive::actuator_hysteresis(o).to_vec();
    all.extend(single);
    all.extend(blades::blade_dissimilarity(o));
    all.extend(reading::sensor_gains(o));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_study::case::Case;

    #[test]
    fn every_cause_is_in_the_list_and_changes_the_model() {
        let model = RotorModel::of(Case::default());
        let instruments = ["fz_n4_N".to_owned()];
        let lag_deg = [(0.0, 0.0), (1.0, 30.0)];
        let occasion = Occasion {
            model: &model,
            instruments: &instruments,
            has_hysteretic: true,
            is_ideal: true,
            is_driven: true,
            middle_volt: 30.0,
            lag_deg: &lag_deg,
        };
        let all = library(&occasion);
        for id in LIBRARY {
            assert!(all.iter().any(|own| own.id == id), "{id}");
        }
        for own in &all {
            assert!(LIBRARY.contains(&own.id), "{}", own.id);
            let none = own.none();
            assert_eq!(own.applied(&model, &none), model, "{}", own.id);
            for (k, parameter) in own.parameters.iter().enumerate() {
                for &amount in &parameter.amounts {
                    let mut values = none.clone();
                    values[k] = amount;
                    assert!(
                        parameter.range.0 <= amount && amount <= parameter.range.1,
                        "{}",
                        own.id
                    );
                    assert_ne!(
                        own.applied(&model, &values),
                        model,
                        "{} {}",
                        own.id,
                        parameter.name
                    );
                }
            }
            for alike in own.confused_with {
                assert!(LIBRARY.contains(alike), "{}: {alike}", own.id);
            }
        }
    }
}

//! Creep: Kelvin-Voigt elements in series with the actuator.
//!
//! ```text
//! y = x + sum_i z_i,      tau_i z_i' = c x - z_i,      tau_i = tau_first r^(i/n),  i = 0, 1, ...
//! ```
//!
//! With `n` elements per decade (`r` = 10) and `c = g/n` a step is followed by a growth of `g` of
//! itself per decade of time, from about the first to about the last retardation time.
//!
//! Source: the logarithmic creep law of soft ceramics, about 1-2 % per decade (maker's catalogues,
//! from memory); its Kelvin-Voigt form is textbook linear viscoelasticity.

use crate::error::{TruthError, require};
use crate::stage::{Stage, first_order_hold};

/// Parameters of [`Creep`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CreepParameters {
    /// Growth per decade of time, `g`, as a share of the displacement, >= 0.
    pub growth_per_decade: f64,
    /// Shortest retardation time, s.
    pub first_time_s: f64,
    /// Elements per decade, `n`.
    pub elements_per_decade: u32,
    /// Number of elements.
    pub elements: u32,
}

impl CreepParameters {
    /// Retardation times, ascending, s.
    pub fn retardation_times_s(&self) -> Vec<f64> {
        let density = f64::from(self.elements_per_decade);
        (0..self.elements)
            .map(|i| self.first_time_s * 10.0_f64.powf(f64::from(i) / density))
            .collect()
    }

    /// Growth due to one element, `c`, as a share of the displacement.
    pub fn element_compliance(&self) -> f64 {
        self.growth_per_decade / f64::from(self.elements_per_decade)
    }
}

/// The creep stage: micrometres in, micrometres out.
#[derive(Debug, Clone)]
pub struct Creep {
    compliance: f64,
    times_s: Vec<f64>,
    input_um: f64,
    states_um: Vec<f64>,
}

impl Creep {
    /// A stage at rest at zero displacement.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for a negative growth, or a time or density that is not positive.
    pub fn new(parameters: CreepParameters) -> Result<Self, TruthError> {
        const STAGE: &str = "creep";
        let p = parameters;
        let growth = p.growth_per_decade;
        require(growth >= 0.0, STAGE, "growth_per_decade", growth, "not negative")?;
        require(p.first_time_s > 0.0, STAGE, "first_time_s", p.first_time_s, "positive")?;
        let density = f64::from(p.elements_per_decade);
        require(density > 0.0, STAGE, "elements_per_decade", density, "at least 1")?;
        let times_s = p.retardation_times_s();
        let states_um = vec![0.0; times_s.len()];
        Ok(Self { compliance: p.element_compliance(), times_s, input_um: 0.0, states_um })
    }
}

impl Stage for Creep {
    fn settle(&mut self, input: f64) -> f64 {
        self.input_um = input;
        self.states_um.fill(self.compliance * input);
        input + self.states_um.iter().sum::<f64>()
    }

    fn step(&mut self, input: f64, dt_s: f64) -> f64 {
        let (from, to) = (self.compliance * self.input_um, self.compliance * input);
        for (z, time_s) in self.states_um.iter_mut().zip(&self.times_s) {
            *z = first_order_hold(*z, from, to, dt_s, *time_s);
        }
        self.input_um = input;
        input + self.states_um.iter().sum::<f64>()
    }
}

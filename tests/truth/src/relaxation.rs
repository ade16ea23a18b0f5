//! Rate-dependent relaxation: domain walls need time, and not all of them the same.
//!
//! ```text
//! y     = sum_i w_i x_i,                       sum_i w_i = 1
//! x_i'  = (h - x_i) / tau_i,
//! tau_i = tau_i0 (1 + p x_i/S) / (1 + q |h - x_i|/S)
//! ```
//!
//! `h` is the rate-independent state, `S` a reference displacement. The spread of times makes the
//! response different from one clean lag; `p` lets the extended actuator (near saturation) relax
//! more slowly, `q` lets a large driving force speed it up, so that amplitude and offset matter.
//!
//! Source: I. D. Mayergoyz, Phys. Rev. Lett. 56 (1986) 1518 and IEEE Trans. Magn. 24 (1988) 2925,
//! for relaxation towards the static hysteresis value; the two factors are this project's choice.

use crate::error::{TruthError, require};
use crate::stage::{Stage, first_order_hold};

/// One relaxing share of the displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelaxationChannel {
    /// Share `w_i`; all shares together are normalised to 1.
    pub weight: f64,
    /// Relaxation time `tau_i0` at the bias and for small deviations, s.
    pub time_constant_s: f64,
}

/// Parameters of [`Relaxation`].
#[derive(Debug, Clone, PartialEq)]
pub struct RelaxationParameters {
    /// The channels.
    pub channels: Vec<RelaxationChannel>,
    /// Reference displacement `S`, um.
    pub reference_um: f64,
    /// Relative growth `p` of the relaxation time per reference displacement of extension, -0.5..0.5.
    pub position_sensitivity: f64,
    /// Relative growth `q` of the relaxation rate per reference displacement of deviation, >= 0.
    pub deviation_sensitivity: f64,
}

/// The relaxation stage: micrometres in, micrometres out.
#[derive(Debug, Clone)]
pub struct Relaxation {
    parameters: RelaxationParameters,
    total_weight: f64,
    input_um: f64,
    states_um: Vec<f64>,
}

impl Relaxation {
    /// A stage at rest at zero displacement.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for a weight, time or reference that is not positive, or a
    /// sensitivity outside its range.
    pub fn new(parameters: RelaxationParameters) -> Result<Self, TruthError> {
        const STAGE: &str = "relaxation";
        let p = &parameters;
        require(p.reference_um > 0.0, STAGE, "reference_um", p.reference_um, "positive")?;
        let position = p.position_sensitivity;
        require(position.abs() <= 0.5, STAGE, "position_sensitivity", position, "in -0.5..0.5")?;
        let deviation = p.deviation_sensitivity;
        require(deviation >= 0.0, STAGE, "deviation_sensitivity", deviation, "not negative")?;
        for channel in &p.channels {
            require(channel.weight > 0.0, STAGE, "weight", channel.weight, "positive")?;
            let time = channel.time_constant_s;
            require(time > 0.0, STAGE, "time_constant_s", time, "positive")?;
        }
        let total_weight: f64 = p.channels.iter().map(|channel| channel.weight).sum();
        require(total_weight > 0.0, STAGE, "channels (sum of weights)", total_weight, "positive")?;
        let states_um = vec![0.0; p.channels.len()];
        Ok(Self { parameters, total_weight, input_um: 0.0, states_um })
    }

    /// One clean lag, the same in every state.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] if the time constant is not positive.
    pub fn single(time_constant_s: f64) -> Result<Self, TruthError> {
        Self::new(RelaxationParameters {
            channels: vec![RelaxationChannel { weight: 1.0, time_constant_s }],
            reference_um: 1.0,
            position_sensitivity: 0.0,
            deviation_sensitivity: 0.0,
        })
    }

    fn output_um(&self) -> f64 {
        let channels = self.parameters.channels.iter().zip(&self.states_um);
        channels.map(|(channel, x)| channel.weight * x).sum::<f64>() / self.total_weight
    }
}

impl RelaxationParameters {
    /// Relaxation time of a channel in a state, s.
    ///
    /// | argument | symbol | unit | range |
    /// |---|---|---|---|
    /// | `time_constant_s` | `tau_i0` | s | > 0 |
    /// | `state_um` | `x_i` | um | counted up to 1.5 reference displacements |
    /// | `input_um` | `h` | um | any |
    pub fn time_constant_s(&self, time_constant_s: f64, state_um: f64, input_um: f64) -> f64 {
        let extension = (state_um / self.reference_um).clamp(-1.5, 1.5);
        let deviation = (input_um - state_um).abs() / self.reference_um;
        time_constant_s * (1.0 + self.position_sensitivity * extension)
            / (1.0 + self.deviation_sensitivity * deviation)
    }
}

impl Stage for Relaxation {
    fn settle(&mut self, input: f64) -> f64 {
        self.input_um = input;
        self.states_um.fill(input);
        self.output_um()
    }

    fn step(&mut self, input: f64, dt_s: f64) -> f64 {
        let from = self.input_um;
        for (x, channel) in self.states_um.iter_mut().zip(&self.parameters.channels) {
            // Exact for a constant time; taken at the middle of the step it is of second order.
            let tau = |state: f64, h: f64| {
                self.parameters.time_constant_s(channel.time_constant_s, state, h)
            };
            let predicted = first_order_hold(*x, from, input, dt_s, tau(*x, from));
            let middle = tau(0.5 * (*x + predicted), 0.5 * (from + input));
            *x = first_order_hold(*x, from, input, dt_s, middle);
        }
        self.input_um = input;
        self.output_um()
    }
}

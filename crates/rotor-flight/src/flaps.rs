//! Flaps whose actuators are marched sample by sample.

use crate::FlightError;
use hhc_control::{ControlLayout, HarmonicAnalyser};
use preisach_dyn::{ActuatorMemory, ActuatorModel, StartState, Stepper};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::Bias;
use std::f64::consts::TAU;

/// Samples of a revolution, and harmonics of the motion that the rotor feels.
const SAMPLES: usize = 128;
pub(crate) const HARMONICS: u32 = 12;
/// Change of a bias that centres the flap for a mean flap angle, V/deg, once a revolution: a few revolutions to centre.
const BIAS_VOLT_PER_DEG: f64 = 2.0;

/// The actuators of all flaps, each with its own memory.
#[derive(Debug, Clone)]
pub struct FlapMarch<'a> {
    models: Vec<&'a ActuatorModel>,
    steppers: Vec<Stepper<'a>>,
    layout: ControlLayout,
    memories: Vec<ActuatorMemory>,
    bias_volt: Vec<f64>,
    /// Change of the bias for a mean flap angle, V/deg, once a revolution.
    bias_gain: f64,
    analysers: Vec<HarmonicAnalyser>,
    /// Cosine and sine of every controlled harmonic at every sample.
    waves: Vec<f64>,
}

/// What one flap did in a revolution.
#[derive(Debug, Clone, PartialEq)]
pub struct FlapTurn {
    /// Its motion, deg: mean and harmonics up to 12 per rev.
    pub flap_deg: HarmonicSeries,
    /// Lowest and highest voltage.
    pub volt: [f64; 2],
    /// Part of the samples whose voltage was held at an end of the range, 0 to 1.
    pub held_share: f64,
}

impl<'a> FlapMarch<'a> {
    /// Flaps at rest about a bias, all with one actuator; `rev_hz` is the revolutions per second of the actuators' time. A bias
    /// that is centred is led by the mean flap angle, one that is held stays.
    ///
    /// # Errors
    /// [`FlightError::Actuator`], [`FlightError::Control`].
    pub fn new(
        model: &'a ActuatorModel,
        layout: &ControlLayout,
        rev_hz: f64,
        bias: Bias,
    ) -> Result<Self, FlightError> {
        Self::of_each(vec![model; layout.flaps()], layout, rev_hz, bias)
    }

    /// The same with an actuator for each flap of the layout.
    ///
    /// # Errors
    /// As [`Self::new`]; [`FlightError::OutOfRange`] for another number of them.
    pub fn of_each(
        models: Vec<&'a ActuatorModel>,
        layout: &ControlLayout,
        rev_hz: f64,
        bias: Bias,
    ) -> Result<Self, FlightError> {
        if models.len() != layout.flaps() {
            let (what, value) = ("number of actuators", models.len() as f64);
            return Err(FlightError::OutOfRange { what, value, expected: "one for each flap" });
        }
        let bias_volt = bias.volt();
        let (mut steppers, mut memories) = (Vec::new(), Vec::new());
        for (flap, model) in models.iter().enumerate() {
            let located = |source| FlightError::Actuator { flap, source };
            steppers.push(model.stepper(1.0 / (rev_hz * SAMPLES as f64)).map_err(located)?);
            memories.push(model.start(bias_volt, StartState::Rest).map_err(located)?);
        }
        let harmonics: Vec<u32> = (0..=HARMONICS).collect();
        let analyser = HarmonicAnalyser::new(1, SAMPLES, 1, &harmonics)?;
        let waves = (0..SAMPLES)
            .flat_map(|k| {
                let psi = TAU * k as f64 / SAMPLES as f64;
                layout.harmonics().iter().map(move |&n| (f64::from(n) * psi).sin_cos())
            })
            .flat_map(|(sin, cos)| [cos, sin])
            .collect();
        Ok(Self {
            models,
            steppers,
            layout: layout.clone(),
            memories,
            bias_volt: vec![bias_volt; layout.flaps()],
            bias_gain: if bias.is_fixed() { 0.0 } else { BIAS_VOLT_PER_DEG },
            analysers: vec![analyser; layout.flaps()],
            waves,
        })
    }

    /// Marches one revolution of every flap under a control vector, V. A voltage beyond the range of the actuator is held at
    /// its end, as an amplifier does.
    ///
    /// # Errors
    /// [`FlightError::Actuator`]; [`FlightError::Control`] for a control vector of another layout.
    pub fn revolve(&mut self, control_volt: &[f64]) -> Result<Vec<FlapTurn>, FlightError> {
        self.layout.check(control_volt)?;
        let width = 2 * self.layout.harmonics().len();
        let mut turns = Vec::with_capacity(self.memories.len());
        for (flap, own) in control_volt.chunks_exact(width).enumerate() {
            let mut motion = HarmonicSeries::zero(0);
            let range = self.models[flap].range_volt;
            let (mut extremes, mut held) = ([f64::INFINITY, f64::NEG_INFINITY], 0_usize);
            for waves in self.waves.chunks_exact(width) {
                let swing: f64 = waves.iter().zip(own).map(|(wave, volt)| wave * volt).sum();
                let wanted = self.bias_volt[flap] + swing;
                let volt = wanted.clamp(range.lowest_volt(), range.highest_volt());
                held += usize::from(volt.to_bits() != wanted.to_bits());
                extremes = [extremes[0].min(volt), extremes[1].max(volt)];
                let flap_deg = self.steppers[flap]
                    .step(&mut self.memories[flap], volt, 0.0)
                    .map_err(|source| FlightError::Actuator { flap, source })?;
                if let Some(found) = self.analysers[flap].push(&[flap_deg])? {
                    motion.mean = found[0];
                    let pairs = found[2..].chunks_exact(2);
                    motion.harmonics =
                        pairs.map(|pair| Harmonic { cosine: pair[0], sine: pair[1] }).collect();
                }
            }
            self.bias_volt[flap] = (self.bias_volt[flap] - self.bias_gain * motion.mean)
                .clamp(range.lowest_volt(), range.highest_volt());
            let held_share = held as f64 / SAMPLES as f64;
            turns.push(FlapTurn { flap_deg: motion, volt: extremes, held_share });
        }
        Ok(turns)
    }
}

//! The chain of an actuator with what causes switch on in it.

use super::reading::Reading;
use preisach_dyn::{
    ActuatorModel, AmplifierStage, LinkageStage, MainsHum, Relaxation, RelaxationElement,
    SensorStage,
};

/// What causes add to the base model.
///
/// ```text
/// command -> amplifier -> law, gain, rate -> ordinary relaxation | linkage -> sensor
/// ```
/// The bar parts front and rear. Amplifier, linkage and sensor are the stages of an actuator file; what
/// stands beside them is more than a file can say, or has no name.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Chain {
    pub(crate) front: FrontStages,
    pub(crate) rear: RearStages,
    /// Gain and zero of the voltage monitor, where they are others.
    pub(crate) monitor: Option<Command>,
}

/// What acts before or in the law.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct FrontStages {
    /// The gain between command and terminals, where it is another.
    pub(crate) command: Option<Command>,
    /// Time by which the terminals follow the command late, where they do, s.
    pub(crate) late_s: Option<f64>,
    /// Stages before the law. Heat and loss of polarisation act on the gain of its output.
    pub(crate) amplifier: Vec<AmplifierStage>,
    /// The point that the gain of heat acts about, from 0 V (0) to the middle of the range (1).
    pub(crate) heat_about: f64,
    /// The same of a loss of polarisation.
    pub(crate) loss_about: f64,
    /// Loops, where the base model has none.
    pub(crate) loops: Option<Loops>,
    /// Relaxation of the law.
    pub(crate) rate: Option<Rate>,
}

/// What acts behind the base model.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct RearStages {
    /// Stages of the linkage.
    pub(crate) linkage: Vec<LinkageStage>,
    /// Stages of the bench sensor. The phase of mains hum is that of each record.
    pub(crate) sensor: Vec<SensorStage>,
    /// What the sensor can read.
    pub(crate) readings: Vec<Reading>,
}

/// A voltage that is passed on with another gain and zero.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Command {
    /// The gain.
    pub(crate) gain: f64,
    /// What is passed on of no voltage, V.
    pub(crate) zero_volt: f64,
}

/// Loops of a law without any.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Loops {
    /// Share of the output that follows through plays.
    pub(crate) share: f64,
    /// Half-width of the widest, output's unit.
    pub(crate) widest: f64,
}

/// Relaxation of the law whose time depends on its state.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Rate {
    /// Mean relaxation time, s.
    pub(crate) tau_s: f64,
    /// Its relative growth per spread of the output.
    pub(crate) position: f64,
}

impl RearStages {
    /// Takes mains hum out of the stages of the sensor.
    pub(crate) fn take_hum(&mut self) -> Option<MainsHum> {
        let is_hum = |stage: &SensorStage| matches!(stage, SensorStage::MainsHum(_));
        let place = self.sensor.iter().position(is_hum)?;
        match self.sensor.remove(place) {
            SensorStage::MainsHum(hum) => Some(hum),
            _ => None,
        }
    }
}

impl Command {
    /// What is passed on of a voltage, V.
    pub(crate) fn of(&self, volt: f64) -> f64 {
        self.gain * volt + self.zero_volt
    }
}

impl Chain {
    /// Adds the stages to the model of an actuator file. The mean time of the law's relaxation is all that a
    /// file can say of it; loops are the law's own there, and what has no name is not extended by.
    pub(crate) fn extend(self, model: &mut ActuatorModel) {
        model.amplifier.extend(self.front.amplifier);
        model.linkage.extend(self.rear.linkage);
        model.sensor.extend(self.rear.sensor);
        if let Some(Rate { tau_s, .. }) = self.front.rate {
            let elements = vec![RelaxationElement { share: 1.0, time_constant_s: tau_s }];
            model.linkage.insert(0, LinkageStage::Relaxation(Relaxation { elements }));
        }
    }
}

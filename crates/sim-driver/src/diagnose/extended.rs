//! The extended model as an ordinary actuator file.

use super::Diagnosis;
use super::causes::Part;
use crate::SimError;
use crate::problem::Place;
use crate::stored_actuator::{GainRule, StoredActuator, StoredKind};
use model_gap::discovery::Verdict;
use preisach_dyn::identify::{Settings, StaticAccumulator};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Calibration, LinkageStage, MainsHum, Relaxation,
    RelaxationElement, SensorStage, VoltageRange,
};

/// Flap angle per output of a bench that does not say it, deg/um.
const USUAL_DEG_PER_UM: f64 = 0.04;
/// Levels of the law of the file.
const LEVELS: usize = 24;

impl Diagnosis {
    /// The base model with the causes found as stages around it: what `hhc run` takes as an actuator.
    ///
    /// The law is the base model's static part, fitted anew as a Preisach density that is nowhere
    /// negative. A relaxation of the law stands behind it as one relaxation time; heat and depolarisation
    /// act about the output at 0 V, as their stages do.
    ///
    /// # Errors
    /// [`SimError::Actuator`] at the place of the data set.
    pub fn extended(&self) -> Result<StoredActuator, SimError> {
        let fail = |source| SimError::Actuator {
            place: Place::file(format!("{}/dataset.ron", self.folder)),
            source,
        };
        let (low, high) = self.range;
        let range_volt = VoltageRange::new(low, high).map_err(fail)?;
        let deg_per_um =
            self.deg_per_um.unwrap_or(if self.is_bench { USUAL_DEG_PER_UM } else { 1.0 });
        let zero_um = if self.is_bench {
            self.base.hysteresis(&[range_volt.middle_volt()]).first().copied().unwrap_or_default()
        } else {
            0.0
        };
        let settings = Settings { range_volt, deg_per_um, levels: LEVELS, ..Settings::default() };
        let mut law = StaticAccumulator::new(&settings, self.stride()).map_err(fail)?;
        for inputs in &self.law_inputs {
            let outputs: Vec<f64> =
                self.base.hysteresis(inputs).iter().map(|h| deg_per_um * (h - zero_um)).collect();
            law.begin_record();
            law.push(inputs, &outputs).map_err(fail)?;
        }
        let law = ActuatorLaw::StaticPreisach(law.fit().map_err(fail)?);
        let mut model = ActuatorModel::new(law, range_volt, Calibration { deg_per_um, zero_um });
        model.linkage.push(LinkageStage::Relaxation(Relaxation { elements: self.relaxation() }));
        if !matches!(self.finding.verdict, Verdict::Unknown) {
            for effect in &self.finding.effects {
                add(&mut model, self.library[effect.candidate].part(&effect.values));
            }
        }
        model.check_stages().map_err(fail)?;
        Ok(StoredActuator {
            kind: StoredKind::Actuator,
            title: format!("Extended after a diagnosis of: {}", self.title),
            dataset: self.folder.clone(),
            data_hash: self.content_hash.clone(),
            program_version: crate::VERSION.to_owned(),
            channels: self.channels.clone(),
            gain: self.is_bench.then_some(match self.deg_per_um {
                Some(_) => GainRule::DataSet,
                None => GainRule::Assumed,
            }),
            settings,
            runs: Vec::new(),
            model,
        })
    }

    fn stride(&self) -> usize {
        let samples: usize = self.law_inputs.iter().map(Vec::len).sum();
        samples.div_ceil(20_000).max(1)
    }

    /// Ordinary creep and relaxation; shares of more than all are scaled down to it.
    fn relaxation(&self) -> Vec<RelaxationElement> {
        let shares: f64 = self.base.relaxation.iter().map(|r| r.1).sum();
        let scale = if shares > 1.0 { 1.0 / shares } else { 1.0 };
        self.base
            .relaxation
            .iter()
            .filter(|r| r.1 > 0.0)
            .map(|&(time_constant_s, share)| RelaxationElement {
                share: scale * share,
                time_constant_s,
            })
            .collect()
    }
}

fn add(model: &mut ActuatorModel, part: Part) {
    match part {
        Part::Amplifier(stage) => model.amplifier.push(stage),
        Part::Linkage(stage) => model.linkage.push(stage),
        Part::Sensor(stages) => model.sensor.extend(stages),
        Part::Heating(stage, _) => model.amplifier.push(AmplifierStage::DielectricHeating(stage)),
        Part::Depolarisation(stage, _) => {
            model.amplifier.push(AmplifierStage::Depolarisation(stage));
        }
        Part::RateDependence { tau_s, .. } => {
            let elements = vec![RelaxationElement { share: 1.0, time_constant_s: tau_s }];
            model.linkage.insert(0, LinkageStage::Relaxation(Relaxation { elements }));
        }
        Part::Hum { amplitude, frequency_hz } => {
            let hum = MainsHum { amplitude_um: amplitude, frequency_hz, phase_rad: 0.0 };
            model.sensor.push(SensorStage::MainsHum(hum));
        }
    }
}

//! The extended model as an ordinary actuator file.

use crate::actuator_file::{GainRule, StoredActuator, StoredChannels, StoredKind};
use crate::base::BaseModel;
use crate::causes::chain_under;
use crate::diagnosis::Diagnosis;
use model_gap::discovery::Verdict;
use preisach_dyn::identify::{Settings, StaticAccumulator};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, Calibration, LinkageStage, PreisachError, Relaxation,
    RelaxationElement, VoltageRange,
};

/// Flap angle per output of a bench that does not say it, deg/um.
pub(crate) const USUAL_DEG_PER_UM: f64 = 0.04;
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
    /// Where the density cannot be fitted, or a stage is out of its range.
    pub fn extended(&self) -> Result<StoredActuator, PreisachError> {
        let data = &self.data;
        let usual = if data.is_bench { USUAL_DEG_PER_UM } else { 1.0 };
        let deg_per_um = data.deg_per_um.unwrap_or(usual);
        let (mut model, settings) =
            law_of_file(&self.base, &self.law_inputs, data.range, deg_per_um, data.is_bench)?;
        model.linkage.push(LinkageStage::Relaxation(Relaxation { elements: self.relaxation() }));
        if !matches!(self.finding.verdict, Verdict::Unknown) {
            chain_under(&self.library, &self.finding.effects).extend(&mut model);
        }
        model.check_stages()?;
        Ok(StoredActuator {
            kind: StoredKind::Actuator,
            title: format!("Extended after a diagnosis of: {}", data.title),
            dataset: data.folder.clone(),
            data_hash: data.content_hash.clone(),
            program_version: env!("CARGO_PKG_VERSION").to_owned(),
            channels: (!data.is_bench).then(|| StoredChannels {
                input: data.input_label.clone(),
                output: data.output_label.clone(),
            }),
            gain: data.is_bench.then_some(match data.deg_per_um {
                Some(_) => GainRule::DataSet,
                None => GainRule::Assumed,
            }),
            settings,
            runs: Vec::new(),
            model,
        })
    }

    /// Ordinary creep and relaxation; shares of more than all are scaled down to it.
    fn relaxation(&self) -> Vec<RelaxationElement> {
        let all = &self.base.relaxation;
        let shares: f64 = all.iter().map(|r| r.1).sum();
        let scale = if shares > 1.0 { 1.0 / shares } else { 1.0 };
        let element = |&(time_constant_s, share): &(f64, f64)| RelaxationElement {
            share: scale * share,
            time_constant_s,
        };
        all.iter().filter(|r| r.1 > 0.0).map(element).collect()
    }
}

/// The static part of a base model, fitted anew as a Preisach density on the inputs it was fitted to.
pub(crate) fn law_of_file(
    base: &BaseModel,
    inputs: &[Vec<f64>],
    range: (f64, f64),
    deg_per_um: f64,
    is_bench: bool,
) -> Result<(ActuatorModel, Settings), PreisachError> {
    let range_volt = VoltageRange::new(range.0, range.1)?;
    let at_middle = || base.hysteresis(&[range_volt.middle_volt()]).first().copied();
    let zero_um = if is_bench { at_middle().unwrap_or_default() } else { 0.0 };
    let settings = Settings { range_volt, deg_per_um, levels: LEVELS, ..Settings::default() };
    let samples: usize = inputs.iter().map(Vec::len).sum();
    let mut law = StaticAccumulator::new(&settings, samples.div_ceil(20_000).max(1))?;
    for run in inputs {
        let outputs: Vec<f64> =
            base.hysteresis(run).iter().map(|h| deg_per_um * (h - zero_um)).collect();
        law.begin_record();
        law.push(run, &outputs)?;
    }
    let law = ActuatorLaw::StaticPreisach(law.fit()?);
    let model = ActuatorModel::new(law, range_volt, Calibration { deg_per_um, zero_um });
    Ok((model, settings))
}

//! `findings.json`: the findings in the form other programs read.

use super::Diagnosis;
use model_gap::discovery::{Confidence, Verdict};
use serde::Serialize;
use std::collections::BTreeMap;

/// The file.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Findings {
    /// The verdict.
    pub verdict: Verdict,
    /// The causes, best first; of an ambiguous verdict all that may be it.
    pub causes: Vec<String>,
    /// How sure the verdict is.
    pub confidence: Confidence,
    /// Parameters of the causes in the extended model.
    pub parameters: BTreeMap<String, BTreeMap<String, ParameterValue>>,
    /// Error on held-out experiments.
    pub gain: GainValue,
    /// What to measure next.
    pub next_experiment: String,
    /// Causes these data could not show.
    pub not_observable: Vec<String>,
    /// The screening.
    pub screen: Vec<ScreenValue>,
}

/// A parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ParameterValue {
    /// Value.
    pub value: f64,
    /// Unit.
    pub unit: String,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// Error on experiments that the model has not seen.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GainValue {
    /// RMS of the base model.
    pub heldout_rms_before: f64,
    /// RMS of the extended model.
    pub heldout_rms_after: f64,
    /// 95 % interval of the difference of both on these experiments, were they measured again.
    pub ci95: [f64; 2],
    /// 95 % interval of the difference on other experiments of these kinds.
    pub ci95_other_experiments: [f64; 2],
    /// Unit.
    pub unit: String,
}

/// One row of the screening.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ScreenValue {
    /// The cause.
    pub cause: String,
    /// Drop of the misfit its effect could bring, noise units.
    pub score: f64,
    /// Share of the effect that the base model absorbs.
    pub absorbed: f64,
    /// The cause that looks most alike.
    pub most_confused_with: String,
    /// Cosine between both.
    pub cosine: f64,
}

impl From<&Diagnosis> for Findings {
    fn from(d: &Diagnosis) -> Self {
        let finding = &d.finding;
        let id = |c: usize| d.candidates[c].cause.id.to_owned();
        let mut causes: Vec<String> = finding.causes.iter().map(|f| id(f.candidate)).collect();
        for found in &finding.causes {
            for &other in &found.alternatives {
                if !causes.contains(&id(other)) {
                    causes.push(id(other));
                }
            }
        }
        let parameters = finding
            .causes
            .iter()
            .map(|found| {
                let values = found
                    .parameters
                    .iter()
                    .filter(|p| !p.is_shape)
                    .map(|p| {
                        let value =
                            ParameterValue { value: p.value, unit: p.unit.into(), ci95: p.ci95 };
                        (p.name.to_owned(), value)
                    })
                    .collect();
                (id(found.candidate), values)
            })
            .collect();
        if matches!(finding.verdict, Verdict::Unknown) {
            causes.clear();
        }
        let gain = finding.gain;
        let screen = finding
            .screen
            .iter()
            .enumerate()
            .map(|(c, s)| ScreenValue {
                cause: id(c),
                score: s.score,
                absorbed: s.absorbed,
                most_confused_with: s.most_confused.map(|m| id(m.0)).unwrap_or_default(),
                cosine: s.most_confused.map_or(0.0, |m| m.1),
            })
            .collect();
        Self {
            verdict: finding.verdict,
            causes,
            confidence: finding.confidence,
            parameters,
            gain: GainValue {
                heldout_rms_before: gain.rms_before,
                heldout_rms_after: gain.rms_after,
                ci95: gain.drop_ci95,
                ci95_other_experiments: gain.drop_elsewhere_ci95,
                unit: d.output_unit.clone(),
            },
            next_experiment: d.next.id.clone(),
            not_observable: d.not_observable(),
            screen,
        }
    }
}

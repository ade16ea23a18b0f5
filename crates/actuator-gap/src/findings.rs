//! The findings of a diagnosis in the form other programs read.

use crate::diagnosis::Diagnosis;
use model_gap::{Findings, GivenModelValue, Told};

impl Diagnosis {
    /// What is told of the finding.
    pub(crate) fn told(&self) -> Told<'_> {
        Told {
            finding: &self.finding,
            candidates: &self.candidates,
            runs: &self.run_ids,
            data_kind: if self.data.is_bench { "ActuatorBench" } else { "GenericLoop" },
            gain_unit: self.output_unit.clone(),
            next_experiment: self.next.id.clone(),
        }
    }
}

impl From<&Diagnosis> for Findings {
    fn from(d: &Diagnosis) -> Self {
        let given_model = d.given.map(|own| GivenModelValue {
            error_percent: own.error_percent,
            measured_error_percent: own.measured_error_percent,
            is_of_this_bench: !own.is_foreign(),
        });
        Self { given_model, ..d.told().findings() }
    }
}

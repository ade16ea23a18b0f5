//! One scored set.

use serde::{Deserialize, Serialize};
use truth::hidden::Answer;

use crate::classes::same_class;
use crate::findings::{Findings, Gain};

/// What a program said about one set, beside the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Case {
    /// The answer.
    pub answer: Answer,
    /// The findings.
    pub findings: Findings,
    /// Wall time of the diagnosis, s.
    pub seconds: f64,
    /// Wall time of the first diagnosis of this base at this noise, s: what is computed once for a base is in it.
    pub first_seconds: Option<f64>,
    /// Gain when the true causes are given.
    pub oracle: Option<Gain>,
    /// What the same truth gave after the proposed experiment.
    pub follow_up: Option<Findings>,
    /// Gains of further draws of the noise for the same truth.
    pub replicates: Vec<Gain>,
    /// The programs that made it: sets kept from several runs may be by several.
    #[serde(default)]
    pub made_by: String,
}

impl Case {
    /// Ids of the hidden causes of the library.
    pub fn causes(&self) -> Vec<&str> {
        let known = self.answer.effects.iter().map(|effect| effect.id.as_str());
        known.filter(|id| !id.starts_with("outside-")).collect()
    }

    /// Whether nothing is hidden.
    pub fn is_null(&self) -> bool {
        self.answer.effects.is_empty()
    }

    /// Whether the hidden effect is outside the library.
    pub fn is_outside(&self) -> bool {
        self.answer.hidden.starts_with("outside-")
    }

    /// The one hidden cause, if it is one of the library.
    pub fn single(&self) -> Option<&str> {
        match self.causes()[..] {
            [cause] => Some(cause),
            _ => None,
        }
    }

    /// Whether the hidden cause is play or friction, which a hysteresis absorbs.
    pub fn is_friction(&self) -> bool {
        self.single().is_some_and(|cause| matches!(cause, "backlash" | "coulomb-friction"))
    }

    /// Whether a name is the cause or in one class with it, by what this set measures.
    pub fn right(&self, cause: &str, name: &str) -> bool {
        same_class(cause, name, self.answer.design == "recommended", self.answer.monitored)
    }

    /// Whether a cause, or one of its class, is among the names given.
    pub fn in_names(&self, cause: &str) -> bool {
        self.findings.names().iter().any(|name| self.right(cause, name))
    }
}

//! `findings.json` as the scorer reads it, from the published layout and not from the product's code.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// The verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The model explains the data.
    NothingMissing,
    /// A cause, or several, and nothing besides.
    Named,
    /// A cause, or several, and something besides.
    NamedStructureRemains,
    /// One of several causes.
    Ambiguous,
    /// Something is missing that no known cause explains.
    Unknown,
    /// The data cannot show it.
    NotObservable,
}

impl Verdict {
    /// Whether causes are given.
    pub fn gives_names(self) -> bool {
        matches!(self, Self::Named | Self::NamedStructureRemains | Self::Ambiguous)
    }
}

/// How sure a verdict is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Confidence {
    /// Sure.
    Confident,
    /// Not sure.
    Tentative,
}

/// An estimate.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its unit.
    pub unit: String,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// What the extension is worth on held-out experiments.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Gain {
    /// Rms error before.
    pub heldout_rms_before: f64,
    /// Rms error after.
    pub heldout_rms_after: f64,
    /// 95 % interval of the difference.
    pub ci95: [f64; 2],
    /// Unit of all of them.
    pub unit: String,
}

impl Gain {
    /// Before minus after.
    pub fn reduction(&self) -> f64 {
        self.heldout_rms_before - self.heldout_rms_after
    }
}

/// What a diagnosis says; the screening is not scored.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Findings {
    /// The verdict.
    pub verdict: Verdict,
    /// Ids of causes, best first.
    pub causes: Vec<String>,
    /// How sure it is.
    pub confidence: Confidence,
    /// Parameters by cause and name.
    pub parameters: BTreeMap<String, BTreeMap<String, Estimate>>,
    /// What the extension is worth; some programs give none where nothing is named.
    pub gain: Option<Gain>,
    /// Id of the experiment that would tell more.
    pub next_experiment: String,
    /// Ids of causes these data could not show.
    pub not_observable: Vec<String>,
    /// The class of what is missing, where one is given.
    #[serde(default)]
    pub class: Option<String>,
    /// Names in that class.
    #[serde(default)]
    pub class_members: Vec<String>,
    /// How sure the class is.
    #[serde(default)]
    pub class_confidence: Option<Confidence>,
}

impl Findings {
    /// Reads `findings.json`.
    ///
    /// # Errors
    /// What is not as the layout says.
    pub fn parse(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text)
    }

    /// The names given, best first; none for a verdict that gives none.
    pub fn names(&self) -> &[String] {
        if self.verdict.gives_names() { &self.causes } else { &[] }
    }

    /// Whether names are given with confidence. An ambiguous verdict never is.
    pub fn is_confident(&self) -> bool {
        !self.names().is_empty()
            && self.verdict != Verdict::Ambiguous
            && self.confidence == Confidence::Confident
    }

    /// The class, where it is given with confidence.
    pub fn sure_class(&self) -> Option<&str> {
        let sure = self.class_confidence == Some(Confidence::Confident);
        self.class.as_deref().filter(|_| sure)
    }

    /// Whether it says with confidence that nothing is missing.
    pub fn denies(&self) -> bool {
        self.verdict == Verdict::NothingMissing && self.confidence == Confidence::Confident
    }
}

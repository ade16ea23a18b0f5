//! Metrics of points of test of a rotor, a blade or a section.
//!
//! One machine a set: sets are independent and the bounds of the shares are exact.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::findings::Findings;
use crate::metrics::{Bar, Metric, median, number, share};
use crate::report::answer_given;

/// Time of a diagnosis of a rotor, s.
const ROTOR_SECONDS: f64 = 120.0;
/// Time of a diagnosis of a blade or a section, s.
const PART_SECONDS: f64 = 5.0;
/// Kind of the sets that say nothing of it.
const ROTOR: &str = "rotor";
/// What is hidden in a set without effect.
const NULL: &str = "null";

/// What is hidden, as the generator writes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointAnswer {
    /// Name of the effect.
    pub effect: String,
    /// Its parameters, by the names of the causes.
    pub parameters: BTreeMap<String, Value>,
    /// Whether the list of the product has it.
    pub in_library: bool,
    /// Seed.
    pub seed: u64,
    /// Noise below the readings, dB.
    pub snr_db: f64,
}

fn rotor() -> String {
    ROTOR.to_owned()
}

/// What a program said about one set, beside the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PointCase {
    /// What was tested: `rotor`, `blade` or `section`.
    #[serde(default = "rotor")]
    pub kind: String,
    /// The answer.
    pub answer: PointAnswer,
    /// The findings.
    pub findings: Findings,
    /// Wall time of the diagnosis, s.
    pub seconds: f64,
    /// The programs that made it.
    pub made_by: String,
}

impl PointCase {
    fn is_null(&self) -> bool {
        self.answer.effect == NULL
    }

    /// Whether a name is given with confidence that is not what is hidden.
    pub fn is_wrong(&self) -> bool {
        let wrong = |name: &String| *name != self.answer.effect;
        self.findings.is_confident() && self.findings.names().iter().any(wrong)
    }

    /// Whether the truth is among the names.
    fn holds_truth(&self) -> bool {
        self.findings.names().contains(&self.answer.effect)
    }

    /// One line: what is hidden, and what was said.
    pub fn line(&self) -> String {
        let sure = if self.findings.denies() { "!" } else { "" };
        let said = answer_given(&self.findings);
        format!("{} -> {said}{sure} {:.1} s", self.answer.effect, self.seconds)
    }

    /// Relative error of each parameter of the truth, and whether its interval holds it; of a confident right name.
    fn parameters(&self) -> Vec<(f64, bool)> {
        if self.is_wrong() || !self.findings.is_confident() {
            return Vec::new();
        }
        let Some(found) = self.findings.parameters.get(&self.answer.effect) else {
            return Vec::new();
        };
        let of = |(name, truth): (&String, &Value)| {
            let (truth, own) = (truth.as_f64()?, found.get(name)?);
            let [low, high] = own.ci95;
            Some(((own.value / truth - 1.0).abs(), (low..=high).contains(&truth)))
        };
        self.answer.parameters.iter().filter_map(of).collect()
    }
}

/// All metrics of a suite.
pub fn metrics(cases: &[PointCase]) -> Vec<Metric> {
    let nulls = || cases.iter().filter(|case| case.is_null());
    let known = || cases.iter().filter(|case| case.answer.in_library && !case.is_null());
    let outside = || cases.iter().filter(|case| !case.answer.in_library);
    let sure = || known().filter(|case| case.findings.is_confident());
    let named = || known().filter(|case| !case.findings.names().is_empty());
    let mut errors: Vec<f64> = known().flat_map(PointCase::parameters).map(|own| own.0).collect();
    let mut seconds: Vec<f64> = cases.iter().map(|case| case.seconds).collect();
    let (values, sets) = (errors.len(), seconds.len());
    let middle = median(&mut seconds);
    let longest = seconds.last().copied().unwrap_or(f64::NAN);
    let is_of_rotors = cases.iter().all(|case| case.kind == ROTOR);
    let most = Bar::AtMost(if is_of_rotors { ROTOR_SECONDS } else { PART_SECONDS });
    vec![
        share("null: any name", Bar::AtMost(0.02), nulls().map(|c| !c.findings.names().is_empty())),
        share(
            "null: confident name",
            Bar::AtMost(0.01),
            nulls().map(|c| c.findings.is_confident()),
        ),
        share(
            "outside the list: confident name",
            Bar::AtMost(0.03),
            outside().map(|c| c.findings.is_confident()),
        ),
        share("confident: right", Bar::AtLeast(0.95), sure().map(|c| !c.is_wrong())),
        share(
            "named: truth among the names",
            Bar::AtLeast(0.97),
            named().map(PointCase::holds_truth),
        ),
        share("known: truth among the names", Bar::Shown, known().map(PointCase::holds_truth)),
        share(
            "known: confident right name",
            Bar::Shown,
            known().map(|c| c.findings.is_confident() && !c.is_wrong()),
        ),
        number(
            "parameters of confident right names, median error",
            Bar::AtMost(0.08),
            median(&mut errors),
            values,
        ),
        share(
            "  their 95 % intervals cover",
            Bar::Within(0.88, 0.98),
            known().flat_map(PointCase::parameters).map(|own| own.1),
        ),
        number("time of a diagnosis, median, s", most, middle, sets),
        number("time of a diagnosis, longest, s", most, longest, sets),
    ]
}

/// The sets with a confident wrong name, one a line; empty where there is none.
pub fn wrong_ones(cases: &[PointCase]) -> String {
    let mut text = String::new();
    for case in cases.iter().filter(|case| case.is_wrong()) {
        let PointAnswer { seed, snr_db, .. } = case.answer;
        let _ = writeln!(text, "wrong name: seed {seed} at {snr_db} dB: {}", case.line());
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::Outcome;
    use serde_json::json;

    fn case(effect: &str, said: &[&str], verdict: &str, confidence: &str) -> PointCase {
        let parameters = if said.is_empty() {
            json!({})
        } else {
            json!({ said[0]: { "ratio": { "value": 0.9, "unit": "1", "ci95": [0.88, 0.92] } } })
        };
        let findings = json!({
            "verdict": verdict, "causes": said, "confidence": confidence, "parameters": parameters,
            "gain": null, "next_experiment": "", "not_observable": [],
        });
        let in_library = effect != "wall-upwash";
        let answer = json!({
            "effect": effect, "parameters": { "ratio": 0.91 }, "in_library": in_library, "seed": 1, "snr_db": 40.0,
        });
        PointCase {
            kind: rotor(),
            answer: serde_json::from_value(answer).unwrap(),
            findings: serde_json::from_value(findings).unwrap(),
            seconds: 50.0,
            made_by: String::new(),
        }
    }

    fn missed(cases: &[PointCase]) -> Vec<String> {
        let all = metrics(cases).into_iter().filter(|own| own.outcome() == Outcome::Missed);
        all.map(|own| own.name).collect()
    }

    #[test]
    fn wrong_answers_miss_their_bars() {
        let right = [case("mass", &["mass"], "named", "confident")];
        // one interval that covers is all of them
        assert_eq!(missed(&right), ["  their 95 % intervals cover"]);
        assert_eq!(right[0].parameters(), [((0.9_f64 / 0.91 - 1.0).abs(), true)]);
        let wrong = [case("mass", &["twist"], "named", "confident")];
        assert!(missed(&wrong).contains(&"confident: right".to_owned()));
        assert!(wrong_ones(&wrong).contains("mass -> twist!"));
        let outside = case("wall-upwash", &["twist"], "named", "confident");
        assert!(missed(&[outside]).contains(&"outside the list: confident name".to_owned()));
        let null = case("null", &["twist"], "ambiguous", "tentative");
        assert_eq!(missed(&[null]), ["null: any name"]);
        let quiet = case("null", &[], "nothing-missing", "tentative");
        assert!(missed(std::slice::from_ref(&quiet)).is_empty());
        // a blade has seconds, not minutes
        let slow = PointCase { kind: "blade".to_owned(), ..quiet };
        assert_eq!(missed(&[slow]).len(), 2);
    }
}

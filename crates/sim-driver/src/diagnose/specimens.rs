//! Several specimens of one actuator: what they have in common, and what one has alone.

use super::story::{one_of, sure};
use super::{Diagnosis, Findings};
use crate::files::significant;
use crate::output::{Printable, Sheet, table};
use actuator_gap::ParameterValue;
use model_gap::discovery::{Confidence, Verdict};
use model_gap::in_common;
use serde::Serialize;
use std::collections::BTreeMap;

/// `specimens.json`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Specimens {
    /// The specimens in the order given.
    pub specimens: Vec<Specimen>,
    /// What is missing, that of most specimens first.
    pub missing: Vec<MissingInSome>,
}

/// What was found in one specimen; its findings are in the folder of its name.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Specimen {
    /// Name: the end of the path of its data.
    pub name: String,
    /// Its verdict.
    pub verdict: Verdict,
    /// How sure it is.
    pub confidence: Confidence,
    /// The causes it may be.
    pub causes: Vec<String>,
    /// What to measure next on it.
    pub next_experiment: String,
}

/// One thing missing, in one specimen or several.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MissingInSome {
    /// The causes that are open in all of these specimens, the best first.
    pub causes: Vec<String>,
    /// Confident where one cause is left, a specimen names it confidently, and none leaves structure beside it.
    pub confidence: Confidence,
    /// Parameters of the first cause in each specimen that has it, by the specimen's name.
    pub specimens: BTreeMap<String, BTreeMap<String, ParameterValue>>,
    /// Specimens in which nothing is missing, confidently.
    pub absent_in: Vec<String>,
    /// Specimens whose data cannot show the first cause.
    pub not_observable_in: Vec<String>,
}

impl Specimens {
    /// What named diagnoses have in common.
    pub fn of(found: &[(String, Diagnosis)]) -> Self {
        let findings: Vec<Findings> = found.iter().map(|(_, own)| own.into()).collect();
        let open: Vec<Vec<Vec<&str>>> = found.iter().map(|(_, own)| own.open()).collect();
        let named = |is: &dyn Fn(&Findings) -> bool| -> Vec<String> {
            let all = found.iter().zip(&findings).filter(|(_, own)| is(own));
            all.map(|((name, _), _)| name.clone()).collect()
        };
        let missing = in_common(&open).into_iter().map(|shared| {
            let first = shared.explanations[0];
            let own = || shared.findings.iter().map(|&(specimen, _)| specimen);
            let is_sure = |s: usize| {
                let own = &findings[s];
                own.verdict == Verdict::Named
                    && own.confidence == Confidence::Confident
                    && own.causes == [first]
            };
            let leaves = |s: usize| findings[s].structure_remains;
            let is_confident =
                shared.explanations.len() == 1 && own().any(is_sure) && !own().any(leaves);
            let strengths = own().map(|s| {
                (found[s].0.clone(), findings[s].parameters.get(first).cloned().unwrap_or_default())
            });
            MissingInSome {
                causes: shared.explanations.iter().map(|id| (*id).to_owned()).collect(),
                confidence: if is_confident {
                    Confidence::Confident
                } else {
                    Confidence::Tentative
                },
                specimens: strengths.collect(),
                absent_in: named(&|own| {
                    own.verdict == Verdict::NothingMissing
                        && own.confidence == Confidence::Confident
                }),
                not_observable_in: named(&|own| own.not_observable.iter().any(|id| id == first)),
            }
        });
        let missing = missing.collect();
        let one = |((name, _), own): (&(String, Diagnosis), Findings)| Specimen {
            name: name.clone(),
            verdict: own.verdict,
            confidence: own.confidence,
            causes: own.causes,
            next_experiment: own.next_experiment,
        };
        Self { missing, specimens: found.iter().zip(findings).map(one).collect() }
    }
}

impl Printable for Specimens {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        let count = self.specimens.len();
        for own in &self.missing {
            let ids: Vec<&str> = own.causes.iter().map(String::as_str).collect();
            let place = match own.specimens.len() {
                1 => format!("in {} only", own.specimens.keys().next().map_or("", String::as_str)),
                all if all == count => format!("in all {count} specimens"),
                some => format!("in {some} of {count} specimens"),
            };
            let sure = sure(own.confidence);
            sheet.paragraphs(&format!("Missing {place} ({sure}): {}", one_of(&ids)));
            for (name, parameters) in &own.specimens {
                let one = |(id, p): (&String, &ParameterValue)| {
                    let [low, high] = p.ci95.map(|end| significant(end, 3));
                    let unit = if p.unit == "1" { "" } else { &p.unit };
                    format!("{id} = {} {unit} (95 %: {low} to {high})", significant(p.value, 4))
                };
                let values: Vec<String> = parameters.iter().map(one).collect();
                sheet.paragraphs(&format!("  {name}: {}", values.join(", ")));
            }
            for (what, names) in
                [("not in", &own.absent_in), ("its data cannot show it:", &own.not_observable_in)]
            {
                if !names.is_empty() {
                    sheet.paragraphs(&format!("  {what} {}", names.join(", ")));
                }
            }
        }
        if self.missing.is_empty() {
            sheet.line(format_args!("Nothing that has a name is missing in {count} specimens."));
        }
        sheet.line("");
        let rows = self.specimens.iter().map(|own| {
            let verdict = match own.verdict {
                Verdict::NothingMissing => "nothing is missing",
                Verdict::Named => "named",
                Verdict::NamedStructureRemains => "named, structure remains",
                Verdict::Ambiguous => "not told apart",
                Verdict::Unknown => "unknown",
                Verdict::NotObservable => "cannot show it",
            };
            let causes = match own.causes.len() {
                0..=2 => own.causes.join(", "),
                more => format!("one of {more}"),
            };
            let next = own.next_experiment.clone();
            vec![own.name.clone(), verdict.into(), sure(own.confidence).into(), causes, next]
        });
        sheet.block(&table(&["specimen", "verdict", "how sure", "causes", "measure next"], rows));
        sheet.screen()
    }
}

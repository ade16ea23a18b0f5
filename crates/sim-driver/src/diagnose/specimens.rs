//! Several specimens of one actuator: what they have in common, and what one has alone.

use super::story::{one_of, sure, valued};
use super::{Diagnosis, Findings};
use crate::output::{Printable, Sheet, table};
use model_gap::discovery::{Confidence, Verdict};
use model_gap::{Class, ParameterValue, in_common};
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
    /// Confident where every one of them names this cause alone, and confidently.
    pub confidence: Confidence,
    /// The class of the first cause.
    pub class: Class,
    /// How sure that class is: confident where it is so in every one of them.
    pub class_confidence: Confidence,
    /// Parameters of the first cause in each specimen that has it, by the specimen's name.
    pub specimens: BTreeMap<String, BTreeMap<String, ParameterValue>>,
    /// Specimens in which nothing is missing, confidently, with the size from which the first cause would have been seen
    /// there with 90 % probability, over the output.
    pub not_seen_in: BTreeMap<String, f64>,
}

impl Specimens {
    /// What named diagnoses have in common.
    pub fn of(found: &[(String, Diagnosis)]) -> Self {
        let findings: Vec<Findings> = found.iter().map(|(_, own)| own.into()).collect();
        let open: Vec<Vec<Vec<&str>>> = found.iter().map(|(_, own)| own.open()).collect();
        let missing = in_common(&open).into_iter().map(|shared| {
            let first = shared.explanations[0];
            let is_sure = |own: &Findings| {
                own.verdict == Verdict::Named
                    && own.confidence == Confidence::Confident
                    && own.causes == [first]
            };
            let members: Vec<usize> = shared.findings.iter().map(|place| place.0).collect();
            let surely = |is: bool| if is { Confidence::Confident } else { Confidence::Tentative };
            let candidates = &found[members[0]].1.candidates;
            let class = candidates.iter().find(|own| own.id == first).map(|own| own.class);
            // the class of a diagnosis is that of what it found first
            let is_sure_of_class = |&(s, place): &(usize, usize)| {
                let own = (findings[s].class, findings[s].class_confidence);
                place == 0 && own == (class, Some(Confidence::Confident))
            };
            let strength = |&s: &usize| {
                let own = findings[s].parameters.get(first).cloned().unwrap_or_default();
                (found[s].0.clone(), own)
            };
            let would_have_shown = |((name, _), own): (&(String, Diagnosis), &Findings)| {
                let is_sure = own.verdict == Verdict::NothingMissing
                    && own.confidence == Confidence::Confident;
                let size = own.would_have_shown.get(first).copied().flatten();
                size.filter(|_| is_sure).map(|size| (name.clone(), size))
            };
            MissingInSome {
                causes: shared.explanations.iter().map(|id| (*id).to_owned()).collect(),
                confidence: surely(members.iter().all(|&s| is_sure(&findings[s]))),
                class: class.unwrap_or_default(),
                class_confidence: surely(shared.findings.iter().all(is_sure_of_class)),
                specimens: members.iter().map(strength).collect(),
                not_seen_in: found.iter().zip(&findings).filter_map(would_have_shown).collect(),
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
            let (with, without) = (own.specimens.len(), own.not_seen_in.len());
            let place = match with {
                1 if without + 1 == count => "in one specimen only".to_owned(),
                all if all == count => format!("in all {count} specimens"),
                some => format!("in {some} of {count} specimens"),
            };
            let (kind, cause) = (own.class.words(), one_of(&ids));
            let [kind_sure, cause_sure] = [own.class_confidence, own.confidence].map(sure);
            sheet.paragraphs(&format!(
                "Missing {place}: {kind} ({kind_sure}). The cause ({cause_sure}): {cause}"
            ));
            for (name, parameters) in &own.specimens {
                let one =
                    |(id, p): (&String, &ParameterValue)| valued(id, p.value, &p.unit, p.ci95);
                let values: Vec<String> = parameters.iter().map(one).collect();
                sheet.paragraphs(&format!("  {name}: {}", values.join(", ")));
            }
            for (name, size) in &own.not_seen_in {
                let percent = 100.0 * size;
                sheet.line(format_args!("  not in {name}, which would have shown {percent:.1} %"));
            }
        }
        let unknown: Vec<&str> = self
            .specimens
            .iter()
            .filter(|own| own.verdict == Verdict::Unknown)
            .map(|own| own.name.as_str())
            .collect();
        if !unknown.is_empty() {
            sheet.paragraphs(&format!(
                "Something without a name is missing in {}",
                unknown.join(", ")
            ));
        }
        if self.missing.is_empty() && unknown.is_empty() {
            sheet.line(format_args!("Nothing was found missing in {count} specimens."));
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

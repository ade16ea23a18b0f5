//! Metrics of sets with everyday errors.
//!
//! Each set is an actuator of its own, so that sets are independent and the bounds of the shares are exact.
//!
//! | group | holds |
//! |---|---|
//! | everyday | everyday errors, pairs, reference runs of another actuator |
//! | single | one cause of the library |
//! | null | nothing hidden; reference runs may be small |
//!
//! A class is said with confidence where it is given so, or where confident names are all of one class.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use everyday_bench::answer::Answer;
use everyday_bench::catalogue::class_of;
use everyday_bench::hidden::Kind;
use serde::{Deserialize, Serialize};

use crate::findings::Findings;
use crate::metrics::{Bar, Metric, median, number, share};
use crate::report::answer_given;

/// Share of the output from which on "nothing is missing" is a wrong denial.
const VISIBLE_SHARE: f64 = 0.03;

/// Time of a diagnosis, s.
const SECONDS: f64 = 15.0;

/// What a program said about one set, beside the answer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct EverydayCase {
    /// The answer.
    pub answer: Answer,
    /// The findings.
    pub findings: Findings,
    /// Wall time of the diagnosis, all that is computed once for an actuator included; s.
    pub seconds: f64,
    /// Wall time of the identification before it, s.
    pub identify_seconds: f64,
    /// The programs that made it.
    pub made_by: String,
}

impl EverydayCase {
    /// The confident names; none where they are not confident.
    fn sure_names(&self) -> &[String] {
        if self.findings.is_confident() { self.findings.names() } else { &[] }
    }

    /// Whether confident names hold one that is not true.
    pub fn wrong_name(&self) -> bool {
        self.sure_names().iter().any(|name| !self.answer.truths.contains(name))
    }

    /// The class said with confidence.
    pub fn sure_class(&self) -> Option<&str> {
        let named: BTreeSet<Option<&str>> =
            self.sure_names().iter().map(|name| class_of(name)).collect();
        let of_names = if named.len() == 1 { named.first().copied().flatten() } else { None };
        self.findings.sure_class().or(of_names)
    }

    /// Whether the class said with confidence is not a true one.
    pub fn wrong_class(&self) -> bool {
        let classes = &self.answer.classes;
        self.findings.sure_class().is_some_and(|class| !classes.iter().any(|own| own == class))
    }

    /// Whether it is said with confidence that nothing is missing where something visible is.
    pub fn wrong_denial(&self) -> bool {
        self.findings.denies() && self.answer.effect_share >= VISIBLE_SHARE
    }

    fn is_everyday(&self) -> bool {
        matches!(self.answer.kind, Kind::Everyday | Kind::Pair | Kind::Foreign)
    }

    fn is(&self, kind: Kind) -> bool {
        self.answer.kind == kind
    }

    /// One line: what is hidden, and what was said.
    pub fn line(&self) -> String {
        let said = answer_given(&self.findings);
        let class = match (&self.findings.class, self.findings.sure_class()) {
            (Some(class), Some(_)) => format!(" ({class}!)"),
            (Some(class), None) => format!(" ({class})"),
            (None, _) => String::new(),
        };
        let sure = if self.findings.denies() { "!" } else { "" };
        format!("{} -> {said}{sure}{class} {:.1} s", self.answer.hidden, self.seconds)
    }
}

/// All metrics of a suite.
pub fn metrics(cases: &[EverydayCase]) -> Vec<Metric> {
    let mut all = everyday(cases);
    all.extend(singles(cases));
    all.extend(nulls(cases));
    let mut seconds: Vec<f64> = cases.iter().map(|case| case.seconds).collect();
    let count = seconds.len();
    let middle = median(&mut seconds);
    let longest = seconds.last().copied().unwrap_or(f64::NAN);
    let mut identifying: Vec<f64> = cases.iter().map(|case| case.identify_seconds).collect();
    all.extend([
        number("time of a diagnosis, median, s", Bar::AtMost(SECONDS), middle, count),
        number("time of a diagnosis, longest, s", Bar::AtMost(SECONDS), longest, count),
        number("time of identify, median, s", Bar::Shown, median(&mut identifying), count),
    ]);
    all
}

fn everyday(cases: &[EverydayCase]) -> Vec<Metric> {
    let own = || cases.iter().filter(|case| case.is_everyday());
    let exact = |case: &EverydayCase| !case.sure_names().is_empty() && !case.wrong_name();
    let zero = Bar::AtMost(0.0);
    vec![
        share("everyday: confident wrong name", zero, own().map(EverydayCase::wrong_name)),
        share(
            "everyday, effect >= 3 %: nothing missing, confident",
            zero,
            own()
                .filter(|case| case.answer.effect_share >= VISIBLE_SHARE)
                .map(EverydayCase::wrong_denial),
        ),
        share("everyday: confident wrong class", zero, own().map(EverydayCase::wrong_class)),
        share("everyday: confident right names", Bar::Shown, own().map(exact)),
        share(
            "everyday, a class is right: confident right class",
            Bar::Shown,
            own()
                .filter(|case| !case.answer.classes.is_empty())
                .map(|case| case.sure_class().is_some() && !case.wrong_class()),
        ),
    ]
}

fn singles(cases: &[EverydayCase]) -> Vec<Metric> {
    let own = || cases.iter().filter(|case| case.is(Kind::Single));
    let sure = || own().filter(|case| !case.sure_names().is_empty());
    let classed = || own().filter_map(|case| Some((case, case.sure_class()?)));
    let right =
        |(case, class): (&EverydayCase, &str)| case.answer.classes.iter().any(|own| own == class);
    vec![
        share(
            "single: class confident",
            Bar::AtLeast(0.65),
            own().map(|case| case.sure_class().is_some()),
        ),
        share("  of these right", Bar::AtLeast(1.0), classed().map(right)),
        share(
            "single: exact name confident",
            Bar::AtLeast(0.35),
            own().map(|case| !case.sure_names().is_empty()),
        ),
        share("  of these right", Bar::AtLeast(0.98), sure().map(|case| !case.wrong_name())),
        share(
            "single: nothing missing, confident",
            Bar::Shown,
            own().map(EverydayCase::wrong_denial),
        ),
        share(
            "single: 95 % intervals of confident right names cover",
            Bar::Within(0.90, 0.98),
            sure().filter(|case| !case.wrong_name()).flat_map(covered),
        ),
    ]
}

/// Whether each interval holds the true value, where both are stated in one unit.
fn covered(case: &EverydayCase) -> Vec<bool> {
    let mut all = Vec::new();
    for (cause, parameters) in &case.answer.parameters {
        let Some(found) = case.findings.parameters.get(cause) else { continue };
        for (name, truth) in parameters {
            if let Some(estimate) = found.get(name).filter(|own| own.unit == truth.unit) {
                let [low, high] = estimate.ci95;
                all.push((low..=high).contains(&truth.value));
            }
        }
    }
    all
}

fn nulls(cases: &[EverydayCase]) -> Vec<Metric> {
    let own = || cases.iter().filter(|case| case.is(Kind::Null)).map(|case| &case.findings);
    let plain = cases.iter().filter(|case| case.answer.hidden == "null");
    vec![
        share("null: any name", Bar::AtMost(0.02), own().map(|found| !found.names().is_empty())),
        share("null: confident name", Bar::AtMost(0.0), own().map(Findings::is_confident)),
        share(
            "null: confident class",
            Bar::AtMost(0.0),
            own().map(|found| found.sure_class().is_some()),
        ),
        share(
            "null, full reference runs: nothing missing, confident",
            Bar::AtLeast(0.60),
            plain.map(|case| case.findings.denies()),
        ),
    ]
}

/// The sets with a confident wrong answer, one a line; empty where there is none.
pub fn wrong_ones(cases: &[EverydayCase]) -> String {
    let mut text = String::new();
    for case in cases {
        let faults = [
            (case.wrong_name(), "name"),
            (case.wrong_class(), "class"),
            (case.wrong_denial(), "denial"),
        ];
        let faults: Vec<&str> =
            faults.iter().filter(|(wrong, _)| *wrong).map(|(_, what)| *what).collect();
        if !faults.is_empty() {
            let Answer { family, seed, effect_share, .. } = &case.answer;
            let _ = writeln!(
                text,
                "wrong {}: {} seed {seed}, {:.1} %: {}",
                faults.join(" and "),
                family.id(),
                100.0 * effect_share,
                case.line()
            );
        }
    }
    text
}

//! The metrics and the confusion table as text.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::case::Case;
use crate::findings::{Findings, Verdict};
use crate::metrics::{Bar, Figure, Metric, Outcome};

/// One line a metric: name, figure, cases, 95 % bounds, bar, outcome.
pub fn metric_table(metrics: &[Metric]) -> String {
    let mut text = format!(
        "{:<54} {:>8} {:>7}  {:<15} {:<12}\n",
        "metric", "found", "cases", "95 % bounds", "bar"
    );
    for metric in metrics {
        let (value, cases, bounds) = match metric.figure {
            Figure::Share(share) => {
                let (low, high) = share.bounds();
                let bounds = format!("{:.1}..{:.1} %", 100.0 * low, 100.0 * high);
                (format!("{:.1} %", 100.0 * share.value()), share.cases, bounds)
            }
            Figure::Number { value, cases } => (format!("{value:.3}"), cases, String::new()),
        };
        let number = |bar: f64| match metric.figure {
            Figure::Share(_) => format!("{:.0} %", 100.0 * bar),
            Figure::Number { .. } => format!("{bar}"),
        };
        let bar = match metric.bar {
            Bar::AtMost(bar) => format!("<= {}", number(bar)),
            Bar::AtLeast(bar) => format!(">= {}", number(bar)),
            Bar::Within(low, high) => format!("{}..{}", number(low), number(high)),
            Bar::Shown => String::new(),
        };
        let outcome = match metric.outcome() {
            Outcome::Met => "met",
            Outcome::Missed => "MISSED",
            Outcome::Open if matches!(metric.bar, Bar::Shown) => "",
            Outcome::Open => "no cases",
        };
        let name = &metric.name;
        let line = if cases == 0 {
            format!("{name:<54} {:>8} {cases:>7}  {:<15} {bar:<12} {outcome}", "-", "")
        } else {
            format!("{name:<54} {value:>8} {cases:>7}  {bounds:<15} {bar:<12} {outcome}")
        };
        let _ = writeln!(text, "{}", line.trim_end());
    }
    text
}

/// Rows: what is hidden. Columns: how often each answer came, the most frequent first. A set of several
/// names counts under its first name with a `+`, a confident name with a `!`.
pub fn confusion_table(cases: &[Case]) -> String {
    confusion(cases.iter().map(|case| (case.answer.hidden.as_str(), &case.findings)))
}

/// [`confusion_table`] of what is hidden and what was found.
pub fn confusion<'a>(sets: impl Iterator<Item = (&'a str, &'a Findings)>) -> String {
    let mut rows: BTreeMap<&str, BTreeMap<String, u32>> = BTreeMap::new();
    for (hidden, findings) in sets {
        let row = rows.entry(hidden).or_default();
        *row.entry(answer_given(findings)).or_default() += 1;
    }
    let mut text = String::from("truth                                    sets  answers\n");
    for (truth, answers) in rows {
        let total: u32 = answers.values().sum();
        let mut answers: Vec<(String, u32)> = answers.into_iter().collect();
        answers.sort_by(|a, b| b.1.cmp(&a.1).then_with(|| a.0.cmp(&b.0)));
        let list: Vec<String> =
            answers.iter().map(|(answer, count)| format!("{answer} {count}")).collect();
        let _ = writeln!(text, "{truth:<40} {total:>4}  {}", list.join(", "));
    }
    text
}

/// An answer in a few words.
pub fn answer_given(found: &Findings) -> String {
    let first = || found.causes.first().map_or("(no name)", String::as_str);
    match found.verdict {
        Verdict::NothingMissing => "nothing".to_owned(),
        Verdict::NotObservable => "not observable".to_owned(),
        Verdict::Unknown => "unknown".to_owned(),
        Verdict::Ambiguous => format!("{}+{}?", first(), found.causes.len().saturating_sub(1)),
        Verdict::Named | Verdict::NamedStructureRemains => {
            let sure = if found.is_confident() { "!" } else { "" };
            format!("{}{sure}", found.causes.join("&"))
        }
    }
}

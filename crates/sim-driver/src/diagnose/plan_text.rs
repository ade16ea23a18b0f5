//! What planned runs would show, as a table.

use super::Plan;
use crate::output::{Printable, Sheet, table};
use actuator_gap::{PlannedCause, Rehearsal, SIZES};
use model_gap::discovery::{Confidence, Verdict};
use serde::Serialize;

/// A plan, printable.
#[derive(Debug, Clone, Serialize)]
#[serde(transparent)]
pub struct PlanText(pub Plan);

/// What a diagnosis would say of a cause, the best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Told {
    Name,
    Class,
    Set,
    Other,
    Unnamed,
    Missed,
    Wrong,
}

fn told(cause: &PlannedCause, own: &Rehearsal) -> Told {
    let is_sure = own.confidence == Confidence::Confident;
    match own.verdict {
        Verdict::NothingMissing | Verdict::NotObservable => Told::Missed,
        Verdict::Unknown => Told::Unnamed,
        _ if own.causes == [cause.cause] && is_sure => Told::Name,
        _ if is_sure => Told::Wrong,
        _ if own.class_confidence == Some(Confidence::Confident) => {
            if own.class == Some(cause.class) { Told::Class } else { Told::Wrong }
        }
        _ if own.causes.iter().any(|id| id == cause.cause) => Told::Set,
        _ => Told::Other,
    }
}

/// The same in words.
fn words(cause: &PlannedCause, own: &Rehearsal) -> String {
    let count = own.causes.len();
    match told(cause, own) {
        Told::Name => "its name".to_owned(),
        Told::Class if count > 1 => format!("its kind, one of {count}"),
        Told::Class => "its kind, name not sure".to_owned(),
        Told::Set if count > 1 => format!("one of {count}"),
        Told::Set => "its name, not sure".to_owned(),
        Told::Other => format!("perhaps {}", own.causes.join(", ")),
        Told::Unnamed => "something, no name".to_owned(),
        Told::Missed => "nothing".to_owned(),
        Told::Wrong => format!("wrong: {}", own.causes.join(", ")),
    }
}

/// What is said of a cause at a size, of the sign that is told worse.
fn at(cause: &PlannedCause, size: f64) -> Option<&Rehearsal> {
    let of_size = cause.rehearsed.iter().filter(|said| (said.size - size).abs() < 1e-9);
    of_size.max_by_key(|said| told(cause, said))
}

impl Printable for PlanText {
    fn text(&self) -> String {
        let Self(plan) = self;
        let mut sheet = Sheet::default();
        for size in SIZES {
            let all: Vec<Told> =
                plan.causes.iter().filter_map(|own| Some(told(own, at(own, size)?))).collect();
            let count = |is: Told| all.iter().filter(|own| **own == is).count();
            sheet.line(format_args!(
                "Of {} causes of {:.0} % of the motion: {} named, the kind of {} more, {} wrong.",
                all.len(),
                100.0 * size,
                count(Told::Name),
                count(Told::Class),
                count(Told::Wrong)
            ));
        }
        sheet.paragraphs(&format!(
            "Runs: {}; noise {:.2} um. Each is simulated once with nothing missing and once with the cause, as the \
             engine knows it and with one draw of the noise: a bench will show rather less. Of a cause with two signs the one that is \
             told worse is shown.",
            plan.runs.join(", "),
            plan.noise_um
        ));
        sheet.line("");
        let rows = plan.causes.iter().map(|own| {
            let seen = own.seen_from.map_or("-".into(), |size| format!("{:.1}", 100.0 * size));
            let mut row = vec![own.cause.to_owned(), seen];
            let none = if own.blocked.is_some() { "cannot show it" } else { "never so large" };
            row.extend(
                SIZES.map(|size| at(own, size).map_or(none.to_owned(), |said| words(own, said))),
            );
            row.push(then(own));
            row
        });
        sheet.block(&table(&["cause", "seen from %", "at 3 %", "at 6 %", "then measure"], rows));
        sheet.screen()
    }
}

/// What would be asked for next, where the smallest size is not named for sure.
fn then(own: &PlannedCause) -> String {
    match at(own, SIZES[0]) {
        Some(said) if told(own, said) != Told::Name => said.next_experiment.clone(),
        _ => String::new(),
    }
}

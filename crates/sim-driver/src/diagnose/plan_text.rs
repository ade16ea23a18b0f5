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

/// What a diagnosis would say of a cause.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Told {
    Name,
    Class,
    Set,
    Unnamed,
    Missed,
    Wrong,
}

fn told(cause: &str, own: &Rehearsal) -> Told {
    let is_sure = own.confidence == Confidence::Confident;
    let has_cause = own.causes.iter().any(|id| id == cause);
    match own.verdict {
        Verdict::NothingMissing | Verdict::NotObservable => Told::Missed,
        Verdict::Unknown => Told::Unnamed,
        _ if !has_cause => Told::Wrong,
        _ if own.causes.len() == 1 && is_sure => Told::Name,
        _ if own.class_confidence == Some(Confidence::Confident) => Told::Class,
        _ => Told::Set,
    }
}

/// The same in words.
fn words(cause: &str, own: &Rehearsal) -> String {
    match told(cause, own) {
        Told::Name => "its name".to_owned(),
        Told::Class if own.causes.len() > 1 => format!("its kind, one of {}", own.causes.len()),
        Told::Class => "its kind, name not sure".to_owned(),
        Told::Set if own.causes.len() > 1 => format!("one of {}", own.causes.len()),
        Told::Set => "its name, not sure".to_owned(),
        Told::Unnamed => "something, no name".to_owned(),
        Told::Missed => "nothing".to_owned(),
        Told::Wrong => format!("{} instead", own.causes.join(", ")),
    }
}

impl Printable for PlanText {
    fn text(&self) -> String {
        let Self(plan) = self;
        let mut sheet = Sheet::default();
        for (k, size) in SIZES.iter().enumerate() {
            let all: Vec<Told> = plan
                .causes
                .iter()
                .filter_map(|own| own.rehearsed.get(k).map(|said| told(own.cause, said)))
                .collect();
            let count = |is: &[Told]| all.iter().filter(|own| is.contains(own)).count();
            sheet.line(format_args!(
                "Of {} causes of {:.0} % of the motion these runs would name {}, and the kind of {} more.",
                all.len(),
                100.0 * size,
                count(&[Told::Name]),
                count(&[Told::Class])
            ));
        }
        sheet.paragraphs(&format!(
            "Runs: {}; noise {:.2} um. Each is measured once with nothing missing and once with the cause, which is \
             simulated as the engine knows it: a bench will show rather less.",
            plan.runs.join(", "),
            plan.noise_um
        ));
        sheet.line("");
        let rows = plan.causes.iter().map(|own| {
            let seen = own.seen_from.map_or("-".into(), |size| format!("{:.1}", 100.0 * size));
            let mut row = vec![own.cause.to_owned(), seen];
            row.extend((0..SIZES.len()).map(|k| {
                own.rehearsed.get(k).map_or("-".to_owned(), |said| words(own.cause, said))
            }));
            row.push(then(own));
            row
        });
        sheet.block(&table(&["cause", "seen from %", "at 3 %", "at 6 %", "then measure"], rows));
        sheet.screen()
    }
}

/// What would be asked for next, where the smallest size is not named for sure.
fn then(own: &PlannedCause) -> String {
    match own.rehearsed.first() {
        Some(said) if told(own.cause, said) != Told::Name => said.next_experiment.clone(),
        _ => String::new(),
    }
}

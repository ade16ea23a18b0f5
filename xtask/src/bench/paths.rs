//! The hot paths with their bars, and the least that the processor needs for their arithmetic.

use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{Discretisation, ResponseError, Rotor, RotorModel};

use super::samples::{Sample, Samples};
use crate::XtaskError;

/// What a path may take.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bar {
    /// Seconds of an element.
    Seconds(f64),
    /// A share of what another bench takes.
    ShareOf(&'static str, f64),
    /// Nothing was asked.
    Open,
}

/// Operations in double precision, each on one number.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Operations {
    /// Divisions.
    pub divisions: f64,
    /// Square roots.
    pub roots: f64,
    /// Products, each with a sum where there is one, or sums and comparisons alone where those are more: a processor may do
    /// the ones beside the others.
    pub multiply_adds: f64,
}

/// What the arithmetic of an element is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Work {
    /// So many operations.
    Counted(Operations),
    /// Those of a residual of a revolution, whose size is the rotor's.
    Revolution,
    /// Made of residuals of a revolution and of sweeps: no count of its own.
    Composed,
}

/// What something took before the work on speed, as it was noted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Before {
    /// From and to, s.
    pub range_s: [f64; 2],
    /// What was otherwise; empty if nothing was.
    pub otherwise: &'static str,
}

impl Before {
    /// What took so many seconds.
    pub const fn took(least_s: f64, most_s: f64) -> Self {
        Self { range_s: [least_s, most_s], otherwise: "" }
    }

    /// In words, as a multiple of what it takes now.
    pub fn over(&self, now_s: f64, words: impl Fn(f64) -> String) -> String {
        let [least_s, most_s] = self.range_s;
        let range =
            |from: String, to: String| if from == to { from } else { format!("{from} to {to}") };
        let times = |before_s: f64| format!("{:.1}", before_s / now_s);
        let took = range(words(least_s), words(most_s));
        let times = range(times(least_s), times(most_s));
        let otherwise = if self.otherwise.is_empty() { "" } else { ", " };
        format!("{took}{otherwise}{}: {times} times", self.otherwise)
    }
}

/// A path that is measured by a bench.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HotPath {
    /// What it does.
    pub name: &'static str,
    /// Target of the bench.
    pub target: &'static str,
    /// Id of the bench.
    pub id: &'static str,
    /// What it may take.
    pub bar: Bar,
    /// Its arithmetic.
    pub work: Work,
    /// What it took before the work on speed.
    pub before: Option<Before>,
}

/// Target and ids of the limits of the processor.
pub const MACHINE: (&str, [&str; 3]) =
    ("machine", ["machine/division", "machine/root", "machine/multiply-add"]);

/// The kernel of the wake on one core and on two.
pub const KERNEL: [&str; 2] = ["kernel/1 thread", "kernel/2 threads"];

/// A residual of a revolution.
pub const RESIDUAL: &str = "residual";

/// Evaluation of a segment at a target with Vatistas's core: two roots, a quotient, and the products of the formula.
const EVALUATION: Operations = Operations { divisions: 1.0, roots: 2.0, multiply_adds: 29.0 };

/// A sample of 40 plays: two comparisons and a sum move each, two more operations find its cell. The multiply-adds of up to
/// five output maps run beside.
const PLAYS: f64 = 40.0 * 5.0;

/// A section with 16 lags in one step: the four inputs in three loads, and for each lag two multiply-adds of its state and one
/// in each load.
const SECTION: Operations =
    Operations { divisions: 0.0, roots: 0.0, multiply_adds: 12.0 + 16.0 * 5.0 };

/// A mode at a station and point: value and slope, each with rate and acceleration, and the work of two loads on it.
const MODE: f64 = 8.0;

/// Target and id of what the lines of a wake held still induce, a part of every trim in the free wake.
pub const LINE_INDUCTION: (&str, &str) = ("sweep", "line induction");

/// The paths, fastest first.
pub const PATHS: [HotPath; 15] = [
    path(
        "kernel, an evaluation, one core",
        ("kernel", KERNEL[0]),
        Bar::Seconds(1.0 / (0.8 * 2.6e8)),
        Work::Counted(EVALUATION),
    ),
    path(
        "kernel, an evaluation, two cores, bar: 1.8 times the rate of one",
        ("kernel", KERNEL[1]),
        Bar::ShareOf(KERNEL[0], 1.0 / 1.8),
        Work::Composed,
    ),
    path(
        "section, a step",
        ("section_step", "step of constant length hariharan-leishman"),
        Bar::Seconds(60e-9),
        Work::Counted(SECTION),
    ),
    path(
        "static Preisach model, a sample at 40 levels",
        ("sample", "sample at 40 levels/static"),
        Bar::Seconds(100e-9),
        Work::Counted(Operations { divisions: 0.0, roots: 0.0, multiply_adds: PLAYS }),
    ),
    path(
        "dynamic Preisach model, a sample at 40 levels",
        ("sample", "sample at 40 levels/dynamic"),
        Bar::Seconds(300e-9),
        Work::Counted(Operations { divisions: 1.0, roots: 1.0, multiply_adds: PLAYS }),
    ),
    path(
        "cycle of the adaptive controller, one harmonic",
        ("control_cycle", "controller cycle, one harmonic"),
        Bar::Seconds(20e-6),
        Work::Composed,
    ),
    path(
        "cycle of the adaptive controller, 2 to 5/rev at once",
        ("control_cycle", "controller cycle, 2 to 5 per rev"),
        Bar::Seconds(20e-6),
        Work::Composed,
    ),
    path(
        "residual of a revolution",
        ("response", RESIDUAL),
        Bar::Seconds(0.8e-3),
        Work::Revolution,
    )
    .before(2.2e-3, 2.5e-3),
    path(
        "sweep of the free wake, 24 azimuths, 4 turns",
        ("sweep", "sweep"),
        Bar::Seconds(0.1),
        Work::Composed,
    ),
    path(
        "response from a nearby orbit",
        ("response", "response/HariharanLeishman"),
        Bar::Seconds(0.05),
        Work::Composed,
    ),
    path(
        "T of two flaps at 2 to 5/rev, bar: a fifth of differences",
        ("linearised", "T/linearised"),
        Bar::ShareOf("T/differences", 0.2),
        Work::Composed,
    ),
    path(
        "trim, Drees's inflow, one core",
        ("coupled_trim", "coupled_trim/1"),
        Bar::Open,
        Work::Composed,
    ),
    path(
        "trim, Drees's inflow, two cores",
        ("coupled_trim", "coupled_trim/2"),
        Bar::Seconds(0.08),
        Work::Composed,
    )
    .before(0.35, 0.35),
    path(
        "trim in the free wake, one core",
        ("free_wake_trim", "trim in the free wake/1"),
        Bar::Open,
        Work::Composed,
    ),
    path(
        "trim in the free wake, two cores",
        ("free_wake_trim", "trim in the free wake/2"),
        Bar::Seconds(0.4),
        Work::Composed,
    )
    .before(1.7, 1.7),
];

/// A path of which nothing was noted before.
const fn path(
    name: &'static str,
    (target, id): (&'static str, &'static str),
    bar: Bar,
    work: Work,
) -> HotPath {
    HotPath { name, target, id, bar, work, before: None }
}

impl HotPath {
    /// The same with what it took before.
    const fn before(self, least_s: f64, most_s: f64) -> Self {
        Self { before: Some(Before::took(least_s, most_s)), ..self }
    }
}

/// Least times that the processor needs for the arithmetic of an element, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limits {
    /// Of its divider.
    pub divider_s: f64,
    /// Of its multiply-adds.
    pub multiply_add_s: f64,
}

impl Limits {
    /// Those of counted operations at the measured rates.
    ///
    /// # Errors
    /// [`XtaskError::Speed`] where these were not measured.
    pub fn of(operations: &Operations, samples: &Samples) -> Result<Self, XtaskError> {
        let [division_s, root_s, multiply_add_s] = MACHINE.1.map(|id| element_s(samples, id));
        Ok(Self {
            divider_s: operations.divisions * division_s? + operations.roots * root_s?,
            multiply_add_s: operations.multiply_adds * multiply_add_s?,
        })
    }

    /// The longer of them, s.
    pub fn longest_s(&self) -> f64 {
        self.divider_s.max(self.multiply_add_s)
    }
}

/// A path as it was measured.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredPath {
    /// The path.
    pub path: HotPath,
    /// What an element may take, s, if anything was asked.
    pub bar_s: Option<f64>,
    /// What it takes, s.
    pub time_s: f64,
    /// The limits of its arithmetic, where that is counted.
    pub limits: Option<Limits>,
    /// Residuals of a revolution that take as long.
    pub residuals: f64,
}

/// The paths with their times and limits.
///
/// # Errors
/// [`XtaskError::Speed`] for a bench that was not run; [`XtaskError::Study`] if the rotor cannot be built.
pub fn measured(samples: &Samples) -> Result<Vec<MeasuredPath>, XtaskError> {
    let residual_s = element_s(samples, RESIDUAL)?;
    let revolution = revolution().map_err(|error| XtaskError::Study(error.to_string()))?;
    let one = |path: &HotPath| -> Result<MeasuredPath, XtaskError> {
        let time_s = element_s(samples, path.id)?;
        let bar_s = match path.bar {
            Bar::Seconds(bar_s) => Some(bar_s),
            Bar::ShareOf(other, share) => Some(share * element_s(samples, other)?),
            Bar::Open => None,
        };
        let operations = match path.work {
            Work::Counted(operations) => Some(operations),
            Work::Revolution => Some(revolution),
            Work::Composed => None,
        };
        let limits = operations.map(|counted| Limits::of(&counted, samples)).transpose()?;
        Ok(MeasuredPath { path: *path, bar_s, time_s, limits, residuals: time_s / residual_s })
    };
    PATHS.iter().map(one).collect()
}

/// Bench targets with the ids that the paths need, limits of the processor first.
pub fn benches() -> Vec<(&'static str, Vec<&'static str>)> {
    let mut all = vec![(MACHINE.0, MACHINE.1.to_vec())];
    for path in &PATHS {
        add(&mut all, path.target, path.id);
        if let Bar::ShareOf(other, _) = path.bar {
            add(&mut all, path.target, other);
        }
    }
    add(&mut all, LINE_INDUCTION.0, LINE_INDUCTION.1);
    all
}

/// Adds an id to those of its target, once.
pub(super) fn add(
    all: &mut Vec<(&'static str, Vec<&'static str>)>,
    target: &'static str,
    id: &'static str,
) {
    match all.iter_mut().find(|(known, _)| *known == target) {
        Some((_, ids)) if ids.contains(&id) => {}
        Some((_, ids)) => ids.push(id),
        None => all.push((target, vec![id])),
    }
}

/// Time of an element of a bench, s.
pub(super) fn element_s(samples: &Samples, id: &str) -> Result<f64, XtaskError> {
    samples.get(id).map(Sample::element_s).ok_or_else(|| XtaskError::Speed {
        what: id.to_owned(),
        said: "there is no such bench: was it renamed?".to_owned(),
    })
}

/// What no residual of the default rotor can do without: at every station and point of time its modes and its section.
fn revolution() -> Result<Operations, ResponseError> {
    let mesh = Discretisation::default();
    let points = mesh.time_elements * mesh.time_gauss_points;
    let modes = mesh.modes.iter().sum::<usize>() as f64;
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    let stations = Rotor::new(RotorModel::paper_case(), &blade, mesh)?.blade().grid().len();
    let each = MODE * modes + SECTION.multiply_adds;
    Ok(Operations { multiply_adds: (stations * points) as f64 * each, ..Operations::default() })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// Every bench of the table, all at one time but for the operations.
    pub(crate) fn samples() -> Samples {
        let ids = benches().into_iter().flat_map(|(_, ids)| ids);
        let mut samples: Samples =
            ids.map(|id| (id.to_owned(), Sample { call_s: 1e-3, elements: 1.0 })).collect();
        for (id, elements) in MACHINE.1.into_iter().zip([1e6, 5e5, 2e7]) {
            samples.insert(id.to_owned(), Sample { call_s: 1e-3, elements });
        }
        samples
    }

    #[test]
    fn limits_are_operations_over_rates() {
        let limits = Limits::of(&EVALUATION, &samples()).unwrap();
        // a division 1 ns, a root 2 ns, a multiply-add 0.05 ns
        assert!((limits.divider_s / 5e-9 - 1.0).abs() < 1e-12, "{limits:?}");
        assert!((limits.multiply_add_s / 1.45e-9 - 1.0).abs() < 1e-12, "{limits:?}");
        assert!((limits.longest_s() - limits.divider_s).abs() < 1e-24);
    }

    #[test]
    fn bars_may_be_shares_of_other_benches() {
        let mut samples = samples();
        samples.insert("T/differences".to_owned(), Sample { call_s: 0.5, elements: 1.0 });
        let paths = measured(&samples).unwrap();
        let t = paths.iter().find(|path| path.path.id == "T/linearised").unwrap();
        assert!((t.bar_s.unwrap() - 0.1).abs() < 1e-12);
        assert!(paths.iter().any(|path| path.bar_s.is_none()));
        assert!((t.residuals - 1.0).abs() < 1e-12);
        assert!(t.limits.is_none());
    }

    #[test]
    fn a_bench_that_was_not_run_is_named() {
        for missing in ["machine/root", "T/differences", "coupled_trim/2"] {
            let mut samples = samples();
            samples.remove(missing);
            let said = measured(&samples).unwrap_err().to_string();
            assert!(said.contains(missing), "{said}");
        }
    }
}

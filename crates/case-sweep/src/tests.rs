//! A sweep over a toy whose cases are numbers, from the file to the table.

use crate::{
    Cell, Done, Failed, Found, Merged, NoNumbers, Plan, ReadCase, Runner, Shard, State, Store,
    SweepError, merge, plan, read_sweep_file, run, status,
};
use measured_data::problem::{Fault, Problems};
use measured_data::{DataError, Folder, Source, read_ron, ron_text, write_atomic};
use proptest::prelude::*;
use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Toy {
    low: f64,
    high: f64,
    count: usize,
    #[serde(default)]
    form: Form,
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
enum Form {
    #[default]
    Round,
    Square(#[serde(default)] Side),
}

#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct Side {
    edge: f64,
}

const BASE: &str = "(low: 1.0, high: 2.0, count: 3, form: Round)";

#[derive(Default)]
struct ToyRunner {
    runs: AtomicUsize,
    /// How often the file that a case names was written anew.
    written: AtomicUsize,
    /// That file is gone.
    gone: AtomicBool,
    /// What ends the case of count 15 is mended.
    mended: bool,
}

impl Runner for ToyRunner {
    type Case = Toy;

    fn version(&self) -> &'static str {
        "toy 1"
    }

    fn read(&self, text: &str) -> Result<ReadCase<Toy>, Problems> {
        let read = read_ron::<Toy>(&Source { name: "case".into(), text: text.into() });
        let mut problems = read.problems;
        if let Some(toy) = &read.value {
            let mut refuse = |field: &str, message: String| {
                problems.push(read.index.place(field), Fault::Other(message));
            };
            if toy.low < 0.0 {
                refuse("low", format!("is {}, expected 0 or more", toy.low));
            }
            if toy.low >= toy.high {
                refuse("high", format!("is {}, expected more than low {}", toy.high, toy.low));
            }
            if self.gone.load(Ordering::Relaxed) {
                refuse("form", "cannot be read".to_owned());
            }
        }
        let toy = problems.into_result(read.value)?;
        let canonical = ron_text(&toy).unwrap_or_default();
        let input = format!("input {}", self.written.load(Ordering::Relaxed));
        Ok(ReadCase { canonical, inputs: vec![input], case: toy })
    }

    fn unit(&self, toy: &Toy, field: &str) -> Option<String> {
        let unit = match (field, &toy.form) {
            ("low" | "high", _) => "m0 R",
            ("count" | "form", _) => "",
            ("form.edge", Form::Square(_)) => "m",
            _ => return None,
        };
        Some(unit.to_owned())
    }

    fn run(&self, toy: Toy) -> Result<Found, NoNumbers> {
        self.runs.fetch_add(1, Ordering::Relaxed);
        if toy.count == 13 {
            return Err(NoNumbers::Failed("13 is unlucky, \"really\"".into()));
        }
        if toy.count == 17 {
            let (path, reason) = ("numbers".into(), "the disk is full".into());
            return Err(NoNumbers::Stopped(DataError::NotWritten { path, reason }));
        }
        self.written.fetch_add(usize::from(toy.count == 19), Ordering::Relaxed);
        self.gone.fetch_or(toy.count == 21, Ordering::Relaxed);
        assert!(toy.count != 15 || self.mended, "a bug of the toy");
        let value = (toy.low * toy.high).sqrt() / toy.count as f64;
        let edge = if let Form::Square(side) = &toy.form { side.edge } else { f64::NAN };
        let columns = vec![("mean_m".to_owned(), value.into()), ("edge_m".to_owned(), edge.into())];
        Ok(Found { columns, warnings: vec![] })
    }
}

fn planned(text: &str) -> Result<Plan, SweepError> {
    let source = Source { name: "s.ron".into(), text: text.into() };
    let file = read_sweep_file(&source, &Folder::Disk("none".into()))?;
    let runner = ToyRunner::default();
    let base = runner.read(BASE)?.canonical;
    plan(&file, base, &runner)
}

fn swept(axes: &str) -> Plan {
    planned(&format!("(base: \"b\", axes: [{axes}])")).unwrap()
}

const TWELVE: &str =
    "(field: \"high\", from: 2, to: 3, count: 4), (field: \"count\", values: [1, 2, 13])";

fn ran(plan: &Plan, shard: &str, store: &Store) -> crate::Ran {
    let part = (Shard::parse(shard).unwrap(), Failed::Left);
    run(plan, part, store, &ToyRunner::default(), &|_| {}).unwrap()
}

/// Layout, comments and order of the base do not matter, nor how a value is written; what is varied does.
#[test]
fn keys_follow_what_a_case_is() {
    let keys = |axes: &str| -> Vec<String> {
        swept(axes).cases.into_iter().map(|case| case.key).collect()
    };
    assert_eq!(keys("(field: \"low\", values: [0.5])"), keys("(field: \"low\", values: [ 5e-1 ])"));
    assert_ne!(keys("(field: \"low\", values: [0.5])"), keys("(field: \"low\", values: [0.51])"));
    let source = Source {
        name: "s".into(),
        text: "(base: \"b\", axes: [(field: \"low\", values: [0.5])])".into(),
    };
    let file = read_sweep_file(&source, &Folder::Disk("none".into())).unwrap();
    let runner = ToyRunner::default();
    let other = "(count: 3, // three\n high: 2, low: 1)";
    let base = runner.read(other).unwrap().canonical;
    assert_eq!(plan(&file, base, &runner).unwrap(), swept("(field: \"low\", values: [0.5])"));
}

/// A field left out of the canonical text is added, one inside a group that another axis brings as well.
#[test]
fn axes_reach_fields_inside_groups() {
    let plan = swept(
        "(field: \"form\", values: [Square(edge: 1), Square()]), (field: \"form.edge\", values: [4, 5])",
    );
    let place = tempfile::tempdir().unwrap();
    let store = Store::new(place.path());
    assert_eq!(ran(&plan, "1/1", &store).computed, 2, "the first axis makes no difference");
    let merged = merge(&plan, &store, false).unwrap();
    let edges: Vec<_> = merged.cases.iter().map(|case| case.found[1].1.clone()).collect();
    assert_eq!(edges, [4.0, 5.0, 4.0, 5.0].map(Cell::from));
    // a unit that the base case does not know is that of the cases
    assert_eq!(plan.units, ["", "m"]);
    assert_eq!(merged.csv().lines().next().unwrap().split(',').nth(2), Some("form.edge [m]"));
    // what is written is read back
    let text = serde_json::to_string(&merged).unwrap();
    assert_eq!(serde_json::from_str::<Merged>(&text).unwrap(), merged);
}

#[test]
fn a_value_that_no_case_takes_is_an_error_with_its_place() {
    for (axes, wanted) in [
        (
            "(field: \"lwo\", values: [1])",
            "s.ron:2:2: axes[0].field: is refused: lwo: unknown key `lwo`, did you mean `low`?",
        ),
        (
            "(field: \"low\", values: [0.5, -1])",
            "axes[0].values[1]: is refused: -1 for low: low is -1, expected 0 or more",
        ),
        (
            "(field: \"low\", values: [0.5, Red])",
            "axes[0].values[1]: is refused: Red for low: low has the wrong type",
        ),
        (
            "(field: \"count\", from: 1, to: 4, count: 3)",
            "axes[0].from: is refused: 2.5 for count: count has the wrong type",
        ),
        ("(field: \"form\", values: [Oval])", "unknown choice `Oval`"),
        ("(field: \"low[2]\", values: [1])", "is no field of the case"),
        ("(field: \"low.deep\", values: [1])", "is no field of the case"),
        ("(field: \"high\", values: [0.5])", "high is 0.5, expected more than low 1"),
    ] {
        let text =
            planned(&format!("(base: \"b\", axes: [\n({}])", &axes[1..])).unwrap_err().to_string();
        assert!(text.contains(wanted), "{text}");
        assert!(text.starts_with("s.ron:2:"), "{text}");
    }
}

/// What is wrong with the base case is said once and of it, not of every value of every axis.
#[test]
fn a_base_case_that_is_refused_is_no_fault_of_an_axis() {
    let text = "(base: \"b\", axes: [(field: \"count\", values: [1, 2])])";
    let source = Source { name: "s.ron".into(), text: text.into() };
    let file = read_sweep_file(&source, &Folder::Disk("none".into())).unwrap();
    let runner = ToyRunner::default();
    let good = runner.read(BASE).unwrap().canonical;
    let bad = good.replacen("low: 1.0", "low: -1.0", 1);
    assert_ne!(good, bad);
    let said = plan(&file, bad, &runner).unwrap_err().to_string();
    assert!(said.starts_with("case:") && said.contains("low: is -1, expected 0 or more"), "{said}");
    assert!(!said.contains("axes") && !said.contains("problems"), "{said}");
}

/// Values that do not go together make a failed case, and the others go on.
#[test]
fn failed_cases_are_results_with_their_reason() {
    let plan = swept(
        "(field: \"low\", values: [0.5, 1.9]), (field: \"high\", values: [1.8, 2.5]), (field: \"count\", values: [1, 13, 15])",
    );
    let place = tempfile::tempdir().unwrap();
    let store = Store::new(place.path());
    let first = ran(&plan, "1/1", &store);
    assert_eq!((first.computed, first.failed.len()), (12, 9));
    let again = ran(&plan, "1/1", &store);
    assert_eq!((again.computed, again.skipped, again.failed), (0, 12, first.failed));
    let csv = merge(&plan, &store, false).unwrap().csv();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!(lines[0], "case,low [m0 R],high [m0 R],count,failed,mean_m,edge_m,warnings,key");
    assert!(lines[2].starts_with("2,0.5,1.8,13,\"13 is unlucky, \"\"really\"\"\",,,0,"), "{csv}");
    assert!(lines[3].contains("a bug of the program"), "{csv}");
    assert!(
        lines[7].contains("high is 1.8") || lines[7].contains("expected more than low 1.9"),
        "{csv}"
    );
    assert!(lines[10].starts_with("10,1.9,2.5,1,,2.179"), "{csv}");
    assert_eq!(status(&store, &plan).failed.len(), 9);
}

/// A full disk is no property of a case: the sweep ends with it, and the case is run again.
#[test]
fn a_case_that_was_stopped_has_no_result() {
    let plan = swept("(field: \"count\", values: [1, 17])");
    let place = tempfile::tempdir().unwrap();
    let store = Store::new(place.path());
    for _ in 0..2 {
        let part = (Shard::WHOLE, Failed::Left);
        let ended = run(&plan, part, &store, &ToyRunner::default(), &|_| {});
        assert!(ended.unwrap_err().to_string().contains("the disk is full"));
    }
    let status = status(&store, &plan);
    assert_eq!(status.missing, [plan.cases[1].key.clone()]);
}

/// A file that changes or goes between the plan and the end of a case: no result, under any key, and no failed case.
#[test]
fn a_case_whose_files_change_has_no_result() {
    for (count, said) in [(19, "since the sweep was planned;"), (21, "form: cannot be read")] {
        let plan = swept(&format!("(field: \"count\", values: [1, {count}, 2])"));
        let place = tempfile::tempdir().unwrap();
        let store = Store::new(place.path());
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let runner = ToyRunner::default();
        let again = || run(&plan, (Shard::WHOLE, Failed::Left), &store, &runner, &|_| {});
        // the second run finds the files changed before it begins
        for runs in [2, 2] {
            let error = one.install(again).unwrap_err().to_string();
            assert!(error.contains(said) && error.contains("run again"), "{error}");
            assert!(error.starts_with(&format!("case {}", &plan.cases[1].key[..12])), "{error}");
            assert_eq!(runner.runs.load(Ordering::Relaxed), runs);
        }
        let status = status(&store, &plan);
        assert_eq!((status.found, status.failed.len(), status.missing.len()), (1, 0, 2));
        assert!(status.foreign.is_empty(), "{status:?}");
    }
}

/// What failed is left, or computed again if that is asked for.
#[test]
fn failed_cases_are_computed_again_when_asked_for() {
    let plan = swept("(field: \"count\", values: [1, 13, 15])");
    let place = tempfile::tempdir().unwrap();
    let store = Store::new(place.path());
    assert_eq!(ran(&plan, "1/1", &store).failed.len(), 2);
    let mended = ToyRunner { mended: true, ..ToyRunner::default() };
    let again = |failed| run(&plan, (Shard::WHOLE, failed), &store, &mended, &|_| {}).unwrap();
    let left = again(Failed::Left);
    assert_eq!((left.computed, left.skipped, left.failed.len()), (0, 3, 2));
    let once_more = again(Failed::Again);
    assert_eq!((once_more.computed, once_more.skipped, once_more.failed.len()), (2, 1, 1));
    assert_eq!(status(&store, &plan).found, 2);
}

/// What is said to be computed is on the disk: a kill loses the cases in progress alone.
#[test]
fn a_result_is_kept_before_it_is_told() {
    let (plan, place) = (swept(TWELVE), tempfile::tempdir().unwrap());
    let store = Store::new(place.path());
    let told = AtomicUsize::new(0);
    let look = |done: Done| {
        let status = status(&store, &plan);
        assert!(status.found + status.failed.len() >= done.computed, "{done:?} {status:?}");
        told.fetch_add(1, Ordering::Relaxed);
    };
    run(&plan, (Shard::WHOLE, Failed::Left), &store, &ToyRunner::default(), &look).unwrap();
    assert_eq!(told.into_inner(), 12);
}

/// Shards in any order, thread counts, one process: the same bytes.
#[test]
fn results_are_the_same_whoever_computes_them() {
    let plan = swept(TWELVE);
    let merged = |shards: &[&str], threads: usize| {
        let place = tempfile::tempdir().unwrap();
        let store = Store::new(place.path());
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let computed: usize =
            pool.install(|| shards.iter().map(|shard| ran(&plan, shard, &store).computed).sum());
        assert_eq!(computed, 12);
        let merged = merge(&plan, &store, false).unwrap();
        (merged.csv(), serde_json::to_string(&merged).unwrap())
    };
    let whole = merged(&["1/1"], 1);
    assert_eq!(whole, merged(&["3/3", "1/3", "2/3"], 4));
    assert_eq!(whole, merged(&["1/2", "2/2", "1/1"], 2));
    assert_eq!(whole.0.lines().count(), 13);
}

#[test]
fn what_is_missing_damaged_or_foreign_is_named() {
    let plan = swept(TWELVE);
    let place = tempfile::tempdir().unwrap();
    let store = Store::new(place.path());
    ran(&plan, "1/2", &store);
    let error = merge(&plan, &store, false).unwrap_err().to_string();
    let lost = plan.cases.iter().position(|case| store.get(&case.key).0 == State::Missing).unwrap();
    let named = format!("case {}, high ", lost + 1);
    assert!(error.contains("cases without a result: 6;") && error.contains(&named), "{error}");
    assert!(error.contains(&plan.cases[lost].key), "{error}");
    assert!(error.contains("and 1 more") && error.contains("--partial"), "{error}");
    assert_eq!(merge(&plan, &store, true).unwrap().cases.len(), 6);
    assert_eq!(ran(&plan, "1/1", &store).computed, 6);
    // one is cut off
    let key = &plan.cases[4].key;
    let path = place.path().join("results").join(&key[..2]).join(key);
    let text = Source::read(&path).unwrap().text;
    write_atomic(&path, &text.as_bytes()[..text.len() / 2]).unwrap();
    let error = merge(&plan, &store, false).unwrap_err().to_string();
    assert!(error.contains("cut off or altered: 1;") && error.contains(key.as_str()), "{error}");
    assert_eq!(store.get(key).0, State::Damaged);
    let again = ran(&plan, "1/1", &store);
    assert_eq!((again.computed, again.damaged), (1, vec![key.clone()]));
    assert_eq!(Source::read(&path).unwrap().text, text);
    // one is forgotten, what is not there as well
    for _ in 0..2 {
        store.forget(key).unwrap();
    }
    assert_eq!(store.get(key).0, State::Missing);
    assert_eq!(ran(&plan, "1/1", &store).computed, 1);
    assert_eq!(Source::read(&path).unwrap().text, text);
    // a result of another sweep
    ran(&swept("(field: \"low\", values: [0.25])"), "1/1", &store);
    let error = merge(&plan, &store, false).unwrap_err().to_string();
    assert!(error.contains("no case of this sweep: 1;"), "{error}");
    assert_eq!(merge(&plan, &store, true).unwrap().cases.len(), 12);
    // what a killed process was writing is no result
    write_atomic(&path.with_file_name(".hhc-x"), b"{").unwrap();
    assert_eq!(status(&store, &plan).foreign.len(), 1);
}

proptest! {
    /// Any bytes for a sweep file, a result or a value are an error or a value, never a panic.
    #[test]
    fn no_text_panics(at in 0_usize..200, byte in any::<u8>(), cut in 0_usize..200) {
        let whole = format!("(base: \"b\", axes: [{TWELVE}], sampling: LatinHypercube(count: 5, seed: 1))");
        let mut bytes = whole.into_bytes();
        let at = at % bytes.len();
        bytes[at] = byte;
        bytes.truncate(bytes.len() - cut % 40 * usize::from(cut.is_multiple_of(3)));
        if let Ok(plan) = planned(&String::from_utf8_lossy(&bytes)) {
            prop_assert!(!plan.cases.is_empty());
        }
    }

    #[test]
    fn any_value_is_taken_or_refused(value in "\\PC{0,12}") {
        let runner = ToyRunner::default();
        let of = Source { name: "s".into(), text: "(base: \"b\", axes: [(field: \"low\", values: [0.5])])".into() };
        let mut file = read_sweep_file(&of, &Folder::Disk("none".into())).unwrap();
        file.axes[0].values = crate::AxisValues::List(vec![(value, file.axes[0].place.clone())]);
        let base = runner.read(BASE).unwrap().canonical;
        if let Ok(plan) = plan(&file, base, &runner) {
            prop_assert_eq!(plan.cases.len(), 1);
        }
    }
}

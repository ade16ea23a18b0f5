//! The regression sweep: what it must see, what it may rewrite, and how it reports.
#![expect(clippy::disallowed_methods, reason = "tests read and write golden files")]
#![expect(clippy::unwrap_used, reason = "a helper that fails is a test that fails")]

use std::collections::BTreeSet;
use std::path::Path;

use xtask::regress::{
    Difference, Filter, GUARDED_CHANGE, HUB_LOADS, Mode, Report, Snapshot, SweepInflow, SweepPoint,
    SweepResult, Tolerance, TrimChannels, Verdict, all_points, compare, run, unfit_for_a_golden,
};
use xtask::workspace;

#[derive(Debug, thiserror::Error)]
#[error("no trim after {iterations} iterations")]
struct NoTrim {
    iterations: usize,
}

/// A result of the size the rotor gives, different at every point.
fn plausible(point: SweepPoint) -> SweepResult {
    let seed = point.advance_ratio + 0.01 * f64::from(point.harmonic_per_rev);
    let loads = |scale: f64| std::array::from_fn(|i| scale * (seed + i as f64).sin());
    SweepResult {
        trim: TrimChannels {
            theta0_deg: 7.0 + seed,
            theta1c_deg: 1.0 + seed,
            theta1s_deg: -4.0 - seed,
            alpha_s_deg: 5.0 * seed,
            phi_s_deg: -2.0 * seed,
            inflow: 0.03 * seed,
        },
        baseline_loads: loads(1e-4),
        controlled_loads: loads(3e-5),
        j_before: 1e-8 * seed,
        j_after: 2e-9 * seed,
        t_matrix_norm_per_volt: 1e-6 * seed,
        counts: vec![("trim_iterations", 6), ("control_steps", 4)],
    }
}

#[expect(clippy::unnecessary_wraps, reason = "stands where a program that can fail stands")]
fn computed(point: SweepPoint) -> Result<SweepResult, NoTrim> {
    Ok(plausible(point))
}

const POINT: SweepPoint =
    SweepPoint { advance_ratio: 0.30, harmonic_per_rev: 3, inflow: SweepInflow::Drees };

fn snapshot() -> Snapshot {
    plausible(POINT).snapshot(POINT)
}

fn everything() -> Filter {
    Filter::parse("").unwrap()
}

/// All goldens of the plausible sweep, in a folder of their own.
fn blessed() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let report = run(folder.path(), Mode::Bless, &everything(), computed).unwrap();
    assert_eq!(report.cases.len(), 29);
    assert!(report.cases.iter().all(|case| matches!(case.verdict, Verdict::Blessed(_))));
    folder
}

fn compared(folder: &Path) -> Report {
    run(folder, Mode::Compare, &everything(), computed).unwrap()
}

/// Every channel of a snapshot, moved by a share of itself, is the only difference and is named.
fn every_channel_is_guarded(golden: &Snapshot) -> usize {
    let mut guarded = 0;
    for group in 0..golden.groups.len() {
        for channel in 0..golden.groups[group].channels.len() {
            for share in [GUARDED_CHANGE, -GUARDED_CHANGE] {
                let mut moved = golden.clone();
                let (name, value) = &mut moved.groups[group].channels[channel];
                *value *= 1.0 + share;
                let name = format!("{}: {name}", golden.groups[group].name);
                let zero = golden.groups[group].channels[channel].1 == 0.0;
                let differences = compare(&moved, golden);
                assert_eq!(differences.len(), usize::from(!zero), "{name}: {differences:?}");
                let named = matches!(
                    differences.first(),
                    Some(Difference::Moved { channel, .. }) if *channel == name
                );
                assert!(zero || named, "{name}: {differences:?}");
            }
            guarded += 1;
        }
    }
    guarded
}

#[test]
fn a_change_of_one_percent_of_any_channel_is_named() {
    assert_eq!(every_channel_is_guarded(&snapshot()), 6 + 12 + 12 + 2 + 1 + 2);
}

#[test]
fn the_shipped_goldens_guard_every_channel() {
    let folder = workspace::root().join("fixtures/golden");
    for point in all_points() {
        let path = folder.join(point.file_name());
        let text = std::fs::read_to_string(&path).unwrap_or_else(|error| {
            panic!("{}: {error}; `cargo xtask regress --bless` writes it", path.display())
        });
        let golden = Snapshot::from_ron(&text).unwrap();
        assert_eq!(unfit_for_a_golden(&golden), [], "{}", path.display());
        let channels = every_channel_is_guarded(&golden);
        assert!(channels >= 34, "{}: only {channels} channels", path.display());
    }
}

#[test]
fn what_is_within_tolerance_passes() {
    let golden = snapshot();
    let mut now = golden.clone();
    for group in &mut now.groups {
        if group.tolerance != Tolerance::Exact {
            group.channels.iter_mut().for_each(|(_, value)| *value *= 1.0 + 5e-4);
        }
    }
    assert_eq!(compare(&golden, &now), []);
}

#[test]
fn counts_are_exact() {
    let golden = snapshot();
    let mut result = plausible(POINT);
    result.counts[1].1 += 1;
    let differences = compare(&golden, &result.snapshot(POINT));
    let [Difference::Moved { channel, golden, now, .. }] = differences.as_slice() else {
        panic!("{differences:?}")
    };
    assert_eq!((channel.as_str(), *golden, *now), ("solver statistics: control_steps", 4.0, 5.0));
}

#[test]
fn what_is_no_number_fails_on_either_side() {
    for bad in [f64::NAN, f64::INFINITY] {
        let good = snapshot();
        let mut broken = good.clone();
        broken.groups[2].channels[0].1 = bad;
        for (golden, now) in [(&good, &broken), (&broken, &good), (&broken, &broken)] {
            let differences = compare(golden, now);
            assert!(
                matches!(differences.as_slice(), [Difference::NotFinite { .. }]),
                "{differences:?}"
            );
        }
        assert!(matches!(unfit_for_a_golden(&broken).as_slice(), [Difference::NotFinite { .. }]));
    }
}

#[test]
fn channels_that_come_go_or_stand_twice_are_named() {
    let golden = snapshot();
    let mut now = golden.clone();
    now.groups[0].channels[1].0 = "theta_new_deg".to_owned();
    let differences = compare(&golden, &now);
    assert_eq!(
        differences,
        [
            Difference::Gone { channel: "trim angles: theta1c_deg".to_owned() },
            Difference::New { channel: "trim angles: theta_new_deg".to_owned() },
        ]
    );
    let mut twice = golden.clone();
    let again = twice.groups[0].channels[0].clone();
    twice.groups[0].channels.push(again);
    assert!(matches!(compare(&twice, &golden).as_slice(), [Difference::Twice { .. }]));
}

#[test]
fn a_golden_cannot_loosen_its_own_tolerance() {
    let now = snapshot();
    let mut golden = now.clone();
    golden.groups[0].tolerance = Tolerance::Scaled { relative: 0.5, absolute: 1.0 };
    golden.groups[0].channels[0].1 *= 1.02;
    let differences = compare(&golden, &now);
    assert!(
        matches!(
            differences.as_slice(),
            [Difference::Label { what, .. }, Difference::Moved { .. }]
                if what == "tolerance of trim angles"
        ),
        "{differences:?}"
    );
}

#[test]
fn a_golden_of_another_case_differs() {
    let other = SweepPoint { harmonic_per_rev: 4, ..POINT };
    let differences = compare(&plausible(POINT).snapshot(other), &snapshot());
    assert!(matches!(differences.as_slice(), [Difference::Label { .. }]), "{differences:?}");
}

#[test]
fn a_value_below_its_floor_cannot_become_golden() {
    let mut result = plausible(POINT);
    result.baseline_loads[4] = 1e-14;
    let unfit = unfit_for_a_golden(&result.snapshot(POINT));
    let [Difference::Blind { channel, .. }] = unfit.as_slice() else { panic!("{unfit:?}") };
    assert!(channel.contains(HUB_LOADS[4]), "{channel}");
    // an exact zero has no share of itself to lose
    result.baseline_loads[4] = 0.0;
    assert_eq!(unfit_for_a_golden(&result.snapshot(POINT)), []);
}

#[test]
fn text_keeps_every_bit() {
    let golden = snapshot();
    let text = golden.to_ron().unwrap();
    assert_eq!(Snapshot::from_ron(&text).unwrap(), golden);
    assert!(text.contains("m0 Omega^2 R^3") && text.contains("relative: 0.001"), "{text}");
    assert!(Snapshot::from_ron(&text.replace("groups", "grups")).is_err());
}

#[test]
fn an_unchanged_program_agrees_with_its_goldens() {
    let folder = blessed();
    let report = compared(folder.path());
    assert_eq!(report.exit_code(), 0);
    assert!(report.text().starts_with("29 of 29 cases"), "{}", report.text());
}

#[test]
fn a_changed_golden_makes_exit_code_3_and_is_named() {
    let folder = blessed();
    let path = folder.path().join(POINT.file_name());
    let mut golden = Snapshot::from_ron(&std::fs::read_to_string(&path).unwrap()).unwrap();
    golden.groups[3].channels[2].1 *= 1.01;
    std::fs::write(&path, golden.to_ron().unwrap()).unwrap();
    let report = compared(folder.path());
    assert_eq!(report.exit_code(), 3);
    let text = report.text();
    assert!(text.contains("mu=0.30,n=3") && text.contains("my_cos"), "{text}");
    assert!(text.contains("-0.990 %") && text.contains("m0 Omega^2 R^3"), "{text}");
    assert!(text.contains("28 of 29 cases") && text.contains("1 different"), "{text}");
    // another case does not care
    let others = Filter::parse("mu=0.30,n=2,n=4,n=5").unwrap();
    assert_eq!(run(folder.path(), Mode::Compare, &others, computed).unwrap().exit_code(), 0);
}

#[test]
fn missing_unreadable_and_orphaned_goldens_fail() {
    let folder = blessed();
    std::fs::remove_file(folder.path().join("mu010_n2.ron")).unwrap();
    std::fs::write(folder.path().join("mu015_n2.ron"), "(advance_ratio: 0.15,").unwrap();
    std::fs::write(folder.path().join("mu040_n2.ron"), "").unwrap();
    let report = compared(folder.path());
    assert_eq!(report.exit_code(), 3);
    let text = report.text();
    for part in ["missing", "mu=0.15,n=2", "mu040_n2.ron", "no case of the sweep", "1:"] {
        assert!(text.contains(part), "{part}: {text}");
    }
}

#[test]
fn blessing_rewrites_what_changed_and_nothing_else() {
    let folder = blessed();
    let untouched = folder.path().join("mu035_n5.ron");
    // within tolerance, but not the text that would be written now
    let marked = std::fs::read_to_string(&untouched).unwrap() + "// a mark\n";
    std::fs::write(&untouched, &marked).unwrap();
    let changed = |point: SweepPoint| -> Result<SweepResult, NoTrim> {
        let mut result = plausible(point);
        if point == POINT {
            result.j_after *= 1.5;
        }
        Ok(result)
    };
    let report = run(folder.path(), Mode::Bless, &everything(), changed).unwrap();
    assert_eq!(report.exit_code(), 0);
    let blessed: BTreeSet<&str> = report
        .cases
        .iter()
        .filter(|case| matches!(case.verdict, Verdict::Blessed(_)))
        .map(|case| case.case.as_str())
        .collect();
    assert_eq!(blessed, BTreeSet::from(["mu=0.30,n=3"]));
    assert_eq!(std::fs::read_to_string(&untouched).unwrap(), marked);
    assert_eq!(run(folder.path(), Mode::Compare, &everything(), changed).unwrap().exit_code(), 0);
    // nothing is left behind by the atomic writes
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 29);
}

#[test]
fn a_broken_result_is_not_blessed() {
    let folder = blessed();
    let before = std::fs::read_to_string(folder.path().join(POINT.file_name())).unwrap();
    let broken = |point: SweepPoint| -> Result<SweepResult, NoTrim> {
        let mut result = plausible(point);
        result.j_before = f64::NAN;
        Ok(result)
    };
    let report = run(folder.path(), Mode::Bless, &everything(), broken).unwrap();
    assert_eq!(report.exit_code(), 3);
    let after = std::fs::read_to_string(folder.path().join(POINT.file_name())).unwrap();
    assert_eq!(before, after);
}

#[test]
fn a_case_that_cannot_be_computed_is_exit_code_1_and_the_others_are_still_compared() {
    let folder = blessed();
    let failing = |point: SweepPoint| {
        if point == POINT { Err(NoTrim { iterations: 40 }) } else { Ok(plausible(point)) }
    };
    let report = run(folder.path(), Mode::Compare, &everything(), failing).unwrap();
    assert_eq!(report.exit_code(), 1);
    let text = report.text();
    assert!(text.contains("mu=0.30,n=3: not computed: no trim after 40 iterations"), "{text}");
    assert!(text.contains("28 of 29"), "{text}");
}

#[test]
fn the_report_does_not_depend_on_the_number_of_threads() {
    let folder = blessed();
    let shifted = |point: SweepPoint| -> Result<SweepResult, NoTrim> {
        let mut result = plausible(point);
        result.trim.theta0_deg += 0.1 * point.advance_ratio;
        Ok(result)
    };
    let text = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(folder.path(), Mode::Compare, &everything(), shifted).unwrap().text())
    };
    assert_eq!(text(1), text(3));
}

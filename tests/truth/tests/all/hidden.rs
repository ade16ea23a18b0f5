//! The sets with hidden effects: strength, noise, limits, convergence, seeds.
#![expect(clippy::unwrap_used, reason = "a helper that fails fails its test")]

use std::collections::{BTreeMap, BTreeSet};

use truth::hidden::{
    Assignment, BASES, BLOCK, BaseActuator, Cause, Character, EXPERIMENTS, Exact, Hidden, Outside,
    PAIRS, Physics, Prepared, Request, Size, Truth, measured, measured_set, noise_um,
    reference_files, truth,
};

/// Every single effect there is.
fn singles() -> Vec<Hidden> {
    let library = Cause::ALL.into_iter().map(Hidden::One);
    library.chain(Outside::ALL.into_iter().map(Hidden::Other)).collect()
}

fn request(hidden: Hidden, base: u64, share: f64) -> Request {
    Request { hidden: Some(hidden), base: Some(base), share: Some(share), ..Request::new(11, 40.0) }
}

fn rms(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(s, n), v| (s + v * v, n + 1.0));
    f64::sqrt(sum / count)
}

fn rms_change(a: &Exact, b: &Exact) -> f64 {
    rms(a.displacement_um.iter().zip(&b.displacement_um).map(|(a, b)| a - b))
}

/// Rms change over rms output, all runs but the one without input with equal weight.
fn share(truth: &Truth) -> f64 {
    let driven: Vec<usize> =
        (0..truth.plans.len()).filter(|i| !truth.plans[*i].id.starts_with("zero_input")).collect();
    let change = rms(driven.iter().map(|i| rms_change(&truth.with[*i], &truth.without[*i])));
    change / rms(driven.iter().map(|i| rms(truth.without[*i].displacement_um.iter().copied())))
}

#[test]
fn an_effect_has_the_strength_asked_for() {
    for hidden in singles() {
        for (base, aim) in [(7, 0.02), (9, 0.05)] {
            let set = truth(&request(hidden, base, aim), 1).unwrap();
            let found = share(&set);
            let id = hidden.id();
            assert!((found / aim - 1.0).abs() < 0.04, "{id} on {base}: {found} instead of {aim}");
            let stated = set.effects[0].effect_share;
            assert!((stated / found - 1.0).abs() < 1e-9, "{id}: stated {stated}, found {found}");
        }
    }
}

#[test]
fn the_recommended_runs_reach_the_greatest_strength() {
    for hidden in singles() {
        let found = share(&truth(&request(hidden, 1, 0.08), 1).unwrap());
        assert!((found / 0.08 - 1.0).abs() < 0.04, "{}: {found} instead of 8 %", hidden.id());
    }
}

#[test]
fn an_effect_of_strength_zero_is_none() {
    let actuator = BaseActuator::new(0);
    let plans = measured(0, Size::Small);
    for plan in plans.iter().filter(|plan| plan.id != "warm_up") {
        let run = Prepared::new(&actuator, plan, 3, 1).unwrap();
        let without = run.with(&[]).unwrap();
        for hidden in singles() {
            let character = &Character::of_seed(hidden, 4)[0];
            let largest = |strength: f64| {
                let with = run.with(&[&character.with_strength(strength).0]).unwrap();
                let pairs = with.displacement_um.iter().zip(&without.displacement_um);
                pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            let (none, some) = (largest(1e-13), largest(character.strength_range().1));
            let id = hidden.id();
            // A relay may switch one step earlier or later: 0.1 um.
            assert!(none < 0.1, "{id} in {}: {none} um", plan.id);
            assert!(some > 100.0 * none, "{id} in {}: {none}, {some} um", plan.id);
        }
    }
}

/// Halving the step changes the records by less than a tenth of the noise at 40 dB, rms of a run.
#[test]
fn the_internal_step_is_fine_enough() {
    for (index, hidden) in singles().into_iter().enumerate() {
        // Strength from a small design; the runs of all three families in turn.
        let strong = truth(&request(hidden, 7, 0.05), 1).unwrap();
        let physics: Vec<&Physics> = strong.physics.iter().collect();
        let base = [0, 1, 3][index % 3];
        let actuator = BaseActuator::new(base);
        let limit = 0.1 * noise_um(base, 40.0).unwrap();
        for plan in &measured(base, Size::Small) {
            let at = |finer: u32| Prepared::new(&actuator, plan, 5, finer).unwrap().with(&physics);
            let change = rms_change(&at(1).unwrap(), &at(2).unwrap());
            assert!(change < limit, "{} on {base}, {}: {change} um", hidden.id(), plan.id);
        }
    }
}

fn displacement(csv: &str) -> Vec<f64> {
    csv.lines().skip(1).map(|line| line.split(',').nth(2).unwrap().parse().unwrap()).collect()
}

#[test]
fn the_noise_has_the_stated_level_at_every_ratio() {
    for snr_db in [40.0, 30.0, 20.0] {
        let asked = Request { snr_db, ..request(Hidden::One(Cause::Creep), 0, 0.05) };
        let (set, exact) = (measured_set(&asked).unwrap(), truth(&asked, 1).unwrap());
        let mut noise = Vec::new();
        for (plan, run) in exact.plans.iter().zip(&exact.with) {
            let name = format!("{}.csv", plan.id);
            let (_, text) = set.files.iter().find(|(file, _)| *file == name).unwrap();
            let read = displacement(text);
            assert_eq!(read.len(), run.displacement_um.len());
            noise.extend(read.iter().zip(&run.displacement_um).map(|(read, y)| read - y));
        }
        let level = rms(noise.iter().copied());
        // 30 000 samples with a little memory: 0.5 % standard error.
        let stated = set.answer.noise_um;
        assert!((level / stated - 1.0).abs() < 0.02, "{level} um, stated {stated} um");
        // The coloured part: 15 % of the variance, correlated over 20 ms.
        let products = noise.iter().zip(&noise[1..]).map(|(a, b)| a * b);
        let correlation = products.sum::<f64>() / noise.len() as f64 / (level * level);
        assert!((0.11..0.17).contains(&correlation), "{correlation} from sample to sample");
    }
    let at = |snr_db| noise_um(3, snr_db).unwrap();
    assert!((at(20.0) / at(40.0) - 10.0).abs() < 1e-9);
}

#[test]
fn a_seed_is_a_set_and_the_reference_is_that_of_its_base() {
    let first = measured_set(&Request::new(5, 30.0)).unwrap();
    assert_eq!(first, measured_set(&Request::new(5, 30.0)).unwrap());
    let other = measured_set(&Request { base: Some(first.answer.base), ..Request::new(6, 30.0) });
    for ((name, a), (_, b)) in first.files.iter().zip(&other.unwrap().files) {
        assert!(name == "dataset.ron" || displacement(a) != displacement(b), "{name}");
    }
    let reference = |snr_db| reference_files(2, snr_db, Size::Small).unwrap();
    assert_eq!(reference(30.0), reference(30.0));
    for ((name, a), (_, b)) in reference(30.0).iter().zip(&reference(40.0)) {
        assert!(name == "dataset.ron" || displacement(a) != displacement(b), "{name}");
    }
}

#[test]
fn nothing_in_a_folder_tells_what_is_hidden() {
    let folder = |hidden| measured_set(&request(hidden, 4, 0.05)).unwrap().files;
    let (null, lag) = (folder(Hidden::Null), folder(Hidden::One(Cause::ElectricalLag)));
    for ((name, a), (other_name, b)) in null.iter().zip(&lag) {
        assert_eq!(name, other_name);
        let visible = |text: &str| -> Vec<String> {
            let cells = |line: &str| line.split(',').take(2).collect::<Vec<_>>().join(",");
            text.lines().map(cells).collect()
        };
        assert_eq!(visible(a), visible(b), "{name}: all but the displacement is the same");
        for hidden in singles() {
            assert!(!b.contains(&hidden.id()), "{name} names {}", hidden.id());
        }
    }
}

#[test]
fn a_block_of_seeds_is_balanced_and_ten_blocks_meet_ten_bases() {
    let mut bases: BTreeMap<String, BTreeSet<u64>> = BTreeMap::new();
    for block in 0..10 {
        let mut counts: BTreeMap<String, u32> = BTreeMap::new();
        for seed in block * BLOCK..(block + 1) * BLOCK {
            let assignment = Assignment::of_seed(seed);
            *counts.entry(assignment.hidden.id()).or_default() += 1;
            assert!(assignment.base < BASES);
            assert!(assignment.shares.iter().all(|share| (0.01..=0.08).contains(share)));
            assert_eq!(
                assignment.shares.len(),
                assignment.hidden.id().split('+').count()
                    - usize::from(assignment.hidden == Hidden::Null)
            );
            bases.entry(assignment.hidden.id()).or_default().insert(assignment.base);
        }
        assert_eq!(counts["null"], 10);
        for cause in Cause::ALL {
            assert_eq!(counts[cause.id()], 1, "{}", cause.id());
        }
        let pairs: u32 =
            PAIRS.iter().filter_map(|(a, b)| counts.get(&Hidden::Two(*a, *b).id())).sum();
        let outside: u32 = Outside::ALL.iter().filter_map(|o| counts.get(o.id())).sum();
        assert_eq!((pairs, outside), (4, 4));
    }
    for cause in Cause::ALL {
        assert_eq!(bases[cause.id()].len(), 10, "{}", cause.id());
    }
    for (a, b) in PAIRS {
        assert!(bases.contains_key(&Hidden::Two(a, b).id()), "pair {} and {}", a.id(), b.id());
    }
    // The order differs from block to block.
    let order = |block: u64| -> Vec<Hidden> {
        (block * BLOCK..(block + 1) * BLOCK).map(|s| Assignment::of_seed(s).hidden).collect()
    };
    assert_ne!(order(0), order(30));
}

#[test]
fn every_experiment_adds_to_the_same_truth() {
    let own = request(Hidden::One(Cause::TransportDelay), 5, 0.04);
    let before = measured_set(&own).unwrap();
    for id in EXPERIMENTS {
        let asked = Request { experiment: Some(id.to_owned()), ..own.clone() };
        let after = measured_set(&asked).unwrap();
        assert_eq!(after.answer.effects, before.answer.effects, "{id}");
        let header = |set: &truth::hidden::MeasuredSet| {
            set.files[0].1.lines().next().unwrap_or_default().to_owned()
        };
        let more = after.files.len() > before.files.len() || header(&after) != header(&before);
        assert!(more, "{id} adds neither run nor column");
        assert_ne!(displacement(&after.files[0].1), displacement(&before.files[0].1), "{id}");
    }
    let unknown = Request { experiment: Some("laser-pointer".to_owned()), ..own };
    let message = measured_set(&unknown).unwrap_err().to_string();
    assert!(message.contains("laser-pointer") && message.contains("ring-down"), "{message}");
}

#[test]
fn names_are_read_back_and_an_unknown_one_is_refused() {
    let pairs = PAIRS.into_iter().map(|(a, b)| Hidden::Two(a, b));
    for hidden in singles().into_iter().chain(pairs).chain([Hidden::Null]) {
        assert_eq!(Hidden::parse(&hidden.id()).unwrap(), hidden);
    }
    let message = Hidden::parse("creeps").unwrap_err().to_string();
    assert!(message.contains("creeps") && message.contains("mains-hum"), "{message}");
}

#[test]
fn the_pages_name_every_cause_and_every_experiment() {
    let catalogue = include_str!("../../EXPERIMENTS.md");
    let book = include_str!("../../../../docs/src/hidden-effects.md");
    for id in EXPERIMENTS {
        assert!(catalogue.contains(&format!("| `{id}` |")), "EXPERIMENTS.md lacks {id}");
        assert!(book.contains(&format!("| `{id}` |")), "the book lacks {id}");
    }
    for cause in Cause::ALL {
        assert!(catalogue.contains(cause.id()), "EXPERIMENTS.md lacks {}", cause.id());
    }
}

//! The metrics of the suite, each with its bar and the number of cases behind it.

use std::collections::BTreeMap;

use crate::binomial::Share;
use crate::case::Case;
use crate::findings::{Findings, Verdict};

/// What a metric has to reach.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Bar {
    /// That much or less.
    AtMost(f64),
    /// That much or more.
    AtLeast(f64),
    /// Between both.
    Within(f64, f64),
    /// Shown for the reader, no bar.
    Shown,
}

/// What was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Figure {
    /// A share of cases.
    Share(Share),
    /// A number from so many cases.
    Number {
        /// The number.
        value: f64,
        /// Cases behind it.
        cases: u64,
    },
}

/// One metric.
#[derive(Debug, Clone, PartialEq)]
pub struct Metric {
    /// What it says.
    pub name: String,
    /// What was measured.
    pub figure: Figure,
    /// What it has to reach.
    pub bar: Bar,
}

/// Whether a metric reaches its bar.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// It does.
    Met,
    /// It does not.
    Missed,
    /// There is no case, or no bar.
    Open,
}

impl Metric {
    /// Whether the measured figure (not its bounds) reaches the bar.
    pub fn outcome(&self) -> Outcome {
        let (value, cases) = match self.figure {
            Figure::Share(share) => (share.value(), share.cases),
            Figure::Number { value, cases } => (value, cases),
        };
        let met = match self.bar {
            Bar::AtMost(bar) => value <= bar,
            Bar::AtLeast(bar) => value >= bar,
            Bar::Within(low, high) => (low..=high).contains(&value),
            Bar::Shown => return Outcome::Open,
        };
        match (cases, met) {
            (0, _) => Outcome::Open,
            (_, true) => Outcome::Met,
            (_, false) => Outcome::Missed,
        }
    }
}

/// Effects so many times above the floor count as visible.
const VISIBLE: f64 = 2.5;

/// Error of a refit below this share of the error before is taken for no gain to compare with.
const LEAST_ORACLE_GAIN: f64 = 0.05;

/// All metrics of a suite.
pub fn metrics(cases: &[Case]) -> Vec<Metric> {
    let floors = Floors::of(cases);
    let mut all = false_alarms(cases);
    all.extend(names(cases, &floors));
    all.extend(outside_and_friction(cases));
    all.extend(parameters(cases));
    all.extend(gains(cases));
    all.extend(experiments_and_pairs(cases, &floors));
    all.extend(times(cases));
    all
}

pub(crate) fn share(name: &str, bar: Bar, outcomes: impl Iterator<Item = bool>) -> Metric {
    Metric { name: name.to_owned(), figure: Figure::Share(Share::of(outcomes)), bar }
}

pub(crate) fn number(name: &str, bar: Bar, value: f64, cases: usize) -> Metric {
    Metric { name: name.to_owned(), figure: Figure::Number { value, cases: cases as u64 }, bar }
}

/// What the base model leaves on sets without effect: median held-out error by design and noise, um.
#[derive(Debug)]
pub struct Floors(BTreeMap<(String, u64), f64>);

impl Floors {
    /// The floors of a suite.
    pub fn of(cases: &[Case]) -> Self {
        let mut errors: BTreeMap<(String, u64), Vec<f64>> = BTreeMap::new();
        for case in cases.iter().filter(|case| case.is_null()) {
            if let Some(gain) = &case.findings.gain {
                errors.entry(Self::key(case)).or_default().push(gain.heldout_rms_before);
            }
        }
        Self(errors.into_iter().map(|(key, mut values)| (key, median(&mut values))).collect())
    }

    /// The floor of a case, um: that of its design and noise, at least the noise itself.
    pub fn floor_um(&self, case: &Case) -> f64 {
        let noise = case.answer.noise_um;
        self.0.get(&Self::key(case)).map_or(noise, |floor| floor.max(noise))
    }

    fn key(case: &Case) -> (String, u64) {
        let monitored = if case.answer.monitored { " with monitors" } else { "" };
        (format!("{}{monitored}", case.answer.design), case.answer.snr_db.to_bits())
    }

    /// Whether each of the hidden effects alone stands well above the floor.
    fn shows(&self, case: &Case) -> bool {
        let floor = self.floor_um(case);
        case.answer.effects.iter().all(|effect| effect.effect_um >= VISIBLE * floor)
    }
}

/// The middle one of some numbers, sorting them; NaN of none.
pub(crate) fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    match values.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => values[n / 2],
        n => 0.5 * (values[n / 2 - 1] + values[n / 2]),
    }
}

fn quiet(case: &Case) -> bool {
    case.answer.snr_db > 25.0
}

fn false_alarms(cases: &[Case]) -> Vec<Metric> {
    let null = || cases.iter().filter(|case| case.is_null()).map(|case| &case.findings);
    let said = |found: &Findings| !found.names().is_empty();
    vec![
        share("null: confident name", Bar::AtMost(0.01), null().map(Findings::is_confident)),
        share("null: any name", Bar::AtMost(0.03), null().map(said)),
        share(
            "null: unknown cause claimed",
            Bar::Shown,
            null().map(|found| found.verdict == Verdict::Unknown),
        ),
    ]
}

fn names(cases: &[Case], floors: &Floors) -> Vec<Metric> {
    let single = || cases.iter().filter_map(|case| Some((case, case.single()?)));
    let confident = || single().filter(|(case, _)| case.findings.is_confident());
    let right = |(case, cause): (&Case, &str)| {
        case.findings.causes.first().is_some_and(|name| case.right(cause, name))
    };
    let exact =
        |(case, cause): (&Case, &str)| case.findings.causes.first().is_some_and(|n| n == cause);
    let named = || single().filter(|(case, _)| !case.findings.names().is_empty());
    let strong = || {
        single().filter(|(case, _)| {
            case.answer.snr_db > 35.0 && !case.is_friction() && floors.shows(case)
        })
    };
    let recommended = |case: &Case| case.answer.design == "recommended";
    let sizes: Vec<f64> = named()
        .filter(|(case, _)| recommended(case))
        .map(|(case, _)| case.findings.names().len() as f64)
        .collect();
    let mean_size = sizes.iter().sum::<f64>() / sizes.len() as f64;
    vec![
        share(
            "confident: right class, 40 and 30 dB",
            Bar::AtLeast(0.97),
            confident().filter(|(case, _)| quiet(case)).map(right),
        ),
        share(
            "confident: right class, 20 dB",
            Bar::AtLeast(0.93),
            confident().filter(|(case, _)| !quiet(case)).map(right),
        ),
        share("confident: exact name", Bar::Shown, confident().map(exact)),
        share(
            "confident, of all single causes",
            Bar::Shown,
            single().map(|(case, _)| case.findings.is_confident()),
        ),
        share(
            "named: truth in the set",
            Bar::AtLeast(0.98),
            named().map(|(case, cause)| case.findings.names().iter().any(|name| name == cause)),
        ),
        share(
            "effect >= 2.5 floors, 40 dB: named",
            Bar::AtLeast(0.95),
            strong().map(|(case, cause)| case.in_names(cause)),
        ),
        share(
            "  the same, recommended runs",
            Bar::Shown,
            strong()
                .filter(|(case, _)| recommended(case))
                .map(|(case, cause)| case.in_names(cause)),
        ),
        number("mean size of the set, recommended runs", Bar::AtMost(1.5), mean_size, sizes.len()),
    ]
}

fn outside_and_friction(cases: &[Case]) -> Vec<Metric> {
    let outside = |calm: bool| {
        cases
            .iter()
            .filter(move |case| case.is_outside() && quiet(case) == calm)
            .map(|case| case.findings.is_confident())
    };
    let friction = || {
        cases
            .iter()
            .filter_map(|case| Some((case, case.single()?)))
            .filter(|(case, _)| case.is_friction())
    };
    let missed = || friction().filter(|(case, cause)| !case.in_names(cause));
    vec![
        share(
            "outside the library: confident name, 40 and 30 dB",
            Bar::AtMost(0.02),
            outside(true),
        ),
        share("outside the library: confident name, 20 dB", Bar::AtMost(0.05), outside(false)),
        share(
            "backlash or friction: named",
            Bar::Shown,
            friction().map(|(case, cause)| case.in_names(cause)),
        ),
        share(
            "backlash or friction missed: listed as not observable",
            Bar::AtLeast(0.95),
            missed().map(|(case, cause)| case.findings.not_observable.iter().any(|id| id == cause)),
        ),
    ]
}

/// The value against which the error of a parameter is stated: its own, for voltages the range of the actuator.
fn scale_of(unit: &str, value: f64) -> f64 {
    if unit == "V" { 170.0 } else { value.abs() }
}

fn parameters(cases: &[Case]) -> Vec<Metric> {
    let mut errors = Vec::new();
    let mut covered = Vec::new();
    for case in cases.iter().filter(|case| case.findings.is_confident()) {
        for effect in &case.answer.effects {
            let Some(found) = case.findings.parameters.get(&effect.id) else { continue };
            for (name, truth) in &effect.parameters {
                let Some(estimate) = found.get(name) else { continue };
                let miss = (estimate.value - truth.value).abs();
                errors.push(miss / scale_of(&truth.unit, truth.value));
                let [low, high] = estimate.ci95;
                covered.push((low..=high).contains(&truth.value));
            }
        }
    }
    let count = errors.len();
    vec![
        number(
            "confident: median error of parameters",
            Bar::AtMost(0.05),
            median(&mut errors),
            count,
        ),
        share(
            "confident: 95 % intervals of parameters cover",
            Bar::Within(0.90, 0.98),
            covered.into_iter(),
        ),
    ]
}

fn gains(cases: &[Case]) -> Vec<Metric> {
    let mut ratios = Vec::new();
    let (mut reached, mut possible) = (0.0, 0.0);
    for case in cases.iter().filter(|case| !case.findings.names().is_empty()) {
        let (Some(oracle), Some(gain)) = (&case.oracle, &case.findings.gain) else { continue };
        let before = oracle.heldout_rms_before;
        if oracle.reduction() > LEAST_ORACLE_GAIN * before {
            ratios.push(gain.reduction() / oracle.reduction());
            reached += gain.reduction() / before;
            possible += oracle.reduction() / before;
        }
    }
    let count = ratios.len();
    let covered = cases.iter().filter(|case| case.replicates.len() > 2).flat_map(|case| {
        let all: Vec<_> = case.replicates.iter().chain(&case.findings.gain).collect();
        let mean = all.iter().map(|gain| gain.reduction()).sum::<f64>() / all.len() as f64;
        all.into_iter()
            .map(move |gain| (gain.ci95[0]..=gain.ci95[1]).contains(&mean))
            .collect::<Vec<_>>()
    });
    vec![
        number(
            "held-out reduction over that of the true cause",
            Bar::AtLeast(0.80),
            reached / possible,
            count,
        ),
        number("  its median", Bar::Shown, median(&mut ratios), count),
        share("95 % intervals of the gain cover its mean", Bar::Within(0.90, 0.98), covered),
    ]
}

fn experiments_and_pairs(cases: &[Case], floors: &Floors) -> Vec<Metric> {
    let followed = || cases.iter().filter_map(|c| Some((c, c.follow_up.as_ref()?, c.single()?)));
    let alone = followed()
        .map(|(case, after, cause)| matches!(after.names(), [only] if case.right(cause, only)));
    // by the exact id: another member of its class in its place is no smaller set. One name alone always is one
    let shrunk = followed().map(|(case, after, cause)| {
        let is_smaller = after.names().len() < case.findings.names().len();
        is_smaller && after.names().iter().any(|name| name == cause)
    });
    let proposals = cases
        .iter()
        .filter(|case| case.findings.verdict == Verdict::Ambiguous)
        .map(|case| truth::hidden::is_experiment(&case.findings.next_experiment));
    let pairs = || cases.iter().filter(|case| case.causes().len() == 2);
    let visible = || pairs().filter(|case| floors.shows(case));
    let third = |case: &Case| {
        let causes = case.causes();
        let wrong = |name: &String| !causes.iter().any(|cause| case.right(cause, name));
        let listed =
            case.findings.verdict != Verdict::Ambiguous && !case.findings.names().is_empty();
        listed && case.findings.causes.len() > 2 && case.findings.causes.iter().any(wrong)
    };
    vec![
        share("ambiguous: the proposal is in the catalogue", Bar::Shown, proposals),
        share(
            "proposed experiment leaves a smaller set with the truth",
            Bar::AtLeast(0.80),
            shrunk,
        ),
        share("  it leaves one, the right one", Bar::Shown, alone),
        share(
            "two causes >= 2.5 floors: both found",
            Bar::AtLeast(0.80),
            visible().map(|case| case.causes().iter().all(|cause| case.in_names(cause))),
        ),
        share("two causes: a third falsely added", Bar::AtMost(0.03), pairs().map(third)),
    ]
}

fn times(cases: &[Case]) -> Vec<Metric> {
    let mut seconds: Vec<f64> = cases.iter().map(|case| case.seconds).collect();
    let count = seconds.len();
    let middle = median(&mut seconds);
    let first: Vec<f64> = cases.iter().filter_map(|case| case.first_seconds).collect();
    let slowest = first.iter().copied().fold(f64::NAN, f64::max);
    let longest = seconds.last().copied().unwrap_or(f64::NAN);
    vec![
        number("time of a small set, median, s", Bar::AtMost(3.0), middle, count),
        number("time of a small set, longest, s", Bar::Shown, longest, count),
        number(
            "time of the first set of a base, longest, s",
            Bar::AtMost(60.0),
            slowest,
            first.len(),
        ),
    ]
}

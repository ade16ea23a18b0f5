//! Anyone's simulator as tables: hub loads and a control over a sweep, with suspects whose effects are known.

use crate::toy::noise;
use model_gap::discovery::{Confidence, Standing, Verdict};
use model_gap::points::{
    Channel, Grid, Instrument, Part, Point, PointFinding, PointTable, Suspect, SuspectParameter,
};

const CHANNELS: [(&str, &str); 5] = [
    ("fz_cos_N", "N"),
    ("fz_sin_N", "N"),
    ("fx_cos_N", "N"),
    ("fx_sin_N", "N"),
    ("theta0_deg", "deg"),
];
/// Harmonic of the loads.
const HARMONIC: f64 = 4.0;

/// What the simulation says at an advance ratio and a rotor speed over the nominal one.
fn simulated(mu: f64, speed: f64) -> [f64; 5] {
    let loads =
        [100.0 * (1.0 + 2.0 * mu), 60.0 * (1.0 - mu), 20.0 * (1.0 + mu * mu), -30.0 * (0.5 + mu)];
    let [a, b, c, d] = loads.map(|load| load * speed * speed);
    [a, b, c, d, 8.0 + 10.0 * mu * mu]
}

/// The same with an amount of something, exactly.
fn with(name: &str, value: f64, mu: f64, speed: f64) -> [f64; 5] {
    let mut own = simulated(mu, speed);
    let turned = |own: [f64; 5], angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let pair = |c: f64, s: f64| (c * cos + s * sin, s * cos - c * sin);
        let ((a, b), (c, d)) = (pair(own[0], own[1]), pair(own[2], own[3]));
        [a, b, c, d, own[4]]
    };
    match name {
        "stiffness" => {
            let by = value - 1.0;
            let each = [200.0 * mu, -150.0, 80.0 * mu * mu, 40.0, 2.0 * mu];
            own.iter_mut().zip(each).for_each(|(own, each)| *own += by * each);
        }
        "drag" => {
            let by = value - 1.0;
            let each = [0.0, 5.0, 30.0 * mu, 10.0, 6.0 * mu];
            own.iter_mut().zip(each).for_each(|(own, each)| *own += by * each);
        }
        "azimuth" => own = turned(own, HARMONIC * value.to_radians()),
        // a delay in seconds turns by the harmonic times the rotor speed, 40 rad/s at the nominal one
        "delay" => own = turned(own, HARMONIC * 40.0 * speed * value),
        other => panic!("no suspect {other}"),
    }
    own
}

/// A sweep over the advance ratio at the nominal speed, `possible` points at other speeds behind.
struct Sweep {
    points: usize,
    possible: Vec<(f64, f64)>,
    /// Part of a typical load that is the deviation of a load.
    noise: f64,
    amount: f64,
    form_error: f64,
}

impl Default for Sweep {
    fn default() -> Self {
        Self { points: 24, possible: vec![], noise: 0.01, amount: 1.0, form_error: 0.05 }
    }
}

impl Sweep {
    fn conditions(&self) -> Vec<(f64, f64)> {
        let swept = (0..self.points).map(|p| (0.05 + 0.3 * p as f64 / self.points as f64, 1.0));
        swept.chain(self.possible.iter().copied()).collect()
    }

    fn deviation(&self) -> [f64; 5] {
        [80.0, 80.0, 30.0, 30.0, 4.0].map(|size| self.noise * size)
    }

    fn grid(&self, of: impl Fn(f64, f64) -> [f64; 5]) -> Grid {
        self.conditions().iter().map(|&(mu, speed)| of(mu, speed).to_vec()).collect()
    }

    fn suspect(&self, name: &'static str, unit: &'static str, none: f64, amount: f64) -> Suspect {
        let at = none + self.amount * (amount - none);
        let back = none - self.amount * (amount - none);
        let tables = [at, back].map(|v| (v, self.grid(|mu, speed| with(name, v, mu, speed))));
        let wide = 20.0 * (amount - none).abs();
        let range = (none - wide, none + wide);
        let parameter = SuspectParameter {
            name: "amount",
            unit,
            none,
            range,
            tables: tables.into(),
            ..SuspectParameter::default()
        };
        let form_error = self.form_error;
        Suspect { name, form_error, parameters: vec![parameter], ..Suspect::default() }
    }

    /// The table of measurements of `truth`, by point and channel.
    fn table(&self, seed: u64, truth: impl Fn(f64, f64) -> [f64; 5]) -> PointTable {
        let mut state = seed;
        let deviation = self.deviation();
        let mut point = |(p, &(mu, speed)): (usize, &(f64, f64))| {
            let read = truth(mu, speed);
            let measured = read.iter().zip(deviation).map(|(v, s)| v + s * noise(&mut state));
            let measured: Vec<f64> = measured.collect();
            let is_measured = p < self.points;
            Point {
                id: format!("{}", p + 1),
                group: p,
                is_reference: false,
                conditions: vec![mu, speed],
                measured: measured.into_iter().map(|v| is_measured.then_some(v)).collect(),
                deviation: deviation.to_vec(),
            }
        };
        let parts =
            [Part::CosineOf(1), Part::SineOf(0), Part::CosineOf(3), Part::SineOf(2), Part::Scalar];
        let channel = |(c, part): (usize, Part)| Channel {
            name: CHANNELS[c].0.into(),
            unit: CHANNELS[c].1.into(),
            instrument: c / 2,
            part,
        };
        let instrument = |name: &str| Instrument { name: name.into(), gain: 0.002, zero: 0.0 };
        PointTable {
            points: self.conditions().iter().enumerate().map(&mut point).collect(),
            channels: parts.into_iter().enumerate().map(channel).collect(),
            instruments: ["fz_N", "fx_N", "theta0_deg"].map(instrument).into(),
            conditions: vec!["mu".into(), "speed".into()],
            predicted: self.grid(simulated),
            suspects: vec![
                self.suspect("stiffness", "1", 1.0, 1.05),
                self.suspect("drag", "1", 1.0, 1.2),
                self.suspect("azimuth", "deg", 0.0, 1.0),
            ],
            knows_deviations: true,
            ..PointTable::default()
        }
    }
}

fn names(found: &PointFinding) -> Vec<&'static str> {
    found.finding.causes.iter().map(|own| found.candidates[own.candidate].id).collect()
}

fn is_confident(found: &PointFinding) -> bool {
    found.finding.verdict == Verdict::Named && found.finding.confidence == Confidence::Confident
}

#[test]
fn noise_alone_shows_nothing_and_says_what_it_would_have_shown() {
    let sweep = Sweep::default();
    let mut shown = 0;
    let mut sure = 0;
    for seed in 0..60 {
        let found = sweep.table(1 + 7 * seed, simulated).find().unwrap();
        shown += usize::from(found.finding.verdict != Verdict::NothingMissing);
        sure += usize::from(found.finding.confidence == Confidence::Confident);
        for limit in found.finding.limits.iter().flatten() {
            assert!((0.01..1.0).contains(limit), "{limit}");
        }
    }
    assert!(shown <= 2, "{shown} of 60");
    assert!(sure >= 50, "{sure} of 60");
}

#[test]
fn what_was_planted_is_named_with_its_amount() {
    let sweep = Sweep::default();
    for (name, value) in
        [("stiffness", 0.93), ("stiffness", 1.06), ("drag", 1.4), ("azimuth", -2.0)]
    {
        let mut covered = 0;
        for seed in 0..20 {
            let table = sweep.table(3 + 11 * seed, |mu, speed| with(name, value, mu, speed));
            let found = table.find().unwrap();
            assert!(is_confident(&found), "{name} {value}, {seed}: {:?}", found.finding.reasons);
            assert_eq!(names(&found), [name], "{seed}");
            let own = &found.finding.causes[0].parameters[0];
            covered += usize::from(own.ci95[0] <= value && value <= own.ci95[1]);
            assert!(
                (own.value - value).abs()
                    < 0.2 * (value - 1.0_f64.min(value.abs())).abs().max(0.05)
            );
            // a channel that the cause moves is better met on points not seen, in its own unit
            let better = found.gains.iter().filter(|g| g.rms_after < 0.9 * g.rms_before).count();
            assert!(better >= 1, "{:?}", found.gains);
        }
        assert!(covered >= 17, "{name} {value}: {covered} of 20 intervals");
    }
}

/// The readings stand beside what is simulated of them, and the fingerprint of a cause is what its fit takes off the residual.
#[test]
fn a_fingerprint_is_what_the_fit_takes_off_the_residual() {
    let sweep = Sweep { possible: vec![(0.2, 1.1)], ..Sweep::default() };
    let mut table = sweep.table(37, |mu, speed| with("stiffness", 1.04, mu, speed));
    table.points[3].measured[2] = None;
    table.alternatives = vec![sweep.grid(|mu, speed| with("drag", 1.02, mu, speed))];
    let found = table.find().unwrap();
    assert_eq!(names(&found), ["stiffness"]);
    assert_eq!(found.readings.len(), 24 * 5 - 1);
    let shown: Vec<(&str, Standing)> = found
        .fingerprints
        .iter()
        .map(|own| (found.candidates[own.candidate].id, own.standing))
        .collect();
    assert_eq!(shown[0], ("stiffness", Standing::Found));
    assert!(shown[1..].iter().all(|own| own.1 != Standing::Found), "{shown:?}");
    let own = &found.fingerprints[0];
    assert!(own.likeness > 0.4, "{}", own.likeness);
    assert!(found.fingerprints[1..].iter().all(|other| other.likeness < own.likeness));
    let (adds, shows) = (own.adds.concat(), own.shows.concat());
    let csv = found.residuals_csv(&table);
    for (i, (reading, line)) in found.readings.iter().zip(csv.lines().skip(1)).enumerate() {
        let [before, after] = reading.residual;
        assert!((before - after - shows[i]).abs() < 1e-9, "{reading:?}, {}", shows[i]);
        let [plain, with] = reading.simulated;
        assert!((with - plain - reading.sigma * adds[i]).abs() < 1e-9, "{reading:?}");
        let (point, channel) = (&table.points[reading.point], &table.channels[reading.channel]);
        assert_eq!(Some(reading.measured), point.measured[reading.channel]);
        let start = format!("{},{},{},{plain},", point.id, channel.name, reading.measured);
        assert!(line.starts_with(&start) && line.ends_with(&format!(",{before:.4},{after:.4}")));
    }
    // beside the cause the floor of a channel: the one alternative, 2 % of drag, moves fx by 0.6 mu over 0.3
    let floor = found.floors.iter().find(|own| own.channel == 2).unwrap();
    let mu: Vec<f64> =
        (0..24).filter(|p| *p != 3).map(|p| 0.05 + 0.3 * f64::from(p) / 24.0).collect();
    let rms = (mu.iter().map(|mu| (2.0 * mu).powi(2)).sum::<f64>() / mu.len() as f64).sqrt();
    assert!((floor.alternatives / rms - 1.0).abs() < 1e-9, "{floor:?}");
    let effect = floor.effects[0];
    assert!(effect[0] > 0.0 && effect[1] > 0.0 && floor.uncertain == 0.0, "{floor:?}");
}

/// A cause that looks like the one found and whose model could not be read was not tried: it is not excluded.
#[test]
fn what_was_not_tried_is_not_excluded() {
    let sweep = Sweep::default();
    let mut table = sweep.table(37, |mu, speed| with("stiffness", 1.04, mu, speed));
    table.suspects[0].confused_with = &["drag"];
    assert!(is_confident(&table.find().unwrap()));
    table.suspects[1].blocked = Some("no model".to_owned());
    assert!(is_confident(&table.find().unwrap()), "the points cannot show it");
    table.suspects[1].is_unread = true;
    let found = table.find().unwrap();
    assert_eq!(names(&found), ["stiffness"]);
    assert!(!is_confident(&found));
}

/// Points of `own` behind those of `reference`, at which nothing is missing.
fn against(reference: PointTable, own: PointTable) -> PointTable {
    let mut all = reference;
    for point in &mut all.points {
        point.id = format!("reference {}", point.id);
        point.is_reference = true;
    }
    all.points.extend(own.points);
    all.predicted.extend(own.predicted);
    for (suspect, own) in all.suspects.iter_mut().zip(own.suspects) {
        for (parameter, own) in suspect.parameters.iter_mut().zip(own.parameters) {
            for ((_, grid), (_, own)) in parameter.tables.iter_mut().zip(own.tables) {
                grid.extend(own);
            }
        }
    }
    all
}

/// Loads read 3 deg late, at the references too, look like an azimuth that is off: they are no discovery, and what changed
/// since is found beside them. Without references the azimuth is named.
#[test]
fn what_references_show_too_is_no_discovery() {
    let sweep = Sweep::default();
    let late = |name: &'static str, value: f64| {
        move |mu: f64, speed: f64| {
            let (own, turned) = (simulated(mu, speed), with("azimuth", 3.0, mu, speed));
            let mut all = with(name, value, mu, speed);
            for ((all, own), turned) in all.iter_mut().zip(own).zip(turned) {
                *all += turned - own;
            }
            all
        }
    };
    for seed in 0..10 {
        let reference = || sweep.table(41 + 7 * seed, late("drag", 1.0));
        let same = against(reference(), sweep.table(43 + 11 * seed, late("drag", 1.0)));
        let found = same.find().unwrap();
        assert!(names(&found).is_empty(), "{seed}: {:?}", found.finding.reasons);
        let changed = against(reference(), sweep.table(43 + 11 * seed, late("stiffness", 0.9)));
        let found = changed.find().unwrap();
        assert_eq!(names(&found), ["stiffness"], "{seed}: {:?}", found.finding.reasons);
        let own = &found.finding.causes[0].parameters[0];
        assert!((own.value - 0.9).abs() < 0.01, "{seed}: {own:?}");
        let alone = sweep.table(43 + 11 * seed, late("drag", 1.0)).find().unwrap();
        assert_eq!(names(&alone), ["azimuth"], "{seed}");
    }
}

/// A point far off, or two neighbours, is no cause.
#[test]
fn a_point_far_off_has_no_name() {
    let sweep = Sweep { points: 40, ..Sweep::default() };
    let off = sweep.deviation()[1] * 8.0;
    for (at, seed) in (7..27).cycle().zip(0..60_u64) {
        for neighbours in [1, 2] {
            let mut table = sweep.table(5 + 13 * seed, simulated);
            for point in table.points.iter_mut().skip(at).take(neighbours) {
                point.measured[1] = point.measured[1].map(|v| v + off);
            }
            let found = table.find().unwrap();
            assert!(!is_confident(&found), "{seed}: {:?}", names(&found));
        }
    }
}

/// Errors that are smooth over the sweep, one of each channel, are no cause: at most one name of 60, and it is not sure.
#[test]
fn a_smooth_error_of_every_channel_has_no_name() {
    let sweep = Sweep::default();
    let mut named = 0;
    for seed in 0..60 {
        let mut state = 17 + 19 * seed;
        let waves: Vec<(f64, f64)> =
            (0..5).map(|_| (noise(&mut state), noise(&mut state))).collect();
        let size = sweep.deviation();
        let truth = |mu: f64, speed: f64| {
            let mut own = simulated(mu, speed);
            for ((own, (a, b)), size) in own.iter_mut().zip(&waves).zip(size) {
                *own += size * (a + 6.0 * b * (mu - 0.2));
            }
            own
        };
        let found = sweep.table(23 + 29 * seed, truth).find().unwrap();
        assert!(!is_confident(&found), "{seed}: {:?}", names(&found));
        let has_name = found.finding.verdict == Verdict::Named;
        named += usize::from(has_name);
    }
    assert!(named <= 1, "{named} of 60");
}

/// Turning the reference of azimuth, measured and simulated alike, changes nothing; nor does the unit of a channel, a
/// further channel that nothing moves, the order of the points, or the size of the amounts that effects were computed with.
#[test]
fn the_verdict_does_not_depend_on_how_the_table_is_written() {
    let sweep = Sweep::default();
    let truth = |mu: f64, speed: f64| with("stiffness", 1.04, mu, speed);
    let plain = sweep.table(9, truth);
    let expected = plain.find().unwrap();
    assert!(is_confident(&expected));
    let value = |found: &PointFinding| found.finding.causes[0].parameters[0].value;
    let interval = expected.finding.causes[0].parameters[0].ci95;
    let tenth = 0.1 * (interval[1] - interval[0]);
    let mut other: Vec<(&str, PointTable)> = Vec::new();
    let mut turned = plain.clone();
    let turn = |row: &mut Vec<f64>| {
        let (sin, cos) = 1.1_f64.sin_cos();
        for (a, b) in [(0, 1), (2, 3)] {
            let (c, s) = (row[a], row[b]);
            (row[a], row[b]) = (c * cos + s * sin, s * cos - c * sin);
        }
    };
    each_row(&mut turned, turn);
    other.push(("azimuth turned", turned));
    let mut scaled = plain.clone();
    each_row(&mut scaled, |row| row[1] *= 1000.0);
    scaled.points.iter_mut().for_each(|point| point.deviation[1] *= 1000.0);
    // a gain is shared by the two of a harmonic in one unit: the unit of both changes
    each_row(&mut scaled, |row| row[0] *= 1000.0);
    scaled.points.iter_mut().for_each(|point| point.deviation[0] *= 1000.0);
    other.push(("another unit", scaled));
    let mut reversed = plain.clone();
    reversed.points.reverse();
    every_grid(&mut reversed, |grid| grid.reverse());
    other.push(("reverse order", reversed));
    for amount in [0.3, 3.0] {
        let own = Sweep { amount, ..Sweep::default() };
        other.push(("other amounts", own.table(9, truth)));
    }
    for (what, table) in other {
        let found = table.find().unwrap();
        assert!(is_confident(&found), "{what}: {:?}", found.finding.reasons);
        assert_eq!(names(&found), names(&expected), "{what}");
        assert!((value(&found) - value(&expected)).abs() < tenth, "{what}");
    }
}

fn every_grid(table: &mut PointTable, change: impl Fn(&mut Grid)) {
    change(&mut table.predicted);
    for suspect in &mut table.suspects {
        for parameter in &mut suspect.parameters {
            parameter.tables.iter_mut().for_each(|own| change(&mut own.1));
        }
    }
}

/// Changes a row of every grid, and of what was measured in full.
fn each_row(table: &mut PointTable, change: impl Fn(&mut Vec<f64>)) {
    every_grid(table, |grid| grid.iter_mut().for_each(&change));
    for point in &mut table.points {
        let mut row: Vec<f64> = point.measured.iter().flatten().copied().collect();
        change(&mut row);
        point.measured = row.into_iter().map(Some).collect();
    }
}

/// Delay and azimuth are one thing at one rotor speed: both are said, and points at another speed are asked for.
#[test]
fn what_these_points_cannot_tell_apart_is_a_set_and_other_points_are_asked_for() {
    let possible = vec![(0.2, 1.0), (0.3, 1.0), (0.2, 0.8), (0.2, 1.02)];
    let sweep = Sweep { possible, form_error: 0.005, ..Sweep::default() };
    let mut table = sweep.table(31, |mu, speed| with("azimuth", 5.0, mu, speed));
    table.suspects.push(sweep.suspect("delay", "s", 0.0, 0.0005));
    let found = table.find().unwrap();
    assert_eq!(found.finding.verdict, Verdict::Ambiguous, "{:?}", found.finding.reasons);
    let cause = &found.finding.causes[0];
    let mut set = vec![found.candidates[cause.candidate].id];
    set.extend(cause.alternatives.iter().map(|own| found.candidates[own.candidate].id));
    set.sort_unstable();
    assert_eq!(set, ["azimuth", "delay"]);
    let next = found.next.unwrap();
    assert_eq!((next.points[0], next.told_apart), (26, 1.0), "{next:?}");
    // measured there, the truth is told
    table.points[26].measured = with("azimuth", 5.0, 0.2, 0.8).map(Some).into();
    let found = table.find().unwrap();
    assert_eq!(names(&found), ["azimuth"], "{:?}", found.finding.reasons);
    assert!(is_confident(&found), "{:?}", found.finding.reasons);
}

#[test]
fn what_another_model_thought_as_good_explains_is_no_discovery() {
    let sweep = Sweep::default();
    let truth = |mu: f64, speed: f64| with("stiffness", 1.04, mu, speed);
    let mut table = sweep.table(37, truth);
    assert!(is_confident(&table.find().unwrap()));
    table.alternatives = vec![sweep.grid(|mu, speed| with("stiffness", 1.05, mu, speed))];
    let found = table.find().unwrap();
    assert!(names(&found).is_empty(), "{:?}", names(&found));
    // the same of an input that is uncertain by as much
    table.uncertain = std::mem::take(&mut table.alternatives);
    assert!(names(&table.find().unwrap()).is_empty());
}

/// The floor says how large an error of the simulation is, not what it looks like: of a second cause that is small beside what is
/// left nothing is sure.
#[test]
fn a_second_cause_that_is_small_beside_what_is_left_is_tentative() {
    let sweep = Sweep { points: 60, ..Sweep::default() };
    let deviation = sweep.deviation();
    let mut state = 77;
    let mut pattern = |size: f64| -> Grid {
        let mut row = || deviation.map(|own| own * size * noise(&mut state)).to_vec();
        (0..sweep.points).map(|_| row()).collect()
    };
    let (shown, hidden) = (pattern(8.0), pattern(3.0));
    let both = |mu: f64, speed: f64| {
        let (mut own, base) = (with("drag", 3.0, mu, speed), simulated(mu, speed));
        let other = with("stiffness", 1.25, mu, speed);
        for ((own, other), base) in own.iter_mut().zip(other).zip(base) {
            *own += other - base;
        }
        own
    };
    let found = |rest: f64| {
        let mut table = sweep.table(5, both);
        let moved = |(row, other): (&Vec<f64>, &Vec<f64>)| -> Vec<f64> {
            row.iter().zip(other).map(|(a, b)| a + b).collect()
        };
        table.alternatives = vec![table.predicted.iter().zip(&shown).map(moved).collect()];
        for (point, off) in table.points.iter_mut().zip(&hidden) {
            let read = point.measured.iter_mut().flatten();
            read.zip(off).for_each(|(value, off)| *value += rest * off);
        }
        table.find().unwrap()
    };
    let (hidden, clear) = (found(1.0), found(0.0));
    for own in [&hidden, &clear] {
        let mut causes = names(own);
        causes.sort_unstable();
        assert_eq!(causes, ["drag", "stiffness"]);
    }
    assert!(is_confident(&clear), "{:?}", clear.finding.reasons);
    assert!(!is_confident(&hidden));
    let why = hidden.finding.reasons.iter().map(ToString::to_string).collect::<Vec<_>>();
    assert!(why.iter().any(|own| own.contains("off the error of the readings")), "{why:?}");
}

/// Control off and on at a few speeds: a drive turns the loads by a part of its size, a suspect too. Two models differ by a fifth of
/// every load at each speed, both drives alike, so that levels say nothing.
fn driven(seed: u64, gain: f64, are_sets: bool) -> PointTable {
    let sweep = Sweep { points: 24, ..Sweep::default() };
    let drive = |p: usize| [0.0, 1.0, 2.0, 3.0][p % 4];
    let level = |p: usize| (2.3 * (p / 4) as f64).sin();
    let answer = |mu: f64| [8.0, -5.0 * mu, 3.0, 2.0, 0.0];
    let with_drive = |p: usize, mu: f64, gain: f64| {
        let own = simulated(mu, 1.0).into_iter().zip(answer(mu));
        own.map(|(own, by)| own + gain * drive(p) * by).collect::<Vec<f64>>()
    };
    // the points of a set share their speed, or are a little apart
    let mu_of = |p: usize| {
        0.05 + 0.05 * (p / 4) as f64 + if are_sets { 0.0 } else { 0.01 * (p % 4) as f64 }
    };
    let mut table = sweep.table(seed, simulated);
    let mut state = seed;
    for (p, point) in table.points.iter_mut().enumerate() {
        let mu = mu_of(p);
        point.conditions[0] = mu;
        let truth = with_drive(p, mu, gain);
        let off = simulated(mu, 1.0).map(|load| 0.1 * load * level(p));
        let read = truth.iter().zip(off).zip(&point.deviation);
        point.measured = read.map(|((v, off), s)| Some(v + off + s * noise(&mut state))).collect();
    }
    let grid = |of: &dyn Fn(usize, f64) -> Vec<f64>| -> Grid {
        (0..table.points.len()).map(|p| of(p, mu_of(p))).collect()
    };
    let lift = |p: usize, mu: f64, by: f64| -> Vec<f64> {
        let own = with_drive(p, mu, 1.0).into_iter();
        own.zip(simulated(mu, 1.0)).map(|(own, load)| own + by * load * level(p)).collect()
    };
    let predicted = grid(&|p, mu| with_drive(p, mu, 1.0));
    let alternative = grid(&|p, mu| lift(p, mu, 0.2));
    let tables = vec![(0.9, grid(&|p, mu| with_drive(p, mu, 0.9)))];
    let parameter = SuspectParameter {
        name: "amount",
        unit: "1",
        none: 1.0,
        range: (0.0, 2.0),
        tables,
        ..SuspectParameter::default()
    };
    table.suspects =
        vec![Suspect { name: "drive", parameters: vec![parameter], ..Suspect::default() }];
    // one column of its shape would explain the level alone: two models that differ otherwise do not
    table.alternatives = vec![alternative, grid(&|p, mu| lift(p + 4, mu, 0.2))];
    table.predicted = predicted;
    table
}

#[test]
fn what_a_drive_does_is_found_though_levels_are_badly_known() {
    let named = |are_sets: bool, gain: f64| {
        let of = |seed: &u64| names(&driven(*seed, gain, are_sets).find().unwrap()) == ["drive"];
        (0..10).filter(of).count()
    };
    let (differences, levels) = (named(true, 0.85), named(false, 0.85));
    assert!(differences >= 9, "{differences}");
    assert!(levels < differences, "{levels}");
    assert_eq!(named(true, 1.0), 0);
}

#[test]
fn too_few_values_choose_nothing_and_unknown_noise_is_never_sure() {
    let sweep = Sweep { points: 4, ..Sweep::default() };
    let truth = |mu: f64, speed: f64| with("stiffness", 1.1, mu, speed);
    let mut few = sweep.table(41, truth);
    for k in 0..25_u32 {
        let amount = 1.0 + 0.05 * f64::from(k + 1);
        few.suspects.push(sweep.suspect("stiffness", "1", 1.0, amount));
    }
    let found = few.find().unwrap();
    assert!(names(&found).is_empty());
    assert!(found.candidates[0].blocked.as_ref().unwrap().contains("20 values"));
    let mut unsure = Sweep::default().table(41, truth);
    unsure.knows_deviations = false;
    assert!(!is_confident(&unsure.find().unwrap()));
}

#[test]
fn blank_cells_are_left_out_and_bad_tables_are_refused() {
    let sweep = Sweep::default();
    let mut table = sweep.table(43, |mu, speed| with("drag", 1.4, mu, speed));
    for point in table.points.iter_mut().step_by(3) {
        point.measured[1] = None;
    }
    table.points[5].measured = vec![None; 5];
    let found = table.find().unwrap();
    assert_eq!((names(&found), found.measured.len()), (vec!["drag"], 23));
    let refused = |change: &dyn Fn(&mut PointTable)| {
        let mut bad = table.clone();
        change(&mut bad);
        bad.find().unwrap_err().to_string()
    };
    assert!(refused(&|t| t.points[3].deviation[2] = 0.0).contains("standard deviation"));
    assert!(refused(&|t| t.predicted[3][2] = f64::NAN).contains("prediction"));
    assert!(
        refused(&|t| {
            t.predicted.pop();
        })
        .contains("expected 24")
    );
    assert!(
        refused(&|t| t.points.iter_mut().for_each(|p| p.measured = vec![None; 5]))
            .contains("measured values")
    );
}

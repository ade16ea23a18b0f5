//! Benches with known truth, made by rules of their own: plays, relays, a lag, Bouc-Wen's equation, creep.

use chacha20::ChaCha8Rng;
use preisach_dyn::VoltageRange;
use preisach_dyn::identify::BenchRecord;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, Normal};
use std::f64::consts::TAU;

/// What the actuator of a bench is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Plays of random half-widths and weights.
    Plays,
    /// Relays: a density over centre and half-width that leans to one side, and a reversible part.
    Relays,
    /// Plays before a first-order lag.
    Lag,
    /// Bouc-Wen's equation.
    BoucWen,
    /// Plays before creep: lags of random time constants.
    Creep,
}

/// The runs of a bench.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Runs {
    /// Slow runs and sines of 1 and 10 Hz.
    Usual,
    /// Runs of at most 0.5 Hz, a staircase and a mixture of tones among them.
    Slow,
    /// One record alone: a slow sine that fades.
    OneFade,
    /// One record alone: a staircase, then a slow sine.
    OneOfStepsAndSine,
    /// Two sines of 1 Hz, a large and a small one.
    TwoSines,
}

/// A kind of actuator on a kind of bench.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Bench {
    pub(crate) name: &'static str,
    pub(crate) kind: Kind,
    pub(crate) runs: Runs,
    /// Seeds it is judged by.
    pub(crate) seeds: u64,
    /// Largest error of identification over that of plays.
    pub(crate) most_of_plays: f64,
}

/// An error within 2 % of that of plays is a tie.
const TIE: f64 = 1.02;

/// Eight benches. On the first both leave no more than what noise does: many draws tell them apart.
pub(crate) const BENCHES: [Bench; 8] = [
    bench("plays", Kind::Plays, Runs::Usual, 12, TIE),
    bench("relays", Kind::Relays, Runs::Usual, 3, TIE),
    bench("lag", Kind::Lag, Runs::Usual, 3, TIE),
    bench("Bouc-Wen", Kind::BoucWen, Runs::Usual, 3, TIE),
    bench("creep", Kind::Creep, Runs::Usual, 3, TIE),
    bench("slow relays", Kind::Relays, Runs::Slow, 3, TIE),
    // what neither plays nor a static model of slow runs can have
    bench("slow creep", Kind::Creep, Runs::Slow, 3, 0.5),
    bench("slow Bouc-Wen", Kind::BoucWen, Runs::Slow, 3, TIE),
];

/// Benches of one record each: nothing but blocks in time to choose a model by.
pub(crate) const ONE_RECORD: [Bench; 7] = [
    bench("fade, plays", Kind::Plays, Runs::OneFade, 4, TIE),
    bench("fade, relays", Kind::Relays, Runs::OneFade, 3, TIE),
    bench("fade, creep", Kind::Creep, Runs::OneFade, 3, TIE),
    bench("fade, Bouc-Wen", Kind::BoucWen, Runs::OneFade, 3, TIE),
    bench("steps and sine, plays", Kind::Plays, Runs::OneOfStepsAndSine, 4, TIE),
    bench("steps and sine, relays", Kind::Relays, Runs::OneOfStepsAndSine, 3, TIE),
    bench("steps and sine, creep", Kind::Creep, Runs::OneOfStepsAndSine, 3, TIE),
];

/// Benches of a large and a small sine: neither says how a model is beyond what trained it.
pub(crate) const TWO_SINES: [Bench; 2] = [
    bench("two sines, plays", Kind::Plays, Runs::TwoSines, 6, TIE),
    bench("two sines, relays", Kind::Relays, Runs::TwoSines, 6, TIE),
];

const fn bench(
    name: &'static str,
    kind: Kind,
    runs: Runs,
    seeds: u64,
    most_of_plays: f64,
) -> Bench {
    Bench { name, kind, runs, seeds, most_of_plays }
}

/// A run not used for training: its command and what the actuator does without noise.
pub(crate) struct Truth {
    pub(crate) time_step_s: f64,
    pub(crate) voltage_volt: Vec<f64>,
    pub(crate) output_deg: Vec<f64>,
}

/// Records to learn from, runs to be judged by.
pub(crate) struct Made {
    pub(crate) range: VoltageRange,
    pub(crate) records: Vec<BenchRecord>,
    pub(crate) held_out: Vec<Truth>,
}

/// A command over half the range about its middle: name, samples per second, values.
type Command = (&'static str, f64, Vec<f64>);

fn sampled(hz: f64, seconds: f64, at: impl Fn(f64) -> f64) -> Vec<f64> {
    let mut values = Vec::new();
    while values.len() as f64 / hz <= seconds {
        values.push(at(values.len() as f64 / hz));
    }
    values
}

fn sine(name: &'static str, hz: f64, [middle, size]: [f64; 2], cycles: f64) -> Command {
    let rate_hz = if hz < 0.6 { 100.0 } else { 200.0 * hz };
    (name, rate_hz, sampled(rate_hz, cycles / hz, |t| middle + size * (TAU * hz * t).sin()))
}

/// Levels one after another, a ramp of some seconds to each and a rest at it.
fn levels(name: &'static str, levels: &[f64], [ramp_s, rest_s]: [f64; 2]) -> Command {
    let each = ramp_s + rest_s;
    let last = levels.len() - 1;
    let at = |t: f64| {
        let place = (0..last).take_while(|i| (*i as f64 + 1.0) * each <= t).count().min(last - 1);
        let share = ((t - place as f64 * each - rest_s) / ramp_s).clamp(0.0, 1.0);
        levels[place] + share * (levels[place + 1] - levels[place])
    };
    (name, 100.0, sampled(100.0, each * last as f64 + rest_s, at))
}

/// From the middle to another level, then loops about it.
fn minor(slower: f64, [middle, size]: [f64; 2]) -> Command {
    let (rate_hz, ramp_s) = (500.0 / slower, 0.4 * slower);
    let at = |t: f64| {
        let share = (t / ramp_s).min(1.0);
        middle * share + size * (TAU * 3.0 / slower * (t - ramp_s).max(0.0)).sin()
    };
    ("minor", rate_hz, sampled(rate_hz, ramp_s + slower, at))
}

/// Three tones of random phases that begin together from the middle.
fn mix(
    name: &'static str,
    slower: f64,
    seconds: f64,
    draw: &mut impl FnMut(f64, f64) -> f64,
) -> Command {
    let tones = [0.7, 2.3, 4.3].map(|hz| (hz / slower, draw(0.2, 0.32), draw(0.0, TAU)));
    let rate_hz = 500.0 / slower;
    let at = |t: f64| {
        let sum: f64 =
            tones.iter().map(|(hz, size, phase)| size * (TAU * hz * t + phase).sin()).sum();
        sum * (t / (0.1 * seconds)).min(1.0)
    };
    (name, rate_hz, sampled(rate_hz, seconds, at))
}

/// What one actuator of a kind does to commands over half its range.
struct Actuator {
    kind: Kind,
    /// Half-width and weight of plays.
    plays: Vec<[f64; 2]>,
    /// Thresholds, down and up, and weight of relays.
    relays: Vec<[f64; 3]>,
    /// Linear part, `A`, `beta`, `gamma` and exponent of Bouc-Wen's equation.
    bouc_wen: [f64; 5],
    lag_s: f64,
    /// Share and time constant (s) of the lags of creep.
    creep: Vec<[f64; 2]>,
    stroke_deg: f64,
    offset_deg: f64,
}

/// Steps of a lag or of Bouc-Wen's equation between two samples.
const FINER: u32 = 10;

impl Actuator {
    fn new(kind: Kind, draw: &mut impl FnMut(f64, f64) -> f64) -> Self {
        let wide = draw(0.15, 0.35);
        let mut plays = vec![[0.0, draw(0.5, 0.9)]];
        plays.extend((0..12).map(|_| {
            let half_width = draw(0.02, 0.8);
            [half_width, draw(0.02, 0.15) * (-half_width / wide).exp()]
        }));
        let (lean, across) = (draw(-0.4, 0.4), draw(0.4, 0.8));
        let n = 48_u32;
        let edge = |i: u32| 2.0 * (f64::from(i) + 0.5) / f64::from(n) - 1.0;
        let mut relays = Vec::new();
        for up in 0..n {
            for down in 0..=up {
                let (middle, half) = (0.5 * (edge(up) + edge(down)), 0.5 * (edge(up) - edge(down)));
                let density = (-half / wide - ((middle - lean) / across).powi(2)).exp();
                relays.push([edge(down), edge(up), density]);
            }
        }
        let reversible = draw(0.5, 1.0) * relays.iter().map(|r| r[2]).sum::<f64>();
        for relay in &mut relays {
            relay[2] /= reversible;
        }
        let beta = draw(2.0, 4.0);
        Self {
            kind,
            plays,
            relays,
            bouc_wen: [
                draw(0.7, 1.0),
                draw(0.3, 0.6),
                beta,
                beta * draw(-0.6, 0.3),
                draw(1.0, 1.6),
            ],
            lag_s: draw(2e-3, 6e-3),
            creep: (0..5)
                .map(|i| [draw(0.006, 0.018), 0.1 * 4.0_f64.powf(f64::from(i) + draw(0.0, 1.0))])
                .collect(),
            stroke_deg: draw(5.0, 60.0),
            offset_deg: draw(-20.0, 20.0),
        }
    }

    fn of_plays(&self, command: &[f64]) -> Vec<f64> {
        let mut states = vec![command[0]; self.plays.len()];
        let at = |v: &f64| {
            let moved = states.iter_mut().zip(&self.plays).map(|(w, [r, weight])| {
                *w = w.clamp(v - r, v + r);
                weight * *w
            });
            moved.sum()
        };
        command.iter().map(at).collect()
    }

    fn of_relays(&self, command: &[f64]) -> Vec<f64> {
        let first = command[0];
        let mut up: Vec<bool> = self.relays.iter().map(|[a, b, _]| 0.5 * (a + b) < first).collect();
        let at = |v: &f64| {
            let moved = up.iter_mut().zip(&self.relays).map(|(up, [a, b, weight])| {
                *up = if v >= b {
                    true
                } else if v <= a {
                    false
                } else {
                    *up
                };
                if *up { *weight } else { -weight }
            });
            v + moved.sum::<f64>()
        };
        command.iter().map(at).collect()
    }

    fn of_bouc_wen(&self, command: &[f64]) -> Vec<f64> {
        let [linear, a, beta, gamma, exponent] = self.bouc_wen;
        let (mut z, mut last) = (0.0_f64, command[0]);
        let at = |v: &f64| {
            let step = (v - last) / f64::from(FINER);
            let slope = |z: f64| a - (beta * (step * z).signum() + gamma) * z.abs().powf(exponent);
            for _ in 0..FINER {
                let k1 = slope(z);
                let k2 = slope(z + 0.5 * step * k1);
                let k3 = slope(z + 0.5 * step * k2);
                let k4 = slope(z + step * k3);
                z += step / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
            }
            last = *v;
            linear * v - z
        };
        command.iter().map(at).collect()
    }

    /// What a lag of some time constant makes of a signal, settled at its first sample.
    fn lagged(signal: &[f64], time_step_s: f64, tau_s: f64) -> Vec<f64> {
        let share = 1.0 - (-time_step_s / (f64::from(FINER) * tau_s)).exp();
        let (mut x, mut last) = (signal[0], signal[0]);
        let at = |y: &f64| {
            for i in 0..FINER {
                let input = last + (y - last) * (f64::from(i) + 0.5) / f64::from(FINER);
                x += share * (input - x);
            }
            last = *y;
            x
        };
        signal.iter().map(at).collect()
    }

    fn output_deg(&self, command: &[f64], time_step_s: f64) -> Vec<f64> {
        let mut y = match self.kind {
            Kind::Plays | Kind::Lag | Kind::Creep => self.of_plays(command),
            Kind::Relays => self.of_relays(command),
            Kind::BoucWen => self.of_bouc_wen(command),
        };
        if self.kind == Kind::Lag {
            y = Self::lagged(&y, time_step_s, self.lag_s);
        }
        if self.kind == Kind::Creep {
            let bare = y.clone();
            for &[share, tau_s] in &self.creep {
                let late = Self::lagged(&bare, time_step_s, tau_s);
                y.iter_mut().zip(late).for_each(|(y, late)| *y += share * (late - bare[0]));
            }
        }
        y.iter().map(|y| self.offset_deg + self.stroke_deg * y).collect()
    }
}

impl Bench {
    /// The bench of a seed, its records with white noise of a share of the deviation of the first of them.
    pub(crate) fn made(&self, seed: u64, noise_share: f64) -> Made {
        let mut rng =
            ChaCha8Rng::seed_from_u64(1000 * seed + 10 * self.kind as u64 + self.runs as u64);
        let (low, high) =
            [(-20.0, 150.0), (0.0, 100.0), (0.0, 150.0), (-30.0, 120.0)][rng.random_range(0..4)];
        let mut draw = |low: f64, high: f64| rng.random_range(low..high);
        let actuator = Actuator::new(self.kind, &mut draw);
        let fade = sampled(100.0, 32.0, |t| 0.95 * (1.0 - t / 33.0) * (TAU * 0.25 * t).sin());
        let random = |count: u32, draw: &mut dyn FnMut(f64, f64) -> f64| -> Vec<f64> {
            std::iter::once(0.0).chain((0..count).map(|_| draw(-0.9, 0.9))).collect()
        };
        let usual = || vec![sine("major", 0.2, [0.0, 0.98], 3.0), ("fade", 100.0, fade.clone())];
        let train = match self.runs {
            Runs::Usual => {
                let mut train = usual();
                for (name, hz, size) in [
                    ("1 Hz large", 1.0, 0.95),
                    ("1 Hz small", 1.0, 0.35),
                    ("10 Hz large", 10.0, 0.95),
                    ("10 Hz small", 10.0, 0.35),
                ] {
                    train.push(sine(name, hz, [0.0, size], if hz > 5.0 { 10.0 } else { 5.0 }));
                }
                train
            }
            Runs::Slow => {
                let mut train = usual();
                train.push(levels("staircase", &random(8, &mut draw), [0.5, 4.0]));
                train.push(mix("slow mix", 10.0, 40.0, &mut draw));
                train
            }
            Runs::TwoSines => [0.98, 0.24].map(|size| sine("sine", 1.0, [0.0, size], 5.0)).into(),
            Runs::OneFade => vec![("fade", 100.0, fade)],
            Runs::OneOfStepsAndSine => {
                let mut stairs = random(6, &mut draw);
                stairs.push(0.0);
                let (name, hz, mut command) = levels("steps and sine", &stairs, [0.5, 3.0]);
                command.extend(sine("sine", 0.2, [0.0, 0.95], 3.0).2);
                vec![(name, hz, command)]
            }
        };
        let slower = if self.runs == Runs::Usual { 1.0 } else { 10.0 };
        let (middle, size) = (draw(-0.5, 0.5), draw(0.2, 0.45));
        let held_out = [
            sine("major", 4.0 / slower, [0.0, 0.9], 3.0),
            minor(slower, [middle, size]),
            levels("steps", &random(7, &mut draw), [0.01, 2.5]),
            mix("mix", slower, 4.0 * slower, &mut draw),
        ];
        let volts = |command: &[f64]| -> Vec<f64> {
            command.iter().map(|v| 0.5 * (low + high) + 0.5 * (high - low) * v).collect()
        };
        let outputs: Vec<Vec<f64>> =
            train.iter().map(|(_, hz, v)| actuator.output_deg(v, 1.0 / hz)).collect();
        let noise = Normal::new(0.0, noise_share * super::deviation(&outputs[0])).unwrap();
        let records = train.iter().zip(outputs).map(|((name, hz, v), y)| BenchRecord {
            id: (*name).to_owned(),
            time_step_s: 1.0 / hz,
            voltage_volt: volts(v),
            output_deg: y.iter().map(|y| y + noise.sample(&mut rng)).collect(),
            ..BenchRecord::default()
        });
        let records = records.collect();
        let held_out = held_out.iter().map(|(_, hz, v)| Truth {
            time_step_s: 1.0 / hz,
            voltage_volt: volts(v),
            output_deg: actuator.output_deg(v, 1.0 / hz),
        });
        Made { range: VoltageRange::new(low, high).unwrap(), records, held_out: held_out.collect() }
    }
}

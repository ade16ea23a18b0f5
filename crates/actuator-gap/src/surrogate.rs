//! Surrogate truths: other hysteresis families with nothing missing, and what the base model leaves of
//! them.
//!
//! Each family is fitted to the static part of the base model on the reference runs, simulated on
//! reference and measured inputs with the ordinary creep and relaxation, and the base model is fitted
//! to it anew. What it then misses on the measured runs is structure that any base model may leave with
//! nothing missing: the floor of every decision.

use crate::base::BaseModel;
use crate::plays::lagged;
use crate::record::Record;
use model_gap::NoiseDraw;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::mean_square;

/// Relays of the relay surrogate.
const RELAYS: usize = 700;
/// Largest factor by which the structure left of a surrogate is scaled to that left of the data.
const LARGEST_SCALE: f64 = 3.0;
/// Least factor, for surrogates that are harder to describe than the data.
const LEAST_SCALE: f64 = 0.33;
/// Part of the relaxation that depends on the state in some surrogates.
const STATE_PART: f64 = 0.1;

/// The families.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Family {
    /// Generalised play: other half-widths, cubic maps.
    GeneralisedPlay,
    /// Prandtl-Ishlinskii: straight plays, cubic envelope.
    Prandtl,
    /// Bouc-Wen with a cubic gain.
    BoucWen,
    /// Relays at quasi-random places of the triangle.
    Relays {
        /// Of another set of places.
        seed: u32,
    },
}

/// What the base model leaves of each surrogate on the measured runs.
pub(crate) fn structures(
    base: &BaseModel,
    reference: &[&Record],
    measured: &[&Record],
    range: (f64, f64),
) -> Vec<Vec<Vec<f64>>> {
    let families = [
        (Family::GeneralisedPlay, 0.0),
        (Family::Prandtl, STATE_PART),
        (Family::BoucWen, 0.0),
        (Family::Relays { seed: 1 }, -STATE_PART),
        (Family::Relays { seed: 2 }, 0.0),
    ];
    families
        .par_iter()
        .filter_map(|&(family, state)| one(base, reference, measured, range, (family, state)))
        .collect()
}

fn one(
    base: &BaseModel,
    reference: &[&Record],
    measured: &[&Record],
    range: (f64, f64),
    (family, state): (Family, f64),
) -> Option<Vec<Vec<f64>>> {
    let truth = Truth::fit(family, base, reference, range)?;
    let simulate = |run: &Record| -> Vec<f64> {
        let law = truth.outputs(&run.input);
        let relaxed = base.relaxed(&law, run.step_s);
        let middle = law.first().copied().unwrap_or_default();
        relaxed
            .iter()
            .zip(&law)
            .map(|(y, h)| y + state * (y - h) * (h - middle) / base.spread)
            .collect()
    };
    let copies: Vec<Record> = reference
        .iter()
        .enumerate()
        .map(|(r, run)| {
            let mut output = simulate(run);
            let noise = NoiseDraw::SHARP
                .again(&NoiseDraw::SHARP.noise_of(&base.residual(run)), 0x1234_5678 + r as u64);
            let judged = output.iter_mut().skip(run.window.start);
            judged.zip(noise).for_each(|(y, e)| *y += e);
            Record { output, ..(*run).clone() }
        })
        .collect();
    let copies: Vec<&Record> = copies.iter().collect();
    let again = BaseModel::fit(&copies, range, Some(base.prior))?;
    let scale = (base.floor / again.floor.max(1e-6)).clamp(LEAST_SCALE, LARGEST_SCALE);
    Some(
        measured
            .iter()
            .map(|run| {
                let left = again.predict(&run.input, run.step_s);
                simulate(run).iter().zip(left).map(|(a, b)| scale * (a - b)).collect()
            })
            .collect(),
    )
}

/// A surrogate: features of the input with weights.
struct Truth {
    family: Family,
    low: f64,
    high: f64,
    /// Rise of the Bouc-Wen state, over the half range; density of the relays.
    shape: Shape,
    weights: DVector<f64>,
}

enum Shape {
    None,
    Rise(f64),
    Relays(Vec<[f64; 3]>),
}

impl Truth {
    fn fit(family: Family, base: &BaseModel, runs: &[&Record], range: (f64, f64)) -> Option<Self> {
        let targets: Vec<Vec<f64>> = runs.iter().map(|r| base.hysteresis(&r.input)).collect();
        let (low, high) = range;
        let shapes = match family {
            Family::BoucWen => [0.1, 0.2, 0.35, 0.6].map(Shape::Rise).into_iter().collect(),
            Family::Relays { seed } => vec![Shape::Relays(relays(seed))],
            _ => vec![Shape::None],
        };
        let mut best: Option<(f64, Self)> = None;
        for shape in shapes {
            let mut truth = Self { family, low, high, shape, weights: DVector::zeros(0) };
            let (mut gram, mut right) = (DMatrix::zeros(0, 0), DVector::zeros(0));
            for (run, target) in runs.iter().zip(&targets) {
                truth.features(&run.input, |i, row| {
                    if i % 7 != 0 {
                        return;
                    }
                    if gram.nrows() == 0 {
                        gram = DMatrix::zeros(row.len(), row.len());
                        right = DVector::zeros(row.len());
                    }
                    let x = DVector::from_column_slice(row);
                    gram.ger(1.0, &x, &x, 1.0);
                    right.axpy(target[i], &x, 1.0);
                });
            }
            let ridge = 1e-6 * gram.trace() / gram.nrows().max(1) as f64;
            for i in 0..gram.nrows() {
                gram[(i, i)] += ridge;
            }
            truth.weights = gram.cholesky()?.solve(&right);
            let error: f64 = runs
                .iter()
                .zip(&targets)
                .map(|(run, target)| {
                    let out = truth.outputs(&run.input);
                    let left: Vec<f64> = out.iter().zip(target).map(|(a, b)| a - b).collect();
                    mean_square(&left)
                })
                .sum();
            if best.as_ref().is_none_or(|b| error < b.0) {
                best = Some((error, truth));
            }
        }
        best.map(|b| b.1)
    }

    fn outputs(&self, inputs: &[f64]) -> Vec<f64> {
        let mut out = Vec::with_capacity(inputs.len());
        self.features(inputs, |_, row| {
            out.push(row.iter().zip(self.weights.iter()).map(|(a, b)| a * b).sum());
        });
        out
    }

    fn features(&self, inputs: &[f64], mut visit: impl FnMut(usize, &[f64])) {
        let (middle, half) = (0.5 * (self.low + self.high), 0.5 * (self.high - self.low));
        let x: Vec<f64> = inputs.iter().map(|u| (u - middle) / half).collect();
        let Some(&first) = x.first() else { return };
        match (&self.shape, self.family) {
            (Shape::Rise(rise), _) => {
                let mut z = 0.0_f64;
                let mut before = first;
                for (i, &u) in x.iter().enumerate() {
                    let du = u - before;
                    // z' = u' (1 - z sgn(u')) / rise, exactly for a straight step
                    let sign = du.signum();
                    z = sign + (z - sign) * (-du.abs() / rise).exp();
                    before = u;
                    visit(i, &[1.0, u, u * u, u * u * u, z, z * u]);
                }
            }
            (Shape::Relays(places), _) => {
                // states by the sign of the distance to the middle of each relay, as after a long rest
                let mut states: Vec<f64> =
                    places.iter().map(|p| (first - 0.5 * (p[0] + p[1])).signum()).collect();
                let mut row = vec![0.0; 12];
                for (i, &u) in x.iter().enumerate() {
                    row.fill(0.0);
                    row[0] = 1.0;
                    row[1] = u;
                    row[2] = u * u * u;
                    for (state, p) in states.iter_mut().zip(places) {
                        if u >= p[0] {
                            *state = 1.0;
                        } else if u <= p[1] {
                            *state = -1.0;
                        }
                        // nine patches of the triangle, each with its own weight
                        let patch = bump(p[2]);
                        row[3 + patch] += *state;
                    }
                    visit(i, &row);
                }
            }
            (Shape::None, family) => {
                let count = 11;
                let width = |k: usize| 0.95 * (k as f64 + 0.5) / count as f64;
                let mut states = vec![first; count];
                let mut row = Vec::new();
                for (i, &u) in x.iter().enumerate() {
                    row.clear();
                    row.extend([1.0, u, u * u, u * u * u]);
                    for (k, p) in states.iter_mut().enumerate() {
                        let r = width(k);
                        *p = p.min(u + r).max(u - r);
                        row.push(*p);
                        if family == Family::GeneralisedPlay {
                            row.extend([*p * *p, *p * *p * *p]);
                        }
                    }
                    visit(i, &row);
                }
            }
        }
    }
}

/// Patch of a relay, from its half-width.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a number from 0 to 8")]
fn bump(half_width: f64) -> usize {
    ((half_width * 9.0) as usize).min(8)
}

/// Places of relays, up and down thresholds and half-width, quasi-random over the triangle.
///
/// Source: the R2 sequence, M. Roberts, *The unreasonable effectiveness of quasirandom sequences* (2018).
fn relays(seed: u32) -> Vec<[f64; 3]> {
    let mut places = Vec::with_capacity(RELAYS);
    let mut n = f64::from(seed) * 1000.0;
    while places.len() < RELAYS {
        n += 1.0;
        let (a, b) = ((0.5 + n * 0.754_877_666).fract(), (0.5 + n * 0.569_840_296).fract());
        // narrow loops are the many
        let half_width = a * a;
        let centre = 2.0 * b - 1.0;
        if centre.abs() + half_width < 1.0 {
            places.push([centre + half_width, centre - half_width, half_width]);
        }
    }
    places
}

/// Gaussian noise from a fixed seed.
pub(crate) struct Noise(pub(crate) u64);

impl Noise {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A number of the standard normal distribution (Box and Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

/// Slow changes of the measurement itself, alike in all runs: a zero and a gain that change at a steady rate, and a
/// reading that returns to zero, as one that is coupled by a capacitor does.
pub(crate) fn trends(law: &[f64], spread: f64, step_s: f64) -> Vec<Vec<f64>> {
    let middle = law.first().copied().unwrap_or_default();
    let half_s = 0.5 * step_s * law.len() as f64;
    let since_middle_s: Vec<f64> = (0..law.len()).map(|i| i as f64 * step_s - half_s).collect();
    let gain = law.iter().zip(&since_middle_s).map(|(h, t)| t * (h - middle) / spread).collect();
    let mut sum = 0.0;
    let returned = law.iter().map(|h| {
        sum += step_s * (h - middle) / spread;
        sum
    });
    vec![since_middle_s, gain, returned.collect()]
}

/// Generic directions, along which structure may be left that no cause explains: powers of
/// output, rate and their products, lags of them, trends.
pub(crate) fn generic(inputs: &[f64], law: &[f64], spread: f64, step_s: f64) -> Vec<Vec<f64>> {
    let n = law.len();
    let middle = law.first().copied().unwrap_or_default();
    let x: Vec<f64> = law.iter().map(|h| (h - middle) / spread).collect();
    let duration = step_s * n as f64;
    let mut all: Vec<Vec<f64>> = Vec::new();
    for power in [2, 3, 4, 5] {
        all.push(x.iter().map(|v| v.powi(power)).collect());
    }
    for tau in [1e-3, 5e-3, 0.03, 0.2, 2.0] {
        let late: Vec<f64> = lagged(&x, tau, step_s).iter().zip(&x).map(|(a, b)| a - b).collect();
        all.push(late.iter().zip(&x).map(|(d, v)| d * v).collect());
        all.push(late.iter().zip(&x).map(|(d, v)| d * v * v).collect());
        all.push(late.iter().map(|d| d * d.abs()).collect());
        all.push(late.iter().map(|d| d * d).collect());
        all.push(late.iter().map(|d| d.powi(3)).collect());
        let twice: Vec<f64> = lagged(&late, tau, step_s);
        all.push(twice);
        all.push(late);
    }
    let trend = |i: usize| i as f64 * step_s / duration - 0.5;
    all.push(x.iter().enumerate().map(|(i, v)| trend(i) * v).collect());
    all.push((0..n).map(trend).collect());
    let middle_in = inputs.first().copied().unwrap_or_default();
    let scale = inputs.iter().map(|u| (u - middle_in).abs()).fold(1e-300, f64::max);
    all.push(inputs.iter().map(|u| ((u - middle_in) / scale).powi(3)).collect());
    all.push(inputs.iter().map(|u| ((u - middle_in) / scale).powi(2)).collect());
    let dose: Vec<f64> =
        lagged(&x.iter().map(|v| v * v).collect::<Vec<_>>(), 0.3 * duration, step_s);
    all.push(dose.iter().zip(&x).map(|(d, v)| d * v).collect());
    all
}

//! Surrogate truths: other hysteresis families with nothing missing, and what the base model leaves of
//! them.
//!
//! Each family is fitted to the static part of the base model on the reference runs, simulated on
//! reference and measured inputs with the ordinary creep and relaxation, and the base model is fitted
//! to it anew. What it then misses on the measured runs is structure that any base model may leave with
//! nothing missing: the floor of every decision.

use crate::base::BaseModel;
use crate::numbers::less;
use crate::plays::lagged;
use crate::record::Record;
use model_gap::NoiseDraw;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::mean_square;

/// Relays of the relay surrogate.
const RELAYS: usize = 700;
/// Plays of the surrogates of plays.
const PLAYS: usize = 11;
/// Largest factor by which the structure left of a surrogate is scaled to that left of the data.
const LARGEST_SCALE: f64 = 3.0;
/// Least factor, for surrogates that are harder to describe than the data.
const LEAST_SCALE: f64 = 0.33;
/// Part of the relaxation that depends on the state in some surrogates.
const STATE_PART: f64 = 0.1;

/// A family of hysteresis, linear in the weights of its features.
enum Family {
    /// Plays of other half-widths: with cubic maps (generalised play), or straight with a cubic envelope
    /// (Prandtl-Ishlinskii).
    Plays {
        /// Whether the maps are cubic.
        cubic: bool,
    },
    /// Bouc-Wen with a cubic gain.
    BoucWen {
        /// Rise of the state, over the half range.
        rise: f64,
    },
    /// Relays at quasi-random places of the triangle: up and down thresholds and half-width.
    Relays(Vec<[f64; 3]>),
}

/// What the base model leaves of each surrogate on the measured runs.
pub(crate) fn structures(
    base: &BaseModel,
    reference: &[&Record],
    measured: &[&Record],
    range: (f64, f64),
) -> Vec<Vec<Vec<f64>>> {
    let rises = [0.1, 0.2, 0.35, 0.6].map(|rise| Family::BoucWen { rise });
    let families = vec![
        (vec![Family::Plays { cubic: true }], 0.0),
        (vec![Family::Plays { cubic: false }], STATE_PART),
        (rises.into(), 0.0),
        (vec![Family::Relays(relays(1))], -STATE_PART),
        (vec![Family::Relays(relays(2))], 0.0),
    ];
    families
        .into_par_iter()
        .filter_map(|(shapes, state)| {
            let truth = Truth::best(shapes, base, reference, range)?;
            left_of(&truth, state, base, reference, measured, range)
        })
        .collect()
}

/// What the base model leaves of one surrogate, whose relaxation depends on its state by a part.
fn left_of(
    truth: &Truth,
    state: f64,
    base: &BaseModel,
    reference: &[&Record],
    measured: &[&Record],
    range: (f64, f64),
) -> Option<Vec<Vec<f64>>> {
    let simulate = |run: &Record| -> Vec<f64> {
        let law = truth.outputs(&run.input);
        let middle = law.first().copied().unwrap_or_default();
        let relaxed = base.relaxed(&law, run.step_s);
        let late = |(y, h): (&f64, &f64)| y + state * (y - h) * (h - middle) / base.spread;
        relaxed.iter().zip(&law).map(late).collect()
    };
    let copies: Vec<Record> = (0x1234_5678_u64..)
        .zip(reference)
        .map(|(seed, run)| {
            let mut output = simulate(run);
            let noise = NoiseDraw::SHARP.noise_of(&base.residual(run));
            let judged = output.iter_mut().skip(run.window.start);
            judged.zip(NoiseDraw::SHARP.again(&noise, seed)).for_each(|(y, e)| *y += e);
            Record { output, ..(*run).clone() }
        })
        .collect();
    let copies: Vec<&Record> = copies.iter().collect();
    let again = BaseModel::fit(&copies, range, Some(base.prior))?;
    let scale = (base.floor / again.floor.max(1e-6)).clamp(LEAST_SCALE, LARGEST_SCALE);
    let left = |run: &&Record| {
        let left = less(&simulate(run), &again.predict(&run.input, run.step_s));
        left.into_iter().map(|left| scale * left).collect()
    };
    Some(measured.iter().map(left).collect())
}

/// A surrogate: features of the input with weights.
struct Truth {
    family: Family,
    /// Middle and half of the range of the input.
    span: (f64, f64),
    weights: DVector<f64>,
}

impl Truth {
    /// The one of some shapes that describes the static part of the base model best.
    fn best(
        shapes: Vec<Family>,
        base: &BaseModel,
        runs: &[&Record],
        (low, high): (f64, f64),
    ) -> Option<Self> {
        let targets: Vec<Vec<f64>> = runs.iter().map(|r| base.hysteresis(&r.input)).collect();
        let mut best: Option<(f64, Self)> = None;
        for family in shapes {
            let span = (0.5 * (low + high), 0.5 * (high - low));
            let mut truth = Self { family, span, weights: DVector::zeros(0) };
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
            let left = |(run, target): (&&Record, &Vec<f64>)| {
                mean_square(&less(&truth.outputs(&run.input), target))
            };
            let error = runs.iter().zip(&targets).map(left).sum();
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
        let (middle, half) = self.span;
        let x: Vec<f64> = inputs.iter().map(|u| (u - middle) / half).collect();
        let Some(&first) = x.first() else { return };
        match &self.family {
            Family::BoucWen { rise } => {
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
            Family::Relays(places) => {
                // states by the sign of the distance to the middle of each relay, as after a long rest
                let mut states: Vec<f64> =
                    places.iter().map(|p| (first - 0.5 * (p[0] + p[1])).signum()).collect();
                for (i, &u) in x.iter().enumerate() {
                    let mut row = [0.0; 12];
                    row[..3].copy_from_slice(&[1.0, u, u * u * u]);
                    for (state, p) in states.iter_mut().zip(places) {
                        if u >= p[0] {
                            *state = 1.0;
                        } else if u <= p[1] {
                            *state = -1.0;
                        }
                        // nine patches of the triangle, each with its own weight
                        row[3 + bump(p[2])] += *state;
                    }
                    visit(i, &row);
                }
            }
            Family::Plays { cubic } => {
                let mut states = [first; PLAYS];
                let mut row = Vec::new();
                for (i, &u) in x.iter().enumerate() {
                    row.clear();
                    row.extend([1.0, u, u * u, u * u * u]);
                    for (k, p) in states.iter_mut().enumerate() {
                        let r = 0.95 * (k as f64 + 0.5) / PLAYS as f64;
                        *p = p.min(u + r).max(u - r);
                        row.push(*p);
                        if *cubic {
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
/// output, rate and their products, lags of them, trends. Beside the spread of the output stands how many times slower
/// than a usual bench the runs are.
pub(crate) fn generic(
    inputs: &[f64],
    law: &[f64],
    (spread, slower): (f64, f64),
    step_s: f64,
) -> Vec<Vec<f64>> {
    let middle = law.first().copied().unwrap_or_default();
    let x: Vec<f64> = law.iter().map(|h| (h - middle) / spread).collect();
    let duration = step_s * law.len() as f64;
    let of = |signal: &[f64], f: &dyn Fn(f64) -> f64| -> Vec<f64> {
        signal.iter().map(|v| f(*v)).collect()
    };
    let times = |a: &[f64], f: &dyn Fn(f64, f64) -> f64| -> Vec<f64> {
        a.iter().zip(&x).map(|(a, v)| f(*a, *v)).collect()
    };
    let mut all: Vec<Vec<f64>> = Vec::new();
    for power in [2, 3, 4, 5] {
        all.push(of(&x, &|v| v.powi(power)));
    }
    for tau in [1e-3, 5e-3, 0.03, 0.2, 2.0].map(|tau| tau * slower) {
        let late = less(&lagged(&x, tau, step_s), &x);
        all.extend([
            times(&late, &|d, v| d * v),
            times(&late, &|d, v| d * v * v),
            of(&late, &|d| d * d.abs()),
            of(&late, &|d| d * d),
            of(&late, &|d| d.powi(3)),
            lagged(&late, tau, step_s),
            late,
        ]);
    }
    let trend: Vec<f64> = (0..law.len()).map(|i| i as f64 * step_s / duration - 0.5).collect();
    let middle_in = inputs.first().copied().unwrap_or_default();
    let scale = inputs.iter().map(|u| (u - middle_in).abs()).fold(1e-300, f64::max);
    let dose = lagged(&of(&x, &|v| v * v), 0.3 * duration, step_s);
    all.extend([
        times(&trend, &|t, v| t * v),
        trend,
        of(inputs, &|u| ((u - middle_in) / scale).powi(3)),
        of(inputs, &|u| ((u - middle_in) / scale).powi(2)),
        times(&dose, &|d, v| d * v),
    ]);
    all
}

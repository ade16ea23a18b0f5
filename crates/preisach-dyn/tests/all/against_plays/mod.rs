//! Identification without options against fifteen lines of non-negative least squares of plays.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

mod benches;

use benches::{BENCHES, Bench, Made};
use nalgebra::{DMatrix, DVector};
use preisach_dyn::identify::{BenchRecord, Candidates, Settings, compare_models};
use rayon::prelude::*;

fn deviation(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    (values.iter().map(|y| (y - mean).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

/// The reference: `y = offset + sum_k w_k play_k[u]`, `w_k >= 0`, half-widths from 0 to half the swing, finer where
/// they are small.
struct Plays {
    half_widths_volt: Vec<f64>,
    weights: DVector<f64>,
    offset_deg: f64,
}

impl Plays {
    fn columns(half_widths_volt: &[f64], voltage_volt: &[f64]) -> DMatrix<f64> {
        let mut table = DMatrix::zeros(voltage_volt.len(), half_widths_volt.len());
        for (k, r) in half_widths_volt.iter().enumerate() {
            let mut w = voltage_volt[0];
            for (i, u) in voltage_volt.iter().enumerate() {
                w = w.clamp(u - r, u + r);
                table[(i, k)] = w;
            }
        }
        table
    }

    fn of(records: &[BenchRecord], half_swing_volt: f64) -> Self {
        let half_widths_volt: Vec<f64> =
            (0..24).map(|k| half_swing_volt * (f64::from(k) / 24.0).powf(1.5)).collect();
        let tables: Vec<_> =
            records.iter().map(|r| Self::columns(&half_widths_volt, &r.voltage_volt)).collect();
        let rows = tables
            .iter()
            .flat_map(DMatrix::row_iter)
            .map(|row| row.into_owned())
            .collect::<Vec<_>>();
        let a = DMatrix::from_rows(&rows);
        let y = DVector::from_iterator(
            a.nrows(),
            records.iter().flat_map(|r| r.output_deg.iter().copied()),
        );
        // the offset is free: means off
        let (means, mean) = (a.row_mean(), y.mean());
        let centred = DMatrix::from_fn(a.nrows(), a.ncols(), |i, k| a[(i, k)] - means[k]);
        let (normal, right) = (centred.tr_mul(&centred), centred.tr_mul(&y.add_scalar(-mean)));
        let weights = non_negative(&normal, &right);
        let offset_deg = mean - (means * &weights)[0];
        Self { half_widths_volt, weights, offset_deg }
    }

    fn output_deg(&self, voltage_volt: &[f64]) -> Vec<f64> {
        let table = Self::columns(&self.half_widths_volt, voltage_volt);
        (table * &self.weights).add_scalar(self.offset_deg).iter().copied().collect()
    }
}

/// `min x'Nx/2 - b'x`, `x >= 0`. Source: C. L. Lawson, R. J. Hanson, *Solving Least Squares Problems* (1974), chapter 23.
fn non_negative(normal: &DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    let n = right.len();
    let (mut x, mut free) = (DVector::zeros(n), Vec::<usize>::new());
    let tolerance = 1e-9 * right.amax();
    loop {
        let slope = right - normal * &x;
        let bound = (0..n).filter(|k| !free.contains(k));
        match bound.max_by(|a, b| slope[*a].total_cmp(&slope[*b])) {
            Some(k) if slope[k] > tolerance && free.len() < n => free.push(k),
            _ => return x,
        }
        loop {
            let part = DMatrix::from_fn(free.len(), free.len(), |i, j| normal[(free[i], free[j])]);
            let aim = DVector::from_fn(free.len(), |i, _| right[free[i]]);
            let s = part.lu().solve(&aim).unwrap();
            let reach =
                |(i, &k): (usize, &usize)| if s[i] <= 0.0 { x[k] / (x[k] - s[i]) } else { 1.0 };
            let share = free.iter().enumerate().map(reach).fold(1.0, f64::min);
            for (i, &k) in free.iter().enumerate() {
                x[k] += share * (s[i] - x[k]);
            }
            if share >= 1.0 {
                break;
            }
            free.retain(|&k| x[k] > 1e-14);
            (0..n).filter(|k| !free.contains(k)).for_each(|k| x[k] = 0.0);
        }
    }
}

/// Errors of the held-out runs over the deviation of their truth, percent; then their root mean square.
fn errors(made: &Made, predicted: impl Fn(&[f64], f64) -> Vec<f64>) -> Vec<f64> {
    let of = |truth: &benches::Truth| {
        let y = predicted(&truth.voltage_volt, truth.time_step_s);
        let squares: f64 = y.iter().zip(&truth.output_deg).map(|(a, b)| (a - b).powi(2)).sum();
        100.0 * (squares / y.len() as f64).sqrt() / deviation(&truth.output_deg)
    };
    let mut each: Vec<f64> = made.held_out.iter().map(of).collect();
    each.push((each.iter().map(|e| e * e).sum::<f64>() / each.len() as f64).sqrt());
    each
}

/// Identification and plays on a bench: errors of each, and the model chosen.
fn contest(bench: &Bench, seed: u64, noise: f64) -> ([Vec<f64>; 2], String) {
    let made = bench.made(seed, noise);
    let settings = Settings { range_volt: made.range, ..Settings::default() };
    let table = compare_models(&made.records, &settings, &Candidates::default(), &|| ()).unwrap();
    if std::env::var("ROWS").is_ok() {
        for row in table.rows.iter().chain(&table.orders) {
            let Ok(fitted) = &row.fitted else { continue };
            let e = errors(&made, |u, h| {
                fitted
                    .model
                    .simulate(u, h)
                    .unwrap()
                    .output_deg
                    .iter()
                    .map(|y| y + table.zero_deg)
                    .collect()
            });
            println!(
                "    {:45} {:?} cv {:.4} noise {:.4} truth {}",
                row.family.name(),
                (row.order.levels, row.order.static_smoothness),
                100.0 * row.cross_validation.unwrap_or(f64::NAN),
                100.0 * row.noise,
                words(&e)
            );
        }
    }
    let (model, best) = (table.model().unwrap(), table.best().unwrap());
    let own = errors(&made, |u, h| {
        model.simulate(u, h).unwrap().output_deg.iter().map(|y| y + table.zero_deg).collect()
    });
    let plays = Plays::of(&made.records, 0.5 * made.range.span_volt());
    let plays = errors(&made, |u, _| plays.output_deg(u));
    (
        [own, plays],
        format!(
            "{} {} {:.0e}",
            best.family.name(),
            best.order.levels,
            best.order.static_smoothness
        ),
    )
}

fn words(errors: &[f64]) -> String {
    errors.iter().map(|e| format!("{e:5.2} ")).collect()
}

#[test]
fn identification_beats_plays() {
    let seeds: Vec<u64> = std::env::var("SEEDS")
        .map_or(vec![1], |s| s.split(',').map(|s| s.parse().unwrap()).collect());
    let only = std::env::var("ONLY").ok();
    let noise = std::env::var("NOISE").map_or(0.01, |s| s.parse().unwrap());
    for bench in BENCHES.iter().filter(|b| only.as_ref().is_none_or(|o| b.name == o)) {
        let found: Vec<_> = if std::env::var("ROWS").is_ok() {
            seeds.iter().map(|s| contest(bench, *s, noise)).collect()
        } else {
            seeds.par_iter().map(|s| contest(bench, *s, noise)).collect()
        };
        for (seed, ([own, plays], chosen)) in seeds.iter().zip(found) {
            println!(
                "{:14} {seed:4} identify {} plays {} {:5.2} {chosen}",
                bench.name,
                words(&own),
                words(&plays),
                own[4] / plays[4]
            );
        }
    }
}

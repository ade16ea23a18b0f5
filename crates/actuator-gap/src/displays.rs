//! What residuals look like, as tables to draw: harmonics, and maps over input, rate, time since the last
//! reversal and dose of drive. Each shows a kind of cause: slopes over amplitude and frequency, flat
//! tops, creep, heat.

use crate::numbers::range;
use model_gap::{HarmonicFit, Sine};
use rotor_base::mean;
use std::fmt::Write;

/// Harmonics of a table.
const HARMONICS: usize = 9;
/// Bins of the input, and of its rate, of a map.
const INPUT_BINS: usize = 24;
const RATE_BINS: usize = 11;
/// Bins of the time since a reversal, four per decade from 1 ms on.
const TIME_BINS: usize = 20;
const PER_DECADE: f64 = 4.0;
const SHORTEST_S: f64 = 1e-3;
/// Bins of the dose.
const DOSE_BINS: usize = 12;

/// Input and residuals of a run.
pub(super) struct Shown<'a> {
    pub(super) id: &'a str,
    pub(super) step_s: f64,
    pub(super) input: &'a [f64],
    pub(super) before: &'a [f64],
    pub(super) after: &'a [f64],
}

/// Residuals that fell into a bin.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Bin {
    count: f64,
    sum: [f64; 2],
    square: [f64; 2],
}

impl Bin {
    fn add(&mut self, residuals: [f64; 2]) {
        self.count += 1.0;
        for (i, r) in residuals.into_iter().enumerate() {
            self.sum[i] += r;
            self.square[i] += r * r;
        }
    }

    /// The columns of a bin.
    fn head(unit: &str) -> String {
        format!("samples,mean_before_{unit},rms_before_{unit},mean_after_{unit},rms_after_{unit}\n")
    }

    /// Samples, mean and rms before, mean and rms after; none of an empty bin.
    fn row(&self) -> Option<String> {
        let Self { count, sum, square } = *self;
        let [a, b] = [0, 1].map(|i| (sum[i] / count, (square[i] / count).sqrt()));
        (count > 0.0).then(|| format!("{count},{:.6e},{:.6e},{:.6e},{:.6e}", a.0, a.1, b.0, b.1))
    }
}

/// Place of a share of 0 to 1 among bins.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of a count is a place in it"
)]
fn bin_of(share: f64, bins: usize) -> usize {
    ((share.clamp(0.0, 1.0) * bins as f64) as usize).min(bins - 1)
}

/// All displays, by name.
pub(super) fn displays(runs: &[Shown<'_>], unit: &str) -> Vec<(String, String)> {
    vec![
        ("residual_harmonics.csv".to_owned(), harmonics(runs, unit)),
        ("residual_map_input_rate.csv".to_owned(), input_and_rate(runs, unit)),
        ("residual_map_since_reversal.csv".to_owned(), since_reversal(runs, unit)),
        ("residual_map_dose.csv".to_owned(), dose(runs)),
    ]
}

/// Harmonics of the residuals of every sine, 1 to 9 as far as sampling carries them.
fn harmonics(runs: &[Shown<'_>], unit: &str) -> String {
    let mut text = format!(
        "run,frequency_hz,input_amplitude,harmonic,before_{unit},before_phase_deg,after_{unit},after_phase_deg\n"
    );
    for run in runs {
        let Some(sine) = Sine::of(run.input, run.step_s) else { continue };
        let Sine { frequency_hz, amplitude, samples, .. } = sine;
        let is_carried = |n: &usize| *n as f64 * frequency_hz < 0.45 / run.step_s;
        let carried = (1..=HARMONICS).rev().find(is_carried);
        let fit = |residual: &[f64]| {
            let own = residual.get(samples.clone())?;
            HarmonicFit::of(own, run.step_s, frequency_hz, carried?).ok()
        };
        let (Some(before), Some(after)) = (fit(run.before), fit(run.after)) else { continue };
        for (i, (a, b)) in before.harmonics.iter().zip(&after.harmonics).enumerate() {
            // writing into a string does not fail
            let _ = writeln!(
                text,
                "{},{frequency_hz:.6},{amplitude:.6},{},{:.6e},{:.3},{:.6e},{:.3}",
                run.id,
                i + 1,
                a.amplitude(),
                a.phase_deg(),
                b.amplitude(),
                b.phase_deg()
            );
        }
    }
    text
}

/// Residuals over input and rate of the input; rates beyond nine tenths of all are put to the ends.
fn input_and_rate(runs: &[Shown<'_>], unit: &str) -> String {
    let (low, high) = range(runs.iter().flat_map(|r| r.input));
    let rate = |run: &Shown<'_>, i: usize| (run.input[i] - run.input[i - 1]) / run.step_s;
    let mut sizes: Vec<f64> =
        runs.iter().flat_map(|r| (1..r.input.len()).map(|i| rate(r, i).abs())).collect();
    sizes.sort_by(f64::total_cmp);
    let most = sizes.get(sizes.len() * 9 / 10).copied().unwrap_or(1.0).max(1e-12);
    let mut bins = vec![[Bin::default(); RATE_BINS]; INPUT_BINS];
    for run in runs {
        for i in 1..run.before.len().min(run.input.len()) {
            let u = bin_of((run.input[i] - low) / (high - low).max(1e-300), INPUT_BINS);
            let v = bin_of(0.5 + 0.5 * rate(run, i) / most, RATE_BINS);
            bins[u][v].add([run.before[i], run.after[i]]);
        }
    }
    let mut text = format!("input,rate_per_s,{}", Bin::head(unit));
    for (u, row) in bins.iter().enumerate() {
        for (v, bin) in row.iter().enumerate() {
            let Some(row) = bin.row() else { continue };
            let input = low + (high - low) * (u as f64 + 0.5) / INPUT_BINS as f64;
            let rate = most * (2.0 * (v as f64 + 0.5) / RATE_BINS as f64 - 1.0);
            let _ = writeln!(text, "{input:.6},{rate:.6},{row}");
        }
    }
    text
}

/// Residuals in the direction of the last move, over the time since the input last turned or stopped.
fn since_reversal(runs: &[Shown<'_>], unit: &str) -> String {
    let mut bins = [Bin::default(); TIME_BINS];
    for run in runs {
        let (mut direction, mut turned) = (0.0_f64, 0);
        for i in 1..run.before.len().min(run.input.len()) {
            let change = run.input[i] - run.input[i - 1];
            if change * direction < 0.0 || (direction == 0.0 && change != 0.0) {
                turned = i;
            }
            if change != 0.0 {
                direction = change.signum();
            }
            let time_s = (i - turned) as f64 * run.step_s;
            let share = (time_s.max(SHORTEST_S) / SHORTEST_S).log10() * PER_DECADE;
            let bin = bin_of(share / TIME_BINS as f64, TIME_BINS);
            bins[bin].add([direction * run.before[i], direction * run.after[i]]);
        }
    }
    let mut text = format!("since_reversal_s,{}", Bin::head(unit));
    for (i, bin) in bins.iter().enumerate() {
        let Some(row) = bin.row() else { continue };
        let time_s = SHORTEST_S * 10.0_f64.powf((i as f64 + 0.5) / PER_DECADE);
        let _ = writeln!(text, "{time_s:.6e},{row}");
    }
    text
}

/// Gain of the residuals on the input over the dose of drive, the sum of `|du| |u - mean|` since the run
/// began, which grows with `f V^2`; in units of the largest dose of all runs.
fn dose(runs: &[Shown<'_>]) -> String {
    let doses = |run: &Shown<'_>| -> (f64, Vec<f64>) {
        let mean = mean(run.input);
        let mut sum = 0.0;
        let grown = |(u, before): (&f64, &f64)| {
            sum += (u - before).abs() * (u - mean).abs();
            sum
        };
        // the first sample has not moved
        let before = run.input.first().into_iter().chain(run.input);
        (mean, run.input.iter().zip(before).map(grown).collect())
    };
    let all: Vec<(f64, Vec<f64>)> = runs.iter().map(doses).collect();
    let largest = all.iter().filter_map(|d| d.1.last()).fold(1e-300_f64, |m, d| m.max(*d));
    let mut sums = [[0.0_f64; 3]; DOSE_BINS];
    for (run, (mean, dose)) in runs.iter().zip(&all) {
        for i in 0..run.before.len().min(run.input.len()) {
            let x = run.input[i] - mean;
            let bin = &mut sums[bin_of(dose[i] / largest, DOSE_BINS)];
            bin[0] += x * x;
            bin[1] += x * run.before[i];
            bin[2] += x * run.after[i];
        }
    }
    let mut text = String::from("dose,gain_before,gain_after\n");
    for (i, [square, before, after]) in sums.iter().enumerate().filter(|(_, s)| s[0] > 0.0) {
        let place = (i as f64 + 0.5) / DOSE_BINS as f64;
        let _ = writeln!(text, "{place:.4},{:.6e},{:.6e}", before / square, after / square);
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn column(text: &str, name: &str) -> Vec<f64> {
        let mut lines = text.lines();
        let place = lines.next().unwrap().split(',').position(|c| c == name).unwrap();
        lines.map(|l| l.split(',').nth(place).unwrap().parse().unwrap()).collect()
    }

    #[test]
    fn displays_show_what_was_put_in() {
        let step_s = 1e-3;
        let input: Vec<f64> =
            (0..4000).map(|i| 10.0 * (TAU * 5.0 * step_s * f64::from(i)).sin()).collect();
        // a third harmonic of 0.2, nothing left afterwards
        let third = |i: u32| 0.2 * (TAU * 15.0 * step_s * f64::from(i)).sin();
        let before: Vec<f64> = (0..4000).map(third).collect();
        let after = vec![0.0; 4000];
        let run = Shown { id: "a", step_s, input: &input, before: &before, after: &after };
        let tables = displays(&[run], "um");
        let harmonics = &tables[0].1;
        let third = column(harmonics, "before_um")[2];
        assert!((third - 0.2).abs() < 1e-3, "{third}");
        assert!(column(harmonics, "after_um").iter().all(|a| *a < 1e-12));
        let samples: f64 = column(&tables[1].1, "samples").iter().sum();
        assert!((samples - 3999.0).abs() < 0.5);
        let since: f64 = column(&tables[2].1, "samples").iter().sum();
        assert!((since - 3999.0).abs() < 0.5);
        // a gain that grows with the dose
        let growing: Vec<f64> = (0..).zip(&input).map(|(i, u)| 1e-6 * f64::from(i) * u).collect();
        let run = Shown { id: "b", step_s, input: &input, before: &growing, after: &after };
        let gain = column(&displays(&[run], "um")[3].1, "gain_before");
        assert!(gain.windows(2).all(|w| w[1] > w[0]), "{gain:?}");
        assert!((gain[11] - 4e-3).abs() < 4e-4, "{gain:?}");
    }
}

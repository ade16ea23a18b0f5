//! The Bouc-Wen benchmark of the workshops on nonlinear system identification, its data made here.
//!
//! ```text
//! m y'' + c y' + k y + z = u,   z' = alpha y' - beta (gamma |y'| z + delta y' |z|)
//! ```
//! Newton where the product has volt, millimetre where it has degrees. Parameters, signals, noise and integration as in
//! J. P. Noël, M. Schoukens, *Hysteretic benchmark with a dynamic nonlinearity* (2016): average acceleration (Newmark)
//! at 15 kHz, filtered and taken at 750 Hz; estimated with noise of 8e-3 mm, tested without. Differs from source: its
//! integrator is not published as text, its random phases are others, the multisines of the estimation rise from
//! zero, and the sweep has no run-in.

use std::f64::consts::{PI, TAU};
use std::ops::RangeInclusive;
use std::sync::LazyLock;

use chacha20::ChaCha8Rng;
use preisach_dyn::identify::{
    BenchRecord, Candidates, Family, FlapZero, ModelComparison, RecordUse, RecordWindows, Settings,
    compare_models,
};
use preisach_dyn::{ActuatorLaw, VoltageRange};
use rand::{RngExt as _, SeedableRng};
use rand_distr::{Distribution, Normal};
use rayon::prelude::*;
use validation::{Check, Failure, row, shared, too_few};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-ACT-40",
        "Bouc-Wen benchmark, model picked by cross-validation on three noisy multisines: rms error, test multisine",
        "um",
    )
    .against("Iacob et al. (2025), Table 1: black boxes 7.53 to 26.5, linear 160")
    .at_most(7.53, || error_um("test multisine")),
    row("V-ACT-41", "the same: rms error, sweep from 20 to 50 Hz", "um")
        .against("the noise of the estimation, 8 um")
        .at_most(8.0, || error_um("sweep")),
    row("V-ACT-42", "the same, best model without a mode, test multisine", "um")
        .against("spread of the output, some 660 um")
        .at_least(100.0, without_mode_um),
    row("V-ACT-43", "the same: natural frequency at small amplitude", "Hz")
        .against("sqrt((k + alpha) / m) / 2 pi")
        .near(35.588, 0.1, frequency_hz),
];

const MASS_KG: f64 = 2.0;
const DAMPING: f64 = 10.0;
const STIFFNESS: f64 = 5e4;
const ALPHA: f64 = 5e4;
const BETA: f64 = 1e3;
const GAMMA: f64 = 0.8;
const DELTA: f64 = -1.1;
/// Sampling frequency, Hz, and steps of the integration per sample.
const SAMPLED_HZ: f64 = 750.0;
const FINER: usize = 20;
/// Samples of a period of the multisine.
const PERIOD: usize = 8192;
/// Samples over which the force of an estimation rises from zero.
const RUN_IN: usize = 200;
/// Noise of the estimation, mm.
const NOISE_MM: f64 = 8e-3;

/// Lines of the multisine, 5 to 150 Hz.
const LINES: RangeInclusive<u32> = 54..=1639;

/// A multisine of random phases, rms 50 N, over one period of the integration.
fn multisine(rng: &mut ChaCha8Rng) -> Vec<f64> {
    let count = PERIOD * FINER;
    let mut sum = vec![0.0; count];
    for line in LINES {
        let (turn_sine, turn_cosine) = (TAU * f64::from(line) / count as f64).sin_cos();
        let (mut sine, mut cosine) = (TAU * rng.random::<f64>()).sin_cos();
        for value in &mut sum {
            *value += cosine;
            (cosine, sine) =
                (cosine * turn_cosine - sine * turn_sine, sine * turn_cosine + cosine * turn_sine);
        }
    }
    let rms = rotor_base::mean_square(&sum).sqrt();
    sum.iter().map(|value| 50.0 * value / rms).collect()
}

/// 40 N from 20 to 50 Hz at 10 Hz a minute, from rest.
fn sweep() -> Vec<f64> {
    const COUNT: u32 = 180 * 15_000;
    let (from_hz, hz_per_s) = (20.0, 10.0 / 60.0);
    let at = |i: u32| {
        let t = f64::from(i) / (SAMPLED_HZ * FINER as f64);
        40.0 * (TAU * (from_hz * t + 0.5 * hz_per_s * t * t)).sin()
    };
    (0..COUNT).map(at).collect()
}

/// Displacement under a force, mm: average acceleration, the hysteretic force by the trapezoidal rule, both solved to
/// rounding.
fn integrated(force: &[f64]) -> Vec<f64> {
    let h = 1.0 / (SAMPLED_HZ * FINER as f64);
    let z_rate = |v: f64, z: f64| ALPHA * v - BETA * (GAMMA * v.abs() * z + DELTA * v * z.abs());
    let acceleration =
        |u: f64, y: f64, v: f64, z: f64| (u - DAMPING * v - STIFFNESS * y - z) / MASS_KG;
    let (mut y, mut v, mut z) = (0.0, 0.0, 0.0);
    let mut a = acceleration(force[0], y, v, z);
    let mut out = Vec::with_capacity(force.len());
    out.push(0.0);
    for u in &force[1..] {
        let mut next = (a, z);
        for _ in 0..8 {
            let v_next = v + 0.5 * h * (a + next.0);
            let y_next = y + h * v + 0.25 * h * h * (a + next.0);
            let z_next = z + 0.5 * h * (z_rate(v, z) + z_rate(v_next, next.1));
            next = (acceleration(*u, y_next, v_next, z_next), z_next);
        }
        y += h * v + 0.25 * h * h * (a + next.0);
        v += 0.5 * h * (a + next.0);
        (a, z) = next;
        out.push(1e3 * y);
    }
    out
}

/// Every twentieth value behind a low pass at 375 Hz: a sinc under a Hamming window of 16 samples to either side, the
/// signal held at its ends.
fn decimated(fine: &[f64]) -> Vec<f64> {
    let reach = 16 * FINER;
    let weights: Vec<f64> = (0..=2 * reach)
        .map(|k| {
            let off = k as f64 - reach as f64;
            let turn = PI * off / FINER as f64;
            let sinc = if k == reach { 1.0 } else { turn.sin() / turn };
            sinc * (0.54 + 0.46 * (PI * off / reach as f64).cos())
        })
        .collect();
    let sum: f64 = weights.iter().sum();
    let last = fine.len() - 1;
    let at = |centre: usize| {
        let near = (0..).map(|k| fine[(centre + k).saturating_sub(reach).min(last)]);
        weights.iter().zip(near).map(|(w, y)| w * y).sum::<f64>() / sum
    };
    (0..fine.len()).step_by(FINER).map(at).collect()
}

fn record(id: &str, force: &[f64], record_use: RecordUse) -> BenchRecord {
    BenchRecord {
        id: id.into(),
        time_step_s: 1.0 / SAMPLED_HZ,
        voltage_volt: force.iter().step_by(FINER).copied().collect(),
        output_deg: decimated(&integrated(force)),
        record_use: Some(record_use),
        ..BenchRecord::default()
    }
}

/// Three multisines from rest with noise; a period of another in its steady state and the sweep, without.
fn records() -> Result<Vec<BenchRecord>, Failure> {
    let made = (0..5_u64).into_par_iter().map(|k| {
        let mut rng = ChaCha8Rng::seed_from_u64(1610 + k);
        match k {
            3 => {
                let periods = multisine(&mut rng).repeat(3);
                let mut test = record("test multisine", &periods, RecordUse::HeldOut);
                test.windows = RecordWindows { train: None, judge: Some(2 * PERIOD..3 * PERIOD) };
                Ok(test)
            }
            4 => Ok(record("sweep", &sweep(), RecordUse::HeldOut)),
            _ => {
                let mut own = multisine(&mut rng);
                let run_in = RUN_IN * FINER;
                let fade = |(k, u): (usize, &mut f64)| *u *= k as f64 / run_in as f64;
                own.iter_mut().take(run_in).enumerate().for_each(fade);
                let mut own = record(&format!("multisine {k}"), &own, RecordUse::Train);
                let normal = Normal::new(0.0, NOISE_MM)?;
                for y in &mut own.output_deg {
                    *y += normal.sample(&mut rng);
                }
                Ok(own)
            }
        }
    });
    made.collect()
}

static TABLE: LazyLock<Result<ModelComparison, Failure>> = LazyLock::new(|| {
    let records = records()?;
    let settings = Settings {
        range_volt: VoltageRange::new(-260.0, 260.0)?,
        levels: 12,
        zero: FlapZero::AsRecorded,
        ..Settings::default()
    };
    let candidates =
        Candidates { families: Family::ALL.to_vec(), orders: Vec::new(), ..Candidates::default() };
    Ok(compare_models(&records, &settings, &candidates, &|| ())?)
});

/// Rms error of a row on a record, um.
fn of_row(table: &ModelComparison, place: usize, id: &str) -> Result<f64, Failure> {
    let record = table.records.iter().position(|(own, _)| own == id);
    let fitted = table.rows[place].fitted.as_ref();
    let (Some(record), Ok(fitted)) = (record, fitted) else {
        return Err(too_few("fits of the record", 0, 1));
    };
    let spreads = shared(&SPREADS_UM)?;
    Ok(fitted.fits[record].nrmse * spreads[record])
}

/// Spread of the judged outputs, um.
static SPREADS_UM: LazyLock<Result<Vec<f64>, Failure>> = LazyLock::new(|| {
    let of = |r: &BenchRecord| rotor_base::variance(&r.output_deg[r.judged_samples()]).sqrt();
    Ok(records()?.iter().map(|r| 1e3 * of(r)).collect())
});

fn error_um(id: &str) -> Result<f64, Failure> {
    let table = shared(&TABLE)?;
    of_row(table, table.chosen, id)
}

fn without_mode_um() -> Result<f64, Failure> {
    let table = shared(&TABLE)?;
    let rows = (0..table.rows.len()).filter(|k| !table.rows[*k].family.has_mode());
    let errors = rows.filter_map(|place| of_row(table, place, "test multisine").ok());
    Ok(errors.fold(f64::INFINITY, f64::min))
}

fn frequency_hz() -> Result<f64, Failure> {
    match shared(&TABLE)?.model().map(|model| &model.law) {
        Some(ActuatorLaw::HystereticOscillator(law)) => Ok(law.parameters().frequency_hz),
        _ => Ok(f64::NAN),
    }
}

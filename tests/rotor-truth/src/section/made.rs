//! A set of section loads: motions and effect drawn by the seed, solved, put into text.

use super::effect::{CATALOGUE, apply};
use super::layout::{Layout, Run};
use super::specimen::Specimen;
use super::theory::Motion;
use crate::asked::{Answer, Asked, Made, chosen};
use crate::draw::{Draw, checked_size, normal, stream};
use crate::error::RotorTruthError;
use chacha20::ChaCha8Rng;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Rows of a history.
const ROWS: u32 = 48;
/// Deviation of the gain of the pressures from one session to the next.
const GAIN: f64 = 0.01;
const LOADS: [&str; 3] = ["cn", "cm", "ch"];

/// The case: a section with its flap; nothing else of it matters.
fn case_ron(layout: &Layout) -> String {
    format!(
        "#![enable(implicit_some, unwrap_variant_newtypes)]\n(\n    title: \"Section in a wind tunnel\",\n    flaps: [\n        \
         (start_r: 0.7, end_r: 0.8, chord_fraction: {}),\n    ],\n    aerodynamics: (\n        model: {}, compressibility: \
         None,\n    ),\n)\n",
        layout.flap_chord, layout.model
    )
}

fn rms(all: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = all.fold((0.0, 0.0), |(sum, count), own| (sum + own * own, count + 1.0));
    f64::sqrt(sum / f64::max(count, 1.0))
}

/// First harmonics per radian, one row a motion. The noise of a load is over its root mean square in all pitching or all flap
/// motions.
fn harmonics(layout: &Layout, own: &Specimen, share: f64, rng: &mut ChaCha8Rng) -> String {
    let loads = if layout.has_hinge { 3 } else { 2 };
    let all: Vec<[[f64; 2]; 3]> = layout.runs.iter().map(|run| own.harmonic(run)).collect();
    let deviation = |motion: Motion, load: usize| {
        let alike = layout.runs.iter().zip(&all).filter(|(run, _)| run.motion == motion);
        share * rms(alike.map(|(_, own)| own[load][0].hypot(own[load][1])))
    };
    let mut out = String::from("point,group,motion,mach,reduced_frequency,frequency_hz");
    // writing to a text cannot fail
    for name in &LOADS[..loads] {
        let _ = write!(out, ",{name}_re,{name}_re_sd,{name}_im,{name}_im_sd");
    }
    for (number, (run, own)) in layout.runs.iter().zip(&all).enumerate() {
        let word = if run.motion == Motion::Pitch { "pitch" } else { "flap" };
        let Run { group, mach, reduced_frequency: k, .. } = run;
        let _ = write!(out, "\nm{},{group},{word},{mach},{k},{}", number + 1, run.frequency_hz());
        for (load, parts) in own.iter().enumerate().take(loads) {
            let sd = deviation(run.motion, load);
            for value in parts {
                let _ = write!(out, ",{:.6},{sd:.3e}", value + sd * normal(rng));
            }
        }
    }
    out.push('\n');
    out
}

/// Histories over the phase. The noise is such that a harmonic has the deviation that a first harmonic told alone would have.
fn histories(layout: &Layout, own: &Specimen, share: f64, rng: &mut ChaCha8Rng) -> String {
    let loads = if layout.has_hinge { 3 } else { 2 };
    let mut out =
        String::from("loop,mach,reduced_frequency,frequency_hz,phase_deg,alpha_deg,flap_deg");
    for name in &LOADS[..loads] {
        let _ = write!(out, ",{name}");
    }
    for (number, run) in layout.runs.iter().enumerate() {
        let rows = own.history(run, ROWS);
        let deviations: [f64; 3] = std::array::from_fn(|load| {
            let mean = rows.iter().map(|own| own[load]).sum::<f64>() / f64::from(ROWS);
            let swing = 2.0_f64.sqrt() * rms(rows.iter().map(|own| own[load] - mean));
            share * swing * (0.5 * f64::from(ROWS)).sqrt()
        });
        for (row, k) in rows.iter().zip(0_u32..) {
            let phase = f64::from(k) / f64::from(ROWS);
            let moved = run.amplitude_deg * (TAU * phase).sin();
            let (alpha, flap) = if run.motion == Motion::Pitch {
                (run.mean_deg + own.pitch_read * moved, 0.0)
            } else {
                (run.mean_deg, moved)
            };
            let _ = write!(
                out,
                "\nm{},{},{},{},{},{alpha:.4},{flap:.4}",
                number + 1,
                run.mach,
                run.reduced_frequency,
                run.frequency_hz(),
                360.0 * phase
            );
            for (value, sd) in row.iter().zip(deviations).take(loads) {
                let _ = write!(out, ",{:.6}", value + sd * normal(rng));
            }
        }
    }
    out.push('\n');
    out
}

/// Makes a set.
///
/// # Errors
/// [`RotorTruthError`] of an unknown effect or a number of motions out of range.
pub fn make(asked: &Asked) -> Result<Made, RotorTruthError> {
    let mut of_effect = stream(asked.seed, 0);
    let effect = chosen(&CATALOGUE, asked.effect.as_deref(), &mut of_effect)?;
    checked_size(asked.size)?;
    if let Some(points) = asked.points {
        asked.points_or(points)?;
    }
    let needs_histories = effect.name == "dynamic-stall";
    let mut layout = Layout::draw(&mut stream(asked.seed, 1), asked.points, needs_histories);
    if effect.name == "compressibility" {
        // the other model of the product has no Mach number
        layout.model = "Calibrated";
    }
    let mut own = Specimen::believed(layout.flap_chord);
    let mut base_ratios = BTreeMap::new();
    if asked.base_error {
        let ratio = 1.0 + GAIN * normal(&mut stream(asked.seed, 2)).clamp(-2.5, 2.5);
        own.gain *= ratio;
        base_ratios.insert("gain", ratio);
    }
    let mut draw = Draw::new(&mut of_effect, asked.size);
    let parameters = apply(effect.name, &mut own, &layout, &mut draw);
    let told = if layout.has_histories { histories } else { harmonics };
    let table_csv = told(&layout, &own, asked.noise_share(), &mut stream(asked.seed, 3));
    let answer = Answer {
        effect: effect.name.to_owned(),
        parameters,
        in_library: effect.is_known,
        seed: asked.seed,
        snr_db: asked.snr_db,
        points: layout.runs.len(),
        layout: if layout.has_histories { "histories" } else { "harmonics" },
        base_ratios,
    };
    Ok(Made { table_csv, case_ron: case_ron(&layout), answer })
}

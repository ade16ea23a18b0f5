//! A set of frequencies: blade, speeds and effect drawn by the seed, solved, put into text.

use super::beam::Family;
use super::effect::{CATALOGUE, Reference, Truth, apply};
use super::specimen::Specimen;
use crate::asked::{Answer, Asked, Made, chosen};
use crate::draw::{Draw, checked_size, log_within, normal, stream};
use crate::error::RotorTruthError;
use chacha20::ChaCha8Rng;
use rand::RngExt;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Modes that differ by less than this part are not told apart by their interchange.
const CLOSE: f64 = 0.03;
/// Factor between the noise of the set and that of its best or worst mode.
const SPREAD: f64 = 2.236;

/// Which modes are read at which speeds.
#[derive(Debug, Clone, PartialEq)]
struct Plan {
    speeds_rpm: Vec<f64>,
    modes: Vec<(Family, usize)>,
}

impl Plan {
    /// Rotor speeds from rest to 1.1 of the nominal one; three or four flap, two or three lag, one or two torsion modes.
    fn draw(rng: &mut ChaCha8Rng, nominal_rpm: f64, points: usize) -> Self {
        let step = 1.1 / (points - 1) as f64;
        let speeds_rpm = (0..points)
            .map(|k| {
                let off = if k == 0 { 0.0 } else { rng.random_range(-0.25..0.0) };
                (nominal_rpm * step * (k as f64 + off)).round()
            })
            .collect();
        let counts = [
            (Family::Flap, rng.random_range(3..=4)),
            (Family::Lag, rng.random_range(2..=3)),
            (Family::Torsion, rng.random_range(1..=2)),
        ];
        let of = |(family, count): (Family, usize)| (1..=count).map(move |n| (family, n));
        Self { speeds_rpm, modes: counts.into_iter().flat_map(of).collect() }
    }

    /// Frequencies as read without noise, Hz, by speed and mode.
    fn read(&self, truth: &Truth) -> Result<Vec<Vec<f64>>, RotorTruthError> {
        let at = |rpm: &f64| {
            let omega_rad_s = rpm * truth.speed * TAU / 60.0;
            let mut all = BTreeMap::new();
            for family in [Family::Flap, Family::Lag, Family::Torsion] {
                let count = self.modes.iter().filter(|own| own.0 == family).count();
                all.insert(family, truth.beam.frequencies_hz(family, omega_rad_s, count)?);
            }
            let of = |(family, n): &(Family, usize)| all[family][n - 1] + truth.counter_off_hz;
            Ok(self.modes.iter().map(of).collect())
        };
        self.speeds_rpm.par_iter().map(at).collect()
    }

    /// The pair of modes of two families that lie closest at the middle speed, but not too close to be told apart.
    fn neighbours(&self, hz: &[Vec<f64>]) -> Option<(usize, usize)> {
        let middle = hz.get(hz.len() / 2)?;
        let mut best: Option<(f64, (usize, usize))> = None;
        for a in 0..self.modes.len() {
            for b in (a + 1)..self.modes.len() {
                let gap = (middle[a] / middle[b]).ln().abs();
                let is_pair = self.modes[a].0 != self.modes[b].0 && gap > CLOSE;
                if is_pair && best.is_none_or(|own| gap < own.0) {
                    best = Some((gap, (a, b)));
                }
            }
        }
        best.map(|own| own.1)
    }

    /// The table with noise; each mode has a deviation of its own, over its frequency.
    fn text(&self, hz: &[Vec<f64>], share: f64, rng: &mut ChaCha8Rng) -> String {
        let of_mode: Vec<f64> =
            self.modes.iter().map(|_| share * log_within(rng, 1.0 / SPREAD, SPREAD)).collect();
        let mut out = String::from("rotor_speed_rpm,mode,frequency_hz,frequency_sd_hz\n");
        for (rpm, row) in self.speeds_rpm.iter().zip(hz) {
            for (((family, n), hz), part) in self.modes.iter().zip(row).zip(&of_mode) {
                let sd = part * hz;
                let read = hz + sd * normal(rng);
                // writing to a text cannot fail
                let _ = writeln!(out, "{rpm},{} {n},{read:.6},{sd:.4e}", family.name());
            }
        }
        out
    }
}

/// Makes a set.
///
/// # Errors
/// [`RotorTruthError`] of an unknown effect, a number of speeds out of range, or a blade without modes.
pub fn make(asked: &Asked) -> Result<Made, RotorTruthError> {
    let mut of_effect = stream(asked.seed, 0);
    let effect = chosen(&CATALOGUE, asked.effect.as_deref(), &mut of_effect)?;
    checked_size(asked.size)?;
    let mut of_layout = stream(asked.seed, 1);
    let believed = Specimen::draw(&mut of_layout);
    let points = asked.points_or(of_layout.random_range(5..=9))?;
    let plan = Plan::draw(&mut of_layout, believed.omega_rpm, points);
    let mut own = believed.clone();
    let base_ratios = if asked.base_error {
        own.move_uncertain(&mut stream(asked.seed, 2))
    } else {
        BTreeMap::new()
    };
    let mut truth =
        Truth { beam: own.beam(), speed: 1.0, counter_off_hz: 0.0, is_interchanged: false };
    let reference =
        Reference { radius_m: believed.radius_m, has_offset: believed.root_offset > 0.0 };
    let mut draw = Draw::new(&mut of_effect, asked.size);
    let mut parameters = apply(effect.name, &mut truth, reference, &mut draw);
    let mut hz = plan.read(&truth)?;
    if let Some((a, b)) = plan.neighbours(&hz).filter(|_| truth.is_interchanged) {
        let name = |k: usize| format!("{} {}", plan.modes[k].0.name(), plan.modes[k].1);
        parameters.insert("modes".to_owned(), vec![name(a), name(b)].into());
        for row in &mut hz {
            row.swap(a, b);
        }
    }
    let table_csv = plan.text(&hz, asked.noise_share(), &mut stream(asked.seed, 3));
    let answer = Answer {
        effect: effect.name.to_owned(),
        parameters,
        in_library: effect.is_known,
        seed: asked.seed,
        snr_db: asked.snr_db,
        points,
        layout: if believed.tables.is_some() { "blade with tables" } else { "uniform blade" },
        base_ratios,
    };
    Ok(Made { table_csv, case_ron: believed.case_ron(), answer })
}

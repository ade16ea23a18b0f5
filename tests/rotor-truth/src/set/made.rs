//! A set: effect and layout drawn by the seed, flown, put into text.

use super::catalogue::{CATALOGUE, Entry, entry};
use super::effect::apply;
use super::fly::fly;
use super::layout::Layout;
use super::machine::Machine;
use super::{case, table};
use crate::asked::Asked;
use crate::draw::{Parameters, stream};
use crate::error::RotorTruthError;
use crate::physics::balance::Resolution;
use crate::physics::blade::{Airloads, Blade, Couplings, Lags};
use chacha20::ChaCha8Rng;
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use serde::Serialize;
use std::collections::BTreeMap;

/// What is hidden in a set.
#[derive(Debug, Clone, Serialize)]
pub struct Answer {
    /// Name of the effect.
    pub effect: String,
    /// Its parameters, by the names of the causes.
    pub parameters: Parameters,
    /// Whether the list of the product has it.
    pub in_library: bool,
    /// Seed.
    pub seed: u64,
    /// Noise, dB below the readings.
    pub snr_db: f64,
    /// Number of points.
    pub points: usize,
    /// Whether flaps are driven.
    pub is_driven: bool,
    /// Lags of the sections, in truth and case.
    pub lags: Lags,
    /// True over believed value of the uncertain inputs.
    pub base_ratios: BTreeMap<&'static str, f64>,
}

/// A set as text.
#[derive(Debug, Clone)]
pub struct Made {
    /// The table of points.
    pub sweep_csv: String,
    /// The case of the engineer.
    pub case_ron: String,
    /// What is hidden.
    pub answer: Answer,
}

fn drawn(rng: &mut ChaCha8Rng) -> Entry {
    CATALOGUE[rng.random_range(0..CATALOGUE.len())]
}

/// Moves the uncertain inputs of a blade; returns true over believed values.
fn with_base_error(blade: &mut Blade, rng: &mut ChaCha8Rng) -> BTreeMap<&'static str, f64> {
    let mut out = BTreeMap::new();
    for (field, percent) in case::UNCERTAIN {
        let normal: f64 = StandardNormal.sample(rng);
        let ratio = 1.0 + 0.01 * percent * normal.clamp(-2.5, 2.5);
        let value = match field {
            "rotor.gj" => &mut blade.gj,
            "rotor.ei_flap" => &mut blade.ei_flap,
            "rotor.ei_lag" => &mut blade.ei_lag,
            "rotor.lock_number" => &mut blade.lock_number,
            _ => &mut blade.gyration[1],
        };
        *value *= ratio;
        out.insert(field, ratio);
    }
    out
}

/// Makes a set, the rotor resolved as finely as asked.
///
/// # Errors
/// [`RotorTruthError`] of an unknown effect, a number of points out of range, or a point that does not converge.
pub fn make(asked: &Asked, resolution: Resolution) -> Result<Made, RotorTruthError> {
    let mut rng = stream(asked.seed, 0);
    let chosen = drawn(&mut rng);
    let chosen = asked.effect.as_deref().map_or(Ok(chosen), entry)?;
    let mut of_layout = stream(asked.seed, 1);
    let drawn_points = of_layout.random_range(20..=50);
    let points = asked.points.unwrap_or(drawn_points);
    if !(4..=400).contains(&points) {
        let (what, expected) = ("the number of points", "4 to 400");
        return Err(RotorTruthError::Value { what, value: points as f64, expected });
    }
    let layout = Layout::draw(&mut of_layout, points, chosen.needs_drive);
    // the product's model of Jones's lags has no Mach number that an effect could add
    let has_beddoes = stream(asked.seed, 4).random_range(0..6) == 0;
    let needs_mach = chosen.name == "compressibility";
    let lags = if has_beddoes || needs_mach { Lags::Beddoes } else { Lags::Jones };
    let believed = Blade {
        couplings: Couplings::Third,
        has_twisted_flow: true,
        airloads: Airloads::Unsteady(lags),
        ..Blade::default()
    };
    let mut machine = Machine::believed(believed.clone());
    let base_ratios = if asked.base_error {
        with_base_error(&mut machine.blade, &mut stream(asked.seed, 2))
    } else {
        BTreeMap::new()
    };
    let parameters = apply(chosen.name, asked.size, &mut machine, &layout.drives, &mut rng)?;
    let readings = fly(&machine, &layout.groups, resolution)?;
    let mut noise = stream(asked.seed, 3);
    let sweep_csv = table::text(&layout.groups, &readings, asked.snr_db, &mut noise);
    let answer = Answer {
        effect: chosen.name.to_owned(),
        parameters,
        in_library: chosen.is_known,
        seed: asked.seed,
        snr_db: asked.snr_db,
        points: readings.iter().map(Vec::len).sum(),
        is_driven: layout.drives.is_driven,
        lags,
        base_ratios,
    };
    Ok(Made { sweep_csv, case_ron: case::text(&believed), answer })
}

//! What an effect changes in a blade and in what is read of it, and by how much.

use super::beam::{Beam, Lump, at};
use crate::asked::{Effect, NULL, known, outside};
use crate::draw::{Draw, Parameters, told};
use serde_json::json;

/// Every effect.
pub const CATALOGUE: [Effect; 15] = [
    known(NULL),
    known("stiffness-flap"),
    known("stiffness-lag"),
    known("stiffness-torsion"),
    known("root-offset"),
    known("rotor-speed"),
    known("tip-mass"),
    known("root-compliance"),
    known("mass"),
    outside("mid-span-mass"),
    outside("graded-stiffness"),
    outside("guy"),
    outside("graded-mass"),
    outside("frequency-offset"),
    outside("modes-interchanged"),
];

/// A blade with what reads it.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// The blade.
    pub beam: Beam,
    /// True rotor speed over the stated one.
    pub speed: f64,
    /// Frequency read less the true one, Hz.
    pub counter_off_hz: f64,
    /// Whether two neighbouring modes have each other's name.
    pub is_interchanged: bool,
}

/// What the sizes of effects are over.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reference {
    /// Radius, m.
    pub radius_m: f64,
    /// Whether the believed root lies off the axis.
    pub has_offset: bool,
}

fn times(along: &mut [(f64, f64)], factor: impl Fn(f64) -> f64) {
    for (station, value) in along {
        *value *= factor(*station);
    }
}

/// Puts an effect into a blade; the parameters of none are empty.
pub fn apply(name: &str, truth: &mut Truth, of: Reference, draw: &mut Draw<'_>) -> Parameters {
    of_library(name, truth, of, draw).or_else(|| beyond(name, truth, draw)).unwrap_or_default()
}

/// Stiffness of a root spring whose compliance is a part of that of the blade in bending or torsion, N m/rad.
fn spring(draw: &mut Draw<'_>, stiffness: &[(f64, f64)], length_m: f64) -> f64 {
    let give = draw.log_size(0.01, 0.08);
    if draw.is_given() { give } else { at(stiffness, 0.5) / (give * length_m) }
}

fn of_library(
    name: &str,
    truth: &mut Truth,
    of: Reference,
    draw: &mut Draw<'_>,
) -> Option<Parameters> {
    let beam = &mut truth.beam;
    Some(match name {
        "stiffness-flap" | "stiffness-lag" | "stiffness-torsion" => {
            let ratio = draw.log_ratio(0.05, 0.3);
            let along = match name {
                "stiffness-flap" => &mut beam.ei_flap,
                "stiffness-lag" => &mut beam.ei_lag,
                _ => &mut beam.gj,
            };
            times(along, |_| ratio);
            told([("ratio", json!(ratio))])
        }
        "root-offset" => {
            let (drawn, inward) = (draw.log_size(0.01, 0.06), draw.is_up() && of.has_offset);
            // no root lies beyond the axis
            let inmost = -beam.root_m / of.radius_m;
            let inward = inward && !draw.is_given();
            let offset_r = if inward { (-drawn).max(inmost) } else { drawn.max(inmost) };
            beam.root_m += offset_r * of.radius_m;
            told([("offset_r", json!(offset_r))])
        }
        "rotor-speed" => {
            truth.speed = draw.log_ratio(0.01, 0.06);
            told([("ratio", json!(truth.speed))])
        }
        "tip-mass" => {
            let share = draw.log_size(0.003, 0.05);
            let mass_kg = if draw.is_given() { share } else { share * beam.mass_of_beam_kg() };
            // a cap spread over the chord, or a compact weight
            let gyration = if draw.is_up() { 1.0 } else { 0.3 };
            beam.lumps.push(Lump { station: 1.0, mass_kg, gyration });
            told([("mass_kg", json!(mass_kg)), ("gyration_share", json!(gyration))])
        }
        "root-compliance" => {
            // in flap, in lag, in pitch
            let plane = if draw.is_up() { 0 } else { 1 + usize::from(draw.is_up()) };
            let along = [&beam.ei_flap, &beam.ei_lag, &beam.gj][plane].clone();
            let stiffness = spring(draw, &along, beam.length_m);
            beam.root_spring[plane] = Some(stiffness);
            told([("stiffness", json!(stiffness))])
        }
        "mass" => {
            let ratio = draw.log_ratio(0.03, 0.12);
            times(&mut beam.mass_kg_m, |_| ratio);
            told([("ratio", json!(ratio))])
        }
        _ => return None,
    })
}

/// Effects that the list of the product does not have.
fn beyond(name: &str, truth: &mut Truth, draw: &mut Draw<'_>) -> Option<Parameters> {
    let beam = &mut truth.beam;
    Some(match name {
        "mid-span-mass" => {
            let share = draw.log_size(0.01, 0.08);
            let station = draw.within(0.35, 0.65);
            let mass_kg = share * beam.mass_of_beam_kg();
            beam.lumps.push(Lump { station, mass_kg, gyration: 0.3 });
            told([("share", json!(share)), ("station", json!(station))])
        }
        "graded-stiffness" => {
            // stiffer at one end than stated, softer at the other
            let grade = draw.signed(0.1, 0.35);
            for along in [&mut beam.ei_flap, &mut beam.ei_lag, &mut beam.gj] {
                times(along, |s| 1.0 + grade * (1.0 - 2.0 * s));
            }
            told([("grade", json!(grade))])
        }
        "guy" => {
            let share = draw.log_size(0.5, 8.0);
            let stiffness = share * at(&beam.ei_flap, 0.5) / beam.length_m.powi(3);
            beam.guys.push((0.5, stiffness));
            told([("stiffness_n_m", json!(stiffness))])
        }
        "graded-mass" => {
            let grade = draw.signed(0.1, 0.35);
            times(&mut beam.mass_kg_m, |s| 1.0 + grade * (1.0 - 2.0 * s));
            told([("grade", json!(grade))])
        }
        "frequency-offset" => {
            truth.counter_off_hz = draw.signed(0.1, 0.8);
            told([("offset_hz", json!(truth.counter_off_hz))])
        }
        "modes-interchanged" => {
            truth.is_interchanged = true;
            told([("speeds", json!("all"))])
        }
        _ => return None,
    })
}

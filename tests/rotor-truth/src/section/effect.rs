//! What an effect changes in a section, and by how much.

use super::layout::Layout;
use super::specimen::Specimen;
use super::stall::Stall;
use super::wake::ReturningWake;
use crate::asked::{Effect, NULL, known, outside};
use crate::draw::{Draw, Parameters, told};
use serde_json::json;

/// Every effect.
pub const CATALOGUE: [Effect; 14] = [
    known(NULL),
    known("flap-effectiveness"),
    known("compressibility"),
    known("unsteady-lag"),
    known("timing"),
    known("sensor-gain"),
    known("dynamic-stall"),
    known("pivot-compliance"),
    known("pitch-axis"),
    outside("returning-wake"),
    outside("flap-chord"),
    outside("tunnel-walls"),
    outside("channel-leak"),
    outside("inertia"),
];

/// Puts an effect into a section; the parameters of none are empty.
pub fn apply(name: &str, own: &mut Specimen, layout: &Layout, draw: &mut Draw<'_>) -> Parameters {
    of_library(name, own, layout, draw).or_else(|| beyond(name, own, draw)).unwrap_or_default()
}

fn of_library(
    name: &str,
    own: &mut Specimen,
    layout: &Layout,
    draw: &mut Draw<'_>,
) -> Option<Parameters> {
    Some(match name {
        "flap-effectiveness" => {
            let lift = draw.size(0.65, 0.93);
            let (moment, hinge) = (draw.within(0.85, 1.1), draw.within(0.75, 1.05));
            own.flap = [lift, moment, hinge];
            let mut all = told([("lift", json!(lift)), ("moment", json!(moment))]);
            if layout.has_hinge {
                all.insert("hinge".to_owned(), json!(hinge));
            }
            all
        }
        "compressibility" => {
            own.mach_share = draw.size(0.99, 1.01);
            told([("share", json!(own.mach_share))])
        }
        "unsteady-lag" => {
            // of all that is not at once, or of the wake alone
            let ratio = draw.log_ratio(0.15, 0.8);
            let share = if draw.is_up() { &mut own.unsteady } else { &mut own.wake_lag };
            *share = ratio;
            told([("ratio", json!(ratio))])
        }
        "timing" => {
            own.late_s = draw.log_size(2e-4, 3e-3);
            told([("s", json!(own.late_s))])
        }
        "sensor-gain" => {
            let ratio = draw.log_ratio(0.05, 0.3);
            // what reads the loads, or what reads the pitch
            let reading = if draw.is_up() { &mut own.gain } else { &mut own.pitch_read };
            *reading *= ratio;
            told([("ratio", json!(ratio))])
        }
        "dynamic-stall" => {
            let highest = layout.runs.iter().map(|own| own.mean_deg + own.amplitude_deg);
            let highest = highest.fold(0.0, f64::max);
            // the hardest loop goes some degrees beyond
            let angle_deg = draw.size(highest - 5.0, highest - 1.0);
            own.stall = Some(Stall::at(angle_deg.to_radians()));
            told([("stall_angle_deg", json!(angle_deg))])
        }
        "pitch-axis" => {
            // over the chord, aft positive
            let aft = draw.signed(0.08, 0.5);
            own.geometry.pitch_axis += 2.0 * aft;
            told([("aft_chords", json!(aft))])
        }
        "pivot-compliance" => {
            own.give = draw.log_size(0.06, 0.6);
            told([("semichords_per_cn", json!(own.give))])
        }
        _ => return None,
    })
}

/// Effects that the list of the product does not have.
fn beyond(name: &str, own: &mut Specimen, draw: &mut Draw<'_>) -> Option<Parameters> {
    Some(match name {
        "returning-wake" => {
            let spacing = draw.log_size(4.0, 15.0);
            let travel = draw.log_size(20.0, 100.0);
            own.returning = Some(ReturningWake { spacing, travel });
            told([("spacing_semichords", json!(spacing)), ("travel_semichords", json!(travel))])
        }
        "flap-chord" => {
            let ratio = draw.log_ratio(0.06, 0.3);
            own.geometry.flap_chord *= ratio;
            told([("ratio", json!(ratio))])
        }
        "tunnel-walls" => {
            own.chord_over_height = draw.log_size(0.25, 0.7);
            told([("chord_over_height", json!(own.chord_over_height))])
        }
        "inertia" => {
            let mass = draw.signed(0.5, 3.0);
            own.inertia = [mass, draw.within(0.2, 0.5)];
            told([("cn_per_k2", json!(mass)), ("arm_chords", json!(own.inertia[1]))])
        }
        "channel-leak" => {
            own.leak = draw.signed(0.01, 0.06);
            told([("cn_into_cm", json!(own.leak))])
        }
        _ => return None,
    })
}

//! What an effect changes in a machine, and by how much.

use super::drive::Hysteresis;
use super::layout::Drives;
use super::machine::{MASS_KG_M, Machine, NOMINAL_RPM, OddBlade, RADIUS_M, Upwash};
use super::path::SupportMode;
use crate::draw::{Draw, Parameters, checked_size, told};
use crate::error::RotorTruthError;
use crate::physics::blade::Stall;
use crate::physics::inflow::InflowKind;
use chacha20::ChaCha8Rng;
use serde_json::json;

/// `m0 Omega^2 R^3` at nominal speed, N m.
fn nominal_moment_newton_metre() -> f64 {
    let omega = NOMINAL_RPM * std::f64::consts::TAU / 60.0;
    MASS_KG_M * omega * omega * RADIUS_M.powi(3)
}

/// Puts an effect into a machine.
///
/// # Errors
/// [`RotorTruthError::UnknownName`] of an effect that is not in the catalogue; [`RotorTruthError::Value`] of a size that its
/// physics refuses.
pub fn apply(
    name: &str,
    size: Option<f64>,
    machine: &mut Machine,
    drives: &Drives,
    rng: &mut ChaCha8Rng,
) -> Result<Parameters, RotorTruthError> {
    checked_size(size)?;
    let draw = &mut Draw::new(rng, size);
    let found = of_blades(name, machine, draw)
        .or_else(|| of_flaps(name, machine, drives, draw))
        .or_else(|| of_air(name, machine, draw))
        .or_else(|| of_readings(name, machine, draw))
        .or_else(|| outside(name, machine, draw));
    match found {
        Some(own) => Ok(own),
        None if name == super::catalogue::NULL => Ok(Parameters::new()),
        None => super::catalogue::entry(name).map(|_| Parameters::new()),
    }
}

fn of_blades(name: &str, m: &mut Machine, draw: &mut Draw<'_>) -> Option<Parameters> {
    let b = &mut m.blade;
    Some(match name {
        "stiffness-flap" => {
            let ratio = draw.ratio(0.08, 0.25);
            b.ei_flap *= ratio;
            told([("ratio", json!(ratio))])
        }
        "stiffness-lag" => {
            let ratio = draw.ratio(0.04, 0.10);
            b.ei_lag *= ratio;
            told([("ratio", json!(ratio))])
        }
        "stiffness-torsion" => {
            let ratio = draw.ratio(0.08, 0.25);
            b.gj *= ratio;
            told([("ratio", json!(ratio))])
        }
        "pitch-link" => {
            // as soft as a part of the blade itself
            let unit = nominal_moment_newton_metre();
            let stiffness = draw.size(5.0, 30.0);
            let stiffness = if draw.is_given() { stiffness } else { stiffness * b.gj * unit };
            b.pitch_spring = Some(stiffness / unit);
            told([("stiffness", json!(stiffness))])
        }
        "mass" => {
            let ratio = draw.ratio(0.04, 0.12);
            m.mass_ratio = ratio;
            told([("ratio", json!(ratio))])
        }
        "cg-offset" => {
            let offset = draw.signed(0.0008, 0.003);
            b.mass_centre += offset;
            told([("offset_r", json!(offset))])
        }
        "aerodynamic-centre" => {
            let offset = draw.signed(0.02, 0.08) * if draw.is_given() { 1.0 } else { b.chord };
            b.aerodynamic_centre += offset;
            told([("offset_r", json!(offset))])
        }
        "structural-damping" => {
            let ratio = draw.size(0.012, 0.04);
            b.damping = ratio;
            told([("ratio", json!(ratio))])
        }
        "blade-dissimilarity" => {
            let blade = 1 + draw.number(m.blade.blades);
            let (mut mass_ratio, mut pitch_deg) = (1.0, 0.0);
            let heavier = draw.is_up();
            let (key, value) = if heavier {
                mass_ratio = draw.ratio(0.01, 0.05);
                ("mass_ratio", mass_ratio)
            } else {
                pitch_deg = draw.signed(0.15, 0.6);
                ("pitch_deg", pitch_deg)
            };
            let (pitch_rad, flaps_late_rad) = (f64::to_radians(pitch_deg), 0.0);
            m.odd = Some(OddBlade { blade, mass_ratio, pitch_rad, flaps_late_rad });
            told([(key, json!(value)), ("blade", json!(blade))])
        }
        _ => return None,
    })
}

fn of_flaps(
    name: &str,
    m: &mut Machine,
    drives: &Drives,
    draw: &mut Draw<'_>,
) -> Option<Parameters> {
    Some(match name {
        "actuator-hysteresis" => {
            let lag_deg = draw.size(20.0, 45.0);
            let (volt, harmonic) = (drives.middle_volt, drives.middle_harmonic);
            m.actuator.hysteresis = Some(Hysteresis::of_lag(lag_deg, volt, harmonic));
            told([
                ("lag_deg", json!(lag_deg)),
                ("at_volt", json!(volt)),
                ("at_harmonic", json!(harmonic)),
            ])
        }
        "actuator-gain" => {
            let ratio = draw.ratio(0.08, 0.28);
            m.actuator.gain *= ratio;
            told([("ratio", json!(ratio))])
        }
        "flap-effectiveness" => {
            let lift = draw.size(0.68, 0.9);
            let moment = draw.within(0.85, 1.1);
            for flap in &mut m.blade.flaps {
                flap.lift *= lift;
                flap.moment *= moment;
            }
            told([("lift", json!(lift)), ("moment", json!(moment))])
        }
        _ => return None,
    })
}

fn of_air(name: &str, m: &mut Machine, draw: &mut Draw<'_>) -> Option<Parameters> {
    let b = &mut m.blade;
    Some(match name {
        "twist" => {
            let deg = draw.signed(0.7, 2.2);
            b.twist_rad += deg.to_radians();
            told([("deg", json!(deg))])
        }
        "lift-slope" => {
            let ratio = draw.ratio(0.04, 0.12);
            b.lift_ratio *= ratio;
            told([("ratio", json!(ratio))])
        }
        "drag" => {
            let ratio = draw.ratio(0.25, 0.9);
            b.drag *= ratio;
            told([("ratio", json!(ratio))])
        }
        "inflow" => {
            m.inflow = InflowKind::Helices;
            told([("share", json!(1.0)), ("model", json!("rigid helices"))])
        }
        "dynamic-stall" => {
            let angle_deg = draw.size(8.5, 11.0);
            b.stall = Some(Stall {
                angle_rad: angle_deg.to_radians(),
                width_rad: 1.2_f64.to_radians(),
                rate: 0.25,
                moment: -0.12,
                drag: 1.2,
            });
            told([("share", json!(1.0)), ("stall_angle_deg", json!(angle_deg))])
        }
        "compressibility" => {
            // told apart by what is there; the machine sets its Mach number
            b.tip_mach = if b.tip_mach.is_some() { None } else { Some(0.58) };
            told([("share", json!(1.0)), ("in_truth", json!(b.tip_mach.is_some()))])
        }
        _ => return None,
    })
}

fn of_readings(name: &str, m: &mut Machine, draw: &mut Draw<'_>) -> Option<Parameters> {
    Some(match name {
        "pitch-reference" => {
            let deg = draw.signed(0.3, 1.5);
            m.path.collective_deg = deg;
            told([("collective_deg", json!(deg))])
        }
        "hub-impedance" => {
            let frequency_hz = draw.size(36.0, 65.0);
            let damping = 0.05;
            m.path.support = Some(SupportMode { frequency_hz, damping });
            told([("frequency_hz", json!(frequency_hz)), ("damping_ratio", json!(damping))])
        }
        "sensor-gain" => {
            let load = draw.number(6);
            let reversed = draw.number(4) == 0;
            let drawn = draw.ratio(0.08, 0.3);
            let ratio = if reversed && !draw.is_given() { -1.0 } else { drawn };
            m.path.gain = Some((load, 4, ratio));
            let instrument = ["fx_n4_N", "fy_n4_N", "fz_n4_N", "mx_n4_Nm", "my_n4_Nm", "mz_n4_Nm"];
            told([("ratio", json!(ratio)), ("instrument", json!(instrument[load]))])
        }
        "azimuth-offset" => {
            let deg = draw.signed(2.0, 12.0);
            m.path.azimuth_deg = deg;
            told([("deg", json!(deg))])
        }
        "channel-delay" => {
            let late_s = draw.size(6e-4, 5e-3);
            m.path.delay_s = late_s;
            told([("s", json!(late_s))])
        }
        "rotor-speed" => {
            let ratio = draw.ratio(0.006, 0.02);
            m.speed = ratio;
            told([("ratio", json!(ratio))])
        }
        "air-density" => {
            let ratio = draw.ratio(0.03, 0.10);
            m.density = ratio;
            told([("ratio", json!(ratio))])
        }
        _ => return None,
    })
}

/// Effects that the list of the product does not have.
fn outside(name: &str, m: &mut Machine, draw: &mut Draw<'_>) -> Option<Parameters> {
    Some(match name {
        "wall-upwash" => {
            let share = draw.size(0.5, 1.2);
            m.upwash = Some(Upwash::Walls(share));
            told([("share_of_mean_inflow", json!(share))])
        }
        "lag-damper" => {
            let constant = draw.size(300.0, 1200.0);
            m.blade.lag_damper = Some((0.25, constant));
            told([("constant", json!(constant)), ("station_r", json!(0.25))])
        }
        "flap-freeplay" => {
            let half_gap_deg = draw.size(0.25, 0.8);
            m.actuator.freeplay_deg = half_gap_deg;
            told([("half_gap_deg", json!(half_gap_deg))])
        }
        "shaft-imbalance" => {
            let newton = draw.size(120.0, 700.0);
            let at = draw.within(0.0, std::f64::consts::TAU);
            m.imbalance = (newton, at);
            told([("force_N", json!(newton)), ("azimuth_rad", json!(at))])
        }
        "fuselage-upwash" => {
            let size = draw.size(0.06, 0.2);
            m.upwash = Some(Upwash::Fuselage(size));
            told([("size", json!(size))])
        }
        "flap-phase-error" => {
            let late_deg = draw.size(10.0, 25.0);
            let blade = 1 + draw.number(m.blade.blades);
            let flaps_late_rad = late_deg.to_radians();
            m.odd = Some(OddBlade { blade, mass_ratio: 1.0, pitch_rad: 0.0, flaps_late_rad });
            told([("late_deg", json!(late_deg)), ("blade", json!(blade))])
        }
        _ => return None,
    })
}

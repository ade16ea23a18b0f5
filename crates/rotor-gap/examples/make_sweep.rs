//! Writes a sweep of the default rotor with something planted: points of test of a rotor of another fidelity, with noise.
//!
//! `cargo run --release -p rotor-gap --example make_sweep -- SEED CAUSE VALUE DRIVEN NOISE > sweep.csv`

use measured_data::{PointData, Source};
use model_gap::SplitMix;
use rotor_gap::{RotorModel, Sweep, predict};
use rotor_study::case::{
    ActuatorChoice, AttachedFlowModel, Case, InflowChoice, TrimValues, WindTunnelTrim,
};
use std::fmt::Write;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().collect();
    let seed: u64 = args[1].parse()?;
    let (cause, value): (&str, f64) = (&args[2], args[3].parse()?);
    let is_driven = args[4] == "1";
    let noise: f64 = args[5].parse()?;
    let other = args.get(6).is_some_and(|own| own == "other");
    let mut case =
        Case { trim: TrimValues::WindTunnel(WindTunnelTrim::default()), ..Case::default() };
    case.actuator.model = ActuatorChoice::Ideal;
    if other {
        case.aerodynamics.model = AttachedFlowModel::HariharanLeishman;
        case.inflow.model = InflowChoice::PittPeters;
    }
    let mut header = String::from(
        "advance_ratio,ct_sigma,shaft_tilt_deg,theta0_deg,theta1c_deg,theta1s_deg,power_W",
    );
    for load in ["fx", "fy", "fz"] {
        header += &format!(",{load}_n4_cos_N,{load}_n4_sin_N");
    }
    for load in ["mx", "my", "mz"] {
        header += &format!(",{load}_n4_cos_Nm,{load}_n4_sin_Nm");
    }
    header += ",fz_n1_cos_N,fz_n1_sin_N,fx_n1_cos_N,fx_n1_sin_N,fx_n2_cos_N,fx_n2_sin_N";
    if is_driven {
        header += ",flap1_n3_cos_V,flap1_n3_sin_V,flap2_n4_cos_V,flap2_n4_sin_V";
    }
    let mut random = SplitMix(seed);
    let mut rows = String::new();
    for p in 0..30 {
        let mu = 0.1 + 0.2 * f64::from(p % 10) / 9.0;
        let (ct, tilt) = (0.06 + 0.01 * f64::from(p / 10), 2.0 + 10.0 * mu);
        let readings = header.split(',').count() - 3 - if is_driven { 4 } else { 0 };
        write!(rows, "{mu},{ct},{tilt}{}", ",0".repeat(readings))?;
        if is_driven {
            for _ in 0..4 {
                write!(rows, ",{}", 25.0 * random.normal().clamp(-1.0, 1.0))?;
            }
        }
        rows.push('\n');
    }
    let text = format!("{header}\n{rows}");
    let source = Source { name: "made".into(), text };
    let data = PointData::read(&source)?;
    let sweep = Sweep::of(&data, &case)?;
    let mut model = RotorModel::of(case);
    match cause {
        "none" => {}
        "stiffness-torsion" => model.case.rotor.gj *= value,
        "stiffness-flap" => model.case.rotor.ei_flap *= value,
        "stiffness-lag" => model.case.rotor.ei_lag *= value,
        "mass" => {
            let r = &mut model.case.rotor;
            for own in [&mut r.ei_flap, &mut r.ei_lag, &mut r.gj, &mut r.ea, &mut r.lock_number] {
                *own /= value;
            }
            r.mass_kg_m *= value;
        }
        "azimuth-offset" => model.path.azimuth_deg = value,
        "channel-delay" => model.path.delay_s = value,
        "sensor-gain" => drop(model.path.gains.insert("fx_n4_N".into(), value)),
        "air-density" => model.density = value,
        "rotor-speed" => model.speed = value,
        "lift-slope" => model.lift_slope = value,
        "drag" => model.case.aerodynamics.drag_coefficient *= value,
        "twist" => model.case.rotor.twist_deg += value,
        "pitch-reference" => model.path.collective_deg = value,
        "structural-damping" => model.case.rotor.modal_damping = value,
        "actuator-gain" => model.drive.gain = value,
        "hub-impedance" => model.path.compliance_s2 = 1.0 / (value * value),
        "aerodynamic-centre" => model.case.rotor.aerodynamic_centre_r = value,
        "flap-effectiveness" => {
            for flap in &mut model.case.flaps {
                flap.effectiveness.lift = value;
            }
        }
        "blade-dissimilarity" => {
            let own =
                rotor_study::case::DissimilarBlade { blade: 2, mass: value, ..Default::default() };
            model.case.rotor.dissimilar_blades.push(own);
        }
        other => return Err(format!("no cause {other}").into()),
    }
    let grid = predict(&model, &sweep, None, None)?;
    // a noise of the same part of every load of a kind
    let size = |names: &[usize]| {
        let squares: f64 = grid.iter().flat_map(|row| names.iter().map(|&c| row[c] * row[c])).sum();
        (squares / (grid.len() * names.len()) as f64).sqrt()
    };
    let count = sweep.channels.len();
    let forces: Vec<usize> = (4..10).collect();
    let moments: Vec<usize> = (10..16).collect();
    let deviation = |c: usize| match c {
        0..3 => 0.02,
        3 => noise * size(&[3]),
        10..16 => noise * size(&moments),
        _ => noise * size(&forces),
    };
    let names: Vec<&str> = header.split(',').collect();
    let mut out = names.join(",");
    for channel in &sweep.channels {
        write!(out, ",{}_sd", channel.name)?;
    }
    out.push('\n');
    for (row, line) in grid.iter().zip(rows.lines()) {
        let cells: Vec<&str> = line.split(',').collect();
        let mut written: Vec<String> = cells[..3].iter().map(|own| (*own).to_owned()).collect();
        for (c, value) in row.iter().enumerate() {
            written.push(format!("{}", value + deviation(c) * random.normal()));
        }
        written.extend(cells[3 + count..].iter().map(|own| (*own).to_owned()));
        written.extend((0..count).map(|c| format!("{}", deviation(c))));
        writeln!(out, "{}", written.join(","))?;
    }
    print!("{out}");
    Ok(())
}

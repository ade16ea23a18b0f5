//! The rotor as the engineer believes it, as a case file of `hhc`.

use super::machine::{MASS_KG_M, NOMINAL_RPM, RADIUS_M, SOUND_M_S};
use crate::physics::blade::{Airloads, Blade, Couplings, Lags};
use std::fmt::Write;

/// Inputs that are not known well: name in the case and standard deviation, percent.
pub const UNCERTAIN: [(&str, f64); 5] = [
    ("rotor.gj", 2.0),
    ("rotor.ei_flap", 1.0),
    ("rotor.ei_lag", 1.0),
    ("rotor.lock_number", 1.0),
    ("rotor.km2_r", 2.0),
];

/// The text of the case.
pub fn text(blade: &Blade) -> String {
    let mut out = String::from("#![enable(implicit_some, unwrap_variant_newtypes)]\n(\n");
    let [km1, km2, ka] = blade.gyration;
    // writing to a text cannot fail
    let _ = write!(
        out,
        "    title: \"Four-bladed rotor in a wind tunnel\",\n    advance_ratio: 0.2,\n    rotor: (\n        blades: {}, \
         radius_m: {RADIUS_M}, omega_rpm: {NOMINAL_RPM:.1}, mass_kg_m: {MASS_KG_M}, chord_r: {}, lock_number: {:.3},\n        \
         ei_flap: {}, ei_lag: {}, gj: {}, ea: 1000000.0,\n        km1_r: {km1}, km2_r: {km2}, ka_r: {ka}, twist_deg: {:.3}, \
         precone_deg: {:.3}, root_cutout_r: {},\n        modal_damping: {},\n    ),\n    flaps: [\n",
        blade.blades,
        blade.chord,
        blade.lock_number,
        blade.ei_flap,
        blade.ei_lag,
        blade.gj,
        blade.twist_rad.to_degrees(),
        blade.precone_rad.to_degrees(),
        blade.cutout,
        blade.damping,
    );
    for own in &blade.flaps {
        let _ = writeln!(
            out,
            "        (start_r: {}, end_r: {}, chord_fraction: {}, mass_fraction: {}, cg_fraction: {}),",
            own.start, own.end, own.chord_fraction, own.mass_fraction, own.cg_fraction
        );
    }
    let [flap, lag, torsion] = blade.modes;
    let couplings = match blade.couplings {
        Couplings::Full | Couplings::Third => "Moderate, untwist: Neglected, twist_angle: Elastic",
        Couplings::Linear => "Linear",
    };
    let model = match blade.airloads {
        Airloads::Unsteady(Lags::Jones) => "Incompressible",
        Airloads::Unsteady(Lags::Beddoes) => "HariharanLeishman",
        Airloads::QuasiSteady | Airloads::ApparentMass => "QuasiSteady",
    };
    let mach = if blade.tip_mach.is_some() { "LocalMach" } else { "None" };
    let _ = write!(
        out,
        "    ],\n    structure: (\n        modes: (flap: {flap}, lag: {lag}, torsion: {torsion}),\n        \
         couplings: {couplings},\n    ),\n    aerodynamics: (\n        model: {model}, compressibility: {mach}, \
         reverse_flow: Abrupt,\n        drag_coefficient: {}, speed_of_sound_m_s: {SOUND_M_S},\n    ),\n    inflow: (model: \
         Drees),\n    trim: WindTunnel(ct_sigma: 0.07, shaft_tilt_deg: 5.0),\n    actuator: (model: Ideal, \
         ideal_amplitude_deg: 10.0),\n    control: (actuators: [Ideal], amplitude_V: 85.0),\n    uncertain: [\n",
        blade.drag
    );
    for (field, percent) in UNCERTAIN {
        let _ = writeln!(out, "        (field: \"{field}\", sd_percent: {percent:.1}),");
    }
    out.push_str("    ],\n)\n");
    out
}

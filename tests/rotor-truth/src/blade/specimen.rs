//! The blade that is measured, as the engineer's case of `hhc` holds it, and in SI units.

use super::beam::{Along, Beam};
use crate::draw::{log_within, normal, rounded};
use chacha20::ChaCha8Rng;
use rand::RngExt;
use std::collections::BTreeMap;
use std::f64::consts::TAU;
use std::fmt::Write;

/// Inputs that are not known well: name in the case and standard deviation, percent.
pub const UNCERTAIN: [(&str, f64); 3] =
    [("rotor.gj", 2.0), ("rotor.ei_flap", 1.0), ("rotor.ei_lag", 1.0)];

/// A blade, lengths over the radius `R`, stiffnesses over `m0 Omega^2 R^4`.
#[derive(Debug, Clone, PartialEq)]
pub struct Specimen {
    /// Radius, m.
    pub radius_m: f64,
    /// Nominal rotor speed, rpm.
    pub omega_rpm: f64,
    /// Mass per length `m0`, kg/m.
    pub mass_kg_m: f64,
    /// Stiffness in flap, lag and torsion where it is uniform.
    pub stiffness: [f64; 3],
    /// Radii of gyration of the mass about and normal to the chord line, and of the area, R.
    pub gyration: [f64; 3],
    /// Station of the root, R.
    pub root_offset: f64,
    /// Mass over `m0` and the three stiffnesses along the radius; none of a uniform blade.
    pub tables: Option<[Along; 4]>,
}

/// Straight lines through factors on a value, root to tip.
fn table(stations: &[f64], value: f64, factors: &[f64]) -> Along {
    stations.iter().zip(factors).map(|(s, own)| (*s, rounded(value * own, 1e7))).collect()
}

impl Specimen {
    /// Draws a blade: half of them uniform, half with the root on the axis.
    pub fn draw(rng: &mut ChaCha8Rng) -> Self {
        let radius_m = rounded(rng.random_range(1.0..6.0), 100.0);
        let tip_speed_m_s = rng.random_range(180.0..220.0);
        let omega_rpm = (tip_speed_m_s / radius_m * 60.0 / TAU).round();
        let mass_kg_m = rounded(0.265 * radius_m * radius_m * rng.random_range(0.7..1.4), 100.0);
        let stiffness = [(0.003, 0.012), (0.015, 0.07), (0.002, 0.008)]
            .map(|(low, high)| rounded(log_within(rng, low, high), 1e5));
        let gyration = [(0.008, 0.014), (0.018, 0.027), (0.02, 0.03)]
            .map(|(low, high)| rounded(rng.random_range(low..high), 1e4));
        let is_offset = rng.random_range(0..2) == 0;
        let drawn = rounded(rng.random_range(0.02..0.10), 100.0);
        let root_offset = if is_offset { drawn } else { 0.0 };
        let is_tabled = rng.random_range(0..2) == 0;
        let inner = rounded(root_offset + rng.random_range(0.12..0.25), 100.0);
        let stations = [root_offset, inner, 1.0];
        let mut factors = || {
            [rng.random_range(1.3..2.5), rng.random_range(0.95..1.1), rng.random_range(0.7..1.0)]
                .map(|own| rounded(own, 100.0))
        };
        let [flap, lag, torsion] = stiffness;
        let tables = [1.0, flap, lag, torsion].map(|own| table(&stations, own, &factors()));
        let tables = is_tabled.then_some(tables);
        Self { radius_m, omega_rpm, mass_kg_m, stiffness, gyration, root_offset, tables }
    }

    /// Moves the uncertain inputs; returns true over believed values.
    pub fn move_uncertain(&mut self, rng: &mut ChaCha8Rng) -> BTreeMap<&'static str, f64> {
        let mut out = BTreeMap::new();
        for (field, percent) in UNCERTAIN {
            let ratio = 1.0 + 0.01 * percent * normal(rng).clamp(-2.5, 2.5);
            let place = match field {
                "rotor.ei_flap" => 0,
                "rotor.ei_lag" => 1,
                _ => 2,
            };
            self.stiffness[place] *= ratio;
            let table = self.tables.iter_mut().flat_map(|own| own[place + 1].iter_mut());
            for (_, value) in table {
                *value *= ratio;
            }
            out.insert(field, ratio);
        }
        out
    }

    /// The beam in SI units.
    pub fn beam(&self) -> Beam {
        let Self { radius_m: r, root_offset: root, .. } = *self;
        let omega_rad_s = self.omega_rpm * TAU / 60.0;
        let unit = self.mass_kg_m * omega_rad_s * omega_rad_s * r.powi(4);
        let scales = [self.mass_kg_m, unit, unit, unit];
        let [flap, lag, torsion] = self.stiffness;
        let uniform = [1.0, flap, lag, torsion].map(|own| vec![(0.0, own), (1.0, own)]);
        let over_length = |own: &Along| -> Along {
            own.iter().map(|(s, value)| ((s - root) / (1.0 - root), *value)).collect()
        };
        let tables = self.tables.as_ref().map(|own| own.each_ref().map(over_length));
        let mut tables = tables.unwrap_or(uniform);
        for (own, scale) in tables.iter_mut().zip(scales) {
            for (_, value) in own {
                *value *= scale;
            }
        }
        let [mass_kg_m, ei_flap, ei_lag, gj] = tables;
        Beam {
            length_m: r * (1.0 - root),
            root_m: r * root,
            mass_kg_m,
            ei_flap,
            ei_lag,
            gj,
            gyration_m: self.gyration.map(|own| own * r),
            root_spring: [None; 3],
            lumps: vec![],
            guys: vec![],
        }
    }

    /// The text of the case.
    pub fn case_ron(&self) -> String {
        let [flap, lag, torsion] = self.stiffness;
        let [km1, km2, ka] = self.gyration;
        let mut out = String::from("#![enable(implicit_some, unwrap_variant_newtypes)]\n(\n");
        // writing to a text cannot fail
        let _ = write!(
            out,
            "    title: \"Blade on a whirl stand\",\n    rotor: (\n        radius_m: {}, omega_rpm: {:.1}, mass_kg_m: {}, \
             ei_flap: {flap}, ei_lag: {lag}, gj: {torsion}, ea: 1000000.0,\n        km1_r: {km1}, km2_r: {km2}, ka_r: {ka}, \
             twist_deg: 0.0, precone_deg: 0.0, root_cutout_r: 0.2,\n        root_offset_r: {:?},\n",
            self.radius_m, self.omega_rpm, self.mass_kg_m, self.root_offset
        );
        if let Some(tables) = &self.tables {
            out.push_str("        tables: (\n");
            for (name, table) in ["mass", "ei_flap", "ei_lag", "gj"].into_iter().zip(tables) {
                let all: Vec<String> =
                    table.iter().map(|(s, value)| format!("({s:?}, {value:?})")).collect();
                let _ = writeln!(out, "            {name}: [{}],", all.join(", "));
            }
            out.push_str("        ),\n");
        }
        out.push_str("    ),\n    flaps: [],\n    control: (harmonics: []),\n    uncertain: [\n");
        for (field, percent) in UNCERTAIN {
            let _ = writeln!(out, "        (field: \"{field}\", sd_percent: {percent:.1}),");
        }
        out.push_str("    ],\n)\n");
        out
    }
}

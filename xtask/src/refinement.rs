//! Refinement of the paper's case: 4/rev hub loads over elements, modes, stations and time elements.

use sim_driver::SimError;
use sim_driver::case::{LoadedCase, PAPER_CASE, shipped_case};
use sim_driver::study::TrimmedRotor;

/// What is refined, and how.
type Change = (&'static str, fn(&mut LoadedCase));

const CHANGES: [Change; 11] = [
    ("12 time elements", |c| c.case.response.time_elements = 12),
    ("16 time elements", |c| c.case.response.time_elements = 16),
    ("24 time elements", |c| c.case.response.time_elements = 24),
    ("12 time points per element", |c| c.case.response.time_gauss_points = 12),
    ("8 stations per piece", |c| c.case.response.span_points_per_piece = 8),
    ("20 beam elements", |c| c.case.blade.elements = 20),
    ("40 beam elements", |c| c.case.blade.elements = 40),
    ("6 flap, 6 lag, 4 torsion modes", |c| modes(c, [6, 6, 4])),
    ("8 flap, 8 lag, 6 torsion modes", |c| modes(c, [8, 8, 6])),
    ("8 stations, 24 time elements", |c| fine(c, 8, 24)),
    ("10 stations, 48 time elements", |c| fine(c, 10, 48)),
];

fn modes(loaded: &mut LoadedCase, modes: [usize; 3]) {
    loaded.case.blade.elements = 20;
    loaded.case.blade.modes = modes;
}

fn fine(loaded: &mut LoadedCase, stations: usize, time_elements: usize) {
    loaded.case.response.span_points_per_piece = stations;
    loaded.case.response.time_elements = time_elements;
}

/// The table: change of each load by a refinement, percent of the load, and of all over their norm.
///
/// # Errors
/// [`SimError`] if the case cannot be read or a refinement cannot be trimmed.
pub fn table() -> Result<String, SimError> {
    let paper = shipped_case(PAPER_CASE)?;
    let loads = |loaded: &LoadedCase| -> Result<[f64; 12], SimError> {
        let rotor = TrimmedRotor::new(loaded, None)?;
        Ok(rotor.trim().rotor.hub.harmonic(loaded.case.blades))
    };
    let base = loads(&paper)?;
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::ASCII_BORDERS_ONLY_CONDENSED);
    table.set_header(["refined", "FX", "FY", "FZ", "MX", "MY", "MZ", "vector"]);
    for (name, change) in CHANGES {
        let mut refined = paper.clone();
        change(&mut refined);
        let found = loads(&refined)?;
        let apart: Vec<f64> = found.iter().zip(&base).map(|(a, b)| a - b).collect();
        let pairs = apart.chunks_exact(2).zip(found.chunks_exact(2));
        let mut cells = vec![name.to_owned()];
        cells.extend(pairs.map(|(d, f)| percent(d[0].hypot(d[1]), f[0].hypot(f[1]))));
        let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        cells.push(percent(norm(&apart), norm(&found)));
        table.add_row(cells);
    }
    Ok(format!("Change of the 4/rev hub loads by refinement, percent of each load\n{table}\n"))
}

fn percent(part: f64, whole: f64) -> String {
    format!("{:.3}", 100.0 * part / whole)
}

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
    ("8 flap, 8 lag, 6 torsion modes", more_modes),
    ("8 stations, 24 time elements", finer_mesh),
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

/// The trimmed paper's case after a change: cosine and sine of every load at 4/rev.
pub(crate) fn loads_after(change: fn(&mut LoadedCase)) -> Result<[f64; 12], SimError> {
    let mut refined = shipped_case(PAPER_CASE)?;
    change(&mut refined);
    let rotor = TrimmedRotor::new(&refined, None)?;
    Ok(rotor.trim().rotor.hub.harmonic(refined.case.blades))
}

/// Distance of each load from a refined one over its amplitude there, and of all over their norm, %.
pub(crate) fn percent_apart(base: &[f64; 12], refined: &[f64; 12]) -> [f64; 7] {
    let apart: [f64; 12] = std::array::from_fn(|i| base[i] - refined[i]);
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    std::array::from_fn(|k| {
        let part = if k < 6 { 2 * k..2 * k + 2 } else { 0..12 };
        100.0 * norm(&apart[part.clone()]) / norm(&refined[part])
    })
}

/// Stations and time elements refined.
pub(crate) fn finer_mesh(loaded: &mut LoadedCase) {
    fine(loaded, 8, 24);
}

/// Modes added.
pub(crate) fn more_modes(loaded: &mut LoadedCase) {
    modes(loaded, [8, 8, 6]);
}

/// The table: change of each load by a refinement, percent of the load, and of all over their norm.
///
/// # Errors
/// [`SimError`] if the case cannot be read or a refinement cannot be trimmed.
pub fn table() -> Result<String, SimError> {
    let base = loads_after(|_| ())?;
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::ASCII_BORDERS_ONLY_CONDENSED);
    table.set_header(["refined", "FX", "FY", "FZ", "MX", "MY", "MZ", "vector"]);
    for (name, change) in CHANGES {
        let apart = percent_apart(&base, &loads_after(change)?);
        table.add_row(std::iter::once(name.to_owned()).chain(apart.map(|p| format!("{p:.3}"))));
    }
    Ok(format!("Change of the 4/rev hub loads by refinement, percent of each load\n{table}\n"))
}

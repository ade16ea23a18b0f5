//! Refinement of the paper's case: 4/rev hub loads over elements, modes, stations and time elements.

use rotor_response::Discretisation;
use rotor_study::TrimmedRotor;
use sim_driver::SimError;
use sim_driver::case::{LoadedCase, PAPER_CASE, shipped_case};

/// A change of the discretisation.
pub(crate) type Change = fn(&mut LoadedCase);

/// What is compared: what it is called, one discretisation, and the one it is held against.
type Row = (&'static str, Change, Change);

const ROWS: [Row; 15] = [
    ("12 time elements", default_mesh, |c| c.case.response.time_elements = 12),
    ("16 time elements", default_mesh, |c| c.case.response.time_elements = 16),
    ("24 time elements", default_mesh, |c| c.case.response.time_elements = 24),
    ("48 time elements", default_mesh, |c| c.case.response.time_elements = 48),
    ("12 time points per element", default_mesh, |c| c.case.response.time_gauss_points = 12),
    ("8 stations per piece", default_mesh, |c| c.case.response.span_points_per_piece = 8),
    ("20 beam elements", default_mesh, |c| c.case.structure.elements = 20),
    ("40 beam elements", default_mesh, |c| c.case.structure.elements = 40),
    ("8, 8, 6 modes, 20 beam elements", default_mesh, more_modes),
    ("12, 12, 10 modes, 40 beam elements", default_mesh, most_modes),
    ("8 stations, 24 time elements", default_mesh, finer_mesh),
    ("all: 8, 8, 6 modes, 20 el., 8 st., 24 t. el.", default_mesh, all_finer),
    ("8, 8, 6 off 12, 12, 10 modes", more_modes, most_modes),
    ("10, 10, 8 off 12, 12, 10 modes", many_modes, most_modes),
    ("the paper's 4, 4, 2 off 12, 12, 10 modes", paper_modes, most_modes),
];

fn modes(loaded: &mut LoadedCase, elements: usize, modes: [usize; 3]) {
    loaded.case.structure.elements = elements;
    loaded.case.structure.modes = modes.into();
}

/// The default discretisation.
pub(crate) fn default_mesh(_: &mut LoadedCase) {}

/// The modes the paper keeps.
pub(crate) fn paper_modes(loaded: &mut LoadedCase) {
    loaded.case.structure.modes = Discretisation::paper().modes.into();
}

/// Stations and time elements refined.
pub(crate) fn finer_mesh(loaded: &mut LoadedCase) {
    loaded.case.response.span_points_per_piece = 8;
    loaded.case.response.time_elements = 24;
}

fn more_modes(loaded: &mut LoadedCase) {
    modes(loaded, 20, [8, 8, 6]);
}

/// Modes far beyond the default.
pub(crate) fn many_modes(loaded: &mut LoadedCase) {
    modes(loaded, 40, [10, 10, 8]);
}

/// Still more: what the rest is held against.
pub(crate) fn most_modes(loaded: &mut LoadedCase) {
    modes(loaded, 40, [12, 12, 10]);
}

/// Everything refined at once.
pub(crate) fn all_finer(loaded: &mut LoadedCase) {
    more_modes(loaded);
    finer_mesh(loaded);
}

/// The trimmed paper's case at the default discretisation after a change: cosine and sine of every load at
/// 4/rev.
pub(crate) fn loads_after(change: Change) -> Result<[f64; 12], SimError> {
    let mut refined = shipped_case(PAPER_CASE)?;
    refined.case.structure.modes = Discretisation::default().modes.into();
    change(&mut refined);
    let rotor = TrimmedRotor::new(&refined.case, None)?;
    Ok(rotor.trim().rotor.hub.harmonic(refined.case.rotor.blades))
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

/// The table: change of each load by a refinement, percent of the load, and of all over their norm.
///
/// # Errors
/// [`SimError`] if the case cannot be read or a refinement cannot be trimmed.
pub fn table() -> Result<String, SimError> {
    let mut known: Vec<(Change, [f64; 12])> = vec![];
    let mut loads = |change: Change| -> Result<[f64; 12], SimError> {
        let same = |one: &&(Change, [f64; 12])| std::ptr::fn_addr_eq(one.0, change);
        if let Some((_, loads)) = known.iter().find(same) {
            return Ok(*loads);
        }
        let found = loads_after(change)?;
        known.push((change, found));
        Ok(found)
    };
    let mut table = comfy_table::Table::new();
    table.load_style(comfy_table::presets::ASCII_BORDERS_ONLY_CONDENSED);
    table.set_header(["refined", "FX", "FY", "FZ", "MX", "MY", "MZ", "vector"]);
    for (name, change, reference) in ROWS {
        let apart = percent_apart(&loads(change)?, &loads(reference)?);
        table.add_row(std::iter::once(name.to_owned()).chain(apart.map(|p| format!("{p:.3}"))));
    }
    Ok(format!(
        "Change of the 4/rev hub loads of the default discretisation by refinement, percent of each load\n{table}\n"
    ))
}

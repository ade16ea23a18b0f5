//! Refinement of the paper's case: 4/rev hub loads over elements, modes, stations and time elements.

use std::sync::LazyLock;

use rayon::prelude::*;
use rotor_response::Discretisation;
use rotor_study::TrimmedRotor;
use sim_driver::case::{LoadedCase, PAPER_CASE, shipped_case};
use validation::{Check, Failure, row, shared, too_few};

const FINER: &str = "8 stations per piece and 24 time elements";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-RESP-47",
        "4/rev hub loads of the paper's case, trimmed, at the default \
         discretisation: largest of all six loads, off the fine mesh",
        "%",
    )
    .against(FINER)
    .at_most(1.0, || Ok(largest(percent_apart(Mesh::Default, Mesh::Finer)?))),
    row("V-RESP-48", "the same, off many modes: largest of all six loads", "%")
        .against("12 flap, 12 lag, 10 torsion modes of 40 beam elements")
        .at_most(1.0, || Ok(largest(percent_apart(Mesh::Default, Mesh::MostModes)?))),
    row("V-RESP-49", "the same, off more of everything: largest of all six loads", "%")
        .against(
            "8 flap, 8 lag, 6 torsion modes of 20 beam elements, 8 stations per piece, \
         24 time elements",
        )
        .at_most(1.0, || Ok(largest(percent_apart(Mesh::Default, Mesh::AllFiner)?))),
    row("V-RESP-50", "10 flap, 10 lag, 8 torsion modes: the many modes have converged", "%")
        .against("12 flap, 12 lag, 10 torsion modes of 40 beam elements")
        .at_most(0.1, || Ok(largest(percent_apart(Mesh::ManyModes, Mesh::MostModes)?))),
    row(
        "V-RESP-51",
        "the paper's 4 flap, 4 lag, 2 torsion modes: largest of all loads but MZ, \
         which is the default's reason",
        "%",
    )
    .against("12 flap, 12 lag, 10 torsion modes of 40 beam elements")
    .at_most(1.0, || {
        Ok(largest(percent_apart(Mesh::PaperModes, Mesh::MostModes)?.into_iter().take(5)))
    }),
];

/// A discretisation of the paper's case: elements, modes in flap, lag and torsion, and whether stations and
/// time elements are refined too.
#[derive(Clone, Copy)]
enum Mesh {
    /// As the program chooses.
    Default,
    /// The modes the paper keeps.
    PaperModes,
    /// Stations and time elements refined.
    Finer,
    /// Modes far beyond the default.
    ManyModes,
    /// Still more modes: what the rest is held against.
    MostModes,
    /// Everything refined at once.
    AllFiner,
}

const MESHES: [Mesh; 6] = [
    Mesh::AllFiner,
    Mesh::MostModes,
    Mesh::Finer,
    Mesh::ManyModes,
    Mesh::Default,
    Mesh::PaperModes,
];

impl Mesh {
    fn set(self, loaded: &mut LoadedCase) {
        let structure = &mut loaded.case.structure;
        structure.modes = match self {
            Self::Default | Self::Finer => Discretisation::default().modes.into(),
            Self::PaperModes => Discretisation::paper().modes.into(),
            Self::ManyModes => [10, 10, 8].into(),
            Self::MostModes => [12, 12, 10].into(),
            Self::AllFiner => [8, 8, 6].into(),
        };
        structure.elements = match self {
            Self::Default | Self::PaperModes | Self::Finer => structure.elements,
            Self::ManyModes | Self::MostModes => 40,
            Self::AllFiner => 20,
        };
        if matches!(self, Self::Finer | Self::AllFiner) {
            loaded.case.response.span_points_per_piece = 8;
            loaded.case.response.time_elements = 24;
        }
    }
}

/// 4/rev hub loads of every mesh: cosine and sine of each load.
static LOADS: LazyLock<Result<Vec<[f64; 12]>, Failure>> = LazyLock::new(|| {
    let loads: Result<Vec<_>, String> =
        MESHES.into_par_iter().map(|mesh| loads_on(mesh).map_err(|e| e.to_string())).collect();
    Ok(loads?)
});

/// The paper's case, trimmed on a mesh.
fn loads_on(mesh: Mesh) -> Result<[f64; 12], Failure> {
    let mut refined = shipped_case(PAPER_CASE)?;
    mesh.set(&mut refined);
    let rotor = TrimmedRotor::new(&refined.case, None)?;
    Ok(rotor.trim().rotor.hub.harmonic(refined.case.rotor.blades))
}

/// Distance of each load from a finer mesh over its amplitude there, %, FX to MZ.
fn percent_apart(coarse: Mesh, fine: Mesh) -> Result<[f64; 6], Failure> {
    let loads = shared(&LOADS)?;
    let of = |mesh: Mesh| {
        let found = MESHES.iter().zip(loads).find(|(own, _)| **own as u8 == mesh as u8);
        found.map(|(_, loads)| loads).ok_or_else(|| too_few("meshes", 0, 1))
    };
    let (coarse, fine) = (of(coarse)?, of(fine)?);
    Ok(std::array::from_fn(|k| {
        let apart = f64::hypot(coarse[2 * k] - fine[2 * k], coarse[2 * k + 1] - fine[2 * k + 1]);
        100.0 * apart / f64::hypot(fine[2 * k], fine[2 * k + 1])
    }))
}

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

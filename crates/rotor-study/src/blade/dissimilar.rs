//! Hub loads of a rotor whose blades are not all alike, as a result.

use crate::blade::loads::{StationLine, station_lines};
use crate::blade::stability::StabilityLine;
use crate::case::Case;
use crate::control::ControlStudy;
use crate::error::StudyError;
use crate::flaps::FlapMotion;
use crate::loads::HubLoads;
use crate::rotor::{TrimmedRotor, UnlikeSolver};
use rotor_base::HarmonicSeries;
use rotor_response::ResponseError;
use serde::{Deserialize, Serialize};

/// Hub loads with the unlike blades of a case: controls, attitude and inflow as with all blades alike.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct UnlikeLine {
    /// What moves the flaps: `rest`, or set of harmonics and actuator.
    pub flaps: String,
    /// Mean loads, order `fx fy fz mx my mz`.
    pub mean: [f64; 6],
    /// Loads at 1, 2, 3 ... per rev.
    pub per_rev: Vec<HubLoads>,
}

/// One blade unlike the rest in the inflow and at the controls of the trimmed rotor, flaps at rest.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct UnlikeBladeLine {
    /// Which blade, from 1.
    pub blade: usize,
    /// Its stability.
    pub stability: StabilityLine,
    /// Its loads along the span.
    pub blade_loads: Vec<StationLine>,
}

impl UnlikeBladeLine {
    /// What a reader must know of every motion that does not die out, at an advance ratio.
    pub fn warnings(&self, advance_ratio: f64) -> Vec<String> {
        let name = format!("blade {}, unlike the rest,", self.blade);
        self.stability.warnings_of(&name, advance_ratio)
    }
}

/// Stability and loads of every blade unlike the rest.
///
/// # Errors
/// [`StudyError::Blade`] and [`StudyError::Response`] with the field of the blade.
pub fn each_unlike_blade(
    case: &Case,
    trimmed: &TrimmedRotor,
) -> Result<Vec<UnlikeBladeLine>, StudyError> {
    let stations = case.load_stations_r();
    let solvers = trimmed.unlike_solvers(case)?;
    let line = |(i, solver): (usize, UnlikeSolver)| {
        let found = trimmed.unlike_blade(&solver, &stations);
        let (stability, loads) = found.map_err(|source| {
            let field = format!("rotor.dissimilar_blades[{i}]");
            StudyError::Response { field, source }
        })?;
        Ok(UnlikeBladeLine {
            blade: case.rotor.dissimilar_blades[i].blade,
            stability: StabilityLine::from(&stability),
            blade_loads: station_lines(&loads, &case.scales()),
        })
    };
    solvers.into_iter().enumerate().map(line).collect()
}

/// The loads with flaps at rest and after every control study; none if all blades are alike.
///
/// # Errors
/// [`StudyError::Blade`] and [`StudyError::Response`] with the field of the unlike blades.
pub fn unlike_lines(
    case: &Case,
    trimmed: &TrimmedRotor,
    studies: &[ControlStudy],
) -> Result<Vec<UnlikeLine>, StudyError> {
    if case.rotor.dissimilar_blades.is_empty() {
        return Ok(vec![]);
    }
    let still = vec![HarmonicSeries::zero(0); trimmed.rotor().model().flaps.len()];
    let rest = (String::from("rest"), still, &trimmed.trim().rotor);
    let controlled = studies.iter().map(|study| {
        let sets: Vec<String> = study.harmonics.iter().map(usize::to_string).collect();
        let name = format!("{}/rev, {}", sets.join("+"), study.actuator.name());
        let angles = study.state.flaps.iter().map(FlapMotion::angle_rad).collect();
        (name, angles, &study.state.rotor)
    });
    let blame = |source: ResponseError| StudyError::Response {
        field: "rotor.dissimilar_blades".to_owned(),
        source,
    };
    let mut solvers = trimmed.unlike_solvers(case)?;
    std::iter::once(rest)
        .chain(controlled)
        .map(|(flaps, angles, about)| {
            let hub = trimmed.unlike_hub_loads(&mut solvers, &angles, about).map_err(blame)?;
            let per_rev = 1..=2 * case.rotor.blades;
            let per_rev = per_rev.map(|n| HubLoads::from_parts(hub.harmonic(n))).collect();
            Ok(UnlikeLine { flaps, mean: hub.mean(), per_rev })
        })
        .collect()
}

//! Hub loads of a rotor whose blades are not all alike, as a result.

use crate::blade::loads::{StationLine, station_lines};
use crate::blade::stability::StabilityLine;
use crate::control::ControlStudy;
use crate::error::StudyError;
use crate::flaps::FlapMotion;
use crate::loads::{HubLoads, Setting, loads_cost};
use crate::rotor::{TrimmedRotor, UnlikeSolver};
use rotor_base::HarmonicSeries;
use rotor_case::Case;
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
    /// `J` of these loads at the blade number per rev, over that with flaps at rest.
    #[serde(default)]
    pub cost_ratio: f64,
    /// `J` of those at the other harmonics below twice the blade number, over the same: what blades that are alike cancel.
    #[serde(default)]
    pub other_cost_ratio: f64,
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
    let blades = case.rotor.blades;
    let baseline = HubLoads::from_parts(trimmed.trim().rotor.hub.harmonic(blades));
    let weights = Setting::of_case(case, &baseline).load_weights();
    let mut at_rest = None;
    std::iter::once(rest)
        .chain(controlled)
        .map(|(flaps, angles, about)| {
            let hub = trimmed.unlike_hub_loads(&mut solvers, &angles, about).map_err(blame)?;
            let cost = |n: usize| loads_cost(&weights, &hub.harmonic(n));
            let own = cost(blades);
            let others = (1..2 * blades).filter(|&n| n != blades).map(cost).sum::<f64>();
            let before = *at_rest.get_or_insert(own);
            let share = |cost: f64| if before > 0.0 { cost / before } else { 0.0 };
            let per_rev = (1..=2 * blades).map(|n| HubLoads::from_parts(hub.harmonic(n))).collect();
            Ok(UnlikeLine {
                flaps,
                mean: hub.mean(),
                per_rev,
                cost_ratio: share(own),
                other_cost_ratio: share(others),
            })
        })
        .collect()
}

/// What a reader of the control table must know where blades are dissimilar: the table is of the rotor with like blades.
pub fn unlike_warnings(lines: &[UnlikeLine], studies: &[ControlStudy]) -> Vec<String> {
    let Some((rest, controlled)) = lines.split_first() else { return Vec::new() };
    let said = |(line, study): (&UnlikeLine, &ControlStudy)| {
        let like = 1.0 - 0.01 * study.reduction_percent();
        format!(
            "control.harmonics: {}: J/J0 is {:.3} with the dissimilar blades of the case; the control is found, and its table is, with like blades ({like:.3}). J of the other harmonics over J0: {:.3}, {:.3} without control",
            line.flaps, line.cost_ratio, line.other_cost_ratio, rest.other_cost_ratio
        )
    };
    controlled.iter().zip(studies).map(said).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::{Drives, control_all};
    use rotor_case::{ControlActuator, DissimilarBlade};

    /// One blade whose flaps are dead: the control found with like blades leaves more, and it is said.
    #[test]
    fn the_cost_of_a_rotor_with_dissimilar_blades_is_its_own() {
        let mut case = Case::default();
        case.control.harmonics = vec![vec![3]];
        case.control.actuators = vec![ControlActuator::Ideal];
        let rotor = TrimmedRotor::new(&case, None).unwrap();
        let drives = Drives::new(&case, None).unwrap();
        let studies = control_all(&case, &rotor, &drives, &|| ()).unwrap();
        let like = studies[0].j_after / studies[0].j_before;
        for (flap_motion, is_dead) in [(1.0, false), (0.0, true)] {
            case.rotor.dissimilar_blades =
                vec![DissimilarBlade { blade: 3, flap_motion, ..DissimilarBlade::default() }];
            let lines = unlike_lines(&case, &rotor, &studies).unwrap();
            let [rest, controlled] = &lines[..] else { panic!("{lines:?}") };
            assert!((rest.cost_ratio - 1.0).abs() < 1e-12);
            let told = unlike_warnings(&lines, &studies);
            println!(
                "{like:.4} {:.4} {:.4} {told:?}",
                controlled.cost_ratio, controlled.other_cost_ratio
            );
            if is_dead {
                assert!(controlled.cost_ratio > like + 0.05 && controlled.other_cost_ratio > 0.05);
                let both = [format!("{:.3} with", controlled.cost_ratio), format!("({like:.3})")];
                assert!(both.iter().all(|text| told[0].contains(text)), "{told:?}");
            } else {
                assert!((controlled.cost_ratio - like).abs() < 1e-3, "{}", controlled.cost_ratio);
                assert!(controlled.other_cost_ratio < 1e-6);
            }
        }
    }

    /// Control at 1/rev is warned of, at other harmonics not.
    #[test]
    fn control_at_the_pilots_harmonic_is_warned_of() {
        let warned = |harmonics: Vec<usize>| {
            let mut case = Case::default();
            case.control.harmonics = vec![harmonics];
            case.value_warnings().iter().any(|w| w.field == "control.harmonics")
        };
        assert!(warned(vec![1, 3]) && !warned(vec![2, 3]));
    }
}

//! What every controlled set costs: what is stored of it, and its figures.

use crate::blade::{LoadLine, MeanLoads, StationLine, station_lines};
use crate::control::{ControlStudy, Drives};
use crate::costs::flap::{FlapCost, PiezoData};
use crate::error::StudyError;
use crate::flaps::{FlapDrive, PlantError};
use crate::loads::Setting;
use crate::plant::angles_rad;
use crate::rotor::TrimmedRotor;
use hhc_control::RunError;
use preisach_dyn::{ActuatorModel, PeriodicSettings};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::{Case, ControlActuator};
use rotor_response::{HingeMoment, ResponseError, StationLoads};
use serde::{Deserialize, Serialize};

/// What the costs of a case are computed from, beside flap motions and hinge moments.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CostRecords {
    /// Flap angle per displacement of the identified actuator, deg/um; none without one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub deg_per_um: Option<f64>,
    /// Loads at the root of the blade without control.
    pub at_rest: StationLine,
    /// Mean loads on the hub without control, rotor units as of [`MeanLoads::hub`]; none of a result of an earlier version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hub_at_rest: Option<[f64; 6]>,
    /// One entry per set of harmonics and actuator.
    pub controls: Vec<CostRecord>,
}

/// The same of one controlled set.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CostRecord {
    /// Loads at the root of the blade with control.
    pub root: StationLine,
    /// Mean loads on the hub with control, pilot controls held, rotor units; none of a result of an earlier version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hub: Option<[f64; 6]>,
    /// Output of the law of every actuator alone, cycled so slowly that it does not lag: `[cosine, sine]` at 1, 2, 3 ... per
    /// rev, deg; empty of an actuator without a loop.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub law_deg: Vec<Vec<[f64; 2]>>,
}

/// What a controlled set costs.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct ControlCost {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// `ideal`, `ignored`, `hysteretic` or `inverse`.
    pub actuator: String,
    /// `J / J0`.
    pub cost_ratio: f64,
    /// Mean power that the actuators of all blades give, none taken back, W.
    #[serde(rename = "given_of_all_blades_W")]
    pub given_of_all_blades_watt: f64,
    /// One entry per flap of one blade, from root to tip.
    pub flaps: Vec<FlapCost>,
    /// Flap, lag and torsional moment at the root of the blade; torsion is what the pitch link holds.
    pub root: Vec<BladeCost>,
    /// Mean loads on the hub and power of the shaft without control and with it, pilot controls held: what differs between
    /// them a pilot would trim away. None of a result of an earlier version.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mean_loads: Option<[MeanLoads; 2]>,
}

/// A load of the blade with and without control.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct BladeCost {
    /// `flap`, `lag`, `torsion` (N m), or `pitch link` (N).
    pub load: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Half the peak-to-peak load, without control and with it.
    pub half_peak_to_peak: [f64; 2],
    /// Amplitudes at 1, 2, 3 ... per rev, without control and with it.
    pub amplitudes: Vec<[f64; 2]>,
}

impl BladeCost {
    fn new(
        load: &'static str,
        unit: &'static str,
        [rest, own]: [&LoadLine; 2],
        scale: f64,
    ) -> Self {
        let size = |of: &[f64; 2]| scale * of[0].hypot(of[1]);
        let pairs = rest.harmonics.iter().zip(&own.harmonics);
        Self {
            load,
            unit,
            half_peak_to_peak: [rest, own].map(|line| 0.5 * scale * line.peak_to_peak),
            amplitudes: pairs.map(|(rest, own)| [size(rest), size(own)]).collect(),
        }
    }

    /// Half the peak-to-peak load over that without control.
    pub fn ratio(&self) -> f64 {
        self.half_peak_to_peak[1] / self.half_peak_to_peak[0]
    }
}

/// What the controls of a case cost, as it is stored, in the order of the studies; nothing without a study.
///
/// # Errors
/// [`StudyError::Response`] of the loads at the root; [`StudyError::Control`] of an actuator.
pub fn control_costs(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
    studies: &[ControlStudy],
) -> Result<CostRecords, StudyError> {
    if studies.is_empty() {
        return Ok(CostRecords::default());
    }
    let root = [case.rotor.root_offset_r];
    let line =
        |found: Result<Vec<StationLoads>, ResponseError>| -> Result<StationLine, StudyError> {
            let loads = found.map_err(|source| StudyError::Response {
                field: "control.harmonics".to_owned(),
                source,
            })?;
            let mut lines = station_lines(&loads, rotor.scales());
            Ok(lines.pop().unwrap_or_default())
        };
    let model = match &drives.hysteretic {
        Some(FlapDrive::Model { model, rev_hz, .. }) => Some((model.as_ref(), *rev_hz)),
        _ => None,
    };
    let law = model.map(|(model, rev_hz)| (law_alone(model), rev_hz));
    let of = |study: &ControlStudy| {
        let angles = angles_rad(&study.state.flaps);
        let loads = rotor.station_loads_with(angles, &study.state.rotor, &root);
        let law_deg = match &law {
            Some((law, rev_hz)) if study.actuator != ControlActuator::Ideal => {
                let voltages = study.state.flaps.iter().map(|flap| &flap.voltage_volt);
                let found = voltages.map(|voltage| law_output(law, voltage, *rev_hz));
                found.collect::<Result<_, PlantError>>().map_err(|source| StudyError::Control {
                    harmonics: study.harmonics.clone(),
                    actuator: study.actuator.name(),
                    source: Box::new(RunError::plant("driven", &study.control_volt)(source)),
                })?
            }
            _ => Vec::new(),
        };
        Ok(CostRecord { root: line(loads)?, hub: Some(study.state.rotor.hub.mean()), law_deg })
    };
    Ok(CostRecords {
        deg_per_um: model.map(|(model, _)| model.calibration.deg_per_um),
        at_rest: line(rotor.station_loads(&root))?,
        hub_at_rest: Some(rotor.trim().rotor.hub.mean()),
        controls: studies.par_iter().map(of).collect::<Result<_, StudyError>>()?,
    })
}

/// How much slower than in flight a law is cycled for its loop: slow enough that no rate shows.
const QUASI_STATIC: f64 = 1e-6;

/// An actuator without the stages around its law.
fn law_alone(model: &ActuatorModel) -> ActuatorModel {
    ActuatorModel {
        amplifier: Vec::new(),
        linkage: Vec::new(),
        sensor: Vec::new(),
        ..model.clone()
    }
}

/// Output of a law under a voltage that is cycled slowly, deg: as many harmonics as the voltage has.
fn law_output(
    law: &ActuatorModel,
    voltage_volt: &HarmonicSeries,
    rev_hz: f64,
) -> Result<Vec<[f64; 2]>, PlantError> {
    let slow_hz = QUASI_STATIC * rev_hz;
    let found = law.periodic_response(voltage_volt, slow_hz, &PeriodicSettings::default())?;
    let count = voltage_volt.harmonics.len();
    let pair = |n: usize| {
        let Harmonic { cosine, sine } = found.flap_deg.harmonic(n);
        [cosine, sine]
    };
    Ok((1..=count).map(pair).collect())
}

/// The moments at the root by name, with their force summation.
fn root_moments(line: &StationLine) -> [(&'static str, &LoadLine); 3] {
    [
        ("flap", &line.flap_newton_metre.force_summation),
        ("lag", &line.lag_newton_metre.force_summation),
        ("torsion", &line.torsion_newton_metre.force_summation),
    ]
}

/// A controlled set whose costs are asked for.
#[derive(Debug, Clone)]
pub struct CostedSet<'a> {
    /// Harmonics per rev.
    pub harmonics: &'a [usize],
    /// Name of the actuator.
    pub actuator: &'a str,
    /// `J / J0`.
    pub cost_ratio: f64,
    /// Of every flap: hinge moment in rotor units, voltage in V and angle in deg.
    pub flaps: Vec<(HingeMoment, &'a HarmonicSeries, &'a HarmonicSeries)>,
}

impl CostRecords {
    /// The costs of a controlled set, the `index`th of those stored; none of a result that does not hold them.
    pub fn figures(
        &self,
        index: usize,
        set: CostedSet<'_>,
        setting: &Setting,
    ) -> Option<ControlCost> {
        let record = self.controls.get(index)?;
        let actuator_values = &setting.actuator;
        let piezo = PiezoData {
            capacitance_farad: actuator_values.capacitance_microfarad.map(|uf| 1e-6 * uf),
            blocked_and_free: actuator_values
                .blocked_force_newton
                .zip(actuator_values.free_stroke_um)
                .map(|(blocked, free)| [blocked, 1e-6 * free]),
            rad_per_metre: self.deg_per_um.map(|deg| 1e6 * deg.to_radians()),
        };
        let laws: Vec<HarmonicSeries> = record
            .law_deg
            .iter()
            .map(|pairs| HarmonicSeries {
                mean: 0.0,
                harmonics: pairs.iter().map(|&[cosine, sine]| Harmonic { cosine, sine }).collect(),
            })
            .collect();
        let flaps: Vec<FlapCost> = set
            .flaps
            .into_iter()
            .enumerate()
            .map(|(k, (hinge, voltage, angle))| {
                FlapCost::new(&hinge, (voltage, angle), laws.get(k), piezo, &setting.scales)
            })
            .collect();
        let pairs = root_moments(&self.at_rest).into_iter().zip(root_moments(&record.root));
        let mut root: Vec<BladeCost> = pairs
            .map(|((load, rest), (_, own))| BladeCost::new(load, "N m", [rest, own], 1.0))
            .collect();
        root.extend(setting.pitch_link_arm_m.map(|arm_m| {
            let torsion = [&self.at_rest, &record.root].map(|line| root_moments(line)[2].1);
            BladeCost::new("pitch link", "N", torsion, 1.0 / arm_m)
        }));
        Some(ControlCost {
            harmonics: set.harmonics.to_vec(),
            actuator: set.actuator.to_owned(),
            cost_ratio: set.cost_ratio,
            given_of_all_blades_watt: setting.blades as f64
                * flaps.iter().map(|flap| flap.given_watt).sum::<f64>(),
            flaps,
            root,
            mean_loads: self
                .hub_at_rest
                .zip(record.hub)
                .map(|(rest, own)| [rest, own].map(|hub| MeanLoads::new(hub, setting))),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::control::memory_actuator;
    use crate::costs::electrical_power;

    /// A law that lags with its rate loses what its static loop loses: far less than its lag in flight would say.
    #[test]
    fn the_loss_is_that_of_the_static_loop() {
        let law = law_alone(&memory_actuator());
        let mut voltage = HarmonicSeries { mean: 65.0, ..HarmonicSeries::zero(0) };
        voltage.set_harmonic(3, Harmonic { cosine: 60.0, sine: 0.0 });
        let loss = |pairs: &[[f64; 2]]| {
            let harmonics = pairs.iter().map(|&[cosine, sine]| Harmonic { cosine, sine }).collect();
            let law_deg = HarmonicSeries { mean: 0.0, harmonics };
            electrical_power(&voltage, Some(&law_deg), 1e-6, 40.0)
        };
        let slow = loss(&law_output(&law, &voltage, 5.0).unwrap());
        let slower = loss(&law_output(&law, &voltage, 1.0).unwrap());
        let fast = loss(&law_output(&law, &voltage, 5.0 / QUASI_STATIC).unwrap());
        let [slow_watt, slower_watt, fast_watt] =
            [slow, slower, fast].map(|found| found.loss_watt.unwrap());
        println!("{slow_watt} {slower_watt} {fast_watt} W, {} VA", slow.apparent_voltampere);
        assert!((slow_watt / slower_watt - 1.0).abs() < 1e-3, "{slow_watt} {slower_watt}");
        assert!(slow_watt > 0.0 && slow_watt < 0.5 * slow.apparent_voltampere);
        assert!(fast_watt > 2.0 * slow_watt, "{fast_watt}");
    }
}

//! What `hhc run` finds: raw numbers as they are stored, and the figures that follow from them.
//!
//! | idea | module |
//! |---|---|
//! | what a run found, each number once | here, controls in `control` |
//! | figures: costs, reductions, lags, powers, computed where they are printed | `figures` |
//! | computed curves, alone and beside measured ones | `measured` |
//! | the file and its hash | `stored` |

mod bench;
mod control;
mod figures;
mod measured;
mod stored;

pub use bench::{BenchPart, LoopRecord, bench_loops};
pub use control::{ControlEnd, ControlHead, ControlRecord, FlapRecord, SeriesLine, StepRecord};
pub use figures::{ControlLine, Figures, FlapLine, figures};
pub use measured::{CurveLine, MeasuredLine, MeasuredPart};
pub(crate) use measured::{curve_name, same_station};
pub(crate) use stored::from_json;
pub use stored::{RESULT_FILE, StoredResult};

use rotor_study::{
    CostRecords, DiskLoads, ForecastLine, FrontLine, HubLoads, MarginLine, RobustnessCell,
    Sensitivity, StabilityLine, StationLine, UnlikeBladeLine, UnlikeLine, WakeStatus,
};
use serde::{Deserialize, Serialize};
pub use study_text::{flap_name, set_name};

/// What a run found, each number once. Loads nondimensional (`m0 Omega^2 R^2`, `m0 Omega^2 R^3`), a harmonic as
/// `[cosine, sine]`.
///
/// What follows from these numbers and the case is in [`Figures`]; it is not stored.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RunResult {
    /// The trim found.
    pub trim: TrimLine,
    /// How well the equations are satisfied; no vibration number without them.
    pub residuals: Residuals,
    /// How wake and trim ended; none without a free wake.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wake: Option<WakeStatus>,
    /// Mean loads on the hub; none in results stored before they were.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mean_loads: Option<MeanHubLoads>,
    /// Loads without control.
    pub baseline: Baseline,
    /// Loads of one blade along its span without control, of each of the like ones where some are dissimilar; none in
    /// results stored before they were.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blade_loads: Vec<StationLine>,
    /// Loads of the air and induced velocity over the disk without control, of the like blades where some are dissimilar;
    /// none in results stored before they were.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub disk: Option<DiskLoads>,
    /// Airloads at the stations that carry air and motion of the tip, flaps at rest; none in results stored before they
    /// were.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<CurveLine>,
    /// What was measured beside what was computed; none without measured data.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub measured: Option<MeasuredPart>,
    /// Stability of the trimmed blade, of each of the like ones where some are dissimilar.
    #[serde(default)]
    pub stability: StabilityLine,
    /// One entry per set of harmonics and actuator.
    pub control: Vec<ControlRecord>,
    /// What the linearised rotor says beforehand, one entry per set; empty without an identified actuator.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub forecasts: Vec<ForecastLine>,
    /// What the costs of every control are computed from; none without control.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub costs: Option<CostRecords>,
    /// Fronts of `J` against power and loads of the blade; empty without control.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fronts: Vec<FrontLine>,
    /// Loads with one assumption changed at a time; empty unless asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sensitivity: Vec<Sensitivity>,
    /// Control under noise, a wrong T and drift; empty unless asked for.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub robustness: Vec<RobustnessCell>,
    /// How wrong T may be, one entry per harmonic of the map.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub margins: Vec<MarginLine>,
    /// Hub loads with dissimilar blades, flaps at rest and after every control; empty if all are alike.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unlike_blades: Vec<UnlikeLine>,
    /// Stability and loads of every dissimilar blade, flaps at rest; empty if all are alike.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub each_unlike_blade: Vec<UnlikeBladeLine>,
    /// What a reader should know before using the numbers.
    #[serde(default)]
    pub warnings: Vec<String>,
}

/// Mean loads of all blades on the hub without control, fixed shaft axes (X aft, Y to starboard, Z up).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct MeanHubLoads {
    /// `FX FY FZ` over `m0 Omega^2 R^2`, `MX MY MZ` over `m0 Omega^2 R^3`.
    pub hub: [f64; 6],
}

/// Controls and attitude. Angles in deg.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct TrimLine {
    /// Collective at 0.75 R.
    pub theta0_deg: f64,
    /// Lateral cyclic.
    pub theta1c_deg: f64,
    /// Longitudinal cyclic.
    pub theta1s_deg: f64,
    /// Shaft tilt, forward positive.
    pub alpha_s_deg: f64,
    /// Bank, right positive.
    pub phi_s_deg: f64,
    /// Tail rotor thrust to starboard, `m0 Omega^2 R^2`.
    pub tail_thrust: f64,
    /// Thrust coefficient over solidity.
    pub ct_sigma: f64,
    /// Mean induced inflow, tip speed, down positive.
    pub induced_inflow: f64,
    /// Newton iterations.
    pub iterations: usize,
}

/// The three residuals of every result.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Residuals {
    /// Largest trim residual over the weight.
    pub trim: f64,
    /// Largest weak residual of the periodic orbit.
    pub periodicity: f64,
    /// Mismatch of the inflow, tip speed.
    pub inflow: f64,
}

/// Loads without control.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Baseline {
    /// Fixed-frame hub loads at the blade number per rev.
    #[serde(alias = "hub_4_per_rev")]
    pub hub_nb_per_rev: HubLoads,
}

/// The controls of each set of harmonics, which stand one after another.
pub fn by_set(control: &[ControlLine]) -> impl Iterator<Item = (&[usize], &[ControlLine])> {
    let sets = control.chunk_by(|a, b| a.head.harmonics == b.head.harmonics);
    sets.map(|lines| (lines[0].head.harmonics.as_slice(), lines))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Loads at the blade number were once stored as those at 4/rev, of whatever number of blades.
    #[test]
    fn loads_under_their_old_name_are_read() {
        let baseline = Baseline { hub_nb_per_rev: HubLoads::from_parts([0.5; 12]) };
        let new = serde_json::to_string(&baseline).unwrap();
        let old = new.replace("hub_nb_per_rev", "hub_4_per_rev");
        assert!(old != new);
        assert_eq!(serde_json::from_str::<Baseline>(&old).unwrap(), baseline);
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "small integers are exact")]
    fn hub_loads_keep_their_order() {
        let mut parts = [0.0; 12];
        for (i, p) in parts.iter_mut().enumerate() {
            *p = i as f64;
        }
        let loads = HubLoads::from_parts(parts);
        assert_eq!(loads.fz, [4.0, 5.0]);
        assert_eq!(loads.mz, [10.0, 11.0]);
        let json = serde_json::to_value(loads).unwrap();
        for (name, amplitude) in HubLoads::NAMES.iter().zip(loads.amplitudes()) {
            let pair = &json[name];
            let found = pair[0].as_f64().unwrap().hypot(pair[1].as_f64().unwrap());
            assert!((found - amplitude).abs() < 1e-15);
        }
    }
}

//! Loads along one blade of the trimmed rotor as a result: at stations, in three ways.

use rotor_base::{HarmonicSeries, RotorScales};
use rotor_response::{LoadHistory, StationLoads};
use serde::{Deserialize, Serialize};

/// Loads that the blade outboard of a station puts on the rest of it, flaps at rest.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct StationLine {
    /// Station, R.
    pub station_r: f64,
    /// Axial force, tension positive.
    #[serde(rename = "axial_force_N")]
    pub axial_force_newton: LoadLine,
    /// Shear in the plane of the undeformed blade's rotation, toward the leading edge.
    #[serde(rename = "inplane_shear_N")]
    pub inplane_shear_newton: LoadLine,
    /// Shear out of that plane, up.
    #[serde(rename = "out_of_plane_shear_N")]
    pub out_of_plane_shear_newton: LoadLine,
    /// Flapwise bending moment, tip up positive.
    #[serde(rename = "flap_moment_N_m")]
    pub flap_newton_metre: MomentLine,
    /// Lagwise bending moment, tip forward.
    #[serde(rename = "lag_moment_N_m")]
    pub lag_newton_metre: MomentLine,
    /// Torsion, nose up.
    #[serde(rename = "torsion_N_m")]
    pub torsion_newton_metre: MomentLine,
}

/// One load over the revolution.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct LoadLine {
    /// Mean.
    pub mean: f64,
    /// Largest less smallest value.
    pub peak_to_peak: f64,
    /// `[cosine, sine]` at 1, 2, 3 ... per rev.
    pub harmonics: Vec<[f64; 2]>,
}

/// One moment, as it was found.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MomentLine {
    /// Force summation with the terms that the equations of motion keep: what the hub gets, and the exact
    /// counterpart of the curvature.
    pub force_summation: LoadLine,
    /// Statics of the whole blade as it is deflected, about its deflected axis: off the force summation by the
    /// terms of third order that the equations leave out.
    pub deflected_statics: LoadLine,
    /// Curvature and rate of twist of the modes.
    pub curvature: LoadLine,
}

impl LoadLine {
    fn new(series: &HarmonicSeries, peak_to_peak: f64, unit: f64) -> Self {
        let harmonics = series.harmonics.iter();
        Self {
            mean: unit * series.mean,
            peak_to_peak: unit * peak_to_peak,
            harmonics: harmonics.map(|h| [unit * h.cosine, unit * h.sine]).collect(),
        }
    }
}

impl StationLine {
    fn new(loads: &StationLoads, scales: &RotorScales) -> Self {
        let line = |history: &LoadHistory<3>, k: usize, unit: f64| {
            LoadLine::new(&history.harmonics[k], history.peak_to_peak()[k], unit)
        };
        let force = |k| line(&loads.forces, k, scales.force_newton());
        let moment = |k| {
            let [force_summation, deflected_statics, curvature] =
                [&loads.moments, &loads.statics, &loads.curvature]
                    .map(|history| line(history, k, scales.moment_newton_metre()));
            MomentLine { force_summation, deflected_statics, curvature }
        };
        Self {
            station_r: loads.station,
            axial_force_newton: force(0),
            inplane_shear_newton: force(1),
            out_of_plane_shear_newton: force(2),
            flap_newton_metre: moment(0),
            lag_newton_metre: moment(1),
            torsion_newton_metre: moment(2),
        }
    }
}

/// The loads at every station as a result.
pub fn station_lines(loads: &[StationLoads], scales: &RotorScales) -> Vec<StationLine> {
    loads.iter().map(|at| StationLine::new(at, scales)).collect()
}

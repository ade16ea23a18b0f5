//! Loads along one blade of the trimmed rotor as a result: at stations, in three ways.

use crate::case::Case;
use crate::output::table;
use rotor_base::{HarmonicSeries, RotorScales};
use rotor_response::{LoadHistory, StationLoads};
use serde::{Deserialize, Serialize};
use std::fmt::Write as _;

/// Stations outboard of the root at which the loads are given unless a case says others, R.
const USUAL_STATIONS_R: [f64; 3] = [0.25, 0.5, 0.75];

impl Case {
    /// Stations at which the loads of the blade are asked for, R; root, 0.25, 0.5 and 0.75 unless the case says
    /// others.
    pub fn load_stations_r(&self) -> Vec<f64> {
        let root = self.blade.root_offset;
        self.response.load_stations_r.clone().unwrap_or_else(|| {
            let outboard = USUAL_STATIONS_R.into_iter().filter(|station| *station > root + 1e-3);
            std::iter::once(root).chain(outboard).collect()
        })
    }
}

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
pub(crate) fn station_lines(loads: &[StationLoads], scales: &RotorScales) -> Vec<StationLine> {
    loads.iter().map(|at| StationLine::new(at, scales)).collect()
}

/// The moments at every station as a table: force summation beside the statics of the deflected blade and the curvature.
pub(crate) fn moments_table(lines: &[StationLine]) -> String {
    let rows = lines.iter().flat_map(|line| {
        [
            ("flap", &line.flap_newton_metre),
            ("lag", &line.lag_newton_metre),
            ("torsion", &line.torsion_newton_metre),
        ]
        .map(|(name, moment)| {
            let number = |value: f64| format!("{value:.2}");
            let MomentLine { force_summation, deflected_statics, curvature } = moment;
            let [summed, deflected, curved] = [force_summation, deflected_statics, curvature];
            let per_rev = |n: usize| {
                let amplitude = summed.harmonics.get(n - 1).map(|[c, s]| c.hypot(*s));
                amplitude.map_or_else(String::new, number)
            };
            vec![
                format!("{:.3} R {name}", line.station_r),
                number(summed.mean),
                per_rev(1),
                per_rev(2),
                per_rev(3),
                per_rev(4),
                number(summed.peak_to_peak),
                number(deflected.mean),
                number(deflected.peak_to_peak),
                number(curved.mean),
                number(curved.peak_to_peak),
            ]
        })
    });
    let moments = table(
        &[
            "force summation",
            "mean",
            "1/rev",
            "2/rev",
            "3/rev",
            "4/rev",
            "peak to peak",
            "statics mean",
            "p-p",
            "curvature mean",
            "p-p",
        ],
        rows,
    );
    moments + &curvature_gap(lines).unwrap_or_default()
}

/// Mean moment that the curvature of the modes misses, over the largest mean of the force summation along the
/// span, from which it is worth a word.
const WIDE_GAP: f64 = 0.05;

/// How far the curvature of the modes kept is from the load, where that is far.
fn curvature_gap(lines: &[StationLine]) -> Option<String> {
    let of_line = |line: &StationLine, k: usize| {
        let moment =
            [&line.flap_newton_metre, &line.lag_newton_metre, &line.torsion_newton_metre][k];
        (moment.force_summation.mean, moment.curvature.mean)
    };
    let mut widest = (WIDE_GAP, None);
    for (k, name) in ["flap", "lag", "torsion"].into_iter().enumerate() {
        let most = lines.iter().map(|line| of_line(line, k).0.abs()).fold(0.0, f64::max);
        for line in lines {
            let (summed, curved) = of_line(line, k);
            let gap = (curved - summed).abs() / most;
            if gap > widest.0 {
                widest = (gap, Some((name, line.station_r)));
            }
        }
    }
    let (gap, Some((name, station))) = widest else { return None };
    Some(format!(
        "The load is the force summation. Curvature is what the modes kept can bend: {name} at {station:.3} R is {:.0} % of\nthe largest off; with structure.basis: Completed and more modes the two meet.\n",
        1e2 * gap
    ))
}

/// The loads at every azimuth and station as CSV text, every digit kept.
pub fn blade_loads_csv(loads: &[StationLoads], scales: &RotorScales) -> String {
    let mut text = String::from("azimuth_deg,station_r");
    for force in ["axial_force", "inplane_shear", "out_of_plane_shear"] {
        // writing to a string cannot fail
        let _ = write!(text, ",{force}_N");
    }
    for method in ["force_summation", "deflected_statics", "curvature"] {
        for moment in ["flap_moment", "lag_moment", "torsion"] {
            let _ = write!(text, ",{moment}_{method}_N_m");
        }
    }
    text.push('\n');
    let [newton, newton_metre] = [scales.force_newton(), scales.moment_newton_metre()];
    for at in loads {
        for (p, azimuth) in at.azimuths_rad.iter().enumerate() {
            let _ = write!(text, "{:e},{}", azimuth.to_degrees(), at.station);
            let moments = [&at.moments, &at.statics, &at.curvature];
            let columns = at.forces.values[p]
                .iter()
                .map(|f| newton * f)
                .chain(moments.into_iter().flat_map(|m| m.values[p]).map(|m| newton_metre * m));
            for value in columns {
                let _ = write!(text, ",{value:e}");
            }
            text.push('\n');
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{BasisChoice, shipped_case};
    use crate::progress::Progress;
    use crate::run::run_case;

    /// Four natural modes bend the root of the lagging blade 14 % less than the load asks; ten completed ones of
    /// each family do not.
    #[test]
    fn a_curvature_far_from_the_load_is_pointed_at() {
        let mut loaded = shipped_case("crosscheck_s2.ron").unwrap();
        let natural = run_case(&loaded, &Progress::hidden()).unwrap().result;
        let text = curvature_gap(&natural.blade_loads).unwrap();
        assert!(text.contains("lag at 0.000 R is 14 %"), "{text}");
        loaded.case.blade.modes = [10, 10, 10];
        loaded.case.blade.basis = BasisChoice::Completed;
        let completed = run_case(&loaded, &Progress::hidden()).unwrap().result;
        assert_eq!(curvature_gap(&completed.blade_loads), None);
    }
}

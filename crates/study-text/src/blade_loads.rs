//! Loads along a blade as a table and as CSV, and hub loads of dissimilar blades as a table.

use report_page::{table, table_of};
use rotor_base::RotorScales;
use rotor_response::StationLoads;
use rotor_study::{MomentLine, StationLine, UnlikeLine};
use std::fmt::Write as _;

/// The three moments at a station, by name.
fn moments(line: &StationLine) -> [(&'static str, &MomentLine); 3] {
    [
        ("flap", &line.flap_newton_metre),
        ("lag", &line.lag_newton_metre),
        ("torsion", &line.torsion_newton_metre),
    ]
}

/// The moments at every station as a table: force summation beside the statics of the deflected blade and the curvature.
pub fn moments_table(lines: &[StationLine]) -> String {
    let number = |value: f64| format!("{value:.2}");
    let per_rev = |moment: &MomentLine, n: usize| {
        let amplitude = moment.force_summation.harmonics.get(n - 1).map(|[c, s]| c.hypot(*s));
        amplitude.map_or_else(String::new, number)
    };
    let rows = lines.iter().flat_map(|line| {
        moments(line).map(|(name, moment)| (format!("{:.3} R {name}", line.station_r), moment))
    });
    let moments = table_of(
        rows,
        &[
            ("force summation", &|(name, _)| name.clone()),
            ("mean", &|(_, m)| number(m.force_summation.mean)),
            ("1/rev", &|(_, m)| per_rev(m, 1)),
            ("2/rev", &|(_, m)| per_rev(m, 2)),
            ("3/rev", &|(_, m)| per_rev(m, 3)),
            ("4/rev", &|(_, m)| per_rev(m, 4)),
            ("peak to peak", &|(_, m)| number(m.force_summation.peak_to_peak)),
            ("statics mean", &|(_, m)| number(m.deflected_statics.mean)),
            ("p-p", &|(_, m)| number(m.deflected_statics.peak_to_peak)),
            ("curvature mean", &|(_, m)| number(m.curvature.mean)),
            ("p-p", &|(_, m)| number(m.curvature.peak_to_peak)),
        ],
    );
    moments + &curvature_gap(lines).unwrap_or_default()
}

/// Mean moment that the curvature of the modes misses, over the largest mean of the force summation along the
/// span, from which it is worth a word.
const WIDE_GAP: f64 = 0.05;

/// How far the curvature of the modes kept is from the load, where that is far.
pub fn curvature_gap(lines: &[StationLine]) -> Option<String> {
    let mut widest = (WIDE_GAP, None);
    for k in 0..3 {
        let means = |line: &StationLine| {
            let (name, moment) = moments(line)[k];
            (name, moment.force_summation.mean, moment.curvature.mean)
        };
        let most = lines.iter().map(|line| means(line).1.abs()).fold(0.0, f64::max);
        for line in lines {
            let (name, summed, curved) = means(line);
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
    let forces = ["axial_force", "inplane_shear", "out_of_plane_shear"];
    let forces = forces.map(|force| format!(",{force}_N")).concat();
    let methods = ["force_summation", "deflected_statics", "curvature"].map(|method| {
        ["flap_moment", "lag_moment", "torsion"].map(|m| format!(",{m}_{method}_N_m")).concat()
    });
    let mut text = format!("azimuth_deg,station_r{forces}{}\n", methods.concat());
    let [newton, newton_metre] = [scales.force_newton(), scales.moment_newton_metre()];
    for at in loads {
        for (p, azimuth) in at.azimuths_rad.iter().enumerate() {
            // writing to a string cannot fail
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

/// Hub loads with dissimilar blades: amplitudes of all loads, a line for every harmonic.
pub fn unlike_table(line: &UnlikeLine) -> String {
    let header = ["per rev", "FX", "FY", "FZ", "MX", "MY", "MZ"];
    table(
        &header,
        line.per_rev.iter().enumerate().map(|(i, loads)| {
            let amplitudes = loads.amplitudes().map(|a| format!("{a:.3e}"));
            std::iter::once((i + 1).to_string()).chain(amplitudes).collect()
        }),
    )
}

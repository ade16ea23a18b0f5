//! Airloads and the motion of the blade tip as CSV, for other programs.

use report_page::csv_of;
use rotor_response::{StationAirloads, TipMotion};

/// Airloads at every station and azimuth as CSV text, every digit kept.
pub fn airloads_csv(stations: &[StationAirloads]) -> String {
    let rows = stations.iter().flat_map(|of| of.loads.iter().map(|load| (of.station, load)));
    csv_of(
        rows,
        &[
            ("station_r", &|(station, _)| station.to_string()),
            ("azimuth_deg", &|(_, load)| load.azimuth_rad.to_degrees().to_string()),
            ("cn_m2", &|(_, load)| format!("{:e}", load.normal_m2)),
            ("cm_m2", &|(_, load)| format!("{:e}", load.moment_m2)),
            ("cc_m2", &|(_, load)| format!("{:e}", load.chord_m2)),
            ("cn", &|(_, load)| format!("{:e}", load.normal)),
            ("mach", &|(_, load)| format!("{:e}", load.mach)),
        ],
    )
}

/// The motion of the blade tip as CSV text, every digit kept.
pub fn tip_csv(motion: &[TipMotion]) -> String {
    csv_of(
        motion,
        &[
            ("azimuth_deg", &|at| at.azimuth_rad.to_degrees().to_string()),
            ("flap_percent_r", &|at| format!("{:e}", 100.0 * at.flap)),
            ("lag_percent_r", &|at| format!("{:e}", 100.0 * at.lag)),
            ("elastic_twist_deg", &|at| format!("{:e}", at.twist_rad.to_degrees())),
        ],
    )
}

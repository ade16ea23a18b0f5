//! Rotating modes as a table, and the data of a fan plot.

use report_page::{Sheet, csv_of, table};
use rotor_study::{ModesResult, numbered};

/// The fan plot as a table: one row for each mode at each rotor speed.
pub fn fan_csv(result: &ModesResult) -> String {
    let rows = result.fan.iter().flat_map(|point| {
        let named = numbered(&point.modes).zip(&point.modes);
        named.map(move |(name, mode)| (point.rotor_speed_rad_s, name, mode))
    });
    csv_of(
        rows,
        &[
            ("rotor_speed_rad_s", &|(speed, ..)| speed.to_string()),
            ("mode", &|(_, name, _)| name.clone()),
            ("frequency_hz", &|(.., mode)| format!("{:.9}", mode.hz)),
            ("per_rev", &|(.., mode)| mode.per_rev.map_or(String::new(), |p| format!("{p:.9}"))),
            ("flap_share", &|(.., mode)| format!("{:.6}", mode.energy[0])),
            ("lag_share", &|(.., mode)| format!("{:.6}", mode.energy[1])),
            ("torsion_share", &|(.., mode)| format!("{:.6}", mode.energy[2])),
            ("axial_share", &|(.., mode)| format!("{:.6}", mode.energy[3])),
        ],
    )
}

/// Modes for people: frequency and division of the kinetic energy, warnings, and frequencies over rotor speed where there are any.
pub fn modes_text(modes: &ModesResult) -> String {
    let mut sheet = Sheet::default();
    sheet.line(format_args!("Rotor speed {:.4} rad/s", modes.rotor_speed_rad_s));
    if let Some(tip) = modes.steady_tip {
        sheet.line(format_args!(
            "Steady tip: lag {:.5} R, flap {:.5} R, twist {:.3} deg",
            tip.lag_r, tip.flap_r, tip.twist_deg
        ));
    }
    sheet.block(&table(
        &["mode", "per rev", "Hz", "flap %", "lag %", "torsion %"],
        numbered(&modes.modes).zip(&modes.modes).map(|(name, mode)| {
            let per_rev = mode.per_rev.map_or_else(|| "-".to_owned(), |p| format!("{p:.6}"));
            let shares = mode.energy.iter().take(3).map(|e| format!("{:.1}", 100.0 * e));
            [name, per_rev, format!("{:.4}", mode.hz)].into_iter().chain(shares).collect()
        }),
    ));
    for warning in &modes.warnings {
        sheet.line(format_args!("warning: {warning}"));
    }
    if !modes.fan.is_empty() {
        sheet.line(format_args!("\nFrequencies in Hz over rotor speed"));
        let names: Vec<String> = numbered(&modes.modes).collect();
        let mut header = vec!["rad/s"];
        header.extend(names.iter().map(String::as_str));
        sheet.block(&table(
            &header,
            modes.fan.iter().map(|point| {
                std::iter::once(format!("{:.4}", point.rotor_speed_rad_s))
                    .chain(point.modes.iter().map(|m| format!("{:.3}", m.hz)))
                    .collect()
            }),
        ));
    }
    sheet.finish()
}

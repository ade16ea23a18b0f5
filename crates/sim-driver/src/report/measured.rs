//! Measured against computed: tables, and the numbers as CSV.

use crate::results::{Figures, curve_name};
use report_page::Section;
use rotor_base::Harmonic;
use rotor_study::{BandPeak, CurveComparison, LISTED_HARMONICS, VortexComparison};
use std::fmt::Write as _;

/// Names of the two sides of the disk, in the order of [`rotor_study::SIDES_DEG`].
const SIDES: [&str; 2] = ["advancing", "retreating"];

/// The tables of a result with measured data, the agreement first; none without.
pub(super) fn sections(figures: &Figures) -> Vec<Section> {
    let mut sections = Vec::new();
    if !figures.measured.is_empty() || figures.vortices.is_some() {
        sections.push(agreement(figures));
    }
    if !figures.measured.is_empty() {
        sections.push(harmonics(&figures.measured));
        sections.push(bands(&figures.measured));
    }
    sections
}

fn header(heads: &[&str]) -> Vec<String> {
    heads.iter().map(|head| (*head).to_owned()).collect()
}

/// A value of a curve: four digits, whatever its size.
fn number(value: f64) -> String {
    let digits = if value == 0.0 || !value.is_finite() { 0 } else { 3 - decade(value) };
    format!("{value:.*}", usize::try_from(digits.clamp(0, 7)).unwrap_or_default())
}

#[expect(clippy::cast_possible_truncation, reason = "a decade of a finite number is small")]
fn decade(value: f64) -> i32 {
    value.abs().log10().floor() as i32
}

fn optional<T>(value: Option<T>, text: impl Fn(T) -> String) -> String {
    value.map_or_else(|| "-".to_owned(), text)
}

fn name(of: &CurveComparison) -> String {
    curve_name(of.quantity, of.station_r)
}

/// How every curve agrees, in one row.
fn agreement(figures: &Figures) -> Section {
    let rows = figures.measured.iter().map(|of| {
        vec![
            name(of),
            number(of.measured.mean),
            number(of.computed.mean),
            format!("{:.3}", of.from_1.correlation),
            number(of.from_1.rms),
            format!("{:.3}", of.from_2.correlation),
            optional(of.distance, number),
            format!("1 to {}", of.last_harmonic),
        ]
    });
    let mut text = "Correlation and rms distance are of the harmonics named last, means removed; from 2/rev on beside, for 1/rev follows from the trim. Distance: rms at the measured azimuths, means and all harmonics included.".to_owned();
    for of in &figures.measured {
        let _ = write!(text, " {}: {}.", name(of), of.source);
    }
    if let Some(VortexComparison { vertical_percent_r, compared, measured }) = figures.vortices {
        let _ = write!(
            text,
            " Tip vortices: vertical rms distance {vertical_percent_r:.2} % R over {compared} of {measured} measured centres; the others have no computed vortex near them."
        );
    }
    Section {
        title: "Measured against computed".to_owned(),
        text,
        header: header(&[
            "curve",
            "mean",
            "computed",
            "correlation",
            "rms",
            "from 2/rev",
            "distance",
            "per rev",
        ]),
        rows: rows.collect(),
    }
}

/// Amplitude and phase of every harmonic.
fn harmonics(measured: &[CurveComparison]) -> Section {
    let rows = measured.iter().flat_map(|of| {
        (1..=LISTED_HARMONICS).map(move |n| {
            let mut cells = vec![name(of), n.to_string()];
            for series in [&of.measured, &of.computed] {
                let harmonic = series.harmonics.get(n - 1);
                cells.push(optional(harmonic, |h| number(h.amplitude())));
                cells.push(optional(harmonic, |h| format!("{:.0}", h.phase_deg())));
            }
            cells
        })
    });
    Section {
        title: "Measured and computed harmonics".to_owned(),
        text: "A cos(n psi - phase), phase in deg; - where the data do not resolve the harmonic."
            .to_owned(),
        header: header(&["curve", "per rev", "measured", "phase", "computed", "phase"]),
        rows: rows.collect(),
    }
}

/// What is above the listed harmonics on both sides of the disk.
fn bands(measured: &[CurveComparison]) -> Section {
    let rows = measured.iter().flat_map(|of| {
        (0..SIDES.len()).map(move |side| {
            let mut cells = vec![name(of), SIDES[side].to_owned()];
            for band in [of.measured_band[side], of.computed_band[side]] {
                cells.push(optional(band, |band: BandPeak| number(band.peak_to_peak)));
                cells.push(optional(band, |band: BandPeak| format!("{:.0}", band.azimuth_deg)));
            }
            cells
        })
    });
    Section {
        title: format!("Measured and computed above {LISTED_HARMONICS}/rev"),
        text: "Peak to peak from 20 to 90 deg (advancing) and from 270 to 340 deg (retreating), and the azimuth of the largest peak, deg; - where the data do not resolve the band.".to_owned(),
        header: header(&["curve", "side", "measured", "peak at", "computed", "peak at"]),
        rows: rows.collect(),
    }
}

/// Every number of the tables as CSV text, every digit kept; an empty field has no value.
pub fn measured_csv(figures: &Figures) -> String {
    let mut text = String::from("quantity,station_r,figure,per_rev,measured,computed,agreement\n");
    let value = |v: Option<f64>| v.map_or_else(String::new, |v| format!("{v:e}"));
    for of in &figures.measured {
        let station = of.station_r.map_or_else(String::new, |station| station.to_string());
        let mut row = |figure: &str, per_rev: &str, values: [Option<f64>; 3]| {
            let [measured, computed, agreement] = values.map(value);
            let quantity = of.quantity.name();
            // writing to a string cannot fail
            let _ = writeln!(
                text,
                "{quantity},{station},{figure},{per_rev},{measured},{computed},{agreement}"
            );
        };
        row("mean", "0", [Some(of.measured.mean), Some(of.computed.mean), None]);
        for n in 1..=LISTED_HARMONICS {
            let both = [&of.measured, &of.computed].map(|series| series.harmonics.get(n - 1));
            let [measured, computed] = both.map(|h| h.map(Harmonic::amplitude));
            row("amplitude", &n.to_string(), [measured, computed, None]);
            let [measured, computed] = both.map(|h| h.map(Harmonic::phase_deg));
            row("phase_deg", &n.to_string(), [measured, computed, None]);
        }
        for (first, agreement) in [(1, of.from_1), (2, of.from_2)] {
            let range = format!("{first}-{}", of.last_harmonic);
            row("correlation", &range, [None, None, Some(agreement.correlation)]);
            row("rms", &range, [None, None, Some(agreement.rms)]);
        }
        row("distance", "", [None, None, of.distance]);
        for (k, side) in SIDES.iter().enumerate() {
            let both = [of.measured_band[k], of.computed_band[k]];
            let above = format!(">{LISTED_HARMONICS}");
            let [measured, computed] = both.map(|band| band.map(|band| band.peak_to_peak));
            row(&format!("peak_to_peak_{side}"), &above, [measured, computed, None]);
            let [measured, computed] = both.map(|band| band.map(|band| band.azimuth_deg));
            row(&format!("peak_azimuth_{side}_deg"), &above, [measured, computed, None]);
        }
    }
    if let Some(vortices) = figures.vortices {
        let distance = value(Some(vortices.vertical_percent_r));
        let _ = writeln!(text, "vortex_centres_percent_r,,vertical_distance,,,,{distance}");
    }
    text
}

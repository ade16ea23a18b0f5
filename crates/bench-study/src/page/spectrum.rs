//! Spectrum of the residuals beside the noise.

use super::loops::line;
use super::{MEASURED, MODEL, MOST_RUNS, RUNS, SPECTRUM};
use crate::identification::BenchIdentification;
use crate::spectra::{ResidualSpectrum, spectra};
use report_page::pictures::{Look, Panel, Series, legend, short};
use report_page::{Markup, counted, folded, grid, titled};

/// A panel for every run, the worst first.
pub(super) fn section(found: &BenchIdentification, simulated: &[Vec<f64>], unit: &str) -> Markup {
    let mut spectra: Vec<(f64, ResidualSpectrum)> = spectra(found, simulated)
        .into_iter()
        .zip(&found.fits)
        .map(|(own, fit)| (fit.nrmse_percent, own))
        .collect();
    spectra.sort_by(|a, b| b.0.total_cmp(&a.0));
    spectra.truncate(MOST_RUNS);
    let looks = [line("noise of repeated cycles", MEASURED), line("residual", MODEL)];
    let panel = |(_, own): &(f64, ResidualSpectrum)| {
        let ends = [own.bands.first(), own.bands.last()].into_iter().flatten();
        let floor = own.noise.map(|noise| ends.map(|end| [end[0], noise]).collect());
        let series = |look: &Look, points: Vec<[f64; 2]>| Series {
            look: look.clone(),
            points,
            told: Vec::new(),
        };
        let note = match own.noise {
            Some(noise) => format!("noise {} {unit}", short(noise)),
            None => "noise not known: no cycle repeats".to_owned(),
        };
        let panel = Panel {
            title: own.id.clone(),
            note,
            axes: ["frequency, Hz".to_owned(), format!("rms of a line, {unit}")],
            is_log: [true, true],
            series: vec![
                series(&looks[0], floor.unwrap_or_default()),
                series(&looks[1], own.bands.clone()),
            ],
            ..Panel::default()
        };
        panel.markup()
    };
    let (first, rest) = spectra.split_at(spectra.len().min(RUNS));
    let mut parts = vec![legend(&looks), grid("grid", first.iter().map(panel))];
    if !rest.is_empty() {
        let title = format!("{} more", counted(rest.len(), "run"));
        parts.push(folded(&title, &grid("grid", rest.iter().map(panel))));
    }
    let mut text = "Measured less simulated, over the samples judged. Where blue lies above grey, the model misses something. White noise is a level line at its standard deviation. What still settles from cycle to cycle counts as noise.".to_owned();
    if spectra.iter().any(|own| own.1.noise.is_none()) {
        text += " A run without a grey line repeats no cycle: record three steady cycles or more.";
    }
    titled("spectrum", SPECTRUM, &text, &parts)
}

//! Measured airloads, tip motion and tip vortices beside the computed ones.
//!
//! ```text
//! x = sum_n (c_n cos n psi + s_n sin n psi),   n from the first to the last harmonic compared, mean removed
//! correlation = <x_m x_c> / sqrt(<x_m^2> <x_c^2>),   rms = sqrt <(x_c - x_m)^2>      < > mean over the revolution
//! ```

use nalgebra::{DMatrix, DVector};
use rotor_base::{
    Harmonic, HarmonicSeries, harmonic_waves, mean_square, uniform_azimuths_rad, wrap_degrees,
};
use rotor_response::{SectionAirload, StationAirloads, TipMotion};
use rotor_wake::FreeWake;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Harmonics that are listed, and removed from the band above.
pub const LISTED_HARMONICS: usize = 10;
/// Last harmonic of a correlation.
pub const CORRELATED_HARMONICS: usize = 6;
/// Azimuths of a computed curve: every degree.
pub const CURVE_AZIMUTHS: usize = 360;
/// Advancing and retreating side, deg: where the band above the listed harmonics is judged.
pub const SIDES_DEG: [[f64; 2]; 2] = [[20.0, 90.0], [270.0, 340.0]];

/// What is compared of a section or of the blade tip; the name is that of its column in tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Quantity {
    /// `C_n M^2`, up positive.
    #[serde(rename = "cn_m2")]
    NormalM2,
    /// `C_m M^2`, nose up positive.
    #[serde(rename = "cm_m2")]
    MomentM2,
    /// `C_c M^2`, toward the leading edge positive.
    #[serde(rename = "cc_m2")]
    ChordM2,
    /// `C_n`, up positive.
    #[serde(rename = "cn")]
    Normal,
    /// Tip deflection, up positive, percent of R.
    #[serde(rename = "flap_percent_r")]
    TipFlap,
    /// Tip deflection, toward the leading edge positive, percent of R.
    #[serde(rename = "lag_percent_r")]
    TipLag,
    /// Elastic twist of the tip, nose up positive, deg.
    #[serde(rename = "elastic_twist_deg")]
    TipTwist,
}

impl Quantity {
    /// Those of a section.
    pub const OF_SECTION: [Self; 4] = [Self::NormalM2, Self::MomentM2, Self::ChordM2, Self::Normal];
    /// Those of the blade tip.
    pub const OF_TIP: [Self; 3] = [Self::TipFlap, Self::TipLag, Self::TipTwist];

    /// Name of its column.
    pub fn name(self) -> &'static str {
        match self {
            Self::NormalM2 => "cn_m2",
            Self::MomentM2 => "cm_m2",
            Self::ChordM2 => "cc_m2",
            Self::Normal => "cn",
            Self::TipFlap => "flap_percent_r",
            Self::TipLag => "lag_percent_r",
            Self::TipTwist => "elastic_twist_deg",
        }
    }

    /// Its value in the airload of a section; NaN for one of the tip.
    fn of_section(self, at: &SectionAirload) -> f64 {
        match self {
            Self::NormalM2 => at.normal_m2,
            Self::MomentM2 => at.moment_m2,
            Self::ChordM2 => at.chord_m2,
            Self::Normal => at.normal,
            Self::TipFlap | Self::TipLag | Self::TipTwist => f64::NAN,
        }
    }

    /// Its value in the motion of the tip; NaN for one of a section.
    fn of_tip(self, at: &TipMotion) -> f64 {
        match self {
            Self::TipFlap => 100.0 * at.flap,
            Self::TipLag => 100.0 * at.lag,
            Self::TipTwist => at.twist_rad.to_degrees(),
            Self::NormalM2 | Self::MomentM2 | Self::ChordM2 | Self::Normal => f64::NAN,
        }
    }
}

/// A computed curve over the revolution.
#[derive(Debug, Clone, PartialEq)]
pub struct ComputedCurve {
    /// What it is.
    pub quantity: Quantity,
    /// Station of the section, R; none of the tip.
    pub station_r: Option<f64>,
    /// Values at equal azimuths from 0, in the unit of the quantity.
    pub values: Vec<f64>,
}

/// The curves of sections and tip.
pub fn computed_curves(airloads: &[StationAirloads], tip: &[TipMotion]) -> Vec<ComputedCurve> {
    let sections = airloads.iter().flat_map(|at| {
        Quantity::OF_SECTION.map(|quantity| ComputedCurve {
            quantity,
            station_r: Some(at.station),
            values: at.loads.iter().map(|load| quantity.of_section(load)).collect(),
        })
    });
    let tip = Quantity::OF_TIP.map(|quantity| ComputedCurve {
        quantity,
        station_r: None,
        values: tip.iter().map(|at| quantity.of_tip(at)).collect(),
    });
    sections.chain(tip).collect()
}

/// The harmonics that equal samples resolve, no more than `most`.
pub fn series_of(values: &[f64], most: usize) -> HarmonicSeries {
    let count = most.min(values.len().saturating_sub(1) / 2);
    HarmonicSeries::from_uniform_samples(values, count).unwrap_or_default()
}

/// What was measured of a quantity over the revolution, in its unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum MeasuredData {
    /// Values against azimuth.
    #[serde(rename = "samples")]
    Samples {
        /// Azimuths, deg, in any order and at any distance.
        azimuth_deg: Vec<f64>,
        /// Values there.
        values: Vec<f64>,
    },
    /// Mean and harmonics.
    #[serde(rename = "harmonics")]
    Harmonics(HarmonicSeries),
}

/// A measured curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct MeasuredCurve {
    /// What it is.
    pub quantity: Quantity,
    /// Station of the section, R; none of the tip.
    pub station_r: Option<f64>,
    /// File, as the case names it, and the rows taken of it.
    pub source: String,
    /// What was measured.
    pub measured: MeasuredData,
}

/// Samples for each unknown of a fit of harmonics, at least.
const SAMPLES_PER_UNKNOWN: f64 = 5.0 / 3.0;

/// The harmonics that samples resolve, [`LISTED_HARMONICS`] at most: five samples for three unknowns, and no period shorter
/// than the largest gap between azimuths.
pub fn resolved_harmonics(azimuth_deg: &[f64]) -> usize {
    let mut sorted: Vec<f64> = azimuth_deg.iter().map(|psi| psi.rem_euclid(360.0)).collect();
    sorted.sort_by(f64::total_cmp);
    let (Some(first), Some(last)) = (sorted.first(), sorted.last()) else { return 0 };
    let around = first + 360.0 - last;
    let gap_deg = sorted.windows(2).map(|pair| pair[1] - pair[0]).fold(around, f64::max);
    let by_gap = (1..=LISTED_HARMONICS).take_while(|n| *n as f64 * gap_deg <= 360.0).count();
    let fits = |n: &usize| (2 * n + 1) as f64 * SAMPLES_PER_UNKNOWN <= sorted.len() as f64;
    (1..=by_gap).take_while(fits).count()
}

impl MeasuredData {
    /// Mean and harmonics: of samples by least squares over those that they resolve ([`resolved_harmonics`]).
    pub fn series(&self) -> HarmonicSeries {
        match self {
            Self::Harmonics(series) => series.clone(),
            Self::Samples { azimuth_deg, values } => {
                let count = resolved_harmonics(azimuth_deg);
                let psi = azimuth_deg.iter().map(|psi| psi.to_radians());
                let waves = psi.flat_map(|psi| harmonic_waves(psi, count));
                let waves = DMatrix::from_row_iterator(values.len(), 1 + 2 * count, waves);
                let found = waves.svd(true, true).solve(&DVector::from_column_slice(values), 1e-9);
                let Ok(found) = found else { return HarmonicSeries::default() };
                let pair = |n: usize| Harmonic { cosine: found[2 * n - 1], sine: found[2 * n] };
                HarmonicSeries { mean: found[0], harmonics: (1..=count).map(pair).collect() }
            }
        }
    }

    /// Azimuths, deg, and values to judge and to draw: the samples, or the harmonics at every degree.
    pub fn points(&self) -> (Vec<f64>, Vec<f64>) {
        match self {
            Self::Samples { azimuth_deg, values } => (azimuth_deg.clone(), values.clone()),
            Self::Harmonics(series) => {
                let psi = uniform_azimuths_rad(CURVE_AZIMUTHS);
                let values = psi.iter().map(|psi| series.value(*psi)).collect();
                (psi.iter().map(|psi| psi.to_degrees()).collect(), values)
            }
        }
    }
}

/// How two curves agree over some harmonics, their means removed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Agreement {
    /// Correlation, -1 to 1; NaN where one of the curves is constant.
    pub correlation: f64,
    /// Rms distance, in the unit of the curves.
    pub rms: f64,
}

/// Agreement of the harmonics in a range; a harmonic that a series does not hold counts as zero.
pub fn agreement(
    computed: &HarmonicSeries,
    measured: &HarmonicSeries,
    harmonics: RangeInclusive<usize>,
) -> Agreement {
    let [mut xx, mut yy, mut xy] = [0.0; 3];
    for n in harmonics {
        let (x, y) = (computed.harmonic(n), measured.harmonic(n));
        // the mean of a squared harmonic is half of its squared amplitude
        xx += 0.5 * (x.cosine * x.cosine + x.sine * x.sine);
        yy += 0.5 * (y.cosine * y.cosine + y.sine * y.sine);
        xy += 0.5 * (x.cosine * y.cosine + x.sine * y.sine);
    }
    Agreement { correlation: xy / (xx * yy).sqrt(), rms: (xx + yy - 2.0 * xy).max(0.0).sqrt() }
}

/// A curve above its listed harmonics on one side of the disk.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct BandPeak {
    /// Peak to peak, in the unit of the curve.
    pub peak_to_peak: f64,
    /// Azimuth of the largest size, deg.
    pub azimuth_deg: f64,
}

/// A curve less mean and [`LISTED_HARMONICS`] harmonics of its series, on both [`SIDES_DEG`]; none without samples there.
pub fn band_peaks(
    azimuth_deg: &[f64],
    values: &[f64],
    series: &HarmonicSeries,
) -> [Option<BandPeak>; 2] {
    let harmonics = series.harmonics.iter().take(LISTED_HARMONICS).copied().collect();
    let low = HarmonicSeries { mean: series.mean, harmonics };
    SIDES_DEG.map(|[from, to]| {
        let [mut least, mut most, mut size, mut at] = [f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0];
        for (psi, value) in azimuth_deg.iter().zip(values) {
            let psi = psi.rem_euclid(360.0);
            if (from..=to).contains(&psi) {
                let above = value - low.value(psi.to_radians());
                (least, most) = (above.min(least), above.max(most));
                if above.abs() > size {
                    (size, at) = (above.abs(), psi);
                }
            }
        }
        (size >= 0.0).then_some(BandPeak { peak_to_peak: most - least, azimuth_deg: at })
    })
}

/// A measured curve beside the computed one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CurveComparison {
    /// What is compared.
    pub quantity: Quantity,
    /// Station of the section, R; none of the tip.
    pub station_r: Option<f64>,
    /// File and rows of the measured curve.
    pub source: String,
    /// Mean and up to [`LISTED_HARMONICS`] harmonics measured, those that the data resolve.
    pub measured: HarmonicSeries,
    /// The same computed, all of them.
    pub computed: HarmonicSeries,
    /// Agreement of 1/rev up to `last_harmonic`.
    pub from_1: Agreement,
    /// The same from 2/rev on: 1/rev follows from the trim.
    pub from_2: Agreement,
    /// Last harmonic of both agreements, [`CORRELATED_HARMONICS`] where the data resolve it.
    pub last_harmonic: usize,
    /// Rms distance at the measured azimuths, means and all harmonics included; none of measured harmonics.
    pub distance: Option<f64>,
    /// The measured curve above its listed harmonics, advancing and retreating side; none where it does not resolve them.
    pub measured_band: [Option<BandPeak>; 2],
    /// The same computed.
    pub computed_band: [Option<BandPeak>; 2],
}

/// A measured curve beside the computed values at equal azimuths.
pub fn compare_curves(of: &MeasuredCurve, computed: &[f64]) -> CurveComparison {
    let MeasuredCurve { quantity, station_r, ref source, ref measured } = *of;
    let (own, whole) = (series_of(computed, LISTED_HARMONICS), series_of(computed, usize::MAX));
    let mut found = measured.series();
    let last_harmonic = found.harmonics.len().min(CORRELATED_HARMONICS);
    let (azimuth_deg, values) = measured.points();
    let is_sampled = matches!(measured, MeasuredData::Samples { .. });
    let distance = is_sampled.then(|| {
        let apart = azimuth_deg.iter().zip(&values);
        let apart = apart.map(|(psi, value)| whole.value(psi.to_radians()) - value);
        mean_square(&apart.collect::<Vec<_>>()).sqrt()
    });
    // ten harmonics alone leave nothing above
    let has_band = found.harmonics.len() >= LISTED_HARMONICS + usize::from(!is_sampled);
    let measured_band =
        if has_band { band_peaks(&azimuth_deg, &values, &found) } else { [None, None] };
    found.harmonics.truncate(LISTED_HARMONICS);
    let psi_deg: Vec<f64> =
        uniform_azimuths_rad(computed.len()).iter().map(|psi| psi.to_degrees()).collect();
    CurveComparison {
        quantity,
        station_r,
        source: source.clone(),
        from_1: agreement(&own, &found, 1..=last_harmonic),
        from_2: agreement(&own, &found, 2..=last_harmonic),
        last_harmonic,
        distance,
        measured_band,
        computed_band: band_peaks(&psi_deg, computed, &own),
        measured: found,
        computed: own,
    }
}

/// A measured centre of a tip vortex.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VortexCentre {
    /// Azimuth of the rotor, deg.
    pub azimuth_deg: f64,
    /// Place in hub axes (aft, starboard, up), R.
    pub place_r: [f64; 3],
}

/// Measured centres of tip vortices beside the tip vortices of the wake.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct VortexComparison {
    /// Vertical rms distance of the centres that have a computed vortex near them, percent of R.
    pub vertical_percent_r: f64,
    /// Number of such centres.
    pub compared: usize,
    /// Number of measured centres.
    pub measured: usize,
}

/// A measured vortex farther along the flight path than this from any computed one, R, is that of another turn.
const SAME_VORTEX_R: f64 = 0.12;

/// Vertical rms distance of measured centres from where the tip vortices of the wake cross the same vertical plane along the
/// flight.
pub fn compare_vortices(centres: &[VortexCentre], wake: &FreeWake) -> VortexComparison {
    let settings = wake.settings();
    let step_deg = settings.step_rad().to_degrees();
    // of all blades, the first at the azimuth of the grid that is nearest
    compare_crossings(centres, |azimuth_deg, y| {
        let off = |i: usize| wrap_degrees(i as f64 * step_deg - azimuth_deg).abs();
        let seen = (0..settings.azimuths).min_by(|a, b| off(*a).total_cmp(&off(*b)));
        let crossings = seen.iter().flat_map(|i| wake.tip_vortex_crossings(*i, y));
        crossings.map(|crossing| crossing.point).collect()
    })
}

/// The same for the places of computed vortices at an azimuth, deg, in a plane, R.
fn compare_crossings(
    centres: &[VortexCentre],
    crossings: impl Fn(f64, f64) -> Vec<[f64; 3]>,
) -> VortexComparison {
    let apart_r: Vec<f64> = centres
        .iter()
        .filter_map(|&VortexCentre { azimuth_deg, place_r: [x, y, z] }| {
            let along = |point: &[f64; 3]| (point[0] - x).abs();
            let found = crossings(azimuth_deg, y);
            let nearest = found.iter().min_by(|a, b| along(a).total_cmp(&along(b)))?;
            (along(nearest) <= SAME_VORTEX_R).then(|| nearest[2] - z)
        })
        .collect();
    VortexComparison {
        vertical_percent_r: 100.0 * mean_square(&apart_r).sqrt(),
        compared: apart_r.len(),
        measured: centres.len(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn series(mean: f64, harmonics: &[(usize, f64, f64)]) -> HarmonicSeries {
        let mut series = HarmonicSeries { mean, harmonics: vec![] };
        for &(n, amplitude, phase_deg) in harmonics {
            series.set_harmonic(
                n,
                Harmonic::from_amplitude_phase(amplitude, f64::to_radians(phase_deg)),
            );
        }
        series
    }

    fn sampled(of: &HarmonicSeries, azimuth_deg: Vec<f64>) -> MeasuredCurve {
        let values = azimuth_deg.iter().map(|psi| of.value(psi.to_radians())).collect();
        MeasuredCurve {
            quantity: Quantity::NormalM2,
            station_r: Some(0.87),
            source: "a.csv".into(),
            measured: MeasuredData::Samples { azimuth_deg, values },
        }
    }

    fn every_degree(of: &HarmonicSeries) -> Vec<f64> {
        uniform_azimuths_rad(CURVE_AZIMUTHS).iter().map(|psi| of.value(*psi)).collect()
    }

    /// The mean of products over azimuth, which the harmonics must reproduce.
    #[test]
    fn agreement_is_that_of_the_curves_against_azimuth() {
        let a = series(3.0, &[(1, 2.0, 20.0), (3, 1.0, -70.0), (6, 0.5, 10.0), (8, 9.0, 0.0)]);
        let b = series(-1.0, &[(1, 1.5, 35.0), (2, 0.7, 5.0), (6, 0.6, -20.0)]);
        let cut = |s: &HarmonicSeries, first: usize| {
            let mut s = s.clone();
            s.mean = 0.0;
            s.harmonics.truncate(6);
            (1..first).for_each(|n| s.set_harmonic(n, Harmonic::default()));
            every_degree(&s)
        };
        for first in [1, 2] {
            let (x, y) = (cut(&a, first), cut(&b, first));
            let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
            let apart: Vec<f64> = x.iter().zip(&y).map(|(x, y)| x - y).collect();
            let found = agreement(&a, &b, first..=6);
            let correlation = dot(&x, &y) / (dot(&x, &x) * dot(&y, &y)).sqrt();
            assert!((found.correlation - correlation).abs() < 1e-12, "{first}");
            assert!((found.rms - mean_square(&apart).sqrt()).abs() < 1e-12, "{first}");
            assert!(correlation < 0.98, "the curves differ");
        }
    }

    #[test]
    fn uneven_samples_give_their_harmonics_and_no_more_than_they_resolve() {
        let truth = series(0.4, &[(1, 2.0, 20.0), (4, 1.0, -70.0), (6, 0.3, 100.0)]);
        // steps of 15 deg with two missing, as the tip of a model rotor was measured
        let psi: Vec<f64> = (0..24).map(|i| 4.0 + 15.01 * f64::from(i)).collect();
        let psi = [&psi[1..12], &psi[13..]].concat();
        assert_eq!((psi.len(), resolved_harmonics(&psi)), (22, 6));
        let found = sampled(&truth, psi).measured.series();
        for n in 1..=6 {
            let off = found.harmonic(n).cosine - truth.harmonic(n).cosine;
            assert!(off.abs() < 1e-12, "{n}: {off:e}");
        }
        assert!((found.mean - 0.4).abs() < 1e-12);
        let many: Vec<f64> = (0..2048).map(|i| 360.0 * f64::from(i) / 2048.0).collect();
        assert_eq!(resolved_harmonics(&many), LISTED_HARMONICS);
        // a gap of 100 deg hides 4/rev, however many samples stand elsewhere
        let gap: Vec<f64> = many.iter().copied().filter(|psi| *psi > 100.0).collect();
        assert_eq!(resolved_harmonics(&gap), 3);
        assert_eq!(resolved_harmonics(&[]), 0);
    }

    #[test]
    fn the_band_above_ten_per_rev_is_found_on_its_side() {
        let low = series(1.0, &[(1, 2.0, 20.0), (10, 1.0, -70.0)]);
        let pulse = |psi_deg: f64| 0.1 * (-((psi_deg - 60.0) / 1.5).powi(2)).exp();
        let psi: Vec<f64> = (0..720).map(|i| 0.5 * f64::from(i)).collect();
        let mut measured = sampled(&low, psi);
        if let MeasuredData::Samples { azimuth_deg, values } = &mut measured.measured {
            azimuth_deg.iter().zip(values).for_each(|(psi, value)| *value += pulse(*psi));
        }
        let own = every_degree(&low);
        let found = compare_curves(&measured, &own);
        let [advancing, retreating] = found.measured_band.map(Option::unwrap);
        assert!((advancing.azimuth_deg - 60.0).abs() < 1e-9, "{advancing:?}");
        // its part below 11/rev is gone
        assert!((0.08..0.12).contains(&advancing.peak_to_peak), "{advancing:?}");
        assert!(retreating.peak_to_peak < 0.02, "{retreating:?}");
        assert!(found.computed_band.map(Option::unwrap)[0].peak_to_peak < 1e-12);
        // what holds ten harmonics holds no band
        let of = MeasuredData::Harmonics(low.clone());
        let alone = compare_curves(&MeasuredCurve { measured: of, ..measured }, &own);
        assert_eq!((alone.measured_band, alone.distance), ([None, None], None));
        assert!((alone.from_1.correlation - 1.0).abs() < 1e-12 && alone.from_1.rms < 1e-12);
    }

    #[test]
    fn the_distance_counts_the_mean() {
        let truth = series(0.5, &[(1, 2.0, 20.0)]);
        let measured = sampled(&truth, (0..72).map(|i| 5.0 * f64::from(i)).collect());
        let own: Vec<f64> = every_degree(&truth).iter().map(|value| value + 0.25).collect();
        let found = compare_curves(&measured, &own);
        assert!((found.distance.unwrap() - 0.25).abs() < 1e-12, "{:?}", found.distance);
        assert!(found.from_1.rms < 1e-12);
    }

    #[test]
    fn vortices_are_compared_in_the_plane_of_their_centre() {
        let at = |azimuth_deg: f64, y: f64| {
            assert_eq!((azimuth_deg, y), (20.0, 0.3));
            vec![[5.0, y, 0.4], [0.5, y, 0.1]]
        };
        let centre = |x: f64, z: f64| VortexCentre { azimuth_deg: 20.0, place_r: [x, 0.3, z] };
        let found = compare_crossings(&[centre(0.52, 0.13), centre(0.7, 0.5)], at);
        assert_eq!((found.compared, found.measured), (1, 2));
        assert!((found.vertical_percent_r - 3.0).abs() < 1e-9, "{found:?}");
    }
}

//! What was measured of an oscillating section.

use crate::error::RotorGapError;
use flap_aero::Motion;
use measured_data::{PointColumn, PointData, Scatter};
use model_gap::points::{Grid, Point};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_study::MeasuredData;

/// Loads: normal force, moment about the quarter chord, hinge moment.
pub const LOADS: [&str; 3] = ["cn", "cm", "ch"];
/// Harmonics that are taken of a history.
const HARMONICS: usize = 3;
const CONDITIONS: [&str; 5] =
    ["mach", "reduced_frequency", "alpha_mean_deg", "amplitude_deg", "frequency_hz"];
const HISTORY: [&str; 4] = ["time_s", "phase_deg", "alpha_deg", "flap_deg"];

/// A motion of a section at a Mach number.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionMotion {
    /// Name in every report.
    pub id: String,
    /// Number of the group it is held out with.
    pub group: usize,
    /// Whether what is looked for does not act there.
    pub is_reference: bool,
    /// What moves.
    pub motion: Motion,
    /// Mach number.
    pub mach: f64,
    /// `k = omega c / (2 U)`.
    pub reduced_frequency: f64,
    /// Mean incidence, rad.
    pub mean_rad: f64,
    /// Amplitude, rad; none of a small one, whose loads are read per radian.
    pub amplitude_rad: Option<f64>,
    /// Frequency, Hz; none where it was not stated.
    pub frequency_hz: Option<f64>,
}

impl SectionMotion {
    /// Largest incidence, deg; 0 of a motion without amplitude.
    pub(super) fn highest_deg(&self) -> f64 {
        let swing = if self.motion == Motion::Flap { Some(0.0) } else { self.amplitude_rad };
        self.amplitude_rad.and(swing).map_or(0.0, |own| (self.mean_rad.abs() + own).to_degrees())
    }
}

/// A channel: a harmonic of a load, over the amplitude of the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct LoadPart {
    /// Position in [`LOADS`].
    pub load: usize,
    /// Harmonic of the motion, 0 of the mean, which is not over the amplitude.
    pub harmonic: usize,
    /// Whether it is out of phase: positive ahead of the motion.
    pub is_imaginary: bool,
}

/// Loads of a section by motion and channel.
#[derive(Debug, Clone, PartialEq)]
pub struct SectionLoads {
    /// The motions.
    pub motions: Vec<SectionMotion>,
    /// Names of the channels.
    pub names: Vec<String>,
    /// What they are.
    pub parts: Vec<LoadPart>,
    /// Readings by motion and channel, over the amplitude.
    values: Grid,
    /// Which of them were read.
    is_read: Vec<Vec<bool>>,
    /// How sure the readings of each channel are.
    scatter: Vec<Scatter>,
}

fn refused(name: &str, reason: impl Into<String>) -> RotorGapError {
    RotorGapError::Column { name: name.to_owned(), reason: reason.into() }
}

/// The motion that a word stands for.
fn motion_of(word: &str) -> Option<Motion> {
    match word.trim().to_lowercase().as_str() {
        "flap" => Some(Motion::Flap),
        "pitch" => Some(Motion::Pitch),
        "plunge" => Some(Motion::Plunge),
        _ => None,
    }
}

/// What a channel is: `cn_re`, `cm_im`, of a loop also `cn_n0`, `ch_n2_re`.
fn part_of(name: &str) -> Option<LoadPart> {
    let (load, rest) = name.split_once('_')?;
    let load = LOADS.iter().position(|own| *own == load)?;
    let (harmonic, rest) = match rest.strip_prefix('n') {
        None => (1, rest),
        Some("0") => return Some(LoadPart { load, harmonic: 0, is_imaginary: false }),
        Some(rest) => {
            let (number, rest) = rest.split_once('_')?;
            (number.parse().ok().filter(|n| (1..=12).contains(n))?, rest)
        }
    };
    let is_imaginary = match rest {
        "re" => false,
        "im" => true,
        _ => return None,
    };
    Some(LoadPart { load, harmonic, is_imaginary })
}

impl SectionLoads {
    /// Of a table of harmonics, or of histories where it has `time_s` or `phase_deg`.
    ///
    /// # Errors
    /// [`RotorGapError::Column`]: a column that is missing or not known, a blank condition, a word that is no motion, a history
    /// that holds no cycle.
    pub fn of(data: &PointData) -> Result<Self, RotorGapError> {
        let has = |name: &str| data.columns.iter().any(|own| own.name == name);
        if has("time_s") || has("phase_deg") {
            return Self::of_histories(data);
        }
        let words = data.table.text_column("motion");
        let words =
            words.ok_or_else(|| refused("motion", "it is missing: flap, pitch or plunge"))?;
        let mut own = Self::empty();
        for column in &data.columns {
            if CONDITIONS.contains(&column.name.as_str()) {
                continue;
            }
            let part = part_of(&column.name).ok_or_else(|| {
                let known =
                    "cn_re, cn_im, cm_re, cm_im, ch_re, ch_im, of loops also cn_n0, cn_n2_re";
                refused(
                    &column.name,
                    format!("expected {} or one of {known}", CONDITIONS.join(", ")),
                )
            })?;
            own.names.push(column.name.clone());
            own.parts.push(part);
            own.scatter.push(column.scatter.clone());
        }
        let readings: Vec<&PointColumn> =
            own.names.iter().filter_map(|name| column_of(data, name)).collect();
        for (row, word) in words.iter().enumerate() {
            let motion = motion_of(word).ok_or_else(|| {
                refused("motion", format!("row {}: `{word}` is not flap, pitch or plunge", row + 1))
            })?;
            let (id, group) = (data.ids[row].clone(), data.groups[row]);
            own.motions.push(SectionMotion { id, group, motion, ..conditions(data, row)? });
            own.values.push(readings.iter().map(|c| c.values[row].unwrap_or_default()).collect());
            own.is_read.push(readings.iter().map(|c| c.values[row].is_some()).collect());
        }
        own.checked()
    }

    fn empty() -> Self {
        let (motions, names, parts) = (Vec::new(), Vec::new(), Vec::new());
        Self { motions, names, parts, values: Vec::new(), is_read: Vec::new(), scatter: Vec::new() }
    }

    fn checked(self) -> Result<Self, RotorGapError> {
        if self.names.is_empty() {
            return Err(refused("cn_re", "no load was read: give cn, cm or ch"));
        }
        Ok(self)
    }

    /// Of histories, one for each word of `loop`: their harmonics over the amplitude, their scatter from what these leave.
    fn of_histories(data: &PointData) -> Result<Self, RotorGapError> {
        let known = |own: &&PointColumn| {
            let name = own.name.as_str();
            !CONDITIONS.contains(&name) && !HISTORY.contains(&name) && !LOADS.contains(&name)
        };
        if let Some(own) = data.columns.iter().find(known) {
            let known = "time_s or phase_deg, alpha_deg, flap_deg, cn, cm, ch and conditions";
            return Err(refused(&own.name, format!("a history has {known}")));
        }
        let loops = data.table.text_column("loop");
        let loops = loops.unwrap_or_else(|| vec!["loop".to_owned(); data.ids.len()]);
        let mut ids: Vec<String> = Vec::new();
        for own in &loops {
            if !ids.contains(own) {
                ids.push(own.clone());
            }
        }
        let read: Vec<usize> =
            (0..LOADS.len()).filter(|&k| column_of(data, LOADS[k]).is_some()).collect();
        let mut own = Self::empty();
        for &load in &read {
            for harmonic in 0..=HARMONICS {
                let parts: &[bool] = if harmonic == 0 { &[false] } else { &[false, true] };
                for &is_imaginary in parts {
                    own.parts.push(LoadPart { load, harmonic, is_imaginary });
                    own.names.push(name_of(load, harmonic, is_imaginary));
                }
            }
        }
        let mut deviations: Grid = Vec::new();
        for (group, id) in ids.iter().enumerate() {
            let rows: Vec<usize> = (0..loops.len()).filter(|&row| loops[row] == *id).collect();
            let history = History::of(data, id, &rows)?;
            own.motions.push(SectionMotion { id: id.clone(), group, ..history.motion.clone() });
            let (mut values, mut sigma) = (Vec::new(), Vec::new());
            for &load in &read {
                let (series, rms) = history.harmonics(data, LOADS[load], &rows)?;
                let amplitude = history.motion.amplitude_rad.unwrap_or(1.0);
                values.push(series.mean);
                sigma.push(rms / (rows.len() as f64).sqrt());
                for n in 1..=HARMONICS {
                    let one = series.harmonic(n);
                    values.extend([one.sine / amplitude, one.cosine / amplitude]);
                    let scatter = rms * (2.0 / rows.len() as f64).sqrt() / amplitude;
                    sigma.extend([scatter, scatter]);
                }
            }
            own.is_read.push(vec![true; values.len()]);
            own.values.push(values);
            deviations.push(sigma);
        }
        let stated = |c: usize| Scatter::Stated(deviations.iter().map(|row| row[c]).collect());
        own.scatter = (0..own.names.len()).map(stated).collect();
        own.checked()
    }

    /// Whether the scatter of every channel is known.
    pub(super) fn knows_deviations(&self) -> bool {
        self.scatter.iter().all(|own| *own != Scatter::Unknown)
    }

    /// The points of the engine: one for each motion.
    pub(super) fn points(&self, predicted: &Grid) -> Vec<Point> {
        let column = |c: usize| {
            let values: Vec<Option<f64>> = self
                .values
                .iter()
                .zip(&self.is_read)
                .map(|(row, is)| is[c].then_some(row[c]))
                .collect();
            let simulated: Vec<f64> = predicted.iter().map(|row| row[c]).collect();
            let deviations = self.scatter[c].deviations(&values, &simulated);
            (values, deviations)
        };
        let columns: Vec<(Vec<Option<f64>>, Vec<f64>)> =
            (0..self.names.len()).map(column).collect();
        let of = |(p, own): (usize, &SectionMotion)| Point {
            id: own.id.clone(),
            group: own.group,
            is_reference: own.is_reference,
            conditions: vec![own.mach, own.reduced_frequency],
            measured: columns.iter().map(|column| column.0[p]).collect(),
            deviation: columns.iter().map(|column| column.1[p]).collect(),
        };
        self.motions.iter().enumerate().map(of).collect()
    }
}

fn name_of(load: usize, harmonic: usize, is_imaginary: bool) -> String {
    match harmonic {
        0 => format!("{}_n0", LOADS[load]),
        n => format!("{}_n{n}_{}", LOADS[load], if is_imaginary { "im" } else { "re" }),
    }
}

fn column_of<'a>(data: &'a PointData, name: &str) -> Option<&'a PointColumn> {
    data.columns.iter().find(|own| own.name == name)
}

/// The conditions of a row; its motion is yet to be said.
fn conditions(data: &PointData, row: usize) -> Result<SectionMotion, RotorGapError> {
    let optional = |name: &str| column_of(data, name).and_then(|own| own.values[row]);
    let needed = |name: &str| {
        optional(name).ok_or_else(|| refused(name, format!("row {}: expected a number", row + 1)))
    };
    Ok(SectionMotion {
        id: String::new(),
        group: 0,
        is_reference: data.references[row],
        motion: Motion::Pitch,
        mach: needed("mach")?,
        reduced_frequency: needed("reduced_frequency")?,
        mean_rad: optional("alpha_mean_deg").unwrap_or_default().to_radians(),
        amplitude_rad: optional("amplitude_deg").map(f64::to_radians),
        frequency_hz: optional("frequency_hz"),
    })
}

/// One history with the phase of its motion.
struct History {
    motion: SectionMotion,
    phase_deg: Vec<f64>,
}

impl History {
    /// Finds what moves, how far, and where in its cycle every row is: the motion is `mean + amplitude sin(phase)`.
    fn of(data: &PointData, id: &str, rows: &[usize]) -> Result<Self, RotorGapError> {
        let first = rows.first().copied().unwrap_or_default();
        let mut motion = conditions(data, first)?;
        let taken = |name: &str| taken(data, name, rows);
        let (alpha, flap) = (taken("alpha_deg")?, taken("flap_deg")?);
        let span = |own: &Option<Vec<f64>>| {
            let own = own.as_deref().unwrap_or_default();
            let high = own.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            (high - own.iter().copied().fold(f64::INFINITY, f64::min)).max(0.0)
        };
        let (moved, what) = if span(&flap) > span(&alpha) {
            (&flap, Motion::Flap)
        } else {
            (&alpha, Motion::Pitch)
        };
        let Some(moved) = moved.as_ref().filter(|_| span(&alpha).max(span(&flap)) > 0.0) else {
            return Err(refused(
                "alpha_deg",
                format!("loop {id}: neither incidence nor flap moves"),
            ));
        };
        motion.motion = what;
        let raw = match (taken("phase_deg")?, taken("time_s")?) {
            (Some(phase), _) => phase,
            (None, Some(time)) => {
                let hz = motion.frequency_hz.or_else(|| frequency(&time, moved));
                let hz = hz.ok_or_else(|| {
                    refused(
                        "time_s",
                        format!("loop {id}: less than two cycles; give a column frequency_hz"),
                    )
                })?;
                motion.frequency_hz = Some(hz);
                time.iter().map(|t| 360.0 * hz * t).collect()
            }
            (None, None) => return Err(refused("time_s", "it is missing")),
        };
        let series = fitted(&raw, moved);
        let Harmonic { cosine, sine } = series.harmonic(1);
        let (amplitude, ahead) = (cosine.hypot(sine), cosine.atan2(sine).to_degrees());
        motion.amplitude_rad = Some(amplitude.to_radians());
        let mean = match what {
            Motion::Flap => alpha.map_or(0.0, |own| own.iter().sum::<f64>() / own.len() as f64),
            _ => series.mean,
        };
        motion.mean_rad = mean.to_radians();
        Ok(Self { motion, phase_deg: raw.iter().map(|own| own + ahead).collect() })
    }

    /// Harmonics of a load over the phase of the motion, and the rms that they leave.
    fn harmonics(
        &self,
        data: &PointData,
        load: &str,
        rows: &[usize],
    ) -> Result<(HarmonicSeries, f64), RotorGapError> {
        let values = taken(data, load, rows)?.unwrap_or_default();
        let series = fitted(&self.phase_deg, &values);
        if series.harmonics.len() < HARMONICS {
            let reason = format!("too few samples of a cycle: {HARMONICS} harmonics are taken");
            return Err(refused(load, reason));
        }
        let left: Vec<f64> = values
            .iter()
            .zip(&self.phase_deg)
            .map(|(value, phase)| value - series.value(phase.to_radians()))
            .collect();
        Ok((series, rotor_base::mean_square(&left).sqrt()))
    }
}

/// The rows of a column; none where there is no such column.
fn taken(data: &PointData, name: &str, rows: &[usize]) -> Result<Option<Vec<f64>>, RotorGapError> {
    let Some(column) = column_of(data, name) else { return Ok(None) };
    let value = |&row: &usize| {
        column.values[row].ok_or_else(|| refused(name, format!("row {} is blank", row + 1)))
    };
    rows.iter().map(value).collect::<Result<_, _>>().map(Some)
}

fn fitted(phase_deg: &[f64], values: &[f64]) -> HarmonicSeries {
    let (azimuth_deg, values) = (phase_deg.to_vec(), values.to_vec());
    MeasuredData::Samples { azimuth_deg, values }.series()
}

/// Frequency of a motion from where it rises through its mean, Hz; none of less than two rises.
fn frequency(time_s: &[f64], moved: &[f64]) -> Option<f64> {
    let mean = moved.iter().sum::<f64>() / moved.len() as f64;
    let mut rises = Vec::new();
    for (t, v) in time_s.windows(2).zip(moved.windows(2)) {
        let (before, after) = (v[0] - mean, v[1] - mean);
        if before < 0.0 && after >= 0.0 {
            rises.push(t[0] + (t[1] - t[0]) * before / (before - after));
        }
    }
    let (first, last) = (rises.first()?, rises.last()?);
    (rises.len() > 1).then(|| (rises.len() - 1) as f64 / (last - first))
}

//! Whether records can be what they are said to be.

use crate::PreisachError;
use crate::check;
use crate::identify::records::flat_top::FlatTop;
use crate::identify::{BenchRecord, Channel, Drive, Finding, Settings, Waveform};

/// A command may span this much more than the declared range before its unit is doubted.
const TOO_LARGE: f64 = 50.0;
/// The largest command of all records must span this share of the declared range.
const TOO_SMALL: f64 = 0.005;
/// Share of the samples outside the range that is more than spikes.
const OFTEN: f64 = 0.1;
/// Samples in a row at an extreme that make a flat top.
const FLAT_RUN: usize = 4;
/// How far the command must move during a flat top of the output, as a share of its span.
const MOVES: f64 = 0.02;
/// Share of steady samples at the extreme that makes a command flat.
const FLAT_SHARE: f64 = 0.02;
/// Lead of the output that cannot be noise, deg of harmonic phase.
const LEAD_DEG: f64 = 1.0;
/// Share of the spread of the output that a falling line explains where the output falls with the command.
const FALLS: f64 = 0.5;
/// Width of a slow loop over the range of the output that no ceramic has.
const TOO_WIDE: f64 = 0.6;

/// Smallest and largest of the finite ones among some values.
fn extremes(values: &[f64]) -> [f64; 2] {
    check::extremes(values.iter().copied().filter(|v| v.is_finite()))
}

/// Refuses sets of records whose columns cannot have the unit or the meaning declared.
///
/// # Errors
/// [`PreisachError::UnitMismatch`], [`PreisachError::SwappedColumns`].
pub(crate) fn check_units(
    records: &[BenchRecord],
    settings: &Settings,
) -> Result<(), PreisachError> {
    let range = settings.range_volt;
    let declared = range.span_volt();
    let mismatch = |found_volt: f64, likely: &'static str| {
        Err(PreisachError::UnitMismatch { found_volt, declared_volt: declared, likely })
    };
    let mut widest = 0.0_f64;
    for record in records {
        let [low, high] = extremes(&record.voltage_volt);
        let found = high - low;
        widest = widest.max(found.max(0.0));
        let outside = |value: f64| range.excess_volt(value) > 0.1 * declared;
        if !(outside(low) || outside(high)) {
            continue;
        }
        if found > TOO_LARGE * declared {
            return mismatch(found, "millivolt");
        }
        // displacement, the other column of the file: inside the range and filling some of it?
        let um = |deg: f64| deg / settings.deg_per_um;
        let [y_low, y_high] = extremes(&record.output_deg).map(um);
        let fills = (y_high - y_low) > 0.05 * declared;
        let beyond = record.voltage_volt.iter().filter(|&&u| outside(u)).count();
        // a spike is no exchange of columns
        let often = beyond as f64 > OFTEN * record.voltage_volt.len() as f64;
        if often && fills && !outside(y_low) && !outside(y_high) {
            return Err(PreisachError::SwappedColumns {
                id: record.id.clone(),
                command_volt: found,
                output_um: y_high - y_low,
            });
        }
    }
    if widest > 0.0 && widest < TOO_SMALL * declared {
        return mismatch(widest, "kilovolt, or the signal before the amplifier");
    }
    Ok(())
}

/// The straight line through a record's judged samples.
pub(crate) struct Line {
    /// Its slope, deg/V.
    pub(crate) slope: f64,
    /// Share of the variance of the output that it explains.
    explained: f64,
}

impl Line {
    /// The line through a record.
    pub(crate) fn of(record: &BenchRecord) -> Self {
        let samples = record.judged_samples();
        let (u, y) = (&record.voltage_volt[samples.clone()], &record.output_deg[samples]);
        let mean = |v: &[f64]| v.iter().sum::<f64>() / v.len() as f64;
        let (u0, y0) = (mean(u), mean(y));
        let (mut uu, mut uy, mut yy) = (0.0, 0.0, 0.0);
        for (u, y) in u.iter().zip(y) {
            uu += (u - u0) * (u - u0);
            uy += (u - u0) * (y - y0);
            yy += (y - y0) * (y - y0);
        }
        Self { slope: uy / uu, explained: uy * uy / (uu * yy) }
    }
}

impl BenchRecord {
    /// What identification suspects of the record alone; `is_slow`: whether it may train a static map.
    pub fn suspicions(&self, is_slow: bool) -> Vec<Finding> {
        suspicions(self, &self.drive(), is_slow)
    }

    /// Slope of the straight line through the record where it is judged, deg/V; not finite at rest.
    pub fn slope_deg_per_volt(&self) -> f64 {
        Line::of(self).slope
    }
}

/// What is suspect about one record.
pub(crate) fn suspicions(record: &BenchRecord, drive: &Drive, is_slow: bool) -> Vec<Finding> {
    let id = || record.id.clone();
    if drive.waveform == Waveform::Constant {
        return vec![Finding::of_rest(record)];
    }
    let mut findings = Vec::new();
    let line = Line::of(record);
    if line.slope < 0.0 && line.explained > FALLS {
        findings.push(Finding::OutputFalls { id: id(), slope: line.slope });
    }
    let clipped = |channel: Channel, (level, share): (f64, f64)| {
        let share_percent = 100.0 * share;
        Finding::Clipped { id: id(), channel, level, share_percent }
    };
    let noisy = || FlatTop::of(record, drive, is_slow).map(|top| (top.level_deg, top.share));
    let output = flat_output(record).or_else(noisy);
    findings.extend(output.map(|top| clipped(Channel::Output, top)));
    if drive.is_periodic() {
        let command = flat_command(&record.voltage_volt[drive.steady.clone()]);
        findings.extend(command.map(|top| clipped(Channel::Command, top)));
        // an output behind an inverting sensor lags by more than 90 deg
        let lead = drive.lag_deg(record).map(|lag| -lag);
        if let Some(lead_deg) = lead.filter(|&lead| lead > LEAD_DEG && lead < 90.0) {
            findings.push(Finding::OutputLeads { id: id(), lead_deg });
        }
        let width = width(record, drive);
        if is_slow && width > TOO_WIDE {
            findings.push(Finding::LoopTooWide { id: id(), width_percent: 100.0 * width });
        }
    }
    findings
}

/// Level and share of the judged samples of an output that rests at its extreme, to the last digit, while the
/// command moves.
fn flat_output(record: &BenchRecord) -> Option<(f64, f64)> {
    let samples = record.judged_samples();
    let (y, u) = (&record.output_deg[samples.clone()], &record.voltage_volt[samples]);
    let [u_low, u_high] = extremes(u);
    let [low, high] = extremes(y);
    let same = 1e-9 * (high - low);
    [high, low].into_iter().find_map(|level| {
        let (mut flat, mut clipped, mut i) = (0, false, 0);
        while i < y.len() {
            let run = y[i..].iter().take_while(|v| (*v - level).abs() <= same).count();
            if run >= FLAT_RUN {
                flat += run;
                let [a, b] = extremes(&u[i..i + run]);
                clipped |= b - a > MOVES * (u_high - u_low);
            }
            i += run.max(1);
        }
        clipped.then(|| (level, flat as f64 / y.len() as f64))
    })
}

/// Level and share of samples of a periodic command that rests at an extreme.
fn flat_command(u: &[f64]) -> Option<(f64, f64)> {
    let [low, high] = extremes(u);
    let same = 1e-9 * (high - low);
    // a square wave rests at both ends and is no clipped sine
    let share = |level: f64| {
        u.iter().filter(|v| (*v - level).abs() <= same).count() as f64 / u.len() as f64
    };
    let square = share(low) + share(high) > 0.8;
    [high, low]
        .into_iter()
        .map(|level| (level, share(level)))
        .find(|&(_, share)| !square && share > FLAT_SHARE && share * u.len() as f64 >= 4.0)
}

/// Difference of the output between the falling and the rising branch at the middle of the command,
/// over the range of the output, in the steady cycles.
fn width(record: &BenchRecord, drive: &Drive) -> f64 {
    let (u, y) = (&record.voltage_volt, &record.output_deg);
    let [low, high] = extremes(&y[drive.steady.clone()]);
    let [mut up, mut down] = [(0.0, 0.0); 2];
    for i in drive.steady.start + 1..drive.steady.end {
        let (a, b) = (u[i - 1] - drive.middle_volt, u[i] - drive.middle_volt);
        if (a < 0.0) != (b < 0.0) {
            let value = y[i - 1] + a / (a - b) * (y[i] - y[i - 1]);
            let side = if b > a { &mut up } else { &mut down };
            side.0 += value;
            side.1 += 1.0;
        }
    }
    if up.1 == 0.0 || down.1 == 0.0 {
        return 0.0;
    }
    (down.0 / down.1 - up.0 / up.1).abs() / (high - low)
}

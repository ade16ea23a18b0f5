//! Which record trains what, and what the set of records cannot tell.

use crate::check::extremes;
use crate::identify::fit::preisach::major_loop_mean;
use crate::identify::fit::training::Training;
use crate::identify::fit::{program, static_fit};
use crate::identify::records::findings::{Finding, Identifiability};
use crate::identify::records::prepared::Prepared;
use crate::identify::records::{plausibility, spikes};
use crate::identify::{BenchRecord, Drive, FlapZero, RecordUse, Settings, Waveform};
use crate::{ActuatorModel, PreisachError, PreisachGrid};
use rayon::prelude::*;
use std::borrow::Cow;

/// Frequencies that differ by less than this share are one.
const SAME_HZ: f64 = 0.05;
/// Amplitudes that differ by less than this share are one.
const SAME_AMPLITUDE: f64 = 0.05;

/// Checked records with their commands and uses.
pub(crate) struct Bench<'a> {
    /// Spikes left out, the offset taken off.
    records: Vec<Cow<'a, BenchRecord>>,
    /// Offset of the outputs that was taken off all records, deg.
    offset_deg: f64,
    drives: Vec<Drive>,
    uses: Vec<RecordUse>,
    /// Whether a record trains the static map.
    slow: Vec<bool>,
    findings: Vec<Finding>,
}

impl<'a> Bench<'a> {
    /// Checks records and settings, and gives every record its part.
    pub(crate) fn new(
        records: &'a [BenchRecord],
        settings: &Settings,
    ) -> Result<Self, PreisachError> {
        settings.check()?;
        plausibility::check_units(records, settings)?;
        for record in records {
            record.check(settings.range_volt)?;
        }
        let mut findings = Vec::new();
        let mended: Vec<Option<_>> = records.par_iter().map(spikes::mended).collect();
        let mut left_out = Vec::new();
        let kept = records.iter().zip(mended).map(|(record, mended)| match mended {
            Some((mended, found)) => {
                left_out.extend(found);
                Cow::Owned(mended)
            }
            None => Cow::Borrowed(record),
        });
        let given = records;
        let mut records: Vec<Cow<BenchRecord>> = kept.collect();
        let drives: Vec<Drive> = records.iter().map(|record| record.drive()).collect();
        let mut uses = settings.split.uses(given, &drives);
        let moves = |i: usize| drives[i].waveform != Waveform::Constant;
        let hz = |i: usize| drives[i].strongest_hz();
        let lowest = |places: &mut dyn Iterator<Item = usize>| extremes(places.map(hz))[0];
        let all = 0..records.len();
        if !all.clone().any(|i| uses[i] == RecordUse::Train && moves(i)) {
            let free = |i: &usize| records[*i].record_use.is_none() && moves(*i);
            let slowest = lowest(&mut all.clone().filter(free));
            let near = |i: &usize| hz(*i) <= slowest * (1.0 + SAME_HZ);
            let taken: Vec<usize> = all.clone().filter(free).filter(near).collect();
            if taken.is_empty() {
                return Err(PreisachError::NoTrainingRecord {
                    part: "the static density mu0",
                    remedy: "record a slow major loop and reversal curves, and mark them for training",
                });
            }
            for &i in &taken {
                uses[i] = RecordUse::Train;
            }
            findings.push(Finding::TrainedByDefault { records: taken.len() });
        }
        let trains = |i: &usize| uses[*i] == RecordUse::Train && moves(*i);
        let quasi_static = |i: usize| settings.split.is_quasi_static(&drives[i]);
        let mut slow: Vec<bool> = all.clone().map(quasi_static).collect();
        if !all.clone().filter(trains).any(quasi_static) {
            let lowest_hz = lowest(&mut all.clone().filter(trains));
            for i in all.clone().filter(trains) {
                slow[i] = hz(i) <= lowest_hz * (1.0 + SAME_HZ);
            }
            let limit_hz = settings.split.quasi_static_hz;
            findings.push(Finding::NoSlowRecords { lowest_hz, limit_hz });
        }
        findings.extend(left_out);
        for i in all {
            findings.extend(plausibility::suspicions(&records[i], &drives[i], quasi_static(i)));
        }
        let trained = records.iter().zip(&uses).filter(|(_, side)| **side == RecordUse::Train);
        let trained = trained.flat_map(|(r, _)| &r.output_deg[r.trained_samples()]);
        let offset_deg = program::offset(extremes(trained.copied()));
        // far from zero, fits would lose the digits of the motion
        if offset_deg.abs() > 0.0 {
            for output in records.iter_mut().flat_map(|r| &mut r.to_mut().output_deg) {
                *output -= offset_deg;
            }
        }
        Ok(Self { records, offset_deg, drives, uses, slow, findings })
    }

    /// Output of the records as given that is zero flap angle, deg.
    pub(crate) fn zero_deg(&self, training: &Training) -> f64 {
        self.offset_deg + self.fitted_zero_deg(training)
    }

    /// The same of the records as fitted.
    fn fitted_zero_deg(&self, training: &Training) -> f64 {
        match training.settings.zero {
            FlapZero::AsRecorded => -self.offset_deg,
            FlapZero::MajorLoopMean => major_loop_mean(&training.slow),
        }
    }

    /// A model of the records as fitted with its flap angle at zero where it is to be, its displacement
    /// that of the records as given.
    pub(crate) fn rigged(&self, model: ActuatorModel, training: &Training) -> ActuatorModel {
        let mut model = model.shifted(-self.fitted_zero_deg(training));
        model.calibration.zero_um += self.offset_deg / model.calibration.deg_per_um;
        model
    }

    /// The use of every record.
    pub(crate) fn uses(&self) -> &[RecordUse] {
        &self.uses
    }

    /// The records made ready for the fits.
    pub(crate) fn prepared<'s>(
        &'s self,
        grid: &PreisachGrid,
        settings: &Settings,
    ) -> Result<Vec<Prepared<'s>>, PreisachError> {
        (0..self.records.len())
            .map(|i| {
                let drive = self.drives[i].clone();
                Prepared::new(&self.records[i], drive, self.uses[i], self.slow[i], grid, settings)
            })
            .collect()
    }

    /// What the records can tell and what they cannot.
    pub(crate) fn summary(&self, training: &Training) -> Identifiability {
        let Training { slow, fast, settings, .. } = training;
        let periodic = slow.iter().chain(fast).filter(|r| r.drive.is_periodic());
        let mut hz: Vec<f64> = periodic.map(|r| r.drive.strongest_hz()).collect();
        hz.sort_by(f64::total_cmp);
        hz.dedup_by(|b, a| *b <= *a * (1.0 + SAME_HZ));
        let mut findings = self.findings.clone();
        if fast.is_empty() {
            findings.push(match hz.as_slice() {
                [hz] => Finding::OneFrequency { hz: *hz },
                _ => Finding::NoRateRecords { slow_hz: settings.split.quasi_static_hz },
            });
        }
        let [determined, unknowns] = static_fit::determined(training);
        // unique if the records determine half of its numbers
        if 2 * determined < unknowns {
            findings.push(Finding::DensityNotUnique { determined, unknowns });
        }
        let amplitudes = || fast.iter().map(|r| r.drive.amplitude_volt);
        let largest = amplitudes().fold(0.0, f64::max);
        if !fast.is_empty() && amplitudes().all(|a| a >= largest * (1.0 - SAME_AMPLITUDE)) {
            findings.push(Finding::OneAmplitude { amplitude_volt: largest });
        }
        Identifiability { findings, density_determined: [determined, unknowns], trained_hz: hz }
    }
}

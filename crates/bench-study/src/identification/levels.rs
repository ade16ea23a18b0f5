//! Levels of runs that differ although the model takes all of them to begin at rest.

use super::BenchIdentification;
use crate::BenchError;
use measured_data::limits;
use preisach_dyn::identify::{Finding, RecordUse};
use rotor_base::{mean, mean_square, variance};

/// Least share of what a model leaves that levels are, its least size in standard deviations of the noise, and the least
/// difference of levels over the largest range of an output, percent.
const LEAST_SHARE: f64 = 0.25;
const LEAST_TIMES: f64 = 5.0;
const LEAST_PERCENT: f64 = 1.0;

impl BenchIdentification {
    /// What differs in level between the training runs, if that is a good part of what the model leaves of them.
    ///
    /// Steady cycles after a larger swing, or after 0 V, stand elsewhere than the same cycles from rest at their first command.
    ///
    /// # Errors
    /// As [`Self::simulated`].
    pub(super) fn levels_differ(&self) -> Result<Option<Finding>, BenchError> {
        let zero_deg = self.identification.zero_deg;
        let reports = &self.identification.records;
        let simulated = self.simulated()?;
        let (mut means, mut left, mut noise, mut range_deg) = (Vec::new(), 0.0, 0.0, 0.0_f64);
        for ((record, report), ours) in self.records.iter().zip(reports).zip(&simulated) {
            let known = report.noise.filter(|_| report.record_use == RecordUse::Train);
            let Some(own) = known else { continue };
            let judged = record.judged_samples();
            let measured = &record.output_deg[judged.clone()];
            let pairs = ours[judged].iter().zip(measured);
            let errors: Vec<f64> = pairs.map(|(a, b)| a + zero_deg - b).collect();
            means.push(mean(&errors));
            left += mean_square(&errors);
            noise += own.std_deg.powi(2);
            let (low, high) = limits(measured);
            range_deg = range_deg.max(high - low);
        }
        if means.len() < 2 {
            return Ok(None);
        }
        let share = means.len() as f64 * variance(&means) / left;
        let times = (left / noise).sqrt();
        let (low, high) = limits(&means);
        let level_percent = 100.0 * (high - low) / range_deg;
        let is_found =
            share >= LEAST_SHARE && times >= LEAST_TIMES && level_percent >= LEAST_PERCENT;
        Ok(is_found.then_some(Finding::LevelsDiffer { noise_times: times, level_percent }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Comparing, identify_bench};
    use super::*;
    use crate::test_bench::PlaysBench;
    use measured_data::BenchData;
    use preisach_dyn::identify::{Family, Settings};

    /// From rest at their middle, or cycles after a rise from 0 V.
    fn bench(after_zero: bool) -> BenchData {
        PlaysBench {
            runs: &[50.0, 25.0, 12.0].map(|volt| (volt, RecordUse::Train)),
            half_widths_volt: &[5.0, 15.0, 30.0, 45.0],
            after_zero,
            noise_um: 0.05,
        }
        .data()
    }

    #[test]
    fn runs_that_began_from_other_histories_are_told() {
        let found = |after_zero: bool| {
            let families = &[Family::BoucWen, Family::PrandtlPlays, Family::StaticPreisach];
            let only = Some(Comparing { families, done: &|| () });
            let mut found = identify_bench(&bench(after_zero), &Settings::default(), only).unwrap();
            found.pick(None).unwrap();
            found
        };
        assert_eq!(found(false).levels_differ().unwrap(), None);
        let found = found(true);
        let Some(Finding::LevelsDiffer { noise_times, level_percent }) =
            found.levels_differ().unwrap()
        else {
            panic!("nothing is said")
        };
        assert!(noise_times > 10.0 && level_percent > 1.0, "{noise_times} {level_percent}");
        let said = |f: &super::super::FindingLine| f.message.contains("another history");
        assert!(found.summary(None).findings.iter().any(said));
    }
}

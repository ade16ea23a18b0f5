//! What a result keeps of the bench: fits, and measured and simulated loops.

use crate::SimError;
use crate::actuator::CaseActuators;
use crate::files::BenchData;
use crate::problem::Place;
use bench_study::BenchError;
use bench_study::identification::BenchIdentification;
use bench_study::stored::StoredFit;
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::RecordUse;
use serde::{Deserialize, Serialize};

/// Bench data and fits of the actuator of a case.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct BenchPart {
    /// Title of the data, which says whether they are synthetic.
    pub data_title: String,
    /// Fit of every bench run.
    pub fits: Vec<StoredFit>,
    /// Measured and simulated loops.
    pub loops: Vec<LoopRecord>,
}

impl BenchPart {
    /// Of the actuators of a case; none for actuators without data.
    ///
    /// # Errors
    /// [`BenchError::Actuator`] if a model cannot follow a bench record.
    pub fn of(actuators: &CaseActuators) -> Result<Option<Self>, SimError> {
        let loops = match &actuators.bench {
            Some((data, found)) => bench_loops(data, found)?,
            None => Vec::new(),
        };
        let part =
            Self { data_title: actuators.data_title.clone(), fits: actuators.fits.clone(), loops };
        Ok(Some(part).filter(|part| *part != Self::default()))
    }
}

/// One bench run: displacement as flap angle against voltage over the last steady cycle.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LoopRecord {
    /// The run.
    pub id: String,
    /// Frequency, Hz.
    pub frequency_hz: f64,
    /// Half peak to peak of the voltage, V.
    pub amplitude_volt: f64,
    /// Whether the model was fitted to it.
    pub trained: bool,
    /// RMS error over the standard deviation of the measured output, percent.
    pub nrmse_percent: f64,
    /// Voltage at every sample, V.
    pub voltage_volt: Vec<f64>,
    /// Measured flap angle, deg.
    pub measured_deg: Vec<f64>,
    /// Simulated flap angle, deg.
    pub simulated_deg: Vec<f64>,
    /// The static model's flap angle, deg.
    pub static_deg: Vec<f64>,
}

/// Most points of one loop; more are not seen.
const MOST_POINTS: usize = 500;

/// The last steady cycle of every periodic run: measured, dynamic and static model, ordered by
/// frequency, the larger amplitude first.
///
/// # Errors
/// [`BenchError::Actuator`] if a model cannot follow a record.
pub fn bench_loops(
    data: &BenchData,
    found: &BenchIdentification,
) -> Result<Vec<LoopRecord>, SimError> {
    let identification = &found.identification;
    let reports = found.records.iter().zip(&identification.records);
    let periodic = reports.filter(|(_, report)| report.drive.is_periodic());
    let charts = periodic.map(|(record, report)| {
        let drive = &report.drive;
        let simulate = |model: &ActuatorModel| {
            let simulated = model.simulate(&record.voltage_volt, record.time_step_s);
            simulated.map(|simulated| simulated.output_deg).map_err(|source| BenchError::Actuator {
                place: Place::file(&data.folder).field(&record.id),
                source,
            })
        };
        let dynamic = simulate(&found.model)?;
        let quasi_static = simulate(&identification.static_only)?;
        let samples = last_cycle(drive.steady.end, drive.base_hz, record.time_step_s);
        let pick = |values: &[f64], shift: f64| -> Vec<f64> {
            samples.iter().filter_map(|&i| values.get(i)).map(|v| v - shift).collect()
        };
        Ok(LoopRecord {
            id: record.id.clone(),
            frequency_hz: drive.strongest_hz(),
            amplitude_volt: drive.amplitude_volt,
            trained: report.record_use == RecordUse::Train,
            nrmse_percent: report.dynamic.nrmse_percent(),
            voltage_volt: pick(&record.voltage_volt, 0.0),
            // the models call the mean of the slow loop zero, the records do not
            measured_deg: pick(&record.output_deg, identification.zero_deg),
            simulated_deg: pick(&dynamic, 0.0),
            static_deg: pick(&quasi_static, 0.0),
        })
    });
    let mut charts = charts.collect::<Result<Vec<_>, SimError>>()?;
    charts.sort_by(|a, b| {
        let larger_first = b.amplitude_volt.total_cmp(&a.amplitude_volt);
        a.frequency_hz.total_cmp(&b.frequency_hz).then(larger_first)
    });
    Ok(charts)
}

/// Indices of the last cycle before `end`, thinned to [`MOST_POINTS`] and closed.
fn last_cycle(end: usize, base_hz: f64, time_step_s: f64) -> Vec<usize> {
    let samples = 1.0 / (base_hz * time_step_s);
    let first = (0..end).rev().take_while(|&i| ((end - i) as f64) <= samples + 1.0).last();
    let Some(first) = first else { return vec![] };
    let stride = (end - first).div_ceil(MOST_POINTS).max(1);
    (first..end).rev().step_by(stride).collect::<Vec<_>>().into_iter().rev().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_cycle_is_one_cycle_long() {
        let cycle = last_cycle(1000, 1.0, 0.01);
        assert_eq!((cycle[0], *cycle.last().unwrap()), (899, 999));
        let thin = last_cycle(10_000, 0.2, 0.001);
        assert!(thin.len() <= MOST_POINTS + 1, "{}", thin.len());
        assert_eq!(*thin.last().unwrap(), 9_999);
        assert!(thin[0] <= 5_010 && thin[0] >= 4_990);
        assert!(last_cycle(0, 1.0, 0.1).is_empty());
    }
}

//! Measured and simulated loops of a bench, ready to be drawn.

use super::LoopChart;
use crate::SimError;
use crate::files::BenchData;
use crate::identification::BenchIdentification;
use crate::problem::Place;
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::RecordUse;

/// Most points of one loop; more are not seen.
const MOST_POINTS: usize = 500;

/// The last steady cycle of every periodic run: measured, dynamic and static model, ordered by
/// frequency, the larger amplitude first.
///
/// # Errors
/// [`SimError::Actuator`] if a model cannot follow a record.
pub fn bench_loops(
    data: &BenchData,
    found: &BenchIdentification,
) -> Result<Vec<LoopChart>, SimError> {
    let identification = &found.identification;
    let mut charts = Vec::new();
    for (record, report) in found.records.iter().zip(&identification.records) {
        let drive = &report.drive;
        if !drive.is_periodic() {
            continue;
        }
        let simulate = |model: &ActuatorModel| {
            model.simulate(&record.voltage_volt, record.time_step_s).map_err(|source| {
                SimError::Actuator { place: Place::file(&data.folder).field(&record.id), source }
            })
        };
        let dynamic = simulate(&found.model)?.output_deg;
        let quasi_static = simulate(&identification.static_only)?.output_deg;
        let samples = last_cycle(drive.steady.end, drive.base_hz, record.time_step_s);
        let pick = |values: &[f64], shift: f64| -> Vec<f64> {
            samples.iter().filter_map(|&i| values.get(i)).map(|v| v - shift).collect()
        };
        charts.push(LoopChart {
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
        });
    }
    charts.sort_by(|a, b| {
        let key = |c: &LoopChart| (c.frequency_hz, -c.amplitude_volt);
        let ((fa, aa), (fb, ab)) = (key(a), key(b));
        fa.total_cmp(&fb).then(aa.total_cmp(&ab))
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

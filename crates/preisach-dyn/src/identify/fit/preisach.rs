//! The parts of a fit of a Preisach model: the linear gain, the rounds of the maps, range and zero.

use crate::check::extremes;
use crate::identify::fit::output_error::Uncertainty;
use crate::identify::fit::refine::{self, Refined};
use crate::identify::fit::training::Training;
use crate::identify::fit::{rate_fit, static_fit, validate};
use crate::identify::records::prepared::Prepared;
use crate::identify::{BenchRecord, Drive, Validation};
use crate::{
    DynamicPreisach, HysteresisLaw, LinearGain, PlayMap, PreisachError, StartState, TrainedRange,
};

/// A refined dynamic Preisach law with what its fit rests on.
pub(crate) struct RateFit {
    pub(crate) smoothness: f64,
    pub(crate) validation: Vec<Validation>,
    pub(crate) refined: Refined,
}

impl RateFit {
    /// The rounds of `mu0` and `mu1, mu2` and the refinement, from a first static map.
    pub(crate) fn new(
        training: &Training,
        mut g0_deg: PlayMap,
        uncertainty: Uncertainty,
    ) -> Result<Self, PreisachError> {
        let (mut smoothness, mut validation) = validate::smoothness(training, &g0_deg);
        let mut model = rate_fit::fit(training, &g0_deg, smoothness)?.model(training, &g0_deg)?;
        for round in 1..training.settings.rounds {
            let slow = training.slow.iter();
            let targets: Vec<_> = slow.map(|r| without_rate_terms(&model, r.record)).collect();
            g0_deg = static_fit::fit(training, &targets)?;
            if round == 1 {
                // again, now that the static map no longer holds the dynamics of the slow records
                (smoothness, validation) = validate::smoothness(training, &g0_deg);
            }
            model = rate_fit::fit(training, &g0_deg, smoothness)?.model(training, &g0_deg)?;
        }
        let refined = refine::refine(&model, training, uncertainty)?;
        Ok(Self { smoothness, validation, refined })
    }
}

/// Output of a record with `d G1 + d^2 G2` taken off, `d` from the simulated model: smooth, and
/// good enough for a term that is small in slow records.
fn without_rate_terms(model: &DynamicPreisach, record: &BenchRecord) -> Vec<f64> {
    let (mut memory, _) = model.start(record.voltage_volt[0], StartState::Rest);
    record
        .voltage_volt
        .iter()
        .zip(&record.output_deg)
        .map(|(&u, &measured)| {
            let output = model.step(&mut memory, u, record.time_step_s);
            // the simulated output is G0 + d G1 + d^2 G2 by construction
            measured - (output - model.maps(&memory.plays)[0])
        })
        .collect()
}

/// Least squares line through the quasi-static records, each weighing alike.
pub(crate) fn fit_linear(slow: &[&Prepared]) -> LinearGain {
    let [mut w, mut u1, mut u2, mut y1, mut uy] = [0.0; 5];
    for Prepared { record, left_out, .. } in slow {
        let weight = 1.0 / record.output_deg.len() as f64;
        let pairs = record.voltage_volt.iter().zip(&record.output_deg).enumerate();
        for (_, (&u, &y)) in pairs.filter(|(index, _)| !left_out.contains(index)) {
            w += weight;
            u1 += weight * u;
            u2 += weight * u * u;
            y1 += weight * y;
            uy += weight * u * y;
        }
    }
    let gain = (w * uy - u1 * y1) / (w * u2 - u1 * u1);
    LinearGain { gain_deg_per_volt: gain, bias_volt: (u1 - y1 / gain) / w }
}

/// Mean over the steady cycles of the periodic quasi-static record with the largest amplitude; over
/// all of the widest record if none is periodic.
pub(crate) fn major_loop_mean(slow: &[&Prepared]) -> f64 {
    let by_amplitude =
        |a: &&&Prepared, b: &&&Prepared| a.drive.amplitude_volt.total_cmp(&b.drive.amplitude_volt);
    let periodic = slow.iter().filter(|r| r.cycles.is_some()).max_by(by_amplitude);
    match periodic.or_else(|| slow.iter().max_by(by_amplitude)) {
        Some(Prepared { cycles: Some(cycles), .. }) => cycles.series.mean,
        Some(Prepared { record: BenchRecord { output_deg, .. }, .. }) => {
            output_deg.iter().sum::<f64>() / output_deg.len() as f64
        }
        None => 0.0,
    }
}

/// What the records that train cover, of all there are.
pub(crate) fn trained_range(training: &Training, all: &[Prepared]) -> TrainedRange {
    let amplitudes = extremes(training.all().iter().map(|r| r.drive.amplitude_volt));
    let trained = training.slow.iter().chain(&training.fast).map(|r| &r.drive);
    let frequencies = extremes(trained.map(Drive::strongest_hz));
    // steps have no frequency
    let ran = all.iter().filter(|r| r.is_slow || r.drive.is_periodic());
    TrainedRange {
        least_amplitude_volt: amplitudes[0],
        largest_amplitude_volt: amplitudes[1],
        lowest_hz: frequencies[0],
        highest_hz: frequencies[1],
        bench_highest_hz: extremes(ran.map(|r| r.drive.strongest_hz()))[1],
    }
}

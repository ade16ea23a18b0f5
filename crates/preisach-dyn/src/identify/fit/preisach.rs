//! The parts of a fit of a Preisach model: the linear gain, the rounds of the maps, range and zero.

use crate::identify::fit::output_error::{Covariance, Estimate, Uncertainty};
use crate::identify::fit::rate_fit;
use crate::identify::fit::refine;
use crate::identify::fit::static_fit;
use crate::identify::fit::validate;
use crate::identify::records::prepared::Prepared;
use crate::identify::{BenchRecord, Drive, Refinement, Settings, Validation};
use crate::{
    ActuatorLaw, DynamicPreisach, LinearGain, PlayMap, PlayMemory, PreisachError, PreisachGrid,
    StartState, TrainedRange,
};

/// A dynamic Preisach law with what its fit rests on.
pub(crate) struct RateFit {
    pub(crate) law: ActuatorLaw,
    pub(crate) smoothness: f64,
    pub(crate) validation: Vec<Validation>,
    pub(crate) refinement: Refinement,
    pub(crate) parameters: Vec<Estimate>,
    pub(crate) covariance: Option<Covariance>,
}

impl RateFit {
    /// The rounds of `mu0` and `mu1, mu2` and the refinement, from a first static map.
    pub(crate) fn new(
        grid: &PreisachGrid,
        mut g0_deg: PlayMap,
        slow: &[&Prepared],
        fast: &[&Prepared],
        settings: &Settings,
        uncertainty: Uncertainty,
    ) -> Result<Self, PreisachError> {
        let (mut smoothness, mut validation) = validate::smoothness(grid, &g0_deg, fast, settings);
        let mut model = rate_fit::fit(grid, &g0_deg, fast, smoothness, settings)?
            .model(grid, &g0_deg, settings)?;
        for round in 1..settings.rounds {
            let targets: Vec<Vec<f64>> =
                slow.iter().map(|r| without_rate_terms(&model, r.record)).collect();
            g0_deg = static_fit::fit(grid, slow, &targets, settings)?;
            if round == 1 {
                // again, now that the static map no longer holds the dynamics of the slow records
                (smoothness, validation) = validate::smoothness(grid, &g0_deg, fast, settings);
            }
            let maps = rate_fit::fit(grid, &g0_deg, fast, smoothness, settings)?;
            model = maps.model(grid, &g0_deg, settings)?;
        }
        let all: Vec<&Prepared> = slow.iter().chain(fast).copied().collect();
        let refine::Refined { model, refinement, parameters, covariance } =
            refine::refine(&model, &all, settings, uncertainty)?;
        let law = ActuatorLaw::DynamicPreisach(model);
        Ok(Self { law, smoothness, validation, refinement, parameters, covariance })
    }
}

/// Output of a record with `d G1 + d^2 G2` taken off, `d` from the simulated model: smooth, and
/// good enough for a term that is small in slow records.
pub(crate) fn without_rate_terms(model: &DynamicPreisach, record: &BenchRecord) -> Vec<f64> {
    let mut memory = PlayMemory::new(model.grid(), record.voltage_volt[0], StartState::Rest);
    let mut history = crate::OutputHistory::at_rest(model.maps(&memory)[0]);
    let mut counts = crate::StepCounts::default();
    record
        .voltage_volt
        .iter()
        .zip(&record.output_deg)
        .map(|(&u, &measured)| {
            let output = model.step(&mut memory, &mut history, &mut counts, u, record.time_step_s);
            // the simulated output is G0 + d G1 + d^2 G2 by construction
            measured - (output - model.maps(&memory)[0])
        })
        .collect()
}

/// Least squares line through the quasi-static records, each weighing alike.
pub(crate) fn fit_linear(slow: &[&Prepared]) -> LinearGain {
    let [mut w, mut u1, mut u2, mut y1, mut uy] = [0.0; 5];
    for Prepared { record, .. } in slow {
        let weight = 1.0 / record.output_deg.len() as f64;
        for (&u, &y) in record.voltage_volt.iter().zip(&record.output_deg) {
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

pub(crate) fn trained_range(
    slow: &[&Prepared],
    fast: &[&Prepared],
    all: &[Prepared],
) -> TrainedRange {
    let trained = || slow.iter().chain(fast).map(|r| &r.drive);
    let least = |values: &mut dyn Iterator<Item = f64>| values.fold(f64::INFINITY, f64::min);
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    TrainedRange {
        least_amplitude_volt: least(&mut trained().map(|d| d.amplitude_volt)),
        largest_amplitude_volt: largest(&mut trained().map(|d| d.amplitude_volt)),
        lowest_hz: least(&mut trained().map(Drive::strongest_hz)),
        highest_hz: largest(&mut trained().map(Drive::strongest_hz)),
        bench_highest_hz: largest(&mut all.iter().map(|r| r.drive.strongest_hz())),
    }
}

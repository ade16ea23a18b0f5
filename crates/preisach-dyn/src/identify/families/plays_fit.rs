//! Plays by constrained least squares.

use crate::check::extremes;
use crate::identify::families::family::Fitted;
use crate::identify::fit::program::{LeastSquaresProgram, Row};
use crate::identify::fit::training::Training;
use crate::{
    ActuatorLaw, Envelope, PrandtlIshlinskii, PrandtlParameters, PreisachError, WeightedPlay,
};

/// Plays of the model, the one of no width among them.
const PLAYS: usize = 64;
/// Grading of the half-widths: small ones lie closer.
const GRADING: f64 = 1.5;
/// Samples a record gives at most; a denser one is thinned.
const MOST_SAMPLES: usize = 16_000;
/// Weight between neighbours: what no loop determines is as beside it.
const SMOOTHNESS: f64 = 1e-6;

/// Fits a gain and plays to all training records, slow and fast.
///
/// ```text
/// min  mean_i (offset + sum_k p_k (w_k - u_mid) - y)^2 / spread^2 + smoothness of p,   p_k >= 0
/// r_k = (k / n)^1.5 a,   k = 0 .. n - 1,   a: half the swing of the commands
/// ```
/// Samples weigh alike: of what is left when plays describe an actuator, the noise, each has as much. Half-widths lie
/// within what was commanded, whatever range is declared.
pub(crate) fn fit(training: &Training<'_>) -> Result<Fitted, PreisachError> {
    let (settings, records) = (training.settings, training.all());
    let range_volt = settings.range_volt;
    let middle_volt = range_volt.middle_volt();
    let commands = records
        .iter()
        .flat_map(|r| r.record.voltage_volt[..r.record.trained_samples().end].iter().copied());
    let [low, high] = extremes(commands);
    let half_swing_volt = 0.5 * (high - low);
    let half_width = |k: usize| half_swing_volt * (k as f64 / PLAYS as f64).powf(GRADING);
    let half_widths_volt: Vec<f64> = (0..PLAYS).map(half_width).collect();
    let spread_deg = records.iter().map(|r| r.spread_deg).fold(0.0, f64::max);
    let samples: usize = records.iter().map(|r| r.record.trained_samples().len()).sum();
    let mut program = LeastSquaresProgram::new(1 + PLAYS);
    for prepared in &records {
        let record = prepared.record;
        let trained = record.trained_samples();
        let stride = trained.len().div_ceil(MOST_SAMPLES).max(1);
        let mut plays_volt = vec![record.voltage_volt[0]; PLAYS];
        for (i, &u) in record.voltage_volt[..trained.end].iter().enumerate() {
            for (w, r) in plays_volt.iter_mut().zip(&half_widths_volt) {
                *w = w.min(u + r).max(u - r);
            }
            let trains = i >= trained.start && !prepared.left_out.contains(&i);
            if trains && (i - trained.start).is_multiple_of(stride) {
                let mut row: Row = vec![(0, 1.0)];
                row.extend(
                    (1..).zip(plays_volt.iter().map(|w| (w - middle_volt) / half_swing_volt)),
                );
                let weight = stride as f64 / samples as f64;
                program.add(&row, record.output_deg[i] / spread_deg, weight);
            }
        }
    }
    for k in 1..=PLAYS {
        program.at_least(vec![(k, 1.0)], 0.0);
    }
    for k in 2..PLAYS {
        program.add(&[(k, 1.0), (k + 1, -1.0)], 0.0, SMOOTHNESS);
    }
    let x = program.solve("plays")?;
    // the solver meets the bounds to its tolerance only
    let mut weights = x[1..].iter().map(|p| p.max(0.0) * spread_deg / half_swing_volt);
    let gain_deg_per_volt = weights.next().unwrap_or_default();
    let pairs = half_widths_volt[1..].iter().zip(weights);
    let plays = pairs
        .map(|(&threshold_volt, weight_deg_per_volt)| WeightedPlay {
            threshold_volt,
            weight_deg_per_volt,
        })
        .collect();
    let law = PrandtlIshlinskii::new(PrandtlParameters {
        range_volt,
        gain_deg_per_volt,
        plays,
        threshold_growth_s: 0.0,
        envelope: Envelope { offset_deg: x[0] * spread_deg, ..Envelope::default() },
    })?;
    let model = settings.actuator_of(ActuatorLaw::PrandtlIshlinskii(law));
    Ok(Fitted { model, parameters: Vec::new() })
}

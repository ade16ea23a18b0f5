//! Stops by constrained least squares.

use crate::check::extremes;
use crate::identify::families::family::Fitted;
use crate::identify::fit::program::{LeastSquaresProgram, Row};
use crate::identify::fit::training::Training;
use crate::identify::records::prepared::Prepared;
use crate::{
    ActuatorLaw, HysteresisLaw, PrandtlStop, PreisachError, StartState, StopParameters,
    WeightedStop,
};

/// Stops of the model, their thresholds equally spaced over half the range.
const STOPS: usize = 16;
/// Samples a record gives at most; a denser one is thinned.
const MOST_SAMPLES: usize = 4000;
/// Weight that keeps numbers finite which no record determines.
const RIDGE: f64 = 1e-8;

/// Fits elastic part, stops and, where records differ in speed, viscosity to all training records.
///
/// ```text
/// min  sum_records mean_i (offset + k (u - u_mid) + sum_j w_j s_j + c du/dt - y)^2 / spread^2
/// k, w_j, c >= 0
/// ```
/// # Errors
/// [`PreisachError::OutputLags`] if the loops run the other way round.
pub(crate) fn fit(training: &Training<'_>) -> Result<Fitted, PreisachError> {
    let Training { slow, fast, settings, .. } = training;
    let area = mean_loop_area(slow);
    if area <= 0.0 {
        return Err(PreisachError::OutputLags { area_share: area });
    }
    let range = settings.range_volt;
    let half_volt = 0.5 * range.span_volt();
    let unit_stop = |i: usize| WeightedStop {
        threshold_volt: half_volt * (i + 1) as f64 / STOPS as f64,
        stiffness_deg_per_volt: 1.0,
    };
    let stops: Vec<WeightedStop> = (0..STOPS).map(unit_stop).collect();
    // all stops of stiffness 1: their memory gives the columns
    let unit = PrandtlStop::new(StopParameters {
        range_volt: range,
        stiffness_deg_per_volt: 0.0,
        stops: stops.clone(),
        viscosity_deg_s_per_volt: 0.0,
        offset_deg: 0.0,
    })?;
    let viscous = !fast.is_empty();
    let unknowns = 2 + STOPS + usize::from(viscous);
    let records = training.all();
    // unknowns in units of the largest spread over half the range, rates in those of the fastest
    let spread_deg = records.iter().map(|r| r.spread_deg).fold(0.0, f64::max);
    let fastest = records.iter().map(|r| r.drive.strongest_hz()).fold(0.0, f64::max);
    let rate_unit = std::f64::consts::TAU * fastest * half_volt;
    let mut program = LeastSquaresProgram::new(unknowns);
    for prepared in &records {
        let record = prepared.record;
        let trained = record.trained_samples();
        let stride = trained.len().div_ceil(MOST_SAMPLES).max(1);
        let kept = trained.clone().step_by(stride).count() as f64;
        let weight = (spread_deg / prepared.spread_deg).powi(2) / (kept * records.len() as f64);
        let (mut memory, _) = unit.start(record.voltage_volt[0], StartState::Rest);
        let mut last_volt = record.voltage_volt[0];
        for (i, &u) in record.voltage_volt[..trained.end].iter().enumerate() {
            unit.step(&mut memory, u, record.time_step_s);
            let trains = i >= trained.start && !prepared.left_out.contains(&i);
            if trains && (i - trained.start).is_multiple_of(stride) {
                let mut row: Row = vec![(0, 1.0), (1, (u - range.middle_volt()) / half_volt)];
                row.extend((2..).zip(memory.stops_volt().map(|s| s / half_volt)));
                if viscous {
                    row.push((2 + STOPS, (u - last_volt) / record.time_step_s / rate_unit));
                }
                program.add(&row, record.output_deg[i] / spread_deg, weight);
            }
            last_volt = u;
        }
    }
    for k in 1..unknowns {
        program.at_least(vec![(k, 1.0)], 0.0);
        program.add(&[(k, 1.0)], 0.0, RIDGE);
    }
    let x = program.solve("stops")?;
    // the solver meets the bounds to its tolerance only
    let stiffness = |k: usize| x[k].max(0.0) * spread_deg / half_volt;
    let weighted = stops
        .iter()
        .zip(2..)
        .map(|(stop, k)| WeightedStop { stiffness_deg_per_volt: stiffness(k), ..*stop });
    let law = PrandtlStop::new(StopParameters {
        range_volt: range,
        stiffness_deg_per_volt: stiffness(1),
        stops: weighted.collect(),
        viscosity_deg_s_per_volt: x.get(2 + STOPS).map_or(0.0, |c| c.max(0.0)) * spread_deg
            / rate_unit,
        offset_deg: x[0] * spread_deg,
    })?;
    let model = settings.actuator_of(ActuatorLaw::PrandtlStop(law));
    Ok(Fitted { model, parameters: Vec::new() })
}

/// `integral y du` over the records that train, each over the square of its ranges and its travel
/// there and back: 1 is a rectangle run clockwise, an output that leads; negative, one that lags.
fn mean_loop_area(records: &[&Prepared]) -> f64 {
    let area = |prepared: &&Prepared| {
        let record = prepared.record;
        let samples = prepared
            .drive
            .steady_within(&record.trained_samples(), record.time_step_s)
            .unwrap_or(record.trained_samples());
        let (u, y) = (&record.voltage_volt[samples.clone()], &record.output_deg[samples]);
        let [low, high] = extremes(y.iter().copied());
        let (middle, half) = (0.5 * (low + high), 0.5 * (high - low));
        let steps = u.windows(2).zip(y.windows(2));
        let work: f64 = steps.map(|(u, y)| (0.5 * (y[0] + y[1]) - middle) * (u[1] - u[0])).sum();
        let travel: f64 = u.windows(2).map(|pair| (pair[1] - pair[0]).abs()).sum();
        work / (half * travel).max(f64::MIN_POSITIVE)
    };
    records.iter().map(area).sum::<f64>() / records.len().max(1) as f64
}

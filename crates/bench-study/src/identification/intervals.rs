//! Physical quantities of a model with intervals by a bootstrap of what the model leaves.

use model_gap::NoiseDraw;
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::{
    BenchRecord, ModelComparison, ModelRow, Quantity, RecordUse, Settings, quantities,
};
use rayon::prelude::*;
use rotor_base::mean_square;

/// Times the residuals are drawn: a deviation is then known to 16 %.
const DRAWS: u64 = 20;
/// Standard deviations on either side of a value in 95 of 100 cases, the deviation from so many draws: Student's t.
const HALF: f64 = 2.09;
/// Blocks drawn together: parts of a record.
const PARTS: usize = 16;
/// Least samples of a block.
const LEAST_BLOCK: usize = 8;

/// Parts of the smoothness of a density that are tried: its own, less and more.
const SMOOTHNESS: [f64; 3] = [1.0, 0.1, 10.0];

/// A physical quantity with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownQuantity {
    /// The quantity.
    pub quantity: Quantity,
    /// Ends of the interval; none where fits to drawn residuals failed.
    pub interval: Option<[f64; 2]>,
}

/// The physical quantities of a fitted model with intervals.
///
/// ```text
/// y* = y_model + blocks of (y - y_model) drawn anew,   q +- 2.09 sqrt( mean (q* - q)^2 over 20 draws + b^2 )
/// b  = max( |q_(s/10) - q_s|, |q_(10 s) - q_s| )
/// ```
/// The model is fitted to each `y*` as it was to `y`. Blocks are a sixteenth of a record, from anywhere in it: what the model
/// misses keeps its colour up to that length. The same for the same records: the draws are seeded.
/// `q_s` is the quantity at the smoothness `s` of the density. Its bias hardly shows in the draws, whose truth is the smooth density
/// itself: `b` is what a tenth or tenfold of it changes.
///
/// Assumes: what is left is stationary over a record. Not in it: how far the truth lies outside the family.
/// Source: H. R. Kuensch, *The jackknife and the bootstrap for general stationary observations*, Annals of Statistics 17
/// (1989).
///
/// `row`: a row of `table`, of which `records` and `settings` are. Empty where the row has no fit.
pub fn known_quantities(
    table: &ModelComparison,
    row: &ModelRow,
    records: &[BenchRecord],
    settings: &Settings,
) -> Vec<KnownQuantity> {
    let Ok(fitted) = &row.fitted else { return Vec::new() };
    let trains: Vec<bool> = table.records.iter().map(|own| own.1 == RecordUse::Train).collect();
    let swing_volt = swing(records, &trains);
    let found = quantities(&fitted.model, swing_volt);
    let refitted = |row: &ModelRow, records: &[BenchRecord]| -> Option<Vec<f64>> {
        let model = table.refitted(row, records, settings).ok()?;
        let own = quantities(&model, swing_volt);
        (own.len() == found.len()).then(|| own.iter().map(|own| own.value).collect())
    };
    let draw =
        |seed: u64| refitted(row, &drawn(&fitted.model, table.zero_deg, records, &trains, seed)?);
    let draws: Vec<Option<Vec<f64>>> = (0..DRAWS).into_par_iter().map(draw).collect();
    let draws: Option<Vec<Vec<f64>>> = draws.into_iter().collect();
    let smoothness = SMOOTHNESS.map(|part| {
        let mut row = row.clone();
        row.order.static_smoothness *= part;
        refitted(&row, records)
    });
    let interval = |(k, own): (usize, &Quantity)| {
        let (draws, [smooth, less, more]) = (draws.as_ref()?, &smoothness);
        let off: Vec<f64> = draws.iter().map(|drawn| drawn[k] - own.value).collect();
        let there = smooth.as_ref()?[k];
        let change = |other: &Option<Vec<f64>>| Some((other.as_ref()?[k] - there).abs());
        let bias = change(less)?.max(change(more)?);
        let half = HALF * (mean_square(&off) + bias * bias).sqrt();
        half.is_finite().then_some([own.value - half, own.value + half])
    };
    let pairs = found.iter().enumerate();
    pairs.map(|own| KnownQuantity { quantity: *own.1, interval: interval(own) }).collect()
}

/// Lowest and highest command of the records that train, V.
fn swing(records: &[BenchRecord], trains: &[bool]) -> [f64; 2] {
    let trained = records.iter().zip(trains).filter(|(_, trains)| **trains);
    let volts = trained.flat_map(|(record, _)| &record.voltage_volt[record.trained_samples()]);
    volts.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(*v), high.max(*v)])
}

/// The records with outputs of the model and residuals drawn anew where they train; none where the model cannot be run.
fn drawn(
    model: &ActuatorModel,
    zero_deg: f64,
    records: &[BenchRecord],
    trains: &[bool],
    seed: u64,
) -> Option<Vec<BenchRecord>> {
    let one = |(i, record): (usize, &BenchRecord)| {
        if !trains[i] {
            return Some(record.clone());
        }
        let own = model.simulate(&record.voltage_volt, record.time_step_s).ok()?.output_deg;
        let left: Vec<f64> =
            record.output_deg.iter().zip(&own).map(|(y, own)| y - own - zero_deg).collect();
        let trained = record.trained_samples();
        let together = (trained.len() / PARTS).max(LEAST_BLOCK);
        // no window: what is smooth is drawn with the rest
        let way = NoiseDraw { half_window: left.len(), together };
        let drawn = way.again(&left[trained.clone()], seed * records.len() as u64 + i as u64);
        let mut again = record.clone();
        for (index, left) in trained.zip(drawn) {
            again.output_deg[index] = own[index] + zero_deg + left;
        }
        Some(again)
    };
    records.iter().enumerate().map(one).collect()
}

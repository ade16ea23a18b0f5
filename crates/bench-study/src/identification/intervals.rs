//! Physical quantities of a model with intervals by a bootstrap of what the model leaves.

use model_gap::NoiseDraw;
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::{
    BenchRecord, Family, ModelComparison, ModelRow, Quantity, RecordUse, Settings, quantities,
};
use rayon::prelude::*;

/// Times the residuals are drawn: a deviation is then known to 16 %.
const DRAWS: u64 = 20;
/// Standard deviations on either side of a value in 95 of 100 cases, the deviation from so many draws: Student's t.
const HALF: f64 = 2.09;
/// Blocks drawn together: parts of a record.
const PARTS: usize = 16;
/// Least samples of a block.
const LEAST_BLOCK: usize = 8;

/// Families whose intervals held the truth in 17 of 20 benches at least, every quantity of them. The others, a static map
/// fitted in rounds with stages behind it or a law before creep, held as few as 10, and those of the deviations of their own
/// searches as few as 3: they get none.
pub const CONFIRMED: [Family; 10] = [
    Family::Linear,
    Family::LinearLag,
    Family::BoucWen,
    Family::BoucWenMode,
    Family::PrandtlPlays,
    Family::PrandtlIshlinskii,
    Family::PrandtlStop,
    Family::StaticPreisach,
    Family::DynamicPreisachFirst,
    Family::DynamicPreisach,
];

/// A physical quantity with its 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownQuantity {
    /// The quantity.
    pub quantity: Quantity,
    /// Ends of the interval; none where the family is not [`CONFIRMED`] or fits to drawn residuals failed.
    pub interval: Option<[f64; 2]>,
}

/// The physical quantities of a fitted model with intervals.
///
/// ```text
/// y* = y_model + blocks of (y - y_model) drawn anew,   deviation^2 = mean (q* - q)^2 over 20 draws,   q +- 2.09 deviation
/// ```
/// The model is fitted to each `y*` as it was to `y`. Blocks are a sixteenth of a record, from anywhere in it: what the model
/// misses keeps its colour up to that length. The bias that a fit has where its own model is the truth, by smoothness for
/// instance, is part of the deviation. The same for the same records: the draws are seeded.
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
    let draw = |seed: u64| -> Option<Vec<f64>> {
        let drawn = drawn(&fitted.model, table.zero_deg, records, &trains, seed)?;
        let model = table.refitted(row, &drawn, settings).ok()?;
        Some(quantities(&model, swing_volt).iter().map(|own| own.value).collect())
    };
    let count = if CONFIRMED.contains(&row.family) { DRAWS } else { 0 };
    let draws: Vec<Option<Vec<f64>>> = (0..count).into_par_iter().map(draw).collect();
    let whole = |own: &Vec<f64>| own.len() == found.len();
    let draws: Option<Vec<Vec<f64>>> = draws.into_iter().map(|own| own.filter(whole)).collect();
    let interval = |(k, own): (usize, &Quantity)| {
        let draws = draws.as_ref()?;
        let squares: f64 = draws.iter().map(|drawn| (drawn[k] - own.value).powi(2)).sum();
        let half = HALF * (squares / draws.len() as f64).sqrt();
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

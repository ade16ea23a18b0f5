//! What a model says in physical terms, whatever numbers its family is searched with, and the fit of the same model to
//! other outputs, by which a bootstrap tells how well that is known.

use crate::identify::families::by_family;
use crate::identify::families::comparison::{ModelComparison, ModelRow};
use crate::identify::families::family::{Family, Fitted, Given};
use crate::identify::fit::linear_mode::LinearMode;
use crate::identify::fit::roles::Bench;
use crate::identify::fit::training::Training;
use crate::identify::{BenchRecord, Settings};
use crate::{
    ActuatorLaw, ActuatorModel, AmplifierStage, DynamicPreisach, HysteresisLaw, LinkageStage,
    PreisachError, PreisachGrid, StartState,
};
use serde::{Deserialize, Serialize};

/// Unit of a [`Quantity`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum QuantityUnit {
    /// That of the output, deg of an actuator.
    Output,
    /// Output times seconds over input, deg s/V of an actuator.
    OutputRate,
    /// Seconds.
    Seconds,
    /// Hertz.
    Hertz,
    /// Percent.
    Percent,
    /// Percent per decade of time.
    PercentPerDecade,
    /// None: a plain number.
    Plain,
}

/// A physical quantity of a model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantity {
    /// What it is.
    pub name: &'static str,
    /// Its unit.
    pub unit: QuantityUnit,
    /// Its value.
    pub value: f64,
}

/// Samples of a branch of a slow loop.
const BRANCH: u32 = 100;
/// Time between them, s: no model knows anything slower.
const SLOW_S: f64 = 1e3;

/// The physical quantities of a model, all that its kind has:
///
/// | quantity | meaning |
/// |---|---|
/// | stroke | slow output at the higher end of the swing less that at the lower end; negative if it falls |
/// | loop width | distance of the branches of a slow loop of that swing at its middle, over the stroke; positive if the output lags |
/// | relaxation time | of a dynamic Preisach law, `-G1` averaged over that loop; of a stage its own |
/// | time constant of the lag, growth of the half-widths, viscosity, mode, creep, accommodation | of the stage or the law |
///
/// `swing_volt`: lower and higher end of the commands, V; the loop of the law alone, without its stages.
pub fn quantities(model: &ActuatorModel, swing_volt: [f64; 2]) -> Vec<Quantity> {
    let mut found = Vec::new();
    let mut put = |name: &'static str, unit, value: f64| found.push(Quantity { name, unit, value });
    let volts = slow_loop(swing_volt);
    if !matches!(model.law, ActuatorLaw::HystereticOscillator(_)) {
        let output = model.law.outputs(&volts, SLOW_S);
        // from the end, in halves of a branch: low, middle falling, high, middle rising
        let back = |halves: usize| output[output.len() - 1 - halves * BRANCH as usize / 2];
        let stroke_deg = back(2) - back(0);
        put("stroke", QuantityUnit::Output, stroke_deg);
        if !matches!(model.law, ActuatorLaw::Linear(_)) {
            let width_deg = back(1) - back(3);
            put("loop width", QuantityUnit::Percent, 100.0 * width_deg / stroke_deg);
        }
    }
    match &model.law {
        ActuatorLaw::DynamicPreisach(law) => {
            put("relaxation time", QuantityUnit::Seconds, relaxation_s(law, &volts));
        }
        ActuatorLaw::PrandtlIshlinskii(law) if law.parameters().threshold_growth_s > 0.0 => {
            let growth_s = law.parameters().threshold_growth_s;
            put("growth of the half-widths", QuantityUnit::Seconds, growth_s);
        }
        ActuatorLaw::PrandtlStop(law) => {
            let viscosity = law.parameters().viscosity_deg_s_per_volt;
            put("viscosity", QuantityUnit::OutputRate, viscosity);
        }
        ActuatorLaw::HystereticOscillator(law) => {
            let own = law.parameters();
            put("natural frequency of the mode", QuantityUnit::Hertz, own.frequency_hz);
            put("damping ratio of the mode", QuantityUnit::Plain, own.damping_ratio);
        }
        _ => {}
    }
    for stage in &model.amplifier {
        if let AmplifierStage::Lag(lag) = stage {
            put("time constant of the lag", QuantityUnit::Seconds, lag.tau_s);
        }
    }
    for stage in &model.linkage {
        match stage {
            LinkageStage::Relaxation(stage) => {
                for element in &stage.elements {
                    put("relaxation time", QuantityUnit::Seconds, element.time_constant_s);
                    let at_once = 100.0 * (1.0 - element.share);
                    put("share that follows at once", QuantityUnit::Percent, at_once);
                }
            }
            LinkageStage::LogCreep(creep) => {
                let name = if creep.from_s < 0.03 { "creep after 0.01 s" } else { "creep" };
                put(name, QuantityUnit::PercentPerDecade, 100.0 * creep.rate_per_decade);
            }
            LinkageStage::Accommodation(stage) => {
                put("share of the accommodation", QuantityUnit::Percent, 100.0 * stage.share);
                let travel_deg = stage.travel_um * model.calibration.deg_per_um.abs();
                put("travel of the accommodation", QuantityUnit::Output, travel_deg);
            }
            LinkageStage::Resonance(mode) => {
                put("natural frequency of the mode", QuantityUnit::Hertz, mode.frequency_hz);
                put("damping ratio of the mode", QuantityUnit::Plain, mode.damping_ratio);
            }
            _ => {}
        }
    }
    found
}

/// Up, down, up and down between two ends.
fn slow_loop([low, high]: [f64; 2]) -> Vec<f64> {
    let at = |i: u32| {
        let place = i % (2 * BRANCH);
        let rise = if place > BRANCH { 2 * BRANCH - place } else { place };
        low + (high - low) * f64::from(rise) / f64::from(BRANCH)
    };
    (0..=4 * BRANCH).map(at).collect()
}

/// `-G1` averaged over the last branches of a loop, s.
fn relaxation_s(law: &DynamicPreisach, volts: &[f64]) -> f64 {
    let (mut memory, _) = law.start(volts[0], StartState::Rest);
    let mut sum_s = 0.0;
    let skipped = volts.len() - 2 * BRANCH as usize;
    for (i, &volt) in volts.iter().enumerate() {
        law.step(&mut memory, volt, SLOW_S);
        if i >= skipped {
            sum_s -= law.maps(&memory.plays)[1];
        }
    }
    sum_s / f64::from(2 * BRANCH)
}

impl ModelComparison {
    /// The model of a row fitted to records of the same commands and other outputs, from where the fit of the row ended.
    ///
    /// # Errors
    /// Those of [`crate::identify::compare_models`], and that of the row where it has no fit.
    pub fn refitted(
        &self,
        row: &ModelRow,
        records: &[BenchRecord],
        settings: &Settings,
    ) -> Result<ActuatorModel, PreisachError> {
        let known = row.fitted.as_ref().map_err(Clone::clone)?;
        let settings = row.order.within(settings);
        let bench = Bench::new(records, &settings)?;
        let grid = PreisachGrid::new(settings.range_volt, settings.levels)?;
        let prepared = bench.prepared(&grid, &settings)?;
        let training = Training::of(&prepared, grid, &settings)?;
        let mode = row.family.has_mode().then(|| LinearMode::of(&training)).transpose()?;
        let whole = Fitted { model: known.model.clone(), parameters: known.parameters.clone() };
        // given a whole fit, creep keeps the rate of that one
        let is_creep =
            matches!(row.family, Family::StaticPreisachCreep | Family::DynamicPreisachCreep);
        let given = Given {
            smoothness: self.rate_smoothness,
            mode: mode.as_ref(),
            whole: (!is_creep).then_some(&whole),
            creep: whole.log_creep(),
            creep_from_s: f64::NAN,
        };
        let fitted = by_family::fit(row.family, &training, given)?;
        Ok(bench.rigged(fitted.model, &training))
    }
}

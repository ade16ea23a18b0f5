//! The monitor of a named cause: whether an actuator in service still is as it was, and how much of the cause it shows.
//!
//! ```text
//! r = measured - base,   e = extended - base        residual and signature of the cause, deg
//! amount = <r e> / <e e>                            0 none, 1 as diagnosed
//! residual^2 = <r r>,   left^2 = <r r> - amount <r e>
//! < >: mean with weights that fall as exp(-age / memory)
//! sound: residual <= threshold;   the cause: left <= threshold < residual, amount > 0;   something else: all others
//! ```

use crate::constant::number;
use crate::json::Json;
use crate::library::{filled, prefixed};
use crate::plan::{Plan, broken};
use crate::targets::json;
use crate::{ExportError, Target, name};
use preisach_dyn::{ActuatorModel, PreisachError};

/// What is watched for, and when it is said.
#[derive(Debug, Clone, PartialEq)]
pub struct Monitor<'a> {
    /// The actuator as it was.
    pub base: &'a ActuatorModel,
    /// The actuator with the cause.
    pub extended: &'a ActuatorModel,
    /// The cause in words.
    pub cause: &'a str,
    /// RMS residual that a sound actuator does not reach, deg, above 0.
    pub threshold_deg: f64,
    /// Time after which a sample has lost 63 % of its weight, s, above 0.
    pub memory_s: f64,
}

/// What is seen of the actuator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seen {
    /// The residual is within the threshold.
    Sound,
    /// It is beyond, and within once the amount of the cause, above 0, is taken off.
    Cause,
    /// It is beyond, with the cause taken off too, or the amount is 0 or below: what is seen is its contrary.
    Other,
}

/// What a monitor says after a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Watched {
    /// RMS of what was measured less the base, deg.
    pub residual_deg: f64,
    /// Amount of the cause: 0 none, 1 as it was diagnosed.
    pub amount: f64,
    /// RMS residual with that amount taken off, deg.
    pub left_deg: f64,
    /// What is seen.
    pub seen: Seen,
}

/// Longest memory, in time steps: beyond it a sample has hardly any weight beside the rounding of the sums.
const LONGEST_MEMORY: f64 = 1e12;

const MEANING: &str = "A sample of the voltage and of the measured flap angle at a time. The residual is what was measured less \
     the actuator as it was; the signature is what the cause adds. The amount of the cause is the share of the signature that \
     explains the residual. The residual itself is said to be due to it where what is left is within the threshold and \
     the amount is above 0.";

impl Monitor<'_> {
    /// What is seen after each sample but the first, at which the actuator rests. Measurements that are not finite are left
    /// out.
    ///
    /// # Errors
    /// A voltage that an actuator refuses.
    pub fn watch(
        &self,
        volts: &[f64],
        measured_deg: &[f64],
        time_step_s: f64,
    ) -> Result<Vec<Watched>, PreisachError> {
        let base = self.base.simulate(volts, time_step_s)?.output_deg;
        let extended = self.extended.simulate(volts, time_step_s)?.output_deg;
        let kept = self.kept(time_step_s);
        let mut sums = [0.0; 4];
        let mut last = Watched { residual_deg: 0.0, amount: 0.0, left_deg: 0.0, seen: Seen::Sound };
        let samples = base.iter().zip(&extended).zip(measured_deg).skip(1);
        let watched = samples.map(|((base, extended), measured)| {
            let (r, e) = (measured - base, extended - base);
            if r.is_finite() && e.is_finite() {
                for (sum, product) in sums.iter_mut().zip([1.0, r * r, r * e, e * e]) {
                    *sum = kept * *sum + (1.0 - kept) * product;
                }
                last = self.judged(sums);
            }
            last
        });
        Ok(watched.collect())
    }

    fn judged(&self, [weight, rr, re, ee]: [f64; 4]) -> Watched {
        let amount = if ee > 0.0 { re / ee } else { 0.0 };
        let residual_deg = (rr / weight).sqrt();
        let left_deg = ((rr - amount * re).max(0.0) / weight).sqrt();
        let seen = match () {
            () if residual_deg <= self.threshold_deg => Seen::Sound,
            () if left_deg <= self.threshold_deg && amount > 0.0 => Seen::Cause,
            () => Seen::Other,
        };
        Watched { residual_deg, amount, left_deg, seen }
    }

    fn kept(&self, time_step_s: f64) -> f64 {
        (-time_step_s / self.memory_s).exp()
    }

    fn check(&self, time_step_s: f64) -> Result<(), ExportError> {
        for (what, value) in [("threshold", self.threshold_deg), ("memory", self.memory_s)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(ExportError::NotPositive { what, value });
            }
        }
        // an invalid time step is refused with the step functions
        if time_step_s > 0.0 && self.memory_s > LONGEST_MEMORY * time_step_s {
            let (memory_s, largest_s) = (self.memory_s, LONGEST_MEMORY * time_step_s);
            return Err(ExportError::Memory { memory_s, largest_s });
        }
        let (a, b) = (self.base, self.extended);
        let sensors = [a, b].into_iter().flat_map(|model| &model.sensor);
        let mut kinds: Vec<String> = sensors.map(kind_of).collect();
        kinds.dedup();
        if !kinds.is_empty() {
            return Err(ExportError::Sensor { stages: kinds.join(", ") });
        }
        if a.law == b.law && a.amplifier == b.amplifier && a.linkage == b.linkage {
            return Err(ExportError::NoCause);
        }
        Ok(())
    }
}

/// An actuator without the stages of some names (`Backlash`, `Delay` ...) of amplifier and linkage: as it was before the cause.
///
/// # Errors
/// [`ExportError::NoStage`] for a name that none of its stages has.
pub fn without_stages<S: AsRef<str>>(
    model: &ActuatorModel,
    names: &[S],
) -> Result<ActuatorModel, ExportError> {
    let amplifier = model.amplifier.iter().map(kind_of);
    let all: Vec<String> = amplifier.chain(model.linkage.iter().map(kind_of)).collect();
    let is_named = |kind: &String| names.iter().any(|name| name.as_ref() == kind);
    if let Some(name) = names.iter().find(|name| !all.iter().any(|kind| kind == name.as_ref())) {
        let found = if all.is_empty() { "none".to_owned() } else { all.join(", ") };
        return Err(ExportError::NoStage { name: name.as_ref().to_owned(), found });
    }
    let mut base = model.clone();
    base.amplifier.retain(|stage| !is_named(&kind_of(stage)));
    base.linkage.retain(|stage| !is_named(&kind_of(stage)));
    Ok(base)
}

/// Name of a stage as in an actuator file.
fn kind_of(stage: &impl std::fmt::Debug) -> String {
    let text = format!("{stage:?}");
    text.split('(').next().unwrap_or_default().to_owned()
}

/// The files of a monitor, name and text of each: `NAME` with `NAME_base` and `NAME_extended`, or one JSON.
///
/// # Errors
/// Those of [`crate::export`]; a threshold or a memory that is not positive, a memory too long for the time step, a sensor
/// stage, two actuators that move alike.
pub fn export_monitor(
    monitor: &Monitor<'_>,
    name: &str,
    time_step_s: f64,
    target: Target,
) -> Result<Vec<(String, String)>, ExportError> {
    monitor.check(time_step_s)?;
    name::check(name)?;
    let names = ["base", "extended"].map(|part| format!("{name}_{part}"));
    let models = [monitor.base, monitor.extended];
    if target == Target::Json {
        let [base, extended] = [0, 1].map(|i| Plan::new(models[i], &names[i], time_step_s));
        let record = [json::record(&base?), json::record(&extended?)];
        return Ok(vec![(format!("{name}.json"), monitor.json(name, time_step_s, record))]);
    }
    let mut files = Vec::new();
    for (model, name) in models.into_iter().zip(&names) {
        files.extend(crate::export(model, name, time_step_s, target)?);
    }
    let templates: &[(&str, &str)] = match target {
        Target::C => &[
            ("h", include_str!("../templates/monitor/main.h")),
            ("c", include_str!("../templates/monitor/main.c")),
        ],
        Target::Python => &[("py", include_str!("../templates/monitor/main.py"))],
        Target::Matlab => &[("m", include_str!("../templates/monitor/main.m"))],
        // written above
        Target::Json => &[],
    };
    for (ending, text) in templates {
        let prefix = match target {
            Target::C => " * ",
            Target::Matlab => "    % ",
            Target::Python | Target::Json => "",
        };
        let about = prefixed(&broken(MEANING, 100), prefix);
        let words = [
            ("about", about.as_str()),
            ("name", name),
            ("NAME", &name.to_uppercase()),
            ("cause", &monitor.cause.replace("*/", "* /").replace('\n', " ")),
            ("time_step", &number(time_step_s)),
            ("threshold", &number(monitor.threshold_deg)),
            ("kept", &number(monitor.kept(time_step_s))),
        ];
        files.push((format!("{name}.{ending}"), filled(text, &words)));
    }
    Ok(files)
}

impl Monitor<'_> {
    fn json(&self, name: &str, time_step_s: f64, [base, extended]: [Json; 2]) -> String {
        let equations = [
            "r = measured - base,   e = extended - base",
            "every mean: m <- kept m + (1 - kept) product, divided by the weight w <- kept w + (1 - kept)",
            "amount = <r e> / <e e>,   residual^2 = <r r>,   left^2 = <r r> - amount <r e>",
            "sound: residual <= threshold; the cause: left <= threshold < residual and amount > 0; something else: all others",
        ];
        Json::Record(vec![
            ("name", Json::text(name)),
            ("cause", Json::text(self.cause)),
            ("meaning", Json::text(MEANING)),
            ("equations", Json::List(equations.map(Json::text).to_vec())),
            ("time_step_s", Json::Number(time_step_s)),
            ("threshold_deg", Json::Number(self.threshold_deg)),
            ("memory_s", Json::Number(self.memory_s)),
            ("kept", Json::Number(self.kept(time_step_s))),
            ("base", base),
            ("extended", extended),
        ])
        .document()
    }
}

//! The page of an identification: its pictures and tables as one HTML text that loads nothing.
//!
//! | section | module |
//! |---|---|
//! | measured loops against the model | `loops` |
//! | gain and phase over frequency | `response` |
//! | spectrum of the residuals beside the noise | `spectrum` |
//! | Preisach density with its deviation | `density` |
//! | FORC diagram | `forc` |
//!
//! Tables are those of the terminal, from the same numbers. A picture that the data cannot give says what is
//! missing and what to record.

mod density;
mod forc;
mod loops;
mod response;
mod spectrum;

use crate::BenchError;
use crate::curves::{CurveIdentification, CurvesResult};
use crate::identification::{BenchIdentification, IdentifyResult};
use crate::reversals::of_records;
use preisach_dyn::ActuatorLaw;
use report_page::{Charts, Markup, Sheet, body, folded, heading, page, titled};

/// Points of all lines of a section together, and of one line at least and at most.
const POINTS: usize = 30_000;
const LINE: [usize; 2] = [100, 1000];
/// Runs that are drawn at once, and those drawn at all, the worst first.
const RUNS: usize = 6;
const MOST_RUNS: usize = 60;
/// Colours of what was measured and of the model.
const MEASURED: usize = 0;
const MODEL: usize = 1;

/// The page of an identification from records; `result` is what was printed of it.
///
/// # Errors
/// [`BenchError::Actuator`] or [`BenchError::Loop`] if the model cannot be simulated on one of its records.
pub fn bench_page(
    found: &BenchIdentification,
    result: &IdentifyResult,
) -> Result<String, BenchError> {
    let units = result.units();
    let simulated = found.simulated()?;
    let statics = match &found.identification.static_only.law {
        ActuatorLaw::StaticPreisach(law) => Some(law),
        _ => None,
    };
    let parts = [
        heading(&format!("Identification: {}", result.title), &verdict(result)),
        what_was_found(result),
        loops::section(found, &simulated, units),
        response::section(result, units),
        spectrum::section(found, &simulated, units[1]),
        density::section(statics, found.identification.density_spread.as_ref(), result, units),
        forc::section(&of_records(&found.records), &forc::none_held(), units),
        models(result),
        parameters(result),
    ];
    Ok(finished(&result.title, &result.dataset, &parts))
}

/// The page of an identification from reversal curves; `result` is what was printed of it.
pub fn curves_page(found: &CurveIdentification, result: &CurvesResult) -> String {
    let units = found.units();
    let none = |class: &str, title: &str, text: &str| titled(class, title, text, &[]);
    let quasi_static = "Reversal curves are quasi-static: they hold no frequency. Record sines at three frequencies or more, in the range of use.";
    let parts = [
        heading(
            &format!("Identification: {}", result.title),
            &format!(
                "Static Preisach model; curves held out are missed by {:.2} % of the range of all outputs, the worst by {:.2} %.",
                result.held_out_rms_percent, result.held_out_worst_percent
            ),
        ),
        titled("found", "What was found", &result.text(), &[]),
        loops::of_curves(found, units),
        none("response", RESPONSE, quasi_static),
        none(
            "spectrum",
            SPECTRUM,
            "Reversal curves carry no times. Record runs with a column of time, several steady cycles each: what differs between them is the noise.",
        ),
        density::of_curves(found.model(), units),
        forc::section(
            found.diagram().ok().as_slice(),
            "The family is too small or too coarse for a diagram: record seven curves at least, their steps as fine as their distances.",
            units,
        ),
        none(
            "models",
            MODELS,
            "Of reversal curves one model is fitted, the static Preisach model. Record runs in time at several frequencies and amplitudes to compare families.",
        ),
        none(
            "parameters",
            PARAMETERS,
            "The model has no parameter but its density. Record runs in time at several frequencies for lags, creep and relaxation.",
        ),
    ];
    finished(&result.title, &result.dataset, &parts)
}

/// Titles of the sections.
const RESPONSE: &str = "Gain and phase over frequency";
const SPECTRUM: &str = "Residual over frequency, beside the noise";
const MODELS: &str = "Models compared";
const PARAMETERS: &str = "Parameters";

/// A whole page of its parts.
fn finished(title: &str, dataset: &str, parts: &[Markup]) -> String {
    let made_by = format!(
        "Made by hhc {} of {dataset}. sd: standard deviation. The numbers of the pictures: hhc identify --figures DIR.",
        crate::VERSION
    );
    page(title, &body(parts, &made_by), &Charts::default())
}

fn verdict(result: &IdentifyResult) -> String {
    let [held_out, _] = result.sides();
    format!("{}, {}. {}: {}.", result.model, result.picked(), held_out.0, held_out.1)
}

/// Sides of the split, gain and range, and what the data cannot tell.
fn what_was_found(result: &IdentifyResult) -> Markup {
    let (low, high) = result.input_range;
    let unit = result.units()[0];
    let mut text = Sheet::default();
    for (label, side) in result.sides() {
        text.line(format_args!("{label}: {side}."));
    }
    text.line(format_args!(
        "Data: {}; range {low} to {high} {unit}, {}.",
        result.dataset, result.range_rule
    ));
    text.line(format_args!("Split: {}.", result.split));
    if result.channels.is_none() {
        text.line(format_args!("Gain: {:.6} deg/um, {}.", result.deg_per_um, result.gain_rule));
    }
    if result.findings.is_empty() {
        text.line("The data raise no remark.");
    }
    for line in &result.findings {
        text.line(format_args!("{:?}: {}\n  {}", line.severity, line.message, line.remedy));
    }
    titled("found", "What was found", &text.finish(), &[])
}

/// The table of models.
fn models(result: &IdentifyResult) -> Markup {
    if result.models.is_empty() {
        let text = "No models were compared: the one above is the only one fitted.";
        return titled("models", MODELS, text, &[]);
    }
    let text = format!(
        "NRMSE in %: rms error over the standard deviation of the measured output. {}",
        result.how_chosen().replace('\n', " ")
    );
    let mut parts = vec![result.models_compared(true).table()];
    let failures = result.not_fitted();
    if !failures.is_empty() {
        parts.push(folded("Not fitted", &report_page::paragraphs(&failures.join("\n"))));
    }
    titled("models", MODELS, &text, &parts)
}

/// Standard deviations on either side of a value in 95 of 100 cases.
const NORMAL_95: f64 = 1.96;

/// The parameters with their intervals.
fn parameters(result: &IdentifyResult) -> Markup {
    use report_page::pictures::{Interval, intervals};
    if result.physical.is_empty() {
        let text = "Models were not compared: parameters are told of a model chosen among others.";
        return titled("parameters", PARAMETERS, text, &[]);
    }
    let all: Vec<Interval> = result
        .physical
        .iter()
        .filter_map(|own| {
            Some(Interval {
                label: format!("{}, {}", own.name, own.unit).trim_end_matches(", ").to_owned(),
                value: own.value,
                ends: own.interval?,
                colour: if own.remark.is_some() { MEASURED } else { MODEL },
                ..Interval::default()
            })
        })
        .collect();
    let values = result.parameters_found().table();
    if all.is_empty() {
        let text = "Values of the model; beside each stands why it has no interval.";
        return titled("parameters", PARAMETERS, text, &[values]);
    }
    let text = "Value and 95 % interval, each on its own axis. Grey: usual values say more of it than the runs, or it is at its bound. One that the runs do not determine is in the table alone.";
    titled("parameters", PARAMETERS, text, &[intervals(&all), values])
}

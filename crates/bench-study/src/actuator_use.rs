//! An actuator at work as text: what its flap did under a voltage, which voltage a wanted motion takes.

use actuator_gap::{ActuatorUse, Deviation, UseSample};
use report_page::{Column, Sheet, csv_of};
use rotor_base::significant;

/// The samples as CSV: time, input, output, and what is beside it.
pub fn samples_csv(own: &ActuatorUse) -> String {
    let [input, output] = &own.columns;
    let word = own.error.as_ref().map(|own| if own.is_wanted { "wanted" } else { "measured" });
    let beside = word.map(|word| format!("{word}_{output}"));
    let mut columns: Vec<Column<'_, UseSample>> = vec![
        ("time_s", &|own| own.time_s.to_string()),
        (input, &|own| own.input.to_string()),
        (output, &|own| own.output.to_string()),
    ];
    if let Some(name) = &beside {
        columns.push((name, &|own| own.beside.unwrap_or_default().to_string()));
    }
    csv_of(own.samples.iter().copied(), &columns)
}

/// Offset over the spread of the motion that is worth a word, percent.
const WORTH_A_WORD: f64 = 5.0;
/// What is left without it, percent of that spread, up to which the motions are alike.
const STILL_ALIKE: f64 = 50.0;

/// Rms error about its mean.
fn without_mean(error: &Deviation) -> f64 {
    (error.rms * error.rms - error.mean * error.mean).max(0.0).sqrt()
}

/// An error, with an exponent where it is next to nothing.
fn told(error: f64) -> String {
    if error.abs() < 1e-4 { format!("{error:.1e}") } else { significant(error, 3).to_string() }
}

/// It for people.
pub fn use_text(own: &ActuatorUse) -> String {
    let mut sheet = Sheet::default();
    let range = |of: fn(&UseSample) -> f64| {
        let all = own.samples.iter().map(of);
        let (low, high) =
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        // rounding beside the other end is a zero
        let least = 1e-9 * low.abs().max(high.abs());
        let shown = |value: f64| if value.abs() < least { 0.0 } else { significant(value, 5) };
        format!("{} to {}", shown(low), shown(high))
    };
    sheet.labelled("Actuator", &own.actuator);
    let (count, step) = (own.samples.len(), significant(own.step_s, 6));
    sheet.labelled("Record", &format!("{}, {count} samples, step {step} s", own.record));
    let named = |at: usize| match &own.read_from[at] {
        Some(source) if *source != own.columns[at] => {
            format!("{}, read from the column `{source}`", own.columns[at])
        }
        _ => own.columns[at].clone(),
    };
    sheet.labelled("Input", &format!("{}: {}", named(0), range(|own| own.input)));
    sheet.labelled("Output", &format!("{}: {}", named(1), range(|own| own.output)));
    if let Some(error) = &own.error {
        let of = if error.is_wanted { "of the wanted" } else { "of the measured" };
        sheet.labelled(
            "Error",
            &format!(
                "rms {}, largest {}; {} % rms of the deviation {of} motion",
                told(error.rms),
                told(error.largest),
                told(error.nrmse_percent)
            ),
        );
    }
    let is_offset = |error: &&Deviation| {
        let [share, rest] = [error.mean.abs() / error.rms, without_mean(error) / error.rms]
            .map(|part| part * error.nrmse_percent);
        share > rest && share > WORTH_A_WORD && rest < STILL_ALIKE
    };
    if let Some(error) = own.error.as_ref().filter(is_offset) {
        let rest = without_mean(error);
        let text = format!(
            "{} of it is an offset, {} rms is left without it: the record has another zero than the runs identified, as of a sensor that was moved",
            told(error.mean),
            told(rest)
        );
        sheet.labelled("Offset", &text);
    }
    for text in &own.suspicions {
        sheet.labelled("Suspect", text);
    }
    if let (Some(at_limit), Some(simulations)) = (own.at_limit, own.simulations) {
        let text = if at_limit == 0 {
            format!("within the range at every sample; {simulations} simulations")
        } else {
            format!(
                "at the end of the range at {at_limit} samples: the motion is out of reach there; ask for less, or shift it"
            )
        };
        sheet.labelled("Voltage", &text);
    }
    sheet.finish()
}

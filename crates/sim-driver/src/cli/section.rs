//! `hhc section`: from options to questions about a section.

use super::args::{ResponseArg, SectionArgs};
use super::say;
use crate::SimError;
use crate::case::DynamicStallChoice;
use crate::files::{refuse_input, write_atomic};
use crate::output::{Printable, print};
use crate::problem::{Fault, Place, Problem};
use crate::section::{
    LoopQuestion, PolarQuestion, SectionChoice, airfoil_table, loop_history, polar,
    section_response, transient_history,
};
use clap::ValueEnum;
use flap_aero::{AeroError, AttachedFlowModel, FlapEffectiveness, Motion};

pub(super) fn section(args: &SectionArgs) -> Result<(), SimError> {
    check_section_options(args)?;
    if let (Some(table), Some(output)) = (&args.table, &args.output) {
        refuse_input(table, output)?;
    }
    let section = SectionChoice {
        model: args.model.unwrap_or(AttachedFlowModel::Calibrated),
        mach: args.mach,
        flap_chord: args.flap_chord.unwrap_or(0.2),
        effectiveness: effectiveness(&args.effectiveness)?,
    };
    let motion = args.motion.unwrap_or(Motion::Flap);
    // the arguments make sure of it where it counts
    let reduced_frequency = args.reduced_frequency.unwrap_or(0.0);
    let mean = args.mean_deg.unwrap_or(0.0).to_radians();
    let half = args.amplitude_deg.unwrap_or(10.0).to_radians();
    let stall = args.stall.and_then(DynamicStallChoice::airfoil);
    let (distance, points) = (args.distance.unwrap_or(20.0), args.points.unwrap_or(200));
    let transient = |rise: f64| transient_history(&section, motion, rise, distance, points);
    let table = match args.response {
        ResponseArg::Harmonic => {
            let result = section_response(&section, motion, reduced_frequency)?;
            write_csv(args, &result.csv(), &result.remarks)?;
            return print(&result.render(args.format)?);
        }
        ResponseArg::Step => transient(0.0)?,
        ResponseArg::Ramp => transient(args.rise.unwrap_or(1.0))?,
        ResponseArg::Loop => loop_history(&LoopQuestion {
            section,
            motion,
            mean_rad: mean,
            amplitude_rad: half,
            reduced_frequency,
            points,
            stall,
            stalls_later_rad: 0.0,
        })?,
        ResponseArg::Polar => polar(&PolarQuestion {
            section,
            incidences_rad: [mean - half, mean + half],
            points,
            stall,
            table: args.table.as_deref().map(airfoil_table).transpose()?,
        })?,
    };
    write_csv(args, &table.csv(), &table.remarks)?;
    print(&table.render(args.format)?)
}

/// Writes the CSV file asked for; what its numbers need said goes to standard error.
fn write_csv(args: &SectionArgs, csv: &str, remarks: &[String]) -> Result<(), SimError> {
    let Some(path) = &args.output else { return Ok(()) };
    // more columns may follow, as with stall
    let second = csv.match_indices(',').nth(1).map_or(csv.len(), |(at, _)| at);
    args.force.holding(Some(path), &csv[..second], "table of hhc")?;
    for remark in remarks {
        say(&format_args!("note: {remark}"));
    }
    Ok(write_atomic(path, csv.as_bytes())?)
}

/// Factors of a flap: none given is theory's.
fn effectiveness(factors: &[f64]) -> Result<FlapEffectiveness, SimError> {
    match factors {
        [] => Ok(FlapEffectiveness::IDEAL),
        [lift, moment, hinge] => Ok(FlapEffectiveness::new(*lift, *moment, *hinge)?),
        _ => Err(AeroError::BadInput {
            quantity: "number of flap effectiveness factors",
            value: factors.len() as f64,
            expected: "three: lift, moment, hinge moment",
        }
        .into()),
    }
}

/// Refuses options that the response asked for would not heed, and numbers that are none.
fn check_section_options(args: &SectionArgs) -> Result<(), SimError> {
    use ResponseArg::{Harmonic, Loop, Polar, Ramp, Step};
    let refused = |name: &str, message: String| {
        let place = Place::file("hhc section").field(name);
        Err(Problem::new(place, Fault::Refused { message }).into())
    };
    let table = args.table.is_some();
    let heeded: [(&str, bool, &[ResponseArg]); 10] = [
        ("--table", table, &[Polar]),
        ("--stall", args.stall.is_some(), &[Loop, Polar]),
        ("--reduced-frequency", args.reduced_frequency.is_some(), &[Harmonic, Loop]),
        ("--distance", args.distance.is_some(), &[Step, Ramp]),
        ("--rise", args.rise.is_some(), &[Ramp]),
        ("--points", args.points.is_some(), &[Step, Ramp, Loop, Polar]),
        ("--mean-deg", args.mean_deg.is_some(), &[Loop, Polar]),
        ("--amplitude-deg", args.amplitude_deg.is_some(), &[Loop, Polar]),
        ("--motion", args.motion.is_some(), &[Harmonic, Step, Ramp, Loop]),
        ("--effectiveness", !args.effectiveness.is_empty(), &[Harmonic, Step, Ramp, Loop]),
    ];
    let unheeded = heeded.iter().find(|(_, given, by)| *given && !by.contains(&args.response));
    if let Some((name, _, by)) = unheeded {
        let values = by.iter().filter_map(ResponseArg::to_possible_value);
        let names: Vec<String> = values.map(|value| value.get_name().to_owned()).collect();
        let names = match names.as_slice() {
            [others @ .., last] if !others.is_empty() => {
                format!("{} or {last}", others.join(", "))
            }
            names => names.concat(),
        };
        return refused(name, format!("it is used with --response {names} only"));
    }
    let own = "a table is a section of its own";
    let beside = [
        ("--stall", args.stall.is_some(), "a table holds its own stall"),
        ("--model", args.model.is_some(), own),
        ("--flap-chord", args.flap_chord.is_some(), own),
    ];
    if let Some((name, _, why)) = beside.into_iter().find(|(_, given, _)| *given && table) {
        return refused(name, format!("it is used without --table: {why}"));
    }
    let numbers = [
        ("--distance", args.distance),
        ("--rise", args.rise),
        ("--mean-deg", args.mean_deg),
        ("--amplitude-deg", args.amplitude_deg),
    ];
    for (name, value) in numbers {
        if let Some(value) = value.filter(|value| !value.is_finite()) {
            return refused(name, format!("it is {value}, not a number to reckon with"));
        }
    }
    Ok(())
}

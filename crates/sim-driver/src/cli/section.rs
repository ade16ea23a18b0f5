//! `hhc section`: from options to questions about a section.

use super::args::{ResponseArg, SectionArgs};
use crate::SimError;
use crate::case::DynamicStallChoice;
use crate::files::{refuse_input, write_atomic};
use crate::output::{Printable, print};
use crate::problem::{Fault, Place, Problem};
use crate::section::{
    LoopQuestion, PolarQuestion, SectionChoice, SectionQuestion, TransientQuestion, loop_history,
    polar, section_response, transient_history,
};
use flap_aero::{AeroError, AttachedFlowModel, FlapEffectiveness, Mach, Motion, StallParameters};

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
    let stall = match args.stall.unwrap_or_default() {
        DynamicStallChoice::Off => None,
        DynamicStallChoice::Naca0012 => Some(StallParameters::naca_0012(Mach::new(args.mach)?)),
    };
    let (distance, points) = (args.distance.unwrap_or(20.0), args.points.unwrap_or(200));
    let transient = |rise: f64| {
        transient_history(&TransientQuestion { section, motion, rise, distance, points })
    };
    let table = match args.response {
        ResponseArg::Harmonic => {
            let result = section_response(&SectionQuestion { section, reduced_frequency, motion })?;
            write_csv(args, &result.csv(), &result.remarks)?;
            return print(&result.render(args.format.format)?);
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
        })?,
        ResponseArg::Polar => polar(&PolarQuestion {
            section,
            incidences_rad: [mean - half, mean + half],
            points,
            stall,
            table: args.table.clone(),
        })?,
    };
    write_csv(args, &table.csv(), &table.remarks)?;
    print(&table.render(args.format.format)?)
}

/// Writes the CSV file asked for; what its numbers need said goes to standard error.
fn write_csv(args: &SectionArgs, csv: &str, remarks: &[String]) -> Result<(), SimError> {
    let Some(path) = &args.output else { return Ok(()) };
    for remark in remarks {
        eprintln!("note: {remark}");
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
    let table = args.table.is_some();
    let moved = "with a response of the section's own flap, not with --response polar";
    let modelled = "without --table: a table is a section of its own";
    let rules = [
        (
            "--table",
            table,
            &[Polar][..],
            "with --response polar only; a rotor takes tables from its case",
        ),
        ("--stall", args.stall.is_some(), &[Loop, Polar], "with --response loop or polar only"),
        (
            "--reduced-frequency",
            args.reduced_frequency.is_some(),
            &[Harmonic, Loop],
            "with --response harmonic or loop only",
        ),
        ("--distance", args.distance.is_some(), &[Step, Ramp], "with --response step or ramp only"),
        ("--rise", args.rise.is_some(), &[Ramp], "with --response ramp only"),
        (
            "--points",
            args.points.is_some(),
            &[Step, Ramp, Loop, Polar],
            "with --response step, ramp, loop or polar only",
        ),
        (
            "--mean-deg",
            args.mean_deg.is_some(),
            &[Loop, Polar],
            "with --response loop or polar only",
        ),
        (
            "--amplitude-deg",
            args.amplitude_deg.is_some(),
            &[Loop, Polar],
            "with --response loop or polar only",
        ),
        (
            "--motion",
            args.motion.is_some(),
            &[Harmonic, Step, Ramp, Loop],
            "with --response harmonic, step, ramp or loop only",
        ),
        ("--effectiveness", !args.effectiveness.is_empty(), &[Harmonic, Step, Ramp, Loop], moved),
    ];
    let unheeded = rules
        .into_iter()
        .find(|(_, given, of, _)| *given && !of.contains(&args.response))
        .map(|(name, .., expected)| (name, expected));
    let beside = [
        ("--stall", args.stall.is_some(), "without --table: a table holds its own stall"),
        ("--model", args.model.is_some(), modelled),
        ("--flap-chord", args.flap_chord.is_some(), modelled),
    ];
    let beside = beside
        .into_iter()
        .find(|(_, given, _)| *given && table)
        .map(|(name, _, expected)| (name, expected));
    let refused = |name: &str, message: String| {
        let place = Place::file("hhc section").field(name);
        Err(Problem::new(place, Fault::Refused { message }).into())
    };
    if let Some((name, expected)) = unheeded.or(beside) {
        return refused(name, format!("it is used {expected}"));
    }
    for (name, value) in [
        ("--distance", args.distance),
        ("--rise", args.rise),
        ("--mean-deg", args.mean_deg),
        ("--amplitude-deg", args.amplitude_deg),
    ] {
        if let Some(value) = value.filter(|value| !value.is_finite()) {
            return refused(name, format!("it is {value}, not a number to reckon with"));
        }
    }
    Ok(())
}

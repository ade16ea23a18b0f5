//! `hhc modes` and `hhc wake`.

use super::args::{ModesArgs, WakeArgs};
use super::{check_advance_ratio, refuse_diverged, refuse_inputs, warn};
use crate::SimError;
use crate::case::{PAPER_CASE, load_case, shipped_case};
use crate::files::{refuse_unwritable, write_atomic};
use crate::output::{Format, Printable, print};
use crate::print::modes::{fan_csv, modes_of_case};
use crate::print::wake::wake_files;
use crate::problem::{Fault, Place, Problems};
use crate::progress::Progress;
use crate::sweep::at_advance_ratio;
use rotor_fem::GyroscopicTerms;
use rotor_study::{AboutState, FAN_SPEEDS, ModesQuestion};

pub(super) fn modes(args: &ModesArgs) -> Result<(), SimError> {
    refuse_inputs(args.case.as_deref(), args.fan.as_ref())?;
    let loaded = match &args.case {
        Some(path) => load_case(path)?,
        None => shipped_case(PAPER_CASE)?,
    };
    let terms =
        if args.no_gyroscopic { GyroscopicTerms::Neglected } else { GyroscopicTerms::Included };
    let about = if args.undeformed { AboutState::Undeformed } else { AboutState::Deflected };
    let speed_ratios = match &args.fan {
        Some(_) if args.speeds.is_empty() => FAN_SPEEDS.to_vec(),
        _ => args.speeds.clone(),
    };
    if !(-90.0..=90.0).contains(&args.pitch_deg) {
        let fault = Fault::OutOfRange {
            value: args.pitch_deg,
            low: -90.0,
            high: 90.0,
            unit: "deg",
            remedy: "the collective at 0.75 R, a finite number",
        };
        let mut problems = Problems::default();
        problems.push(Place::file("--pitch-deg"), fault);
        return Err(problems.into());
    }
    let mut problems = Problems::default();
    for value in speed_ratios.iter().copied().filter(|ratio| !(0.0..=10.0).contains(ratio)) {
        let remedy = "rotor speeds over the nominal one; 0 is a blade at rest";
        let fault = Fault::OutOfRange { value, low: 0.0, high: 10.0, unit: "", remedy };
        problems.push(Place::file("--speeds"), fault);
    }
    problems.into_result(Some(()))?;
    let pitch_rad = args.pitch_deg.to_radians();
    let question = ModesQuestion { terms, pitch_rad, about, speed_ratios };
    let result = modes_of_case(&loaded, &question)?;
    let text = result.render(args.format.format)?;
    if let Some(path) = &args.fan {
        write_atomic(path, fan_csv(&result).as_bytes())?;
    }
    print(&text)
}

pub(super) fn wake(args: &WakeArgs) -> Result<(), SimError> {
    let mut loaded = match &args.case {
        Some(path) => load_case(path)?,
        None => shipped_case(PAPER_CASE)?,
    };
    if let Some(mu) = args.mu {
        let mut problems = Problems::default();
        check_advance_ratio(&mut problems, mu);
        problems.into_result(Some(()))?;
        loaded = at_advance_ratio(&loaded, mu);
    }
    if let Some(folder) = &args.out {
        refuse_unwritable(folder)?;
    }
    let progress = Progress::new(1);
    progress.doing("free wake and trim");
    let outcome = wake_files(&loaded);
    progress.finish();
    let (result, files) = outcome?;
    warn(&result.warnings, Format::Details);
    if let Some(folder) = &args.out {
        for (name, text) in files {
            write_atomic(&folder.join(name), text.as_bytes())?;
        }
    }
    print(&result.render(args.format.format)?)?;
    refuse_diverged(&loaded, result.parted)
}

//! `hhc modes`, `hhc wake` and `hhc root-pitch`.

use super::args::{ModesArgs, RootPitchArgs, WakeArgs};
use super::{
    case_or_paper, check_advance_ratio, check_range, overridden, refuse_inputs, warn, write_texts,
};
use crate::SimError;
use crate::files::{refuse_unwritable, write_atomic};
use crate::output::{Format, Printable, print};
use crate::print::{modes_of_case, root_pitch_of_case, wake_files};
use crate::problem::Problems;
use crate::progress::Progress;
use crate::sweep::at_advance_ratio;
use crate::sweep::refuse_diverged;
use rotor_fem::GyroscopicTerms;
use rotor_study::{AboutState, FAN_SPEEDS, ModesQuestion};
use study_text::fan_csv;

pub(super) fn modes(args: &ModesArgs) -> Result<(), SimError> {
    refuse_inputs(args.case.as_deref(), args.fan.as_ref())?;
    let loaded = case_or_paper(args.case.as_ref())?;
    let terms =
        if args.no_gyroscopic { GyroscopicTerms::Neglected } else { GyroscopicTerms::Included };
    let about = if args.undeformed { AboutState::Undeformed } else { AboutState::Deflected };
    let speed_ratios = match &args.fan {
        Some(_) if args.speeds.is_empty() => FAN_SPEEDS.to_vec(),
        _ => args.speeds.clone(),
    };
    let mut problems = Problems::default();
    let remedy = "the collective at 0.75 R, a finite number";
    check_range(&mut problems, "--pitch-deg", args.pitch_deg, [-90.0, 90.0], "deg", remedy);
    let remedy = "rotor speeds over the nominal one; 0 is a blade at rest";
    for &ratio in &speed_ratios {
        check_range(&mut problems, "--speeds", ratio, [0.0, 10.0], "", remedy);
    }
    problems.into_result(Some(()))?;
    let pitch_rad = args.pitch_deg.to_radians();
    let question = ModesQuestion { terms, pitch_rad, about, speed_ratios };
    let result = modes_of_case(&loaded, &question)?;
    let text = result.render(args.format)?;
    if let Some(path) = &args.fan {
        write_atomic(path, fan_csv(&result).as_bytes())?;
    }
    print(&text)
}

pub(super) fn wake(args: &WakeArgs) -> Result<(), SimError> {
    let mut loaded = case_or_paper(args.case.as_ref())?;
    if let Some(mu) = args.mu {
        let mut problems = Problems::default();
        check_advance_ratio(&mut problems, mu);
        problems.into_result(Some(()))?;
        loaded = at_advance_ratio(&loaded, mu);
    }
    if let Some(folder) = &args.out {
        refuse_unwritable(folder)?;
    }
    let (result, files) = Progress::during("free wake and trim", || wake_files(&loaded))?;
    warn(&result.warnings, Format::Details);
    if let Some(folder) = &args.out {
        write_texts(folder, files)?;
    }
    print(&result.render(args.format)?)?;
    refuse_diverged(&loaded, result.diverged)
}

pub(super) fn root_pitch(args: &RootPitchArgs) -> Result<(), SimError> {
    let loaded = overridden(case_or_paper(args.case.as_ref())?, args.inflow);
    let result = Progress::during("flaps and root pitch", || root_pitch_of_case(&loaded))?;
    print(&result.render(args.format)?)
}

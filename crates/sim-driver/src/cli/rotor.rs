//! `hhc modes`, `hhc wake` and `hhc root-pitch`.

use super::args::{ModesArgs, RootPitchArgs, WakeArgs};
use super::{case_or_paper, moved_to, overridden, refuse_inputs, warn, write_texts};
use crate::SimError;
use crate::case::LoadedCase;
use crate::choices::check_range;
use crate::files::{refuse_unwritable, write_atomic};
use crate::output::{Format, Printable, print};
use crate::print::{modes_of_case, root_pitch_of_case, wake_and_files};
use crate::problem::Problems;
use crate::progress::Progress;
use crate::sweep::refuse_diverged;
use rotor_fem::GyroscopicTerms;
use rotor_flight::{InTimeQuestion, wake_in_time, wake_in_time_csv};
use rotor_study::{AboutState, FAN_SPEEDS, ModesQuestion};
use study_text::fan_csv;
use study_text::known::{IN_TIME_FILES, WAKE_FILES};

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
    let pitch_rad = args.pitch_deg.to_radians();
    let question =
        ModesQuestion { terms, pitch_rad, about, speed_ratios, ..ModesQuestion::default() };
    let result = modes_of_case(&loaded, &question)?;
    let text = result.render(args.format)?;
    if let Some(path) = &args.fan {
        let fan = fan_csv(&result);
        args.force.table(Some(path), &fan)?;
        write_atomic(path, fan.as_bytes())?;
    }
    print(&text)
}

pub(super) fn wake(args: &WakeArgs) -> Result<(), SimError> {
    let loaded = moved_to(case_or_paper(args.case.as_ref())?, args.mu)?;
    if let Some(folder) = &args.out {
        refuse_unwritable(folder)?;
        let files = if args.in_time.is_some() { IN_TIME_FILES } else { WAKE_FILES };
        args.force.files(folder, files)?;
    }
    if let Some(revolutions) = args.in_time {
        return in_time(&loaded, revolutions, args);
    }
    let find = || wake_and_files(&loaded, args.out.is_some());
    let (result, files) = Progress::during("free wake and trim", find)?;
    warn(&result.warnings, Format::Details);
    if let Some(folder) = &args.out {
        args.force.tables(folder, &files, &[])?;
        write_texts(folder, files)?;
    }
    print(&result.render(args.format)?)?;
    refuse_diverged(&loaded, result.diverged)
}

/// Rotor and wake marched in time.
fn in_time(loaded: &LoadedCase, revolutions: usize, args: &WakeArgs) -> Result<(), SimError> {
    let mut problems = Problems::default();
    let remedy = "revolutions to measure, some tens";
    check_range(&mut problems, "--in-time", revolutions as f64, [10.0, 1e5], "", remedy);
    let remedy = "revolutions in which the wake forgets how it began";
    check_range(&mut problems, "--settling", args.settling as f64, [0.0, 1e5], "", remedy);
    problems.into_result(Some(()))?;
    let question = InTimeQuestion { settling: args.settling, revolutions };
    let progress = Progress::new(1 + args.settling + revolutions);
    progress.doing("trim, then rotor and wake in time");
    let found = wake_in_time(&loaded.case, question, &mut |done, _| {
        progress.begin(1 + done, "rotor and wake in time");
    });
    progress.finish();
    let doubts = || loaded.in_words(loaded.case.value_warnings());
    let mut found = found.map_err(|error| loaded.located(error).in_doubt(doubts()))?;
    found.result.warnings.splice(0..0, doubts());
    warn(&found.result.warnings, Format::Details);
    if let Some(folder) = &args.out {
        let history = wake_in_time_csv(&found.history);
        write_texts(folder, vec![("in_time.csv".to_owned(), history)])?;
    }
    print(&found.result.render(args.format)?)
}

pub(super) fn root_pitch(args: &RootPitchArgs) -> Result<(), SimError> {
    let loaded = overridden(case_or_paper(args.case.as_ref())?, args.inflow);
    let result = Progress::during("flaps and root pitch", || root_pitch_of_case(&loaded))?;
    print(&result.render(args.format)?)
}

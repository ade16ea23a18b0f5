//! `hhc diagnose` and `hhc ladder`.

use super::args::{DiagnoseArgs, LadderArgs, RecordsArgs};
use super::{case_or_paper, overridden, say, warn, write_texts};
use crate::SimError;
use crate::actuator::case_actuators;
use crate::case::{LoadedCase, load_case, with_actuator_file};
use crate::diagnose::{
    CasePoints, Climb, Diagnosis, Findings, KeptStructures, PAGE_FILE, PlanText, Planned,
    PointDiagnosis, PointStory, Question, Record, Records, Specimens, Stage, Story, bench_page,
    both, climb, extended, model_or_case, plan, points_of, records_of, usual_runs,
};
use crate::files::{Folder, SweepData, distinct_names, refuse_input, ron_text, write_atomic};
use crate::output::{Format, Printable, json, print};
use crate::problem::{Fault, Place, Problem};
use crate::progress::Progress;
use bench_study::stored::write_actuator;
use measured_data::Accuracy;
use rotor_gap::{TableData, read_table};
use std::path::{Path, PathBuf};
use study_text::known::{DIAGNOSIS_FILES, LADDER_FILES, PLAN_FILES, SPECIMENS_FILES};

/// Name of the actuator a diagnosis extended.
const EXTENDED_FILE: &str = "extended.ron";
/// Name of the case given to a diagnosis, with that actuator.
const EXTENDED_CASE_FILE: &str = "extended_case.ron";

pub(super) fn diagnose(args: &DiagnoseArgs) -> Result<(), SimError> {
    let form = args.records.format.form();
    if let Some(table) = &args.table {
        return tabled(args, table);
    }
    let (Some(model), Some(output)) = (&args.model, &args.output) else {
        return planned(args);
    };
    if let [data] = &args.data[..]
        && let Some(sweep) = points_of(data)?
    {
        return of_points(args, model, &sweep, output);
    }
    let store = KeptStructures::at(args.records.cache.as_deref());
    if let [data] = &args.data[..] {
        return print(&Story::of(&found_in(args, (model, data), output, &store)?).render(form)?);
    }
    let names = distinct_names(&args.data)?;
    args.records.force.files(output, SPECIMENS_FILES)?;
    if args.records.reference.is_some() {
        say(&format_args!(
            "warning: one --reference for several specimens: how they differ from each other is found as a cause"
        ));
    }
    let mut found = Vec::new();
    for (name, data) in names.into_iter().zip(&args.data) {
        let own = found_in(args, (model, data), &output.join(&name), &store)?;
        found.push((name, own));
    }
    let specimens = Specimens::of(&found);
    write_atomic(&output.join("specimens.json"), json(&specimens)?.as_bytes())?;
    print(&specimens.render(form)?)
}

/// Says what the simulation of a case lacks, from points of test.
fn of_points(
    args: &DiagnoseArgs,
    case: &Path,
    sweep: &SweepData,
    output: &Path,
) -> Result<(), SimError> {
    let form = args.records.format.form();
    args.records.force.files(output, DIAGNOSIS_FILES)?;
    let case = load_case(case)?;
    warn(&sweep.warnings, form);
    let progress = Progress::new(DIAGNOSIS);
    let begun = |percent: usize, what: &str| progress.begin(DIAGNOSIS * percent / 100, what);
    let found = CasePoints::of(&case, sweep, &args.only, &begun);
    progress.finish();
    let found = found?;
    write_texts(output, found.files()?)?;
    for note in &found.diagnosis.notes {
        say(note);
    }
    print(&PointStory::of(&found.diagnosis).render(form)?)
}

/// Says what anyone's simulator lacks, from tables of it.
fn tabled(args: &DiagnoseArgs, folder: &Path) -> Result<(), SimError> {
    let form = args.records.format.form();
    if let Some(output) = &args.output {
        args.records.force.files(output, DIAGNOSIS_FILES)?;
    }
    let read = read_table(&Folder::Disk(folder.to_path_buf()))?;
    warn(&read.warnings, form);
    let TableData { title, folder, table, .. } = read;
    let found = PointDiagnosis::of((title, &folder), "EffectTable", table, &args.only)?;
    if let Some(output) = &args.output {
        write_texts(output, found.files()?)?;
    }
    print(&PointStory::of(&found).render(form)?)
}

/// Says what runs would show of an actuator, before they are measured.
fn planned(args: &DiagnoseArgs) -> Result<(), SimError> {
    let Some(path) = &args.plan else { return Ok(()) };
    if let Some(output) = &args.output {
        args.records.force.files(output, PLAN_FILES)?;
    }
    let refused = |file: &Path, message: &str| {
        let fault = Fault::Refused { message: message.to_owned() };
        Err(Problem::new(Place::file(file.display().to_string()), fault).into())
    };
    let model = match model_or_case(path)? {
        (Some(model), _) => Some(model),
        (None, case) => {
            case.map(|case| case_actuators(&case)).transpose()?.and_then(|own| own.real)
        }
    };
    let Some(model) = model else {
        return refused(
            path,
            "its actuator is ideal: give an actuator file, or a case with a bench",
        );
    };
    let usual = || usual_runs((model.range_volt.lowest_volt(), model.range_volt.highest_volt()));
    let (runs, accuracy) = match &args.runs {
        Some(folder) => {
            let (records, warnings) = records_of(folder)?;
            warn(&warnings, Format::Text);
            if !records.is_bench {
                return refused(folder, "a plan is of the runs of an actuator bench");
            }
            (records.runs, records.accuracy)
        }
        None => (usual(), Accuracy::default()),
    };
    let progress = Progress::new(DIAGNOSIS);
    let told = |done: usize, all: usize| {
        progress.begin(DIAGNOSIS * done / all, "each cause is put in and diagnosed");
    };
    told(0, 1);
    let store = KeptStructures::at(args.records.cache.as_deref());
    let planned = Planned { runs: &runs, accuracy, only: &args.only };
    let found = plan(&model, &planned, &path.display().to_string(), &store, &told);
    progress.finish();
    let text = PlanText(found?);
    if let Some(output) = &args.output {
        write_atomic(&output.join("plan.json"), json(&text)?.as_bytes())?;
    }
    print(&text.render(args.records.format.form())?)
}

/// Diagnoses the data of one specimen and writes what is found to a folder.
fn found_in(
    args: &DiagnoseArgs,
    (model, data): (&Path, &Path),
    output: &Path,
    store: &KeptStructures<'_>,
) -> Result<Diagnosis, SimError> {
    refuse_input(model, &output.join(EXTENDED_FILE))?;
    let force = args.records.force;
    force.files(output, DIAGNOSIS_FILES)?;
    force.actuator(&output.join(EXTENDED_FILE))?;
    let (model, case) = model_or_case(model)?;
    let (measured, reference) = both_records(data, &args.records)?;
    let progress = Progress::new(DIAGNOSIS);
    let question = Question {
        reference,
        only: args.only.clone(),
        cache: Some(store),
        given: model.as_ref(),
        begun: Some(&|stage| begin(&progress, stage)),
    };
    let found = crate::diagnose::diagnose(&measured, &question);
    progress.finish();
    let found = found?;
    let findings = json(&Findings::from(&found))?;
    let tables = found.figures();
    let read: Vec<&Path> =
        args.records.reference.iter().map(PathBuf::as_path).chain([data]).collect();
    force.tables(output, &tables, &read)?;
    write_actuator(&extended(&found)?, &output.join(EXTENDED_FILE))?;
    if let Some(case) = case {
        write_extended_case(&case, output)?;
    }
    write_texts(output, tables)?;
    write_atomic(&output.join("findings.json"), findings.as_bytes())?;
    write_atomic(&output.join(PAGE_FILE), bench_page(&found).as_bytes())?;
    Ok(found)
}

/// Steps of the progress of a diagnosis, about percent of its time.
const DIAGNOSIS: usize = 100;
/// Steps of the rungs of a ladder beside it.
const RUNGS: usize = 3;

/// Says what a diagnosis begins, and the share of its time that has gone by then.
fn begin(progress: &Progress, stage: Stage) {
    match stage {
        Stage::BaseModel => progress.begin(0, "base model"),
        Stage::Surrogates => progress.begin(2, "surrogates with nothing missing"),
        Stage::Search => progress.begin(10, "search for what is missing"),
        Stage::NextExperiment => progress.begin(95, "next experiment"),
    }
}

pub(super) fn ladder(args: &LadderArgs) -> Result<(), SimError> {
    let (RecordsArgs { cache, format, force, .. }, output) = (&args.records, &args.output);
    force.files(output, LADDER_FILES)?;
    force.actuator(&output.join(EXTENDED_FILE))?;
    let (measured, reference) = both_records(&args.data, &args.records)?;
    let loaded = overridden(case_or_paper(args.case.as_ref())?, args.inflow);
    let progress = Progress::new(DIAGNOSIS + RUNGS);
    let climbed = climb(&measured, &reference, &loaded, cache.as_deref(), &|climb| match climb {
        Climb::Diagnosis(stage) => begin(&progress, stage),
        Climb::Rung(rung) => progress.begin(DIAGNOSIS + rung, "vibration with each model"),
    });
    progress.finish();
    let (ladder, found) = climbed?;
    let text = json(&ladder)?;
    write_actuator(&extended(&found)?, &output.join(EXTENDED_FILE))?;
    write_atomic(&output.join("ladder.json"), text.as_bytes())?;
    print(&ladder.render(format.form())?)
}

/// The runs to be explained and those that show the system as it is; what is said of both is printed.
fn both_records(data: &Path, args: &RecordsArgs) -> Result<(Records, Vec<Record>), SimError> {
    let given = both(data, args.reference.as_deref())?;
    warn(&given.warnings, Format::Text);
    Ok((given.measured, given.reference))
}

/// Writes a case with the extended actuator beside it, where no other file is named in it: their paths would
/// lead elsewhere.
fn write_extended_case(case: &LoadedCase, output: &Path) -> Result<(), SimError> {
    let extended = output.join(EXTENDED_FILE);
    let folder = Folder::of_file(&extended);
    let Ok(own) = with_actuator_file(case, &extended, &folder) else {
        say(&format_args!(
            "warning: no {EXTENDED_CASE_FILE}: the case names files beside it; name {} as its actuator",
            extended.display()
        ));
        return Ok(());
    };
    let path = output.join(EXTENDED_CASE_FILE);
    let text = ron_text(&own.case).map_err(|e| SimError::not_written(&path, &e))?;
    Ok(write_atomic(&path, text.as_bytes())?)
}

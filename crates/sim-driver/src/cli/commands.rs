//! What each command does.

use super::args::{
    CheckArgs, DiagnoseArgs, IdentifyArgs, ImportArgs, InflowOverride, InitArgs, LadderArgs,
    ModesArgs, RecordsArgs, ReportArgs, RunArgs, StudyArgs, WakeArgs,
};
use crate::SimError;
use crate::actuator::case_actuators;
use crate::blade_loads::blade_loads_csv;
use crate::case::{
    InflowChoice, LoadedCase, PAPER_CASE, load_case, shipped_case, with_actuator_file,
};
use crate::check::check_file;
use crate::curve_identification::identify_curves;
use crate::diagnose::{Findings, Question, Record, Records, Story, climb};
use crate::figures::figure_files;
use crate::files::{
    DataSet, Folder, SHIPPED_CASES, Source, read_dataset, refuse_input, refuse_inside,
    refuse_unwritable, ron_text, write_atomic, write_new,
};
use crate::identification::{BenchIdentification, identify_bench, identify_loops};
use crate::import::{ColumnOptions, ImportRequest, default_folder};
use crate::modes::{AboutState, FAN_SPEEDS, ModesQuestion, fan_csv, rotating_modes};
use crate::output::{Format, Printable, print};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::progress::Progress;
use crate::recompute::{RESULT_FILE, STUDY_FILE, changed, compared_table, reproduced};
use crate::report::{StudyReport, report_html};
use crate::results::{RunResult, StoredResult};
use crate::run::{RunOutcome, run_case, run_trimmed, steps_of};
use crate::stored_actuator::{StoredActuator, read_actuator};
use crate::study::{
    Assumptions, histories_csv, page_part, robustness_csv, robustness_maps, sensitivities,
    sensitivity_csv, study_report,
};
use crate::sweep::{SweepResult, SweepRow, at_advance_ratio, continued_trim, sweep_csv};
use crate::wake::wake_of_case;
use preisach_dyn::ActuatorModel;
use preisach_dyn::identify::Settings;
use rotor_fem::GyroscopicTerms;
use std::path::{Path, PathBuf};
use trim::TrimSolution;

/// Name of the report.
const REPORT_FILE: &str = "report.html";
/// Name of the flap and voltage histories.
const HISTORIES_FILE: &str = "histories.csv";
const BLADE_LOADS_FILE: &str = "blade_loads.csv";
/// Name of the sensitivities.
const SENSITIVITY_FILE: &str = "sensitivity.csv";
/// Name of the robustness maps.
const ROBUSTNESS_FILE: &str = "robustness.csv";
/// Name of the table over advance ratios.
const SWEEP_FILE: &str = "sweep.csv";
/// Name of the actuator a diagnosis extended.
const EXTENDED_FILE: &str = "extended.ron";
/// Name of the case given to a diagnosis, with that actuator.
const EXTENDED_CASE_FILE: &str = "extended_case.ron";

pub(super) fn study(args: &StudyArgs) -> Result<(), SimError> {
    let loaded = overridden(shipped_case(PAPER_CASE)?, Some(args.inflow));
    run_and_store(
        &loaded,
        &args.out,
        args.format.format,
        Scope { sensitivity: Some(Assumptions::WithoutWake), robustness: false },
    )
}

pub(super) fn run(args: &RunArgs) -> Result<(), SimError> {
    let loaded = overridden(load_case(&args.case)?, args.inflow);
    let out = args.out.clone().unwrap_or_else(|| {
        let stem = args.case.file_stem().map(PathBuf::from).unwrap_or_default();
        Path::new("out").join(stem)
    });
    let sensitivity = args.sensitivity.then_some(Assumptions::WithWake);
    let scope = Scope { sensitivity, robustness: args.robustness };
    if args.mu.is_empty() {
        return run_and_store(&loaded, &out, args.format.format, scope);
    }
    run_sweep(&loaded, &args.mu, &out, (args.format.format, scope))
}

/// Name of the folder of the results at an advance ratio.
fn sweep_folder(advance_ratio: f64) -> String {
    format!("mu_{advance_ratio}")
}

/// Whether the rotor can fly at an advance ratio of the command line.
fn check_advance_ratio(problems: &mut Problems, mu: f64) {
    if !(0.0..=0.5).contains(&mu) {
        let remedy = "the attached-flow rotor model ends at 0.5; 0 is hover";
        let fault = Fault::OutOfRange { value: mu, low: 0.0, high: 0.5, unit: "", remedy };
        problems.push(Place::file("--mu"), fault);
    }
}

fn run_sweep(
    loaded: &LoadedCase,
    advance_ratios: &[f64],
    out: &Path,
    (format, scope): (Format, Scope),
) -> Result<(), SimError> {
    let mut problems = Problems::default();
    for (i, &mu) in advance_ratios.iter().enumerate() {
        let place = || Place::file("--mu");
        check_advance_ratio(&mut problems, mu);
        if advance_ratios[..i].iter().any(|before| sweep_folder(*before) == sweep_folder(mu)) {
            let message = format!("{mu} is given twice; give every advance ratio once");
            problems.push(place(), Fault::Refused { message });
        }
    }
    problems.into_result(Some(()))?;
    refuse_unwritable(out)?;
    let mut rows = Vec::new();
    let ended = sweep_into(&mut rows, loaded, advance_ratios, out, scope);
    // what was found before an advance ratio that fails is of use
    if !rows.is_empty() {
        let sweep = SweepResult { rows };
        write_atomic(&out.join(SWEEP_FILE), sweep_csv(&sweep).as_bytes())?;
        match format {
            Format::Json => print(&sweep.render(format)?)?,
            Format::Text => print(&format!(
                "{}\nResults in {}, a folder for each advance ratio\n",
                sweep.render(format)?,
                out.display()
            ))?,
        }
    }
    ended
}

/// Runs the advance ratios, each from the one before, up to the first that fails.
fn sweep_into(
    rows: &mut Vec<SweepRow>,
    loaded: &LoadedCase,
    advance_ratios: &[f64],
    out: &Path,
    scope: Scope,
) -> Result<(), SimError> {
    let actuators = case_actuators(loaded)?;
    let mut start: Option<TrimSolution> = None;
    // a wake that parted does not keep the others from being found
    let mut ended = Ok(());
    for &mu in advance_ratios {
        let here = at_advance_ratio(loaded, mu);
        let more = scope.sensitivity.map_or(0, |which| which.rows(&here));
        let progress = Progress::new(steps_of(&here) + more);
        progress.doing(format!("advance ratio {mu}"));
        let computed = continued_trim(&here, start.as_ref()).and_then(|trimmed| {
            run_trimmed(&here, actuators.clone(), trimmed, &progress)
                .and_then(|outcome| with_scope(&here, outcome, scope, &progress))
        });
        progress.finish();
        let computed = computed.inspect_err(|_| note_earlier(&out.join(sweep_folder(mu))));
        let outcome = computed.map_err(|source| SimError::SweepEnded {
            advance_ratio: mu,
            found: rows.iter().map(|row| row.advance_ratio).collect(),
            source: Box::new(source),
        })?;
        start = Some(outcome.trimmed.trim().clone());
        store(&here, &out.join(sweep_folder(mu)), &outcome)?;
        if outcome.trimmed.wake_parted() && ended.is_ok() {
            ended = refuse_parted(&here, true).map_err(|source| SimError::SweepEnded {
                advance_ratio: mu,
                found: Vec::new(),
                source: Box::new(source),
            });
        }
        rows.push(SweepRow { advance_ratio: mu, result: outcome.result });
    }
    ended
}

/// What is computed beside the case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
struct Scope {
    sensitivity: Option<Assumptions>,
    robustness: bool,
}

/// The outcome with what is computed beside the case.
fn with_scope(
    loaded: &LoadedCase,
    mut outcome: RunOutcome,
    scope: Scope,
    progress: &Progress,
) -> Result<RunOutcome, SimError> {
    if let Some(which) = scope.sensitivity {
        progress.doing("sensitivity");
        let done = || progress.step();
        let rotor = (&outcome.trimmed, &outcome.drives);
        outcome.result.sensitivity = sensitivities(loaded, rotor, which, &done)?;
    }
    if scope.robustness {
        progress.doing("robustness");
        outcome.result.robustness = robustness_maps(loaded, &outcome)?;
    }
    Ok(outcome)
}

/// Writes everything a run leaves behind; its report.
fn store(loaded: &LoadedCase, out: &Path, outcome: &RunOutcome) -> Result<StudyReport, SimError> {
    let result = &outcome.result;
    for warning in &result.warnings {
        eprintln!("warning: {warning}");
    }
    let inputs = outcome.actuators.inputs.clone();
    let page = page_part(loaded, outcome)?;
    let mut stored = StoredResult::new(&loaded.file, inputs, result.clone())?;
    stored.page_key = Some(page.key()?);
    let blade_loads = blade_loads_csv(&outcome.blade_loads, &loaded.case.scales);
    stored.blade_loads_key = Some(blade_loads_key(result, &blade_loads)?);
    let report = study_report(&stored, page);
    for (name, text) in tables(&stored) {
        write_atomic(&out.join(name), text.as_bytes())?;
    }
    stored.write(&out.join(RESULT_FILE))?;
    write_atomic(&out.join(BLADE_LOADS_FILE), blade_loads.as_bytes())?;
    let numbers = serde_json::to_string(&report)
        .map_err(|e| SimError::NotWritten { path: out.join(STUDY_FILE), reason: e.to_string() })?;
    write_atomic(&out.join(STUDY_FILE), numbers.as_bytes())?;
    write_atomic(&out.join(REPORT_FILE), report_html(&report).as_bytes())?;
    Ok(report)
}

/// blake3 of the loads of the blade in a result and in their table.
fn blade_loads_key(result: &RunResult, table: &str) -> Result<String, SimError> {
    let lines = serde_json::to_string(&result.blade_loads)
        .map_err(|e| SimError::NotWritten { path: RESULT_FILE.into(), reason: e.to_string() })?;
    let mut hash = blake3::Hasher::new();
    hash.update(lines.as_bytes()).update(table.as_bytes());
    Ok(hash.finalize().to_hex().to_string())
}

/// The tables that a stored result gives, by file name.
fn tables(stored: &StoredResult<RunResult>) -> Vec<(&'static str, String)> {
    let result = &stored.result;
    let mut files = vec![(HISTORIES_FILE, histories_csv(&result.control))];
    if !result.sensitivity.is_empty() {
        let harmonics = &stored.case.control.harmonics;
        files.push((SENSITIVITY_FILE, sensitivity_csv(harmonics, &result.sensitivity)));
    }
    if !result.robustness.is_empty() {
        files.push((ROBUSTNESS_FILE, robustness_csv(&result.robustness)));
    }
    files
}

fn run_and_store(
    loaded: &LoadedCase,
    out: &Path,
    format: Format,
    scope: Scope,
) -> Result<(), SimError> {
    refuse_unwritable(out)?;
    let more = scope.sensitivity.map_or(0, |which| which.rows(loaded));
    let progress = Progress::new(steps_of(loaded) + more);
    let computed = run_case(loaded, &progress)
        .and_then(|outcome| with_scope(loaded, outcome, scope, &progress));
    progress.finish();
    let outcome = computed.inspect_err(|_| note_earlier(out))?;
    let report = store(loaded, out, &outcome)?;
    let result = &outcome.result;
    match format {
        Format::Json => print(&result.render(format)?),
        Format::Text => {
            let text = result.render(format)? + &report.text();
            print(&format!("{text}\nResults, histories and report in {}\n", out.display()))
        }
    }?;
    refuse_parted(loaded, outcome.trimmed.wake_parted())
}

/// Ends a command in failure, after what it found is stored and shown, if that is no solution.
fn refuse_parted(loaded: &LoadedCase, parted: bool) -> Result<(), SimError> {
    if parted {
        return Err(SimError::WakeParted { place: loaded.index.place("inflow.model") });
    }
    Ok(())
}

/// Says of a run that failed that the results in its folder are not its own.
fn note_earlier(out: &Path) {
    if out.join(RESULT_FILE).is_file() {
        eprintln!("note: the results in {} are of an earlier run", out.display());
    }
}

/// The case in another inflow; a case with a free wake keeps its own where one is asked for.
fn overridden(mut loaded: LoadedCase, inflow: Option<InflowOverride>) -> LoadedCase {
    let has_one = matches!(loaded.case.inflow, InflowChoice::FreeWake(_));
    if let Some(inflow) = inflow.filter(|i| !(has_one && *i == InflowOverride::Free)) {
        loaded.case.inflow = inflow.into();
        loaded.file.inflow.model = inflow.into();
    }
    loaded
}

pub(super) fn identify(args: &IdentifyArgs) -> Result<(), SimError> {
    let base = match &args.start {
        Some(path) => read_actuator(&Source::read(path)?)?.settings,
        None => Settings::default(),
    };
    refuse_inside(&args.bench, &args.output)?;
    refuse_inputs(args.start.as_deref(), Some(&args.output))?;
    let data = read_dataset(&Folder::Disk(args.bench.clone()))?;
    for warning in data.warnings() {
        eprintln!("warning: {warning}");
    }
    let progress = Progress::new(1);
    progress.doing(format!("identifying from {} runs", data.run_count()));
    let written = Some(args.output.display().to_string());
    let (stored, text, figures) = match &data {
        DataSet::Curves(curves) => {
            let found = identify_curves(curves);
            progress.finish();
            let found = found?;
            let figures = args.figures.as_ref().map(|_| found.figure_files()).transpose()?;
            (found.stored(), found.summary(written).render(args.format.format)?, figures)
        }
        DataSet::Bench(bench) => {
            record_files(&compared(identify_bench(bench, &base), args, &progress)?, written, args)?
        }
        DataSet::Loops(loops) => {
            record_files(&compared(identify_loops(loops, &base), args, &progress)?, written, args)?
        }
    };
    stored.write(&args.output)?;
    if let (Some(folder), Some(figures)) = (&args.figures, figures) {
        for (name, text) in figures {
            write_atomic(&folder.join(name), text.as_bytes())?;
        }
    }
    print(&text)
}

pub(super) fn diagnose(args: &DiagnoseArgs) -> Result<(), SimError> {
    let RecordsArgs { output, cache, format, .. } = &args.records;
    refuse_input(&args.model, &output.join(EXTENDED_FILE))?;
    let (model, case) = given_model(&args.model)?;
    let (measured, reference) = both_records(&args.records)?;
    let progress = Progress::new(1);
    progress.doing(format!("diagnosing {} runs", measured.runs.len()));
    let question =
        Question { reference, only: args.only.clone(), cache: Some(cache), given: model.as_ref() };
    let found = crate::diagnose::diagnose(&measured, &question);
    progress.finish();
    let found = found?;
    let findings = serde_json::to_string_pretty(&Findings::from(&found)).map_err(|e| {
        SimError::NotWritten { path: "findings.json".into(), reason: e.to_string() }
    })?;
    found.extended()?.write(&output.join(EXTENDED_FILE))?;
    if let Some(case) = case {
        write_extended_case(&case, output)?;
    }
    for (name, text) in found.figures() {
        write_atomic(&output.join(name), text.as_bytes())?;
    }
    write_atomic(&output.join("findings.json"), (findings + "\n").as_bytes())?;
    print(&Story::of(&found).render(format.format)?)
}

pub(super) fn ladder(args: &LadderArgs) -> Result<(), SimError> {
    let RecordsArgs { output, cache, format, .. } = &args.records;
    let (measured, reference) = both_records(&args.records)?;
    let loaded = match &args.case {
        Some(path) => load_case(path)?,
        None => shipped_case(PAPER_CASE)?,
    };
    let loaded = overridden(loaded, args.inflow);
    let progress = Progress::new(1);
    progress.doing(format!("climbing on {} runs", measured.runs.len()));
    let climbed = climb(&measured, &reference, &loaded, Some(cache));
    progress.finish();
    let (ladder, found) = climbed?;
    let text = serde_json::to_string_pretty(&ladder)
        .map_err(|e| SimError::NotWritten { path: "ladder.json".into(), reason: e.to_string() })?;
    found.extended()?.write(&output.join(EXTENDED_FILE))?;
    write_atomic(&output.join("ladder.json"), (text + "\n").as_bytes())?;
    print(&ladder.render(format.format)?)
}

/// The runs to be explained and those that show the system as it is.
fn both_records(args: &RecordsArgs) -> Result<(Records, Vec<Record>), SimError> {
    let measured = records_of(&args.data)?;
    let reference = reference_runs(args.reference.as_deref(), &args.data, &measured)?;
    Ok((measured, reference))
}

/// The model of an actuator file; or the case.
fn given_model(path: &Path) -> Result<(Option<ActuatorModel>, Option<LoadedCase>), SimError> {
    let source = Source::read(path)?;
    match read_actuator(&source) {
        Ok(stored) => Ok((Some(stored.model), None)),
        Err(problems) if source.text.contains("kind: Actuator") => Err(problems.into()),
        Err(_) => Ok((None, Some(load_case(path)?))),
    }
}

/// Writes a case with the extended actuator beside it, where no other file is named in it: their paths would
/// lead elsewhere.
fn write_extended_case(case: &LoadedCase, output: &Path) -> Result<(), SimError> {
    let extended = output.join(EXTENDED_FILE);
    let folder = Folder::of_file(&extended);
    let Ok(own) = with_actuator_file(&case.file, &case.index, &extended, &folder) else {
        eprintln!(
            "warning: no {EXTENDED_CASE_FILE}: the case names files beside it; name {} as its actuator",
            extended.display()
        );
        return Ok(());
    };
    let path = output.join(EXTENDED_CASE_FILE);
    let text = ron_text(&own.file)
        .map_err(|e| SimError::NotWritten { path: path.clone(), reason: e.to_string() })?;
    write_atomic(&path, text.as_bytes())
}

fn records_of(folder: &Path) -> Result<Records, SimError> {
    let data = read_dataset(&Folder::Disk(folder.to_path_buf()))?;
    for warning in data.warnings() {
        eprintln!("warning: {warning}");
    }
    match &data {
        DataSet::Bench(bench) => Ok(bench.into()),
        DataSet::Loops(loops) => Ok(loops.into()),
        DataSet::Curves(curves) => {
            let place = Place::file(format!("{}/dataset.ron", curves.folder)).field("kind");
            let message =
                "reversal curves hold no time: nothing dynamic can be diagnosed from them; \
                           give an ActuatorBench or a GenericLoop"
                    .to_owned();
            Err(Problem::new(place, Fault::Refused { message }).into())
        }
    }
}

/// Reference runs: of the folder given, else those of the data, else of `../reference`. A folder in which no
/// run has a role is one of reference runs.
fn reference_runs(
    given: Option<&Path>,
    data: &Path,
    measured: &Records,
) -> Result<Vec<Record>, SimError> {
    let folder = match given {
        Some(folder) => folder.to_path_buf(),
        None if measured.runs.iter().any(|run| run.is_reference) => return Ok(Vec::new()),
        None => data.join("../reference"),
    };
    if given.is_none() && !folder.join("dataset.ron").is_file() {
        return Ok(Vec::new());
    }
    let found = records_of(&folder)?;
    if found.content_hash == measured.content_hash {
        let place = Place::file(format!("{}/dataset.ron", folder.display()));
        let message = "these are the measured runs themselves: reference runs show the actuator with nothing missing; \
             give their folder, or none"
            .to_owned();
        return Err(Problem::new(place, Fault::Refused { message }).into());
    }
    let mut runs = found.runs;
    if runs.iter().any(|run| run.is_reference) {
        runs.retain(|run| run.is_reference);
    }
    for run in &mut runs {
        run.is_reference = true;
    }
    Ok(runs)
}

/// Model file, printed text and tables of the figures.
type IdentifiedFiles = (StoredActuator, String, Option<Vec<(String, String)>>);

fn record_files(
    found: &BenchIdentification,
    written: Option<String>,
    args: &IdentifyArgs,
) -> Result<IdentifiedFiles, SimError> {
    let figures = args.figures.as_ref().map(|_| figure_files(found)).transpose()?;
    Ok((found.stored(), found.summary(written).render(args.format.format)?, figures))
}

/// The identification with the table of all models and the one that is wanted in place.
fn compared(
    found: Result<BenchIdentification, SimError>,
    args: &IdentifyArgs,
    progress: &Progress,
) -> Result<BenchIdentification, SimError> {
    progress.doing("comparing all models".to_owned());
    let found = found.and_then(|mut found| {
        found.compare()?;
        found.pick(args.model)?;
        Ok(found)
    });
    progress.finish();
    found
}

pub(super) fn import(args: &ImportArgs) -> Result<(), SimError> {
    let first = args.files.first().map_or(Path::new("data"), PathBuf::as_path);
    let request = ImportRequest {
        files: args.files.clone(),
        out: args.out.clone().unwrap_or_else(|| default_folder(first)),
        source: args.source,
        kind: args.kind,
        columns: ColumnOptions {
            columns: args.columns.clone(),
            input: args.input.clone(),
            response: args.response.clone(),
            convert: args.convert.clone(),
        },
        variable: args.variable.clone(),
        range: args.range,
        sampling_hz: args.sampling_hz,
        reduce_to_hz: args.reduce_to_hz,
        most_samples: args.max_samples,
        title: args.title.clone(),
    };
    let result = crate::import::import(&request)?;
    for warning in &result.warnings {
        eprintln!("warning: {warning}");
    }
    print(&result.render(args.format.format)?)
}

/// Refuses to write to a file that is read, where both are given.
fn refuse_inputs(read: Option<&Path>, written: Option<&PathBuf>) -> Result<(), SimError> {
    read.zip(written).map_or(Ok(()), |(read, written)| refuse_input(read, written))
}

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
    let result = rotating_modes(&loaded, &question)?;
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
        loaded.case.advance_ratio = mu;
        loaded.file.advance_ratio = mu;
    }
    if let Some(folder) = &args.out {
        refuse_unwritable(folder)?;
    }
    let progress = Progress::new(1);
    progress.doing("free wake and trim");
    let outcome = wake_of_case(&loaded);
    progress.finish();
    let (result, files) = outcome?;
    for warning in &result.warnings {
        eprintln!("warning: {warning}");
    }
    if let Some(folder) = &args.out {
        for (name, text) in files {
            write_atomic(&folder.join(name), text.as_bytes())?;
        }
    }
    print(&result.render(args.format.format)?)?;
    refuse_parted(&loaded, result.parted)
}

pub(super) fn check(args: &CheckArgs) -> Result<(), SimError> {
    let result = check_file(&args.file)?;
    for warning in &result.warnings {
        eprintln!("warning: {warning}");
    }
    print(&result.render(args.format.format)?)
}

pub(super) fn init(args: &InitArgs) -> Result<(), SimError> {
    let text = starting_case()?;
    write_new(&args.file, text.as_bytes())?;
    print(&format!(
        "{0} written: the paper's case, every field commented. Edit it, then `hhc check {0}` and `hhc run {0}`.\n",
        args.file.display()
    ))
}

/// The shipped paper case with its data set named so that it is found from any folder.
fn starting_case() -> Result<String, Problem> {
    let text = Folder::Shipped(SHIPPED_CASES.to_owned()).read(PAPER_CASE)?.text;
    Ok(text.replace("../bench/apa500l_synthetic", "shipped:apa500l_synthetic"))
}

pub(super) fn report(args: &ReportArgs) -> Result<(), SimError> {
    let shown: StudyReport = json_of(&args.dir.join(STUDY_FILE))?;
    let stored: StoredResult<RunResult> = json_of(&args.dir.join(RESULT_FILE))?;
    let (checked, report) = reproduced(&shown, stored)?;
    let key = checked.stored.blade_loads_key.clone().unwrap_or_default();
    let table = Source::read(&args.dir.join(BLADE_LOADS_FILE))?;
    let found = blade_loads_key(&checked.stored.result, &table.text)?;
    if key != found {
        let (stored, anew) = (format!("of key {found}"), format!("key {key}"));
        return Err(changed(BLADE_LOADS_FILE, "table or blade_loads".to_owned(), stored, anew));
    }
    for (name, text) in tables(&checked.stored) {
        let found = Source::read(&args.dir.join(name))?;
        compared_table(&found.text, &text, name)?;
    }
    let path = args.dir.join(REPORT_FILE);
    write_atomic(&path, report_html(&report).as_bytes())?;
    print(&format!("{checked}{} written\n", path.display()))
}

fn json_of<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T, SimError> {
    let source = Source::read(path)?;
    serde_json::from_str(&source.text).map_err(|e| {
        let place = Place::at(&source.name, e.line(), e.column());
        Problem::new(place, Fault::Syntax { message: e.to_string() }).into()
    })
}

//! `hhc export`.

use super::args::{ExportArgs, ExportForm, ExportMatrices};
use super::warn;
use crate::SimError;
use crate::case::{LoadedCase, is_actuator_file, read_case};
use crate::files::{DataError, Folder, Source, write_folder};
use crate::flight::{flight_values, leaving};
use crate::output::{Format, print};
use crate::problem::{Fault, Place, Problem};
use actuator_export::{
    ExportError, Monitor, Target, export_monitor, timed_command, timing_program, without_stages,
};
use bench_study::stored::read_actuator;
use clap::ValueEnum;
use preisach_dyn::ActuatorModel;
use rotor_case::AttachedFlowModel;
use rotor_export::{DataFormat, controller_files, data_files};
use rotor_flight::{controllers_of_case, exported_case, state_space_of_case};
use std::fmt::Display;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Files of a folder, name and bytes of each, and warnings.
type Written = (Vec<(String, Vec<u8>)>, Vec<String>);

pub(super) fn export(args: &ExportArgs) -> Result<(), SimError> {
    let output = &args.output.clone().unwrap_or_else(|| default_folder(args));
    if output.exists() {
        return Err(DataError::WouldOverwrite { path: output.clone() }.into());
    }
    if !(args.sampling_hz.is_finite() && args.sampling_hz > 0.0) {
        let remedy = "give the rate at which the step functions are called, or leave it out";
        let fault = Fault::NotPositive { value: args.sampling_hz, unit: "Hz", remedy };
        return Err(Problem::new(Place::file("--sampling-hz"), fault).into());
    }
    let source = Source::read(&args.file)?;
    if args.what.is_some() && (is_actuator_file(&source) || args.to == ExportForm::C) {
        return Err(refused(
            args,
            &"`--what` chooses numbers of a case for json, csv and mat; leave it out",
        ));
    }
    if !args.monitor.is_empty() && !is_actuator_file(&source) {
        return Err(refused(
            args,
            &"`--monitor` watches an actuator and this is a case; leave it out",
        ));
    }
    let (files, warnings) = if is_actuator_file(&source) {
        actuator(args, &source)?
    } else {
        case(args, &read_case(&source, &Folder::of_file(&args.file))?)?
    };
    warn(&warnings, Format::Details);
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    let text = format!("{} written to {}\n", names.join(", "), output.display());
    write_folder(output, &files)?;
    let cost = if is_actuator_file(&source) { cost(args, &source, output)? } else { String::new() };
    print(&(text + &cost))
}

/// The folder if none is given, in the working folder: the file's name and the form.
fn default_folder(args: &ExportArgs) -> PathBuf {
    let stem = args.file.file_stem().map(|stem| stem.display().to_string()).unwrap_or_default();
    let form = args.to.to_possible_value().map(|own| own.get_name().to_owned()).unwrap_or_default();
    PathBuf::from(format!("{stem}_{form}"))
}

/// What a sample costs here: of the C where it can be compiled and run, else of the model in Rust.
#[expect(clippy::disallowed_methods, reason = "a cost is shown, not stored")]
fn cost(args: &ExportArgs, source: &Source, folder: &Path) -> Result<String, SimError> {
    let own = read_actuator(source)?;
    let time_step_s = 1.0 / args.sampling_hz;
    let name = args.name.as_deref().unwrap_or("flap_actuator");
    let is_c = args.to == ExportForm::C && args.monitor.is_empty();
    let program = || timing_program(&own.model, name, time_step_s);
    if let Some([forward, inverse]) = is_c.then(|| timed(&program(), name, folder)).flatten() {
        return Ok(format!(
            "Cost of the C, by cc -O2 on this computer: {forward:.0} ns a sample forward, {inverse:.0} ns inverse\n"
        ));
    }
    let volts = timed_command(&own.model, time_step_s);
    let mut best_s = f64::INFINITY;
    for _ in 0..5 {
        let begun = Instant::now();
        let moved = own.model.simulate(&volts, time_step_s);
        moved.map_err(|error| refused(args, &error))?;
        best_s = best_s.min(begun.elapsed().as_secs_f64());
    }
    let ns = 1e9 * best_s / volts.len() as f64;
    let why = if is_c { "; the C could not be compiled by cc and run" } else { "" };
    Ok(format!(
        "Cost of the actuator in Rust, the original, on this computer: {ns:.0} ns a sample forward{why}\n"
    ))
}

/// ns per sample of the forward and the inverse step of the C in a folder; none if it cannot be compiled and run.
fn timed(program: &str, name: &str, folder: &Path) -> Option<[f64; 2]> {
    let file = format!("{name}.c");
    let arguments = ["-std=c99", "-O2", "-I.", "-o", ".timing", "-x", "c", "-", &file, "-lm"];
    let mut command = Command::new("cc");
    command.args(arguments).current_dir(folder).stdin(Stdio::piped());
    let mut compiler = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().ok()?;
    let given = compiler.stdin.take()?.write_all(program.as_bytes());
    let is_compiled = compiler.wait().is_ok_and(|status| status.success()) && given.is_ok();
    let own = folder.join(".timing");
    let ran = is_compiled.then(|| Command::new(&own).output().ok()).flatten();
    let _ = std::fs::remove_file(&own);
    let printed = String::from_utf8(ran?.stdout).ok()?;
    let numbers: Vec<f64> = printed.split_whitespace().map_while(|n| n.parse().ok()).collect();
    <[f64; 3]>::try_from(numbers).ok().map(|[forward, inverse, _]| [forward, inverse])
}

fn refused(args: &ExportArgs, message: &dyn Display) -> SimError {
    let place = Place::file(args.file.display().to_string());
    Problem::new(place, Fault::Refused { message: message.to_string() }).into()
}

fn as_bytes(texts: impl IntoIterator<Item = (String, String)>) -> Vec<(String, Vec<u8>)> {
    texts.into_iter().map(|(name, text)| (name, text.into_bytes())).collect()
}

fn actuator(args: &ExportArgs, source: &Source) -> Result<Written, SimError> {
    let own = read_actuator(source)?;
    let target = match args.to {
        ExportForm::C => Target::C,
        ExportForm::Python => Target::Python,
        ExportForm::Matlab => Target::Matlab,
        ExportForm::Json => Target::Json,
        ExportForm::Csv | ExportForm::Mat => {
            let message = "is an actuator, which goes out as c, python, matlab or json; csv and mat are T of a case";
            return Err(refused(args, &message));
        }
    };
    let (name, time_step_s) = (args.name.as_deref(), 1.0 / args.sampling_hz);
    let files = if args.monitor.is_empty() {
        actuator_export::export(&own.model, name.unwrap_or("flap_actuator"), time_step_s, target)
    } else {
        watching(args, &own.model, name.unwrap_or("flap_monitor"), target)
    };
    let files = files.map_err(|error| refused(args, &error))?;
    Ok((as_bytes(files), actuator_export::remarks(&own.model)))
}

/// The monitor of the stages that are named.
fn watching(
    args: &ExportArgs,
    extended: &ActuatorModel,
    name: &str,
    target: Target,
) -> Result<Vec<(String, String)>, ExportError> {
    let monitor = Monitor {
        base: &without_stages(extended, &args.monitor)?,
        extended,
        cause: &args.monitor.join(", "),
        threshold_deg: args.threshold_deg.unwrap_or_default(),
        memory_s: args.memory_s.unwrap_or(1.0),
    };
    export_monitor(&monitor, name, 1.0 / args.sampling_hz, target)
}

fn case(args: &ExportArgs, loaded: &LoadedCase) -> Result<Written, SimError> {
    let name = args.name.as_deref().unwrap_or("rotor");
    actuator_export::check_name(name).map_err(|error| refused(args, &error))?;
    let format = match args.to {
        ExportForm::Json => DataFormat::Json,
        ExportForm::Csv => DataFormat::Csv,
        ExportForm::Mat => DataFormat::Mat,
        ExportForm::C => return controllers(args, loaded, name),
        ExportForm::Python | ExportForm::Matlab => {
            let message = "is a case, whose T goes out as json, csv or mat and whose controllers as c; python and matlab are code of an actuator";
            return Err(refused(args, &message));
        }
    };
    let (document, warnings) = match args.what.unwrap_or_default() {
        ExportMatrices::T => leaving(loaded, exported_case)?,
        ExportMatrices::StateSpace => {
            let (document, mut warnings) = leaving(loaded, |case, _| state_space_of_case(case))?;
            warnings.extend(settled_lags(loaded));
            (document, warnings)
        }
    };
    Ok((data_files(&document, name, format), warnings))
}

/// What is said of a state space whose sections have lags in the case.
fn settled_lags(loaded: &LoadedCase) -> Option<String> {
    let message = "the lag states of the sections are settled in the state space, which is quasi-steady: the lift of a flap comes at once and whole. What the lags do to the answer to the flaps is in T: hhc export CASE.ron --to json";
    let has_lags = loaded.case.aerodynamics.model != AttachedFlowModel::QuasiSteady;
    has_lags.then(|| {
        let place = loaded.index.place("aerodynamics.model");
        Problem::new(place, Fault::Other(message.to_owned())).to_string()
    })
}

fn controllers(args: &ExportArgs, loaded: &LoadedCase, name: &str) -> Result<Written, SimError> {
    flight_values(loaded)?;
    let (controllers, warnings) = leaving(loaded, controllers_of_case)?;
    let mut files = Vec::new();
    for (controller, spec) in controllers {
        let own = controller_files(&spec, &format!("{name}_{controller}"));
        files.extend(as_bytes(own.map_err(|error| refused(args, &error))?));
    }
    Ok((files, warnings))
}

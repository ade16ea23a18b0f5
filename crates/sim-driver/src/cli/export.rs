//! `hhc export`.

use super::args::{ExportArgs, ExportForm, ExportMatrices};
use super::warn;
use crate::SimError;
use crate::case::{LoadedCase, is_actuator_file, read_case};
use crate::files::{DataError, Folder, Source, write_folder};
use crate::flight::{flight_values, leaving};
use crate::output::{Format, print};
use crate::problem::{Fault, Place, Problem};
use actuator_export::{ExportError, Monitor, Target, export_monitor, without_stages};
use bench_study::stored::read_actuator;
use preisach_dyn::ActuatorModel;
use rotor_export::{DataFormat, controller_files, data_files};
use rotor_flight::{controllers_of_case, exported_case, state_space_of_case};
use std::fmt::Display;

/// Files of a folder, name and bytes of each, and warnings.
type Written = (Vec<(String, Vec<u8>)>, Vec<String>);

pub(super) fn export(args: &ExportArgs) -> Result<(), SimError> {
    if args.output.exists() {
        return Err(DataError::WouldOverwrite { path: args.output.clone() }.into());
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
    let text = format!("{} written to {}\n", names.join(", "), args.output.display());
    write_folder(&args.output, &files)?;
    print(&text)
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
        ExportMatrices::StateSpace => leaving(loaded, |case, _| state_space_of_case(case))?,
    };
    Ok((data_files(&document, name, format), warnings))
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

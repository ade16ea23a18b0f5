//! `hhc import`, `hhc check` and `hhc init`.

use super::args::{Cli, ImportArgs};
use super::warn;
use crate::SimError;
use crate::case::starting_case;
use crate::check::check_file;
use crate::files::write_new;
use crate::import::{
    ColumnOptions, ImportReport, ImportRequest, default_folder, deg_per_um_of_arm, import_mapped,
};
use crate::output::{Format, Printable, print};
use crate::problem::{Fault, Place, Problem};
use clap::CommandFactory;
use std::path::{Path, PathBuf};

pub(super) fn import(args: &ImportArgs) -> Result<(), SimError> {
    let first = args.files.first().map_or(Path::new("data"), PathBuf::as_path);
    let request = ImportRequest {
        files: args.files.clone(),
        out: args.out.clone().unwrap_or_else(|| default_folder(first)),
        source: args.source,
        kind: args.kind,
        columns: ColumnOptions {
            input: args.input.clone(),
            response: args.response.clone(),
            convert: args.convert.clone(),
            ..args.columns.options()
        },
        variable: args.variable.clone(),
        range: args.range,
        sampling_hz: args.columns.sampling_hz,
        reduce_to_hz: args.reduce_to_hz,
        most_samples: args.max_samples,
        title: args.title.clone(),
        deg_per_um: args.deg_per_um.or(args.arm_mm.map(deg_per_um_of_arm)),
        split: args.split,
    };
    let imported = match &args.mapping {
        Some(mapping) => import_mapped(request, mapping)?,
        None => crate::import::import(&request)?,
    };
    let result = ImportReport::from(imported);
    warn(&result.warnings, Format::Details);
    print(&result.render(args.format)?)
}

pub(super) fn check(file: &Path, format: Format) -> Result<(), SimError> {
    let result = check_file(file)?;
    warn(&result.warnings, Format::Details);
    print(&result.render(format)?)
}

pub(super) fn init(file: &Path) -> Result<(), SimError> {
    let text = starting_case()?;
    write_new(file, text.as_bytes())?;
    print(&format!(
        "{0} written: the paper's case, every field commented. Edit it, then `hhc check {0}` and `hhc run {0}`.\n",
        file.display()
    ))
}

/// Prints the completions for a shell.
pub(super) fn completions(shell: clap_complete::Shell) -> Result<(), SimError> {
    let mut text = Vec::new();
    clap_complete::generate(shell, &mut Cli::command(), "hhc", &mut text);
    print(&String::from_utf8_lossy(&text))
}

/// Prints a page of the manual.
pub(super) fn man(name: Option<&str>) -> Result<(), SimError> {
    let mut all = Cli::command();
    all.build();
    let page = match name {
        None => all,
        Some(name) => all.find_subcommand(name).cloned().ok_or_else(|| {
            let message = format!("there is no command `{name}`; `hhc help` lists them");
            Problem::new(Place::file("hhc man"), Fault::Other(message))
        })?,
    };
    let mut text = Vec::new();
    let written = clap_mangen::Man::new(page).render(&mut text);
    written.map_err(|e| SimError::not_written("the manual page", &e))?;
    print(&String::from_utf8_lossy(&text))
}

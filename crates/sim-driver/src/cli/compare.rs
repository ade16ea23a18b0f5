//! `hhc compare`: two results side by side.

use super::args::CompareArgs;
use super::{warn, write_texts};
use crate::SimError;
use crate::case::load_case;
use crate::compare::{compare_html, compare_results};
use crate::files::refuse_unwritable;
use crate::output::{Printable, print};
use crate::problem::{Fault, Place, Problem};
use crate::progress::Progress;
use crate::results::{RESULT_FILE, StoredResult};
use crate::run::{run_case, steps_of, stored_of};
use std::path::Path;
use study_text::known::COMPARE_FILES;

pub(super) fn compare(args: &CompareArgs) -> Result<(), SimError> {
    if let Some(out) = &args.out {
        refuse_unwritable(out)?;
        args.force.files(out, COMPARE_FILES)?;
    }
    let (a, b) = (result_of(&args.a, args)?, result_of(&args.b, args)?);
    let [name_a, name_b] = [&args.a, &args.b].map(|path| path.display().to_string());
    let found = compare_results([(&name_a, &a), (&name_b, &b)])?;
    if let Some(out) = &args.out {
        write_texts(out, [("compare.csv", found.csv()), ("compare.html", compare_html(&found))])?;
    }
    print(&found.render(args.format.form())?)
}

/// The result in a folder, or of a case that is run.
fn result_of(path: &Path, args: &CompareArgs) -> Result<StoredResult, SimError> {
    let is_result = path.file_name().is_some_and(|name| name == RESULT_FILE);
    let folder = if is_result { path.parent().unwrap_or(path) } else { path };
    if is_result || folder.is_dir() {
        if !folder.join(RESULT_FILE).is_file() {
            let message = format!(
                "holds no {RESULT_FILE}; give a folder that `hhc run CASE --out DIR` has written, or a case file"
            );
            let place = Place::file(path.display().to_string());
            return Err(Problem::new(place, Fault::Other(message)).into());
        }
        return StoredResult::read(folder);
    }
    let loaded = load_case(path)?;
    let progress = Progress::new(steps_of(&loaded));
    let computed = run_case(&loaded, &progress);
    progress.finish();
    let outcome = computed?;
    warn(&outcome.figures().warnings, args.format.form());
    stored_of(&loaded, &outcome)
}

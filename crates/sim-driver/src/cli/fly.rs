//! `hhc fly`.

use super::args::FlyArgs;
use super::{check_range, folder_or, overridden, warn, write_texts};
use crate::SimError;
use crate::case::load_case;
use crate::files::{refuse_unwritable, remove_own};
use crate::flight::{Beside, flight_csv, flight_html, flown};
use crate::output::{Format, Printable, print};
use crate::problem::Problems;
use rotor_flight::{BESIDE_FILES, draws_csv, failures_csv, is_own_table, margins_csv};
use study_text::known::FLIGHT_FILES;

pub(super) fn fly(args: &FlyArgs) -> Result<(), SimError> {
    let loaded = overridden(load_case(&args.case)?, args.inflow);
    let out = folder_or(args.out.as_ref(), &args.case);
    refuse_unwritable(&out)?;
    args.force.files(&out, FLIGHT_FILES)?;
    let asked = [args.failures, args.margins, args.draws.is_some()];
    for (file, _) in BESIDE_FILES.iter().zip(asked).filter(|(_, is_asked)| *is_asked) {
        args.force.files(&out, std::slice::from_ref(file))?;
    }
    if let Some(draws) = args.draws {
        let mut problems = Problems::default();
        check_range(&mut problems, "--draws", draws as f64, [1.0, 1e5], "", "50 draws, say");
        problems.into_result(Some(()))?;
    }
    let beside = Beside { failures: args.failures, margins: args.margins, draws: args.draws };
    let found = flown(&loaded, beside)?;
    let files = [("flight.csv", flight_csv(&found)), ("flight.html", flight_html(&found))];
    let failures = found.failures.as_ref().map(|study| ("failures.csv", failures_csv(study)));
    let margins = found.margins.as_ref().map(|study| ("margins.csv", margins_csv(study)));
    let draws = found.drawn.as_ref().map(|drawn| ("draws.csv", draws_csv(drawn)));
    let beside: Vec<(&str, String)> = failures.into_iter().chain(margins).chain(draws).collect();
    // tables of an earlier flight are not of this one
    for (name, _) in BESIDE_FILES.iter().filter(|(name, _)| beside.iter().all(|own| own.0 != *name))
    {
        remove_own(&out.join(name), |text| is_own_table(name, text))?;
    }
    write_texts(&out, files.into_iter().chain(beside))?;
    warn(&found.warnings, args.format);
    print(&found.render(args.format)?)?;
    if args.format != Format::Json {
        print(&format!(
            "\nEvery cycle in {0}/flight.csv, pictures in {0}/flight.html\n",
            out.display()
        ))?;
    }
    Ok(())
}

//! `hhc fly`.

use super::args::FlyArgs;
use super::{folder_or, overridden, warn, write_texts};
use crate::SimError;
use crate::case::load_case;
use crate::files::refuse_unwritable;
use crate::flight::{flight_csv, flight_html, flown};
use crate::output::{Format, Printable, print};
use rotor_flight::failures_csv;

pub(super) fn fly(args: &FlyArgs) -> Result<(), SimError> {
    let loaded = overridden(load_case(&args.case)?, args.inflow);
    let out = folder_or(args.out.as_ref(), &args.case);
    refuse_unwritable(&out)?;
    let found = flown(&loaded, args.failures)?;
    let files = [("flight.csv", flight_csv(&found)), ("flight.html", flight_html(&found))];
    let failures = found.failures.as_ref().map(|study| ("failures.csv", failures_csv(study)));
    write_texts(&out, files.into_iter().chain(failures))?;
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

//! Generation of small sets with hidden effects.
//!
//! Budget: 1 s on one core for a reference folder and a measured folder together, strength search
//! included. Runs each effect on the recommended runs of the three families and prints the slowest
//! beside the bar.
#![expect(clippy::disallowed_methods, reason = "a benchmark reads the clock")]
#![expect(clippy::print_stdout, reason = "a benchmark reports")]

use std::time::Instant;

use truth::error::TruthError;
use truth::hidden::{Cause, Hidden, Outside, Request, Size, measured_set, reference_files};

const BAR_S: f64 = 1.0;

fn main() -> Result<(), TruthError> {
    let library = Cause::ALL.into_iter().map(Hidden::One);
    let outside = Outside::ALL.into_iter().map(Hidden::Other);
    let (mut slowest_s, mut slowest, mut sum_s, mut count) = (0.0, String::new(), 0.0, 0.0);
    for hidden in library.chain(outside).chain([Hidden::Null]) {
        for base in [0, 1, 3] {
            let request =
                Request { hidden: Some(hidden), base: Some(base), ..Request::new(2, 40.0) };
            let begin = Instant::now();
            let reference = reference_files(base, request.snr_db, Size::Small)?;
            let set = measured_set(&request)?;
            let seconds = begin.elapsed().as_secs_f64();
            std::hint::black_box((reference, set));
            sum_s += seconds;
            count += 1.0;
            if seconds > slowest_s {
                (slowest_s, slowest) = (seconds, format!("{} on base {base}", hidden.id()));
            }
        }
    }
    println!(
        "set with reference: mean {:.3} s, slowest {slowest_s:.3} s ({slowest}), {:.2} of the bar of {BAR_S} s",
        sum_s / count,
        slowest_s / BAR_S
    );
    Ok(())
}

//! The whole study of the paper: identification, trim, control of 2, 3 and 4/rev with every actuator.
//!
//! Budget: 20 s on two cores with Drees inflow, the sensitivity table included.

use criterion::{Criterion, criterion_group, criterion_main};
use sim_driver::SimError;
use sim_driver::case::{PAPER_CASE, shipped_case};
use sim_driver::progress::Progress;
use sim_driver::run::run_case;
use sim_driver::study::{Assumptions, sensitivities};
use std::hint::black_box;
use std::time::{Duration, Instant};

const BUDGET_S: f64 = 20.0;

fn whole_study() -> Result<f64, SimError> {
    let loaded = shipped_case(PAPER_CASE)?;
    let outcome = run_case(&loaded, &Progress::hidden())?;
    let rotor = (&outcome.trimmed, &outcome.drives);
    let rows = sensitivities(&loaded, rotor, Assumptions::WithoutWake, &|| ())?;
    Ok(rows.iter().flat_map(|row| &row.reduction_percent).sum())
}

#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn study(criterion: &mut Criterion) {
    let started = Instant::now();
    match whole_study() {
        Ok(_) => {
            let seconds = started.elapsed().as_secs_f64();
            println!("paper study: {seconds:.1} s, {:.2} of the budget", seconds / BUDGET_S);
        }
        Err(error) => {
            println!("paper study failed: {error}");
            return;
        }
    }
    criterion.bench_function("paper study", |b| b.iter(|| black_box(whole_study())));
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(100));
    targets = study
}
criterion_main!(benches);

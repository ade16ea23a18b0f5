//! The whole study on two cores: trim, control of 2, 3, 4, 5/rev and all together with every actuator (ideal,
//! ignored, feedback, inverse), forecasts and the table of sensitivities; identification of the actuator included.
//!
//! Budgets: 20 s with Drees inflow, 120 s in the free wake.

use criterion::{Criterion, criterion_group, criterion_main};
use rotor_study::{Assumptions, sensitivities, sensitivity_lines};
use sim_driver::SimError;
use sim_driver::case::{CONTROLLERS_CASE, FreeWakeValues, InflowChoice, shipped_case};
use sim_driver::progress::Progress;
use sim_driver::run::run_case;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// That of `hhc`.
#[global_allocator]
static ALLOCATOR: mimalloc::MiMalloc = mimalloc::MiMalloc;

fn whole_study(inflow: InflowChoice) -> Result<f64, SimError> {
    let mut loaded = shipped_case(CONTROLLERS_CASE)?;
    loaded.case.inflow.model = inflow;
    let outcome = run_case(&loaded, &Progress::hidden())?;
    let (rotor, drives) = (&outcome.trimmed, &outcome.drives);
    let rows = sensitivities(&loaded.case, rotor, drives, Assumptions::WithoutWake, &|| ())?;
    let figures = outcome.figures();
    let controlled = figures.control.iter().map(|line| line.reduction_percent);
    let rows = sensitivity_lines(&rows, &outcome.setting);
    Ok(controlled.sum::<f64>() + rows.iter().flat_map(|row| &row.reduction_percent).sum::<f64>())
}

#[expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench reads the clock and reports"
)]
fn study(criterion: &mut Criterion) {
    let free = InflowChoice::FreeWake(FreeWakeValues::default());
    for (name, inflow, budget_s) in
        [("study, Drees", InflowChoice::Drees, 20.0), ("study, free wake", free, 120.0)]
    {
        let started = Instant::now();
        match whole_study(inflow) {
            Ok(_) => {
                let seconds = started.elapsed().as_secs_f64();
                println!("{name}: {seconds:.1} s, {:.2} of the budget", seconds / budget_s);
            }
            Err(error) => {
                println!("{name} failed: {error}");
                return;
            }
        }
        // the free wake is measured once, above: ten samples of it would take many minutes
        if inflow == InflowChoice::Drees {
            criterion.bench_function(name, |b| b.iter(|| black_box(whole_study(inflow))));
        }
    }
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10).measurement_time(Duration::from_secs(100));
    targets = study
}
criterion_main!(benches);

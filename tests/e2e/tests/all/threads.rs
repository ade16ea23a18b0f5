//! Results are the same bits on one thread, on two and on four.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use sim_driver::case::{LoadedCase, read_case};
use sim_driver::files::{Source, shipped};
use sim_driver::progress::Progress;
use sim_driver::results::Figures;
use sim_driver::run::run_case;

/// A small rotor with the identified actuator: identification, trim, T matrix and control all take part.
const CASE: &str = "(
    title: \"small rotor, identified actuator\",
    advance_ratio: 0.2,
    structure: (elements: 4, modes: (flap: 2, lag: 1, torsion: 1)),
    aerodynamics: (model: QuasiSteady, compressibility: None),
    inflow: (model: Drees),
    trim: WindTunnel(ct_sigma: 0.07, shaft_tilt_deg: 3.0),
    control: (harmonics: [[3]], actuators: [Ideal, Hysteretic]),
)
";

fn run_on(loaded: &LoadedCase, threads: usize) -> Figures {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    match pool.map(|pool| pool.install(|| run_case(loaded, &Progress::hidden()))) {
        Ok(Ok(outcome)) => outcome.figures(),
        Ok(Err(error)) => panic!("{error}"),
        Err(error) => panic!("{error}"),
    }
}

/// All figures of a case on one thread, which are those on two and on four.
fn same_on_all(case: &str) -> Figures {
    let source = Source { name: "threads.ron".into(), text: case.into() };
    let loaded = read_case(&source, &shipped("fixtures/cases")).unwrap();
    let one = run_on(&loaded, 1);
    for threads in [2, 4] {
        let more = run_on(&loaded, threads);
        // equal text of all digits is equal bits
        let texts = [&one, &more].map(|figures| serde_json::to_string(figures).unwrap());
        assert_eq!(texts[0], texts[1], "{threads} threads");
    }
    one
}

#[test]
fn any_number_of_threads_gives_the_same_bits() {
    let figures = same_on_all(CASE);
    assert!(figures.control.iter().all(|line| line.reduction_percent > 1.0), "{figures:?}");
}

/// The free wake, its trim, and control in it.
#[test]
fn so_it_does_in_the_free_wake() {
    let wake = "FreeWake(azimuths: 24, turns: 2, panels: 10)";
    let figures = same_on_all(&CASE.replace("Drees", wake));
    assert_eq!(figures.control.len(), 2, "{figures:?}");
}

//! Results are the same bits on one thread and on two.

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

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let source = Source { name: "threads.ron".into(), text: CASE.into() };
    let loaded = read_case(&source, &shipped("fixtures/cases")).unwrap();
    let one = run_on(&loaded, 1);
    assert!(one.control.iter().all(|line| line.reduction_percent > 1.0), "{one:?}");
    let two = run_on(&loaded, 2);
    // equal text of all digits is equal bits
    assert_eq!(serde_json::to_string(&one).unwrap(), serde_json::to_string(&two).unwrap());
}

//! Results do not depend on the number of threads, to the last bit.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use sim_driver::case::{ActuatorSource, ControlActuator, PAPER_CASE, shipped_case};
use sim_driver::progress::Progress;
use sim_driver::run::run_case;

/// Trim, T matrix, stroke search and feedback with one thread and with two.
fn study_with(threads: usize) -> String {
    let mut loaded = shipped_case(PAPER_CASE).unwrap();
    loaded.case.control.harmonics = vec![vec![2], vec![3]];
    loaded.case.control.actuators = vec![ControlActuator::Ideal, ControlActuator::Hysteretic];
    assert!(matches!(loaded.case.actuator.source, ActuatorSource::Bench(_)));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let outcome = pool.install(|| run_case(&loaded, &Progress::hidden())).unwrap();
    serde_json::to_string(&outcome.result).unwrap()
}

#[test]
fn one_thread_and_two_give_the_same_bits() {
    let one = study_with(1);
    assert_eq!(one, study_with(2));
    assert!(one.contains("\"hysteretic\""));
}

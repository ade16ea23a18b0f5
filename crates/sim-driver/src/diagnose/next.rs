//! What to measure next, from a catalogue of experiments a bench can do.

use super::causes::Design;
use super::record::Record;
use model_gap::Candidate;
use model_gap::discovery::{Finding, Verdict};

/// The experiment that tells the remaining causes apart best, by its name in the catalogue.
pub(crate) fn proposal(
    finding: &Finding,
    candidates: &[Candidate],
    design: &Design,
    runs: &[&Record],
) -> String {
    let has_monitor = runs.iter().any(|r| r.amplifier.is_some());
    let mut open: Vec<usize> = Vec::new();
    for found in &finding.causes {
        open.push(found.candidate);
        open.extend(&found.alternatives);
    }
    let names: Vec<&str> = open.iter().map(|&c| candidates[c].cause.id).collect();
    let any = |set: &[&str]| names.iter().any(|n| set.contains(n));
    let input = any(&["electrical-lag", "amplifier-current-limit", "voltage-saturation"]);
    let lags = [
        "transport-delay",
        "sensor-filter",
        "rate-dependence",
        "electrical-lag",
        "mechanical-resonance",
    ];
    let choice = if names.len() < 2 && finding.verdict == Verdict::NothingMissing {
        "small-motion"
    } else if any(&["backlash", "coulomb-friction"]) {
        "preload"
    } else if input && !has_monitor {
        "amplifier-monitor"
    } else if any(&["sensor-filter", "transport-delay"])
        && any(&["rate-dependence", "mechanical-resonance", "electrical-lag"])
    {
        "laser-cross-check"
    } else if any(&lags) {
        "multisine-5-181Hz"
    } else if any(&["dielectric-heating"]) {
        "cold-hot-cold"
    } else if any(&["creep"]) {
        "hold-steps-100s"
    } else if any(&["load-stiffness"]) {
        "two-springs"
    } else if any(&["sensor-nonlinearity"]) {
        "laser-cross-check"
    } else if any(&["depolarisation", "voltage-saturation"]) {
        "overdrive-two-biases"
    } else if any(&["mains-hum"]) {
        "zero-input-record"
    } else if design.only_hz.is_some() {
        "frequency-sweep"
    } else {
        "multisine-5-181Hz"
    };
    choice.to_owned()
}

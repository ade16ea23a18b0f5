//! Warming by dielectric loss.

use super::cause::{BenchCause, amount, linear, logarithmic, shape, usual};
use super::design::Design;
use model_gap::{Candidate, Class, Parameter};
use preisach_dyn::{AmplifierStage, DielectricHeating};

/// Longest run from which on warming may show where no thermometer was read, s: a third of the shortest
/// time constant.
const SHORTEST_S: f64 = 2.0;

/// Warming by dielectric loss.
pub(super) const CAUSE: BenchCause = BenchCause {
    candidate: |design| {
        // the warmth per loss is anyone's guess: only its product with the coefficient shows in the output
        let needs = (!design.has_temperature).then_some("temperature_C");
        let start = |part: f64| vec![(part * design.longest_s).clamp(6.0, 2000.0), 0.002, 1.0];
        Candidate {
            id: "dielectric-heating",
            physics: "Dielectric loss warms the ceramic and raises its gain, gain (1 + a dT), C dT' = P - dT / R.",
            parameters: vec![
                logarithmic("time_constant", "s", 5.0, 3000.0),
                Parameter { needs, ..amount("coefficient", "1/K", -0.05, 0.5) },
                shape(linear("about", "1", -0.5, 1.5)),
            ],
            class: Class::SlowDrift,
            fingerprint: "slow scaling ordered by the dose of f V^2, not by the time since a step",
            confused_with: &["creep", "load-stiffness"],
            separating: &["cold-hot-cold"],
            starts: [0.3, 1.0, 4.0].map(start).to_vec(),
            blocked: blocked(design),
            ..usual()
        }
    },
    apply: |chain, values| {
        let stage = DielectricHeating::new(values[0], values[1]);
        chain.front.amplifier.push(AmplifierStage::DielectricHeating(stage));
        chain.front.heat_about = values[2];
    },
};

fn blocked(design: &Design) -> Option<String> {
    if !design.is_bench {
        return Some("the loss of a dielectric belongs to a piezo actuator".into());
    }
    let longest_s = design.longest_s;
    (longest_s < SHORTEST_S && !design.has_temperature).then(|| {
        format!(
            "the longest run lasts {longest_s:.1} s; heating needs records of a part of its time constant, \
             {SHORTEST_S:.0} s and more"
        )
    })
}

//! A flight in sentences.

use rotor_case::{Case, FailedOn, FlapActuator, FlightValues, Notice};

/// What truth is and what happens in a flight, in sentences; of actuators the title of their data, empty for the ideal one.
pub fn flight_notes(case: &Case, values: &FlightValues, actuator: &str) -> Vec<String> {
    let actuator = if actuator.is_empty() { "the ideal linear one" } else { actuator };
    let mut notes = vec![
        format!(
            "Truth: the rotor in trim at {} advance ratios, linear in its flaps, interpolated linearly in between. Every revolution is a steady state.",
            if values.is_level() { 1 } else { values.knots }
        ),
        format!(
            "Actuators: {actuator}. Each flap is marched through its own hysteresis, all harmonics at once."
        ),
        format!(
            "Speed: advance ratio {} to {} in {} s from {} s on.",
            values.start_advance_ratio, values.end_advance_ratio, values.ramp_s, values.ramp_at_s
        ),
    ];
    notes.extend(values.flap_actuators.iter().map(own_actuator));
    let unlike = case.rotor.dissimilar_blades.iter().map(|one| one.blade.to_string());
    let unlike = unlike.collect::<Vec<_>>().join(", ");
    if !unlike.is_empty() {
        notes.push(format!("Blades unlike the rest: {unlike}. Each answers by itself in the inflow and at the controls of the trim. The T of the controllers is of blades alike."));
    }
    notes.extend(values.thrust_step.map(|step| {
        format!("Thrust: times {} within {} s from {} s on.", step.ratio, step.length_s, step.at_s)
    }));
    notes.extend(values.failed_flap.map(|failed| {
        let told = if failed.notice == Notice::Told { "told" } else { "not told" };
        let on = if failed.on == FailedOn::OneBlade { "one blade" } else { "every blade" };
        let (flap, at_s, stuck_deg) = (failed.flap, failed.at_s, failed.stuck_deg);
        let kept = failed.kept_percent;
        let left = if kept > 0.0 { format!(" with {kept} % of its motion") } else { String::new() };
        format!("Failure: flap {flap} of {on} stuck at {stuck_deg} deg{left} from {at_s} s on; the controller is {told}.")
    }));
    if values.flap_survival_percent < 100.0 {
        notes.push(format!(
            "Flaps: the controllers count on {} % of each, so that one that fails shakes the hub less.",
            values.flap_survival_percent
        ));
    }
    if values.dead_flap_percent < 1e6 {
        notes.push(format!(
            "Flaps: by T no one that stops leaves J above {} % of that without control; the control turns away from its optimum where it would.",
            values.dead_flap_percent
        ));
    }
    let (noise, seed) = (values.noise_percent, values.seed);
    let told = if values.noise_notice == Notice::Told { "told to" } else { "estimated by" };
    notes.push(format!(
        "Noise: {noise} % of the loads at the start in each revolution, seed {seed}; {told} the adaptive controller."
    ));
    notes
}

fn own_actuator(own: &FlapActuator) -> String {
    let blade =
        own.blade.map_or_else(|| "every blade".to_owned(), |blade| format!("blade {blade}"));
    let known = match (own.blade, own.notice) {
        (Some(_), _) | (None, Notice::Untold) => "does not know it",
        (None, Notice::Told) => "knows it",
    };
    format!(
        "Flap {} of {blade}: actuator {}; the T of the controllers {known}.",
        own.flap, own.path
    )
}

//! JSON: the parameters of the model with names, units and meanings.

use crate::json::Json;
use crate::plan::Plan;
use crate::remarks;
use preisach_dyn::{
    ActuatorLaw, AmplifierStage, Envelope, LinkageStage, PlayMap, PreisachGrid, RateForm,
    TimeOrder, VoltageRange,
};

pub(crate) fn files(plan: &Plan<'_>) -> Vec<(String, String)> {
    vec![(format!("{}.json", plan.name), record(plan).document())]
}

/// The actuator as a record.
pub(crate) fn record(plan: &Plan<'_>) -> Json {
    let (model, law) = (plan.model, &plan.law);
    let lines = |lines: &[&str]| Json::List(lines.iter().map(|line| Json::text(line)).collect());
    let remarks = remarks(model).into_iter().map(Json::Text).collect();
    Json::Record(vec![
        ("name", Json::text(plan.name)),
        (
            "units",
            Json::text("the unit stands at the end of every name; without one a pure number"),
        ),
        ("time_step_s", Json::Number(plan.time_step_s)),
        ("command_range_volt", range(model.range_volt)),
        (
            "calibration",
            Json::Record(vec![
                ("deg_per_um", Json::Number(model.calibration.deg_per_um)),
                ("zero_um", Json::Number(model.calibration.zero_um)),
            ]),
        ),
        (
            "law",
            Json::Record(vec![
                ("kind", Json::text(law.title)),
                ("equation", lines(law.equation)),
                ("start", Json::text("at rest: every play centred on the first voltage")),
                ("parameters", law_parameters(&model.law)),
            ]),
        ),
        ("amplifier", Json::List(model.amplifier.iter().map(amplifier).collect())),
        ("linkage", Json::List(model.linkage.iter().map(linkage).collect())),
        ("remarks", Json::List(remarks)),
    ])
}

fn range(range: VoltageRange) -> Json {
    Json::numbers(&[range.lowest_volt(), range.highest_volt()])
}

/// A record of numbers.
fn numbers(fields: &[(&'static str, f64)]) -> Json {
    Json::Record(fields.iter().map(|(name, value)| (*name, Json::Number(*value))).collect())
}

fn grid(grid: &PreisachGrid) -> Json {
    Json::Record(vec![("range_volt", range(grid.range())), ("levels", Json::Count(grid.levels()))])
}

fn map(map: &PlayMap) -> Json {
    let rows = map.nodes.iter().map(|row| Json::numbers(row)).collect();
    Json::Record(vec![("constant", Json::Number(map.constant)), ("nodes", Json::List(rows))])
}

fn envelope(envelope: &Envelope) -> Json {
    numbers(&[
        ("offset_deg", envelope.offset_deg),
        ("quadratic", envelope.quadratic),
        ("cubic", envelope.cubic),
    ])
}

fn law_parameters(law: &ActuatorLaw) -> Json {
    let number = Json::Number;
    match law {
        ActuatorLaw::Linear(law) => {
            numbers(&[("gain_deg_per_volt", law.gain_deg_per_volt), ("bias_volt", law.bias_volt)])
        }
        ActuatorLaw::StaticPreisach(law) => {
            Json::Record(vec![("grid", grid(law.grid())), ("g0_deg", map(law.map()))])
        }
        ActuatorLaw::DynamicPreisach(law) => {
            let p = law.parameters();
            let form = match p.form {
                RateForm::Literal => "Literal",
                RateForm::WellPosed => "WellPosed",
            };
            let order = match p.time_order {
                TimeOrder::First => 1,
                TimeOrder::Second => 2,
            };
            Json::Record(vec![
                ("grid", grid(&p.grid)),
                ("g0_deg", map(&p.g0_deg)),
                ("g1_s", map(&p.g1_s)),
                ("g2_s2_per_deg", map(&p.g2_s2_per_deg)),
                ("form", Json::text(form)),
                ("unfolded_rate_deg_s", number(p.unfolded_rate_deg_s)),
                ("time_order", Json::Count(order)),
            ])
        }
        ActuatorLaw::PrandtlIshlinskii(law) => {
            let p = law.parameters();
            let play = |play: &preisach_dyn::WeightedPlay| {
                numbers(&[
                    ("threshold_volt", play.threshold_volt),
                    ("weight_deg_per_volt", play.weight_deg_per_volt),
                ])
            };
            Json::Record(vec![
                ("range_volt", range(p.range_volt)),
                ("gain_deg_per_volt", number(p.gain_deg_per_volt)),
                ("plays", Json::List(p.plays.iter().map(play).collect())),
                ("threshold_growth_s", number(p.threshold_growth_s)),
                ("envelope", envelope(&p.envelope)),
            ])
        }
        ActuatorLaw::BoucWen(law) => {
            let p = law.parameters();
            Json::Record(vec![
                ("range_volt", range(p.range_volt)),
                ("gain_deg_per_volt", number(p.gain_deg_per_volt)),
                ("half_height_deg", number(p.half_height_deg)),
                ("rise_volt", number(p.rise_volt)),
                ("sigma", number(p.sigma)),
                ("exponent", number(p.exponent)),
                ("envelope", envelope(&p.envelope)),
            ])
        }
        ActuatorLaw::PrandtlStop(law) => {
            let p = law.parameters();
            let stop = |stop: &preisach_dyn::WeightedStop| {
                numbers(&[
                    ("threshold_volt", stop.threshold_volt),
                    ("stiffness_deg_per_volt", stop.stiffness_deg_per_volt),
                ])
            };
            Json::Record(vec![
                ("range_volt", range(p.range_volt)),
                ("stiffness_deg_per_volt", number(p.stiffness_deg_per_volt)),
                ("stops", Json::List(p.stops.iter().map(stop).collect())),
                ("viscosity_deg_s_per_volt", number(p.viscosity_deg_s_per_volt)),
                ("offset_deg", number(p.offset_deg)),
            ])
        }
        // refused before
        _ => Json::Record(Vec::new()),
    }
}

fn stage(kind: &str, parameters: Json) -> Json {
    Json::Record(vec![("kind", Json::text(kind)), ("parameters", parameters)])
}

fn amplifier(of: &AmplifierStage) -> Json {
    match of {
        AmplifierStage::Lag(lag) => stage("Lag", numbers(&[("tau_s", lag.tau_s)])),
        AmplifierStage::CurrentLimit(limit) => {
            let slew = ("slew_rate_volt_per_s", limit.slew_rate_volt_per_s);
            stage("CurrentLimit", numbers(&[slew]))
        }
        AmplifierStage::Saturation(s) => {
            let low = ("v_min_volt", s.v_min_volt);
            let limits = [low, ("v_max_volt", s.v_max_volt), ("knee_volt", s.knee_volt)];
            stage("Saturation", numbers(&limits))
        }
        AmplifierStage::Delay(delay) => stage("Delay", numbers(&[("delay_s", delay.delay_s)])),
        // refused before
        _ => stage("unknown", Json::Record(Vec::new())),
    }
}

fn linkage(of: &LinkageStage) -> Json {
    let elements = |elements: Vec<Json>| Json::Record(vec![("elements", Json::List(elements))]);
    match of {
        LinkageStage::LogCreep(c) => {
            let rate = ("rate_per_decade", c.rate_per_decade);
            stage("LogCreep", numbers(&[rate, ("from_s", c.from_s), ("to_s", c.to_s)]))
        }
        LinkageStage::KelvinVoigt(c) => {
            let element = |e: &preisach_dyn::KelvinVoigtElement| {
                let ratio = ("compliance_ratio", e.compliance_ratio);
                numbers(&[ratio, ("time_constant_s", e.time_constant_s)])
            };
            stage("KelvinVoigt", elements(c.elements.iter().map(element).collect()))
        }
        LinkageStage::Relaxation(r) => {
            let element = |e: &preisach_dyn::RelaxationElement| {
                numbers(&[("share", e.share), ("time_constant_s", e.time_constant_s)])
            };
            stage("Relaxation", elements(r.elements.iter().map(element).collect()))
        }
        LinkageStage::Accommodation(a) => {
            stage("Accommodation", numbers(&[("share", a.share), ("travel_um", a.travel_um)]))
        }
        LinkageStage::Resonance(r) => {
            let frequency = ("frequency_hz", r.frequency_hz);
            stage("Resonance", numbers(&[frequency, ("damping_ratio", r.damping_ratio)]))
        }
        LinkageStage::Backlash(b) => stage("Backlash", numbers(&[("width_um", b.width_um)])),
        LinkageStage::CoulombFriction(f) => {
            stage("CoulombFriction", numbers(&[("width_um", f.width_um)]))
        }
        LinkageStage::LoadStiffness(l) => {
            let ratio = ("stiffness_ratio", l.stiffness_ratio);
            let give = ("compliance_um_per_newton", l.compliance_um_per_newton);
            stage("LoadStiffness", numbers(&[ratio, give]))
        }
        // refused before
        _ => stage("unknown", Json::Record(Vec::new())),
    }
}

//! Doubts about the stages around the law.

use super::{BEYOND, Doubts};
use preisach_dyn::{AmplifierStage, LinkageStage, SensorStage, VoltageRange};

/// Share of the stroke that a gap or friction may take before it is doubted.
const WIDE_GAP: f64 = 0.2;
/// Error of a sensor that is doubted, as a share of the stroke.
const SENSOR_ERROR: f64 = 0.1;
/// Way of an accommodation that is doubted, in strokes.
const LONG_TRAVEL: f64 = 50.0;
/// Mains and their harmonics, Hz.
const MAINS_HZ: std::ops::RangeInclusive<f64> = 10.0..=2000.0;

pub(super) fn amplifier(stage: &AmplifierStage, range: VoltageRange, doubts: &mut Doubts) {
    let (low, high, span) = (range.lowest_volt(), range.highest_volt(), range.span_volt());
    match stage {
        AmplifierStage::Lag(lag) => doubts.above("tau_s", lag.tau_s, "s", 0.5),
        AmplifierStage::Delay(delay) => doubts.above("delay_s", delay.delay_s, "s", 0.1),
        AmplifierStage::CurrentLimit(limit) => {
            let slew = limit.slew_rate_volt_per_s;
            if span / slew > 10.0 {
                let found = format!("{slew} V/s: {:.0} s for the range", span / slew);
                let (field, expected) = ("slew_rate_volt_per_s", "500 to 500 000 V/s");
                doubts.unlikely(field, found, expected, "check the unit");
            }
        }
        AmplifierStage::Saturation(limit) => {
            let found = format!("{} to {} V", limit.v_min_volt, limit.v_max_volt);
            let expected = format!("inside the commands' {low} to {high} V");
            if limit.v_min_volt >= high || limit.v_max_volt <= low {
                let remedy = "the voltage would never change; correct the limits";
                doubts.impossible("", found, &expected, remedy);
            } else if limit.v_min_volt < low - BEYOND * span
                && limit.v_max_volt > high + BEYOND * span
            {
                doubts.unlikely("", found, &expected, "it never acts; correct it or leave it out");
            }
        }
        AmplifierStage::DielectricHeating(heat) => {
            let idle = heat.coefficient_per_k == 0.0 || heat.rise_k_per_volt2_hz == 0.0;
            doubts.idle(idle, "", "no change of gain with heat");
            doubts.above("coefficient_per_k", heat.coefficient_per_k.abs(), "1/K", 0.03);
        }
        AmplifierStage::Depolarisation(loss) => {
            let threshold = loss.threshold_volt;
            let loses = loss.loss_per_volt > 0.0 || loss.loss_per_volt_second > 0.0;
            doubts.above("loss_per_volt_second", loss.loss_per_volt_second, "1/(V s)", 1.0);
            let idle = !loses || threshold <= low;
            let field = "threshold_volt";
            doubts.idle(idle, field, &format!("{threshold} V, never passed below"));
            if idle {
                return;
            }
            if loss.loss_per_volt * (threshold - high) >= 1.0 {
                let found = format!("{threshold} V: nothing is left of the polarisation");
                let expected = "about -0.2 of the highest voltage";
                doubts.impossible(field, found, expected, "correct the threshold");
            } else if threshold > 0.0 {
                let found = format!("{threshold} V");
                doubts.unlikely(field, found, "a reverse voltage", "check the sign");
            }
        }
        _ => {}
    }
}

pub(super) fn linkage(stage: &LinkageStage, stroke_um: f64, doubts: &mut Doubts) {
    let gap = |width_um: f64, remedy: &'static str, doubts: &mut Doubts| {
        let field = "width_um";
        let found = format!("{width_um} um of a stroke of {stroke_um:.1} um");
        let expected = "0.1 to 3 % of the stroke";
        if width_um == 0.0 {
            doubts.idle(true, field, "0 um");
        } else if width_um >= stroke_um {
            doubts.impossible(field, found, expected, remedy);
        } else if width_um > WIDE_GAP * stroke_um {
            doubts.unlikely(field, found, expected, "check the unit");
        }
    };
    match stage {
        LinkageStage::LogCreep(creep) => {
            doubts.idle(creep.rate_per_decade == 0.0, "rate_per_decade", "0");
            doubts.above("rate_per_decade", creep.rate_per_decade, "of a step", 0.1);
        }
        LinkageStage::KelvinVoigt(chain) => {
            let sum: f64 = chain.elements.iter().map(|e| e.compliance_ratio).sum();
            doubts.idle(sum == 0.0, "elements", "no compliance");
            doubts.above("elements", sum, "of a step in all", 0.5);
        }
        LinkageStage::Relaxation(relaxation) => {
            doubts.idle(relaxation.elements.iter().all(|e| e.share == 0.0), "elements", "no share");
        }
        LinkageStage::Accommodation(late) => {
            doubts.idle(late.share == 0.0, "share", "0");
            doubts.above("share", late.share, "of the motion", 0.3);
            if late.travel_um > LONG_TRAVEL * stroke_um {
                let found = format!("{} um of a stroke of {stroke_um:.1} um", late.travel_um);
                doubts.unlikely("travel_um", found, "0.1 to 1 stroke", "check the unit");
            }
        }
        LinkageStage::Resonance(mode) if mode.frequency_hz < 10.0 => {
            let found = format!("{} Hz", mode.frequency_hz);
            doubts.unlikely("frequency_hz", found, "60 to 400 Hz", "check value and unit");
        }
        LinkageStage::Backlash(joint) => {
            gap(joint.width_um, "the flap would never move; correct the width", doubts);
        }
        LinkageStage::CoulombFriction(joint) => {
            gap(joint.width_um, "friction would hold the flap; correct the width", doubts);
        }
        LinkageStage::LoadStiffness(load) => {
            let idle = load.stiffness_ratio == 0.0 && load.compliance_um_per_newton == 0.0;
            doubts.idle(idle, "", "no stiffness and no compliance");
            doubts.above("stiffness_ratio", load.stiffness_ratio, "of the actuator's", 10.0);
            doubts.above("compliance_um_per_newton", load.compliance_um_per_newton, "um/N", 20.0);
        }
        _ => {}
    }
}

/// Gaps that each leave a motion and together leave none.
pub(super) fn gaps(linkage: &[LinkageStage], stroke_um: f64, doubts: &mut Doubts) {
    let widths = || {
        linkage.iter().filter_map(|stage| match stage {
            LinkageStage::Backlash(gap) => Some(gap.width_um),
            _ => None,
        })
    };
    let sum: f64 = widths().sum();
    if sum > 0.0 && sum >= stroke_um && widths().all(|width| width < stroke_um) {
        let found = format!("gaps of {sum} um in all, a stroke of {stroke_um:.1} um");
        let remedy = "the flap would never move; correct the widths";
        doubts.impossible("", found, "0.1 to 3 % of the stroke", remedy);
    }
}

pub(super) fn sensor(stage: &SensorStage, stroke_um: f64, doubts: &mut Doubts) {
    match stage {
        SensorStage::Filter(lag) => doubts.above("tau_s", lag.tau_s, "s", 0.5),
        SensorStage::Delay(delay) => doubts.above("delay_s", delay.delay_s, "s", 0.1),
        SensorStage::Nonlinearity(shape) => {
            doubts.idle(shape.amplitude_um == 0.0, "amplitude_um", "0 um");
            doubts.above("amplitude_um", shape.amplitude_um.abs(), "um", SENSOR_ERROR * stroke_um);
            if 2.0 * shape.half_range_um < 0.5 * stroke_um {
                let found = format!("{} um of a stroke of {stroke_um:.1} um", shape.half_range_um);
                let remedy = "beyond it the polynomial runs away; check the unit";
                doubts.unlikely("half_range_um", found, "half the stroke or more", remedy);
            }
        }
        SensorStage::Quantisation(rounding) if rounding.step_um >= stroke_um => {
            let found = format!("{} um of a stroke of {stroke_um:.1} um", rounding.step_um);
            let remedy = "the reading would never change; correct the step";
            doubts.impossible("step_um", found, "0.1 % of the stroke", remedy);
        }
        SensorStage::MainsHum(hum) => {
            doubts.idle(hum.amplitude_um == 0.0, "amplitude_um", "0 um");
            doubts.above("amplitude_um", hum.amplitude_um, "um", SENSOR_ERROR * stroke_um);
            if !MAINS_HZ.contains(&hum.frequency_hz) {
                let found = format!("{} Hz", hum.frequency_hz);
                doubts.unlikely("frequency_hz", found, "50, 60 or 400 Hz", "check value and unit");
            }
        }
        _ => {}
    }
}

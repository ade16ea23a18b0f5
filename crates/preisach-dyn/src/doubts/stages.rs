//! Doubts about the stages around the law.

use super::{BEYOND, Doubts};
use crate::{AmplifierStage, LinkageStage, SensorStage, VoltageRange};

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
            let sweep_s = span / limit.slew_rate_volt_per_s;
            if sweep_s > 10.0 {
                let found =
                    format!("{} V/s: {sweep_s:.0} s for the range", limit.slew_rate_volt_per_s);
                doubts.unlikely(
                    "slew_rate_volt_per_s",
                    found,
                    "500 to 500 000 V/s",
                    "check the unit",
                );
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
            if heat.coefficient_per_k == 0.0 || heat.rise_k_per_volt2_hz == 0.0 {
                doubts.idle("", "no change of gain with heat".into());
            }
            doubts.above("coefficient_per_k", heat.coefficient_per_k.abs(), "1/K", 0.03);
        }
        AmplifierStage::Depolarisation(loss) => {
            let threshold = loss.threshold_volt;
            let loses = loss.loss_per_volt > 0.0 || loss.loss_per_volt_second > 0.0;
            doubts.above("loss_per_volt_second", loss.loss_per_volt_second, "1/(V s)", 1.0);
            if !loses || threshold <= low {
                doubts.idle("threshold_volt", format!("{threshold} V, never passed below"));
            } else if loss.loss_per_volt * (threshold - high) >= 1.0 {
                let found = format!("{threshold} V: nothing is left of the polarisation");
                let expected = "about -0.2 of the highest voltage";
                doubts.impossible("threshold_volt", found, expected, "correct the threshold");
            } else if threshold > 0.0 {
                let found = format!("{threshold} V");
                doubts.unlikely("threshold_volt", found, "a reverse voltage", "check the sign");
            }
        }
    }
}

pub(super) fn linkage(stage: &LinkageStage, stroke_um: f64, doubts: &mut Doubts) {
    let gap = |width_um: f64, remedy: &'static str, doubts: &mut Doubts| {
        let field = "width_um";
        let found = format!("{width_um} um of a stroke of {stroke_um:.1} um");
        let expected = "0.1 to 3 % of the stroke";
        if width_um == 0.0 {
            doubts.idle(field, "0 um".into());
        } else if width_um >= stroke_um {
            doubts.impossible(field, found, expected, remedy);
        } else if width_um > WIDE_GAP * stroke_um {
            doubts.unlikely(field, found, expected, "check the unit");
        }
    };
    match stage {
        LinkageStage::LogCreep(creep) => {
            if creep.rate_per_decade == 0.0 {
                doubts.idle("rate_per_decade", "0".into());
            }
            doubts.above("rate_per_decade", creep.rate_per_decade, "of a step", 0.1);
        }
        LinkageStage::KelvinVoigt(chain) => {
            let sum: f64 = chain.elements.iter().map(|e| e.compliance_ratio).sum();
            if sum == 0.0 {
                doubts.idle("elements", "no compliance".into());
            }
            doubts.above("elements", sum, "of a step in all", 0.5);
        }
        LinkageStage::Relaxation(relaxation) => {
            if relaxation.elements.iter().all(|e| e.share == 0.0) {
                doubts.idle("elements", "no share".into());
            }
        }
        LinkageStage::Accommodation(late) => {
            if late.share == 0.0 {
                doubts.idle("share", "0".into());
            }
            doubts.above("share", late.share, "of the motion", 0.3);
            if late.travel_um > LONG_TRAVEL * stroke_um {
                let found = format!("{} um of a stroke of {stroke_um:.1} um", late.travel_um);
                doubts.unlikely("travel_um", found, "0.1 to 1 stroke", "check the unit");
            }
        }
        LinkageStage::Resonance(mode) => {
            if mode.frequency_hz < 10.0 {
                let found = format!("{} Hz", mode.frequency_hz);
                doubts.unlikely("frequency_hz", found, "60 to 400 Hz", "check value and unit");
            }
        }
        LinkageStage::Backlash(joint) => {
            gap(joint.width_um, "the flap would never move; correct the width", doubts);
        }
        LinkageStage::CoulombFriction(joint) => {
            gap(joint.width_um, "friction would hold the flap; correct the width", doubts);
        }
        LinkageStage::LoadStiffness(load) => {
            if load.stiffness_ratio == 0.0 && load.compliance_um_per_newton == 0.0 {
                doubts.idle("", "no stiffness and no compliance".into());
            }
            doubts.above("stiffness_ratio", load.stiffness_ratio, "of the actuator's", 10.0);
            let compliance = load.compliance_um_per_newton;
            doubts.above("compliance_um_per_newton", compliance, "um/N", 20.0);
        }
    }
}

/// Gaps that each leave a motion and together leave none.
pub(super) fn gaps(linkage: &[LinkageStage], stroke_um: f64, doubts: &mut Doubts) {
    let widths: Vec<f64> = linkage
        .iter()
        .filter_map(|stage| match stage {
            LinkageStage::Backlash(gap) => Some(gap.width_um),
            _ => None,
        })
        .collect();
    let sum: f64 = widths.iter().sum();
    if sum > 0.0 && sum >= stroke_um && widths.iter().all(|&width| width < stroke_um) {
        doubts.place = "linkage".into();
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
            if shape.amplitude_um == 0.0 {
                doubts.idle("amplitude_um", "0 um".into());
            }
            doubts.above("amplitude_um", shape.amplitude_um.abs(), "um", SENSOR_ERROR * stroke_um);
            if 2.0 * shape.half_range_um < 0.5 * stroke_um {
                let found = format!("{} um of a stroke of {stroke_um:.1} um", shape.half_range_um);
                let remedy = "beyond it the polynomial runs away; check the unit";
                doubts.unlikely("half_range_um", found, "half the stroke or more", remedy);
            }
        }
        SensorStage::Quantisation(rounding) => {
            if rounding.step_um >= stroke_um {
                let found = format!("{} um of a stroke of {stroke_um:.1} um", rounding.step_um);
                let remedy = "the reading would never change; correct the step";
                doubts.impossible("step_um", found, "0.1 % of the stroke", remedy);
            }
        }
        SensorStage::MainsHum(hum) => {
            if hum.amplitude_um == 0.0 {
                doubts.idle("amplitude_um", "0 um".into());
            }
            doubts.above("amplitude_um", hum.amplitude_um, "um", SENSOR_ERROR * stroke_um);
            if !MAINS_HZ.contains(&hum.frequency_hz) {
                let found = format!("{} Hz", hum.frequency_hz);
                doubts.unlikely("frequency_hz", found, "50, 60 or 400 Hz", "check value and unit");
            }
        }
    }
}

//! What a reader of an export has to know.

use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, LinkageStage, RateForm, SensorStage,
};

/// What an export of an actuator leaves out or does only nearly: sentences to print beside it.
///
/// The same sentences stand at the head of the generated files. None: forward and inverse are those of the
/// actuator in all it can do.
pub fn remarks(model: &ActuatorModel) -> Vec<String> {
    let mut remarks = Vec::new();
    if let Some(trained) = model.trained {
        remarks.push(format!(
            "Identified from periodic records of {:.3} to {:.3} V amplitude at {:.3} to {:.3} Hz: beyond them \
             it extrapolates.",
            trained.least_amplitude_volt,
            trained.largest_amplitude_volt,
            trained.lowest_hz,
            trained.highest_hz,
        ));
    }
    remarks.extend(law_remark(&model.law).map(str::to_owned));
    remarks.extend(inverse_remarks(model).into_iter().map(str::to_owned));
    if !model.sensor.is_empty() {
        let names: Vec<&str> = model.sensor.iter().map(sensor_name).collect();
        remarks.push(format!(
            "Sensor stages do not act on the flap and are left out: {}.",
            names.join(", ")
        ));
    }
    remarks
}

fn law_remark(law: &ActuatorLaw) -> Option<&'static str> {
    match law {
        ActuatorLaw::DynamicPreisach(law) if law.parameters().form == RateForm::Literal => Some(
            "The literal form of equation (5) may diverge: watch the status of every step. A well-posed form \
             cannot; identify without the literal form where that matters.",
        ),
        ActuatorLaw::PrandtlIshlinskii(law) if law.parameters().threshold_growth_s > 0.0 => Some(
            "Half-widths that grow with the rate have no exact inverse that goes forward in time: this one \
             takes the rate from an inverse without rate. Its error grows with the square of frequency times \
             growth.",
        ),
        _ => None,
    }
}

fn inverse_remarks(model: &ActuatorModel) -> Vec<&'static str> {
    let amplifier = |is: fn(&AmplifierStage) -> bool| model.amplifier.iter().any(is);
    let linkage = |is: fn(&LinkageStage) -> bool| model.linkage.iter().any(is);
    let lags = amplifier(|stage| matches!(stage, AmplifierStage::Lag(_)))
        || linkage(|stage| {
            use LinkageStage::{KelvinVoigt, LogCreep, Relaxation, Resonance};
            matches!(stage, LogCreep(_) | KelvinVoigt(_) | Relaxation(_) | Resonance(_))
        });
    let joints = linkage(|stage| {
        matches!(stage, LinkageStage::Backlash(_) | LinkageStage::CoulombFriction(_))
    });
    let delay = amplifier(|stage| matches!(stage, AmplifierStage::Delay(_)));
    let load = linkage(|stage| matches!(stage, LinkageStage::LoadStiffness(_)));
    let all = [
        (
            lags,
            "The inverse undoes lags, creep and modes by backward differences: to second order in the time \
             step, some 20 samples a period or more for half a percent.",
        ),
        (
            joints,
            "A joint that sticks has to be moved through its gap at every reversal of the wanted angle: the \
             inverse asks for a jump of the voltage there.",
        ),
        (
            delay,
            "The inverse cannot undo a delay: the flap follows what is wanted that much later.",
        ),
        (load, "No external load: the load spring alone acts."),
    ];
    all.into_iter().filter_map(|(holds, text)| holds.then_some(text)).collect()
}

fn sensor_name(stage: &SensorStage) -> &'static str {
    match stage {
        SensorStage::Filter(_) => "Filter",
        SensorStage::Nonlinearity(_) => "Nonlinearity",
        SensorStage::Quantisation(_) => "Quantisation",
        SensorStage::Delay(_) => "Delay",
        SensorStage::MainsHum(_) => "MainsHum",
        _ => "another one",
    }
}

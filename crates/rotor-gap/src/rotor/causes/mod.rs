//! The cause library: what a rotor may lack.
//!
//! A cause is where it enters the model: [`PointCause::apply`]. The extended model is what that made. A group is one file, a
//! cause one function of it and one line of [`library`].

mod aerodynamics;
mod blades;
mod condition;
mod drive;
mod reading;

use crate::rotor::model::RotorModel;
use model_gap::points::PointCause;

/// A cause, ready for one rotor.
pub type RotorCause = PointCause<RotorModel>;

/// What the library is made for.
#[derive(Debug)]
pub(crate) struct Occasion<'a> {
    pub(crate) model: &'a RotorModel,
    /// Names of the instruments of the channels.
    pub(crate) instruments: &'a [String],
    /// Whether an actuator with hysteresis is there that the simulation lacks.
    pub(crate) has_hysteretic: bool,
    /// Whether the drive of the case is an ideal one.
    pub(crate) is_ideal: bool,
    /// Whether flaps are driven at any point.
    pub(crate) is_driven: bool,
    /// Lag of that actuator by its part of the motion, deg, at the middle amplitude of the points.
    pub(crate) lag_deg: &'a [(f64, f64)],
}

/// Names of the causes of a rotor.
pub const LIBRARY: [&str; 25] = [
    "actuator-hysteresis",
    "actuator-gain",
    "flap-effectiveness",
    "stiffness-flap",
    "stiffness-lag",
    "stiffness-torsion",
    "pitch-link",
    "mass",
    "cg-offset",
    "aerodynamic-centre",
    "structural-damping",
    "blade-dissimilarity",
    "pitch-reference",
    "twist",
    "lift-slope",
    "drag",
    "inflow",
    "dynamic-stall",
    "compressibility",
    "hub-impedance",
    "sensor-gain",
    "azimuth-offset",
    "channel-delay",
    "rotor-speed",
    "air-density",
];

/// The causes for a model and its channels.
pub(crate) fn library(o: &Occasion<'_>) -> Vec<RotorCause> {
    let single = [
        drive::actuator_gain(o),
        aerodynamics::flap_effectiveness(o),
        blades::stiffness_flap(),
        blades::stiffness_lag(),
        blades::stiffness_torsion(),
        blades::pitch_link(o),
        blades::mass(),
        blades::cg_offset(o),
        aerodynamics::aerodynamic_centre(o),
        blades::structural_damping(o),
        reading::pitch_reference(),
        aerodynamics::twist(),
        aerodynamics::lift_slope(),
        aerodynamics::drag(o),
        aerodynamics::inflow(o),
        aerodynamics::dynamic_stall(o),
        aerodynamics::compressibility(o),
        reading::hub_impedance(),
        reading::azimuth_offset(),
        reading::channel_delay(),
        condition::rotor_speed(),
        condition::air_density(),
    ];
    let mut all = drive::actuator_hysteresis(o).to_vec();
    all.extend(single);
    all.extend(blades::blade_dissimilarity(o));
    all.extend(reading::sensor_gains(o));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use rotor_case::Case;

    #[test]
    fn every_cause_is_in_the_list_and_changes_the_model() {
        let model = RotorModel::of(Case::default());
        let instruments = ["fz_n4_N".to_owned()];
        let lag_deg = [(0.0, 0.0), (1.0, 30.0)];
        let occasion = Occasion {
            model: &model,
            instruments: &instruments,
            has_hysteretic: true,
            is_ideal: true,
            is_driven: true,
            lag_deg: &lag_deg,
        };
        let all = library(&occasion);
        for id in LIBRARY {
            assert!(all.iter().any(|own| own.id == id), "{id}");
        }
        for own in &all {
            assert!(LIBRARY.contains(&own.id), "{}", own.id);
            let none = own.none();
            assert_eq!(own.applied(&model, &none), model, "{}", own.id);
            for (k, parameter) in own.parameters.iter().enumerate() {
                for &amount in &parameter.amounts {
                    let mut values = none.clone();
                    values[k] = amount;
                    assert!(
                        parameter.range.0 <= amount && amount <= parameter.range.1,
                        "{}",
                        own.id
                    );
                    assert_ne!(
                        own.applied(&model, &values),
                        model,
                        "{} {}",
                        own.id,
                        parameter.name
                    );
                }
            }
            for alike in own.confused_with {
                assert!(LIBRARY.contains(alike), "{}: {alike}", own.id);
            }
        }
    }
}

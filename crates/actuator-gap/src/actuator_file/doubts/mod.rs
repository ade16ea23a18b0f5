//! What is impossible or unlikely about an actuator, number by number.

mod stages;

use preisach_dyn::{ActuatorLaw, ActuatorModel, HysteresisLaw, LinkageStage, StartState};
use serde::{Deserialize, Serialize};
use std::fmt;

/// How much a doubt weighs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Weight {
    /// It can be, but hardly any actuator is like that.
    Unlikely,
    /// No actuator can be like that.
    Impossible,
}

/// One thing about an actuator that is impossible or unlikely.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Doubt {
    /// How much it weighs.
    pub weight: Weight,
    /// Place in the model: `law`, `linkage[2].width_um`.
    pub field: String,
    /// What is there, with its unit.
    pub found: String,
    /// What would be expected, with its unit.
    pub expected: String,
    /// What to do.
    pub remedy: &'static str,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}, expected {}; {}", self.field, self.found, self.expected, self.remedy)
    }
}

/// Limits beyond the range by more than this share of it were not meant to be its ends.
const BEYOND: f64 = 0.01;
/// Strokes of a stack that are doubted, um.
const LEAST_STROKE_UM: f64 = 1.0;
const MOST_STROKE_UM: f64 = 5000.0;
/// Travel of a flap that is doubted, deg.
const MOST_TRAVEL_DEG: f64 = 90.0;
/// Travel of a law that counts as none, deg.
const LEAST_TRAVEL_DEG: f64 = 1e-9;
/// Steps of a sweep through the range, and the time each takes, s.
const SWEEP: u32 = 32;
const SLOW_S: f64 = 1e6;

/// What is impossible or unlikely about this actuator, in the order of its chain; empty for a sound
/// one. Parameters outside the ranges of their stages are errors of [`ActuatorModel::check_stages`].
///
/// The law moves, upwards, and over the whole range of commands; limits and thresholds act inside
/// that range; gaps are smaller than the stroke; one stage feels the load; no stage is without
/// effect; sizes are the usual ones of their stages, widened some ten times.
pub(super) fn doubts(model: &ActuatorModel) -> Vec<Doubt> {
    let mut doubts = Doubts::default();
    let per_um = model.calibration.deg_per_um;
    let gain = "calibration.deg_per_um";
    if !(per_um.is_finite() && per_um != 0.0) {
        let found = format!("{per_um} deg/um");
        let remedy = "give the gain of the bench";
        doubts.at(gain).impossible("", found, "a number other than 0", remedy);
    }
    let stroke_um = (law_doubts(model, &mut doubts) / per_um).abs();
    let moves = stroke_um.is_finite() && stroke_um * per_um.abs() >= LEAST_TRAVEL_DEG;
    if moves && !(LEAST_STROKE_UM..=MOST_STROKE_UM).contains(&stroke_um) {
        let found = format!("a stroke of {stroke_um:.3} um");
        let remedy = "check deg_per_um and the law's unit";
        doubts.at(gain).unlikely("", found, "50 to 1000 um", remedy);
    }
    for (i, stage) in model.amplifier.iter().enumerate() {
        stages::amplifier(stage, model.range_volt, doubts.at(format!("amplifier[{i}]")));
    }
    for (i, stage) in model.linkage.iter().enumerate() {
        stages::linkage(stage, stroke_um, doubts.at(format!("linkage[{i}]")));
    }
    stages::gaps(&model.linkage, stroke_um, doubts.at("linkage"));
    let loads = |stage: &&LinkageStage| matches!(stage, LinkageStage::LoadStiffness(_));
    let count = model.linkage.iter().filter(loads).count();
    if count > 1 {
        let found = format!("{count} LoadStiffness stages");
        let expected = "one: each takes the whole load";
        doubts.at("linkage").impossible("", found, expected, "make them one");
    }
    for (i, stage) in model.sensor.iter().enumerate() {
        stages::sensor(stage, stroke_um, doubts.at(format!("sensor[{i}]")));
    }
    doubts.list
}

/// Doubts about the law alone; how far it moves over the range of commands, slowly, deg.
fn law_doubts(model: &ActuatorModel, doubts: &mut Doubts) -> f64 {
    let range = model.range_volt;
    let own = match &model.law {
        ActuatorLaw::StaticPreisach(law) => law.grid().range(),
        ActuatorLaw::DynamicPreisach(law) => law.grid().range(),
        ActuatorLaw::PrandtlIshlinskii(law) => law.parameters().range_volt,
        ActuatorLaw::BoucWen(law) => law.parameters().range_volt,
        ActuatorLaw::PrandtlStop(law) => law.parameters().range_volt,
        ActuatorLaw::HystereticOscillator(law) => law.parameters().range_volt,
        // a line goes on for ever
        _ => range,
    };
    let [low, high] = [range.lowest_volt(), range.highest_volt()];
    let found = format!("{low} to {high} V");
    let expected = format!("inside the law's {} to {} V", own.lowest_volt(), own.highest_volt());
    let excess = own.excess_volt(low).max(own.excess_volt(high));
    if high <= own.lowest_volt() || low >= own.highest_volt() {
        let remedy = "give the range the law was fitted in";
        doubts.at("range_volt").impossible("", found, &expected, remedy);
    } else if excess > BEYOND * own.span_volt() {
        let remedy = "the law has no numbers out there; narrow the range or fit again";
        doubts.at("range_volt").unlikely("", found, &expected, remedy);
    }
    // so slowly that no rate counts
    let (mut memory, first) = model.law.start(low, StartState::RisingFromLowest);
    let mut last = first;
    for part in 1..=SWEEP {
        let volt = low + range.span_volt() * f64::from(part) / f64::from(SWEEP);
        last = model.law.step(&mut memory, volt, SLOW_S);
    }
    let travel = last - first;
    doubts.at("law");
    let found = format!("{travel:.3e} deg over the range of commands");
    if travel.is_nan() || travel.abs() < LEAST_TRAVEL_DEG {
        doubts.impossible("", found, "a flap that moves", "give the law a gain other than 0");
    } else if travel < 0.0 {
        let remedy = "change its sign, or leave it if the linkage turns the motion round";
        doubts.unlikely("", found, "an output that rises with the voltage", remedy);
    } else if travel > MOST_TRAVEL_DEG {
        doubts.unlikely("", found, "less than 90 deg", "check the unit of the law's output");
    }
    travel
}

/// Doubts found so far, and the place that is looked at.
#[derive(Default)]
struct Doubts {
    list: Vec<Doubt>,
    place: String,
}

impl Doubts {
    /// Goes on to another place.
    fn at(&mut self, place: impl Into<String>) -> &mut Self {
        self.place = place.into();
        self
    }

    fn push(&mut self, weight: Weight, field: &str, found: String, sound: (&str, &'static str)) {
        let dot = if field.is_empty() { "" } else { "." };
        let field = format!("{}{dot}{field}", self.place);
        let (expected, remedy) = (sound.0.to_owned(), sound.1);
        self.list.push(Doubt { weight, field, found, expected, remedy });
    }

    fn impossible(&mut self, field: &str, found: String, expected: &str, remedy: &'static str) {
        self.push(Weight::Impossible, field, found, (expected, remedy));
    }

    fn unlikely(&mut self, field: &str, found: String, expected: &str, remedy: &'static str) {
        self.push(Weight::Unlikely, field, found, (expected, remedy));
    }

    /// A number larger than `most`.
    fn above(&mut self, field: &str, value: f64, unit: &str, most: f64) {
        if value > most {
            let expected = format!("up to {most} {unit}");
            self.unlikely(field, format!("{value} {unit}"), &expected, "check value and unit");
        }
    }

    /// A stage that is the identity, if it is.
    fn idle(&mut self, is_idle: bool, field: &str, found: &str) {
        if is_idle {
            let remedy = "leave the stage out or correct it";
            self.unlikely(field, found.into(), "a stage that acts", remedy);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::{
        Accommodation, AmplifierStage, Backlash, Calibration, CoulombFriction, Depolarisation,
        LinearGain, LoadStiffness, MainsHum, Nonlinearity, NonlinearityShape, PlayMap,
        PreisachGrid, Quantisation, Saturation, SensorStage, StaticPreisach, VoltageRange,
    };

    fn sound() -> ActuatorModel {
        ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 0.04)
    }

    /// Field and weight of the only doubt.
    fn only(model: &ActuatorModel) -> (String, Weight) {
        let found = doubts(model);
        assert_eq!(found.len(), 1, "{found:?}");
        (found[0].field.clone(), found[0].weight)
    }

    fn with_linkage(stages: Vec<LinkageStage>) -> ActuatorModel {
        ActuatorModel { linkage: stages, ..sound() }
    }

    #[test]
    fn a_sound_actuator_raises_none() {
        let mut model = sound();
        let limit = Saturation::sharp(-20.0, 150.0);
        model.amplifier.push(AmplifierStage::Saturation(limit));
        model.linkage.push(LinkageStage::Backlash(Backlash { width_um: 5.0 }));
        model.linkage.push(LinkageStage::LoadStiffness(LoadStiffness {
            stiffness_ratio: 0.2,
            compliance_um_per_newton: 0.9,
        }));
        assert_eq!(doubts(&model), []);
    }

    #[test]
    fn gains_that_are_zero_or_negative_are_doubted() {
        let gain = |gain_deg_per_volt: f64| {
            let law = ActuatorLaw::Linear(LinearGain { gain_deg_per_volt, bias_volt: 65.0 });
            only(&ActuatorModel { law, ..sound() })
        };
        assert_eq!(gain(0.0), ("law".into(), Weight::Impossible));
        assert_eq!(gain(-0.1), ("law".into(), Weight::Unlikely));
        assert_eq!(gain(1.0), ("law".into(), Weight::Unlikely));
        let calibration = Calibration { deg_per_um: 0.0, zero_um: 0.0 };
        let flat = ActuatorModel { calibration, ..sound() };
        assert_eq!(only(&flat), ("calibration.deg_per_um".into(), Weight::Impossible));
        for deg_per_um in [0.001, 40.0] {
            let calibration = Calibration { deg_per_um, zero_um: 0.0 };
            let odd = ActuatorModel { calibration, ..sound() };
            assert_eq!(only(&odd), ("calibration.deg_per_um".into(), Weight::Unlikely));
        }
    }

    #[test]
    fn the_range_of_commands_lies_in_that_of_the_law() {
        let law = |low, high| {
            let grid = PreisachGrid::new(VoltageRange::new(low, high).unwrap(), 4).unwrap();
            let rises: Vec<Vec<f64>> = (0..4).map(|j| vec![1.0; 4 - j]).collect();
            let map = PlayMap::from_rises(&grid, 0.0, &rises).unwrap();
            let law = ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, map).unwrap());
            ActuatorModel { law, ..sound() }
        };
        assert_eq!(doubts(&law(-20.0, 150.0)), []);
        assert_eq!(doubts(&law(-50.0, 200.0)), []);
        assert_eq!(only(&law(0.0, 100.0)), ("range_volt".into(), Weight::Unlikely));
        let apart = doubts(&law(200.0, 300.0));
        assert_eq!((&*apart[0].field, apart[0].weight), ("range_volt", Weight::Impossible));
    }

    #[test]
    fn limits_thresholds_and_gaps_act_inside_the_range() {
        let amplifier = |stage| only(&ActuatorModel { amplifier: vec![stage], ..sound() });
        let limits = |v_min_volt, v_max_volt| {
            amplifier(AmplifierStage::Saturation(Saturation::sharp(v_min_volt, v_max_volt)))
        };
        assert_eq!(limits(-200.0, 400.0), ("amplifier[0]".into(), Weight::Unlikely));
        assert_eq!(limits(160.0, 400.0), ("amplifier[0]".into(), Weight::Impossible));
        let threshold = |volt| {
            let stage = Depolarisation { loss_per_volt: 0.1, ..Depolarisation::new(volt) };
            amplifier(AmplifierStage::Depolarisation(stage)).1
        };
        assert_eq!(threshold(-30.0), Weight::Unlikely);
        assert_eq!(threshold(20.0), Weight::Unlikely);
        assert_eq!(threshold(170.0), Weight::Impossible);
        // the stroke is 500 um
        for (width_um, weight) in
            [(0.0, Weight::Unlikely), (150.0, Weight::Unlikely), (600.0, Weight::Impossible)]
        {
            let expected = ("linkage[0].width_um".into(), weight);
            let gap = LinkageStage::Backlash(Backlash { width_um });
            assert_eq!(only(&with_linkage(vec![gap])), expected);
            let friction = LinkageStage::CoulombFriction(CoulombFriction { width_um });
            assert_eq!(only(&with_linkage(vec![friction])), expected);
        }
        let late = |share, travel_um| {
            let stage = LinkageStage::Accommodation(Accommodation { share, travel_um });
            only(&with_linkage(vec![stage])).0
        };
        assert_eq!(late(0.4, 100.0), "linkage[0].share");
        assert_eq!(late(0.05, 1e5), "linkage[0].travel_um");
        let half = LinkageStage::Backlash(Backlash { width_um: 90.0 });
        let sum = with_linkage(vec![half; 6]);
        assert_eq!(only(&sum), ("linkage".into(), Weight::Impossible));
        let coarse = SensorStage::Quantisation(Quantisation { step_um: 900.0 });
        let model = ActuatorModel { sensor: vec![coarse], ..sound() };
        assert_eq!(only(&model), ("sensor[0].step_um".into(), Weight::Impossible));
        let read = |stage| only(&ActuatorModel { sensor: vec![stage], ..sound() });
        let bent = |amplitude_um| {
            let shape = NonlinearityShape::Cubic;
            read(SensorStage::Nonlinearity(Nonlinearity {
                amplitude_um,
                half_range_um: 300.0,
                shape,
            }))
        };
        let hum = |amplitude_um, frequency_hz| {
            read(SensorStage::MainsHum(MainsHum { amplitude_um, frequency_hz, phase_rad: 0.0 }))
        };
        for amplitude_um in [0.0, 80.0] {
            let expected = ("sensor[0].amplitude_um".into(), Weight::Unlikely);
            assert_eq!(bent(amplitude_um), expected);
            assert_eq!(hum(amplitude_um, 50.0), expected);
        }
        assert_eq!(hum(1.0, 0.05).0, "sensor[0].frequency_hz");
    }

    #[test]
    fn the_load_is_taken_once_and_by_something_stiff() {
        let load = |compliance_um_per_newton| {
            LinkageStage::LoadStiffness(LoadStiffness {
                stiffness_ratio: 0.1,
                compliance_um_per_newton,
            })
        };
        let twice = with_linkage(vec![load(0.9), load(0.9)]);
        assert_eq!(only(&twice), ("linkage".into(), Weight::Impossible));
        let soft = only(&with_linkage(vec![load(50.0)]));
        assert_eq!(soft, ("linkage[0].compliance_um_per_newton".into(), Weight::Unlikely));
        let text = doubts(&with_linkage(vec![load(50.0)]))[0].to_string();
        assert!(text.contains("50 um/N") && text.contains("up to 20 um/N"), "{text}");
    }
}

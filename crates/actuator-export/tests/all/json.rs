//! JSON: it parses, and its numbers are those of the model.

use crate::common::{Named, laws, stages, statics};
use actuator_export::{Target, export};
use preisach_dyn::{ActuatorLaw, MainsHum, SensorStage};
use serde_json::Value;

fn parsed(named: &Named) -> Value {
    let files = export(&named.model, named.name, 1e-3, Target::Json).unwrap();
    assert_eq!(files.len(), 1);
    assert_eq!(files[0].0, format!("{}.json", named.name));
    serde_json::from_str(&files[0].1).unwrap()
}

#[test]
fn every_law_and_stage_is_written_with_its_parameters() {
    for named in laws().iter().chain(&stages()) {
        let json = parsed(named);
        assert_eq!(json["name"], named.name);
        assert!(json["law"]["parameters"].as_object().is_some_and(|p| !p.is_empty()), "{json}");
        assert_eq!(json["amplifier"].as_array().unwrap().len(), named.model.amplifier.len());
        assert_eq!(json["linkage"].as_array().unwrap().len(), named.model.linkage.len());
        for list in ["amplifier", "linkage"] {
            for stage in json[list].as_array().unwrap() {
                assert_ne!(stage["kind"], "unknown");
                assert!(!stage["parameters"].as_object().unwrap().is_empty());
            }
        }
    }
}

#[test]
fn the_numbers_come_back_with_the_same_bits() {
    let named = Named { name: "flap", model: statics(7) };
    let json = parsed(&named);
    let ActuatorLaw::StaticPreisach(law) = &named.model.law else { panic!("law") };
    let rows = json["law"]["parameters"]["g0_deg"]["nodes"].as_array().unwrap();
    assert_eq!(rows.len(), 7);
    for (row, expected) in rows.iter().zip(&law.map().nodes) {
        for (value, expected) in row.as_array().unwrap().iter().zip(expected) {
            assert_eq!(value.as_f64().unwrap().to_bits(), expected.to_bits());
        }
    }
    assert_eq!(json["command_range_volt"], serde_json::json!([-20.0, 150.0]));
}

#[test]
fn remarks_are_part_of_it() {
    let mut model = statics(7);
    let hum = MainsHum { amplitude_um: 0.3, frequency_hz: 50.0, phase_rad: 0.4 };
    model.sensor = vec![SensorStage::MainsHum(hum)];
    let json = parsed(&Named { name: "flap", model: model.clone() });
    assert!(json["remarks"][0].as_str().unwrap().contains("MainsHum"));
    // and of every head
    for target in [Target::C, Target::Python, Target::Matlab] {
        let text = &export(&model, "flap", 1e-3, target).unwrap()[0].1;
        assert!(text.contains("left out: MainsHum."), "{text}");
    }
}

//! T that is handed in: exported and handed back it flies the same flight to the last bit, and what is not of the case is refused.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod common;

use common::actuator;
use preisach_dyn::ActuatorModel;
use rotor_case::{ActuatorChoice, BiasChoice, Case, FlightValues, InflowChoice};
use rotor_export::Document;
use rotor_flight::{FlightError, FlownCase, FlyingCase, exported_case, handed_t};
use std::sync::Arc;

fn case() -> Case {
    let flight = Some(FlightValues {
        duration_s: 6.0,
        start_advance_ratio: 0.28,
        end_advance_ratio: 0.30,
        ramp_at_s: 1.0,
        ramp_s: 4.0,
        knots: 3,
        harmonics: vec![3],
        noise_percent: 3.0,
        ..FlightValues::default()
    });
    let mut case = Case { flight, ..Case::default() };
    case.control.harmonics = vec![vec![3]];
    case
}

fn flown(
    case: &Case,
    values: &FlightValues,
    model: &ActuatorModel,
) -> Result<FlownCase, FlightError> {
    FlyingCase::new(case, values, model)?.fly(&|| ())
}

#[test]
fn the_exported_t_handed_back_flies_the_same_flight_to_the_last_bit() {
    let (mut case, model) = (case(), actuator());
    let values = case.flight.clone().unwrap();
    let own = flown(&case, &values, &model).unwrap();
    let document = exported_case(&case, &model).unwrap();
    case.control.handed_t = Some(Arc::new(handed_t(&case, &document).unwrap()));
    let handed = flown(&case, &values, &model).unwrap();
    assert_eq!(own.flights.len(), 3);
    for (own, handed) in own.flights.iter().zip(&handed.flights) {
        assert!(own.points.len() > 8);
        for (a, b) in own.points.iter().zip(&handed.points) {
            let bits = |u: &[f64]| u.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&a.control_volt), bits(&b.control_volt));
        }
        assert_eq!(own, handed);
    }
    // and it is the T handed in that is used: another one flies otherwise
    let mut other = document.clone();
    for array in other.arrays.iter_mut().filter(|array| array.name == "T_3") {
        for value in &mut array.values {
            *value *= 1.3;
        }
    }
    case.control.handed_t = Some(Arc::new(handed_t(&case, &other).unwrap()));
    let otherwise = flown(&case, &values, &model).unwrap();
    assert!(otherwise.flights[0].points[2].control_volt != own.flights[0].points[2].control_volt);
    // what is exported stays the rotor's own
    assert_eq!(exported_case(&case, &model).unwrap(), document);
}

/// Weights, limits and conditions go with T; what the case has otherwise is said, each at its field, and nothing else.
#[test]
fn what_t_was_found_with_is_compared_with_the_case() {
    let (case, model) = (case(), actuator());
    let document = exported_case(&case, &model).unwrap();
    let told = |case: &Case| handed_t(case, &document).unwrap().told;
    assert_eq!(told(&case), Vec::<String>::new());
    let mut other = case.clone();
    other.control.load_weights.fz = 4.0;
    other.actuator.range_volt.1 = 120.0;
    other.rotor.omega_rpm = 300.0;
    other.actuator.model = ActuatorChoice::Ideal;
    other.actuator.bench_rev_hz = 6.0;
    other.control.bias = BiasChoice::Fixed(case.control.bias_volt);
    other.inflow.model = InflowChoice::PittPeters;
    if let Some(flight) = &mut other.flight {
        flight.rate_limit_volt = 3.0;
    }
    let said = told(&other);
    assert_eq!(said.len(), 8, "{said:?}");
    for (line, parts) in said.iter().zip([
        ["`rotor_rpm` 383, the case has 300", "`rotor.omega_rpm`"],
        ["`bench_rev_hz` 5, the case has 6", "`actuator.bench_rev_hz`"],
        ["`bias_held` 0, the case has 1", "`control.bias`"],
        ["`highest_V` 150, the case has 120", "`actuator.range_V`"],
        ["`rate_limit_V` 10, the case has 3", "`flight.rate_limit_V`"],
        ["`fz_4_per_rev_cos` 1, the case has 4", "`control.load_weights`"],
        ["Inflow: Drees", "Inflow: PittPeters"],
        ["Actuator: Bench, data set `shipped:apa500l_synthetic`.", "Actuator: Ideal, 10 deg"],
    ]) {
        assert!(parts.iter().all(|part| line.contains(part)), "{line}: {parts:?}");
    }
    // T alone, such as one table of CSV: that nothing is known is said too
    let mut alone = document.clone();
    alone.arrays.retain(|array| array.name.starts_with("T_"));
    let said = handed_t(&case, &alone).unwrap().told;
    assert!(said.len() == 1 && said[0].contains("without `settings`"), "{said:?}");
}

/// Changes a document, and what is then said of it.
fn told(change: impl Fn(&mut Document)) -> String {
    let (case, model) = (case(), actuator());
    let level = Case { flight: None, ..case.clone() };
    let mut document = exported_case(&level, &model).unwrap();
    handed_t(&level, &document).unwrap();
    change(&mut document);
    handed_t(&level, &document).unwrap_err().to_string()
}

fn t(document: &mut Document) -> &mut rotor_export::LabelledArray {
    document.arrays.iter_mut().find(|array| array.name == "T_3").unwrap()
}

#[test]
fn names_units_and_shapes_that_are_not_the_cases_are_refused_in_words() {
    let none = told(|document| document.arrays.retain(|array| array.name != "T_3"));
    assert!(none.contains("no array of T") && none.contains("`baseline`"), "{none}");
    let named = told(|document| t(document).name = "T_three".to_owned());
    assert!(named.contains("`T_three`: its name ends in harmonics"), "{named}");
    let load = told(|document| t(document).axes[0].labels.swap(0, 2));
    assert!(
        load.contains("load 1 is `fy_4_per_rev_cos`, the case has `fx_4_per_rev_cos`"),
        "{load}"
    );
    let unit = told(|document| t(document).axes[0].units[3] = "N".to_owned());
    assert!(
        unit.contains("load `fy_4_per_rev_sin` is in `N`, expected `m0 Omega^2 R^2`"),
        "{unit}"
    );
    let volt = told(|document| t(document).axes[1].units[0] = "mV".to_owned());
    assert!(volt.contains("control `flap1_3_per_rev_cos_V` is in `mV`, expected `V`"), "{volt}");
    let flaps = told(|document| {
        let array = t(document);
        array.axes[1].labels.truncate(2);
        array.axes[1].units.truncate(2);
    });
    assert!(flaps.contains("has 2 controls, the case has 4"), "{flaps}");
    let short = told(|document| t(document).values.truncate(47));
    assert!(
        short.contains("holds 47 numbers, expected 12 loads x 4 controls x 1 points"),
        "{short}"
    );
    let nan = told(|document| t(document).values[5] = f64::NAN);
    assert!(nan.contains("mz_4_per_rev") || nan.contains("is no finite number"), "{nan}");
    let point = told(|document| {
        document.arrays.retain(|array| array.name != "conditions");
        t(document).axes[2].labels[0] = "fast".to_owned();
    });
    assert!(point.contains("point `fast` has no advance ratio"), "{point}");
    // the set that is flown is not there
    let (mut case, model) = (case(), actuator());
    let document = exported_case(&Case { flight: None, ..case.clone() }, &model).unwrap();
    case.control.handed_t = Some(Arc::new(handed_t(&case, &document).unwrap()));
    let values = FlightValues { harmonics: vec![4], ..case.flight.clone().unwrap() };
    let missing = flown(&case, &values, &model).unwrap_err();
    assert_eq!(missing.field(), "control.t_file");
    assert!(missing.to_string().contains("T of 3 per rev, not of 4 per rev"), "{missing}");
    let beyond = flown(&case, &case.flight.clone().unwrap(), &model).unwrap_err();
    assert!(beyond.to_string().contains("0.3 to 0.3, asked for at 0.28"), "{beyond}");
}

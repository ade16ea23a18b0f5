//! What a T was found with and is meant for: weights, limits and conditions of its case, which go into its file and are compared
//! with the case that it is handed to.

use super::labels::load_labels;
use rotor_case::{ActuatorChoice, BiasChoice, Case, InflowChoice, LoadScaleChoice, TInflowChoice};
use rotor_export::{Axis, Document, LabelledArray};

/// Names of the arrays.
const SETTINGS: &str = "settings";
const LOAD_WEIGHT: &str = "load_weight";
/// How the notes on the inflow and on the actuator begin.
const INFLOW_NOTE: &str = "Inflow: ";
const ACTUATOR_NOTE: &str = "Actuator: ";
/// Difference of two numbers of the same meaning that is none, as a part of them.
const ALIKE: f64 = 1e-9;

/// A number of a case: name, unit, value, and the field that says it.
type Setting = (&'static str, &'static str, f64, &'static str);

/// Conditions of T0 and limits of a case; those of the flight where there is one.
fn of_case(case: &Case) -> Vec<Setting> {
    let (control, actuator) = (&case.control, &case.actuator);
    let is_held = matches!(control.bias, BiasChoice::Fixed(_));
    let is_over_baseline = control.load_scale == LoadScaleChoice::Baseline;
    let thrust = case.trim.ct_sigma().map(|value| ("ct_sigma", "", value, "trim"));
    let all = [
        ("rotor_rpm", "1/min", case.rotor.omega_rpm, "rotor.omega_rpm"),
        ("step_V", "V", case.t_step_volt(), "control.t_step_deg"),
        ("bench_rev_hz", "rev/s", actuator.bench_rev_hz, "actuator.bench_rev_hz"),
        ("bias_held", "", f64::from(u8::from(is_held)), "control.bias"),
        ("bias_V", "V", control.drive_bias().volt(), "control.bias_V"),
        ("lowest_V", "V", actuator.range_volt.0, "actuator.range_V"),
        ("highest_V", "V", actuator.range_volt.1, "actuator.range_V"),
        ("full_scale_V", "V", control.amplitude_volt, "control.amplitude_V"),
        ("weights_over_baseline", "", f64::from(u8::from(is_over_baseline)), "control.load_scale"),
    ];
    let flight = case.flight.iter().flat_map(|flight| {
        [
            ("amplitude_limit_V", "V", flight.amplitude_limit_volt, "flight.amplitude_limit_V"),
            ("rate_limit_V", "V", flight.rate_limit_volt, "flight.rate_limit_V"),
            ("rate_weight", "1/V^2", flight.rate_weight, "flight.rate_weight"),
            ("gain", "", flight.gain, "flight.gain"),
        ]
    });
    thrust.into_iter().chain(all).chain(flight).collect()
}

/// Weight of each of the twelve loads in `J`, that of the case.
fn weights(case: &Case) -> [f64; 12] {
    let w = &case.control.load_weights;
    let each = [w.fx, w.fy, w.fz, w.mx, w.my, w.mz];
    std::array::from_fn(|k| each[k / 2])
}

/// The arrays `settings` and `load_weight` of a case.
pub(super) fn arrays(case: &Case) -> [LabelledArray; 2] {
    let all = of_case(case);
    let of = |text: fn(&Setting) -> &'static str| all.iter().map(move |own| text(own).to_owned());
    let axis = Axis {
        name: "setting".to_owned(),
        labels: of(|own| own.0).collect(),
        units: of(|own| own.1).collect(),
    };
    let meaning = "what T was found with and is limited by: thrust over solidity that is trimmed to, rotor speed, step of T, bench time of a revolution, 1 where the bias is held and 0 where it follows the mean flap angle, bias, range and full scale of the actuator, 1 where the weights are over the squared load without control, limits, rate weight and gain of the flight";
    let settings = LabelledArray::from_fn(SETTINGS, meaning, vec![axis], |i, _, _| all[i].2);
    let axis = Axis::of_unit("load", load_labels(case), "");
    let weights = weights(case);
    let meaning = "diagonal of W in J = Z'WZ, loads over their `load_unit`";
    let weights = LabelledArray::from_fn(LOAD_WEIGHT, meaning, vec![axis], |i, _, _| weights[i]);
    [settings, weights]
}

/// The inflow of a case, and what it does in T.
pub(super) fn inflow_note(case: &Case) -> String {
    let inflow = match &case.inflow.model {
        InflowChoice::Uniform => "Uniform",
        InflowChoice::Drees => "Drees",
        InflowChoice::Prescribed { .. } => "Prescribed",
        InflowChoice::PittPeters => "PittPeters",
        InflowChoice::FreeWake(_) => "FreeWake",
    };
    let in_t = match case.control.t_inflow {
        TInflowChoice::Frozen => "held as in trim",
        TInflowChoice::Settled | TInflowChoice::Reconverged => {
            "settled on the moved loading, the geometry of a free wake held"
        }
    };
    format!("{INFLOW_NOTE}{inflow}; in T it is {in_t}. Pilot controls are held in T.")
}

/// The actuator that a case names.
pub(super) fn actuator_note(case: &Case) -> String {
    let actuator = match &case.actuator.model {
        ActuatorChoice::Ideal => {
            format!("Ideal, {} deg at full scale", case.actuator.ideal_amplitude_deg)
        }
        ActuatorChoice::Bench(own) => format!("Bench, data set `{}`", own.dataset),
        ActuatorChoice::File(own) => format!("File, `{}`", own.path),
    };
    format!("{ACTUATOR_NOTE}{actuator}.")
}

/// What a document says otherwise than a case, in sentences; that it says nothing where it does.
pub(super) fn mismatches(case: &Case, document: &Document) -> Vec<String> {
    let named = |name: &str| document.arrays.iter().find(|array| array.name == name);
    let (Some(settings), Some(weight)) = (named(SETTINGS), named(LOAD_WEIGHT)) else {
        return vec![
            "The T that is handed in comes without `settings` and `load_weight`: nobody can say whether it was found for the weights, limits and conditions of this case. The JSON of `hhc export --what t` holds them.".to_owned(),
        ];
    };
    let at = |array: &LabelledArray, label: &str| {
        let place = array.axes.first()?.labels.iter().position(|own| own == label)?;
        array.at(place, 0, 0)
    };
    let differs = |array: &LabelledArray, label: &str, own: f64, field: &str| {
        let found = at(array, label)?;
        let is_alike = (found - own).abs() <= ALIKE * found.abs().max(own.abs());
        (!is_alike).then(|| {
            format!(
                "The T that is handed in was found with `{label}` {found}, the case has {own} (`{field}`)."
            )
        })
    };
    let settings = of_case(case)
        .into_iter()
        .filter_map(|(label, _, own, field)| differs(settings, label, own, field));
    let labels = load_labels(case);
    // cosine and sine of a load have one weight
    let weights = labels
        .iter()
        .zip(weights(case))
        .step_by(2)
        .filter_map(|(label, own)| differs(weight, label, own, "control.load_weights"));
    let notes = [(INFLOW_NOTE, inflow_note(case)), (ACTUATOR_NOTE, actuator_note(case))];
    let notes = notes.into_iter().filter_map(|(start, own)| {
        let found = document.notes.iter().find(|note| note.starts_with(start))?;
        (**found != own).then(|| {
            format!("The T that is handed in was found otherwise. {found} The case has: {own}")
        })
    });
    settings.chain(weights).chain(notes).collect()
}

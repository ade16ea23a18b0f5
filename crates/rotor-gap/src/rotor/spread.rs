//! What a simulation of a rotor is not sure of: inputs of its case, and its own level of fidelity.

use crate::error::RotorGapError;
use measured_data::{Change, with_field_moved};
use rotor_case::{AttachedFlowModel, Case, InflowChoice, ModeNumbers, UncertainField};

/// What is taken for uncertain where a case says nothing: field and percent.
pub const USUAL_UNCERTAIN: [(&str, f64); 6] = [
    ("rotor.gj", 3.0),
    ("rotor.ei_flap", 2.0),
    ("rotor.ei_lag", 2.0),
    ("rotor.km2_r", 2.0),
    ("rotor.lock_number", 1.5),
    ("aerodynamics.drag_coefficient", 10.0),
];

/// Those that hold where a case says nothing.
pub fn usual_uncertain() -> Vec<UncertainField> {
    in_percent(&USUAL_UNCERTAIN)
}

/// Fields with their standard deviations in percent.
pub(crate) fn in_percent(fields: &[(&str, f64)]) -> Vec<UncertainField> {
    let one = |(field, percent): &(&str, f64)| UncertainField {
        field: (*field).to_owned(),
        sd_percent: Some(*percent),
        sd: None,
    };
    fields.iter().map(one).collect()
}

/// Uncertain fields in words; `from` says where they are stated.
pub fn stated(uncertain: &[UncertainField], from: &str) -> String {
    let one = |own: &UncertainField| match (own.sd_percent, own.sd) {
        (Some(percent), _) => format!("{} {percent} %", own.field),
        (None, sd) => format!("{} {}", own.field, sd.unwrap_or_default()),
    };
    let all: Vec<String> = uncertain.iter().map(one).collect();
    format!("uncertain (1 sd, {from}): {}", all.join(", "))
}

/// What uncertain inputs of these names were moved by, in words; none where none was.
pub(crate) fn moved_inputs<'a>(names: impl Iterator<Item = &'a str>, by: &[f64]) -> Option<String> {
    let moved = names.zip(by).filter(|(_, by)| **by != 0.0);
    let all: Vec<String> = moved.map(|(name, by)| format!("{name} {by:+.1} sd")).collect();
    let text = format!(
        "what was found is beside uncertain inputs as the points have them: {}",
        all.join(", ")
    );
    (!all.is_empty()).then_some(text)
}

/// The case with every uncertain field moved by so many of its standard deviations.
///
/// # Errors
/// [`RotorGapError::Uncertain`]: no such field, no number, no standard deviation or two.
pub fn with_inputs(
    case: &Case,
    uncertain: &[UncertainField],
    by: &[f64],
) -> Result<Case, RotorGapError> {
    let mut own = case.clone();
    for (number, (field, by)) in uncertain.iter().zip(by).enumerate() {
        own = moved(field, (number, *by), &own)?;
    }
    Ok(own)
}

/// The case with an uncertain field moved by some of its standard deviations; `number` is its place among them.
fn moved(
    own: &UncertainField,
    (number, by): (usize, f64),
    case: &Case,
) -> Result<Case, RotorGapError> {
    let refused =
        |reason: String| RotorGapError::Uncertain { number, field: own.field.clone(), reason };
    let is_good = |sd: &f64| sd.is_finite() && *sd > 0.0;
    let change = match (own.sd_percent.filter(is_good), own.sd.filter(is_good)) {
        (Some(percent), None) => Change::Times(1.0 + by * percent / 100.0),
        (None, Some(sd)) => Change::Plus(by * sd),
        _ => {
            let reason = "has no `sd_percent` or `sd` above 0, or both; give one of them";
            return Err(refused(reason.to_owned()));
        }
    };
    // a table stands in place of the uniform value of its name
    let tabled =
        own.field.split_once('.').map(|(section, name)| format!("{section}.tables.{name}"));
    let of_table = tabled.and_then(|path| with_field_moved(case, &path, change).ok());
    let found = of_table.map_or_else(|| with_field_moved(case, &own.field, change), Ok);
    let mut moved = found.map_err(refused)?;
    // what the text of a case does not hold
    moved.aerodynamics.tables.clone_from(&case.aerodynamics.tables);
    Ok(moved)
}

/// Other levels of fidelity of a case that are thought as good: what they explain is no discovery. Each with its name.
pub fn alternatives(case: &Case) -> Vec<(&'static str, Case)> {
    let with = |change: &dyn Fn(&mut Case)| {
        let mut own = case.clone();
        change(&mut own);
        own
    };
    let mut all = Vec::new();
    match case.inflow.model {
        InflowChoice::Drees => {
            all.push((
                "inflow of Pitt and Peters",
                with(&|c| c.inflow.model = InflowChoice::PittPeters),
            ));
        }
        InflowChoice::PittPeters | InflowChoice::Uniform => {
            all.push(("inflow of Drees", with(&|c| c.inflow.model = InflowChoice::Drees)));
        }
        InflowChoice::FreeWake(_) | InflowChoice::Prescribed { .. } => {}
    }
    let other = match case.aerodynamics.model {
        AttachedFlowModel::HariharanLeishman => AttachedFlowModel::Calibrated,
        AttachedFlowModel::Incompressible => AttachedFlowModel::QuasiSteady,
        _ => AttachedFlowModel::HariharanLeishman,
    };
    all.push(("sections of other lags", with(&|c| c.aerodynamics.model = other)));
    let ModeNumbers { flap, lag, torsion } = case.structure.modes;
    all.push((
        "one mode more of each kind",
        with(&|c| {
            c.structure.modes = ModeNumbers { flap: flap + 1, lag: lag + 1, torsion: torsion + 1 }
        }),
    ));
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_field_or_its_table_moves_by_its_deviation() {
        let case = Case::default();
        let of = |field: &str, sd_percent, sd| UncertainField {
            field: field.to_owned(),
            sd_percent,
            sd,
        };
        let shift = |own: &UncertainField, case: &Case| moved(own, (0, 1.0), case).unwrap();
        let changed = shift(&of("rotor.gj", Some(5.0), None), &case);
        assert!((changed.rotor.gj / case.rotor.gj - 1.05).abs() < 1e-12);
        let changed = shift(&of("rotor.precone_deg", None, Some(0.1)), &case);
        assert!((changed.rotor.precone_deg - case.rotor.precone_deg - 0.1).abs() < 1e-12);
        let mut tabled = case.clone();
        tabled.rotor.tables.gj = vec![(0.0, 0.006), (1.0, 0.005)];
        let changed = shift(&of("rotor.gj", Some(5.0), None), &tabled);
        assert!((changed.rotor.tables.gj[1].1 - 0.00525).abs() < 1e-12);
        assert!((changed.rotor.gj - case.rotor.gj).abs() < 1e-15);
        for usual in usual_uncertain() {
            assert_ne!(shift(&usual, &case), case, "{}", usual.field);
        }
        let text = |own: UncertainField| moved(&own, (3, 1.0), &case).unwrap_err().to_string();
        assert!(text(of("rotor.gjj", Some(5.0), None)).contains("uncertain[3]: `rotor.gjj`"));
        assert!(text(of("title", Some(5.0), None)).contains("no number"));
        assert!(text(of("rotor.gj", None, None)).contains("sd_percent"));
        assert!(text(of("rotor.gj", Some(-1.0), None)).contains("above 0"));
    }
}

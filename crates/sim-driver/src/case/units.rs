//! The unit of a field of a case by its path.

use rotor_case::{Case, Field, Section, Value, Visitor};

/// The unit of the field at a path such as `rotor.gj` or `flaps[0].start_r`, empty for a pure number, a word or a group; none
/// where the case has no such field.
pub fn unit_of(case: &Case, path: &str) -> Option<&'static str> {
    let mut search = Search { wanted: path, at: String::new(), unit: None };
    case.each(&mut search);
    search.unit
}

/// Walks over a case to the field that is wanted.
struct Search<'a> {
    wanted: &'a str,
    at: String,
    unit: Option<&'static str>,
}

impl Search<'_> {
    /// Does something one step further on the path.
    fn within(&mut self, step: &str, then: impl FnOnce(&mut Self)) {
        let before = self.at.len();
        self.at.push_str(step);
        then(self);
        self.at.truncate(before);
    }
}

impl Visitor for Search<'_> {
    fn field<T: Value>(&mut self, field: &Field, value: &T) {
        let dot = if self.at.is_empty() { "" } else { "." };
        self.within(&format!("{dot}{}", field.key), |search| {
            // one value of a list has the unit of all
            let rest = search.wanted.strip_prefix(&search.at);
            if rest.is_some_and(|rest| {
                rest.is_empty() || (rest.starts_with('[') && !rest.contains('.'))
            }) {
                search.unit = Some(field.unit);
            }
            value.inside(search);
        });
    }

    fn section<T: Section>(&mut self, _: &str, section: &T) {
        section.each(self);
    }

    fn item<T: Section>(&mut self, index: usize, section: &T) {
        self.within(&format!("[{index}]"), |search| section.each(search));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{FreeWakeValues, InflowChoice, PAPER_CASE, shipped_case};

    #[test]
    fn a_field_has_its_unit_wherever_it_stands() {
        let mut case = shipped_case(PAPER_CASE).unwrap().case;
        for (path, unit) in [
            ("advance_ratio", Some("")),
            ("rotor.gj", Some("m0 Omega^2 R^4")),
            ("rotor.radius_m", Some("m")),
            ("flaps[1].start_r", Some("R")),
            ("flaps[1]", Some("")),
            ("flaps[9].start_r", None),
            ("control.harmonics[0]", Some("1/rev")),
            ("inflow.model", Some("")),
            ("inflow.model.core_r", None),
            ("rotor.g", None),
            ("", None),
        ] {
            assert_eq!(unit_of(&case, path), unit, "{path}");
        }
        case.inflow.model = InflowChoice::FreeWake(FreeWakeValues::default());
        assert_eq!(unit_of(&case, "inflow.model.core_r"), Some("R"));
    }
}

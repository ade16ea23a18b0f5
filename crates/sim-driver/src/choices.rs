//! Choices of case files on the command line and of other callers, by the names that serde knows.

use crate::problem::{Fault, Place, Problem, Problems};
use bench_study::identification::ModelChoice;
use clap::ValueEnum;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use preisach_dyn::identify::Family;
use rotor_case::variant_names;
use serde::de::value::{Error, StrDeserializer};
use serde::de::{DeserializeOwned, IntoDeserializer};

/// A name in lower case, its words set apart: `hariharan-leishman` for `HariharanLeishman`.
pub(crate) fn spelt(name: &str, separator: char) -> String {
    let mut text = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() && !text.is_empty() {
            text.push(separator);
        }
        text.push(c.to_ascii_lowercase());
    }
    text
}

/// A choice without fields by its name, spelt as on the command line; `option` is what it was given as.
///
/// # Errors
/// A name that is not known, with those that are.
pub fn choice_named<T: DeserializeOwned>(option: &str, given: &str) -> Result<T, Problem> {
    let names = variant_names::<T>();
    let found = names.iter().find(|name| spelt(name, '-') == given);
    let read = found.and_then(|name| {
        let name: StrDeserializer<'_, Error> = name.into_deserializer();
        T::deserialize(name).ok()
    });
    read.ok_or_else(|| unknown(option, given, names.iter().map(|name| spelt(name, '-'))))
}

/// A choice of the command line by its name.
///
/// # Errors
/// As [`choice_named`].
pub fn value_named<T: ValueEnum>(option: &str, given: &str) -> Result<T, Problem> {
    let known = T::value_variants().iter().filter_map(ValueEnum::to_possible_value);
    let known = known.map(|value| value.get_name().to_owned());
    T::from_str(given, false).map_err(|_| unknown(option, given, known))
}

/// A family of models by its name; `best` leaves the choice to cross-validation.
///
/// # Errors
/// As [`choice_named`].
pub fn model_named(option: &str, given: &str) -> Result<ModelChoice, Problem> {
    let names = || Family::ALL.map(|family| spelt(&format!("{family:?}"), '-'));
    if given == BEST {
        return Ok(None);
    }
    let found = Family::ALL.into_iter().zip(names()).find(|(_, name)| name == given);
    let known = std::iter::once(BEST.to_owned()).chain(names());
    found.map(|(family, _)| Some(family)).ok_or_else(|| unknown(option, given, known))
}

/// Refuses a number of the command line that is out of its range.
pub(crate) fn check_range(
    problems: &mut Problems,
    option: &str,
    value: f64,
    [low, high]: [f64; 2],
    unit: &'static str,
    remedy: &'static str,
) {
    if !(low..=high).contains(&value) {
        problems.push(Place::file(option), Fault::OutOfRange { value, low, high, unit, remedy });
    }
}

/// The choice that is left to cross-validation.
const BEST: &str = "best";

fn unknown(option: &str, given: &str, known: impl Iterator<Item = String>) -> Problem {
    let known = known.collect::<Vec<_>>().join(", ");
    let found = given.to_owned();
    let fault = Fault::Unknown { what: "choice", found, known, nearest: None };
    Problem::new(Place::file(option), fault)
}

/// Reads a choice of models from the command line; with `best` that of cross-validation is one.
pub(crate) fn model_parser(with_best: bool) -> impl TypedValueParser<Value = ModelChoice> {
    let spelling = |family: Family| spelt(&format!("{family:?}"), '-');
    let best = PossibleValue::new(BEST)
        .help("the one that cross-validation over the training runs chooses");
    // the parser keeps its names as long as the program runs
    let families =
        Family::ALL.map(|family| PossibleValue::new(&*spelling(family).leak()).help(family.name()));
    PossibleValuesParser::new(Some(best).filter(|_| with_best).into_iter().chain(families))
        .map(move |given| Family::ALL.into_iter().find(|family| spelling(*family) == given))
}

/// Reads a choice without fields from the command line, spelt in lower case with hyphens.
pub(crate) fn choice_parser<T>() -> impl TypedValueParser<Value = T>
where
    T: DeserializeOwned + Clone + Send + Sync + 'static,
{
    // the parser keeps its names as long as the program runs
    let possible = variant_names::<T>().iter().map(|name| &*spelt(name, '-').leak());
    PossibleValuesParser::new(possible).try_map(|given| {
        let name = variant_names::<T>().iter().find(|name| spelt(name, '-') == given);
        let name: StrDeserializer<'_, Error> =
            name.copied().unwrap_or_default().into_deserializer();
        T::deserialize(name)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use flap_aero::AttachedFlowModel;

    #[test]
    fn a_choice_is_spelt_in_lower_case_with_hyphens() {
        for (model, name) in AttachedFlowModel::ALL.iter().zip(variant_names::<AttachedFlowModel>())
        {
            assert_eq!(spelt(name, '-'), model.name());
        }
    }
}

//! Choices of case files on the command line, by the names that serde knows.

use bench_study::identification::ModelChoice;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use preisach_dyn::identify::Family;
use rotor_study::case::variant_names;
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

/// Reads a choice of models from the command line.
pub(crate) fn model_parser() -> impl TypedValueParser<Value = ModelChoice> {
    let spelling = |family: Family| spelt(&format!("{family:?}"), '-');
    let best = PossibleValue::new("best")
        .help("the one that cross-validation over the training runs chooses");
    // the parser keeps its names as long as the program runs
    let families =
        Family::ALL.map(|family| PossibleValue::new(&*spelling(family).leak()).help(family.name()));
    PossibleValuesParser::new(std::iter::once(best).chain(families))
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

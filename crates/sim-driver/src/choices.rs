//! Choices of case files on the command line, by the names that serde knows.

use clap::builder::{PossibleValuesParser, TypedValueParser};
use rotor_study::case::variant_names;
use serde::de::value::{Error, StrDeserializer};
use serde::de::{DeserializeOwned, IntoDeserializer};

/// `hariharan-leishman` for `HariharanLeishman`.
fn kebab(name: &str) -> String {
    let mut text = String::new();
    for c in name.chars() {
        if c.is_ascii_uppercase() && !text.is_empty() {
            text.push('-');
        }
        text.push(c.to_ascii_lowercase());
    }
    text
}

/// Reads a choice without fields from the command line, spelt in lower case with hyphens.
pub(crate) fn choice_parser<T>() -> impl TypedValueParser<Value = T>
where
    T: DeserializeOwned + Clone + Send + Sync + 'static,
{
    // the parser keeps its names as long as the program runs
    let spelt: Vec<(&'static str, &'static str)> =
        variant_names::<T>().iter().map(|name| (&*kebab(name).leak(), *name)).collect();
    let possible: Vec<&'static str> = spelt.iter().map(|(given, _)| *given).collect();
    PossibleValuesParser::new(possible).try_map(move |given| {
        let known = spelt.iter().find(|(spelling, _)| *spelling == given);
        let name = known.map(|(_, name)| *name).unwrap_or_default();
        let name: StrDeserializer<'_, Error> = name.into_deserializer();
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
            assert_eq!(kebab(name), model.name());
        }
    }
}

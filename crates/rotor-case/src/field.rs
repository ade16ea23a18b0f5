//! A field of a case is stated once: name, default, range, unit, remedy and meaning, beside each other.
//!
//! [`section!`](macro@section) makes a struct of the fields and lets a [`Visitor`] walk over them. The checks
//! of values, the page of case fields and the commented case to start from are three such walks.

use super::CaseFault;
use serde::de::value::Error;
use serde::de::{DeserializeOwned, Error as _, Visitor as SerdeVisitor};
use serde::{Deserializer, Serialize, forward_to_deserialize_any};

/// What a value must be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Anything of its type.
    Any,
    /// A number between two others, both included.
    Within(f64, f64),
    /// A number above 0, no larger than this.
    UpTo(f64),
    /// A whole number between two others, both included.
    Count(usize, usize),
    /// A rule with other fields, in words; the code that checks it stands in `rules`.
    Rule(&'static str),
}

/// A field of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Field {
    /// Its name in a file.
    pub key: &'static str,
    /// Its meaning, line by line.
    pub meaning: &'static [&'static str],
    /// What its value must be.
    pub range: Range,
    /// Its unit, empty for a pure number.
    pub unit: &'static str,
    /// What to do if the value is not in its range.
    pub remedy: &'static str,
}

/// Visits the fields of a section.
pub trait Visitor {
    /// A field and its value.
    fn field<T: Value>(&mut self, field: &Field, value: &T);
    /// The section that is the value of a field, behind the name of a choice if it belongs to one.
    fn section<T: Section>(&mut self, choice: &str, section: &T);
    /// A section of a list.
    fn item<T: Section>(&mut self, index: usize, section: &T);
}

/// A value of a case.
pub trait Value: Serialize + DeserializeOwned {
    /// What is wrong with it; nothing if it is in range.
    fn fault(&self, _range: &Field) -> Option<CaseFault> {
        None
    }

    /// Names of the choices there are, those that serde reads; none of what is no choice.
    fn choices() -> &'static [&'static str] {
        variant_names::<Self>()
    }

    /// The values of a table along the span, behind their stations; nothing of another value.
    fn table(&self) -> Option<&[(f64, f64)]> {
        None
    }

    /// Walks over the fields inside; false if it has none.
    fn inside<V: Visitor>(&self, _visitor: &mut V) -> bool {
        false
    }
}

/// A group of fields.
pub trait Section: Value + Default {
    /// What the section is, line by line.
    const ABOUT: &'static [&'static str];

    /// Walks over the fields in the order of the file.
    fn each<V: Visitor>(&self, visitor: &mut V);
}

/// A struct of fields, each with its default, what its value must be, and its remedy:
/// `/// Meaning.` `pub name as "key": type = default, range, "unit", "remedy";`
macro_rules! section {
    (
        $(#[doc = $about:literal])+
        $(#[derive($($derive:ident),+)])?
        #[serde($($container:tt)+)]
        pub struct $name:ident {
            $(
                $(#[doc = $meaning:literal])+
                $(#[serde($($serde:tt)+)])?
                pub $field:ident $(as $key:literal)?: $type:ty = $default:expr, $range:expr, $unit:literal, $remedy:literal;
            )+
        }
        $(apart {
            $(
                $(#[doc = $apart_doc:literal])+
                pub $apart:ident: $apart_type:ty = $apart_default:expr;
            )+
        })?
    ) => {
        $(#[doc = $about])+
        #[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize $($(, $derive)+)?)]
        #[serde($($container)+)]
        pub struct $name {
            $(
                $(#[doc = $meaning])+
                $(#[serde(rename = $key)])?
                $(#[serde($($serde)+)])?
                pub $field: $type,
            )+
            $($(
                $(#[doc = $apart_doc])+
                #[serde(skip)]
                pub $apart: $apart_type,
            )+)?
        }

        impl Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)+ $($($apart: $apart_default,)+)? }
            }
        }

        impl $crate::field::Value for $name {
            fn inside<V: $crate::field::Visitor>(&self, visitor: &mut V) -> bool {
                visitor.section("", self);
                true
            }
        }

        impl $crate::field::Section for $name {
            const ABOUT: &'static [&'static str] = &[$($about),+];

            fn each<V: $crate::field::Visitor>(&self, visitor: &mut V) {
                #[allow(unused_imports, reason = "ranges of some sections only")]
                use $crate::field::Range::{Any, Count, Rule, UpTo, Within};
                $(visitor.field(
                    &$crate::field::Field {
                        key: $crate::field::section!(@key $field $($key)?),
                        meaning: &[$($meaning),+],
                        range: $range,
                        unit: $unit,
                        remedy: $remedy,
                    },
                    &self.$field,
                );)+
            }
        }
    };
    (@key $field:ident $key:literal) => { $key };
    (@key $field:ident) => { stringify!($field) };
}
pub(crate) use section;

/// Values without a range of their own. Of a choice, the variants in braces hold a section to walk over.
macro_rules! values {
    ($($name:ty $({ $($variant:ident),+ })?),+ $(,)?) => {
        $(impl $crate::field::Value for $name {
            $(fn inside<V: $crate::field::Visitor>(&self, visitor: &mut V) -> bool {
                $(if let Self::$variant(section) = self {
                    visitor.section(stringify!($variant), section);
                    return true;
                })+
                false
            })?
        })+
    };
}
pub(crate) use values;

values!(
    flap_aero::AttachedFlowModel,
    rotor_fem::ModalBasis,
    rotor_fem::RootSupport,
    rotor_fem::TwistAngle,
    rotor_fem::Untwist,
    rotor_response::FlapMass,
    rotor_response::ReverseFlow,
    rotor_wake::ControlPoint,
    rotor_wake::CoreModel,
    rotor_wake::FarField,
    rotor_wake::NearWakeMotion,
    rotor_wake::ReleasePoint,
    rotor_wake::WakeMethod,
    rotor_wake::WakeSymmetry,
    // checked by rules
    Vec<f64>,
    Vec<usize>,
    Vec<Vec<usize>>,
    (f64, f64),
);

impl Value for f64 {
    fn fault(&self, field: &Field) -> Option<CaseFault> {
        let (value, Field { range, unit, remedy, .. }) = (*self, *field);
        match range {
            Range::Within(low, high) => CaseFault::of_number(value, (low, high), unit, remedy),
            Range::UpTo(_) if !(value > 0.0 && value.is_finite()) => {
                Some(CaseFault::NotPositive { value, unit, remedy })
            }
            Range::UpTo(most) => {
                (value > most).then_some(CaseFault::Beyond { value, most, unit, remedy })
            }
            Range::Any | Range::Count(..) | Range::Rule(_) => None,
        }
    }
}

impl Value for usize {
    fn fault(&self, field: &Field) -> Option<CaseFault> {
        let Range::Count(low, high) = field.range else { return None };
        CaseFault::of_count(*self, (low, high), field.remedy)
    }
}

impl Value for String {
    fn fault(&self, field: &Field) -> Option<CaseFault> {
        let message = || format!("is empty; give {}", field.remedy);
        self.trim().is_empty().then(|| CaseFault::Rule { message: message() })
    }
}

impl<T: Value> Value for Option<T> {
    fn choices() -> &'static [&'static str] {
        T::choices()
    }

    fn fault(&self, field: &Field) -> Option<CaseFault> {
        self.as_ref().and_then(|value| value.fault(field))
    }

    fn inside<V: Visitor>(&self, visitor: &mut V) -> bool {
        self.as_ref().is_some_and(|value| value.inside(visitor))
    }
}

impl<T: Section> Value for Vec<T> {
    fn inside<V: Visitor>(&self, visitor: &mut V) -> bool {
        for (index, section) in self.iter().enumerate() {
            visitor.item(index, section);
        }
        true
    }
}

impl Value for Vec<(f64, f64)> {
    fn table(&self) -> Option<&[(f64, f64)]> {
        Some(self)
    }
}

/// Whether a value is the default of its type: not written then.
pub(crate) fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

/// Takes note of the names of the variants of an enum, then gives up.
struct Variants<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for Variants<'_> {
    type Error = Error;

    fn deserialize_any<V: SerdeVisitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        Err(Error::custom("not an enum"))
    }

    fn deserialize_enum<V: SerdeVisitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Error> {
        *self.0 = variants;
        Err(Error::custom("only its names are wanted"))
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit
        unit_struct newtype_struct seq tuple tuple_struct map struct identifier ignored_any
    }
}

/// Names of the variants of an enum as files spell them; none of any other type.
pub fn variant_names<T: DeserializeOwned>() -> &'static [&'static str] {
    let mut names: &'static [&'static str] = &[];
    // ends in an error in any case
    drop(T::deserialize(Variants(&mut names)));
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_names_of_a_choice_are_those_of_files() {
        let names = ["QuasiSteady", "Incompressible", "HariharanLeishman", "Calibrated"];
        assert_eq!(variant_names::<flap_aero::AttachedFlowModel>(), names);
        assert!(variant_names::<f64>().is_empty());
    }
}

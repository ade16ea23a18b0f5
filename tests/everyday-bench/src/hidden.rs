//! What a set hides: by name, or by its seed.

use std::str::FromStr;

use crate::catalogue::{CATALOGUE, Effect, LIBRARY, PAIRS, Sizes};
use crate::draw::Draw;
use crate::error::EverydayError;

/// What kind of thing a set hides.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Nothing.
    Null,
    /// One cause of a usual library.
    Single,
    /// One everyday error.
    Everyday,
    /// Two of unlike kind.
    Pair,
    /// The reference runs are of another actuator.
    Foreign,
}

/// Which sets seeds are dealt.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Deal {
    /// One null, two singles, two everyday errors of five.
    #[default]
    All,
    /// Everyday errors, pairs, foreign and small reference runs.
    Everyday,
    /// Causes of a usual library.
    Singles,
    /// Nothing.
    Nulls,
}

impl FromStr for Deal {
    type Err = EverydayError;

    fn from_str(text: &str) -> Result<Self, EverydayError> {
        match text {
            "all" => Ok(Self::All),
            "everyday" => Ok(Self::Everyday),
            "singles" => Ok(Self::Singles),
            "nulls" => Ok(Self::Nulls),
            _ => Err(EverydayError::UnknownName {
                what: "kind",
                found: text.to_owned(),
                known: "all, everyday, singles, nulls".to_owned(),
            }),
        }
    }
}

/// One part of what is hidden.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// The effect.
    pub effect: Effect,
    /// Its size, where it is given: a share of the output for causes of a usual library, else its own quantity.
    pub size: Option<f64>,
}

/// What a set hides.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hidden {
    /// Its parts; none for a null set.
    pub parts: Vec<Part>,
}

impl Hidden {
    fn of(effects: &[Effect]) -> Self {
        Self { parts: effects.iter().map(|effect| Part { effect: *effect, size: None }).collect() }
    }

    /// What a seed hides. Seeds that follow one another are dealt each entry once before any comes again.
    pub fn of_seed(seed: u64, deal: Deal) -> Self {
        let everyday = || {
            let errors: Vec<Vec<Effect>> = CATALOGUE[LIBRARY..]
                .iter()
                .map(|entry| vec![entry.effect])
                .chain(PAIRS.iter().map(|pair| pair.to_vec()))
                .collect();
            errors
        };
        let singles = || CATALOGUE[..LIBRARY].iter().map(|entry| vec![entry.effect]).collect();
        let (list, index): (Vec<Vec<Effect>>, u64) = match (deal, seed % 5) {
            (Deal::Nulls, _) | (Deal::All, 0) => return Self::default(),
            (Deal::Everyday, _) => (everyday(), seed),
            (Deal::Singles, _) => (singles(), seed),
            // two of each in five seeds
            (Deal::All, place @ (1 | 2)) => (everyday(), seed / 5 * 2 + place - 1),
            (Deal::All, place) => (singles(), seed / 5 * 2 + place - 3),
        };
        let count = list.len() as u64;
        let order = Draw::new("deal", &[index / count, count]).order(list.len());
        let place = usize::try_from(index % count).unwrap_or(0);
        Self::of(&list[order[place]])
    }

    /// The name: `null`, an id, two ids joined by `+`.
    pub fn id(&self) -> String {
        let ids: Vec<&str> = self.parts.iter().map(|part| part.effect.entry().id).collect();
        if ids.is_empty() { "null".to_owned() } else { ids.join("+") }
    }

    /// Its kind.
    pub fn kind(&self) -> Kind {
        match self.parts[..] {
            [] | [Part { effect: Effect::SmallReference, .. }] => Kind::Null,
            [Part { effect: Effect::ForeignReference, .. }] => Kind::Foreign,
            [Part { effect, .. }] if (effect as usize) < LIBRARY => Kind::Single,
            [_] => Kind::Everyday,
            _ => Kind::Pair,
        }
    }

    /// Whether an effect is among the parts.
    pub fn has(&self, effect: Effect) -> bool {
        self.parts.iter().any(|part| part.effect == effect)
    }
}

impl FromStr for Hidden {
    type Err = EverydayError;

    /// `null`, or `ID[:SIZE]`, or several of them joined by `+`.
    fn from_str(text: &str) -> Result<Self, EverydayError> {
        if text == "null" {
            return Ok(Self::default());
        }
        let part = |text: &str| {
            let (id, size) = text.split_once(':').map_or((text, None), |(id, s)| (id, Some(s)));
            let entry = CATALOGUE.iter().find(|entry| entry.id == id);
            let entry = entry.ok_or_else(|| EverydayError::UnknownName {
                what: "effect",
                found: id.to_owned(),
                known: CATALOGUE.map(|entry| entry.id).join(", "),
            })?;
            let effect = entry.effect;
            let Some(size) = size else { return Ok(Part { effect, size: None }) };
            let wrong = |expected| EverydayError::Size {
                what: id.to_owned(),
                found: size.to_owned(),
                expected,
            };
            let value: f64 = size.parse().map_err(|_| wrong("a number"))?;
            let accepted = match entry.sizes {
                Sizes::None => return Err(wrong("left out")),
                Sizes::Share { .. } => value > 0.0 && value < 1.0,
                Sizes::Own { choices, .. } => value.abs() <= 10.0 * choices[2].abs(),
            };
            let is_time = matches!(effect, Effect::AmplifierDelay | Effect::AmplifierSecondOrder);
            if !accepted || (is_time && value <= 0.0) {
                return Err(wrong("a share between 0 and 1, or at most ten times the usual"));
            }
            Ok(Part { effect, size: Some(value) })
        };
        Ok(Self { parts: text.split('+').map(part).collect::<Result<_, _>>()? })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_entry_is_dealt_before_any_comes_again() {
        for (deal, count) in [(Deal::Everyday, 23), (Deal::Singles, 15)] {
            for block in 0..3 {
                let ids: BTreeSet<String> = (block * count..(block + 1) * count)
                    .map(|seed| Hidden::of_seed(seed, deal).id())
                    .collect();
                assert_eq!(ids.len() as u64, count);
            }
        }
        let all: Vec<Kind> = (0..100).map(|s| Hidden::of_seed(s, Deal::All).kind()).collect();
        assert_eq!(all.iter().filter(|kind| **kind == Kind::Single).count(), 40);
    }

    #[test]
    fn names_are_read_back_and_wrong_ones_refused() {
        let pair: Hidden = "amplifier-gain:-0.05+transport-delay".parse().unwrap();
        assert_eq!(pair.id(), "amplifier-gain+transport-delay");
        assert_eq!((pair.parts[0].size, pair.parts[1].size), (Some(-0.05), None));
        assert_eq!(pair.kind(), Kind::Pair);
        for wrong in
            ["gain", "sensor-gain:much", "creep:2", "small-reference:1", "amplifier-delay:-1"]
        {
            assert!(wrong.parse::<Hidden>().is_err(), "{wrong}");
        }
    }
}

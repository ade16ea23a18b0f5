//! Families of rate-independent hysteresis.

mod duhem;
mod relays;

use std::str::FromStr;

use duhem::Duhem;
use relays::Relays;

use crate::error::EverydayError;

/// A family.
#[derive(
    Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, serde::Serialize, serde::Deserialize,
)]
#[serde(rename_all = "kebab-case")]
pub enum Family {
    /// Relays with random thresholds.
    Relays,
    /// Bouc-Wen elements and bent plays.
    Duhem,
}

impl Family {
    /// The name in files.
    pub fn id(self) -> &'static str {
        match self {
            Self::Relays => "relays",
            Self::Duhem => "duhem",
        }
    }
}

impl FromStr for Family {
    type Err = EverydayError;

    fn from_str(text: &str) -> Result<Self, EverydayError> {
        match text {
            "relays" => Ok(Self::Relays),
            "duhem" => Ok(Self::Duhem),
            _ => Err(EverydayError::UnknownName {
                what: "family",
                found: text.to_owned(),
                known: "relays, duhem".to_owned(),
            }),
        }
    }
}

/// A hysteresis with its state; the output has no unit.
#[derive(Debug, Clone)]
pub(crate) enum Law {
    Relays(Relays),
    Duhem(Duhem),
}

impl Law {
    /// The law of a seed.
    pub(crate) fn new(family: Family, seed: u64) -> Self {
        match family {
            Family::Relays => Self::Relays(Relays::of_seed(seed)),
            Family::Duhem => Self::Duhem(Duhem::of_seed(seed)),
        }
    }

    /// The output when the voltage has run straight to `volt`.
    pub(crate) fn run_to(&mut self, volt: f64) -> f64 {
        match self {
            Self::Relays(relays) => relays.run_to(volt),
            Self::Duhem(duhem) => duhem.run_to(volt),
        }
    }

    /// Loops of shrinking amplitude about a voltage, as before every run of a bench.
    pub(crate) fn condition(&mut self, volt: f64) {
        const LOOPS: u32 = 60;
        for i in 0..LOOPS {
            let amplitude = 85.0 * (1.0 - f64::from(i) / f64::from(LOOPS));
            self.run_to(volt + amplitude);
            self.run_to(volt - amplitude);
        }
        self.run_to(volt);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn relays_close_loops_and_forget_what_a_larger_loop_passes_over() {
        for seed in 0..4 {
            let mut law = Law::new(Family::Relays, seed);
            law.condition(65.0);
            law.run_to(140.0);
            let before = law.run_to(20.0);
            // a minor loop comes back to where it began
            law.run_to(90.0);
            law.run_to(50.0);
            law.run_to(80.0);
            let after = law.run_to(20.0);
            assert!((before - after).abs() < 1e-12, "{before} {after}");
            // and two histories are one after the same large loop
            let mut other = Law::new(Family::Relays, seed);
            for (own, foreign) in [(30.0, 100.0), (33.0, -5.0), (150.0, 150.0), (-20.0, -20.0)] {
                law.run_to(own);
                other.run_to(foreign);
            }
            assert!((law.run_to(77.0) - other.run_to(77.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn a_straight_run_does_not_depend_on_where_it_is_sampled() {
        for family in [Family::Relays, Family::Duhem] {
            let mut coarse = Law::new(family, 3);
            let mut fine = coarse.clone();
            for target in [120.0_f64, -10.0, 60.0, 31.0, 149.0] {
                let from = if target > 100.0 { 0.0 } else { target + 40.0 };
                let (a, b) = (coarse.run_to(from), fine.run_to(from));
                assert!((a - b).abs() < 1e-9);
                for i in 1..=50 {
                    fine.run_to(from + (target - from) * f64::from(i) / 50.0);
                }
                assert!((coarse.run_to(target) - fine.run_to(target)).abs() < 1e-9, "{family:?}");
            }
        }
    }
}

//! Choosing cases of the sweep: `mu=0.30,n=3`.

use super::sweep::{ADVANCE_RATIOS, HARMONICS_PER_REV, SweepPoint};
use crate::XtaskError;

/// Which cases are wanted; an empty list means all.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Filter {
    advance_ratios: Vec<f64>,
    harmonics_per_rev: Vec<u32>,
}

impl Filter {
    /// A filter from text: `mu=...` and `n=...` between commas; a key given twice means either value.
    ///
    /// # Errors
    /// [`XtaskError::Filter`] for a key or number that is not understood, and for a value the sweep
    /// does not have.
    pub fn parse(text: &str) -> Result<Self, XtaskError> {
        let refused = |problem| XtaskError::Filter {
            text: text.to_owned(),
            problem,
            available: format!("mu {ADVANCE_RATIOS:?}, n {HARMONICS_PER_REV:?}"),
        };
        let mut filter = Self::default();
        for part in text.split(',').map(str::trim).filter(|part| !part.is_empty()) {
            let (key, value) = part.split_once('=').ok_or_else(|| refused("no `=` in it"))?;
            match key.trim() {
                "mu" => {
                    let wanted: f64 =
                        value.trim().parse().map_err(|_| refused("mu is not a number"))?;
                    let known = ADVANCE_RATIOS.into_iter().find(|mu| (mu - wanted).abs() < 1e-9);
                    let known = known.ok_or_else(|| refused("no case has this mu"))?;
                    filter.advance_ratios.push(known);
                }
                "n" => {
                    let wanted: u32 =
                        value.trim().parse().map_err(|_| refused("n is not a whole number"))?;
                    if !HARMONICS_PER_REV.contains(&wanted) {
                        return Err(refused("no case has this n"));
                    }
                    filter.harmonics_per_rev.push(wanted);
                }
                _ => return Err(refused("only mu and n can be chosen")),
            }
        }
        Ok(filter)
    }

    /// Whether a case is wanted.
    pub fn admits(&self, point: &SweepPoint) -> bool {
        let mu = &self.advance_ratios;
        let n = &self.harmonics_per_rev;
        (mu.is_empty() || mu.iter().any(|mu| (mu - point.advance_ratio).abs() < 1e-9))
            && (n.is_empty() || n.contains(&point.harmonic_per_rev))
    }

    /// Whether every case is wanted.
    pub fn is_everything(&self) -> bool {
        *self == Self::default()
    }
}

#[cfg(test)]
mod tests {
    use super::super::sweep::all_points;
    use super::*;

    fn count(text: &str) -> usize {
        let filter = Filter::parse(text).unwrap();
        all_points().iter().filter(|point| filter.admits(point)).count()
    }

    #[test]
    fn cases_are_chosen() {
        // six advance ratios by four harmonics, and 4/rev in a free wake at five of them
        assert_eq!([count(""), count("mu=0.30"), count("mu=.3, n=3")], [29, 5, 1]);
        assert_eq!([count("n=2"), count("n=2,n=5"), count("mu=0.1,mu=0.35,n=4")], [6, 12, 3]);
        assert!(Filter::parse("").unwrap().is_everything());
        assert!(!Filter::parse("n=2").unwrap().is_everything());
    }

    #[test]
    fn what_is_not_understood_is_refused_with_the_remedy() {
        for bad in ["mu", "mu=x", "n=3.5", "n=6", "mu=0.31", "speed=3", "mu=NaN"] {
            let message = Filter::parse(bad).unwrap_err().to_string();
            assert!(message.contains(bad) && message.contains("0.15"), "{message}");
        }
    }
}

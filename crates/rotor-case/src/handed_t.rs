//! T that a user hands in: what the controller knows of the rotor, which stays what it is.

use hhc_control::{ControlError, TMatrix};

/// T of several sets of harmonics over the advance ratio, hub loads alone, for actuators driven by volts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HandedT {
    /// One entry per set.
    pub sets: Vec<HandedSet>,
    /// What it was found with otherwise than the case has it, in sentences.
    pub told: Vec<String>,
}

/// T of one set of harmonics.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct HandedSet {
    /// Harmonics per rev, in the order of the controls.
    pub harmonics: Vec<usize>,
    /// Advance ratios, rising.
    pub advance_ratios: Vec<f64>,
    /// Columns at each of them: a control each, flap by flap, harmonic by harmonic, cosine then sine; nondimensional load per V.
    pub columns: Vec<Vec<Vec<f64>>>,
}

/// Why a T that was handed in does not serve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum HandedTError {
    /// The file holds no T of a set.
    #[error(
        "the file holds T of {}, not of {} per rev: control a set that it has, or export T with that set",
        sets(held),
        set(wanted)
    )]
    NoSet {
        /// Sets that it holds.
        held: Vec<Vec<usize>>,
        /// Set asked for.
        wanted: Vec<usize>,
    },
    /// The advance ratio lies beyond those of the file.
    #[error(
        "T is given at advance ratios of {low} to {high}, asked for at {wanted}: fly within them, or export T there"
    )]
    BeyondAdvanceRatios {
        /// Least one given.
        low: f64,
        /// Largest one given.
        high: f64,
        /// The one asked for.
        wanted: f64,
    },
    /// The numbers are no T.
    #[error(transparent)]
    Numbers(#[from] ControlError),
}

fn set(harmonics: &[usize]) -> String {
    harmonics.iter().map(usize::to_string).collect::<Vec<_>>().join("+")
}

fn sets(all: &[Vec<usize>]) -> String {
    if all.is_empty() {
        return "no set".to_owned();
    }
    all.iter().map(|own| set(own)).collect::<Vec<_>>().join(", ") + " per rev"
}

/// Difference of advance ratios that names of points, with four digits, do not tell apart.
const SAME_POINT: f64 = 5.1e-5;

impl HandedT {
    /// The set of these harmonics, in this order.
    ///
    /// # Errors
    /// [`HandedTError::NoSet`].
    pub fn set(&self, harmonics: &[usize]) -> Result<&HandedSet, HandedTError> {
        let found = self.sets.iter().find(|own| own.harmonics == harmonics);
        found.ok_or_else(|| HandedTError::NoSet {
            held: self.sets.iter().map(|own| own.harmonics.clone()).collect(),
            wanted: harmonics.to_vec(),
        })
    }
}

impl HandedSet {
    /// T at an advance ratio: that of a point to the bit, linear between two.
    ///
    /// # Errors
    /// [`HandedTError::BeyondAdvanceRatios`], [`HandedTError::Numbers`].
    pub fn at(&self, advance_ratio: f64) -> Result<TMatrix, HandedTError> {
        let points = &self.advance_ratios;
        let same = |point: &f64| (point - advance_ratio).abs() <= SAME_POINT;
        if let Some(k) = points.iter().position(same) {
            return Ok(TMatrix::from_columns(&self.columns[k])?);
        }
        let above = points.partition_point(|point| *point < advance_ratio);
        if above == 0 || above == points.len() {
            let (low, high) = (points.first().copied(), points.last().copied());
            return Err(HandedTError::BeyondAdvanceRatios {
                low: low.unwrap_or(f64::NAN),
                high: high.unwrap_or(f64::NAN),
                wanted: advance_ratio,
            });
        }
        let (low, high) = (points[above - 1], points[above]);
        let share = (advance_ratio - low) / (high - low);
        let pairs = self.columns[above - 1].iter().zip(&self.columns[above]);
        let columns: Vec<Vec<f64>> = pairs
            .map(|(a, b)| a.iter().zip(b).map(|(a, b)| (1.0 - share) * a + share * b).collect())
            .collect();
        Ok(TMatrix::from_columns(&columns)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn t_is_that_of_a_point_and_linear_between_two() {
        let column = |value: f64| vec![vec![value, -value], vec![2.0 * value, 0.5]];
        let own = HandedSet {
            harmonics: vec![3],
            advance_ratios: vec![0.15, 0.3],
            columns: vec![column(0.1 + 0.2), column(1.0)],
        };
        let handed = HandedT { sets: vec![own], ..HandedT::default() };
        let at = |mu: f64| handed.set(&[3]).unwrap().at(mu).unwrap();
        assert_eq!(at(0.15).columns(), column(0.1 + 0.2));
        assert_eq!(at(0.300_04).columns(), column(1.0));
        let between = at(0.20).columns();
        assert!((between[0][0] - (0.3 * 2.0 / 3.0 + 1.0 / 3.0)).abs() < 1e-15, "{between:?}");
        let beyond = handed.set(&[3]).unwrap().at(0.35).unwrap_err().to_string();
        assert!(beyond.contains("0.15 to 0.3, asked for at 0.35"), "{beyond}");
        let missing = handed.set(&[4, 5]).unwrap_err().to_string();
        assert!(missing.contains("T of 3 per rev, not of 4+5 per rev"), "{missing}");
    }
}

//! How the control vector is laid out.

use crate::{ControlError, error};
use rotor_base::{Harmonic, wrap_degrees};

/// The order of the control vector `u`: per flap, per controlled harmonic, cosine then sine voltage.
///
/// ```text
/// u = [flap 1: u_2c u_2s u_3c u_3s ... | flap 2: u_2c u_2s ...],   volt
/// ```
/// A *pair* is one flap at one harmonic; pairs are numbered in the same order, so that pair `p` owns
/// elements `2 p` (cosine) and `2 p + 1` (sine).
///
/// Source: eq. (6)-(7). The steady bias voltage is not a control and has no element.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ControlLayout {
    flaps: usize,
    harmonics: Vec<u32>,
}

impl ControlLayout {
    /// A layout of `flaps` flaps, each driven at every harmonic (per revolution) of `harmonics`.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] without flap or harmonic, for harmonic 0 (that is the bias, which is solved
    /// for) or one given twice.
    pub fn new(flaps: usize, harmonics: Vec<u32>) -> Result<Self, ControlError> {
        let (what, expected) = ("pairs of a control layout", "a flap and a harmonic at least");
        error::check_range(flaps > 0 && !harmonics.is_empty(), what, 0.0, expected)?;
        for (index, &harmonic) in harmonics.iter().enumerate() {
            let (what, value) = ("controlled harmonic (per rev)", f64::from(harmonic));
            let expected =
                "1/rev or more, each once (the steady bias is solved for, it is not a control)";
            let fits = harmonic > 0 && !harmonics[..index].contains(&harmonic);
            error::check_range(fits, what, value, expected)?;
        }
        Ok(Self { flaps, harmonics })
    }

    /// Number of flaps.
    pub fn flaps(&self) -> usize {
        self.flaps
    }

    /// Controlled harmonics, per revolution, in the order of the control vector.
    pub fn harmonics(&self) -> &[u32] {
        &self.harmonics
    }

    /// Number of pairs (flap, harmonic).
    pub fn pairs(&self) -> usize {
        self.flaps * self.harmonics.len()
    }

    /// Length of the control vector.
    #[expect(clippy::len_without_is_empty, reason = "a layout cannot be empty")]
    pub fn len(&self) -> usize {
        2 * self.pairs()
    }

    /// Number of the pair of `flap` (from 0) and `harmonic` (per revolution); `None` if the layout
    /// does not hold it.
    pub fn pair(&self, flap: usize, harmonic: u32) -> Option<usize> {
        let position = self.harmonics.iter().position(|&h| h == harmonic)?;
        (flap < self.flaps).then_some(flap * self.harmonics.len() + position)
    }

    /// Flap (from 0) and harmonic (per revolution) of a pair; `None` beyond the last.
    pub fn flap_and_harmonic(&self, pair: usize) -> Option<(usize, u32)> {
        let flap = pair / self.harmonics.len();
        let harmonic = *self.harmonics.get(pair % self.harmonics.len())?;
        (flap < self.flaps).then_some((flap, harmonic))
    }

    /// The zero control vector.
    pub fn zero(&self) -> Vec<f64> {
        vec![0.0; self.len()]
    }

    /// The control vector as harmonics in volt, one per pair.
    ///
    /// # Errors
    /// [`ControlError::Length`] if the vector does not fit the layout.
    pub fn voltages_volt(&self, control_volt: &[f64]) -> Result<Vec<Harmonic>, ControlError> {
        self.check(control_volt)?;
        Ok(as_harmonics(control_volt))
    }

    /// Voltage amplitudes, one per pair.
    ///
    /// # Errors
    /// [`ControlError::Length`] if the vector does not fit the layout.
    pub fn amplitudes_volt(&self, control_volt: &[f64]) -> Result<Vec<f64>, ControlError> {
        Ok(self.voltages_volt(control_volt)?.iter().map(Harmonic::amplitude).collect())
    }

    /// The control vector of given harmonics in volt, one per pair.
    ///
    /// # Errors
    /// [`ControlError::Length`] if there is not one harmonic per pair.
    pub fn control_volt(&self, voltages_volt: &[Harmonic]) -> Result<Vec<f64>, ControlError> {
        let found = voltages_volt.len();
        error::check_length("harmonics of a control vector", found, self.pairs())?;
        Ok(voltages_volt.iter().flat_map(|h| [h.cosine, h.sine]).collect())
    }

    /// Accepts a finite control vector of the right length.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`].
    pub fn check(&self, control_volt: &[f64]) -> Result<(), ControlError> {
        error::check_vector("control vector (volt)", control_volt, self.len())
    }
}

/// Consecutive cosine and sine coefficients as harmonics.
pub(crate) fn as_harmonics(coefficients: &[f64]) -> Vec<Harmonic> {
    coefficients.chunks_exact(2).map(|pair| Harmonic { cosine: pair[0], sine: pair[1] }).collect()
}

/// Largest amplitude of the harmonics of a control vector, volt.
pub(crate) fn largest_amplitude(control_volt: &[f64]) -> f64 {
    as_harmonics(control_volt).iter().map(Harmonic::amplitude).fold(0.0, f64::max)
}

/// One control vector less another.
pub(crate) fn difference(to: &[f64], from: &[f64]) -> Vec<f64> {
    to.iter().zip(from).map(|(a, b)| a - b).collect()
}

/// Lag of one harmonic behind another of the same frequency, in degrees of harmonic phase.
///
/// ```text
/// early = A cos(n psi - a),   late = B cos(n psi - b):   lag = b - a,   in (-180, 180]
/// ```
/// The lag of a flap behind its voltage is `lag_deg(voltage, flap)`; the lead of the outboard over
/// the inboard flap is `lag_deg(outboard, inboard)`.
pub fn lag_deg(early: Harmonic, late: Harmonic) -> f64 {
    wrap_degrees(late.phase_deg() - early.phase_deg())
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    #[test]
    fn pairs_follow_the_papers_order() {
        let layout = ControlLayout::new(2, vec![2, 3, 4, 5]).unwrap();
        assert_eq!((layout.pairs(), layout.len()), (8, 16));
        assert_eq!(layout.pair(0, 2), Some(0));
        assert_eq!(layout.pair(1, 4), Some(6));
        assert_eq!(layout.pair(2, 4), None);
        assert_eq!(layout.pair(0, 6), None);
        for pair in 0..layout.pairs() {
            let (flap, harmonic) = layout.flap_and_harmonic(pair).unwrap();
            assert_eq!(layout.pair(flap, harmonic), Some(pair));
        }
        assert_eq!(layout.flap_and_harmonic(8), None);
    }

    #[test]
    fn harmonics_round_trip() {
        let layout = ControlLayout::new(2, vec![3]).unwrap();
        let control = [3.0, 4.0, -1.0, 0.0];
        let voltages = layout.voltages_volt(&control).unwrap();
        assert_eq!(layout.amplitudes_volt(&control).unwrap(), vec![5.0, 1.0]);
        assert_eq!(layout.control_volt(&voltages).unwrap(), control);
        assert!(layout.control_volt(&voltages[..1]).is_err());
    }

    #[test]
    fn impossible_layouts_are_refused() {
        for (flaps, harmonics) in [(0, vec![3]), (1, vec![]), (1, vec![0]), (2, vec![3, 4, 3])] {
            assert!(ControlLayout::new(flaps, harmonics).is_err());
        }
        let layout = ControlLayout::new(1, vec![3]).unwrap();
        assert!(matches!(layout.check(&[1.0]), Err(ControlError::Length { .. })));
        assert!(matches!(
            layout.check(&[1.0, f64::NAN]),
            Err(ControlError::NotFinite { index: 1, .. })
        ));
    }

    #[test]
    fn lag_is_positive_when_late_and_wraps() {
        let at = |deg: f64| Harmonic::from_amplitude_phase(2.0, deg.to_radians());
        assert_abs_diff_eq!(lag_deg(at(10.0), at(57.0)), 47.0, epsilon = 1e-12);
        assert_abs_diff_eq!(lag_deg(at(170.0), at(-150.0)), 40.0, epsilon = 1e-12);
    }
}

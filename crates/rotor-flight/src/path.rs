//! The rotor along a path of advance ratios.

use crate::FlightError;
use rotor_base::HarmonicSeries;
use rotor_study::case::Case;
use rotor_study::{HUB_OUTPUTS, TrimmedRotor};

/// Trims of a case at rising advance ratios.
///
/// ```text
/// Z(mu, delta) = sum over the two knots about mu of  w_k ( Z0_k + G_k delta ),      w linear in mu, held beyond the ends
/// ```
/// Truth is this rotor, linear in the motion of the flaps.
#[derive(Debug, Clone)]
pub struct RotorPath {
    knots: Vec<(f64, TrimmedRotor)>,
    blades: usize,
}

impl RotorPath {
    /// Trims a case at advance ratios, each from the last.
    ///
    /// # Errors
    /// [`FlightError::OutOfRange`] unless there is one and they rise; [`FlightError::Trim`], [`FlightError::Response`].
    pub fn new(case: &Case, advance_ratios: &[f64]) -> Result<Self, FlightError> {
        let rises = advance_ratios.windows(2).all(|pair| pair[0] < pair[1]);
        if advance_ratios.is_empty() || !rises {
            let (what, value) = ("number of advance ratios", advance_ratios.len() as f64);
            return Err(FlightError::OutOfRange { what, value, expected: "1 or more that rise" });
        }
        let mut knots: Vec<(f64, TrimmedRotor)> = Vec::with_capacity(advance_ratios.len());
        for &advance_ratio in advance_ratios {
            let mut here = case.clone();
            here.advance_ratio = advance_ratio;
            let start = knots.last().map(|(_, rotor)| rotor.trim());
            let rotor = TrimmedRotor::new(&here, start)
                .map_err(|source| FlightError::Trim { advance_ratio, source: Box::new(source) })?;
            rotor.authority().map_err(|source| FlightError::Response { advance_ratio, source })?;
            knots.push((advance_ratio, rotor));
        }
        Ok(Self { knots, blades: case.rotor.blades })
    }

    /// Hub loads at the blade number per rev for motions of the flaps, deg; cosine and sine of six, nondimensional.
    ///
    /// # Errors
    /// [`FlightError::Response`].
    pub fn loads(
        &self,
        advance_ratio: f64,
        flaps_deg: &[HarmonicSeries],
    ) -> Result<[f64; HUB_OUTPUTS], FlightError> {
        let mut loads = [0.0; HUB_OUTPUTS];
        for (index, weight) in self.weights(advance_ratio) {
            let (at, rotor) = &self.knots[index];
            let authority = rotor
                .authority()
                .map_err(|source| FlightError::Response { advance_ratio: *at, source })?;
            let mut add = |part: [f64; HUB_OUTPUTS]| {
                loads.iter_mut().zip(part).for_each(|(load, part)| *load += weight * part);
            };
            add(rotor.trim().rotor.hub.harmonic(self.blades));
            for (flap, motion) in flaps_deg.iter().enumerate() {
                add(authority.loads(flap, motion));
            }
        }
        Ok(loads)
    }

    /// Advance ratios of the knots.
    pub fn advance_ratios(&self) -> Vec<f64> {
        self.knots.iter().map(|(advance_ratio, _)| *advance_ratio).collect()
    }

    /// The two knots about an advance ratio with their weights.
    pub(crate) fn weights(&self, advance_ratio: f64) -> [(usize, f64); 2] {
        let above = self.knots.partition_point(|(knot, _)| *knot < advance_ratio);
        if above == 0 || above == self.knots.len() {
            let end = above.min(self.knots.len() - 1);
            return [(end, 1.0), (end, 0.0)];
        }
        let (low, high) = (self.knots[above - 1].0, self.knots[above].0);
        let share = (advance_ratio - low) / (high - low);
        [(above - 1, 1.0 - share), (above, share)]
    }
}

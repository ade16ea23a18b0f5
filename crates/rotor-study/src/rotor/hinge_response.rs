//! What the flap motions of a trimmed rotor do to its hinge moments.

use crate::flaps::{HingeCoupling, coefficients, series};
use crate::rotor::trimmed::TrimmedRotor;
use crate::series::{added, scaled};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_response::{HingeMoment, InflowState, ResponseError};

/// Step of the differences in a harmonic of a flap angle, rad: the response is nearly linear in it.
const RESPONSE_STEP_RAD: f64 = 1e-3;

impl TrimmedRotor {
    /// Change of all hinge moments with all flap motions about the trim, N m per rad, in the order of
    /// [`HingeCoupling::new`], made once for a rotor: of the linearised rotor, or by differences of
    /// responses where that one does not answer (a rotor that stalls).
    fn hinge_response(&self) -> Result<DMatrix<f64>, ResponseError> {
        self.hinge_response.found(|| self.found_hinge_response()).cloned()
    }

    fn found_hinge_response(&self) -> Result<DMatrix<f64>, ResponseError> {
        let rest = &self.trim.rotor.hinge;
        let count = rest.iter().map(|h| h.total().harmonics.len()).max().unwrap_or(0);
        let columns = match self.linearised_to(InflowState::Settled, count) {
            Ok(authority) => self.hinge_columns(count, |angles| {
                let mut change = vec![HarmonicSeries::zero(0); angles.len()];
                for (flap, angle) in angles.iter().enumerate() {
                    let motion_deg = scaled(angle, 180.0 / std::f64::consts::PI);
                    for (sum, part) in change.iter_mut().zip(authority.hinge(flap, &motion_deg)) {
                        *sum = added(sum, &part, 1.0);
                    }
                }
                Ok(change)
            }),
            Err(_) => self.hinge_columns(count, |angles| {
                let moved =
                    self.with_flaps(angles.iter().map(|a| scaled(a, RESPONSE_STEP_RAD)).collect())?;
                let pairs = moved.hinge.iter().zip(rest);
                let change = |(moved, rest): (&HingeMoment, &HingeMoment)| {
                    scaled(&added(&moved.total(), &rest.total(), -1.0), 1.0 / RESPONSE_STEP_RAD)
                };
                Ok(pairs.map(change).collect())
            }),
        }?;
        Ok(DMatrix::from_columns(&columns))
    }

    /// The columns of the response matrix from the change of the hinge moments (rotor units) per rad of
    /// a motion.
    fn hinge_columns(
        &self,
        count: usize,
        change: impl Fn(Vec<HarmonicSeries>) -> Result<Vec<HarmonicSeries>, ResponseError> + Sync,
    ) -> Result<Vec<DVector<f64>>, ResponseError> {
        let (flaps, size) = (self.trim.rotor.hinge.len(), 2 * count + 1);
        (0..flaps * size)
            .into_par_iter()
            .map(|j| {
                if j % size == 0 {
                    // the mean angle is the bias's
                    return Ok(DVector::zeros(flaps * size));
                }
                let mut angles = vec![HarmonicSeries::zero(0); flaps];
                let mut unit = vec![0.0; size];
                unit[j % size] = 1.0;
                angles[j / size] = series(&unit);
                let found = change(angles)?;
                let all = found.iter().flat_map(|h| coefficients(h, count));
                Ok(DVector::from_vec(all.map(|c| self.moment_newton_metre() * c).collect()))
            })
            .collect()
    }

    /// The coupling of flaps that give way by an angle per hinge moment, deg/(N m); none without give.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn coupling(
        &self,
        compliance_deg_per_newton_metre: f64,
    ) -> Result<Option<HingeCoupling>, ResponseError> {
        if compliance_deg_per_newton_metre == 0.0 || self.trim.rotor.hinge.is_empty() {
            return Ok(None);
        }
        let unit = self.moment_newton_metre();
        let at_rest = self.trim.rotor.hinge.iter().map(|h| scaled(&h.total(), unit)).collect();
        Ok(HingeCoupling::new(compliance_deg_per_newton_metre, at_rest, self.hinge_response()?))
    }
}

//! What the flap motions of a trimmed rotor do to its hinge moments.

use crate::flaps::{HingeCoupling, HingePower};
use crate::rotor::trimmed::TrimmedRotor;
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::HarmonicSeries;
use rotor_base::once::found;
use rotor_base::series::{added, coefficients, only, scaled, weighted};
use rotor_response::{HingeMoment, ResponseError, RotorSolution};

/// Step of the differences in a harmonic of a flap angle, rad: the response is nearly linear in it.
const RESPONSE_STEP_RAD: f64 = 1e-3;

impl TrimmedRotor {
    /// Change of all hinge moments with all flap motions about the trim, N m per rad, in the order of
    /// [`HingeCoupling::new`]: of the linearised rotor, or by differences of responses where that one does not
    /// answer (a rotor that stalls).
    fn hinge_response(&self) -> Result<DMatrix<f64>, ResponseError> {
        let rest = &self.trim.rotor.hinge;
        let count = rest.iter().map(|h| h.total().harmonics.len()).max().unwrap_or(0);
        let (flaps, size, unit) = (rest.len(), 2 * count + 1, self.scales().moment_newton_metre());
        let harmonics: Vec<usize> = (1..=count).collect();
        let authority = self.linearised_for(&harmonics).ok().map(|[settled, _]| settled);
        let columns = (0..flaps * size)
            .into_par_iter()
            .map(|j| {
                let (flap, place) = (j / size, j % size);
                if place == 0 {
                    // the mean angle is the bias's
                    return Ok(DVector::zeros(flaps * size));
                }
                let change: Vec<HarmonicSeries> = if let Some(authority) = &authority {
                    authority.hinge(flap, &only(place, 180.0 / std::f64::consts::PI))
                } else {
                    let mut angles_rad = vec![HarmonicSeries::zero(0); flaps];
                    angles_rad[flap] = only(place, RESPONSE_STEP_RAD);
                    let moved = self.with_flaps(angles_rad)?;
                    let pairs = moved.hinge.iter().zip(rest);
                    let change = |(moved, rest): (&HingeMoment, &HingeMoment)| {
                        weighted(&moved.total(), &rest.total(), 1.0 / RESPONSE_STEP_RAD)
                    };
                    pairs.map(change).collect()
                };
                let all = change.iter().flat_map(|h| coefficients(h, count));
                Ok(DVector::from_vec(all.map(|c| unit * c).collect()))
            })
            .collect::<Result<Vec<DVector<f64>>, ResponseError>>()?;
        Ok(DMatrix::from_columns(&columns))
    }

    /// Mean power that the actuators of one blade give for motions of the flaps (deg), none taken back, W: of the
    /// linearised rotor.
    ///
    /// # Errors
    /// The errors of the linearised response.
    pub fn linear_power_watt(&self, flaps_deg: &[&HarmonicSeries]) -> Result<f64, ResponseError> {
        let authority = self.authority()?;
        let mut moments: Vec<HarmonicSeries> =
            self.trim.rotor.hinge.iter().map(HingeMoment::total).collect();
        for (flap, motion) in flaps_deg.iter().enumerate() {
            for (sum, part) in moments.iter_mut().zip(authority.hinge(flap, motion)) {
                *sum = added(sum, &part, 1.0);
            }
        }
        let each = moments.into_iter().zip(flaps_deg).map(|(aerodynamic, motion)| {
            let hinge = HingeMoment { aerodynamic, inertial: HarmonicSeries::zero(0) };
            HingePower::new(&hinge, motion, self.scales()).given_watt
        });
        Ok(each.sum())
    }

    /// Hinge moment of every flap in a response, N m, positive in the sense of the angle.
    pub(crate) fn hinge_moments_newton_metre(
        &self,
        response: &RotorSolution,
    ) -> Vec<HarmonicSeries> {
        let unit = self.scales().moment_newton_metre();
        response.hinge.iter().map(|h| scaled(&h.total(), unit)).collect()
    }

    /// The same with the columns of the mean angles, which a bias that is held leaves to follow.
    fn hinge_response_with_means(&self) -> Result<DMatrix<f64>, ResponseError> {
        let mut response = found(&self.hinge_response, || self.hinge_response())?.clone();
        let rest = &self.trim.rotor.hinge;
        let (flaps, unit) = (rest.len(), self.scales().moment_newton_metre());
        let size = response.ncols() / flaps.max(1);
        let authority = self.linearised_for(&[0]).ok().map(|[settled, _]| settled);
        for flap in 0..flaps {
            let change = if let Some(authority) = &authority {
                authority.hinge(flap, &only(0, 180.0 / std::f64::consts::PI))
            } else {
                let mut angles_rad = vec![HarmonicSeries::zero(0); flaps];
                angles_rad[flap] = only(0, RESPONSE_STEP_RAD);
                let moved = self.with_flaps(angles_rad)?;
                let pairs = moved.hinge.iter().zip(rest);
                pairs
                    .map(|(moved, rest)| {
                        weighted(&moved.total(), &rest.total(), 1.0 / RESPONSE_STEP_RAD)
                    })
                    .collect()
            };
            let all = change.iter().flat_map(|h| coefficients(h, size / 2));
            let column: Vec<f64> = all.map(|c| unit * c).collect();
            response.column_mut(flap * size).copy_from_slice(&column);
        }
        Ok(response)
    }

    /// The coupling of flaps that give way by an angle per hinge moment, deg/(N m), their mean angles too where the bias is
    /// held; none without give.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn coupling(
        &self,
        compliance_deg_per_newton_metre: f64,
        holds_bias: bool,
    ) -> Result<Option<HingeCoupling>, ResponseError> {
        if compliance_deg_per_newton_metre == 0.0 || self.trim.rotor.hinge.is_empty() {
            return Ok(None);
        }
        let at_rest = self.hinge_moments_newton_metre(&self.trim.rotor);
        if holds_bias {
            let response = self.hinge_response_with_means()?;
            let give = compliance_deg_per_newton_metre;
            return Ok(HingeCoupling::with_held_bias(give, at_rest, response));
        }
        let response = found(&self.hinge_response, || self.hinge_response())?;
        Ok(HingeCoupling::new(compliance_deg_per_newton_metre, at_rest, response.clone()))
    }
}

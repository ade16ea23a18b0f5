//! Flap motion and hinge moment settled on each other.
//!
//! ```text
//! delta = actuator(voltage, H),   H = rotor(delta)
//! ```
//! The unknown is the hinge moment of every flap, mean and harmonics. The actuator gives way by `g` deg
//! per N m; the rotor's answer to a flap alone, the blade held and the wake settled, is the operator `K`
//! of [`HingeSlopes`]. Newton's step with that Jacobian,
//!
//! ```text
//! ( I - K g ) dH = rotor(delta(H)) - H
//! ```
//! leaves what blade, wake lags and the other flap answer; Anderson's acceleration takes care of them.
//! The mean angle does not give way: the bias holds it.

use super::anderson::Anderson;
use super::drive::scaled;
use super::{FlapMotion, PlantError};
use nalgebra::{DMatrix, DVector, Dyn, LU};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::HingeSlopes;

/// Largest change of a harmonic of the flap angle by the hinge moment still left, deg.
pub const COUPLING_TOLERANCE_DEG: f64 = 1e-7;
/// Iterations allowed.
const MAX_ITERATIONS: usize = 40;

/// How well flap motion and hinge moment agree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CouplingResidual {
    /// Responses of the rotor it took.
    pub iterations: usize,
    /// Largest change of a harmonic of a flap angle by the mismatch of the hinge moment, deg.
    pub residual_deg: f64,
}

/// The Newton matrix of every flap and what it takes to iterate on its hinge moment.
#[derive(Debug, Clone)]
pub struct HingeCoupling {
    harmonics: usize,
    give_deg_per_newton_metre: f64,
    /// Slopes in N m per rad.
    slopes: Vec<HingeSlopes>,
    /// Hinge moment of the flaps at rest, N m.
    at_rest: Vec<HarmonicSeries>,
    /// Factors of `I - K g` by flap.
    matrices: Vec<LU<f64, Dyn, Dyn>>,
}

/// Coefficients of a series to `count` harmonics: mean, then cosine and sine of each.
fn coefficients(series: &HarmonicSeries, count: usize) -> Vec<f64> {
    std::iter::once(series.mean)
        .chain((1..=count).flat_map(|n| {
            let h = series.harmonic(n);
            [h.cosine, h.sine]
        }))
        .collect()
}

fn series(coefficients: &[f64]) -> HarmonicSeries {
    HarmonicSeries {
        mean: coefficients[0],
        harmonics: coefficients[1..]
            .chunks_exact(2)
            .map(|pair| Harmonic { cosine: pair[0], sine: pair[1] })
            .collect(),
    }
}

impl HingeCoupling {
    /// The coupling of flaps alike.
    ///
    /// | argument | meaning | unit |
    /// |---|---|---|
    /// | `give_deg_per_newton_metre` | how far a steady hinge moment turns the flap in its own sense | deg/(N m) |
    /// | `at_rest` | hinge moment of each flap at rest | N m |
    /// | `slopes` | its change with the motion of that flap | N m per rad |
    ///
    /// None without give. Harmonics of the hinge moment beyond those of `at_rest` are left out.
    pub fn new(
        give_deg_per_newton_metre: f64,
        at_rest: Vec<HarmonicSeries>,
        slopes: Vec<HingeSlopes>,
    ) -> Option<Self> {
        if give_deg_per_newton_metre == 0.0 {
            return None;
        }
        let harmonics = at_rest.iter().map(|h| h.harmonics.len()).max().unwrap_or(0);
        let give_rad = give_deg_per_newton_metre.to_radians();
        let size = 2 * harmonics + 1;
        let matrices = slopes
            .iter()
            .map(|slopes| {
                // a moment in its own sense turns the flap by the give: dH = K g dH
                let columns: Vec<DVector<f64>> = (0..size)
                    .map(|j| {
                        let mut column = vec![0.0; size];
                        if j > 0 {
                            let mut unit = vec![0.0; size];
                            unit[j] = give_rad;
                            column =
                                coefficients(&slopes.change(&series(&unit), harmonics), harmonics);
                        }
                        DVector::from_vec(column)
                    })
                    .collect();
                (DMatrix::identity(size, size) - DMatrix::from_columns(&columns)).lu()
            })
            .collect();
        Some(Self { harmonics, give_deg_per_newton_metre, slopes, at_rest, matrices })
    }

    fn split(&self, moments: &DVector<f64>) -> Vec<HarmonicSeries> {
        moments.as_slice().chunks_exact(2 * self.harmonics + 1).map(series).collect()
    }

    fn gather<'a>(&self, moments: impl IntoIterator<Item = &'a HarmonicSeries>) -> DVector<f64> {
        let all: Vec<f64> =
            moments.into_iter().flat_map(|h| coefficients(h, self.harmonics)).collect();
        DVector::from_vec(all)
    }

    /// Newton's step for a mismatch of the hinge moments; the mismatch itself where the matrix is
    /// singular (a flap in resonance on its actuator).
    fn step(&self, mismatch: &DVector<f64>) -> DVector<f64> {
        let size = 2 * self.harmonics + 1;
        let parts: Vec<f64> = mismatch
            .as_slice()
            .chunks_exact(size)
            .zip(&self.matrices)
            .flat_map(|(part, matrix)| {
                let part = DVector::from_column_slice(part);
                let step = matrix.solve(&part).unwrap_or(part);
                step.as_slice().to_vec()
            })
            .collect();
        DVector::from_vec(parts)
    }

    /// Largest turn of a flap by a mismatch of its hinge moment at one harmonic, deg.
    fn residual_deg(&self, mismatch: &DVector<f64>) -> f64 {
        if mismatch.iter().any(|value| !value.is_finite()) {
            return f64::NAN;
        }
        let largest = |h: &HarmonicSeries| {
            h.harmonics.iter().map(Harmonic::amplitude).fold(h.mean.abs(), f64::max)
        };
        let worst = self.split(mismatch).iter().map(largest).fold(0.0, f64::max);
        worst * self.give_deg_per_newton_metre.abs()
    }

    /// Motion and response that agree.
    ///
    /// `actuate` turns hinge moments (N m) into flap motions, `respond` these into the response of the
    /// rotor and its hinge moments; `respond` is handed the last response to start from.
    ///
    /// # Errors
    /// [`PlantError::Coupling`] with iterations, residual and the best motion; the errors of both.
    pub fn settle<R>(
        &self,
        actuate: impl Fn(&[HarmonicSeries]) -> Result<Vec<FlapMotion>, PlantError>,
        respond: impl Fn(&[FlapMotion], Option<&R>) -> Result<(R, Vec<HarmonicSeries>), PlantError>,
    ) -> Result<(Vec<FlapMotion>, R, CouplingResidual), PlantError> {
        // the linear prediction from the flaps at rest, without a response
        let rest = self.gather(&self.at_rest);
        let mut flaps = actuate(&self.at_rest)?;
        let predicted: Vec<HarmonicSeries> = flaps
            .iter()
            .zip(&self.slopes)
            .map(|(flap, slopes)| {
                let motion_rad = scaled(&flap.flap_deg, 1.0_f64.to_radians());
                slopes.change(&motion_rad, self.harmonics)
            })
            .collect();
        let mut moments = &rest + self.step(&self.gather(&predicted));
        let mut anderson = Anderson::default();
        let mut last: Option<R> = None;
        let mut best: Option<(f64, Vec<FlapMotion>)> = None;
        for iterations in 1..=MAX_ITERATIONS {
            flaps = actuate(&self.split(&moments))?;
            let (response, found) = respond(&flaps, last.as_ref())?;
            let mismatch = self.gather(&found) - &moments;
            let residual_deg = self.residual_deg(&mismatch);
            if residual_deg <= COUPLING_TOLERANCE_DEG {
                return Ok((flaps, response, CouplingResidual { iterations, residual_deg }));
            }
            if residual_deg.is_nan() {
                break;
            }
            if best.as_ref().is_none_or(|(least, _)| residual_deg < *least) {
                best = Some((residual_deg, flaps));
            }
            moments = anderson.next(&moments, &self.step(&mismatch));
            last = Some(response);
        }
        let (residual_deg, best) = best.unwrap_or((f64::NAN, Vec::new()));
        Err(PlantError::Coupling {
            iterations: MAX_ITERATIONS,
            residual_deg,
            tolerance_deg: COUPLING_TOLERANCE_DEG,
            best,
        })
    }
}

#[cfg(test)]
#[path = "coupling_tests.rs"]
mod tests;

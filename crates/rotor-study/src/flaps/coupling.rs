//! Flap motion and hinge moment settled on each other.
//!
//! ```text
//! delta = actuator(voltage, H),   H = rotor(delta)
//! ```
//! The unknown is the hinge moment of every flap, mean and harmonics. The actuator gives way by `g` rad
//! per N m, and the rotor, blade and wake included, answers a small flap motion by the matrix `R`, taken
//! once by differences about the trim. Newton's step with that Jacobian,
//!
//! ```text
//! ( I - R g ) dH = rotor(delta(H)) - H
//! ```
//! leaves what is not linear and what the stages behind the load do; Anderson's acceleration takes care of
//! it. The mean angle does not give way where the bias is solved for: that holds it. A bias that is held leaves it to follow.

use crate::flaps::error::PlantError;
use crate::flaps::motion::FlapMotion;
use nalgebra::{DMatrix, DVector, Dyn, LU};
use rotor_base::series::{coefficients, series};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::Anderson;

/// Largest change of a harmonic of the flap angle by the hinge moment still left, deg.
pub const COUPLING_TOLERANCE_DEG: f64 = 1e-7;
/// Iterations allowed.
const MAX_ITERATIONS: usize = 40;
/// Steps that the acceleration remembers: more than the slow directions that the preconditioner leaves.
const STEPS_KEPT: usize = 8;

/// Highest harmonic of the voltage, paper equation (6).
const CONTROLLED: usize = 5;

/// How well flap motion and hinge moment agree.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct CouplingResidual {
    /// Responses of the rotor it took.
    pub iterations: usize,
    /// Largest change of a harmonic of a flap angle by the mismatch of the hinge moment, deg.
    pub residual_deg: f64,
}

/// The Newton matrix of the flaps and what it takes to iterate on their hinge moments.
#[derive(Debug, Clone)]
pub struct HingeCoupling {
    harmonics: usize,
    compliance_deg_per_newton_metre: f64,
    /// Hinge moment of the flaps at rest, N m.
    at_rest: Vec<HarmonicSeries>,
    /// Change of all hinge moments with all flap motions, N m per rad.
    response: DMatrix<f64>,
    /// Factors of `I - R g`.
    newton: LU<f64, Dyn, Dyn>,
    /// First of the coefficients of a motion that give way: 0 the mean, 1 where the bias holds it.
    first: usize,
}

impl HingeCoupling {
    /// The coupling of flaps with actuators alike.
    ///
    /// | argument | meaning | unit |
    /// |---|---|---|
    /// | `compliance_deg_per_newton_metre` | how far a steady hinge moment turns a flap in its own sense | deg/(N m) |
    /// | `at_rest` | hinge moment of each flap at rest, all to the same harmonic | N m |
    /// | `response` | change of all hinge moments with all flap motions; rows and columns flap by flap, mean, then cosine and sine of each harmonic | N m per rad |
    ///
    /// None without give. Harmonics of the hinge moment beyond those of `at_rest` are left out.
    pub fn new(
        compliance_deg_per_newton_metre: f64,
        at_rest: Vec<HarmonicSeries>,
        response: DMatrix<f64>,
    ) -> Option<Self> {
        Self::of(compliance_deg_per_newton_metre, at_rest, response, 1)
    }

    /// The same of actuators whose bias is held: the mean angles give way as well, and the columns of `response` for them
    /// count.
    pub fn with_held_bias(
        compliance_deg_per_newton_metre: f64,
        at_rest: Vec<HarmonicSeries>,
        response: DMatrix<f64>,
    ) -> Option<Self> {
        Self::of(compliance_deg_per_newton_metre, at_rest, response, 0)
    }

    fn of(
        compliance_deg_per_newton_metre: f64,
        at_rest: Vec<HarmonicSeries>,
        response: DMatrix<f64>,
        first: usize,
    ) -> Option<Self> {
        if compliance_deg_per_newton_metre == 0.0 {
            return None;
        }
        let harmonics = at_rest.iter().map(|h| h.harmonics.len()).max().unwrap_or(0);
        let size = 2 * harmonics + 1;
        let mut newton = -compliance_deg_per_newton_metre.to_radians() * &response;
        for mean in (0..newton.ncols()).step_by(size).filter(|_| first > 0) {
            // the bias holds the mean angle
            newton.column_mut(mean).fill(0.0);
        }
        newton += DMatrix::identity(newton.nrows(), newton.ncols());
        let newton = newton.lu();
        Some(Self { harmonics, compliance_deg_per_newton_metre, at_rest, response, newton, first })
    }

    fn split(&self, moments: &DVector<f64>) -> Vec<HarmonicSeries> {
        moments.as_slice().chunks_exact(2 * self.harmonics + 1).map(series).collect()
    }

    fn gather(&self, all: &[HarmonicSeries]) -> DVector<f64> {
        let all = all.iter().flat_map(|one| coefficients(one, self.harmonics));
        DVector::from_vec(all.collect())
    }

    /// Change of the hinge moments with flap motions in the linear answer of the rotor, N m.
    fn answer(&self, flaps: &[FlapMotion]) -> DVector<f64> {
        let angles_rad: Vec<HarmonicSeries> = flaps.iter().map(FlapMotion::angle_rad).collect();
        &self.response * self.gather(&angles_rad)
    }

    /// Newton's step for a mismatch of the hinge moments; the mismatch itself where the matrix is
    /// singular (a flap in resonance on its actuator).
    fn step(&self, mismatch: &DVector<f64>) -> DVector<f64> {
        self.newton.solve(mismatch).unwrap_or_else(|| mismatch.clone())
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
        worst * self.compliance_deg_per_newton_metre.abs()
    }

    /// Motion that agrees with the linear answer of the rotor, `H = H_rest + R delta`: no response is
    /// computed. What it misses is the curvature of the rotor's answer.
    ///
    /// # Errors
    /// As [`Self::settle`].
    pub fn predict(
        &self,
        actuate: impl Fn(&[HarmonicSeries]) -> Result<Vec<FlapMotion>, PlantError>,
    ) -> Result<Vec<FlapMotion>, PlantError> {
        let rest = self.gather(&self.at_rest);
        let linear = |flaps: &[FlapMotion], _: Option<&()>| {
            Ok(((), self.split(&(&rest + self.answer(flaps)))))
        };
        Ok(self.settle(actuate, linear)?.0)
    }

    /// Motion and response that agree.
    ///
    /// `actuate` turns hinge moments (N m) into flap motions, `respond` these into the response of the
    /// rotor and its hinge moments; `respond` is handed the last response to start from.
    ///
    /// # Errors
    /// [`PlantError::Coupling`] with iterations and the least residual; the errors of both;
    /// [`PlantError::TooSoft`] around either where the loop gain is 1 or more.
    pub fn settle<R>(
        &self,
        actuate: impl Fn(&[HarmonicSeries]) -> Result<Vec<FlapMotion>, PlantError>,
        respond: impl Fn(&[FlapMotion], Option<&R>) -> Result<(R, Vec<HarmonicSeries>), PlantError>,
    ) -> Result<(Vec<FlapMotion>, R, CouplingResidual), PlantError> {
        self.iterate(actuate, respond).map_err(|source| {
            let loop_gain = self.loop_gain();
            if loop_gain < 1.0 {
                return source;
            }
            PlantError::TooSoft {
                hinge_stiffness_newton_metre_per_rad: self
                    .compliance_deg_per_newton_metre
                    .to_radians()
                    .recip(),
                loop_gain,
                share_percent: 100.0 / loop_gain,
                source: Box::new(source),
            }
        })
    }

    /// How far the flaps move by the hinge moments of a motion, over that motion, up to the highest
    /// harmonic that is controlled: the largest eigenvalue of `g R` there. The means are left out where the bias
    /// holds them. At 1 the motion feeds itself: the flap is in resonance on its actuator, or swept along.
    pub fn loop_gain(&self) -> f64 {
        let size = 2 * self.harmonics + 1;
        let last = 2 * CONTROLLED.min(self.harmonics);
        let kept: Vec<usize> = (0..self.response.ncols())
            .filter(|k| (self.first..=last).contains(&(k % size)))
            .collect();
        let open = self.response.select_columns(&kept).select_rows(&kept);
        let eigenvalues =
            (self.compliance_deg_per_newton_metre.to_radians() * open).complex_eigenvalues();
        eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max)
    }

    fn iterate<R>(
        &self,
        actuate: impl Fn(&[HarmonicSeries]) -> Result<Vec<FlapMotion>, PlantError>,
        respond: impl Fn(&[FlapMotion], Option<&R>) -> Result<(R, Vec<HarmonicSeries>), PlantError>,
    ) -> Result<(Vec<FlapMotion>, R, CouplingResidual), PlantError> {
        // the linear prediction from the flaps at rest, without a response
        let rest = self.gather(&self.at_rest);
        let mut moments = &rest + self.step(&self.answer(&actuate(&self.at_rest)?));
        let mut anderson = Anderson::new(STEPS_KEPT);
        let mut last: Option<R> = None;
        let mut least_deg = f64::NAN;
        for iterations in 1..=MAX_ITERATIONS {
            let flaps = actuate(&self.split(&moments))?;
            let (response, found) = respond(&flaps, last.as_ref())?;
            let mismatch = self.gather(&found) - &moments;
            let residual_deg = self.residual_deg(&mismatch);
            if residual_deg <= COUPLING_TOLERANCE_DEG {
                return Ok((flaps, response, CouplingResidual { iterations, residual_deg }));
            }
            if residual_deg.is_nan() {
                break;
            }
            least_deg = least_deg.min(residual_deg);
            let column = |v: &DVector<f64>| DMatrix::from_column_slice(v.len(), 1, v.as_slice());
            let next = anderson.propose(&column(&moments), &column(&self.step(&mismatch)));
            moments = next.column(0).into_owned();
            last = Some(response);
        }
        Err(PlantError::Coupling {
            iterations: MAX_ITERATIONS,
            residual_deg: least_deg,
            tolerance_deg: COUPLING_TOLERANCE_DEG,
        })
    }
}

#[cfg(test)]
#[path = "coupling_tests.rs"]
mod tests;

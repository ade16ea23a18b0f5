//! Newton's method on the harmonics of a voltage.

use super::{InverseSettings, PeriodicInverse};
use crate::check::{check_count, check_finite, check_positive, extremes, largest_above};
use crate::{ActuatorModel, PeriodicResponse, PreisachError};
use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries, mean_square, uniform_azimuths_rad};

/// Amplitudes closer than this share of the wanted one are not told apart when the reach is sought.
pub(super) const REACH_RESOLUTION: f64 = 1.0 / 128.0;
/// Difference of a voltage coefficient in the Jacobian, as a share of the range.
const DIFFERENCE: f64 = 1e-4;
/// Shares of a command to start from.
const STARTS: [f64; 4] = [1.0, 0.98, 0.95, 0.9];
/// Halvings of a Newton step.
const HALVINGS: usize = 7;

/// A command with its orbit.
struct Point {
    x: DVector<f64>,
    response: PeriodicResponse,
}

/// The search for one periodic voltage.
pub(super) struct Search<'a> {
    model: &'a ActuatorModel,
    wanted: DVector<f64>,
    wanted_samples: Vec<f64>,
    amplitude_deg: f64,
    rev_hz: f64,
    /// As given, with orbits of as many harmonics as the voltage has.
    settings: InverseSettings,
    /// Harmonics of the flap that are made right, by as many of the voltage.
    solved: usize,
}

impl<'a> Search<'a> {
    /// Refuses settings and targets that make no sense.
    pub(super) fn new(
        model: &'a ActuatorModel,
        wanted_deg: &HarmonicSeries,
        rev_hz: f64,
        settings: &InverseSettings,
    ) -> Result<Self, PreisachError> {
        check_positive("rev_hz", rev_hz)?;
        check_positive("tolerance_deg", settings.tolerance_deg)?;
        let solved = settings.voltage_harmonics;
        check_count("voltage_harmonics", solved, wanted_deg.harmonics.len().max(1))?;
        let wanted = coefficients(wanted_deg, solved);
        check_finite("wanted flap (deg)", wanted.iter().copied())?;
        let mut settings = *settings;
        settings.periodic.harmonics = settings.periodic.harmonics.max(solved);
        let azimuths = uniform_azimuths_rad(settings.periodic.steps_per_rev);
        let wanted_samples: Vec<f64> = azimuths.iter().map(|&psi| wanted_deg.value(psi)).collect();
        let [low, high] = extremes(wanted_samples.iter().copied());
        let amplitude_deg = 0.5 * (high - low);
        Ok(Self { model, wanted, wanted_samples, amplitude_deg, rev_hz, settings, solved })
    }

    /// The inverse from rest at the wanted mean, through smaller amplitudes where it must be.
    pub(super) fn start_at_rest(&self) -> Result<PeriodicInverse, PreisachError> {
        let mut at = self.rest()?;
        let (mut share, mut step, mut iterations) = (0.0, 1.0, 0);
        loop {
            let next = f64::min(1.0, share + step);
            match self.newton(&at, next) {
                Ok((found, used)) => {
                    iterations += used;
                    if next >= 1.0 {
                        return Ok(self.solution(found, iterations));
                    }
                    (at, share) = (found, next);
                }
                Err(error) => {
                    step *= 0.5;
                    if step < REACH_RESOLUTION {
                        return Err(self.failure(&at, share, error));
                    }
                }
            }
        }
    }

    /// The inverse from a command close to it, by its first `solved` harmonics; the others stay.
    pub(super) fn start_at(
        mut self,
        command_volt: &HarmonicSeries,
        solved: usize,
    ) -> Result<PeriodicInverse, PreisachError> {
        self.solved = solved.min(self.settings.voltage_harmonics);
        let command = coefficients(command_volt, self.settings.voltage_harmonics);
        let shrunk = |share: f64| {
            let mut x = &command * share;
            x[0] = command[0];
            self.point(x)
        };
        // what is left of a command that had more harmonics may overshoot the range a little
        let start = STARTS.iter().find_map(|&share| shrunk(share).ok());
        let start = start.map_or_else(|| shrunk(1.0), Ok);
        let start = match start {
            Ok(start) => start,
            Err(error @ PreisachError::CommandOutOfRange { .. }) => {
                return Err(self.failure(&self.rest()?, 0.0, error));
            }
            Err(error) => return Err(error),
        };
        match self.newton(&start, 1.0) {
            Ok((found, iterations)) => Ok(self.solution(found, iterations)),
            Err(error) => Err(self.failure(&start, 1.0, error)),
        }
    }

    /// Half peak to peak of the wanted motion, deg.
    pub(super) fn amplitude_deg(&self) -> f64 {
        self.amplitude_deg
    }

    fn point(&self, x: DVector<f64>) -> Result<Point, PreisachError> {
        let response =
            self.model.periodic_response(&series(&x), self.rev_hz, &self.settings.periodic)?;
        Ok(Point { x, response })
    }

    /// The constant voltage whose output is the wanted mean, by bisection; the nearer end of the
    /// range if there is none.
    fn rest(&self) -> Result<Point, PreisachError> {
        let range = self.model.range_volt;
        let constant = |volt: f64| {
            let mut x = DVector::zeros(self.wanted.len());
            x[0] = volt;
            self.point(x)
        };
        let off = |point: &Point| point.response.flap_deg.mean - self.wanted[0];
        let (mut low, mut high) = (range.lowest_volt(), range.highest_volt());
        let rises = off(&constant(high)?) > off(&constant(low)?);
        let mut middle = constant(0.5 * (low + high))?;
        for _ in 0..40 {
            let error = off(&middle);
            if error.abs() <= self.settings.tolerance_deg {
                break;
            }
            if (error > 0.0) == rises {
                high = middle.x[0];
            } else {
                low = middle.x[0];
            }
            middle = constant(0.5 * (low + high))?;
        }
        Ok(middle)
    }

    /// The target at a share of the wanted motion: its mean in full, its harmonics scaled.
    fn target(&self, share: f64) -> DVector<f64> {
        let mut target = self.wanted.rows(0, 2 * self.solved + 1) * share;
        target[0] = self.wanted[0];
        target
    }

    fn residual(&self, point: &Point, target: &DVector<f64>) -> DVector<f64> {
        coefficients(&point.response.flap_deg, self.solved) - target
    }

    /// Newton's method for a share of the wanted motion.
    fn newton(&self, start: &Point, share: f64) -> Result<(Point, usize), PreisachError> {
        let target = self.target(share);
        let mut at = self.point(start.x.clone())?;
        let mut residual = self.residual(&at, &target);
        let mut iterations = 0;
        loop {
            let residual_deg = residual.amax();
            if residual_deg <= self.settings.tolerance_deg {
                return Ok((at, iterations));
            }
            let stalled = PreisachError::InverseNotConverged { iterations, residual_deg, share };
            if iterations == self.settings.largest_iterations {
                return Err(stalled);
            }
            let jacobian = self.jacobian(&at)?;
            let Some(solution) = jacobian.lu().solve(&residual) else {
                return Err(stalled);
            };
            let step = solution.resize_vertically(at.x.len(), 0.0);
            let mut tried = Err(stalled);
            for halving in 0..HALVINGS {
                let factor = 0.5_f64.powi(i32::try_from(halving).unwrap_or(0));
                match self.point(&at.x - &step * factor) {
                    Ok(point) => {
                        let next = self.residual(&point, &target);
                        if next.norm() < residual.norm() * (1.0 - 0.1 * factor) {
                            tried = Ok((point, next));
                            break;
                        }
                    }
                    // the whole step leaves the range: remembered, and a shorter one is tried
                    Err(error) if halving == 0 => tried = Err(error),
                    Err(_) => {}
                }
            }
            (at, residual) = tried?;
            iterations += 1;
        }
    }

    /// Differences of the flap's harmonics over those of the voltage, taken to the side that lies
    /// inside the range.
    fn jacobian(&self, at: &Point) -> Result<DMatrix<f64>, PreisachError> {
        let here = coefficients(&at.response.flap_deg, self.solved);
        let size = DIFFERENCE * self.model.range_volt.span_volt();
        let columns = (0..here.len())
            .into_par_iter()
            .map(|k| {
                let shifted = |difference: f64| {
                    let mut x = at.x.clone();
                    x[k] += difference;
                    let flap = self.point(x)?.response.flap_deg;
                    let there = coefficients(&flap, self.solved);
                    Ok::<_, PreisachError>((there - &here) / difference)
                };
                // where both sides leave the range the command touches both ends
                shifted(size).or_else(|_| shifted(-size)).or_else(|_| shifted(1e-6 * size))
            })
            .collect::<Result<Vec<_>, PreisachError>>()?;
        Ok(DMatrix::from_columns(&columns))
    }

    fn solution(&self, point: Point, iterations: usize) -> PeriodicInverse {
        let pairs = point.response.samples_deg.iter().zip(&self.wanted_samples);
        let errors: Vec<f64> = pairs.map(|(a, b)| a - b).collect();
        PeriodicInverse {
            largest_error_deg: errors.iter().fold(0.0, |m, e| e.abs().max(m)),
            rms_error_deg: mean_square(&errors).sqrt(),
            amplitude_deg: self.amplitude_deg,
            iterations,
            response: point.response,
        }
    }

    /// The error of a search that an error ended at `share` of the wanted motion.
    fn failure(&self, at: &Point, share: f64, error: PreisachError) -> PreisachError {
        match error {
            PreisachError::InverseNotConverged { iterations, residual_deg, .. } => {
                PreisachError::InverseNotConverged { iterations, residual_deg, share }
            }
            PreisachError::CommandOutOfRange { azimuth_deg, voltage_volt, range } => {
                let command = series(&at.x);
                let amplitudes = command.harmonics.iter().map(Harmonic::amplitude);
                let (strongest, _) = largest_above(0.0, amplitudes);
                PreisachError::MotionOutOfReach {
                    wanted_deg: self.amplitude_deg,
                    reachable_deg: share * self.amplitude_deg,
                    harmonic: strongest + 1,
                    rev_hz: self.rev_hz,
                    azimuth_deg,
                    voltage_volt,
                    range,
                }
            }
            other => other,
        }
    }
}

/// Mean, then cosine and sine of each harmonic.
fn coefficients(series: &HarmonicSeries, count: usize) -> DVector<f64> {
    let mut x = DVector::zeros(2 * count + 1);
    x[0] = series.mean;
    for n in 1..=count {
        let harmonic = series.harmonic(n);
        x[2 * n - 1] = harmonic.cosine;
        x[2 * n] = harmonic.sine;
    }
    x
}

fn series(x: &DVector<f64>) -> HarmonicSeries {
    let harmonics = (1..x.len()).step_by(2);
    HarmonicSeries {
        mean: x[0],
        harmonics: harmonics.map(|i| Harmonic { cosine: x[i], sine: x[i + 1] }).collect(),
    }
}

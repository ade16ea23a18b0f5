//! Periodic response alone, with momentum inflow, or trimmed as in a wind tunnel.

use super::balance::{Elastic, Evaluation, FlapAngles, Flow};
use super::hub::hub_loads;
use super::inflow::{glauert, momentum_defect};
use super::newton::Jacobian;
use crate::error::RotorTruthError;
use std::f64::consts::PI;

/// Size of the last step of an accepted solution.
const TOLERANCE: f64 = 1e-9;
/// Steps with one Jacobian.
const STEPS: usize = 30;
/// Jacobians tried.
const JACOBIANS: usize = 6;

/// What is held at a condition.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Held {
    /// Controls, rad, and induced inflow.
    All {
        /// Collective, lateral, longitudinal.
        controls: [f64; 3],
        /// Mean induced inflow.
        lambda_i: f64,
    },
    /// Controls, rad; the inflow follows the thrust.
    Controls([f64; 3]),
    /// Thrust coefficient over solidity; the mean hub moments are zero.
    Thrust(f64),
}

/// A periodic response.
#[derive(Debug, Clone)]
pub struct Response {
    /// Modal series, then the unknowns of the trim.
    unknowns: Vec<f64>,
    /// Number of modal coefficients.
    size: usize,
    held: Held,
    /// Root loads by azimuth.
    pub root: Vec<[f64; 6]>,
    /// Residual evaluations spent.
    pub evaluations: usize,
}

impl Response {
    /// The modal series.
    pub fn series(&self) -> &[f64] {
        &self.unknowns[..self.size]
    }

    /// Controls, rad.
    pub fn controls(&self) -> [f64; 3] {
        self.held.split(&self.unknowns, self.size).1
    }

    /// Mean induced inflow.
    pub fn lambda_i(&self) -> f64 {
        self.held.split(&self.unknowns, self.size).2
    }
}

impl Held {
    fn extra(self) -> usize {
        match self {
            Self::All { .. } => 0,
            Self::Controls(_) => 1,
            Self::Thrust(_) => 4,
        }
    }

    /// Motion, controls and inflow of a list of unknowns.
    fn split(self, x: &[f64], size: usize) -> (&[f64], [f64; 3], f64) {
        let (series, rest) = x.split_at(size);
        match self {
            Self::All { controls, lambda_i } => (series, controls, lambda_i),
            Self::Controls(controls) => (series, controls, rest[0]),
            Self::Thrust(_) => (series, [rest[0], rest[1], rest[2]], rest[3]),
        }
    }
}

/// A rotor whose blades are all alike, with the Jacobians it has used.
#[derive(Debug, Clone)]
pub struct Solver<'a> {
    elastic: &'a Elastic,
    /// Of [`Held::All`], [`Held::Controls`] and [`Held::Thrust`].
    kept: [Option<Jacobian>; 3],
}

impl<'a> Solver<'a> {
    /// A solver that has not worked yet.
    pub fn new(elastic: &'a Elastic) -> Self {
        Self { elastic, kept: [None, None, None] }
    }

    fn residual(&self, x: &[f64], held: Held, air: (&Flow, &FlapAngles)) -> Vec<f64> {
        let (series, controls, lambda_i) = held.split(x, self.elastic.size());
        let Evaluation { mut residual, root } =
            self.elastic.evaluate(series, controls, lambda_i, air);
        if held.extra() > 0 {
            let blade = &self.elastic.blade;
            let loads = hub_loads(&self.elastic.fourier, &vec![root.as_slice(); blade.blades]);
            let mean = |k: usize| loads.iter().map(|own| own[k]).sum::<f64>() / loads.len() as f64;
            let thrust = mean(2);
            if let Held::Thrust(loading) = held {
                let aim = loading * blade.blades as f64 * blade.air_mass();
                residual.extend([thrust - aim, mean(3), mean(4)]);
            }
            let coefficient = thrust * blade.solidity() / (blade.blades as f64 * blade.air_mass());
            let lambda = air.0.mu * air.0.tilt_rad.tan() + lambda_i;
            residual.push(momentum_defect(air.0.mu, lambda, lambda_i, coefficient));
        }
        residual
    }

    /// Periodic response with `held`, from another response or from rest.
    ///
    /// # Errors
    /// [`RotorTruthError::Response`] if it does not converge.
    pub fn solve(
        &mut self,
        held: Held,
        air: (&Flow, &FlapAngles),
        near: Option<&Response>,
    ) -> Result<Response, RotorTruthError> {
        let (start, mut evaluations) = match near {
            Some(own) => (Self::started(held, own), 0),
            None => self.begun(held, air)?,
        };
        let place = match held {
            Held::All { .. } => 0,
            Held::Controls(_) => 1,
            Held::Thrust(_) => 2,
        };
        let of = |x: &[f64]| self.residual(x, held, air);
        let mut kept = self.kept[place].clone();
        let mut x = start;
        let mut last = f64::INFINITY;
        for _ in 0..JACOBIANS {
            let jacobian = if let Some(own) = kept.take() {
                own
            } else {
                evaluations += x.len() + 1;
                Jacobian::at(&x, &of)
            };
            let found = jacobian.solve(&x, TOLERANCE, STEPS, &of)?;
            evaluations += found.iterations + 1;
            if found.is_converged {
                let (series, controls, lambda_i) = held.split(&found.x, self.elastic.size());
                let root = self.elastic.evaluate(series, controls, lambda_i, air).root;
                // one found anew is nearer to what comes next
                self.kept[place] = Some(jacobian);
                let size = self.elastic.size();
                return Ok(Response { unknowns: found.x, size, held, root, evaluations });
            }
            last = found.residual;
            if found.residual.is_finite() && found.residual < 1.0 {
                x = found.x;
            }
        }
        let loading = if let Held::Thrust(own) = held { own } else { f64::NAN };
        let (advance_ratio, iterations) = (air.0.mu, JACOBIANS * STEPS);
        Err(RotorTruthError::Response { advance_ratio, loading, residual: last, iterations })
    }

    /// The unknowns of another response, for what is held now.
    fn started(held: Held, own: &Response) -> Vec<f64> {
        let mut x = own.series().to_vec();
        match held {
            Held::All { .. } => {}
            Held::Controls(_) => x.push(own.lambda_i()),
            Held::Thrust(_) => {
                x.extend(own.controls());
                x.push(own.lambda_i());
            }
        }
        x
    }

    /// A response at plausible controls, for a trim that starts from nothing.
    fn begun(
        &mut self,
        held: Held,
        air: (&Flow, &FlapAngles),
    ) -> Result<(Vec<f64>, usize), RotorTruthError> {
        let zeros = vec![0.0; self.elastic.size()];
        let loading = match held {
            Held::All { .. } => return Ok((zeros, 0)),
            Held::Thrust(own) => own,
            Held::Controls(_) => 0.07,
        };
        let (mu, tilt) = (air.0.mu, air.0.tilt_rad);
        let lambda_i = glauert(mu, tilt, loading * self.elastic.blade.solidity());
        let controls = if let Held::Controls(own) = held {
            own
        } else {
            // blade element theory with 2 pi: CT/sigma = pi (theta/3 (1 + 1.5 mu^2) - lambda/2)
            let lambda = mu * tilt.tan() + lambda_i;
            let collective = (loading / PI + 0.5 * lambda) * 3.0 / (1.0 + 1.5 * mu * mu);
            [1.25 * collective, 0.02, -0.3 * mu]
        };
        let found = self.solve(Held::All { controls, lambda_i }, air, None)?;
        Ok((Self::started(held, &found), found.evaluations))
    }
}

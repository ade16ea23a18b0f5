//! Changes of a response along a direction: what moves a wake, and the state.

use crate::loads::wrenches::added;
use crate::{ResponseError, RotorSolution};
use nalgebra::DMatrix;
use rotor_base::HarmonicSeries;
use rotor_fem::Orbit;

/// Change of what moves a free wake.
#[derive(Debug, Clone, PartialEq)]
pub struct WakeDrive {
    /// Bound circulation at the azimuths and panels of the wake, azimuth by azimuth, `Omega R^2`.
    pub circulation: Vec<f64>,
    /// Harmonics of every modal coordinate, as [`RotorSolution::modal`].
    pub modal: Vec<HarmonicSeries>,
}

/// Change of the orbit and of the inflow.
#[derive(Debug, Clone, PartialEq)]
pub struct StateChange {
    /// Modal motion.
    pub(crate) orbit: Orbit,
    /// Modal accelerations that satisfy the equations of motion at every point.
    pub(crate) accelerations: DMatrix<f64>,
    /// Parameters of the inflow, tip speed.
    pub(crate) inflow: Vec<f64>,
}

/// `a += factor b`.
pub(crate) fn add(a: &mut [f64], factor: f64, b: &[f64]) {
    for (value, part) in a.iter_mut().zip(b) {
        *value += factor * part;
    }
}

impl WakeDrive {
    /// `self += factor other`.
    pub(crate) fn add(&mut self, other: &Self, factor: f64) {
        add(&mut self.circulation, factor, &other.circulation);
        self.modal = other.moved(&self.modal, factor);
    }

    /// A motion and a part of this change of it.
    pub fn moved(&self, modal: &[HarmonicSeries], part: f64) -> Vec<HarmonicSeries> {
        modal.iter().zip(&self.modal).map(|(value, change)| added(value, change, part)).collect()
    }

    /// `self *= factor`.
    pub(crate) fn scale(&mut self, factor: f64) {
        let own = self.clone();
        self.add(&own, factor - 1.0);
    }
}

impl StateChange {
    /// The change from one response to another; without a change of the inflow where they have inflows of different kinds.
    #[must_use]
    pub fn between(from: &RotorSolution, to: &RotorSolution) -> Self {
        let (before, after) = (from.inflow.parameters(), to.inflow.parameters());
        let inflow = if before.len() == after.len() {
            after.iter().zip(&before).map(|(a, b)| a - b).collect()
        } else {
            vec![0.0; after.len()]
        };
        let nodal = &to.orbit.nodal - &from.orbit.nodal;
        Self {
            orbit: Orbit { nodal },
            accelerations: &to.accelerations - &from.accelerations,
            inflow,
        }
    }

    /// The same for a response in an inflow of which nothing is known, where this is the change of another kind; none for a
    /// response of another blade or on other points of time.
    #[must_use]
    pub fn for_response(mut self, response: &RotorSolution) -> Option<Self> {
        let count = response.inflow.parameters().len();
        if self.inflow.len() != count {
            self.inflow = vec![0.0; count];
        }
        let fits = self.orbit.nodal.shape() == response.orbit.nodal.shape()
            && self.accelerations.shape() == response.accelerations.shape();
        fits.then_some(self)
    }

    /// `self *= factor`.
    pub fn scale(&mut self, factor: f64) {
        self.orbit.nodal *= factor;
        self.accelerations *= factor;
        for value in &mut self.inflow {
            *value *= factor;
        }
    }

    /// No change of the same size.
    #[must_use]
    pub fn zero(&self) -> Self {
        let nodal = self.orbit.nodal.map(|_| 0.0);
        let accelerations = self.accelerations.map(|_| 0.0);
        Self { orbit: Orbit { nodal }, accelerations, inflow: vec![0.0; self.inflow.len()] }
    }

    /// `self += factor other`.
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.orbit.nodal.zip_apply(&other.orbit.nodal, |value, part| *value += factor * part);
        self.accelerations.zip_apply(&other.accelerations, |value, part| *value += factor * part);
        add(&mut self.inflow, factor, &other.inflow);
    }
}

impl RotorSolution {
    /// A start for the response that a change leads to: orbit and inflow are moved, nothing else.
    ///
    /// # Errors
    /// [`ResponseError::Wake`] for another number of inflow parameters.
    pub fn moved_start(mut self, change: &StateChange) -> Result<Self, ResponseError> {
        self.orbit.nodal += &change.orbit.nodal;
        let mut inflow = self.inflow.parameters();
        add(&mut inflow, 1.0, &change.inflow);
        self.inflow = self.inflow.with_parameters(&inflow)?;
        Ok(self)
    }

    /// The response as the linearised rotor has it after a change: orbit, accelerations and inflow are moved, as the loads of
    /// the blade ask for ([`crate::RotorSolver::station_loads`]). Hub loads and hinge moments stay those of before.
    ///
    /// # Errors
    /// [`ResponseError::Wake`] for another number of inflow parameters.
    pub fn moved_blade(self, change: &StateChange) -> Result<Self, ResponseError> {
        let mut moved = self.moved_start(change)?;
        moved.accelerations += &change.accelerations;
        Ok(moved)
    }
}

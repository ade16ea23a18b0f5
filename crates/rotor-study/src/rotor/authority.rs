//! What every harmonic of every flap does to the hub, from the linearised rotor.

use crate::series::{added, coefficients, only};
use rotor_base::HarmonicSeries;
use rotor_response::{
    Condition, FlapDirection, InflowState, ResponseError, RotorSolution, RotorSolver,
};
use rotor_wake::InflowModel;

/// Highest harmonic of the flap whose effect on the hub is kept. A flap harmonic reaches the hub at the
/// blade number per rev through the periodic coefficients of the rotor, whose own harmonics fall off fast.
pub(crate) const HARMONICS: usize = 10;

/// Derivative of the hub loads at the blade number per rev with the flap harmonics, about the trimmed
/// orbit: pilot controls held, inflow settled or frozen.
#[derive(Debug, Clone, PartialEq)]
pub struct FlapAuthority {
    /// By flap: mean, then cosine and sine of each harmonic; load per deg.
    columns: Vec<Vec<[f64; 12]>>,
    /// The same of the hinge moments of all flaps, `m0 Omega^2 R^3` per deg.
    hinge: Vec<Vec<Vec<HarmonicSeries>>>,
}

impl FlapAuthority {
    /// The derivatives about a converged orbit, with the harmonics of a flap up to the `highest`.
    ///
    /// # Errors
    /// As [`RotorSolver::linearised`].
    pub fn about(
        solver: &mut RotorSolver,
        condition: &Condition,
        about: &RotorSolution,
        inflow: &dyn InflowModel,
        state: InflowState,
        highest: usize,
    ) -> Result<Self, ResponseError> {
        let model = solver.rotor().model();
        let (flaps, blades) = (model.flaps.len(), model.blades);
        let per_flap = 2 * highest + 1;
        let directions: Vec<FlapDirection> = (0..flaps * per_flap)
            .map(|k| {
                let mut direction = vec![HarmonicSeries::zero(0); flaps];
                direction[k / per_flap] = only(k % per_flap, 1.0_f64.to_radians());
                direction
            })
            .collect();
        let found = solver.linearised((condition, about), inflow, &directions, state)?;
        let all: Vec<[f64; 12]> =
            found.sensitivities.iter().map(|s| s.hub.harmonic(blades)).collect();
        let hinge: Vec<Vec<HarmonicSeries>> =
            found.sensitivities.into_iter().map(|s| s.hinge).collect();
        Ok(Self {
            columns: all.chunks(per_flap).map(<[[f64; 12]]>::to_vec).collect(),
            hinge: hinge.chunks(per_flap).map(<[Vec<HarmonicSeries>]>::to_vec).collect(),
        })
    }

    /// The same with the hub loads of one harmonic of one flap (load per deg, cosine and sine) found otherwise.
    #[must_use]
    pub(crate) fn with_harmonic(
        mut self,
        flap: usize,
        harmonic: usize,
        loads_per_deg: [[f64; 12]; 2],
    ) -> Self {
        if let Some(columns) = self.columns.get_mut(flap)
            && harmonic > 0
            && let Some(pair) = columns.get_mut(2 * harmonic - 1..=2 * harmonic)
        {
            pair.copy_from_slice(&loads_per_deg);
        }
        self
    }

    /// Change of the hub loads for a small motion of one flap, deg. Harmonics beyond those kept have
    /// no part in it.
    pub fn loads(&self, flap: usize, motion_deg: &HarmonicSeries) -> [f64; 12] {
        let mut loads = [0.0; 12];
        let Some(columns) = self.columns.get(flap) else { return loads };
        for (part, column) in coefficients(motion_deg, columns.len() / 2).zip(columns) {
            for (load, c) in loads.iter_mut().zip(column) {
                *load += c * part;
            }
        }
        loads
    }

    /// Change of the hinge moment of every flap for a small motion of one flap, deg; `m0 Omega^2 R^3`.
    pub fn hinge(&self, flap: usize, motion_deg: &HarmonicSeries) -> Vec<HarmonicSeries> {
        let Some(columns) = self.hinge.get(flap) else { return Vec::new() };
        let mut moments = vec![HarmonicSeries::zero(0); columns.first().map_or(0, Vec::len)];
        for (part, column) in coefficients(motion_deg, columns.len() / 2).zip(columns) {
            for (moment, change) in moments.iter_mut().zip(column) {
                *moment = added(moment, change, part);
            }
        }
        moments
    }
}

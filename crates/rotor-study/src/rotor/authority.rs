//! What every harmonic of every flap does to the hub, from the linearised rotor.

use rotor_base::HarmonicSeries;
use rotor_base::series::{added, coefficients, only};
use rotor_response::{
    Condition, FlapDirection, HubSensitivity, InflowState, ResponseError, RotorSolution,
    RotorSolver, StateChange,
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
    /// The same of orbit and inflow, per deg; none of motions that are not kept.
    states: Vec<Vec<Option<StateChange>>>,
}

impl FlapAuthority {
    /// The derivatives about a converged orbit with the inflow settled, and with the inflow held, for some harmonics of
    /// every flap; 0 is the mean.
    ///
    /// # Errors
    /// As [`RotorSolver::linearised`].
    pub(crate) fn about(
        solver: &mut RotorSolver,
        condition: &Condition,
        about: &RotorSolution,
        inflow: &dyn InflowModel,
        harmonics: &[usize],
    ) -> Result<[Self; 2], ResponseError> {
        let model = solver.rotor().model();
        let (flaps, blades) = (model.flaps.len(), model.blades);
        let both = |&n: &usize| if n == 0 { vec![0] } else { vec![2 * n - 1, 2 * n] };
        let places: Vec<usize> = harmonics.iter().flat_map(both).collect();
        let size = places.iter().max().map_or(0, |place| place + 1);
        let each: Vec<(usize, usize)> =
            (0..flaps).flat_map(|flap| places.iter().map(move |&place| (flap, place))).collect();
        let directions: Vec<FlapDirection> = each
            .iter()
            .map(|&(flap, place)| {
                let mut direction = vec![HarmonicSeries::zero(0); flaps];
                direction[flap] = only(place, 1.0_f64.to_radians());
                direction
            })
            .collect();
        let at = (condition, about);
        let found = solver.linearised(at, inflow, &directions, InflowState::Settled)?;
        let of = |changes: Vec<HubSensitivity>| {
            let mut made = Self {
                columns: vec![vec![[0.0; 12]; size]; flaps],
                hinge: vec![vec![vec![HarmonicSeries::zero(0); flaps]; size]; flaps],
                states: vec![vec![None; size]; flaps],
            };
            for (&(flap, place), change) in each.iter().zip(changes) {
                made.columns[flap][place] = change.hub.harmonic(blades);
                made.hinge[flap][place] = change.hinge;
                made.states[flap][place] = Some(change.state);
            }
            made
        };
        Ok([of(found.sensitivities), of(found.held)])
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

    /// A start for the response to flap motions, rad, from that about which is linearised.
    ///
    /// # Errors
    /// As [`RotorSolution::moved_start`].
    pub(crate) fn start(
        &self,
        about: &RotorSolution,
        flap_angles_rad: &[HarmonicSeries],
    ) -> Result<RotorSolution, ResponseError> {
        let start = about.clone();
        match self.state_change(flap_angles_rad) {
            Some(change) => start.moved_start(&change),
            None => Ok(start),
        }
    }

    /// The response to small flap motions, rad, about that of which is linearised, as the loads of the blade ask for it.
    ///
    /// # Errors
    /// As [`RotorSolution::moved_blade`].
    pub(crate) fn moved_blade(
        &self,
        about: &RotorSolution,
        flap_angles_rad: &[HarmonicSeries],
    ) -> Result<RotorSolution, ResponseError> {
        let moved = about.clone();
        match self.state_change(flap_angles_rad) {
            Some(change) => moved.moved_blade(&change),
            None => Ok(moved),
        }
    }

    /// Change of orbit and inflow with flap motions, rad; none of motions that are zero or not kept.
    fn state_change(&self, flap_angles_rad: &[HarmonicSeries]) -> Option<StateChange> {
        let mut whole: Option<StateChange> = None;
        for (columns, angle) in self.states.iter().zip(flap_angles_rad) {
            for (part, change) in coefficients(angle, columns.len() / 2).zip(columns) {
                let Some(change) = change.as_ref().filter(|_| part != 0.0) else { continue };
                let whole = whole.get_or_insert_with(|| change.zero());
                whole.add(change, part.to_degrees());
            }
        }
        whole
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

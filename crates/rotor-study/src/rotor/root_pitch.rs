//! Pitch at the root of the blades beside the controls of the trim.

use crate::rotor::TrimmedRotor;
use rotor_base::HarmonicSeries;
use rotor_base::series::{added, only, place};
use rotor_response::{
    Disturbance, ResponseError, RotorSolution, RotorSolver, StateChange, StationLoads,
};

/// What a degree of root pitch does, linearised.
#[derive(Debug, Clone, PartialEq)]
pub struct RootPitchEffect {
    /// Hub loads at the blade number per rev, load per deg.
    pub loads_per_deg: [f64; 12],
    /// Orbit and inflow, per deg.
    pub state_per_deg: StateChange,
}

impl TrimmedRotor {
    /// The solver with pitch at the root, rad, beside that of the case.
    fn pitched(&self, pitch_rad: &HarmonicSeries) -> RotorSolver {
        self.solver.with_root_pitch(added(self.solver.root_pitch_rad(), pitch_rad, 1.0))
    }

    /// Response to pitch at the root of all blades beside the controls, rad, nose up positive, each blade at its own
    /// azimuth: pilot controls and attitude as trimmed, flaps at rest, inflow settled anew.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn with_root_pitch(
        &self,
        pitch_rad: &HarmonicSeries,
        start: &RotorSolution,
    ) -> Result<RotorSolution, ResponseError> {
        let mut solver = self.pitched(pitch_rad);
        solver.solve(&self.flaps_at_rest(), self.inflow.as_ref(), Some(start))
    }

    /// What cosine and sine of some harmonics of root pitch do about the response to a root pitch, rad, in the order of
    /// the harmonics; inflow as the case has it in T.
    ///
    /// # Errors
    /// The errors of the linearised response.
    pub fn root_pitch_effects(
        &self,
        (pitch_rad, about): (&HarmonicSeries, &RotorSolution),
        harmonics: &[usize],
    ) -> Result<Vec<RootPitchEffect>, ResponseError> {
        let blades = self.rotor().model().blades;
        let along = |n: usize| {
            [false, true]
                .map(|sine| Disturbance::RootPitch(only(place(n, sine), 1.0_f64.to_radians())))
        };
        let along: Vec<Disturbance> = harmonics.iter().flat_map(|&n| along(n)).collect();
        let at = (&self.flaps_at_rest(), about);
        let inflow = self.inflow.as_ref();
        let found =
            self.pitched(pitch_rad).linearised_along(at, inflow, &along, self.state_in_t())?;
        let effects = found.sensitivities.into_iter().map(|change| RootPitchEffect {
            loads_per_deg: change.hub.harmonic(blades),
            state_per_deg: change.state,
        });
        Ok(effects.collect())
    }

    /// Loads of one blade at stations of its span (R) in the response to a root pitch, rad, flaps at rest.
    ///
    /// # Errors
    /// As [`RotorSolver::station_loads`].
    pub fn station_loads_pitched(
        &self,
        pitch_rad: &HarmonicSeries,
        response: &RotorSolution,
        stations: &[f64],
    ) -> Result<Vec<StationLoads>, ResponseError> {
        self.pitched(pitch_rad).station_loads(&self.flaps_at_rest(), response, stations)
    }
}

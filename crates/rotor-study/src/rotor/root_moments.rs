//! What small flap motions do to the moments at the root of the blade.

use crate::rotor::trimmed::TrimmedRotor;
use rotor_base::HarmonicSeries;
use rotor_base::series::{scaled, weighted};
use rotor_response::{InflowState, ResponseError};

/// Flap motion of the central difference, deg: the loads of a response that the linearised rotor gives are smooth in it.
const STEP_DEG: f64 = 1e-2;

impl TrimmedRotor {
    /// Change of the moments at a station of the blade, flap (tip up), lag (tip forward) and torsion (nose up), with a
    /// motion of one flap, per unit of the motion (deg): `m0 Omega^2 R^3`.
    ///
    /// Orbit, accelerations and inflow move as in the linearised rotor, the inflow settled; the moments are those of
    /// [`TrimmedRotor::station_loads_with`], by a central difference. No response is solved. Harmonics of the motion beyond
    /// those of [`crate::FlapAuthority`] move the flap and not the blade.
    ///
    /// # Errors
    /// The errors of the linearised response and of the loads.
    pub fn moments_along(
        &self,
        (flap, motion_deg): (usize, &HarmonicSeries),
        station_r: f64,
    ) -> Result<[HarmonicSeries; 3], ResponseError> {
        let authority = self.linearised(InflowState::Settled)?;
        let at = |step_deg: f64| {
            let still = HarmonicSeries::zero(0);
            let mut angles_rad = vec![still; self.rotor().model().flaps.len()];
            if let Some(own) = angles_rad.get_mut(flap) {
                *own = scaled(motion_deg, step_deg.to_radians());
            }
            let moved = authority.moved_blade(&self.trim().rotor, &angles_rad)?;
            let loads = self.station_loads_with(angles_rad, &moved, &[station_r])?;
            Ok::<_, ResponseError>(loads.into_iter().next().map(|at| at.moments.harmonics))
        };
        let none = || std::array::from_fn(|_| HarmonicSeries::zero(0));
        let [up, down] = [STEP_DEG, -STEP_DEG].map(at);
        let (up, down) = (up?.unwrap_or_else(none), down?.unwrap_or_else(none));
        Ok(std::array::from_fn(|k| weighted(&up[k], &down[k], 0.5 / STEP_DEG)))
    }
}

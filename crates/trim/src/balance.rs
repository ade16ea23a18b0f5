//! The equations of trim: what is asked for, and what a response leaves of it.

use crate::TrimError;
use crate::vehicle::{AirframeLoads, Attitude, Vehicle, equilibrium};
use nalgebra::DVector;
use rotor_response::{Controls, RotorSolution, RotorSolver};
use rotor_wake::FlightState;

/// What the rotor is trimmed to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum TrimTarget {
    /// Level flight of the whole helicopter: six equations for the three controls, shaft tilt, bank
    /// and tail rotor thrust.
    Propulsive {
        /// Weight as `C_W / sigma`.
        weight_ct_sigma: f64,
        /// The helicopter.
        vehicle: Vehicle,
    },
    /// Wind-tunnel (moment) trim: thrust and hub moments for the three controls at a given shaft tilt.
    WindTunnel {
        /// Thrust as `C_T / sigma`.
        ct_sigma: f64,
        /// Shaft tilt, rad, forward positive.
        shaft_tilt_rad: f64,
        /// Mean moments `M_X`, `M_Y` of all blades on the hub, `m0 Omega^2 R^3`; usually zero.
        hub_moments: [f64; 2],
    },
    /// Controls and shaft tilt are given; nothing is solved but the response.
    Prescribed {
        /// The controls.
        controls: Controls,
        /// Shaft tilt, rad, forward positive.
        shaft_tilt_rad: f64,
    },
}

/// Shaft tilt and bank beyond which level flight is not meant, rad.
pub(crate) const ATTITUDE_LIMIT: f64 = 0.8;

/// Trim equations of a rotor at one advance ratio.
#[derive(Debug, Clone)]
pub(crate) struct Balance {
    pub(crate) advance_ratio: f64,
    pub(crate) target: TrimTarget,
    /// Weight or thrust asked for, `m0 Omega^2 R^2`.
    pub(crate) weight: f64,
    /// The same as thrust coefficient.
    pub(crate) thrust_coefficient: f64,
    /// Number of unknowns, and of equations.
    pub(crate) unknowns: usize,
    /// Weight of the blades, `m0 Omega^2 R^2`, zero without gravity.
    blades_weight: f64,
    density_chord: f64,
    chord: f64,
}

impl Balance {
    pub(crate) fn new(
        solver: &RotorSolver,
        advance_ratio: f64,
        target: &TrimTarget,
    ) -> Result<Self, TrimError> {
        let model = solver.rotor().model();
        let (loading, unknowns, tilt) = match target {
            TrimTarget::Propulsive { weight_ct_sigma, vehicle } => {
                vehicle.validate()?;
                (*weight_ct_sigma, 6, 0.0)
            }
            TrimTarget::WindTunnel { ct_sigma, shaft_tilt_rad, .. } => {
                (*ct_sigma, 3, *shaft_tilt_rad)
            }
            TrimTarget::Prescribed { shaft_tilt_rad, .. } => (0.07, 0, *shaft_tilt_rad),
        };
        let attitude = -ATTITUDE_LIMIT..=ATTITUDE_LIMIT;
        let moments = match target {
            TrimTarget::WindTunnel { hub_moments: [mx, my], .. } => mx.abs().max(my.abs()),
            _ => 0.0,
        };
        for (field, value, is_good, expected) in [
            ("hub_moments", moments, moments.is_finite(), "finite numbers"),
            ("ct_sigma", loading, loading > 0.0 && loading <= 0.5, "more than 0 and at most 0.5"),
            ("shaft_tilt_rad", tilt, attitude.contains(&tilt), "-0.8 to 0.8 rad"),
            ("advance_ratio", advance_ratio, (0.0..=0.5).contains(&advance_ratio), "0 to 0.5"),
        ] {
            if !is_good {
                return Err(TrimError::Parameter { field, value, expected });
            }
        }
        let weight = model.thrust_of_loading(loading);
        Ok(Self {
            advance_ratio,
            target: *target,
            weight,
            thrust_coefficient: model.thrust_coefficient(weight),
            blades_weight: solver.rotor().blades_weight(),
            density_chord: model.density_chord(),
            chord: model.chord,
            unknowns,
        })
    }

    pub(crate) fn flight(&self, shaft_tilt_rad: f64) -> FlightState {
        FlightState { advance_ratio: self.advance_ratio, shaft_tilt_rad }
    }

    /// Drag and tail lift of the airframe; none but in level flight.
    pub(crate) fn airframe(&self, shaft_tilt_rad: f64) -> AirframeLoads {
        match &self.target {
            TrimTarget::Propulsive { vehicle, .. } => AirframeLoads::of(
                vehicle,
                self.density_chord,
                self.chord,
                self.advance_ratio,
                shaft_tilt_rad,
            ),
            _ => AirframeLoads::default(),
        }
    }

    /// Controls and attitude of the unknowns.
    pub(crate) fn state(&self, x: &DVector<f64>) -> (Controls, Attitude) {
        let found = || Controls { theta0_rad: x[0], theta1c_rad: x[1], theta1s_rad: x[2] };
        match self.target {
            TrimTarget::Prescribed { controls, shaft_tilt_rad } => {
                (controls, Attitude { shaft_tilt_rad, ..Attitude::default() })
            }
            TrimTarget::WindTunnel { shaft_tilt_rad, .. } => {
                (found(), Attitude { shaft_tilt_rad, ..Attitude::default() })
            }
            TrimTarget::Propulsive { .. } => {
                (found(), Attitude { shaft_tilt_rad: x[3], roll_rad: x[4], tail_thrust: x[5] })
            }
        }
    }

    /// The unknowns of controls and attitude.
    pub(crate) fn unknowns_of(&self, c: &Controls, a: &Attitude) -> DVector<f64> {
        let pitch = [c.theta0_rad, c.theta1c_rad, c.theta1s_rad];
        let all = [pitch, [a.shaft_tilt_rad, a.roll_rad, a.tail_thrust]].concat();
        DVector::from_column_slice(&all[..self.unknowns])
    }

    /// Trim residuals over the weight of a response at an attitude; empty for prescribed controls.
    pub(crate) fn residual(&self, rotor: &RotorSolution, attitude: &Attitude) -> DVector<f64> {
        self.residual_of(rotor.hub.mean(), attitude)
    }

    /// The same of mean loads of all blades on the hub, `m0 Omega^2 R^2` and `m0 Omega^2 R^3`.
    pub(crate) fn residual_of(&self, mut mean: [f64; 6], attitude: &Attitude) -> DVector<f64> {
        // what the hub carries besides its blades' own weight
        let (sin_a, cos_a) = attitude.shaft_tilt_rad.sin_cos();
        let (sin_f, cos_f) = attitude.roll_rad.sin_cos();
        for (force, up) in mean.iter_mut().zip([sin_a * cos_f, -sin_f, cos_a * cos_f]) {
            *force += self.blades_weight * up;
        }
        let residual = match &self.target {
            TrimTarget::Prescribed { .. } => vec![],
            TrimTarget::WindTunnel { hub_moments: [mx, my], .. } => {
                vec![mean[2] - self.weight, mean[3] - mx, mean[4] - my]
            }
            TrimTarget::Propulsive { vehicle, .. } => {
                let airframe = self.airframe(attitude.shaft_tilt_rad);
                equilibrium(mean, attitude, vehicle, self.weight, airframe).to_vec()
            }
        };
        DVector::from_vec(residual) / self.weight
    }
}

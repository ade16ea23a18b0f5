//! A rotor ready to be solved, and the condition it is solved in.

use crate::model::flap_mass::with_flap_masses;
use crate::response::system::{PointInput, ResponseSystem, side_by_side};
use crate::sections::air::{AirPoint, FlapAngle};
use crate::sections::flight_air::FlightAir;
use crate::structure::blade::ResponseBlade;
use crate::{Controls, Discretisation, ResponseError, RotorModel};
use nalgebra::DMatrix;
use rotor_base::HarmonicSeries;
use rotor_fem::BladeProperties;
use rotor_wake::FlightState;

/// A rotor ready to be solved in any flight condition.
#[derive(Debug, Clone)]
pub struct Rotor {
    model: RotorModel,
    pub(crate) discretisation: Discretisation,
    blade: ResponseBlade,
    pub(crate) mass: DMatrix<f64>,
    pub(crate) damping: DMatrix<f64>,
}

impl Rotor {
    /// Builds mode shapes, stations and matrices, of the blade made heavier by flaps that its mass does
    /// not contain ([`with_flap_masses`]).
    ///
    /// # Errors
    /// Any problem of the model, the blade or the discretisation.
    pub fn new(
        model: RotorModel,
        properties: &BladeProperties,
        discretisation: Discretisation,
    ) -> Result<Self, ResponseError> {
        model.validate()?;
        let properties = with_flap_masses(properties, &model.flaps)?;
        let blade = ResponseBlade::new(&model, &properties, discretisation)?;
        let mass = blade.mass_matrix();
        let damping = blade.damping(model.modal_damping, model.lag_damper);
        Ok(Self { model, discretisation, blade, mass, damping })
    }

    /// The same rotor with another damping of its modes over critical.
    #[must_use]
    pub fn with_modal_damping(&self, modal_damping: f64) -> Self {
        let model = RotorModel { modal_damping, ..self.model.clone() };
        let damping = self.blade.damping(modal_damping, model.lag_damper);
        Self { model, damping, ..self.clone() }
    }

    /// The parameters.
    pub fn model(&self) -> &RotorModel {
        &self.model
    }

    /// Weight of all blades, `m0 Omega^2 R^2`; zero without gravity.
    pub fn blades_weight(&self) -> f64 {
        self.model.blades as f64 * self.model.gravity * self.blade.grid.integral(&self.blade.mass)
    }

    /// The blade at its stations.
    pub fn blade(&self) -> &ResponseBlade {
        &self.blade
    }

    /// The periodic system of one blade for what air and pilot do at every point.
    pub(crate) fn system<'a>(
        &'a self,
        air: &'a FlightAir,
        points: Vec<PointInput>,
    ) -> ResponseSystem<'a> {
        ResponseSystem {
            blade: &self.blade,
            couplings: self.model.couplings,
            air,
            blocks: side_by_side(&points),
            points,
            damping: &self.damping,
            mass: &self.mass,
        }
    }
}

impl Rotor {
    /// What air and pilot do to a blade at an azimuth (rad), for the induced velocity at its lifting stations, down and from
    /// the leading to the trailing edge, tip speed, and the angles of its flaps.
    pub(crate) fn point_input(
        &self,
        root_pitch_rad: &HarmonicSeries,
        condition: &Condition,
        azimuth: f64,
        induced: &[[f64; 2]],
        flap: Vec<FlapAngle>,
    ) -> PointInput {
        let (sin, cos) = azimuth.sin_cos();
        let advance_ratio = condition.flight.advance_ratio;
        let through = advance_ratio * condition.flight.shaft_tilt_rad.tan();
        let pitch = condition.controls.root_pitch(root_pitch_rad, azimuth);
        let reverse_flow = self.model.reverse_flow;
        PointInput {
            gravity: self.gravity(condition, sin, cos),
            air: AirPoint { sin, cos, advance_ratio, pitch, reverse_flow },
            inflow: induced.iter().map(|[down, along]| [through + down, *along]).collect(),
            flap,
        }
    }

    /// Acceleration of gravity in the axes of the coned blade at an azimuth.
    ///
    /// ```text
    /// up = (sin a cos f, -sin f, cos a cos f) in hub axes,   a shaft tilt forward, f bank right
    /// ```
    fn gravity(&self, condition: &Condition, sin: f64, cos: f64) -> [f64; 3] {
        let up = up(condition).map(|c| -self.model.gravity * c);
        let [outward, leading] = [up[0] * cos + up[1] * sin, up[1] * cos - up[0] * sin];
        let (across, along) = self.blade.precone.sin_cos();
        [outward * along + up[2] * across, leading, up[2] * along - outward * across]
    }
}

/// Flight condition, controls and flap motion of one solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// Advance ratio and shaft tilt.
    pub flight: FlightState,
    /// Bank, rad, right positive: the direction of gravity besides the shaft tilt.
    pub bank_rad: f64,
    /// Pitch controls.
    pub controls: Controls,
    /// Angle of every flap (rad, trailing edge down positive) against blade azimuth.
    pub flap_angles_rad: Vec<HarmonicSeries>,
}

/// The upward vertical in hub axes (X aft, Y starboard, Z along the shaft).
pub(crate) fn up(condition: &Condition) -> [f64; 3] {
    let (sin_a, cos_a) = condition.flight.shaft_tilt_rad.sin_cos();
    let (sin_f, cos_f) = condition.bank_rad.sin_cos();
    [sin_a * cos_f, -sin_f, cos_a * cos_f]
}
